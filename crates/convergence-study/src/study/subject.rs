//! What a judged item or a guarded number is about, as data.
//!
//! A diagnosis groups and separates items by their subjects. It never reads a claim, evidence or
//! another sentence, so that their wording can be improved without changing what is concluded.

/// What a check, a rate or a guarded number is about.
#[derive(Debug, Clone, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub struct Subject {
    /// The case: an entry of the study's file, or a named run; `None` for the study as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub case: Option<String>,
    /// The quantity, field or norm; empty if it is not known.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub quantity: String,
    /// The method that computed it, in a word of the project; `None` if it is that of the study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<String>,
    /// The other method of a ratio or a difference: either may be the cause.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub against: Option<String>,
    /// The level of refinement, or another parameter that distinguishes numbers of one quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
}

impl Subject {
    /// This quantity, of the study as a whole.
    pub fn of(quantity: impl Into<String>) -> Self {
        Self {
            quantity: quantity.into(),
            ..Self::default()
        }
    }

    /// The same of a case.
    #[must_use]
    pub fn in_case(self, case: impl Into<String>) -> Self {
        Self {
            case: Some(case.into()),
            ..self
        }
    }

    /// The same by a method.
    #[must_use]
    pub fn by(self, method: impl Into<String>) -> Self {
        Self {
            method: Some(method.into()),
            ..self
        }
    }

    /// The same compared with another method.
    #[must_use]
    pub fn against(self, method: impl Into<String>) -> Self {
        Self {
            against: Some(method.into()),
            ..self
        }
    }

    /// The same by each of its methods.
    pub(crate) fn sides(&self) -> impl Iterator<Item = Self> {
        let other = self.against.clone().map(|method| self.clone().by(method));
        [self.clone()].into_iter().chain(other)
    }

    /// The same at a level.
    #[must_use]
    pub fn at(self, level: impl Into<String>) -> Self {
        Self {
            level: Some(level.into()),
            ..self
        }
    }

    /// Whether nothing is known, as in records of earlier versions.
    pub fn is_unknown(&self) -> bool {
        *self == Self::default()
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
pub enum Sort {
    /// An error at a level.
    Error,
    /// An observed rate.
    Rate,
    /// Any other number.
    #[default]
    Value,
}
