//! The errors of a scene's numbers: their differences to a run of any order whose own error is at
//! most a tenth of them.
//!
//! What to refine first is measured as well: the scene is run with only space refined and with only
//! steps refined, and both runs are compared with the same reference. A one-step scheme gets twice
//! the elements or dt/2, dG gets p + 4 or halved steps. No rate is assumed: if impacts make errors
//! fall irregularly, the table shows it.

use std::fmt;

use serde::Serialize;

use super::curves::{CurveRows, Curves, Wanted, curves};
use super::data::Data;
use super::first::first;
use super::policy::Policy;
use super::reference::{Reference, reference};
use super::{StopReason, Unreachable, Work};
use crate::error::reference::distance_of_curves;
use crate::scene::Scene;

/// Error of the first reference, in units of the largest value of a curve.
const ROUGH: f64 = 1e-4;

/// Allowed error of the reference, relative to the error that it measures.
const TENTH: f64 = 0.1;

/// Allowed error of any reference, in units of the largest value of a curve: round-off.
const FLOOR: f64 = 1e-11;

/// Maximum number of references, each at least ten times better than the last.
const ROUNDS: usize = 8;

/// A finer run whose error is this many times the total contradicts it: less may be due to errors
/// of space and time that cancel.
const CONTRADICTION: f64 = 10.0;

/// Refinement pays if it removes at least this part of the error.
const GAIN: f64 = 0.1;

/// The source of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// Elements and their degree.
    Space,
    /// Steps and their degree.
    Time,
}

/// The kind of quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum QuantityKind {
    /// A curve: the largest error over time; for dG also inside steps, for a one-step scheme at its
    /// time levels.
    Curve,
    /// The largest value of u(1, t).
    Largest,
    /// The smallest.
    Smallest,
    /// The value of a curve at the end.
    End,
}

/// The error in one number or curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// Name of the quantity.
    pub name: &'static str,
    /// A number or a curve.
    pub kind: QuantityKind,
    /// The number itself, or the largest absolute value of a curve.
    pub value: f64,
    /// The error: the difference to the reference, plus the reference's own error.
    pub total: f64,
    /// The reference's own error.
    pub reference: f64,
    /// The error with only space refined; `None` if that run failed.
    pub finer_space: Option<f64>,
    /// The error with only steps refined.
    pub finer_steps: Option<f64>,
}

/// The errors in the numbers of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Budget {
    /// What to refine first; `None` if refining only one lowers no error.
    pub dominant: Option<Source>,
    /// The same in a sentence.
    pub advice: String,
    /// One for each number or curve.
    pub quantities: Vec<Estimate>,
}

/// A number or curve whose error is estimated.
struct Observable {
    name: &'static str,
    kind: QuantityKind,
    /// The curve that it is, or belongs to.
    curve: usize,
}

impl Observable {
    const ALL: [Self; 8] = [
        Self::new("u(1) at the end", QuantityKind::End, 0),
        Self::new("largest u(1)", QuantityKind::Largest, 0),
        Self::new("smallest u(1)", QuantityKind::Smallest, 0),
        Self::new("u(1) over time", QuantityKind::Curve, 0),
        Self::new("phi(1) at the end", QuantityKind::End, 1),
        Self::new("phi(1) over time", QuantityKind::Curve, 1),
        Self::new("energy at the end", QuantityKind::End, 2),
        Self::new("energy over time", QuantityKind::Curve, 2),
    ];

    const fn new(name: &'static str, kind: QuantityKind, curve: usize) -> Self {
        Self { name, kind, curve }
    }

    /// Compares a run with the reference.
    fn compare(&self, own: &Curves, exact: &Curves) -> ReferenceDifference {
        let curve = own.column(self.curve);
        let truth = exact.column(self.curve);
        let (value, truth) = match self.kind {
            QuantityKind::Curve => {
                return ReferenceDifference {
                    value: largest(&curve),
                    difference: distance_of_curves(&curve, &truth),
                };
            }
            QuantityKind::Largest => (own.range.high, exact.range.high),
            QuantityKind::Smallest => (own.range.low, exact.range.low),
            QuantityKind::End => (last(&curve), last(&truth)),
        };
        ReferenceDifference {
            value,
            difference: (value - truth).abs(),
        }
    }
}

/// The value of a number or curve, and its difference to the reference.
struct ReferenceDifference {
    value: f64,
    difference: f64,
}

/// Estimates the errors of a scene by any method.
///
/// # Errors
/// [`Unreachable`]: the scene's own run fails, no reference is accurate enough, or a finer run
/// contradicts it.
pub fn estimate(scene: &Scene, work: &mut Work<'_>) -> Result<Budget, Unreachable> {
    let own = curves(scene, &CurveRows::Numbers, None, work).map_err(Unreachable::Own)?;
    let times = own.own_times();
    let Truth { reference, exact } = against(scene, &own, &times, work)?;
    let finer = Policy::default()
        .finer(scene)
        .map(|finer| curves(&finer?, &CurveRows::Numbers, Some(&times), work));
    let mut quantities = vec![];
    for observable in Observable::ALL {
        let ReferenceDifference { value, difference } = observable.compare(&own, &exact);
        let error = if observable.kind == QuantityKind::End {
            reference.end * largest(&exact.column(observable.curve))
        } else {
            reference.error(observable.curve)
        };
        let [finer_space, finer_steps] = finer.each_ref().map(|run| {
            let run = run.as_ref().ok()?;
            Some(observable.compare(run, &exact).difference + error)
        });
        quantities.push(Estimate {
            name: observable.name,
            kind: observable.kind,
            value,
            total: difference + error,
            reference: error,
            finer_space,
            finer_steps,
        });
    }
    contradiction(&quantities).map_or(Ok(()), Err)?;
    let dominant = dominant(&quantities);
    Ok(Budget {
        dominant,
        advice: advice(scene, dominant).to_owned(),
        quantities,
    })
}

/// A reference, and its curves at the scene's times.
struct Truth {
    reference: Reference,
    exact: Curves,
}

impl Truth {
    /// Whether its own error is at most this part of the scene's in every curve, or round-off.
    fn is_within(&self, part: f64, errors: &[f64; 3], scales: &[f64; 3]) -> bool {
        (0..3).all(|k| self.reference.error(k) <= (part * errors[k]).max(FLOOR * scales[k]))
    }
}

/// A reference whose own error is at most a tenth of the scene's in every curve.
///
/// The reference is improved until it qualifies; otherwise the last one is taken if its error does
/// not exceed the scene's.
fn against(
    scene: &Scene,
    own: &Curves,
    times: &[f64],
    work: &mut Work<'_>,
) -> Result<Truth, Unreachable> {
    let scales = scales(scene, own, times, work)?;
    let mut wanted = Wanted {
        rows: CurveRows::Numbers,
        tolerance: scales.map(|scale| ROUGH * scale),
    };
    let policy = Policy::default();
    // The last reference, and the scene's errors measured against it.
    let mut last: Option<(Truth, [f64; 3])> = None;
    for _ in 0..ROUNDS {
        let start = last.as_ref().map(|(truth, _)| &truth.reference.scene);
        let outcome = reference(scene, start, &wanted, &policy, work).and_then(|reference| {
            let exact = curves(&reference.scene, &CurveRows::Numbers, Some(times), work)
                .map_err(|reason| Unreachable::without_comparison(wanted.tolerance[0], reason))?;
            Ok(Truth { reference, exact })
        });
        let truth = match (outcome, last) {
            (Ok(truth), _) => truth,
            (Err(_), Some((truth, errors))) if truth.is_within(1.0, &errors, &scales) => {
                return Ok(truth);
            }
            (Err(error), _) => return Err(error),
        };
        let errors: [f64; 3] =
            std::array::from_fn(|k| distance_of_curves(&own.column(k), &truth.exact.column(k)));
        if truth.is_within(TENTH, &errors, &scales) {
            return Ok(truth);
        }
        for (k, tolerance) in wanted.tolerance.iter_mut().enumerate() {
            *tolerance = (TENTH * errors[k].max(TENTH * truth.reference.error(k)))
                .max(FLOOR * scales[k])
                .min(*tolerance);
        }
        last = Some((truth, errors));
    }
    Err(Unreachable::without_comparison(
        wanted.tolerance[0],
        StopReason::Rounds,
    ))
}

/// The largest value of each curve: that of the scene or, if its mesh may miss narrow features of
/// the initial data, of the first dG run on a mesh that resolves them.
fn scales(
    scene: &Scene,
    own: &Curves,
    times: &[f64],
    work: &mut Work<'_>,
) -> Result<[f64; 3], Unreachable> {
    let own_scales = largest_values(own);
    let wanted = Wanted {
        rows: CurveRows::Numbers,
        tolerance: [ROUGH; 3],
    };
    let data = Data::of(scene);
    let (first, is_narrow) = data.resolve(first(scene, &wanted, &data.kept), &wanted)?;
    if !is_narrow {
        return Ok(own_scales);
    }
    let rough = curves(&first, &CurveRows::Numbers, Some(times), work)
        .map_err(|reason| Unreachable::without_comparison(ROUGH, reason))?;
    let rough_scales = largest_values(&rough);
    Ok(std::array::from_fn(|k| own_scales[k].max(rough_scales[k])))
}

/// The largest absolute value of each curve, greater than 0.
fn largest_values(curves: &Curves) -> [f64; 3] {
    std::array::from_fn(|k| largest(&curves.column(k)).max(f64::MIN_POSITIVE))
}

fn largest(curve: &[f64]) -> f64 {
    distance_of_curves(curve, &vec![0.0; curve.len()])
}

fn last(curve: &[f64]) -> f64 {
    curve.last().copied().unwrap_or(f64::NAN)
}

/// A curve whose error grows much if only space or only steps are refined: single numbers may have
/// small errors by chance.
fn contradiction(quantities: &[Estimate]) -> Option<Unreachable> {
    for &Estimate {
        name,
        total,
        finer_space,
        finer_steps,
        ..
    } in curves_among(quantities)
    {
        for (finer, error) in [("a finer space", finer_space), ("finer steps", finer_steps)] {
            match error {
                Some(difference) if !(difference <= CONTRADICTION * total) => {
                    return Some(Unreachable::Contradicted {
                        name,
                        total,
                        finer,
                        difference,
                    });
                }
                _ => (),
            }
        }
    }
    None
}

/// The estimates of whole curves.
fn curves_among(quantities: &[Estimate]) -> impl Iterator<Item = &Estimate> {
    quantities
        .iter()
        .filter(|estimate| estimate.kind == QuantityKind::Curve)
}

/// The part of the curves' errors that a refinement removes, on average; `finer` gives the error
/// that it leaves.
fn mean_gain(quantities: &[Estimate], finer: fn(&Estimate) -> Option<f64>) -> f64 {
    let gains: Vec<f64> = curves_among(quantities)
        .map(|estimate| 1.0 - finer(estimate).unwrap_or(estimate.total) / estimate.total)
        .collect();
    gains.iter().sum::<f64>() / gains.len() as f64
}

/// The refinement that lowers the errors of the curves more; errors of single numbers may be small
/// by chance.
fn dominant(quantities: &[Estimate]) -> Option<Source> {
    let space = mean_gain(quantities, |estimate| estimate.finer_space);
    let time = mean_gain(quantities, |estimate| estimate.finer_steps);
    let (source, gain) = if space > time {
        (Source::Space, space)
    } else {
        (Source::Time, time)
    };
    (gain >= GAIN).then_some(source)
}

fn advice(scene: &Scene, dominant: Option<Source>) -> &'static str {
    match dominant {
        Some(Source::Space) => scene.method.finer_space(),
        Some(Source::Time) => scene.method.finer_time(),
        None => {
            "Neither alone lowers the errors: refine space and time together; if that does not help, take a smaller tolerance."
        }
    }
}

impl fmt::Display for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Errors, by a run of any order")?;
        writeln!(
            f,
            "{:<18}{:>20}{:>10}{:>12}{:>14}{:>14}",
            "", "value", "error", "of the run", "finer space", "finer steps"
        )?;
        for estimate in &self.quantities {
            let total = error_cell(Some(estimate.total));
            let reference = error_cell(Some(estimate.reference));
            let space = error_cell(estimate.finer_space);
            let steps = error_cell(estimate.finer_steps);
            writeln!(
                f,
                "{:<18}{:>20.12}{total:>10}{reference:>12}{space:>14}{steps:>14}",
                estimate.name, estimate.value
            )?;
        }
        writeln!(
            f,
            "The last two columns: the errors with a finer space alone (twice the elements, or p + 4), and with half the steps alone."
        )?;
        write!(f, "{}", self.advice)
    }
}

/// A cell of the table; a dash for a run that failed.
fn error_cell(error: Option<f64>) -> String {
    error.map_or_else(|| "-".to_owned(), |error| format!("{error:.1e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finer_run_that_contradicts_the_total_of_a_curve_is_refused_with_both_numbers() {
        let of = |kind, finer_space, finer_steps| Estimate {
            name: "energy over time",
            kind,
            value: 1.0,
            total: 4.3e-5,
            reference: 1e-6,
            finer_space,
            finer_steps,
        };
        let refused = |of| contradiction(&[of]).map(|error| error.to_string());
        assert_eq!(
            refused(of(QuantityKind::Curve, Some(4.2e-4), Some(4.2e-4))),
            None
        );
        assert_eq!(refused(of(QuantityKind::Curve, None, None)), None);
        // A single number may have a small error by chance.
        assert_eq!(refused(of(QuantityKind::End, Some(0.79), None)), None);
        for (finer_space, finer_steps, words) in [
            (Some(0.79), None, "a finer space"),
            (None, Some(0.79), "finer steps"),
        ] {
            let message = refused(of(QuantityKind::Curve, finer_space, finer_steps))
                .expect("a contradiction");
            assert!(
                message.contains("4.3e-5") && message.contains("7.9e-1") && message.contains(words),
                "{message}"
            );
        }
        assert!(refused(of(QuantityKind::Curve, Some(f64::NAN), None)).is_some());
    }
}
