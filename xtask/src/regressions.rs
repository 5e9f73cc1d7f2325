//! `regressions`: plants hand-written mistakes of meaning one at a time: does `verify` notice and name each?
//!
//! A mutant changes an operator. People swap two fields, take the wrong time level, or treat a graded mesh as uniform.
//! `xtask/regressions.toml` lists such mistakes, each with the study or the test that must notice it. Each is planted in a copy of the work
//! tree below `target/regressions/`, where the quick tier of `verify` is compiled and run. The results are kept, so an interrupted
//! run continues where it stopped.

mod judged;
mod list;
mod planted;

use std::io;

use convergence_study::cli::exit::{self, Outcome, Unusable};
use convergence_study::cli::running::LongRun;
use convergence_study::cli::{screen, workspace};
use convergence_study::judge::verdict::Verdict;
use convergence_study::report;
use convergence_study::store::atomic;
use convergence_study::study::outcome::Table;

use list::Regression;
use planted::{Copy, Found};

/// Judge the studies: does the quick tier of `verify` notice and name each mistake in a list?
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Plant only mistakes with this in their name or file; may be repeated
    #[arg(long, value_name = "PART")]
    only: Vec<String>,
    /// Write reports/regressions.md, and xtask/fingerprints.json for comparison with later runs
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
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let all = list::read(&root)?;
    let is_meant = |one: &&Regression| {
        let has =
            |part: &String| one.name.contains(part.as_str()) || one.file.contains(part.as_str());
        arguments.only.is_empty() || arguments.only.iter().any(has)
    };
    let chosen: Vec<&Regression> = all.iter().filter(is_meant).collect();
    if chosen.is_empty() {
        return Err(Unusable::because(&format!(
            "no regression with {} in its name",
            arguments.only.join(" or ")
        )));
    }
    if arguments.list {
        return print_list(&chosen);
    }
    // All of them are checked before the first is compiled.
    let planted = chosen
        .iter()
        .map(|regression| regression.planted(&root))
        .collect::<Result<Vec<_>, _>>()?;
    let reported = root.join("reports/regressions.md");
    let clock = LongRun::begin(
        "one build and one run of the quick tier for each mistake",
        &reported,
        false,
    );
    let (copy, count) = (Copy::of(&root)?, chosen.len());
    let passing = copy.as_it_is(arguments.recorded)?.seconds;
    exit::say(move || format!("{count} mistakes were to be planted; those that were are recorded"));
    let (mut all, mut complaints) = (vec![], vec![]);
    for (regression, text) in chosen.iter().zip(&planted) {
        match copy.with(regression, text, arguments.recorded) {
            Ok(found) => {
                clock.done(&format!(
                    "{}: {}",
                    regression.name,
                    first_words(regression, &found)
                ));
                all.push((*regression, found));
            }
            Err(why) => complaints.push(format!("{}: {}", regression.name, why.message())),
        }
    }
    if all.is_empty() {
        return Err(Unusable::because(&complaints.join("\n")));
    }
    complaints
        .iter()
        .for_each(|complaint| screen::complain(complaint));
    let all = judged::judged(&root, all)?;
    let named = all
        .iter()
        .filter(|one| one.found.is_named_by(one.regression))
        .count();
    let table = Table::new(
        "",
        HEAD,
        all.iter().map(|one| row(one.regression, &one.found)),
    );
    let rest = if all.len() < count {
        format!(", {} more are not recorded", count - all.len())
    } else {
        String::new()
    };
    let sentence = format!(
        "{named} of {} mistakes are noticed by the study or the test named for them{rest}",
        all.len()
    );
    let scores = judged::page(&all, passing);
    screen::print(&format!(
        "{}{scores}{sentence}\n",
        screen::table(&HEAD, &table.rows)
    ))?;
    if arguments.write {
        atomic::write(
            &reported,
            page(&table, &sentence, &clock.ended(&root)) + "\n" + &scores,
        )?;
        let prints = serde_json::to_string(&judged::fingerprints(&all)).map_err(io::Error::from)?;
        atomic::write(
            &root.join(FINGERPRINTS),
            prints.replace("{\"mistake\"", "\n{\"mistake\"") + "\n",
        )?;
        screen::print(&format!("report: reports/regressions.md, {FINGERPRINTS}\n"))?;
    }
    Ok(if named == count {
        Verdict::Pass
    } else {
        Verdict::Fail
    })
}

fn print_list(chosen: &[&Regression]) -> Outcome {
    let row = |one: &&Regression| {
        vec![
            one.name.clone(),
            one.file.clone(),
            one.noticed_by().to_owned(),
        ]
    };
    let rows = chosen.iter().map(row).collect::<Vec<_>>();
    screen::print(&screen::table(
        &["mistake", "file", "to be noticed by"],
        &rows,
    ))?;
    Ok(Verdict::Pass)
}

/// Where later runs of `verify` find the effects of these mistakes.
const FINGERPRINTS: &str = "xtask/fingerprints.json";

const HEAD: [&str; 4] = [
    "mistake",
    "file",
    "first words about it",
    "named by its study or test",
];

fn first_words(regression: &Regression, found: &Found) -> String {
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

fn row(regression: &Regression, found: &Found) -> Vec<String> {
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
        "# Mistakes of meaning\n\nWritten by `cargo xtask dev regressions --write`. Each mistake of `{}` is planted by itself; the \
         quick tier of `verify` must notice it, and the study named for it must name what is wrong; or the test named for it must fail. {ended}\n\n{sentence}.\n\n{}",
        list::FILE,
        report::markdown(table)
    )
}
