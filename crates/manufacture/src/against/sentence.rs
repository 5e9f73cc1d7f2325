//! Comparisons: what is said of each component.

use std::collections::BTreeMap;

use super::Comparison;
use super::ask::ForeignQuantity;
use super::cause::{Cause, Edit, Named, Unexplained};
use super::explain::Explained;
use super::right::{ComponentPlace, Right};
use super::search::{EditSearch, place_of};
use super::site::Span;
use super::text::of_whole;
use super::whole::Component;
use crate::problem::{Expression, LineColumn};

/// A value explains another within this many spreads of the file's own two evaluations, of the
/// larger of both sides, or within the digits printed.
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
    let triples = values.iter().zip(&answer.values).zip(&answer.units);
    let allowed = triples
        .map(|((right, foreign), unit)| SPREADS * spread * right.size.max(foreign.abs()) + unit);
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
    let words = cause.words(&right.model.problem.file, &labels);
    let words = match &cause {
        Cause::Equal if largest == 0.0 => format!("{words}, to the last digit"),
        Cause::Equal => format!(
            "{words}: the largest difference, {largest:.1e}, is within {SPREADS} times the spread \
             of the two evaluations of the file, or within the digits printed"
        ),
        Cause::None(_) => format!("{words}; {}", where_it_differs(right, &differences)),
        _ => placed(words, right, component.place, &cause),
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
        edits: match cause {
            Cause::Edit(named) => vec![named.edit],
            _ => vec![],
        },
        alternatives,
    }
}

/// Words with the place of what they are about, if they do not name it.
fn placed(words: String, right: &Right<'_>, place: ComponentPlace, cause: &Cause) -> String {
    let problem = &right.model.problem;
    let whole = place_of(right, place.quantity);
    let terms = problem
        .equations
        .iter()
        .flat_map(|equation| &equation.terms);
    let LineColumn { line, column } = match cause {
        Cause::Edit(named) if named.label.is_none() => return words,
        Cause::Edit(Named { edit, .. }) => LineColumn {
            line: edit.line,
            column: edit.column,
        },
        Cause::Terms(changed) => {
            let mut terms = terms.filter(|term| term.label == changed[0].label);
            let first = terms.next().map(|term| &term.expression);
            first.map_or(whole.text, |Expression { place, text, tree }| {
                place.of_text(text, Span::of(tree, text).start)
            })
        }
        _ => {
            let Edit { line, column, .. } = of_whole(problem, &whole, String::new(), String::new());
            LineColumn { line, column }
        }
    };
    format!("{words} ({}:{line}:{column})", problem.file)
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
