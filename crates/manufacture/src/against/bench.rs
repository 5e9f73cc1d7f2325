//! Quantities of the file after an edit: only what the edit reaches is derived anew.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};

use super::candidates::number;
use super::site::{self, Home, Route};
use crate::arithmetic::graph::Mark;
use crate::arithmetic::tape::{SizedValue, Tape};
use crate::arithmetic::{Graph, NodeId};
use crate::derive::{Basis, Elaborator, Part, Role, Tensor};
use crate::fit::Column;
use crate::language::tree::Tree;
use crate::model::Model;
use crate::problem::{
    Expression, LineColumn, Location, Parameter, ParameterValue, Problem, mentions,
};

/// The name of the unknown factor; no file can contain it.
pub(crate) const FACTOR: &str = " factor";

/// A part of the file replaced by another.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rewrite {
    pub(crate) home: Home,
    pub(crate) route: Route,
    pub(crate) new: Tree,
}

/// What is done to the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Alteration {
    /// In one place, or in all expressions of a quantity.
    Rewrites(Vec<Rewrite>),
    /// All derivatives in the equation, and in what it names.
    Basis(Basis),
    /// The values of one time at all times.
    Time(f64),
    /// Two coordinates exchanged, by their places.
    Exchange([usize; 2]),
}

/// A file that edits are tried on.
pub(crate) struct Bench {
    problem: Problem,
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
const MOST_WORK: usize = 400_000_000;

/// A quantity that may have been changed.
pub(crate) struct Altered<'b> {
    bench: &'b Bench,
    alteration: Option<&'b Alteration>,
    pub(crate) tensor: Tensor<NodeId>,
    tape: Tape<'b>,
}

impl Altered<'_> {
    /// All components at each of some points, with this unknown factor.
    pub(crate) fn at<'p>(
        &'p self,
        points: &'p [Vec<f64>],
        factor: f64,
    ) -> impl Iterator<Item = Vec<SizedValue>> + 'p {
        let Bench { problem, work, .. } = self.bench;
        let parameter = problem.parameters.len() - 1;
        let setting = ParameterValue {
            parameter,
            value: factor,
        };
        // Parameters without values have no quantities.
        let parameters = problem.parameter_values(&[setting]);
        let parameters = parameters.unwrap_or_else(|_| vec![f64::NAN; parameter + 1]);
        points.iter().map(move |point| {
            work.set(work.get() + self.tape.work());
            let mut point = point.clone();
            match self.alteration {
                Some(Alteration::Time(time)) => *point.last_mut().unwrap_or(&mut 0.0) = *time,
                Some(Alteration::Exchange([first, second])) => point.swap(*first, *second),
                _ => (),
            }
            self.tape.with(&point, &parameters).roots
        })
    }

    /// Of each component its values at points.
    pub(crate) fn columns(&self, points: &[Vec<f64>], factor: f64) -> Vec<Column> {
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

impl Bench {
    /// `None` if the file with an unknown factor has no values; it has, if it has without.
    pub(crate) fn new(model: &Model, part: Part) -> Option<Self> {
        let mut problem = model.problem.clone();
        problem.parameters.push(Parameter {
            name: FACTOR.to_owned(),
            expression: one(),
        });
        let parameters = problem.parameter_values(&[]).ok()?;
        let graph = Graph::new(problem.intervals.clone(), parameters);
        let mut elaborator = Elaborator::new(&problem, graph);
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

    /// What becomes of a quantity, given to `see`; `None` if the altered file has no such values.
    pub(crate) fn altered<R>(
        &mut self,
        alteration: Option<&Alteration>,
        quantity: &str,
        see: impl FnOnce(&Altered<'_>) -> R,
    ) -> Option<R> {
        let mut undo = vec![];
        let mut known = self.known.clone();
        let mut basis = Basis::Turning;
        match alteration {
            Some(Alteration::Rewrites(rewrites)) => {
                for rewrite in rewrites {
                    undo.extend(self.rewrite(rewrite));
                    if let Home::Definition { name, .. } = &rewrite.home {
                        let users = users(&self.problem, name);
                        known.retain(|known, _| !users.contains(known.as_str()));
                    }
                }
            }
            Some(Alteration::Basis(other)) => {
                basis = *other;
                known.clear();
            }
            _ => (),
        }
        let tensor = self.derived(known, basis, quantity);
        let seen = tensor.map(|tensor| {
            see(&Altered {
                tape: Tape::new(&self.graph, &tensor.parts),
                bench: self,
                alteration,
                tensor,
            })
        });
        for rewrite in undo.iter().rev() {
            self.rewrite(rewrite);
        }
        let nodes = self.graph.len() - self.nodes_as_written;
        self.work.set(self.work.get() + NEW_NODE * nodes);
        self.graph.rewind(self.mark);
        seen
    }

    /// Puts a part into its place, and returns how to put back what was there.
    fn rewrite(&mut self, rewrite: &Rewrite) -> Option<Rewrite> {
        let expression = rewrite.home.expression_mut(&mut self.problem)?;
        let part = site::at_mut(&mut expression.tree, &rewrite.route)?;
        let old = std::mem::replace(part, rewrite.new.clone());
        Some(Rewrite {
            new: old,
            ..rewrite.clone()
        })
    }

    fn derived(
        &mut self,
        known: HashMap<String, Tensor<NodeId>>,
        basis: Basis,
        quantity: &str,
    ) -> Option<Tensor<NodeId>> {
        let graph = std::mem::take(&mut self.graph);
        let mut elaborator = Elaborator::new(&self.problem, graph);
        elaborator.known = known;
        elaborator.space.basis = basis;
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

/// The definitions whose values a definition is part of, and itself.
fn users<'p>(problem: &'p Problem, name: &'p str) -> HashSet<&'p str> {
    let mut users = HashSet::from([name]);
    loop {
        let before = users.len();
        for (user, definition) in &problem.definitions {
            let mut parts = site::parts(&definition.value);
            if parts.any(|part| users.iter().any(|name| mentions(&part.tree, name))) {
                users.insert(user);
            }
        }
        if users.len() == before {
            return users;
        }
    }
}

/// The number 1, as an expression of the file.
fn one() -> Expression {
    Expression {
        place: Location {
            file: String::new(),
            line: 0,
            start: 0,
            text: LineColumn { line: 0, column: 1 },
            key: String::new(),
        },
        text: "1".to_owned(),
        tree: number("1", 1.0),
    }
}
