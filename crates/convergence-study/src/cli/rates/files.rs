//! What `rates --out DIR` writes: a figure, Markdown and JUnit XML, and on GitHub the job summary.

use std::io;
use std::path::Path;

use super::text::{found, legend, mark, pairwise, rate, sentence};
use super::{Findings, Judged};
use crate::cli::github;
use crate::judge::verdict::Aside;
use crate::plots::{Convergence, ErrorSeries, Guide, convergence};
use crate::store::{atomic, junit};
use crate::text::number::{error_text, plain_text};
use crate::text::visible::visible;

/// Most columns in the figure: more would have the colours of the first.
const DRAWN: usize = 8;

/// Writes the files, each as a whole, and appends to the job summary.
///
/// # Errors
/// That of the operating system, with the name of the file.
pub(super) fn write(findings: &Findings<'_>, folder: &Path) -> io::Result<()> {
    atomic::prepare_folder(folder)?;
    atomic::write(&folder.join("rates.svg"), figure(findings))?;
    let picture = format!("![Errors over {}](rates.svg)\n\n", cell(&findings.table.step));
    atomic::write(&folder.join("rates.md"), markdown(findings, &picture))?;
    let junit =
        junit::junit_of(findings.project.name, &findings.source, &judged(findings)).map_err(io::Error::other)?;
    atomic::write(&folder.join("junit.xml"), junit)?;
    // A picture would have to be somewhere on the web.
    github::summarise(&markdown(findings, ""));
    Ok(())
}

/// The columns that are drawn: those with a claim first.
fn drawn(findings: &Findings<'_>) -> Vec<usize> {
    let mut columns: Vec<usize> = (0..findings.columns.len()).collect();
    columns.sort_by_key(|k| !findings.columns[*k].decides);
    columns.truncate(DRAWN);
    columns
}

fn figure(findings: &Findings<'_>) -> String {
    let series = |k: usize| {
        let (judged, (_, levels)) = (&findings.columns[k], &findings.table.columns[k]);
        ErrorSeries {
            label: judged.name.to_owned(),
            points: levels.iter().map(|level| (level.step, level.error)).collect(),
            order: Some(judged.rate.order).filter(|order| !order.is_nan()),
            fit: judged.rate.power_law(),
            interval: judged.rate.interval,
            used: Some(judged.rate.used.clone()),
            ..ErrorSeries::default()
        }
    };
    let series: Vec<ErrorSeries> = drawn(findings).into_iter().map(series).collect();
    let mut slopes: Vec<f64> = series.iter().filter_map(|series| series.order).collect();
    slopes.sort_by(f64::total_cmp);
    slopes.dedup();
    let at_floor = |judged: &Judged<'_>| judged.rate.set_aside.iter().any(|aside| aside.because == Aside::AtFloor);
    let floor = findings.columns.iter().any(at_floor);
    convergence(&Convergence {
        title: None,
        x_label: findings.table.step.clone(),
        y_label: "error".to_owned(),
        series,
        slopes,
        floor: floor.then(|| Guide { label: "floor".to_owned(), value: findings.floor }),
        ..Convergence::default()
    })
}

/// * `picture`: where the figure goes, with the empty line below it.
fn markdown(findings: &Findings<'_>, picture: &str) -> String {
    let mut page = format!("# Rates of {}\n\n", cell(&findings.source));
    page += &format!("**{}**: {}\n\n", findings.verdict, sentence(findings));
    findings.table.notes.iter().for_each(|note| page += &format!("{}\n\n", cell(note)));
    page += picture;
    if !picture.is_empty() && findings.columns.len() > DRAWN {
        page +=
            &format!("The figure shows {DRAWN} of {} columns, those with a claim first.\n\n", findings.columns.len());
    }
    page += &row(["column", "order claimed", "rate", "verdict", "reason"].map(str::to_owned));
    page += "| --- | --- | --- | --- | --- |\n";
    for judged in &findings.columns {
        let claim = if judged.is_claimed() { judged.rate.claim() } else { "-".to_owned() };
        let verdict = judged.rate.verdict.to_string();
        page += &row([cell(judged.name), claim, rate(judged), verdict, judged.reason().to_owned()]);
    }
    page += "\n";
    page += &errors(findings);
    let legend = legend(findings);
    page + if legend.is_empty() { "" } else { "\n" }
        + &legend.replace("~ ", "`~` ").replace("_ ", "`_` ").replace('\n', "  \n")
}

/// The errors, each with the rate from the level before.
fn errors(findings: &Findings<'_>) -> String {
    let table = findings.table;
    let heads = table.columns.iter().flat_map(|(name, _)| [cell(name), "rate".to_owned()]);
    let mut text = row(std::iter::once(cell(&table.step)).chain(heads));
    text += &row((0..=2 * table.columns.len()).map(|_| "---:".to_owned()));
    for level in 0..table.columns.first().map_or(0, |(_, levels)| levels.len()) {
        let cells = table.columns.iter().zip(&findings.columns).flat_map(|((_, levels), judged)| {
            let mark = Some(mark(judged, level))
                .filter(|mark| !mark.is_empty())
                .map_or(String::new(), |mark| format!(" `{mark}`"));
            [error_text(levels[level].error) + &mark, pairwise(judged, level)]
        });
        text += &row(std::iter::once(plain_text(table.columns[0].1[level].step)).chain(cells));
    }
    text
}

fn row(cells: impl IntoIterator<Item = String>) -> String {
    cells.into_iter().fold(String::from("|"), |row, cell| row + " " + &cell + " |") + "\n"
}

/// Text for a cell, of which no character is markup.
fn cell(raw: &str) -> String {
    let mut text = String::new();
    for c in visible(raw).chars() {
        if matches!(c, '\\' | '|' | '*' | '_' | '`' | '<' | '[' | ']') {
            text.push('\\');
        }
        text.push(c);
    }
    text
}

/// A test case for each column that decides.
fn judged(findings: &Findings<'_>) -> Vec<junit::Judged> {
    let case = |judged: &Judged<'_>| {
        let claim = if judged.is_claimed() { format!(": order {}", judged.rate.order) } else { String::new() };
        (judged.name.to_owned() + &claim, judged.rate.verdict, found(judged))
    };
    let cases: Vec<_> = findings.columns.iter().filter(|column| column.decides).map(case).collect();
    if cases.is_empty() { vec![("a claim".to_owned(), findings.verdict, sentence(findings))] } else { cases }
}
