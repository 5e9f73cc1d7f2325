//! `regressions`: mistakes of meaning, written by hand, one at a time: does `verify` notice each, and name it?
//!
//! A mutant changes an operator. People swap two fields, take the wrong time level, or treat a graded mesh as a uniform one.
//! Such mistakes are listed in `.cargo/regressions.toml`, each with the study that must notice it. Each is planted in a copy of
//! the work tree below `target/regressions/`, which is compiled and runs the quick tier of `verify`.

mod list;
mod planted;

use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::cli::long::LongRun;
use convergence_study::cli::{interrupt, output, screen, workspace};
use convergence_study::report;
use convergence_study::store::atomic;
use convergence_study::study::outcome::Table;

use list::Regression;
use planted::{Copy, Noticed};

/// Judge the studies: does the quick tier of `verify` notice each mistake of a list, and name it?
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Plant only those with this in their name or file; may be given more than once
    #[arg(long, value_name = "PART")]
    only: Vec<String>,
    /// Write reports/regressions.md
    #[arg(long)]
    write: bool,
    /// List them and plant nothing
    #[arg(long, conflicts_with = "write")]
    list: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let all = list::read(&root)?;
    let is_meant = |regression: &&Regression| {
        let of = |part: &String| regression.name.contains(part.as_str()) || regression.file.contains(part.as_str());
        arguments.only.is_empty() || arguments.only.iter().any(of)
    };
    let chosen: Vec<&Regression> = all.iter().filter(is_meant).collect();
    if chosen.is_empty() {
        return Err(Unusable::because(&format!("no regression with {} in its name", arguments.only.join(" or "))));
    }
    if arguments.list {
        let rows: Vec<_> =
            chosen.iter().map(|one| vec![one.name.clone(), one.file.clone(), one.study.clone()]).collect();
        output::print(&screen::table(&["mistake", "file", "to be noticed by"], &rows))?;
        return Ok(Ended::Well);
    }
    // All of them are looked up before the first is compiled.
    let planted = chosen.iter().map(|regression| regression.planted(&root)).collect::<Result<Vec<_>, _>>()?;
    let reported = root.join("reports/regressions.md");
    let clock = LongRun::begin("one build and one run of the quick tier for each mistake", &reported, false);
    let copy = Copy::of(&root)?;
    copy.passes_as_it_is()?;
    let count = chosen.len();
    interrupt::say(move || format!("{count} mistakes were to be planted"));
    let mut rows = vec![];
    let mut unnoticed = 0;
    for (regression, text) in chosen.iter().zip(&planted) {
        let noticed = copy.with(&regression.file, text)?;
        let is_named = noticed.is_named_by(&regression.study, &regression.says);
        unnoticed += usize::from(!is_named);
        let said = if is_named { noticed.first().to_owned() } else { format!("not noticed:\n{}", noticed.text()) };
        clock.done(&format!("{}: {said}", regression.name));
        rows.push(row(regression, &noticed, is_named));
    }
    let table = Table { title: String::new(), head: HEAD.map(str::to_owned).to_vec(), rows };
    let sentence = format!("{} of {count} mistakes are noticed by the study named for them", count - unnoticed);
    output::print(&format!("{}{sentence}\n", screen::table(&HEAD, &table.rows)))?;
    if arguments.write {
        atomic::write(&reported, page(&table, &sentence, &clock.ended(&root)))?;
        output::print("report: reports/regressions.md\n")?;
    }
    Ok(if unnoticed == 0 { Ended::Well } else { Ended::Badly })
}

const HEAD: [&str; 5] = ["mistake", "file", "studies that notice", "first words about it", "named by its study"];

fn row(regression: &Regression, noticed: &Noticed, is_named: bool) -> Vec<String> {
    let named = if is_named { regression.study.clone() } else { format!("no, not by {}", regression.study) };
    vec![
        regression.name.clone(),
        regression.file.clone(),
        noticed.studies().to_string(),
        noticed.first().to_owned(),
        named,
    ]
}

fn page(table: &Table, sentence: &str, ended: &str) -> String {
    format!(
        "# Mistakes of meaning\n\nWritten by `cargo xtask dev regressions --write`. Each mistake of `{}` is planted by itself; the \
         quick tier of `verify` must notice it, and the study named for it must name what is wrong. {ended}\n\n{sentence}.\n\n{}",
        list::FILE,
        report::markdown(table)
    )
}
