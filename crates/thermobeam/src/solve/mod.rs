//! The solvers of a step, (3.7)-(3.8): their settings, their reports, and the discrete solution.

mod balance;
mod bound;
mod control;
pub(crate) mod fixed_point;
pub(crate) mod newton;
mod root;
pub(crate) mod stepper;
mod sweeps;

pub use crate::level::TimeLevel;

/// The method that solves the nonlinear system of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Solver {
    /// Newton's method on the whole step, with the contact law solved in closed form.
    Newton,
    /// The paper's fixed-point iteration (4.1)-(4.5).
    FixedPoint,
}

impl Solver {
    /// All methods.
    pub const ALL: [Solver; 2] = [Solver::Newton, Solver::FixedPoint];

    /// The name in scene and study files.
    pub fn name(self) -> &'static str {
        match self {
            Solver::Newton => "newton",
            Solver::FixedPoint => "fixed-point",
        }
    }
}

/// The method and its stopping criterion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The method.
    pub solver: Solver,
    /// When its iteration ends.
    pub stopping: Stopping,
    /// Initial iterate of Newton's method. The fixed point always starts from (4.1).
    pub start: Start,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            solver: Solver::Newton,
            stopping: Stopping::default(),
            start: Start::Extrapolated,
        }
    }
}

/// When the iteration of a step ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stopping {
    /// As soon as the increment is small; a step that needs too many iterations fails.
    Converged {
        /// η* > 0, the bound on the last increment in the norm of (3.14); see
        /// [`StepReport::increment`](crate::motion::StepReport::increment).
        tolerance: f64,
        /// Largest number of iterations of a step, at least 1.
        max_iterations: usize,
    },
    /// After exactly this number of iterations, at least 1, without a test: the paper's "L times"
    /// (Section 4, before (4.5)). Only the fixed point can stop in this way. Its steps are then not
    /// solved, so the energy balance has a defect.
    Iterations(usize),
}

impl Default for Stopping {
    fn default() -> Self {
        Self::below(1e-10)
    }
}

impl Stopping {
    /// Until the increment is at most `tolerance`, with at most 100 iterations.
    pub fn below(tolerance: f64) -> Self {
        Self::Converged {
            tolerance,
            max_iterations: 100,
        }
    }

    /// The same criterion with another largest number of iterations; without a test the number
    /// stays.
    #[must_use]
    pub fn with_limit(self, max_iterations: usize) -> Self {
        match self {
            Self::Converged { tolerance, .. } => Self::Converged {
                tolerance,
                max_iterations,
            },
            Self::Iterations(_) => self,
        }
    }

    /// The bound on the increment; `None` if nothing is tested.
    pub fn tolerance(self) -> Option<f64> {
        match self {
            Self::Converged { tolerance, .. } => Some(tolerance),
            Self::Iterations(_) => None,
        }
    }

    /// Largest number of iterations of a step.
    pub fn max_iterations(self) -> usize {
        match self {
            Self::Converged { max_iterations, .. } => max_iterations,
            Self::Iterations(iterations) => iterations,
        }
    }
}

/// Initial iterate of Newton's method. It changes the number of passes; the result changes within
/// the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Start {
    /// Velocities and axial force, extrapolated from the last three levels. At the start the
    /// missing levels are copies of the first.
    #[default]
    Extrapolated,
    /// The previous level, as in (4.1).
    Previous,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solver_names_are_those_of_the_scene_files() {
        assert_eq!(Solver::ALL.map(Solver::name), ["newton", "fixed-point"]);
    }
}
