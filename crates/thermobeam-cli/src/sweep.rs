//! `sweep FILE`: many scenes from one.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use clap::Args;
use indicatif::ProgressBar;
use thermobeam_study::sweep::{self, CaseLine, InOrder, Journal, Sweep, SweepShare};

use convergence_study::{
    Verdict,
    internal::{
        cli::{
            exit::{self, CommandOutcome},
            flags::Flags,
            running::{self, seconds},
        },
        run,
    },
};

use super::merge;

/// Run many scenes: a grid or a Latin hypercube over the numbers of one scene
///
/// One JSON line for each case: its parameters and what `run --format json` prints, without the
/// wall time. A case that fails has a line with the reason; the exit status is then 1. With --out
/// the folder gets a journal, and results.jsonl at the end; without --out, the lines go to standard
/// output. --merge joins the shares of a sweep into the file that one run would have written; a
/// missing or repeated case is an error, and nothing is written.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The sweep file
    #[arg(required_unless_present = "merge")]
    file: Option<PathBuf>,
    /// Time limit of each case; its line says where it stopped, and the others continue
    /// [default: none]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    time_limit: Option<Duration>,
    /// Continue the sweep in the folder; start it if the folder is empty
    #[arg(long, requires = "out")]
    resume: bool,
    /// Run share k of n; the values of a case determine its share; --merge joins the shares
    #[arg(long, value_name = "k/n", default_value_t = SweepShare::ALL, hide_default_value = true)]
    partition: SweepShare,
    /// Join these shares of a sweep, and run nothing
    #[arg(
        long,
        value_name = "DIR",
        num_args = 1..,
        conflicts_with_all = ["file", "time_limit", "resume", "partition"]
    )]
    merge: Vec<PathBuf>,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> CommandOutcome {
    let Some(file) = &arguments.file else {
        return merge::run(&arguments.merge, &arguments.flags);
    };
    let sweep = Sweep::read(file)?;
    let share = arguments.partition;
    let mine: Vec<usize> = (0..sweep.cases())
        .filter(|&index| share == SweepShare::ALL || share.holds(sweep.case(index).hash()))
        .collect();
    Ok(match &arguments.flags.out {
        Some(folder) => to_folder(arguments, &sweep, mine, folder)?,
        None => to_stdout(arguments, &sweep, mine)?,
    })
}

/// Lines to standard output, in the order of the cases; fail if one failed.
fn to_stdout(arguments: &Arguments, sweep: &Sweep, mine: Vec<usize>) -> io::Result<Verdict> {
    let bar = running::counting(&sweep.name, mine.len(), "cases", arguments.flags.quiet);
    let state = Mutex::new((InOrder::new(io::stdout(), mine.clone()), Verdict::Pass));
    let outcome = sweep::run(
        sweep,
        &mine,
        jobs(arguments),
        arguments.time_limit,
        |line: CaseLine| {
            let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
            state.1 = if line.passed { state.1 } else { Verdict::Fail };
            bar.inc(1);
            state.0.add(line)
        },
    );
    bar.finish_and_clear();
    match outcome {
        // A reader that stops early, such as `head`, is not an error.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
        _ => Ok(state.into_inner().unwrap_or_else(PoisonError::into_inner).1),
    }
}

/// Lines to the folder's journal, then the results in order; fail if one failed.
fn to_folder(
    arguments: &Arguments,
    sweep: &Sweep,
    mine: Vec<usize>,
    folder: &Path,
) -> Result<Verdict, sweep::SweepError> {
    let journal = Journal::open(folder, sweep, arguments.partition, arguments.resume)?;
    let cases = mine.len();
    let pending: Vec<usize> = mine
        .into_iter()
        .filter(|&index| !journal.has(index))
        .collect();
    let begun = pending.len();
    let bar = running::counting(&sweep.name, begun, "cases", arguments.flags.quiet);
    let counted = bar.clone();
    let before = cases - begun;
    let place = folder.display().to_string();
    exit::say(move || {
        let done = before + counted.position() as usize;
        format!("{done} of {cases} cases are saved in {place}; continue with --resume")
    });
    let start = Instant::now();
    let journal = journaled(sweep, pending, arguments, journal, &bar)?;
    let took = start.elapsed();
    bar.finish_and_clear();
    let failed = journal.failed();
    let results = journal.finish()?;
    let flags = &arguments.flags;
    let verdict = if failed == 0 {
        Verdict::Pass
    } else {
        Verdict::Fail
    };
    let sentence = format!("{}: {cases} cases, {failed} failed", sweep.name);
    let words = flags.words(verdict, &sentence, || {
        summary(arguments, sweep, [cases, begun, failed], took, &results)
    });
    Ok(flags.print(
        verdict,
        &SweepObject {
            sweep: &sweep.name,
            cases,
            failed,
            results,
        },
        &words,
    )?)
}

/// The keys of `sweep --out DIR --format json` in addition to the verdict.
#[derive(serde::Serialize)]
struct SweepObject<'a> {
    sweep: &'a str,
    cases: usize,
    failed: usize,
    results: PathBuf,
}

fn jobs(arguments: &Arguments) -> usize {
    arguments.flags.jobs.unwrap_or_else(run::available).get()
}

fn journaled(
    sweep: &Sweep,
    pending: Vec<usize>,
    arguments: &Arguments,
    journal: Journal,
    bar: &ProgressBar,
) -> Result<Journal, io::Error> {
    let journal = Mutex::new(journal);
    sweep::run(
        sweep,
        &pending,
        jobs(arguments),
        arguments.time_limit,
        |line| {
            bar.inc(1);
            journal
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .append(&line)
        },
    )?;
    Ok(journal.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn summary(
    arguments: &Arguments,
    sweep: &Sweep,
    [cases, begun, failed]: [usize; 3],
    took: Duration,
    results: &Path,
) -> String {
    let share = if arguments.partition == SweepShare::ALL {
        String::new()
    } else {
        format!(
            ", share {}: {cases} of {}",
            arguments.partition,
            sweep.cases()
        )
    };
    let each = 1e3 * took.as_secs_f64() / begun.max(1) as f64;
    format!(
        "{}: {cases} cases{share}; {failed} failed\n{begun} run now in {:.2} s, {each:.3} ms each; {} were there\nwrote {}\n",
        sweep.name,
        took.as_secs_f64(),
        cases - begun,
        results.display()
    )
}
