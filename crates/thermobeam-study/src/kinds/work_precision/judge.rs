//! From the grids of all methods to checks, tables and figures.

use convergence_study::judge::fit::Quantiles;
use convergence_study::plots;
use convergence_study::study::Ran;
use convergence_study::study::levels::completion;
use convergence_study::study::outcome::{self, Check, Figure, Outcome, Table};

use super::law::{GridPoint, Law, front};
use super::method::{METHODS, Measurement, Method};
use super::{Advantage, MethodOnMesh, WorkPrecision};
use crate::error::evaluator::ErrorMeasure;

/// Results of all cases.
type Results = [Ran<MethodOnMesh, Vec<Measurement>>];

/// Errors of which the cost is shown.
const TARGETS: [f64; 7] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// The error of a single run may lie below the law by so many times the misfit allowed: there errors of space and time
/// happen to cancel, as they do not in neighbouring runs, with which the fit must agree.
const UNDERCUT: f64 = 2.5;
/// Relative change of a cost that is tolerated: rates enter its exponent.
const COST_TOLERANCE: f64 = 1e-2;
/// Confidence of the intervals of the rates.
const CONFIDENCE: f64 = 0.95;

/// One method in one quantity.
struct Row {
    method: Method,
    quantity: ErrorMeasure,
    points: Vec<GridPoint>,
    law: Result<Law, String>,
}

impl Row {
    fn name(&self) -> String {
        format!("{}, {}", self.quantity.name(), self.method.name)
    }

    /// Node-steps of an error; NaN without a law.
    fn cost(&self, error: f64) -> f64 {
        self.law.as_ref().map_or(f64::NAN, |law| law.cost(error))
    }

    /// Whether a cost at that error is beyond what was measured.
    fn is_extrapolated(&self, error: f64) -> bool {
        !self.law.as_ref().is_ok_and(|law| error >= law.reach)
    }

    /// Solves per step of the finest run: with it node-steps become node-solves.
    fn solves_per_step(&self) -> f64 {
        self.points.last().map_or(f64::NAN, |point| point.node_solves / point.node_steps)
    }
}

pub(super) fn judge(study: &WorkPrecision, ran: &Results) -> Outcome {
    let rows = rows(study, ran);
    let mut checks = vec![completion(ran, |runs| not_finite(runs))];
    checks.extend(rows.iter().flat_map(|row| check_law(row, study.misfit)));
    let advantages: Vec<Check> = study.advantages.iter().map(|claim| check_advantage(claim, &rows)).collect();
    let summary = summary(&rows, &advantages);
    let headline = advantages.first().map_or_else(|| summary.clone(), |check| check.evidence.clone());
    checks.extend(advantages);
    let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
    outcome.tables = ErrorMeasure::ALL.map(|quantity| winners(quantity, &rows)).to_vec();
    outcome.tables.push(laws(&rows));
    outcome.figures = ErrorMeasure::ALL.map(|quantity| figure(study, quantity, &rows)).to_vec();
    outcome.quantities = quantities(&rows);
    outcome
}

fn not_finite(runs: &[Measurement]) -> Vec<String> {
    let of_run = |run: &Measurement| {
        let errors = ErrorMeasure::ALL.into_iter().zip(run.errors).map(|(quantity, error)| (quantity.name(), error));
        let cost = [("node-steps", run.spent.node_steps), ("node-solves", run.spent.node_solves)];
        let named = errors.chain(cost).filter(|(_, value)| !value.is_finite());
        named.map(|(name, _)| name.to_owned()).collect::<Vec<_>>()
    };
    runs.iter().flat_map(of_run).collect()
}

/// The grid of one method in one quantity; NaN where a run failed.
fn points(study: &WorkPrecision, ran: &Results, method: &Method, quantity: usize) -> Vec<GridPoint> {
    let mut points = vec![];
    for Ran { case, found } in ran.iter().filter(|ran| ran.case.data.method == *method) {
        for (k, &steps) in study.steps.iter().enumerate() {
            let run = found.as_ref().ok().and_then(|runs| runs.get(k));
            let value = |number: &dyn Fn(&Measurement) -> f64| run.map_or(f64::NAN, number);
            points.push(GridPoint {
                elements: case.data.elements,
                steps,
                error: value(&|run| run.errors[quantity]),
                node_steps: value(&|run| run.spent.node_steps),
                node_solves: value(&|run| run.spent.node_solves),
            });
        }
    }
    points
}

fn rows(study: &WorkPrecision, ran: &Results) -> Vec<Row> {
    let Some(quantiles) = Quantiles::new(CONFIDENCE) else { return vec![] };
    let mut rows = vec![];
    for method in METHODS {
        let [full, superclose, tip] = [0, 1, 2].map(|quantity| points(study, ran, &method, quantity));
        let fit = |points: &[GridPoint]| Law::fit(points, study.family.t_end, method.runs());
        let close = fit(&superclose);
        let law = match &close {
            Ok(close) => Law::with_interpolation(&full, (&superclose, close), &quantiles),
            Err(reason) => Err(reason.clone()),
        };
        let row = |quantity, points, law| Row { method, quantity, points, law };
        rows.push(row(ErrorMeasure::Theorem34, full, law));
        rows.push(row(ErrorMeasure::Superclose, superclose, close));
        let law = fit(&tip);
        rows.push(row(ErrorMeasure::Tip, tip, law));
    }
    rows.sort_by_key(|row| ErrorMeasure::ALL.iter().position(|quantity| *quantity == row.quantity));
    rows
}

fn check_law(row: &Row, misfit: f64) -> Vec<Check> {
    let claim = format!("{}: the errors follow a law", row.name());
    let law = match &row.law {
        Ok(law) => law,
        Err(reason) => return vec![Check::that(false, claim, reason)],
    };
    let rms = law.misfit;
    let undercut = law.undercut(&row.points);
    let allowed = (UNDERCUT * misfit * law.exponent()).exp();
    vec![
        Check::that(rms <= misfit, claim, format!("misfit {rms:.4}, at most {misfit}")),
        Check::that(
            undercut <= allowed,
            format!("{}: no run is cheaper than the best path", row.name()),
            format!("cost on the best path over cost of a run with that error: {undercut:.2}, at most {allowed:.2}"),
        ),
    ]
}

fn find<'r>(rows: &'r [Row], quantity: ErrorMeasure, method: &Method) -> Option<&'r Row> {
    rows.iter().find(|row| row.quantity == quantity && row.method == *method)
}

fn check_advantage(claim: &Advantage, rows: &[Row]) -> Check {
    let Advantage { quantity, error, of, over, times } = *claim;
    let cost = |method: &Method| find(rows, quantity, method).map_or(f64::NAN, |row| row.cost(error));
    let note = |method: &Method| match find(rows, quantity, method) {
        Some(row) if !row.is_extrapolated(error) => "",
        _ => " (extrapolated)",
    };
    let (cheap, dear) = (cost(&of), cost(&over));
    let ratio = dear / cheap;
    Check::that(
        ratio >= times,
        format!("{} {error:e}: {} is at least {times} times cheaper than {}", quantity.name(), of.name, over.name),
        format!("{ratio:.0} times cheaper: {cheap:.2e} node-steps{} against {dear:.2e}{}", note(&of), note(&over)),
    )
}

fn summary(rows: &[Row], advantages: &[Check]) -> String {
    if let Some(check) = advantages.first() {
        return format!("{}: {}", check.claim, check.evidence);
    }
    let winner = |quantity| cheapest(rows, quantity, 1e-4).map_or("none", |row| row.method.name);
    let list = ErrorMeasure::ALL.map(|quantity| format!("{} {}", quantity.name(), winner(quantity)));
    format!("cheapest at an error of 1e-4: {}", list.join(", "))
}

/// The method with the fewest node-steps; none where a cost is not known.
fn cheapest(rows: &[Row], quantity: ErrorMeasure, error: f64) -> Option<&Row> {
    let known = rows.iter().filter(|row| row.quantity == quantity && row.cost(error).is_finite());
    known.min_by(|a, b| (a.cost(error) * a.solves_per_step()).total_cmp(&(b.cost(error) * b.solves_per_step())))
}

fn winners(quantity: ErrorMeasure, rows: &[Row]) -> Table {
    let mut head = vec!["error".to_owned()];
    head.extend(METHODS.iter().map(|method| method.name.to_owned()));
    head.extend(["cheapest", "ahead of the next"].map(str::to_owned));
    let row = |error: &f64| {
        let of_quantity: Vec<&Row> = METHODS.iter().filter_map(|method| find(rows, quantity, method)).collect();
        let solves = |row: &Row| row.cost(*error) * row.solves_per_step();
        let mut cells = vec![format!("{error:e}")];
        cells.extend(of_quantity.iter().map(|row| {
            let mark = if row.is_extrapolated(*error) { "*" } else { "" };
            format!("{:.2e} / {:.2e}{mark}", row.cost(*error), solves(row))
        }));
        let mut costs: Vec<f64> = of_quantity.iter().map(|row| solves(row)).filter(|cost| cost.is_finite()).collect();
        costs.sort_by(f64::total_cmp);
        cells.push(cheapest(rows, quantity, *error).map_or("-", |row| row.method.name).to_owned());
        cells.push(if let [first, second, ..] = costs[..] { format!("{:.1}", second / first) } else { "-".to_owned() });
        cells
    };
    Table {
        title: format!(
            "Cost of an error in {}: node-steps / node-solves on the best path; * extrapolated along the fitted law",
            quantity.name()
        ),
        head,
        rows: TARGETS.iter().map(row).collect(),
    }
}

fn laws(rows: &[Row]) -> Table {
    let head =
        ["error", "method", "C_h", "p", "C_t", "q", "misfit", "cost ~ E^-b", "best path at E = 1e-4", "solves a step"];
    let row = |row: &Row| {
        let mut cells = vec![row.quantity.name().to_owned(), row.method.name.to_owned()];
        match &row.law {
            Ok(law) => {
                let [h, dt] = law.best(1e-4);
                let fit = law;
                cells.extend([format!("{:.3e}", fit.c_h), format!("{:.3}", fit.p)]);
                cells.extend([format!("{:.3e}", fit.c_t), format!("{:.3}", fit.q), format!("{:.3}", fit.misfit)]);
                cells.extend([format!("{:.2}", law.exponent()), format!("h = {h:.2e}, dt = {dt:.2e}")]);
            }
            Err(reason) => {
                cells.extend(vec!["-".to_owned(); 6]);
                cells.push(reason.clone());
            }
        }
        cells.push(format!("{:.2}", row.solves_per_step()));
        cells
    };
    Table {
        title: "Laws e^2 = (C_h h^p)^2 + (C_t dt^q)^2 fitted to all runs; dt is that of the coarse run of richardson"
            .to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows: rows.iter().map(row).collect(),
    }
}

fn figure(study: &WorkPrecision, quantity: ErrorMeasure, rows: &[Row]) -> Figure {
    let of_quantity = rows.iter().filter(|row| row.quantity == quantity);
    let series = of_quantity
        .map(|row| plots::Series {
            label: row.method.name.to_owned(),
            points: front(row.points.iter().map(|point| (point.node_solves, point.error))),
        })
        .collect();
    let svg = plots::work_precision(&plots::WorkPrecision {
        title: None,
        x_label: Some("cost: elements × linear solves".to_owned()),
        y_label: format!("error, {}", quantity.name()),
        series,
    });
    Figure {
        file: format!("{}-{}.svg", study.header.id, quantity.name()),
        caption: format!(
            "Error ({}) over cost, in elements times linear solves: for each method the runs that no other run of it beats.",
            quantity.name()
        ),
        svg,
    }
}

fn quantities(rows: &[Row]) -> Vec<outcome::Quantity> {
    let quantity = |row: &Row| outcome::Quantity {
        name: format!("node-steps for 1e-4, {}", row.name()),
        value: row.cost(1e-4),
        tolerance: COST_TOLERANCE,
    };
    rows.iter().map(quantity).collect()
}
