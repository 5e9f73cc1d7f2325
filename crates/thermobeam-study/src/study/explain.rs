//! What studies, norms and verdicts mean, in words: a row of this file for each kind, each norm and each reason.

mod kinds;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::document::InputError;
use crate::exact::nearest::nearest;
use crate::study_file::{Axis, CONVERGENCE, ConvergenceSpec, Norm, StudyHeader};
use crate::verdict::Reason;
use kinds::{KINDS, Kind};

/// What a norm measures.
fn norm_text(norm: Norm) -> &'static str {
    match norm {
        Norm::Velocity => "the L2 norm of the error of the velocity u_t",
        Norm::Shear => "the L2 norm of the error of the shear u_x - phi: a derivative, so first order in h at best",
        Norm::RotationRate => "the L2 norm of the error of the rate of rotation phi_t",
        Norm::Curvature => "the L2 norm of the error of phi_x: a derivative, so first order in h at best",
        Norm::Temperature => "the L2 norm of the error of the temperature",
        Norm::Theorem34 => {
            "the root of the sum of the squares of velocity, shear, rotation-rate, curvature and temperature at the same time: \
             the left-hand side of Theorem 3.4, bounded there by c (h + dt)"
        }
        Norm::Displacement => "the L2 norm of the error of the displacement u",
        Norm::Superclose => {
            "as theorem-3.4, but of the distance to the interpolant of the exact solution: Z_n^1/2 of (3.16). The first order of \
             Theorem 3.4 is that of interpolation alone; to the interpolant the scheme is of order h^2 + dt. The sharpest guard: \
             it sees defects which the interpolation error hides"
        }
    }
}

/// Every reason, for listing.
const REASONS: [Reason; 17] = [
    Reason::Agrees,
    Reason::NonFiniteError,
    Reason::NegativeError,
    Reason::ErrorGrows,
    Reason::FallsAway,
    Reason::TooLow,
    Reason::TooHigh,
    Reason::ZeroError,
    Reason::StepsNotDecreasing,
    Reason::ClaimUnusable,
    Reason::ToleranceTooWide,
    Reason::TooFewLevels,
    Reason::NotAsymptotic,
    Reason::RoundOffFloor,
    Reason::WildRate,
    Reason::IntervalTooWide,
    Reason::AtTheEdge,
];

/// The name by which a reason is asked for, and what it means.
fn reason_text(reason: Reason) -> (&'static str, &'static str) {
    match reason {
        Reason::Agrees => ("agrees", "The whole interval of the rate lies within the tolerance of the order."),
        Reason::NonFiniteError => {
            ("non-finite", "An error is NaN or infinite: a case broke down, or did not come to its end.")
        }
        Reason::NegativeError => {
            ("negative", "An error is negative, which no norm can be: a sign was lost, or a difference was given.")
        }
        Reason::ErrorGrows => (
            "grows",
            "Refining does not make the error smaller, though it is above the round-off floor: no convergence.",
        ),
        Reason::FallsAway => (
            "falls-away",
            "The finest rates fall, by more than half an order: an inconsistency is emerging which coarse levels hide.",
        ),
        Reason::TooLow => {
            ("too-low", "The whole interval lies below the band: an order is lost. Look for a term of lower order.")
        }
        Reason::TooHigh => (
            "too-high",
            "The whole interval lies above the band: the exact solution may be too simple, or the error not the one that was meant.",
        ),
        Reason::ZeroError => (
            "zero",
            "An error of exactly zero has no logarithm: the solution lies in the discrete space. Choose another one.",
        ),
        Reason::StepsNotDecreasing => ("steps", "Levels must be given coarse to fine, each once."),
        Reason::ClaimUnusable => (
            "claim",
            "The order and the tolerance must be positive numbers. Where no order is claimed, none is confirmed.",
        ),
        Reason::ToleranceTooWide => {
            ("tolerance", "Half an order or more on either side accepts two integer orders. Claim more narrowly.")
        }
        Reason::TooFewLevels => {
            ("levels", "A rate with an interval needs three levels above the round-off floor, and five to be believed.")
        }
        Reason::NotAsymptotic => {
            ("asymptotic", "The rates are still changing, or change more and more. Add finer levels.")
        }
        Reason::RoundOffFloor => {
            ("floor", "Errors so small are round-off. Add coarser levels, or tighten the tolerance of the steps.")
        }
        Reason::WildRate => {
            ("wild", "A pairwise rate is more than five orders away from the claim: these levels are not one family.")
        }
        Reason::IntervalTooWide => {
            ("wide", "The data scatter too much for this tolerance. Add levels, or claim less narrowly.")
        }
        Reason::AtTheEdge => (
            "edge",
            "The interval is narrow, but holds an end of the band: the claim is neither confirmed nor refuted.",
        ),
    }
}

/// A norm, a reason or a kind, in words; `None` where there is none of that name.
pub fn term(name: &str) -> Option<String> {
    if let Some(norm) = Norm::ALL.into_iter().find(|norm| norm.name() == name) {
        let mut text = format!("{name}, a norm\n");
        section(&mut text, "what it measures", &format!("{}.", norm_text(norm)));
        section(&mut text, "when", "The maximum over all time levels counts.");
        return Some(text);
    }
    for reason in REASONS {
        let (known, text) = reason_text(reason);
        if known == name {
            let mut words = format!("{name}, a reason for {}\n", reason.verdict());
            section(&mut words, "in short", &format!("{}.", reason.text()));
            section(&mut words, "what it means", text);
            return Some(words);
        }
    }
    let kind = KINDS.iter().find(|kind| kind.name == name)?;
    let mut text = format!("{name}, a kind of study\n");
    describe(&mut text, kind, None);
    Some(text)
}

/// The names that [`term`] knows.
pub fn terms() -> Vec<&'static str> {
    groups().into_iter().flat_map(|(_, names)| names).collect()
}

/// The names that [`term`] knows, group by group.
pub fn contents() -> String {
    let mut text = "what can be explained\n".to_owned();
    for (title, names) in groups() {
        section(&mut text, title, &names.join(", "));
    }
    text
}

fn groups() -> [(&'static str, Vec<&'static str>); 3] {
    let norms = Norm::ALL.iter().map(|norm| norm.name());
    let reasons = REASONS.iter().map(|&reason| reason_text(reason).0);
    let kinds = KINDS.iter().map(|kind| kind.name);
    [("norms", norms.collect()), ("reasons for a verdict", reasons.collect()), ("kinds of study", kinds.collect())]
}

/// A study file in words; `None` where its kind has no row in this file.
///
/// # Errors
/// [`InputError`] where the file is none.
pub fn study(path: &Path) -> Result<Option<String>, InputError> {
    let header = StudyHeader::read(path)?;
    let Some(kind) = KINDS.iter().find(|kind| kind.name == header.kind) else { return Ok(None) };
    let spec = (header.kind == CONVERGENCE).then(|| ConvergenceSpec::read(path)).transpose()?;
    let mut text = format!("{} ({}, tier {})\n", header.id, header.kind, header.tier.name());
    section(&mut text, "what is claimed", &header.claim);
    describe(&mut text, kind, spec.as_ref());
    Ok(Some(text))
}

/// The study of that id among the files of a folder.
pub fn find(folder: &Path, id: &str) -> Option<PathBuf> {
    headers(folder).into_iter().find(|(_, header)| header.id == id).map(|(path, _)| path)
}

/// An id or a term that was probably meant.
pub fn meant(folder: &Path, name: &str) -> Option<String> {
    let headers = headers(folder);
    let ids = headers.iter().map(|(_, header)| header.id.as_str());
    nearest(name, ids.chain(terms())).map(str::to_owned)
}

/// The study files of a folder in the order of their names; files that are none are left out.
fn headers(folder: &Path) -> Vec<(PathBuf, StudyHeader)> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut paths: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    paths.into_iter().filter_map(|path| StudyHeader::read(&path).ok().map(|header| (path, header))).collect()
}

fn describe(text: &mut String, kind: &Kind, spec: Option<&ConvergenceSpec>) {
    section(text, "why it should hold", kind.why);
    if let Some(spec) = spec {
        section(text, "what is done", &design(spec));
        for expectation in &spec.expect {
            let (norm, order, tolerance) = (expectation.norm, expectation.order, expectation.tolerance);
            let claim = format!("{}, order {order} ± {tolerance}", norm.name());
            section(text, &claim, &format!("{}.", norm_text(norm)));
        }
    }
    section(text, "how it is judged", kind.judged);
    section(text, "what a failure would mean", kind.failure);
}

/// What a convergence study refines, and why its other error does not disturb.
fn design(spec: &ConvergenceSpec) -> String {
    let refine = &spec.refine;
    let levels = refine.cases().len();
    let what = match (refine.axis, refine.isolate) {
        (Axis::Space, true) => {
            "The mesh is refined. The exact solution is replaced by its own time sequence and the loads by the scheme's time-discrete \
             operator on it, so that the time error is exactly zero and few steps are enough."
        }
        (Axis::Space, false) => {
            "The mesh is refined; the time step is fixed, and its error must be far below that of the mesh."
        }
        (Axis::Time, true) => {
            "The time step is refined. The exact solution is replaced by its interpolant and the loads use the discrete matrices, so \
             that the space error is exactly zero and a coarse mesh is enough."
        }
        (Axis::Time, false) => {
            "The time step is refined; the mesh is fixed, and its error must be far below that of the steps."
        }
        (Axis::Both, _) if refine.grid => {
            "All combinations of meshes and time steps; e^2 = (C_h h^p)^2 + (C_t dt^q)^2 is fitted to the errors, both orders at once."
        }
        (Axis::Both, _) => "Mesh and time step are refined together: the theorem as it stands.",
    };
    let mut text = format!("{what} {levels} levels; scheme {}.", refine.scheme.name);
    if let Some(control) = &spec.control {
        let _ = write!(
            text,
            " The solver differs from the sources in {}: a negative control, which must fail.",
            control.changed.join(", ")
        );
    }
    text
}

/// A title, and a paragraph with lines of at most 100 characters.
fn section(text: &mut String, title: &str, paragraph: &str) {
    const WIDTH: usize = 100;
    let _ = write!(text, "\n{title}\n ");
    let mut column = 1;
    for word in paragraph.split_whitespace() {
        if column + 1 + word.chars().count() > WIDTH {
            text.push_str("\n ");
            column = 1;
        }
        let _ = write!(text, " {word}");
        column += 1 + word.chars().count();
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_study_of_the_repository_is_explained() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
        // The crate may be tested without the repository around it.
        let headers = if folder.exists() { headers(&folder) } else { return };
        assert!(headers.len() > 10);
        for (path, header) in headers {
            let text = study(&path).unwrap();
            let text = text.unwrap_or_else(|| panic!("{}: the kind `{}` needs a row here", header.id, header.kind));
            for title in ["what is claimed", "why it should hold", "how it is judged", "what a failure would mean"] {
                assert!(text.contains(&format!("\n{title}\n")), "{text}");
            }
            assert!(text.starts_with(&header.id) && text.lines().all(|line| line.chars().count() <= 100), "{text}");
            assert_eq!(find(&folder, &header.id), Some(path));
        }
    }

    #[test]
    fn every_kind_of_study_has_its_words() {
        let words: BTreeSet<_> = KINDS.iter().map(|kind| kind.name).collect();
        let kinds: BTreeSet<_> = crate::study::kinds().collect();
        assert_eq!(words, kinds);
    }

    #[test]
    fn every_term_has_one_meaning() {
        let names = terms();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        for name in names {
            let text = term(name).unwrap_or_else(|| panic!("{name}"));
            assert!(text.starts_with(name) && text.lines().all(|line| line.chars().count() <= 100), "{text}");
            assert!(contents().contains(name));
        }
        assert_eq!(term("magic"), None);
        assert_eq!(meant(Path::new("nowhere"), "superclosed").as_deref(), Some("superclose"));
    }
}
