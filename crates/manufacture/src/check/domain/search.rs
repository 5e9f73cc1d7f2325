//! The search for places where a condition fails, by halving the box.

use super::sides::{middle, snapped};
use super::{DomainFinding, Trouble, probe};
use crate::arithmetic::conditions::{Condition, Need};
use crate::arithmetic::enclosure::{Enclosure, Over};
use crate::arithmetic::interval::Interval;
use crate::arithmetic::tape::Tape;
use crate::arithmetic::{Node, NodeId};
use crate::derive::{DerivedQuantity, Part, Role};
use crate::model::Model;
use crate::problem::{Surface, System};
use crate::sample::FROM_AXIS;

/// The search in a part ends after so many nodes over boxes: a second or two.
const MOST_WORK: usize = 2_000_000;

/// An operation that so many smallest boxes leave open is undecided.
const MOST_OPEN: usize = 8;

/// A point so near to an end of an interval, in lengths of it, lies on the boundary.
const AT_END: f64 = 1e-12;

/// Sides are halved down to this share of those of the domain, or to the last digit.
const SMALLEST: f64 = 1e-18;

/// What becomes of a condition.
#[derive(Debug, Default)]
struct State {
    open: usize,
    trouble: Option<Trouble>,
    is_settled: bool,
}

/// A box, and the conditions that are open in it.
struct Cell {
    sides: Vec<Interval>,
    open: Vec<usize>,
}

/// A level: its root, and whether the part lies on it.
struct LevelSet {
    root: NodeId,
    is_own: bool,
}

/// A part of the domain, and the nodes of its quantities.
pub(super) struct DomainSearch<'m> {
    model: &'m Model,
    enclosure: Enclosure<'m>,
    levels: Vec<LevelSet>,
    domain: Vec<Interval>,
}

impl<'m> DomainSearch<'m> {
    pub(super) fn new(
        model: &'m Model,
        part: Part,
        quantities: &[DerivedQuantity<NodeId>],
    ) -> Self {
        let mut roots: Vec<NodeId> = vec![];
        for quantity in quantities {
            roots.extend(&quantity.tensor.parts);
        }
        if part == Part::Interior {
            roots.extend(integrands(model));
        }
        let own = match part {
            Part::Face(index) => Some(model.problem.faces[index].name.as_str()),
            _ => None,
        };
        let mut levels = vec![];
        for level in model.of_role(Role::Level) {
            roots.extend(&level.tensor.parts);
            levels.push(LevelSet {
                root: level.tensor.parts[0],
                is_own: own == Some(level.name.as_str()),
            });
        }
        Self {
            enclosure: Enclosure::new(&model.graph, &roots),
            domain: sides(model, part),
            levels,
            model,
        }
    }

    /// All conditions that are not known to hold.
    pub(super) fn run(&self) -> Vec<Trouble> {
        let conditions = &self.enclosure.conditions;
        let mut states: Vec<State> = vec![];
        states.resize_with(conditions.len(), State::default);
        let mut budget = (MOST_WORK / self.enclosure.work().max(1)).max(100);
        let mut stack = vec![Cell {
            sides: self.domain.clone(),
            open: (0..conditions.len()).collect(),
        }];
        while let Some(mut cell) = stack.pop() {
            cell.open.retain(|place| !states[*place].is_settled);
            if cell.open.is_empty() {
                continue;
            }
            if budget == 0 {
                for place in &cell.open {
                    let condition = conditions[*place][0];
                    self.record(
                        &mut states[*place],
                        condition,
                        DomainFinding::Undecided,
                        &cell,
                    );
                }
                continue;
            }
            budget -= 1;
            let over = self.enclosure.over(&cell.sides);
            if self.is_outside(&over) {
                continue;
            }
            cell.open
                .retain(|place| over.open(&conditions[*place]).is_some());
            self.probe_middle(&over, &mut cell, &mut states);
            if cell.open.is_empty() {
                continue;
            }
            match self.widest(&over, &cell) {
                Some(side) => stack.extend(self.halves(cell, side)),
                None => {
                    for place in &cell.open {
                        if let Some(condition) = over.open(&conditions[*place]) {
                            self.settle(&mut states[*place], condition, &over, &cell);
                        }
                    }
                }
            }
        }
        states
            .into_iter()
            .filter_map(|state| state.trouble)
            .collect()
    }

    /// Whether no point of the box is in the domain.
    fn is_outside(&self, over: &Over<'_, '_>) -> bool {
        self.levels.iter().any(|level| {
            let range = over.range(level.root);
            range.lo > 0.0 || (level.is_own && range.hi < 0.0)
        })
    }

    fn is_inside(&self, over: &Over<'_, '_>) -> bool {
        self.levels
            .iter()
            .all(|level| over.range(level.root).hi < 0.0)
    }

    /// Settles the conditions that fail for sure in the middle of a box.
    fn probe_middle(&self, over: &Over<'_, '_>, cell: &mut Cell, states: &mut [State]) {
        let conditions = &self.enclosure.conditions;
        let is_violated = |place: &usize| {
            let Condition { need, argument, .. } = conditions[*place][0];
            need != Need::OneSide && need.is_violated(over.middle(argument))
        };
        if !cell.open.iter().any(is_violated) {
            return;
        }
        let point = middle(&cell.sides);
        let at = self.enclosure.over(&points(&point));
        if !self.is_inside(&at) {
            return;
        }
        cell.open.retain(|place| {
            let condition = at.open(&conditions[*place]);
            let Some(condition) = condition.filter(|_| is_violated(place)) else {
                return true;
            };
            let state = &mut states[*place];
            state.is_settled = true;
            state.trouble = Some(Trouble {
                condition,
                kind: DomainFinding::Missing,
                is_on_boundary: self.is_on_boundary(&point),
                point: point.clone(),
            });
            false
        });
    }

    /// The longest side, in lengths of the domain, of those that the open conditions depend on;
    /// `None` if all are as short as they get.
    fn widest(&self, over: &Over<'_, '_>, cell: &Cell) -> Option<usize> {
        let open = cell.open.iter();
        let mut nodes: Vec<NodeId> = open
            .map(|place| self.enclosure.conditions[*place][0].argument)
            .collect();
        nodes.extend(over.undecided());
        nodes.extend(self.levels.iter().map(|level| level.root));
        let graph = &self.model.graph;
        let mut widest: Option<(usize, f64)> = None;
        for (side, (interval, whole)) in cell.sides.iter().zip(&self.domain).enumerate() {
            let least = (interval.midpoint().abs() * f64::EPSILON).max(SMALLEST * whole.width());
            let share = interval.width() / whole.width();
            let is_divided =
                interval.width() > least && nodes.iter().any(|node| graph.depends_on(*node, side));
            if is_divided && widest.is_none_or(|widest| share > widest.1) {
                widest = Some((side, share));
            }
        }
        widest.map(|widest| widest.0)
    }

    /// The half that is nearer to the middle of the domain comes last, and so is looked at first.
    fn halves(&self, cell: Cell, side: usize) -> [Cell; 2] {
        let interval = cell.sides[side];
        let cut = interval.midpoint();
        let part = |lo: f64, hi: f64| {
            let mut sides = cell.sides.clone();
            sides[side] = Interval::new(lo, hi);
            Cell {
                sides,
                open: cell.open.clone(),
            }
        };
        let [lower, upper] = [part(interval.lo, cut), part(cut, interval.hi)];
        if cut < self.domain[side].midpoint() {
            [lower, upper]
        } else {
            [upper, lower]
        }
    }

    /// Whether a point lies on the boundary of the part.
    fn is_on_boundary(&self, point: &[f64]) -> bool {
        let mut coordinates = point.iter().zip(&self.domain);
        if coordinates.any(|(x, side)| is_at_end(*x, *side)) {
            return true;
        }
        let levels = self.levels.iter().filter(|level| !level.is_own);
        let roots: Vec<NodeId> = levels.map(|level| level.root).collect();
        let values = Tape::new(&self.model.graph, &roots).at(point).roots;
        values
            .iter()
            .any(|level| level.value.abs() <= AT_END * level.size)
    }

    /// Looks at the points of a smallest box.
    fn settle(&self, state: &mut State, condition: Condition, over: &Over<'_, '_>, cell: &Cell) {
        let kind = probe::kind(self.model, condition, over, &cell.sides);
        self.record(state, condition, kind, cell);
    }

    fn record(&self, state: &mut State, condition: Condition, kind: DomainFinding, cell: &Cell) {
        let point = snapped(&cell.sides);
        state.open += 1;
        state.is_settled = kind == DomainFinding::Missing || state.open == MOST_OPEN;
        let is_worse = kind == DomainFinding::Missing || state.trouble.is_none();
        if is_worse {
            state.trouble = Some(Trouble {
                condition,
                kind,
                is_on_boundary: self.is_on_boundary(&point),
                point,
            });
        }
    }
}

/// The sides of a part, its fixed ones as points.
fn sides(model: &Model, part: Part) -> Vec<Interval> {
    let problem = &model.problem;
    let intervals = problem.intervals.iter();
    let mut sides: Vec<Interval> = intervals.map(|[lo, hi]| Interval::new(*lo, *hi)).collect();
    match part {
        Part::Interior => (),
        Part::Initial => {
            if let (Some(first), Some(time)) = (problem.first_time(), sides.last_mut()) {
                *time = Interval::point(first);
            }
        }
        Part::Face(index) => {
            if let Surface::Side {
                coordinate,
                is_upper,
            } = problem.faces[index].surface
            {
                let Interval { lo, hi } = sides[coordinate];
                sides[coordinate] = Interval::point(if is_upper { hi } else { lo });
            }
        }
    }
    if problem.system != System::Cartesian {
        // Nothing is evaluated on the axis.
        let [low, high] = problem.intervals[0];
        let nearest = low + FROM_AXIS * (high - low);
        sides[0] = sides[0].max(Interval::point(if low == 0.0 { nearest } else { low }));
    }
    sides
}

/// The bodies of all integrals.
fn integrands(model: &Model) -> Vec<NodeId> {
    let places = 0..model.graph.len();
    let nodes = places.map(|place| model.graph.node(NodeId(place as u32)));
    let bodies = nodes.filter_map(|node| match node {
        Node::Integral { body, .. } => Some(*body),
        _ => None,
    });
    bodies.collect()
}

fn points(point: &[f64]) -> Vec<Interval> {
    point.iter().map(|x| Interval::point(*x)).collect()
}

/// Whether a coordinate lies on an end of its interval, but for rounding.
fn is_at_end(x: f64, side: Interval) -> bool {
    let near = AT_END * side.width();
    near > 0.0 && ((x - side.lo).abs() <= near || (side.hi - x).abs() <= near)
}
