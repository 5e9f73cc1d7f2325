//! The coefficients of a step, and the state of one case in the Newton iteration: scalars of the
//! current step, and those kept from step to step.

use crate::contact::Tip;
use crate::lanes::Lane;
use crate::motion::Work;
use crate::norms::slope_squared;
use crate::scheme::SteppedBeam;
use crate::solve::TimeLevel;

/// The coefficients of a step that do not depend on the node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scalars<T> {
    pub(super) dt: T,
    pub(super) half_dt: T,
    pub(super) zeta: T,
    /// s = ζ + dt/2, the factor of W in `φ½ + ζ W = φ0 + s W`.
    pub(super) stiff: T,
    /// κ, the factor of `M (V - v0)`.
    pub(super) inertia: T,
    pub(super) two_over_dt: T,
    pub(super) half_a: T,
    /// `a θ_A`. The lifting contributes `a θ_A (1 - x, N_i') = a θ_A (1, N_i)`: a constant under
    /// the mass matrix.
    pub(super) lift: T,
}

/// An element.
#[derive(Debug, Clone, Copy)]
pub(super) struct ElementLengths<T> {
    /// 1/h.
    pub(super) inverse: T,
    /// h/6, the unit of the consistent mass matrix.
    pub(super) sixth: T,
}

impl<T: Lane> ElementLengths<T> {
    /// That of case k.
    #[inline(always)]
    pub(super) fn of_lane(&self, k: usize) -> ElementLengths<f64> {
        ElementLengths {
            inverse: self.inverse.lane(k),
            sixth: self.sixth.lane(k),
        }
    }
}

/// The state of one case.
#[derive(Debug, Clone, Copy)]
pub(super) struct Control {
    /// ‖u_x‖² at the old level.
    pub(super) slope_squared: f64,
    /// N at the last three levels, the latest first.
    pub(super) forces: [f64; 3],
    /// m̄, for which the matrix was factorised; NaN without a valid factorisation.
    pub(super) factorized: f64,
    /// m of the current pass.
    pub(super) m: f64,
    /// ‖u_x‖² of the iterate.
    pub(super) new_slope_squared: f64,
    /// ‖δV_x‖ of the last pass.
    pub(super) increment_slope: f64,
    /// The tip of the iterate.
    pub(super) tip: Tip,
    /// The contact force of the step that led to the old level.
    pub(super) force: f64,
    pub(super) iterations: usize,
    /// Bound on the next increment.
    pub(super) increment: f64,
    pub(super) state: Progress,
    /// Passes and factorisations for this case, the same number as in a single run.
    pub(super) work: Work,
}

/// The stage of a case within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Progress {
    /// Iterating with the kept factorisation.
    Iterating,
    /// The iterate is within the tolerance.
    Accepted,
    /// The safeguarded iteration must solve it.
    NeedsSafeguard,
    /// In the safeguarded iteration, which treats one case at a time.
    Safeguarded,
    /// The step has failed.
    Failed,
}

impl Control {
    /// At the given level, before the first step.
    pub(super) fn new(case: &SteppedBeam, level: &TimeLevel) -> Self {
        let slope_squared = slope_squared(&case.lengths, &level.u);
        let (u, force) = (level.u[level.u.len() - 1], level.contact_force);
        Self {
            slope_squared,
            forces: [case.beam.axial_force(slope_squared); 3],
            factorized: f64::NAN,
            m: f64::NAN,
            new_slope_squared: f64::NAN,
            increment_slope: f64::NAN,
            tip: Tip {
                u,
                force,
                stiffness: 0.0,
            },
            force,
            iterations: 0,
            increment: f64::NAN,
            state: Progress::Iterating,
            work: Work::default(),
        }
    }
}
