//! How the nonlinear system of a step is solved.

/// The method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Solver {
    /// Newton's method on the whole step, contact in closed form.
    Newton,
    /// The paper's fixed point (4.1)-(4.5).
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

/// The method and when it stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The method.
    pub solver: Solver,
    /// η*: bound on the increment of the last iteration, in the norm of Theorem 3.4's left-hand side.
    pub tolerance: f64,
    /// Iterations after which a step is given up.
    pub max_iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { solver: Solver::Newton, tolerance: 1e-10, max_iterations: 100 }
    }
}
