//! All single edits of a file: what people do to an expression by mistake.

mod operators;
mod products;
pub(crate) mod trees;
mod walk;

use std::collections::BTreeMap;

use super::bench::{Alteration, Rewrite};
use super::site;
use crate::derive::{Basis, Part};
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::problem::{Expression, Problem, System, mentions};

use trees::{binary, node};
use walk::Walk;

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
    /// A factor, or a divisor.
    LostFactor,
    /// A factor that changes with time alone is forgotten in a term.
    LostTime,
    /// The same in all of a quantity.
    TimeFactor,
    /// A product in place of a quotient, or the other way round.
    TimesForOver,
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
    /// An operator by its neighbour, `*` by `^`.
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
pub(crate) struct Candidate<'p> {
    pub(crate) kind: EditKind,
    pub(crate) alteration: Alteration<'p>,
    /// What is said of it, if its trees do not say it.
    pub(crate) wording: Option<Wording>,
    /// How far it is from a top-level term.
    pub(crate) depth: usize,
}

/// What an edit is in words.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Wording {
    /// What the other program has in place of a part.
    New(String),
    /// What the file and the other program have, in all of a quantity.
    Whole { old: String, new: String },
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

/// What an expression is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Home {
    /// A term of an equation.
    Term,
    /// A component of a datum of a face.
    Datum,
    /// A component of a definition.
    Definition,
}

/// All candidates in the expressions that a quantity depends on.
pub(crate) fn all<'p>(problem: &'p Problem, part: Part, quantity: &str) -> Vec<Candidate<'p>> {
    let mut found = vec![];
    let of_time = of_time(problem);
    let all = expressions(problem, part);
    let own = all.iter().filter(|one| one.quantity == quantity);
    let own: Vec<&Expression> = own.map(|one| one.expression).collect();
    let home = match part {
        Part::Face(_) => Home::Datum,
        _ => Home::Term,
    };
    let Some(first) = own.first() else {
        return found;
    };
    let mut walk = Walk {
        problem,
        home,
        within: first,
        depth: 0,
        found: &mut found,
    };
    for (place, within) in own.iter().enumerate() {
        walk.within = within;
        walk.all();
        walk.without_time(&of_time);
        if place == 0 || home == Home::Datum {
            walk.added();
        }
    }
    walk.home = Home::Definition;
    for (name, depth) in distances(problem, own) {
        walk.depth = depth;
        for within in problem.definitions[name].value.parts() {
            walk.within = within;
            walk.all();
        }
    }
    found.extend(of_all(problem, part, &all, of_time));
    let parameters = 0..problem.parameters.len();
    found.extend(parameters.map(|place| Candidate {
        kind: EditKind::Parameter,
        alteration: Alteration::Parameter(place),
        wording: None,
        depth: 0,
    }));
    found
}

/// An expression of a quantity: a term, or a component of a datum.
struct Whole<'p> {
    quantity: &'p str,
    expression: &'p Expression,
}

impl<'p> Whole<'p> {
    fn new(quantity: &'p str, expression: &'p Expression) -> Self {
        Self {
            quantity,
            expression,
        }
    }
}

/// The terms of all equations, or the data of a face.
fn expressions(problem: &Problem, part: Part) -> Vec<Whole<'_>> {
    let mut all = vec![];
    match part {
        Part::Face(face) => {
            for datum in &problem.faces[face].data {
                let parts = datum.value.parts().into_iter();
                all.extend(parts.map(|part| Whole::new(&datum.name, part)));
            }
        }
        _ => {
            for equation in &problem.equations {
                let terms = equation.terms.iter();
                all.extend(terms.map(|term| Whole::new(&equation.name, &term.expression)));
            }
        }
    }
    all
}

/// Edits that are about all of each quantity, of which these are the expressions.
fn of_all<'p>(
    problem: &'p Problem,
    part: Part,
    all: &[Whole<'p>],
    of_time: Vec<Tree>,
) -> Vec<Candidate<'p>> {
    let mut found = vec![];
    let everywhere = |edit: &dyn Fn(&Tree) -> Tree| {
        let rewrites = all.iter().map(|one| Rewrite {
            within: one.expression,
            route: vec![],
            new: edit(&one.expression.tree),
        });
        Alteration::Rewrites(rewrites.collect())
    };
    if problem.system != System::Cartesian {
        let system = problem.system.name();
        for (basis, new) in [
            (Basis::Unturned, "without the derivatives of the basis"),
            (Basis::Flat, "cartesian"),
        ] {
            let alteration = Alteration::Basis(basis);
            found.push(of_whole(EditKind::Basis, alteration, [system, new]));
        }
    }
    if part != Part::Interior {
        let inwards = everywhere(&inwards);
        found.push(of_whole(EditKind::Normal, inwards, ["n", "-n"]));
    }
    for factor in of_time {
        let without = everywhere(&|whole| binary(Binary::Divide, whole, &factor));
        let wording = [&factor.to_string(), ""];
        found.push(of_whole(EditKind::TimeFactor, without, wording));
    }
    if let (Some(time), Some(interval)) = (&problem.time, problem.intervals.last()) {
        for end in interval {
            let wording = [time.as_str(), &end.to_string()];
            found.push(of_whole(EditKind::Time, Alteration::Time(*end), wording));
        }
    }
    for (second, new) in problem.coordinates.iter().enumerate() {
        for (first, old) in problem.coordinates[..second].iter().enumerate() {
            let exchange = Alteration::Exchange([first, second]);
            found.push(of_whole(EditKind::Coordinates, exchange, [old, new]));
        }
    }
    found
}

/// A candidate that changes the problem as a whole, from the old words to the new.
fn of_whole<'p>(
    kind: EditKind,
    alteration: Alteration<'p>,
    [old, new]: [&str; 2],
) -> Candidate<'p> {
    Candidate {
        kind,
        alteration,
        wording: Some(Wording::Whole {
            old: old.to_owned(),
            new: new.to_owned(),
        }),
        depth: 0,
    }
}

/// A datum with the normal reversed.
fn inwards(tree: &Tree) -> Tree {
    let mut tree = tree.clone();
    if matches!(&tree.kind, TreeKind::Name(name) if name == "n") {
        return node(TreeKind::Negate(Box::new(tree)));
    }
    for child in tree.children_mut() {
        *child = inwards(child);
    }
    tree
}

/// The factors of the solution and of definitions that change with time alone.
fn of_time(problem: &Problem) -> Vec<Tree> {
    let mut found = vec![];
    for definition in problem.definitions.values() {
        for part in definition.value.parts() {
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
fn distances<'p>(problem: &'p Problem, mut level: Vec<&'p Expression>) -> BTreeMap<&'p str, usize> {
    let mut distances = BTreeMap::new();
    for distance in 1.. {
        let mut next = vec![];
        for (name, definition) in &problem.definitions {
            let is_named = level.iter().any(|part| mentions(&part.tree, name));
            if is_named && !distances.contains_key(name.as_str()) {
                let exact = if definition.is_exact { EXACT } else { 0 };
                distances.insert(name.as_str(), DEFINITION * distance + exact);
                next.extend(definition.value.parts());
            }
        }
        if next.is_empty() {
            break;
        }
        level = next;
    }
    distances
}
