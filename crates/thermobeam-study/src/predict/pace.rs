//! Time per element and step: of the ways to solve a step, of what a scene has, and over the number of elements.
//!
//! Times vary, so nothing of this enters a committed record; the counts of work beside them are exact. Every time is the
//! best of several runs: a machine that does something else can only make a run slower.

use crate::run::simulate;
use crate::scene::Scene;
use convergence_study::study::Table;
use std::hint::black_box;
use std::time::Instant;
use thermobeam::ensemble::Ensemble;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::simulation::{BYTES_PER_ELEMENT, Problem, Simulation, Stepping};
use thermobeam::solve::{Level, Settings, Solver, Start};

/// Elements times steps of one timed run: some ten milliseconds.
const RUN: usize = 500_000;
/// Runs of which the best counts.
const REPEATS: usize = 9;

/// A time with the work behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
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
    watch: Watch,
}

/// What is looked at after each step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Watch {
    Nothing,
    Energy,
    Balance,
}

impl Setting<'_> {
    fn steps(&self) -> usize {
        (RUN / self.problem.mesh.elements()).max(20)
    }

    /// The best of several runs of one case.
    fn pace(&self) -> Result<Pace, SetupError> {
        let (n, steps) = (self.problem.mesh.elements(), self.steps());
        let mut best = Pace { nanoseconds: f64::INFINITY, passes: f64::NAN, factorizations: 0 };
        for _ in 0..REPEATS {
            let stepping =
                Stepping { scheme: self.scene.scheme, settings: self.settings, dt: self.scene.dt, loaded: false };
            let mut simulation = Simulation::new(self.problem.clone(), stepping)?;
            let mut levels = [simulation.level(), simulation.level()];
            let start = Instant::now();
            for _ in 0..steps {
                // A scene that fails is timed up to there; the paper's do not.
                if simulation.advance().is_err() {
                    break;
                }
                self.look(&mut simulation, &mut levels);
            }
            let done = simulation.step().max(1);
            let nanoseconds = start.elapsed().as_secs_f64() * 1e9 / (n * done) as f64;
            let work = simulation.work();
            if nanoseconds < best.nanoseconds {
                let passes = work.passes as f64 / done as f64;
                best = Pace { nanoseconds, passes, factorizations: work.factorizations };
            }
        }
        Ok(best)
    }

    fn look(&self, simulation: &mut Simulation, levels: &mut [Level; 2]) {
        if self.watch == Watch::Nothing {
            return;
        }
        let [old, new] = levels;
        simulation.observe(new);
        if self.watch == Watch::Energy {
            black_box(simulation.energy(new));
        } else {
            black_box(simulation.balance(old, new));
        }
        levels.swap(0, 1);
    }

    /// The same for four equal cases in lanes.
    fn lanes(&self) -> Result<Pace, SetupError> {
        let (n, steps, cases) = (self.problem.mesh.elements(), self.steps(), 4);
        let mut best = Pace { nanoseconds: f64::INFINITY, passes: f64::NAN, factorizations: 0 };
        for _ in 0..REPEATS {
            let (problems, dt) = (vec![self.problem.clone(); cases], vec![self.scene.dt; cases]);
            let mut ensemble = Ensemble::new(problems, &dt, self.scene.scheme, self.settings)?;
            let start = Instant::now();
            let mut balances = vec![];
            for _ in 0..steps {
                ensemble.advance();
                if self.watch != Watch::Nothing {
                    ensemble.balances(&mut balances);
                    black_box(&balances);
                }
            }
            let nanoseconds = start.elapsed().as_secs_f64() * 1e9 / (n * steps * cases) as f64;
            let work = ensemble.work();
            if nanoseconds < best.nanoseconds {
                best = Pace {
                    nanoseconds,
                    passes: work.passes as f64 / steps as f64,
                    factorizations: work.factorizations,
                };
            }
        }
        Ok(best)
    }
}

fn setting(scene: &Scene, mesh: Mesh) -> Setting<'_> {
    let scene_on_mesh = Scene { mesh, ..scene.clone() };
    Setting { problem: simulate::problem(&scene_on_mesh), scene, settings: scene.settings, watch: Watch::Nothing }
}

fn row(name: &str, pace: &Pace, against: f64) -> Vec<String> {
    vec![
        name.to_owned(),
        format!("{:.1}", pace.nanoseconds),
        format!("{:.2}", pace.nanoseconds / against),
        format!("{:.3}", pace.passes),
        pace.factorizations.to_string(),
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
    let base = || -> Result<Setting<'_>, SetupError> { Ok(setting(scene, Mesh::uniform(elements)?)) };
    let with = |settings: Settings| -> Result<Pace, SetupError> { Setting { settings, ..base()? }.pace() };
    let newton = with(scene.settings)?;
    let graded = setting(scene, Mesh::mapped(elements, |s| s + 0.1 * (std::f64::consts::TAU * s).sin())?).pace()?;
    let balanced = || -> Result<Setting<'_>, SetupError> { Ok(Setting { watch: Watch::Balance, ..base()? }) };
    let rows = [
        ("the paper's fixed point", with(Settings { solver: Solver::FixedPoint, ..scene.settings })?),
        ("Newton from the level before", with(Settings { start: Start::Previous, ..scene.settings })?),
        ("Newton, extrapolated start", newton),
        ("the same on a graded mesh", graded),
        ("four cases in lanes, per case", base()?.lanes()?),
        ("Newton, and the balance of each step", balanced()?.pace()?),
        ("four cases in lanes with it, per case", balanced()?.lanes()?),
    ];
    let rows = rows.iter().map(|(name, pace)| row(name, pace, newton.nanoseconds)).collect();
    Ok(table(&format!("Ways to solve a step, {elements} elements"), "way", rows))
}

/// What a scene pays for, against the full one.
///
/// # Errors
/// [`SetupError`] where the scene cannot be set up.
pub fn scenes(scene: &Scene, elements: usize) -> Result<Table, SetupError> {
    let full = setting(scene, Mesh::uniform(elements)?);
    let change = |apply: &dyn Fn(&mut Problem)| -> Result<Pace, SetupError> {
        let mut changed = setting(scene, Mesh::uniform(elements)?);
        apply(&mut changed.problem);
        changed.pace()
    };
    let cold = |problem: &mut Problem| {
        problem.beam.a = 0.0;
        problem.initial.theta.fill(0.0);
    };
    let whole = full.pace()?;
    let rows = [
        ("everything", whole),
        (
            "everything, observed with its energy at each step",
            Setting { watch: Watch::Energy, ..setting(scene, Mesh::uniform(elements)?) }.pace()?,
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
    let rows = rows.iter().map(|(name, pace)| row(name, pace, whole.nanoseconds)).collect();
    Ok(table(&format!("What a scene pays for, {elements} elements"), "scene", rows))
}

/// Cost and memory over the number of elements, of one case and of each of four in lanes.
///
/// # Errors
/// [`SetupError`] where the scene cannot be set up.
pub fn scaling(scene: &Scene, elements: &[usize]) -> Result<Table, SetupError> {
    let pace = |&n: &usize| {
        let setting = setting(scene, Mesh::uniform(n)?);
        Ok((n, setting.pace()?, setting.lanes()?))
    };
    let paces = elements.iter().map(pace).collect::<Result<Vec<_>, SetupError>>()?;
    let against = paces.iter().find(|(n, ..)| *n >= 1000).map_or(f64::NAN, |(_, pace, _)| pace.nanoseconds);
    let row = |(n, alone, lanes): &(usize, Pace, Pace)| {
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
    let title = "Over the number of elements; the ratio is to the first mesh of 1000 or more. Past the caches a step takes as long \
                 as its numbers take to come from memory and go back";
    Ok(Table { title: title.to_owned(), head: head.map(str::to_owned).to_vec(), rows: paces.iter().map(row).collect() })
}
