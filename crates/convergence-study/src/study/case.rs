//! One computation of a study, and its result or the reason why there is none.

/// One computation of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<D> {
    /// What distinguishes it from the study's other cases, such as `n = 64, 20 steps`.
    pub label: String,
    /// Estimate of the work, in any unit that all studies of a project share: the runner starts with the costliest case.
    pub cost: f64,
    /// What the computation needs to know.
    pub data: D,
}

/// A case after it was run: its data, and what it found.
#[derive(Debug, Clone, PartialEq)]
pub struct Ran<D, F> {
    /// The case.
    pub case: Case<D>,
    /// Its result.
    pub found: Result<F, CaseFailure>,
}

impl<D, F> Ran<D, F> {
    /// What the case found, if it completed.
    pub fn ok(&self) -> Option<&F> {
        self.found.as_ref().ok()
    }
}

/// Why a case has no result: an error of the computation, a panic caught by the runner, or the time limit.
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
