//! What is claimed of all scenes together.

use convergence_study::study::levels::completion;
use convergence_study::study::{Check, Outcome, Quantity, Ran};

use super::{BATCH, Batch, Ends, RandomScenes, Worst, report};
use crate::kinds::watch::{CLOSED, of_allowed};

/// Share of the scenes that may be exceptions.
const RARE: f64 = 2e-3;

/// Sums and maxima over all batches.
pub(super) struct Total {
    pub(super) scenes: usize,
    pub(super) ends: Ends,
    refused: usize,
    steps: usize,
    not_finite_levels: usize,
    exceptions: usize,
    worst: Worst,
}

impl Total {
    fn of(study: &RandomScenes, batches: &[&Batch]) -> Self {
        let sum = |number: fn(&Batch) -> usize| batches.iter().map(|batch| number(batch)).sum::<usize>();
        Self {
            scenes: study.batches * BATCH,
            ends: batches.iter().fold(Ends::default(), |sum, batch| sum.sum(batch.ends)),
            refused: sum(|batch| batch.refused),
            steps: sum(|batch| batch.steps),
            not_finite_levels: sum(|batch| batch.not_finite_levels),
            exceptions: sum(|batch| batch.exceptions),
            worst: batches.iter().fold(Worst::NONE, |worst, batch| worst.max(batch.worst)),
        }
    }
}

pub(super) fn judge(study: &RandomScenes, ran: &[Ran<usize, Batch>]) -> Outcome {
    let batches: Vec<&Batch> = ran.iter().filter_map(Ran::ok).collect();
    let total = Total::of(study, &batches);
    let Total { scenes, ends, steps, exceptions, worst, .. } = &total;
    let checks = [vec![completion(ran, not_finite)], claims(&total)].concat();
    let others = ends.iteration_limit + ends.not_finite;
    let summary = format!(
        "{scenes} scenes, {steps} steps: {} solved, {} refused (operator not definite), {} other failures; residual at most \
         {:.1e} of the energy, {exceptions} above {CLOSED:.0e}",
        ends.answers, ends.indefinite, others, worst.residual,
    );
    let headline = format!(
        "{scenes} scenes: {} solved, {} refused (operator not definite){}; largest residual {:.1e} of the energy",
        ends.answers,
        ends.indefinite,
        if others > 0 { format!(", {others} other failures") } else { String::new() },
        worst.residual,
    );
    Outcome {
        headline,
        tables: vec![report::counts(&total.ends), report::exceptions(study, &batches)],
        figures: vec![report::figure(&study.header.id, &batches)],
        quantities: vec![
            // A scene at the limit of definiteness may fall to either side on another machine.
            Quantity { name: "answers".to_owned(), value: ends.answers as f64, tolerance: 1e-3 },
        ],
        ..Outcome::new(summary, vec![], checks)
    }
}

fn not_finite(batch: &Batch) -> Vec<String> {
    let Worst { residual, rise, open, risen } = batch.worst;
    let numbers =
        [("residual", residual), ("rise", rise), ("residual over its bound", open), ("rise over its bound", risen)];
    numbers.iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| (*name).to_owned()).collect()
}

fn claims(total: &Total) -> Vec<Check> {
    let Total { scenes, ends, refused, not_finite_levels, exceptions, worst, .. } = total;
    let ended = ends.answers + ends.errors();
    let others = ends.iteration_limit + ends.not_finite;
    vec![
        Check::that(
            ended == *scenes && *not_finite_levels == 0,
            "every scene is solved with finite numbers, or refused with a stated reason",
            format!("{ended} of {scenes} ended, {not_finite_levels} levels with a number that is not finite"),
        ),
        Check::that(
            *refused == 0 && others == 0,
            "a step is refused for an indefinite operator only, and never where β > -B (1 + 2ζ/dt)",
            format!("{refused} definite operators refused, {others} other failures"),
        ),
        Check::that(
            worst.risen <= 1.0,
            "the energy never rises by more than the bound on rounding errors",
            format!("largest rise {:.1e} of the energy, {}", worst.rise, of_allowed(worst.risen)),
        ),
        Check::that(
            worst.open <= 1.0,
            "the balance closes to 1e-12 of the energy, or to the bound on rounding errors",
            format!("largest residual {:.1e} of the energy, {}", worst.residual, of_allowed(worst.open)),
        ),
        Check::that(
            *exceptions as f64 <= RARE * *scenes as f64,
            "at most 2 scenes in 1000 have a residual above 1e-12 of the energy",
            format!("{exceptions} of {scenes} scenes"),
        ),
    ]
}
