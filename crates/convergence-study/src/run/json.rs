//! A finished study as JSON: its fields, and the list of what did not pass, which is written only,
//! because it follows from them.

use serde::{Serialize, Serializer};

use super::failures::items_not_passed;
use super::{FailedCase, Finished, Item, WhereLost};
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
    where_lost: Option<&'f WhereLost>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    not_passed: Vec<Item>,
}

impl Serialize for Finished {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let written = Written {
            header: &self.header,
            outcome: &self.outcome,
            failed_cases: &self.failed_cases,
            not_finite: &self.not_finite,
            untested: &self.untested,
            where_lost: self.where_lost.as_ref(),
            not_passed: items_not_passed(self),
        };
        written.serialize(serializer)
    }
}
