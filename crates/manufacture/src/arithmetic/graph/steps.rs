//! Choices that go over smoothly from one value to the other, along a line across their surface.

use super::{Graph, NodeId};
use crate::arithmetic::Algebra;
use crate::arithmetic::tape::Tape;
use crate::language::names::Function;
use crate::language::tree::Binary;

/// A line across the surface of a choice, and how far a step goes along it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Steps {
    pub(crate) middle: Vec<f64>,
    pub(crate) along: Vec<f64>,
    /// In units of `along`.
    pub(crate) width: f64,
    /// The line ends at this many widths from the middle, on both sides.
    pub(crate) reach: f64,
}

impl Steps {
    /// The point at s, in units of `along`.
    pub(crate) fn at(&self, s: f64) -> Vec<f64> {
        let pairs = self.middle.iter().zip(&self.along);
        pairs.map(|(x, along)| x + s * along).collect()
    }
}

/// The width of the step of a choice, as a difference of what it compares; `None` if it does not
/// change along the line: then it jumps where it did.
pub(super) fn width(graph: &Graph, compared: [NodeId; 2]) -> Option<f64> {
    let steps = graph.steps.as_ref()?;
    let tape = Tape::new(graph, &compared);
    let end = steps.reach * steps.width;
    let [below, above] = [-end, end].map(|s| {
        let roots = tape.at(&steps.at(s)).roots;
        roots[0].value - roots[1].value
    });
    (below * above < 0.0).then(|| (above - below).abs() / (2.0 * steps.reach))
}

/// `otherwise + (1 + tanh(d/w))/2*(then - otherwise)`, with the width w, and d = `above - below`.
pub(super) fn step(
    graph: &mut Graph,
    [above, below]: [NodeId; 2],
    width: f64,
    then: NodeId,
    otherwise: NodeId,
) -> NodeId {
    let half = graph.number(0.5);
    let width = graph.number(width);
    let distance = graph.binary(Binary::Subtract, &above, &below);
    let distance = graph.binary(Binary::Divide, &distance, &width);
    let tangent = graph.call(Function::Tanh, &distance);
    let share = graph.product(half, tangent);
    let share = graph.binary(Binary::Add, &half, &share);
    let difference = graph.binary(Binary::Subtract, &then, &otherwise);
    let part = graph.product(share, difference);
    graph.binary(Binary::Add, &otherwise, &part)
}
