//! Rates, errors and cost over the runs of a journal, as one page that needs nothing else.

use super::html::{escape, html};
use super::markdown::{cell, text};
use super::page::{PICTURES, badge, document};
use super::section;
use crate::plots::{self, Axis, Guide, History, Series};
use crate::store::journal::{Run, StudyRun};
use crate::store::provenance::date;
use crate::study::outcome::Figure;

/// The page: the runs, newest first, then three pictures of each study.
///
/// * `project`: its name.
/// * `runs`: oldest first, at least one. They are numbered from 1 in all pictures.
pub fn history(project: &str, runs: &[Run]) -> String {
    let Some(last) = runs.last() else { return String::new() };
    let ids = distinct(runs.iter().flat_map(|run| run.studies.iter().map(|study| study.id.as_str())));
    let studies: String = ids.iter().map(|id| study(id, runs)).collect();
    let head = format!(
        "<header>\n<h1>History of {}</h1>\n<p class=\"verdict\">{} the last of {} runs, {}</p>\n</header>\n",
        escape(project),
        badge(last.verdict),
        runs.len(),
        escape(&revision(last)),
    );
    let body = format!("{head}<main>\n{}{studies}</main>\n", html(&table(runs), &[]));
    document(&format!("{}: history of {}", last.verdict, escape(project)), &body, &[PICTURES])
}

fn table(runs: &[Run]) -> String {
    let row = |(index, run): (usize, &Run)| {
        let not_passing: Vec<&str> =
            run.studies.iter().filter(|study| !study.verdict.is_pass()).map(|study| study.id.as_str()).collect();
        let seconds: f64 = run.studies.iter().map(|study| study.busy_seconds).sum();
        vec![
            (index + 1).to_string(),
            run.finished_at.and_then(date).unwrap_or("-".to_owned()),
            cell(&revision(run)),
            section::marked(run.verdict),
            format!("{} of {}", run.studies.len() - not_passing.len(), run.studies.len()),
            format!("{seconds:.2}"),
            cell(&not_passing.join(", ")),
            cell(&run.command),
        ]
    };
    let head = ["run", "finished", "revision", "verdict", "studies that pass", "seconds", "not passing", "command"];
    "## Runs\n\n".to_owned() + &section::untitled(&head, runs.iter().enumerate().map(row).rev().collect(), "runs")
}

/// Rates with the orders claimed, finest errors and seconds, over the runs that have the study.
fn study(id: &str, runs: &[Run]) -> String {
    let numbered = (1..).map(f64::from).zip(runs);
    let having = numbered.filter_map(|(number, run)| Some((number, run.studies.iter().find(|study| study.id == id)?)));
    let having: Vec<(f64, &StudyRun)> = having.collect();
    let Some((_, last)) = having.last() else { return String::new() };
    let rate =
        |study: &StudyRun, name: &str| study.rates.iter().find(|rate| rate.norm == name).and_then(|rate| rate.fitted);
    let error =
        |study: &StudyRun, name: &str| study.errors.0.iter().find(|(norm, _)| norm == name).map(|(_, error)| *error);
    let rates = distinct(having.iter().flat_map(|(_, study)| study.rates.iter().map(|rate| rate.norm.as_str())));
    let errors = distinct(having.iter().flat_map(|(_, study)| study.errors.0.iter().map(|(norm, _)| norm.as_str())));
    let mut orders: Vec<f64> = last.rates.iter().map(|rate| rate.order).filter(|order| order.is_finite()).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    let guides = orders.iter().map(|&value| Guide { label: format!("order {value}"), value }).collect();
    let drawn = [
        (
            "rates",
            "Observed rates over the runs, with the orders claimed.",
            Axis::linear("observed rate"),
            series(&rates, &having, rate),
            guides,
        ),
        (
            "errors",
            "Errors on the finest level over the runs.",
            Axis::log("error on the finest level"),
            series(&errors, &having, error),
            vec![],
        ),
        (
            "cost",
            "Time over all threads.",
            Axis::linear("time (s)"),
            series(&["all cases"], &having, |study, _| Some(study.busy_seconds)),
            vec![],
        ),
    ];
    let pictures = drawn.into_iter().filter(|(_, _, _, series, _)| !series.is_empty());
    let figures: Vec<Figure> = pictures
        .map(|(what, caption, y, series, guides)| {
            let figure = History { x_label: "run".to_owned(), y, series, guides, ..History::default() };
            Figure { file: format!("{id}-{what}.svg"), caption: caption.to_owned(), svg: plots::history(&figure) }
        })
        .collect();
    let markdown: Vec<String> = figures.iter().map(section::figure).collect();
    let open = if last.verdict.is_pass() { "" } else { " open=\"\"" };
    format!(
        "<details class=\"study\" id=\"{id}\"{open}>\n<summary>{} <h2>{id}</h2> <span class=\"claim\">{}</span></summary>\n{}</details>\n",
        badge(last.verdict),
        escape(&text(&changed(&having))),
        html(&markdown.join("\n"), &figures),
        id = escape(id),
    )
}

/// Curves over the runs; one without any point is left out.
fn series(names: &[&str], having: &[(f64, &StudyRun)], value: impl Fn(&StudyRun, &str) -> Option<f64>) -> Vec<Series> {
    let one = |name: &&str| {
        let points: Vec<(f64, f64)> =
            having.iter().filter_map(|(number, study)| Some((*number, value(study, name)?))).collect();
        (!points.is_empty()).then(|| Series { label: (*name).to_owned(), points })
    };
    names.iter().filter_map(one).collect()
}

/// In which run the verdict of a study became what it is.
fn changed(having: &[(f64, &StudyRun)]) -> String {
    let Some((_, last)) = having.last() else { return String::new() };
    let since = having.iter().rev().take_while(|(_, study)| study.verdict == last.verdict).last();
    since.map_or(String::new(), |(number, _)| format!("{} since run {number}, in {} runs", last.verdict, having.len()))
}

/// The first digits of the revision, and a plus where the working tree differed.
fn revision(run: &Run) -> String {
    let Some(revision) = &run.git_revision else { return "no revision".to_owned() };
    let short: String = revision.chars().take(10).collect();
    if run.git_modified == Some(true) { short + "+" } else { short }
}

/// Each once, in the order in which they are first met.
fn distinct<'n>(names: impl Iterator<Item = &'n str>) -> Vec<&'n str> {
    let mut distinct: Vec<&str> = vec![];
    for name in names {
        if !distinct.contains(&name) {
            distinct.push(name);
        }
    }
    distinct
}
