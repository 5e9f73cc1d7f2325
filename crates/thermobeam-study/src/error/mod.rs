//! The error of a discrete level: in the norm of Theorem 3.4, to the interpolant (superclose), and at the tip.
//!
//! Against an exact solution, or against a run of any order ([`Traced`]), whose own error is negligible. The reference's mesh must
//! contain the nodes of the measured mesh; a coarse P1 function is then P1 on the fine mesh, and all norms are exact.

pub mod free_vibration;
pub mod reference;

use crate::error::reference::Traced;
use crate::exact::errors::ErrorMeter;
use crate::exact::norm::Norm;
use crate::exact::solution::{Factors, Manufactured, Product};
use crate::run::family::{Family, OnMesh};
use convergence_study::study::CaseFailure;
use thermobeam::mesh::Mesh;
use thermobeam::solve::Level;

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorMeasure {
    /// The norm of (3.14).
    Theorem34,
    /// The same norm of the distance to the nodal interpolant.
    Superclose,
    /// |u_h(1) - u(1)|.
    Tip,
}

impl ErrorMeasure {
    /// All measures, in the order of [`Evaluator::measure`].
    pub const ALL: [ErrorMeasure; 3] = [
        ErrorMeasure::Theorem34,
        ErrorMeasure::Superclose,
        ErrorMeasure::Tip,
    ];

    /// The name in files, reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            ErrorMeasure::Theorem34 => "theorem-3.4",
            ErrorMeasure::Superclose => "superclose",
            ErrorMeasure::Tip => "tip",
        }
    }
}

enum Answer<'a> {
    Exact {
        exact: &'a Manufactured,
        meter: Box<(ErrorMeter, Factors)>,
        tip: Vec<f64>,
    },
    Computed {
        reference: &'a Traced,
        mesh: Mesh,
    },
    Tip(&'a [f64]),
}

/// Measures the levels of one mesh.
pub struct Evaluator<'a> {
    answer: Answer<'a>,
}

impl<'a> Evaluator<'a> {
    /// Measures against `reference`, or against the family's exact solution if there is no reference.
    ///
    /// # Errors
    /// [`CaseFailure`] if there is neither, or if the reference's mesh does not contain the nodes.
    pub fn new(
        family: &'a Family,
        on: &OnMesh<'_>,
        reference: Option<&'a Traced>,
    ) -> Result<Self, CaseFailure> {
        let mesh = on.mesh();
        let answer = match (reference, family.exact()) {
            (Some(reference), _) if !reference.mesh.elements().is_multiple_of(mesh.elements()) => {
                return Err(CaseFailure::new(
                    "the reference's number of elements is no multiple of this mesh's",
                ));
            }
            (Some(reference), _) => Answer::Computed {
                reference,
                mesh: mesh.clone(),
            },
            (None, Some(exact)) => {
                let mut meter = ErrorMeter::new(exact, mesh, false);
                meter.lift(mesh, family.beam.theta_a);
                let tip = exact
                    .u
                    .iter()
                    .map(|product: &Product| product.x.eval(1.0))
                    .collect();
                Answer::Exact {
                    exact,
                    meter: Box::new((meter, Factors::default())),
                    tip,
                }
            }
            (None, None) => {
                return Err(CaseFailure::new(
                    "there is nothing to measure the error against",
                ));
            }
        };
        Ok(Self { answer })
    }

    /// Measures only u(1), against its values at the times of observation.
    pub(crate) fn of_tip(tip: &'a [f64]) -> Self {
        Self {
            answer: Answer::Tip(tip),
        }
    }

    /// The three errors of a level at time t, which is observation number `index` from 0; NaN if not measured.
    pub fn measure(&mut self, level: &Level, index: usize, t: f64) -> [f64; 3] {
        let u_tip = level.u[level.u.len() - 1];
        match &mut self.answer {
            Answer::Tip(tip) => [f64::NAN, f64::NAN, (u_tip - tip[index]).abs()],
            Answer::Exact { exact, meter, tip } => {
                let (meter, factors) = &mut **meter;
                factors.at(exact, t);
                let errors = meter.measure(level, factors);
                let u: f64 = factors.u.value.iter().zip(tip).map(|(t, x)| t * *x).sum();
                [
                    errors[Norm::Theorem34],
                    errors[Norm::Superclose],
                    (u_tip - u).abs(),
                ]
            }
            Answer::Computed { reference, mesh } => {
                let [full, nodal] = reference.errors_of(level, mesh, index);
                let fine = &reference.levels[index];
                [full, nodal, (u_tip - fine.u[fine.u.len() - 1]).abs()]
            }
        }
    }
}
