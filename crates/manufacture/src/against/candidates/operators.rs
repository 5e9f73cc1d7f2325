//! Functions, and operators on tensors, by their neighbours.

use super::super::site::Route;
use super::EditKind;
use super::trees::{binary, gradient, name, node, number, operator};
use super::walk::Walk;
use crate::language::names::{Callee, Function, OperandAlteration, Operator, Piecewise};
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::problem::System;

impl Walk<'_, '_> {
    pub(super) fn call(&mut self, callee: Callee, parts: &[Tree], route: &Route) {
        let call = |callee: Callee| node(TreeKind::Call(callee, parts.to_vec()));
        match callee {
            Callee::Function(function) => {
                self.add(EditKind::LostOperator, route, parts[0].clone());
                if let Some(other) = neighbour(function) {
                    self.add(EditKind::Function, route, call(Callee::Function(other)));
                }
            }
            Callee::Piecewise(function) => {
                let other = match function {
                    Piecewise::Min => Some(Piecewise::Max),
                    Piecewise::Max => Some(Piecewise::Min),
                    _ => None,
                };
                if let Some(other) = other {
                    self.add(EditKind::Function, route, call(Callee::Piecewise(other)));
                }
                let is_choice = |part: &&Tree| !matches!(part.kind, TreeKind::Compare(..));
                for branch in parts.iter().filter(is_choice) {
                    self.add(EditKind::Branch, route, branch.clone());
                }
            }
            Callee::Operator(operator) => self.operator(operator, parts, route),
        }
    }

    fn operator(&mut self, of: Operator, parts: &[Tree], route: &Route) {
        let first = &parts[0];
        let transposed = |tree: &Tree| operator(Operator::Transpose, &[tree]);
        self.basis(of, parts, route);
        match of {
            Operator::Derivative => self.derivative(parts, route),
            Operator::TimeDerivative => {
                let is_first = !matches!(
                    first.kind,
                    TreeKind::Call(Callee::Operator(Operator::TimeDerivative), _)
                );
                if !is_first {
                    self.add(EditKind::Derivative, route, first.clone());
                }
            }
            Operator::Gradient => {
                let whole = operator(of, &[first]);
                self.add(EditKind::TransposedGradient, route, transposed(&whole));
            }
            Operator::Transpose => self.add(EditKind::MissingTranspose, route, first.clone()),
            Operator::Symmetric => self.symmetric(first, route),
            Operator::Skew => {
                self.add(EditKind::LostOperator, route, first.clone());
                let other = operator(Operator::Symmetric, &[first]);
                self.add(EditKind::Operator, route, other);
            }
            Operator::Inverse | Operator::Trace | Operator::Determinant => {
                self.add(EditKind::LostOperator, route, first.clone());
            }
            Operator::Divergence => {
                let other = operator(of, &[&transposed(first)]);
                self.add(EditKind::Order, route, other);
            }
            Operator::Laplacian => {
                let inner = operator(Operator::Divergence, &[first]);
                let other = operator(Operator::Gradient, &[&inner]);
                self.add(EditKind::Operator, route, other);
            }
            Operator::Dot | Operator::Outer => {
                let other = operator(of, &[&parts[1], first]);
                self.add(EditKind::Order, route, other);
                if let (Operator::Dot, Some(of)) = (of, gradient(first)) {
                    let product = operator(Operator::Outer, &[of, &parts[1]]);
                    let other = operator(Operator::Divergence, &[&product]);
                    self.add(EditKind::Operator, route, other);
                }
            }
            _ => (),
        }
    }

    /// A derivative that does not know that the basis turns.
    fn basis(&mut self, of: Operator, parts: &[Tree], route: &Route) {
        let is_derivative = matches!(
            of,
            Operator::Gradient | Operator::Divergence | Operator::Laplacian | Operator::Curl
        );
        if self.problem.system == System::Cartesian || !is_derivative {
            return;
        }
        let parts: Vec<&Tree> = parts.iter().collect();
        let whole = operator(of, &parts);
        for (basis, words) in [
            (
                OperandAlteration::Unturned,
                "without the derivatives of the basis",
            ),
            (OperandAlteration::Flat, "as in Cartesian coordinates"),
        ] {
            let new = operator(Operator::Altered(basis), &[&whole]);
            self.add_worded(EditKind::Basis, route, new, format!("{whole} {words}"));
        }
    }

    /// `A`, `A/2` or `skew(A)` for `sym(A)`.
    fn symmetric(&mut self, of: &Tree, route: &Route) {
        self.add(EditKind::MissingTranspose, route, of.clone());
        let half = binary(Binary::Divide, of, &number("2", 2.0));
        self.add(EditKind::MissingTranspose, route, half);
        self.add(EditKind::Operator, route, operator(Operator::Skew, &[of]));
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
                    EditKind::Derivative,
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
                    self.add(
                        EditKind::Derivative,
                        route,
                        operator(Operator::Derivative, &by),
                    );
                }
            }
        }
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
