//! `rates FILE...`: errors of any code, judged by the rule of the studies.

mod files;
mod shown;

use std::io::{self, IsTerminal};
use std::path::PathBuf;

use clap::Args;

use super::exit::{Outcome, Unusable};
use super::flags::{Flags, number};
use super::screen::{self, Format};
use crate::input::error_table::{Choice, Column, RateTable, names::position};
use crate::judge::claims::{Claim, order_from_text};
use crate::judge::richardson::{Estimate, Estimator};
use crate::judge::verdict::{self, Judge, RateVerdict, Verdict};
use crate::project::Project;
use crate::text::names::{did_you_mean, nearest, quoted};

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

/// A value of `--order`.
#[derive(Debug, Clone)]
struct Claimed {
    /// As given.
    text: String,
    /// The column; `None` for all.
    name: Option<String>,
    order: f64,
    at_least: bool,
}

fn claimed(text: &str) -> Result<Claimed, String> {
    let at = text
        .rfind(">=")
        .or_else(|| text.rfind('=').map(|at| at + 1));
    let (name, order) = text.split_at(at.unwrap_or(0));
    let name = name.trim_end();
    let order = order_from_text(order).filter(|_| name.is_empty() || name.ends_with('='));
    let (order, at_least) = order
        .ok_or("expected a number > 0, '>=P' with such a number P, or NAME= before one of them")?;
    Ok(Claimed {
        text: text.to_owned(),
        name: name.strip_suffix('=').map(str::to_owned),
        order,
        at_least,
    })
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

/// Everything that is printed and written about a table.
struct Judgement<'t> {
    project: &'t Project,
    source: &'t Source,
    columns: Vec<JudgedColumn<'t>>,
    judge: &'t Judge,
    verdict: Verdict,
}

/// Judges the tables, prints rates and verdicts, and writes the files requested.
///
/// # Errors
/// Tables or claims that cannot be used, and a folder that cannot be written.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let judge = Judge::new(arguments.tolerance)?.with_floor(arguments.floor)?;
    let estimator = Estimator::new(arguments.tolerance)?;
    let sources = sources(project, arguments)?;
    let claims = claims(arguments, &sources)?;
    let judged = |(source, claims): (_, Vec<Claim>)| {
        let columns = judged_columns(source, &claims, &judge, &estimator, arguments.all);
        let deciding = columns.iter().filter(|column| column.decides);
        let verdict = Verdict::worst(deciding.map(|column| column.rate.verdict));
        Judgement {
            project,
            source,
            columns,
            judge: &judge,
            verdict,
        }
    };
    let findings: Vec<Judgement<'_>> = sources.iter().zip(claims).map(judged).collect();
    let verdict = Verdict::worst(findings.iter().map(|judgement| judgement.verdict));
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

/// The columns of a table with their judgements.
///
/// * `claims`: one for each column, errors first.
/// * `all`: whether columns without a claim count, too.
fn judged_columns<'t>(
    source: &'t Source,
    claims: &[Claim],
    judge: &Judge,
    estimator: &Estimator,
    all: bool,
) -> Vec<JudgedColumn<'t>> {
    let errors = source.table.columns.len();
    let judged = |(k, (column, claim)): (usize, (&'t Column, &Claim))| {
        let estimate = (k >= errors).then(|| column.estimate(estimator, claim.order));
        let rate = estimate.as_ref().map_or_else(
            || column.judge(judge, claim),
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

/// Reads the tables of all files; without a file those of standard input, unless it is a terminal.
fn sources(project: &Project, arguments: &Arguments) -> Result<Vec<Source>, Unusable> {
    let mut files: Vec<String> = arguments
        .files
        .iter()
        .map(|file| file.display().to_string())
        .collect();
    if files.is_empty() {
        if io::stdin().is_terminal() {
            return Err(Unusable::because(
                "rates: found no FILE; expected a table, or one that another program writes to standard input",
            ));
        }
        files.push("-".to_owned());
    }
    let mut sources = vec![];
    for file in files {
        let choice = choice(project, arguments, &file);
        for (heading, table) in RateTable::read_all_with(&file, &choice)? {
            let name = if heading.is_empty() {
                file.clone()
            } else {
                format!("{file}: {heading}")
            };
            let file = file.clone();
            sources.push(Source { file, name, table });
        }
    }
    Ok(sources)
}

/// What the arguments say about the table.
///
/// * `source`: the file, as the command that repeats the run names it.
fn choice(project: &Project, arguments: &Arguments, source: &str) -> Choice {
    let claims = arguments.order.iter();
    let names = claims.clone().filter_map(|claimed| claimed.name.clone());
    let options: String = claims
        .map(|claimed| format!(" --order {}", quoted(&claimed.text)))
        .collect();
    Choice {
        step: arguments.step.clone(),
        columns: arguments.columns.clone(),
        values: arguments.values.clone(),
        names: arguments.names.clone(),
        claimed: names.collect(),
        dim: arguments.dim,
        ratio: arguments.ratio,
        command: format!("{} rates {source}{options}", project.command),
    }
}

/// The columns to judge: errors, then values.
fn columns(table: &RateTable) -> impl Iterator<Item = &Column> + Clone {
    table.columns.iter().chain(&table.values)
}

/// The claims for each column of each table. Each column that is named must be in one of them.
fn claims(arguments: &Arguments, sources: &[Source]) -> Result<Vec<Vec<Claim>>, Unusable> {
    let all: Vec<&str> = sources
        .iter()
        .flat_map(|source| columns(&source.table))
        .map(|column| column.name.as_str())
        .collect();
    for claimed in &arguments.order {
        let is_in = |source: &Source, name: &str| {
            let names = columns(&source.table).map(|column| column.name.as_str());
            position(names, name).is_some()
        };
        if let Some(name) = &claimed.name
            && !sources.iter().any(|source| is_in(source, name))
        {
            return Err(unknown(name, &claimed.text, &all));
        }
    }
    sources
        .iter()
        .map(|source| claims_of(arguments, &source.table))
        .collect()
}

/// The claim for each column; the order is NaN without one.
fn claims_of(arguments: &Arguments, table: &RateTable) -> Result<Vec<Claim>, Unusable> {
    let names: Vec<&str> = columns(table).map(|column| column.name.as_str()).collect();
    // The last entry is the claim for all columns.
    let mut of: Vec<Option<&Claimed>> = vec![None; names.len() + 1];
    for claimed in &arguments.order {
        let text = &claimed.text;
        let place = claimed.name.as_deref().map_or(Some(names.len()), |name| {
            position(names.iter().copied(), name)
        });
        // Another table has the column.
        let Some(k) = place else { continue };
        if let Some(Claimed { text: first, .. }) = of[k].replace(claimed) {
            let expected = "expected one order for all columns, and --order NAME=P for others";
            return Err(Unusable::because(&match names.get(k) {
                Some(name) => format!(
                    "--order {text}: expected each column once; found `{name}` a second time"
                ),
                None => format!("{expected}; found --order {first} and --order {text}"),
            }));
        }
    }
    let claim = |(k, name): (usize, &&str)| match of[k].or(of[names.len()]) {
        Some(Claimed {
            order,
            at_least: true,
            ..
        }) if k >= table.columns.len() => {
            let found = format!("found --order '>={order}' for `{name}`");
            Err(Unusable::because(&format!(
                "expected an order alone for values; {found}"
            )))
        }
        Some(&Claimed {
            order, at_least, ..
        }) => Ok(Claim {
            at_least,
            ..Claim::new(order, arguments.tolerance)
        }),
        None => Ok(Claim::new(f64::NAN, arguments.tolerance)),
    };
    names.iter().enumerate().map(claim).collect()
}

/// The error of a claim about a column that is not judged.
fn unknown(name: &str, claim: &str, names: &[&str]) -> Unusable {
    /// Most names that a message lists.
    const LISTED: usize = 12;
    let more = if names.len() > LISTED { ", ..." } else { "" };
    let hint = if name.contains(['=', ',']) {
        "; repeat --order for each column".to_owned()
    } else {
        did_you_mean(&nearest(name, names.iter().copied()).map(str::to_owned))
    };
    let known = names[..names.len().min(LISTED)].join(", ") + more;
    Unusable::because(&format!(
        "--order {claim}: expected a column of errors: {known}; found `{name}`{hint}"
    ))
}
