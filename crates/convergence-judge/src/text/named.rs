//! Numbers by name.

/// A number with its name: a parameter of a level, or an error in a norm.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedNumber {
    /// The name, unique in its list.
    pub name: String,
    /// The number; NaN where there is no result.
    pub value: f64,
}

impl NamedNumber {
    /// A number with its name.
    pub fn new(name: impl Into<String>, value: f64) -> Self {
        Self {
            name: name.into(),
            value,
        }
    }

    /// The number of this name in a list.
    pub fn find(list: &[Self], name: &str) -> Option<f64> {
        let known = list.iter().find(|known| known.name == name);
        known.map(|known| known.value)
    }
}
