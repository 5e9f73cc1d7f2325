//! One computation of a study, what it has measured, or why it could not.

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
