//! The findings of a study: studies of every kind reach record, baseline and report in this form.
//!
//! Requirements on every outcome, whatever the kind of study: its verdict is not better than those
//! of its rates and checks, nothing passes on numbers that are not finite, and names used as keys
//! by record, baseline and report are unique.

use std::collections::HashSet;

use super::coverage::{self, Coverage};
use super::subject::{Sort, Subject};
use crate::judge::fit::Level;
use crate::judge::verdict::{RateVerdict, Verdict};
use crate::text::json;

/// The result of a study, which is also its record.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Outcome {
    /// The worst verdict of checks and rates; inconclusive if nothing was judged.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub summary: String,
    /// What the summary says after the rates, if these sum up the study; `None` if it is in the
    /// study's own words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after_rates: Option<String>,
    /// The numbers to read first, in a few words; empty if the rates are the claim.
    #[serde(default)]
    pub headline: String,
    /// Errors of each level of a convergence study.
    pub levels: Vec<LevelErrors>,
    /// Judged rates, each with its norm.
    #[serde(with = "rates")]
    pub rates: Vec<(String, RateVerdict)>,
    /// What rates are about, by their names, where that is more than the name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rate_subjects: Vec<(String, Subject)>,
    /// Everything judged that is not a rate.
    pub checks: Vec<Check>,
    /// How many items of each sort were judged, and why not the others; empty in older records.
    #[serde(default)]
    pub coverage: Vec<Coverage>,
    /// Tables of the report.
    #[serde(default)]
    pub tables: Vec<Table>,
    /// Figures of the report.
    #[serde(default)]
    pub figures: Vec<Figure>,
    /// Numbers that the baseline guards.
    pub quantities: Vec<Quantity>,
}

/// The errors at one level of refinement, one for each norm.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LevelErrors {
    /// Its parameters by name, such as elements and steps: separate keys in JSON.
    #[serde(flatten, with = "json::counted")]
    pub parameters: Vec<(String, f64)>,
    /// The step over which the errors are judged; `None` if they are not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// The cost of the level, in a unit of the study's choice, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work: Option<f64>,
    /// Errors by name; NaN without a result.
    #[serde(with = "json::named")]
    pub errors: Vec<(String, f64)>,
    /// The names of the errors for which the level has no result.
    #[serde(
        rename = "without_result",
        default,
        skip_serializing_if = "Vec::is_empty"
    )]
    pub without: Vec<String>,
}

impl LevelErrors {
    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<f64> {
        self.parameters
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, value)| *value)
    }

    /// The error of that name; NaN if there is none.
    pub fn error(&self, name: &str) -> f64 {
        self.errors
            .iter()
            .find(|(known, _)| known == name)
            .map_or(f64::NAN, |(_, error)| *error)
    }
}

/// Whose statement a check is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// That every case has run: no statement.
    Completion,
    /// A statement of the source, as printed there.
    Source,
    /// What holds in place of a statement of the source that does not.
    Correction,
    /// The study's own.
    #[default]
    Own,
}

/// Something judged.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Check {
    /// The claim, without its case.
    pub claim: String,
    /// What it is about; unknown in older records, whose claims begin with the case.
    #[serde(default, skip_serializing_if = "Subject::is_unknown")]
    pub subject: Subject,
    /// The outcome.
    pub verdict: Verdict,
    /// The evidence, with numbers.
    pub evidence: String,
    /// Whose statement it is; [`Origin::Own`] in records that do not say.
    #[serde(default)]
    pub origin: Origin,
    /// Ids of the other studies that do not pass, where it judges those.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub other_studies: Vec<String>,
}

impl Check {
    /// Passes or fails on a condition; `holds` must be false for NaN.
    pub fn that(holds: bool, claim: impl Into<String>, evidence: impl Into<String>) -> Self {
        let verdict = if holds { Verdict::Pass } else { Verdict::Fail };
        Self {
            claim: claim.into(),
            verdict,
            subject: Subject::default(),
            evidence: evidence.into(),
            origin: Origin::Own,
            other_studies: vec![],
        }
    }

    /// The same about a subject.
    #[must_use]
    pub fn about(self, subject: Subject) -> Self {
        Self { subject, ..self }
    }

    /// The claim as it is printed: after its case, if it has one.
    pub fn statement(&self) -> String {
        match &self.subject.case {
            Some(case) => format!("{case}: {}", self.claim),
            None => self.claim.clone(),
        }
    }

    /// What it is about; the claim stands in for a quantity that is not known.
    pub fn quantity(&self) -> &str {
        self.subject.quantity_or(&self.claim)
    }

    /// The same as somebody's statement.
    #[must_use]
    pub fn stated_by(self, origin: Origin) -> Self {
        Self { origin, ..self }
    }
}

/// A table, printed with aligned columns.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// Column heads.
    pub head: Vec<String>,
    /// Rows of cells, one for each head.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// * `head`: a word for each cell of a row.
    pub fn new<H: Into<String>>(
        title: impl Into<String>,
        head: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        let head = head.into_iter().map(Into::into).collect();
        Self {
            title: title.into(),
            head,
            rows: rows.into_iter().collect(),
        }
    }
}

/// A picture.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Figure {
    /// File name without folder: `<what>.svg`, and `<id>-<what>.svg` once the study's outcome is
    /// settled.
    pub file: String,
    /// What the figure shows, in a sentence: caption and alternative text.
    pub caption: String,
    /// The picture; in a record it is a separate file.
    #[serde(skip)]
    pub svg: String,
}

impl Figure {
    /// A picture of a study, in the file `<what>.svg`.
    pub fn new(what: &str, caption: impl Into<String>, svg: String) -> Self {
        Self {
            file: format!("{what}.svg"),
            caption: caption.into(),
            svg,
        }
    }
}

/// A number that must not move unnoticed.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Quantity {
    /// Name, unique within the study.
    pub name: String,
    /// What it is about; unknown in older records.
    #[serde(default, skip_serializing_if = "Subject::is_unknown")]
    pub subject: Subject,
    /// Whether it is an error, a rate or another number.
    #[serde(default)]
    pub sort: Sort,
    /// Value.
    #[serde(deserialize_with = "json::nan")]
    pub value: f64,
    /// Relative change tolerated.
    #[serde(deserialize_with = "json::nan")]
    pub tolerance: f64,
}

impl Quantity {
    /// A number about the quantity of its name.
    ///
    /// * `tolerance`: relative change tolerated.
    pub fn new(name: impl Into<String>, value: f64, tolerance: f64) -> Self {
        let name = name.into();
        Self {
            subject: Subject::of(&name),
            name,
            sort: Sort::Value,
            value,
            tolerance,
        }
    }

    /// The same about a subject.
    #[must_use]
    pub fn about(self, subject: Subject) -> Self {
        Self { subject, ..self }
    }

    /// The same as an error or a rate.
    #[must_use]
    pub fn of_sort(self, sort: Sort) -> Self {
        Self { sort, ..self }
    }
}

/// A number that JSON cannot hold.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct NotFinite {
    /// Where in the study, such as `levels[2].errors.velocity`.
    pub at: String,
    /// `NaN`, `inf` or `-inf`.
    pub value: String,
}

/// Rates as objects: the norm, the judgement, and advice unless it is a pass.
mod rates {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::judge::verdict::RateVerdict;

    #[derive(Serialize)]
    struct Written<'r> {
        norm: &'r str,
        #[serde(flatten)]
        rate: &'r RateVerdict,
        /// What the reason means, and what to do; absent for a pass.
        #[serde(skip_serializing_if = "Option::is_none")]
        advice: Option<String>,
    }

    #[derive(Deserialize)]
    struct Read {
        norm: String,
        #[serde(flatten)]
        rate: RateVerdict,
    }

    pub(super) fn serialize<S: Serializer>(
        rates: &[(String, RateVerdict)],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(rates.iter().map(|(norm, rate)| Written {
            norm,
            rate,
            advice: rate.advice(),
        }))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<(String, RateVerdict)>, D::Error> {
        let rates: Vec<Read> = Vec::deserialize(deserializer)?;
        Ok(rates
            .into_iter()
            .map(|Read { norm, rate }| (norm, rate))
            .collect())
    }
}

impl Outcome {
    /// What a rate is about: by default the error of its name.
    pub fn subject_of_rate(&self, name: &str) -> Subject {
        let known = self.rate_subjects.iter().find(|(of, _)| of == name);
        known.map_or_else(|| Subject::of(name), |(_, subject)| subject.clone())
    }

    /// The errors of that name over their steps; NaN on a level without one.
    pub fn levels_of(&self, name: &str) -> Vec<Level> {
        let level = |level: &LevelErrors| Level {
            step: level.step.unwrap_or(f64::NAN),
            error: level.error(name),
        };
        self.levels.iter().map(level).collect()
    }

    /// Builds an outcome; the verdict is the worst of all rates and checks.
    pub fn new(
        summary: impl Into<String>,
        rates: Vec<(String, RateVerdict)>,
        checks: Vec<Check>,
    ) -> Self {
        let verdicts = rates
            .iter()
            .map(|(_, rate)| rate.verdict)
            .chain(checks.iter().map(|check| check.verdict));
        Self {
            verdict: Verdict::worst(verdicts),
            summary: summary.into(),
            after_rates: None,
            headline: String::new(),
            levels: vec![],
            rates,
            rate_subjects: vec![],
            checks,
            coverage: vec![],
            tables: vec![],
            figures: vec![],
            quantities: vec![],
        }
    }

    /// The same, whose summary is that of its rates and these words.
    #[must_use]
    pub fn summed_up_by_rates(self, more: impl Into<String>) -> Self {
        Self {
            after_rates: Some(more.into()),
            ..self
        }
    }

    /// Says more in the summary.
    pub(super) fn add_to_summary(&mut self, words: &str) {
        self.summary = joined(&self.summary, words);
        if let Some(more) = &mut self.after_rates {
            *more = joined(more, words);
        }
    }

    /// The outcome of a study of several parts: their summaries and headlines one after the other.
    ///
    /// * `completion`: the check that all cases of all parts have completed.
    pub fn of_parts(completion: Check, parts: impl IntoIterator<Item = Self>) -> Self {
        let mut all = Self::new("", vec![], vec![completion]);
        for part in parts {
            all.summary = joined(&all.summary, &part.summary);
            all.headline = joined(&all.headline, &part.headline);
            all.extend(part);
        }
        all
    }

    /// Adds the findings of another part of the study, except for summary and headline.
    pub fn extend(&mut self, part: Self) {
        self.verdict = Verdict::worst([self.verdict, part.verdict]);
        self.levels.extend(part.levels);
        self.rates.extend(part.rates);
        self.rate_subjects.extend(part.rate_subjects);
        self.checks.extend(part.checks);
        coverage::merge(&mut self.coverage, part.coverage);
        self.tables.extend(part.tables);
        self.figures.extend(part.figures);
        self.quantities.extend(part.quantities);
    }

    /// Every number that JSON cannot hold.
    pub fn not_finite(&self) -> Vec<NotFinite> {
        let mut found = Vec::new();
        let mut look = |at: String, value: f64| {
            if !value.is_finite() {
                found.push(NotFinite {
                    at,
                    value: value.to_string(),
                });
            }
        };
        for (i, level) in self.levels.iter().enumerate() {
            level
                .errors
                .iter()
                .for_each(|(norm, error)| look(format!("levels[{i}].errors.{norm}"), *error));
        }
        for (i, (_, rate)) in self.rates.iter().enumerate() {
            rate.pairwise
                .iter()
                .enumerate()
                .for_each(|(j, rate)| look(format!("rates[{i}].pairwise[{j}]"), *rate));
            let interval = rate.interval.into_iter().flatten();
            interval
                .enumerate()
                .for_each(|(j, end)| look(format!("rates[{i}].interval[{j}]"), end));
            rate.fitted
                .into_iter()
                .for_each(|fitted| look(format!("rates[{i}].fitted"), fitted));
            rate.extrapolated
                .into_iter()
                .for_each(|rate| look(format!("rates[{i}].extrapolated"), rate));
        }
        for (i, quantity) in self.quantities.iter().enumerate() {
            look(format!("quantities[{i}].value"), quantity.value);
        }
        found
    }
}

/// The outcome of the study `id` with its verdict recomputed, its figures named after it, and a
/// failing check if it does not meet the requirements. Its summary says how many items were not
/// judged, if any.
pub fn settle(id: &str, mut outcome: Outcome) -> Outcome {
    outcome
        .figures
        .iter_mut()
        .for_each(|figure| figure.file = format!("{id}-{}", figure.file));
    let defects = defects(id, &outcome);
    if !defects.is_empty() {
        outcome.checks.push(
            Check::that(
                false,
                "the outcome of the study is sound",
                defects.join("; "),
            )
            .about(Subject::of("outcome")),
        );
    }
    let claimed = outcome.verdict;
    let rates = outcome.rates.iter().map(|(_, rate)| rate.verdict);
    let parts = Verdict::worst(rates.chain(outcome.checks.iter().map(|check| check.verdict)));
    outcome.verdict = parts.max(claimed);
    if outcome.rates.is_empty() && outcome.checks.is_empty() {
        outcome.add_to_summary("nothing was judged");
    } else if outcome.verdict != claimed {
        outcome.add_to_summary("but a rate or a check does not pass");
    }
    for left_out in coverage::incomplete(&outcome.coverage) {
        outcome.add_to_summary(&left_out);
    }
    outcome
}

/// Two parts of a summary; either may be empty.
pub(crate) fn joined(summary: &str, more: &str) -> String {
    match (summary, more) {
        ("", more) => more.to_owned(),
        (summary, "") => summary.to_owned(),
        (summary, more) => format!("{summary}; {more}"),
    }
}

fn defects(id: &str, outcome: &Outcome) -> Vec<String> {
    let mut defects = Vec::new();
    defects.extend(twice(
        "the rate",
        outcome.rates.iter().map(|(norm, _)| norm),
    ));
    defects.extend(twice(
        "the quantity",
        outcome.quantities.iter().map(|quantity| &quantity.name),
    ));
    defects.extend(twice(
        "the figure",
        outcome.figures.iter().map(|figure| &figure.file),
    ));
    for level in &outcome.levels {
        defects.extend(twice(
            "at one level the norm",
            level.errors.iter().map(|(norm, _)| norm),
        ));
    }
    for (norm, rate) in &outcome.rates {
        if rate.verdict == Verdict::Pass && !rests_on_numbers(rate) {
            defects.push(format!(
                "`{norm}` passes without a finite rate in a finite interval"
            ));
        }
    }
    for figure in outcome
        .figures
        .iter()
        .filter(|figure| !well_named(id, figure))
    {
        defects.push(format!(
            "the figure `{}` is not called {id}-<what>.svg",
            figure.file
        ));
    }
    defects.extend(twice(
        "the count of",
        outcome.coverage.iter().map(|coverage| &coverage.items),
    ));
    for coverage in &outcome.coverage {
        if !coverage.adds_up() {
            defects.push(format!("the counts of `{}` do not add up", coverage.items));
        }
    }
    for table in &outcome.tables {
        if table.rows.iter().any(|row| row.len() != table.head.len()) {
            defects.push(format!(
                "the table `{}` has rows that do not match its head",
                table.title
            ));
        }
    }
    defects
}

/// Whether a passing rate has the numbers to justify it.
fn rests_on_numbers(rate: &RateVerdict) -> bool {
    let interval = rate
        .interval
        .is_some_and(|[low, high]| low.is_finite() && high.is_finite());
    interval && rate.fitted.is_some_and(f64::is_finite)
}

/// A plain file name that begins with the study's id: figures of all studies share one folder.
fn well_named(id: &str, figure: &Figure) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '.' | '_');
    let what = figure
        .file
        .strip_prefix(id)
        .and_then(|rest| rest.strip_prefix('-'));
    what.and_then(|what| what.strip_suffix(".svg"))
        .is_some_and(|what| !what.is_empty() && what.chars().all(plain))
}

fn twice<'n>(what: &str, names: impl Iterator<Item = &'n String>) -> Vec<String> {
    let mut seen = HashSet::new();
    names
        .filter(|name| !seen.insert(*name))
        .map(|name| format!("{what} `{name}` occurs twice"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::verdict;

    fn passing() -> Outcome {
        let levels = [(0.5, 0.5), (0.25, 0.25), (0.125, 0.125), (0.0625, 0.0625)];
        let rates = vec![(
            "velocity".to_owned(),
            verdict::judge_pairs(levels, 1.0, 0.1),
        )];
        Outcome::new("fine", rates, vec![Check::that(true, "c", "e")])
    }

    #[track_caller]
    fn refused(outcome: Outcome, evidence: &str) {
        let settled = settle("id", outcome);
        assert_eq!(settled.verdict, Verdict::Fail, "{settled:?}");
        let last = &settled.checks.last().unwrap().evidence;
        assert!(last.contains(evidence), "{last}");
    }

    #[test]
    fn a_sound_outcome_is_left_alone() {
        assert_eq!(passing().verdict, Verdict::Pass);
        assert_eq!(settle("id", passing()), passing());
    }

    #[test]
    fn figures_are_named_after_the_study() {
        let drawn = Outcome {
            figures: vec![Figure::new("errors", "", String::new())],
            ..passing()
        };
        let settled = settle("id", drawn);
        assert_eq!(
            (settled.verdict, settled.figures[0].file.as_str()),
            (Verdict::Pass, "id-errors.svg")
        );
    }

    #[test]
    fn nothing_judged_is_inconclusive_even_where_a_pass_is_claimed() {
        let empty = Outcome {
            verdict: Verdict::Pass,
            ..Outcome::new("all well", vec![], vec![])
        };
        let settled = settle("id", empty);
        assert_eq!(settled.verdict, Verdict::Inconclusive);
        assert_eq!(settled.summary, "all well; nothing was judged");
    }

    #[test]
    fn a_verdict_is_no_better_than_its_parts_and_no_better_than_claimed() {
        let mut hidden = passing();
        hidden.checks.push(Check::that(false, "c", "e"));
        assert_eq!(settle("id", hidden).verdict, Verdict::Fail);
        let strict = Outcome {
            verdict: Verdict::Fail,
            ..passing()
        };
        assert_eq!(settle("id", strict).verdict, Verdict::Fail);
    }

    #[test]
    fn a_summary_says_how_many_items_were_not_judged() {
        let summary = |reasons: &[Option<&str>]| {
            let coverage = vec![Coverage::of("points", reasons.iter().copied())];
            let outcome = Outcome {
                coverage,
                ..passing()
            };
            settle("id", outcome).summary
        };
        assert_eq!(
            summary(&[None, Some("short")]),
            "fine; 1 of 2 points judged; 1 not: short"
        );
        assert_eq!(summary(&[None, None]), "fine");
    }

    #[test]
    fn every_defect_of_an_outcome_fails_and_is_named() {
        let quantity = |value| Quantity::new("q", value, 0.1);
        refused(
            Outcome {
                quantities: vec![quantity(1.0), quantity(2.0)],
                ..passing()
            },
            "the quantity `q` occurs twice",
        );
        for file in ["../x.svg", ".svg", "a/b.svg", "x.png"] {
            let figure = Figure {
                file: file.into(),
                caption: String::new(),
                svg: String::new(),
            };
            refused(
                Outcome {
                    figures: vec![figure],
                    ..passing()
                },
                file,
            );
        }
        let table = Table {
            title: "ragged".into(),
            head: vec!["a".into()],
            rows: vec![vec![]],
        };
        refused(
            Outcome {
                tables: vec![table],
                ..passing()
            },
            "ragged",
        );
        let mut twice_judged = Coverage::of("points", [None, Some("short")]);
        twice_judged.judged = 2;
        refused(
            Outcome {
                coverage: vec![twice_judged],
                ..passing()
            },
            "the counts of `points` do not add up",
        );
        let mut nan = passing();
        nan.rates[0].1.fitted = Some(f64::NAN);
        refused(nan, "`velocity` passes without");
    }
}
