//! A file with all its quantities as nodes of one graph, and as jets at points.

use std::rc::Rc;

use crate::arithmetic::NodeId;
use crate::arithmetic::graph::Steps;
use crate::arithmetic::jet::{Jet, Jets, Monomials};
use crate::arithmetic::quadrature::{self, POINTS};
use crate::arithmetic::tape::{Evaluated, SizedValue, Tape};
use crate::arithmetic::{Depth, Graph, Node};
use crate::derive::{DerivedQuantity, Elaborator, Part, Role, Tensor, quantity};
use crate::problem::{InputError, Problem};

/// A file, derived.
#[derive(Debug)]
pub(crate) struct Model {
    pub(crate) problem: Problem,
    pub(crate) graph: Graph,
    pub(crate) parts: Vec<(Part, Vec<DerivedQuantity<NodeId>>)>,
    /// The values of [define], in alphabetical order.
    pub(crate) definitions: Vec<DerivedQuantity<NodeId>>,
    /// The expressions of the parameters, in those that they depend on.
    pub(crate) parameters: Vec<NodeId>,
    /// The largest number of derivatives one inside the other.
    order: usize,
    /// The largest number of panels of an integral.
    panels: usize,
}

impl Model {
    /// A point in words: `x = 0.25, t = 1`.
    pub(crate) fn place_in_words(&self, point: &[f64]) -> String {
        let names = self.problem.variables();
        let entries: Vec<String> = names
            .iter()
            .zip(point)
            .map(|(name, value)| format!("{name} = {value:.6}"))
            .collect();
        entries.join(", ")
    }

    pub(crate) fn new(problem: Problem) -> Result<Self, InputError> {
        let parameters = problem.parameter_values(&[])?;
        let graph = Graph::new(problem.intervals.clone(), parameters);
        Self::derived(problem, graph)
    }

    /// The same file, where exact fields and their derivatives are nodes of their own.
    pub(crate) fn keeping_fields(&self) -> Result<Self, InputError> {
        let graph = Graph::new(self.graph.intervals.clone(), self.graph.parameters.clone());
        Self::derived(self.problem.clone(), graph.keeping_fields())
    }

    /// The sources of the file, where choices go over smoothly.
    pub(crate) fn with_steps(&self, steps: Steps) -> Result<SmoothSources, InputError> {
        let graph = Graph::new(self.graph.intervals.clone(), self.graph.parameters.clone());
        let mut elaborator = Elaborator::new(&self.problem, graph.with_steps(steps));
        let equations = self.problem.equations.iter();
        let sources = equations.map(|equation| Ok(elaborator.source(equation)?.tensor));
        Ok(SmoothSources {
            sources: sources.collect::<Result<_, InputError>>()?,
            graph: elaborator.algebra,
        })
    }

    /// The largest number of derivatives one inside the other.
    pub(crate) fn order(&self) -> usize {
        self.order
    }

    fn derived(problem: Problem, graph: Graph) -> Result<Self, InputError> {
        let mut elaborator = Elaborator::new(&problem, graph);
        let mut parts = vec![];
        for part in Part::all(&problem) {
            parts.push((part, elaborator.part(part)?));
        }
        let mut definitions = vec![];
        for (name, definition) in &problem.definitions {
            if let Some(tensor) = elaborator.known.get(name)
                && !definition.is_exact
            {
                let place = definition.value.place();
                definitions.push(quantity(Role::Definition, name, place, tensor.clone()));
            }
        }
        let mut expressions = vec![];
        for parameter in &problem.parameters {
            let value = elaborator.expression(&parameter.expression)?;
            expressions.extend(value.parts);
        }
        let graph = elaborator.algebra;
        let mut depth = Elaborator::new(&problem, Depth);
        let mut order = 0;
        for part in Part::all(&problem) {
            for quantity in depth.part(part)? {
                order = quantity.tensor.parts.into_iter().fold(order, usize::max);
            }
        }
        let panels = most_panels(&graph);
        Ok(Self {
            parts,
            definitions,
            parameters: expressions,
            order,
            panels,
            graph,
            problem,
        })
    }

    /// The quantities of a part.
    pub(crate) fn part(&self, part: Part) -> &[DerivedQuantity<NodeId>] {
        let entry = self.parts.iter().find(|entry| entry.0 == part);
        entry.map_or(&[], |entry| &entry.1)
    }

    /// The values of quantities at points.
    pub(crate) fn rows<'q>(
        &self,
        quantities: impl IntoIterator<Item = &'q DerivedQuantity<NodeId>>,
    ) -> TensorRows<'_> {
        let tensors = quantities.into_iter().map(|quantity| &quantity.tensor);
        TensorRows::new(&self.graph, tensors)
    }

    pub(crate) fn of_role(&self, role: Role) -> impl Iterator<Item = &DerivedQuantity<NodeId>> {
        let all = self.parts.iter().flat_map(|entry| &entry.1);
        all.filter(move |quantity| quantity.role == role)
    }

    /// The jets of a part at points, one after the other.
    pub(crate) fn jets(&self) -> JetsAt<'_> {
        let variables = self.problem.intervals.len();
        let rule = quadrature::gauss(POINTS);
        let intervals = self.graph.intervals.iter();
        let rules = intervals.map(|interval| quadrature::panels(*interval, self.panels, &rule));
        JetsAt {
            model: self,
            jets: Jets {
                monomials: Rc::new(Monomials::new(variables, self.order)),
                point: vec![],
                parameters: Rc::new(self.graph.parameters.clone()),
                rules: Rc::new(rules.collect()),
            },
        }
    }
}

/// The sources of a file, each in the order of the equations, where choices go over smoothly.
pub(crate) struct SmoothSources {
    graph: Graph,
    sources: Vec<Tensor<NodeId>>,
}

impl SmoothSources {
    pub(crate) fn rows(&self) -> TensorRows<'_> {
        TensorRows::new(&self.graph, self.sources.iter())
    }
}

/// The largest number of panels of an integral.
fn most_panels(graph: &Graph) -> usize {
    let mut most = 1;
    for place in 0..graph.len() {
        if let Node::Integral { panels, .. } = graph.node(NodeId(place as u32)) {
            most = most.max(*panels);
        }
    }
    most
}

/// The jets of a model at any point.
pub(crate) struct JetsAt<'m> {
    model: &'m Model,
    /// At no point.
    jets: Jets,
}

impl JetsAt<'_> {
    /// The quantities of a part at a point, from the expressions as written.
    pub(crate) fn at(
        &self,
        part: Part,
        point: &[f64],
    ) -> Result<Vec<DerivedQuantity<Jet>>, InputError> {
        let jets = Jets {
            point: point.to_vec(),
            ..self.jets.clone()
        };
        Elaborator::new(&self.model.problem, jets).part(part)
    }
}

/// The values of tensors at a point: of each all components.
pub(crate) struct TensorRows<'m> {
    tape: Tape<'m>,
    /// Where the components of each tensor begin.
    starts: Vec<usize>,
}

impl<'m> TensorRows<'m> {
    pub(crate) fn new<'t>(
        graph: &'m Graph,
        tensors: impl Iterator<Item = &'t crate::derive::Tensor<NodeId>>,
    ) -> Self {
        let mut roots = vec![];
        let mut starts = vec![0];
        for tensor in tensors {
            roots.extend(&tensor.parts);
            starts.push(roots.len());
        }
        Self {
            tape: Tape::new(graph, &roots),
            starts,
        }
    }

    /// With the parameters of the file.
    pub(crate) fn at(&self, point: &[f64]) -> RowsAt {
        self.of(self.tape.at(point))
    }

    pub(crate) fn with(&self, point: &[f64], parameters: &[f64]) -> RowsAt {
        self.of(self.tape.with(point, parameters))
    }

    fn of(&self, Evaluated { roots, switches }: Evaluated) -> RowsAt {
        let ends = self.starts.windows(2);
        RowsAt {
            tensors: ends.map(|ends| roots[ends[0]..ends[1]].to_vec()).collect(),
            switches,
        }
    }
}

/// [`TensorRows`] at a point.
pub(crate) struct RowsAt {
    pub(crate) tensors: Vec<Vec<SizedValue>>,
    pub(crate) switches: Vec<f64>,
}
