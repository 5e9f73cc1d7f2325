//! The sentences of Section 5, each a check with its numbers.

use super::{
    Experiments, MeasuredRun, SectionGroup,
    group::{OfExperiment, OfGroup, SectionFive},
    paper,
    plotted::{Plotted, U_TIP, largest_difference},
    rests, straight_energy,
};
use crate::kinds::prelude::*;
use crate::kinds::{
    runs::{
        checks::{Condition, all, at_most, increasing},
        steady::name_of,
    },
    settings::ItemMethod,
};
use convergence_study::Origin;
use thermobeam::{kirchhoff::BUCKLING, parameters::Beam};
use thermobeam_exact::equilibrium::Phase;

/// A first contact within this share of the figures' span counts as "at the beginning".
const BEGINNING: f64 = 0.1;

/// Distance from the exact steady state within which an experiment has arrived: the error of a
/// hundred elements and the remaining motion, a hundredth of the distance between the obstacles.
const ARRIVED: f64 = 1e-3;

/// The energy that remains, in units of its last fall per unit of time: no mode of these beams,
/// including heat conduction, decays more slowly than exp(-t/50).
const REMAINS: f64 = 50.0;

/// Largest change of the energy in a step: the round-off of an energy of order 1 to 10.
const ROUND_OFF: f64 = 1e-14;

/// Share of an error that can be neglected.
const NEGLIGIBLE: f64 = 0.02;

/// * `plotted`: the figures.
pub(super) fn checks(
    study: &Experiments,
    runs: &SectionFive<'_>,
    plotted: &[Plotted],
) -> Vec<Check> {
    let mut checks = vec![never_rises(&runs.all)];
    checks.extend(ends_straight(&runs.first, REMAINS * study.rate));
    checks.extend(moves(&runs.first));
    for runs in &runs.all.runs {
        match runs.experiment.group {
            SectionGroup::First => {}
            SectionGroup::Second(contact) => checks.push(comes_to_rest(runs, contact)),
            SectionGroup::Third => checks.push(ends_bent(runs)),
        }
    }
    let mut checks: Vec<Check> = checks
        .into_iter()
        .map(|check| check.stated_by(Origin::Source))
        .collect();
    checks.extend(rests::checks(&runs.rests));
    checks.push(study.data());
    checks.push(paper::motion(&runs.first));
    checks.push(thin_lines(plotted));
    if study.fixed_point.is_some() {
        checks.push(solved(&runs.all));
    }
    checks
}

/// The tolerance η* of the paper's algorithm leaves an error that does not matter.
///
/// With ‖φ‖ <= (2/π) ‖φ_x‖, the norm d of (3.14) bounds |u(1)| <= ‖u_x‖ <= ‖u_x - φ‖ + ‖φ‖ <= (1 +
/// 4/π²)^½ d.
fn solved(all_runs: &OfGroup<'_>) -> Check {
    let evidence = all_runs.joined(", ", |runs| {
        let bound = bound_of_tolerance(runs);
        let error = error_of_paper(runs);
        format!("{} {bound:.1e} of {error:.1e}", runs.name())
    });
    let are_small =
        all_runs.all(|runs| bound_of_tolerance(runs) <= NEGLIGIBLE * error_of_paper(runs));
    all(
        format!("η* causes at most {NEGLIGIBLE} of the error of u(1, t)"),
        Subject::of("distance to Newton's solution").by(ItemMethod::FixedPoint),
        [Condition::that(are_small, evidence)],
    )
}

/// A bound on the error of u(1, t) that η* causes; NaN if the study does not run the paper's
/// algorithm.
fn bound_of_tolerance(runs: &OfExperiment<'_>) -> f64 {
    let distance = runs.paper.map_or(f64::NAN, |paper| paper.solvers.distance);
    distance / BUCKLING.sqrt()
}

/// The largest error of u(1, t) by the paper's algorithm; NaN if the study does not run that.
fn error_of_paper(runs: &OfExperiment<'_>) -> f64 {
    let Some(paper) = runs.paper else {
        return f64::NAN;
    };
    let exact = U_TIP.points(runs.experiment, &runs.first.trace);
    let tip = U_TIP.points(runs.experiment, &paper.trace);
    largest_difference(false, &exact, &tip)
}

/// The figures are drawn from curves whose error cannot be seen.
fn thin_lines(plotted: &[Plotted]) -> Check {
    let each: Vec<String> = plotted
        .iter()
        .map(|plot| format!("{} {:.0e}", plot.what, plot.error()))
        .collect();
    let evidence = format!("largest error over the width: {}", each.join(", "));
    let is_thin = !plotted.is_empty() && plotted.iter().all(|plot| plot.error() < 1.0);
    all(
        "the error of each curve in the figures is below the width of its line",
        Subject::of("curves of the figures").by(ItemMethod::AnyOrder),
        [Condition::that(is_thin, evidence)],
    )
}

/// A time that may be missing.
fn time(t: Option<f64>) -> String {
    t.map_or_else(|| "never".to_owned(), |t| format!("t = {t:.4}"))
}

fn never_rises(all_runs: &OfGroup<'_>) -> Check {
    let each = all_runs.joined(", ", |runs| {
        format!("{} {:.1e}", runs.name(), runs.trace().largest_increase)
    });
    let evidence = format!("largest change in a step: {each}");
    let largest = all_runs.largest(|runs| runs.trace().largest_increase);
    all(
        "the energy rises in none of the experiments",
        Subject::of("energy"),
        [at_most(largest, ROUND_OFF, evidence)],
    )
}

/// * `allowed`: upper bound on the remaining energy.
fn ends_straight(group: &OfGroup<'_>, allowed: f64) -> [Check; 2] {
    let remains =
        group.largest(|runs| (runs.first.energy - straight_energy(&runs.experiment.scene)).abs());
    let energies = group.list(|runs| {
        let MeasuredRun { energy, end, .. } = runs.first;
        let straight = straight_energy(&runs.experiment.scene);
        format!("{energy:.9} for {straight:.9} at t = {:.0}", end.t)
    });
    let largest = group.largest(|runs| runs.first.largest_field);
    let fields = group.list(|runs| format!("{:.1e}", runs.first.largest_field));
    let fields = format!("largest of the three fields: {fields}");
    [
        all(
            format!("the energy falls to β²/(4ρ), to {allowed:.1e}"),
            Subject::of("energy at rest").in_case("θ_A = 0"),
            [at_most(remains, allowed, energies)],
        ),
        all(
            "the evolution is towards u = φ = θ = 0",
            Subject::of("fields at rest").in_case("θ_A = 0"),
            [at_most(largest, ARRIVED, fields)],
        ),
    ]
}

/// First contacts, frequency and amplitude; the experiments are in ascending order of β.
fn moves(group: &OfGroup<'_>) -> [Check; 3] {
    let contacts = group.list(|runs| {
        let trace = runs.trace();
        let [upper, lower] = [trace.first_upper, trace.first_lower].map(time);
        format!("upper {upper}, lower {lower}")
    });
    let frequencies = group.list(|runs| {
        let crossings = runs.trace().crossings;
        format!("{:.4} from {crossings} upward crossings", frequency(runs))
    });
    let frequencies = format!("frequency of u(1), in the order of β, not of |β|: {frequencies}");
    let amplitudes = group.list(|runs| format!("{:.4}", runs.trace().phi_amplitude));
    let amplitudes = format!("largest minus smallest φ(1): {amplitudes}");
    let is_largest = match &group.numbers(|runs| runs.trace().phi_amplitude)[..] {
        [first, others @ ..] => !others.is_empty() && others.iter().all(|other| first > other),
        [] => false,
    };
    let least = group.runs.first();
    let beta = least.map_or(f64::NAN, |runs| runs.beam().beta);
    [
        all(
            "at the beginning the beam touches both obstacles",
            Subject::of("first contact"),
            [Condition::that(
                group.all(touches_both),
                format!("first contacts: {contacts}"),
            )],
        ),
        all(
            "the frequency of oscillation grows with β",
            Subject::of("frequency"),
            [increasing(&group.numbers(frequency), frequencies)],
        ),
        all(
            format!("the oscillations of φ(1) are largest for β = {beta}"),
            Subject::of("phi_amplitude"),
            [Condition::that(is_largest, amplitudes)],
        ),
    ]
}

/// The frequency of u(1); NaN if it is not known.
fn frequency(runs: &OfExperiment<'_>) -> f64 {
    runs.trace().frequency.unwrap_or(f64::NAN)
}

/// Whether the beam touches both obstacles at the beginning.
fn touches_both(runs: &OfExperiment<'_>) -> bool {
    let until = BEGINNING * runs.experiment.scene.t_end;
    let trace = runs.trace();
    [trace.first_upper, trace.first_lower]
        .into_iter()
        .all(|contact| contact.is_some_and(|t| t > 0.0 && t <= until))
}

fn comes_to_rest(runs: &OfExperiment<'_>, contact: Phase) -> Check {
    let run = runs.first;
    let presses = match contact {
        Phase::Upper => run.contact_force > 0.0,
        Phase::Lower => run.contact_force < 0.0,
        Phase::Free => run.contact_force == 0.0,
    };
    let place = if contact == Phase::Free {
        "free of both obstacles"
    } else {
        name_of(contact)
    };
    let Beam { theta_a, beta, .. } = runs.beam();
    let is_there = run.end.contact() == Some(contact);
    all(
        format!("at the steady state the beam is {place}"),
        Subject::of("contact at rest").in_case(format!("θ_A = {theta_a}, β = {beta}")),
        [Condition::that(
            presses && is_there && has_arrived(run),
            at_rest(run),
        )],
    )
}

fn ends_bent(runs: &OfExperiment<'_>) -> Check {
    let run = runs.first;
    let evidence = format!("{}, one of {} steady states", at_rest(run), run.end.count());
    all(
        "the stationary solution is not zero",
        Subject::of("end").in_case(format!("β = {}", runs.beam().beta)),
        [Condition::that(
            run.end.tip[0].abs() > ARRIVED && has_arrived(run),
            evidence,
        )],
    )
}

/// Whether the end is an exact, stable steady state.
fn has_arrived(run: &MeasuredRun) -> bool {
    run.end.is_stable() && run.end.distance() <= ARRIVED
}

fn at_rest(run: &MeasuredRun) -> String {
    let [u, _] = run.end.tip;
    let [exact, _] = run.end.exact_tip();
    let force = run.contact_force;
    let t = run.end.t;
    format!(
        "u(1) = {u:.9}, contact force {force:.6}, at t = {t:.0}; the exact state has u(1) = {exact:.9}"
    )
}
