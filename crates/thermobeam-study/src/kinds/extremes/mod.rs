//! Scenes at the edge of what is allowed, and past the edge of the theory: each with what it must come to.
//!
//! Every case ends with the answer, or with the typed error, that it claims; up to there the energy never rises and its
//! balance closes, in every step, within 1e-12 of the energy or what rounding errors explain. Where a case claims a `drift`, the
//! residuals of all its steps, added up with their signs, stay below it: rounding errors that all pull to one side would not.
//!
//! ```toml
//! [[case]]
//! name = "long-steps"
//! claim = "..."                # in words
//! ends = "answer"              # or "indefinite", "iteration-limit", "not-finite": a typed error
//! drift = 1e-10                # optional: bound of the sum of all residuals, in units of the energy
//! # and the tables of a scene
//! [case.time]
//! dt = 10.0
//! t_end = 1000.0
//! ```

mod report;

use crate::kinds::untyped::{Case, Measured};
use crate::kinds::watch::{SOLVED, Watch};
use crate::kinds::{FromFile, Study};
use crate::run::patience::StepPatience;
use crate::run::simulate;
use crate::scene::{self, Scene};
use convergence_study::input::{self, InputError, Section};
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::Outcome;
use std::path::Path;
use thermobeam::error::StepFailure;
use thermobeam::simulation::{Simulation, Stepping};
use thermobeam::solve::{Level, Settings, Solver};

/// Name of the kind.
pub const KIND: &str = "extremes";

/// Points of a curve in a figure.
const POINTS: usize = 300;

/// Every so many steps the size of the energy is looked at.
const SCALED: usize = 8;

/// A study of this kind.
#[derive(Debug, Clone)]
pub struct Extremes {
    header: Header,
    extremes: Vec<Extreme>,
}

/// A case, read.
#[derive(Debug, Clone)]
struct Extreme {
    scene: Scene,
    claim: String,
    end: End,
    drift: Option<f64>,
}

/// How a run ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    Answer,
    Indefinite,
    IterationLimit,
    NotFinite,
}

impl End {
    const ALL: [(&str, End); 4] = [
        ("answer", End::Answer),
        ("indefinite", End::Indefinite),
        ("iteration-limit", End::IterationLimit),
        ("not-finite", End::NotFinite),
    ];

    fn of(failure: &StepFailure) -> Self {
        match failure {
            StepFailure::Indefinite { .. } => End::Indefinite,
            StepFailure::Diverged { .. } | StepFailure::IterationLimit { .. } => End::IterationLimit,
            StepFailure::NonFinite { .. } => End::NotFinite,
        }
    }

    /// Its number in [`End::ALL`], as it is measured.
    fn code(self) -> f64 {
        Self::ALL.iter().position(|(_, end)| *end == self).map_or(f64::NAN, |k| k as f64)
    }

    fn name_of(code: f64) -> &'static str {
        Self::ALL.iter().find(|(_, end)| end.code() == code).map_or("nothing", |(name, _)| name)
    }
}

impl FromFile for Extremes {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, |root, _| Self::from_document(root))
    }
}

impl Extremes {
    fn from_document(root: &Section<'_>) -> Result<Self, InputError> {
        root.allow(&["study", "case"])?;
        let allowed = "a list of at least one case, each [[case]]";
        let list = root.require("case", allowed)?;
        let items = list.items(allowed)?;
        let mut extremes: Vec<Extreme> = Vec::new();
        for item in &items {
            let extreme = extreme(&item.section()?)?;
            if extremes.iter().any(|earlier| earlier.scene.name == extreme.scene.name) {
                return Err(item.refuse(format!("a second \"{}\"", extreme.scene.name), "a name of its own"));
            }
            extremes.push(extreme);
        }
        if extremes.is_empty() {
            Err(list.refuse_as_written(allowed))
        } else {
            Ok(Self { header: Header::from_document(root)?, extremes })
        }
    }
}

fn extreme(section: &Section<'_>) -> Result<Extreme, InputError> {
    section.allow(&[&["name", "claim", "ends", "drift"], &scene::TABLES[..]].concat())?;
    let name = section.require("name", "a text")?.text()?;
    let positive = "a finite number > 0";
    Ok(Extreme {
        scene: Scene::from_tables(section, name.to_owned())?,
        claim: section.require("claim", "a text")?.text()?.to_owned(),
        end: section.require("ends", "\"answer\" or an error")?.choice(&End::ALL)?,
        drift: section.get("drift").map(|drift| drift.number_where(positive, |drift| drift > 0.0)).transpose()?,
    })
}

impl Study for Extremes {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let case = |extreme: &Extreme| {
            let scene = &extreme.scene;
            // A step costs some 100 ns beside that of its elements.
            let cost = scene.steps as f64 * (4.0 * scene.mesh.elements() as f64 + 4.0);
            Case { label: scene.name.clone(), cost }
        };
        self.extremes.iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        run(&self.extremes[index].scene)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        report::outcome(self, results)
    }
}

/// Runs a scene to its end, or to the step that cannot be done.
fn run(scene: &Scene) -> Result<Measured, CaseFailure> {
    let newton = scene.settings.solver == Solver::Newton;
    let settings = if newton { Settings { tolerance: SOLVED, ..scene.settings } } else { scene.settings };
    let stepping = Stepping { scheme: scene.scheme, settings, dt: scene.dt, loaded: false };
    let mut simulation = Simulation::new(simulate::problem(scene), stepping)?;
    let mut old = simulation.level();
    let mut new = Level::new(old.u.len());
    let start = simulation.energy(&old).total();
    let mut watch = Watch::new(simulation.energy_scale(&old));
    let (mut end, mut done, mut contact, mut most) = (End::Answer, 0, 0, 0);
    let (mut drift, every) = (vec![], scene.steps.div_ceil(POINTS));
    let mut patience = Patience::of(&simulation);
    for step in 1..=scene.steps {
        patience.before_step_of(&simulation)?;
        match simulation.advance() {
            Ok(report) => most = most.max(report.iterations),
            Err(error) => {
                end = End::of(&error.failure);
                break;
            }
        }
        done = step;
        simulation.observe(&mut new);
        contact += usize::from(new.contact_force != 0.0);
        // The scale only grows, so that a level left out makes the laws stricter.
        let scale = if step % SCALED == 1 { simulation.energy_scale(&new) } else { 0.0 };
        let balance = simulation.balance(&old, &new);
        watch.step(&balance, scale, || simulation.rounding(&old, &new));
        if step % every == 0 {
            drift.push((step as f64, watch.drift.abs()));
        }
        std::mem::swap(&mut old, &mut new);
    }
    let mut measured = Measured::default();
    let lost = start - simulation.energy(&old).total();
    let values = [
        ("end", end.code()),
        ("steps", done as f64),
        ("contact", contact as f64),
        ("most iterations", most as f64),
        ("lost", lost),
    ];
    values.iter().for_each(|(name, value)| measured.push(*name, *value));
    if done > 0 {
        measured.push("drift", watch.drift.abs());
        watch.worsen(&mut measured);
    }
    measured.series = vec![("drift".to_owned(), drift)];
    Ok(measured)
}
