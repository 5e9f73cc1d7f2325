//! Random scenes by the thousand: every coefficient over its whole range, wild meshes, rough data, steps up to 10.
//!
//! Each ends with an answer or a typed error, and as long as there is an answer the energy never rises and its balance
//! closes. The scenes are those of [`wild`](super::energy), seed by seed the same on every machine; Newton's method runs
//! eight of them side by side.
//!
//! A step may be refused for one reason only: its operator is not definite. With `‖V_x - W‖² + ‖W_x‖² >= B ‖V_x‖²`, B the
//! buckling force, it is definite where `B (ζ + dt/2) + m dt/2 > 0`, and the mean axial force m is never below β. So every
//! scene with `β > -B (1 + 2 ζ/dt)` must have its answer.
//!
//! ```toml
//! [random-scenes]
//! batches = 64       # of 256 scenes, with 1 to 32 elements; the scheme changes from batch to batch
//! steps = 20
//! seed = 1
//! ```

mod report;

use crate::kinds::energy::wild;
use crate::kinds::untyped::{Case, Measured};
use crate::kinds::watch::{CLOSED, SOLVED, Watch};
use crate::kinds::{FromFile, Study};
use crate::scene::limits;
use convergence_study::input::{self, InputError, Section};
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::Outcome;
use std::path::Path;
use thermobeam::ensemble::Ensemble;
use thermobeam::error::StepFailure;
use thermobeam::kirchhoff::BUCKLING;
use thermobeam::parameters::Beam;
use thermobeam::scheme::{SCHEMES, Scheme};
use thermobeam::simulation::Problem;
use thermobeam::solve::{Level, Settings};

/// Name of the kind.
pub const KIND: &str = "random-scenes";

/// Scenes side by side.
const LANES: usize = 8;
/// Groups of lanes in a batch: one for each number of elements, from 1 on.
const GROUPS: usize = 32;
/// Scenes in a batch.
const BATCH: usize = LANES * GROUPS;
/// The worst exceptions of a batch that are kept.
const KEPT: usize = 4;

/// A study of this kind.
#[derive(Debug, Clone)]
pub struct RandomScenes {
    header: Header,
    batches: usize,
    steps: usize,
    seed: u64,
}

impl FromFile for RandomScenes {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, |root, _| Self::from_document(root))
    }
}

impl RandomScenes {
    fn from_document(root: &Section<'_>) -> Result<Self, InputError> {
        root.allow(&["study", KIND])?;
        let section = root.require(KIND, "a table with batches, steps and seed")?.section()?;
        section.allow(&["batches", "steps", "seed"])?;
        let number = "a whole number";
        Ok(Self {
            header: Header::from_document(root)?,
            batches: section.require("batches", number)?.count(1..=100_000)?,
            steps: section.require("steps", number)?.count(1..=limits::STEPS)?,
            seed: section.require("seed", number)?.count(0..=u32::MAX as usize)? as u64,
        })
    }

    /// The seed of a scene, by its number.
    fn seed_of(&self, scene: usize) -> u64 {
        // Far from those of other studies, whose seeds are small.
        (self.seed << 32) + scene as u64
    }

    fn scheme(&self, batch: usize) -> Scheme {
        SCHEMES[batch % SCHEMES.len()]
    }
}

/// Whether the operator of every step is definite, whatever the axial force turns out to be.
fn definite(beam: &Beam, dt: f64) -> bool {
    beam.beta > -BUCKLING * (1.0 + 2.0 * beam.zeta / dt)
}

/// How a scene ended, counted by these names.
const ANSWER: &str = "answers";
const INDEFINITE: &str = "indefinite";
const LIMIT: &str = "iteration limit";
const NOT_FINITE: &str = "not finite";
const ENDS: [&str; 4] = [ANSWER, INDEFINITE, LIMIT, NOT_FINITE];

fn name_of(failure: &StepFailure) -> &'static str {
    match failure {
        StepFailure::Indefinite { .. } => INDEFINITE,
        StepFailure::Diverged { .. } | StepFailure::IterationLimit { .. } => LIMIT,
        StepFailure::NonFinite { .. } => NOT_FINITE,
    }
}

/// What a batch has seen.
#[derive(Default)]
struct Tally {
    ends: [usize; ENDS.len()],
    /// Scenes refused though their operators are definite.
    refused: usize,
    steps: usize,
    /// Numbers that are not finite in a level that was given out as an answer.
    broken: usize,
    worst: Measured,
    /// Scene, residual: those whose balance does not close to 1e-12.
    exceptions: Vec<(f64, f64)>,
    /// dt and shortest element, each with the residual.
    over_dt: Vec<(f64, f64)>,
    over_h: Vec<(f64, f64)>,
}

impl Study for RandomScenes {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        // 16 elements on average, and an observed step costs some 100 ns an element.
        let cost = (BATCH * self.steps * GROUPS / 2) as f64 * 4.0;
        let label = |batch: usize| format!("scenes {} to {}", batch * BATCH, (batch + 1) * BATCH - 1);
        (0..self.batches).map(|batch| Case { label: label(batch), cost }).collect()
    }

    fn run(&self, batch: usize) -> Result<Measured, CaseFailure> {
        let mut tally = Tally::default();
        for group in 0..GROUPS {
            self.run_group(batch, group, &mut tally)?;
        }
        Ok(tally.measured())
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        report::outcome(self, results)
    }
}

impl RandomScenes {
    /// Scenes with `group + 1` elements each, to their ends.
    fn run_group(&self, batch: usize, group: usize, tally: &mut Tally) -> Result<(), CaseFailure> {
        let first = batch * BATCH + group * LANES;
        let scenes: Vec<(Problem, f64)> =
            (first..first + LANES).map(|scene| wild(group + 1, self.seed_of(scene))).collect::<Result<_, _>>()?;
        let dt: [f64; LANES] = std::array::from_fn(|k| scenes[k].1);
        let settings = Settings { tolerance: SOLVED, ..Settings::default() };
        let problems = scenes.iter().map(|(problem, _)| problem.clone()).collect();
        let mut ensemble = Ensemble::new(problems, &dt, self.scheme(batch), settings)?;
        let mut old: Vec<Level> = vec![Level::new(group + 2); LANES];
        (0..LANES).for_each(|k| ensemble.observe(k, &mut old[k]));
        let mut watches: Vec<Watch> = (0..LANES).map(|k| Watch::new(ensemble.energy_scale(k, &old[k]))).collect();
        let mut ends: [Option<&str>; LANES] = [None; LANES];
        let (mut new, mut balances) = (Level::new(group + 2), vec![]);
        let mut patience = Patience::new(LANES * (group + 1));
        for step in 0..self.steps {
            patience.check(step, || step as f64 * dt[0])?;
            ensemble.advance();
            ensemble.balances(&mut balances);
            for k in (0..LANES).filter(|&k| ends[k].is_none()).collect::<Vec<_>>() {
                if let Err(error) = ensemble.report(k) {
                    ends[k] = Some(name_of(&error.failure));
                    tally.refused += usize::from(definite(&scenes[k].0.beam, dt[k]));
                    continue;
                }
                ensemble.observe(k, &mut new);
                let scale = ensemble.energy_scale(k, &new);
                watches[k].step(&balances[k], scale, || ensemble.rounding(k, &old[k], &new));
                tally.steps += 1;
                tally.broken += usize::from(!is_finite(&new));
                std::mem::swap(&mut old[k], &mut new);
            }
        }
        for k in 0..LANES {
            tally.file((first + k, &scenes[k].0, dt[k]), &watches[k], ends[k].unwrap_or(ANSWER));
        }
        Ok(())
    }
}

fn is_finite(level: &Level) -> bool {
    let fields = [&level.u, &level.v, &level.phi, &level.w, &level.theta];
    level.contact_force.is_finite() && fields.iter().all(|field| field.iter().all(|value| value.is_finite()))
}

impl Tally {
    fn file(&mut self, (scene, problem, dt): (usize, &Problem, f64), watch: &Watch, end: &str) {
        for (count, name) in self.ends.iter_mut().zip(ENDS) {
            *count += usize::from(name == end);
        }
        watch.worsen(&mut self.worst);
        if !(watch.residual <= CLOSED) {
            self.exceptions.push((scene as f64, watch.residual));
        }
        let shortest = problem.mesh.lengths().fold(f64::INFINITY, f64::min);
        self.over_dt.push((dt, watch.residual));
        self.over_h.push((shortest, watch.residual));
    }

    fn measured(mut self) -> Measured {
        let mut measured = self.worst;
        for (name, count) in ENDS.iter().zip(self.ends) {
            measured.push(*name, count as f64);
        }
        measured.push("refused", self.refused as f64);
        measured.push("steps", self.steps as f64);
        measured.push("broken", self.broken as f64);
        measured.push("exceptions", self.exceptions.len() as f64);
        self.exceptions.sort_by(|a, b| b.1.total_cmp(&a.1));
        self.exceptions.truncate(KEPT);
        measured.series = [("exceptions", self.exceptions), ("over dt", self.over_dt), ("over h", self.over_h)]
            .map(|(name, points)| (name.to_owned(), points))
            .to_vec();
        measured
    }
}
