//! Which terms a model of the time needs: one after the other, as long as the error on scenes left out falls by more than one
//! standard error.

use crate::study::records::{ChoiceRecord, ModelRecord};

use super::fit::{Fitter, Model};
use super::terms::{CANDIDATES, Candidate, Term};

/// The name of the model that results.
pub const CHOSEN: &str = ModelRecord::CHOSEN;

/// Choose terms from all scenes but `out`; each step is told.
pub fn choose(fitter: &Fitter, out: &[usize], mut told: impl FnMut(ChoiceRecord)) -> Model {
    let mut model = Model::of(CHOSEN, &[Term::Inner, Term::Test]);
    let mut left: Vec<&Candidate> = CANDIDATES.iter().collect();
    let folds: Vec<Vec<usize>> = fitter.others(out).map(|scene| vec![scene]).collect();
    let errors_of = |model: &Model| {
        let predicted = fitter.left_out(out, &folds, |_| model.clone());
        fitter.errors(&predicted, out)
    };
    let mut errors = errors_of(&model);
    for step in 1.. {
        let tried: Vec<(Model, Vec<f64>, [f64; 2])> = left
            .iter()
            .map(|candidate| {
                let with = with(&model, candidate);
                let after = errors_of(&with);
                let gain = gain(&errors, &after);
                (with, after, gain)
            })
            .collect();
        let gains = (0..tried.len()).filter(|&one| tried[one].2[0] > tried[one].2[1]);
        let taken = gains.max_by(|&a, &b| tried[a].2[0].total_cmp(&tried[b].2[0]));
        for (number, (candidate, (_, after, [gain, se]))) in left.iter().zip(&tried).enumerate() {
            told(ChoiceRecord {
                step,
                candidate: candidate.name.into(),
                error_before: mean(&errors),
                error_after: mean(after),
                gain: *gain,
                gain_se: *se,
                taken: taken == Some(number),
            });
        }
        let Some(taken) = taken else {
            break;
        };
        (model, errors) = (tried[taken].0.clone(), tried[taken].1.clone());
        left.remove(taken);
    }
    model
}

fn with(model: &Model, candidate: &Candidate) -> Model {
    let kept = model
        .terms
        .iter()
        .filter(|term| !candidate.replaces.contains(term));
    Model {
        terms: kept.chain(candidate.adds).copied().collect(),
        ..model.clone()
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Mean over scenes of what the error falls by, and its standard error.
fn gain(before: &[f64], after: &[f64]) -> [f64; 2] {
    let gains: Vec<f64> = before.iter().zip(after).map(|(b, a)| b - a).collect();
    let n = gains.len() as f64;
    let middle = mean(&gains);
    let squares: f64 = gains
        .iter()
        .map(|gain| (gain - middle) * (gain - middle))
        .sum();
    [middle, (squares / (n - 1.0).max(1.0) / n).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::super::fit::tests::{rows, trees};
    use super::*;

    #[test]
    fn the_term_that_made_the_times_is_chosen_and_no_other() {
        let trees = trees(0.02);
        let rows = rows(&trees);
        let fitter = Fitter::new(&rows);
        for out in [&[][..], &[2]] {
            let mut steps = Vec::new();
            let model = choose(&fitter, out, |row| steps.push(row));
            let taken: Vec<_> = steps.iter().filter(|s| s.taken).collect();
            assert_eq!(taken[0].candidate, "mispredicted branches");
            assert!(model.terms.contains(&Term::Surprise));
            // What is taken after it gains next to nothing.
            assert!(taken[1..].iter().all(|s| s.gain < 0.002), "{taken:?}");
            assert!(taken[0].gain > 4.0 * taken[0].gain_se && taken[0].error_after < 0.02);
        }
    }

    #[test]
    fn gains_have_the_standard_error_of_their_mean() {
        let [gain, se] = gain(&[0.5, 0.4, 0.3], &[0.2, 0.3, 0.1]);
        // Gains 0.3, 0.1, 0.2: mean 0.2, deviation 0.1.
        assert!((gain - 0.2).abs() < 1e-15 && (se - 0.1 / 3.0_f64.sqrt()).abs() < 1e-15);
    }
}
