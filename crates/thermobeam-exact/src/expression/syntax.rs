//! The syntax tree, and its evaluation on plain and on dual numbers.

use num_dual::{Dual2_64, DualNum};

/// A number with or without derivatives.
pub(super) trait Number: DualNum<Primitive = f64> + Copy {
    /// The value without its derivatives.
    fn value(self) -> f64;

    /// f(self), given the value and the first two derivatives of f at `self`.
    fn chain(self, value: f64, first: f64, second: f64) -> Self;
}

impl Number for f64 {
    fn value(self) -> f64 {
        self
    }

    fn chain(self, value: f64, _first: f64, _second: f64) -> Self {
        value
    }
}

impl Number for Dual2_64 {
    fn value(self) -> f64 {
        self.re
    }

    fn chain(self, value: f64, first: f64, second: f64) -> Self {
        Self::new(
            value,
            self.v1 * first,
            self.v2 * first + self.v1 * self.v1 * second,
        )
    }
}

/// An operator between two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// A function, named as in the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Abs,
    Min,
    Max,
}

/// All functions by name.
pub(super) const FUNCTIONS: [(&str, Function); 16] = [
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("asin", Function::Asin),
    ("acos", Function::Acos),
    ("atan", Function::Atan),
    ("sinh", Function::Sinh),
    ("cosh", Function::Cosh),
    ("tanh", Function::Tanh),
    ("exp", Function::Exp),
    ("ln", Function::Ln),
    ("log10", Function::Log10),
    ("sqrt", Function::Sqrt),
    ("abs", Function::Abs),
    ("min", Function::Min),
    ("max", Function::Max),
];

/// A node of the syntax tree. Subtrees without the variable are constants.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Node {
    Constant(f64),
    Variable,
    Negate(Box<Node>),
    Binary(Operator, Box<[Node; 2]>),
    /// A power with constant exponent. Exact at 0, unlike exp(n ln x).
    ConstantPower(Box<Node>, f64),
    Call1(Function, Box<Node>),
    Call2(Function, Box<[Node; 2]>),
}

impl Node {
    pub(super) fn negate(operand: Node) -> Self {
        Node::Negate(Box::new(operand)).folded()
    }

    pub(super) fn binary(operator: Operator, left: Node, right: Node) -> Self {
        match (operator, &right) {
            (Operator::Power, &Node::Constant(exponent)) => {
                Node::ConstantPower(Box::new(left), exponent)
            }
            _ => Node::Binary(operator, Box::new([left, right])),
        }
        .folded()
    }

    pub(super) fn call1(function: Function, argument: Node) -> Self {
        Node::Call1(function, Box::new(argument)).folded()
    }

    pub(super) fn call2(function: Function, arguments: [Node; 2]) -> Self {
        Node::Call2(function, Box::new(arguments)).folded()
    }

    fn is_constant(&self) -> bool {
        matches!(self, Node::Constant(_))
    }

    /// A constant if all operands are constants.
    ///
    /// Otherwise sqrt(0) would have the derivative 0 · ∞ instead of 0.
    fn folded(self) -> Self {
        let fold = match &self {
            Node::Constant(_) | Node::Variable => false,
            Node::Negate(operand) | Node::ConstantPower(operand, _) | Node::Call1(_, operand) => {
                operand.is_constant()
            }
            Node::Binary(_, operands) | Node::Call2(_, operands) => {
                operands.iter().all(Node::is_constant)
            }
        };
        if fold {
            Node::Constant(self.eval(0.0))
        } else {
            self
        }
    }

    /// The value at `x`, with derivatives if `D` has them.
    pub(super) fn eval<D: Number>(&self, x: D) -> D {
        match self {
            Node::Constant(value) => D::from(*value),
            Node::Variable => x,
            Node::Negate(operand) => -operand.eval(x),
            Node::Binary(operator, operands) => {
                let [left, right] = operands.as_ref();
                operate(*operator, left.eval(x), right.eval(x))
            }
            Node::ConstantPower(base, exponent) => constant_power(base.eval(x), *exponent),
            Node::Call1(function, argument) => call(*function, argument.eval(x)),
            Node::Call2(function, arguments) => {
                let [left, right] = arguments.as_ref();
                choose(*function, left.eval(x), right.eval(x))
            }
        }
    }

    /// Appends the numbers at `x` whose signs select branches: arguments of `abs`, differences of
    /// those of `min` and `max`.
    pub(super) fn push_branches(&self, x: f64, branches: &mut Vec<f64>) {
        match self {
            Node::Constant(_) | Node::Variable => (),
            Node::Negate(operand) | Node::ConstantPower(operand, _) => {
                operand.push_branches(x, branches);
            }
            Node::Call1(function, argument) => {
                if *function == Function::Abs {
                    branches.push(argument.eval(x));
                }
                argument.push_branches(x, branches);
            }
            Node::Binary(_, operands) => operands
                .iter()
                .for_each(|operand| operand.push_branches(x, branches)),
            Node::Call2(_, arguments) => {
                branches.push(arguments[0].eval(x) - arguments[1].eval(x));
                arguments
                    .iter()
                    .for_each(|argument| argument.push_branches(x, branches));
            }
        }
    }
}

fn operate<D: Number>(operator: Operator, left: D, right: D) -> D {
    match operator {
        Operator::Add => left + right,
        Operator::Subtract => left - right,
        Operator::Multiply => left * right,
        Operator::Divide => left / right,
        Operator::Power => (right * left.ln()).exp(),
    }
}

/// x^n with its derivatives n x^(n-1) and n (n-1) x^(n-2).
///
/// `powf` is exact for integer n whenever the result is representable, also for negative x, and
/// 0^0 = 1. A term with a zero factor is zero, although the power in it is infinite at x = 0 for
/// n = 0 or 1.
fn constant_power<D: Number>(base: D, n: f64) -> D {
    let x = base.value();
    let term = |factor: f64, exponent: f64| {
        if factor == 0.0 {
            0.0
        } else {
            factor * x.powf(exponent)
        }
    };
    base.chain(x.powf(n), term(n, n - 1.0), term(n * (n - 1.0), n - 2.0))
}

fn call<D: Number>(function: Function, argument: D) -> D {
    let x = argument.value();
    match function {
        Function::Sin => argument.sin(),
        Function::Cos => argument.cos(),
        // As a quotient, tan would round differently from `f64::tan`, and tanh would overflow.
        Function::Tan => {
            let value = x.tan();
            let first = 1.0 + value * value;
            argument.chain(value, first, 2.0 * value * first)
        }
        Function::Tanh => {
            let value = x.tanh();
            // 1 - tanh² cancels for tanh close to 1.
            let first = x.cosh().powi(-2);
            argument.chain(value, first, -2.0 * value * first)
        }
        Function::Asin => argument.asin(),
        Function::Acos => argument.acos(),
        Function::Atan => argument.atan(),
        Function::Sinh => argument.sinh(),
        Function::Cosh => argument.cosh(),
        Function::Exp => argument.exp(),
        Function::Ln => argument.ln(),
        Function::Log10 => argument.log10(),
        Function::Sqrt => {
            let root = x.sqrt();
            argument.chain(root, 0.5 / root, -0.25 / (root * x))
        }
        Function::Abs => {
            if x < 0.0 {
                -argument
            } else {
                argument
            }
        }
        Function::Min | Function::Max => unreachable!("the parser gives these two arguments"),
    }
}

/// The smaller or the larger of two numbers; NaN if either is NaN, which `f64::min` and `f64::max`
/// would drop.
fn choose<D: Number>(function: Function, left: D, right: D) -> D {
    let (a, b) = (left.value(), right.value());
    let take_left = a.is_nan()
        || if function == Function::Min {
            a <= b
        } else {
            a >= b
        };
    if take_left { left } else { right }
}
