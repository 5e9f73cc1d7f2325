//! Quantities of the file after an edit: only what the edit reaches is derived anew.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};

use super::site::{self, Home, Route};
use crate::arithmetic::graph::Mark;
use crate::arithmetic::tape::{SizedValue, Tape};
use crate::arithmetic::{Graph, NodeId};
use crate::derive::{Basis, Elaborator, Part, Role, Tensor, tensor};
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::model::Model;
use crate::problem::{Expression, LineColumn, Location, Parameter, Problem, mentions};

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
    Rewrite(Rewrite),
    /// All of the quantity is divided by a part that changes with time alone.
    Over(Tree),
    /// All derivatives in the equation, and in what it names.
    Basis(Basis),
    /// The normal of the face points inwards.
    Normal,
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
    /// For each definition those that its value is part of, and itself.
    reached: HashMap<String, HashSet<String>>,
    /// Of the file, then 1 for the unknown factor.
    parameters: Vec<f64>,
    /// Nodes that were derived or evaluated.
    work: Cell<usize>,
}

/// To derive a node takes as long as to evaluate so many.
const NEW_NODE: usize = 10;

/// A search ends when it has derived and evaluated so many nodes: some ten seconds.
const MOST_WORK: usize = 400_000_000;

/// A quantity that may have been changed.
pub(crate) struct Altered<'b> {
    graph: &'b Graph,
    pub(crate) tensor: Tensor<NodeId>,
    parameters: &'b [f64],
    work: &'b Cell<usize>,
}

impl Altered<'_> {
    /// All components, at points and with an unknown factor.
    pub(crate) fn evaluation(&self) -> Evaluation<'_> {
        Evaluation {
            tape: Tape::new(self.graph, &self.tensor.parts),
            parameters: self.parameters,
            work: self.work,
        }
    }
}

/// A quantity as steps of its evaluation.
pub(crate) struct Evaluation<'b> {
    tape: Tape<'b>,
    parameters: &'b [f64],
    work: &'b Cell<usize>,
}

impl Evaluation<'_> {
    /// All components at a point, with this unknown factor.
    pub(crate) fn at(&self, point: &[f64], factor: f64) -> Vec<SizedValue> {
        self.work.set(self.work.get() + self.tape.work());
        let mut parameters = self.parameters.to_vec();
        parameters.pop();
        parameters.push(factor);
        self.tape.with(point, &parameters).roots
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
        let graph = Graph::new(problem.intervals.clone(), parameters.clone());
        let mut elaborator = Elaborator::new(&problem, graph);
        elaborator.part(Part::Interior).ok()?;
        elaborator.part(part).ok()?;
        let known = std::mem::take(&mut elaborator.known);
        let graph = elaborator.algebra;
        Some(Self {
            reached: reached(&problem),
            nodes_as_written: graph.len(),
            mark: graph.mark(),
            parameters,
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

    /// Whether a quantity may change if an expression does.
    pub(crate) fn reaches(&self, home: &Home, quantity: &str) -> bool {
        match home {
            Home::Term { equation, .. } => self.problem.equations[*equation].name == quantity,
            Home::Datum { face, datum, .. } => {
                self.part == Part::Face(*face)
                    && self.problem.faces[*face].data[*datum].name == quantity
            }
            Home::Definition { name, .. } => {
                let reached = &self.reached[name];
                self.expressions(quantity)
                    .iter()
                    .any(|tree| reached.iter().any(|name| mentions(tree, name)))
            }
        }
    }

    /// The trees of a quantity itself.
    fn expressions(&self, quantity: &str) -> Vec<&Tree> {
        match self.part {
            Part::Face(face) => {
                let data = self.problem.faces[face].data.iter();
                data.filter(|datum| datum.name == quantity)
                    .flat_map(|datum| site::parts(&datum.value))
                    .map(|expression| &expression.tree)
                    .collect()
            }
            _ => {
                let equations = self.problem.equations.iter();
                equations
                    .filter(|equation| equation.name == quantity)
                    .flat_map(|equation| &equation.terms)
                    .map(|term| &term.expression.tree)
                    .collect()
            }
        }
    }

    /// What becomes of a quantity, given to `see`; `None` if the altered file has no such values.
    pub(crate) fn altered<R>(
        &mut self,
        alteration: Option<&Alteration>,
        quantity: &str,
        see: impl FnOnce(&Altered<'_>) -> R,
    ) -> Option<R> {
        let mut undo = None;
        let mut known = self.known.clone();
        let mut basis = Basis::Turning;
        match alteration {
            Some(Alteration::Rewrite(rewrite)) => {
                undo = self.rewrite(rewrite);
                if let Home::Definition { name, .. } = &rewrite.home {
                    known.retain(|known, _| !self.reached[name].contains(known));
                }
            }
            Some(Alteration::Basis(other)) => {
                basis = *other;
                known.clear();
            }
            _ => (),
        }
        let is_inward = alteration == Some(&Alteration::Normal);
        let divisor = match alteration {
            Some(Alteration::Over(tree)) => Some(tree),
            _ => None,
        };
        let tensor = self.derived(known, basis, is_inward, quantity, divisor);
        if let Some(undo) = undo {
            self.rewrite(&undo);
        }
        let seen = tensor.map(|tensor| {
            see(&Altered {
                graph: &self.graph,
                tensor,
                parameters: &self.parameters,
                work: &self.work,
            })
        });
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
        is_inward: bool,
        quantity: &str,
        divisor: Option<&Tree>,
    ) -> Option<Tensor<NodeId>> {
        let graph = std::mem::take(&mut self.graph);
        let mut elaborator = Elaborator::new(&self.problem, graph);
        elaborator.known = known;
        elaborator.space.basis = basis;
        elaborator.is_inward = is_inward;
        let tensor = match self.part {
            Part::Face(_) => elaborator.part(self.part).ok().and_then(|quantities| {
                let mut data = quantities.into_iter();
                data.find(|q| q.role == Role::Datum && q.name == quantity)
                    .map(|datum| datum.tensor)
            }),
            _ => {
                let mut equations = self.problem.equations.iter();
                equations
                    .find(|equation| equation.name == quantity)
                    .and_then(|equation| elaborator.source(equation).ok())
                    .map(|source| source.tensor)
            }
        };
        let divisor = divisor.and_then(|tree| elaborator.tree(tree, &one()).ok());
        let tensor = tensor.map(|tensor| match divisor {
            None => tensor,
            Some(divisor) => {
                let divisor = &divisor.parts[0];
                tensor::scale(&mut elaborator.algebra, Binary::Divide, &tensor, divisor)
            }
        });
        self.graph = elaborator.algebra;
        tensor
    }
}

/// For each definition those that it is part of, and itself.
fn reached(problem: &Problem) -> HashMap<String, HashSet<String>> {
    let mut users: HashMap<&str, Vec<&str>> = HashMap::new();
    for (user, definition) in &problem.definitions {
        let mut names = vec![];
        for part in site::parts(&definition.value) {
            site::names(&part.tree, &mut names);
        }
        for name in names {
            users.entry(name).or_default().push(user);
        }
    }
    let all = problem.definitions.keys().map(|name| {
        let mut reached = HashSet::from([name.clone()]);
        let mut open = vec![name.as_str()];
        while let Some(next) = open.pop() {
            for user in users.get(next).into_iter().flatten() {
                if reached.insert((*user).to_owned()) {
                    open.push(user);
                }
            }
        }
        (name.clone(), reached)
    });
    all.collect()
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
        tree: Tree {
            kind: TreeKind::Number(1.0, "1".to_owned()),
            at: 0,
        },
    }
}
