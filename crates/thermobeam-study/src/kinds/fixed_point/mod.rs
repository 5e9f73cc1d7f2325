//! The convergence of the paper's fixed point (4.1)-(4.5), which the paper leaves out.
//!
//! In contact its error shrinks by `α = dt/ε [A_u⁻¹]_nn` per iteration and past α = 1 it diverges
//! ([`contact_contraction`](thermobeam::contraction::contact_contraction)); measured over all combinations of dt, ε and ζ.
//! On a scene it agrees with Newton's method,
//! and its tolerance η* bounds its error.
//!
//! ```toml
//! [fixed-point]
//! scene = "scenes/paper-1-beta-0.toml"     # a file beside this one
//! elements = 100
//! dt = [1e-4, 1e-3]
//! epsilon = [1e-4, 1e-3]
//! zeta = [0.01, 0.1]
//! steps = 1000                             # of the scene, with its own dt
//! tolerances = [1e-4, 1e-6, 1e-8]          # η*, falling
//! ```

mod contraction;
mod scene;

use crate::kinds::untyped::{Case, Measured};
use crate::kinds::{FromFile, Study};
use crate::scene::Scene;
use crate::scene::limits;
use crate::scene::tables;
use convergence_study::input::{self, InputError, Section};
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::{Check, Outcome};
use std::path::Path;

/// Name of the kind.
pub const FIXED_POINT: &str = "fixed-point";

/// A study of this kind.
pub struct FixedPoint {
    header: Header,
    scene: Scene,
    elements: usize,
    dt: Vec<f64>,
    epsilon: Vec<f64>,
    zeta: Vec<f64>,
    steps: usize,
    tolerances: Vec<f64>,
}

impl FromFile for FixedPoint {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, Self::from_document)
    }
}

impl FixedPoint {
    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", FIXED_POINT])?;
        let allowed = "a table with scene, elements, dt, epsilon, zeta, steps and tolerances";
        let section = root.require(FIXED_POINT, allowed)?.section()?;
        section.allow(&["scene", "elements", "dt", "epsilon", "zeta", "steps", "tolerances"])?;
        let list = |key: &str| {
            let allowed = "a list of at least one number > 0";
            let items = section.require(key, allowed)?.items(allowed)?;
            items
                .iter()
                .map(|item| item.number_where("a finite number > 0", |x| x > 0.0))
                .collect::<Result<Vec<_>, _>>()
        };
        let [dt, epsilon, zeta] = [list("dt")?, list("epsilon")?, list("zeta")?];
        limits::cases(&section.require("dt", "a list")?, &[dt.len(), epsilon.len(), zeta.len()])?;
        Ok(Self {
            header: Header::from_document(root)?,
            scene: Scene::read(section.require("scene", "a scene file beside this one")?.file(folder)?)?,
            elements: tables::elements(&section.require("elements", "a number of elements")?)?,
            dt,
            epsilon,
            zeta,
            // Each is a point of a figure.
            steps: section.require("steps", "a number of steps")?.count(1..=limits::RECORDED_STEPS)?,
            tolerances: list("tolerances")?,
        })
    }

    /// (dt, ε, ζ) of each contraction measured.
    fn grid(&self) -> Vec<[f64; 3]> {
        let mut grid = vec![];
        for &zeta in &self.zeta {
            for &epsilon in &self.epsilon {
                grid.extend(self.dt.iter().map(|&dt| [dt, epsilon, zeta]));
            }
        }
        grid
    }
}

impl Study for FixedPoint {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let cost = self.elements as f64 * contraction::ITERATIONS as f64;
        let label = |[dt, epsilon, zeta]: [f64; 3]| format!("dt = {dt:e}, epsilon = {epsilon:e}, zeta = {zeta}");
        let mut cases: Vec<Case> = self.grid().into_iter().map(|at| Case { label: label(at), cost }).collect();
        // Some four iterations of 60 ns a step and element, against 25 ns for the runner's unit.
        let scene_cost = (self.elements * self.steps) as f64 * 10.0;
        cases.extend(self.tolerances.iter().map(|eta| Case { label: format!("tolerance {eta:e}"), cost: scene_cost }));
        cases
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let grid = self.grid();
        match grid.get(index) {
            Some(&at) => contraction::measure(self.elements, at),
            None => scene::compare(&self.scene, self.elements, self.steps, self.tolerances[index - grid.len()]),
        }
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let grid = self.grid();
        let (contractions, scenes) = results.split_at(grid.len().min(results.len()));
        let mut checks = vec![];
        for (case, result) in self.cases().iter().zip(results) {
            if let Err(failure) = result {
                checks.push(Check::that(false, format!("{}: runs to its end", case.label), &failure.reason));
            }
        }
        let judged = contraction::judge(&grid, contractions);
        let compared = scene::judge(&self.tolerances, scenes);
        checks.extend(judged.checks);
        checks.extend(compared.checks);
        let summary = format!("{}; {}", judged.summary, compared.summary);
        let headline = summary.clone();
        let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
        outcome.tables = vec![judged.table, compared.table];
        outcome.figures = vec![
            contraction::figure(&self.header.id, &grid, contractions),
            scene::figure(&self.header.id, scenes.last().and_then(|result| result.as_ref().ok())),
        ];
        outcome.quantities = judged.quantities;
        outcome
    }
}

/// What one half of the study contributes to the outcome.
struct Part {
    summary: String,
    checks: Vec<Check>,
    table: convergence_study::study::outcome::Table,
    quantities: Vec<convergence_study::study::outcome::Quantity>,
}
