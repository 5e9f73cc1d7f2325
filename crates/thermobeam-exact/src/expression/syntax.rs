//! The syntax tree, and its evaluation on plain and on dual numbers.

use manufacture::language::names::Function;
use manufacture::language::tree::{Binary, Relation};
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

/// A node of the syntax tree. Subtrees without the variable are constants.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum SyntaxNode {
    Constant(f64),
    Variable,
    Negate(Box<SyntaxNode>),
    Binary(Binary, Box<[SyntaxNode; 2]>),
    /// A power with constant exponent. Exact at 0, unlike exp(n ln x).
    ConstantPower(Box<SyntaxNode>, f64),
    Call(Function, Box<SyntaxNode>),
    Abs(Box<SyntaxNode>),
    /// The first if the relation holds between the two, else the second: `min` and `max`.
    Choose(Relation, Box<[SyntaxNode; 2]>),
}

impl SyntaxNode {
    fn is_constant(&self) -> bool {
        matches!(self, SyntaxNode::Constant(_))
    }

    /// The nodes directly below.
    fn operands(&self) -> &[SyntaxNode] {
        match self {
            SyntaxNode::Constant(_) | SyntaxNode::Variable => &[],
            SyntaxNode::Negate(operand)
            | SyntaxNode::ConstantPower(operand, _)
            | SyntaxNode::Call(_, operand)
            | SyntaxNode::Abs(operand) => std::slice::from_ref(operand),
            SyntaxNode::Binary(_, operands) | SyntaxNode::Choose(_, operands) => &**operands,
        }
    }

    /// A constant if all operands are constants.
    ///
    /// Otherwise sqrt(0) would have the derivative 0 · ∞ instead of 0.
    pub(super) fn folded(self) -> Self {
        let operands = self.operands();
        if !operands.is_empty() && operands.iter().all(SyntaxNode::is_constant) {
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
            SyntaxNode::Call(function, argument) => call(*function, argument.eval(x)),
            SyntaxNode::Abs(argument) => {
                let argument = argument.eval(x);
                if argument.value() < 0.0 {
                    -argument
                } else {
                    argument
                }
            }
            SyntaxNode::Choose(relation, operands) => {
                let [left, right] = operands.as_ref();
                choose(*relation, left.eval(x), right.eval(x))
            }
        }
    }

    /// Appends the numbers at `x` whose signs select branches: arguments of `abs`, differences of
    /// those of `min` and `max`.
    pub(super) fn push_branches(&self, x: f64, branches: &mut Vec<f64>) {
        match self {
            SyntaxNode::Abs(argument) => branches.push(argument.eval(x)),
            SyntaxNode::Choose(_, operands) => {
                branches.push(operands[0].eval(x) - operands[1].eval(x));
            }
            _ => (),
        }
        for operand in self.operands() {
            operand.push_branches(x, branches);
        }
    }

    /// Appends the numbers at `x` that divide: those below quotients, the bases of their powers and
    /// of negative powers, and cosines below tangents.
    pub(super) fn push_divisors(&self, x: f64, divisors: &mut Vec<f64>) {
        match self {
            SyntaxNode::Binary(Binary::Divide, operands) => {
                let mut below = &operands[1];
                while let SyntaxNode::ConstantPower(base, _) = below {
                    below = base;
                }
                divisors.push(below.eval(x));
            }
            SyntaxNode::ConstantPower(base, exponent) if *exponent < 0.0 => {
                divisors.push(base.eval(x));
            }
            SyntaxNode::Call(Function::Tan, argument) => divisors.push(argument.eval(x).cos()),
            _ => (),
        }
        for operand in self.operands() {
            operand.push_divisors(x, divisors);
        }
    }
}

fn operate<D: Number>(operator: Binary, left: D, right: D) -> D {
    match operator {
        Binary::Add => left + right,
        Binary::Subtract => left - right,
        Binary::Multiply => left * right,
        Binary::Divide => left / right,
        Binary::Power => (right * left.ln()).exp(),
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
    }
}

/// The smaller or the larger of two numbers; NaN if either is NaN, which `f64::min` and `f64::max`
/// would drop.
fn choose<D: Number>(relation: Relation, left: D, right: D) -> D {
    let [a, b] = [left.value(), right.value()];
    if a.is_nan() || relation.holds(a, b) {
        left
    } else {
        right
    }
}
