//! Messages that name the arguments of a call, and the calls that they offer: each caller prints
//! them in its own words, as options of a command or as arguments of a function.

use std::fmt;
use std::ops::Add;

use serde::Serialize;

use crate::text::names::quoted;

/// What says how a table is read and judged: an option of a command, or an argument of a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Argument {
    /// The order that theory claims.
    Order,
    /// The column of the step.
    Step,
    /// The columns of errors.
    Columns,
    /// The columns of values.
    Values,
    /// Names for all columns.
    Names,
    /// The dimension of what a count counts.
    Dim,
    /// The ratio of the steps of consecutive levels.
    Ratio,
    /// The lines of the table.
    Lines,
}

impl Argument {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Order,
        Self::Step,
        Self::Columns,
        Self::Values,
        Self::Names,
        Self::Dim,
        Self::Ratio,
        Self::Lines,
    ];

    /// Its name: that of an option without dashes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Order => "order",
            Self::Step => "step",
            Self::Columns => "columns",
            Self::Values => "values",
            Self::Names => "names",
            Self::Dim => "dim",
            Self::Ratio => "ratio",
            Self::Lines => "lines",
        }
    }

    /// What stands for its value.
    pub fn placeholder(self) -> &'static str {
        match self {
            Self::Order => "[NAME=]P",
            Self::Step => "COLUMN",
            Self::Columns | Self::Values | Self::Names => "LIST",
            Self::Dim => "D",
            Self::Ratio => "R",
            Self::Lines => "A-B",
        }
    }

    /// Its name in a message.
    pub(crate) fn alone(self) -> Text {
        Text(vec![MessagePart::Argument {
            argument: self,
            value: None,
        }])
    }

    /// The same with a value as the caller writes it.
    pub(crate) fn with(self, value: &str) -> Text {
        Text(vec![MessagePart::Argument {
            argument: self,
            value: Some(value.to_owned()),
        }])
    }

    /// The same with what stands for its value.
    pub(crate) fn with_placeholder(self) -> Text {
        self.with(self.placeholder())
    }
}

/// A part of a message; in JSON a text, or an object with an argument.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum MessagePart {
    /// Words, which name no argument.
    Words(String),
    /// An argument.
    Argument {
        /// Which one.
        argument: Argument,
        /// Its value as the caller writes it, or what stands for a value.
        value: Option<String>,
    },
}

impl MessagePart {
    fn words(&self, surface: &dyn Surface) -> String {
        match self {
            Self::Words(words) => words.clone(),
            Self::Argument { argument, value } => surface.argument(*argument, value.as_deref()),
        }
    }
}

/// A message, or a part of one, that may name arguments. Shown in the words of the command line.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Text(Vec<MessagePart>);

impl Text {
    /// Its parts in order.
    pub fn parts(&self) -> &[MessagePart] {
        &self.0
    }

    /// The message in the words of a surface.
    pub fn words(&self, surface: &dyn Surface) -> String {
        self.0.iter().map(|part| part.words(surface)).collect()
    }
}

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&CommandLine::default()))
    }
}

impl From<&str> for Text {
    fn from(words: &str) -> Self {
        words.to_owned().into()
    }
}

impl From<String> for Text {
    fn from(words: String) -> Self {
        Self(vec![MessagePart::Words(words)])
    }
}

impl<T: Into<Self>> Add<T> for Text {
    type Output = Self;

    fn add(mut self, more: T) -> Self {
        self.0.extend(more.into().0);
        self
    }
}

/// An argument with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Which argument.
    pub argument: Argument,
    /// Its value.
    pub value: ArgumentValue,
}

/// The value of an argument.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ArgumentValue {
    /// A number.
    Number(f64),
    /// A column, by its name or its number from 1.
    Name(String),
    /// Several columns.
    Names(Vec<String>),
}

impl ArgumentValue {
    /// `None` without names.
    pub(crate) fn names(names: &[String]) -> Option<Self> {
        (!names.is_empty()).then(|| Self::Names(names.to_vec()))
    }
}

/// The value of an option: several columns are separated by commas.
impl fmt::Display for ArgumentValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Name(name) => f.write_str(name),
            Self::Names(names) => f.write_str(&names.join(",")),
        }
    }
}

/// Where messages are read: how a caller writes arguments and calls.
pub trait Surface {
    /// An argument in a sentence, with a value if one is given.
    fn argument(&self, argument: Argument, value: Option<&str>) -> String;

    /// The call that was refused, with these settings in place of its own; `None` if it cannot have
    /// them.
    fn call(&self, settings: &[Setting]) -> Option<String>;
}

/// The command line: `--dim 2`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct CommandLine {
    /// The command without the settings of the reader; without one, no call is offered.
    pub command: Option<String>,
}

impl Surface for CommandLine {
    fn argument(&self, argument: Argument, value: Option<&str>) -> String {
        let value = value.map_or(String::new(), |value| format!(" {value}"));
        format!("--{}{value}", argument.name())
    }

    fn call(&self, settings: &[Setting]) -> Option<String> {
        let mut call = self.command.clone()?;
        for Setting { argument, value } in settings {
            let value = quoted(&value.to_string());
            call += " ";
            call += &self.argument(*argument, Some(&value));
        }
        Some(call)
    }
}
