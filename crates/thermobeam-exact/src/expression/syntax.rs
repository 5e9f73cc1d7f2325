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
pub(super) enum BinaryOperator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// A function, named as in the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ElementaryFunction {
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
pub(super) const FUNCTIONS: [(&str, ElementaryFunction); 16] = [
    ("sin", ElementaryFunction::Sin),
    ("cos", ElementaryFunction::Cos),
    ("tan", ElementaryFunction::Tan),
    ("asin", ElementaryFunction::Asin),
    ("acos", ElementaryFunction::Acos),
    ("atan", ElementaryFunction::Atan),
    ("sinh", ElementaryFunction::Sinh),
    ("cosh", ElementaryFunction::Cosh),
    ("tanh", ElementaryFunction::Tanh),
    ("exp", ElementaryFunction::Exp),
    ("ln", ElementaryFunction::Ln),
    ("log10", ElementaryFunction::Log10),
    ("sqrt", ElementaryFunction::Sqrt),
    ("abs", ElementaryFunction::Abs),
    ("min", ElementaryFunction::Min),
    ("max", ElementaryFunction::Max),
];

/// A node of the syntax tree. Subtrees without the variable are constants.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum SyntaxNode {
    Constant(f64),
    Variable,
    Negate(Box<SyntaxNode>),
    Binary(BinaryOperator, Box<[SyntaxNode; 2]>),
    /// A power with constant exponent. Exact at 0, unlike exp(n ln x).
    ConstantPower(Box<SyntaxNode>, f64),
    Call1(ElementaryFunction, Box<SyntaxNode>),
    Call2(ElementaryFunction, Box<[SyntaxNode; 2]>),
}

impl SyntaxNode {
    pub(super) fn negate(operand: SyntaxNode) -> Self {
        SyntaxNode::Negate(Box::new(operand)).folded()
    }

    pub(super) fn binary(operator: BinaryOperator, left: SyntaxNode, right: SyntaxNode) -> Self {
        match (operator, &right) {
            (BinaryOperator::Power, &SyntaxNode::Constant(exponent)) => {
                SyntaxNode::ConstantPower(Box::new(left), exponent)
            }
            _ => SyntaxNode::Binary(operator, Box::new([left, right])),
        }
        .folded()
    }

    pub(super) fn call1(function: ElementaryFunction, argument: SyntaxNode) -> Self {
        SyntaxNode::Call1(function, Box::new(argument)).folded()
    }

    pub(super) fn call2(function: ElementaryFunction, arguments: [SyntaxNode; 2]) -> Self {
        SyntaxNode::Call2(function, Box::new(arguments)).folded()
    }

    fn is_constant(&self) -> bool {
        matches!(self, SyntaxNode::Constant(_))
    }

    /// A constant if all operands are constants.
    ///
    /// Otherwise sqrt(0) would have the derivative 0 · ∞ instead of 0.
    fn folded(self) -> Self {
        let fold = match &self {
            SyntaxNode::Constant(_) | SyntaxNode::Variable => false,
            SyntaxNode::Negate(operand)
            | SyntaxNode::ConstantPower(operand, _)
            | SyntaxNode::Call1(_, operand) => operand.is_constant(),
            SyntaxNode::Binary(_, operands) | SyntaxNode::Call2(_, operands) => {
                operands.iter().all(SyntaxNode::is_constant)
            }
        };
        if fold {
            SyntaxNode::Constant(self.eval(0.0))
        } else {
            self
        }
    }

    /// The value at `x`, with derivatives if `D` has them.
    pub(super) fn eval<D: Number>(&self, x: D) -> D {
        match self {
            SyntaxNode::Constant(value) => D::from(*value),
            SyntaxNode::Variable => x,
            SyntaxNode::Negate(operand) => -operand.eval(x),
            SyntaxNode::Binary(operator, operands) => {
                let [left, right] = operands.as_ref();
                operate(*operator, left.eval(x), right.eval(x))
            }
            SyntaxNode::ConstantPower(base, exponent) => constant_power(base.eval(x), *exponent),
            SyntaxNode::Call1(function, argument) => call(*function, argument.eval(x)),
            SyntaxNode::Call2(function, arguments) => {
                let [left, right] = arguments.as_ref();
                choose(*function, left.eval(x), right.eval(x))
            }
        }
    }

    /// Appends the numbers at `x` whose signs select branches: arguments of `abs`, differences of
    /// those of `min` and `max`.
    pub(super) fn push_branches(&self, x: f64, branches: &mut Vec<f64>) {
        match self {
            SyntaxNode::Constant(_) | SyntaxNode::Variable => (),
            SyntaxNode::Negate(operand) | SyntaxNode::ConstantPower(operand, _) => {
                operand.push_branches(x, branches);
            }
            SyntaxNode::Call1(function, argument) => {
                if *function == ElementaryFunction::Abs {
                    branches.push(argument.eval(x));
                }
                argument.push_branches(x, branches);
            }
            SyntaxNode::Binary(_, operands) => operands
                .iter()
                .for_each(|operand| operand.push_branches(x, branches)),
            SyntaxNode::Call2(_, arguments) => {
                branches.push(arguments[0].eval(x) - arguments[1].eval(x));
                arguments
                    .iter()
                    .for_each(|argument| argument.push_branches(x, branches));
            }
        }
    }
}

fn operate<D: Number>(operator: BinaryOperator, left: D, right: D) -> D {
    match operator {
        BinaryOperator::Add => left + right,
        BinaryOperator::Subtract => left - right,
        BinaryOperator::Multiply => left * right,
        BinaryOperator::Divide => left / right,
        BinaryOperator::Power => (right * left.ln()).exp(),
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

fn call<D: Number>(function: ElementaryFunction, argument: D) -> D {
    let x = argument.value();
    match function {
        ElementaryFunction::Sin => argument.sin(),
        ElementaryFunction::Cos => argument.cos(),
        // As a quotient, tan would round differently from `f64::tan`, and tanh would overflow.
        ElementaryFunction::Tan => {
            let value = x.tan();
            let first = 1.0 + value * value;
            argument.chain(value, first, 2.0 * value * first)
        }
        ElementaryFunction::Tanh => {
            let value = x.tanh();
            // 1 - tanh² cancels for tanh close to 1.
            let first = x.cosh().powi(-2);
            argument.chain(value, first, -2.0 * value * first)
        }
        ElementaryFunction::Asin => argument.asin(),
        ElementaryFunction::Acos => argument.acos(),
        ElementaryFunction::Atan => argument.atan(),
        ElementaryFunction::Sinh => argument.sinh(),
        ElementaryFunction::Cosh => argument.cosh(),
        ElementaryFunction::Exp => argument.exp(),
        ElementaryFunction::Ln => argument.ln(),
        ElementaryFunction::Log10 => argument.log10(),
        ElementaryFunction::Sqrt => {
            let root = x.sqrt();
            argument.chain(root, 0.5 / root, -0.25 / (root * x))
        }
        ElementaryFunction::Abs => {
            if x < 0.0 {
                -argument
            } else {
                argument
            }
        }
        ElementaryFunction::Min | ElementaryFunction::Max => {
            unreachable!("the parser gives these two arguments")
        }
    }
}

/// The smaller or the larger of two numbers; NaN if either is NaN, which `f64::min` and `f64::max`
/// would drop.
fn choose<D: Number>(function: ElementaryFunction, left: D, right: D) -> D {
    let (a, b) = (left.value(), right.value());
    let take_left = a.is_nan()
        || if function == ElementaryFunction::Min {
            a <= b
        } else {
            a >= b
        };
    if take_left { left } else { right }
}
