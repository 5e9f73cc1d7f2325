//! All single edits of a file: what people do to an expression by mistake.

mod operators;
mod products;
mod trees;
mod walk;

use std::collections::BTreeMap;

use super::bench::{Alteration, FACTOR, Rewrite};
use super::site::{self, Home};
use crate::derive::{Basis, Part};
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::problem::{Problem, System, mentions};

use trees::{binary, name, times_factor};
pub(crate) use trees::{node, number};
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
pub(crate) struct Candidate {
    pub(crate) kind: EditKind,
    pub(crate) alteration: Alteration,
    /// What is said of it, if its trees do not say it.
    pub(crate) wording: Option<Wording>,
    /// How far it is from a top-level term.
    pub(crate) depth: usize,
    /// It is tried only if no other explains the values.
    pub(crate) is_rare: bool,
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

/// All candidates in the expressions that a quantity depends on.
pub(crate) fn all(problem: &Problem, part: Part, quantity: &str) -> Vec<Candidate> {
    let mut found = vec![];
    let of_time = of_time(problem);
    let all = expressions(problem, part);
    let own = all.iter().filter(|one| one.quantity == quantity);
    let own: Vec<&Whole<'_>> = own.collect();
    for Whole { home, tree, .. } in &own {
        let mut walk = Walk {
            problem,
            home,
            depth: 0,
            found: &mut found,
        };
        walk.all(tree);
        walk.without_time(tree, &of_time);
        if matches!(home, Home::Term { term: 0, .. } | Home::Datum { .. }) {
            walk.added(tree);
        }
    }
    for (name, depth) in distances(problem, own.iter().map(|one| one.tree).collect()) {
        for (part, expression) in site::parts(&problem.definitions[&name].value).enumerate() {
            let name = name.clone();
            let mut walk = Walk {
                problem,
                home: &Home::Definition { name, part },
                depth,
                found: &mut found,
            };
            walk.all(&expression.tree);
        }
    }
    found.extend(of_all(problem, part, &all, of_time));
    found.extend(of_parameters(problem));
    found
}

/// An expression of a quantity: a term, or a component of a datum.
struct Whole<'p> {
    quantity: &'p str,
    home: Home,
    tree: &'p Tree,
}

/// The terms of all equations, or the data of a face.
fn expressions(problem: &Problem, part: Part) -> Vec<Whole<'_>> {
    let mut all = vec![];
    if let Part::Face(face) = part {
        for (datum, entry) in problem.faces[face].data.iter().enumerate() {
            for (part, expression) in site::parts(&entry.value).enumerate() {
                all.push(Whole {
                    quantity: &entry.name,
                    home: Home::Datum { face, datum, part },
                    tree: &expression.tree,
                });
            }
        }
        return all;
    }
    for (equation, entry) in problem.equations.iter().enumerate() {
        for (term, of_term) in entry.terms.iter().enumerate() {
            all.push(Whole {
                quantity: &entry.name,
                home: Home::Term { equation, term },
                tree: &of_term.expression.tree,
            });
        }
    }
    all
}

/// Edits that are about all of each quantity, of which these are the expressions.
fn of_all(problem: &Problem, part: Part, all: &[Whole<'_>], of_time: Vec<Tree>) -> Vec<Candidate> {
    let mut found = vec![];
    let mut add = |kind: EditKind, alteration: Alteration, [old, new]: [&str; 2]| {
        found.push(Candidate {
            kind,
            alteration,
            wording: Some(Wording::Whole {
                old: old.to_owned(),
                new: new.to_owned(),
            }),
            depth: 0,
            is_rare: false,
        });
    };
    let everywhere = |edit: &dyn Fn(&Tree) -> Tree| {
        let rewrites = all.iter().map(|one| Rewrite {
            home: one.home.clone(),
            route: vec![],
            new: edit(one.tree),
        });
        Alteration::Rewrites(rewrites.collect())
    };
    if problem.system != System::Cartesian {
        let system = problem.system.name();
        for (basis, new) in [
            (Basis::Unturned, "without the derivatives of the basis"),
            (Basis::Flat, "cartesian"),
        ] {
            add(EditKind::Basis, Alteration::Basis(basis), [system, new]);
        }
    }
    if part != Part::Interior {
        add(EditKind::Normal, everywhere(&inwards), ["n", "-n"]);
    }
    for factor in of_time {
        let without = everywhere(&|whole| binary(Binary::Divide, whole, &factor));
        add(EditKind::TimeFactor, without, [&factor.to_string(), ""]);
    }
    if let (Some(time), Some(interval)) = (&problem.time, problem.intervals.last()) {
        for end in interval {
            let wording = [time.as_str(), &end.to_string()];
            add(EditKind::Time, Alteration::Time(*end), wording);
        }
    }
    for (second, new) in problem.coordinates.iter().enumerate() {
        for (first, old) in problem.coordinates[..second].iter().enumerate() {
            let exchange = Alteration::Exchange([first, second]);
            add(EditKind::Coordinates, exchange, [old, new]);
        }
    }
    found
}

/// Another value of each parameter.
fn of_parameters(problem: &Problem) -> Vec<Candidate> {
    let values = problem.parameter_values(&[]).unwrap_or_default();
    let candidates = values
        .into_iter()
        .enumerate()
        .map(|(place, value)| Candidate {
            kind: EditKind::Parameter,
            alteration: Alteration::Rewrites(vec![Rewrite {
                home: Home::Parameter(place),
                route: vec![],
                new: match value {
                    0.0 => name(FACTOR),
                    _ => times_factor(&problem.parameters[place].expression.tree),
                },
            }]),
            wording: None,
            depth: 0,
            is_rare: false,
        });
    candidates.collect()
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
fn distances<'p>(problem: &'p Problem, mut level: Vec<&'p Tree>) -> BTreeMap<String, usize> {
    let mut distances = BTreeMap::new();
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
