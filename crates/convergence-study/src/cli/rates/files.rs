//! What `rates --out DIR` writes: a figure, Markdown and JUnit XML.

use std::io;
use std::path::Path;

use super::text::{legend, mark, pairwise, rate, sentence};
use super::{Findings, Judged};
use crate::judge::verdict::{Aside, Verdict};
use crate::plots::{Convergence, ErrorSeries, Guide, convergence};
use crate::store::atomic;
use crate::study::levels::power_law;
use crate::text::number::{error_text, plain_text};
use crate::text::visible::visible;

/// Most columns in the figure: more would have the colours of the first.
const DRAWN: usize = 8;

/// Writes the files, each as a whole.
///
/// # Errors
/// That of the operating system, with the name of the file.
pub(super) fn write(findings: &Findings<'_>, folder: &Path) -> io::Result<()> {
    atomic::prepare_folder(folder)?;
    atomic::write(&folder.join("rates.svg"), figure(findings))?;
    atomic::write(&folder.join("rates.md"), markdown(findings))?;
    atomic::write(&folder.join("junit.xml"), junit(findings))
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
            fit: power_law(levels, judged.rate),
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

fn markdown(findings: &Findings<'_>) -> String {
    let mut page = format!("# Rates of {}\n\n", cell(&findings.source));
    page += &format!(
        "**{}**: {}\n\n![Errors over {}](rates.svg)\n\n",
        findings.verdict,
        sentence(findings),
        cell(&findings.table.step)
    );
    if findings.columns.len() > DRAWN {
        page +=
            &format!("The figure shows {DRAWN} of {} columns, those with a claim first.\n\n", findings.columns.len());
    }
    page += &row(["column", "order claimed", "rate", "verdict", "reason"].map(str::to_owned));
    page += "| --- | --- | --- | --- | --- |\n";
    for judged in &findings.columns {
        let claim = if judged.is_claimed() {
            format!("{} ± {}", judged.rate.order, judged.rate.tolerance)
        } else {
            "-".to_owned()
        };
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

/// One suite with a test case for each column that decides; inconclusive is a failure of its own type.
fn junit(findings: &Findings<'_>) -> String {
    let deciding: Vec<&Judged<'_>> = findings.columns.iter().filter(|column| column.decides).collect();
    let source = attribute(&findings.source);
    let mut cases = String::new();
    for judged in &deciding {
        let claim = if judged.is_claimed() { format!(": order {}", judged.rate.order) } else { String::new() };
        let name = attribute(&format!("{}{claim}", judged.name));
        cases += &case(&source, &name, judged.rate.verdict, &format!("{}; {}", judged.reason(), rate(judged)));
    }
    if deciding.is_empty() {
        cases += &case(&source, "a claim", findings.verdict, &sentence(findings));
    }
    let (tests, failures) = (deciding.len().max(1), cases.matches("<failure ").count());
    let counts = format!("tests=\"{tests}\" failures=\"{failures}\" errors=\"0\"");
    let name = attribute(findings.project.name);
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{name}\" {counts}>\n    \
         <testsuite name=\"{source}\" {counts}>\n{cases}    </testsuite>\n</testsuites>\n"
    )
}

fn case(class: &str, name: &str, verdict: Verdict, reason: &str) -> String {
    let head = format!("        <testcase name=\"{name}\" classname=\"{class}\"");
    if verdict == Verdict::Pass {
        return head + "/>\n";
    }
    let failure = format!("<failure type=\"{verdict}\" message=\"{}\"/>", attribute(reason));
    format!("{head}>\n            {failure}\n        </testcase>\n")
}

/// Text as the value of an attribute of XML.
fn attribute(text: &str) -> String {
    let text = visible(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;");
    text.chars().map(|c| if matches!(c, '\u{fffe}' | '\u{ffff}') { char::REPLACEMENT_CHARACTER } else { c }).collect()
}
