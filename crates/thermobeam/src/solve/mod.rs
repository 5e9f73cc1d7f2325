//! How the nonlinear system of a step is solved.

mod balance;
mod bound;
pub(crate) mod fixed_point;
pub(crate) mod newton;
mod root;
pub(crate) mod sweeps;

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
    /// Where Newton's iteration starts. The fixed point always starts from (4.1).
    pub start: Start,
}

impl Default for Settings {
    fn default() -> Self {
        Self { solver: Solver::Newton, tolerance: 1e-10, max_iterations: 100, start: Start::Extrapolated }
    }
}

/// Where Newton's iteration starts; it changes the number of passes, not the answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Start {
    /// Velocities and axial force extrapolated from the last three levels; the first level stands for those before it.
    #[default]
    Extrapolated,
    /// The level before, as (4.1) has it.
    Previous,
}

/// What a step took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Iterations, each at least one solve of the linear system.
    pub iterations: usize,
    /// Fixed point: the last increment. Newton: a bound on the increment that one more iteration would bring.
    pub increment: f64,
    /// Fixed point: ratio of the last two increments, where there were two.
    pub contraction: Option<f64>,
}

/// Counts of the work done: exact where times are noisy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// Solves of the whole step's linear system: a pass of Newton's method, an iteration of the fixed point.
    pub passes: usize,
    /// Factorisations of that system, or of the displacement's part in the fixed point.
    pub factorizations: usize,
    /// Evaluations of the loads.
    pub loads: usize,
    /// Levels handed to an observer.
    pub observations: usize,
}

impl Work {
    /// This work and another.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            passes: self.passes + other.passes,
            factorizations: self.factorizations + other.factorizations,
            loads: self.loads + other.loads,
            observations: self.observations + other.observations,
        }
    }
}

/// The discrete solution at one time level: n + 1 nodal values of each field.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Displacement u.
    pub u: Vec<f64>,
    /// Its velocity û.
    pub v: Vec<f64>,
    /// Rotation φ.
    pub phi: Vec<f64>,
    /// Its velocity φ̂.
    pub w: Vec<f64>,
    /// Lifted temperature θ~ = θ - θ_A (1 - x).
    pub theta: Vec<f64>,
    /// The contact force of the step that led here: g(u(1)), or its discrete gradient in the `midpoint` scheme.
    pub contact_force: f64,
}

impl Level {
    /// A level of zeros with so many nodes.
    pub fn new(nodes: usize) -> Self {
        let zeros = || vec![0.0; nodes];
        Self { u: zeros(), v: zeros(), phi: zeros(), w: zeros(), theta: zeros(), contact_force: 0.0 }
    }

    /// Is no node faster than `speed`, in u or φ? A velocity that is NaN is not slow.
    pub fn is_slow(&self, speed: f64) -> bool {
        self.v.iter().chain(&self.w).all(|rate| rate.abs() <= speed)
    }

    /// Takes over the values of a level with as many nodes.
    ///
    /// The derived `clone_from` would allocate five new vectors, in every step that is observed.
    pub(crate) fn copy_from(&mut self, other: &Level) {
        self.u.clone_from(&other.u);
        self.v.clone_from(&other.v);
        self.phi.clone_from(&other.phi);
        self.w.clone_from(&other.w);
        self.theta.clone_from(&other.theta);
        self.contact_force = other.contact_force;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_added_count_by_count() {
        let one = Work { passes: 1, factorizations: 2, loads: 3, observations: 4 };
        let other = Work { passes: 50, factorizations: 60, loads: 70, observations: 80 };
        assert_eq!(one.plus(other), Work { passes: 51, factorizations: 62, loads: 73, observations: 84 });
    }

    #[test]
    fn solver_names_are_those_of_the_scene_files() {
        assert_eq!(Solver::ALL.map(Solver::name), ["newton", "fixed-point"]);
    }
}
