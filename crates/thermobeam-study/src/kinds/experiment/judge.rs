//! The sentences of Section 5, each a check with its numbers.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::levels::completion;
use convergence_study::study::{Check, Outcome, Ran};
use thermobeam::equilibrium::Contact;

use super::run::straight_energy;
use super::{Experiment, Experiments, Found, Group, Rest, Run, Task, Until, report, rest};
use crate::kinds::steady::name_of;
use crate::scene::Scene;

/// The first contacts count as "at the beginning" within this share of the figures' span.
const BEGINNING: f64 = 0.1;

/// Distance from the exact steady state at which an experiment has arrived there: what the mesh of a hundred elements
/// and the last of the motion leave, a hundredth of the distance between the obstacles.
const ARRIVED: f64 = 1e-3;

/// What remains of the energy, in units of its last fall per unit of time: no mode of these beams decays slower than
/// exp(-t/50), the heat that flows through them included.
const REMAINS: f64 = 50.0;

/// Largest change of the energy in a step: the round-off of an energy of order 1 to 10.
const ROUND_OFF: f64 = 1e-14;

/// The experiments of a group that completed.
pub(super) struct Runs<'r> {
    pub(super) runs: Vec<(&'r Experiment, &'r Run)>,
    /// Whether all of them did: no claim holds without.
    complete: bool,
}

impl<'r> Runs<'r> {
    /// The experiments that belong to the group.
    pub(super) fn of(study: &'r Experiments, ran: &'r [Ran<Task, Found>], belongs: impl Fn(Group) -> bool) -> Self {
        let run = |task: Task| match ran.iter().find(|ran| ran.case.data == task).and_then(Ran::ok) {
            Some(Found::Run(run)) => Some(&**run),
            _ => None,
        };
        let group = || study.experiments.iter().enumerate().filter(|(_, experiment)| belongs(experiment.group));
        let runs: Vec<_> = group().filter_map(|(k, experiment)| Some((experiment, run(Task::Run(k))?))).collect();
        Self { complete: runs.len() == group().count() && !runs.is_empty(), runs }
    }

    fn all(&self, holds: impl Fn(&Scene, &Run) -> bool) -> bool {
        self.complete && self.runs.iter().all(|(experiment, run)| holds(&experiment.scene, run))
    }

    fn list(&self, text: impl Fn(&Scene, &Run) -> String) -> String {
        let one = |(Experiment { scene, .. }, run): &(&Experiment, &Run)| {
            format!("β = {}: {}", scene.beam.beta, text(scene, run))
        };
        self.runs.iter().map(one).collect::<Vec<_>>().join("; ")
    }
}

pub(super) fn judge(study: &Experiments, ran: &[Ran<Task, Found>]) -> Outcome {
    let rests = rests(study, ran);
    let mut checks = vec![completion(ran, not_finite)];
    checks.extend(claims(study, ran));
    checks.extend(rest::judge(&rests, rests.len() == study.betas.len()));
    report::outcome(study, ran, &rests, checks)
}

/// The runs to rest that completed, each with its β.
fn rests<'r>(study: &Experiments, ran: &'r [Ran<Task, Found>]) -> Vec<(f64, &'r Rest)> {
    let rest = |ran: &'r Ran<Task, Found>| match (ran.case.data, ran.ok()) {
        (Task::Rest(k), Some(Found::Rest(rest))) => Some((study.betas[k], rest)),
        _ => None,
    };
    ran.iter().filter_map(rest).collect()
}

/// Names of the numbers that are not finite.
fn not_finite(found: &Found) -> Vec<String> {
    let distance = |nearest: Option<super::Nearest>| nearest.map_or(f64::NAN, |nearest| nearest.distance);
    let numbers = match found {
        Found::Run(run) => vec![
            ("time of the steady state", run.t_steady),
            ("energy", run.energy),
            ("u(1)", run.u_tip),
            ("φ(1)", run.phi_tip),
            ("contact force", run.contact_force),
            ("largest field", run.largest_field),
            ("distance to a steady state", distance(run.nearest)),
            ("first contact above", run.first_upper.unwrap_or(0.0)),
            ("first contact below", run.first_lower.unwrap_or(0.0)),
            ("frequency", run.frequency.unwrap_or(0.0)),
            ("range of φ(1)", run.phi_amplitude),
            ("largest change of the energy", run.largest_increase),
        ],
        Found::Rest(rest) => vec![
            ("u(1)", rest.u_tip),
            ("time of rest", rest.t_rest),
            ("distance to a steady state", distance(rest.nearest)),
        ],
    };
    numbers.iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| (*name).to_owned()).collect()
}

/// All checks of the text, but for the number of steady states.
fn claims(study: &Experiments, ran: &[Ran<Task, Found>]) -> Vec<Check> {
    let first = Runs::of(study, ran, |group| group == Group::First);
    let mut checks = vec![
        energy_never_rises(&Runs::of(study, ran, |_| true)),
        energy_limit(&study.until, &first),
        becomes_straight(&first),
        both_obstacles(&first),
        frequency_grows(&first),
        amplitude_is_largest(&first),
    ];
    // Completion has failed where a run is missing.
    checks.extend(Runs::of(study, ran, |group| group != Group::First).runs.iter().map(|(experiment, run)| {
        match experiment.group {
            Group::Second(contact) => comes_to_rest(&experiment.scene, contact, run),
            Group::First | Group::Third => ends_bent(&experiment.scene, run),
        }
    }));
    checks
}

fn energy_never_rises(runs: &Runs<'_>) -> Check {
    let each = runs.runs.iter().map(|(e, run)| format!("{} {:.1e}", e.scene.name, run.largest_increase));
    Check::that(
        runs.all(|_, run| run.largest_increase <= ROUND_OFF),
        "the energy rises in none of the experiments",
        format!("largest change in a step: {}", each.collect::<Vec<_>>().join(", ")),
    )
}

fn energy_limit(until: &Until, first: &Runs<'_>) -> Check {
    let allowed = REMAINS * until.rate;
    let list = first
        .list(|scene, run| format!("{:.9} for {:.9} at t = {:.0}", run.energy, straight_energy(scene), run.t_steady));
    let holds = first.all(|scene, run| (run.energy - straight_energy(scene)).abs() <= allowed);
    Check::that(holds, format!("θ_A = 0: the energy falls to β²/(4ρ), to {allowed:.1e}"), list)
}

fn becomes_straight(first: &Runs<'_>) -> Check {
    Check::that(
        first.all(|_, run| run.largest_field <= ARRIVED),
        "θ_A = 0: the evolution is towards u = φ = θ = 0",
        format!("largest of the three fields: {}", first.list(|_, run| format!("{:.1e}", run.largest_field))),
    )
}

fn both_obstacles(first: &Runs<'_>) -> Check {
    let early = |scene: &Scene, t: Option<f64>| t.is_some_and(|t| t > 0.0 && t <= BEGINNING * scene.t_end);
    let list = first
        .list(|_, run| format!("upper {}, lower {}", report::time(run.first_upper), report::time(run.first_lower)));
    Check::that(
        first.all(|scene, run| early(scene, run.first_upper) && early(scene, run.first_lower)),
        "at the beginning the beam touches both obstacles",
        format!("first contacts: {list}"),
    )
}

fn frequency_grows(first: &Runs<'_>) -> Check {
    let frequency = |run: &Run| run.frequency.unwrap_or(f64::NAN);
    let grows = first.runs.windows(2).all(|pair| frequency(pair[0].1) < frequency(pair[1].1));
    let list = first.list(|_, run| format!("{:.4} from {} upward crossings", frequency(run), run.crossings));
    Check::that(
        first.complete && first.runs.len() >= 2 && grows,
        "the frequency of oscillation grows with β (with β itself, not with its size |β|)",
        format!("frequency of u(1): {list}"),
    )
}

fn amplitude_is_largest(first: &Runs<'_>) -> Check {
    let holds = match first.runs.as_slice() {
        [(_, first), others @ ..] if !others.is_empty() => {
            others.iter().all(|(_, run)| first.phi_amplitude > run.phi_amplitude)
        }
        _ => false,
    };
    let list = first.list(|_, run| format!("{:.4}", run.phi_amplitude));
    let beta = first.runs.first().map_or(f64::NAN, |(experiment, _)| experiment.scene.beam.beta);
    Check::that(
        first.complete && holds,
        format!("the oscillations of φ(1) are largest for β = {beta}"),
        format!("largest minus smallest φ(1): {list}"),
    )
}

fn comes_to_rest(scene: &Scene, contact: Contact, run: &Run) -> Check {
    let presses = match contact {
        Contact::Upper => run.contact_force > 0.0,
        Contact::Lower => run.contact_force < 0.0,
        Contact::Free => run.contact_force == 0.0,
    };
    let Scene { beam, .. } = scene;
    let place = if contact == Contact::Free { "free of both obstacles" } else { name_of(contact) };
    let is_there = run.nearest.is_some_and(|nearest| nearest.state.contact == contact);
    Check::that(
        presses && is_there && has_arrived(run),
        format!("θ_A = {}, β = {}: at the steady state the beam is {place}", beam.theta_a, beam.beta),
        at_rest(run),
    )
}

fn ends_bent(scene: &Scene, run: &Run) -> Check {
    Check::that(
        run.u_tip.abs() > ARRIVED && has_arrived(run),
        format!("β = {}: the stationary solution is not zero", scene.beam.beta),
        format!("{}, one of {} steady states", at_rest(run), run.states),
    )
}

/// Whether the end is an exact, stable steady state.
fn has_arrived(run: &Run) -> bool {
    run.nearest.is_some_and(|nearest| nearest.state.stable && nearest.distance <= ARRIVED)
}

fn at_rest(run: &Run) -> String {
    format!(
        "u(1) = {:.9}, contact force {:.6}, at t = {:.0}; the exact state has u(1) = {:.9}",
        run.u_tip,
        run.contact_force,
        run.t_steady,
        run.nearest.map_or(f64::NAN, |nearest| nearest.state.u_tip)
    )
}

/// How many of the checks passed, in a sentence.
pub(super) fn summary(checks: &[Check]) -> String {
    let passed = checks.iter().filter(|check| check.verdict == Verdict::Pass).count();
    format!("{passed} of {} statements about the experiments hold", checks.len())
}
