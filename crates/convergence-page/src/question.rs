//! What the page asks.

use convergence_judge::text::names::quoted;
use convergence_study::{
    Choice,
    internal::{
        input::advice::{CommandLine, Surface},
        rates::{Claimed, Request, claimed},
    },
};
use serde::Deserialize;
use serde_json::{Map, Value};

use crate::answer::Refused;
use crate::{FILE, LONGEST_TEXT, PROGRAM};

/// A text, and the options of the command `rates` under their names.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Question {
    /// The tables.
    pub(crate) text: String,
    /// Values of `--order`.
    #[serde(default)]
    order: Vec<String>,
    #[serde(default)]
    tolerance: Option<f64>,
    #[serde(default)]
    floor: Option<f64>,
    #[serde(flatten)]
    choice: Choice,
    /// What is none of the above.
    #[serde(flatten)]
    others: Map<String, Value>,
}

impl Question {
    pub(crate) fn of_json(text: &str) -> Result<Self, Refused> {
        let question: Self =
            serde_json::from_str(text).map_err(|error| Refused::because(&error.to_string()))?;
        if let Some(name) = question.others.keys().next() {
            return Err(Refused::because(&format!(
                "expected an option of `{PROGRAM} rates`; found `{name}`"
            )));
        }
        let length = question.text.len();
        if length > LONGEST_TEXT {
            return Err(Refused::because(&format!(
                "expected a text of at most {LONGEST_TEXT} bytes; found {length}: use `{PROGRAM} rates {FILE}`"
            )));
        }
        Ok(question)
    }

    pub(crate) fn request(&self) -> Result<Request, Refused> {
        let claims: Result<Vec<Claimed>, Refused> = self
            .order
            .iter()
            .map(|order| {
                claimed(order).map_err(|expected| {
                    Refused::because(&format!("--order {}: {expected}", quoted(order)))
                })
            })
            .collect();
        Ok(Request {
            claims: claims?,
            tolerance: self.tolerance,
            floor: self.floor.unwrap_or(0.0),
            choice: self.choice.clone(),
            ..Request::default()
        })
    }

    /// The command that judges a file by the same claims, without the settings of the reader.
    pub(crate) fn command_of_claims(&self) -> String {
        let mut command = format!("{PROGRAM} rates {FILE}");
        for order in &self.order {
            command += &format!(" --order {}", quoted(order));
        }
        for (option, value) in [("tolerance", self.tolerance), ("floor", self.floor)] {
            if let Some(value) = value {
                command += &format!(" --{option} {value}");
            }
        }
        command
    }

    /// The command that judges a file in the same way.
    pub(crate) fn command(&self) -> String {
        let command = self.command_of_claims();
        let surface = CommandLine {
            command: Some(&command),
        };
        let call = surface.call(&self.choice.settings());
        call.unwrap_or(command)
    }
}
