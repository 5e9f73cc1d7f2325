//! The kinds of study, one file each, behind one interface.
//!
//! A study is a TOML file: data. Its kind says what its cases are (pure computations, run on any thread in any order),
//! and how their results become an [`Outcome`]: checks with verdicts, tables, figures, and the numbers that the baseline
//! guards. The runner knows threads, the report knows Markdown, a study knows neither.

pub mod calibration;
pub mod controls;
pub mod convergence;
pub mod energy;
pub mod fixed_point;
pub mod work_precision;

use crate::document::InputError;
use crate::outcome::Outcome;
use crate::study_file::{CONVERGENCE, StudyHeader};
use std::path::Path;

/// One computation of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// What tells it from the study's other cases, such as `n = 64, 20 steps`.
    pub label: String,
    /// Estimate of the work, in elements times steps: the runner starts with the costliest.
    pub cost: f64,
}

/// What a case has measured: plain data, by name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measured {
    /// Single numbers.
    pub values: Vec<(String, f64)>,
    /// Curves, for the figures.
    pub series: Vec<(String, Vec<(f64, f64)>)>,
}

impl Measured {
    /// Adds a number.
    pub fn push(&mut self, name: impl Into<String>, value: f64) {
        self.values.push((name.into(), value));
    }

    /// The number of that name; NaN where there is none, so that nothing passes on it.
    pub fn value(&self, name: &str) -> f64 {
        self.values.iter().find(|(key, _)| key == name).map_or(f64::NAN, |(_, value)| *value)
    }

    /// The curve of that name; empty where there is none.
    pub fn curve(&self, name: &str) -> &[(f64, f64)] {
        self.series.iter().find(|(key, _)| key == name).map_or(&[], |(_, points)| points)
    }
}

/// Why a case has no result: an error of the solver, or a panic caught by the runner.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseFailure {
    /// In words, with step, time and numbers.
    pub reason: String,
}

impl<E: std::error::Error> From<E> for CaseFailure {
    fn from(error: E) -> Self {
        Self { reason: error.to_string() }
    }
}

/// A study of any kind, read and validated.
pub trait Study: Send + Sync {
    /// Its id, claim, tier and kind.
    fn header(&self) -> &StudyHeader;

    /// Its computations.
    fn cases(&self) -> Vec<Case>;

    /// Runs case number `index` of [`Study::cases`]. Pure: the same result on every thread, at every time.
    ///
    /// # Errors
    /// [`CaseFailure`] where the computation did not come to its end.
    fn run(&self, index: usize) -> Result<Measured, CaseFailure>;

    /// Judges the results, one for each case in the order of [`Study::cases`]. A failed case must not pass unseen.
    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome;
}

/// Reads a study file of any kind.
///
/// # Errors
/// [`InputError`] with file, line, field, the value found and the values allowed.
pub fn read(path: &Path) -> Result<Box<dyn Study>, InputError> {
    let header = StudyHeader::read(path)?;
    match header.kind.as_str() {
        CONVERGENCE => Ok(Box::new(convergence::Convergence::read(path)?)),
        controls::CONTROLS => Ok(Box::new(controls::Controls::read(path)?)),
        energy::ENERGY => Ok(Box::new(energy::EnergyDecay::read(path)?)),
        calibration::CALIBRATION => Ok(Box::new(calibration::RuleCalibration::read(path)?)),
        fixed_point::FIXED_POINT => Ok(Box::new(fixed_point::FixedPoint::read(path)?)),
        work_precision::WORK_PRECISION => Ok(Box::new(work_precision::WorkPrecision::read(path)?)),
        _ => unreachable!("kinds are registered below"),
    }
}
