//! `verify`: the main job.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use thermobeam_study::report::{can_be_blessed, key_numbers, sentence};
use thermobeam_study::runner::Finished;
use thermobeam_study::study;
use thermobeam_study::study_file::Tier;
use thermobeam_study::verdict::Verdict;
use thermobeam_study::verification::{self, Request, Scope, Verification};

use crate::running::{Limits, Watched};
use crate::screen;
use crate::workspace::{self, Listed};
use crate::{github, moved, selection};

/// Run the studies in `studies/` and write `reports/`
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Tier of studies; full holds quick
    #[arg(long, value_parser = selection::tier_parser(), default_value = "quick")]
    tier: Tier,
    #[command(flatten)]
    limits: Limits,
    /// Take the new numbers for the baseline; refused where a study does not pass
    #[arg(long)]
    bless: bool,
    /// No progress bar, and of the table only what does not pass
    #[arg(long)]
    quiet: bool,
    /// Every number that is not what it was, not only the worst of each study
    #[arg(long, conflicts_with = "quiet")]
    verbose: bool,
    /// Ids or patterns of studies; their reports go to reports/local/partial/
    #[arg(value_name = "ID")]
    ids: Vec<String>,
}

/// Runs the studies, writes the reports, prints the table.
pub(crate) fn verify(arguments: &Arguments) -> Result<ExitCode, Box<dyn Error>> {
    let root = workspace::root()?;
    let all = workspace::studies(&root)?;
    let headers: Vec<_> = all.iter().map(|listed| &listed.header).collect();
    let meant = selection::select(&headers, arguments.tier, &arguments.ids)?;
    let meant = all.iter().zip(meant).filter(|(_, meant)| *meant).map(|(listed, _)| listed);
    let studies = meant.map(|listed| study::read(&listed.path)).collect::<Result<Vec<_>, _>>()?;

    let (effort, bless) = (arguments.limits.effort(), arguments.bless);
    let request = Request { scope: scope(arguments, &all), effort, bless, root };
    let watched = Watched::new(&studies, !arguments.quiet);
    let verification = verification::verify(&studies, &request, &|progress| watched.show(progress));
    watched.clear();
    let verification = verification?;
    screen::print(&text(&verification, &request, arguments))?;
    github::announce(&verification.findings(&request.scope, &request.scope.command()))?;
    Ok(screen::exit(verification.verdict))
}

fn scope(arguments: &Arguments, all: &[Listed]) -> Scope {
    if arguments.ids.is_empty() {
        Scope::Tier(arguments.tier, all.iter().map(|listed| listed.header.id.clone()).collect())
    } else {
        Scope::Selection(arguments.ids.clone())
    }
}

/// The table, what moved, what became of the blessing, where the reports are, and the verdict last.
fn text(found: &Verification, request: &Request, arguments: &Arguments) -> String {
    let quiet = arguments.quiet;
    let shown = found.finished.iter().filter(|finished| !quiet || finished.outcome.verdict != Verdict::Pass);
    let rows: Vec<Vec<String>> = shown.map(row).collect();
    let mut text = String::new();
    if !rows.is_empty() {
        text += &screen::table(&["study", "verdict", "seconds", "key numbers"], &rows);
        text += "\n";
    }
    text += &moved::lines(&found.changes, arguments.verbose);
    match &found.blessing {
        Some(Ok(())) => text += "baseline: blessed, see studies/baseline.json\n",
        Some(Err(refusal)) => text += &format!("baseline: {refusal}\n"),
        None if !found.changes.is_empty() && can_be_blessed(&found.finished) => {
            text += &format!("if that is meant: {} --bless\n", request.scope.command());
        }
        None => {}
    }
    if !quiet {
        let [page, readme] = ["index.html", "README.md"].map(|name| below(&found.reports.join(name), &request.root));
        text += &format!("report: {page}, {readme}\n");
        if matches!(request.scope, Scope::Selection(_)) {
            text += "a selection leaves the committed report as it is\n";
        }
    }
    text + &format!("{}: {}\n", screen::verdict(found.verdict), sentence(&found.finished, &found.changes))
}

fn row(Finished { header, outcome, spent, .. }: &Finished) -> Vec<String> {
    let seconds = format!("{:.2}", spent.busy.as_secs_f64());
    vec![header.id.clone(), outcome.verdict.to_string(), seconds, key_numbers(outcome)]
}

/// A path as seen from the workspace.
fn below(path: &Path, root: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).display().to_string()
}
