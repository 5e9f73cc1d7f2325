//! `list`: the studies with their last verdicts and their costs.

use std::path::Path;

use serde_json::json;

use super::exit::CommandOutcome;
use super::flags::Flags;
use super::screen;
use super::workspace;
use crate::project::Project;
use crate::study::{StudyFile, Tier};
use crate::text::columns::Columns;
use crate::text::number::{counted, counted_as};
use crate::text::visible::visible;
use convergence_judge::verdict::Verdict;

/// List the studies: tier, last verdict, cost, claim
///
/// Verdict and seconds, which are those of all threads, are of the last `verify` of each study on
/// this machine: it keeps them in reports/local/. The home is the file that the study is in, of
/// data or of code. On a terminal claims are cut to its width; elsewhere they are whole.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Only the studies that `verify --tier` would run; full includes quick
    #[arg(long, value_parser = workspace::tier_parser(), default_value = "full")]
    tier: Tier,
    /// Only these: ids or patterns such as '*-space'
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    #[command(flatten)]
    flags: Flags,
}

/// A study as it is listed.
#[derive(serde::Serialize)]
struct ListedStudy {
    id: String,
    tier: &'static str,
    kind: String,
    /// The last verdict; `None` if it never ran.
    last: Option<&'static str>,
    cases: usize,
    /// The time of its last run, if it ever ran.
    seconds: Option<f64>,
    /// The file that it is in: of data, or of code.
    home: String,
    claim: String,
}

const HEAD: [&str; 8] = [
    "study", "tier", "kind", "last", "cases", "seconds", "home", "claim",
];

/// Prints a row for each study.
///
/// # Errors
/// Study files or records that cannot be read, and a selection without a study.
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    let root = Project::root()?;
    let all = workspace::studies(project, &root)?;
    let files = workspace::select(project, all, arguments.tier, &arguments.ids)?;
    show(&root, &files, &arguments.flags)
}

/// Prints a row for each of these studies, and what they took when they last ran.
///
/// # Errors
/// Records that cannot be read.
pub(super) fn show(root: &Path, files: &[StudyFile], flags: &Flags) -> CommandOutcome {
    let runs = workspace::last_runs(root)?;
    let mut studies = vec![];
    let mut last = vec![];
    for StudyFile { path, study } in files {
        let header = study.header();
        let run = runs.get(&header.id);
        let verdict = run.and_then(|run| run.verdict);
        last.push(verdict.unwrap_or(Verdict::Inconclusive));
        studies.push(ListedStudy {
            id: header.id.clone(),
            tier: header.tier.name(),
            kind: header.kind.clone(),
            last: verdict.map(Verdict::name),
            cases: study.plan().cases().len(),
            seconds: run.map(|run| run.busy_seconds),
            home: path.display().to_string(),
            claim: header.claim.clone(),
        });
    }
    let passed = last.iter().filter(|verdict| verdict.is_pass()).count();
    let cases = studies.iter().map(|study| study.cases).sum();
    let total: f64 = studies
        .iter()
        .map(|study| study.seconds.unwrap_or(0.0))
        .sum();
    let sentence = format!(
        "{} with {}, of which {passed} passed when they last ran; {total:.1} s",
        counted_as(studies.len(), "study", "studies"),
        counted(cases, "case")
    );
    let verdict = Verdict::worst(last);
    let words = flags.words(verdict, &sentence, || {
        let mut rows: Vec<Vec<String>> = studies.iter().map(row).collect();
        let mut head = HEAD.to_vec();
        let width = screen::width();
        width
            .iter()
            .for_each(|width| make_room(&mut head, &mut rows, *width));
        let table = screen::table_within(width, &head, &rows);
        format!("{table}\n{sentence}\n")
    });
    flags.show("list", verdict, &json!({"studies": studies}), &words)?;
    Ok(Verdict::Pass)
}

fn row(study: &ListedStudy) -> Vec<String> {
    let ListedStudy {
        id,
        tier,
        kind,
        last,
        cases,
        seconds,
        home,
        claim,
    } = study;
    let last = last.unwrap_or("never run").to_owned();
    let seconds = seconds.map_or("-".to_owned(), |seconds| format!("{seconds:.2}"));
    vec![
        id.clone(),
        (*tier).to_owned(),
        kind.clone(),
        last,
        cases.to_string(),
        seconds,
        visible(home),
        claim.clone(),
    ]
}

/// Leaves out columns to make room for the claim.
fn make_room(head: &mut Vec<&str>, rows: &mut [Vec<String>], width: usize) {
    for dispensable in ["home", "kind", "cases", "tier"] {
        let column = head.iter().position(|name| *name == dispensable);
        if let Some(column) = column.filter(|_| room(head, rows, width) < screen::LEAST) {
            head.remove(column);
            rows.iter_mut().for_each(|row| drop(row.remove(column)));
        }
    }
}

/// The width that the other columns leave to the last one.
fn room(head: &[&str], rows: &[Vec<String>], width: usize) -> usize {
    let head: Vec<String> = head.iter().map(|name| (*name).to_owned()).collect();
    let columns = Columns::of(&head, rows);
    width.saturating_sub(
        (0..head.len() - 1)
            .map(|column| columns.width(column) + 2)
            .sum(),
    )
}

#[cfg(test)]
mod tests {
    use super::{HEAD, make_room};
    use crate::cli::screen;

    fn row(id: &str, claim: &str) -> Vec<String> {
        [
            id,
            "quick",
            "self-convergence",
            "inconclusive",
            "100",
            "1.00",
            "studies/self-convergence.toml",
            claim,
        ]
        .map(str::to_owned)
        .into()
    }

    /// The widest line, and the names of the columns.
    fn fitted(rows: &mut [Vec<String>], width: usize) -> (String, Vec<&'static str>) {
        let mut head = HEAD.to_vec();
        make_room(&mut head, rows, width);
        (screen::table_within(Some(width), &head, rows), head)
    }

    #[test]
    fn rows_fit_on_the_screen_and_short_claims_stay_whole() {
        let long = "é".repeat(200);
        for (width, columns) in [(80, 4), (160, HEAD.len())] {
            let mut rows = [row("work-precision-manufactured", &long), row("x", "short")];
            let (table, head) = fitted(&mut rows, width);
            assert_eq!(
                table.lines().map(|line| line.chars().count()).max(),
                Some(width),
                "{table}"
            );
            assert!(
                table.contains('…') && table.contains("short\n") && table.contains("inconclusive"),
                "{table}"
            );
            assert_eq!(head.len(), columns, "{head:?}");
        }
        let mut rows = [row("x", &long)];
        assert_eq!(
            fitted(&mut rows, 10).0.matches('é').count(),
            screen::LEAST - 1
        );
    }
}
