//! `rates FILE`: errors of any code, judged by the rule of the studies.

mod advice;
mod shown;

use std::path::PathBuf;

use clap::Args;

use super::exit::{Outcome, Unusable};
use super::flags::Flags;
use crate::input::error_table::{Choice, Column, RateTable, names::position};
use crate::judge::richardson::{Estimate, Estimator};
use crate::judge::verdict::{self, Judge, RateVerdict, Verdict};
use crate::project::Project;
use crate::text::names::{did_you_mean, nearest};

/// Judge a table of step sizes and errors made elsewhere
///
/// Tables, logs, lists and JSON are read. The step is what falls, or counts up, by regular ratios; errors are
/// positive and fall; rates are recognised by their numbers. A line
/// says how the table was read. Exit status 0 where every rate with a claim agrees with its order, 1 where one does
/// not, the data cannot tell or nothing is claimed, 2 where the
/// table cannot be read: then the message has the command that reads it.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The table, - for standard input
    file: PathBuf,
    /// The order that theory claims, for all columns or as NAME=P for one; may be repeated. Without one nothing passes
    #[arg(long, value_name = "[NAME=]P", value_parser = claim, allow_negative_numbers = true)]
    order: Vec<(Option<String>, f64)>,
    /// How far the rate may be from the order, above or below: 0 < T < 0.5, for half an order accepts two whole ones
    #[arg(long, value_name = "T", default_value_t = verdict::DEFAULT_TOLERANCE, allow_negative_numbers = true)]
    tolerance: f64,
    /// Round-off, in the unit of the errors: the finest levels have no say as long as their errors are not above E; 0
    /// drops none
    ///
    /// A level above the floor keeps its say, and so do all levels coarser than it.
    #[arg(long, value_name = "E", default_value_t = verdict::ROUND_OFF_FLOOR, allow_negative_numbers = true)]
    floor: f64,
    /// The column of the step, or of a count: its name, or its number from 1
    #[arg(long, value_name = "COLUMN")]
    step: Option<String>,
    /// The columns of errors, by name or number, separated by commas; without it those whose numbers fall
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    columns: Option<Vec<String>>,
    /// Columns of values, which tend to a limit that nobody knows: their differences are judged
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    values: Vec<String>,
    /// Names for all columns, in place of those in the table
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    names: Option<Vec<String>>,
    /// The column of the step counts cells, unknowns or steps in D dimensions: h = count^(-1/D)
    #[arg(long, value_name = "D", value_parser = dimension, allow_negative_numbers = true)]
    dim: Option<f64>,
    /// Columns without a claim decide, too: with one of them nothing passes
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    flags: Flags,
}

fn claim(text: &str) -> Result<(Option<String>, f64), String> {
    let (name, order) = text.rsplit_once('=').map_or((None, text), |(name, order)| (Some(name.to_owned()), order));
    match dimension(order.trim()) {
        Ok(order) => Ok((name, order)),
        Err(_) => Err("expected a number > 0, or NAME= and a number > 0".to_owned()),
    }
}

fn dimension(text: &str) -> Result<f64, String> {
    let dim = text.parse().ok().filter(|dim| *dim > 0.0 && f64::is_finite(*dim));
    dim.ok_or_else(|| "expected a number > 0".to_owned())
}

/// A column, judged; the order of one without a claim is NaN.
struct Judged<'t> {
    column: &'t Column,
    rate: RateVerdict,
    /// Of a column of values.
    estimate: Option<Estimate>,
    /// Whether its verdict counts.
    decides: bool,
}

impl Judged<'_> {
    fn is_claimed(&self) -> bool {
        !self.rate.order.is_nan()
    }
}

/// All that is printed and written.
struct Findings<'t> {
    project: &'t Project,
    source: String,
    table: &'t RateTable,
    columns: Vec<Judged<'t>>,
    judge: &'t Judge,
    verdict: Verdict,
}

/// Judges the table, prints rates and verdicts, and writes what is asked for.
///
/// # Errors
/// A table or claims that cannot be used, and a folder that cannot be written to.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let judge = Judge::new(arguments.tolerance)?.with_floor(arguments.floor)?;
    let source = arguments.file.display().to_string();
    let claims: String = arguments
        .order
        .iter()
        .map(|(name, order)| match name {
            Some(name) => format!(" --order '{name}={order}'"),
            None => format!(" --order {order}"),
        })
        .collect();
    let choice = Choice {
        step: arguments.step.clone(),
        columns: arguments.columns.clone(),
        values: arguments.values.clone(),
        names: arguments.names.clone(),
        claimed: arguments.order.iter().filter_map(|(name, _)| name.clone()).collect(),
        dim: arguments.dim,
        command: format!("{} rates {source}{claims}", project.command),
    };
    let table = RateTable::read_with(&arguments.file, &choice)?;
    let orders = orders(arguments, &table)?;
    let mut columns = vec![];
    for (k, column) in all(&table).enumerate() {
        let order = orders[k];
        let estimator = if k < table.columns.len() { None } else { Some(Estimator::new(arguments.tolerance)?) };
        let estimate = estimator.map(|estimator| column.estimate(&estimator, order));
        let rate = estimate.as_ref().map_or_else(|| column.judge(&judge, order), |estimate| estimate.judged.clone());
        columns.push(Judged { column, rate, estimate, decides: arguments.all || !order.is_nan() });
    }
    let verdict = Verdict::worst(columns.iter().filter(|column| column.decides).map(|column| column.rate.verdict));
    let findings = Findings { project, source, table: &table, columns, judge: &judge, verdict };
    let flags = &arguments.flags;
    if let Some(folder) = &flags.out {
        shown::write(&findings, folder)?;
    }
    flags.show("rates", verdict, &shown::object(&findings), &shown::text(&findings, flags.quiet))?;
    Ok(verdict.into())
}

/// The columns that are judged: errors, then values.
fn all(table: &RateTable) -> impl Iterator<Item = &Column> + Clone {
    table.columns.iter().chain(&table.values)
}

/// The order that is claimed of each column, NaN for none.
fn orders(arguments: &Arguments, table: &RateTable) -> Result<Vec<f64>, Unusable> {
    let names = || all(table).map(|column| column.name.as_str());
    let for_all: Vec<f64> =
        arguments.order.iter().filter(|(name, _)| name.is_none()).map(|(_, order)| *order).collect();
    if let [first, second, ..] = for_all[..] {
        let expected = "expected one order for all columns, and --order NAME=P for others";
        return Err(Unusable::because(&format!("{expected}; found --order {first} and --order {second}")));
    }
    let mut orders = vec![for_all.first().copied().unwrap_or(f64::NAN); names().count()];
    let mut named = vec![];
    for (name, order) in &arguments.order {
        let Some(name) = name else { continue };
        let k = position(names(), name).ok_or_else(|| unknown(name, *order, table))?;
        if named.contains(&k) {
            let found = format!(
                "--order {name}={order}: expected each column once; found `{}` a second time",
                names().nth(k).unwrap_or(name)
            );
            return Err(Unusable::because(&found));
        }
        named.push(k);
        orders[k] = *order;
    }
    Ok(orders)
}

/// What is wrong with a claim about a column that is not judged.
fn unknown(name: &str, order: f64, table: &RateTable) -> Unusable {
    let names = || all(table).map(|column| column.name.as_str());
    let known: Vec<&str> = names().take(LISTED).collect();
    let more = if names().count() > LISTED { ", ..." } else { "" };
    let hint = if name.contains('=') || name.contains(',') {
        "; repeat --order for each column".to_owned()
    } else {
        did_you_mean(&nearest(name, names()).map(str::to_owned))
    };
    let known = known.join(", ") + more;
    Unusable::because(&format!("--order {name}={order}: expected a column of errors: {known}; found `{name}`{hint}"))
}

/// Most names that a message lists.
const LISTED: usize = 12;
