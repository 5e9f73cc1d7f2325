//! `merge DIR...`: joins the shares of a sweep.

use std::path::PathBuf;

use clap::Args;
use thermobeam_study::sweep;

use convergence_harness::cli::exit::{Outcome, Unusable};
use convergence_harness::cli::flags::Flags;
use convergence_harness::judge::verdict::Verdict;

/// Join the shares of a sweep into the file that one run would have written
///
/// Writes results.jsonl to the folder given by --out, with a line for each case in order. A missing
/// or repeated case is an error, and nothing is written.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The folders of all shares
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let flags = &arguments.flags;
    let Some(folder) = &flags.out else {
        return Err(Unusable::because(
            "--out DIR: expected the folder for the joined results; found none",
        ));
    };
    let merged = sweep::merge(&arguments.folders, folder)?;
    let verdict = if merged.failed == 0 {
        Verdict::Pass
    } else {
        Verdict::Fail
    };
    let sentence = format!("{} cases, {} failed", merged.cases, merged.failed);
    let words = flags.words(verdict, &sentence, || {
        format!("{sentence}\nwrote {}\n", merged.results.display())
    });
    Ok(flags.print(verdict, &merged, &words)?)
}
