//! The difference between the fixed point and Newton's method on a scene, against the fixed point's
//! tolerance.

use convergence_study::chart::{self, Chart, Shade};

use super::{SolverResult, SolverTask, not_empty, results};
use crate::kinds::prelude::*;
use crate::{
    kinds::{
        runs::side_by_side::{SideBySide, SolverComparison, StepOfBoth},
        tables::Share,
    },
    run::ObservableMotion,
    scene::{
        Scene,
        limits::{self, Elements},
    },
};
use thermobeam::mesh::Mesh;

/// The table `[comparison]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ComparisonTable {
    /// a scene file, relative to this file
    pub(super) scene: String,
    /// number of elements
    elements: Elements,
    // Each step is a point of a figure.
    /// number of steps
    steps: Count<1, { limits::RECORDED_STEPS }>,
    /// η*, at which the fixed point ends
    tolerances: Vec<Share>,
}

impl ComparisonTable {
    pub(super) fn comparison(self, folder: &Path) -> Result<Comparison, Refusal> {
        let scene = Scene::read(named_file("scene", &self.scene, folder)?)?;
        if let Err(error) = scene.one_step() {
            let allowed = "a scene by a one-step scheme";
            return Err(Refusal::written_and("scene", format!(": {error}"), allowed));
        }
        not_empty("tolerances", &self.tolerances)?;
        Ok(Comparison {
            scene,
            elements: self.elements.get(),
            steps: self.steps.get(),
            tolerances: self.tolerances,
        })
    }
}

/// A scene by both solvers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Comparison {
    scene: Scene,
    elements: usize,
    steps: usize,
    tolerances: Vec<Share>,
}

/// The results of running both solvers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Agreement {
    /// η*.
    tolerance: f64,
    /// Distance and iterations over all steps.
    pub solvers: SolverComparison,
    /// Its iterations in each step, as (t, iterations).
    pub iterations: Vec<(f64, f64)>,
    /// Newton iterations in each step, likewise.
    pub newton: Vec<(f64, f64)>,
    /// Time intervals of the steps that end in contact.
    pub contact: Vec<(f64, f64)>,
}

fn label(tolerance: f64) -> String {
    format!("tolerance {tolerance:e}")
}

impl Comparison {
    pub(super) fn cases(&self) -> Vec<Case<SolverTask>> {
        // Some four iterations of 60 ns per step and element; the unit of the runner is 25 ns.
        let cost = (self.elements * self.steps) as f64 * 10.0;
        let parts = Parts::of(&self.scene);
        let parts = parts.by_the_paper(Solver::FixedPoint);
        let mut cases = vec![];
        for eta in self.tolerances.iter().map(|eta| eta.get()) {
            let case = Case::new(label(eta), cost, SolverTask::Comparison(eta));
            cases.push(case.described(&parts));
        }
        cases
    }

    /// Steps the scene by both solvers side by side.
    pub(super) fn run(&self, tolerance: f64) -> Result<Agreement, CaseFailure> {
        let scene = Scene {
            mesh: Mesh::uniform(self.elements)?,
            ..self.scene.clone()
        };
        let mut both = SideBySide::new(&scene, tolerance)?;
        let mut agreement = Agreement {
            tolerance,
            ..Agreement::default()
        };
        for _ in 0..self.steps {
            let StepOfBoth {
                fixed_point,
                newton,
            } = both.step()?;
            let t = both.fixed_point.motion().t();
            agreement
                .iterations
                .push((t, fixed_point.iterations as f64));
            agreement.newton.push((t, newton.iterations as f64));
            if fixed_point.in_contact {
                agreement.contact.push((t - scene.dt(), t));
            }
        }
        agreement.solvers = both.comparison;
        Ok(agreement)
    }

    pub(super) fn judge(ran: &[Ran<SolverTask, SolverResult>]) -> Outcome {
        let all = results(ran, |found| match found {
            SolverResult::Comparison(agreement) => Some(agreement),
            _ => None,
        });
        let last = all.last().copied();
        let distance = last.map_or(f64::NAN, |last| last.solvers.distance);
        let mut summary =
            format!("distance to Newton's method {distance:.1e} at the smallest tolerance");
        if all.iter().all(|agreement| agreement.contact.is_empty()) {
            summary += ", without a step in contact";
        }
        let title = "Fixed point against Newton's method on the scene";
        let numbers = all.iter().flat_map(|agreement| agreement.numbers());
        Outcome {
            headline: summary.clone().into(),
            figures: vec![iterations(last.unwrap_or(&Agreement::default()))],
            ..Outcome::new(summary, vec![], vec![]).with_sheets([Sheet::new(
                title,
                "both solvers",
                numbers,
            )])
        }
    }
}

impl Agreement {
    /// A step leaves at most α/(1 - α) η* unsolved; here α is far below 1/2, and the beam damps the
    /// rest: so both solvers agree within the tolerance.
    pub(super) fn numbers(&self) -> Vec<Measured> {
        let one = |name: &str, value: f64| measured(label(self.tolerance), name, value);
        let SolverComparison {
            distance,
            mean_iterations,
            most_iterations,
        } = self.solvers;
        // Where nothing moves, both solvers have the same bits, and nothing is compared.
        let distance = Some(distance).filter(|distance| *distance != 0.0);
        vec![
            measured(label(self.tolerance), "distance to Newton", distance)
                .scientific(3)
                .must_be(Must::AtMost(self.tolerance)),
            one("mean iterations", mean_iterations).fixed(3),
            one("most iterations", most_iterations as f64).fixed(0),
        ]
    }
}

fn iterations(agreement: &Agreement) -> Figure {
    let (title, shaded) = if agreement.contact.is_empty() {
        ("Newton's method takes fewer iterations", "")
    } else {
        (
            "The fixed point takes more iterations in contact",
            "; shaded where the tip is in contact",
        )
    };
    // With a shorter axis, ticks would lie between whole numbers.
    let y = chart::Axis::linear("iterations per step").showing([0.0, 5.0]);
    let mut chart = Chart::empty(chart::Axis::linear("time t"), y).titled(title);
    chart.bands.push(Shade {
        label: "in contact".to_owned(),
        intervals: agreement.contact.clone(),
    });
    chart.curve("fixed point", stairs(&agreement.iterations));
    chart.curve("Newton's method", stairs(&agreement.newton));
    let caption = format!(
        "Iterations per step of the fixed point at the smallest tolerance, and of Newton's method{shaded}."
    );
    Figure::of("iterations", caption, chart)
}

/// Every value held over its step, from the end of the previous one.
fn stairs(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut held = points.get(..1).unwrap_or_default().to_vec();
    for pair in points.windows(2) {
        held.extend([(pair[0].0, pair[1].1), pair[1]]);
    }
    held
}
