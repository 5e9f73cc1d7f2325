//! Rates where no exact solution is known: the paper's own data, contact included.
//!
//! Two readings of the same runs, each with an interval by the rule that all rates are judged by:
//!
//! * *successive* (three-level Richardson): with `q_h = q + C h^p` the difference of neighbouring levels is
//!   `q_h - q_{h/2} = C (1 - 2^-p) h^p`: it falls with the order, and two of them (three levels) give a rate;
//! * *reference*: the difference to a much finer run. That run's own error bends the finest rates by the factor
//!   `1 - (h_ref/h)^p`; a reference by another scheme, of higher order, bends less and is an independent witness.
//!
//! What the contact does is not assumed. The contact force is Lipschitz, so where the tip enters or leaves an obstacle it
//! has a kink in time. That costs one step a local error of dt² instead of dt³, once for each event: first and second order
//! should survive at fixed times, with a constant that depends on where in its step the event falls, so that rates scatter.
//! The largest displacement over all levels has no such claim: it sits beside the true maximum by a share of a step.
//! Only what the file claims under `[[expect]]` is judged; the rest is shown with the verdict that it would get.

mod file;
mod quantity;

use super::Study;
use super::ladder::{self, Family, Ladder, rate_table};
use crate::kinds::untyped::{Case, Measured};
use crate::run::rerun::{Rerun, resampled};
use crate::scene::Scene;
use convergence_study::plots::{self, Axis as PlotAxis, Guide, History, Series};
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Figure, Outcome, Quantity, Table};
use convergence_study::study::{Axis, Header};
pub use quantity::Observable;
use thermobeam::scheme::Scheme;

/// The name in study files.
pub const KIND: &str = "self-convergence";

/// Half-width of the band about the order for quantities that are shown but not claimed.
const SHOWN_TOLERANCE: f64 = 0.1;

/// Points of a curve in a figure: more than pixels.
const CURVE_POINTS: usize = 2000;

/// Relative drift that the baseline lets pass in a value of the solution itself.
const VALUE_DRIFT: f64 = 1e-8;

/// An order that is claimed of both readings.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Claim {
    observable: Observable,
    order: f64,
    tolerance: f64,
}

/// A study of rates without exact solution.
#[derive(Debug, Clone, PartialEq)]
pub struct SelfConvergence {
    header: Header,
    scene: Scene,
    axis: Axis,
    /// Elements of each run, the reference last.
    elements: Vec<usize>,
    /// Steps of each run, the reference last.
    steps: Vec<usize>,
    t_end: f64,
    samples: usize,
    scheme: Scheme,
    reference_scheme: Scheme,
    /// Must the tip meet an obstacle?
    contact: bool,
    claims: Vec<Claim>,
}

type Results<'r> = &'r [Result<Measured, CaseFailure>];

impl SelfConvergence {
    fn reference(&self) -> usize {
        self.elements.len() - 1
    }

    /// Difference of two runs; NaN where one of them failed.
    fn difference(&self, observable: Observable, results: Results<'_>, coarse: usize, fine: usize) -> f64 {
        match (results.get(coarse), results.get(fine)) {
            (Some(Ok(coarse)), Some(Ok(fine))) => observable.difference(coarse, fine, self.samples),
            _ => f64::NAN,
        }
    }

    /// h or dt of each level, the reference left out.
    fn step_sizes(&self) -> Vec<f64> {
        let size = |k: usize| match self.axis {
            Axis::Space => resampled(&self.scene.mesh, self.elements[k]).map_or(f64::NAN, |mesh| mesh.size()),
            _ => self.t_end / self.steps[k] as f64,
        };
        (0..self.reference()).map(size).collect()
    }

    fn claim(&self, observable: Observable) -> Option<&Claim> {
        self.claims.iter().find(|claim| claim.observable == observable)
    }

    /// Differences of neighbours (`successive`) or to the reference.
    fn ladder(&self, results: Results<'_>, successive: bool) -> Ladder {
        let mut steps = self.step_sizes();
        if successive {
            steps.pop();
        }
        let reading = if successive { "successive" } else { "reference" };
        let shown = Observable::ALL.into_iter().filter(|&o| self.axis == Axis::Space || o != Observable::Superclose);
        let family = |observable: Observable| {
            let fine = |k: usize| if successive { k + 1 } else { self.reference() };
            let claim = self.claim(observable);
            Family {
                name: format!("{}, {reading}", observable.name()),
                errors: (0..steps.len()).map(|k| self.difference(observable, results, k, fine(k))).collect(),
                order: claim.map_or(observable.order(self.axis, self.scheme.order), |claim| claim.order),
                tolerance: claim.map_or(SHOWN_TOLERANCE, |claim| claim.tolerance),
            }
        };
        let families = shown.map(family).collect();
        Ladder { axis: self.axis, steps, families }
    }

    fn is_claimed(&self, family: &str) -> bool {
        self.claims.iter().any(|claim| family.strip_prefix(claim.observable.name()).is_some_and(|r| r.starts_with(',')))
    }

    /// The reference's values with Richardson's estimate of what the finest level is away from the limit.
    fn values(&self, results: Results<'_>) -> Table {
        let finest = self.reference() - 1;
        let row = |k: usize| {
            let name = format!("tip {k}");
            let value = |level: usize| ladder::value(results, level, &name);
            let order = Observable::Tip.order(self.axis, self.scheme.order);
            let error =
                if finest == 0 { f64::NAN } else { (value(finest) - value(finest - 1)) / (2f64.powf(order) - 1.0) };
            let t = self.t_end * k as f64 / self.samples as f64;
            vec![
                format!("{t:.4}"),
                format!("{:.10}", value(finest)),
                format!("{:.10}", value(finest) + error),
                format!("{:.10}", value(self.reference())),
                format!("{:.1e}", error.abs()),
                format!("{:.1e}", (value(finest) - value(self.reference())).abs()),
            ]
        };
        let head = ["t", "u(1), finest", "extrapolated", "reference", "error estimated", "against reference"];
        Table {
            title: "Tip displacement: finest level, extrapolated, reference".into(),
            head: head.map(str::to_owned).into(),
            rows: (1..=self.samples).map(row).collect(),
        }
    }

    fn contact_check(&self, results: Results<'_>) -> Option<Check> {
        let obstacles = self.scene.obstacles.filter(|_| self.contact)?;
        let [low, high] = ["tip min", "tip max"].map(|name| ladder::value(results, self.reference(), name));
        let evidence =
            format!("u(1) runs from {low:.6} to {high:.6}; the obstacles are at {} and {}", obstacles.g1, obstacles.g2);
        Some(Check::that(low < obstacles.g1 || high > obstacles.g2, "contact is part of what is measured", evidence))
    }

    fn tip_figure(&self, results: Results<'_>) -> Figure {
        let name = |k: usize| match self.axis {
            Axis::Space => format!("n = {}", self.elements[k]),
            _ => format!("{} steps", self.steps[k]),
        };
        let reference = self.reference();
        let curve = |(k, label): (usize, String)| Series {
            label,
            points: results.get(k).and_then(|r| r.as_ref().ok()).map_or(vec![], |m| m.curve("tip").to_vec()),
        };
        let shown = [
            (reference, format!("reference, {}", name(reference))),
            (0, name(0)),
            (reference - 1, name(reference - 1)),
        ];
        let guides = self.scene.obstacles.map_or(vec![], |o| {
            vec![Guide { label: "g₁".into(), value: o.g1 }, Guide { label: "g₂".into(), value: o.g2 }]
        });
        let figure = History {
            title: Some(format!("Tip of {}", self.scene.name)),
            y: PlotAxis::linear("tip displacement u(1, t) (dimensionless)"),
            series: shown.into_iter().map(curve).collect(),
            guides,
            ..History::default()
        };
        Figure {
            file: format!("{}-tip.svg", self.header.id),
            caption:
                "Tip displacement on the coarsest and the finest level and in the reference run, with the obstacles."
                    .into(),
            svg: plots::history(&figure),
        }
    }

    fn quantities(&self, results: Results<'_>) -> Vec<Quantity> {
        let names = [format!("tip {}", self.samples), format!("energy {}", self.samples), "tip max".into()];
        let quantity = |name: String| Quantity {
            value: ladder::value(results, self.reference() - 1, &name),
            name: format!("{name}, finest level"),
            tolerance: VALUE_DRIFT,
        };
        names.into_iter().map(quantity).collect()
    }
}

impl Study for SelfConvergence {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let case = |(&elements, &steps): (&usize, &usize)| Case {
            label: format!("n = {elements}, {steps} steps"),
            cost: elements as f64 * steps as f64,
        };
        self.elements.iter().zip(&self.steps).map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let scheme = if index == self.reference() { self.reference_scheme } else { self.scheme };
        let rerun = Rerun {
            mesh: resampled(&self.scene.mesh, self.elements[index])?,
            steps: self.steps[index],
            t_end: self.t_end,
            scheme,
            ..Rerun::of(&self.scene)
        };
        let mut measured = Measured::default();
        let nodes = rerun.mesh.nodes();
        // As many points as fit a figure, and all the times that are compared.
        let per_sample = (CURVE_POINTS / self.samples).max(1);
        let mut points = vec![];
        let stride = largest_divisor(rerun.steps / self.samples, per_sample);
        let trace = rerun.run(self.samples * stride, |simulation, level| {
            points.push((simulation.t(), level.u[nodes.len() - 1]));
            if points.len() % stride == 0 {
                let energy = simulation.energy(level).total();
                quantity::store(&mut measured, points.len() / stride, nodes, level, energy);
            }
        })?;
        measured.push("tip min", trace.tip[0]);
        measured.push("tip max", trace.tip[1]);
        measured.series.push(("tip".into(), points));
        Ok(measured)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let ladders = [true, false].map(|successive| self.ladder(results, successive));
        let all: Vec<_> = ladders.iter().flat_map(Ladder::judge).collect();
        let (claimed, shown): (Vec<_>, Vec<_>) = all.into_iter().partition(|(name, _)| self.is_claimed(name));
        let mut checks = vec![ladder::completion(&self.cases(), results)];
        checks.extend(self.contact_check(results));
        let file = format!("{}-errors.svg", self.header.id);
        let caption = "Differences to the reference run, with the orders of a smooth solution.";
        let both: Vec<_> = claimed.iter().chain(&shown).cloned().collect();
        let figures = vec![
            ladders[1].figure(file, &format!("No exact solution: {}", self.scene.name), caption.into(), &both),
            self.tip_figure(results),
        ];
        let mut tables = vec![self.values(results)];
        if !shown.is_empty() {
            tables.insert(0, rate_table("Rates shown, not claimed: not needed for a pass", &shown));
        }
        let quantities = ladder::rate_quantities(&claimed).chain(self.quantities(results)).collect();
        Outcome { tables, figures, quantities, ..Outcome::new(ladder::summary(&claimed), claimed, checks) }
    }
}

/// The largest divisor of `n` that is at most `limit`.
fn largest_divisor(n: usize, limit: usize) -> usize {
    (1..=limit.min(n)).rev().find(|&divisor| n.is_multiple_of(divisor)).unwrap_or(1)
}
