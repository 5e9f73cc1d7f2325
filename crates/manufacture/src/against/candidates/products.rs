//! Products: factors that are lost or stand elsewhere, and what derivatives act on.

use super::super::site::{self, Route};
use super::EditKind;
use super::trees::{Binding, binary, bracketed, gradient, held, is_chain, node, number, operator};
use super::walk::Walk;
use crate::language::names::{Callee, Operator};
use crate::language::tree::{Binary, Tree, TreeKind};

impl Walk<'_, '_> {
    pub(super) fn binary(&mut self, operator: Binary, operands: &[Tree; 2], route: &Route) {
        let [left, right] = operands;
        match operator {
            Binary::Multiply => {
                self.add(EditKind::Operator, route, raised(left, right));
                self.add(EditKind::LostFactor, route, left.clone());
                self.add(
                    EditKind::TimesForOver,
                    route,
                    binary(Binary::Divide, left, right),
                );
                self.brackets(operator, operands, route);
                if !is_chain(left) {
                    self.add(EditKind::LostFactor, route, right.clone());
                }
            }
            Binary::Divide => {
                // `a/b^2` becomes `a/b*2`.
                if let TreeKind::Binary(Binary::Power, power) = &right.kind {
                    let quotient = binary(Binary::Divide, left, &power[0]);
                    let product = binary(Binary::Multiply, &quotient, &power[1]);
                    self.add(EditKind::Operator, route, product);
                }
                self.add(EditKind::LostFactor, route, left.clone());
                self.brackets(operator, operands, route);
                let product = binary(Binary::Multiply, left, right);
                self.add(EditKind::TimesForOver, route, product);
                if !is_chain(left) && !matches!(left.kind, TreeKind::Number(..)) {
                    let inverse = binary(Binary::Divide, &number("1", 1.0), right);
                    self.add(EditKind::LostFactor, route, inverse);
                }
            }
            Binary::Power => {
                let product = binary(Binary::Multiply, left, right);
                self.add(EditKind::Operator, route, product);
            }
            _ => (),
        }
    }

    /// `a*b + c` for `a*(b + c)`, `a + b/c` for `(a + b)/c`.
    fn brackets(&mut self, of: Binary, [left, right]: &[Tree; 2], route: &Route) {
        if let Some(Sum { sign, first, last }) = Sum::in_bracket(left) {
            let last = binary(of, last, right);
            self.add(EditKind::LostBracket, route, binary(sign, first, &last));
        }
        if let (Binary::Multiply, Some(Sum { sign, first, last })) = (of, Sum::in_bracket(right)) {
            let first = binary(of, left, first);
            self.add(EditKind::LostBracket, route, binary(sign, &first, last));
        }
    }

    /// Products: all factors but one are constants for derivatives; a factor goes below a
    /// derivative that it stands before.
    pub(super) fn chain(&mut self, tree: &Tree, route: &Route) {
        let mut factors = vec![];
        collect(tree, &mut vec![], &mut factors);
        if factors.len() > 2 {
            for kept in &factors {
                let mut new = tree.clone();
                for other in factors.iter().filter(|other| *other != kept) {
                    if let Some(part) = site::at(tree, other) {
                        new = site::replaced(&new, other, held(part));
                    }
                }
                let wording = site::at(tree, kept).map_or(String::new(), Tree::to_string);
                self.add_worded(EditKind::OneDifferentiated, route, new, wording);
            }
        }
        for factor in &factors {
            let Some(part) = site::at(tree, factor) else {
                continue;
            };
            if let Some(new) = below(tree, factor, part) {
                self.add(EditKind::TakenBelow, route, new);
            }
        }
    }
}

/// `a^b` as it is read with `a` before it: an exponent belongs to the last factor.
fn raised(of: &Tree, exponent: &Tree) -> Tree {
    match &of.kind {
        TreeKind::Binary(operator @ (Binary::Multiply | Binary::Divide | Binary::Power), parts) => {
            binary(*operator, &parts[0], &raised(&parts[1], exponent))
        }
        TreeKind::Negate(inner) => node(TreeKind::Negate(Box::new(raised(inner, exponent)))),
        _ => binary(Binary::Power, of, exponent),
    }
}

/// The same product with the derivative, which is one of its factors, acting on all of it.
fn below(tree: &Tree, factor: &Route, derivative: &Tree) -> Option<Tree> {
    let TreeKind::Call(callee @ Callee::Operator(of), parts) = &derivative.kind else {
        return None;
    };
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
    let inside = site::replaced(tree, factor, bracketed(&inner, Binding::Atom));
    let parts = std::iter::once(inside).chain(marks.to_vec()).collect();
    Some(node(TreeKind::Call(callee, parts)))
}

/// The factors of a product that are no numbers: of quotients, and of products of tensors, too.
fn collect(tree: &Tree, route: &mut Route, found: &mut Vec<Route>) {
    let is_product = match &tree.kind {
        TreeKind::Binary(Binary::Multiply | Binary::Divide, _) => true,
        TreeKind::Call(Callee::Operator(of), parts) => {
            let is_gradient = gradient(&parts[0]).is_some();
            matches!(
                of,
                Operator::Dot | Operator::Inner | Operator::Outer | Operator::Cross
            ) && !is_gradient
        }
        TreeKind::Bracket(inner) => is_chain(inner),
        TreeKind::Negate(_) => true,
        _ => false,
    };
    if !is_product {
        if !matches!(tree.kind, TreeKind::Number(..)) {
            found.push(route.clone());
        }
        return;
    }
    for (place, child) in tree.children().iter().enumerate() {
        route.push(place);
        collect(child, route, found);
        route.pop();
    }
}

/// A sum or a difference of two.
struct Sum<'t> {
    sign: Binary,
    first: &'t Tree,
    last: &'t Tree,
}

impl<'t> Sum<'t> {
    /// What a bracket holds, if that is a sum.
    fn in_bracket(tree: &'t Tree) -> Option<Self> {
        let TreeKind::Bracket(inner) = &tree.kind else {
            return None;
        };
        let TreeKind::Binary(sign @ (Binary::Add | Binary::Subtract), parts) = &inner.kind else {
            return None;
        };
        let [first, last] = &**parts;
        Some(Self {
            sign: *sign,
            first,
            last,
        })
    }
}
