//! `sweep --merge DIR...`: joins the shares of a sweep into the file that one run would have
//! written.

use std::path::PathBuf;

use thermobeam_study::sweep;

use convergence_study::{
    Verdict,
    internal::cli::{
        exit::{CommandOutcome, Unusable},
        flags::Flags,
    },
};

/// Writes `results.jsonl` to the folder of `--out`, with a line for each case in order.
///
/// * `folders`: of all shares.
///
/// # Errors
/// A missing or repeated case; nothing is written then.
pub(crate) fn run(folders: &[PathBuf], flags: &Flags) -> CommandOutcome {
    let Some(folder) = &flags.out else {
        return Err(Unusable::because(
            "--out DIR: expected the folder for the joined results; found none",
        ));
    };
    let merged = sweep::merge(folders, folder)?;
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
