//! Enclosures of random graphs over random boxes hold what dense samples find there, and so do the
//! signs that comparisons imply.

use super::enclosure::Enclosure;
use super::guards::Facts;
use super::interval::Interval;
use super::signs::Signs;
use super::tape::{Tape, nodes_below};
use super::{Algebra, Graph, NodeId};
use crate::language::names::Function;
use crate::language::tree::{Binary, Relation};
use crate::sample::Random;

const FUNCTIONS: [Function; 13] = [
    Function::Sin,
    Function::Cos,
    Function::Tan,
    Function::Asin,
    Function::Acos,
    Function::Atan,
    Function::Sinh,
    Function::Cosh,
    Function::Tanh,
    Function::Exp,
    Function::Ln,
    Function::Log10,
    Function::Sqrt,
];

const OPERATORS: [Binary; 4] = [
    Binary::Add,
    Binary::Subtract,
    Binary::Multiply,
    Binary::Divide,
];

const EXPONENTS: [f64; 7] = [-2.0, -1.5, -1.0, 0.5, 1.7, 2.0, 3.0];

fn below(random: &mut Random, count: usize) -> usize {
    (random.share() * count as f64) as usize
}

/// A node more, of nodes that are there.
fn grown(graph: &mut Graph, nodes: &[NodeId], random: &mut Random) -> NodeId {
    let mut any = || nodes[below(random, nodes.len())];
    let [a, b, c, d] = [any(), any(), any(), any()];
    match below(random, 12) {
        0..4 => graph.binary(OPERATORS[below(random, 4)], &a, &b),
        4 => {
            let exponent = graph.number(EXPONENTS[below(random, 7)]);
            graph.binary(Binary::Power, &a, &exponent)
        }
        5 => graph.binary(Binary::Power, &a, &b),
        6 => {
            let zero = graph.number(0.0);
            let opposite = graph.negate(&a);
            graph.choose(Relation::Less, [&a, &zero], &opposite, &a)
        }
        7 => graph.choose(Relation::GreaterOrEqual, [&a, &b], &a, &b),
        8 => graph.choose(Relation::LessOrEqual, [&a, &b], &c, &d),
        9 => graph.derivative(&a, below(random, 2)),
        _ => graph.call(FUNCTIONS[below(random, 13)], &a),
    }
}

fn random_graph(random: &mut Random) -> (Graph, Vec<NodeId>) {
    let mut graph = Graph::new(vec![[-1.0, 1.0]; 2], vec![]);
    let mut nodes = vec![graph.variable(0), graph.variable(1)];
    let number = 4.0 * random.share() - 2.0;
    nodes.push(graph.number(number));
    for _ in 0..4 + below(random, 8) {
        let node = grown(&mut graph, &nodes, random);
        nodes.push(node);
    }
    (graph, nodes)
}

fn random_side(random: &mut Random) -> Interval {
    let centre = 4.0 * random.share() - 2.0;
    // From wide sides to those of a few numbers.
    let width = 2.0 * 0.1_f64.powi(below(random, 17) as i32);
    Interval::new(centre, centre + width * random.share())
}

fn inside(side: Interval, random: &mut Random) -> f64 {
    match below(random, 6) {
        0 => side.lo,
        1 => side.hi,
        _ => (side.lo + random.share() * side.width()).clamp(side.lo, side.hi),
    }
}

/// Whether a node is infinite at a point, or a number of it has been folded to no number.
fn overflows(graph: &Graph, root: NodeId, point: &[f64]) -> bool {
    let nodes = nodes_below(graph, &[root]);
    let values = Tape::new(graph, &nodes).at(point).roots;
    let mut pairs = nodes.iter().zip(values);
    pairs.any(|(node, value)| {
        let is_folded = graph.constant(*node).is_some_and(f64::is_nan);
        is_folded || value.value.is_infinite()
    })
}

/// A value that is finite lies in its enclosure but for the rounding of its own evaluation, and
/// where no condition is open all values are there.
#[test]
fn values_lie_in_their_enclosures_and_free_boxes_have_all_values() {
    let mut random = Random(11);
    let [mut free, mut contained] = [0, 0];
    for number in 0..4000 {
        let (graph, nodes) = random_graph(&mut random);
        let root = nodes[nodes.len() - 1];
        let enclosure = Enclosure::new(&graph, &[root]);
        let tape = Tape::new(&graph, &[root]);
        for _ in 0..3 {
            let cell = [random_side(&mut random), random_side(&mut random)];
            let over = enclosure.over(&cell);
            let is_free = enclosure.conditions.iter().all(|c| over.open(c).is_none());
            let range = over.range(root);
            for _ in 0..40 {
                let point = cell.map(|side| inside(side, &mut random));
                let found = tape.at(&point).roots[0];
                if is_free {
                    free += 1;
                    let is_missing = found.value.is_nan() && !overflows(&graph, root, &point);
                    assert!(!is_missing, "{number} {cell:?} {point:?}");
                }
                if found.value.is_finite() {
                    contained += 1;
                    let rounding = 1e-13 * found.size;
                    let is_in =
                        range.lo - rounding <= found.value && found.value <= range.hi + rounding;
                    assert!(
                        is_in,
                        "{number}: {found:?} in {range:?} over {cell:?} at {point:?}"
                    );
                }
            }
        }
    }
    assert!(free > 50_000 && contained > 200_000, "{free} {contained}");
}

const COMPARISONS: [Relation; 4] = [
    Relation::Less,
    Relation::LessOrEqual,
    Relation::Greater,
    Relation::GreaterOrEqual,
];

/// The sign of a value that is not rounding alone is one of those that its range and the result of
/// a comparison allow, at all points with that result.
#[test]
fn values_behind_a_comparison_have_the_signs_that_it_implies() {
    let mut random = Random(12);
    let mut implied = 0;
    for number in 0..3000 {
        let (mut graph, mut nodes) = random_graph(&mut random);
        nodes.push(graph.number(0.0));
        let mut any = || nodes[nodes.len() - 1 - below(&mut random, nodes.len())];
        let [left, right, node] = [any(), any(), any()];
        let zero = graph.number(0.0);
        let comparison = COMPARISONS[below(&mut random, 4)];
        let choice = graph.choose(comparison, [&left, &right], &node, &zero);
        if choice == node || choice == zero {
            continue;
        }
        let enclosure = Enclosure::new(&graph, &[choice]);
        let tape = Tape::new(&graph, &[left, right, node, choice]);
        for _ in 0..4 {
            let centre = random.share() - 0.5;
            let wide = Interval::new(centre - random.share(), centre + random.share());
            let cell = [wide, random_side(&mut random)];
            let over = enclosure.over(&cell);
            let mut facts = Facts::new(&over);
            facts.add(choice, true);
            let signs = facts.signs(node);
            implied += usize::from(signs != Signs::between(over.range(node)));
            for _ in 0..30 {
                let point = cell.map(|side| inside(side, &mut random));
                let values = tape.at(&point).roots;
                // The choice has the value of the node only where the comparison holds.
                let [left, right, value] = [values[0], values[1], values[2]];
                let rounding = 1e-12 * (left.size + right.size);
                let is_sure = (left.value - right.value).abs() > rounding;
                let holds = value.value == values[3].value && value.value != 0.0;
                if !is_sure || !holds || overflows(&graph, choice, &point) {
                    continue;
                }
                let least = 1e-12 * value.size;
                let is_in = value.value.abs() <= least
                    || (value.value > 0.0 && signs.positive)
                    || (value.value < 0.0 && signs.negative);
                assert!(
                    is_in,
                    "{number}: {value:?}, {signs:?} over {cell:?} at {point:?}"
                );
            }
        }
    }
    assert!(implied > 700, "{implied}");
}
