//! Studies whose cases are numbered and whose results are numbers by name; kinds leave this room for typed results.

use std::path::Path;

use convergence_study::input::{self, InputError, Section};
use convergence_study::study::{self as harness, CaseFailure, Header, Outcome, Ran};

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

/// A study of any kind, read and validated.
pub trait Study: Send + Sync {
    /// Its id, claim, tier and kind.
    fn header(&self) -> &Header;

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

/// A study of a known kind, which a file holds.
pub trait FromFile: Sized {
    /// Reads a study from `text`; complaints name `file`, and files that it names are looked for beside it.
    ///
    /// # Errors
    /// [`InputError`] with file, line, field, the value found and the values allowed.
    fn parse(text: &str, file: &Path) -> Result<Self, InputError>;

    /// Reads a study file, and the studies or scenes that it names.
    ///
    /// # Errors
    /// As [`FromFile::parse`], and where the file cannot be read.
    fn read(file: impl AsRef<Path>) -> Result<Self, InputError> {
        Self::parse(&input::read_text(file.as_ref())?, file.as_ref())
    }
}

/// An untyped study as one of the harness.
struct Typed<S>(S);

impl<S: Study> harness::Kind for Typed<S> {
    type Data = usize;
    type Found = Measured;

    fn header(&self) -> &Header {
        self.0.header()
    }

    fn cases(&self) -> Vec<harness::Case<usize>> {
        let case = |(data, Case { label, cost }): (usize, Case)| harness::Case { label, cost, data };
        self.0.cases().into_iter().enumerate().map(case).collect()
    }

    fn run(&self, index: &usize) -> Result<Measured, CaseFailure> {
        self.0.run(*index)
    }

    fn judge(&self, ran: &[Ran<usize, Measured>]) -> Outcome {
        self.0.conclude(&ran.iter().map(|ran| ran.found.clone()).collect::<Vec<_>>())
    }
}

/// The reader of an untyped kind.
pub(crate) fn reader<S: Study + FromFile + 'static>(
    _: Header,
    root: &Section<'_>,
    _: &Path,
) -> Result<Box<dyn harness::Study>, InputError> {
    Ok(harness::erased(Typed(S::parse(root.text(), Path::new(root.file()))?)))
}
