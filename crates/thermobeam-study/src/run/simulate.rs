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

use thermobeam::energy::Balance;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::Obstacles;
use thermobeam::simulation::{self, Problem, Simulation};
use thermobeam::solve::{Level, StepReport, Work};

use super::tally::Tally;
use crate::expression::Expression;
use crate::run::driver::{Driver, RunError, Step};
use crate::scene::Scene;

pub use super::tally::{EnergySummary, Extremes, Iterations, Sample};
pub use figures::figures;
pub use history::{Dissipation, Frames, MOST_ROWS, Row, RunHistory};
pub(super) use object::Counts;
pub use object::Object;
pub use together::{Together, run_together};

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

/// The scene at t = 0, to be stepped.
///
/// # Errors
/// [`SetupError`] where the solver cannot work with the scene's numbers.
pub(crate) fn driver(scene: &Scene) -> Result<Driver, SetupError> {
    Driver::new(problem(scene), scene.one_step()?)
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
        let driver = driver(scene)?.timed();
        let sampler = Sampler::new(&scene.mesh);
        Ok(Self { driver, sampler, steps: scene.steps() })
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
        let mut sums = Sums::new(first.u_tip);
        let ended = driver.run(steps, |step| {
            let Step { report, old, new, simulation } = step;
            let balance = simulation.balance(old, new);
            sums.add(&report, &balance, new.u[new.u.len() - 1], new.contact_force);
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
            ..sums.run(simulation.step(), [first, last], driver.wall(), work, is_heated)
        }
    }
}

/// Reads samples off the levels of a simulation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sampler {
    middle: Middle,
}

impl Sampler {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        Self { middle: Middle::of(mesh) }
    }

    pub(crate) fn sample(self, simulation: &Simulation, level: &Level) -> Sample {
        let theta_a = simulation.problem().beam.theta_a;
        Sample::of(level, simulation.t(), self.middle, theta_a, simulation.energy(level).total())
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

/// What is summed up over the steps of a one-step scheme.
struct Sums {
    tally: Tally,
    contact_steps: usize,
}

impl Sums {
    fn new(u_tip: f64) -> Self {
        Self { tally: Tally::new(u_tip), contact_steps: 0 }
    }

    fn add(&mut self, report: &StepReport, balance: &Balance, u_tip: f64, contact_force: f64) {
        self.tally.add(report.iterations, balance.change, balance.residual);
        self.tally.include(u_tip);
        self.contact_steps += usize::from(contact_force != 0.0);
    }

    /// The run that they are of, without failure and history.
    fn run(self, steps: usize, [first, last]: [Sample; 2], wall: Duration, work: Work, is_heated: bool) -> Run {
        Run {
            steps,
            iterations: self.tally.iterations,
            wall,
            first,
            last,
            extremes: self.tally.extremes,
            contact_steps: self.contact_steps,
            energy: self.tally.energy(first.energy, last.energy),
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
