//! The result for programs, in tables of other formats, as a figure and as a page.

use serde_json::{Value, json};

use super::shown::{agreement, sentence, sentence_of_all, text};
use super::{JudgedColumn, Judgement, verdict_of};
use crate::chart::{Axis, Chart, Columns, Guide, Series, titled_by_verdict};
#[cfg(feature = "command-line")]
use crate::exchange::csv_field;
use crate::input::table::RateTable;
use crate::text::visible::{self, visible};
use convergence_judge::claims::Bound;
use convergence_judge::verdict::{Aside, Verdict};

/// Most columns in the figure: more would repeat the colours.
const DRAWN: usize = 8;

/// The rows of each table, separated by commas, without marks; a line with its name before each of
/// several.
#[cfg(feature = "command-line")]
pub(crate) fn csv(findings: &[Judgement<'_>]) -> String {
    let tables = findings.iter().map(|judgement| {
        let name = visible(&judgement.source.name);
        let head = (findings.len() > 1).then(|| format!("# {name}\n"));
        let rows = judgement.rows();
        let lines: String = rows.iter().map(|row| csv_line(row)).collect();
        head.unwrap_or_default() + &lines
    });
    tables.collect::<Vec<_>>().join("\n")
}

#[cfg(feature = "command-line")]
fn csv_line(row: &[String]) -> String {
    let cells = row
        .iter()
        .map(|cell| csv_field(cell.trim_end_matches([' ', '_', '~', '\'']).trim()));
    cells.collect::<Vec<_>>().join(",") + "\n"
}

/// The rows of each table in Markdown, with the meaning of their marks; each of several under its
/// name.
#[cfg(feature = "command-line")]
pub(crate) fn rows_in_markdown(findings: &[Judgement<'_>]) -> String {
    let tables = findings.iter().map(|judgement| {
        let name = escaped(&judgement.source.name);
        let head = (findings.len() > 1).then(|| format!("## {name}\n\n"));
        let rows = judgement.rows();
        let mut lines: Vec<String> = rows.iter().map(|row| markdown_line(row)).collect();
        lines.insert(1, format!("|{}\n", " --: |".repeat(rows[0].len())));
        let legend = judgement.legend();
        lines.extend(legend.lines().map(|line| format!("\n{}\n", escaped(line))));
        head.unwrap_or_default() + &lines.concat()
    });
    tables.collect::<Vec<_>>().join("\n")
}

#[cfg(feature = "command-line")]
fn markdown_line(row: &[String]) -> String {
    let cells: Vec<String> = row.iter().map(|cell| escaped(cell.trim())).collect();
    format!("| {} |\n", cells.join(" | "))
}

/// A text in Markdown, without markup of its own.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in visible(text).chars() {
        if "\\|*_`<[]".contains(c) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

/// What `rates --format json` prints in addition to the verdict: the object of a table, or a list
/// of several, each with its name and verdict.
pub(crate) fn object_of_all(findings: &[Judgement<'_>]) -> Value {
    if let [alone] = findings {
        return object(alone);
    }
    let tables = findings.iter().map(|findings| {
        let mut object = object(findings);
        object["table"] = json!(findings.source.name);
        object["verdict"] = json!(findings.verdict().name());
        object
    });
    json!({"tables": tables.collect::<Vec<_>>()})
}

/// Rates as in `study --format json`, with the column's name as the norm's.
fn object(findings: &Judgement<'_>) -> Value {
    let table = &findings.source.table;
    let mut notes = vec![table.reading.clone()];
    notes.extend(table.doubts.iter().map(ToString::to_string));
    notes.extend(findings.equals.iter().map(ToString::to_string));
    notes.extend(findings.boundary.iter().map(|loss| loss.evidence.clone()));
    json!({
        "step": table.step, "floor": findings.floor.value(),
        "rates": findings.columns.iter().map(rate).collect::<Vec<_>>(),
        "left_out": table.left_out, "notes": notes,
        "doubts": doubts(table),
    })
}

/// The rate of a column as an object.
fn rate(judged: &JudgedColumn<'_>) -> Value {
    let mut object = json!(judged.rate);
    object["norm"] = json!(judged.column.name);
    object["decides"] = json!(judged.decides);
    object["order"] = json!(judged.claim.map(|claim| claim.order));
    let bound = judged.claim.map(|claim| claim.bound);
    object["at_least"] = json!(bound.is_some_and(Bound::is_least));
    object["any_above"] = json!(bound == Some(Bound::AnyAbove));
    if let Some(factors) = &judged.factors {
        object["factor"] = json!({"fitted": factors.fitted, "interval": factors.interval});
    }
    let levels = judged.column.levels.iter();
    object["levels"] = levels
        .map(|level| json!({"step": level.step, "error": level.error}))
        .collect();
    let aside = judged.rate.set_aside.iter();
    object["set_aside"] = aside
        .map(|aside| json!({"level": aside.level, "because": aside.because.text()}))
        .collect();
    if let Some(estimate) = &judged.estimate {
        if let Ok(bar) = &estimate.bar {
            object["limit"] = json!({"value": bar.extrapolated, "interval": bar.limit});
        }
        if let Ok(gci) = &estimate.gci {
            object["gci"] = json!(gci.half_width);
        }
    }
    object
}

/// The doubts about a table, each with the settings that remove it.
pub(super) fn doubts(table: &RateTable) -> Vec<Value> {
    let doubts = table.doubts.iter().map(|doubt| {
        let settings = doubt.offer.as_ref().map(super::refusal::settings);
        json!({"because": doubt.to_string(), "settings": settings})
    });
    doubts.collect()
}

/// The errors over the steps, columns with a claim first. The title begins with the verdict, unless
/// it is a pass.
pub(crate) fn figure(findings: &Judgement<'_>) -> String {
    let svg = figure_without_verdict(findings);
    match findings.verdict() {
        Verdict::Pass => svg,
        verdict => titled_by_verdict(&svg, verdict),
    }
}

/// The same, whose title says what was found alone: that of a study gets the verdict of the study.
pub(crate) fn figure_without_verdict(findings: &Judgement<'_>) -> String {
    let errors = findings.columns.iter();
    let mut drawn: Vec<_> = errors.filter(|judged| judged.estimate.is_none()).collect();
    drawn.sort_by_key(|judged| !judged.decides);
    drawn.truncate(DRAWN);
    let step = &findings.source.table.step;
    let mut table = Columns::default();
    let mut series = vec![];
    for judged in &drawn {
        let name = &judged.column.name;
        let [over, of] = [step, name].map(|column| format!("{column}, {name}"));
        let levels = judged.column.levels.iter();
        table.push(&over, levels.clone().map(|level| level.step));
        table.push(&of, levels.map(|level| level.error));
        let errors = Series::errors(name, over, of);
        let errors = match judged.rate.order() {
            Some(order) => errors.claiming(order),
            None => errors,
        };
        series.push(errors.judged(&judged.rate));
    }
    let mut set_aside = drawn.iter().flat_map(|judged| &judged.rate.set_aside);
    let at_floor = set_aside.any(|aside| aside.because == Aside::AtFloor);
    let floor = at_floor.then(|| Guide {
        label: "floor".to_owned(),
        value: findings.floor.value(),
    });
    let chart = Chart {
        series,
        guides: floor.into_iter().collect(),
        ..Chart::new(table, Axis::log(step), Axis::log("error"))
    };
    chart.titled(agreement(findings)).svg()
}

/// The verdict on several tables, below them; an only one has its own.
pub(crate) fn verdict_in_markdown(findings: &[Judgement<'_>]) -> Option<String> {
    (findings.len() > 1).then(|| {
        let sentence = sentence_of_all(findings);
        format!("**{}**: {sentence}\n", verdict_of(findings))
    })
}

/// The printed result, as a page.
///
/// * `picture`: the link to the figure, with the empty line below it.
pub(crate) fn markdown(findings: &Judgement<'_>, picture: &str) -> String {
    let source = escaped(&findings.source.name);
    let text = visible::lines(&text(findings, false, plain_verdict));
    let block: String = text.lines().map(|line| format!("    {line}\n")).collect();
    format!(
        "# Rates of {source}\n\n**{}**: {}\n\n{picture}{block}",
        findings.verdict(),
        sentence(findings)
    )
}

/// A verdict without a colour.
pub(super) fn plain_verdict(verdict: Verdict) -> String {
    verdict.to_string()
}
