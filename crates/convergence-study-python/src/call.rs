//! Refusals in the words of Python: `dim=2`, and the call with other arguments.

use convergence_study::rates::{Argument, ArgumentValue, Setting, Surface};
use pyo3::prelude::*;
use pyo3::types::PyString;

/// A call that was refused.
pub(crate) struct Call<'py> {
    py: Python<'py>,
    /// Without the settings of the reader, and without its end.
    start: String,
    /// The settings that the function has as arguments.
    arguments: &'static [Argument],
}

/// The settings that `judge` and `assert_order` have.
pub(crate) const OF_JUDGE: &[Argument] = &[
    Argument::Step,
    Argument::Columns,
    Argument::Names,
    Argument::Dim,
    Argument::Ratio,
];

impl<'py> Call<'py> {
    /// A function with its first argument and the claim.
    ///
    /// * `claim`: the argument that has it, and its value.
    pub(crate) fn new(
        py: Python<'py>,
        function: &str,
        first: &str,
        claim: (&str, Option<&Bound<'_, PyAny>>),
        arguments: &'static [Argument],
    ) -> PyResult<Self> {
        let mut start = format!("{function}({first}");
        if let (name, Some(claim)) = claim {
            start += &format!(", {name}={}", claim.repr()?);
        }
        Ok(Self {
            py,
            start,
            arguments,
        })
    }

    /// A column: its number from 1, or its name.
    fn column(&self, name: &str) -> String {
        let is_number = name.parse().is_ok_and(|k: usize| k.to_string() == name);
        if is_number {
            name.to_owned()
        } else {
            literal(self.py, name)
        }
    }
}

/// A text as Python writes it.
pub(crate) fn literal(py: Python<'_>, text: &str) -> String {
    let written = PyString::new(py, text).repr();
    written.map_or_else(|_| format!("{text:?}"), |written| written.to_string())
}

impl Surface for Call<'_> {
    fn argument(&self, argument: Argument, value: Option<&str>) -> String {
        format!("{}={}", argument.name(), value.unwrap_or("..."))
    }

    fn call(&self, settings: &[Setting]) -> Option<String> {
        let mut call = self.start.clone();
        for Setting { argument, value } in settings {
            if !self.arguments.contains(argument) {
                return None;
            }
            let value = match value {
                ArgumentValue::Number(number) => number.to_string(),
                ArgumentValue::Name(name) => self.column(name),
                ArgumentValue::Names(names) => {
                    let columns = names.iter().map(|name| self.column(name));
                    format!("[{}]", columns.collect::<Vec<_>>().join(", "))
                }
            };
            call += &format!(", {}={value}", argument.name());
        }
        Some(call + ")")
    }
}
