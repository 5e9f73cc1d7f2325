//! Comparisons: what is said of each component.

use std::collections::BTreeMap;

use super::Comparison;
use super::ask::ForeignQuantity;
use super::candidates;
use super::cause::{Cause, Edit, TermFactor, Unexplained};
use super::explain::Explained;
use super::right::{ComponentPlace, Right};
use super::search::{EditSearch, place_of};
use super::text::{self, of_whole};
use super::whole::Component;
use crate::problem::{Expression, Problem};

/// A value explains another within this many spreads of the file's own two evaluations, or within
/// the digits printed.
///
/// Another program sums in another order, and may expand products: its rounding is larger than the
/// spread, but of its kind.
const SPREADS: f64 = 1000.0;

/// Explains what another program answers.
///
/// * `spreads`: those of [`Right::spreads`].
/// * `fresh`: points that the program was not asked about.
pub(super) fn explain(
    right: &Right<'_>,
    spreads: &[Vec<f64>],
    answers: &[ForeignQuantity],
    fresh: &[Vec<f64>],
) -> Vec<Comparison> {
    let components: Vec<Component<'_, '_>> = answers
        .iter()
        .map(|answer| component(right, spreads, answer))
        .collect();
    let mut explained: Vec<Option<Explained>> = components
        .iter()
        .map(|component| component.of_source().map(Explained::plain))
        .collect();
    let mut open: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (place, explained) in explained.iter().enumerate() {
        if explained.is_none() {
            let quantity = components[place].place.quantity;
            open.entry(quantity).or_default().push(place);
        }
    }
    if !open.is_empty()
        && let Some(mut search) = EditSearch::new(right, &components, fresh.to_vec())
    {
        for (quantity, wrong) in open {
            let found = search.explain(quantity, &wrong);
            for (place, found) in wrong.into_iter().zip(found) {
                explained[place] = Some(found);
            }
        }
    }
    let parts = answers.iter().zip(&components).zip(explained);
    parts
        .map(|((answer, component), explained)| {
            let explained =
                explained.unwrap_or_else(|| Explained::plain(Cause::None(Unexplained::default())));
            comparison(answer, component, explained)
        })
        .collect()
}

fn component<'a, 'm>(
    right: &'a Right<'m>,
    spreads: &[Vec<f64>],
    answer: &'a ForeignQuantity,
) -> Component<'a, 'm> {
    let place = right.place_of(answer).unwrap_or(ComponentPlace {
        quantity: 0,
        component: 0,
    });
    let values = right.values(place);
    let spread = spreads[place.quantity][place.component];
    let allowed = values
        .iter()
        .zip(&answer.units)
        .map(|(v, unit)| SPREADS * spread * v.size + unit);
    Component {
        right,
        place,
        foreign: &answer.values,
        allowed: allowed.collect(),
        source: values.iter().map(|v| v.value).collect(),
    }
}

fn comparison(
    answer: &ForeignQuantity,
    component: &Component<'_, '_>,
    explained: Explained,
) -> Comparison {
    let Explained {
        cause,
        alternatives,
    } = explained;
    let right = component.right;
    let differences = component.differences();
    let largest = differences.iter().copied().fold(0.0, f64::max);
    let labels = right.labels(component.place);
    let edits = edits(right, component.place, &cause);
    let words = cause.words(&right.model.problem.file, &labels);
    let words = match &cause {
        Cause::Equal if largest == 0.0 => format!("{words}, to the last digit"),
        Cause::Equal => format!(
            "{words}: the largest difference, {largest:.1e}, is within {SPREADS} times the spread \
             of the two evaluations of the file, or within the digits printed"
        ),
        Cause::None(_) => format!("{words}; {}", where_it_differs(right, &differences)),
        _ => placed(words, &cause, &edits, &right.model.problem.file),
    };
    let words = match alternatives.is_empty() {
        true => words,
        false => format!("{words} (this fits as well: {})", alternatives.join(", ")),
    };
    Comparison {
        quantity: answer.name.clone(),
        difference: largest,
        sentence: format!("{}: {words}", answer.name),
        cause: cause.name(),
        terms: cause.terms(),
        factors: cause.factors(),
        edits,
        alternatives,
    }
}

/// Words with the place of the edit, if they do not name it.
fn placed(words: String, cause: &Cause, edits: &[Edit], file: &str) -> String {
    match edits.first() {
        Some(Edit { line, column, .. }) if !cause.has_place() => {
            format!("{words} ({file}:{line}:{column})")
        }
        _ => words,
    }
}

/// Where the difference is largest and where it is smallest.
fn where_it_differs(right: &Right<'_>, differences: &[f64]) -> String {
    let differences = || differences.iter().zip(&right.points);
    let largest = differences().max_by(|a, b| a.0.total_cmp(b.0));
    let smallest = differences().min_by(|a, b| a.0.total_cmp(b.0));
    let [largest, smallest] = [largest, smallest].map(|entry| {
        entry.map_or(String::new(), |(difference, point)| {
            format!("{difference:.3e} at {}", right.model.place_in_words(point))
        })
    });
    format!("your values differ by {largest} and by {smallest}")
}

/// The edits of a cause, each with its place.
fn edits(right: &Right<'_>, place: ComponentPlace, cause: &Cause) -> Vec<Edit> {
    let problem = &right.model.problem;
    let whole = place_of(right, place.quantity);
    let of_all = |old: &str, new: String| {
        vec![Edit {
            kind: cause.name(),
            ..of_whole(problem, &whole, old.to_owned(), new)
        }]
    };
    let sum = sum(&right.labels(place), &whole.key);
    match cause {
        Cause::Equal | Cause::None(_) => vec![],
        Cause::Edits(edits) => edits.iter().map(|named| named.edit.clone()).collect(),
        Cause::SignOfSource => of_all(&sum, format!("-({sum})")),
        Cause::Normal => of_all("n", "-n".to_owned()),
        Cause::Constant(number) => of_all(&sum, format!("{sum} + {number}")),
        Cause::FactorOfSource(factor) => of_all(&sum, format!("{factor}*({sum})")),
        Cause::Terms(terms) => {
            let name = &right.quantities[place.quantity].quantity.name;
            let edit = |term: &TermFactor| {
                let candidate = candidates::of_term(problem, name, &term.label)?;
                Some(text::named(problem, &whole, &candidate, term.factor).edit)
            };
            terms.iter().filter_map(edit).collect()
        }
        Cause::Time(time) => of_all(time_name(right), time.to_string()),
        Cause::TimeShift(shift) => {
            let name = time_name(right);
            of_all(name, format!("{name} + {shift}"))
        }
        Cause::Component(name) => of_all(right.name(place), name.clone()),
        Cause::Coordinates([first, second]) => {
            of_all(&format!("{first}, {second}"), format!("{second}, {first}"))
        }
        Cause::Parameters(names) => {
            let [first, second] = names.each_ref().map(|name| parameter(problem, name));
            let both = first.zip(second);
            both.map_or_else(Vec::new, |(first, second)| {
                let new = |of: &Expression, other: &Expression| Edit {
                    kind: cause.name(),
                    ..of_whole(problem, &of.place, of.text.clone(), other.text.clone())
                };
                vec![new(first, second), new(second, first)]
            })
        }
        Cause::Parameter { name, value } => {
            parameter(problem, name).map_or_else(Vec::new, |expression| {
                vec![Edit {
                    kind: cause.name(),
                    ..of_whole(
                        problem,
                        &expression.place,
                        expression.text.clone(),
                        value.to_string(),
                    )
                }]
            })
        }
    }
}

fn parameter<'p>(problem: &'p Problem, name: &str) -> Option<&'p Expression> {
    let mut parameters = problem.parameters.iter();
    parameters
        .find(|parameter| parameter.name == name)
        .map(|parameter| &parameter.expression)
}

fn time_name<'r>(right: &'r Right<'_>) -> &'r str {
    right.model.problem.time.as_deref().unwrap_or("")
}

/// The sum of all terms in words; for a datum its key.
fn sum(labels: &[&str], key: &str) -> String {
    if labels.is_empty() {
        return key.to_owned();
    }
    labels.join(" + ").replace(" + -", " - ")
}
