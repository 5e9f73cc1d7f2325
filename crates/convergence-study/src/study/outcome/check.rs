//! Judged statements.

use crate::study::subject::Subject;
use crate::text::prose::Prose;
use convergence_judge::verdict::Verdict;

/// Something judged that is not a rate.
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
    /// Whether it says that every case has run, which is no statement of the study.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) is_completion: bool,
}

impl Check {
    /// Passes or fails on a condition; `holds` must be false for NaN.
    pub(crate) fn that(holds: bool, claim: impl Into<Prose>, evidence: impl Into<Prose>) -> Self {
        let verdict = if holds { Verdict::Pass } else { Verdict::Fail };
        Self::new(verdict, claim, evidence)
    }

    /// A statement with this verdict.
    pub(crate) fn new(
        verdict: Verdict,
        claim: impl Into<Prose>,
        evidence: impl Into<Prose>,
    ) -> Self {
        Self {
            claim: claim.into(),
            verdict,
            subject: Subject::default(),
            evidence: evidence.into(),
            is_completion: false,
        }
    }

    /// The same about a subject.
    pub(crate) fn about(self, subject: Subject) -> Self {
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
}
