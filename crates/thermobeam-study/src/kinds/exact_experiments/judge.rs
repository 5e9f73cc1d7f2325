//! The verdict: two discretisations agree, and their energy falls with a balance that closes.

use convergence_study::study::levels;
use convergence_study::study::{Check, Outcome, Quantity, Ran};
use convergence_study::text::number::max_or_nan;

use super::{ExactExperiments, Method, Run, Shown, report};
use crate::run::tally::Sample;

/// Residual of the balance that is round-off, over the initial energy.
const CLOSED: f64 = 1e-12;

/// Relative change of a published number that the baseline tolerates.
const TOLERANCE: f64 = 1e-8;

/// The runs of one scene.
pub(super) struct OfScene<'r> {
    pub(super) name: &'r str,
    pub(super) any_order: [Option<&'r Shown>; 2],
    pub(super) own: Option<&'r Shown>,
}

pub(super) fn numbers(state: &Sample) -> [(&'static str, f64); 6] {
    [
        ("u(1)", state.u_tip),
        ("phi(1)", state.phi_tip),
        ("u_t(1)", state.u_t_tip),
        ("phi_t(1)", state.phi_t_tip),
        ("theta(1/2)", state.theta_mid),
        ("E", state.energy),
    ]
}

pub(super) fn judge(study: &ExactExperiments, ran: &[Ran<Run, Shown>]) -> Outcome {
    let mut checks = vec![levels::completion(ran, not_finite)];
    let scenes: Vec<OfScene<'_>> = (0..study.scenes.len()).map(|scene| of_scene(study, ran, scene)).collect();
    let mut worst = 0.0;
    let mut quantities = vec![];
    for scene in &scenes {
        let difference = difference(scene);
        worst = max_or_nan(worst, difference);
        checks.push(Check::that(
            difference <= study.agreement,
            format!("{}: two discretisations agree within {:e}", scene.name, study.agreement),
            format!("largest difference {difference:.1e}"),
        ));
        checks.push(events_agree(scene, study.agreement));
        checks.push(balance(scene));
        for state in scene.any_order[0].iter().flat_map(|shown| &shown.states) {
            quantities.extend(numbers(state).iter().map(|(name, value)| Quantity {
                name: format!("{}: {name} at t = {}", scene.name, state.t),
                value: *value,
                tolerance: TOLERANCE,
            }));
        }
    }
    let summary = format!("{} experiments, two discretisations agree within {worst:.1e}", scenes.len());
    Outcome {
        headline: report::headline(study, &scenes, worst),
        tables: report::tables(study, &scenes),
        figures: report::figures(study, &scenes),
        quantities,
        ..Outcome::new(summary, vec![], checks)
    }
}

fn of_scene<'r>(study: &'r ExactExperiments, ran: &'r [Ran<Run, Shown>], scene: usize) -> OfScene<'r> {
    let by = |method: Method| {
        ran.iter().find(|ran| ran.case.data == Run { scene, method }).and_then(|ran| ran.found.as_ref().ok())
    };
    OfScene {
        name: &study.scenes[scene].name,
        any_order: [by(Method::AnyOrder(0)), by(Method::AnyOrder(1))],
        own: by(Method::Own),
    }
}

fn not_finite(shown: &Shown) -> Vec<String> {
    let states = shown.states.iter().flat_map(|state| numbers(state));
    let names = states.filter(|(_, value)| !value.is_finite()).map(|(name, _)| name.to_owned());
    let tip = (shown.tip.is_empty() || shown.tip.iter().any(|(_, u)| !u.is_finite())).then(|| "u(1, t)".to_owned());
    names.chain(tip).collect()
}

/// The largest difference of any number at any time; NaN where one of the runs is missing.
pub(super) fn difference(scene: &OfScene<'_>) -> f64 {
    let [Some(one), Some(other)] = scene.any_order else { return f64::NAN };
    if one.states.len() != other.states.len() || one.states.is_empty() {
        return f64::NAN;
    }
    let pairs = one.states.iter().zip(&other.states);
    let differences = pairs.flat_map(|(a, b)| {
        let (a, b) = (numbers(a), numbers(b));
        (0..a.len()).map(move |i| (a[i].1 - b[i].1).abs())
    });
    differences.fold(0.0, max_or_nan)
}

fn events_agree(scene: &OfScene<'_>, agreement: f64) -> Check {
    let claim = format!("{}: they agree on every contact event", scene.name);
    let [Some(one), Some(other)] = scene.any_order else {
        return Check::that(false, claim, "a run is missing");
    };
    let alike = one.events.len() == other.events.len()
        && one.events.iter().zip(&other.events).all(|(a, b)| (a.from, a.to) == (b.from, b.to));
    let apart = one.events.iter().zip(&other.events).map(|(a, b)| (a.t - b.t).abs()).fold(0.0, max_or_nan);
    // Times are of order 10, the other numbers of order 1.
    let holds = alike && apart <= 10.0 * agreement;
    Check::that(
        holds,
        claim,
        format!("{} and {} events, times at most {apart:.1e} apart", one.events.len(), other.events.len()),
    )
}

fn balance(scene: &OfScene<'_>) -> Check {
    let fold = |i: usize| {
        let values = scene.any_order.iter().map(|shown| shown.map_or(f64::NAN, |shown| shown.balance[i]));
        values.fold(f64::NEG_INFINITY, max_or_nan)
    };
    let (residual, increase) = (fold(0), fold(1));
    Check::that(
        residual <= CLOSED && increase <= 0.0,
        format!("{}: the energy falls in every step and its balance closes within {CLOSED:e} of E0", scene.name),
        format!("largest residual {residual:.1e} of E0, largest change {increase:.1e}"),
    )
}
