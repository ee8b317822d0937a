use super::*;

const FILE: &str = include_str!("../../../experiments/figure3.toml");

#[test]
fn the_command_repeats_the_run() {
    let command = |seed, lines, quick| {
        let error = None;
        let overrides = Overrides {
            seed,
            lines,
            error,
            quick,
        };
        let plan = Plan::parse(FILE, "x.toml", "x", overrides).expect("a plan");
        (plan.name, plan.command)
    };
    assert_eq!(
        command(None, None, false),
        ("x".into(), "validate run x.toml".into())
    );
    assert_eq!(
        command(Some(7), Some(4096), true),
        (
            "x-quick".into(),
            "validate run x.toml --quick --seed 7 --lines 4096".into()
        )
    );
}

#[test]
fn wrong_values_are_found_where_they_stand() {
    let error = |old: &str, new: &str| {
        assert!(FILE.contains(old), "{old}");
        let text = FILE.replacen(old, new, 1);
        let line = 1 + text[..text.find(new).expect("new")].matches('\n').count();
        let error = Plan::parse(&text, "x.toml", "x", Overrides::default());
        let error = error.expect_err(new).to_string();
        assert!(error.starts_with(&format!("x.toml:{line}:")), "{error}");
    };
    error("family = 0.01 ", "family = 1e-13 ");
    error("gate = 0.001 ", "gate = 1.0 ");
    error("accepted_above = 1e-4", "accepted_above = -1.0");
    error("slope_error = 0.002", "slope_error = 2.0");
    error("max = 16_777_216", "max = 16");
    error("question = ", "question = \"\" # ");
}

#[test]
fn names_of_folders() {
    for name in ["validate", "figure3-quick", "a_b.c"] {
        assert!(is_folder_name(name), "{name}");
    }
    for name in ["", ".", "..", ".git", "a/b", "a\\b", "a b", "a:b"] {
        assert!(!is_folder_name(name), "{name}");
    }
}

#[test]
fn messages_are_one_line_without_gaps() {
    let told = |text: &str, name: &str, quick: bool| {
        let overrides = Overrides {
            quick,
            ..Overrides::default()
        };
        let error = Plan::parse(text, "x.toml", name, overrides);
        error.expect_err("no plan").to_string()
    };
    let full = &FILE[..FILE.find("[quick]").expect("a quick form")];
    for error in [told(full, "x", true), told(FILE, "a b", false)] {
        assert!(!error.contains("  ") && !error.contains('\n'), "{error}");
    }
}

#[test]
fn scenes_have_files_of_their_own() {
    let error = |scenes: [&str; 2]| {
        let plan = Plan::parse(FILE, "x.toml", "x", Overrides::default()).expect("a plan");
        let scenes = scenes.map(String::from).into();
        let wrong = Plan { scenes, ..plan }
            .check()
            .expect_err("one name for two");
        assert_eq!(wrong.key, "scenes");
        wrong.message
    };
    let message = error(["a/b.nff", "a-b.nff"]);
    let told = "scenes 'a/b.nff' and 'a-b.nff' would share the files 'a-b-nff'";
    assert!(message.starts_with(told), "{message}");
    assert!(error(["a.nff", "a.nff"]).contains("named twice"));
}

/// Every experiment that comes with the program can be read, in its quick form too if it has one.
#[test]
fn the_experiments_of_the_program_are_read() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/experiments");
    let mut seen = (0, 0);
    for entry in std::fs::read_dir(folder).expect("experiments") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        Plan::read(&path, Overrides::default()).expect("a plan");
        seen.0 += 1;
        let text = std::fs::read_to_string(&path).expect("text");
        if text.contains("\n[quick]") {
            let quick = true;
            let overrides = Overrides {
                quick,
                ..Overrides::default()
            };
            Plan::read(&path, overrides).expect("a quick plan");
            seen.1 += 1;
        }
    }
    assert!(seen.0 >= 14 && seen.1 >= 8, "{seen:?}");
}
