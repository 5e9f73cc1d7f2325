//! Orders in ε, claims about both solvers, and what the baseline guards.

use convergence_study::judge::fit::Level;
use convergence_study::judge::verdict::RateVerdict;
use convergence_study::study::levels::completion;
use convergence_study::study::{Check, Outcome, Quantity, Ran};
use convergence_study::text::number::{max_or_nan, rate_text};
use thermobeam::parameters::Obstacles;

use super::theory::peak_penetration;
use super::{Bouncing, FixedPointRun, Found, Impact, Rest, RigidStudy, RunOf, Task, report};

/// Contraction above which a time step averages over the whole impact, which makes the penetration of order 1.
const AVERAGED: f64 = 5.0;

/// Compliance below which an obstacle is stiff: the layer of an impact is then short compared with the beam.
const STIFF: f64 = 1e-3;

/// Contraction from which on the fixed point may need more iterations than allowed.
const SLOW: f64 = 0.8;

/// Names of the rates.
pub(super) const LARGEST: &str = "largest penetration, fixed h and dt";
const DISTANCE: &str = "distance to the rigid limit, fixed h and dt";
const RESTING: &str = "penetration at rest";
const IMPACT: &str = "peak penetration of an impact, resolved";

/// The results of one compliance; `None` where the case failed.
#[derive(Default)]
pub(super) struct Compliance<'r> {
    pub(super) epsilon: f64,
    pub(super) bouncing: Option<&'r Bouncing>,
    pub(super) fixed_point: Option<&'r FixedPointRun>,
    pub(super) rest: Option<&'r Rest>,
    pub(super) impact: Option<&'r Impact>,
}

/// All results, by compliance in descending order.
pub(super) struct Results<'r> {
    pub(super) limit: Option<&'r Bouncing>,
    pub(super) by_compliance: Vec<Compliance<'r>>,
}

impl<'r> Results<'r> {
    fn new(study: &RigidStudy, ran: &'r [Ran<Task, Found>]) -> Self {
        let compliance = |&epsilon: &f64| Compliance { epsilon, ..Compliance::default() };
        let mut results = Self { limit: None, by_compliance: study.epsilons.iter().map(compliance).collect() };
        for Ran { case, found } in ran {
            let Task { epsilon, run } = case.data;
            let of_compliance = results.by_compliance.iter_mut().find(|compliance| compliance.epsilon == epsilon);
            match (found, of_compliance) {
                (Ok(Found::Bouncing(found)), _) if run == RunOf::RigidLimit => results.limit = Some(found),
                (Ok(Found::Bouncing(found)), Some(place)) => place.bouncing = Some(found),
                (Ok(Found::FixedPoint(found)), Some(place)) => place.fixed_point = Some(found),
                (Ok(Found::Rest(found)), Some(place)) => place.rest = Some(found),
                (Ok(Found::Impact(found)), Some(place)) => place.impact = Some(found),
                _ => {}
            }
        }
        results
    }

    /// Largest distance over time between the free end of a bouncing beam and that with rigid obstacles.
    pub(super) fn distance_to_limit(&self, of: &Compliance<'_>) -> f64 {
        match (of.bouncing, self.limit) {
            (Some(Bouncing { tip, .. }), Some(limit)) if tip.len() == limit.tip.len() => {
                tip.iter().zip(&limit.tip).map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, max_or_nan)
            }
            _ => f64::NAN,
        }
    }
}

impl Compliance<'_> {
    pub(super) fn largest_penetration(&self) -> f64 {
        self.bouncing.map_or(f64::NAN, |found| found.penetration)
    }

    pub(super) fn resting_penetration(&self) -> f64 {
        self.rest.map_or(f64::NAN, |found| found.penetration)
    }

    pub(super) fn peak_penetration(&self) -> f64 {
        self.impact.map_or(f64::NAN, |found| found.penetration)
    }

    pub(super) fn alpha(&self) -> f64 {
        self.fixed_point.map_or(f64::NAN, |found| found.alpha)
    }
}

pub(super) fn judge(study: &RigidStudy, ran: &[Ran<Task, Found>]) -> Outcome {
    let results = Results::new(study, ran);
    let rates = rates(study, &results);
    let observed: Vec<String> = rates.iter().map(|(name, rate)| format!("{name} {}", rate_text(rate.fitted))).collect();
    let checks = vec![
        completion(ran, not_finite),
        peak_as_predicted(study, &results),
        newton_does_not_depend_on_epsilon(study, &results),
        fixed_point_fails_at_one(&results),
        contraction_as_predicted(&results),
    ];
    Outcome {
        tables: report::tables(&results),
        figures: report::figures(study, &results),
        quantities: quantities(&results),
        ..Outcome::new(format!("orders in ε: {}", observed.join("; ")), rates, checks)
    }
}

fn not_finite(found: &Found) -> Vec<String> {
    let numbers = match found {
        Found::Bouncing(Bouncing { force, penetration, mean_iterations, tip, .. }) => {
            let largest = tip.iter().map(|(t, u)| t.abs() + u.abs()).fold(0.0, max_or_nan);
            vec![("force", *force), ("penetration", *penetration), ("iterations", *mean_iterations), ("tip", largest)]
        }
        Found::FixedPoint(FixedPointRun { alpha, contraction, mean_iterations, failed_at }) => vec![
            ("alpha", *alpha),
            ("contraction", contraction.unwrap_or(0.0)),
            ("iterations", *mean_iterations),
            ("time of failure", failed_at.unwrap_or(0.0)),
        ],
        Found::Rest(Rest { force, penetration }) => vec![("force", *force), ("penetration", *penetration)],
        Found::Impact(Impact { velocity, force, penetration }) => {
            vec![("velocity", *velocity), ("force", *force), ("penetration", *penetration)]
        }
    };
    numbers.into_iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| name.to_owned()).collect()
}

/// The four orders in ε.
fn rates(study: &RigidStudy, results: &Results<'_>) -> Vec<(String, RateVerdict)> {
    // The predicted α tells whether dt resolves the impact; NaN, where a case failed, must not drop a level.
    let averaged = |of: &Compliance<'_>| !(of.alpha() < AVERAGED);
    let stiff = |of: &Compliance<'_>| of.epsilon <= STIFF;
    // Penetrations are ε times a force: they have digits, not a floor.
    let judge = study.judge.clone().with_floor(0.0).unwrap_or_else(|_| study.judge.clone());
    let rate =
        |name: &str, order, belongs: &dyn Fn(&Compliance<'_>) -> bool, error: &dyn Fn(&Compliance<'_>) -> f64| {
            let levels = results.by_compliance.iter().filter(|of| belongs(of));
            let levels: Vec<Level> = levels.map(|of| Level { step: of.epsilon, error: error(of) }).collect();
            (name.to_owned(), judge.judge(&levels, order))
        };
    vec![
        rate(LARGEST, 1.0, &averaged, &|of| of.largest_penetration()),
        rate(DISTANCE, 1.0, &averaged, &|of| results.distance_to_limit(of)),
        rate(RESTING, 1.0, &stiff, &|of| of.resting_penetration()),
        rate(IMPACT, 2.0 / 3.0, &stiff, &|of| of.peak_penetration()),
    ]
}

fn peak_as_predicted(study: &RigidStudy, results: &Results<'_>) -> Check {
    let exact = peak_penetration();
    let (epsilon, impact) = results.by_compliance.last().map_or((f64::NAN, None), |of| (of.epsilon, of.impact));
    let time = Obstacles { epsilon, ..Obstacles::default() }.impact_time(study.impact.beam.zeta);
    let measured = impact.map_or(f64::NAN, |found| found.penetration / (found.velocity * time));
    Check::that(
        (measured / exact - 1.0).abs() <= 5e-3,
        "the peak penetration of an impact is 0.858 v (ε √ζ)^(2/3), to half a per cent",
        format!("{measured:.5} for {exact:.5} at ε = {epsilon:.0e}"),
    )
}

fn newton_does_not_depend_on_epsilon(study: &RigidStudy, results: &Results<'_>) -> Check {
    let bouncing: Vec<&Bouncing> =
        results.by_compliance.iter().filter_map(|of| of.bouncing).chain(results.limit).collect();
    let complete = bouncing.len() == study.epsilons.len() + 1;
    let (Some(softest), Some(limit)) = (bouncing.first(), results.limit) else {
        return Check::that(false, NEWTON, "no bouncing beam was run to its end");
    };
    let holds = |found: &&Bouncing| {
        found.mean_iterations <= 1.1 * softest.mean_iterations && found.most_iterations <= softest.most_iterations + 2
    };
    let most = bouncing.iter().map(|found| found.most_iterations).max();
    let evidence = format!(
        "mean from {:.3} at the softest to {:.3} at the stiffest, ε = {:.0e}; most in a step: {}",
        softest.mean_iterations,
        limit.mean_iterations,
        study.limit,
        most.unwrap_or(0)
    );
    Check::that(complete && bouncing.iter().all(holds), NEWTON, evidence)
}

const NEWTON: &str = "Newton's iterations do not grow as the obstacles become rigid";

fn fixed_point_fails_at_one(results: &Results<'_>) -> Check {
    let runs = || results.by_compliance.iter().filter_map(|of| Some((of.epsilon, of.fixed_point?)));
    let as_predicted = |(_, run): (f64, &FixedPointRun)| match run.alpha {
        alpha if alpha < SLOW => run.failed_at.is_none(),
        alpha if alpha > 1.0 => run.failed_at.is_some(),
        // Between the two it may do either; NaN is neither.
        alpha => alpha.is_finite(),
    };
    let last = runs().rfind(|(_, run)| run.failed_at.is_none());
    let first = runs().find(|(_, run)| run.failed_at.is_some());
    let name = |run: Option<(f64, &FixedPointRun)>| {
        run.map_or("none".to_owned(), |(epsilon, run)| format!("ε = {epsilon:.1e} (α = {:.3})", run.alpha))
    };
    Check::that(
        runs().all(as_predicted) && last.is_some() && first.is_some(),
        "the fixed point converges while α < 1 and fails beyond; Newton's method does every step",
        format!("last that converges: {}, first that fails: {}", name(last), name(first)),
    )
}

fn contraction_as_predicted(results: &Results<'_>) -> Check {
    let runs = results.by_compliance.iter().filter_map(|of| of.fixed_point);
    let runs = runs.filter(|run| (0.01..SLOW).contains(&run.alpha));
    let ratios: Vec<f64> = runs.map(|run| run.contraction.unwrap_or(f64::NAN) / run.alpha).collect();
    let worst = ratios.iter().map(|ratio| (ratio - 1.0).abs()).fold(0.0, max_or_nan);
    Check::that(
        !ratios.is_empty() && worst <= 0.1,
        "in contact the fixed point contracts by α = (dt/ε) [A_u⁻¹]_nn, to a tenth",
        format!("{} compliances with α between 0.01 and {SLOW}, the farthest ratio {worst:.1e} from 1", ratios.len()),
    )
}

fn quantities(results: &Results<'_>) -> Vec<Quantity> {
    let guard = |name: &str, number: fn(&Compliance<'_>) -> f64| {
        let quantity = |of: &Compliance<'_>| Quantity {
            name: format!("{name}, ε = {:.1e}", of.epsilon),
            value: number(of),
            tolerance: 1e-6,
        };
        results.by_compliance.iter().map(quantity).collect::<Vec<_>>()
    };
    [
        guard("largest penetration", |of| of.largest_penetration()),
        guard("penetration at rest", |of| of.resting_penetration()),
        guard("peak penetration", |of| of.peak_penetration()),
    ]
    .concat()
}
