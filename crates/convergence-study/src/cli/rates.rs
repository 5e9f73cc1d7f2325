//! `rates FILE.csv`: errors of any code, judged by the rule of the studies.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

use crate::input::error_table::RateTable;
use crate::judge::verdict::{self, Judge, RateVerdict};
use clap::Args;
use serde::Serialize;

use super::exit::{Outcome, Unusable};
use crate::cli::output::{self, Format};

/// Judge a table of step sizes and errors made elsewhere
///
/// The first row has names, the first column is h or dt, every other column an error. Exit status 0 where every rate
/// agrees with its order, 1 where one does not or the data cannot tell, 2 where the table cannot be read.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The table: cells separated by commas, semicolons or tabs
    file: PathBuf,
    /// The order that theory claims, for all columns or as NAME=P for one; may be repeated. Without one nothing passes
    #[arg(long, value_name = "[NAME=]P", value_parser = claim)]
    order: Vec<(Option<String>, f64)>,
    /// How far the rate may be from the order, above or below: 0 < T < 0.5, for half an order accepts two whole ones
    #[arg(long, value_name = "T", default_value_t = 0.05)]
    tolerance: f64,
    /// Errors not above are round-off, and left out: a thousand times that of quantities of order 1
    #[arg(long, value_name = "E", default_value_t = verdict::ROUND_OFF_FLOOR)]
    floor: f64,
    /// How the result is printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

fn claim(text: &str) -> Result<(Option<String>, f64), String> {
    let (name, order) = text.rsplit_once('=').map_or((None, text), |(name, order)| (Some(name.to_owned()), order));
    match order.trim().parse() {
        Ok(order) if order > 0.0 && f64::is_finite(order) => Ok((name, order)),
        _ => Err("allowed is a number > 0, or NAME= and a number > 0".to_owned()),
    }
}

/// Judges the table and prints rates and verdicts.
///
/// # Errors
/// A table or claims that cannot be used.
pub(super) fn run(arguments: &Arguments) -> Outcome {
    let judge = Judge::new(arguments.tolerance)?.with_floor(arguments.floor)?;
    let table = RateTable::read(&arguments.file)?;
    let orders = orders(arguments, &table)?;
    // Where nothing is claimed the judge says so: no order is no number.
    let order = |column: &str| orders.get(column).copied().unwrap_or(f64::NAN);
    let rates = table.judge(&judge, order);
    match arguments.format {
        Format::Text => output::print(&text(&table, &rates))?,
        Format::Json => output::print_json(&Object { rates: rates.iter().map(Rate::new).collect() })?,
    }
    Ok(verdict::Verdict::worst(rates.iter().map(|(_, rate)| rate.verdict)).into())
}

/// The order of each column for which one is claimed.
fn orders<'a>(arguments: &'a Arguments, table: &'a RateTable) -> Result<BTreeMap<&'a str, f64>, Unusable> {
    let mut orders = BTreeMap::new();
    let columns = || table.columns.iter().map(|(column, _)| column.as_str());
    for (_, order) in arguments.order.iter().filter(|(name, _)| name.is_none()) {
        orders.extend(columns().map(|column| (column, *order)));
    }
    for (name, order) in &arguments.order {
        let Some(name) = name else { continue };
        let column = columns().find(|column| column == name).ok_or_else(|| {
            let known: Vec<&str> = columns().collect();
            Unusable::because(&format!("--order {name}={order}: no such column; there are {}", known.join(", ")))
        })?;
        orders.insert(column, *order);
    }
    Ok(orders)
}

#[derive(Debug, Serialize)]
struct Object<'a> {
    rates: Vec<Rate<'a>>,
}

/// As in `study --format json`, the column's name for the norm's; a number that is none is `null`.
#[derive(Debug, Serialize)]
struct Rate<'a> {
    norm: &'a str,
    order: f64,
    tolerance: f64,
    pairwise: &'a [f64],
    fitted: Option<f64>,
    interval: Option<[f64; 2]>,
    extrapolated: Option<f64>,
    verdict: &'static str,
    reason: &'a str,
}

impl<'a> Rate<'a> {
    fn new((norm, rate): &'a (String, RateVerdict)) -> Self {
        Self {
            norm,
            order: rate.order,
            tolerance: rate.tolerance,
            pairwise: &rate.pairwise,
            fitted: rate.fitted,
            interval: rate.interval,
            extrapolated: rate.extrapolated,
            verdict: rate.verdict.name(),
            reason: &rate.reason,
        }
    }
}

/// The errors with the rates between them, and a verdict for each column.
fn text(table: &RateTable, rates: &[(String, RateVerdict)]) -> String {
    let mut text = format!("{:>12}", table.step);
    for (name, _) in &table.columns {
        let _ = write!(text, "{name:>16}{:>8}", "rate");
    }
    text.push('\n');
    let levels = table.columns.first().map_or(0, |(_, levels)| levels.len());
    for level in 0..levels {
        let mut line = format!("{:>12.4e}", table.columns[0].1[level].step);
        for ((_, levels), (_, rate)) in table.columns.iter().zip(rates) {
            let pairwise = level.checked_sub(1).and_then(|before| rate.pairwise.get(before));
            let pairwise = pairwise.map_or(String::new(), |rate| format!("{rate:.3}"));
            let _ = write!(line, "{:>16.4e}{pairwise:>8}", levels[level].error);
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text.push('\n');
    for (name, rate) in rates {
        // The judge reports an unusable order; here none was given.
        let reason = if rate.order.is_nan() { "no order is claimed" } else { rate.reason.as_str() };
        let _ = writeln!(text, "{name}: {}: {reason}", rate.verdict);
    }
    if rates.iter().any(|(_, rate)| rate.order.is_nan()) {
        text.push_str("\nclaim what theory says: --order P for all columns, --order NAME=P for one\n");
    }
    text
}
