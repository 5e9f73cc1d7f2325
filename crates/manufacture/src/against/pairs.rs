//! Pairs of edits that are made together.

use super::bench::{Alteration, FACTORS, Rewrite};
use super::cause::Named;
use super::right::ComponentPlace;
use super::search::{EditSearch, position};
use super::site;
use super::solve::{difference, simple};
use super::trial::{Effect, Trial};
use crate::fit::{self, Column};
use crate::language::tree::{Tree, TreeKind};
use crate::problem::Problem;

/// The best edits, which are tried together with all others.
const BEST: usize = 60;

/// Pairs that are held against all points.
const MOST_CONFIRMED: usize = 20;

/// What a pair may leave of the difference, before it is held against all points.
const LEFT: f64 = 1e-7;

/// The pairs that were tried, and the first that fits.
pub(super) struct Pairs {
    pub(super) count: usize,
    found: Vec<(Vec<ComponentPlace>, Vec<Named>)>,
}

impl Pairs {
    /// The pair that explains a component.
    pub(super) fn fits(&self, place: ComponentPlace) -> Option<Vec<Named>> {
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
    search: &mut EditSearch<'_, '_>,
    quantity: usize,
    trial: &Trial,
    effects: &[Effect],
) -> Pairs {
    let target: Column = trial
        .wrong()
        .flat_map(|sample| difference(&sample.foreign, &sample.right))
        .collect();
    let effects: Vec<&Effect> = effects
        .iter()
        .filter(|effect| fit::norm(&effect.column) > 0.0)
        .filter(|effect| effect.column.iter().all(|value| value.is_finite()))
        .collect();
    let mut pairs = Pairs {
        count: 0,
        found: vec![],
    };
    let mut fitting = vec![];
    for first in best(&effects, &target, search) {
        let rest = Rest::new(first, &target);
        for second in &effects {
            pairs.count += 1;
            if first.candidate == second.candidate || !rest.may_be_left_by(second) {
                continue;
            }
            fitting.extend(fitted([first, second], &target));
        }
    }
    fitting.sort_by_key(|pair| {
        let both =
            [0, 1].map(|place| search.size(pair.edits[place].candidate, pair.factors[place]));
        (both[0].0 + both[1].0, both[0].1 + both[1].1)
    });
    let mut confirmed = fitting
        .iter()
        .take(MOST_CONFIRMED)
        .filter_map(|pair| confirmed(search, quantity, trial, pair));
    pairs.found.extend(confirmed.next());
    pairs
}

/// The edits that leave least, of those with the same effect one.
fn best<'e>(
    effects: &[&'e Effect],
    target: &Column,
    search: &EditSearch<'_, '_>,
) -> Vec<&'e Effect> {
    let mut left: Vec<(f64, &Effect)> = effects
        .iter()
        .map(|effect| (Rest::new(effect, target).length, *effect))
        .collect();
    left.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Vec<(f64, &Effect)> = vec![];
    for (length, effect) in left {
        let size = |effect: &Effect| search.size(effect.candidate, 1.0);
        match best.last_mut() {
            Some(last) if (length - last.0).abs() <= 1e-9 * last.0 => {
                if size(effect) < size(last.1) {
                    last.1 = effect;
                }
            }
            _ => best.push((length, effect)),
        }
    }
    best.iter().take(BEST).map(|entry| entry.1).collect()
}

/// What an edit leaves of the difference.
struct Rest {
    column: Column,
    length: f64,
    /// The effect of the edit with the length 1, if its factor is free.
    direction: Option<Column>,
    whole: f64,
}

impl Rest {
    fn new(effect: &Effect, target: &Column) -> Self {
        let length = fit::norm(&effect.column);
        let direction: Column = effect.column.iter().map(|value| value / length).collect();
        let column = match effect.is_free {
            true => without(target, &direction),
            false => difference(target, &effect.column),
        };
        Self {
            length: fit::norm(&column),
            direction: effect.is_free.then_some(direction),
            whole: fit::norm(target),
            column,
        }
    }

    /// Whether another edit may leave next to nothing of the rest, but for rounding.
    fn may_be_left_by(&self, effect: &Effect) -> bool {
        const ROUNDING: f64 = 1e-6;
        let column = match &self.direction {
            Some(direction) => without(&effect.column, direction),
            None => effect.column.clone(),
        };
        let left = match effect.is_free {
            true => {
                let length = fit::norm(&column);
                let direction: Column = column.iter().map(|value| value / length).collect();
                fit::norm(&without(&self.column, &direction))
            }
            false => fit::norm(&difference(&self.column, &column)),
        };
        left <= ROUNDING * self.whole
    }
}

/// A column without its part along a direction of length 1.
fn without(column: &[f64], direction: &[f64]) -> Column {
    let part: f64 = column.iter().zip(direction).map(|(a, b)| a * b).sum();
    let pairs = column.iter().zip(direction);
    pairs.map(|(value, along)| value - part * along).collect()
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
    search: &mut EditSearch<'_, '_>,
    quantity: usize,
    trial: &Trial,
    pair: &Pair<'_>,
) -> Option<(Vec<ComponentPlace>, Vec<Named>)> {
    let [first, second] = pair.edits.map(|effect| effect.candidate);
    let first_alteration = search.candidates[first].alteration.clone();
    let second_alteration = with_second_factor(&search.candidates[second].alteration);
    let problem = &search.right.model.problem;
    let both = together(problem, [&first_alteration, &second_alteration])?;
    let alterations: Vec<&Alteration> = both.alterations.iter().collect();
    let mut factors = pair.factors;
    if let Some(inner) = both.inner
        && pair.edits.iter().all(|effect| effect.is_free)
    {
        // Outside a (A + b B) the effects are a - 1 of A + B, and a b - a of B.
        let outer = factors[1 - inner];
        factors[inner] = simple((outer + factors[inner] - 1.0) / outer);
    }
    let mut places = vec![];
    for sample in trial.wrong() {
        let place = ComponentPlace {
            quantity,
            component: sample.component,
        };
        let component = &search.components[position(search.components, place)?];
        if !search.fits_everywhere(component, &alterations, factors) {
            return None;
        }
        places.push(place);
    }
    let named = [(first, factors[0]), (second, factors[1])];
    let named = named.map(|(candidate, factor)| search.named(quantity, candidate, factor));
    Some((places, named.to_vec()))
}

/// Two edits at once.
struct Together {
    /// One, if one of the edits is made inside what the other replaces.
    alterations: Vec<Alteration>,
    /// Which of the edits is inside the other.
    inner: Option<usize>,
}

/// Two edits at once; `None` if one drops what the other changes.
fn together(problem: &Problem, edits: [&Alteration; 2]) -> Option<Together> {
    let apart = || Together {
        alterations: edits.map(Clone::clone).to_vec(),
        inner: None,
    };
    let [Alteration::Rewrite(first), Alteration::Rewrite(second)] = edits else {
        return Some(apart());
    };
    let place = if is_above(first, second) {
        1
    } else if is_above(second, first) {
        0
    } else {
        return Some(apart());
    };
    let [outer, inner] = if place == 1 {
        [first, second]
    } else {
        [second, first]
    };
    let tree = &inner.home.expression(problem)?.tree;
    let old = site::at(tree, &inner.route)?;
    let mut new = outer.new.clone();
    let is_replaced = replace(&mut new, old, &inner.new);
    is_replaced.then(|| Together {
        alterations: vec![Alteration::Rewrite(Rewrite {
            new,
            ..outer.clone()
        })],
        inner: Some(place),
    })
}

/// Whether the first edit replaces a tree in which the second is made.
fn is_above(first: &Rewrite, second: &Rewrite) -> bool {
    first.home == second.home && second.route.starts_with(&first.route)
}

/// Replaces a part, which its place in the text tells from others; whether there is one.
fn replace(tree: &mut Tree, old: &Tree, new: &Tree) -> bool {
    if tree == old {
        *tree = new.clone();
        return true;
    }
    let mut is_replaced = false;
    for child in tree.children_mut() {
        is_replaced |= replace(child, old, new);
    }
    is_replaced
}

fn with_second_factor(alteration: &Alteration) -> Alteration {
    let mut alteration = alteration.clone();
    if let Alteration::Rewrite(rewrite) = &mut alteration {
        rename(&mut rewrite.new);
    }
    alteration
}

fn rename(tree: &mut Tree) {
    if let TreeKind::Name(name) = &mut tree.kind
        && name == FACTORS[0]
    {
        FACTORS[1].clone_into(name);
    }
    for child in tree.children_mut() {
        rename(child);
    }
}
