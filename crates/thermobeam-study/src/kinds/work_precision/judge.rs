//! From the runs of all methods to checks, tables and figures.

use super::law::{CostLaw, GridPoint, front};
use super::method::{Measurement, NamedMethod};
use super::{Advantage, Runs, WorkPrecision};
use crate::kinds::prelude::*;

/// Errors whose cost is shown.
const TARGETS: [f64; 7] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// The error of a single run may lie below the law by this multiple of the allowed misfit: there the errors of space and
/// time happen to cancel. In neighbouring runs they do not, and these must agree with the fit.
const UNDERCUT: f64 = 2.5;
/// Allowed relative change of a cost: rates enter its exponent.
const COST_TOLERANCE: f64 = 1e-2;
/// Allowed relative change of a ratio of costs.
const RATIO_TOLERANCE: f64 = 0.05;
/// Allowed range for the ratio of second-order errors along a diagonal, ideally 4.
const FALL: [f64; 2] = [3.5, 4.5];

/// The cost of an error.
enum CostBy {
    /// The law fitted to a grid, or the reason why there is none.
    Law(Result<CostLaw, String>),
    /// Along a diagonal of the grid error times cost is constant, the optimum for a scheme of second order in h and dt.
    Diagonal,
    /// The cost of the cheapest run with that error.
    Runs,
}

/// One method in one quantity.
struct MethodRow {
    method: NamedMethod,
    quantity: ErrorMeasure,
    points: Vec<GridPoint>,
    cost: CostBy,
}

impl MethodRow {
    fn name(&self) -> String {
        format!("{}, {}", self.quantity.name(), self.method.name)
    }

    /// Node-steps and node-solves of an error; NaN if unknown.
    fn cost(&self, error: f64) -> [f64; 2] {
        let cheaper = |a: [f64; 2], b: [f64; 2]| if b[1] >= a[1] { a } else { b };
        let none = [f64::NAN; 2];
        match &self.cost {
            CostBy::Law(Err(_)) => none,
            CostBy::Law(Ok(law)) => [law.cost(error), law.cost(error) * self.solves_per_step()],
            CostBy::Diagonal => {
                let along = |p: &GridPoint| {
                    [
                        p.node_steps * p.error / error,
                        p.node_solves * p.error / error,
                    ]
                };
                self.points
                    .iter()
                    .map(along)
                    .reduce(cheaper)
                    .unwrap_or(none)
            }
            CostBy::Runs => {
                let good = self.points.iter().filter(|point| point.error <= error);
                good.map(|point| [point.node_steps, point.node_solves])
                    .reduce(cheaper)
                    .unwrap_or(none)
            }
        }
    }

    /// Whether a cost at that error is outside the measured range.
    fn is_extrapolated(&self, error: f64) -> bool {
        match &self.cost {
            CostBy::Law(law) => !law.as_ref().is_ok_and(|law| error >= law.reach),
            CostBy::Diagonal => !self.points.iter().any(|point| point.error <= error),
            CostBy::Runs => false,
        }
    }

    /// Solves per step of the finest run, which convert node-steps to node-solves.
    fn solves_per_step(&self) -> f64 {
        self.points
            .last()
            .map_or(f64::NAN, |point| point.node_solves / point.node_steps)
    }
}

pub(super) fn judge(study: &WorkPrecision, ran: &[Ran<Runs, Vec<Measurement>>]) -> Outcome {
    let rows = rows(study, ran);
    let mut checks = vec![completion(ran, |runs| {
        readings::not_finite(
            &runs
                .iter()
                .flat_map(|run| found(study, run))
                .collect::<Vec<_>>(),
        )
    })];
    checks.extend(rows.iter().flat_map(|row| check_law(row, study.misfit)));
    let claims = study
        .advantages
        .iter()
        .map(|claim| (claim, check_advantage(claim, &rows)));
    let (ratios, advantages): (Vec<_>, Vec<Check>) = claims
        .map(|(claim, (ratio, check))| ((claim, ratio), check))
        .unzip();
    let headline = advantages
        .first()
        .map_or_else(String::new, |check| check.evidence.clone());
    let summary = advantages
        .first()
        .map_or_else(String::new, |check| format!("{}: {headline}", check.claim));
    checks.extend(advantages);
    let mut outcome = Outcome {
        headline,
        ..Outcome::new(summary, vec![], checks)
    };
    let quantities = study.quantities().iter();
    outcome.tables = quantities
        .clone()
        .map(|&quantity| winners(quantity, &rows))
        .collect();
    outcome.tables.extend(
        [laws(&rows), runs(study, ran)]
            .into_iter()
            .filter(|table| !table.rows.is_empty()),
    );
    outcome.figures = quantities
        .map(|&quantity| figure(quantity, &rows))
        .collect();
    outcome.quantities = guarded(&rows, &ratios);
    outcome
}

/// The measured errors and the counted cost of a run.
fn found(study: &WorkPrecision, Measurement { errors, spent }: &Measurement) -> Vec<Reading> {
    let error = |&quantity: &ErrorMeasure| {
        Reading::new(quantity.name(), errors[quantity as usize]).scientific(2)
    };
    let cost = [
        Reading::new("node-steps", spent.node_steps),
        Reading::new("node-solves", spent.node_solves).scientific(2),
    ];
    study.quantities().iter().map(error).chain(cost).collect()
}

/// The runs of a method, with one error each; NaN if a run failed.
fn points(
    study: &WorkPrecision,
    ran: &[Ran<Runs, Vec<Measurement>>],
    method: &NamedMethod,
    quantity: usize,
) -> Vec<GridPoint> {
    let mut points = vec![];
    for Ran { case, found } in ran {
        let (h, dts) = match case.data {
            Runs::OnMesh(of, _, elements) if of == *method => {
                let dt = |steps: &usize| study.family.t_end / *steps as f64;
                (
                    1.0 / elements as f64,
                    study.steps_on(elements).iter().map(dt).collect(),
                )
            }
            Runs::Dg(degrees) if method.one_step.is_none() => (f64::NAN, vec![degrees.dt]),
            _ => continue,
        };
        for (k, dt) in dts.into_iter().enumerate() {
            let run = found.as_ref().ok().and_then(|runs| runs.get(k));
            let numbers = |run: &Measurement| {
                [
                    run.errors[quantity],
                    run.spent.node_steps,
                    run.spent.node_solves,
                ]
            };
            let [error, node_steps, node_solves] = run.map_or([f64::NAN; 3], numbers);
            points.push(GridPoint {
                h,
                dt,
                error,
                node_steps,
                node_solves,
            });
        }
    }
    points
}

fn rows(study: &WorkPrecision, ran: &[Ran<Runs, Vec<Measurement>>]) -> Vec<MethodRow> {
    let mut rows = vec![];
    for method in study.methods() {
        let points = [0, 1, 2].map(|quantity| points(study, ran, &method, quantity));
        let costs = match (method.one_step, study.diagonal) {
            (None, _) => [const { CostBy::Runs }; 3],
            (Some(_), Some(_)) => [const { CostBy::Diagonal }; 3],
            (Some(scheme), None) => {
                let fit =
                    |points: &[GridPoint]| CostLaw::fit(points, study.family.t_end, scheme.runs());
                let [full, superclose, tip] = &points;
                let close = fit(superclose);
                let law = match &close {
                    Ok(close) => CostLaw::with_interpolation(full, superclose, close),
                    Err(reason) => Err(reason.clone()),
                };
                [law, close, fit(tip)].map(CostBy::Law)
            }
        };
        let of_quantity = ErrorMeasure::ALL.into_iter().zip(points).zip(costs);
        rows.extend(of_quantity.map(|((quantity, points), cost)| MethodRow {
            method,
            quantity,
            points,
            cost,
        }));
    }
    rows.retain(|row| study.quantities().contains(&row.quantity));
    rows.sort_by_key(|row| row.quantity as usize);
    rows
}

fn check_law(row: &MethodRow, misfit: f64) -> Vec<Check> {
    let claim = "the errors follow a law";
    let subject = |quantity: &str| {
        Subject::of(quantity)
            .in_case(row.name())
            .by(row.method.name)
    };
    let law = match &row.cost {
        CostBy::Law(Ok(law)) => law,
        CostBy::Law(Err(reason)) => {
            return vec![Check::that(false, claim, reason).about(subject("law"))];
        }
        CostBy::Runs => return vec![],
        CostBy::Diagonal => {
            let falls: Vec<f64> = row
                .points
                .windows(2)
                .map(|two| two[0].error / two[1].error)
                .collect();
            return vec![
                Check::that(
                    !falls.is_empty()
                        && falls.iter().all(|fall| (FALL[0]..=FALL[1]).contains(fall)),
                    format!(
                        "{}'s error falls fourfold with twice the elements and steps",
                        row.method.name
                    ),
                    falls
                        .iter()
                        .map(|fall| format!("{fall:.2}"))
                        .collect::<Vec<_>>()
                        .join(", "),
                )
                .about(subject("diagonal")),
            ];
        }
    };
    let rms = law.fit.rms;
    let undercut = law.undercut(&row.points);
    let allowed = (UNDERCUT * misfit * law.exponent()).exp();
    vec![
        Check::that(
            rms <= misfit,
            claim,
            format!("misfit {rms:.4}, at most {misfit}"),
        )
        .about(subject("law")),
        Check::that(
            undercut <= allowed,
            "no run is cheaper than the best path",
            format!(
                "cost on the best path over cost of a run with that error: {undercut:.2}, at most {allowed:.2}"
            ),
        )
        .about(subject("best path")),
    ]
}

/// The ratio of the costs, and whether it reaches the claim.
fn check_advantage(claim: &Advantage, rows: &[MethodRow]) -> (f64, Check) {
    let Advantage {
        quantity,
        error,
        of,
        over,
        times,
    } = *claim;
    let find = |method: NamedMethod| {
        rows.iter()
            .find(|row| row.quantity == quantity && row.method == method)
    };
    let cost = |method| find(method).map_or(f64::NAN, |row| row.cost(error)[claim.unit()]);
    let note = |method| match find(method) {
        Some(row) if !row.is_extrapolated(error) => "",
        _ => " (extrapolated)",
    };
    let (cheap, dear) = (cost(of), cost(over));
    let ratio = dear / cheap;
    let unit = ["node-steps", "node-solves"][claim.unit()];
    let check = Check::that(
        ratio >= times && ratio.is_finite(),
        format!(
            "{} {error:e}: {} is at least {times} times cheaper than {}",
            quantity.name(),
            of.name,
            over.name
        ),
        format!(
            "{ratio:.0} times cheaper: {cheap:.2e} {unit}{} against {dear:.2e}{}",
            note(of),
            note(over)
        ),
    )
    .about(
        Subject::of(format!("advantage, {}", quantity.name()))
            .by(of.name)
            .at(format!("{error:e}")),
    );
    (ratio, check)
}

fn winners(quantity: ErrorMeasure, rows: &[MethodRow]) -> Table {
    let of_quantity: Vec<&MethodRow> = rows.iter().filter(|row| row.quantity == quantity).collect();
    let line = |&error: &f64| {
        let cell = |row: &&MethodRow| match row.cost(error) {
            [_, solves] if solves.is_nan() => "-".to_owned(),
            [steps, solves] => {
                format!(
                    "{steps:.2e} / {solves:.2e}{}",
                    if row.is_extrapolated(error) { "*" } else { "" }
                )
            }
        };
        let mut solves: Vec<_> = of_quantity
            .iter()
            .map(|row| (row.cost(error)[1], row.method.name))
            .collect();
        solves.retain(|(cost, _)| cost.is_finite());
        solves.sort_by(|a, b| a.0.total_cmp(&b.0));
        let cheapest = solves.first().map_or("-", |(_, name)| name).to_owned();
        let ahead = match solves[..] {
            [first, second, ..] => format!("{:.1}", second.0 / first.0),
            _ => "-".to_owned(),
        };
        [format!("{error:e}")]
            .into_iter()
            .chain(of_quantity.iter().map(cell))
            .chain([cheapest, ahead])
            .collect()
    };
    let names = of_quantity.iter().map(|row| row.method.name);
    let cells =
        "node-steps / node-solves on the best path, of dg by the cheapest run; * extrapolated";
    let head = ["error"]
        .into_iter()
        .chain(names)
        .chain(["cheapest", "ahead of the next"]);
    Table::new(
        format!("Cost of an error in {}: {cells}", quantity.name()),
        head,
        TARGETS.iter().map(line),
    )
}

fn laws(rows: &[MethodRow]) -> Table {
    let line = |row: &MethodRow| {
        let CostBy::Law(law) = &row.cost else {
            return None;
        };
        let number = |name, of: fn(&CostLaw) -> f64| Reading::new(name, law.as_ref().ok().map(of));
        let path = law.as_ref().map(|law| law.best(1e-4));
        let path = path.map_or_else(Clone::clone, |[h, dt]| {
            format!("h = {h:.2e}, dt = {dt:.2e}")
        });
        let cells = vec![
            number("C_h", |law| law.fit.c_h).scientific(3),
            number("p", |law| law.fit.p).fixed(3),
            number("C_t", |law| law.fit.c_t).scientific(3),
            number("q", |law| law.fit.q).fixed(3),
            number("misfit", |law| law.fit.rms).fixed(3),
            number("cost ~ E^-b", CostLaw::exponent).fixed(2),
            Reading::text("best path at E = 1e-4", path),
            Reading::new("solves a step", row.solves_per_step()).fixed(2),
        ];
        Some((
            vec![row.quantity.name().to_owned(), row.method.name.to_owned()],
            cells,
        ))
    };
    let title = "Laws e^2 = (C_h h^p)^2 + (C_t dt^q)^2 fitted to all runs; dt is that of the coarse run of richardson";
    readings::table(
        title,
        &["error", "method"],
        &rows.iter().filter_map(line).collect::<Vec<_>>(),
    )
}

/// The runs without a fitted law.
fn runs(study: &WorkPrecision, ran: &[Ran<Runs, Vec<Measurement>>]) -> Table {
    let single = ran
        .iter()
        .filter(|ran| study.diagonal.is_some() || matches!(ran.case.data, Runs::Dg(_)));
    let line = |ran: &Ran<Runs, Vec<Measurement>>| {
        let run = ran.ok().and_then(|runs| runs.first());
        (
            vec![ran.case.label.clone()],
            run.map_or(vec![], |run| found(study, run)),
        )
    };
    readings::table(
        "Largest errors over time, and counted work",
        &["run"],
        &single.map(line).collect::<Vec<_>>(),
    )
}

fn figure(quantity: ErrorMeasure, rows: &[MethodRow]) -> Figure {
    let of_quantity = rows.iter().filter(|row| row.quantity == quantity);
    let costs = |row: &MethodRow| {
        front(
            row.points
                .iter()
                .map(|point| (point.node_solves, point.error)),
        )
    };
    let series: Vec<_> = of_quantity
        .map(|row| plots::Series::new(row.method.name, costs(row)))
        .collect();
    let (cost, error) = (
        "cost: elements × linear solves",
        format!("error, {}", quantity.name()),
    );
    let drawn = plots::work_precision(cost, error, &series);
    let runs =
        "in elements times linear solves: for each method the runs that no other run of it beats.";
    Figure::new(
        quantity.name(),
        format!("Error ({}) over cost, {runs}", quantity.name()),
        drawn.draw(),
    )
}

/// Costs by the laws, and the ratios claimed for dG.
fn guarded(rows: &[MethodRow], ratios: &[(&Advantage, f64)]) -> Vec<Quantity> {
    let laws = rows.iter().filter(|row| matches!(row.cost, CostBy::Law(_)));
    let laws = laws.map(|row| {
        Quantity::new(
            format!("node-steps for 1e-4, {}", row.name()),
            row.cost(1e-4)[0],
            COST_TOLERANCE,
        )
        .about(
            Subject::of(format!("node-steps, {}", row.quantity.name()))
                .by(row.method.name)
                .at("1e-4"),
        )
    });
    let of_dg = ratios
        .iter()
        .filter(|(claim, ratio)| claim.unit() == 1 && ratio.is_finite());
    laws.chain(of_dg.map(
        |(
            Advantage {
                quantity,
                error,
                of,
                over,
                ..
            },
            ratio,
        )| {
            let name = format!(
                "times cheaper, {} {error:e}, {} over {}",
                quantity.name(),
                of.name,
                over.name
            );
            let advantage = format!("advantage, {}", quantity.name());
            let subject = Subject::of(advantage).by(of.name);
            Quantity::new(name, *ratio, RATIO_TOLERANCE).about(subject)
        },
    ))
    .collect()
}
