//! How many steady states there are below β = -1/2, and in which of them a moving beam comes to rest.

use thermobeam::kirchhoff::BUCKLING;

use super::ToRest;
use crate::kinds::steady::{at_resolution, exact_states, nearest, settle};
use crate::kinds::untyped::Measured;
use crate::scene::Scene;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Table};

/// Where the paper's text puts the beginning of several steady states.
const AS_PRINTED: f64 = -0.5;

/// A tip closer to zero than this is that of a straight beam: bent tips start at some 0.01, the lower obstacle.
const STRAIGHT: f64 = 1e-6;

/// Counts the exact steady states of the scene with another β and lets the beam come to rest.
///
/// # Errors
/// Steady states that cannot be told, or a beam that does not come to rest.
pub(super) fn run(scene: &Scene, beta: f64, rest: &ToRest) -> Result<Measured, CaseFailure> {
    let mut scene = at_resolution(scene, rest.elements, rest.dt)?;
    scene.beam.beta = beta;
    scene.name = format!("beta = {beta}");
    let states = exact_states(&scene)?;
    let end = settle(&scene, rest.speed, rest.t_max)?;
    let mut measured = Measured::default();
    measured.push("states", states.len() as f64);
    measured.push("stable", states.iter().filter(|state| state.stable).count() as f64);
    measured.push("u_tip", end.level.u[end.level.u.len() - 1]);
    measured.push("t_rest", end.t);
    if let Some((state, (in_u, in_phi))) = nearest(&scene.mesh, &end.level, &states) {
        measured.push("nearest_stable", f64::from(u8::from(state.stable)));
        measured.push("distance", in_u.max(in_phi));
    }
    Ok(measured)
}

/// Judges the paper's last sentence.
pub(super) fn judge(betas: &[f64], rests: &[Measured]) -> Vec<Check> {
    vec![unique_above_one_half(betas, rests), unique_below_one_half(betas, rests), several_beyond(betas, rests)]
}

/// The β of a range with their results.
fn within<'a>(
    betas: &'a [f64],
    rests: &'a [Measured],
    range: [f64; 2],
) -> impl Iterator<Item = (f64, &'a Measured)> + Clone {
    betas.iter().copied().zip(rests).filter(move |(beta, _)| range[0] < *beta && *beta < range[1])
}

fn is_alone_and_straight(measured: &Measured) -> bool {
    measured.value("states") == 1.0 && measured.value("u_tip").abs() <= STRAIGHT
}

fn unique_above_one_half(betas: &[f64], rests: &[Measured]) -> Check {
    let all = within(betas, rests, [AS_PRINTED, f64::INFINITY]);
    let holds = all.clone().next().is_some() && all.clone().all(|(_, measured)| is_alone_and_straight(measured));
    Check::that(
        holds,
        "uniqueness for β > -1/2: the straight beam is the only steady state, and moving beams come to rest in it",
        evidence(all),
    )
}

fn unique_below_one_half(betas: &[f64], rests: &[Measured]) -> Check {
    let all = within(betas, rests, [-BUCKLING, AS_PRINTED]);
    let holds = all.clone().next().is_some() && all.clone().all(|(_, measured)| is_alone_and_straight(measured));
    Check::that(
        holds,
        "not as printed (\"for β < -1/2 there are multiple steady-state solutions\"): for -0.7116 < β < -1/2 there \
         is one only, the straight beam",
        format!(
            "{}; the potential energy is strictly convex for β > -(π²/4)/(1 + π²/4) = {:.6}",
            evidence(all),
            -BUCKLING
        ),
    )
}

fn several_beyond(betas: &[f64], rests: &[Measured]) -> Check {
    let all = within(betas, rests, [f64::NEG_INFINITY, -BUCKLING]);
    let is_bent = |measured: &Measured| measured.value("u_tip").abs() > STRAIGHT;
    let several = |measured: &Measured| measured.value("states") >= 3.0 && measured.value("stable") >= 2.0;
    let holds = all.clone().next().is_some()
        && all.clone().all(|(_, m)| several(m) && is_bent(m) && m.value("nearest_stable") == 1.0);
    Check::that(
        holds,
        "for β < -0.7116 there are several steady states, two of them stable, and moving beams come to rest bent",
        evidence(all),
    )
}

fn evidence<'a>(all: impl Iterator<Item = (f64, &'a Measured)>) -> String {
    let one = |(beta, measured): (f64, &Measured)| {
        format!("β = {beta}: {} of them, at rest u(1) = {:.2e}", measured.value("states"), measured.value("u_tip"))
    };
    let all: Vec<String> = all.map(one).collect();
    if all.is_empty() { "no β in this range".to_owned() } else { all.join("; ") }
}

/// The numbers behind the judgement.
pub(super) fn table(betas: &[f64], rests: &[Measured]) -> Table {
    let row = |(beta, measured): (&f64, &Measured)| {
        let number = |name: &str| measured.value(name);
        vec![
            format!("{beta}"),
            format!("{}", number("states")),
            format!("{}", number("stable")),
            format!("{:.6e}", number("u_tip")),
            format!("{:.1e}", number("distance")),
            format!("{:.0}", number("t_rest")),
        ]
    };
    Table {
        title: "Steady states without heating, and where the moving beam comes to rest".into(),
        head: ["β", "steady states", "stable", "u(1) at rest", "distance to the nearest", "at rest by t"]
            .map(String::from)
            .to_vec(),
        rows: betas.iter().zip(rests).map(row).collect(),
    }
}
