//! An error budget for a scene of any order, from two finer runs.

use std::fmt;

use serde::Serialize;

use super::{Curves, Sampled, finer_space, finer_steps, impact, sample, times};
use crate::error::curve::distance;
use crate::scene::any_order::AnyOrderScene;

/// Where an error comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// Elements and their degree.
    Space,
    /// Steps and their degree.
    Time,
}

/// The error in one number or curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// What it is the error of.
    pub name: &'static str,
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
/// High orders make the finer runs so much better that the differences are errors of the scene's own run. They are added up
/// as if their signs were equal; rounding errors and the iteration are in both.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Budget {
    /// The source of the larger part of most errors; `None` where no error was found or one is NaN.
    pub dominant: Option<Source>,
    /// What to refine next, in a sentence.
    pub advice: String,
    /// One for each number or curve.
    pub quantities: Vec<Estimate>,
}

type Observable = (&'static str, fn(&Sampled) -> Vec<f64>);

/// The same as for one-step schemes, in the same order.
const OBSERVABLES: [Observable; 8] = [
    ("u(1) at the end", |run| last(&run.u)),
    ("largest u(1)", |run| vec![run.range[1]]),
    ("smallest u(1)", |run| vec![run.range[0]]),
    ("u(1) over time", |run| run.u.clone()),
    ("phi(1) at the end", |run| last(&run.phi)),
    ("phi(1) over time", |run| run.phi.clone()),
    ("energy at the end", |run| last(&run.energy)),
    ("energy over time", |run| run.energy.clone()),
];

fn last(curve: &[f64]) -> Vec<f64> {
    vec![curve.last().copied().unwrap_or(f64::NAN)]
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, convergence_study::text::number::max_or_nan)
}

/// Estimates the errors of a scene: by p + 2 (or the longest elements halved), and by steps of half the length.
///
/// # Errors
/// The solver's own words, with the run that failed.
pub fn estimate(scene: &AnyOrderScene) -> Result<Budget, String> {
    let count = times(scene, impact(scene));
    let run = |what: &str, scene: &AnyOrderScene| {
        sample(scene, count, Curves::All).map_err(|failure| format!("the run with {what}: {failure}"))
    };
    let own = run("the scene's own resolution", scene)?;
    let finer = finer_space(scene).ok_or("the elements are as many and of as high a degree as they get")?;
    let in_space = run("a finer space", &finer)?;
    let in_time = run("half the steps", &finer_steps(scene))?;
    let quantities: Vec<Estimate> = OBSERVABLES
        .iter()
        .map(|(name, read)| {
            let of = read(&own);
            let [space, time] = [&in_space, &in_time].map(|other| distance(&of, &read(other)));
            let value = if of.len() == 1 { of[0] } else { largest(of.iter().map(|value| value.abs())) };
            Estimate { name, value, space, time, total: space + time }
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
        for Estimate { name, value, space, time, total } in &self.quantities {
            writeln!(f, "{name:<18}{value:>20.12}{space:>10.1e}{time:>10.1e}{total:>10.1e}")?;
        }
        write!(f, "{}", self.advice)
    }
}
