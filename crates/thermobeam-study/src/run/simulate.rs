//! A scene, run from its initial state to its end.
//!
//! Every step is observed: the energy's balance, its change and the extremes are over all time levels, not over those
//! that a report happens to look at. The clock runs only while the solver steps, so that the time is the solver's alone;
//! reading the clock twice a step costs some 50 ns of it.
//!
//! A step that cannot be done ends the run, and so does a [limit on its time](convergence_study::run::time_limit). What was computed up to
//! there is kept: [`Run::failure`] says why it ended.
//!
//! ```
//! use thermobeam_study::scene::Scene;
//! use thermobeam_study::run::simulate::{Recording, Simulator};
//!
//! let text = "[initial]\nu_t = \"x\"\n[time]\ndt = 0.01\nt_end = 1.0";
//! let scene = Scene::parse(text, "swing.toml")?;
//! let run = Simulator::new(&scene)?.run(Recording::Summary, &mut |_| ());
//! assert_eq!((run.steps, run.failure), (100, None));
//! assert!(run.energy.largest_increase < 0.0 && run.energy.largest_balance_residual < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod figures;
mod history;
mod object;
mod together;

use std::ops::ControlFlow;
use std::time::Duration;

use serde::Serialize;
use thermobeam::energy::Balance;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::Obstacles;
use thermobeam::simulation::{self, Problem, Simulation, Stepping};
use thermobeam::solve::{Level, StepReport, Work};

use crate::expression::Expression;
use crate::run::driver::{Driver, RunError, Step};
use crate::scene::Scene;
use convergence_study::text::number::max_or_nan;

pub use figures::figures;
pub use history::{Dissipation, Frames, MOST_ROWS, Row, RunHistory};
pub use object::Object;
pub use together::{Together, run_together};

/// The value at x = 1/2 of nodal values on a mesh.
pub(crate) fn middle_value(mesh: &Mesh, values: &[f64]) -> f64 {
    Middle::of(mesh).value(values)
}

/// Where x = 1/2 lies in a mesh.
#[derive(Debug, Clone, Copy)]
struct Middle {
    /// The node left of it, or at it.
    node: usize,
    /// How far on the way to the next node.
    fraction: f64,
}

impl Middle {
    fn of(mesh: &Mesh) -> Self {
        let nodes = mesh.nodes();
        // The first node is 0 and the last 1, so that there is always one on either side.
        let node = nodes.partition_point(|&x| x <= 0.5) - 1;
        Self { node, fraction: (0.5 - nodes[node]) / (nodes[node + 1] - nodes[node]) }
    }

    fn value(self, y: &[f64]) -> f64 {
        (1.0 - self.fraction) * y[self.node] + self.fraction * y[self.node + 1]
    }
}

/// Observed quantities of a time level; the JSON object of a run has them, except the contact force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sample {
    /// Time.
    pub t: f64,
    /// u(1).
    pub u_tip: f64,
    /// φ(1).
    pub phi_tip: f64,
    /// û(1).
    pub u_t_tip: f64,
    /// φ̂(1).
    pub phi_t_tip: f64,
    /// The physical temperature at x = 1/2.
    pub theta_mid: f64,
    /// The contact force of the step that led here, positive on the upper obstacle; g(u(1)) at the start.
    #[serde(skip)]
    pub contact_force: f64,
    /// E^n, with the term of θ_A.
    pub energy: f64,
}

/// Iterations of all steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Iterations {
    /// Their sum.
    pub total: usize,
    /// Those of the step that took most.
    pub max: usize,
}

/// The free end's range over all time levels, the start included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extremes {
    /// Smallest u(1).
    pub u_tip_min: f64,
    /// Largest u(1).
    pub u_tip_max: f64,
}

/// The energy over a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnergySummary {
    /// E^0.
    pub initial: f64,
    /// E^n of the last level.
    #[serde(rename = "final")]
    pub last: f64,
    /// Largest `E^n - E^{n-1}`; negative where the energy always falls, NaN where no step was done.
    pub largest_increase: f64,
    /// Largest defect of the exact discrete balance, over all steps.
    pub largest_balance_residual: f64,
}

/// The rise of the energy in one step that is no longer taken for round-off or a loose tolerance, in parts of the initial
/// energy, or of 1 where that is less: every step of both schemes lowers the energy, or leaves it.
const RISE: f64 = 1e-3;

impl EnergySummary {
    /// The largest rise of the energy in a step where it is far beyond what rounding and tolerance explain: the numbers of such a
    /// run mean nothing. `None` for a sound run, and where no step was done.
    pub fn rise(&self, steps: usize) -> Option<f64> {
        let is_sound = self.largest_increase <= RISE * self.initial.abs().max(1.0);
        (steps > 0 && !is_sound).then_some(self.largest_increase)
    }
}

/// What to keep beside the summary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Recording {
    /// Nothing: memory does not grow with the number of steps.
    #[default]
    Summary,
    /// The history and frames for pictures, see [`RunHistory`].
    History,
}

/// A finished run, or the part of it that could be done.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Steps done.
    pub steps: usize,
    /// Iterations that they took.
    pub iterations: Iterations,
    /// Time spent stepping, without any observing.
    pub wall: Duration,
    /// The start.
    pub first: Sample,
    /// The last level.
    pub last: Sample,
    /// The free end's range.
    pub extremes: Extremes,
    /// Steps that ended with a contact force.
    pub contact_steps: usize,
    /// The energy.
    pub energy: EnergySummary,
    /// Counts of the solver's work.
    pub work: Work,
    /// Whether the temperature was computed: it is left out where nothing heats the beam.
    pub is_heated: bool,
    /// Why the run ended early, if it did.
    pub failure: Option<RunError>,
    /// History and frames, if they were asked for.
    pub history: Option<RunHistory>,
}

/// The solver's view of a scene: initial data at the nodes, which in one dimension is the projection (3.6).
///
/// Boundary values are set exactly. The scene has checked that its functions meet them up to their round-off, which for
/// a function such as sin(1000πx) is more than the solver would accept unseen.
pub fn problem(scene: &Scene) -> Problem {
    Problem {
        beam: scene.beam,
        obstacles: scene.obstacles,
        mesh: scene.mesh.clone(),
        initial: initial(scene, &scene.mesh),
    }
}

/// A scene's initial data on any mesh, boundary values set as in [`problem`].
pub(crate) fn initial(scene: &Scene, mesh: &Mesh) -> simulation::Initial {
    let nodes = mesh.nodes();
    let at_nodes = |function: &Option<Expression>, start: f64| -> Vec<f64> {
        let value = |&x: &f64| function.as_ref().map_or(0.0, |function| function.eval(x));
        let mut values: Vec<f64> = nodes.iter().map(value).collect();
        values[0] = start;
        values
    };
    let initial = &scene.initial;
    let mut theta = at_nodes(&initial.theta, scene.beam.theta_a);
    theta[nodes.len() - 1] = 0.0;
    simulation::Initial {
        u: at_nodes(&initial.u, 0.0),
        u_t: at_nodes(&initial.u_t, 0.0),
        phi: at_nodes(&initial.phi, 0.0),
        phi_t: at_nodes(&initial.phi_t, 0.0),
        theta,
    }
}

/// A scene, ready to run.
pub struct Simulator {
    driver: Driver,
    sampler: Sampler,
    steps: usize,
}

impl Simulator {
    /// Sets the scene up at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] where the solver cannot work with the scene's numbers.
    pub fn new(scene: &Scene) -> Result<Self, SetupError> {
        let stepping = Stepping { scheme: scene.scheme, settings: scene.settings, dt: scene.dt, loaded: false };
        let driver = Driver::new(problem(scene), stepping)?.timed();
        let sampler = Sampler { middle: Middle::of(&scene.mesh), dt: scene.dt };
        Ok(Self { driver, sampler, steps: scene.steps })
    }

    /// Steps to the end; `progress` hears the number of steps done after each of them.
    pub fn run(self, recording: Recording, progress: &mut dyn FnMut(usize)) -> Run {
        let Self { mut driver, sampler, steps } = self;
        let start = driver.level().clone();
        // No step has led to the start, so that its contact force is that of the law.
        let obstacles = driver.simulation().problem().obstacles;
        let first = sampler.sample(driver.simulation(), &start).at_the_start(obstacles);
        let nodes = driver.simulation().problem().mesh.nodes();
        let mut history = (recording == Recording::History).then(|| RunHistory::new(nodes, steps, first, &start.u));
        let mut tally = Tally::new(first.u_tip);
        let ended = driver.run(steps, |step| {
            let Step { report, old, new, simulation } = step;
            let balance = simulation.balance(old, new);
            tally.add(&report, &balance, new.u[new.u.len() - 1], new.contact_force);
            if let Some(history) = &mut history {
                history.add(simulation.step(), &balance, &new.u, || sampler.sample(simulation, new));
            }
            progress(simulation.step());
            ControlFlow::<()>::Continue(())
        });
        let end = driver.level().clone();
        let simulation = driver.simulation();
        let last = if simulation.step() == 0 { first } else { sampler.sample(simulation, &end) };
        if let Some(history) = &mut history {
            history.finish(last, &end.u);
        }
        let (work, is_heated) = (simulation.work(), simulation.is_heated());
        Run {
            failure: ended.err(),
            history,
            ..tally.run(simulation.step(), [first, last], driver.wall(), work, is_heated)
        }
    }
}

/// Reads samples off the levels of a simulation.
#[derive(Debug, Clone, Copy)]
struct Sampler {
    middle: Middle,
    dt: f64,
}

impl Sampler {
    fn sample(self, simulation: &Simulation, level: &Level) -> Sample {
        let theta_a = simulation.problem().beam.theta_a;
        let t = simulation.step() as f64 * self.dt;
        Sample::of(level, t, self.middle, theta_a, simulation.energy(level).total())
    }
}

impl Sample {
    fn of(level: &Level, t: f64, middle: Middle, theta_a: f64, energy: f64) -> Self {
        let tip = level.u.len() - 1;
        Self {
            t,
            u_tip: level.u[tip],
            phi_tip: level.phi[tip],
            u_t_tip: level.v[tip],
            phi_t_tip: level.w[tip],
            // The lifting θ_A (1 - x) is linear, so that adding its value in the middle is exact on any mesh.
            theta_mid: middle.value(&level.theta) + 0.5 * theta_a,
            // The solver gives a free tip the sign of zero that its displacement has: -0 + 0 is 0.
            contact_force: level.contact_force + 0.0,
            energy,
        }
    }

    /// The same with the contact force of the law.
    fn at_the_start(self, obstacles: Option<Obstacles>) -> Self {
        let contact_force = obstacles.map_or(0.0, |obstacles| obstacles.force(self.u_tip) + 0.0);
        Self { contact_force, ..self }
    }
}

/// What is summed up over the steps.
struct Tally {
    iterations: Iterations,
    extremes: Extremes,
    contact_steps: usize,
    largest_increase: Option<f64>,
    largest_residual: f64,
}

impl Tally {
    fn new(u_tip: f64) -> Self {
        Self {
            iterations: Iterations::default(),
            extremes: Extremes { u_tip_min: u_tip, u_tip_max: u_tip },
            contact_steps: 0,
            largest_increase: None,
            largest_residual: 0.0,
        }
    }

    fn add(&mut self, report: &StepReport, balance: &Balance, u_tip: f64, contact_force: f64) {
        self.iterations.total += report.iterations;
        self.iterations.max = self.iterations.max.max(report.iterations);
        self.extremes.u_tip_max = max_or_nan(self.extremes.u_tip_max, u_tip);
        self.extremes.u_tip_min = -max_or_nan(-self.extremes.u_tip_min, -u_tip);
        self.contact_steps += usize::from(contact_force != 0.0);
        // Not the difference of two totals, which would lose the digits that tell a small fall from a small rise.
        self.largest_increase =
            Some(self.largest_increase.map_or(balance.change, |most| max_or_nan(most, balance.change)));
        self.largest_residual = max_or_nan(self.largest_residual, balance.residual.abs());
    }

    /// The run that it is of, without failure and history.
    fn run(self, steps: usize, [first, last]: [Sample; 2], wall: Duration, work: Work, is_heated: bool) -> Run {
        let energy = EnergySummary {
            initial: first.energy,
            last: last.energy,
            largest_increase: self.largest_increase.unwrap_or(f64::NAN),
            largest_balance_residual: self.largest_residual,
        };
        Run {
            steps,
            iterations: self.iterations,
            wall,
            first,
            last,
            extremes: self.extremes,
            contact_steps: self.contact_steps,
            energy,
            work,
            is_heated,
            failure: None,
            history: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rise_of_the_energy_beyond_rounding_is_told_and_nan_is_one() {
        let rise = |initial, largest_increase, steps| {
            EnergySummary { initial, last: 0.0, largest_increase, largest_balance_residual: 0.0 }.rise(steps)
        };
        for sound in [-1.0, 0.0, 1e-12, 9e-4] {
            assert_eq!(rise(0.5, sound, 1), None, "{sound}");
        }
        assert_eq!([rise(0.5, 2e-3, 1), rise(100.0, 2e-3, 1), rise(0.5, 1e264, 7)], [Some(2e-3), None, Some(1e264)]);
        assert!(rise(0.5, f64::NAN, 1).is_some_and(f64::is_nan));
        assert_eq!(rise(0.5, f64::NAN, 0), None, "no step was done");
    }

    #[test]
    fn the_middle_is_interpolated_where_it_is_no_node() {
        let value = |nodes: Vec<f64>| {
            let y: Vec<f64> = nodes.iter().map(|x| 3.0 * x - 1.0).collect();
            Middle::of(&Mesh::from_nodes(nodes).unwrap()).value(&y)
        };
        for nodes in [vec![0.0, 1.0], vec![0.0, 0.5, 1.0], vec![0.0, 0.1, 0.7, 1.0], vec![0.0, 0.9, 1.0]] {
            assert!((value(nodes) - 0.5).abs() < 1e-15);
        }
    }
}
