//! `compare`: two records side by side.

use std::path::PathBuf;

use super::exit::{CommandOutcome, Unusable};
use super::flags::{Flags, number};
use crate::cli::screen;
use crate::compare::{Finding, Order, RecordComparison, Shift, WITHIN, compare};
use crate::interval::Interval;
use crate::judge::verdict::{Floor, Verdict};
use crate::store::Record;
use crate::text::number::counted_as;
use crate::text::visible::{self, visible};

/// Compare the records of two versions: orders, errors at a step, work for an error
///
/// `verify` writes records to results.json, and `study --format json` prints them. Exit status 1 if
/// anything is worse or lost.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The record of the old version
    old: PathBuf,
    /// The record of the new version
    new: PathBuf,
    /// Errors at the same step that differ by less, as a share, are the same
    #[arg(long, value_name = "SHARE", default_value_t = WITHIN, value_parser = share, allow_hyphen_values = true)]
    within: f64,
    /// Errors not above this are not used; 0 uses all
    #[arg(
        long,
        value_name = "E",
        default_value_t = 0.0,
        value_parser = number,
        allow_hyphen_values = true
    )]
    floor: f64,
    /// Every error, not only those that differ
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    flags: Flags,
}

fn share(text: &str) -> Result<f64, String> {
    let share = text
        .parse()
        .ok()
        .filter(|share: &f64| *share >= 0.0 && share.is_finite());
    share.ok_or("expected a number >= 0, such as 0.01".to_owned())
}

/// Compares the records and prints the differences.
///
/// # Errors
/// Files that are not records, and records without a common study.
pub(super) fn run(arguments: &Arguments) -> CommandOutcome {
    let Arguments {
        old,
        new,
        within,
        floor,
        all,
        flags,
    } = arguments;
    let floor = Floor::new(*floor)?;
    let comparison = compare(&Record::read(old)?, &Record::read(new)?, floor, *within);
    if comparison.studies == 0 {
        let [old, new] = [old, new].map(|path| visible::path(path));
        return Err(Unusable::because(&format!(
            "{new}: found no study that {old} has, too; expected at least one"
        )));
    }
    let verdict = if comparison.change >= Shift::Worse {
        Verdict::Fail
    } else {
        Verdict::Pass
    };
    let words = flags.words(verdict, sentence(&comparison).trim_end(), || {
        text(&comparison, *all)
    });
    Ok(flags.show("compare", verdict, &comparison, &words)?)
}

fn text(comparison: &RecordComparison, all: bool) -> String {
    let mut text = String::new();
    for Finding {
        study,
        norm,
        change,
        reason,
        ..
    } in &comparison.findings
    {
        if all || *change != Shift::Same {
            let norm = norm
                .as_ref()
                .map_or(String::new(), |norm| format!("{}: ", visible(norm)));
            text += &format!("{study}: {norm}{}: {}\n", change.name(), visible(reason));
        }
    }
    if all {
        text += &orders(comparison);
    }
    for gained in &comparison.gained {
        text += &format!("note: only the new record has {}\n", visible(gained));
    }
    text + &sentence(comparison)
}

/// The orders of every error in both records.
fn orders(comparison: &RecordComparison) -> String {
    let row = |Finding {
                   study,
                   norm,
                   change,
                   orders,
                   ..
               }: &Finding| {
        let [old, new] = [orders.old, orders.new].map(order_text);
        Some(vec![
            study.clone(),
            visible(norm.as_ref()?),
            old,
            new,
            change.name().to_owned(),
        ])
    };
    let rows: Vec<Vec<String>> = comparison.findings.iter().filter_map(row).collect();
    let head = ["study", "error", "order, old", "order, new", "is"];
    if rows.is_empty() {
        String::new()
    } else {
        format!("\n{}\n", screen::table(&head, &rows))
    }
}

/// An order with its interval; `-` for none.
fn order_text(order: Option<Order>) -> String {
    let Some(Order { order, interval }) = order else {
        return "-".to_owned();
    };
    let Interval { low, high } = interval;
    format!("{order:.4} ({low:.4} to {high:.4})")
}

fn sentence(comparison: &RecordComparison) -> String {
    let count = |change: Shift| {
        comparison
            .findings
            .iter()
            .filter(|finding| finding.change == change)
            .count()
    };
    let [lost, worse, better, same, open] = [
        Shift::Lost,
        Shift::Worse,
        Shift::Better,
        Shift::Same,
        Shift::NotProven,
    ]
    .map(count);
    let some = |count: usize, what: &str| {
        if count == 0 {
            String::new()
        } else {
            format!("{count} {what}")
        }
    };
    let lost = some(lost, "lost, ");
    let open = some(open, "not proven, ");
    let change = comparison.change.name();
    let studies = counted_as(comparison.studies, "study", "studies");
    format!("{change}: {lost}{worse} worse, {better} better, {same} the same, {open}in {studies}\n")
}
