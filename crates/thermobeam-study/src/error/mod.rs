//! The errors of a discrete level: in the norm of Theorem 3.4, and at the tip.
//!
//! Against an exact solution, or against a run of any order ([`Polynomials`]), whose own error is
//! negligible.

pub mod free_vibration;
pub mod polynomials;
pub mod reference;

use crate::error::polynomials::{OfAnyOrder, OfLinear, Polynomials, missing};
use crate::exact::any_order;
use crate::exact::errors::ErrorMeter;
use crate::exact::norm::Norm;
use crate::exact::solution::{Factors, Manufactured};
use crate::run::family::{Family, OnMesh};
use convergence_study::CaseFailure;
use thermobeam::dg::{self, DgLevel};
use thermobeam::solve::Level;

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

enum OneStepAnswer<'a> {
    Exact {
        exact: &'a Manufactured,
        meter: Box<(ErrorMeter, Factors)>,
        tip: Vec<f64>,
    },
    Computed(OfLinear<'a>),
}

/// Measures the levels of one mesh.
pub struct Evaluator<'a> {
    answer: OneStepAnswer<'a>,
}

impl<'a> Evaluator<'a> {
    /// Measures against `reference`, or against the family's exact solution if there is no
    /// reference.
    ///
    /// # Errors
    /// [`CaseFailure`] if there is neither.
    pub fn new(
        family: &'a Family,
        on: &OnMesh<'_>,
        reference: Option<&'a Polynomials>,
    ) -> Result<Self, CaseFailure> {
        let mesh = on.mesh();
        if let Some(reference) = reference {
            let answer = OneStepAnswer::Computed(OfLinear::new(mesh.clone(), reference));
            return Ok(Self { answer });
        }
        let exact = family.exact().ok_or_else(missing)?;
        let mut meter = ErrorMeter::new(exact, mesh, false);
        meter.lift(mesh, family.beam.theta_a);
        let answer = OneStepAnswer::Exact {
            exact,
            meter: Box::new((meter, Factors::default())),
            tip: exact.u.iter().map(|product| product.x.eval(1.0)).collect(),
        };
        Ok(Self { answer })
    }

    /// The errors of a level at time t, which is observation number `index` from 0.
    pub fn measure(&mut self, level: &Level, index: usize, t: f64) -> Errors {
        match &mut self.answer {
            OneStepAnswer::Exact { exact, meter, tip } => {
                let (meter, factors) = &mut **meter;
                factors.at(exact, t);
                let norm = meter.measure(level, factors)[Norm::Theorem34];
                let u: f64 = factors.u.value.iter().zip(tip).map(|(t, x)| t * *x).sum();
                let tip = (level.u[level.u.len() - 1] - u).abs();
                Errors { norm, tip }
            }
            OneStepAnswer::Computed(meter) => meter.errors(level, index),
        }
    }
}

enum AnyOrderAnswer<'a> {
    Exact(Box<any_order::ErrorMeter<'a>>),
    Computed(OfAnyOrder<'a>),
}

/// Measures the levels of one space of any order.
pub struct AnyOrderEvaluator<'a> {
    answer: AnyOrderAnswer<'a>,
}

impl<'a> AnyOrderEvaluator<'a> {
    /// Arguments as in [`Evaluator::new`].
    ///
    /// # Errors
    /// [`CaseFailure`] if there is neither a reference nor an exact solution.
    pub fn new(
        family: &'a Family,
        space: &'a dg::Space,
        reference: Option<&'a Polynomials>,
    ) -> Result<Self, CaseFailure> {
        let answer = match reference {
            Some(reference) => AnyOrderAnswer::Computed(OfAnyOrder::new(space, reference)),
            None => {
                let exact = family.exact().ok_or_else(missing)?;
                let meter = any_order::ErrorMeter::new(exact, family.beam.theta_a, space);
                AnyOrderAnswer::Exact(Box::new(meter))
            }
        };
        Ok(Self { answer })
    }

    /// The errors of a level, which is observation number `index` from 0.
    pub fn measure(&mut self, level: &DgLevel, index: usize) -> Errors {
        match &mut self.answer {
            AnyOrderAnswer::Exact(meter) => Errors {
                norm: meter.theorem_34(level),
                tip: meter.tip(level),
            },
            AnyOrderAnswer::Computed(meter) => meter.errors(level, index),
        }
    }
}
