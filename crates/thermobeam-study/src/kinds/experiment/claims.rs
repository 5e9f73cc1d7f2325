//! The sentences of Section 5, each a check with its numbers.

use thermobeam::equilibrium::Contact;

use super::log::straight_energy;
use super::{Experiments, Group, Until, of_group};
use crate::kinds::steady::{code_of, contact_of, name_of};
use crate::kinds::untyped::Measured;
use crate::scene::Scene;
use convergence_study::study::outcome::Check;

/// The first contacts count as "at the beginning" within this share of the figures' span.
const BEGINNING: f64 = 0.1;

/// Distance from the exact steady state at which an experiment has arrived there: what the mesh of a hundred elements
/// and the last of the motion leave, a hundredth of the distance between the obstacles.
const ARRIVED: f64 = 1e-3;

/// What remains of the energy, in units of its last fall per unit of time: no mode of these beams decays slower than
/// exp(-t/50), the heat that flows through them included.
const REMAINS: f64 = 50.0;

/// All checks of the text, but for the number of steady states.
pub(super) fn judge(study: &Experiments, runs: &[Measured]) -> Vec<Check> {
    let first: Vec<_> = of_group(study, runs, |group| group == Group::First).map(|(e, m)| (&e.scene, m)).collect();
    let mut checks = vec![
        energy_never_rises(study, runs),
        energy_limit(&study.until, &first),
        becomes_straight(&first),
        both_obstacles(&first),
        frequency_grows(&first),
        amplitude_is_largest(&first),
    ];
    checks.extend(of_group(study, runs, |group| matches!(group, Group::Second(_))).filter_map(
        |(e, m)| match e.group {
            Group::Second(contact) => Some(comes_to_rest(&e.scene, contact, m)),
            _ => None,
        },
    ));
    checks.extend(of_group(study, runs, |group| group == Group::Third).map(|(e, m)| ends_bent(&e.scene, m)));
    checks
}

fn energy_never_rises(study: &Experiments, runs: &[Measured]) -> Check {
    let each = study.experiments.iter().zip(runs).map(|(e, m)| (e.scene.name.as_str(), m.value("largest_increase")));
    // Within the round-off of an energy of order 1 to 10.
    let holds = runs.len() == study.experiments.len() && each.clone().all(|(_, rise)| rise <= 1e-14);
    let list: Vec<String> = each.map(|(name, rise)| format!("{name} {rise:.1e}")).collect();
    Check::that(
        holds,
        "the energy never rises, in none of the experiments",
        format!("largest change in a step: {}", list.join(", ")),
    )
}

type Runs<'a> = [(&'a Scene, &'a Measured)];

fn energy_limit(until: &Until, first: &Runs<'_>) -> Check {
    let allowed = REMAINS * until.rate;
    let excess = |(scene, m): &(&Scene, &Measured)| m.value("energy") - straight_energy(scene);
    let holds = !first.is_empty() && first.iter().all(|run| excess(run).abs() <= allowed);
    let list = list(first, |scene, m| {
        format!("{:.9} for {:.9} at t = {:.0}", m.value("energy"), straight_energy(scene), m.value("t_steady"))
    });
    let claim = format!("θ_A = 0: the energy falls to β²/(4ρ), to {allowed:.1e}");
    Check::that(holds, claim, list)
}

fn becomes_straight(first: &Runs<'_>) -> Check {
    let holds = !first.is_empty() && first.iter().all(|(_, m)| m.value("largest_field") <= ARRIVED);
    let list = list(first, |_, m| format!("{:.1e}", m.value("largest_field")));
    Check::that(
        holds,
        "θ_A = 0: the evolution is towards u = φ = θ = 0",
        format!("largest of the three fields: {list}"),
    )
}

fn both_obstacles(first: &Runs<'_>) -> Check {
    let early = |scene: &Scene, t: f64| t > 0.0 && t <= BEGINNING * scene.t_end;
    let touches =
        |(scene, m): &(&Scene, &Measured)| early(scene, m.value("first_upper")) && early(scene, m.value("first_lower"));
    let holds = !first.is_empty() && first.iter().all(touches);
    let list =
        list(first, |_, m| format!("upper t = {:.4}, lower t = {:.4}", m.value("first_upper"), m.value("first_lower")));
    Check::that(holds, "at the beginning the beam touches both obstacles", format!("first contacts: {list}"))
}

fn frequency_grows(first: &Runs<'_>) -> Check {
    let frequency = |m: &Measured| m.value("frequency");
    let holds = first.len() >= 2 && first.windows(2).all(|pair| frequency(pair[0].1) < frequency(pair[1].1));
    let list = list(first, |_, m| format!("{:.4} from {} upward crossings", frequency(m), m.value("crossings")));
    Check::that(
        holds,
        "the frequency of oscillation grows with β (with β itself, not with its size |β|)",
        format!("frequency of u(1): {list}"),
    )
}

fn amplitude_is_largest(first: &Runs<'_>) -> Check {
    let amplitude = |m: &Measured| m.value("phi_amplitude");
    let holds = first.len() >= 2 && first[1..].iter().all(|(_, m)| amplitude(first[0].1) > amplitude(m));
    let list = list(first, |_, m| format!("{:.4}", amplitude(m)));
    let beta = first.first().map_or(f64::NAN, |(scene, _)| scene.beam.beta);
    Check::that(
        holds,
        format!("the oscillations of φ(1) are largest for β = {beta}"),
        format!("largest minus smallest φ(1): {list}"),
    )
}

fn comes_to_rest(scene: &Scene, contact: Contact, m: &Measured) -> Check {
    let presses = match contact {
        Contact::Upper => m.value("contact_force") > 0.0,
        Contact::Lower => m.value("contact_force") < 0.0,
        Contact::Free => m.value("contact_force") == 0.0,
    };
    let Scene { beam, .. } = scene;
    let place = if contact == Contact::Free { "free of both obstacles" } else { name_of(contact) };
    Check::that(
        presses && is_exact(m, contact),
        format!("θ_A = {}, β = {}: at the steady state the beam is {place}", beam.theta_a, beam.beta),
        at_rest(m),
    )
}

fn ends_bent(scene: &Scene, m: &Measured) -> Check {
    let contact = contact_of(m.value("exact_contact"));
    let holds = m.value("u_tip").abs() > ARRIVED && contact.is_some_and(|contact| is_exact(m, contact));
    Check::that(
        holds,
        format!("β = {}: the stationary solution is not zero", scene.beam.beta),
        format!("{}, one of {} steady states", at_rest(m), m.value("states")),
    )
}

/// Whether the end is the exact, stable steady state with this contact.
fn is_exact(m: &Measured, contact: Contact) -> bool {
    m.value("exact_contact") == code_of(contact) && m.value("exact_stable") == 1.0 && m.value("distance") <= ARRIVED
}

fn at_rest(m: &Measured) -> String {
    format!(
        "u(1) = {:.9}, contact force {:.6}, at t = {:.0}; the exact state has u(1) = {:.9}",
        m.value("u_tip"),
        m.value("contact_force"),
        m.value("t_steady"),
        m.value("exact_u_tip")
    )
}

fn list(runs: &Runs<'_>, text: impl Fn(&Scene, &Measured) -> String) -> String {
    let each: Vec<String> =
        runs.iter().map(|(scene, m)| format!("β = {}: {}", scene.beam.beta, text(scene, m))).collect();
    each.join("; ")
}
