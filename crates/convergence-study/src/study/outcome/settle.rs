//! What every outcome must meet, whatever the kind of study, and its verdict recomputed.

use std::collections::HashSet;

use super::{Check, Figure, NamedRate, Outcome};
use crate::interval::Interval;
use crate::study::subject::Subject;
use convergence_judge::verdict::{RateVerdict, Verdict};

/// The outcome of the study `id` with its verdict recomputed, its figures named after it, and a
/// failing check if it does not meet the requirements. Its summary says how many items were not
/// judged, if any; the titles of its figures say the verdict unless it is a pass.
pub(crate) fn settle(id: &str, mut outcome: Outcome) -> Outcome {
    for figure in &mut outcome.figures {
        figure.file = format!("{id}-{}", figure.file);
    }
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
    outcome.verdict = outcome.verdict_of_parts().max(claimed);
    if outcome.rates.is_empty() && outcome.checks.is_empty() {
        outcome.add_to_summary("nothing was judged");
    } else if outcome.verdict != claimed {
        outcome.add_to_summary("but a rate or a check does not pass");
    }
    for left_out in outcome.left_out.clone() {
        outcome.add_to_summary(&left_out);
    }
    if !outcome.verdict.is_pass() {
        let figures = std::mem::take(&mut outcome.figures).into_iter();
        let titled = figures.map(|figure| figure.titled_by(outcome.verdict));
        outcome.figures = titled.collect();
    }
    outcome
}

fn defects(id: &str, outcome: &Outcome) -> Vec<String> {
    let mut defects = Vec::new();
    defects.extend(repetitions(
        "the rate",
        outcome.rates.iter().map(|rate| &rate.name),
    ));
    defects.extend(repetitions(
        "the quantity",
        outcome.quantities.iter().map(|quantity| &quantity.name),
    ));
    defects.extend(repetitions(
        "the figure",
        outcome.figures.iter().map(|figure| &figure.file),
    ));
    for level in &outcome.levels {
        defects.extend(repetitions(
            "at one level the norm",
            level.errors.iter().map(|error| &error.name),
        ));
    }
    for NamedRate { name, rate, .. } in &outcome.rates {
        if rate.verdict == Verdict::Pass && !rests_on_numbers(rate) {
            defects.push(format!(
                "`{name}` passes without a finite rate in a finite interval"
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
    let numbers = outcome.sheets.iter().flat_map(|sheet| &sheet.measured);
    let names: Vec<String> = numbers.map(|one| one.in_case(&one.name)).collect();
    defects.extend(repetitions("the number", names.iter()));
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
    rate.interval.is_some_and(Interval::is_finite) && rate.fitted.is_some_and(f64::is_finite)
}

/// A plain file name that begins with the study's id: figures of all studies share one folder.
fn well_named(id: &str, figure: &Figure) -> bool {
    let rest = figure.file.strip_prefix(id);
    let what = rest
        .and_then(|rest| rest.strip_prefix('-'))
        .and_then(|rest| rest.strip_suffix(".svg"));
    what.is_some_and(|what| {
        let mut characters = what.chars();
        !what.is_empty()
            && characters.all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '.' | '_'))
    })
}

/// A complaint for each name that an earlier one equals.
fn repetitions<'n>(what: &str, names: impl Iterator<Item = &'n String>) -> Vec<String> {
    let mut seen = HashSet::new();
    names
        .filter(|name| !seen.insert(*name))
        .map(|name| format!("{what} `{name}` occurs twice"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::left_out::left_out;
    use crate::study::outcome::{Quantity, Table};
    use convergence_judge::verdict;

    fn passing() -> Outcome {
        let levels = [(0.5, 0.5), (0.25, 0.25), (0.125, 0.125), (0.0625, 0.0625)];
        let rate = verdict::judge_pairs(levels, 1.0, 0.1);
        let rates = vec![NamedRate::new("velocity", rate)];
        Outcome::new("fine", rates, vec![Check::that(true, "c", "e")])
    }

    #[track_caller]
    fn refused(outcome: Outcome, evidence: &str) {
        let settled = settle("id", outcome);
        assert_eq!(settled.verdict, Verdict::Fail, "{settled:?}");
        let last = settled.checks.last().unwrap().evidence.to_string();
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

    #[cfg(feature = "reports")]
    #[test]
    fn the_title_of_a_figure_says_that_its_study_does_not_pass() {
        use crate::chart::{Axis, Chart};
        let mut chart = Chart::empty(Axis::linear("t"), Axis::linear("E")).titled("E falls");
        chart.curve("E", [(0.0, 1.0), (1.0, 0.5)]);
        let drawn = |holds: bool| {
            let mut outcome = passing();
            outcome.checks.push(Check::that(holds, "c", "e"));
            outcome.figures = vec![Figure::of("energy", "", chart.clone())];
            settle("id", outcome).figures.remove(0).svg().to_owned()
        };
        assert_eq!(drawn(true), chart.svg());
        assert_eq!(
            drawn(false),
            chart.svg().replace("\"\">E falls<", "\"\">fail: E falls<")
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
        assert_eq!(settled.summary.to_string(), "all well; nothing was judged");
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
        let outcome = Outcome {
            left_out: left_out("points", [None, Some("short")])
                .into_iter()
                .collect(),
            ..passing()
        };
        let summary = settle("id", outcome).summary.to_string();
        assert_eq!(summary, "fine; 1 of 2 points judged; 1 not: short");
    }

    #[test]
    fn every_defect_of_an_outcome_fails_and_is_named() {
        let quantity = |value| Quantity::new("q", value, 0.1);
        let mut twice = passing();
        twice.quantities = vec![quantity(1.0), quantity(2.0)];
        refused(twice, "the quantity `q` occurs twice");
        for file in ["../x.svg", ".svg", "a/b.svg", "x.png"] {
            let mut drawn = passing();
            let mut figure = Figure::new("", "", String::new());
            figure.file = file.into();
            drawn.figures = vec![figure];
            refused(drawn, file);
        }
        let mut ragged = passing();
        ragged.tables = vec![Table {
            title: "ragged".into(),
            head: vec!["a".into()],
            rows: vec![vec![]],
        }];
        refused(ragged, "ragged");
        let mut nan = passing();
        nan.rates[0].rate.fitted = Some(f64::NAN);
        refused(nan, "`velocity` passes without");
    }
}
