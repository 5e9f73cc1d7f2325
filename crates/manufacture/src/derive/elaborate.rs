//! From trees to tensors, in any arithmetic; shapes are checked here.

use std::collections::HashMap;

use super::space::{Basis, Space};
use super::tensor::{self, Tensor, combine, scale};
use crate::arithmetic::{Algebra, Origin};
use crate::language::MAX_DEPTH;
use crate::language::names::{CONSTANTS, Callee, Operator, unknown};
use crate::language::tree::{Binary, Tree, TreeKind, callee_name};
use crate::problem::{Expression, InputError, Problem, TensorValue};

/// A file whose graph has more nodes is refused.
const MOST_NODES: usize = 200_000;

/// An expression of the file, and what takes its place.
#[derive(Debug)]
pub(crate) struct AlteredExpression<'p> {
    pub(crate) expression: &'p Expression,
    pub(crate) tree: Tree,
}

/// Evaluates the expressions of a file in an arithmetic.
pub(crate) struct Elaborator<'p, A: Algebra> {
    pub(crate) problem: &'p Problem,
    /// Expressions whose trees are others than those of the file.
    pub(crate) altered: &'p [AlteredExpression<'p>],
    pub(crate) algebra: A,
    pub(crate) space: Space,
    /// On a face: the outward unit normal.
    pub(super) normal: Option<Tensor<A::Number>>,
    /// The values of definitions.
    pub(crate) known: HashMap<String, Tensor<A::Number>>,
    /// Definitions that are being evaluated.
    open: Vec<String>,
    /// Exact fields are those of the file, not those of a variant.
    pub(super) is_plain: bool,
}

pub(super) type Elaborated<A> = Result<Tensor<<A as Algebra>::Number>, InputError>;

impl<'p, A: Algebra> Elaborator<'p, A> {
    pub(crate) fn new(problem: &'p Problem, algebra: A) -> Self {
        Self {
            space: Space {
                system: problem.system,
                components: problem.axes().len(),
                basis: Basis::Turning,
            },
            problem,
            altered: &[],
            algebra,
            normal: None,
            known: HashMap::new(),
            open: vec![],
            is_plain: false,
        }
    }

    pub(crate) fn expression(&mut self, expression: &Expression) -> Elaborated<A> {
        let mut altered = self.altered.iter();
        let altered = altered.find(|altered| altered.expression == expression);
        let tree = altered.map_or(&expression.tree, |altered| &altered.tree);
        self.tree(tree, expression)
    }

    pub(crate) fn value(&mut self, value: &TensorValue) -> Elaborated<A> {
        match value {
            TensorValue::One(expression) => self.expression(expression),
            TensorValue::List(place, parts) => {
                let parts: Result<Vec<_>, _> = parts.iter().map(|part| self.value(part)).collect();
                let stacked = stack(parts?);
                stacked.map_err(|problem| place.error(problem))
            }
        }
    }

    pub(crate) fn tree(&mut self, tree: &Tree, within: &Expression) -> Elaborated<A> {
        match &tree.kind {
            TreeKind::Number(value, _) => Ok(Tensor::scalar(self.algebra.number(*value))),
            TreeKind::Name(name) => self.name(name, tree, within),
            TreeKind::Bracket(inner) => self.tree(inner, within),
            TreeKind::Negate(operand) => {
                let operand = self.tree(operand, within)?;
                Ok(operand.map(|part| self.algebra.negate(part)))
            }
            TreeKind::Binary(..) => self.chain(tree, within),
            TreeKind::Call(callee, parts) => {
                let value = self.call(*callee, parts, tree, within)?;
                if self.algebra.nodes() > MOST_NODES {
                    let problem =
                        format!("expected at most {MOST_NODES} nodes of the graph, found more");
                    return Err(refused(within, tree, problem));
                }
                Ok(value)
            }
            TreeKind::List(parts) => {
                let parts: Result<Vec<_>, _> =
                    parts.iter().map(|part| self.tree(part, within)).collect();
                stack(parts?).map_err(|problem| refused(within, tree, problem))
            }
            TreeKind::Index(parts) => self.index(&parts[0], &parts[1..], within),
            TreeKind::Compare(..) => {
                let problem = "expected a comparison only as the first argument of `where`";
                Err(refused(within, tree, problem))
            }
        }
    }

    /// Operations from left to right. Sums of many terms are one below the other in their left
    /// operands: a loop goes along them.
    fn chain(&mut self, tree: &Tree, within: &Expression) -> Elaborated<A> {
        let mut chain = vec![];
        let mut first = tree;
        while let TreeKind::Binary(operator, operands) = &first.kind {
            chain.push((first, *operator, &operands[1]));
            first = &operands[0];
        }
        let mut value = self.tree(first, within)?;
        for (operation, operator, divisor) in chain.into_iter().rev() {
            let left = value;
            let right = self.tree(divisor, within)?;
            value = self
                .binary(operator, &left, &right)
                .map_err(|problem| refused(within, operation, problem))?;
            match operator {
                Binary::Divide => self.keep_origin([&value, &right], divisor, within),
                Binary::Power => {
                    let base = &operation.children()[0];
                    self.keep_origin([&value, &left], base, within);
                }
                _ => (),
            }
        }
        Ok(value)
    }

    /// Keeps where operations are that may have no value.
    ///
    /// * `of`: the value of the operation, and that of its argument.
    fn keep_origin(&mut self, of: [&Tensor<A::Number>; 2], argument: &Tree, within: &Expression) {
        for number in of.into_iter().flat_map(|tensor| &tensor.parts) {
            self.algebra.keep_origin(number, || Origin {
                within: within.clone(),
                argument: match &argument.kind {
                    TreeKind::Bracket(inner) => (**inner).clone(),
                    _ => argument.clone(),
                },
            });
        }
    }

    fn name(&mut self, name: &str, tree: &Tree, within: &Expression) -> Elaborated<A> {
        let problem = self.problem;
        if let Some(index) = problem.variables().iter().position(|entry| *entry == name) {
            return Ok(Tensor::scalar(self.algebra.variable(index)));
        }
        if let Some(index) = problem
            .parameters
            .iter()
            .position(|entry| entry.name == name)
        {
            return Ok(Tensor::scalar(self.algebra.parameter(index)));
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|entry| entry.0 == name) {
            return Ok(Tensor::scalar(self.algebra.number(*value)));
        }
        if let Some(definition) = problem.definitions.get(name) {
            return self.defined(name, &definition.value, tree, within);
        }
        match name {
            "identity" => Ok(self.identity()),
            "n" => match &self.normal {
                Some(normal) if self.open.is_empty() => Ok(normal.clone()),
                _ => Err(refused(
                    within,
                    tree,
                    "`n` is the unit normal; expected it in [boundary] only",
                )),
            },
            _ => Err(self.unknown(name, tree, within)),
        }
    }

    fn unknown(&self, name: &str, tree: &Tree, within: &Expression) -> InputError {
        let problem = self.problem;
        let parameters = problem.parameters.iter().map(|entry| entry.name.as_str());
        let known: Vec<&str> = problem
            .variables()
            .into_iter()
            .chain(parameters)
            .chain(problem.definitions.keys().map(String::as_str))
            .collect();
        refused(within, tree, unknown("name", name, &known))
    }

    fn defined(
        &mut self,
        name: &str,
        value: &TensorValue,
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        if let Some(first) = self.open.iter().position(|open| open == name) {
            let mut circle = self.open[first..].to_vec();
            circle.push(name.to_owned());
            let problem = format!("a circle: {}", circle.join(" -> "));
            return Err(refused(within, tree, problem));
        }
        if self.open.len() > MAX_DEPTH {
            let problem = format!("expected at most {MAX_DEPTH} definitions one inside the other");
            return Err(refused(within, tree, problem));
        }
        self.definition(name, value)
    }

    /// The value of a name, which is evaluated once.
    pub(super) fn definition(&mut self, name: &str, value: &TensorValue) -> Elaborated<A> {
        if let Some(known) = self.known.get(name) {
            return Ok(known.clone());
        }
        self.open.push(name.to_owned());
        let definition = self.problem.definitions.get(name);
        let value = if definition.is_some_and(|definition| definition.is_exact) {
            self.kept(name, value)?
        } else {
            self.value(value)?
        };
        self.open.pop();
        self.known.insert(name.to_owned(), value.clone());
        Ok(value)
    }

    /// The value of an exact field, as a node of its own where the arithmetic keeps fields.
    fn kept(&mut self, name: &str, value: &TensorValue) -> Elaborated<A> {
        let mut tensor = self.exact(name, value)?;
        let mut fields = self.problem.exact_fields();
        if let Some(place) = fields.position(|field| field == name)
            && !self.is_plain
        {
            for (component, part) in tensor.parts.iter_mut().enumerate() {
                *part = self.algebra.field(part, place, component);
            }
        }
        Ok(tensor)
    }

    fn identity(&mut self) -> Tensor<A::Number> {
        let rows = self.space.components;
        let mut parts = vec![];
        for i in 0..rows {
            for j in 0..rows {
                parts.push(self.algebra.number(f64::from(u8::from(i == j))));
            }
        }
        Tensor {
            shape: vec![rows, rows],
            parts,
        }
    }

    pub(super) fn binary(
        &mut self,
        operator: Binary,
        left: &Tensor<A::Number>,
        right: &Tensor<A::Number>,
    ) -> Result<Tensor<A::Number>, String> {
        let algebra = &mut self.algebra;
        let shapes = || [left.words(), right.words()];
        let [is_left_scalar, is_right_scalar] = [left, right].map(|side| side.rank() == 0);
        match operator {
            Binary::Add | Binary::Subtract if left.shape == right.shape => {
                Ok(combine(algebra, operator, left, right))
            }
            Binary::Multiply | Binary::Divide if is_right_scalar => {
                Ok(scale(algebra, operator, left, &right.parts[0]))
            }
            Binary::Multiply if is_left_scalar => {
                Ok(right.map(|part| algebra.binary(operator, &left.parts[0], part)))
            }
            Binary::Power if is_left_scalar && is_right_scalar => {
                let power = algebra.binary(operator, &left.parts[0], &right.parts[0]);
                Ok(Tensor::scalar(power))
            }
            Binary::Add | Binary::Subtract => {
                let [left, right] = shapes();
                let sign = if operator == Binary::Add {
                    "plus"
                } else {
                    "minus"
                };
                Err(format!("{left} {sign} {right}; expected equal shapes"))
            }
            Binary::Multiply => {
                let [left, right] = shapes();
                Err(format!(
                    "{left} times {right}; expected a scalar on one side, or dot, inner, outer, cross"
                ))
            }
            Binary::Divide => {
                let [left, right] = shapes();
                Err(format!(
                    "{left} divided by {right}; expected a scalar below"
                ))
            }
            Binary::Power => {
                let [left, right] = shapes();
                Err(format!("{left} to the power of {right}; expected scalars"))
            }
        }
    }

    fn call(
        &mut self,
        callee: Callee,
        parts: &[Tree],
        tree: &Tree,
        within: &Expression,
    ) -> Elaborated<A> {
        match callee {
            Callee::Function(function) => {
                let argument = self.scalar(&parts[0], within)?;
                let value = Tensor::scalar(self.algebra.call(function, &argument));
                self.keep_origin([&value, &Tensor::scalar(argument)], &parts[0], within);
                Ok(value)
            }
            Callee::Piecewise(function) => self.piecewise(function, parts, tree, within),
            Callee::Operator(operator) => {
                let value = self.operator(operator, parts, tree, within)?;
                self.keep_origin([&value; 2], &parts[0], within);
                Ok(value)
            }
        }
    }

    /// A scalar part of an expression.
    pub(super) fn scalar(
        &mut self,
        tree: &Tree,
        within: &Expression,
    ) -> Result<A::Number, InputError> {
        let value = self.tree(tree, within)?;
        match value.parts.as_slice() {
            [part] if value.rank() == 0 => Ok(part.clone()),
            _ => {
                let problem = format!("expected a scalar, found {}", value.words());
                Err(refused(within, tree, problem))
            }
        }
    }

    fn index(&mut self, of: &Tree, indices: &[Tree], within: &Expression) -> Elaborated<A> {
        let tensor = self.tree(of, within)?;
        if indices.len() != tensor.rank() {
            let problem = format!(
                "{} has {} indices, found {}",
                tensor.words(),
                tensor.rank(),
                indices.len()
            );
            return Err(refused(within, of, problem));
        }
        let mut place = 0;
        for (index, length) in indices.iter().zip(&tensor.shape) {
            place = place * length + self.place(index, *length, within)?;
        }
        Ok(Tensor::scalar(tensor.parts[place].clone()))
    }

    /// The place of a component: by number from 1, or by coordinate.
    fn place(&self, index: &Tree, length: usize, within: &Expression) -> Result<usize, InputError> {
        let axes = self.problem.axes();
        let place = match &index.kind {
            TreeKind::Number(value, _) if value.fract() == 0.0 && *value >= 1.0 => {
                Some(*value as usize - 1)
            }
            TreeKind::Name(name) if axes.len() == length => {
                axes.iter().position(|axis| axis == name)
            }
            _ => None,
        };
        place.filter(|place| *place < length).ok_or_else(|| {
            let names = if axes.len() == length {
                format!(", or one of {}", axes.join(" "))
            } else {
                String::new()
            };
            let problem = format!("expected a number from 1 to {length}{names}, found {index}");
            refused(within, index, problem)
        })
    }

    /// The place of a variable that an argument names.
    pub(super) fn variable(&self, tree: &Tree, within: &Expression) -> Result<usize, InputError> {
        let known = self.problem.variables();
        if let TreeKind::Name(name) = &tree.kind
            && let Some(place) = known.iter().position(|variable| variable == name)
        {
            return Ok(place);
        }
        let problem = format!("expected one of {}, found {tree}", known.join(" "));
        Err(refused(within, tree, problem))
    }

    pub(super) fn operand_error(
        &self,
        operator: Operator,
        expected: &str,
        operands: &[Tensor<A::Number>],
        tree: &Tree,
        within: &Expression,
    ) -> InputError {
        let name = callee_name(Callee::Operator(operator));
        let words: Vec<String> = operands.iter().map(Tensor::words).collect();
        let found = words.join(" and ");
        refused(
            within,
            tree,
            format!("`{name}` of {found}; expected {expected}"),
        )
    }
}

/// An error in a part of an expression; the part is named unless it is all of the text.
pub(super) fn refused(within: &Expression, tree: &Tree, problem: impl Into<String>) -> InputError {
    let problem = problem.into();
    let part = tree.to_string();
    let is_call = matches!(tree.kind, TreeKind::Binary(..) | TreeKind::Call(..));
    let problem = if is_call && part.len() <= 60 {
        format!("`{part}`: {problem}")
    } else {
        problem
    };
    within.place.error_at(&within.text, tree.at, problem)
}

/// Tensors of one shape as the rows of another.
fn stack<N: Clone>(rows: Vec<Tensor<N>>) -> Result<Tensor<N>, String> {
    let first = rows[0].shape.clone();
    if let Some(other) = rows.iter().find(|row| row.shape != first) {
        let [first, other] = [rows[0].words(), other.words()];
        return Err(format!(
            "{first} beside {other}; expected rows of one shape"
        ));
    }
    let mut shape = vec![rows.len()];
    shape.extend(first);
    let parts = rows.into_iter().flat_map(|row| row.parts).collect();
    Ok(Tensor { shape, parts })
}

/// The determinant or the inverse, of up to three rows.
pub(super) fn matrix<A: Algebra>(
    algebra: &mut A,
    operator: Operator,
    tensor: &Tensor<A::Number>,
) -> Option<Tensor<A::Number>> {
    let rows = tensor.square().filter(|rows| (1..=3).contains(rows))?;
    Some(match operator {
        Operator::Determinant => Tensor::scalar(tensor::determinant(algebra, tensor, rows)),
        _ => tensor::inverse(algebra, tensor, rows),
    })
}
