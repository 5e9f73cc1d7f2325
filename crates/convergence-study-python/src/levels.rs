//! The levels that a study computes.

use convergence_study::Budget;
use pyo3::prelude::*;

use crate::values::{numbers, refuse};

/// The levels of a study: numbers of cells, or steps.
pub(crate) enum LevelChoice {
    Auto,
    Counts(Vec<usize>),
    Steps(Vec<f64>),
}

impl LevelChoice {
    /// Reads the arguments `n` and `h`, of which at most one is given.
    pub(crate) fn read(
        n: Option<&Bound<'_, PyAny>>,
        h: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (name, given) = match (n, h) {
            (Some(_), Some(_)) => return Err(refuse("h: expected either n or h, found both")),
            (None, None) => return Ok(Self::Auto),
            (_, Some(h)) => ("h", h),
            (Some(n), _) if n.extract::<String>().is_ok_and(|text| text == "auto") => {
                return Ok(Self::Auto);
            }
            (Some(n), _) => ("n", n),
        };
        let numbers = numbers(name, given)?;
        if numbers.is_empty() {
            let expected = "\"auto\" or whole numbers, or steps as h=[...]";
            return Err(refuse(format!("{name}: expected {expected}; found none")));
        }
        for (k, number) in numbers.iter().enumerate() {
            let found = format!("found {number}");
            if name == "n" && (!(1.0..=1e15).contains(number) || number.fract() != 0.0) {
                let other = "give steps as h=[...]";
                return Err(refuse(format!(
                    "n[{k}]: expected a whole number > 0, {found}; {other}"
                )));
            }
            if !(*number > 0.0 && number.is_finite()) {
                return Err(refuse(format!(
                    "h[{k}]: expected a finite number > 0, {found}"
                )));
            }
            if numbers[..k].contains(number) {
                return Err(refuse(format!(
                    "{name}[{k}]: expected each number once, {found} again"
                )));
            }
        }
        if name == "h" {
            let mut steps = numbers;
            steps.sort_by(|a, b| b.total_cmp(a));
            return Ok(Self::Steps(steps));
        }
        Ok(Self::Counts(
            numbers.into_iter().map(|number| number as usize).collect(),
        ))
    }

    pub(crate) fn is_auto(&self) -> bool {
        matches!(self, Self::Auto)
    }

    /// The word for what tells the levels apart.
    pub(crate) fn counted(&self) -> &'static str {
        match self {
            Self::Steps(_) => "level",
            _ => "n",
        }
    }

    /// What tells the levels apart at the first look.
    ///
    /// * `order`: the highest that is claimed.
    pub(crate) fn counts(&self, order: f64) -> Vec<usize> {
        match self {
            Self::Auto => Budget::first_levels(|n| n.powf(-order)).to_vec(),
            Self::Counts(counts) => counts.clone(),
            Self::Steps(steps) => (1..=steps.len()).collect(),
        }
    }

    /// The levels as requested.
    pub(crate) fn words(&self) -> String {
        let words: Vec<String> = match self {
            Self::Auto => vec!["auto".to_owned()],
            Self::Counts(counts) => counts.iter().map(ToString::to_string).collect(),
            Self::Steps(steps) => steps.iter().map(ToString::to_string).collect(),
        };
        words.join(", ")
    }

    /// What tells the next finer level apart: twice the count, or half the step.
    ///
    /// * `counts`: those of the levels so far.
    pub(crate) fn finer(&mut self, counts: &[usize]) -> usize {
        let last = counts.iter().copied().max().unwrap_or(1);
        match self {
            Self::Steps(steps) => {
                steps.extend(steps.last().map(|finest| 0.5 * finest));
                last + 1
            }
            _ => 2 * last,
        }
    }

    /// The step of a level that was requested by its step.
    pub(crate) fn step(&self, count: usize) -> Option<f64> {
        match self {
            Self::Steps(steps) => steps.get(count - 1).copied(),
            _ => None,
        }
    }
}
