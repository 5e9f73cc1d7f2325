//! A judged rate, and its form in records.

use serde::{Deserialize, Serialize, Serializer};

use crate::study::subject::Subject;
use convergence_judge::verdict::RateVerdict;

/// The judged rate of an error.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(from = "Read")]
pub struct NamedRate {
    /// The error: a norm, a quantity; on a grid also the step, `L2 in dt`.
    pub name: String,
    /// What the rate is about.
    pub subject: Subject,
    /// The judgement.
    pub rate: RateVerdict,
}

impl NamedRate {
    /// A rate that is about the error of its name.
    pub fn new(name: impl Into<String>, rate: RateVerdict) -> Self {
        let name = name.into();
        Self {
            subject: Subject::of(&name),
            name,
            rate,
        }
    }
}

/// In records: the name, what the rate is about where that is more than the name, the judgement,
/// and advice unless it is a pass.
#[derive(Serialize)]
struct Written<'r> {
    norm: &'r str,
    #[serde(skip_serializing_if = "Option::is_none")]
    subject: Option<&'r Subject>,
    #[serde(flatten)]
    rate: &'r RateVerdict,
    #[serde(skip_serializing_if = "Option::is_none")]
    advice: Option<String>,
}

impl Serialize for NamedRate {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let subject = Some(&self.subject);
        let written = Written {
            norm: &self.name,
            subject: subject.filter(|subject| **subject != Subject::of(&self.name)),
            rate: &self.rate,
            advice: self.rate.advice(),
        };
        written.serialize(serializer)
    }
}

#[derive(Deserialize)]
struct Read {
    norm: String,
    subject: Option<Subject>,
    #[serde(flatten)]
    rate: RateVerdict,
}

impl From<Read> for NamedRate {
    fn from(read: Read) -> Self {
        Self {
            subject: read.subject.unwrap_or_else(|| Subject::of(&read.norm)),
            name: read.norm,
            rate: read.rate,
        }
    }
}
