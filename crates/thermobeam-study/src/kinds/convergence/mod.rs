//! Convergence studies: a manufactured solution, levels of refinement, orders expected.
//!
//! Three shapes, by what `[refine]` says: one axis, a path on which both are refined together (h = dt), or the full grid
//! of (h, dt), to which `e² = (C_h h^p)² + (C_t dt^q)²` is fitted. The step of a level is 1/n, the mean mesh width, or dt.

mod figures;
pub mod file;
mod grid;

use crate::error::design::{Disagreement, Prepared};
use crate::kinds::convergence::file::{CONVERGENCE, ConvergenceSpec};
use crate::kinds::tables::{Expectation, Norm};
use crate::kinds::untyped::{Case, Measured};
use crate::kinds::{FromFile, Study};
use convergence_study::input::InputError;
use convergence_study::judge::verdict::{Judge, Level, RateVerdict, Reason, Verdict};
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{LevelErrors, Outcome, Quantity};
use convergence_study::study::{Axis, Header};
use std::path::Path;

/// Relative change of an error that the baseline tolerates: the solver's tolerance and the instructions of another
/// machine move errors by less, a change of the scheme by more.
const ERROR_TOLERANCE: f64 = 1e-4;

/// A convergence study, ready to run.
pub struct Convergence {
    header: Header,
    spec: ConvergenceSpec,
}

impl FromFile for Convergence {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        Ok(Self::new(ConvergenceSpec::parse(text, &file.display().to_string())?))
    }
}

impl Convergence {
    /// The study of a specification.
    pub fn new(spec: ConvergenceSpec) -> Self {
        let header = Header {
            id: spec.id.clone(),
            claim: spec.claim.clone(),
            tier: spec.tier,
            kind: CONVERGENCE.to_owned(),
            group: spec.group.clone(),
        };
        Self { header, spec }
    }

    /// Errors of each level in each norm; NaN where the case failed, so that it cannot pass.
    fn levels(&self, results: &[Result<Measured, CaseFailure>]) -> Vec<LevelErrors> {
        let cases = self.spec.refine.cases();
        cases
            .iter()
            .zip(results)
            .map(|(&(elements, steps), result)| {
                let error = |norm: Norm| result.as_ref().map_or(f64::NAN, |measured| measured.value(norm.name()));
                let errors = Norm::ALL.map(|norm| (norm.name().to_owned(), error(norm))).to_vec();
                LevelErrors { parameters: resolution(elements, steps), errors }
            })
            .collect()
    }

    /// Judges the errors of one norm over the levels.
    fn judge(&self, levels: &[LevelErrors], expectation: &Expectation) -> RateVerdict {
        let Expectation { norm, order, tolerance } = *expectation;
        let points: Vec<Level> = levels
            .iter()
            .map(|level| Level {
                step: step(&self.spec, elements_of(level), steps_of(level)),
                error: level.error(norm.name()),
            })
            .collect();
        match Judge::new(tolerance) {
            Ok(judge) => judge.judge(&points, order),
            // Refused by the reader of study files already; whoever builds a specification by hand is told here.
            Err(error) => RateVerdict {
                order,
                tolerance,
                pairwise: vec![],
                fitted: None,
                interval: None,
                extrapolated: None,
                used: 0..0,
                set_aside: vec![],
                verdict: Verdict::Inconclusive,
                kind: Reason::ToleranceTooWide,
                reason: error.to_string(),
            },
        }
    }
}

/// Elements and steps as the parameters of a level.
pub(crate) fn resolution(elements: usize, steps: usize) -> Vec<(String, f64)> {
    [("elements", elements), ("steps", steps)].map(|(name, count)| (name.to_owned(), count as f64)).into()
}

fn elements_of(level: &LevelErrors) -> usize {
    level.parameter("elements").unwrap_or(f64::NAN) as usize
}

fn steps_of(level: &LevelErrors) -> usize {
    level.parameter("steps").unwrap_or(f64::NAN) as usize
}

/// The step of a level: 1/n, the mean mesh width, or dt where time alone is refined.
pub(crate) fn step(spec: &ConvergenceSpec, elements: usize, steps: usize) -> f64 {
    match spec.refine.axis {
        Axis::Space | Axis::Both => 1.0 / elements as f64,
        Axis::Time => spec.refine.dt(steps),
    }
}

impl Study for Convergence {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let label = |(n, steps): &(usize, usize)| format!("n = {n}, {steps} steps");
        let case = |case: &(usize, usize)| Case { label: label(case), cost: case.0 as f64 * (case.1 as f64 + 50.0) };
        self.spec.refine.cases().iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let (elements, steps) = self.spec.refine.cases()[index];
        let (beam, obstacles) = self.spec.solver_coefficients();
        let errors = Prepared::new(&self.spec, elements)?.run(steps, Disagreement { beam, obstacles, defect: None })?;
        let mut measured = Measured::default();
        for (norm, error) in Norm::ALL.into_iter().zip(errors) {
            measured.push(norm.name(), error);
        }
        Ok(measured)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let levels = self.levels(results);
        let failures: Vec<String> = self
            .cases()
            .iter()
            .zip(results)
            .filter_map(|(case, result)| {
                result.as_ref().err().map(|failure| format!("{}: {}", case.label, failure.reason))
            })
            .collect();
        let mut outcome =
            if self.spec.refine.grid { grid::conclude(&self.spec, &levels) } else { self.conclude_path(&levels) };
        if !failures.is_empty() {
            outcome.verdict = Verdict::Fail;
            outcome.summary = format!(
                "{}; {} of {} cases failed: {}",
                outcome.summary,
                failures.len(),
                results.len(),
                failures.join("; ")
            );
        }
        outcome.quantities.extend(guarded_errors(&levels));
        outcome.levels = levels;
        outcome
    }
}

impl Convergence {
    fn conclude_path(&self, levels: &[LevelErrors]) -> Outcome {
        let rates: Vec<(String, RateVerdict)> =
            self.spec.expect.iter().map(|e| (e.norm.name().to_owned(), self.judge(levels, e))).collect();
        let mut outcome = Outcome::new(summary(&rates), rates, vec![]);
        for (norm, rate) in &outcome.rates {
            if let Some(fitted) = rate.fitted {
                let name = format!("rate {norm}");
                outcome.quantities.push(Quantity { name, value: fitted, tolerance: ERROR_TOLERANCE });
            }
        }
        outcome.figures.push(figures::rates(&self.spec, levels, &outcome.rates, |level| {
            step(&self.spec, elements_of(level), steps_of(level))
        }));
        outcome
    }
}

/// The worst rate in a sentence.
fn summary(rates: &[(String, RateVerdict)]) -> String {
    let worst = Verdict::worst(rates.iter().map(|(_, rate)| rate.verdict));
    let list: Vec<String> = rates
        .iter()
        .filter(|(_, rate)| worst == Verdict::Pass || rate.verdict != Verdict::Pass)
        .map(|(norm, rate)| {
            let found = rate.fitted.map_or("no rate".to_owned(), |fitted| format!("{fitted:.4}"));
            if worst == Verdict::Pass {
                format!("{norm} {found} (order {})", rate.order)
            } else {
                format!("{norm} {found} (order {}): {}", rate.order, rate.reason)
            }
        })
        .collect();
    list.join("; ")
}

fn guarded_errors(levels: &[LevelErrors]) -> Vec<Quantity> {
    levels
        .iter()
        .flat_map(|level| {
            level.errors.iter().map(|(norm, value)| Quantity {
                name: format!("error {norm}, n = {}, {} steps", elements_of(level), steps_of(level)),
                value: *value,
                tolerance: ERROR_TOLERANCE,
            })
        })
        .collect()
}
