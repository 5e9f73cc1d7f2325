//! How many steady states there are below β = -1/2, and in which of them a moving beam comes to rest.

use convergence_study::study::{CaseFailure, Check, Table};
use thermobeam::kirchhoff::BUCKLING;

use super::{Nearest, ToRest};
use crate::kinds::steady::{at_resolution, exact_states, settle};
use crate::scene::Scene;

/// Where the paper's text puts the beginning of several steady states.
const AS_PRINTED: f64 = -0.5;

/// A tip closer to zero than this is that of a straight beam: bent tips start at some 0.01, the lower obstacle.
const STRAIGHT: f64 = 1e-6;

/// The exact steady states at one β, and where a moving beam comes to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Number of exact steady states.
    pub states: usize,
    /// Number of those that are stable.
    pub stable: usize,
    /// u(1) at rest.
    pub u_tip: f64,
    /// When the beam has come to rest.
    pub t_rest: f64,
    /// The nearest exact steady state; `None` if there is none.
    pub nearest: Option<Nearest>,
}

/// Results with their β, in ascending order of it.
pub(super) type Rests<'r> = [(f64, &'r Rest)];

/// Counts the exact steady states of the scene with another β and lets the beam come to rest.
///
/// # Errors
/// Steady states that cannot be found, or a beam that does not come to rest.
pub(super) fn run(scene: &Scene, beta: f64, rest: &ToRest) -> Result<Rest, CaseFailure> {
    let mut scene = at_resolution(scene, rest.elements, rest.dt)?;
    scene.beam.beta = beta;
    scene.name = format!("beta = {beta}");
    let states = exact_states(&scene)?;
    let end = settle(&scene, rest.speed, rest.t_max)?;
    Ok(Rest {
        states: states.len(),
        stable: states.iter().filter(|state| state.stable).count(),
        u_tip: end.level.u[end.level.u.len() - 1],
        t_rest: end.t,
        nearest: Nearest::of(&scene.mesh, &end.level, &states),
    })
}

/// Judges the paper's last sentence.
///
/// * `complete`: whether there is a result for every β; no claim holds without.
pub(super) fn judge(rests: &Rests<'_>, complete: bool) -> Vec<Check> {
    let claim = |range: [f64; 2], holds: fn(&Rest) -> bool, text: &str, more: &str| {
        let within: Vec<_> = rests.iter().filter(|(beta, _)| range[0] < *beta && *beta < range[1]).collect();
        let holds = complete && !within.is_empty() && within.iter().all(|(_, rest)| holds(rest));
        let each: Vec<String> = within.iter().map(|(beta, rest)| evidence(*beta, rest)).collect();
        let evidence = if each.is_empty() { "no β in this range".to_owned() } else { each.join("; ") };
        Check::that(holds, text, evidence + more)
    };
    vec![
        claim(
            [AS_PRINTED, f64::INFINITY],
            is_alone_and_straight,
            "uniqueness for β > -1/2: the straight beam is the only steady state, and moving beams come to rest in it",
            "",
        ),
        claim(
            [-BUCKLING, AS_PRINTED],
            is_alone_and_straight,
            "not as printed (\"for β < -1/2 there are multiple steady-state solutions\"): for -0.7116 < β < -1/2 there is only \
             one, the straight beam",
            &format!("; the potential energy is strictly convex for β > -(π²/4)/(1 + π²/4) = {:.6}", -BUCKLING),
        ),
        claim(
            [f64::NEG_INFINITY, -BUCKLING],
            is_one_of_several_and_bent,
            "for β < -0.7116 there are several steady states, two of them stable, and moving beams come to rest bent",
            "",
        ),
    ]
}

fn is_alone_and_straight(rest: &Rest) -> bool {
    rest.states == 1 && rest.u_tip.abs() <= STRAIGHT
}

fn is_one_of_several_and_bent(rest: &Rest) -> bool {
    let several = rest.states >= 3 && rest.stable >= 2;
    several && rest.u_tip.abs() > STRAIGHT && rest.nearest.is_some_and(|nearest| nearest.state.stable)
}

fn evidence(beta: f64, rest: &Rest) -> String {
    format!("β = {beta}: {} of them, at rest u(1) = {:.2e}", rest.states, rest.u_tip)
}

/// The numbers behind the judgement.
pub(super) fn table(rests: &Rests<'_>) -> Table {
    let row = |(beta, rest): &(f64, &Rest)| {
        vec![
            format!("{beta}"),
            rest.states.to_string(),
            rest.stable.to_string(),
            format!("{:.6e}", rest.u_tip),
            rest.nearest.map_or_else(|| "-".to_owned(), |nearest| format!("{:.1e}", nearest.distance)),
            format!("{:.0}", rest.t_rest),
        ]
    };
    Table {
        title: "Steady states without heating, and where the moving beam comes to rest".into(),
        head: ["β", "steady states", "stable", "u(1) at rest", "distance to the nearest", "at rest by t"]
            .map(String::from)
            .to_vec(),
        rows: rests.iter().map(row).collect(),
    }
}
