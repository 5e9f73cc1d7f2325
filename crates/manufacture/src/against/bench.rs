//! Quantities of the file after an edit: only what the edit reaches is derived anew.

use std::borrow::Cow;
use std::cell::Cell;
use std::collections::HashMap;

use super::site::{self, Route};
use crate::arithmetic::graph::Mark;
use crate::arithmetic::tape::{SizedValue, Tape};
use crate::arithmetic::{Graph, NodeId};
use crate::derive::{AlteredExpression, Basis, Elaborator, Part, Role, Tensor};
use crate::fit::Column;
use crate::language::tree::Tree;
use crate::model::Model;
use crate::problem::{Expression, ParameterValue, Problem};

/// A part of an expression replaced by another.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rewrite<'p> {
    pub(crate) within: &'p Expression,
    pub(crate) route: Route,
    pub(crate) new: Tree,
}

/// What is done to the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Alteration<'p> {
    /// In one place, or in all expressions of a quantity.
    Rewrites(Vec<Rewrite<'p>>),
    /// A parameter, by its place, times the unknown factor; one that is zero becomes that factor.
    Parameter(usize),
    /// All derivatives in the equation, and in what it names.
    Basis(Basis),
    /// The values of one time at all times.
    Time(f64),
    /// Two coordinates exchanged, by their places.
    Exchange([usize; 2]),
}

impl Alteration<'_> {
    /// Whether the nodes of the file as written keep their values: the edit makes other nodes.
    fn keeps_values(&self) -> bool {
        matches!(self, Self::Rewrites(_) | Self::Basis(_))
    }
}

/// A file that edits are tried on.
pub(crate) struct Bench<'m> {
    problem: &'m Problem,
    part: Part,
    graph: Graph,
    mark: Mark,
    nodes_as_written: usize,
    /// The values of definitions as written.
    known: HashMap<String, Tensor<NodeId>>,
    /// Nodes that were derived or evaluated.
    work: Cell<usize>,
}

/// To derive a node takes as long as to evaluate so many.
const NEW_NODE: usize = 10;

/// A search ends when it has derived and evaluated so many nodes: some ten seconds.
const MOST_WORK: usize = 300_000_000;

/// Points at which quantities are evaluated after edits.
pub(crate) struct Points {
    points: Vec<Vec<f64>>,
    /// At each point the values of all nodes of the file as written; empty where they are not kept.
    as_written: Vec<Vec<SizedValue>>,
}

impl Points {
    /// Points at which few edits are evaluated: nothing is kept for them.
    pub(crate) fn plain(points: &[Vec<f64>]) -> Self {
        Self {
            points: points.to_vec(),
            as_written: vec![],
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }
}

/// A quantity that may have been changed.
pub(crate) struct Altered<'b> {
    bench: &'b Bench<'b>,
    alteration: Option<&'b Alteration<'b>>,
    parts: Vec<NodeId>,
    /// The number of nodes that keep their values as written.
    kept: usize,
    /// Of the other nodes.
    tape: Tape<'b>,
}

/// A parameter with a factor.
pub(crate) fn scaled(value: f64, factor: f64) -> f64 {
    if value == 0.0 { factor } else { value * factor }
}

impl Altered<'_> {
    /// The parameters of the file, and behind them the unknown factor.
    fn parameters(&self, factor: f64) -> Vec<f64> {
        let Bench { problem, graph, .. } = self.bench;
        let mut settings = vec![];
        if let Some(Alteration::Parameter(parameter)) = self.alteration {
            settings.push(ParameterValue {
                parameter: *parameter,
                value: scaled(graph.parameters[*parameter], factor),
            });
        }
        // Parameters without values have no quantities.
        let values = problem.parameter_values(&settings);
        let mut values = values.unwrap_or_else(|_| vec![f64::NAN; problem.parameters.len()]);
        values.push(factor);
        values
    }

    /// All components at each point, with this unknown factor.
    pub(crate) fn at<'p>(
        &'p self,
        points: &'p Points,
        factor: f64,
    ) -> impl Iterator<Item = Vec<SizedValue>> + 'p {
        let Bench { graph, work, .. } = self.bench;
        let parameters = self.parameters(factor);
        let as_written = match self.kept {
            0 => &[],
            _ => points.as_written.as_slice(),
        };
        let tape = match self.kept > 0 && as_written.is_empty() {
            true => Cow::Owned(Tape::new(graph, &self.parts)),
            false => Cow::Borrowed(&self.tape),
        };
        points.points.iter().enumerate().map(move |(k, point)| {
            work.set(work.get() + tape.work());
            let mut point = point.clone();
            match self.alteration {
                Some(Alteration::Time(time)) => *point.last_mut().unwrap_or(&mut 0.0) = *time,
                Some(Alteration::Exchange([first, second])) => point.swap(*first, *second),
                _ => (),
            }
            let given = as_written.get(k).map_or(&[][..], Vec::as_slice);
            tape.with_given(&point, &parameters, given).roots
        })
    }

    /// Of each component its values at points.
    pub(crate) fn columns(&self, points: &Points, factor: f64) -> Vec<Column> {
        let mut columns: Vec<Column> = vec![];
        for values in self.at(points, factor) {
            columns.resize(values.len(), vec![]);
            for (column, value) in columns.iter_mut().zip(values) {
                column.push(value.value);
            }
        }
        columns
    }
}

impl<'m> Bench<'m> {
    /// `None` if a quantity has no values.
    pub(crate) fn new(model: &'m Model, part: Part) -> Option<Self> {
        let problem = &model.problem;
        let parameters = [model.graph.parameters.as_slice(), &[1.0]].concat();
        let graph = Graph::new(problem.intervals.clone(), parameters);
        let mut elaborator = Elaborator::new(problem, graph);
        elaborator.part(Part::Interior).ok()?;
        elaborator.part(part).ok()?;
        let known = std::mem::take(&mut elaborator.known);
        let graph = elaborator.algebra;
        Some(Self {
            nodes_as_written: graph.len(),
            mark: graph.mark(),
            work: Cell::new(0),
            graph,
            known,
            part,
            problem,
        })
    }

    /// Whether the limit of work is reached.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.work.get() > MOST_WORK
    }

    /// Points at which many edits are tried: few, as the values of all nodes are kept.
    pub(crate) fn points(&self, points: &[Vec<f64>]) -> Points {
        let nodes: Vec<NodeId> = (0..self.nodes_as_written as u32).map(NodeId).collect();
        let tape = Tape::new(&self.graph, &nodes);
        let values = points.iter();
        Points {
            as_written: values
                .map(|point| tape.values(point, &self.graph.parameters))
                .collect(),
            points: points.to_vec(),
        }
    }

    /// What becomes of a quantity, given to `see`; `None` if the altered file has no such values.
    pub(crate) fn altered<R>(
        &mut self,
        alteration: Option<&Alteration<'_>>,
        quantity: &str,
        see: impl FnOnce(&Altered<'_>) -> R,
    ) -> Option<R> {
        let tensor = self.derived(alteration, quantity);
        let seen = tensor.map(|tensor| {
            let is_kept = alteration.is_none_or(Alteration::keeps_values);
            let kept = if is_kept { self.nodes_as_written } else { 0 };
            see(&Altered {
                tape: Tape::behind(&self.graph, kept, &tensor.parts),
                parts: tensor.parts,
                kept,
                bench: self,
                alteration,
            })
        });
        let nodes = self.graph.len() - self.nodes_as_written;
        self.work.set(self.work.get() + NEW_NODE * nodes);
        self.graph.rewind(self.mark);
        seen
    }

    fn derived(
        &mut self,
        alteration: Option<&Alteration<'_>>,
        quantity: &str,
    ) -> Option<Tensor<NodeId>> {
        let mut altered = vec![];
        if let Some(Alteration::Rewrites(rewrites)) = alteration {
            altered.extend(rewrites.iter().map(|rewrite| AlteredExpression {
                expression: rewrite.within,
                tree: site::replaced(&rewrite.within.tree, &rewrite.route, rewrite.new.clone()),
            }));
        }
        let is_altered = |part: &Expression| altered.iter().any(|entry| entry.expression == part);
        let reached = self.problem.depending(is_altered);
        let mut elaborator = Elaborator::new(self.problem, std::mem::take(&mut self.graph));
        elaborator.altered = &altered;
        elaborator.known = self.known.clone();
        elaborator
            .known
            .retain(|name, _| !reached.contains(name.as_str()));
        if let Some(Alteration::Basis(basis)) = alteration {
            elaborator.space.basis = *basis;
            elaborator.known.clear();
        }
        let derived = match self.part {
            Part::Face(_) => elaborator.part(self.part).ok().and_then(|quantities| {
                let mut data = quantities.into_iter();
                data.find(|q| q.role == Role::Datum && q.name == quantity)
            }),
            _ => {
                let mut equations = self.problem.equations.iter();
                let equation = equations.find(|equation| equation.name == quantity);
                equation.and_then(|equation| elaborator.source(equation).ok())
            }
        };
        self.graph = elaborator.algebra;
        derived.map(|derived| derived.tensor)
    }
}
