//! `merge DIR...`: joins the shares of a sweep.

use std::path::PathBuf;

use clap::Args;
use thermobeam_study::sweep;

use convergence_study::cli::exit::{Ended, Outcome};
use convergence_study::cli::output;

/// Join the shares of a sweep into the file that one run would have written
///
/// A missing or repeated case is an error, and nothing is written.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The folders of all shares
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// The file to write, in the order of the cases
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Print nothing on success
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let merged = sweep::merge(&arguments.folders, &arguments.out)?;
    if !arguments.quiet {
        let out = arguments.out.display();
        output::print(&format!("{} cases, {} failed\nwrote {out}\n", merged.cases, merged.failed))?;
    }
    Ok(if merged.failed == 0 { Ended::Well } else { Ended::Badly })
}
