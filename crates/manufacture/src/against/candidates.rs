//! All single edits of a file: what people do to an expression by mistake.

use std::collections::HashMap;

use super::bench::{Alteration, FACTORS, Rewrite};
use super::site::{self, Home, Route};
use crate::derive::{Basis, Part};
use crate::language::names::{self, Callee, Function, Operator, Piecewise};
use crate::language::tree::{Binary, Kind, Tree};
use crate::problem::{Problem, System, mentions};

/// What an edit does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
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
    /// Two definitions exchanged.
    Exchange,
    /// Two parameters exchanged.
    Parameters,
    /// The normal of a face points inwards.
    Normal,
}

/// An edit that is tried.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) change: Change,
    pub(crate) alteration: Alteration,
    /// How far it is from a top-level term.
    pub(crate) depth: usize,
    /// It is tried only if no other explains the values.
    pub(crate) is_rare: bool,
}

impl Change {
    /// Whether a number belongs to it.
    pub(crate) fn has_factor(self) -> bool {
        use Change::{Added, Exponent, Part, Summand, Term};
        matches!(self, Term | Summand | Part | Exponent | Added)
    }
}

impl Candidate {
    pub(crate) fn has_factor(&self) -> bool {
        self.change.has_factor()
    }
}

/// How a part stands in the expression around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Root,
    Summand,
    /// A factor of a product, or below a fraction line: one of them stands for all.
    Factor,
    Exponent,
    /// What is around it is linear in it.
    Linear,
    Argument,
    /// A coordinate, or an index.
    Mark,
}

/// A definition is so much further from a term than what names it.
const DEFINITION: usize = 20;

/// The solution is further from all terms than any definition.
const EXACT: usize = 1000;

struct Walk<'c> {
    problem: &'c Problem,
    /// Definitions of one shape, pair by pair.
    alike: &'c [[String; 2]],
    home: &'c Home,
    /// How far the expression is from a top-level term.
    depth: usize,
    found: &'c mut Vec<Candidate>,
}

/// All candidates in the expressions that a comparison is about.
///
/// * `alike`: definitions of one shape, pair by pair.
pub(crate) fn all(problem: &Problem, part: Part, alike: &[[String; 2]]) -> Vec<Candidate> {
    let mut found = vec![];
    let mut homes = vec![];
    for (name, definition) in &problem.definitions {
        let parts = site::parts(&definition.value);
        homes.extend(parts.enumerate().map(|(part, _)| Home::Definition {
            name: name.clone(),
            part,
        }));
    }
    if let Part::Face(face) = part {
        for (datum, entry) in problem.faces[face].data.iter().enumerate() {
            let parts = site::parts(&entry.value).enumerate();
            homes.extend(parts.map(|(part, _)| Home::Datum { face, datum, part }));
        }
    } else {
        for (equation, entry) in problem.equations.iter().enumerate() {
            let terms = 0..entry.terms.len();
            homes.extend(terms.map(|term| Home::Term { equation, term }));
        }
    }
    let distances = distances(problem, &homes);
    for home in &homes {
        let Some(expression) = home.expression(problem) else {
            continue;
        };
        let distance = match home {
            // What no term needs cannot be wrong.
            Home::Definition { name, .. } => match distances.get(name) {
                Some(distance) => *distance,
                None => continue,
            },
            _ => 0,
        };
        let mut walk = Walk {
            problem,
            alike,
            home,
            depth: distance,
            found: &mut found,
        };
        walk.visit(&expression.tree, &mut vec![], Role::Root);
        walk.exchanges(&expression.tree);
        if matches!(home, Home::Term { term: 0, .. } | Home::Datum { .. }) {
            walk.added(&expression.tree);
        }
    }
    if problem.system != System::Cartesian {
        for basis in [Basis::Unturned, Basis::Flat] {
            found.push(Candidate {
                change: Change::Basis,
                alteration: Alteration::Basis(basis),
                depth: 0,
                is_rare: false,
            });
        }
    }
    if part != Part::Interior {
        found.push(Candidate {
            change: Change::Normal,
            alteration: Alteration::Normal,
            depth: 0,
            is_rare: false,
        });
    }
    for names in alike {
        found.push(Candidate {
            change: Change::Exchange,
            alteration: Alteration::Exchange(names.clone()),
            depth: 0,
            is_rare: true,
        });
    }
    found
}

/// A factor at the term with a label.
pub(crate) fn of_term(problem: &Problem, equation: &str, label: &str) -> Option<Candidate> {
    let mut equations = problem.equations.iter();
    let equation = equations.position(|entry| entry.name == equation)?;
    let mut terms = problem.equations[equation].terms.iter();
    let term = terms.position(|term| term.label == label)?;
    let home = Home::Term { equation, term };
    let new = times_factor(&home.expression(problem)?.tree);
    Some(Candidate {
        change: Change::Term,
        alteration: Alteration::Rewrite(Rewrite {
            home,
            route: vec![],
            new,
        }),
        depth: 0,
        is_rare: false,
    })
}

/// How far each definition is from a term, or from a datum.
fn distances(problem: &Problem, homes: &[Home]) -> HashMap<String, usize> {
    let mut distances = HashMap::new();
    let tops = homes
        .iter()
        .filter(|home| !matches!(home, Home::Definition { .. }));
    let mut level: Vec<&Tree> = tops
        .filter_map(|home| home.expression(problem))
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

/// The roles of the parts directly below.
fn roles(tree: &Tree) -> Vec<Role> {
    match &tree.kind {
        Kind::Number(..) | Kind::Name(_) => vec![],
        Kind::Negate(_) | Kind::Bracket(_) => vec![Role::Linear],
        Kind::Binary(operator, _) => match operator {
            Binary::Add | Binary::Subtract => vec![Role::Summand; 2],
            Binary::Multiply | Binary::Divide => vec![Role::Factor; 2],
            Binary::Power => vec![Role::Argument, Role::Exponent],
        },
        Kind::Call(callee, parts) => match callee {
            Callee::Operator(Operator::Derivative | Operator::Integral) => {
                let marks = std::iter::repeat_n(Role::Mark, parts.len() - 1);
                std::iter::once(Role::Linear).chain(marks).collect()
            }
            Callee::Operator(
                Operator::Dot | Operator::Inner | Operator::Outer | Operator::Cross,
            ) => vec![Role::Factor; 2],
            Callee::Operator(Operator::Determinant) => vec![Role::Argument],
            Callee::Operator(_) => vec![Role::Linear; parts.len()],
            Callee::Function(_) | Callee::Piecewise(_) => vec![Role::Argument; parts.len()],
        },
        Kind::Compare(..) => vec![Role::Argument; 2],
        Kind::List(parts) => vec![Role::Argument; parts.len()],
        Kind::Index(_, indices) => {
            let marks = std::iter::repeat_n(Role::Mark, indices.len());
            std::iter::once(Role::Linear).chain(marks).collect()
        }
    }
}

fn node(kind: Kind) -> Tree {
    Tree { kind, at: 0 }
}

fn name(name: &str) -> Tree {
    node(Kind::Name(name.to_owned()))
}

pub(crate) fn number(text: &str, value: f64) -> Tree {
    node(Kind::Number(value, text.to_owned()))
}

fn binary(operator: Binary, left: &Tree, right: &Tree) -> Tree {
    node(Kind::Binary(
        operator,
        Box::new([left.clone(), right.clone()]),
    ))
}

fn operator(operator: Operator, parts: &[&Tree]) -> Tree {
    let parts = parts.iter().map(|part| (*part).clone()).collect();
    node(Kind::Call(Callee::Operator(operator), parts))
}

pub(crate) fn held(tree: &Tree) -> Tree {
    operator(Operator::Altered(names::Alteration::Held), &[tree])
}

/// A part times an unknown factor.
pub(crate) fn times_factor(tree: &Tree) -> Tree {
    binary(Binary::Multiply, tree, &name(FACTORS[0]))
}

/// Whether brackets around it change nothing.
fn is_chain(tree: &Tree) -> bool {
    matches!(
        tree.kind,
        Kind::Binary(Binary::Multiply | Binary::Divide, _)
    )
}

impl Walk<'_> {
    fn add(&mut self, change: Change, route: &Route, new: Tree) {
        self.found.push(Candidate {
            change,
            alteration: Alteration::Rewrite(Rewrite {
                home: self.home.clone(),
                route: route.clone(),
                new,
            }),
            depth: self.depth + route.len(),
            is_rare: false,
        });
    }

    /// An edit that is tried only if others do not explain the values.
    fn add_rare(&mut self, change: Change, route: &Route, new: Tree) {
        self.add(change, route, new);
        if let Some(last) = self.found.last_mut() {
            last.is_rare = true;
        }
    }

    fn visit(&mut self, tree: &Tree, route: &mut Route, role: Role) {
        if role == Role::Mark {
            return;
        }
        self.factor(tree, route, role);
        if role == Role::Factor && !matches!(tree.kind, Kind::Number(..) | Kind::Negate(_)) {
            self.add(Change::Held, route, held(tree));
        }
        if role == Role::Root && matches!(self.home, Home::Definition { .. }) {
            self.add(Change::Held, route, held(tree));
        }
        if is_chain(tree) && role != Role::Factor {
            self.chain(tree, route);
        }
        match &tree.kind {
            Kind::Binary(operator, operands) => self.binary(*operator, operands, route),
            Kind::Call(callee, parts) => self.call(*callee, parts, route),
            Kind::Name(named) => {
                if role == Role::Factor {
                    let two = number("2", 2.0);
                    self.add(Change::Square, route, binary(Binary::Power, tree, &two));
                }
                for other in self.others(named) {
                    self.add_rare(Change::Name, route, name(&other));
                }
            }
            Kind::Index(of, indices) => self.index(of, indices, route),
            _ => (),
        }
        let is_signed_factor = role == Role::Factor && matches!(tree.kind, Kind::Negate(_));
        for (place, (child, role)) in tree.children().into_iter().zip(roles(tree)).enumerate() {
            let role = if is_signed_factor { Role::Factor } else { role };
            route.push(place);
            self.visit(child, route, role);
            route.pop();
        }
    }

    /// Names of the same kind: variables, parameters, definitions of the same shape.
    fn others(&self, named: &str) -> Vec<String> {
        let parameters = self.problem.parameters.iter();
        let parameters: Vec<&str> = parameters.map(|p| p.name.as_str()).collect();
        for kind in [self.problem.variables(), parameters] {
            if kind.contains(&named) {
                let others = kind.into_iter().filter(|other| *other != named);
                return others.map(str::to_owned).collect();
            }
        }
        let pairs = self.alike.iter();
        pairs
            .filter_map(|[first, second]| match [first == named, second == named] {
                [true, _] => Some(second.clone()),
                [_, true] => Some(first.clone()),
                _ => None,
            })
            .collect()
    }

    /// Two names of one kind exchanged in all of an expression.
    fn exchanges(&mut self, tree: &Tree) {
        let mut names = vec![];
        site::names(tree, &mut names);
        names.sort_unstable();
        names.dedup();
        for (place, first) in names.iter().enumerate() {
            for second in self.others(first) {
                if names[place..].contains(&second.as_str()) {
                    let mut new = tree.clone();
                    exchange(&mut new, first, &second);
                    let mut parameters = self.problem.parameters.iter();
                    let change = match parameters.any(|parameter| parameter.name == **first) {
                        true => Change::Parameters,
                        false => Change::Exchange,
                    };
                    self.add_rare(change, &vec![], new);
                }
            }
        }
    }

    /// A field, or another definition, as another summand.
    fn added(&mut self, tree: &Tree) {
        let names: Vec<String> = self.problem.definitions.keys().cloned().collect();
        for named in names {
            let summand = times_factor(&name(&named));
            let sum = binary(Binary::Add, tree, &summand);
            self.add_rare(Change::Added, &vec![], sum);
        }
    }

    /// Another component.
    fn index(&mut self, of: &Tree, indices: &[Tree], route: &Route) {
        let indexed = |indices: Vec<Tree>| node(Kind::Index(Box::new(of.clone()), indices));
        if let [first, second] = indices {
            let swapped = indexed(vec![second.clone(), first.clone()]);
            self.add(Change::Index, route, swapped);
        }
        for (place, index) in indices.iter().enumerate() {
            let others: Vec<Tree> = match index.kind {
                Kind::Number(..) => (1..=3)
                    .map(|other| number(&other.to_string(), f64::from(other)))
                    .collect(),
                _ => self.problem.axes().iter().map(|axis| name(axis)).collect(),
            };
            for other in others.into_iter().filter(|other| other.kind != index.kind) {
                let mut indices = indices.to_vec();
                indices[place] = other;
                self.add_rare(Change::Index, route, indexed(indices));
            }
        }
    }

    /// An unknown factor, where it is not that of another part as well.
    fn factor(&mut self, tree: &Tree, route: &Route, role: Role) {
        let change = match role {
            Role::Root if matches!(self.home, Home::Term { .. }) => Change::Term,
            Role::Root | Role::Argument => Change::Part,
            Role::Summand => Change::Summand,
            Role::Exponent => Change::Exponent,
            Role::Factor | Role::Linear | Role::Mark => return,
        };
        let is_sum = matches!(tree.kind, Kind::Binary(Binary::Add | Binary::Subtract, _));
        if is_sum && role == Role::Summand {
            return;
        }
        if !matches!(tree.kind, Kind::Compare(..) | Kind::List(_)) {
            self.add(change, route, times_factor(tree));
        }
    }

    fn binary(&mut self, operator: Binary, operands: &[Tree; 2], route: &Route) {
        let [left, right] = operands;
        match operator {
            Binary::Multiply => {
                self.add(Change::LostFactor, route, left.clone());
                self.add(
                    Change::TimesForOver,
                    route,
                    binary(Binary::Divide, left, right),
                );
                self.brackets(operator, operands, route);
                if !is_chain(left) {
                    self.add(Change::LostFactor, route, right.clone());
                }
            }
            Binary::Divide => {
                self.add(Change::LostDivisor, route, left.clone());
                self.brackets(operator, operands, route);
                let product = binary(Binary::Multiply, left, right);
                self.add(Change::TimesForOver, route, product);
                if !is_chain(left) && !matches!(left.kind, Kind::Number(..)) {
                    let inverse = binary(Binary::Divide, &number("1", 1.0), right);
                    self.add(Change::LostFactor, route, inverse);
                }
            }
            _ => (),
        }
    }

    /// `a*b + c` for `a*(b + c)`, `a + b/c` for `(a + b)/c`.
    fn brackets(&mut self, of: Binary, [left, right]: &[Tree; 2], route: &Route) {
        let sum = |tree: &Tree| match &tree.kind {
            Kind::Bracket(inner) => match &inner.kind {
                Kind::Binary(sign @ (Binary::Add | Binary::Subtract), parts) => {
                    Some((*sign, (**parts).clone()))
                }
                _ => None,
            },
            _ => None,
        };
        let bracket = |tree: Tree| node(Kind::Bracket(Box::new(tree)));
        if let Some((sign, [first, last])) = sum(left) {
            let last = binary(of, &last, right);
            self.add(
                Change::LostBracket,
                route,
                bracket(binary(sign, &first, &last)),
            );
        }
        if let (Binary::Multiply, Some((sign, [first, last]))) = (of, sum(right)) {
            let first = binary(of, left, &first);
            self.add(
                Change::LostBracket,
                route,
                bracket(binary(sign, &first, &last)),
            );
        }
    }

    fn call(&mut self, callee: Callee, parts: &[Tree], route: &Route) {
        let call = |callee: Callee| node(Kind::Call(callee, parts.to_vec()));
        match callee {
            Callee::Function(function) => {
                self.add(Change::LostOperator, route, parts[0].clone());
                if let Some(other) = neighbour(function) {
                    self.add(Change::Function, route, call(Callee::Function(other)));
                }
            }
            Callee::Piecewise(function) => {
                let other = match function {
                    Piecewise::Min => Some(Piecewise::Max),
                    Piecewise::Max => Some(Piecewise::Min),
                    _ => None,
                };
                if let Some(other) = other {
                    self.add(Change::Function, route, call(Callee::Piecewise(other)));
                }
                let is_choice = |part: &&Tree| !matches!(part.kind, Kind::Compare(..));
                for branch in parts.iter().filter(is_choice) {
                    self.add(Change::Branch, route, branch.clone());
                }
            }
            Callee::Operator(operator) => self.operator(operator, parts, route),
        }
    }

    fn operator(&mut self, of: Operator, parts: &[Tree], route: &Route) {
        let first = &parts[0];
        let transposed = |tree: &Tree| operator(Operator::Transpose, &[tree]);
        let is_curved = self.problem.system != System::Cartesian;
        let is_derivative = matches!(
            of,
            Operator::Gradient | Operator::Divergence | Operator::Laplacian | Operator::Curl
        );
        if is_curved && is_derivative {
            let parts: Vec<&Tree> = parts.iter().collect();
            let whole = operator(of, &parts);
            for basis in [names::Alteration::Unturned, names::Alteration::Flat] {
                let new = operator(Operator::Altered(basis), &[&whole]);
                self.add(Change::Basis, route, new);
            }
        }
        match of {
            Operator::Derivative => self.derivative(parts, route),
            Operator::TimeDerivative => {
                let is_first = !matches!(
                    first.kind,
                    Kind::Call(Callee::Operator(Operator::TimeDerivative), _)
                );
                if !is_first {
                    self.add(Change::Derivative, route, first.clone());
                }
            }
            Operator::Gradient => {
                let whole = operator(of, &[first]);
                self.add(Change::TransposedGradient, route, transposed(&whole));
            }
            Operator::Transpose => self.add(Change::MissingTranspose, route, first.clone()),
            Operator::Symmetric => {
                self.add(Change::MissingTranspose, route, first.clone());
                let half = binary(Binary::Divide, first, &number("2", 2.0));
                let half = match first.kind {
                    Kind::Binary(..) => {
                        let bracket = node(Kind::Bracket(Box::new(first.clone())));
                        binary(Binary::Divide, &bracket, &number("2", 2.0))
                    }
                    _ => half,
                };
                self.add(Change::MissingTranspose, route, half);
                self.add(Change::Operator, route, operator(Operator::Skew, &[first]));
            }
            Operator::Skew => {
                self.add(Change::LostOperator, route, first.clone());
                let other = operator(Operator::Symmetric, &[first]);
                self.add(Change::Operator, route, other);
            }
            Operator::Inverse | Operator::Trace | Operator::Determinant => {
                self.add(Change::LostOperator, route, first.clone());
            }
            Operator::Divergence => {
                let other = operator(of, &[&transposed(first)]);
                self.add(Change::Order, route, other);
            }
            Operator::Laplacian => {
                let inner = operator(Operator::Divergence, &[first]);
                let other = operator(Operator::Gradient, &[&inner]);
                self.add(Change::Operator, route, other);
            }
            Operator::Dot | Operator::Outer => {
                let other = operator(of, &[&parts[1], first]);
                self.add(Change::Order, route, other);
                if let (Operator::Dot, Some(of)) = (of, gradient(first)) {
                    let product = operator(Operator::Outer, &[of, &parts[1]]);
                    let other = operator(Operator::Divergence, &[&product]);
                    self.add(Change::Operator, route, other);
                }
            }
            _ => (),
        }
    }

    /// A derivative by one variable fewer, or by another.
    fn derivative(&mut self, parts: &[Tree], route: &Route) {
        for place in 1..parts.len() {
            let is_other = place == 1 || parts[place - 1].kind != parts[place].kind;
            if parts.len() > 2 && is_other {
                let mut fewer = parts.to_vec();
                fewer.remove(place);
                let fewer = fewer.iter().collect::<Vec<_>>();
                self.add(
                    Change::Derivative,
                    route,
                    operator(Operator::Derivative, &fewer),
                );
            }
            for other in self.problem.variables() {
                let other = name(other);
                if other.kind != parts[place].kind {
                    let mut by = parts.to_vec();
                    by[place] = other;
                    let by = by.iter().collect::<Vec<_>>();
                    self.add_rare(
                        Change::Derivative,
                        route,
                        operator(Operator::Derivative, &by),
                    );
                }
            }
        }
    }

    /// Products: all factors but one are constants for derivatives; a factor goes below a derivative
    /// that it stands before.
    fn chain(&mut self, tree: &Tree, route: &Route) {
        let mut factors = vec![];
        collect(tree, &mut vec![], &mut factors);
        if factors.len() > 2 {
            for kept in &factors {
                let mut new = tree.clone();
                for other in factors.iter().filter(|other| *other != kept) {
                    if let Some(part) = site::at_mut(&mut new, other) {
                        *part = held(part);
                    }
                }
                self.add(Change::OneDifferentiated, route, new);
            }
        }
        for factor in &factors {
            let Some(part) = site::at(tree, factor) else {
                continue;
            };
            if let Some(new) = below(tree, factor, part) {
                self.add(Change::TakenBelow, route, new);
            }
        }
    }
}

fn exchange(tree: &mut Tree, first: &str, second: &str) {
    if let Kind::Name(name) = &mut tree.kind {
        if name == first {
            second.clone_into(name);
        } else if name == second {
            first.clone_into(name);
        }
    }
    for child in tree.children_mut() {
        exchange(child, first, second);
    }
}

/// The same product with the derivative, which is one of its factors, acting on all of it.
fn below(tree: &Tree, factor: &Route, derivative: &Tree) -> Option<Tree> {
    let Kind::Call(callee @ Callee::Operator(of), parts) = &derivative.kind else {
        return None;
    };
    let mut inside = tree.clone();
    let (callee, inner, marks) = match of {
        Operator::Derivative | Operator::TimeDerivative | Operator::Divergence => {
            (*callee, parts[0].clone(), &parts[1..])
        }
        Operator::Dot => {
            let product = operator(Operator::Outer, &[gradient(&parts[0])?, &parts[1]]);
            (Callee::Operator(Operator::Divergence), product, &parts[..0])
        }
        _ => return None,
    };
    let inner = match inner.kind {
        Kind::Binary(..) | Kind::Negate(_) => node(Kind::Bracket(Box::new(inner))),
        _ => inner,
    };
    *site::at_mut(&mut inside, factor)? = inner;
    let parts = std::iter::once(inside).chain(marks.to_vec()).collect();
    Some(node(Kind::Call(callee, parts)))
}

/// The operand of a gradient.
fn gradient(tree: &Tree) -> Option<&Tree> {
    match &tree.kind {
        Kind::Call(Callee::Operator(Operator::Gradient), parts) => parts.first(),
        _ => None,
    }
}

/// The factors of a product that are no numbers: of quotients, and of products of tensors, too.
fn collect(tree: &Tree, route: &mut Route, found: &mut Vec<Route>) {
    let is_product = match &tree.kind {
        Kind::Binary(Binary::Multiply | Binary::Divide, _) => true,
        Kind::Call(Callee::Operator(of), parts) => {
            let is_gradient = gradient(&parts[0]).is_some();
            matches!(
                of,
                Operator::Dot | Operator::Inner | Operator::Outer | Operator::Cross
            ) && !is_gradient
        }
        Kind::Bracket(inner) => is_chain(inner),
        Kind::Negate(_) => true,
        _ => false,
    };
    if !is_product {
        if !matches!(tree.kind, Kind::Number(..)) {
            found.push(route.clone());
        }
        return;
    }
    for (place, child) in tree.children().into_iter().enumerate() {
        route.push(place);
        collect(child, route, found);
        route.pop();
    }
}

/// A function that is taken for another.
fn neighbour(function: Function) -> Option<Function> {
    Some(match function {
        Function::Sin => Function::Cos,
        Function::Cos => Function::Sin,
        Function::Sinh => Function::Cosh,
        Function::Cosh => Function::Sinh,
        Function::Tan => Function::Tanh,
        Function::Tanh => Function::Tan,
        Function::Ln => Function::Log10,
        Function::Log10 => Function::Ln,
        _ => return None,
    })
}
