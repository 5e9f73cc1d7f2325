//! The kinds of study, one file each, behind one interface.
//!
//! A study is a TOML file: data. Its kind says what its cases are (pure computations, run on any thread in any order),
//! and how their results become an [`Outcome`]: checks with verdicts, tables, figures, and the numbers that the baseline
//! guards. The runner knows threads, the report knows Markdown, a study knows neither.

pub mod bifurcation;
pub mod calibration;
mod complete;
pub mod controls;
pub mod convergence;
pub mod energy;
pub mod equilibrium;
pub mod experiment;
pub mod explain;
pub mod extremes;
pub mod fixed_point;
pub mod frequencies;
mod ladder;
pub mod random_scenes;
pub mod rigid;
pub mod self_convergence;
pub mod sensitivity;
pub mod stability;
mod steady;
pub mod vibration;
mod watch;
pub mod work_precision;

use crate::case::{Case, CaseFailure, Measured};
use crate::document::{self, InputError, Section};
use crate::outcome::Outcome;
use crate::study_file::{CONVERGENCE, StudyHeader};
use std::path::{Path, PathBuf};

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
        Self::parse(&document::read_text(file.as_ref())?, file.as_ref())
    }
}

/// Reader of the study files of one kind.
type Reader = fn(&Path) -> Result<Box<dyn Study>, InputError>;

fn boxed<S: Study + FromFile + 'static>(file: &Path) -> Result<Box<dyn Study>, InputError> {
    Ok(Box::new(S::read(file)?))
}

/// The kinds of study, by the name that `[study] kind` has for them.
const KINDS: &[(&str, Reader)] = &[
    (CONVERGENCE, boxed::<convergence::Convergence>),
    (controls::CONTROLS, boxed::<controls::Controls>),
    (sensitivity::SENSITIVITY, boxed::<sensitivity::Sensitivity>),
    (energy::ENERGY, boxed::<energy::EnergyDecay>),
    (fixed_point::FIXED_POINT, boxed::<fixed_point::FixedPoint>),
    (vibration::KIND, boxed::<vibration::Vibration>),
    (frequencies::KIND, boxed::<frequencies::Frequencies>),
    (self_convergence::KIND, boxed::<self_convergence::SelfConvergence>),
    ("experiment", boxed::<experiment::Experiments>),
    ("equilibrium", boxed::<equilibrium::EndStates>),
    ("bifurcation", boxed::<bifurcation::BifurcationStudy>),
    ("rigid", boxed::<rigid::RigidStudy>),
    (work_precision::WORK_PRECISION, boxed::<work_precision::WorkPrecision>),
    (stability::KIND, boxed::<stability::Stability>),
    (extremes::KIND, boxed::<extremes::Extremes>),
    (random_scenes::KIND, boxed::<random_scenes::RandomScenes>),
    (calibration::CALIBRATION, boxed::<calibration::RuleCalibration>),
];

/// Reads a study file of any kind.
///
/// # Errors
/// [`InputError`] with file, line, field, the value found and the values allowed.
pub fn read(path: &Path) -> Result<Box<dyn Study>, InputError> {
    let kind = StudyHeader::read(path)?.kind;
    reader(path, &kind)?(path)
}

/// Reads the headers of study files, each of any kind.
///
/// # Errors
/// [`InputError`]; also where the kind is not known and where two studies have one id.
pub fn headers(paths: &[PathBuf]) -> Result<Vec<StudyHeader>, InputError> {
    let mut headers: Vec<StudyHeader> = Vec::new();
    for path in paths {
        let header = StudyHeader::read(path)?;
        reader(path, &header.kind)?;
        if let Some(i) = headers.iter().position(|earlier| earlier.id == header.id) {
            let found = format!("\"{}\", which {} has too", header.id, paths[i].display());
            return Err(refuse(path, "id", &found, "an id for each study of its own"));
        }
        headers.push(header);
    }
    Ok(headers)
}

/// The names of all kinds of study.
pub fn kinds() -> impl Iterator<Item = &'static str> {
    KINDS.iter().map(|(name, _)| *name)
}

/// The reader for a kind.
fn reader(path: &Path, kind: &str) -> Result<Reader, InputError> {
    let known = KINDS.iter().find(|(name, _)| *name == kind);
    known.map(|(_, reader)| *reader).ok_or_else(|| {
        let names: Vec<String> = kinds().map(|name| format!("\"{name}\"")).collect();
        refuse(path, "kind", &format!("\"{kind}\""), &names.join(", "))
    })
}

/// The complaint about a key of `[study]`, with its line.
fn refuse(path: &Path, key: &str, found: &str, allowed: &str) -> InputError {
    let complain = |root: &Section<'_>| -> Result<InputError, InputError> {
        let study = root.require("study", "a table")?.section()?;
        Ok(study.refuse(key, found, allowed))
    };
    let text = document::read_text(path);
    text.and_then(|text| document::parse(&text, &path.display().to_string(), complain)).unwrap_or_else(|error| error)
}
