//! `sweep FILE`: many scenes from one.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use indicatif::ProgressBar;
use thermobeam_study::sweep::{self, Finished, Header, ShareFile, Sweep, SweepShare};

use convergence_study::{
    Verdict,
    command_line::{Flags, Unusable},
};

/// Run many scenes: a grid or a list of the numbers of one scene
///
/// One JSON line for each case, in their order: its parameters and what `run --format json` prints,
/// without the wall time. The first line names the sweep by a hash. A case that fails has a line
/// with the reason; the exit status is then 1. With --out the lines go to results.jsonl in the
/// folder, and the same command again runs what has no line; without, to standard output. --merge
/// joins the shares of a sweep into the file that one run would have written; a missing or repeated
/// case is an error, and nothing is written.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The sweep file
    #[arg(required_unless_present = "merge")]
    file: Option<PathBuf>,
    /// Time limit of each case; its line says where it stopped, and the others continue. It has a
    /// line, so the same command does not run it again: choose another folder, without a limit or
    /// with a longer one, or remove its line and those below it [default: none]
    #[arg(long, value_name = "SECONDS", value_parser = Flags::seconds, allow_hyphen_values = true)]
    time_limit: Option<Duration>,
    /// Run share k of n; --merge joins the shares
    #[arg(long, value_name = "k/n", default_value_t = SweepShare::ALL, hide_default_value = true)]
    partition: SweepShare,
    /// Join these shares of a sweep, and run nothing
    #[arg(
        long,
        value_name = "DIR",
        num_args = 1..,
        conflicts_with_all = ["file", "time_limit", "partition"]
    )]
    merge: Vec<PathBuf>,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Result<Verdict, Unusable> {
    let Some(file) = &arguments.file else {
        return merge(&arguments.merge, &arguments.flags);
    };
    let sweep = Sweep::read(file)?;
    match &arguments.flags.out {
        Some(folder) => to_folder(arguments, &sweep, folder),
        None => Ok(to_stdout(arguments, &sweep)?),
    }
}

/// All lines to standard output; fail if a case failed.
fn to_stdout(arguments: &Arguments, sweep: &Sweep) -> io::Result<Verdict> {
    let share = arguments.partition;
    let cases: Vec<usize> = share.cases(sweep.cases).collect();
    let bar = arguments.flags.bar(&sweep.name, cases.len(), "cases");
    let mut failed = 0;
    let written = writeln!(io::stdout(), "{}", Header::new(sweep, share).line())
        .and_then(|()| write_lines(arguments, sweep, &cases, io::stdout(), &bar, &mut failed));
    match written {
        // A reader that stops early, such as `head`, is not an error.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
        _ => Ok(verdict(failed)),
    }
}

/// The lines that are missing to the file of the folder; fail if a case failed.
fn to_folder(arguments: &Arguments, sweep: &Sweep, folder: &Path) -> Result<Verdict, Unusable> {
    let ShareFile {
        path: results,
        file,
        pending,
        done,
        mut failed,
    } = ShareFile::open(folder, sweep, arguments.partition)?;
    let (begun, cases) = (pending.len(), done + pending.len());
    let bar = arguments.flags.bar(&sweep.name, begun, "cases");
    let (counted, place) = (bar.clone(), folder.display().to_string());
    Flags::when_interrupted(move || {
        let done = done + counted.position() as usize;
        format!("{done} of {cases} cases are saved in {place}; the same command runs the others")
    });
    write_lines(arguments, sweep, &pending, file, &bar, &mut failed)
        .map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", results.display())))?;
    let finished = Finished {
        cases,
        failed,
        results,
    };
    let ran = format!("\n{begun} run now, {done} were there");
    report(&arguments.flags, Some(&sweep.name), &finished, &ran)
}

/// `sweep --merge DIR...`: joins shares into the file that one run would have written.
fn merge(folders: &[PathBuf], flags: &Flags) -> Result<Verdict, Unusable> {
    let Some(out) = &flags.out else {
        return Err(Unusable::because(
            "--out DIR: expected the folder for the joined results; found none",
        ));
    };
    report(flags, None, &sweep::merge(folders, out)?, "")
}

fn verdict(failed: usize) -> Verdict {
    if failed == 0 {
        Verdict::Pass
    } else {
        Verdict::Fail
    }
}

/// The keys of `sweep --out DIR --format json` in addition to the verdict.
#[derive(serde::Serialize)]
struct SweepObject<'a> {
    /// The sweep's name; of joined shares none is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    sweep: Option<&'a str>,
    #[serde(flatten)]
    finished: &'a Finished,
}

/// Says what a finished file of results holds.
///
/// * `ran`: what else to say of a sweep that was run.
fn report(
    flags: &Flags,
    sweep: Option<&str>,
    finished: &Finished,
    ran: &str,
) -> Result<Verdict, Unusable> {
    let verdict = verdict(finished.failed);
    let name = sweep.map(|name| format!("{name}: ")).unwrap_or_default();
    let sentence = format!("{name}{} cases, {} failed", finished.cases, finished.failed);
    let words = flags.words(verdict, &sentence, || {
        format!("{sentence}{ran}\nwrote {}\n", finished.results.display())
    });
    Ok(flags.print(verdict, &SweepObject { sweep, finished }, &words)?)
}

/// Runs cases and writes their lines in order. Counts in `failed` those that fail, and on the bar
/// those that are written.
fn write_lines(
    arguments: &Arguments,
    sweep: &Sweep,
    cases: &[usize],
    output: impl Write + Send,
    bar: &ProgressBar,
    failed: &mut usize,
) -> io::Result<()> {
    let jobs = arguments.flags.threads().get();
    let limit = arguments.time_limit;
    let run = sweep::run(sweep, cases, jobs, limit, output, |written, failures| {
        bar.inc(written as u64);
        *failed += failures;
    });
    bar.finish_and_clear();
    run
}
