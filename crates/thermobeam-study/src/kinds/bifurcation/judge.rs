//! The claims: where the beam buckles and lifts off, and that moving beams come to rest on stable branches.

use convergence_study::study::levels::{Claim, ErrorColumn, Levels, Refinement, completion};
use convergence_study::study::{Axis, Check, Outcome, Ran};
use convergence_study::text::number::max_or_nan;
use thermobeam::kirchhoff::BUCKLING;

use super::branches::Event;
use super::cases::BRACKET;
use super::{BifurcationStudy, Diagram, Found, Rest, Task, report};
use crate::scene::Scene;

/// A tip closer to zero than this is that of a straight beam.
const STRAIGHT: f64 = 1e-6;

/// How far the extrapolated buckling force of P1 elements may be from the exact one.
const LIMIT: f64 = 1e-8;

/// The results by what they are; `None` and NaN where a case failed.
pub(super) struct Results<'r> {
    /// One for each scene.
    pub(super) diagrams: Vec<Option<&'r Diagram>>,
    /// One for each mesh.
    pub(super) forces: Vec<f64>,
    /// For each scene, one for each β.
    pub(super) rests: Vec<Vec<Option<&'r Rest>>>,
}

impl<'r> Results<'r> {
    fn of(study: &BifurcationStudy, ran: &'r [Ran<Task, Found>]) -> Self {
        let found = |task: Task| ran.iter().find(|ran| ran.case.data == task).and_then(Ran::ok);
        let diagram = |scene: usize| match found(Task::Diagram(scene)) {
            Some(Found::Diagram(diagram)) => Some(diagram),
            _ => None,
        };
        let force = |n: usize| match found(Task::Buckling(n)) {
            Some(Found::Force(force)) => *force,
            _ => f64::NAN,
        };
        let rest = |scene: usize, beta: usize| match found(Task::Rest(scene, beta)) {
            Some(Found::Rest(rest)) => Some(rest),
            _ => None,
        };
        let rests = |scene: usize| (0..study.betas.len()).map(|beta| rest(scene, beta)).collect();
        Self {
            diagrams: (0..study.scenes.len()).map(diagram).collect(),
            forces: study.meshes.iter().map(|&n| force(n)).collect(),
            rests: (0..study.scenes.len()).map(rests).collect(),
        }
    }
}

pub(super) fn judge(study: &BifurcationStudy, ran: &[Ran<Task, Found>]) -> Outcome {
    let results = Results::of(study, ran);
    let mut checks = vec![completion(ran, not_finite), discrete_limit(study, &results.forces)];
    for ((scene, diagram), rests) in study.scenes.iter().zip(&results.diagrams).zip(&results.rests) {
        checks.push(ends_are_stable(study, scene, rests));
        // Completion has failed where there is no diagram.
        let Some(diagram) = diagram else { continue };
        checks.push(unambiguous(scene, diagram));
        checks.extend(match Event::of(scene) {
            Event::Buckling => vec![buckles(diagram), bent_below(study, rests)],
            Event::LiftOff => vec![lifts_off(diagram), one_state(scene, diagram)],
        });
    }
    let levels = levels(study, &results.forces);
    report::outcome(study, &results, &levels, checks)
}

/// Names of the numbers that are not finite.
fn not_finite(found: &Found) -> Vec<String> {
    let numbers = match found {
        Found::Diagram(Diagram { event: [low, high], .. }) => vec![("event, below", *low), ("event, above", *high)],
        Found::Force(force) => vec![("force", *force)],
        Found::Rest(Rest { u_tip, distance, .. }) => vec![("u(1)", *u_tip), ("distance", *distance)],
    };
    numbers.iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| (*name).to_owned()).collect()
}

/// The errors of the discrete buckling force.
fn levels(study: &BifurcationStudy, forces: &[f64]) -> Levels {
    let refinement = |&n: &usize| Refinement {
        label: format!("n = {n}"),
        parameters: vec![("elements".to_owned(), n as f64)],
        step: 1.0 / n as f64,
    };
    Levels {
        axis: Axis::Space,
        refinements: study.meshes.iter().map(refinement).collect(),
        columns: vec![ErrorColumn {
            name: "buckling force of P1 elements".to_owned(),
            errors: forces.iter().map(|force| Some((force - BUCKLING).abs())).collect(),
            claim: Some(Claim { order: 2.0, tolerance: study.tolerance }),
            look: 0,
        }],
    }
}

/// The discrete buckling force for vanishing mesh width, from the last two meshes.
pub(super) fn extrapolated(study: &BifurcationStudy, forces: &[f64]) -> f64 {
    let (&[.., coarse, fine], &[.., before, last]) = (study.meshes.as_slice(), forces) else { return f64::NAN };
    last + (last - before) / ((fine as f64 / coarse as f64).powi(2) - 1.0)
}

fn discrete_limit(study: &BifurcationStudy, forces: &[f64]) -> Check {
    let limit = extrapolated(study, forces);
    Check::that(
        (limit - BUCKLING).abs() <= LIMIT,
        "P1 elements buckle at -(π²/4)/(1 + π²/4) as the mesh is refined, to 1e-8",
        format!("extrapolated -{limit:.10} for -{BUCKLING:.10}"),
    )
}

fn ends_are_stable(study: &BifurcationStudy, scene: &Scene, rests: &[Option<&Rest>]) -> Check {
    let distance = |rest: &Option<&Rest>| rest.map_or(f64::NAN, |rest| rest.distance);
    let is_stable = |rest: &Rest| rest.state.is_some_and(|state| state.stable);
    let arrived = |rest: &Option<&Rest>| rest.is_some_and(|rest| is_stable(rest) && rest.distance <= study.distance);
    let farthest = rests.iter().map(distance).fold(0.0, max_or_nan);
    let off = study.betas.iter().zip(rests).filter(|(_, rest)| !arrived(rest)).map(|(beta, _)| beta.to_string());
    let off: Vec<String> = off.collect();
    let list = if off.is_empty() { "none".to_owned() } else { off.join(", ") };
    Check::that(
        !rests.is_empty() && off.is_empty(),
        format!("θ_A = {}: every moving beam comes to rest on a stable branch", scene.beam.theta_a),
        format!("{} runs, at most {farthest:.1e} from an exact state; not on a stable branch: {list}", rests.len()),
    )
}

fn bent_below(study: &BifurcationStudy, rests: &[Option<&Rest>]) -> Check {
    let tip = |rest: &Option<&Rest>| rest.map_or(f64::NAN, |rest| rest.u_tip.abs());
    let tips = || study.betas.iter().zip(rests).map(|(beta, rest)| (*beta, tip(rest)));
    let as_expected = |(beta, tip): (f64, f64)| if beta < -BUCKLING { tip > STRAIGHT } else { tip <= STRAIGHT };
    let bent = tips().filter(|(_, tip)| *tip > STRAIGHT).map(|(beta, _)| beta).fold(f64::NEG_INFINITY, f64::max);
    let straight = tips().filter(|(_, tip)| *tip <= STRAIGHT).map(|(beta, _)| beta).fold(f64::INFINITY, f64::min);
    Check::that(
        bent < straight && tips().all(as_expected),
        "θ_A = 0: moving beams come to rest bent below β = -0.7116 and straight above",
        format!("bent up to β = {bent}, straight from β = {straight}"),
    )
}

fn unambiguous(scene: &Scene, diagram: &Diagram) -> Check {
    let Diagram { ambiguous, branches, .. } = diagram;
    Check::that(
        *ambiguous == 0 && !branches.is_empty(),
        format!(
            "θ_A = {}: contact, side and number of unstable directions tell all branches apart",
            scene.beam.theta_a
        ),
        format!("{ambiguous} states could belong to two branches"),
    )
}

fn buckles(diagram: &Diagram) -> Check {
    let [low, high] = diagram.event;
    // The bracket's ends are found by counting, the number by analysis.
    let holds = low <= -BUCKLING + BRACKET && -BUCKLING <= high + BRACKET && high - low <= BRACKET;
    Check::that(
        holds,
        "θ_A = 0: the straight beam is the only steady state down to β = -(π²/4)/(1 + π²/4), and not below",
        format!("several states up to {low:.10}, one from {high:.10}, for {:.10}", -BUCKLING),
    )
}

fn lifts_off(diagram: &Diagram) -> Check {
    let [low, high] = diagram.event;
    Check::that(
        high - low <= BRACKET,
        "the heated beam leaves the upper obstacle at one β, and is free above",
        format!("between {low:.9} and {high:.9}"),
    )
}

fn one_state(scene: &Scene, diagram: &Diagram) -> Check {
    let counts = &diagram.counts;
    let several: Vec<String> = counts.iter().filter(|(_, n)| *n != 1).map(|(beta, _)| beta.to_string()).collect();
    let list = if several.is_empty() { "none".to_owned() } else { several.join(", ") };
    let claim =
        format!("θ_A = {}: one steady state for every β of the diagram, even beyond buckling", scene.beam.theta_a);
    let evidence = format!("{} values of β, with another number of states: {list}", counts.len());
    Check::that(!counts.is_empty() && several.is_empty(), claim, evidence)
}
