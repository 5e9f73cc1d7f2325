//! The errors of a simulation, for any method: what failed, where and when, and what to change.

use std::fmt;

use crate::kirchhoff::BUCKLING;
use crate::mesh::MeshError;
use crate::parameters::ParameterError;
use thiserror::Error;

/// A step that failed. The simulation stays at the previous time level.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("step {step} (from t = {t}, length {dt:e}): {failure}")]
#[non_exhaustive]
pub struct StepError {
    /// Number n of the step, counted from 1.
    pub step: usize,
    /// The time at which it starts.
    pub t: f64,
    /// Its length.
    pub dt: f64,
    /// The cause.
    pub failure: StepFailure,
}

/// The cause of a failed step.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StepFailure {
    /// The increments of the iteration do not decrease.
    #[error(
        "the iteration diverges{}: expected a contraction factor below 1, found {contraction:.3e} (increment \
         {increment:.3e} after {iterations} iterations): take a smaller dt{}",
        of.map_or(String::new(), |of| format!(" in the loop of {of}")), other_advice(*of)
    )]
    Diverged {
        /// Number of iterations done.
        iterations: usize,
        /// The last increment.
        increment: f64,
        /// Ratio of the last two increments.
        contraction: f64,
        /// The loop of the fixed point with the largest factor.
        of: Option<Loop>,
    },
    /// The increments decrease, but not below the tolerance within the allowed number of
    /// iterations.
    #[error(
        "the iteration is too slow: expected an increment below the tolerance, found {increment:.3e} after \
         {iterations} iterations (contraction factor {contraction:.3e}): allow more iterations, or take a larger \
         tolerance or a smaller dt"
    )]
    IterationLimit {
        /// Number of iterations done.
        iterations: usize,
        /// The last increment.
        increment: f64,
        /// Ratio of the last two increments.
        contraction: f64,
    },
    /// The solution is infinite or NaN.
    #[error(
        "expected a finite solution, found an infinite value or NaN after {iterations} iterations (last finite \
         increment {increment:.3e}): check the loads, or take a smaller dt"
    )]
    NonFinite {
        /// Number of iterations done.
        iterations: usize,
        /// The last finite increment; NaN if there is none.
        increment: f64,
    },
    /// The matrix of the step is not positive definite, or not quasi-definite with the temperature.
    #[error(
        "the matrix of the step is not positive definite: expected a pivot of the right sign, found {pivot:.3e} at \
         node {node} for the axial force {n_value:.6}: {}", advice(*pivot, *n_value, *of)
    )]
    Indefinite {
        /// Node of the pivot.
        node: usize,
        /// The pivot.
        pivot: f64,
        /// The mean axial force of the matrix.
        n_value: f64,
        /// Which matrix it is.
        of: StepMatrix,
    },
    /// More contact events within the smallest step of dG than an impact explains.
    #[error(
        "{events} contact events within {within:.3e} (take a smaller restart_dt: the tip's motion is not resolved)"
    )]
    EventsTooClose {
        /// Number of events.
        events: usize,
        /// The time in which they occurred.
        within: f64,
    },
    /// A contact event that the polynomial of a dG step predicts, but that no step length hits.
    #[error("no step ends on the obstacle: the tip misses it by {miss:.3e} (take a smaller dt)")]
    EventNotFound {
        /// Distance of the tip from the obstacle at the end of the last attempt.
        miss: f64,
    },
    /// The contact phase of dG contradicts the motion: closed contact pulls, or the open free end
    /// penetrates.
    #[error(
        "contact contradicts the motion of the free end by a force of {force:.3e}: it pulls where it is closed, or penetrates \
         where it is open (rounding errors of the position are a force of {noise:.3e}: take a larger epsilon)"
    )]
    WrongContact {
        /// The force with the wrong sign.
        force: f64,
        /// Rounding errors of the position, divided by ε.
        noise: f64,
    },
}

/// Other remedies for a fixed point that diverges.
fn other_advice(of: Option<Loop>) -> &'static str {
    match of {
        Some(Loop::Contact) => ", a larger epsilon, or the solver \"newton\"",
        Some(_) => ", or the solver \"newton\"",
        None => "",
    }
}

/// The matrices that a step factorises.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepMatrix {
    /// That of a single field in (4.2).
    OneField,
    /// That of u, φ and θ together in (3.7).
    Coupled,
    /// That of dG.
    AnyOrder,
}

impl StepMatrix {
    /// The dt, in units of ζ, up to which the matrix is definite on every mesh for an axial force:
    /// THEORY.md, "How many solutions a step has". `None` if that is every dt, or not known.
    fn longest_step(self, n_value: f64) -> Option<f64> {
        // 2 s/(-s - N), s being the least stiffness that compression must exceed.
        let stiffness = match self {
            Self::OneField => 1.0,
            Self::Coupled => BUCKLING,
            Self::AnyOrder => return None,
        };
        (n_value < -stiffness).then(|| 2.0 * stiffness / (-stiffness - n_value))
    }
}

/// What to change after a lost pivot: NaN indicates an overflow, not buckling.
fn advice(pivot: f64, n_value: f64, of: StepMatrix) -> String {
    if !pivot.is_finite() {
        return "take coefficients, dt and elements of less extreme size, because an entry of the matrix is too large for a \
                floating-point number"
            .to_owned();
    }
    let smaller = "take a smaller dt, because the beam is loaded beyond its buckling force";
    match of.longest_step(n_value) {
        Some(longest) => {
            let digits: f64 = format!("{longest:.2e}").parse().unwrap_or(longest);
            format!("{smaller}: dt <= {digits:?} zeta is enough for this axial force")
        }
        None => smaller.to_owned(),
    }
}

/// A simulation that cannot be set up.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SetupError {
    /// A coefficient, a time step, a degree, a tolerance or an iteration limit out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Nodes that do not form a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A vector with the wrong number of entries.
    #[error("{field}: expected {expected} values, found {found}")]
    Length {
        /// Name of the vector.
        field: &'static str,
        /// Number of values given.
        found: usize,
        /// Number of values needed.
        expected: usize,
    },
    /// Initial data that are not finite.
    #[error("initial {field} at node {node}: expected a finite number, found {found}")]
    NotFinite {
        /// Name of the field.
        field: &'static str,
        /// Index of the node.
        node: usize,
        /// The value.
        found: f64,
    },
    /// Initial data of any degree that are not finite.
    #[error(
        "initial {field} between x = {from} and x = {to}: expected finite numbers, found {found}"
    )]
    NotFiniteBetween {
        /// Name of the field.
        field: &'static str,
        /// The projection's coefficient that is not finite.
        found: f64,
        /// Left end of the element.
        from: f64,
        /// Right end of the element.
        to: f64,
    },
    /// Initial data that violate a boundary condition of (1.3).
    #[error(
        "initial {field} at x = {x}: expected {allowed} from the boundary condition, found {found}"
    )]
    Boundary {
        /// Name of the field.
        field: &'static str,
        /// The end of the beam.
        x: f64,
        /// The value.
        found: f64,
        /// The boundary value.
        allowed: f64,
    },
    /// A method that cannot do what is requested.
    #[error("scheme: expected {allowed}, found {found}")]
    Method {
        /// Its name.
        found: &'static str,
        /// The methods allowed, in words.
        allowed: &'static str,
    },
}

/// A loop by which an error of an iterate returns to its field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loop {
    /// Between the free end and the contact force.
    Contact,
    /// Between displacement and rotation.
    Rotation,
    /// Between rotation and temperature.
    Heat,
    /// Between displacement and axial force.
    AxialForce,
}

impl fmt::Display for Loop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Loop::Contact => "displacement and contact force",
            Loop::Rotation => "displacement and rotation",
            Loop::Heat => "rotation and temperature",
            Loop::AxialForce => "displacement and axial force",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckling_is_blamed_for_a_pivot_of_the_wrong_sign_only() {
        let said = |pivot| {
            StepFailure::Indefinite {
                node: 1,
                pivot,
                n_value: 0.0,
                of: StepMatrix::Coupled,
            }
            .to_string()
        };
        assert!(
            said(-1.0).ends_with("the beam is loaded beyond its buckling force"),
            "{}",
            said(-1.0)
        );
        for pivot in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let said = said(pivot);
            assert!(
                !said.contains("buckling")
                    && said.contains("too large for a floating-point number"),
                "{said}"
            );
        }
    }
}
