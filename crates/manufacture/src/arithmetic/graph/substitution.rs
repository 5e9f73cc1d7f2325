//! A number in place of a variable.

use rustc_hash::FxHashMap;

use super::{Graph, Node, NodeId};
use crate::arithmetic::Algebra;

impl Graph {
    /// A node with a number in place of a variable.
    ///
    /// * `known`: nodes that have been changed.
    pub(super) fn substituted(
        &mut self,
        of: NodeId,
        variable: usize,
        value: NodeId,
        known: &mut FxHashMap<NodeId, NodeId>,
    ) -> NodeId {
        if !self.depends_on(of, variable) {
            return of;
        }
        if let Some(known) = known.get(&of) {
            return *known;
        }
        let node = *self.node(of);
        let operands: Vec<NodeId> = node
            .operands()
            .iter()
            .map(|operand| self.substituted(*operand, variable, value, known))
            .collect();
        let changed = match (node, operands.as_slice()) {
            (Node::Variable(_), _) => value,
            (Node::Negate(_), [operand]) => self.opposite(*operand),
            (Node::Held(_), [operand]) => self.held(operand),
            (Node::Call(function, _), [argument]) => self.call(function, argument),
            (Node::Binary(operator, _), [left, right]) => self.binary(operator, left, right),
            (Node::Choose(comparison, _), [left, right, then, otherwise]) => {
                self.choose(comparison, [left, right], then, otherwise)
            }
            (
                Node::Integral {
                    body,
                    variable: over,
                    ..
                },
                _,
            ) => {
                let body = self.substituted(body, variable, value, known);
                // As for derivatives: the check reports NaN as singular.
                self.integral(&body, over)
                    .unwrap_or_else(|_| self.number(f64::NAN))
            }
            _ => of,
        };
        known.insert(of, changed);
        changed
    }
}
