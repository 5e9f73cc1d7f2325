//! `rates FILE...`: errors of any code, judged by the rule of the studies.

mod claims;
mod files;
mod refusal;
mod shown;

use std::io::{self, IsTerminal};
use std::path::PathBuf;

use clap::Args;
use serde_json::Value;

use super::exit::{Outcome, Unusable};
use super::flags::{self, Flags, number};
use super::screen::{self, Format};
use crate::input::advice::CommandLine;
use crate::input::error_table::{Choice, Column, RateTable};
use crate::judge::claims::Claim;
use crate::judge::richardson::{Estimate, Estimator};
use crate::judge::verdict::{self, Judge, RateVerdict, Verdict};
use crate::project::Project;
use crate::text::names::quoted;
pub use claims::Claimed;
use claims::claimed;
pub use refusal::Refusal;

/// Judge tables of step sizes and errors made elsewhere
///
/// The input may be tables, logs, lists or JSON. The step is the column that falls, or counts up,
/// by regular ratios; errors are positive and fall; rates are recognised by their numbers. A line
/// says how the table was read. Several tables of one file are judged each under its heading. Exit
/// status 0 if every rate with a claim agrees with its order, 1 if one does not, the data cannot
/// tell or nothing is claimed in a table, 2 if a table cannot be read: then the message has the
/// command that reads it.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The tables; `-` is standard input, which is read without a file, too
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The order that theory claims, for all columns or as NAME=P for one, '>=P' for the least; may
    /// be repeated. Without one nothing passes
    #[arg(long, value_name = "[NAME=]P", value_parser = claimed, allow_negative_numbers = true)]
    order: Vec<Claimed>,
    /// How far the rate may be from the order, above or below: 0 < T < 0.5, because bands of half
    /// an order around consecutive whole orders would overlap
    #[arg(long, value_name = "T", default_value_t = verdict::DEFAULT_TOLERANCE, value_parser = number, allow_negative_numbers = true)]
    tolerance: f64,
    /// Round-off, in the unit of the errors: the finest levels are dropped as long as their errors
    /// are not above E; 0 drops none
    ///
    /// A level above the floor is kept, and so are all levels coarser than it.
    #[arg(
        long,
        value_name = "E",
        default_value_t = 0.0,
        value_parser = number,
        allow_negative_numbers = true
    )]
    floor: f64,
    /// The column of the step, of a count or of levels: its name, or its number from 1
    #[arg(long, value_name = "COLUMN")]
    step: Option<String>,
    /// The columns of errors, by name or number, separated by commas; without it those whose
    /// numbers fall
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    columns: Option<Vec<String>>,
    /// Columns of values, which tend to an unknown limit: their differences are judged
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    values: Vec<String>,
    /// Names for all columns, instead of those in the table
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    names: Option<Vec<String>>,
    /// The column of the step counts cells, unknowns or steps in D dimensions: h = count^(-1/D)
    #[arg(long, value_name = "D", value_parser = dimension, allow_negative_numbers = true)]
    dim: Option<f64>,
    /// The column of the step numbers the levels of refinement, each with a step R times as small:
    /// h = R^(-level)
    #[arg(long, value_name = "R", value_parser = ratio, conflicts_with = "dim", allow_negative_numbers = true)]
    ratio: Option<f64>,
    /// Columns without a claim count, too: then nothing passes
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    flags: Flags,
}

fn dimension(text: &str) -> Result<f64, String> {
    let dim = text
        .parse()
        .ok()
        .filter(|dim| *dim > 0.0 && f64::is_finite(*dim));
    dim.ok_or_else(|| "expected a number > 0".to_owned())
}

fn ratio(text: &str) -> Result<f64, String> {
    let ratio = text
        .parse()
        .ok()
        .filter(|ratio| *ratio > 1.0 && f64::is_finite(*ratio));
    ratio.ok_or_else(|| "expected a number > 1".to_owned())
}

/// A column, judged.
struct JudgedColumn<'t> {
    column: &'t Column,
    /// Its order is NaN without a claim.
    claim: Claim,
    rate: RateVerdict,
    /// Only of a column of values.
    estimate: Option<Estimate>,
    /// Whether its verdict counts.
    decides: bool,
}

impl JudgedColumn<'_> {
    fn is_claimed(&self) -> bool {
        !self.rate.order.is_nan()
    }
}

/// A table that was read.
struct Source {
    /// As the command line names it.
    file: String,
    /// The file, and the heading of the table if the file has several.
    name: String,
    table: RateTable,
}

impl Source {
    /// * `heading`: of the table, if its file has several; otherwise empty.
    fn new(file: &str, heading: &str, table: RateTable) -> Self {
        let name = if heading.is_empty() {
            file.to_owned()
        } else {
            format!("{file}: {heading}")
        };
        Self {
            file: file.to_owned(),
            name,
            table,
        }
    }
}

/// Everything that is printed and written about a table.
struct Judgement<'t> {
    project: &'t Project,
    source: &'t Source,
    columns: Vec<JudgedColumn<'t>>,
    judge: &'t Judge,
    verdict: Verdict,
}

/// What is judged, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The orders that theory claims; without one nothing passes.
    pub claims: Vec<Claimed>,
    /// Allowed deviation of a rate from its order, above or below.
    pub tolerance: f64,
    /// Round-off, in the unit of the errors.
    pub floor: f64,
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

/// The object that `rates --format json` prints.
///
/// # Errors
/// [`Refusal`], if the tables cannot be read or the claims are about other columns.
pub fn object(project: &Project, tables: Tables<'_>, request: &Request) -> Result<Value, Refusal> {
    let rule = Rule::new(request)?;
    let sources = read(tables, &request.choice())?;
    let findings = judge(project, &sources, &rule, request)?;
    Ok(flags::object(
        verdict_of(&findings),
        &files::object_of_all(&findings),
    ))
}

/// Judges the tables, prints rates and verdicts, and writes the files requested.
///
/// # Errors
/// Tables or claims that cannot be used, and a folder that cannot be written.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let request = arguments.request();
    let files = arguments.files()?;
    let refused = |refusal| refuse(project, arguments, &refusal);
    let rule = Rule::new(&request).map_err(refused)?;
    let mut sources = vec![];
    for file in &files {
        sources.extend(read(Tables::File(file), &request.choice()).map_err(refused)?);
    }
    let findings = judge(project, &sources, &rule, &request).map_err(refused)?;
    let verdict = verdict_of(&findings);
    let flags = &arguments.flags;
    if let Some(folder) = &flags.out {
        files::write(&findings, verdict, folder)?;
    }
    let words = match flags.format {
        Format::Csv => files::csv(&findings),
        Format::Md => files::rows_in_markdown(&findings),
        Format::Text | Format::Json => {
            shown::text_of_all(&findings, verdict, flags.quiet, screen::verdict)
        }
    };
    Ok(flags.show("rates", verdict, &files::object_of_all(&findings), &words)?)
}

/// The refusal in the words of the command line; with `--format json` it is printed as an object,
/// too.
fn refuse(project: &Project, arguments: &Arguments, refusal: &Refusal) -> Unusable {
    let command = match refusal {
        Refusal::Table { file, .. } => Some(arguments.command(project, file)),
        Refusal::Claim(_) | Refusal::Rule(_) => None,
    };
    let surface = CommandLine {
        command: command.as_deref(),
    };
    match arguments.flags.print_refusal(&refusal.object(&surface)) {
        Ok(()) => Unusable::because(&refusal.words(&surface)),
        Err(error) => error.into(),
    }
}

impl Arguments {
    /// What the arguments say, but for the files.
    fn request(&self) -> Request {
        Request {
            claims: self.order.clone(),
            tolerance: self.tolerance,
            floor: self.floor,
            choice: Choice {
                step: self.step.clone(),
                columns: self.columns.clone(),
                values: self.values.clone(),
                names: self.names.clone(),
                claimed: vec![],
                dim: self.dim,
                ratio: self.ratio,
            },
            all: self.all,
        }
    }

    /// The files; without one standard input, unless it is a terminal.
    fn files(&self) -> Result<Vec<String>, Unusable> {
        if !self.files.is_empty() {
            let files = self.files.iter().map(|file| file.display().to_string());
            return Ok(files.collect());
        }
        if io::stdin().is_terminal() {
            return Err(Unusable::because(
                "rates: found no FILE; expected a table, or one that another program writes to standard input",
            ));
        }
        Ok(vec!["-".to_owned()])
    }

    /// The command that judges a file, without the settings of the reader.
    fn command(&self, project: &Project, file: &str) -> String {
        let orders = self.order.iter();
        let orders = orders.map(|claimed| format!(" --order {}", quoted(&claimed.text)));
        format!(
            "{} rates {file}{}",
            project.command,
            orders.collect::<String>()
        )
    }
}

impl Request {
    /// How the tables are read.
    fn choice(&self) -> Choice {
        let claims = self.claims.iter();
        Choice {
            claimed: claims.filter_map(|claimed| claimed.name.clone()).collect(),
            ..self.choice.clone()
        }
    }
}

/// The rule for errors and the rule for values.
struct Rule {
    judge: Judge,
    estimator: Estimator,
}

impl Rule {
    fn new(request: &Request) -> Result<Self, Refusal> {
        Ok(Self {
            judge: Judge::new(request.tolerance)?.with_floor(request.floor)?,
            estimator: Estimator::new(request.tolerance)?,
        })
    }
}

/// Reads all tables of a file or a text.
fn read(tables: Tables<'_>, choice: &Choice) -> Result<Vec<Source>, Refusal> {
    let (file, tables) = match tables {
        Tables::File(file) => (file, RateTable::read_all_with(file, choice)),
        Tables::Text(text) => (TEXT, RateTable::parse_all_with(text, TEXT, choice)),
    };
    let tables = tables.map_err(|error| Refusal::Table {
        file: file.to_owned(),
        error: Box::new(error),
    })?;
    let tables = tables.into_iter();
    Ok(tables
        .map(|(heading, table)| Source::new(file, &heading, table))
        .collect())
}

/// The judgements of all tables.
fn judge<'t>(
    project: &'t Project,
    sources: &'t [Source],
    rule: &'t Rule,
    request: &Request,
) -> Result<Vec<Judgement<'t>>, Refusal> {
    let claims = claims::claims(request, sources)?;
    let judged = |(source, claims): (&'t Source, Vec<Claim>)| {
        let columns = judged_columns(source, &claims, rule, request.all);
        let deciding = columns.iter().filter(|column| column.decides);
        let verdict = Verdict::worst(deciding.map(|column| column.rate.verdict));
        Judgement {
            project,
            source,
            columns,
            judge: &rule.judge,
            verdict,
        }
    };
    Ok(sources.iter().zip(claims).map(judged).collect())
}

/// The verdict on all tables.
fn verdict_of(findings: &[Judgement<'_>]) -> Verdict {
    Verdict::worst(findings.iter().map(|judgement| judgement.verdict))
}

/// The columns of a table with their judgements.
///
/// * `claims`: one for each column, errors first.
/// * `all`: whether columns without a claim count, too.
fn judged_columns<'t>(
    source: &'t Source,
    claims: &[Claim],
    rule: &Rule,
    all: bool,
) -> Vec<JudgedColumn<'t>> {
    let errors = source.table.columns.len();
    let judged = |(k, (column, claim)): (usize, (&'t Column, &Claim))| {
        let estimate = (k >= errors).then(|| column.estimate(&rule.estimator, claim.order));
        let rate = estimate.as_ref().map_or_else(
            || column.judge(&rule.judge, claim),
            |estimate| estimate.judged.clone(),
        );
        JudgedColumn {
            column,
            claim: *claim,
            rate,
            estimate,
            decides: all || !claim.order.is_nan(),
        }
    };
    let columns = columns(&source.table).zip(claims).enumerate();
    columns.map(judged).collect()
}

/// The columns to judge: errors, then values.
fn columns(table: &RateTable) -> impl Iterator<Item = &Column> + Clone {
    table.columns.iter().chain(&table.values)
}

#[cfg(test)]
mod tests {
    use clap::Args;

    use super::Arguments;
    use crate::input::advice::Argument;

    #[test]
    fn every_argument_of_a_message_is_an_option_of_the_command() {
        let command = Arguments::augment_args(clap::Command::new("rates"));
        for argument in Argument::ALL {
            let mut options = command.get_arguments();
            let option = options
                .find(|option| option.get_long() == Some(argument.name()))
                .unwrap_or_else(|| panic!("no --{}", argument.name()));
            let names = option.get_value_names().expect("a value");
            assert_eq!(names, [argument.placeholder()], "{}", argument.name());
        }
    }
}
