//! A finished study as JSON: its fields, and the list of what did not pass, which is written only,
//! because it follows from them.

use serde::{Serialize, Serializer};

use super::{FailedCase, Finished, Item, NotPassed, WhereLost};
use crate::judge::verdict::Verdict;
use crate::study::outcome::NotFinite;
use crate::study::{Header, Outcome, Untested};

#[derive(Serialize)]
struct Written<'f> {
    #[serde(flatten)]
    header: &'f Header,
    #[serde(flatten)]
    outcome: &'f Outcome,
    failed_cases: &'f [FailedCase],
    not_finite: &'f [NotFinite],
    #[serde(skip_serializing_if = "<[Untested]>::is_empty")]
    untested: &'f [Untested],
    #[serde(rename = "where", skip_serializing_if = "Option::is_none")]
    located: Option<&'f WhereLost>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    not_passed: Vec<WrittenItem>,
}

#[derive(Serialize)]
struct WrittenItem {
    item: String,
    verdict: Verdict,
    why: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    code: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    advice: Option<String>,
}

impl From<&Item<'_>> for WrittenItem {
    fn from(item: &Item<'_>) -> Self {
        Self {
            item: item.name(),
            verdict: item.verdict(),
            why: item.why(),
            code: item.code(),
            advice: item.advice(),
        }
    }
}

impl Serialize for Finished {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let not_passed = NotPassed::of(self);
        let not_passed = not_passed.iter().flat_map(|study| &study.items);
        let written = Written {
            header: &self.header,
            outcome: &self.outcome,
            failed_cases: &self.failed_cases,
            not_finite: &self.not_finite,
            untested: &self.untested,
            located: self.located.as_ref(),
            not_passed: not_passed.map(WrittenItem::from).collect(),
        };
        written.serialize(serializer)
    }
}
