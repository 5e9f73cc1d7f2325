//! `regressions`: plants hand-written mistakes of meaning one at a time: does `verify` notice and
//! name each?
//!
//! A mutant changes an operator. People swap two fields, take the wrong time level, or treat a
//! graded mesh as uniform. `xtask/regressions.toml` lists such mistakes, each with the study or the
//! test that must notice it. Each is planted in a copy of the work tree below
//! `target/regressions/`, where the quick tier of `verify` is compiled and run. The results are
//! kept, so an interrupted run continues where it stopped.

mod judged;
mod list;
mod planted;

use std::io;
use std::path::Path;

use convergence_study::{
    Table, Verdict,
    internal::{
        cli::{
            exit::{self, CommandOutcome, Unusable},
            running::LongRun,
            screen, workspace,
        },
        report,
        store::atomic,
    },
};

use judged::JudgedRegression;
use list::Regression;
use planted::{Copy, PlantedRun};

/// Judge the studies: does the quick tier of `verify` notice and name each mistake in a list?
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Plant only mistakes with this in their name or file; may be repeated
    #[arg(long, value_name = "PART")]
    only: Vec<String>,
    /// Write reports/regressions.md
    #[arg(long)]
    write: bool,
    /// Diagnose recorded results again, and plant nothing
    #[arg(long)]
    recorded: bool,
    /// List the mistakes and plant nothing
    #[arg(long, conflicts_with = "write")]
    list: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> CommandOutcome {
    let root = workspace::root()?;
    let all = list::read(&root)?;
    let chosen = chosen(arguments, &all)?;
    if arguments.list {
        return print_list(&chosen);
    }
    // All of them are checked before the first is compiled.
    let texts = chosen
        .iter()
        .map(|regression| regression.planted(&root))
        .collect::<Result<Vec<_>, _>>()?;
    let reported = root.join(REPORT);
    let clock = LongRun::begin(
        "one build and one run of the quick tier for each mistake",
        &reported,
        false,
    );
    let count = chosen.len();
    let copy = Copy::of(&root)?;
    let passing = copy.as_it_is(arguments.recorded)?.seconds;
    exit::say(move || format!("{count} mistakes were to be planted; those that were are recorded"));
    let planted = chosen.iter().copied().zip(&texts);
    let results = plant(&copy, planted, arguments.recorded, &clock)?;
    let report = Report::of(judged::judged(&root, results)?, count, passing);
    report.print()?;
    if arguments.write {
        report.write(&root, &clock.ended(&root))?;
        screen::print(&format!("report: {REPORT}\n"))?;
    }
    Ok(report.verdict())
}

/// The mistakes that are asked for.
///
/// # Errors
/// There are none.
fn chosen<'r>(
    arguments: &Arguments,
    all: &'r [Regression],
) -> Result<Vec<&'r Regression>, Unusable> {
    let mut chosen = vec![];
    for mistake in all {
        let mut parts = arguments.only.iter();
        if arguments.only.is_empty()
            || parts.any(|part| mistake.name.contains(part) || mistake.file.contains(part))
        {
            chosen.push(mistake);
        }
    }
    if chosen.is_empty() {
        return Err(Unusable::because(&format!(
            "no regression with {} in its name",
            arguments.only.join(" or ")
        )));
    }
    Ok(chosen)
}

/// What was noticed of all mistakes, as the terminal and the page show it.
struct Report<'r> {
    judged: Vec<JudgedRegression<'r>>,
    /// Number of mistakes that were to be planted.
    count: usize,
    /// Number of mistakes that their study or test names.
    named: usize,
    table: Table,
    sentence: String,
    /// How well causes are named.
    scores: String,
}

impl<'r> Report<'r> {
    /// * `passing`: seconds of a run without a mistake.
    fn of(judged: Vec<JudgedRegression<'r>>, count: usize, passing: f64) -> Self {
        let named = judged
            .iter()
            .filter(|one| one.found.is_named_by(one.regression))
            .count();
        let rest = if judged.len() < count {
            format!(", {} more are not recorded", count - judged.len())
        } else {
            String::new()
        };
        Self {
            table: Table::new(
                "",
                HEAD,
                judged.iter().map(|one| row(one.regression, &one.found)),
            ),
            sentence: format!(
                "{named} of {} mistakes are noticed by the study or the test named for them{rest}",
                judged.len()
            ),
            scores: judged::page(&judged, passing),
            judged,
            count,
            named,
        }
    }

    fn verdict(&self) -> Verdict {
        if self.named == self.count {
            Verdict::Pass
        } else {
            Verdict::Fail
        }
    }

    fn print(&self) -> io::Result<()> {
        let table = screen::table(&HEAD, &self.table.rows);
        let diagnoses = judged::diagnoses(&self.judged);
        screen::print(&format!(
            "{table}{}{diagnoses}{}\n",
            self.scores, self.sentence
        ))
    }

    /// Writes the page.
    fn write(&self, root: &Path, ended: &str) -> io::Result<()> {
        let rows = self.judged.iter().map(|one| {
            let found = &one.found;
            summary(one.regression, found.is_named_by(one.regression))
        });
        let table = Table::new("", SUMMARY, rows);
        let page = page(&table, &self.sentence, ended) + "\n" + &self.scores;
        atomic::write(&root.join(REPORT), page)
    }
}

/// Plants one mistake after the other, and runs the quick tier with each.
///
/// * `planted`: each mistake with the text of its file.
///
/// # Errors
/// No mistake has a result; the others without one are complained about.
fn plant<'r, 't>(
    copy: &Copy,
    planted: impl Iterator<Item = (&'r Regression, &'t String)>,
    recorded: bool,
    clock: &LongRun,
) -> Result<Vec<(&'r Regression, PlantedRun)>, Unusable> {
    let mut results = vec![];
    let mut complaints = vec![];
    for (regression, text) in planted {
        match copy.with(regression, text, recorded) {
            Ok(result) => {
                let words = first_words(regression, &result);
                clock.done(&format!("{}: {words}", regression.name));
                results.push((regression, result));
            }
            Err(why) => complaints.push(format!("{}: {}", regression.name, why.message())),
        }
    }
    if results.is_empty() {
        return Err(Unusable::because(&complaints.join("\n")));
    }
    complaints
        .iter()
        .for_each(|complaint| screen::complain(complaint));
    Ok(results)
}

fn print_list(chosen: &[&Regression]) -> CommandOutcome {
    let mut rows = vec![];
    for mistake in chosen {
        rows.push(vec![
            mistake.name.clone(),
            mistake.file.clone(),
            mistake.noticed_by().to_owned(),
        ]);
    }
    screen::print(&screen::table(
        &["mistake", "file", "to be noticed by"],
        &rows,
    ))?;
    Ok(Verdict::Pass)
}

/// The page that is written.
const REPORT: &str = "reports/regressions.md";

const HEAD: [&str; 4] = [
    "mistake",
    "file",
    "first words about it",
    "named by its study or test",
];

/// The columns of the page.
const SUMMARY: [&str; 3] = ["mistake", "file", "noticed by"];

/// A row of the page: short enough for a window.
fn summary(regression: &Regression, is_named: bool) -> Vec<String> {
    let by = regression.noticed_by();
    // A test is known by its name, which has underscores: `cargo test NAME` runs it.
    let by = by.rsplit_once("::").map_or(by, |(_, name)| name).to_owned();
    let file = &regression.file;
    vec![
        regression.name.clone(),
        file.strip_prefix("crates/").unwrap_or(file).to_owned(),
        if is_named { by } else { format!("not {by}") },
    ]
}

fn first_words(regression: &Regression, found: &PlantedRun) -> String {
    let said = found.said();
    match said.first() {
        Some(first) if found.is_named_by(regression) => first.clone(),
        _ => format!(
            "not noticed:\n{}",
            said.iter()
                .take(SHOWN)
                .map(|line| format!("  {line}\n"))
                .collect::<String>()
        ),
    }
}

/// Lines shown if the study named for a mistake does not notice it.
const SHOWN: usize = 12;

fn row(regression: &Regression, found: &PlantedRun) -> Vec<String> {
    let by = regression.noticed_by();
    let named = if found.is_named_by(regression) {
        by.to_owned()
    } else {
        format!("no, not by {by}")
    };
    let first = found
        .said()
        .first()
        .cloned()
        .unwrap_or_else(|| "nothing".to_owned());
    vec![
        regression.name.clone(),
        regression.file.clone(),
        first,
        named,
    ]
}

fn page(table: &Table, sentence: &str, ended: &str) -> String {
    format!(
        "# Mistakes of meaning\n\n\
         Written by `cargo xtask dev regressions --write`. Each mistake of `{}` is planted by itself; the \
         quick tier of `verify` must notice it, or the study of the full tier that is named for it, and that \
         study must name what is wrong; or the test named for it must fail. {ended}\n\n{sentence}.\n\n{}",
        list::FILE,
        report::markdown(table)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root() -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
    }

    fn listed() -> Vec<Regression> {
        list::read(&root()).unwrap_or_else(|error| panic!("{}", error.message()))
    }

    #[test]
    fn no_line_of_the_page_is_wider_than_a_window() {
        let rows = listed()
            .iter()
            .map(|one| summary(one, false))
            .collect::<Vec<_>>();
        let page = report::markdown(&Table::new("", SUMMARY, rows));
        let widest = page.lines().map(|line| line.chars().count()).max();
        assert!(widest.is_some_and(|widest| widest <= 200), "{widest:?}");
        assert!(page.len() < 40_000, "{}", page.len());
    }
}
