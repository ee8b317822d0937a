//! The catalogue of hard cases.

use crate::scene::nearest_name;

use super::case::Case;
use super::{boxes, cones, files, lines, polygons, spheres, statistics, trees, triangles};

/// Every case, group by group.
pub fn catalogue() -> Vec<Case> {
    let groups = [
        lines::cases,
        boxes::cases,
        triangles::cases,
        spheres::cases,
        cones::cases,
        polygons::cases,
        trees::cases,
        files::cases,
        statistics::cases,
    ];
    groups.into_iter().flat_map(|cases| cases()).collect()
}

/// The cases of these names, in the catalogue's order; all of them if none is given. The error tells the name that is unknown and
/// the nearest that is not.
pub fn select(names: Option<&[String]>) -> Result<Vec<Case>, String> {
    let all = catalogue();
    let Some(names) = names else {
        return Ok(all);
    };
    if names.is_empty() {
        return Err("cases must name at least one; leave the key out for all".into());
    }
    for name in names {
        if !all.iter().any(|case| case.name == name) {
            let known = all.iter().map(|case| case.name);
            let hint = nearest_name(name, known)
                .map_or(String::new(), |near| format!("did you mean '{near}'? "));
            return Err(format!(
                "'{name}' is no case; {hint}`validate list cases` names them"
            ));
        }
    }
    let mut chosen = all;
    chosen.retain(|case| names.iter().any(|name| name == case.name));
    Ok(chosen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::stability::case::{Check, Group, Outcome};

    #[test]
    fn names_are_unique_and_every_group_is_there() {
        let all = catalogue();
        let mut names: Vec<_> = all.iter().map(|case| case.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len());
        assert!(all.len() >= 70, "{}", all.len());
        for group in Group::ALL {
            assert!(all.iter().any(|case| case.group == group), "{group:?}");
        }
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-^".contains(c);
        for case in all {
            assert!(case.name.chars().all(plain), "{}", case.name);
            assert!(!case.stresses.is_empty(), "{}", case.name);
        }
    }

    /// Cases of files and of statistics come out as expected, word for word.
    #[test]
    fn cases_of_neither_kernel_nor_tree_pass() {
        for case in catalogue() {
            if !matches!(case.group, Group::Files | Group::Statistics) {
                continue;
            }
            let Check::Once(check) = case.check else {
                panic!("{} needs no kernel", case.name);
            };
            let finding = check();
            assert_eq!(finding.outcome, Outcome::Pass, "{}: {finding:?}", case.name);
        }
    }

    #[test]
    fn unknown_names_are_told_the_nearest() {
        let wrong = select(Some(&["tree-teraine".into()]))
            .map(|_| ())
            .unwrap_err();
        assert!(wrong.contains("did you mean 'tree-terrain'?"), "{wrong}");
        let two = select(Some(&["tree-terrain".into(), "sphere-tangent".into()])).unwrap();
        assert_eq!(
            two.iter().map(|c| c.name).collect::<Vec<_>>(),
            ["sphere-tangent", "tree-terrain"]
        );
    }
}
