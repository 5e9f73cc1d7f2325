//! Proposition 3.1: the energy never rises; and, sharper, its balance closes to round-off in every step.
//!
//! ```toml
//! [energy]
//! scenes = ["scenes/paper-1-beta-0.toml"]       # files beside this one
//! schemes = ["euler-crank-nicolson", "midpoint"]
//! elements = 50                                 # of the mesh, graded or uniform as below
//! map = "s"                                     # optional
//! dt = 1e-3
//! steps = 1000
//! random = 16                                   # beams with random coefficients and random smooth data
//! seed = 1
//! tolerance = 1e-12                             # of the balance's residual, in units of the initial energy
//! ```

mod random;

pub(super) use random::wild;

use crate::expression::Variable;
use crate::kinds::untyped::{Case, Measured};
use crate::kinds::{FromFile, Study};
use crate::run::patience::StepPatience;
use crate::run::simulate;
use crate::scene::Scene;
use crate::scene::functions::FunctionField;
use crate::scene::limits;
use crate::scene::tables;
use convergence_study::input::{self, InputError, Section};
use convergence_study::plots;
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::{Check, Figure, Outcome, Table};
use convergence_study::text::number::max_or_nan;
use std::path::Path;
use thermobeam::energy::Energy;
use thermobeam::mesh::Mesh;
use thermobeam::scheme::{SCHEMES, Scheme};
use thermobeam::simulation::{Problem, Simulation, Stepping};
use thermobeam::solve::Settings;

/// Name of the kind.
pub const ENERGY: &str = "energy";

/// Increment at which a step counts as solved: the balance holds for the exact solution of a step only.
const SOLVED: f64 = 1e-14;
/// Points of a curve in a figure.
const POINTS: usize = 400;

/// A study of this kind.
pub struct EnergyDecay {
    header: Header,
    scenes: Vec<Scene>,
    schemes: Vec<Scheme>,
    mesh: Mesh,
    dt: f64,
    steps: usize,
    random: usize,
    seed: u64,
    tolerance: f64,
}

impl FromFile for EnergyDecay {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, Self::from_document)
    }
}

impl EnergyDecay {
    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "energy"])?;
        let section = root.require("energy", "a table with scenes, schemes, elements, dt and steps")?.section()?;
        section.allow(&["scenes", "schemes", "elements", "map", "dt", "steps", "random", "seed", "tolerance"])?;
        let list = "a list of scene files beside this one";
        let scenes = section.require("scenes", list)?.items(list)?;
        let names = SCHEMES.map(|scheme| (scheme.name, scheme));
        let list = "a list of at least one scheme";
        let schemes = section.require("schemes", list)?.items(list)?;
        let map = section.get("map").map(|field| field.expression(Variable::S)).transpose()?;
        let elements = section.require("elements", "a number of elements")?;
        let mesh = Mesh::mapped(tables::elements(&elements)?, |s| map.as_ref().map_or(s, |map| map.eval(s)));
        let positive = "a finite number > 0";
        let count = |key: &str| section.get(key).map_or(Ok(0), |field| field.count(0..=usize::MAX));
        let random = count("random")?;
        if let Some(field) = section.get("random") {
            limits::cases(&field, &[random, schemes.len()])?;
        }
        Ok(Self {
            header: Header::from_document(root)?,
            scenes: scenes.iter().map(|file| Scene::read(file.file(folder)?)).collect::<Result<_, _>>()?,
            schemes: schemes.iter().map(|scheme| scheme.choice(&names)).collect::<Result<_, _>>()?,
            mesh: tables::checked_mesh(mesh, &elements)?,
            dt: section.require("dt", positive)?.number_where(positive, |dt| dt > 0.0)?,
            steps: section.require("steps", "a number of steps")?.count(1..=limits::STEPS)?,
            random,
            seed: count("seed")? as u64,
            tolerance: section.require("tolerance", positive)?.number_where(positive, |t| t > 0.0)?,
        })
    }

    /// Name, problem and scheme of a case.
    fn problem(&self, index: usize) -> (String, Problem, Scheme) {
        let scheme = self.schemes[index % self.schemes.len()];
        let index = index / self.schemes.len();
        let (name, problem) = match self.scenes.get(index) {
            Some(scene) => {
                let scene = Scene { mesh: self.mesh.clone(), ..scene.clone() };
                (scene.name.clone(), simulate::problem(&scene))
            }
            None => {
                let number = (index - self.scenes.len()) as u64;
                (format!("random-{number}"), random::problem(&self.mesh, self.seed + number))
            }
        };
        (format!("{name}, {}", scheme.name), problem, scheme)
    }
}

impl Study for EnergyDecay {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let count = (self.scenes.len() + self.random) * self.schemes.len();
        let cost = self.mesh.elements() as f64 * self.steps as f64;
        (0..count).map(|index| Case { label: self.problem(index).0, cost }).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let (_, problem, scheme) = self.problem(index);
        let settings = Settings { tolerance: SOLVED, ..Settings::default() };
        let mut simulation = Simulation::new(problem, Stepping { scheme, settings, dt: self.dt, loaded: false })?;
        let mut old = simulation.level();
        let mut new = old.clone();
        let scale = scale(&simulation.energy(&old));
        let (mut energy, mut residuals) = (vec![], vec![]);
        let (mut increase, mut residual) = (f64::NEG_INFINITY, 0.0_f64);
        let every = self.steps.div_ceil(POINTS);
        let mut peak = 0.0_f64;
        let mut patience = Patience::of(&simulation);
        for step in 1..=self.steps {
            patience.before_step_of(&simulation)?;
            simulation.advance()?;
            simulation.observe(&mut new);
            let balance = simulation.balance(&old, &new);
            let relative = balance.residual.abs() / scale;
            increase = max_or_nan(increase, balance.change / scale);
            residual = max_or_nan(residual, relative);
            peak = max_or_nan(peak, relative);
            if step % every == 0 {
                energy.push((simulation.t(), simulation.energy(&new).total()));
                residuals.push((simulation.t(), peak));
                peak = 0.0;
            }
            std::mem::swap(&mut old, &mut new);
        }
        let values = vec![
            ("scale".to_owned(), scale),
            ("largest increase".to_owned(), increase),
            ("largest residual".to_owned(), residual),
        ];
        Ok(Measured { values, series: vec![("energy".to_owned(), energy), ("residual".to_owned(), residuals)] })
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let cases = self.cases();
        let mut checks = vec![];
        let mut rows = vec![];
        let (mut worst_increase, mut worst_residual) = (f64::NEG_INFINITY, 0.0);
        for (case, result) in cases.iter().zip(results) {
            let name = &case.label;
            match result {
                Ok(measured) => {
                    let (increase, residual) = (measured.value("largest increase"), measured.value("largest residual"));
                    worst_increase = max_or_nan(worst_increase, increase);
                    worst_residual = max_or_nan(worst_residual, residual);
                    let evidence =
                        format!("largest increase {increase:.1e}, residual {residual:.1e} of the initial energy");
                    let holds = increase <= self.tolerance && residual <= self.tolerance;
                    checks.push(Check::that(
                        holds,
                        format!("{name}: the energy falls and its balance closes"),
                        evidence,
                    ));
                    rows.push(vec![
                        name.clone(),
                        format!("{:.4e}", measured.value("scale")),
                        format!("{increase:.1e}"),
                        format!("{residual:.1e}"),
                    ]);
                }
                Err(failure) => checks.push(Check::that(false, format!("{name}: runs to its end"), &failure.reason)),
            }
        }
        let summary = format!(
            "{} runs: largest increase of the energy {worst_increase:.1e}, largest residual of the balance {worst_residual:.1e} of the initial energy",
            results.len()
        );
        let headline = format!(
            "largest residual {worst_residual:.1e} of the energy, largest change in a step {worst_increase:.1e}"
        );
        let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
        let head = ["run", "initial energy", "largest increase", "largest residual"].map(str::to_owned).to_vec();
        outcome.tables.push(Table {
            title: "Balance over all steps, in units of the initial energy".to_owned(),
            head,
            rows,
        });
        outcome.figures = self.figures(&cases, results);
        outcome
    }
}

impl EnergyDecay {
    fn figures(&self, cases: &[Case], results: &[Result<Measured, CaseFailure>]) -> Vec<Figure> {
        // The scenes by the first scheme: random beams and further schemes would only crowd the picture.
        let shown = self.scenes.len() * self.schemes.len();
        let series = |name: &str, relative: bool| {
            cases[..shown]
                .iter()
                .zip(results)
                .step_by(self.schemes.len())
                .filter_map(|(case, result)| {
                    let measured = result.as_ref().ok()?;
                    let label = case.label.split(',').next().unwrap_or_default().to_owned();
                    let unit = if relative { measured.value("scale") } else { 1.0 };
                    let points = measured.curve(name).iter().map(|&(t, value)| (t, value / unit)).collect();
                    Some(plots::Series { label, points })
                })
                .collect::<Vec<_>>()
        };
        let figure = |what: &str, caption: &str, y, series| Figure {
            file: format!("{}-{what}.svg", self.header.id),
            caption: caption.to_owned(),
            svg: plots::history(&plots::History { y, series, ..plots::History::default() }),
        };
        vec![
            figure(
                "energy",
                "The energy never rises. Its unit is its size at the beginning.",
                plots::Axis::linear("energy E / initial energy"),
                series("energy", true),
            ),
            figure(
                "balance",
                "Residual of the energy balance, largest in each group of steps, in units of the initial energy.",
                plots::Axis::log("residual / initial energy"),
                series("residual", false),
            ),
        ]
    }
}

/// The size of an energy: its terms without their signs.
fn scale(energy: &Energy) -> f64 {
    let Energy { kinetic, shear, bending, thermal, kirchhoff, contact, lifting } = energy;
    kinetic + shear + bending + thermal + kirchhoff.abs() + contact + lifting.abs()
}
