//! Errors of any code, judged by the rule of the studies: tables of a text or a file, the claims
//! about their columns, and what is found, in words and for programs, as the command `rates` has
//! it. Nothing here needs files, threads or a clock, but for a file that a caller names.
//!
//! ```
//! use convergence_study::rates::{Request, Tables};
//!
//! let text = "h L2\n0.4 0.16\n0.2 0.041\n0.1 0.0103\n0.05 0.00257\n";
//! let request = Request {
//!     claims: vec!["L2=2".parse().expect("a claim")],
//!     ..Request::default()
//! };
//! let found = request.object("rates", Tables::Text(text)).expect("a table");
//! assert_eq!(found["verdict"], "pass");
//! ```

mod claims;
mod forms;
mod judgement;
#[cfg(feature = "command-line")]
mod latex;
mod page;
mod refusal;
mod shown;

use std::borrow::Cow;
use std::io;
use std::path::Path;

use serde_json::Value;

use crate::exchange;
use crate::input::advice::CommandLine;
use crate::input::{self, Document};
#[doc(inline)]
pub use crate::input::{
    advice::{Argument, ArgumentValue, Setting, Surface},
    table::{Choice, Column, FrameCell, FrameColumn, LeftOut, LineRange, RateTable},
};
use crate::text::names::quoted;
use crate::text::number::plain_text;
pub use claims::Claimed;
use convergence_judge::verdict::{Floor, JudgeError};
#[cfg(feature = "command-line")]
pub(crate) use forms::{csv, rows_in_markdown};
pub(crate) use forms::{
    figure, figure_without_verdict, markdown, object_of_all, verdict_in_markdown,
};
pub(crate) use judgement::{JudgedColumn, Judgement, judgements, verdict_of};
#[cfg(feature = "command-line")]
pub(crate) use latex::latex;
pub use refusal::NotJudged;
pub(crate) use shown::{REASONS, sentence, text_of_all};

/// What is judged, and how.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// The orders that theory claims; without one nothing passes.
    pub claims: Vec<Claimed>,
    /// Whether the claims are factors by which errors fall for each unit of a count or a degree.
    pub by_factor: bool,
    /// Allowed deviation of a rate from its order, above or below; that of
    /// [`Claim::usual`](crate::Claim::usual) without.
    pub tolerance: Option<f64>,
    /// Round-off, in the unit of the errors; 0 if it is not known.
    pub floor: f64,
    /// The size of the solution; 1 without.
    pub scale: Option<f64>,
    /// The relative round-off of numbers; that of double precision without.
    pub eps: Option<f64>,
    /// How the tables are read; the columns with a claim need not be named again.
    pub choice: Choice,
    /// Whether columns without a claim count, too.
    pub all: bool,
}

/// Where tables come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tables<'t> {
    /// A file; `-` is standard input.
    File(&'t str),
    /// A text.
    Text(&'t str),
}

impl<'t> Tables<'t> {
    /// As the caller names them.
    fn name(self) -> &'t str {
        match self {
            Self::File(file) => file,
            Self::Text(_) => "text",
        }
    }

    /// In commands: the reader of one puts the name of a file in place of that of a text.
    fn file(self) -> &'t str {
        match self {
            Self::File(file) => file,
            Self::Text(_) => "FILE",
        }
    }
}

impl Request {
    /// Judges tables: the object that `rates --format json` prints.
    ///
    /// * `program`: of the caller, in the commands that advice names.
    ///
    /// # Errors
    /// [`NotJudged`], if the tables cannot be read or the claims are about other columns.
    pub fn object(&self, program: &str, tables: Tables<'_>) -> Result<Value, NotJudged> {
        let sources = read(tables, &self.choice())?;
        let findings = judgements(program, &sources, self)?;
        let object = object_of_all(&findings);
        Ok(exchange::object(verdict_of(&findings), &object))
    }

    /// What a page shows of the tables of a text: an object with `verdict`; `sentence`; `text`, as
    /// `rates` prints it; `markdown`; `object`, which `rates --format json` prints; and `tables`,
    /// each with its `name`, `reading`, `doubts`, `rows`, `legend`, `columns` and `figure`. A
    /// column has `name`, `verdict`, which is null if nothing is claimed, `answer` and `advice`.
    ///
    /// * `program`: as for [`Request::object`].
    ///
    /// # Errors
    /// As [`Request::object`].
    pub fn page(&self, program: &str, text: &str) -> Result<Value, NotJudged> {
        let sources = read(Tables::Text(text), &self.choice())?;
        Ok(page::page(&judgements(program, &sources, self)?))
    }

    /// The command that judges a file in the same way.
    pub fn command(&self, program: &str, file: &str) -> String {
        let command_line = self.command_line(program, file);
        let command = command_line.call(&self.choice.settings());
        command.unwrap_or_default()
    }

    /// Where a refusal of tables of a file is read: the command line, whose offers keep the claims.
    pub fn command_line(&self, program: &str, file: &str) -> impl Surface + use<> {
        let option = if self.by_factor { "factor" } else { "order" };
        let claims = self.claims.iter();
        let claims = claims.map(|claimed| format!(" --{option} {}", quoted(&claimed.text)));
        let floor = Some(self.floor).filter(|floor| *floor > 0.0);
        let numbers = [
            ("tolerance", self.tolerance),
            ("floor", floor),
            ("scale", self.scale),
            ("eps", self.eps),
        ];
        let numbers = numbers
            .into_iter()
            .filter_map(|(option, number)| Some(format!(" --{option} {}", plain_text(number?))));
        let samples = self.choice.samples;
        let samples = samples.map(|of| format!(" --samples --of {of}"));
        let options: String = claims.chain(numbers).chain(samples).collect();
        CommandLine {
            command: Some(format!("{program} rates {file}{options}")),
        }
    }

    /// How the tables are read.
    pub(crate) fn choice(&self) -> Choice {
        let claims = self.claims.iter();
        Choice {
            claimed: claims.filter_map(|claimed| claimed.name.clone()).collect(),
            by_unit: self.by_factor,
            ..self.choice.clone()
        }
    }

    /// An option that another one would make the reader of tables ignore, with that other one. The
    /// command line refuses the same options.
    ///
    /// The scatter of samples says how well a level is known; a factor is one of errors, for each unit
    /// of a count, whatever steps are made of counts.
    pub fn ignored(&self) -> Option<[&'static str; 2]> {
        let beside_samples = [
            ("factor", self.by_factor),
            ("floor", self.floor > 0.0),
            ("values", !self.choice.values.is_empty()),
            ("ratio", self.choice.ratio.is_some()),
        ];
        let beside_factor = [
            ("values", !self.choice.values.is_empty()),
            ("dim", self.choice.dim.is_some()),
            ("ratio", self.choice.ratio.is_some()),
        ];
        let (kept, others) = match self.choice.samples {
            Some(_) => ("samples", &beside_samples[..]),
            None if self.by_factor => ("factor", &beside_factor[..]),
            None => return None,
        };
        let ignored = others.iter().find(|(_, is_set)| *is_set)?;
        Some([kept, ignored.0])
    }

    /// What is known of round-off.
    fn floor(&self) -> Result<Floor, JudgeError> {
        let floor = Floor::new(self.floor)?.of_scale(self.scale.unwrap_or(1.0))?;
        floor.of_epsilon(self.eps.unwrap_or(f64::EPSILON))
    }
}

/// A table that was read.
pub(crate) struct SourceTable {
    /// In commands.
    file: String,
    /// The file, and the heading of the table if the file has several.
    pub(crate) name: String,
    pub(crate) table: RateTable,
}

/// Reads all tables of a file or a text.
pub(crate) fn read(tables: Tables<'_>, choice: &Choice) -> Result<Vec<SourceTable>, NotJudged> {
    const STANDARD_INPUT: &str = "standard input";
    let name = tables.name();
    let (shown, text) = match tables {
        Tables::Text(text) => (name, Ok(Cow::Borrowed(text))),
        Tables::File("-") => {
            let text = input::read_from(STANDARD_INPUT, io::stdin().lock());
            (STANDARD_INPUT, text.map(Cow::Owned))
        }
        Tables::File(file) => {
            let text = Document::text_of_file(Path::new(file));
            (name, text.map(Cow::Owned))
        }
    };
    let read = text.and_then(|text| RateTable::parse_all_with(&text, shown, choice));
    let read = read.map_err(|error| NotJudged::Table {
        file: name.to_owned(),
        error: Box::new(error),
    })?;
    let sources = read.into_iter().map(|table| SourceTable {
        file: tables.file().to_owned(),
        name: match table.name.as_str() {
            "" => name.to_owned(),
            heading => format!("{name}: {heading}"),
        },
        table,
    });
    Ok(sources.collect())
}
