//! Whether scrambled Sobol' lines do as well as expected.

use crate::study::records::{ErrorRecord, ExponentRecord, Verdict};

use super::Found;
use super::asked::SpeedVsError;
use super::errors::NODES;
use super::method::{Method, Way};

/// Each expectation of the samplers and what came of it; none where Sobol' lines are not among them.
pub fn verdicts(asked: &SpeedVsError, found: &[Found]) -> Vec<Verdict> {
    let Some((part, bounds)) = asked.samplers.as_ref().zip(asked.expect.sobol.as_ref()) else {
        return Vec::new();
    };
    let ways = Way::all(part);
    let Some(sobol) = ways.into_iter().find(|way| way.method == Method::Sobol) else {
        return Vec::new();
    };
    let judged = |scene: &String, sampler: &str, rays: &str| {
        bounds.scenes.contains(scene) && sampler == sobol.method.name() && rays == sobol.rays()
    };
    let errors = found.iter().flat_map(|f| &f.errors);
    let errors: Vec<&ErrorRecord> = errors
        .filter(|e| e.lines == part.to && judged(&e.scene, &e.sampler, &e.rays))
        .collect();
    let exponents = found.iter().flat_map(|f| &f.exponents);
    let exponents: Vec<&ExponentRecord> = exponents
        .filter(|e| e.quantity == "C" && judged(&e.scene, &e.sampler, &e.rays))
        .collect();

    let at = part.to;
    let nodes = errors.iter().filter(|e| e.quantity == NODES);
    let scaled = nodes.map(|e| {
        let root = (e.lines as f64).sqrt();
        (
            e.rmse * root,
            [e.rmse_lo * root, e.rmse_hi * root],
            &*e.scene,
        )
    });
    let gains = errors.iter().filter(|e| e.quantity == "C");
    let gains = gains.filter_map(|e| Some((e.gain?, [e.gain_lo?, e.gain_hi?], &*e.scene)));
    let falls = exponents
        .iter()
        .map(|e| (e.exponent, [e.exponent_lo, e.exponent_hi], &*e.scene));
    let (most, gain, exponent) = (bounds.nodes, bounds.gain, bounds.exponent);
    let verdict = |name: &str,
                   worst: Option<(f64, [f64; 2], &str)>,
                   held: &dyn Fn(f64) -> bool,
                   what: String| {
        worst.map(|(value, [lo, hi], scene)| Verdict {
            name: name.into(),
            held: held(value),
            message: format!("{what}: {value:.3}, 95 % {lo:.3} to {hi:.3} ({scene})"),
        })
    };
    let largest = scaled.max_by(|a, b| a.0.total_cmp(&b.0));
    let least_gain = gains.min_by(|a, b| a.0.total_cmp(&b.0));
    let least_fall = falls.min_by(|a, b| a.0.total_cmp(&b.0));
    [
        verdict(
            "sobol-nodes",
            largest,
            &|value| value <= most,
            format!(
                "NRMSE of the nodes times sqrt(N), scrambled Sobol', {at} lines, at most {most}"
            ),
        ),
        verdict(
            "sobol-gain",
            least_gain,
            &|value| value >= gain,
            format!(
                "mean square error of C, random over scrambled Sobol', {at} lines, at least {gain}"
            ),
        ),
        verdict(
            "sobol-fall",
            least_fall,
            &|value| value >= exponent,
            format!(
                "exponent of C's error, scrambled Sobol', up to {at} lines, at least {exponent}"
            ),
        ),
    ]
    .into_iter()
    .flatten()
    .collect()
}
