//! What the variants show, for people: at most fifteen lines.

use std::collections::BTreeMap;

use super::decide::Conclusion;
use crate::run::{Fate, VariantRates, WhereLost};
use crate::study::variants::{SolverPart, Variants};
use crate::text::columns::Columns;
use crate::text::number::plain_text;
use convergence_judge::verdict::{RateVerdict, Reason, Tendency};

/// Most rows of the table; more variants stand beside each other.
const MOST_ROWS: usize = 10;

impl WhereLost {
    /// The table of variants, and the conclusion.
    pub fn text(&self) -> String {
        let cells = self.variants.iter().map(|variant| {
            vec![
                variant.name.clone(),
                deciding(Some(variant)),
                order(variant).to_owned(),
            ]
        });
        let cells: Vec<Vec<String>> = cells.collect();
        let columns = cells.len().div_ceil(MOST_ROWS).max(1);
        let count = cells.len().div_ceil(columns).max(1);
        let head = ["variant", "rate", "order"].repeat(columns);
        let head: Vec<String> = head.into_iter().map(str::to_owned).collect();
        let rows = (0..count).map(|place| {
            let beside = (0..columns).map(|column| cells.get(place + column * count));
            let beside = beside.map(|cells| cells.cloned().unwrap_or(vec![String::new(); 3]));
            beside.flatten().collect()
        });
        let rows: Vec<Vec<String>> = rows.collect();
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
pub(crate) fn summary(places: &[&WhereLost]) -> String {
    if places.len() < 2 {
        return String::new();
    }
    let mut counts: Vec<(&SolverPart, usize)> = vec![];
    for part in places.iter().flat_map(|where_lost| &where_lost.named) {
        match counts.iter_mut().find(|(known, _)| *known == part) {
            Some((_, count)) => *count += 1,
            None => counts.push((part, 1)),
        }
    }
    // Stable: equal counts keep the order of the studies.
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let parts = counts
        .iter()
        .map(|(part, count)| format!("{} in {count}", PartWords::of(part, &BTreeMap::new()).place));
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

/// What is said of a part.
struct PartWords {
    place: String,
    /// What its variant is like.
    variant: String,
    hint: String,
}

impl PartWords {
    /// * `data`: the names of the conditions at each face.
    fn of(part: &SolverPart, data: &BTreeMap<String, Vec<String>>) -> Self {
        let [place, variant, hint] = match part {
            SolverPart::Face(name) => [
                format!("at the face {name}"),
                "the solution is flat there".to_owned(),
                conditions(name, data),
            ],
            SolverPart::Initial => [
                "at the first time".to_owned(),
                "the solution is flat there".to_owned(),
                "the initial data".to_owned(),
            ],
            SolverPart::Coordinate(name) => [
                format!("in what acts along {name}"),
                format!("the solution is constant in {name}"),
                format!(
                    "the derivatives by {name} inside the domain, and the points at which source and exact values are taken"
                ),
            ],
            SolverPart::Time(name) => [
                format!("in what acts along {name}"),
                format!("the solution is constant in {name}"),
                "the time at which source and data are taken, and the time stepping".to_owned(),
            ],
            SolverPart::Parameter(name) => [
                format!("in the terms with {name}"),
                format!("{name} is zero"),
                format!("the terms with {name}"),
            ],
            SolverPart::Field(name) => [
                format!("in what acts on {name}"),
                format!("{name} is constant"),
                format!("the terms with {name}"),
            ],
            // Several faces are named one by one.
            SolverPart::BothFaces(_)
            | SolverPart::AllFaces
            | SolverPart::AllFacesBut(_)
            | SolverPart::AllFacesAndInitial => Default::default(),
        };
        Self {
            place,
            variant,
            hint,
        }
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
        Some(Tendency::Constant { limit }) => Some(plain_text(limit)),
        _ => None,
    };
    let lost = limit.as_ref().map_or_else(
        || "the order is lost".to_owned(),
        |limit| format!("the errors tend to about {limit} by a mistake"),
    );
    let explained = match conclusion {
        Conclusion::Named(parts) => named(parts, rows, variants),
        Conclusion::Corner(faces) => {
            let rates = faces.iter().map(|face| rate(rows, face));
            Explained {
                places: format!("where the faces {} meet", names_of(faces)),
                variants: format!(
                    "the solution is flat at either ({})",
                    listed(rates.collect())
                ),
                lost_else: "not where it is flat at any other face",
                hints: "what is done at this corner".to_owned(),
            }
        }
        Conclusion::Everywhere => {
            return format!(
                "{lost} in every variant: everywhere, as by a quadrature, a coefficient or a norm, \
                 or in several parts at once; no part is named"
            );
        }
        Conclusion::Open(parts) => return open(parts, rows),
        Conclusion::Several => {
            return format!(
                "no part is named: no single one explains that the order comes back {}",
                back(rows)
            );
        }
    };
    // Errors that tend to a constant are the subject: then `it` would be unclear.
    let [it, kind] = match limit {
        None => ["it", ""],
        Some(_) => [
            "the order",
            "; a coefficient, a sign or a value is wrong there, rather than a stencil",
        ],
    };
    let Explained {
        places,
        variants,
        lost_else,
        hints,
    } = explained;
    format!(
        "{lost} {places}: {it} comes back where {variants}, and {lost_else}; look at {hints}{kind}"
    )
}

/// The parts of the sentence about parts that explain all losses.
struct Explained {
    places: String,
    /// Where the order comes back.
    variants: String,
    /// Where it does not.
    lost_else: &'static str,
    hints: String,
}

/// Parts in all of which at once every mistake acts; but each at one of several faces.
fn named(parts: &[SolverPart], rows: &[VariantRates], of: &Variants) -> Explained {
    let is_face = |part: &&SolverPart| matches!(part, SolverPart::Face(_));
    let faces = parts.iter().filter(is_face).count();
    let mut places = vec![];
    let mut variants = vec![];
    let mut hints = vec![];
    for part in parts {
        let words = PartWords::of(part, &of.data);
        hints.push(words.hint);
        if faces < 2 || !is_face(&part) {
            places.push(words.place);
            variants.push(format!("{} ({})", words.variant, rate(rows, part)));
        }
    }
    if faces > 1 {
        places.insert(0, format!("at the faces {}", names_of(parts)));
        variants.insert(0, "the solution is flat at these together".to_owned());
        hints.push("what serves them all".to_owned());
    }
    match faces {
        0 => (),
        1 => hints.push("the cells beside it".to_owned()),
        _ => hints.push("the cells beside them".to_owned()),
    }
    Explained {
        places: listed(places),
        variants: listed(variants),
        lost_else: match faces {
            0 if parts.contains(&SolverPart::Initial) => "not where it is flat at any face",
            0 => "stays lost where the solution is flat at the faces and at the first time",
            1 => "not where it is flat at any other face",
            _ => "not where one of them is left",
        },
        hints: listed(hints),
    }
}

/// The faces among some parts.
fn names_of(parts: &[SolverPart]) -> String {
    let names = parts.iter().filter_map(|part| match part {
        SolverPart::Face(name) => Some(name.clone()),
        _ => None,
    });
    listed(names.collect())
}

/// What would decide, and at which sizes.
fn open(parts: &[SolverPart], rows: &[VariantRates]) -> String {
    let mut reasons = vec![];
    for why in ["without finite errors", UNDECIDED, "left out"] {
        let is_own =
            |row: &&VariantRates| parts.contains(&row.switches_off) && why_open(row) == why;
        let names = rows.iter().filter(is_own).map(|row| match &row.next {
            Some(level) if why == UNDECIDED => format!("{} at {level}", row.name),
            _ => row.name.clone(),
        });
        let names: Vec<String> = names.collect();
        if !names.is_empty() {
            reasons.push(format!("{why}: {}", listed(names)));
        }
    }
    format!(
        "no part is named: what would decide is undecided or left out ({})",
        reasons.join("; ")
    )
}

const UNDECIDED: &str = "undecided, finer levels may tell";

/// Why a variant decides nothing.
fn why_open(row: &VariantRates) -> &'static str {
    let mut rates = row.rates.iter();
    if row.left_out.is_some() {
        "left out"
    } else if rates.any(|rate| rate.rate.code == Reason::NonFiniteError) {
        "without finite errors"
    } else {
        UNDECIDED
    }
}

/// The data of a face: `the condition flux at x_max`.
fn conditions(face: &str, data: &BTreeMap<String, Vec<String>>) -> String {
    let names = data.get(face).cloned().unwrap_or_default();
    let data = match names.len() {
        0 => "data",
        1 => "condition ",
        _ => "conditions ",
    };
    format!("the {data}{} at {face}", listed(names))
}

/// The rate with a variant.
fn rate(rows: &[VariantRates], part: &SolverPart) -> String {
    deciding(rows.iter().find(|row| row.switches_off == *part))
}

/// The rate that decides what became of the order, with the name of its error if there are several.
fn deciding(row: Option<&VariantRates>) -> String {
    let rates = row.map_or(&[][..], |row| &row.rates);
    match rates {
        [] => "-".to_owned(),
        [only] => interval(&only.rate),
        [first, ..] => format!("{} of {}", interval(&first.rate), first.error),
    }
}

/// Where the order comes back.
fn back(rows: &[VariantRates]) -> String {
    let back = rows
        .iter()
        .filter(|row| matches!(row.order, Fate::Back | Fate::RoundOff));
    let names: Vec<String> = back.map(|row| row.name.clone()).collect();
    match names.is_empty() {
        true => "in none".to_owned(),
        false => format!("in {}, and in no other", listed(names)),
    }
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
        let where_lost = |named: Vec<SolverPart>| WhereLost {
            named,
            conclusion: String::new(),
            variants: vec![],
        };
        let a = || SolverPart::Parameter("a".to_owned());
        let places = [
            where_lost(vec![SolverPart::Face("x_max".to_owned())]),
            where_lost(vec![SolverPart::Field("heat".to_owned()), a()]),
            where_lost(vec![a()]),
            where_lost(vec![]),
        ];
        let all: Vec<&WhereLost> = places.iter().collect();
        assert_eq!(
            summary(&all),
            "of 4 studies that have lost an order: in the terms with a in 2, at the face x_max in 1, \
             in what acts on heat in 1\n"
        );
        assert_eq!(summary(&all[..1]), "");
        let none = "of 2 studies that have lost an order: no part is named\n";
        assert_eq!(summary(&[all[3], all[3]]), none);
    }
}
