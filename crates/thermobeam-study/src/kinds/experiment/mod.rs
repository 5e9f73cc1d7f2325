//! The paper's Section 5, sentence by sentence: seven experiments are run until they are steady, the claims of the text are
//! judged, its figures redrawn.
//!
//! # What is measured, and how
//!
//! | quantity | measured as |
//! | --- | --- |
//! | steady | the energy has fallen by at most `rate` per unit of time over the last `window` |
//! | frequency of u(1) | upward crossings of zero on [0, t_end]: (their number - 1) / (last - first), each interpolated |
//! | amplitude of φ(1) | largest minus smallest value on [0, t_end] |
//! | first contact | when the tip first passes the obstacle, interpolated |
//! | rests on | the contact force of the last step, and the tip's position |
//!
//! t_end is that of the scene, 10 in the paper: the span of its figures.
//!
//! # Where the paper's text goes too far
//!
//! From the experiment at β = -0.8 it concludes that several steady states exist for β < -1/2. But between
//! -0.7116 and -1/2 it is wrong. With B = π²/4 / (1 + π²/4) = 0.711600 and without heating, steady states are the critical points of
//!
//! ```text
//! ½ (‖u_x - φ‖² + ‖φ_x‖² + β ‖u_x‖²) + ρ/4 ‖u_x‖⁴ + G(u(1)),
//! ```
//!
//! and `‖u_x - φ‖² + ‖φ_x‖² >= B ‖u_x‖²`: for β > -B this is strictly convex, so the straight beam is the only one. The
//! study shows this twice: by the list of all exact steady states, and by where moving beams come to rest.

mod judge;
mod report;

use super::prelude::*;
use super::steady::{ToRest, listed_scene};
use crate::kinds::settings;
use thermobeam::simulation::Simulation;

pub use super::steady::{AtRest, Nearest};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "experiment",
    read: reader::<Experiments>,
    why: "Section 5 of the paper says what its seven experiments show. Each statement is a condition on a run of ours.",
    judged: "One check a statement, with the numbers. Where a statement does not hold as printed, the check says what holds.",
    failure: "Our beam does not do what the paper's does, or the resolution is too coarse to tell.",
    settings: settings::of_experiments,
};

/// Approximate number of points of a curve in a figure: more than the figure has columns.
const POINTS: usize = 4000;

/// The time that an animation shows: the beam hits both obstacles several times.
const SPAN: f64 = 6.0;

/// Number of intervals of that time, with a frame at each end; the motion between frames is interpolated.
const PARTS: usize = 100;

/// The group of an experiment, which determines what is claimed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SectionGroup {
    /// θ_A = 0, (5.4): the beam becomes straight.
    First,
    /// θ_A = 20, (5.5): the beam comes to rest in this state of contact.
    Second(Phase),
    /// Beyond buckling: the beam comes to rest bent.
    Third,
}

/// One of the experiments.
#[derive(Debug, Clone, PartialEq)]
struct Experiment {
    group: SectionGroup,
    /// The scene, at the study's resolution.
    scene: Scene,
}

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiments {
    experiments: Vec<Experiment>,
    /// A longer run fails.
    t_max: f64,
    /// Span over which the energy's fall is measured: longer than an oscillation, because the beam stands still at
    /// turning points.
    window: f64,
    /// Fall of the energy per unit of time below which the state is steady.
    rate: f64,
    rest: ToRest,
}

/// What a case finds.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Of an experiment.
    Run(Box<Measured>),
    /// Of a run to rest.
    Rest(AtRest),
}

impl FromFile for Experiments {
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "experiments", "run", "steady"])?;
        let run = root.table("run", &["elements", "dt", "t_max", "window", "rate"])?;
        let (t_max, window, rate) = (
            run.positive("t_max")?,
            run.positive("window")?,
            run.positive("rate")?,
        );
        let field = run.require("t_max", POSITIVE)?;
        let mut experiments = experiments(root, folder)?;
        for Experiment { scene, .. } in &mut experiments {
            refine(&run, scene)?;
            limits::steps_until(&field, t_max, scene.dt(), limits::STEPS)?;
        }
        let rest = ToRest::read(&root.table("steady", &ToRest::KEYS)?)?;
        Ok(Self {
            experiments,
            t_max,
            window,
            rate,
            rest,
        })
    }
}

/// The table `[experiments]`: the scenes of the three groups.
fn experiments(root: &Section<'_>, folder: &Path) -> Result<Vec<Experiment>, InputError> {
    let section = root.table("experiments", &["first", "second", "rests", "third"])?;
    // At least two scenes in ascending order of β, since the claims compare neighbours.
    let ascending = |key: &str| {
        let fits = |scenes: &[Scene]| {
            scenes.len() >= 2 && scenes.is_sorted_by(|a, b| a.beam.beta < b.beam.beta)
        };
        let allowed = "a list of at least two scene files, beta ascending";
        section.list(key, allowed, |item| listed_scene(item, folder), fits)
    };
    let (first, second) = (ascending("first")?, ascending("second")?);
    // The contact state that is claimed for each beam of the second group.
    let choices = [
        ("upper", Phase::Upper),
        ("lower", Phase::Lower),
        ("free", Phase::Free),
    ];
    let allowed = "a list of \"upper\", \"lower\" or \"free\", one for each scene of second";
    let rests = section.list(
        "rests",
        allowed,
        |item| item.choice(&choices),
        |list| list.len() == second.len(),
    )?;
    let third = listed_scene(&section.require("third", "a scene file")?, folder)?;
    let one = |(group, scene): (SectionGroup, Scene)| Experiment { group, scene };
    let first = first.into_iter().map(|scene| (SectionGroup::First, scene));
    let second = rests.into_iter().map(SectionGroup::Second).zip(second);
    Ok(first
        .chain(second)
        .chain([(SectionGroup::Third, third)])
        .map(one)
        .collect())
}

/// Another mesh and time step, if `[run]` has them.
fn refine(run: &Section<'_>, scene: &mut Scene) -> Result<(), InputError> {
    let (elements, dt) = (run.get("elements"), run.get("dt"));
    if elements.is_none() && dt.is_none() {
        return Ok(());
    }
    let elements = elements
        .as_ref()
        .map_or(Ok(scene.mesh.elements()), tables::elements)?;
    let dt = dt.map_or(Ok(scene.dt()), |field| field.positive())?;
    let mesh = Mesh::uniform(elements)
        .map_err(|error| run.refuse("elements", error.to_string(), "a mesh"))?;
    *scene = scene.at(mesh, dt);
    Ok(())
}

impl Kind for Experiments {
    /// Number of the case: the experiments, then the runs to rest.
    type Data = usize;
    type Found = Found;

    /// The seven experiments, then for each β a moving beam until it rests.
    fn cases(&self) -> Vec<Case<usize>> {
        // Steady states are reached at t = 50 to 100.
        let cost = |scene: &Scene| 80.0 / scene.dt() * scene.mesh.elements() as f64;
        let run = |Experiment { scene, .. }: &Experiment| (scene.name.clone(), cost(scene));
        let rest = |beta: &f64| (format!("to rest, beta = {beta}"), self.rest.cost());
        let cases = self
            .experiments
            .iter()
            .map(run)
            .chain(self.rest.betas.iter().map(rest));
        cases
            .enumerate()
            .map(|(data, (label, cost))| Case::new(label, cost, data))
            .collect()
    }

    fn run(&self, &case: &usize) -> Result<Found, CaseFailure> {
        if let Some(Experiment { scene, .. }) = self.experiments.get(case) {
            return Ok(Found::Run(Box::new(self.run_until_steady(scene)?)));
        }
        let count = self.experiments.len();
        // The third experiment is the last.
        Ok(Found::Rest(
            self.rest
                .run(&self.experiments[count - 1].scene, case - count)?,
        ))
    }

    fn judge(&self, ran: &[Ran<usize, Found>]) -> Outcome {
        report::outcome(self, ran)
    }
}

/// The results of an experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The beam as soon as it is steady.
    pub end: AtRest,
    /// The energy then.
    pub energy: f64,
    /// The contact force then: positive at the upper obstacle.
    pub contact_force: f64,
    /// Largest absolute nodal value of u, φ and the lifted temperature then.
    pub largest_field: f64,
    /// When u(1) first passes the upper obstacle, within the figures' span.
    pub first_upper: Option<f64>,
    /// When u(1) first passes the lower obstacle, within the figures' span.
    pub first_lower: Option<f64>,
    /// Upward crossings of zero by u(1) within the figures' span.
    pub crossings: usize,
    /// Frequency of u(1); `None` with fewer than two crossings.
    pub frequency: Option<f64>,
    /// Largest minus smallest φ(1) within the figures' span.
    pub phi_amplitude: f64,
    /// Largest change of the energy in a step: negative if the energy falls in every step.
    pub largest_increase: f64,
    /// Free end and energy over time.
    pub points: Vec<Sample>,
    /// u in the first seconds.
    pub frames: figures::Frames,
}

impl Experiments {
    /// Runs a scene until its energy is steady.
    ///
    /// # Errors
    /// A step that fails, steady states that cannot be found, or a beam that still moves at `t_max`.
    fn run_until_steady(&self, scene: &Scene) -> Result<Measured, CaseFailure> {
        let mut driver = driver(scene)?;
        let mut log = MotionLog::new(scene, &mut driver);
        let window = (self.window / scene.dt()).round().max(1.0) as usize;
        let mut fall = 0.0;
        loop {
            let Step {
                old,
                new,
                simulation,
                ..
            } = driver.stepped()?;
            // Summed from differences: the round-off of the total would hide a slow fall.
            let change = simulation.energy_change(old, new);
            log.largest_increase = max_or_nan(log.largest_increase, change);
            log.add(simulation, new);
            fall -= change;
            if simulation.step() % window == 0 {
                if fall <= self.rate * self.window {
                    return log.finish(simulation, new);
                }
                fall = 0.0;
            }
            if !(simulation.t() < self.t_max) {
                return Err(CaseFailure::new(format!(
                    "not steady by t = {}",
                    self.t_max
                )));
            }
        }
    }
}

/// What has been recorded of a run so far.
struct MotionLog<'a> {
    scene: &'a Scene,
    /// (t, u(1), φ(1)) at the start and after each step in the figures' span.
    motion: Vec<[f64; 3]>,
    largest_increase: f64,
    points: Vec<Sample>,
    frames: figures::Frames,
}

impl<'a> MotionLog<'a> {
    fn new(scene: &'a Scene, driver: &mut Driver) -> Self {
        let largest_increase = f64::NEG_INFINITY;
        let frames = figures::Frames {
            points: scene.mesh.nodes().to_vec(),
            ..Default::default()
        };
        let mut log = Self {
            scene,
            motion: vec![],
            largest_increase,
            points: vec![],
            frames,
        };
        let (simulation, level) = driver.present();
        log.add(simulation, level);
        log
    }

    fn add(&mut self, simulation: &Simulation, level: &Level) {
        let (t, step, tip) = (simulation.t(), simulation.step(), level.u.len() - 1);
        let (t_end, dt) = (self.scene.t_end, self.scene.dt());
        // Half a step of slack: n dt differs from t_end by round-off.
        if t <= t_end + 0.5 * dt {
            self.motion.push([t, level.u[tip], level.phi[tip]]);
        }
        let of_frames = (SPAN / dt).round() as usize;
        if step <= of_frames && step.is_multiple_of((of_frames / PARTS).max(1)) {
            self.frames.times.push(t);
            self.frames.u.push(level.u.clone());
        }
        // Beyond the figures' span only slow, smooth motion is left.
        let stride =
            ((t_end / dt).round() as usize / POINTS).max(1) * if t <= t_end { 1 } else { 10 };
        if step.is_multiple_of(stride) {
            let (Scene { mesh, beam, .. }, energy) = (self.scene, simulation.energy(level).total());
            self.points
                .push(Sample::of(level, t, mesh, beam.theta_a, energy));
        }
    }

    /// When u(1) passes a value between two levels that `passes` accepts, interpolated.
    fn passings(&self, at: f64, passes: impl Fn(f64, f64) -> bool) -> impl Iterator<Item = f64> {
        let pairs = self
            .motion
            .windows(2)
            .map(|pair| [pair[0][1], pair[1][1], pair[1][0]]);
        let passing = pairs.filter(move |[before, now, _]| passes(*before, *now));
        passing.map(move |[before, now, t]| t - self.scene.dt() * (now - at) / (now - before))
    }

    fn finish(self, simulation: &Simulation, end: &Level) -> Result<Measured, CaseFailure> {
        let values = [&end.u, &end.phi, &end.theta].into_iter().flatten();
        let obstacles = self.scene.obstacles.as_ref();
        let upper = obstacles.and_then(|of| {
            self.passings(of.g2, |before, now| before <= of.g2 && now > of.g2)
                .next()
        });
        let lower = obstacles.and_then(|of| {
            self.passings(of.g1, |before, now| before >= of.g1 && now < of.g1)
                .next()
        });
        let crossings: Vec<f64> = self
            .passings(0.0, |before, now| before < 0.0 && now >= 0.0)
            .collect();
        let count = crossings.len();
        // The start is not a step.
        let largest = |sign: f64| {
            self.motion
                .iter()
                .skip(1)
                .map(|[_, _, phi]| sign * phi)
                .fold(f64::NEG_INFINITY, max_or_nan)
        };
        Ok(Measured {
            end: AtRest::of(self.scene, &self.scene.mesh, simulation.t(), end, |_| true)?,
            energy: simulation.energy(end).total(),
            contact_force: end.contact_force,
            largest_field: values.fold(0.0, |most, value| max_or_nan(most, value.abs())),
            first_upper: upper,
            first_lower: lower,
            crossings: count,
            frequency: (count >= 2)
                .then(|| (count as f64 - 1.0) / (crossings[count - 1] - crossings[0])),
            phi_amplitude: largest(1.0) + largest(-1.0),
            largest_increase: self.largest_increase,
            points: self.points,
            frames: self.frames,
        })
    }
}

/// The energy of the straight beam at rest; NaN for the linear beam, whose energy differs by a constant.
fn straight_energy(scene: &Scene) -> f64 {
    figures::energy_at_rest(&scene.beam).unwrap_or(f64::NAN)
}
