//! Sentences for people.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A text with a capital letter first.
pub fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// A sentence for people: it is printed and stored, and nothing is concluded from it.
///
/// What a program needs to know stands beside it as data: a verdict, a reason by name, a subject.
/// So this type cannot be searched, parted or compared with a text, and a better wording changes
/// nothing else. Whether there is a sentence at all is the one thing that it tells.
///
/// ```
/// use convergence_judge::Prose;
///
/// let evidence = Prose::from("drift 3e-13");
/// assert_eq!(evidence.to_string(), "drift 3e-13");
/// ```
///
/// ```compile_fail,E0599
/// # use convergence_judge::Prose;
/// Prose::from("drift 3e-13").contains("3e-13");
/// ```
///
/// ```compile_fail,E0369
/// # use convergence_judge::Prose;
/// Prose::from("drift 3e-13") == "drift 3e-13";
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Prose(String);

impl Prose {
    /// Whether there is nothing to print.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// This sentence and another, parted by a semicolon; either may be empty.
    #[must_use]
    pub fn then(&self, more: &Self) -> Self {
        match (self.is_empty(), more.is_empty()) {
            (true, _) => more.clone(),
            (_, true) => self.clone(),
            _ => Self(format!("{self}; {more}")),
        }
    }
}

impl From<&str> for Prose {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

impl From<String> for Prose {
    fn from(text: String) -> Self {
        Self(text)
    }
}

impl fmt::Display for Prose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
