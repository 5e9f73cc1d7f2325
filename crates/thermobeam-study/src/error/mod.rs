//! The errors of a discrete level: in the norm of Theorem 3.4, and at the tip.
//!
//! Against an exact solution, or against a run of any order ([`Polynomials`]), whose own error is
//! negligible.

pub mod free_vibration;
pub mod polynomials;
pub mod reference;

use crate::error::polynomials::{OfPolynomials, Polynomials, missing};
use crate::exact::{
    any_order,
    errors::ErrorMeter,
    norm::Norm,
    solution::{Factors, Manufactured},
};
use crate::run::{family::Family, levels::of_linear};
use convergence_study::CaseFailure;
use thermobeam::dg::{self, DgLevel};

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorMeasure {
    /// The norm of (3.14).
    Theorem34,
    /// |u_h(1) - u(1)|.
    Tip,
}

impl ErrorMeasure {
    /// All measures.
    pub const ALL: [ErrorMeasure; 2] = [ErrorMeasure::Theorem34, ErrorMeasure::Tip];

    /// The name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            ErrorMeasure::Theorem34 => "theorem-3.4",
            ErrorMeasure::Tip => "tip",
        }
    }

    /// The name in titles and on axes.
    pub fn in_words(self) -> &'static str {
        match self {
            ErrorMeasure::Theorem34 => "the norm of Theorem 3.4",
            ErrorMeasure::Tip => "u(1, t)",
        }
    }
}

/// The errors of a level, or the largest over time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// In the norm of (3.14).
    pub norm: f64,
    /// |u_h(1) - u(1)|.
    pub tip: f64,
}

impl Errors {
    /// The error in a measure.
    pub fn of(self, measure: ErrorMeasure) -> f64 {
        match measure {
            ErrorMeasure::Theorem34 => self.norm,
            ErrorMeasure::Tip => self.tip,
        }
    }
}

/// Measures the levels of one space; those of a one-step scheme are polynomials of degree 1.
pub(crate) enum Evaluator<'a> {
    /// Against an exact solution.
    Exact(Box<any_order::ErrorMeter<'a>>),
    /// On linear elements, where the exact solution is integrated once and not at each level.
    Linear(&'a Manufactured, Box<(ErrorMeter, Factors)>),
    /// Against a run of any order.
    Computed(OfPolynomials<'a>),
}

impl<'a> Evaluator<'a> {
    /// Measures against `reference`, or against the family's exact solution if there is no
    /// reference.
    ///
    /// # Errors
    /// [`CaseFailure`] if there is neither.
    pub(crate) fn new(
        family: &'a Family,
        space: &'a dg::Space,
        reference: Option<&'a Polynomials>,
    ) -> Result<Self, CaseFailure> {
        Ok(match reference {
            Some(reference) => Self::Computed(OfPolynomials::new(space, reference)),
            None => {
                let exact = family.exact().ok_or_else(missing)?;
                let theta_a = family.beam.theta_a;
                if space.degree() == 1 {
                    let mut meter = ErrorMeter::new(exact, space.mesh(), false);
                    meter.lift(space.mesh(), theta_a);
                    Self::Linear(exact, Box::new((meter, Factors::default())))
                } else {
                    let meter = any_order::ErrorMeter::new(exact, theta_a, space);
                    Self::Exact(Box::new(meter))
                }
            }
        })
    }

    /// The errors of a level, which is observation number `index` from 0.
    pub(crate) fn measure(&mut self, level: &DgLevel, index: usize) -> Errors {
        match self {
            Self::Exact(meter) => Errors {
                norm: meter.theorem_34(level),
                tip: meter.tip(level),
            },
            Self::Linear(exact, meter) => {
                let (meter, factors) = &mut **meter;
                factors.at(exact, level.t);
                let nodal = of_linear(level);
                let tip = nodal.u.last().copied().unwrap_or(f64::NAN);
                Errors {
                    norm: meter.measure(&nodal, factors)[Norm::Theorem34],
                    tip: (tip - exact.tip(level.t)).abs(),
                }
            }
            Self::Computed(meter) => meter.errors(level, index),
        }
    }
}
