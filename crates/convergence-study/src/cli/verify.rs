//! `verify`: the main job.

use std::path::Path;

use super::exit::Outcome;
use super::flags::Flags;
use crate::cli::output::Format;
use crate::cli::running::{Limits, Watched, kept};
use crate::cli::{github, output, screen, selection, workspace};
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report::{Findings, blessing, can_be_blessed, key_numbers, sentence, text_of_failures};
use crate::run::Finished;
use crate::store::baseline::Change;
use crate::store::record;
use crate::study::{Study, StudyFile, Tier};
use crate::text::visible;
use crate::text::visible::visible;
use crate::verify;
use crate::verify::{Request, Scope, Verification};

/// Run the studies in `studies/` and write `reports/`
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Tier of studies; full holds quick
    #[arg(long, value_parser = selection::tier_parser(), default_value = "quick")]
    tier: Tier,
    #[command(flatten)]
    limits: Limits,
    /// Take the new numbers and claims for the baseline; refused where a study does not pass
    #[arg(long)]
    bless: bool,
    /// Why; a changed claim is not blessed without, and the baseline keeps it beside what has changed
    #[arg(long, value_name = "TEXT", requires = "bless", value_parser = reason)]
    reason: Option<String>,
    /// Take only these: STUDY:NAME of a number, STUDY:claim PATH, or a pattern such as 'heat-*:rate *'
    #[arg(long, value_name = "PATTERN", requires = "reason")]
    only: Vec<String>,
    /// Every study, also where some fail, and every number that is not what it was, not only the worst of each study
    #[arg(long, conflicts_with = "quiet")]
    verbose: bool,
    /// Ids or patterns of studies; their reports go to reports/local/partial/
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the studies, writes the reports, prints the table.
///
/// # Errors
/// Study files, a baseline or a selection that cannot be used, and reports that cannot be written.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let all = workspace::studies(project, &root)?;
    workspace::warn_of_near_names(&root);
    let headers: Vec<_> = all.iter().map(|file| file.study.header()).collect();
    let list = format!("{} list", project.command);
    let meant = selection::select(&headers, arguments.tier, &arguments.ids, &list)?;
    let scope = scope(arguments.tier, &arguments.ids, &all);
    let mut studies: Vec<Box<dyn Study>> =
        all.into_iter().zip(meant).filter(|(_, meant)| *meant).map(|(file, _)| file.study).collect();

    let Arguments { bless, reason, only, .. } = arguments;
    if *bless {
        // What is blessed was computed by the programs as they are.
        studies.iter_mut().for_each(|study| study.compute_anew());
    }
    let flags = &arguments.flags;
    let effort = flags.effort(arguments.limits.case_limit);
    let reports = flags.out.clone().unwrap_or_else(|| root.join("reports"));
    let request = Request { scope, effort, bless: *bless, reason: reason.clone(), only: only.clone(), root, reports };
    let watched = Watched::new(&studies, !flags.quiet);
    let verification = verify::verify(project, &studies, &request, &|progress| watched.show(progress));
    watched.clear();
    let verification = verification?;
    let record = verification.record(&request.scope, &request.scope.command(project));
    output::print(&match flags.format {
        Format::Text => text(project, &verification, &request, arguments),
        Format::Json => record::json(&record)?,
    })?;
    github::announce(&Findings { project, record: &record, see_also: None, provenance: None }, flags.format);
    Ok(verification.verdict.into())
}

/// A reason: it is kept in a file that people read, one line of text.
fn reason(text: &str) -> Result<String, String> {
    let text = text.trim();
    let is_line = !text.is_empty() && !text.contains(char::is_control);
    if is_line { Ok(text.to_owned()) } else { Err("expected one line of text that says why".to_owned()) }
}

/// The tier where nothing is named.
fn scope(tier: Tier, ids: &[String], all: &[StudyFile]) -> Scope {
    if ids.is_empty() {
        Scope::Tier(tier, all.iter().map(|file| file.study.header().clone()).collect())
    } else {
        Scope::Selection(ids.to_vec())
    }
}

/// The table, where the reports are, what differs from the baseline, what became of the blessing, what did not pass, and the
/// verdict last: a terminal shows the end.
fn text(project: &Project, found: &Verification, request: &Request, arguments: &Arguments) -> String {
    let quiet = arguments.flags.quiet;
    let mut text = moved_lines(&found.changes, arguments.verbose);
    match &found.blessing {
        Some(Ok(())) => text += "baseline: blessed, see studies/baseline.json\n",
        Some(Err(refusal)) => text += &format!("baseline: {}\n", visible::lines(&refusal.to_string())),
        None if !found.changes.is_empty() && can_be_blessed(&found.finished) => {
            let command = request.scope.command(project);
            text += &format!("if that is meant: {}\n", blessing(project, &command, &found.finished, &found.changes));
        }
        None => {}
    }
    let gap = if text.is_empty() { "" } else { "\n" };
    let mut whole = if quiet { String::new() } else { overview(found, request, arguments.verbose) + gap };
    whole += &text;
    let failures = text_of_failures(&found.finished);
    if !(failures.is_empty() || whole.is_empty()) {
        whole.push('\n');
    }
    whole += &failures;
    whole + &format!("{}: {}\n", screen::verdict(found.verdict), sentence(&found.finished, Some(&found.changes)))
}

/// The table of studies, without those that pass where something fails, and where the reports are.
fn overview(found: &Verification, request: &Request, verbose: bool) -> String {
    let all = verbose || found.verdict == Verdict::Pass;
    let is_shown = |finished: &&Finished| all || finished.outcome.verdict != Verdict::Pass;
    let rows: Vec<Vec<String>> = found.finished.iter().filter(is_shown).map(row).collect();
    let mut text = match rows[..] {
        [] => String::new(),
        _ => screen::table_within(screen::width(), &["study", "verdict", "seconds", "key numbers"], &rows),
    };
    match found.finished.len() - rows.len() {
        0 => {}
        1 => text += "1 study passes (--verbose lists it)\n",
        passing => text += &format!("{passing} studies pass (--verbose lists them)\n"),
    }
    for Finished { header, spent, .. } in &found.finished {
        text += &kept(spent).map_or(String::new(), |kept| format!("{}: {kept}\n", header.id));
    }
    let [page, readme] = ["index.html", "README.md"].map(|name| below(&found.reports.join(name), &request.root));
    text += &format!("\nreport: {page}, {readme}\n");
    if matches!(request.scope, Scope::Selection(_)) {
        text += "a selection leaves the committed report as it is\n";
    }
    text
}

fn row(Finished { header, outcome, spent, .. }: &Finished) -> Vec<String> {
    let seconds = format!("{:.2}", spent.busy.as_secs_f64());
    vec![header.id.clone(), outcome.verdict.to_string(), seconds, key_numbers(outcome)]
}

/// A path as seen from the workspace.
fn below(path: &Path, root: &Path) -> String {
    visible::path(path.strip_prefix(root).unwrap_or(path))
}

/// Changes of a study that are listed one by one.
const LISTED: usize = 3;

/// Claims that changed, under a head. Of numbers one line each, too; of a study with many, their number and those of most
/// weight, unless all are wanted.
fn moved_lines(changes: &[Change], all: bool) -> String {
    let studies = changes.chunk_by(|one, next| one.study == next.study);
    let numbers: String = studies.map(|of_study| of_one_study(of_study, all)).collect();
    let claims: String = changes.iter().filter(|change| change.movement.needs_a_reason()).map(claim).collect();
    if claims.is_empty() { numbers } else { format!("{numbers}claims changed\n{claims}") }
}

fn claim(change: &Change) -> String {
    format!("  {}\n", visible(&change.words()))
}

fn of_one_study(changes: &[Change], all: bool) -> String {
    let numbers: Vec<&Change> = changes.iter().filter(|change| !change.movement.needs_a_reason()).collect();
    if all || numbers.len() <= LISTED { each(numbers) } else { condensed(numbers) }
}

fn each<'c>(changes: impl IntoIterator<Item = &'c Change>) -> String {
    changes.into_iter().map(|change| format!("baseline: {}\n", visible(&change.to_string()))).collect()
}

fn condensed(changes: Vec<&Change>) -> String {
    let (study, rest) = (&changes[0].study, changes.len() - LISTED);
    let mut heaviest = changes.clone();
    // A stable order: of equals the first ones.
    heaviest.sort_by(|a, b| b.movement.weight().total_cmp(&a.movement.weight()));
    heaviest.truncate(LISTED);
    each(heaviest) + &format!("baseline: {study}: and {rest} more; --verbose and the report list all\n")
}

#[cfg(test)]
mod tests {
    use super::moved_lines;
    use crate::store::baseline::{Change, Movement};

    fn moved(study: &str, name: &str, to: f64) -> Change {
        let movement = Movement::Moved { from: 1.0, to, tolerance: 1e-3 };
        Change { study: study.to_owned(), name: name.to_owned(), movement }
    }

    #[test]
    fn of_many_changes_the_largest_are_listed() {
        let mut changes: Vec<Change> = (0..10).map(|i| moved("many", &format!("n{i}"), 1.1 + f64::from(i))).collect();
        changes[0].movement = Movement::Vanished { value: 1.0 };
        changes.push(moved("few", "m", 2.0));
        let text = moved_lines(&changes, false);
        let listed: Vec<&str> = text.lines().map(|line| line.split(' ').nth(2).unwrap()).collect();
        assert_eq!(listed, ["n0", "n9", "n8", "and", "m"], "{text}");
        assert!(text.contains("many: and 7 more"), "{text}");
        assert_eq!(moved_lines(&changes, true).lines().count(), 11);
    }
}
