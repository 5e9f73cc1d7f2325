//! Judged statements.

use crate::judge::verdict::Verdict;
use crate::study::subject::Subject;
use crate::text::prose::Prose;

/// Whose statement a check is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// That every case has run: no statement.
    Completion,
    /// A statement of the source, as printed there.
    Source,
    /// What holds in place of a statement of the source that does not.
    Correction,
    /// The study's own.
    #[default]
    Own,
}

/// Something judged that is not a rate.
///
/// ```
/// use convergence_study::{Check, Subject, Verdict};
///
/// let drift = 3e-13;
/// let check = Check::that(drift < 1e-12, "the energy is conserved", format!("drift {drift:e}"))
///     .about(Subject::of("energy").in_case("n = 64"));
/// assert_eq!(check.verdict, Verdict::Pass);
/// assert_eq!(check.statement(), "n = 64: the energy is conserved");
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[must_use = "a check counts in the outcome that holds it"]
pub struct Check {
    /// The claim, without its case.
    pub claim: Prose,
    /// What it is about.
    #[serde(default)]
    pub subject: Subject,
    /// The outcome.
    pub verdict: Verdict,
    /// The evidence, with numbers.
    pub evidence: Prose,
    /// Whose statement it is; [`Origin::Own`] in records that do not say.
    #[serde(default)]
    pub origin: Origin,
}

impl Check {
    /// Passes or fails on a condition; `holds` must be false for NaN.
    pub fn that(holds: bool, claim: impl Into<Prose>, evidence: impl Into<Prose>) -> Self {
        let verdict = if holds { Verdict::Pass } else { Verdict::Fail };
        Self {
            claim: claim.into(),
            verdict,
            subject: Subject::default(),
            evidence: evidence.into(),
            origin: Origin::Own,
        }
    }

    /// The same about a subject.
    pub fn about(self, subject: Subject) -> Self {
        Self { subject, ..self }
    }

    /// The claim as it is printed: after its case, if it has one.
    pub fn statement(&self) -> String {
        match &self.subject.case {
            Some(case) => format!("{case}: {}", self.claim),
            None => self.claim.to_string(),
        }
    }

    /// What it is about; the claim stands in for a quantity that is not known.
    pub fn quantity(&self) -> String {
        self.subject.quantity_or(&self.claim.to_string()).to_owned()
    }

    /// The same as somebody's statement.
    pub fn stated_by(self, origin: Origin) -> Self {
        Self { origin, ..self }
    }
}
