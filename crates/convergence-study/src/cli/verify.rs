//! `verify`: the main job.

mod selection;

use std::io;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::exit::CommandOutcome;
use super::flags::Flags;
use super::running::{Limits, watched};
use super::screen::{self, Format};
use super::{github, study, where_lost, workspace};
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report::{
    Findings, blessing, can_be_blessed, key_numbers, sentence, text_of_diagnosis, text_of_failures,
};
use crate::run::{Effort, Finished};
use crate::store::{GuardedChange, Record, json, without_baseline};
use crate::study::{Study, Tier};
use crate::text::number::counted;
use crate::text::visible;
use crate::text::visible::visible;
use crate::verify;
use crate::verify::{Blessing, Scope, Verification, VerifyRequest};
use crate::where_lost::summary_of_located;
use selection::{dry_run, files, scope};

/// Run the studies in `studies/` and write `reports/`; or study files from anywhere
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Tier of studies; full includes quick
    #[arg(long, value_parser = workspace::tier_parser(), default_value = "quick")]
    tier: Tier,
    #[command(flatten)]
    limits: Limits,
    /// Accept the new numbers as baseline; refused if a study does not pass
    #[arg(long)]
    bless: bool,
    /// Accept also claims and tolerances that are looser, settings that changed, and what is gone
    #[arg(long, requires = "bless")]
    loosened: bool,
    /// Every study even if some fail, and every number that moved, not only the worst of each study
    #[arg(long, short, conflicts_with = "quiet")]
    verbose: bool,
    /// Only list what would run, with its cases and the seconds of its last run
    #[arg(long, short = 'n', conflicts_with_all = ["bless", "verbose", "durations"])]
    dry_run: bool,
    /// Begin no case once a study has failed; the report is then that of a selection
    #[arg(long, conflicts_with = "bless")]
    fail_fast: bool,
    /// Search where the order of studies that do not pass is lost, by variants of their solutions
    #[arg(long = "where", conflicts_with = "dry_run")]
    located: bool,
    /// List the slowest studies
    #[arg(long, conflicts_with = "quiet")]
    durations: bool,
    /// Ids or patterns of studies, whose reports go to reports/local/partial/; or study files,
    /// named with their ending .toml: they are run as `study` runs them
    #[arg(value_name = "ID|FILE")]
    ids: Vec<String>,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the studies, writes the reports, prints the table.
///
/// # Errors
/// Study files, a baseline or a selection that cannot be used, and reports that cannot be written.
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    if let Some(files) = files(arguments)? {
        return study::run_files(
            project,
            &files,
            arguments.limits,
            arguments.located,
            &arguments.flags,
        );
    }
    let started = Instant::now();
    let root = Project::root()?;
    let all = workspace::studies(project, &root)?;
    workspace::warn_of_near_names(&root);
    let headers: Vec<_> = all.iter().map(|file| file.study.header()).collect();
    let list = format!("{} list", project.command);
    let mask = workspace::select(&headers, arguments.tier, &arguments.ids, &list)?;
    if arguments.dry_run {
        return dry_run(arguments, &root, &all, &mask);
    }
    let scope = match scope(arguments.tier, &arguments.ids, &all) {
        // Studies may be missing: this is not a report on a tier.
        Scope::Tier(..) if arguments.fail_fast => Scope::Selection(vec!["--fail-fast".to_owned()]),
        scope => scope,
    };
    let studies: Vec<Box<dyn Study>> = all
        .into_iter()
        .zip(mask)
        .filter(|(_, is_selected)| *is_selected)
        .map(|(file, _)| file.study)
        .collect();

    arguments.limits.consent(project, &studies)?;
    let flags = &arguments.flags;
    let request = request(arguments, scope, root);
    let mut with_variants = studies
        .iter()
        .filter(|study| where_lost::has_variants(study.as_ref()));
    if arguments.located && with_variants.next().is_none() {
        return Err(where_lost::no_file("no study"));
    }
    let mut verification = watched(&studies, flags.quiet, |progress| {
        verify::verify(project, &studies, &request, progress)
    })?;
    if arguments.located {
        let finished = &mut verification.record.studies;
        where_lost::locate(&studies, finished, request.effort, flags.quiet)?;
    }
    let took = started.elapsed();
    print(project, &verification, &request, arguments, took)?;
    Ok(verification.record.verdict)
}

/// Prints what was found, and announces it to a CI server.
fn print(
    project: &Project,
    found: &Verification,
    request: &VerifyRequest,
    arguments: &Arguments,
    took: Duration,
) -> io::Result<()> {
    let format = arguments.flags.format;
    let findings = Findings {
        project,
        record: &found.record,
        see_also: None,
        provenance: None,
    };
    screen::print(&if format == Format::Json {
        json(&found.record)?
    } else {
        reused(&found.record.studies) + &text(project, found, request, arguments, took)
    })?;
    github::announce(&findings, format);
    Ok(())
}

/// How many levels have the answers of an earlier run; empty if none has.
fn reused(studies: &[Finished]) -> String {
    let counts = studies.iter().map(|study| study.outcome.reused);
    let counts: Vec<_> = counts.filter(|one| one.reused > 0).collect();
    let [reused, cases] = [
        counts.iter().map(|one| one.reused).sum::<usize>(),
        counts.iter().map(|one| one.cases).sum(),
    ];
    if reused == 0 {
        return String::new();
    }
    format!("{reused} of {} reused\n", counted(cases, "level"))
}

/// * `scope`: what is run; `root`: the folder of the project.
fn request(arguments: &Arguments, scope: Scope, root: PathBuf) -> VerifyRequest {
    let flags = &arguments.flags;
    VerifyRequest {
        scope,
        effort: Effort {
            fail_fast: arguments.fail_fast,
            ..flags.effort(arguments.limits.time_limit)
        },
        bless: arguments.bless,
        loosened: arguments.loosened,
        reports: flags.out.clone().unwrap_or_else(|| root.join("reports")),
        root,
    }
}

/// For a run that passes: the table of studies and the verdict. For any other: the verdict, its
/// cause, and the clearest failures first, all visible at once.
///
/// * `took`: from start to end.
fn text(
    project: &Project,
    found: &Verification,
    request: &VerifyRequest,
    arguments: &Arguments,
    took: Duration,
) -> String {
    let Arguments {
        verbose,
        flags: Flags { quiet, .. },
        ..
    } = arguments;
    let verdict = screen::verdict(found.record.verdict);
    // Numbers that have just become the baseline are not "unchanged".
    let is_blessed = matches!(found.blessing, Blessing::Taken(_));
    let changes = found.record.changes.as_deref().filter(|_| !is_blessed);
    let sentence = sentence(&found.record.studies, changes);
    let table = if *quiet {
        String::new()
    } else {
        overview(found, request, arguments)
    };
    if found.record.verdict == Verdict::Pass {
        return format!("{table}{}{verdict}: {sentence}\n", blessed(project, found));
    }
    if is_first(&found.record) && matches!(found.blessing, Blessing::NotAsked) {
        let Record {
            command, studies, ..
        } = &found.record;
        let command = blessing(project, command, studies, found.record.moves());
        return format!("{table}{sentence}; `{command}` accepts them\n");
    }
    let took = if *quiet {
        String::new()
    } else {
        format!(" in {:.1} s", took.as_secs_f64())
    };
    let clearest = found
        .record
        .diagnosis
        .as_ref()
        .map(|diagnosis| diagnosis.clearest.as_slice())
        .filter(|_| !verbose);
    let changes = changes_to_print(&found.record, *verbose);
    let parts = [
        format!("{verdict}{took}: {sentence}\n"),
        found
            .record
            .diagnosis
            .as_ref()
            .map(text_of_diagnosis)
            .unwrap_or_default(),
        text_of_failures(&found.record.studies, clearest),
        located(&found.record.studies, *verbose),
        moved_lines(&changes, *verbose) + &blessed(project, found),
        table,
    ];
    let parts: Vec<&str> = parts
        .iter()
        .map(|part| part.trim_end())
        .filter(|part| !part.is_empty())
        .collect();
    parts.join("\n\n") + "\n"
}

/// Where the orders of studies are lost, if this was searched for: of several studies the parts
/// that are named, and the conclusions; their tables if `verbose`.
fn located(studies: &[Finished], verbose: bool) -> String {
    let mut places = vec![];
    let mut texts = vec![];
    for Finished {
        header, located, ..
    } in studies
    {
        if let Some(located) = located {
            places.push(located);
            texts.push((header.id.as_str(), located));
        }
    }
    let has_tables = verbose || texts.len() == 1;
    let texts = texts.into_iter().map(|(id, located)| {
        if has_tables {
            format!("{id}\n{}", located.text())
        } else {
            format!("{id}: {}\n", located.conclusion)
        }
    });
    let texts: Vec<String> = texts.collect();
    summary_of_located(&places) + &texts.join(if has_tables { "\n" } else { "" })
}

/// Whether all studies pass and the baseline has nothing of them.
fn is_first(record: &Record) -> bool {
    can_be_blessed(&record.studies) && without_baseline(&record.studies, record.moves()).is_some()
}

/// The changes, without those of failing studies unless `verbose`: such a study has already said
/// why, and its numbers moved for the same reason.
fn changes_to_print(record: &Record, verbose: bool) -> Vec<GuardedChange> {
    let failed = |id: &str| {
        let mut studies = record.studies.iter();
        studies.any(|study| study.header.id == id && study.outcome.verdict != Verdict::Pass)
    };
    let is_printed = |change: &&GuardedChange| {
        verbose || change.movement.is_of_claims() || !failed(&change.study)
    };
    let moves = match without_baseline(&record.studies, record.moves()) {
        Some(_) => &[],
        None => record.moves(),
    };
    moves.iter().filter(is_printed).cloned().collect()
}

/// What was blessed, or which command blesses.
fn blessed(project: &Project, found: &Verification) -> String {
    let Record {
        command, studies, ..
    } = &found.record;
    match &found.blessing {
        Blessing::Taken(loosened) => {
            let lines = loosened.iter().map(|change| line("loosened: ", change));
            lines.collect::<String>() + "baseline: blessed, see studies/baseline.json\n"
        }
        Blessing::Refused(refusal) => {
            format!("baseline: {}\n", visible::lines(&refusal.to_string()))
        }
        Blessing::NotAsked if found.record.moves().is_empty() || !can_be_blessed(studies) => {
            String::new()
        }
        Blessing::NotAsked => {
            let command = blessing(project, command, studies, found.record.moves());
            format!("if that is meant: {command}\n")
        }
    }
}

/// The table of studies if all pass or all are wanted, otherwise how many more fail, and where the
/// reports are.
fn overview(
    found: &Verification,
    request: &VerifyRequest,
    Arguments {
        verbose, durations, ..
    }: &Arguments,
) -> String {
    let verbose = *verbose;
    let durations = *durations;
    let mut text = String::new();
    let shown = found
        .record
        .diagnosis
        .as_ref()
        .map_or(0, |diagnosis| diagnosis.clearest.len());
    if verbose || found.record.verdict == Verdict::Pass || is_first(&found.record) {
        let rows: Vec<Vec<String>> = found.record.studies.iter().map(row).collect();
        text = screen::table_within(
            screen::width(),
            &["study", "verdict", "seconds", "key numbers"],
            &rows,
        ) + "\n";
    } else {
        let failing = found
            .record
            .studies
            .iter()
            .filter(|study| study.outcome.verdict != Verdict::Pass)
            .count();
        let more = failing.saturating_sub(shown);
        let rest = if more > 0 {
            format!("{more} more: ")
        } else {
            String::new()
        };
        text += &format!("{rest}--verbose lists every study and every number that changed\n");
    }
    if durations {
        let mut slowest: Vec<&Finished> = found.record.studies.iter().collect();
        slowest.sort_by_key(|study| std::cmp::Reverse(study.spent.busy));
        let row = |study: &&Finished| {
            vec![
                format!("{:.2}", study.spent.busy.as_secs_f64()),
                study.header.id.clone(),
            ]
        };
        let rows: Vec<Vec<String>> = slowest.iter().take(SLOWEST).map(row).collect();
        text += &(screen::table(&["seconds", "slowest studies"], &rows) + "\n");
    }
    // As seen from the workspace.
    text += &screen::report_in(
        found
            .reports
            .strip_prefix(&request.root)
            .unwrap_or(&found.reports),
    );
    if matches!(request.scope, Scope::Selection(_)) {
        text += "a selection leaves the committed report as it is\n";
    } else if found.record.verdict != Verdict::Pass {
        text += "a run that does not pass leaves the committed report as it is\n";
    }
    text
}

fn row(
    Finished {
        header,
        outcome,
        spent,
        ..
    }: &Finished,
) -> Vec<String> {
    let seconds = format!("{:.2}", spent.busy.as_secs_f64());
    vec![
        header.id.clone(),
        outcome.verdict.to_string(),
        seconds,
        key_numbers(outcome),
    ]
}

/// Studies that `--durations` lists.
const SLOWEST: usize = 10;

/// Numbers that moved which are listed one by one, unless all are wanted.
const LISTED: usize = 6;

/// Numbers that moved, those that moved farthest first unless all are wanted; then changed claims,
/// under a head.
fn moved_lines(changes: &[GuardedChange], all: bool) -> String {
    let (claims, mut numbers): (Vec<&GuardedChange>, Vec<&GuardedChange>) = changes
        .iter()
        .partition(|change| change.movement.is_of_claims());
    let more = numbers.len().saturating_sub(LISTED);
    let mut lines = String::new();
    if !all && more > 0 {
        let weight = |change: &GuardedChange| change.movement.weight();
        numbers.sort_by(|one, next| weight(next).total_cmp(&weight(one)));
        numbers.truncate(LISTED);
    }
    for change in &numbers {
        lines += &line("baseline: ", change);
    }
    if numbers.len() == LISTED && more > 0 {
        lines += &format!("baseline: and {more} more numbers\n");
    }
    if !claims.is_empty() {
        lines += "claims changed\n";
    }
    for change in claims {
        lines += &line("  ", change);
    }
    lines
}

/// A change on a line of its own.
fn line(before: &str, change: &GuardedChange) -> String {
    format!("{before}{}\n", visible(&change.to_string()))
}

#[cfg(test)]
mod tests {
    use super::moved_lines;
    use crate::store::{GuardedChange, Movement};

    #[test]
    fn of_many_changes_the_farthest_are_listed_unless_all_are_wanted() {
        let changes: Vec<GuardedChange> = (0..10)
            .map(|i| GuardedChange::moved("many", &format!("n{i}"), [1.0, 1.1 + f64::from(i)]))
            .collect();
        let lines = |changes: &[GuardedChange], all| -> Vec<String> {
            let text = moved_lines(changes, all);
            text.lines().map(str::to_owned).collect()
        };
        assert_eq!(lines(&changes[..6], false).len(), 6);
        assert!(lines(&changes[..6], false)[0].starts_with("baseline: many: n0"));
        assert_eq!(lines(&changes, true).len(), 10);
        let few = lines(&changes, false);
        assert!(few[0].starts_with("baseline: many: n9 moved"), "{few:?}");
        assert_eq!(few[6..], ["baseline: and 4 more numbers"]);
        let mut claim = GuardedChange::moved("few", "study", [1.0, 1.0]);
        claim.movement = Movement::VanishedStudy { numbers: 3 };
        assert_eq!(
            lines(&[changes, vec![claim]].concat(), false)[7..],
            [
                "claims changed",
                "  few: study was deleted: it had 3 guarded numbers"
            ]
        );
    }
}
