//! `validate scene`: the measurement of the study on one scene, every strategy, and the rays that matter in it.

use std::path::Path;

use anyhow::Result;
use sahlab::cost::CostModel;
use sahlab::kd::{Ask, Rules, StopRule, Strategy};
use sahlab::rays::{LineLaw, Source, file};
use sahlab::report::{screen, write_report};
use sahlab::scene::Scene;
use sahlab::study::hits::HitsVsArea;
use sahlab::study::hits::asked::{Expect, Figure};
use sahlab::study::hits::work::{Own, Work};
use sahlab::study::plan::Overrides;
use sahlab::study::ray_sets::{RaysOf, check_scene};
use sahlab::study::records::file_stem;
use sahlab::study::{Kind, LineRule, Plan};
use sahlab::tracer::RayKind;

use crate::args::Common;
use crate::{render, run, run_loaded};

/// What the command line asks for.
pub struct OneScene<'a> {
    /// The scene.
    pub spec: &'a str,
    /// When nodes become leaves.
    pub stop: StopRule,
    /// Whether objects are clipped to the parts of a node.
    pub clipped: bool,
    /// A file of rays, and what they ask.
    pub own: Option<(&'a Path, Ask)>,
}

/// Run it. Says whether every expectation held.
pub fn one_scene(asked: &OneScene<'_>, common: &Common, overrides: Overrides) -> Result<bool> {
    let mut plan = plan(asked, common.quick, overrides)?;
    let own = match asked.own {
        Some((file, ask)) => Some(Own::new(file::read(file)?, ask)),
        None => None,
    };
    let scenes = run::load_scenes(&mut plan, None)?;
    if let Kind::HitsVsArea(hits) = &mut plan.kind {
        let rays = work(&scenes[0], own, common.quick);
        hits.work = Some(Work {
            error: common.error,
            ..rays
        });
    }
    let quick = if common.quick { "-quick" } else { "" };
    plan.name = format!("scene-{}{quick}", file_stem(&plan.scenes[0]));
    let plans = [(plan, scenes)];
    let held = run_loaded(&plans, common, screen::scene)?;
    let [(plan, scenes)] = &plans;
    if let (false, Some(look)) = (common.dry_run, &scenes[0].look) {
        let rules = Rules {
            strategy: Strategy::Sah,
            stop: asked.stop,
            cost: plan.cost,
            clipped: asked.clipped,
        };
        let [data, plots] = run::folders(plan, common);
        render::render(&scenes[0], look, &rules, plan.quick, &plots)?;
        // Once more, now that there is a picture for it.
        write_report(&run::read(&data)?, &plots)?;
    }
    Ok(held)
}

/// The plan but for its rays, which depend on the scene.
fn plan(asked: &OneScene<'_>, quick: bool, overrides: Overrides) -> Result<Plan> {
    let &OneScene {
        spec,
        stop,
        clipped,
        own,
    } = asked;
    let slope_within = if quick { 0.02 } else { 0.005 };
    let lines = match (overrides.lines, overrides.error) {
        (Some(n), _) => LineRule::exactly(n),
        (None, Some(error)) => LineRule::for_cost_error(error),
        (None, None) if quick => LineRule::for_error(slope_within, 1 << 16, 1 << 20),
        (None, None) => LineRule::for_error(slope_within, 1 << 18, 1 << 22),
    };
    let rays = own.map_or_else(String::new, |(file, ask)| {
        format!(" --rays {} --ask {ask}", file.display())
    });
    Ok(Plan {
        name: String::new(),
        command: format!(
            "validate scene {spec} --stop {stop}{}{rays}{}",
            if clipped { " --clipped" } else { "" },
            overrides.arguments()
        ),
        question: format!(
            "What does a kd-tree over {spec} cost, and which strategy should build it?"
        ),
        seed: overrides.seed.unwrap_or(1),
        scenes: vec![spec.into()],
        cost: CostModel::WALD_HAVRAN,
        quick,
        kind: Kind::HitsVsArea(HitsVsArea {
            strategies: Strategy::ALL.into(),
            stop,
            clipped,
            nodes: false,
            lines: lines.map_err(anyhow::Error::msg)?,
            figure: Figure {
                scene: spec.into(),
                strategy: Strategy::Sah,
            },
            controls: None,
            work: None,
            expect: Expect {
                slope_within,
                family: 0.01,
                gate: 0.001,
            },
        }),
        record: None,
    })
}

/// The metric's own lines, then with an end, then from within and from the objects; the rays of a picture, if the scene has
/// a look. Objects without area have no rays that start on them.
fn work(scene: &Scene, own: Option<Own>, quick: bool) -> Work {
    let lines = Source::Law(LineLaw::Surface);
    let mut rays = vec![
        RaysOf::Source(lines, Ask::All),
        RaysOf::Source(lines, Ask::Nearest),
        RaysOf::Source(Source::Law(LineLaw::VolumeRay), Ask::Nearest),
        RaysOf::Source(Source::Objects, Ask::Nearest),
    ];
    rays.retain(|&set| check_scene(scene, &[set]).is_ok());
    if scene.look.is_some() {
        rays.extend(RayKind::ALL.map(RaysOf::Traced));
    }
    let (number, pixels) = if quick { (1 << 13, 64) } else { (1 << 16, 256) };
    Work {
        rays,
        number,
        error: None,
        pixels,
        own,
    }
}
