//! Orders and claims.

use super::theory::{impact_time, peak_penetration};
use super::{Found, RigidStudy};
use crate::kinds::untyped::Measured;
use convergence_study::judge::fit::Level;
use convergence_study::judge::verdict::RateVerdict;
use convergence_study::study::outcome::Check;
use convergence_study::text::number::max_or_nan;

/// Contraction above which a time step averages over the whole impact, which makes the penetration of order 1.
const AVERAGED: f64 = 5.0;

/// Compliance below which an obstacle is stiff: the layer of an impact is then short compared with the beam.
const STIFF: f64 = 1e-3;

/// Names of the rates.
pub(super) const LARGEST: &str = "largest penetration, fixed h and dt";
const DISTANCE: &str = "distance to the rigid limit, fixed h and dt";
const RESTING: &str = "penetration at rest";
const IMPACT: &str = "peak penetration of an impact, resolved";

/// The four orders in ε.
pub(super) fn rates(study: &RigidStudy, found: &Found<'_>) -> Vec<(String, RateVerdict)> {
    // Whether dt resolves the impact is told by the predicted α; NaN, where a case failed, must not drop a level.
    let averaged = |k: usize, _| !(found.fixed_point[k].value("alpha") < AVERAGED);
    let stiff = |_, epsilon: f64| epsilon <= STIFF;
    let rate = |errors: Vec<f64>, order: f64, belongs: &dyn Fn(usize, f64) -> bool| {
        let levels = study.epsilons.iter().zip(errors).enumerate().filter(|(k, (epsilon, _))| belongs(*k, **epsilon));
        let levels: Vec<Level> = levels.map(|(_, (&step, error))| Level { step, error }).collect();
        // Penetrations are ε times a force: they have digits, not a floor.
        let judge = study.judge.clone().with_floor(0.0).unwrap_or_else(|_| study.judge.clone());
        judge.judge(&levels, order)
    };
    let distances = found.moving.iter().map(|m| found.distance_to_limit(m)).collect();
    vec![
        (LARGEST.to_owned(), rate(numbers(found.moving, "penetration"), 1.0, &averaged)),
        (DISTANCE.to_owned(), rate(distances, 1.0, &averaged)),
        (RESTING.to_owned(), rate(numbers(found.rest, "penetration"), 1.0, &stiff)),
        (IMPACT.to_owned(), rate(numbers(found.impact, "penetration"), 2.0 / 3.0, &stiff)),
    ]
}

pub(super) fn numbers(all: &[Measured], name: &str) -> Vec<f64> {
    all.iter().map(|m| m.value(name)).collect()
}

/// All checks that are no rates.
pub(super) fn judge(study: &RigidStudy, found: &Found<'_>) -> Vec<Check> {
    vec![
        peak_as_predicted(study, found),
        newton_does_not_notice(study, found),
        fixed_point_fails_at_one(study, found),
        contraction_as_predicted(study, found),
    ]
}

fn peak_as_predicted(study: &RigidStudy, found: &Found<'_>) -> Check {
    let exact = peak_penetration();
    let epsilon = study.epsilons.last().copied().unwrap_or(f64::NAN);
    let measured = found.impact.last().map_or(f64::NAN, |m| {
        m.value("penetration") / (m.value("velocity") * impact_time(epsilon, study.impact.beam.zeta))
    });
    Check::that(
        (measured / exact - 1.0).abs() <= 5e-3,
        "the peak penetration of an impact is 0.858 v (ε √ζ)^(2/3), to half a per cent",
        format!("{measured:.5} for {exact:.5} at ε = {epsilon:.0e}"),
    )
}

fn newton_does_not_notice(study: &RigidStudy, found: &Found<'_>) -> Check {
    let (mean, most) = (numbers(found.moving, "iterations"), numbers(found.moving, "most_iterations"));
    let soft = mean.first().copied().unwrap_or(f64::NAN);
    let stiffest = found.limit.value("iterations");
    // There are at least three compliances.
    let holds = mean.iter().chain([&stiffest]).all(|mean| *mean <= 1.1 * soft)
        && most.iter().all(|count| *count <= most[0] + 2.0);
    Check::that(
        holds,
        "Newton's iterations do not grow as the obstacles become rigid",
        format!(
            "mean from {soft:.3} at ε = {:.0e} to {:.3} at ε = {:.0e} and {stiffest:.3} at {:.0e}; most in a step: {}",
            study.epsilons.first().unwrap_or(&f64::NAN),
            mean.last().unwrap_or(&f64::NAN),
            study.epsilons.last().unwrap_or(&f64::NAN),
            study.limit,
            most.iter().copied().fold(0.0, max_or_nan)
        ),
    )
}

/// Contraction from which on a fixed point may need more iterations than anyone allows.
const SLOW: f64 = 0.8;

fn fixed_point_fails_at_one(study: &RigidStudy, found: &Found<'_>) -> Check {
    let runs =
        || study.epsilons.iter().zip(found.fixed_point).map(|(e, m)| (*e, m.value("alpha"), m.value("converged")));
    let as_predicted = |(_, alpha, converged): (f64, f64, f64)| match alpha {
        alpha if alpha < SLOW => converged == 1.0,
        alpha if alpha > 1.0 => converged == 0.0,
        // Between the two it may do either; NaN is neither.
        alpha => alpha.is_finite() && converged.is_finite(),
    };
    let converges = |converged: f64| runs().filter(move |run| run.2 == converged);
    let last = converges(1.0).next_back();
    let first = converges(0.0).next();
    let name = |run: Option<(f64, f64, f64)>| {
        run.map_or("none".to_owned(), |(e, alpha, _)| format!("ε = {e:.1e} (α = {alpha:.3})"))
    };
    Check::that(
        runs().all(as_predicted) && last.is_some() && first.is_some(),
        "the fixed point converges while α < 1 and fails beyond; Newton's method does every step",
        format!("last that converges: {}, first that fails: {}", name(last), name(first)),
    )
}

fn contraction_as_predicted(study: &RigidStudy, found: &Found<'_>) -> Check {
    let slow_enough = |alpha: f64| (0.01..SLOW).contains(&alpha);
    let runs = study.epsilons.iter().zip(found.fixed_point).filter(|(_, m)| slow_enough(m.value("alpha")));
    let ratios: Vec<f64> = runs.map(|(_, m)| m.value("contraction") / m.value("alpha")).collect();
    let worst = ratios.iter().map(|ratio| (ratio - 1.0).abs()).fold(0.0, max_or_nan);
    Check::that(
        !ratios.is_empty() && worst <= 0.1,
        "in contact the fixed point contracts by α = (dt/ε) [A_u⁻¹]_nn, to a tenth",
        format!("{} compliances with α between 0.01 and {SLOW}, the farthest ratio {worst:.1e} from 1", ratios.len()),
    )
}
