//! What is claimed of all scenes: the checks, and the figure.

use super::{
    Drawn, RandomErrors,
    measure::{AbandonedSearch, PredictedErrors},
};
use crate::kinds::prelude::*;
use convergence_judge::text::number::min_or_nan;
use convergence_study::internal::{
    plots::{self, xy::Xy},
    study::readings,
};

/// An error may be this many times its estimate.
const EXCEEDED: f64 = 1.3;

/// Required ratio of linear elements' errors for four times the elements and steps: contact costs
/// first order.
const FALL: f64 = 4.0;

impl RandomErrors {
    pub(super) fn checks(
        &self,
        ran: &[Ran<Drawn, PredictedErrors>],
        found: &[(&Ran<Drawn, PredictedErrors>, &PredictedErrors)],
    ) -> Vec<Check> {
        let mut checks = vec![completion_check(ran, |found| {
            readings::not_finite(&found.readings())
        })];
        checks.extend(self.of_errors(found));
        checks.extend(of_refusals(found));
        if self.refined > 0 {
            checks.push(of_linear_elements(found));
        }
        checks
    }

    /// Errors against estimates and targets.
    fn of_errors(&self, found: &[(&Ran<Drawn, PredictedErrors>, &PredictedErrors)]) -> [Check; 3] {
        let [over_estimate, over_target, over_norm_target] = worst(found).unwrap_or([f64::NAN; 3]);
        [
            Check::that(
                over_estimate <= EXCEEDED && !found.is_empty(),
                format!("no error of a number exceeds {EXCEEDED} times its estimate"),
                format!(
                    "the largest is {over_estimate:.2} of its estimate, of {} numbers",
                    8 * found.len()
                ),
            )
            .about(Subject::of("estimates")),
            Check::that(
                over_target <= 1.0 && !found.is_empty(),
                "no chosen run misses its target error",
                format!(
                    "the largest is {over_target:.2} of it, of {} runs",
                    self.targets.len() * found.len()
                ),
            )
            .about(Subject::of("target errors")),
            Check::that(
                over_norm_target <= 1.0 && !found.is_empty(),
                "no chosen run misses its target error in the norm of Theorem 3.4",
                format!("the largest is {over_norm_target:.2} of it"),
            )
            .about(Subject::of("target errors in the norm")),
        ]
    }

    pub(super) fn figure(
        &self,
        found: &[(&Ran<Drawn, PredictedErrors>, &PredictedErrors)],
    ) -> Figure {
        let mut points: Vec<(f64, f64)> = found
            .iter()
            .map(|(_, found)| (found.work, found.over_target))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let work = "work of a scene's searches (unknowns times solves)";
        let series = [plots::Series::new("random scenes", points)];
        let drawn = Xy {
            guides: vec![plots::Guide {
                label: "target".to_owned(),
                value: 1.0,
            }],
            ..plots::work_precision(work, "largest error of u(1, t) / target error", &series)
        };
        let caption = "Largest errors of the runs chosen for random scenes, in units of their target errors: all below 1.";
        Figure::new(
            "errors",
            caption,
            drawn
                .scattered()
                .titled("Every error stays below its target")
                .draw(),
        )
    }
}

/// The largest errors in units of their estimates, of the targets, and of those in the norm; `None`
/// without a scene.
pub(super) fn worst(
    found: &[(&Ran<Drawn, PredictedErrors>, &PredictedErrors)],
) -> Option<[f64; 3]> {
    let of: [fn(&PredictedErrors) -> f64; 3] = [
        |found| found.over_estimate,
        |found| found.over_target,
        |found| found.over_norm_target,
    ];
    let largest = of.map(|of| {
        found
            .iter()
            .map(|(_, found)| of(found))
            .fold(0.0, max_or_nan)
    });
    (!found.is_empty()).then_some(largest)
}

/// Searches of smooth data end with a run, those of rough data may be refused.
fn of_refusals(found: &[(&Ran<Drawn, PredictedErrors>, &PredictedErrors)]) -> [Check; 2] {
    let refused = refusals(found, false);
    let rough = refusals(found, true);
    [
        Check::that(
            refused.is_empty(),
            "every search of smooth data ends with a run",
            in_words(&refused),
        )
        .about(Subject::of("refused searches")),
        Check::that(
            rough.iter().all(|(_, refusal)| refusal.is_of_features),
            "a search of rough data is refused only where no mesh resolves them, or because a finer run contradicts it",
            format!("{} searches refused: {}", rough.len(), in_words(&rough)),
        )
        .about(Subject::of("refused searches of rough data")),
    ]
}

/// Linear elements and small steps tend to the chosen motion.
fn of_linear_elements(found: &[(&Ran<Drawn, PredictedErrors>, &PredictedErrors)]) -> Check {
    let falls: Vec<f64> = found
        .iter()
        .filter_map(|(_, of)| of.linear.map(|[coarse, fine]| coarse / fine))
        .collect();
    let least = falls.iter().copied().fold(f64::INFINITY, min_or_nan);
    Check::that(
        least >= FALL && !falls.is_empty(),
        format!(
            "linear elements and steps of midpoint tend to the same motion: their error falls {FALL} times or more"
        ),
        format!(
            "with four times of both it falls at least {least:.1} times, of {} scenes",
            falls.len()
        ),
    )
    .about(Subject::of("linear elements"))
}

/// Why searches of smooth, or of rough, data were refused.
fn refusals<'r>(
    found: &[(&'r Ran<Drawn, PredictedErrors>, &'r PredictedErrors)],
    is_rough: bool,
) -> Vec<(&'r str, &'r AbandonedSearch)> {
    let of = found
        .iter()
        .filter(|(_, found)| found.may_be_refused == is_rough);
    of.flat_map(|(ran, found)| {
        let refused = found.refused.iter();
        refused.map(|refusal| (ran.case.label.as_str(), refusal))
    })
    .collect()
}

fn in_words(refusals: &[(&str, &AbandonedSearch)]) -> String {
    refusals
        .iter()
        .map(|(scene, refusal)| format!("{scene}, {}", refusal.words))
        .collect::<Vec<_>>()
        .join("; ")
}
