//! `rates FILE`: errors of any code, judged by the rule of the studies.

mod advice;
mod files;
mod object;
mod text;

use std::collections::{BTreeMap, HashSet};
use std::path::PathBuf;

use crate::input::error_table::{Choice, RateTable, names::position};
use crate::judge::verdict::{self, Judge, RateVerdict, Verdict};
use crate::project::Project;
use crate::text::names::{did_you_mean, nearest};
use clap::Args;

use super::exit::{Outcome, Unusable};
use super::flags::Flags;

/// Judge a table of step sizes and errors made elsewhere
///
/// One column is the step, h or dt, or a count such as cells; errors are the others that no name shows to be something else. Exit status 0 where every rate with a claim agrees
/// with its order, 1 where one does not, the data cannot tell or nothing is claimed, 2 where the table cannot be read.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The table, - for standard input: CSV, aligned columns, Markdown or LaTeX
    file: PathBuf,
    /// The order that theory claims, for all columns or as NAME=P for one; may be repeated. Without one nothing passes
    #[arg(long, value_name = "[NAME=]P", value_parser = claim, allow_negative_numbers = true)]
    order: Vec<(Option<String>, f64)>,
    /// How far the rate may be from the order, above or below: 0 < T < 0.5, for half an order accepts two whole ones
    #[arg(long, value_name = "T", default_value_t = verdict::DEFAULT_TOLERANCE, allow_negative_numbers = true)]
    tolerance: f64,
    /// Round-off, in the unit of the errors: the finest levels have no say as long as their errors are not above E; 0 drops none
    ///
    /// A level above the floor keeps its say, and so do all levels coarser than it.
    #[arg(long, value_name = "E", default_value_t = verdict::ROUND_OFF_FLOOR, allow_negative_numbers = true)]
    floor: f64,
    /// The column of the step, or of a count; without it its name decides, or else the first column is taken and named
    #[arg(long, value_name = "COLUMN")]
    step: Option<String>,
    /// The columns of errors, separated by commas; without it all that are not steps, counts, rates or costs by their names
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    columns: Option<Vec<String>>,
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
    match order.trim().parse() {
        Ok(order) if order > 0.0 && f64::is_finite(order) => Ok((name, order)),
        _ => Err("expected a number > 0, or NAME= and a number > 0".to_owned()),
    }
}

fn dimension(text: &str) -> Result<f64, String> {
    let dim = text.parse().ok().filter(|dim| *dim > 0.0 && f64::is_finite(*dim));
    dim.ok_or_else(|| "expected a number > 0".to_owned())
}

/// A column, judged.
struct Judged<'t> {
    name: &'t str,
    rate: &'t RateVerdict,
    /// Whether its verdict counts.
    decides: bool,
    /// Whether an order for all columns does not mean it.
    is_unlike: bool,
}

impl Judged<'_> {
    fn is_claimed(&self) -> bool {
        !self.rate.order.is_nan()
    }

    /// The judge reports an unusable order; here none was given.
    fn reason(&self) -> &str {
        match (self.is_claimed(), self.is_unlike) {
            (true, _) => &self.rate.because,
            (false, true) => "not meant by --order P, for it does not fall with the step; --order NAME=P judges it",
            (false, false) => "no order is claimed",
        }
    }
}

/// All that is printed and written.
struct Findings<'t> {
    project: &'t Project,
    source: String,
    table: &'t RateTable,
    columns: Vec<Judged<'t>>,
    floor: f64,
    verdict: Verdict,
}

/// Judges the table, prints rates and verdicts, and writes what is asked for.
///
/// # Errors
/// A table or claims that cannot be used, and a folder that cannot be written to.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let judge = Judge::new(arguments.tolerance)?.with_floor(arguments.floor)?;
    let claimed = arguments.order.iter().filter_map(|(name, _)| name.clone()).collect();
    let choice =
        Choice { step: arguments.step.clone(), columns: arguments.columns.clone(), claimed, dim: arguments.dim };
    let table = RateTable::read_with(&arguments.file, &choice)?;
    let orders = orders(arguments, &table)?;
    // Where nothing is claimed the judge says so: no order is no number.
    let rates = table.judge(&judge, |column| orders.get(column).copied().unwrap_or(f64::NAN));
    let for_all = arguments.order.iter().any(|(name, _)| name.is_none());
    let unlike: HashSet<&str> = table.unclaimed.iter().map(String::as_str).collect();
    let columns = rates.iter().map(|(name, rate)| Judged {
        name,
        rate,
        decides: arguments.all || !rate.order.is_nan(),
        is_unlike: for_all && unlike.contains(name.as_str()),
    });
    let columns: Vec<Judged<'_>> = columns.collect();
    let verdict = Verdict::worst(columns.iter().filter(|column| column.decides).map(|column| column.rate.verdict));
    let source = arguments.file.display().to_string();
    let findings = Findings { project, source, table: &table, columns, floor: arguments.floor, verdict };
    let flags = &arguments.flags;
    if let Some(folder) = &flags.out {
        files::write(&findings, folder)?;
    }
    flags.show("rates", verdict, &object::Object::new(&findings), &text::text(&findings, flags.quiet))?;
    Ok(verdict.into())
}

/// The order of each column for which one is claimed.
fn orders<'t>(arguments: &Arguments, table: &'t RateTable) -> Result<BTreeMap<&'t str, f64>, Unusable> {
    let columns = || table.columns.iter().map(|(column, _)| column.as_str());
    let mut orders = BTreeMap::new();
    let mut for_all = arguments.order.iter().filter(|(name, _)| name.is_none()).map(|(_, order)| *order);
    if let Some(order) = for_all.next() {
        if let Some(second) = for_all.next() {
            let expected = "expected one order for all columns, and --order NAME=P for others";
            return Err(Unusable::because(&format!("{expected}; found --order {order} and --order {second}")));
        }
        let unlike: HashSet<&str> = table.unclaimed.iter().map(String::as_str).collect();
        orders.extend(columns().filter(|column| !unlike.contains(column)).map(|column| (column, order)));
    }
    let mut named: HashSet<&str> = HashSet::new();
    for (name, order) in &arguments.order {
        let Some(name) = name else { continue };
        let column = position(columns(), name).and_then(|k| table.columns.get(k));
        let column = column.ok_or_else(|| unknown(name, *order, table))?.0.as_str();
        if !named.insert(column) {
            let found = format!("--order {name}={order}: expected each column once; found `{column}` a second time");
            return Err(Unusable::because(&found));
        }
        orders.insert(column, *order);
    }
    Ok(orders)
}

/// What is wrong with a claim about a column that is not judged.
fn unknown(name: &str, order: f64, table: &RateTable) -> Unusable {
    let columns = || table.columns.iter().map(|(column, _)| column.as_str());
    let known: Vec<&str> = columns().take(LISTED + 1).collect();
    let more = if known.len() > LISTED { ", ..." } else { "" };
    let hint = match table.not_errors.iter().find(|(column, _)| column == name) {
        Some((_, why)) => format!(", which is {why} unless --columns names it"),
        None if name.contains('=') => "; repeat --order for each column".to_owned(),
        None => did_you_mean(&nearest(name, columns()).map(str::to_owned)),
    };
    let known = known[..known.len().min(LISTED)].join(", ") + more;
    Unusable::because(&format!("--order {name}={order}: expected a column of errors: {known}; found `{name}`{hint}"))
}

/// Most names that a message lists.
const LISTED: usize = 12;
