//! `list`: the studies with their last verdicts and their costs.

use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::study::{StudyFile, Tier};
use crate::text::columns::Columns;

use super::exit::{Ended, Outcome};
use crate::cli::earlier::Earlier;
use crate::cli::workspace;
use crate::cli::{output, screen, selection};

/// List the studies: tier, last verdict, cost, claim
///
/// The verdict is that of the newest record: reports/results.json, reports/full/results.json, or that of a selection in
/// reports/local/. The work is the study's own estimate, in millions of the units of cost that its kind counts in. Seconds are those of all threads
/// in the last `verify` on this machine. On a terminal claims are cut to its width; elsewhere they are whole.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Only the studies that `verify --tier` would run; full holds quick
    #[arg(long, value_parser = selection::tier_parser(), default_value = "full")]
    tier: Tier,
    /// Only these: ids or patterns such as '*-space'
    #[arg(value_name = "ID")]
    ids: Vec<String>,
}

const HEAD: [&str; 7] = ["study", "tier", "kind", "last", "work", "seconds", "claim"];

/// The narrowest claim that still says something.
const NARROWEST: usize = 24;

/// Prints a row for each study.
///
/// # Errors
/// Study files or records that cannot be read, and a selection without a study.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let all = workspace::studies(project, &root)?;
    let headers: Vec<_> = all.iter().map(|file| file.study.header()).collect();
    let meant = selection::select(&headers, arguments.tier, &arguments.ids, &format!("{} list", project.command))?;
    let earlier = Earlier::read(&root)?;
    let meant = all.iter().zip(meant).filter(|(_, meant)| *meant);
    let mut rows: Vec<Vec<String>> = meant.map(|(file, _)| row(file, &earlier)).collect();
    if let Some(width) = screen::width() {
        fit(&mut rows, width);
    }
    output::print(&screen::table(&HEAD, &rows))?;
    Ok(Ended::Well)
}

fn row(StudyFile { study, .. }: &StudyFile, earlier: &Earlier) -> Vec<String> {
    let header = study.header();
    let verdict = earlier.verdict(&header.id).map_or("never run", Verdict::name);
    let work = format!("{:.2}", 1e-6 * study.plan().cases().iter().map(|case| case.cost).sum::<f64>());
    let seconds = earlier.seconds(&header.id).map_or("-".to_owned(), |seconds| format!("{seconds:.2}"));
    let [id, tier, kind] = [header.id.as_str(), header.tier.name(), header.kind.as_str()].map(str::to_owned);
    vec![id, tier, kind, verdict.to_owned(), work, seconds, header.claim.clone()]
}

/// Cuts the claims so that no row is wider than the screen.
fn fit(rows: &mut [Vec<String>], width: usize) {
    let columns = Columns::of(&HEAD.map(str::to_owned), rows);
    let claim = HEAD.len() - 1;
    let before: usize = (0..claim).map(|column| columns.width(column) + 2).sum();
    let room = width.saturating_sub(before).max(NARROWEST);
    for cell in rows.iter_mut().map(|row| &mut row[claim]).filter(|cell| cell.chars().count() > room) {
        *cell = cell.chars().take(room - 1).chain(['…']).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::{HEAD, NARROWEST, fit};
    use crate::cli::screen;

    #[test]
    fn rows_fit_on_the_screen_and_short_claims_stay_whole() {
        let row = |claim: &str| {
            let mut row = vec!["x".to_owned(); HEAD.len() - 1];
            row.push(claim.to_owned());
            row
        };
        let long = "é".repeat(200);
        for width in [80, 120] {
            let mut rows = vec![row(&long), row("short")];
            fit(&mut rows, width);
            let table = screen::table(&HEAD, &rows);
            assert_eq!(table.lines().map(|line| line.chars().count()).max(), Some(width));
            assert!(table.contains('…') && table.contains("short\n"));
        }
        let mut rows = vec![row(&long)];
        fit(&mut rows, 10);
        assert_eq!(rows[0][HEAD.len() - 1].chars().count(), NARROWEST);
    }
}
