//! Functions of one variable with two derivatives, for the factors of an exact solution.

use std::fmt::{self, Debug, Formatter};
use std::ops::Deref;
use std::sync::Arc;

use crate::expression::{Expression, samples};

/// A function of one variable with its first two derivatives.
pub trait Function: Send + Sync {
    /// Value, first and second derivative.
    fn derivatives(&self, at: f64) -> [f64; 3];

    /// The value.
    fn eval(&self, at: f64) -> f64 {
        self.derivatives(at)[0]
    }

    /// `max(|f| + |x f'|)` over samples of [0, end]; a derivative that is not finite there is
    /// omitted.
    fn size(&self, end: f64) -> f64 {
        samples(end)
            .map(|at| {
                let [value, first, _] = self.derivatives(at);
                let slope = (at * first).abs();
                value.abs() + if slope.is_finite() { slope } else { 0.0 }
            })
            .fold(0.0, f64::max)
    }

    /// The expected rounding error of a value on [0, end].
    ///
    /// `8 ε max(|f| + |x f'|)`: the second term is the effect of a rounding error in x.
    fn roundoff(&self, end: f64) -> f64 {
        // A handful of operations, each with an error of half an ε, of operands about as large as
        // the result.
        const ROUNDINGS: f64 = 8.0;
        ROUNDINGS * f64::EPSILON * self.size(end)
    }
}

impl<F: Fn(f64) -> [f64; 3] + Send + Sync> Function for F {
    fn derivatives(&self, at: f64) -> [f64; 3] {
        self(at)
    }
}

impl Function for Expression {
    fn derivatives(&self, at: f64) -> [f64; 3] {
        self.derivatives(at)
    }

    // This costs a third of the evaluation with derivatives.
    fn eval(&self, at: f64) -> f64 {
        self.eval(at)
    }
}

/// A function that several products may share.
///
/// ```
/// use thermobeam_exact::function::Factor;
///
/// let cubic = Factor::new(|x: f64| [x.powi(3), 3.0 * x.powi(2), 6.0 * x]);
/// assert_eq!(cubic.eval(2.0), 8.0);
/// ```
#[derive(Clone)]
pub struct Factor(Arc<dyn Function>);

impl Debug for Factor {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("Factor")
    }
}

impl Factor {
    /// The factor for this function; a closure returns value, first and second derivative.
    pub fn new(function: impl Function + 'static) -> Self {
        Self(Arc::new(function))
    }
}

impl From<Expression> for Factor {
    fn from(expression: Expression) -> Self {
        Self::new(expression)
    }
}

impl Deref for Factor {
    type Target = dyn Function;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}
