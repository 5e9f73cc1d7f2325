//! Time per element and step: of the ways to solve a step, of what a scene has, and over the number of elements.
//!
//! Times vary, so nothing of this enters a committed record; the counts of work beside them are exact. Every time is the
//! best of several runs: other load on the machine only makes a run slower.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use convergence_study::study::Table;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::simulation::{BYTES_PER_ELEMENT, Problem, Stepping};
use thermobeam::solve::{Settings, Solver, Start, Work};

use crate::run::driver::{Driver, Step};
use crate::run::ensemble::EnsembleDriver;
use crate::run::simulate;
use crate::scene::Scene;

/// Elements times steps of one timed run: some ten milliseconds.
const RUN: usize = 500_000;
/// Runs of which the best counts.
const REPEATS: usize = 9;

/// A time with the work behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepTime {
    /// Nanoseconds per element, step and case.
    pub nanoseconds: f64,
    /// Passes per step.
    pub passes: f64,
    /// Factorisations in all.
    pub factorizations: usize,
}

/// What is timed.
struct Setting<'a> {
    problem: Problem,
    scene: &'a Scene,
    settings: Settings,
    observed: Observed,
}

/// What is computed after each step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Observed {
    Nothing,
    Energy,
    Balance,
}

impl Setting<'_> {
    fn steps(&self) -> usize {
        (RUN / self.problem.mesh.elements()).max(20)
    }

    /// The best of several runs of one case.
    fn alone(&self) -> Result<StepTime, SetupError> {
        let (scene, settings) = (self.scene, self.settings);
        let stepping = Stepping { settings, ..scene.one_step()? };
        best_of_several(|| {
            let mut driver = Driver::new(self.problem.clone(), stepping)?;
            let start = Instant::now();
            self.step(&mut driver);
            let seconds = start.elapsed().as_secs_f64();
            Ok(self.step_time(seconds, driver.simulation().step().max(1), 1, driver.simulation().work()))
        })
    }

    /// Steps to the end, or to the step that fails; none of the paper's scenes fails.
    fn step(&self, driver: &mut Driver) {
        let steps = self.steps();
        let observe = |step: Step<'_>| {
            match self.observed {
                Observed::Energy => drop(black_box(step.simulation.energy(step.new))),
                _ => drop(black_box(step.simulation.balance(step.old, step.new))),
            }
            ControlFlow::<()>::Continue(())
        };
        let _ = match self.observed {
            Observed::Nothing => (0..steps).try_for_each(|_| driver.advance(|_, _| ()).map(drop)),
            _ => driver.run(steps, observe).map(drop),
        };
    }

    /// The same for four equal cases in lanes.
    fn in_lanes(&self) -> Result<StepTime, SetupError> {
        let (steps, cases) = (self.steps(), 4);
        best_of_several(|| {
            let (problems, dt) = (vec![self.problem.clone(); cases], vec![self.scene.dt(); cases]);
            let mut driver = EnsembleDriver::new(problems, &dt, self.scene.one_step()?.scheme, self.settings)?;
            let start = Instant::now();
            let _ = match self.observed {
                Observed::Nothing => (0..steps).try_for_each(|_| driver.advance()),
                _ => driver.run(steps, |_, balances| {
                    black_box(balances);
                    ControlFlow::Continue(())
                }),
            };
            let seconds = start.elapsed().as_secs_f64();
            Ok(self.step_time(seconds, driver.ensemble().step().max(1), cases, driver.ensemble().work()))
        })
    }

    fn step_time(&self, seconds: f64, steps: usize, cases: usize, work: Work) -> StepTime {
        StepTime {
            nanoseconds: seconds * 1e9 / (self.problem.mesh.elements() * steps * cases) as f64,
            passes: work.passes as f64 / steps as f64,
            factorizations: work.factorizations,
        }
    }
}

fn best_of_several(run: impl Fn() -> Result<StepTime, SetupError>) -> Result<StepTime, SetupError> {
    let mut best = run()?;
    for _ in 1..REPEATS {
        let time = run()?;
        if time.nanoseconds < best.nanoseconds {
            best = time;
        }
    }
    Ok(best)
}

fn setting(scene: &Scene, mesh: Mesh) -> Result<Setting<'_>, SetupError> {
    let scene_on_mesh = Scene { mesh, ..scene.clone() };
    let settings = scene.one_step()?.settings;
    Ok(Setting { problem: simulate::problem(&scene_on_mesh), scene, settings, observed: Observed::Nothing })
}

fn row(name: &str, time: &StepTime, against: f64) -> Vec<String> {
    vec![
        name.to_owned(),
        format!("{:.1}", time.nanoseconds),
        format!("{:.2}", time.nanoseconds / against),
        format!("{:.3}", time.passes),
        time.factorizations.to_string(),
    ]
}

fn table(title: &str, first: &str, rows: Vec<Vec<String>>) -> Table {
    let head =
        [first, "ns per element and step", "ratio", "passes a step", "factorizations"].map(str::to_owned).to_vec();
    Table { title: title.to_owned(), head, rows }
}

/// The ways to solve a step, on the scene with so many elements.
///
/// # Errors
/// [`SetupError`] where the scene cannot be set up on that mesh.
pub fn ways(scene: &Scene, elements: usize) -> Result<Table, SetupError> {
    let base = || -> Result<Setting<'_>, SetupError> { setting(scene, Mesh::uniform(elements)?) };
    let with = |settings: Settings| -> Result<StepTime, SetupError> { Setting { settings, ..base()? }.alone() };
    let settings = scene.one_step()?.settings;
    let newton = with(settings)?;
    let graded = setting(scene, Mesh::mapped(elements, |s| s + 0.1 * (std::f64::consts::TAU * s).sin())?)?.alone()?;
    let balanced = || -> Result<Setting<'_>, SetupError> { Ok(Setting { observed: Observed::Balance, ..base()? }) };
    let rows = [
        ("the paper's fixed point", with(Settings { solver: Solver::FixedPoint, ..settings })?),
        ("Newton from the level before", with(Settings { start: Start::Previous, ..settings })?),
        ("Newton, extrapolated start", newton),
        ("the same on a graded mesh", graded),
        ("four cases in lanes, per case", base()?.in_lanes()?),
        ("Newton, and the balance of each step", balanced()?.alone()?),
        ("four cases in lanes with it, per case", balanced()?.in_lanes()?),
    ];
    let rows = rows.iter().map(|(name, time)| row(name, time, newton.nanoseconds)).collect();
    Ok(table(&format!("Ways to solve a step, {elements} elements"), "way", rows))
}

/// What a scene pays for, against the full one.
///
/// # Errors
/// [`SetupError`] where the scene cannot be set up.
pub fn scenes(scene: &Scene, elements: usize) -> Result<Table, SetupError> {
    let full = setting(scene, Mesh::uniform(elements)?)?;
    let change = |apply: &dyn Fn(&mut Problem)| -> Result<StepTime, SetupError> {
        let mut changed = setting(scene, Mesh::uniform(elements)?)?;
        apply(&mut changed.problem);
        changed.alone()
    };
    let cold = |problem: &mut Problem| {
        problem.beam.a = 0.0;
        problem.initial.theta.fill(0.0);
    };
    let whole = full.alone()?;
    let rows = [
        ("everything", whole),
        (
            "everything, observed with its energy at each step",
            Setting { observed: Observed::Energy, ..setting(scene, Mesh::uniform(elements)?)? }.alone()?,
        ),
        ("no obstacles: no contact", change(&|problem| problem.obstacles = None)?),
        ("rho = 0: no iteration", change(&|problem| problem.beam.rho = 0.0)?),
        ("a = 0 and no heat: no temperature", change(&cold)?),
        (
            "none of the three",
            change(&|problem| {
                cold(problem);
                problem.obstacles = None;
                problem.beam.rho = 0.0;
            })?,
        ),
    ];
    let rows = rows.iter().map(|(name, time)| row(name, time, whole.nanoseconds)).collect();
    Ok(table(&format!("What a scene pays for, {elements} elements"), "scene", rows))
}

/// What [`scaling`] has to say beside its table.
pub const SCALING: &str = "The ratio is to the first mesh of 1000 elements or more. Past the caches a step takes as long as its \
                           numbers take to come from memory and go back.";

/// Cost and memory over the number of elements, of one case and of each of four in lanes.
///
/// # Errors
/// [`SetupError`] where the scene cannot be set up.
pub fn scaling(scene: &Scene, elements: &[usize]) -> Result<Table, SetupError> {
    let times = |&n: &usize| {
        let setting = setting(scene, Mesh::uniform(n)?)?;
        Ok((n, setting.alone()?, setting.in_lanes()?))
    };
    let times = elements.iter().map(times).collect::<Result<Vec<_>, SetupError>>()?;
    let against = times.iter().find(|(n, ..)| *n >= 1000).map_or(f64::NAN, |(_, time, _)| time.nanoseconds);
    let row = |(n, alone, lanes): &(usize, StepTime, StepTime)| {
        vec![
            n.to_string(),
            format!("{:.1}", alone.nanoseconds),
            format!("{:.2}", alone.nanoseconds / against),
            format!("{:.1}", lanes.nanoseconds),
            format!("{:.3}", alone.passes),
            format!("{:.2}", (n * BYTES_PER_ELEMENT) as f64 / f64::from(1 << 20)),
        ]
    };
    let head = ["elements", "ns per element and step", "ratio", "in lanes, per case", "passes a step", "MiB a case"];
    let title = "Time over the number of elements";
    Ok(Table { title: title.to_owned(), head: head.map(str::to_owned).to_vec(), rows: times.iter().map(row).collect() })
}
