//! What the page asks.

use convergence_judge::text::names::quoted;
use convergence_study::rates::{Choice, Claimed, Request};
use serde::Deserialize;
use serde_json::{Map, Value};

use crate::refused::Refused;
use crate::{FILE, LONGEST_TEXT, PROGRAM};

/// A text, and the options of the command `rates` under their names.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Question {
    /// The tables.
    pub(crate) text: String,
    /// Values of `--order`.
    #[serde(default)]
    order: Vec<String>,
    /// Values of `--factor`.
    #[serde(default)]
    factor: Vec<String>,
    #[serde(default)]
    tolerance: Option<f64>,
    #[serde(default)]
    floor: Option<f64>,
    #[serde(default)]
    scale: Option<f64>,
    #[serde(default)]
    eps: Option<f64>,
    /// The value of `--of`, with `--samples`.
    #[serde(default)]
    samples: Option<String>,
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
        let claims = [("order", &self.order), ("factor", &self.factor)];
        let claims: Result<Vec<Claimed>, Refused> = claims
            .into_iter()
            .flat_map(|(option, claims)| claims.iter().map(move |claim| (option, claim)))
            .map(|(option, claim)| {
                claim.parse().map_err(|expected: String| {
                    Refused::because(&format!("--{option} {}: {expected}", quoted(claim)))
                })
            })
            .collect();
        let samples = self.samples.as_deref().map(str::parse).transpose();
        let request = Request {
            claims: claims?,
            by_factor: !self.factor.is_empty(),
            tolerance: self.tolerance,
            floor: self.floor.unwrap_or(0.0),
            scale: self.scale,
            eps: self.eps,
            choice: Choice {
                samples: samples
                    .map_err(|expected: String| Refused::because(&format!("--of: {expected}")))?,
                ..self.choice.clone()
            },
            ..Request::default()
        };
        // A floor of zero is one, too.
        let floor = self.floor.and(request.choice.samples);
        let floor = floor.map(|_| ["samples", "floor"]);
        let order = (request.by_factor && !self.order.is_empty()).then_some(["factor", "order"]);
        match request.ignored().or(floor).or(order) {
            Some([kept, ignored]) => Err(Refused::because(&format!(
                "expected --{kept} without --{ignored}; found both"
            ))),
            None => Ok(request),
        }
    }
}
