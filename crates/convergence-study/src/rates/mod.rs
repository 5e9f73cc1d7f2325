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
#[cfg(feature = "command-line")]
mod latex;
#[cfg(feature = "reports")]
mod parts;
mod refusal;
mod shown;

use std::io;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use crate::exchange;
use crate::input::{self, Document};
#[doc(inline)]
pub use crate::input::{
    advice::{Argument, ArgumentValue, CommandLine, Setting, Surface},
    table::{Choice, Column, Doubt, FrameCell, FrameColumn, LeftOut, LineRange, Offer, RateTable},
};
use crate::judge::richardson::{Estimate, Estimator};
use crate::judge::verdict::{DEFAULT_TOLERANCE, Floor, JudgeError, RateVerdict, Verdict};
use crate::judge::{self, claims::Claim};
use crate::text::names::quoted;
use crate::text::number::plain_text;
use crate::text::visible::visible;
pub use claims::Claimed;
#[cfg(feature = "command-line")]
pub(crate) use forms::{cases, csv, rows_in_markdown};
pub(crate) use forms::{figure, markdown, object_of_all};
#[cfg(feature = "command-line")]
pub(crate) use latex::latex;
pub use refusal::Refusal;
pub(crate) use shown::{REASONS, sentence_of_all, text_of_all};

/// A column, judged.
pub(crate) struct JudgedColumn<'t> {
    pub(crate) column: &'t Column,
    pub(crate) claim: Option<Claim>,
    pub(crate) rate: RateVerdict,
    /// The same with factors for each unit of a count in place of rates, where they are claimed.
    factors: Option<RateVerdict>,
    /// Only of a column of values.
    estimate: Option<Estimate>,
    /// Whether its verdict counts.
    decides: bool,
}

impl Judgement<'_> {
    /// The file, and the heading of the table if the file has several.
    #[cfg(feature = "command-line")]
    pub(crate) fn name(&self) -> &str {
        &self.source.name
    }

    /// The columns that were set aside, each with the reason.
    #[cfg(feature = "command-line")]
    pub(crate) fn left_out(&self) -> Vec<(String, String)> {
        let left_out = self.source.table.left_out.iter();
        left_out
            .map(|one| (one.column.clone(), one.because.clone()))
            .collect()
    }
}

impl JudgedColumn<'_> {
    fn is_claimed(&self) -> bool {
        self.claim.is_some()
    }
}

/// A table that was read.
pub(crate) struct SourceTable {
    /// As the command line names it; in commands a text, which is in no file, is `FILE`.
    file: String,
    /// The file, and the heading of the table if the file has several.
    name: String,
    table: RateTable,
}

impl SourceTable {
    fn new(tables: Tables<'_>, table: RateTable) -> Self {
        let (file, name) = match tables {
            Tables::File(file) => (file, file),
            Tables::Text(_) => (FILE, TEXT),
        };
        let name = if table.name.is_empty() {
            name.to_owned()
        } else {
            format!("{name}: {}", table.name)
        };
        Self {
            file: file.to_owned(),
            name,
            table,
        }
    }
}

/// Everything that is printed and written about a table.
pub(crate) struct Judgement<'t> {
    /// The program of the caller, in the commands that advice names.
    program: &'t str,
    /// Of the command that judges the file in the same way.
    command_line: CommandLine,
    /// The command with a floor that makes it pass, where the finest errors may be round-off.
    command_with_floor: Option<String>,
    source: &'t SourceTable,
    columns: Vec<JudgedColumn<'t>>,
    floor: Floor,
    verdict: Verdict,
    /// Errors that are equal in all digits.
    equals: Vec<EqualColumns>,
}

/// Two columns of errors that are equal on all levels, in all digits.
pub(crate) struct EqualColumns {
    names: [String; 2],
    /// Whether both have claims, of which then neither passes.
    are_claimed: bool,
}

impl std::fmt::Display for EqualColumns {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [one, other] = self.names.each_ref().map(|name| visible(name));
        write!(f, "{one} and {other} are equal in all digits")
    }
}

/// What is judged, and how.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// The orders that theory claims; without one nothing passes.
    pub claims: Vec<Claimed>,
    /// Whether the claims are factors by which errors fall for each unit of a count or a degree.
    pub by_factor: bool,
    /// Allowed deviation of a rate from its order, above or below; that of [`Claim::usual`] without.
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

/// The name of a text in messages.
const TEXT: &str = "text";

/// The name of a file that the reader of a command puts in place.
const FILE: &str = "FILE";

impl Request {
    /// Judges tables: the object that `rates --format json` prints.
    ///
    /// * `program`: of the caller, in the commands that advice names.
    ///
    /// # Errors
    /// [`Refusal`], if the tables cannot be read or the claims are about other columns.
    pub fn object(&self, program: &str, tables: Tables<'_>) -> Result<Value, Refusal> {
        let sources = read(tables, &self.choice())?;
        let findings = judgements(program, &sources, self)?;
        Ok(exchange::object(
            verdict_of(&findings),
            &object_of_all(&findings),
        ))
    }

    /// Judges a text for a page.
    ///
    /// * `program`: as for [`Request::object`].
    ///
    /// # Errors
    /// As [`Request::object`].
    pub fn page(&self, program: &str, text: &str) -> Result<Page, Refusal> {
        let sources = read(Tables::Text(text), &self.choice())?;
        let findings = judgements(program, &sources, self)?;
        let verdict = verdict_of(&findings);
        let mut pages: Vec<String> = findings.iter().map(|one| markdown(one, "")).collect();
        pages.extend(verdict_in_markdown(&findings, verdict));
        Ok(Page {
            verdict,
            sentence: sentence_of_all(&findings),
            text: text_of_all(&findings, verdict, false, forms::plain_verdict),
            markdown: pages.join("\n"),
            object: exchange::object(verdict, &object_of_all(&findings)),
            tables: findings.iter().map(table_on_page).collect(),
        })
    }

    /// The command that judges a file in the same way.
    pub fn command(&self, program: &str, file: &str) -> String {
        let command_line = self.command_line(program, file);
        let command = command_line.call(&self.choice.settings());
        command.unwrap_or_default()
    }

    /// Where a refusal of tables of a file is read: the command line, whose offers keep the claims.
    pub fn command_line(&self, program: &str, file: &str) -> CommandLine {
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
    /// The scatter of samples says how well a level is known; a factor is one for each unit of a
    /// count, whatever steps are made of counts.
    pub fn ignored(&self) -> Option<[&'static str; 2]> {
        let by_samples = self.choice.samples.is_some();
        let has_ratio = self.choice.ratio.is_some();
        let options = [
            (by_samples, "samples", self.by_factor, "factor"),
            (by_samples, "samples", self.floor > 0.0, "floor"),
            (
                by_samples,
                "samples",
                !self.choice.values.is_empty(),
                "values",
            ),
            (by_samples, "samples", has_ratio, "ratio"),
            (self.by_factor, "factor", self.choice.dim.is_some(), "dim"),
            (self.by_factor, "factor", has_ratio, "ratio"),
        ];
        let both = options
            .into_iter()
            .find(|(one, _, other, _)| *one && *other);
        both.map(|(_, kept, _, ignored)| [kept, ignored])
    }

    /// What is known of round-off.
    fn floor(&self) -> Result<Floor, JudgeError> {
        let floor = Floor::new(self.floor)?.of_scale(self.scale.unwrap_or(1.0))?;
        floor.of_epsilon(self.eps.unwrap_or(f64::EPSILON))
    }
}

/// What a page shows of the tables of a text.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Page {
    /// The worst verdict of the tables.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub sentence: String,
    /// What `rates` prints.
    pub text: String,
    /// The same as `rates.md` has it, without pictures.
    pub markdown: String,
    /// What `rates --format json` prints.
    pub object: Value,
    /// The tables in the order of the text.
    pub tables: Vec<TableOnPage>,
}

/// What a page shows of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TableOnPage {
    /// Its heading, if the text has several tables; otherwise the name of the text.
    pub name: String,
    /// How it was read.
    pub reading: String,
    /// What speaks against it, each as an object with the settings that remove it.
    pub doubts: Vec<Value>,
    /// Steps, errors and rates as text: the names, then a row for each level.
    pub rows: Vec<Vec<String>>,
    /// The meaning of the marks in the rows, a line for each.
    pub legend: String,
    /// What is found of each column.
    pub columns: Vec<ColumnOnPage>,
    /// Errors over steps, as SVG.
    pub figure: String,
}

/// What a page shows of a column.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnOnPage {
    /// The name of the column.
    pub name: String,
    /// Its verdict; `None` if nothing is claimed.
    pub verdict: Option<Verdict>,
    /// Rate, claim, and the reason unless it is a pass.
    pub answer: String,
    /// What the reason means, and what to do; empty for a pass, and where nothing is claimed.
    pub advice: String,
}

/// The verdict on several tables, below them; an only one has its own.
pub(crate) fn verdict_in_markdown(findings: &[Judgement<'_>], verdict: Verdict) -> Option<String> {
    (findings.len() > 1).then(|| format!("**{verdict}**: {}\n", sentence_of_all(findings)))
}

fn table_on_page(judgement: &Judgement<'_>) -> TableOnPage {
    let columns = judgement.columns_with_rates();
    let table = &judgement.source.table;
    let column = |judged: &JudgedColumn<'_>| ColumnOnPage {
        name: judged.column.name.clone(),
        verdict: judged.is_claimed().then_some(judged.rate.verdict),
        answer: judged.answer(),
        advice: shown::advice_of_claim(judged, &table.step).unwrap_or_default(),
    };
    TableOnPage {
        name: judgement.source.name.clone(),
        reading: table.reading.clone(),
        doubts: forms::doubts(table),
        rows: judge::shown::rows(&table.step, &columns),
        legend: judge::shown::legend(&columns, judgement.floor.value()),
        columns: judgement.columns.iter().map(column).collect(),
        figure: figure(judgement),
    }
}

/// Reads all tables of a file or a text.
pub(crate) fn read(tables: Tables<'_>, choice: &Choice) -> Result<Vec<SourceTable>, Refusal> {
    const STANDARD_INPUT: &str = "standard input";
    let (name, text) = match tables {
        Tables::Text(text) => (TEXT, Ok(text.to_owned())),
        Tables::File("-") => (
            STANDARD_INPUT,
            input::read_from(STANDARD_INPUT, io::stdin().lock()),
        ),
        Tables::File(file) => (file, Document::text_of_file(Path::new(file))),
    };
    let read = text.and_then(|text| RateTable::parse_all_with(&text, name, choice));
    let read = read.map_err(|error| Refusal::Table {
        file: match tables {
            Tables::Text(_) => TEXT,
            Tables::File(file) => file,
        }
        .to_owned(),
        error: Box::new(error),
    })?;
    let read = read.into_iter();
    Ok(read.map(|table| SourceTable::new(tables, table)).collect())
}

/// The judgements of all tables.
pub(crate) fn judgements<'t>(
    program: &'t str,
    sources: &'t [SourceTable],
    request: &Request,
) -> Result<Vec<Judgement<'t>>, Refusal> {
    let floor = request.floor()?;
    let claims = claims::claims(request, sources)?;
    let judged = |(source, claims): (&'t SourceTable, Vec<Option<Claim>>)| {
        let mut columns = judged_columns(source, &claims, floor, request)?;
        let equals = equal_columns(&mut columns);
        let deciding = columns.iter().filter(|column| column.decides);
        let verdicts = deciding.map(|column| column.rate.verdict);
        // What a failed run has printed may look right.
        let doubts = source.table.doubts.iter();
        let doubts = doubts.filter(|doubt| counts(doubt, &columns));
        let verdict = Verdict::worst(verdicts.chain(doubts.map(|_| Verdict::Inconclusive)));
        Ok(Judgement {
            program,
            command_line: request.command_line(program, &source.file),
            command_with_floor: command_with_floor(program, source, request, &columns)?,
            source,
            columns,
            floor,
            verdict,
            equals,
        })
    };
    sources.iter().zip(claims).map(judged).collect()
}

/// The command with a floor that makes all columns pass that decide, if one is offered.
fn command_with_floor(
    program: &str,
    source: &SourceTable,
    request: &Request,
    columns: &[JudgedColumn<'_>],
) -> Result<Option<String>, JudgeError> {
    let offered = columns
        .iter()
        .filter_map(|judged| judged.rate.offered_floor);
    let Some(floor) = offered.reduce(f64::max) else {
        return Ok(None);
    };
    let request = Request {
        floor,
        ..request.clone()
    };
    let floor = request.floor()?;
    let passes = |judged: &JudgedColumn<'_>| match (&judged.claim, &judged.estimate) {
        (Some(claim), None) => judged.column.judge(claim, floor).verdict.is_pass(),
        _ => judged.rate.verdict.is_pass(),
    };
    let mut deciding = columns.iter().filter(|judged| judged.decides);
    Ok(deciding
        .all(passes)
        .then(|| request.command(program, &source.file)))
}

/// Whether a doubt speaks against the verdict: not one about an error without a claim.
fn counts(doubt: &Doubt, columns: &[JudgedColumn<'_>]) -> bool {
    let is_its = |judged: &&JudgedColumn<'_>| doubt.column.as_ref() == Some(&judged.column.name);
    columns
        .iter()
        .find(is_its)
        .is_none_or(|judged| judged.decides)
}

/// The verdict on all tables.
pub(crate) fn verdict_of(findings: &[Judgement<'_>]) -> Verdict {
    Verdict::worst(findings.iter().map(|judgement| judgement.verdict))
}

/// The columns of a table with their judgements.
///
/// * `claims`: one for each column, errors first.
fn judged_columns<'t>(
    source: &'t SourceTable,
    claims: &[Option<Claim>],
    floor: Floor,
    request: &Request,
) -> Result<Vec<JudgedColumn<'t>>, JudgeError> {
    let errors = source.table.columns.len();
    let judged = |(k, (column, claim)): (usize, (&'t Column, &Option<Claim>))| {
        let tolerance = claim.map_or(request.tolerance, |claim| Some(claim.tolerance));
        let estimator = Estimator::new(tolerance.unwrap_or(DEFAULT_TOLERANCE))?;
        let order = claim.map(|claim| claim.order);
        let estimate = (k >= errors).then(|| column.estimate(&estimator, order));
        let rate = match (&estimate, claim) {
            (Some(estimate), _) => estimate.judged.clone(),
            (None, Some(claim)) => column.judge(claim, floor),
            (None, None) => column.observe(floor),
        };
        let factors = request.by_factor.then(|| rate.as_factors());
        Ok(JudgedColumn {
            column,
            claim: *claim,
            rate,
            factors,
            estimate,
            decides: request.all || claim.is_some(),
        })
    };
    let columns = columns(&source.table).zip(claims).enumerate();
    columns.map(judged).collect()
}

/// Each column of errors that equals one before it; where both have claims, none of them passes.
fn equal_columns(columns: &mut [JudgedColumn<'_>]) -> Vec<EqualColumns> {
    let mut equals = vec![];
    for k in 0..columns.len() {
        let is_equal = |other: &usize| {
            let [one, other] = [&columns[*other], &columns[k]];
            one.estimate.is_none() && other.estimate.is_none() && one.column.equals(other.column)
        };
        let same: Vec<usize> = (0..k).filter(is_equal).collect();
        let claimed = same.iter().find(|same| columns[**same].is_claimed());
        let Some(&first) = claimed.or(same.first()) else {
            continue;
        };
        let are_claimed = columns[first].is_claimed() && columns[k].is_claimed();
        let names = [first, k].map(|k| columns[k].column.name.clone());
        if are_claimed {
            for (column, other) in [(first, &names[1]), (k, &names[0])] {
                let rate = columns[column].rate.clone();
                columns[column].rate = rate.equal_to(other);
            }
        }
        equals.push(EqualColumns { names, are_claimed });
    }
    equals
}

/// The columns to judge: errors, then values.
fn columns(table: &RateTable) -> impl Iterator<Item = &Column> + Clone {
    table.columns.iter().chain(&table.values)
}
