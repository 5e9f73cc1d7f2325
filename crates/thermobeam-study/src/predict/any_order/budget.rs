//! An error budget for a scene of any order, from two finer runs.

use std::fmt;

use serde::Serialize;

use super::sampled::{Curves, POINTS};
use super::{Sampled, Wanted, finer_space, finer_steps, sample};
use crate::error::curve::distance;
use crate::scene::Scene;

/// Where an error comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// Elements and their degree.
    Space,
    /// Steps and their degree.
    Time,
}

/// What the differences of an estimate are taken over. The difference of a single number may vanish by chance while the number
/// is wrong, that of a curve over some time may not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A curve: the largest difference over the whole time, inside steps included.
    Curve,
    /// Its smallest or largest value: the largest difference of the curve where it is near that value, by a tenth of its range.
    Extremum,
    /// Its value at the end: the largest difference at ends of steps over the last quarter of the time.
    End,
}

/// The error in one number or curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// What it is the error of.
    pub name: &'static str,
    /// What the differences are taken over.
    pub kind: Kind,
    /// The number itself; of a curve its largest absolute value.
    pub value: f64,
    /// Difference to a finer space.
    pub space: f64,
    /// Difference to finer steps.
    pub time: f64,
    /// Their sum.
    pub total: f64,
}

/// The errors in the numbers that a run shows.
///
/// The finer runs are better by so much that the differences are most of the errors of the scene's own run: of 1328 errors in 240
/// random scenes 11 were more than 1.3 times their total, at most 1.8 times. They are added up as if their signs were equal;
/// rounding errors and the iteration are in both. Estimates, not bounds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Budget {
    /// The source of the larger part of most errors; `None` where no error was found or one is NaN.
    pub dominant: Option<Source>,
    /// What to refine next, in a sentence.
    pub advice: String,
    /// One for each number or curve.
    pub quantities: Vec<Estimate>,
}

/// A curve, and which of its numbers.
type Observable = (&'static str, Kind, fn(&Curves) -> &Vec<f64>);

/// The same as for one-step schemes, in the same order.
const OBSERVABLES: [Observable; 8] = [
    ("u(1) at the end", Kind::End, |curves| &curves.u),
    (LARGEST, Kind::Extremum, |curves| &curves.u),
    ("smallest u(1)", Kind::Extremum, |curves| &curves.u),
    ("u(1) over time", Kind::Curve, |curves| &curves.u),
    ("phi(1) at the end", Kind::End, |curves| &curves.phi),
    ("phi(1) over time", Kind::Curve, |curves| &curves.phi),
    ("energy at the end", Kind::End, |curves| &curves.energy),
    ("energy over time", Kind::Curve, |curves| &curves.energy),
];

/// Part of the range of u(1, t) that is near its smallest or largest value.
const NEAR: f64 = 0.1;

const LARGEST: &str = "largest u(1)";

/// Part of the time, at its end, over which a number at the end is compared; and how many ends of steps there, at most.
const LAST_PART: f64 = 0.25;
const ENDS: usize = 12;

/// What kind of numbers the differences are.
const EXPLAINED: &str = "\
Estimates, no bounds: largest differences to a finer space and to finer steps. Of a curve: over the whole time, inside steps included.
Of an extremum: while the curve is within a tenth of its range of it. Of a number at the end: over the last quarter of the time.";

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, convergence_study::text::number::max_or_nan)
}

/// Some ends of steps in the last part of the time, the last of all among them: where they are among the times of a run's own.
fn last_ends(own: &Sampled) -> Vec<usize> {
    let t_end = own.times.last().map_or(0.0, |last| last.t);
    let ends = (POINTS - 1..own.times.len()).step_by(POINTS);
    let mut ends: Vec<usize> = ends.filter(|&end| own.times[end].t >= (1.0 - LAST_PART) * t_end).collect();
    let stride = ends.len().div_ceil(ENDS).max(1);
    ends = ends.into_iter().rev().step_by(stride).collect();
    ends.reverse();
    ends
}

/// Estimates the errors of a scene: by p + 4 (or the longest elements halved), and by steps of half the length.
///
/// # Errors
/// The solver's own words, with the run that failed.
pub fn estimate(scene: &Scene) -> Result<Budget, String> {
    let run = |what: &str, scene: &Scene, wanted: Wanted<'_>| {
        sample(scene, wanted).map_err(|failure| format!("the run with {what}: {failure}"))
    };
    let wanted = Wanted { at: &[], ends: &[], own: true, all: true };
    let own = run("the scene's own resolution", scene, wanted)?;
    let finer = finer_space(scene).ok_or("the elements are as many and of as high a degree as they get")?;
    let (times, last) = (own.own_times(), last_ends(&own));
    let ends: Vec<f64> = last.iter().map(|&end| times[end]).collect();
    let compared = Wanted { at: &times, ends: &ends, own: false, all: true };
    let in_space = run("a finer space", &finer, compared)?;
    let in_time = run("half the steps", &finer_steps(scene), compared)?;
    let curve = [&in_space, &in_time].map(|finer| distance(&own.own.u, &finer.at.u));
    let quantities: Vec<Estimate> = OBSERVABLES
        .iter()
        .map(|&(name, kind, read)| {
            let [space, time] = [&in_space, &in_time].map(|finer| match kind {
                Kind::Curve => distance(read(&own.own), read(&finer.at)),
                Kind::End => {
                    distance(&last.iter().map(|&end| read(&own.own)[end]).collect::<Vec<_>>(), read(&finer.ends))
                }
                Kind::Extremum => near_extremum(&own, finer, usize::from(name == LARGEST), curve[0] + curve[1]),
            });
            Estimate { name, kind, value: value(&own, name, kind, read), space, time, total: space + time }
        })
        .collect();
    let dominant = dominant(&quantities);
    let advice = match dominant {
        Some(Source::Space) => "Space dominates: raise mesh.degree by 2, or add elements near x = 1.",
        Some(Source::Time) => {
            "Time dominates: halve dt, restart_dt and growth - 1; where nothing touches, a higher time.degree is cheaper."
        }
        None => "No error was found that could be told from zero.",
    };
    Ok(Budget { dominant, advice: advice.to_owned(), quantities })
}

/// Largest difference of u(1, t) at the times where it is near its smallest (`which` = 0) or largest (1) value.
///
/// A curve that is nowhere further off than `error` has its extremum where this one is at most twice that from its own. The tenth of
/// the range is for a difference that vanishes just there.
fn near_extremum(own: &Sampled, finer: &Sampled, which: usize, error: f64) -> f64 {
    let near = (NEAR * (own.range[1] - own.range[0])).max(2.0 * error);
    let pairs = own.own.u.iter().zip(&finer.at.u).filter(|(u, _)| !((*u - own.range[which]).abs() > near));
    let (mut of_own, mut of_finer) = (vec![own.range[which]], vec![finer.range[which]]);
    pairs.for_each(|(u, v)| {
        of_own.push(*u);
        of_finer.push(*v);
    });
    distance(&of_own, &of_finer)
}

fn value(own: &Sampled, name: &str, kind: Kind, read: fn(&Curves) -> &Vec<f64>) -> f64 {
    match kind {
        Kind::Curve => largest(read(&own.own).iter().map(|value| value.abs())),
        Kind::End => read(&own.own).last().copied().unwrap_or(f64::NAN),
        Kind::Extremum => own.range[usize::from(name == LARGEST)],
    }
}

/// All numbers count alike.
fn dominant(quantities: &[Estimate]) -> Option<Source> {
    let share = |part: fn(&Estimate) -> f64| -> f64 {
        quantities.iter().map(|of| if of.total == 0.0 { 0.0 } else { part(of) / of.total }).sum()
    };
    let (space, time) = (share(|of| of.space), share(|of| of.time));
    match space.partial_cmp(&time)? {
        std::cmp::Ordering::Less => Some(Source::Time),
        _ if space > 0.0 => Some(Source::Space),
        _ => None,
    }
}

impl fmt::Display for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Estimated errors")?;
        writeln!(f, "{:<18}{:>20}{:>10}{:>10}{:>10}", "", "value", "space", "time", "total")?;
        for Estimate { name, value, space, time, total, .. } in &self.quantities {
            writeln!(f, "{name:<18}{value:>20.12}{space:>10.1e}{time:>10.1e}{total:>10.1e}")?;
        }
        writeln!(f, "{EXPLAINED}")?;
        write!(f, "{}", self.advice)
    }
}
