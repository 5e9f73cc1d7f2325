//! What the variants show, for people: at most fifteen lines.

use super::decide::Conclusion;
use crate::judge::verdict::{RateVerdict, Tendency};
use crate::run::{Fate, VariantRates, WhereLost};
use crate::study::variants::{SolverPart, Variants};
use crate::text::columns::Columns;
use crate::text::number::plain_text;

/// Most rows of the table; more variants stand beside each other.
const MOST_ROWS: usize = 10;

impl WhereLost {
    /// The table of variants, and the conclusion.
    pub fn text(&self) -> String {
        let cells = |variant: &VariantRates| {
            let rate = variant.rates.first();
            vec![
                variant.name.clone(),
                rate.map_or_else(|| "-".to_owned(), |rate| interval(&rate.rate)),
                order(variant).to_owned(),
            ]
        };
        let cells: Vec<Vec<String>> = self.variants.iter().map(cells).collect();
        let columns = cells.len().div_ceil(MOST_ROWS).max(1);
        let count = cells.len().div_ceil(columns).max(1);
        let head = ["variant", "rate", "order"].repeat(columns);
        let head: Vec<String> = head.into_iter().map(str::to_owned).collect();
        let row = |place: usize| -> Vec<String> {
            let beside = (0..columns).map(|column| cells.get(place + column * count));
            let beside = beside.map(|cells| cells.cloned().unwrap_or(vec![String::new(); 3]));
            beside.flatten().collect()
        };
        let rows: Vec<Vec<String>> = (0..count).map(row).collect();
        let widths = Columns::of(&head, &rows);
        let mut text = String::new();
        for cells in std::iter::once(&head).chain(&rows) {
            let cells: Vec<String> = widths.pad(cells).collect();
            text += cells.join("  ").trim_end();
            text += "\n";
        }
        text + &self.conclusion + "\n"
    }
}

pub(super) fn order(variant: &VariantRates) -> &'static str {
    match variant.order {
        Fate::Back => "back",
        Fate::RoundOff => "round-off",
        Fate::Lost => "lost",
        Fate::Unknown if variant.left_out.is_some() => "left out",
        Fate::Unknown if variant.rates.is_empty() => "not run",
        Fate::Unknown => "undecided",
    }
}

/// The parts that are named in several studies, the commonest first: a line; empty for one study.
pub(crate) fn summary_of_located(places: &[&WhereLost]) -> String {
    if places.len() < 2 {
        return String::new();
    }
    let mut counts: Vec<(&SolverPart, usize)> = vec![];
    for part in places.iter().flat_map(|located| &located.named) {
        match counts.iter_mut().find(|(known, _)| *known == part) {
            Some((_, count)) => *count += 1,
            None => counts.push((part, 1)),
        }
    }
    // Stable: equal counts keep the order of the studies.
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let parts = counts
        .iter()
        .map(|(part, count)| format!("{} in {count}", place(part)));
    let parts: Vec<String> = parts.collect();
    let parts = if parts.is_empty() {
        "no part is named".to_owned()
    } else {
        parts.join(", ")
    };
    format!(
        "of {} studies that have lost an order: {parts}\n",
        places.len()
    )
}

/// A part that is named.
fn place(part: &SolverPart) -> String {
    match part {
        SolverPart::Face(name) => format!("at the face {name}"),
        SolverPart::Initial => "at the first time".to_owned(),
        part => Inside::of(part).map_or_else(String::new, |words| words.place),
    }
}

/// `2.03 ± 0.04`; the last rate without an interval.
fn interval(rate: &RateVerdict) -> String {
    if let (Some(fitted), Some(interval)) = (rate.fitted, rate.interval) {
        return format!("{fitted:.2} ± {:.2}", interval.width() / 2.0);
    }
    let last = rate.pairwise.last();
    last.map_or_else(|| "-".to_owned(), |rate| format!("{rate:.2}"))
}

/// The conclusion in a sentence.
///
/// * `tendency`: what the errors of the study tend to, if not to zero.
pub(super) fn sentence(
    conclusion: &Conclusion,
    rows: &[VariantRates],
    tendency: Option<Tendency>,
    variants: &Variants,
) -> String {
    let limit = match tendency {
        Some(Tendency::Constant { limit }) => Some(limit),
        _ => None,
    };
    let lost = limit.map_or_else(
        || "the order is lost".to_owned(),
        |limit| {
            format!(
                "the errors tend to about {} by a mistake",
                plain_text(limit)
            )
        },
    );
    // Errors that tend to a constant are the subject: then `it` would be unclear.
    let it = if limit.is_some() { "the order" } else { "it" };
    let mut sentence = match conclusion {
        Conclusion::Faces { names, time } => {
            faces([&lost, it], names, time.as_deref(), rows, variants)
        }
        Conclusion::Corner([one, other]) => format!(
            "{lost} where the faces {one} and {other} meet: {it} comes back where the solution is flat \
             at {one} ({}) and at {other} ({}) alike, and not where it is flat at any other face; \
             look at what is done at this corner",
            rate(rows, &SolverPart::Face(one.clone())),
            rate(rows, &SolverPart::Face(other.clone())),
        ),
        Conclusion::Initial => format!(
            "{lost} at the first time: {it} comes back where the solution is flat there ({}), and not \
             where it is flat at any face; look at the initial data",
            rate(rows, &SolverPart::Initial),
        ),
        Conclusion::Inside(parts) => inside([&lost, it], parts, rows),
        Conclusion::Everywhere => format!(
            "{lost} in every variant: everywhere, as by a quadrature, a coefficient or a norm, or in \
             several parts at once; no part is named"
        ),
        Conclusion::Open(parts) => open(parts, rows),
        Conclusion::Several => format!(
            "no part is named: no single one explains that the order comes back {}",
            back(rows)
        ),
    };
    if limit.is_some() && !conclusion.named().is_empty() {
        sentence += "; a coefficient, a sign or a value is wrong there, rather than a stencil";
    }
    sentence
}

/// What would decide, and at which sizes.
fn open(parts: &[SolverPart], rows: &[VariantRates]) -> String {
    let is_open = |row: &&VariantRates| parts.contains(&row.switches_off);
    let (left_out, undecided): (Vec<&VariantRates>, Vec<_>) = rows
        .iter()
        .filter(is_open)
        .partition(|row| row.left_out.is_some());
    let mut reasons = vec![];
    if !undecided.is_empty() {
        let at = |row: &&VariantRates| match &row.next {
            Some(level) => format!("{} at {level}", row.name),
            None => row.name.clone(),
        };
        let variants = listed(undecided.iter().map(at).collect());
        reasons.push(format!("undecided, finer levels may tell: {variants}"));
    }
    if !left_out.is_empty() {
        let names = listed(left_out.iter().map(|row| row.name.clone()).collect());
        reasons.push(format!("left out: {names}"));
    }
    format!(
        "no part is named: what would decide is undecided or left out ({})",
        reasons.join("; ")
    )
}

/// * `lost`, `it`: how the sentence begins, and the order in it.
/// * `time`: its name, if the order comes back where nothing changes in it.
fn faces(
    [lost, it]: [&str; 2],
    names: &[String],
    time: Option<&str>,
    rows: &[VariantRates],
    variants: &Variants,
) -> String {
    let all: Vec<String> = names
        .iter()
        .map(|face| conditions(face, variants))
        .collect();
    let all = listed(all);
    let (place, back) = match names {
        [face] => (
            format!("the face {face}"),
            format!(
                "it comes back where the solution is flat there ({})",
                rate(rows, &SolverPart::Face(face.clone()))
            ),
        ),
        _ => (
            format!("the faces {}", listed(names.to_vec())),
            "it comes back where the solution is flat at these together".to_owned(),
        ),
    };
    let back = back.replacen("it", it, 1);
    let not = match names {
        [_] => "not where it is flat at any other face",
        _ => "not where one of them is left",
    };
    let Some(time) = time else {
        let together = if names.len() > 1 {
            ", and at what serves them all"
        } else {
            ""
        };
        return format!("{lost} at {place}: {back}, and {not}; look at {all}{together}");
    };
    let constant = rate(rows, &SolverPart::Time(time.to_owned()));
    format!(
        "{lost} at {place}, in time: {back}, and where it is constant in {time} ({constant}), and {not}; \
         look at the time at which {all} {} taken",
        if names.len() > 1 { "are" } else { "is" }
    )
}

/// What is said of a part inside the domain.
struct Inside {
    place: String,
    /// What its variant is like.
    variant: String,
    hint: String,
}

impl Inside {
    /// `None` for a part that is not inside.
    fn of(part: &SolverPart) -> Option<Self> {
        match part {
            SolverPart::Coordinate(name) => Some(Self {
                place: format!("in what acts along {name}"),
                variant: format!("the solution is constant in {name}"),
                hint: format!("the derivatives by {name} inside the domain"),
            }),
            SolverPart::Time(name) => Some(Self {
                place: format!("in what acts along {name}"),
                variant: format!("the solution is constant in {name}"),
                hint: "the time at which source and data are taken, and the time stepping"
                    .to_owned(),
            }),
            SolverPart::Parameter(name) => Some(Self {
                place: format!("in the terms with {name}"),
                variant: format!("{name} is zero"),
                hint: format!("the terms with {name}"),
            }),
            SolverPart::Field(name) => Some(Self {
                place: format!("in what acts on {name}"),
                variant: format!("{name} is constant"),
                hint: format!("the terms with {name}"),
            }),
            _ => None,
        }
    }
}

/// * `lost`, `it`: as for [`faces`].
fn inside([lost, it]: [&str; 2], parts: &[SolverPart], rows: &[VariantRates]) -> String {
    let mut places = vec![];
    let mut variants = vec![];
    let mut hints = vec![];
    for part in parts {
        if let Some(words) = Inside::of(part) {
            places.push(words.place);
            variants.push(format!("{} ({})", words.variant, rate(rows, part)));
            hints.push(words.hint);
        }
    }
    format!(
        "{lost} {}: {it} comes back where {}, and stays lost where the solution is flat at the faces \
         and at the first time; look at {}",
        listed(places),
        listed(variants),
        listed(hints)
    )
}

/// The data of a face: `the condition flux at x_max`.
fn conditions(face: &str, variants: &Variants) -> String {
    let names = variants.data.get(face).cloned().unwrap_or_default();
    match names.len() {
        0 => format!("the data at {face}"),
        1 => format!("the condition {} at {face}", listed(names)),
        _ => format!("the conditions {} at {face}", listed(names)),
    }
}

/// The rate with a variant.
fn rate(rows: &[VariantRates], part: &SolverPart) -> String {
    let row = rows.iter().find(|row| row.switches_off == *part);
    let rate = row.and_then(|row| row.rates.first());
    rate.map_or_else(|| "-".to_owned(), |rate| interval(&rate.rate))
}

/// Where the order comes back.
fn back(rows: &[VariantRates]) -> String {
    let is_back = |row: &VariantRates| matches!(row.order, Fate::Back | Fate::RoundOff);
    if rows.iter().any(is_back) {
        format!("in {}, and in no other", names(rows, is_back))
    } else {
        "in none".to_owned()
    }
}

/// The names of variants.
fn names(rows: &[VariantRates], is_wanted: impl Fn(&VariantRates) -> bool) -> String {
    let wanted = rows.iter().filter(|row| is_wanted(row));
    listed(wanted.map(|row| row.name.clone()).collect())
}

/// `a, b and c`.
fn listed(mut names: Vec<String>) -> String {
    let last = names.pop().unwrap_or_default();
    if names.is_empty() {
        last
    } else {
        format!("{} and {last}", names.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_named_in_several_studies_are_counted() {
        let located = |named: Vec<SolverPart>| WhereLost {
            named,
            conclusion: String::new(),
            variants: vec![],
        };
        let a = || SolverPart::Parameter("a".to_owned());
        let places = [
            located(vec![SolverPart::Face("x_max".to_owned())]),
            located(vec![SolverPart::Field("heat".to_owned()), a()]),
            located(vec![a()]),
            located(vec![]),
        ];
        let all: Vec<&WhereLost> = places.iter().collect();
        assert_eq!(
            summary_of_located(&all),
            "of 4 studies that have lost an order: in the terms with a in 2, at the face x_max in 1, \
             in what acts on heat in 1\n"
        );
        assert_eq!(summary_of_located(&all[..1]), "");
        let none = "of 2 studies that have lost an order: no part is named\n";
        assert_eq!(summary_of_located(&[all[3], all[3]]), none);
    }
}
