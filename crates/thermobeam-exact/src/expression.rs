//! Functions of one variable in mathematical notation.
//!
//! | text | meaning |
//! | --- | --- |
//! | `-x^2` | -(x²): a power has precedence over a sign |
//! | `2^3^2` | 2⁹ = 512: powers are right-associative |
//! | `2^-1`, `2*-x` | a sign may follow an operator |
//! | `1e-3`, `.5`, `2.` | numbers |
//! | `pi`, `e` | constants |
//! | `sin cos tan asin acos atan sinh cosh tanh exp ln log10 sqrt abs` | functions of one argument |
//! | `min max` | functions of two arguments |
//!
//! A product needs its `*`: `2x` is an error. The syntax tree is evaluated on `f64` and on
//! second-order dual numbers, which give exact derivatives.

mod error;
mod parser;
mod syntax;

use std::fmt;

use num_dual::Dual2_64;

pub use error::NotFinite;
pub use manufacture::language::SyntaxError as ExpressionError;
use syntax::SyntaxNode;
use thermobeam::bracket::bisect;

/// The variable of a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Variable {
    /// Position along the beam.
    X,
    /// Time.
    T,
    /// Parameter of a mesh map.
    S,
}

impl Variable {
    /// Its name in the text.
    pub fn name(self) -> &'static str {
        match self {
            Variable::X => "x",
            Variable::T => "t",
            Variable::S => "s",
        }
    }
}

/// A function of one variable and its text.
///
/// ```
/// use thermobeam_exact::expression::{Expression, Variable};
///
/// let f = Expression::parse("x^3 - 2*x", Variable::X)?;
/// assert_eq!(f.eval(2.0), 4.0);
/// assert_eq!(f.derivatives(0.0), [0.0, -2.0, 0.0]);
/// # Ok::<(), thermobeam_exact::expression::ExpressionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    source: String,
    variable: Variable,
    root: SyntaxNode,
}

impl Expression {
    /// Parses a function of `variable`.
    ///
    /// # Errors
    /// [`ExpressionError`] with the position of the error in the text.
    pub fn parse(source: &str, variable: Variable) -> Result<Self, ExpressionError> {
        let root = parser::parse(source, variable)?;
        Ok(Self {
            source: source.to_owned(),
            variable,
            root,
        })
    }

    /// The text from which it was parsed.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// The value at `x`; infinite or NaN outside the domain of the function.
    pub fn eval(&self, x: f64) -> f64 {
        self.root.eval(x)
    }

    /// Value, first and second derivative at `x`.
    ///
    /// At a kink (`abs`, `min`, `max`) the derivatives are those of one of the two sides.
    pub fn derivatives(&self, x: f64) -> [f64; 3] {
        let Dual2_64 { re, v1, v2 } = self.root.eval(Dual2_64::new(x, 1.0, 0.0));
        [re, v1, v2]
    }

    /// Checks that the function and its derivatives up to `order` (0, 1 or 2) are finite on
    /// [0, end].
    ///
    /// The function is sampled, and between samples a pole is found if its divisor changes sign.
    ///
    /// # Errors
    /// [`NotFinite`] for the first sample with an infinite value or NaN, or next to a pole.
    pub fn check_finite(&self, end: f64, order: usize) -> Result<(), NotFinite> {
        for at in samples(end) {
            // The values are those of `eval`, because the solver uses it.
            let [_, first, second] = if order == 0 {
                [0.0; 3]
            } else {
                self.derivatives(at)
            };
            for (order, found) in [self.eval(at), first, second]
                .into_iter()
                .enumerate()
                .take(order + 1)
            {
                if !found.is_finite() {
                    return Err(NotFinite {
                        variable: self.variable,
                        at,
                        end,
                        order,
                        found,
                    });
                }
            }
        }
        match self.pole(end) {
            None => Ok(()),
            Some(at) => Err(NotFinite {
                variable: self.variable,
                at,
                end,
                order: 0,
                // It is only large where it was looked at.
                found: f64::INFINITY,
            }),
        }
    }

    /// A place next to which a divisor changes sign, and the value grows without bound.
    fn pole(&self, end: f64) -> Option<f64> {
        let points: Vec<f64> = samples(end).collect();
        let sizes = points.iter().map(|x| self.eval(*x).abs());
        let largest = sizes.fold(f64::MIN_POSITIVE, f64::max);
        let mut changes = self
            .changes_of_sign(SyntaxNode::push_divisors, &points)
            .into_iter();
        changes.find(|x| self.eval(x + NEXT_TO_POLE * end).abs() > UNBOUNDED * largest)
    }

    /// The points of [0, 1] at which `abs`, `min` or `max` change branch, in increasing order.
    ///
    /// A change is a change of sign of the argument of `abs`, or of the difference of the two
    /// arguments. It is seen between points that are 1/10080 apart, and next to the other changes:
    /// two changes of one function that are closer than that are found only if a change of another
    /// function is between them, as in a narrow hat `max(0, 1 - abs(x - c)/w)`.
    pub fn kinks(&self) -> Vec<f64> {
        let mut kinks = vec![];
        if self.numbers(SyntaxNode::push_branches, 0.0).is_empty() {
            return kinks;
        }
        let mut points: Vec<f64> = evenly_spaced(1.0, BRANCH_SAMPLES).collect();
        loop {
            let changes = self.changes_of_sign(SyntaxNode::push_branches, &points);
            if changes.len() == kinks.len() {
                return changes;
            }
            points.extend(&changes);
            points.sort_by(f64::total_cmp);
            kinks = changes;
        }
    }

    /// The changes of sign of some numbers between neighbouring points.
    fn changes_of_sign(&self, push: Push, points: &[f64]) -> Vec<f64> {
        let mut changes = vec![];
        let mut before = self.numbers(push, points[0]);
        for pair in points.windows(2) {
            let after = self.numbers(push, pair[1]);
            for index in
                (0..after.len()).filter(|&index| (before[index] < 0.0) != (after[index] < 0.0))
            {
                changes.push(self.change_of_sign(push, index, [pair[0], pair[1]]));
            }
            before = after;
        }
        changes.sort_by(f64::total_cmp);
        changes.dedup_by(|next, x| *next - *x <= 4.0 * f64::EPSILON);
        changes
    }

    /// The point where a number changes sign; of the two neighbouring floats the one where it is
    /// not negative.
    fn change_of_sign(&self, push: Push, index: usize, ends: [f64; 2]) -> f64 {
        let number = |x: f64| self.numbers(push, x)[index];
        let [negative, other] = if number(ends[0]) < 0.0 {
            ends
        } else {
            [ends[1], ends[0]]
        };
        bisect(|x| -number(x), negative, other)
    }

    /// Numbers of the function at `x`, in the order of the text.
    fn numbers(&self, push: Push, x: f64) -> Vec<f64> {
        let mut numbers = vec![];
        push(&self.root, x, &mut numbers);
        numbers
    }
}

/// Appends numbers of a function at a point: those that select branches, or that divide.
type Push = fn(&SyntaxNode, f64, &mut Vec<f64>);

/// A distance from a pole, in lengths of the interval, and how many times larger the value is there
/// than the largest sample.
const NEXT_TO_POLE: f64 = 1e-9;
const UNBOUNDED: f64 = 1e3;

/// Samples of an interval: a multiple of every number up to 10, so that 1/3 and 0.1 are sampled
/// exactly.
const SAMPLES: u32 = 2520;

/// The same for changes of branch, which may be 1e-4 apart.
const BRANCH_SAMPLES: u32 = 4 * SAMPLES;

/// Evenly spaced points of [0, end], including both ends.
pub(crate) fn samples(end: f64) -> impl Iterator<Item = f64> {
    evenly_spaced(end, SAMPLES)
}

fn evenly_spaced(end: f64, parts: u32) -> impl Iterator<Item = f64> {
    (0..=parts).map(move |i| end * (f64::from(i) / f64::from(parts)))
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.source)
    }
}
