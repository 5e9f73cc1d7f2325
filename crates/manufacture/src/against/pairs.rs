//! Pairs of edits that are made together.

use super::bench::{Alteration, FACTORS, Rewrite};
use super::cause::Named;
use super::right::Place;
use super::search::{Search, Trial, position};
use super::solve::{difference, simple};
use crate::fit::{self, Column};
use crate::language::tree::{Kind, Tree};

/// What an edit adds to all components that are wrong, one after the other.
#[derive(Debug, Clone)]
pub(super) struct Effect {
    pub(super) candidate: usize,
    /// For one more of its factor, or for the edit itself.
    column: Column,
    is_free: bool,
}

impl Effect {
    /// Of an edit without a number.
    pub(super) fn fixed(column: Column) -> Self {
        Self {
            candidate: 0,
            column,
            is_free: false,
        }
    }

    /// The same, of this candidate.
    pub(super) fn of(self, candidate: usize) -> Self {
        Self { candidate, ..self }
    }

    /// Of an edit whose values are linear in a factor.
    pub(super) fn free(column: Column) -> Self {
        Self {
            candidate: 0,
            column,
            is_free: true,
        }
    }
}

/// The best edits, of which all pairs are tried.
const BEST: usize = 200;

/// What a pair may leave of the difference, before it is held against all points.
const LEFT: f64 = 1e-7;

/// The pairs that were tried, and the first that fits.
pub(super) struct Pairs {
    pub(super) count: usize,
    found: Vec<(Vec<Place>, Vec<Named>)>,
}

impl Pairs {
    /// The pair that explains a component.
    pub(super) fn fits(&self, place: Place) -> Option<Vec<Named>> {
        let mut found = self.found.iter();
        found
            .find(|entry| entry.0.contains(&place))
            .map(|entry| entry.1.clone())
    }
}

/// Two edits with the factors that fit best.
struct Pair<'e> {
    edits: [&'e Effect; 2],
    factors: [f64; 2],
}

/// Tries pairs of the best edits on all components that are wrong together.
pub(super) fn search(
    search: &mut Search<'_, '_>,
    quantity: usize,
    trial: &Trial,
    effects: &[Effect],
) -> Pairs {
    let target: Column = trial
        .wrong()
        .flat_map(|sample| difference(&sample.foreign, &sample.right))
        .collect();
    let mut best: Vec<(f64, &Effect)> = effects
        .iter()
        .filter(|effect| fit::norm(&effect.column) > 0.0)
        .filter(|effect| effect.column.iter().all(|value| value.is_finite()))
        .map(|effect| {
            (
                fit::least_squares(&[&effect.column], &target).residual,
                effect,
            )
        })
        .collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    best.truncate(BEST);
    let mut pairs = Pairs {
        count: 0,
        found: vec![],
    };
    for (place, (_, first)) in best.iter().enumerate() {
        for (_, second) in &best[..place] {
            pairs.count += 1;
            let Some(pair) = fitted([first, second], &target) else {
                continue;
            };
            if let Some(found) = confirmed(search, quantity, trial, &pair) {
                pairs.found.push(found);
                return pairs;
            }
        }
    }
    pairs
}

/// The factors of two edits, if they leave next to nothing.
fn fitted<'e>(edits: [&'e Effect; 2], target: &Column) -> Option<Pair<'e>> {
    let mut rest = target.clone();
    let mut columns = vec![];
    for effect in edits {
        if effect.is_free {
            columns.push(&effect.column);
        } else {
            rest = difference(&rest, &effect.column);
        }
    }
    let fitted = fit::least_squares(&columns, &rest);
    if fitted.residual > LEFT * fit::norm(target) {
        return None;
    }
    let mut factors = fitted.factors.into_iter();
    let factors = edits.map(|effect| match effect.is_free {
        true => factors.next().map_or(1.0, |change| simple(1.0 + change)),
        false => 1.0,
    });
    Some(Pair { edits, factors })
}

/// A pair that gives the values of components at all points: these, and what is said of it.
fn confirmed(
    search: &mut Search<'_, '_>,
    quantity: usize,
    trial: &Trial,
    pair: &Pair<'_>,
) -> Option<(Vec<Place>, Vec<Named>)> {
    let [first, second] = pair.edits.map(|effect| effect.candidate);
    let first_alteration = search.candidates[first].alteration.clone();
    let second_alteration = with_second_factor(&search.candidates[second].alteration);
    if are_nested(&first_alteration, &second_alteration) {
        return None;
    }
    let mut places = vec![];
    for sample in trial.wrong() {
        let place = Place {
            quantity,
            component: sample.component,
        };
        let component = &search.components[position(search.components, place)?];
        let alterations = [&first_alteration, &second_alteration];
        if !search.fits_everywhere(component, &alterations, pair.factors) {
            return None;
        }
        places.push(place);
    }
    let named = [(first, pair.factors[0]), (second, pair.factors[1])];
    let named = named.map(|(candidate, factor)| search.named(quantity, candidate, factor));
    Some((places, named.to_vec()))
}

/// Whether one edit replaces what the other changes.
fn are_nested(first: &Alteration, second: &Alteration) -> bool {
    let (Alteration::Rewrite(first), Alteration::Rewrite(second)) = (first, second) else {
        return false;
    };
    let is_above = |a: &Rewrite, b: &Rewrite| b.route.starts_with(&a.route);
    first.home == second.home && (is_above(first, second) || is_above(second, first))
}

fn with_second_factor(alteration: &Alteration) -> Alteration {
    let mut alteration = alteration.clone();
    if let Alteration::Rewrite(rewrite) = &mut alteration {
        rename(&mut rewrite.new);
    }
    alteration
}

fn rename(tree: &mut Tree) {
    if let Kind::Name(name) = &mut tree.kind
        && name == FACTORS[0]
    {
        FACTORS[1].clone_into(name);
    }
    for child in tree.children_mut() {
        rename(child);
    }
}
