//! `compare`: two records side by side.

use std::path::PathBuf;

use serde::Serialize;

use super::exit::{Ended, Outcome, Unusable};
use super::flags::Flags;
use crate::cli::screen;
use crate::compare::{Change, Comparison, Norm, Settings, Study, WITHIN, compare};
use crate::judge::verdict::Verdict;
use crate::store::record::Record;
use crate::text::visible::visible;

/// Compare two versions by their records: order, errors at the same step, work for the same error
///
/// Records are what `verify` writes to results.json and what `study --format json` prints. Exit status 1 where something is worse.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The record of the old version
    old: PathBuf,
    /// The record of the new version
    new: PathBuf,
    /// Errors at the same step that differ by less, as a share, are the same
    #[arg(long, value_name = "SHARE", default_value_t = WITHIN, value_parser = share, allow_hyphen_values = true)]
    within: f64,
    /// Errors not above this have no say [default: 1e-10]
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    floor: Option<f64>,
    /// Every error, not only those that differ
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    flags: Flags,
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share: &f64| *share >= 0.0 && share.is_finite());
    share.ok_or("expected a number >= 0, such as 0.01".to_owned())
}

/// What `--format json` prints.
#[derive(Serialize)]
struct Object<'a> {
    within: f64,
    #[serde(flatten)]
    comparison: &'a Comparison,
}

/// Compares the records and prints what differs.
///
/// # Errors
/// Files that are no records, and records without a common study.
pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Arguments { old, new, within, floor, all, flags } = arguments;
    let settings = Settings::new(*floor, *within)?;
    let records = [Record::read(old)?, Record::read(new)?];
    let comparison = compare(&records[0], &records[1], &settings);
    if comparison.studies.is_empty() {
        let [old, new] = [old, new].map(|path| visible(&path.display().to_string()));
        return Err(Unusable::because(&format!("{new}: found no study that {old} has, too; expected at least one")));
    }
    let is_worse = comparison.change == Change::Worse;
    let verdict = if is_worse { Verdict::Fail } else { Verdict::Pass };
    let words = flags.words(verdict, sentence(&comparison).trim_end(), || text(&comparison, *all));
    flags.show("compare", verdict, &Object { within: *within, comparison: &comparison }, &words)?;
    Ok(if is_worse { Ended::Badly } else { Ended::Well })
}

fn text(comparison: &Comparison, all: bool) -> String {
    let mut text = String::new();
    for study in &comparison.studies {
        let shown = |norm: &&Norm| all || norm.change != Change::Same;
        for Norm { norm, change, reason, .. } in study.norms.iter().filter(shown) {
            text += &format!("{}: {}: {}: {}\n", study.id, visible(norm), change.name(), visible(reason));
        }
        if let Some(reason) = &study.reason {
            text += &format!("{}: {}: {}\n", study.id, study.change.name(), visible(reason));
        }
    }
    if all {
        text += &table(comparison);
    }
    for note in notes(comparison) {
        text += &format!("note: {}\n", visible(&note));
    }
    text + &sentence(comparison)
}

fn notes(comparison: &Comparison) -> Vec<String> {
    let of_study =
        |study: &'_ Study| study.notes.iter().map(|note| format!("{}: {note}", study.id)).collect::<Vec<_>>();
    comparison.studies.iter().flat_map(of_study).chain(comparison.notes.iter().cloned()).collect()
}

/// Order, constant, error and work of every error.
fn table(comparison: &Comparison) -> String {
    let of_study = |study: &'_ Study| study.norms.iter().map(|norm| row(&study.id, norm)).collect::<Vec<_>>();
    let rows: Vec<Vec<String>> = comparison.studies.iter().flat_map(of_study).collect();
    let head = ["study", "error", "order, old", "order, new", "constant, old", "constant, new", "error", "work", "is"];
    if rows.is_empty() { String::new() } else { format!("\n{}\n", screen::table(&head, &rows)) }
}

fn row(id: &str, Norm { norm, change, lines, error, work, .. }: &Norm) -> Vec<String> {
    let none = || "-".to_owned();
    let interval = |value: f64, [low, high]: [f64; 2]| format!("{value:.4} ({low:.4} to {high:.4})");
    let order = |k: usize| lines[k].map_or_else(none, |line| interval(line.order, line.order_interval));
    let constant = |k: usize| {
        let finite = lines[k].filter(|line| line.constant.is_finite());
        finite.map_or_else(none, |line| {
            format!("{:.3e} ({:.2e} to {:.2e})", line.constant, line.constant_interval[0], line.constant_interval[1])
        })
    };
    let error = error.map_or_else(none, |error| interval(error.ratio, error.interval));
    let work = work.map_or_else(none, |work| interval(work.ratio, work.interval));
    vec![
        id.to_owned(),
        visible(norm),
        order(0),
        order(1),
        constant(0),
        constant(1),
        error,
        work,
        change.name().to_owned(),
    ]
}

fn sentence(comparison: &Comparison) -> String {
    let norms = || comparison.studies.iter().flat_map(|study| study.norms.iter().map(|norm| norm.change));
    let of_studies = comparison.studies.iter().filter(|study| study.reason.is_some()).map(|study| study.change);
    let found: Vec<Change> = norms().filter(|change| *change != Change::Same).chain(of_studies).collect();
    let count = |change: Change| found.iter().filter(|known| **known == change).count();
    let [worse, better, not_proven] = [Change::Worse, Change::Better, Change::NotProven].map(count);
    let same = norms().filter(|change| *change == Change::Same).count();
    let not_proven = if not_proven == 0 { String::new() } else { format!(", {not_proven} not proven") };
    let studies = comparison.studies.len();
    format!(
        "{}: {worse} worse, {better} better, {same} the same{not_proven}, in {studies} studies\n",
        comparison.change.name()
    )
}
