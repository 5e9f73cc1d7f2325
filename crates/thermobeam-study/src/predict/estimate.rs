//! The errors of a scene's numbers: their differences to a run of any order whose own error is at
//! most a tenth of them.
//!
//! What to refine first is measured as well: the scene is run with only space refined and with only
//! steps refined, and both runs are compared with the same reference. A one-step scheme gets twice
//! the elements or dt/2, dG gets p + 4 or halved steps. No rate is assumed: if impacts make errors
//! fall irregularly, the table shows it.

use std::fmt;

use serde::Serialize;

use super::curves::{Curves, Rows, Wanted, curves};
use super::data::Data;
use super::first::first;
use super::reference::{Reference, reference};
use super::refine::finer;
use super::{Reason, Unreachable, Work};
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
pub enum Kind {
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
    pub kind: Kind,
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

const OBSERVABLES: [(&str, Kind, usize); 8] = [
    ("u(1) at the end", Kind::End, 0),
    ("largest u(1)", Kind::Largest, 0),
    ("smallest u(1)", Kind::Smallest, 0),
    ("u(1) over time", Kind::Curve, 0),
    ("phi(1) at the end", Kind::End, 1),
    ("phi(1) over time", Kind::Curve, 1),
    ("energy at the end", Kind::End, 2),
    ("energy over time", Kind::Curve, 2),
];

/// Estimates the errors of a scene by any method.
///
/// # Errors
/// [`Unreachable`]: the scene's own run fails, no reference is accurate enough, or a finer run
/// contradicts it.
pub fn estimate(scene: &Scene, work: &mut Work<'_>) -> Result<Budget, Unreachable> {
    let own = curves(scene, &Rows::Numbers, None, work).map_err(Unreachable::Own)?;
    let times = own.own_times();
    let (reference, exact) = against(scene, &own, &times, work)?;
    let finer = finer(scene).map(|finer| curves(&finer?, &Rows::Numbers, Some(&times), work));
    let quantities: Vec<Estimate> = OBSERVABLES
        .iter()
        .map(|&(name, kind, k)| {
            let (value, difference) = measured(kind, k, &own, &exact);
            let error = if kind == Kind::End {
                reference.end * largest(&exact.column(k))
            } else {
                reference.error(k)
            };
            let [finer_space, finer_steps] = finer.each_ref().map(|run| {
                run.as_ref()
                    .ok()
                    .map(|run| measured(kind, k, run, &exact).1 + error)
            });
            Estimate {
                name,
                kind,
                value,
                total: difference + error,
                reference: error,
                finer_space,
                finer_steps,
            }
        })
        .collect();
    contradiction(&quantities).map_or(Ok(()), Err)?;
    let dominant = dominant(&quantities);
    Ok(Budget {
        dominant,
        advice: advice(scene, dominant).to_owned(),
        quantities,
    })
}

/// A reference whose own error is at most a tenth of the scene's in every curve, and its curves at
/// the scene's times.
///
/// The reference is improved until it qualifies; otherwise the last one is taken if its error does
/// not exceed the scene's.
fn against(
    scene: &Scene,
    own: &Curves,
    times: &[f64],
    work: &mut Work<'_>,
) -> Result<(Reference, Curves), Unreachable> {
    let scales = scales(scene, own, times, work)?;
    let mut wanted = Wanted {
        rows: Rows::Numbers,
        tolerance: scales.map(|scale| ROUGH * scale),
    };
    let mut held: Option<(Reference, Curves, [[f64; 2]; 3])> = None;
    let fits = |errors: &[[f64; 2]; 3], part: f64| {
        errors
            .iter()
            .zip(scales)
            .all(|([made, its], scale)| *its <= (part * made).max(FLOOR * scale))
    };
    for _ in 0..ROUNDS {
        let start = held.as_ref().map(|(reference, ..)| &reference.scene);
        let found = reference(scene, start, &wanted, work).and_then(|reference| {
            let curves = curves(&reference.scene, &Rows::Numbers, Some(times), work);
            curves
                .map(|curves| (reference, curves))
                .map_err(|reason| Unreachable::without_comparison(wanted.tolerance[0], reason))
        });
        let (reference, exact) = match (found, held) {
            (Ok(found), _) => found,
            (Err(_), Some((reference, exact, errors))) if fits(&errors, 1.0) => {
                return Ok((reference, exact));
            }
            (Err(error), _) => return Err(error),
        };
        let errors = std::array::from_fn(|k| {
            [
                distance_of_curves(&own.column(k), &exact.column(k)),
                reference.error(k),
            ]
        });
        if fits(&errors, TENTH) {
            return Ok((reference, exact));
        }
        for (tolerance, ([made, its], scale)) in
            wanted.tolerance.iter_mut().zip(errors.iter().zip(scales))
        {
            *tolerance = (TENTH * made.max(TENTH * its))
                .max(FLOOR * scale)
                .min(*tolerance);
        }
        held = Some((reference, exact, errors));
    }
    Err(Unreachable::without_comparison(
        wanted.tolerance[0],
        Reason::Rounds,
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
    let largest_of = |curves: &Curves| {
        std::array::from_fn(|k| largest(&curves.column(k)).max(f64::MIN_POSITIVE))
    };
    let of_own: [f64; 3] = largest_of(own);
    let wanted = Wanted {
        rows: Rows::Numbers,
        tolerance: [ROUGH; 3],
    };
    let data = Data::of(scene);
    let (first, is_narrow) = data.resolve(first(scene, &wanted, &data.kept), &wanted)?;
    if !is_narrow {
        return Ok(of_own);
    }
    let rough = curves(&first, &Rows::Numbers, Some(times), work)
        .map_err(|reason| Unreachable::without_comparison(ROUGH, reason))?;
    let of_rough: [f64; 3] = largest_of(&rough);
    Ok(std::array::from_fn(|k| of_own[k].max(of_rough[k])))
}

fn largest(curve: &[f64]) -> f64 {
    distance_of_curves(curve, &vec![0.0; curve.len()])
}

/// The value of a number or curve, and its difference to the reference.
fn measured(kind: Kind, k: usize, own: &Curves, exact: &Curves) -> (f64, f64) {
    let [curve, truth] = [own, exact].map(|run| run.column(k));
    let last = |curve: &[f64]| curve.last().copied().unwrap_or(f64::NAN);
    let (value, truth) = match kind {
        Kind::Curve => return (largest(&curve), distance_of_curves(&curve, &truth)),
        Kind::Largest => (own.range[1], exact.range[1]),
        Kind::Smallest => (own.range[0], exact.range[0]),
        Kind::End => (last(&curve), last(&truth)),
    };
    (value, (value - truth).abs())
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
    } in quantities.iter().filter(|of| of.kind == Kind::Curve)
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

/// The refinement that lowers the errors of the curves more; errors of single numbers may be small
/// by chance.
fn dominant(quantities: &[Estimate]) -> Option<Source> {
    let gain = |finer: fn(&Estimate) -> Option<f64>| -> f64 {
        let curves = quantities.iter().filter(|of| of.kind == Kind::Curve);
        let gains: Vec<f64> = curves
            .map(|of| 1.0 - finer(of).unwrap_or(of.total) / of.total)
            .collect();
        gains.iter().sum::<f64>() / gains.len() as f64
    };
    let (space, time) = (gain(|of| of.finer_space), gain(|of| of.finer_steps));
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
        let cell = |error: Option<f64>| {
            error.map_or_else(|| "-".to_owned(), |error| format!("{error:.1e}"))
        };
        writeln!(f, "Errors, by a run of any order")?;
        writeln!(
            f,
            "{:<18}{:>20}{:>10}{:>12}{:>14}{:>14}",
            "", "value", "error", "of the run", "finer space", "finer steps"
        )?;
        for of in &self.quantities {
            let cells = [
                Some(of.total),
                Some(of.reference),
                of.finer_space,
                of.finer_steps,
            ]
            .map(cell);
            let [total, reference, space, steps] = cells;
            writeln!(
                f,
                "{:<18}{:>20.12}{total:>10}{reference:>12}{space:>14}{steps:>14}",
                of.name, of.value
            )?;
        }
        writeln!(
            f,
            "The last two columns: the errors with a finer space alone (twice the elements, or p + 4), and with half the steps alone."
        )?;
        write!(f, "{}", self.advice)
    }
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
        assert_eq!(refused(of(Kind::Curve, Some(4.2e-4), Some(4.2e-4))), None);
        assert_eq!(refused(of(Kind::Curve, None, None)), None);
        // A single number may have a small error by chance.
        assert_eq!(refused(of(Kind::End, Some(0.79), None)), None);
        for (finer_space, finer_steps, words) in [
            (Some(0.79), None, "a finer space"),
            (None, Some(0.79), "finer steps"),
        ] {
            let message =
                refused(of(Kind::Curve, finer_space, finer_steps)).expect("a contradiction");
            assert!(
                message.contains("4.3e-5") && message.contains("7.9e-1") && message.contains(words),
                "{message}"
            );
        }
        assert!(refused(of(Kind::Curve, Some(f64::NAN), None)).is_some());
    }
}
