//! All single edits of a file: what people do to an expression by mistake.

mod operators;
mod products;
mod trees;
mod walk;

use std::collections::BTreeMap;

use super::bench::{Alteration, FACTOR, Rewrite};
use super::site::{self, Home};
use crate::derive::{Basis, Part};
use crate::language::tree::{Tree, TreeKind};
use crate::problem::{Problem, System, mentions};

pub(crate) use trees::number;
use trees::{name, times_factor};
use walk::{Role, Walk};

/// What an edit does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EditKind {
    /// An unknown factor at a whole term of an equation, or at a whole datum.
    Term,
    /// An unknown factor at a summand.
    Summand,
    /// An unknown factor at another part that is not a factor of a product.
    Part,
    /// An unknown factor at an exponent.
    Exponent,
    LostFactor,
    LostDivisor,
    /// A factor that changes with time alone is forgotten in a term.
    LostTime,
    /// The same in all of a quantity.
    TimeFactor,
    /// A product in place of a quotient, or the other way round.
    TimesForOver,
    /// `*` in place of `^`, or the other way round.
    Typed,
    /// A square in place of a number.
    Square,
    /// The argument in place of a function or an operator of it.
    LostOperator,
    /// A function by its neighbour.
    Function,
    TransposedGradient,
    MissingTranspose,
    /// The other order of two operands, or of two indices.
    Order,
    /// An operator by its neighbour.
    Operator,
    /// A part is a constant for the derivatives that act on it.
    Held,
    /// Only one factor of a product is differentiated.
    OneDifferentiated,
    /// A factor before a derivative is taken below it.
    TakenBelow,
    /// Derivatives as in Cartesian coordinates.
    Basis,
    /// A derivative by another variable, or by one fewer.
    Derivative,
    /// A component by another.
    Index,
    /// One of the values of a choice at all points.
    Branch,
    /// The factor before a bracket, or the divisor behind it, reaches one summand only.
    LostBracket,
    /// A name by another of its kind.
    Name,
    /// Another summand, with an unknown factor.
    Added,
    /// Two parameters exchanged in an expression.
    Parameters,
    /// The normal of a face points inwards.
    Normal,
    /// A parameter times an unknown factor; one that is zero by an unknown number.
    Parameter,
    /// The values of one time at all times.
    Time,
    /// Two coordinates exchanged.
    Coordinates,
}

/// An edit that is tried.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) change: EditKind,
    pub(crate) alteration: Alteration,
    /// How far it is from a top-level term.
    pub(crate) depth: usize,
    /// It is tried only if no other explains the values.
    pub(crate) is_rare: bool,
}

impl EditKind {
    /// Whether a number belongs to it.
    pub(crate) fn has_factor(self) -> bool {
        use EditKind::{Added, Exponent, Parameter, Part, Summand, Term};
        matches!(self, Term | Summand | Part | Exponent | Added | Parameter)
    }
}

/// A definition is so much further from a term than what names it.
const DEFINITION: usize = 20;

/// The solution is further from all terms than any definition.
const EXACT: usize = 1000;

/// All candidates in the expressions that a quantity depends on.
pub(crate) fn all(problem: &Problem, part: Part, quantity: &str) -> Vec<Candidate> {
    let mut found = vec![];
    for (home, distance) in homes(problem, part, quantity) {
        let Some(expression) = home.expression(problem) else {
            continue;
        };
        let mut walk = Walk {
            problem,
            home: &home,
            depth: distance,
            found: &mut found,
        };
        walk.visit(&expression.tree, &mut vec![], Role::Root);
        walk.exchanges(&expression.tree);
        if !matches!(home, Home::Definition { .. }) {
            walk.without_time(&expression.tree, &of_time(problem));
        }
        if matches!(home, Home::Term { term: 0, .. } | Home::Datum { .. }) {
            walk.added(&expression.tree);
        }
    }
    found.extend(of_all(problem, part));
    found
}

/// The terms of an equation or the data of a face, and the definitions that they need: how far each
/// is from a term.
fn homes(problem: &Problem, part: Part, quantity: &str) -> Vec<(Home, usize)> {
    let mut homes = vec![];
    if let Part::Face(face) = part {
        let mut data = problem.faces[face].data.iter().enumerate();
        if let Some((datum, entry)) = data.find(|entry| entry.1.name == quantity) {
            let parts = site::parts(&entry.value).enumerate();
            homes.extend(parts.map(|(part, _)| (Home::Datum { face, datum, part }, 0)));
        }
    } else {
        let mut equations = problem.equations.iter().enumerate();
        if let Some((equation, entry)) = equations.find(|entry| entry.1.name == quantity) {
            let terms = 0..entry.terms.len();
            homes.extend(terms.map(|term| (Home::Term { equation, term }, 0)));
        }
    }
    let distances = distances(problem, &homes);
    for (name, distance) in distances {
        let parts = site::parts(&problem.definitions[&name].value).enumerate();
        homes.extend(parts.map(|(part, _)| {
            let name = name.clone();
            (Home::Definition { name, part }, distance)
        }));
    }
    homes
}

/// Edits that are about all of a quantity.
fn of_all(problem: &Problem, part: Part) -> Vec<Candidate> {
    let mut found = vec![];
    let mut add = |change: EditKind, alteration: Alteration| {
        found.push(Candidate {
            change,
            alteration,
            depth: 0,
            is_rare: false,
        });
    };
    if problem.system != System::Cartesian {
        for basis in [Basis::Unturned, Basis::Flat] {
            add(EditKind::Basis, Alteration::Basis(basis));
        }
    }
    if part != Part::Interior {
        add(EditKind::Normal, Alteration::Normal);
    }
    for tree in of_time(problem) {
        add(EditKind::TimeFactor, Alteration::Over(tree));
    }
    if problem.time.is_some() {
        for end in problem.intervals.last().into_iter().flatten() {
            add(EditKind::Time, Alteration::Time(*end));
        }
    }
    for second in 1..problem.coordinates.len() {
        for first in 0..second {
            add(EditKind::Coordinates, Alteration::Exchange([first, second]));
        }
    }
    let values = problem.parameter_values(&[]).unwrap_or_default();
    for (parameter, value) in values.into_iter().enumerate() {
        let rewrite = Rewrite {
            home: Home::Parameter(parameter),
            route: vec![],
            new: match value {
                0.0 => name(FACTOR),
                _ => times_factor(&problem.parameters[parameter].expression.tree),
            },
        };
        add(EditKind::Parameter, Alteration::Rewrite(rewrite));
    }
    found
}

/// The factors of the solution and of definitions that change with time alone.
fn of_time(problem: &Problem) -> Vec<Tree> {
    let mut found = vec![];
    for definition in problem.definitions.values() {
        for part in site::parts(&definition.value) {
            gather_of_time(problem, &part.tree, &mut found);
        }
    }
    found
}

fn gather_of_time(problem: &Problem, tree: &Tree, found: &mut Vec<Tree>) {
    let mut names = vec![];
    site::names(tree, &mut names);
    let variables = problem.variables();
    let is_time = |name: &&str| Some(*name) == problem.time.as_deref();
    let is_constant = |name: &&str| {
        let is_known = problem.definitions.contains_key(*name);
        !is_known && !variables.contains(name)
    };
    let is_factor = !matches!(
        tree.kind,
        TreeKind::Name(_) | TreeKind::Negate(_) | TreeKind::Binary(..)
    );
    let has_time = names.iter().any(is_time);
    if is_factor && has_time && names.iter().all(|name| is_time(name) || is_constant(name)) {
        if !found
            .iter()
            .any(|known| known.to_string() == tree.to_string())
        {
            found.push(tree.clone());
        }
        return;
    }
    for child in tree.children() {
        gather_of_time(problem, child, found);
    }
}

/// How far each definition that these expressions need is from them.
fn distances(problem: &Problem, homes: &[(Home, usize)]) -> BTreeMap<String, usize> {
    let mut distances = BTreeMap::new();
    let homes = homes.iter();
    let mut level: Vec<&Tree> = homes
        .filter_map(|(home, _)| home.expression(problem))
        .map(|expression| &expression.tree)
        .collect();
    for distance in 1.. {
        let mut next = vec![];
        for (name, definition) in &problem.definitions {
            let is_named = level.iter().any(|tree| mentions(tree, name));
            if is_named && !distances.contains_key(name) {
                let exact = if definition.is_exact { EXACT } else { 0 };
                distances.insert(name.clone(), DEFINITION * distance + exact);
                next.extend(site::parts(&definition.value).map(|part| &part.tree));
            }
        }
        if next.is_empty() {
            break;
        }
        level = next;
    }
    distances
}
