//! Why tables are not judged, for people and for programs.

use serde_json::{Value, json};

use crate::input::advice::{Surface, Text};
use crate::input::table::Offer;
use crate::input::{Complaint, InputError};
use convergence_judge::verdict::JudgeError;

/// Why tables are not judged.
#[derive(Debug, Clone, PartialEq)]
pub enum NotJudged {
    /// A table that cannot be read.
    Table {
        /// Its file, as the caller names it.
        file: String,
        /// Why, and what to do.
        error: Box<InputError>,
    },
    /// A claim about a column that no table has, or has twice.
    Claim(Text),
    /// A tolerance or a floor that the rule cannot use.
    Rule(JudgeError),
}

impl From<Text> for NotJudged {
    fn from(text: Text) -> Self {
        Self::Claim(text)
    }
}

impl From<JudgeError> for NotJudged {
    fn from(error: JudgeError) -> Self {
        Self::Rule(error)
    }
}

impl NotJudged {
    /// The message in the words of a surface.
    pub fn words(&self, surface: &dyn Surface) -> String {
        match self {
            Self::Table { error, .. } => error.words(surface),
            Self::Claim(text) => text.words(surface),
            Self::Rule(error) => error.to_string(),
        }
    }

    /// The refusal for programs: its words, and of a table where, what was expected and found, and
    /// what is offered.
    pub fn object(&self, surface: &dyn Surface) -> Value {
        let mut object = json!({ "message": self.words(surface) });
        if let Self::Table { error, .. } = self {
            object["file"] = json!(error.file);
            object["line"] = json!(error.place.map(|place| place.line));
            object["column"] = json!(error.place.map(|place| place.column));
            object["field"] = json!(error.field);
            if let Complaint::Table { expected, found } = &*error.complaint {
                object["expected"] = json!(expected.parts());
                object["found"] = json!(found);
            }
            let offers = error.offers.iter();
            object["offers"] = offers.map(|one| offer(one, surface)).collect();
        }
        object
    }
}

/// Settings by name, with the call that has them.
fn offer(offer: &Offer, surface: &dyn Surface) -> Value {
    json!({
        "settings": settings(offer),
        "comment": offer.comment,
        "call": surface.call(&offer.choice.settings()),
    })
}

/// Settings by name.
pub(super) fn settings(offer: &Offer) -> Value {
    let settings = offer.choice.settings().into_iter();
    settings
        .map(|setting| (setting.argument.name().to_owned(), json!(setting.value)))
        .collect()
}
