//! Claims, the table of boundaries, and what the baseline guards.

use super::measure::{ALPHA, FAILED, GAMMA, ITERATIONS_OF_NEWTON, REFUSED};
use super::{Parameter, Stability, figures};
use crate::kinds::Study;
use crate::kinds::complete::{all_ran, or_nothing};
use crate::kinds::untyped::Measured;
use crate::kinds::watch::of_allowed;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Outcome, Quantity, Table};
use convergence_study::text::number::max_or_nan;
use thermobeam::kirchhoff::BUCKLING;
use thermobeam::parameters::Beam;

/// A factor with which the iterations of the map are enough, and margin for the mean force that is not known before.
const SLOW: f64 = 0.8;
/// γ up to which α stands alone.
const ALONE: f64 = 0.01;
/// Iterations that Newton's method may take in a step, from whatever start.
const MOST: f64 = 30.0;

pub(super) fn outcome(study: &Stability, results: &[Result<Measured, CaseFailure>]) -> Outcome {
    let cases = study.cases();
    let measured = or_nothing(cases.len(), results);
    let (rows, lines) = measured.split_at(study.points);
    let mut checks = vec![all_ran(&cases, results), complete(study, rows)];
    checks.extend([in_contact(rows), as_predicted(rows), newton_answers(study, rows), newton_is_quick(rows)]);
    checks.extend(energy(rows));
    checks.extend(study.lines.iter().zip(lines).map(|(value, line)| boundary(study, *value, line)));
    let converged = rows.iter().flat_map(|row| row.curve(FAILED)).filter(|(_, failed)| *failed == 0.0).count();
    let points = study.points * study.points;
    let alone = lines.iter().filter(|line| line.value("gamma") <= ALONE);
    let worst = alone.map(|line| (line.value("found") / line.value("predicted") - 1.0).abs()).fold(0.0, max_or_nan);
    let summary = format!(
        "{points} points: the fixed point converges at {converged}, Newton's method answers at {}; boundary within {:.2} % of alpha = 1 where gamma <= {ALONE}; residual at most {:.1e} of the energy",
        points - count(rows, REFUSED),
        100.0 * worst,
        largest(rows, "residual"),
    );
    let headline = format!(
        "boundary within {:.2} % of alpha = 1, residual at most {:.1e} of the energy",
        100.0 * worst,
        largest(rows, "residual"),
    );
    let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
    outcome.tables = vec![boundaries(study, lines)];
    outcome.figures = figures::all(study, rows, lines);
    outcome.quantities = quantities(study, lines, converged as f64);
    outcome
}

/// Number of points with a mark.
fn count(rows: &[Measured], mark: &str) -> usize {
    rows.iter().flat_map(|row| row.curve(mark)).filter(|(_, value)| *value != 0.0).count()
}

fn largest(rows: &[Measured], name: &str) -> f64 {
    rows.iter().map(|row| row.value(name)).fold(f64::NEG_INFINITY, max_or_nan)
}

fn complete(study: &Stability, rows: &[Measured]) -> Check {
    let known = |mark: &str| rows.iter().map(|row| row.curve(mark).len()).sum::<usize>();
    let (fixed, newton, points) = (known(FAILED), known(REFUSED), study.points * study.points);
    let evidence = format!("{fixed} and {newton} of {points}");
    Check::that(fixed == points && newton == points, "both solvers were tried at every point", evidence)
}

fn in_contact(rows: &[Measured]) -> Check {
    let forces = || rows.iter().flat_map(|row| row.curve("contact")).map(|(_, force)| *force);
    let least = forces().fold(f64::INFINITY, f64::min);
    let holds = forces().next().is_some() && forces().all(|force| force > 0.0);
    Check::that(holds, "the first step ends in contact", format!("least contact force {least:.2e}"))
}

/// The map against α and γ: convergence where both are well below 1, none where α exceeds 1 by γ and more.
fn as_predicted(rows: &[Measured]) -> Check {
    let (mut fast, mut beyond, mut wrong) = (0, 0, 0);
    for row in rows {
        let at = |name: &str, dt: f64| row.curve(name).iter().find(|(x, _)| *x == dt).map(|(_, value)| *value);
        for &(dt, failed) in row.curve(FAILED) {
            // Without an α the operator of (4.4) is indefinite.
            let alpha = at(ALPHA, dt).unwrap_or(f64::INFINITY);
            let gamma = at(GAMMA, dt).unwrap_or(f64::INFINITY);
            if alpha < SLOW && gamma < SLOW {
                fast += 1;
                wrong += usize::from(failed != 0.0);
            } else if alpha == f64::INFINITY || alpha > 1.0 + gamma + (1.0 - SLOW) {
                beyond += 1;
                wrong += usize::from(failed == 0.0);
            }
        }
    }
    Check::that(
        wrong == 0 && fast > 0 && beyond > 0,
        "on the map the fixed point converges where alpha and gamma are below 0.8, and not where alpha > 1.2 + gamma",
        format!("{fast} points of the one kind, {beyond} of the other, {wrong} against it"),
    )
}

/// Newton's method answers wherever its operator is known to be definite.
fn newton_answers(study: &Stability, rows: &[Measured]) -> Check {
    let (mut known, mut wrong) = (0, 0);
    for (value, row) in study.rows().into_iter().zip(rows) {
        let mut beam = Beam::default();
        match study.over {
            Parameter::Beta => beam.beta = value,
            Parameter::Zeta => beam.zeta = value,
            Parameter::Epsilon | Parameter::Width => {}
        }
        for &(dt, refused) in row.curve(REFUSED) {
            if BUCKLING * (beam.zeta + 0.5 * dt) + 0.5 * beam.beta * dt > 0.0 {
                known += 1;
                wrong += usize::from(refused != 0.0);
            }
        }
    }
    Check::that(
        wrong == 0 && known > 0,
        "Newton's method answers wherever B (zeta + dt/2) + beta dt/2 > 0",
        format!("{known} points, {wrong} refused; {} refused elsewhere", count(rows, REFUSED) - wrong),
    )
}

fn newton_is_quick(rows: &[Measured]) -> Check {
    let counts = || rows.iter().flat_map(|row| row.curve(ITERATIONS_OF_NEWTON)).map(|(_, count)| *count);
    let most = counts().fold(f64::NEG_INFINITY, f64::max);
    let claim = format!("Newton's method takes at most {MOST} iterations in any step");
    Check::that(most <= MOST && counts().all(f64::is_finite), claim, format!("at most {most}"))
}

fn energy(rows: &[Measured]) -> [Check; 2] {
    let evidence = |what: &str, share: &str| {
        format!("{:.1e} of the energy, {}", largest(rows, what), of_allowed(largest(rows, share)))
    };
    // A row in which the energy falls in every step has no share of a rise.
    let risen = rows.iter().all(|row| row.value("risen") <= 1.0);
    let open = rows.iter().all(|row| row.value("open") <= 1.0);
    [
        Check::that(risen, "the energy never rises beyond rounding errors", evidence("rise", "risen")),
        Check::that(
            open,
            "the balance closes to 1e-12 of the energy, or to what rounding errors explain",
            evidence("residual", "open"),
        ),
    ]
}

/// The contact's factor at the boundary found is 1, up to the share of γ that stands against it.
fn boundary(study: &Stability, value: f64, line: &Measured) -> Check {
    let name = study.over.name();
    let (crosses, expected) = (line.value("crosses"), line.value("should cross"));
    if crosses == 0.0 && expected == 0.0 {
        let claim = format!("{name} = {value:e}: no boundary on the map, as predicted");
        return Check::that(true, claim, "the fixed point behaves alike at both ends");
    }
    let (alpha, gamma) = (line.value("alpha"), line.value("gamma"));
    let holds = crosses == 1.0 && expected == 1.0 && (alpha - 1.0).abs() <= study.agreement + gamma;
    let (found, predicted) = (line.value("found"), line.value("predicted"));
    let difference = 100.0 * (found / predicted - 1.0);
    Check::that(
        holds,
        format!("{name} = {value:e}: the fixed point fails from alpha = 1 on"),
        format!(
            "from dt = {found:.4e} on, predicted {predicted:.4e} ({difference:+.2} %); alpha {alpha:.4} there, gamma {gamma:.1e}"
        ),
    )
}

fn boundaries(study: &Stability, lines: &[Measured]) -> Table {
    let row = |(value, line): (&f64, &Measured)| {
        let (found, predicted) = (line.value("found"), line.value("predicted"));
        let number = |x: f64, text: String| if x.is_finite() { text } else { "-".to_owned() };
        vec![
            format!("{value:e}"),
            number(predicted, format!("{predicted:.4e}")),
            number(found, format!("{found:.4e}")),
            number(found / predicted, format!("{:+.3} %", 100.0 * (found / predicted - 1.0))),
            number(line.value("alpha"), format!("{:.4}", line.value("alpha"))),
            number(line.value("gamma"), format!("{:.1e}", line.value("gamma"))),
        ]
    };
    let head = [study.over.name(), "dt where alpha = 1", "dt found", "difference", "alpha there", "gamma there"];
    Table {
        title: "Where the fixed point ceases to converge, by bisection in dt".to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows: study.lines.iter().zip(lines).map(row).collect(),
    }
}

fn quantities(study: &Stability, lines: &[Measured], converged: f64) -> Vec<Quantity> {
    let found = |(value, line): (&f64, &Measured)| {
        let name = format!("boundary at {} = {value:e}", study.over.name());
        let dt = line.value("found");
        dt.is_finite().then_some(Quantity { name, value: dt, tolerance: 1e-2 })
    };
    let mut quantities: Vec<Quantity> = study.lines.iter().zip(lines).filter_map(found).collect();
    // A point next to the boundary may fall to either side.
    quantities.push(Quantity { name: "points with a fixed point".to_owned(), value: converged, tolerance: 1e-2 });
    quantities
}
