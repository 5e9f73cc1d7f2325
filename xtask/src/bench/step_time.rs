//! Time per element and step: for ways to solve a step, for features of a scene, and over the
//! number of elements.
//!
//! Times vary, so they never enter a committed record; the counts of work next to them are exact.
//! Every time is the best of several runs, since other load on the machine only slows a run.

use std::hint::black_box;

use convergence_study::Table;
use thermobeam::ensemble::Ensemble;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::motion::{Motion, Work};
use thermobeam::one_step::{BYTES_PER_ELEMENT, OneStep, Problem, Stepping};
use thermobeam::solve::{Settings, Solver, Start};

use super::cpu_seconds;
use thermobeam_study::run::simulate;
use thermobeam_study::scene::Scene;

/// Elements times steps of one timed run: some ten milliseconds.
const RUN: usize = 500_000;
/// Number of runs; the best one counts.
const REPEATS: usize = 9;
/// Cases in lanes.
const LANES: usize = 4;

/// A timed configuration.
#[derive(Clone)]
struct Timed {
    problem: Problem,
    stepping: Stepping,
    /// Whether four equal cases run in lanes.
    in_lanes: bool,
    /// Whether the balance of each step is computed.
    balanced: bool,
}

/// A time with the work behind it.
struct StepTime {
    /// Nanoseconds per element, step and case.
    nanoseconds: f64,
    /// Passes per step.
    passes: f64,
    /// Total number of factorisations.
    factorizations: usize,
}

/// CPU seconds of so many steps, or of those up to a failing one.
fn seconds_of(steps: usize, mut step: impl FnMut() -> bool) -> f64 {
    let start = cpu_seconds();
    let _ = (0..steps).all(|_| step());
    cpu_seconds() - start
}

impl Timed {
    fn new(scene: &Scene, mesh: Mesh) -> Result<Self, SetupError> {
        let problem = simulate::problem(&Scene {
            mesh,
            ..scene.clone()
        });
        Ok(Self {
            problem,
            stepping: scene.one_step()?,
            in_lanes: false,
            balanced: false,
        })
    }

    /// The best of several runs.
    fn time(&self) -> Result<StepTime, SetupError> {
        let elements = self.problem.mesh.elements();
        let mut best = f64::INFINITY;
        let mut done = 1;
        let mut work = Work::default();
        for _ in 0..REPEATS {
            let seconds;
            (seconds, done, work) = self.run((RUN / elements).max(20))?;
            best = best.min(seconds);
        }
        let cases = if self.in_lanes { LANES } else { 1 };
        Ok(StepTime {
            nanoseconds: best * 1e9 / (elements * done * cases) as f64,
            passes: work.passes as f64 / done as f64,
            factorizations: work.factorizations,
        })
    }

    /// Seconds, steps and work, to the end or to a failing step; none of the paper's scenes fails.
    #[expect(
        clippy::disallowed_methods,
        reason = "steps are timed without anything around them"
    )]
    fn run(&self, steps: usize) -> Result<(f64, usize, Work), SetupError> {
        if self.in_lanes {
            let problems = vec![self.problem.clone(); LANES];
            let dt = [self.stepping.dt; LANES];
            let Stepping {
                scheme, settings, ..
            } = self.stepping;
            let mut ensemble = Ensemble::new(problems, &dt, scheme, settings)?;
            let mut balances = Vec::with_capacity(LANES);
            let seconds = seconds_of(steps, || {
                ensemble.step_once();
                if self.balanced {
                    ensemble.balances(&mut balances);
                    black_box(&balances);
                }
                ensemble.report(0).is_ok()
            });
            return Ok((seconds, ensemble.steps().max(1), ensemble.work()));
        }
        let mut simulation = OneStep::new(self.problem.clone(), self.stepping)?;
        let mut old = simulation.level();
        let mut new = old.clone();
        let seconds = seconds_of(steps, || {
            let is_done = simulation.step_once().is_ok();
            if self.balanced {
                std::mem::swap(&mut old, &mut new);
                simulation.observe(&mut new);
                black_box(simulation.balance(&old, &new));
            }
            is_done
        });
        Ok((seconds, simulation.steps().max(1), simulation.work()))
    }
}

/// A change of the configuration.
type ConfigurationChange = fn(&mut Timed);

/// The ways to solve a step, and the savings from omitted features.
const WAYS: [(&str, ConfigurationChange); 10] = [
    ("Newton, extrapolated start", |_| ()),
    ("Newton from the level before", |s| {
        s.stepping.settings = Settings {
            start: Start::Previous,
            ..s.stepping.settings
        }
    }),
    ("the paper's fixed point", |s| {
        s.stepping.settings = Settings {
            solver: Solver::FixedPoint,
            ..s.stepping.settings
        }
    }),
    ("four cases in lanes, per case", |s| s.in_lanes = true),
    ("Newton, and the balance of each step", |s| {
        s.balanced = true;
    }),
    ("four cases in lanes with it, per case", |s| {
        (s.in_lanes, s.balanced) = (true, true);
    }),
    ("no obstacles: no contact", |s| s.problem.obstacles = None),
    ("rho = 0: no iteration", |s| s.problem.beam.rho = 0.0),
    ("a = 0 and no heat: no temperature", cold),
    ("none of the three", |s| {
        cold(s);
        (s.problem.obstacles, s.problem.beam.rho) = (None, 0.0);
    }),
];

fn cold(setting: &mut Timed) {
    setting.problem.beam.a = 0.0;
    setting.problem.initial.theta.fill(0.0);
}

/// Times of the ways to solve a step and of the features of a scene, with `elements` elements.
///
/// # Errors
/// [`SetupError`] if the scene cannot be set up on that mesh.
pub(super) fn ways(scene: &Scene, elements: usize) -> Result<Table, SetupError> {
    let whole = Timed::new(scene, Mesh::uniform(elements)?)?;
    let mut first = None;
    let mut rows = vec![];
    for (name, change) in WAYS {
        let mut setting = whole.clone();
        change(&mut setting);
        let StepTime {
            nanoseconds,
            passes,
            factorizations,
        } = setting.time()?;
        let ratio = nanoseconds / *first.get_or_insert(nanoseconds);
        rows.push(vec![
            name.to_owned(),
            format!("{nanoseconds:.1}"),
            format!("{ratio:.2}"),
            format!("{passes:.3}"),
            factorizations.to_string(),
        ]);
    }
    let head = [
        "way",
        "ns per element and step",
        "ratio",
        "passes a step",
        "factorizations",
    ];
    let title = format!(
        "Ways to solve a step, and what a scene saves by what it does not have, {elements} elements"
    );
    Ok(Table {
        title,
        head: head.map(str::to_owned).to_vec(),
        rows,
    })
}

/// Cost and memory over the number of elements, for a single case and for each of four in lanes.
///
/// # Errors
/// [`SetupError`] if the scene cannot be set up.
pub(super) fn scaling(scene: &Scene, elements: &[usize]) -> Result<Table, SetupError> {
    let mut rows = vec![];
    for &n in elements {
        let alone = Timed::new(scene, Mesh::uniform(n)?)?;
        let lanes = Timed {
            in_lanes: true,
            ..alone.clone()
        }
        .time()?;
        let time = alone.time()?;
        rows.push(vec![
            n.to_string(),
            format!("{:.1}", time.nanoseconds),
            format!("{:.1}", lanes.nanoseconds),
            format!("{:.3}", time.passes),
            format!("{:.2}", (n * BYTES_PER_ELEMENT) as f64 / f64::from(1 << 20)),
        ]);
    }
    let head = [
        "elements",
        "ns per element and step",
        "in lanes, per case",
        "passes a step",
        "MiB a case",
    ];
    Ok(Table {
        title: "Time over the number of elements: past the caches a step takes as long as its numbers take from memory and back"
            .to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows,
    })
}
