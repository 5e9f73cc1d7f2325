//! A running simulation by a one-step scheme: time limit, loads, step, levels shown to an observer.

use std::time::{Duration, Instant};

use convergence_judge::time_limit::Patience;
use thermobeam::energy::Balance;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::motion::{Motion, StepReport};
use thermobeam::one_step::{OneStep, Problem, Stepping};
use thermobeam::parameters::Obstacles;
use thermobeam::solve::TimeLevel;

use super::energy::EnergySummary;
use super::levels::{MOST_POINTS, on_mesh, thinned};
use super::{BALANCE, EnergySize, Loaded, ObservableMotion, RunError, Sample, Unsound};

/// Steps between checks of the energy: one evaluation costs a fifth of a step, one in sixteen steps
/// a hundredth.
const CHECKED: usize = 16;

/// Rounding errors of an energy, relative to it: of sums over at most millions of elements, whose
/// errors mostly cancel.
const ROUNDED: f64 = 1e-12;

/// Maximum number of rows of a history: every step up to this number, then every second, third, ...
/// step.
const MOST_ROWS: usize = 200_000;

/// A running simulation.
pub(crate) struct Driver<'l> {
    simulation: OneStep,
    /// The level before the last step.
    old: TimeLevel,
    /// The current level.
    new: TimeLevel,
    /// The energy at t = 0, and its size.
    initial: f64,
    size: f64,
    is_solved: bool,
    patience: Patience,
    wall: Duration,
    is_timed: bool,
    /// Computes the loads of a step at its middle.
    fill: Box<Fill<'l>>,
}

/// Writes the loads at a time.
type Fill<'l> = dyn FnMut(f64, &mut [[f64; 3]]) + 'l;

impl<'l> Driver<'l> {
    /// Starts at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] if the solver refuses the problem.
    pub(crate) fn new(problem: Problem, stepping: Stepping) -> Result<Self, SetupError> {
        let is_solved = stepping.settings.stopping.tolerance().is_some();
        let simulation = OneStep::new(problem, stepping)?;
        let old = simulation.level();
        let (new, patience) = (old.clone(), Patience::new(simulation.lengths().len()));
        let (initial, size) = (
            simulation.energy(&old).total(),
            simulation.energy_scale(&old),
        );
        Ok(Self {
            simulation,
            old,
            new,
            initial,
            size,
            is_solved,
            patience,
            wall: Duration::ZERO,
            is_timed: false,
            fill: Box::new(|_, _| ()),
        })
    }

    /// Fills the loads of each step at its middle t_{n-½}; [`Stepping::loaded`] must be set.
    pub(crate) fn loaded(self, fill: impl FnMut(f64, &mut [[f64; 3]]) + 'l) -> Self {
        Self {
            fill: Box::new(fill),
            ..self
        }
    }

    /// Reads the clock before and after each step, at a cost of some 50 ns.
    pub(crate) fn timed(self) -> Self {
        Self {
            is_timed: true,
            ..self
        }
    }

    /// The simulation.
    pub(crate) fn simulation(&self) -> &OneStep {
        &self.simulation
    }

    /// The current level.
    pub(crate) fn level(&self) -> &TimeLevel {
        &self.new
    }

    /// The level before the last step.
    pub(crate) fn old_level(&self) -> &TimeLevel {
        &self.old
    }

    /// Solves a step and reads the level at its end.
    #[expect(clippy::disallowed_methods, reason = "the loop steps by it")]
    fn step_once(&mut self) -> Result<StepReport, RunError> {
        let Self {
            simulation,
            patience,
            fill,
            ..
        } = self;
        patience.check(simulation.steps(), || simulation.t())?;
        let middle = (simulation.steps() as f64 + 0.5) * simulation.dt();
        if let Some(load) = simulation.load_mut() {
            fill(middle, load);
        }
        let started = self.is_timed.then(Instant::now);
        let outcome = self.simulation.step_once();
        self.wall += started.map(|started| started.elapsed()).unwrap_or_default();
        let report = outcome?;
        self.patience.also(report.iterations.saturating_sub(1));
        std::mem::swap(&mut self.old, &mut self.new);
        self.simulation.observe(&mut self.new);
        Ok(report)
    }
}

impl ObservableMotion for Driver<'_> {
    fn motion(&self) -> &dyn Motion {
        &self.simulation
    }

    fn step(&mut self, until: f64) -> Result<Option<StepReport>, RunError> {
        if self.simulation.has_reached(until) {
            return Ok(None);
        }
        self.step_once().map(Some)
    }

    /// What is wrong with the current level: an energy that is not finite or has risen since t = 0,
    /// where no exactly solved step raises it. A load may.
    ///
    /// Looks at the energy after 1, 2, 4, 8 steps and every [`CHECKED`] steps, and wherever u(1) is
    /// not finite.
    fn unsound(&self) -> Option<Unsound> {
        let n = self.simulation.steps();
        let is_due = n.is_multiple_of(CHECKED) || n.is_power_of_two();
        if self.simulation.is_loaded() || !is_due && self.new.u[self.new.u.len() - 1].is_finite() {
            return None;
        }
        let Self { initial, size, .. } = *self;
        let last = self.simulation.energy(&self.new).total();
        // Both energies are rounded, and contain the constant of Kirchhoff's term.
        let largest_increase = last - initial - ROUNDED * initial.abs();
        let energy = EnergySummary {
            initial,
            last,
            largest_increase,
            largest_balance_residual: 0.0,
            size,
            is_loaded: false,
        };
        energy.sound(|| self.energy_size()).err()
    }

    fn sample(&mut self) -> Sample {
        let (simulation, level) = (&self.simulation, &self.new);
        let Problem {
            beam,
            obstacles,
            mesh,
            ..
        } = simulation.problem();
        let energy = simulation.energy(level).total();
        let sample = Sample::of(level, simulation.t(), mesh, beam.theta_a, energy);
        // No step leads to the start, so its contact force is that of the law.
        if simulation.steps() == 0 {
            sample.at_the_start(*obstacles)
        } else {
            sample
        }
    }

    /// At its end: the scheme has no values inside.
    fn inside(&mut self, _: f64) -> Sample {
        self.sample()
    }

    fn balance(&self) -> Result<Balance, Loaded> {
        self.refuse_loads(BALANCE)?;
        Ok(self.simulation.balance(&self.old, &self.new))
    }

    fn wall(&self) -> Duration {
        self.wall
    }

    fn energy_size(&self) -> EnergySize {
        EnergySize {
            terms: self.simulation.energy_scale(&self.new),
            rounding: self.simulation.rounding(&self.old, &self.new).total(),
            is_solved: self.is_solved,
        }
    }

    fn parts(&self, t_end: f64, count: usize) -> Vec<f64> {
        let steps = (t_end / self.simulation.dt()).round() as usize;
        let stride = steps.div_ceil(count).max(1);
        let is_shown = self.simulation.steps().is_multiple_of(stride);
        is_shown.then(|| self.simulation.t()).into_iter().collect()
    }

    fn rows(&self) -> usize {
        MOST_ROWS
    }

    fn points(&self) -> Vec<f64> {
        thinned(self.simulation.problem().mesh.nodes(), MOST_POINTS)
    }

    fn shape(&self, _: f64) -> Vec<f64> {
        thinned(&self.new.u, MOST_POINTS)
    }

    fn on(&self, mesh: &Mesh) -> TimeLevel {
        TimeLevel {
            contact_force: 0.0,
            ..on_mesh(&self.new, &self.simulation.problem().mesh, mesh)
        }
    }
}

/// The value of a P1 function at x = 1/2.
fn middle(mesh: &Mesh, y: &[f64]) -> f64 {
    let nodes = mesh.nodes();
    // The first node is 0 and the last is 1, so there is always one on either side.
    let node = nodes.partition_point(|&x| x <= 0.5) - 1;
    let fraction = (0.5 - nodes[node]) / (nodes[node + 1] - nodes[node]);
    (1.0 - fraction) * y[node] + fraction * y[node + 1]
}

impl Sample {
    pub(crate) fn of(level: &TimeLevel, t: f64, mesh: &Mesh, theta_a: f64, energy: f64) -> Self {
        let tip = level.u.len() - 1;
        Self {
            t,
            u_tip: level.u[tip],
            phi_tip: level.phi[tip],
            u_t_tip: level.v[tip],
            phi_t_tip: level.w[tip],
            // The lifting θ_A (1 - x) is linear, so adding its midpoint value is exact on any mesh.
            theta_mid: middle(mesh, &level.theta) + 0.5 * theta_a,
            // For a free tip the solver returns a zero with the sign of the displacement: -0 + 0
            // is 0.
            contact_force: level.contact_force + 0.0,
            energy,
        }
    }

    /// The same with the contact force of the law.
    pub(super) fn at_the_start(self, obstacles: Option<Obstacles>) -> Self {
        let contact_force = obstacles.map_or(0.0, |obstacles| obstacles.force(self.u_tip) + 0.0);
        Self {
            contact_force,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::run_to;
    use crate::run::simulate::{driver, ran};
    use crate::scene::Scene;

    #[test]
    fn a_run_without_an_end_ends_soon_after_the_energy_has_risen() {
        // Steps that cannot be solved.
        let text = "[beam]\nrho = 5000\n[initial]\nu_t = \"x\"\n[mesh]\nelements = 5\n[time]\nscheme = \"midpoint\"\n\
                    t_end = 10.0\ndt = 0.1\ntolerance = 1e6\n";
        let mut driver =
            driver(&Scene::parse(text, "loose.toml").expect("a scene")).expect("a driver");
        let initial = driver.simulation.energy(&driver.new).total();
        let mut risen = usize::MAX;
        let ended = run_to(&mut driver, 100.0, |driver, _| {
            let rise = driver.simulation.energy(driver.level()).total() - initial;
            if rise > 1e-3 * initial.max(1.0) {
                risen = risen.min(driver.simulation.steps());
            }
        });
        let Err(RunError::Unsound { step, t, dt, .. }) = ended else {
            panic!("{ended:?}")
        };
        assert!(
            step <= risen.saturating_add(CHECKED),
            "{step}, risen at {risen}"
        );
        assert!((t + dt - 0.1 * step as f64).abs() < 1e-9, "{step} {t} {dt}");
    }

    /// For ρ s² = 5000 a motion of size s is s times that of size 1, exactly: powers of 2 change no
    /// rounding.
    #[test]
    fn a_small_motion_ends_at_the_same_step_as_a_large_one() {
        let ended = |exponent: i32| {
            let size = 2f64.powi(exponent);
            let text = format!(
                "[beam]\nrho = {:?}\n[initial]\nu_t = \"{size:?}*x\"\n[mesh]\nelements = 5\n[time]\nscheme = \"midpoint\"\n\
                 t_end = 10.0\ndt = 0.1\ntolerance = 1e6\n",
                5000.0 / size / size
            );
            match ran(&text).1.failure {
                Some(RunError::Unsound { step, .. }) => step,
                other => panic!("{size}: {other:?}"),
            }
        };
        let step = ended(0);
        for exponent in [-40, -20, 20] {
            assert_eq!(ended(exponent), step, "2^{exponent}");
        }
    }

    #[test]
    fn the_middle_is_interpolated_where_it_is_no_node() {
        let value = |nodes: Vec<f64>| {
            let y: Vec<f64> = nodes.iter().map(|x| 3.0 * x - 1.0).collect();
            middle(&Mesh::from_nodes(nodes).unwrap(), &y)
        };
        for nodes in [
            vec![0.0, 1.0],
            vec![0.0, 0.5, 1.0],
            vec![0.0, 0.1, 0.7, 1.0],
            vec![0.0, 0.9, 1.0],
        ] {
            assert!((value(nodes) - 0.5).abs() < 1e-15);
        }
    }
}
