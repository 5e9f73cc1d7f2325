//! A scene, run from its initial state to its end, by any method.
//!
//! Every step is observed: the energy's balance, its change and the extremes cover the whole time,
//! whatever a report shows. The clock runs only during steps, so the time is that of the solver
//! alone; reading the clock twice a step adds some 50 ns.
//!
//! A run ends early at a step that fails, at a step that violates the law of the energy, and at a
//! [limit on its time](convergence_judge::time_limit). The results so far are kept:
//! [`Run::failure`] says why it ended.
//!
//! ```
//! use thermobeam_study::scene::Scene;
//! use thermobeam_study::run::simulate::{Recording, Simulator};
//!
//! let initial = "[initial]\nu_t = \"x\"\n[time]\nt_end = 1.0\n";
//! for method in ["dt = 0.01", "scheme = \"dg\""] {
//!     let scene = Scene::parse(&format!("{initial}{method}"), "swing.toml")?;
//!     let run = Simulator::new(&scene)?.run(Recording::Summary, &mut |_, _| ());
//!     assert_eq!((run.last.t, run.failure), (1.0, None));
//!     assert!(run.energy.largest_increase < 0.0 && run.energy.largest_balance_residual < 1e-12);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::ops::ControlFlow;

use thermobeam::dg::Dg;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::motion::StepReport;
use thermobeam::one_step::{self, Problem};

use super::dg::DgMotion;
use super::driver::Driver;
use super::history::RunHistory;
pub use super::tally::{Contact, Run};
use super::{AnyMotion, RunError, Watch, run};
use crate::expression::Expression;
use crate::scene::{Initial, Method, Scene};

/// What to record in addition to the summary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Recording {
    /// Nothing: memory does not grow with the number of steps.
    #[default]
    Summary,
    /// This number of equidistant rows, without pictures; for a one-step scheme at most this
    /// number, at its levels.
    Curve(usize),
    /// The history and frames for pictures, see [`RunHistory`], in as many rows as the method has.
    History,
    /// The same in this number of rows; for a one-step scheme in at most this number, at its
    /// levels.
    HistoryOf(usize),
}

/// The solver's view of a scene: initial data at the nodes, which in one dimension is the
/// projection (3.6).
///
/// Boundary values are set exactly. The scene has checked that its functions satisfy them up to
/// their round-off, which for a function such as sin(1000πx) exceeds what the solver accepts.
pub fn problem(scene: &Scene) -> Problem {
    Problem {
        beam: scene.beam,
        obstacles: scene.obstacles,
        mesh: scene.mesh.clone(),
        initial: initial(&scene.initial, scene.beam.theta_a, &scene.mesh),
    }
}

/// The scene at t = 0, ready to be stepped.
///
/// # Errors
/// [`SetupError`] if the solver refuses the scene's numbers.
pub(crate) fn driver(scene: &Scene) -> Result<Driver<'static>, SetupError> {
    Driver::new(problem(scene), scene.one_step()?)
}

/// A scene at t = 0.
///
/// # Errors
/// [`RunError`] if the solver refuses the scene's numbers.
pub fn motion(scene: &Scene) -> Result<Box<AnyMotion>, RunError> {
    Ok(match scene.method {
        Method::OneStep(_) => Box::new(driver(scene)?.timed()),
        Method::Dg(stepping) => Box::new(DgMotion::new(scene, stepping)?),
    })
}

/// The initial data of a scene on any mesh, with boundary values set as in [`problem`].
pub(crate) fn initial(initial: &Initial, theta_a: f64, mesh: &Mesh) -> one_step::InitialValues {
    let nodes = mesh.nodes();
    let mut theta = nodal_values(nodes, &initial.theta, theta_a);
    theta[nodes.len() - 1] = 0.0;
    one_step::InitialValues {
        u: nodal_values(nodes, &initial.u, 0.0),
        u_t: nodal_values(nodes, &initial.u_t, 0.0),
        phi: nodal_values(nodes, &initial.phi, 0.0),
        phi_t: nodal_values(nodes, &initial.phi_t, 0.0),
        theta,
    }
}

/// A function at the nodes, with this value at the first one; zero if it is not given.
fn nodal_values(nodes: &[f64], function: &Option<Expression>, first: f64) -> Vec<f64> {
    let mut values = match function {
        Some(function) => nodes.iter().map(|&x| function.eval(x)).collect(),
        None => vec![0.0; nodes.len()],
    };
    values[0] = first;
    values
}

/// A scene, ready to run.
pub struct Simulator {
    motion: Box<AnyMotion>,
    t_end: f64,
}

impl Simulator {
    /// Sets the scene up at t = 0.
    ///
    /// # Errors
    /// [`RunError`] if the solver refuses the scene's numbers.
    pub fn new(scene: &Scene) -> Result<Self, RunError> {
        Ok(Self {
            motion: motion(scene)?,
            t_end: scene.t_end,
        })
    }

    /// Steps to the end; `progress` receives the number of steps and the time after each step.
    pub fn run(self, recording: Recording, progress: &mut dyn FnMut(usize, f64)) -> Run {
        let mut watch = |motion: &mut AnyMotion, _: &StepReport| {
            let motion = motion.motion();
            progress(motion.steps(), motion.t());
            Ok(ControlFlow::Continue(()))
        };
        self.watched(recording, &[], &mut watch)
    }

    /// Runs to the end; `read` receives the motion at each of these times, which increase.
    ///
    /// # Errors
    /// The [`RunError`] that ended the run.
    pub(crate) fn read_at(
        self,
        recording: Recording,
        times: &[f64],
        mut read: impl FnMut(&mut AnyMotion),
    ) -> Result<Run, RunError> {
        let mut passed = 0;
        let mut watch = |motion: &mut AnyMotion, _: &StepReport| {
            // A level of a one-step scheme is there up to rounding.
            if times
                .get(passed)
                .is_some_and(|time| (motion.motion().t() - time).abs() <= 1e-9 * time)
            {
                read(motion);
                passed += 1;
            }
            Ok(ControlFlow::Continue(()))
        };
        self.watched(recording, times, &mut watch).finished()
    }

    /// The same as [`Simulator::run`] with an additional watch; a step ends at each of the times
    /// `ends`, see [`run`].
    pub fn watched(self, recording: Recording, ends: &[f64], watch: &mut dyn Watch) -> Run {
        let Self { mut motion, t_end } = self;
        let first = motion.sample();
        let size = motion.energy_size().terms;
        let mut sums = Run::start(first, size, motion.motion().is_loaded());
        let mut history = match recording {
            Recording::Summary => None,
            Recording::Curve(rows) => Some(RunHistory::without_frames(t_end, rows, first)),
            Recording::History => Some(RunHistory::new(&*motion, t_end, motion.rows(), first)),
            Recording::HistoryOf(rows) => Some(RunHistory::new(&*motion, t_end, rows, first)),
        };
        let started_in = motion.dg().map(Dg::phase);
        let failure = match &mut history {
            Some(history) => run(&mut *motion, t_end, ends, &mut [history, &mut sums, watch]),
            None => run(&mut *motion, t_end, ends, &mut [&mut sums, watch]),
        }
        .err();
        let last = motion.sample();
        if let Some(history) = &mut history {
            history.finish(&*motion, last);
        }
        let contact = started_in.zip(motion.dg()).map(|(started_in, dg)| Contact {
            started_in,
            events: dg.events().to_vec(),
        });
        sums.end(last, motion.motion().work(), motion.motion().is_heated());
        Run {
            wall: motion.wall(),
            contact,
            failure,
            history,
            ..sums
        }
    }
}

/// The scene of a text, and its run.
#[cfg(test)]
pub(super) fn ran(text: &str) -> (Scene, Run) {
    let scene = Scene::parse(text, "s.toml").expect("a scene");
    let simulator = Simulator::new(&scene).expect("a simulator");
    let run = simulator.run(Recording::Summary, &mut |_, _| ());
    (scene, run)
}

#[cfg(test)]
mod tests {
    use super::super::Loaded;
    use super::super::together::Together;
    use super::*;
    use thermobeam::dg;

    #[test]
    fn a_run_keeps_extremes_and_is_read_at_the_times_given() {
        let text = "[initial]\nu_t = \"x\"\n[mesh]\nelements = 4\n[time]\ndt = 0.1\nt_end = 2.0\n";
        let scene = Scene::parse(text, "s.toml").expect("a scene");
        let (times, mut read) = ([0.5, 1.0, 1.5, 2.0], vec![]);
        let see = |motion: &mut AnyMotion| read.push(motion.sample());
        let run = Simulator::new(&scene)
            .expect("a motion")
            .read_at(Recording::Summary, &times, see)
            .expect("a run");
        assert!(read.iter().map(|sample| sample.t).eq(times));
        let [low, high] = [run.extremes.u_tip_min, run.extremes.u_tip_max];
        assert_eq!(low.min(0.0), low);
        assert!(
            read.iter()
                .all(|sample| (low..=high).contains(&sample.u_tip))
        );
    }

    /// A beam at rest under the constant load F_u = 1, by a one-step scheme or by dG.
    fn pushed(time: &str) -> Simulator {
        let text = format!("[mesh]\nelements = 4\n[time]\nt_end = 1.0\n{time}");
        let mut scene = Scene::parse(&text, "pushed.toml").expect("a scene");
        let motion: Box<AnyMotion> = match &mut scene.method {
            Method::OneStep(stepping) => {
                stepping.loaded = true;
                // (1, χ): h for an inner node, half of it for the last one.
                let fill = |_, load: &mut [[f64; 3]]| {
                    let last = load.len() - 1;
                    for (node, entry) in load.iter_mut().enumerate() {
                        entry[0] = if node == last { 0.125 } else { 0.25 };
                    }
                };
                Box::new(driver(&scene).expect("a driver").loaded(fill))
            }
            Method::Dg(stepping) => {
                let stepping = *stepping;
                let simulation = Dg::with_load(scene.dg_problem(), stepping, |space| {
                    let points = dg::Space::gauss(12);
                    let mut constant = vec![[0.0; 3]; space.blocks()];
                    space.add_load(dg::Field::U, &points, |_| 1.0, &mut constant);
                    Box::new(move |_, load| {
                        for (sum, entry) in load.iter_mut().zip(&constant) {
                            sum[0] += entry[0];
                        }
                    })
                })
                .expect("a simulation");
                let motion = DgMotion::of(simulation, &scene.beam, None, stepping);
                Box::new(motion)
            }
        };
        Simulator { motion, t_end: 1.0 }
    }

    const METHODS: [&str; 2] = ["dt = 0.01", "scheme = \"dg\""];

    #[test]
    fn a_load_may_raise_the_energy() {
        for time in METHODS {
            let run = pushed(time).run(Recording::Summary, &mut |_, _| ());
            assert_eq!((run.failure, run.last.t), (None, 1.0), "{time}");
            assert!(run.last.u_tip > 0.05, "{time}: {:?}", run.last);
            assert!(run.energy.largest_increase > 1e-3 && run.energy.last > 1e-3);
            assert!(run.energy.largest_balance_residual.is_nan());
        }
    }

    #[test]
    fn a_beam_with_loads_has_no_balance_and_no_history_of_it() {
        for time in METHODS {
            let loaded = Loaded {
                what: "a balance of the energy",
            };
            assert_eq!(pushed(time).motion.balance(), Err(loaded), "{time}");
            let run = pushed(time).run(Recording::History, &mut |_, _| ());
            assert_eq!(run.failure, Some(RunError::Loaded(loaded)), "{time}");
            assert!(run.complaint().is_some_and(|words| {
                words.starts_with("a balance of the energy: found a beam with loads")
            }));
        }
    }

    #[test]
    fn a_beam_with_loads_runs_alone() {
        let text = "[initial]\nu_t = \"x\"\n[time]\ndt = 0.1\nt_end = 2.0\n";
        let mut scene = Scene::parse(text, "s.toml").expect("a scene");
        assert!(Together::of(&scene).is_some());
        if let Method::OneStep(stepping) = &mut scene.method {
            stepping.loaded = true;
        }
        assert!(Together::of(&scene).is_none());
    }
}
