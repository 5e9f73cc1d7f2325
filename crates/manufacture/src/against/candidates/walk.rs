//! The walk over the parts of an expression.

use super::super::bench::{Alteration, Rewrite};
use super::super::site::{self, Route};
use super::trees::{binary, held, is_chain, is_sum, name, node, number, times_factor};
use super::{Candidate, EditKind, Home, Wording};
use crate::language::names::{Callee, Operator};
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::problem::{Expression, Problem};

/// How a part stands in the expression around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
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

pub(super) struct Walk<'p, 'f> {
    pub(super) problem: &'p Problem,
    pub(super) home: Home,
    pub(super) within: &'p Expression,
    /// How far the expression is from a top-level term.
    pub(super) depth: usize,
    pub(super) found: &'f mut Vec<Candidate<'p>>,
}

/// The roles of the parts directly below.
fn roles(tree: &Tree) -> Vec<Role> {
    match &tree.kind {
        TreeKind::Number(..) | TreeKind::Name(_) => vec![],
        TreeKind::Negate(_) | TreeKind::Bracket(_) => vec![Role::Linear],
        TreeKind::Binary(operator, _) => match operator {
            Binary::Add | Binary::Subtract => vec![Role::Summand; 2],
            Binary::Multiply | Binary::Divide => vec![Role::Factor; 2],
            Binary::Power => vec![Role::Argument, Role::Exponent],
        },
        TreeKind::Call(callee, parts) => match callee {
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
        TreeKind::Compare(..) => vec![Role::Argument; 2],
        TreeKind::List(parts) => vec![Role::Argument; parts.len()],
        TreeKind::Index(parts) => {
            let marks = std::iter::repeat_n(Role::Mark, parts.len() - 1);
            std::iter::once(Role::Linear).chain(marks).collect()
        }
    }
}

impl Walk<'_, '_> {
    /// All edits of an expression.
    pub(super) fn all(&mut self) {
        let tree = &self.within.tree;
        self.visit(tree, &mut vec![], Role::Root);
        self.exchanges(tree);
    }

    /// An edit that is tried.
    pub(super) fn add(&mut self, kind: EditKind, route: &Route, new: Tree) {
        self.found.push(Candidate {
            kind,
            alteration: Alteration::Rewrites(vec![Rewrite {
                within: self.within,
                route: route.clone(),
                new,
            }]),
            wording: None,
            depth: self.depth + route.len(),
        });
    }

    /// An edit whose trees do not say what the other program has.
    pub(super) fn add_worded(&mut self, kind: EditKind, route: &Route, new: Tree, wording: String) {
        self.add(kind, route, new);
        if let Some(last) = self.found.last_mut() {
            last.wording = Some(Wording::New(wording));
        }
    }

    fn hold(&mut self, tree: &Tree, route: &Route) {
        let wording = format!("{tree}, held constant");
        self.add_worded(EditKind::Held, route, held(tree), wording);
    }

    fn visit(&mut self, tree: &Tree, route: &mut Route, role: Role) {
        if role == Role::Mark {
            return;
        }
        self.factor(tree, route, role);
        if role == Role::Factor && !matches!(tree.kind, TreeKind::Number(..) | TreeKind::Negate(_))
        {
            self.hold(tree, route);
        }
        if role == Role::Root && self.home == Home::Definition {
            self.hold(tree, route);
        }
        if is_chain(tree) && role != Role::Factor {
            self.chain(tree, route);
        }
        match &tree.kind {
            TreeKind::Binary(operator, operands) => self.binary(*operator, operands, route),
            TreeKind::Call(callee, parts) => self.call(*callee, parts, route),
            TreeKind::Name(named) => {
                if role == Role::Factor {
                    let two = number("2", 2.0);
                    self.add(EditKind::Square, route, binary(Binary::Power, tree, &two));
                }
                for other in self.others(named) {
                    self.add(EditKind::Name, route, name(&other));
                }
            }
            TreeKind::Index(parts) => self.index(&parts[0], &parts[1..], route),
            _ => (),
        }
        let is_signed_factor = role == Role::Factor && matches!(tree.kind, TreeKind::Negate(_));
        for (place, (child, role)) in tree.children().iter().zip(roles(tree)).enumerate() {
            let role = if is_signed_factor { Role::Factor } else { role };
            route.push(place);
            self.visit(child, route, role);
            route.pop();
        }
    }

    /// Names of the same kind: variables, parameters.
    fn others(&self, named: &str) -> Vec<String> {
        let parameters = self.problem.parameters.iter();
        let parameters: Vec<&str> = parameters.map(|p| p.name.as_str()).collect();
        let mut kinds = [self.problem.variables(), parameters].into_iter();
        let kind = kinds.find(|kind| kind.contains(&named)).unwrap_or_default();
        let others = kind.into_iter().filter(|other| *other != named);
        others.map(str::to_owned).collect()
    }

    /// Two parameters exchanged in all of an expression.
    fn exchanges(&mut self, tree: &Tree) {
        let mut names = vec![];
        site::names(tree, &mut names);
        let parameters = self.problem.parameters.iter();
        let mut parameters: Vec<&str> = parameters.map(|p| p.name.as_str()).collect();
        parameters.retain(|name| names.contains(name));
        for (place, first) in parameters.iter().enumerate() {
            for second in &parameters[..place] {
                let mut new = tree.clone();
                exchange(&mut new, first, second);
                self.add(EditKind::Parameters, &vec![], new);
            }
        }
    }

    /// All of an expression without a factor that changes with time alone.
    pub(super) fn without_time(&mut self, factors: &[Tree]) {
        let tree = &self.within.tree;
        for factor in factors {
            let without = binary(Binary::Divide, tree, factor);
            self.add(EditKind::LostTime, &vec![], without);
        }
    }

    /// A field, or another definition, as another summand.
    pub(super) fn added(&mut self) {
        for named in self.problem.definitions.keys() {
            let summand = times_factor(&name(named));
            let sum = binary(Binary::Add, &self.within.tree, &summand);
            self.add(EditKind::Added, &vec![], sum);
        }
    }

    /// Another component.
    pub(super) fn index(&mut self, of: &Tree, indices: &[Tree], route: &Route) {
        let indexed =
            |indices: Vec<Tree>| node(TreeKind::Index([vec![of.clone()], indices].concat()));
        if let [first, second] = indices {
            let swapped = indexed(vec![second.clone(), first.clone()]);
            self.add(EditKind::Index, route, swapped);
        }
        for (place, index) in indices.iter().enumerate() {
            let others: Vec<Tree> = match index.kind {
                TreeKind::Number(..) => (1..=3)
                    .map(|other| number(&other.to_string(), f64::from(other)))
                    .collect(),
                _ => self.problem.axes().iter().map(|axis| name(axis)).collect(),
            };
            for other in others.into_iter().filter(|other| other.kind != index.kind) {
                let mut indices = indices.to_vec();
                indices[place] = other;
                self.add(EditKind::Index, route, indexed(indices));
            }
        }
    }

    /// An unknown factor, where it is not that of another part as well.
    pub(super) fn factor(&mut self, tree: &Tree, route: &Route, role: Role) {
        let kind = match role {
            Role::Root if self.home == Home::Term => EditKind::Term,
            Role::Root | Role::Argument => EditKind::Part,
            Role::Summand => EditKind::Summand,
            Role::Exponent => EditKind::Exponent,
            Role::Factor | Role::Linear | Role::Mark => return,
        };
        if is_sum(tree) && role == Role::Summand {
            return;
        }
        if !matches!(tree.kind, TreeKind::Compare(..) | TreeKind::List(_)) {
            self.add(kind, route, times_factor(tree));
        }
    }
}

fn exchange(tree: &mut Tree, first: &str, second: &str) {
    if let TreeKind::Name(name) = &mut tree.kind {
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
