//! What a judged item or a guarded number is about: which case, and which quantity of it.
//!
//! What the case is, its method and its terms, the case says itself. So a diagnosis never reads a
//! claim, evidence or another sentence.

/// What a check, a rate or a guarded number is about.
#[derive(Debug, Clone, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub struct Subject {
    /// The label of the case, or what the labels of several begin with; `None` for the study as a
    /// whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub case: Option<String>,
    /// The other case of a ratio or a difference, likewise: either may be the cause.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub against: Option<String>,
    /// The quantity, field or norm; empty if it is not known.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub quantity: String,
}

impl Subject {
    /// This quantity, of the study as a whole.
    pub fn of(quantity: impl Into<String>) -> Self {
        Self {
            quantity: quantity.into(),
            ..Self::default()
        }
    }

    /// The same of a case; below a case, of a part of it: `p = 3, n = 16`.
    #[must_use]
    pub fn in_case(self, case: impl Into<String>) -> Self {
        let case = case.into();
        let case = match self.case {
            Some(above) if !case.starts_with(&above) => format!("{above}, {case}"),
            _ => case,
        };
        Self {
            case: Some(case),
            ..self
        }
    }

    /// The same, compared with another case.
    #[must_use]
    pub fn against(self, case: impl Into<String>) -> Self {
        Self {
            against: Some(case.into()),
            ..self
        }
    }

    /// The quantity; `name` stands in for one that is not known.
    pub fn quantity_or<'s>(&'s self, name: &'s str) -> &'s str {
        if self.quantity.is_empty() {
            name
        } else {
            &self.quantity
        }
    }
}

/// What a guarded number is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Sort {
    /// An error at a level.
    Error,
    /// An observed rate.
    Rate,
    /// Any other number.
    #[default]
    Value,
}
