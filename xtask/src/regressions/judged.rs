//! Whether the diagnosis of each mistake names method, term or field, and module: the table of
//! `reports/regressions.md`.

use std::collections::BTreeMap;
use std::path::Path;

use convergence_study::Study;
use convergence_study::internal::{
    cli::{exit::Unusable, workspace},
    store::diagnosis::{Diagnosis, diagnose},
};

use super::list::Regression;
use super::planted::PlantedRun;

/// The lines of a diagnosis that are shown: what fails, and what moved first.
const SHOWN: [&str; 2] = ["fails", "first"];

/// Methods that are both wrong if neither must be named.
const METHODS: [&str; 2] = ["one-step schemes", "any order"];

/// A mistake, the results with it, and their diagnosis.
pub(super) struct JudgedRegression<'r> {
    pub(super) regression: &'r Regression,
    pub(super) found: PlantedRun,
    diagnosis: Diagnosis,
    /// Whether method, term or field, and module are right; `None` if none was declared.
    right: [Option<bool>; 3],
}

/// Diagnoses every mistake.
///
/// # Errors
/// Study files that cannot be read.
pub(super) fn judged<'r>(
    root: &Path,
    found: Vec<(&'r Regression, PlantedRun)>,
) -> Result<Vec<JudgedRegression<'r>>, Unusable> {
    let files = workspace::studies(&crate::PROJECT, root)?;
    let studies: Vec<Box<dyn Study>> = files.into_iter().map(|file| file.study).collect();
    let mut all: Vec<JudgedRegression<'r>> = vec![];
    for (regression, found) in found {
        let record = &found.record;
        let diagnosis = diagnose(&crate::PROJECT, &studies, &record.studies, record.moves());
        let diagnosis = diagnosis.unwrap_or_default();
        all.push(JudgedRegression {
            regression,
            right: right(regression, &diagnosis),
            found,
            diagnosis,
        });
    }
    Ok(all)
}

fn right(regression: &Regression, diagnosis: &Diagnosis) -> [Option<bool>; 3] {
    let shared = diagnosis.contrast.shared.iter();
    let shared = shared.map(|(_, value)| value.as_str());
    let values: Vec<&str> = diagnosis.contrast.values().chain(shared).collect();
    let field = diagnosis.first.first().map(|field| field.name.as_str());
    let mut methods = regression.method.iter();
    let mut topics = regression.about.iter();
    let names_method = methods.any(|word| names(&values, word));
    let names_topic = topics.any(|word| names(&values, word) || field == Some(word.as_str()));
    let module = regression.module();
    let place = diagnosis.look_at.iter().any(|place| place.contains(module));
    [
        (!regression.method.is_empty()).then_some(names_method),
        (!regression.about.is_empty()).then_some(names_topic),
        Some(place),
    ]
}

/// Whether a diagnosis names the word with one of its values; no method stands for both.
fn names(values: &[&str], word: &str) -> bool {
    if word == "both" {
        !values.iter().any(|value| METHODS.contains(value))
    } else {
        values.contains(&word)
    }
}

/// The scores for written mistakes and for randomly drawn ones.
///
/// * `passing`: seconds of a run without a mistake.
pub(super) fn page(all: &[JudgedRegression<'_>], passing: f64) -> String {
    let [written, drawn] = [false, true].map(|mutant| -> Vec<_> {
        all.iter()
            .filter(|one| one.regression.mutant == mutant)
            .collect()
    });
    let mut page = "## How well causes are named\n\n| mistakes | noticed | method | term or field | module | commonest answers | lines, at most | times a passing run, median | worst |\n| --- | --: | --: | --: | --: | --- | --: | --: | --: |\n".to_owned();
    page += &(scores("written", &written, passing) + &scores("drawn at random", &drawn, passing));
    page += "\nRight are those of which the diagnosis names what was declared beside the mistake. \"Commonest answers\" is the score of always giving the commonest one.\n";
    page
}

/// The diagnosis of each, for the terminal.
pub(super) fn diagnoses(all: &[JudgedRegression<'_>]) -> String {
    let each: String = all.iter().map(said).collect();
    format!("\n## What is said of each\n\n{each}")
}

fn scores(name: &str, all: &[&JudgedRegression<'_>], passing: f64) -> String {
    // The diagnosis is that of `verify`; it says nothing of what only a test notices.
    let noticed: Vec<&&JudgedRegression<'_>> = all
        .iter()
        .filter(|one| !one.found.record.verdict.is_pass())
        .collect();
    let commonest = [
        share_of_commonest(&noticed, |regression| regression.method.clone()),
        share_of_commonest(&noticed, |regression| regression.about.clone()),
        share_of_commonest(&noticed, |regression| vec![regression.module().to_owned()]),
    ];
    let mut times: Vec<f64> = noticed
        .iter()
        .map(|one| one.found.seconds / passing)
        .collect();
    times.sort_by(f64::total_cmp);
    let lines = noticed.iter().map(|one| one.found.lines).max().unwrap_or(0);
    let [median, worst] =
        [times.get(times.len() / 2), times.last()].map(|time| time.copied().unwrap_or(f64::NAN));
    format!(
        "| {name} | {} of {} | {} | {} | {} | {} | {lines} | {median:.1} | {worst:.1} |\n",
        noticed.len(),
        all.len(),
        score(&noticed, 0),
        score(&noticed, 1),
        score(&noticed, 2),
        commonest.join(", ")
    )
}

/// How often one of the three answers is right.
fn score(noticed: &[&&JudgedRegression<'_>], which: usize) -> String {
    let answers: Vec<bool> = noticed.iter().filter_map(|one| one.right[which]).collect();
    let right = answers.iter().filter(|right| **right).count();
    percent(right, answers.len())
}

/// How often the commonest word would be right.
fn share_of_commonest(
    noticed: &[&&JudgedRegression<'_>],
    words: impl Fn(&Regression) -> Vec<String>,
) -> String {
    let mut declared = 0;
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for judged in noticed {
        let words = words(judged.regression);
        declared += usize::from(!words.is_empty());
        for word in words {
            *counts.entry(word).or_default() += 1;
        }
    }
    percent(counts.values().max().copied().unwrap_or(0), declared)
}

fn percent(part: usize, whole: usize) -> String {
    format!(
        "{part}/{whole} ({:.0} %)",
        100.0 * part as f64 / whole.max(1) as f64
    )
}

fn said(one: &JudgedRegression<'_>) -> String {
    let JudgedRegression {
        regression,
        found,
        diagnosis,
        right,
        ..
    } = one;
    let is_right =
        right.map(|right| right.map_or("-", |right| if right { "right" } else { "wrong" }));
    let head = format!("- **{}**, `{}`: ", regression.name, regression.file);
    if found.is_unnoticed() {
        return head + "not noticed\n";
    } else if found.record.verdict.is_pass() {
        return format!("{head}by a test, `cargo test {}`\n", regression.test);
    }
    let head = format!(
        "{head}method {}, term or field {}, module {}\n",
        is_right[0], is_right[1], is_right[2]
    );
    let lines = diagnosis
        .lines()
        .into_iter()
        .filter(|(word, _)| SHOWN.contains(word));
    lines.fold(head, |text, (word, words)| {
        format!("{text}  - {word}: {words}\n")
    })
}
