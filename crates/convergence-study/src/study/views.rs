//! What a study says of its numbers: checks, tables, entries of the baseline, headline.

use std::cmp::Ordering;

use super::measured::{Measured, Recorded, Sheet};
use super::must::Must;
use super::outcome::{Check, Outcome, Quantity, Table};
use super::subject::Subject;
use crate::text::lists::{distinct, grouped};
use convergence_judge::verdict::Verdict;

impl Measured {
    fn subject(&self) -> Subject {
        let case = (!self.case.is_empty()).then(|| self.case.clone());
        Subject {
            case,
            against: self.against.clone(),
            ..Subject::of(&self.name)
        }
    }

    /// Fails where a claim does not hold, or a number is not finite; `None` if nothing is claimed.
    fn check(&self) -> Option<Check> {
        let words = match (self.claim, &self.statement) {
            (Some(_), Some(statement)) => statement.clone(),
            (Some(claim @ Must::Near { .. }), None) => format!("{} is {claim}", self.name),
            (Some(claim), None) => format!("{} {claim}", self.name),
            (None, _) if self.is_broken() => format!("{} is a finite number", self.name),
            (None, _) => return None,
        };
        let holds = self.holds().unwrap_or(false);
        Some(Check::that(holds, words, self.text()).about(self.subject()))
    }

    fn quantity(&self) -> Option<Quantity> {
        let Recorded { name, tolerance } = self.record.as_ref()?;
        let value = self.value.unwrap_or(f64::NAN);
        let quantity = Quantity::new(name, value, *tolerance);
        Some(quantity.about(self.subject()).claimed(self.claim))
    }
}

impl Sheet {
    /// What is claimed of its numbers.
    fn checks(&self) -> impl Iterator<Item = Check> {
        self.measured.iter().filter_map(Measured::check)
    }

    /// What the baseline guards of its numbers; one without a value is NaN.
    pub fn quantities(&self) -> Vec<Quantity> {
        self.measured
            .iter()
            .filter_map(Measured::quantity)
            .collect()
    }

    /// A row for each case, a column for each name; `None` if none of its numbers is shown.
    pub fn table(&self) -> Option<Table> {
        let shown = self.measured.iter().filter(|one| !one.is_hidden);
        let shown: Vec<&Measured> = shown.collect();
        let names = distinct(shown.iter().map(|one| one.name.as_str()));
        let cases = distinct(shown.iter().map(|one| one.case.as_str()));
        let rows = cases.iter().map(|case| {
            let cells = names.iter().map(|name| {
                let mut all = shown.iter();
                let one = all.find(|one| one.case == *case && one.name == *name);
                one.map_or_else(|| "-".to_owned(), |one| one.text())
            });
            [(*case).to_owned()].into_iter().chain(cells).collect()
        });
        let head = [self.first.as_str()].into_iter();
        let head = head.chain(names.iter().copied());
        (!shown.is_empty()).then(|| Table::new(self.title.clone(), head, rows))
    }
}

impl Outcome {
    /// The outcome of a study whose numbers are these; it fails if none of them has a claim.
    ///
    /// * `headline`: the name of the numbers to read first; empty if they do not sum up the study.
    pub fn of_sheets(sheets: impl IntoIterator<Item = Sheet>, headline: &str) -> Self {
        let sheets: Vec<Sheet> = sheets.into_iter().collect();
        let all: Vec<&Measured> = sheets.iter().flat_map(|sheet| &sheet.measured).collect();
        let headline = in_short(&all, headline);
        let mut nothing = vec![];
        if all.iter().all(|one| one.claim.is_none()) {
            let check = Check::that(false, "the study claims something", "no number has a claim");
            nothing.push(check.about(Subject::of("claims")));
        }
        Self {
            headline: headline.as_str().into(),
            ..Self::new(headline, vec![], nothing).with_sheets(sheets)
        }
    }

    /// The same with more numbers: their checks, tables and guarded numbers. Its verdict can only
    /// become worse, unless nothing was judged before.
    pub fn with_sheets(mut self, sheets: impl IntoIterator<Item = Sheet>) -> Self {
        let is_judged = !self.rates.is_empty() || !self.checks.is_empty();
        let before = is_judged.then_some(self.verdict);
        for sheet in sheets {
            self.checks.extend(sheet.checks());
            self.tables.extend(sheet.table());
            self.quantities.extend(sheet.quantities());
            self.sheets.push(sheet);
        }
        let checks = self.checks.iter().map(|check| check.verdict);
        self.verdict = Verdict::worst(before.into_iter().chain(checks));
        self
    }

    /// The outcome of checks that have verdicts of their own, with the numbers that they are about.
    #[cfg(feature = "reports")]
    pub(crate) fn of_judged_sheet(summary: String, checks: Vec<Check>, sheet: Sheet) -> Self {
        Self {
            tables: sheet.table().into_iter().collect(),
            quantities: sheet.quantities(),
            headline: summary.as_str().into(),
            sheets: vec![sheet],
            ..Self::new(summary, vec![], checks)
        }
    }

    /// What numbers must be that the baseline does not guard, each by its name: for a name whose
    /// cases have the same claim one line, otherwise one for each case.
    pub(crate) fn claims(&self) -> Vec<(String, Must)> {
        let all = self.sheets.iter().flat_map(|sheet| &sheet.measured);
        let others = all.filter(|one| one.record.is_none());
        let claimed = others.filter_map(|one| Some((one.name.as_str(), (one, one.claim?))));
        let mut lines = vec![];
        for (name, claimed) in grouped(claimed) {
            let (_, first) = claimed[0];
            if claimed.iter().all(|(_, claim)| *claim == first) {
                lines.push((name.to_owned(), first));
            } else {
                let each = claimed.iter();
                lines.extend(each.map(|(one, claim)| (one.in_case(name), *claim)));
            }
        }
        lines
    }
}

fn by_value(a: &Measured, b: &Measured) -> Ordering {
    let [a, b] = [a, b].map(|one| one.value.unwrap_or(f64::NAN));
    a.total_cmp(&b)
}

/// The numbers of a name in a few words: the extreme one where all have a bound on one side.
fn in_short(all: &[&Measured], name: &str) -> String {
    if name.is_empty() {
        return String::new();
    }
    let named: Vec<&&Measured> = all.iter().filter(|one| one.name == name).collect();
    let has = |claim: fn(&Must) -> bool| {
        let mut named = named.iter();
        named.all(|one| one.claim.as_ref().is_some_and(claim))
    };
    let (word, extreme) = if has(|claim| matches!(claim, Must::AtMost(_))) {
        ("at most", named.iter().max_by(|a, b| by_value(a, b)))
    } else if has(|claim| matches!(claim, Must::AtLeast(_) | Must::Above(_))) {
        ("at least", named.iter().min_by(|a, b| by_value(a, b)))
    } else {
        ("", None)
    };
    match extreme {
        Some(one) => format!("{name} {word} {}", one.text()),
        None => {
            let each = named.iter().map(|one| match one.case.as_str() {
                "" => one.text(),
                case => format!("{} at {case}", one.text()),
            });
            format!("{name}: {}", each.collect::<Vec<_>>().join(", "))
        }
    }
}
