//! Orders in ε, claims about both solvers, tables, and the numbers that the baseline guards.

mod figures;

use convergence_judge::text::number::rate_text;

use super::{RigidObstacles, RunOf, ShownImpact, peak_penetration};
use crate::kinds::prelude::*;
use crate::kinds::{
    runs::{
        Findings, Listing, Results, Row,
        checks::{Condition, all, at_most, largest_difference, within},
    },
    settings::ItemMethod,
};
use convergence_study::{
    Coverage, Refinement,
    internal::study::over_levels::{ErrorColumn, Levels},
};

/// Contraction above which a time step averages over the whole impact, so that the penetration is
/// of order 1.
const AVERAGED: f64 = 5.0;

/// Compliance below which an obstacle is stiff: the layer of an impact is then short compared with
/// the beam.
const STIFF: f64 = 1e-3;

/// Contraction above which the fixed point may need more iterations than allowed.
const SLOW: f64 = 0.8;

/// Contraction below which a step takes too few iterations to show it.
const MEASURABLE: f64 = 0.01;

/// A rate, and the name of its curve.
const LARGEST: &str = "largest penetration, fixed h and dt";

/// The runs with one compliance.
struct Compliance<'r> {
    epsilon: f64,
    bouncing: &'r ShownImpact,
    fixed_point: &'r ShownImpact,
    rest: &'r ShownImpact,
    impact: &'r ShownImpact,
    /// Largest distance over time between the free ends of the bouncing beam and of the beam with
    /// rigid obstacles.
    distance: f64,
}

/// The largest distance between the free ends over time; NaN for different levels.
fn distance(one: &ShownImpact, other: &ShownImpact) -> f64 {
    let [one, other] =
        [one, other].map(|run| run.tip.iter().map(|(_, u)| *u).collect::<Vec<f64>>());
    largest_difference(&one, &other)
}

impl<'r> Compliance<'r> {
    fn new(epsilon: f64, results: &Results<'r, RigidObstacles>, limit: &ShownImpact) -> Self {
        let [bouncing, fixed_point, rest, impact] =
            RunOf::OF_EACH_COMPLIANCE.map(|run| results.of(&(epsilon, run)));
        Self {
            epsilon,
            bouncing,
            fixed_point,
            rest,
            impact,
            distance: distance(bouncing, limit),
        }
    }

    fn label(&self) -> String {
        format!("ε = {:.1e}", self.epsilon)
    }

    fn alpha(&self) -> f64 {
        self.fixed_point.alpha.unwrap_or(f64::NAN)
    }

    fn contraction(&self) -> f64 {
        self.fixed_point.contraction.unwrap_or(f64::NAN)
    }

    /// Whether the fixed point fails at a step.
    fn fails(&self) -> bool {
        self.fixed_point.failed_at.is_some()
    }

    /// Whether a time step averages over the impact. The predicted α tells; NaN must not drop a
    /// level.
    fn is_averaged(&self) -> bool {
        !(self.alpha() < AVERAGED)
    }

    fn is_stiff(&self) -> bool {
        self.epsilon <= STIFF
    }

    /// Why the factor of the fixed point is not compared with α; `None` if it is.
    fn factor_left_out(&self) -> Option<&'static str> {
        match self.alpha() {
            alpha if alpha < MEASURABLE => Some("too few iterations to show a factor"),
            alpha if alpha >= SLOW => Some("α near 1 or above"),
            _ => None,
        }
    }

    /// Penetrations and forces.
    fn forces(&self) -> Vec<Reading> {
        let bouncing = "bouncing: largest penetration";
        let impact = "impact, resolved: peak penetration";
        vec![
            self.penetration(bouncing, self.bouncing, "largest penetration"),
            force("largest force", self.bouncing),
            Reading::new("distance to the rigid limit", self.distance).scientific(4),
            self.penetration("at rest: penetration", self.rest, "penetration at rest"),
            force("force", self.rest),
            self.penetration(impact, self.impact, "peak penetration"),
            force("peak force", self.impact),
        ]
    }

    /// * `name`: that of the guarded number.
    fn penetration(&self, head: &str, run: &ShownImpact, name: &str) -> Reading {
        Reading::new(head, run.penetration)
            .scientific(4)
            .guarded(format!("{name}, {}", self.label()), 1e-6)
            .about(Subject::of(name).at(self.label()))
    }

    fn solvers(&self) -> Vec<Reading> {
        let newton = self.bouncing;
        let fixed_point = self.fixed_point;
        let ended = fixed_point
            .failed_at
            .map_or("converges".to_owned(), |t| format!("fails at t = {t:.3}"));
        vec![
            Reading::new("Newton's iterations", newton.mean_iterations).fixed(3),
            Reading::new("most in a step", newton.most_iterations as f64).fixed(0),
            Reading::new("fixed point's iterations", fixed_point.mean_iterations).fixed(2),
            Reading::new("α", fixed_point.alpha).fixed(4),
            Reading::new("contraction", fixed_point.contraction).fixed(4),
            Reading::text("fixed point", ended),
        ]
    }
}

fn force(head: &str, run: &ShownImpact) -> Reading {
    Reading::new(head, run.force).scientific(4)
}

pub(super) fn judge(study: &RigidObstacles, results: &Results<'_, RigidObstacles>) -> Findings {
    let limit = results.of(&(study.limit, RunOf::RigidLimit));
    let compliances: Vec<Compliance<'_>> = study
        .epsilons
        .iter()
        .map(|&epsilon| Compliance::new(epsilon, results, limit))
        .collect();
    let rates = rates(study, &compliances);
    let observed: Vec<String> = rates
        .iter()
        .map(|named| format!("{} {}", named.name, rate_text(named.rate.fitted)))
        .collect();
    let forces = rows(&compliances, Compliance::forces);
    let solvers = rows(&compliances, Compliance::solvers);
    let title = "Penetrations and forces as the obstacles become rigid";
    Findings {
        summary: format!("orders in ε: {}", observed.join("; ")),
        rates,
        checks: vec![
            peak_as_predicted(study, compliances.last()),
            newton_does_not_depend_on_epsilon(study, &compliances, limit),
            fixed_point_fails_at_one(&compliances),
            contraction_as_predicted(&compliances),
        ],
        listings: vec![
            Listing::of(title, &["ε"], forces),
            Listing::of("Solvers of the bouncing beam", &["ε"], solvers),
        ],
        figures: vec![
            figures::penetrations(&compliances),
            figures::tip(study, &compliances, limit),
            figures::contractions(&compliances),
        ],
        coverage: coverage(&compliances),
        ..Findings::default()
    }
}

/// The rows of a table, one for each compliance.
fn rows<'r>(
    compliances: &[Compliance<'r>],
    readings: fn(&Compliance<'r>) -> Vec<Reading>,
) -> Vec<Row> {
    compliances
        .iter()
        .map(|compliance| {
            (
                vec![format!("{:.1e}", compliance.epsilon)],
                readings(compliance),
            )
        })
        .collect()
}

/// The four orders in ε.
fn rates(study: &RigidObstacles, compliances: &[Compliance<'_>]) -> Vec<NamedRate> {
    let averaged: Vec<_> = compliances
        .iter()
        .filter(|compliance| compliance.is_averaged())
        .collect();
    let stiff: Vec<_> = compliances
        .iter()
        .filter(|compliance| compliance.is_stiff())
        .collect();
    let linear = Claim::new(1.0, study.tolerance);
    let resolved = Claim::new(2.0 / 3.0, study.tolerance);
    let distance = "distance to the rigid limit, fixed h and dt";
    let peak = "peak penetration of an impact, resolved";
    [
        rate(&averaged, LARGEST, linear, |compliance| {
            compliance.bouncing.penetration
        }),
        rate(&averaged, distance, linear, |compliance| {
            Some(compliance.distance)
        }),
        rate(&stiff, "penetration at rest", linear, |compliance| {
            compliance.rest.penetration
        }),
        rate(&stiff, peak, resolved, |compliance| {
            compliance.impact.penetration
        }),
    ]
    .concat()
}

/// The rate of an error over the compliances in the range of its order.
fn rate(
    range: &[&Compliance<'_>],
    name: &str,
    claim: Claim,
    error: fn(&Compliance<'_>) -> Option<f64>,
) -> Vec<NamedRate> {
    let errors = range.iter().map(|compliance| error(compliance));
    let levels = range
        .iter()
        .map(|compliance| Refinement::new(compliance.label(), &[], compliance.epsilon));
    // The axis is that of a figure which this study does not draw.
    Levels::new(Axis::Both, levels, [ErrorColumn::new(name, claim, errors)]).judge()
}

fn peak_as_predicted(study: &RigidObstacles, last: Option<&Compliance<'_>>) -> Check {
    let exact = peak_penetration();
    let epsilon = last.map_or(f64::NAN, |compliance| compliance.epsilon);
    let impact = last.map(|compliance| compliance.impact);
    let [penetration, velocity] = [
        impact.and_then(|impact| impact.penetration),
        impact.and_then(|impact| impact.velocity),
    ]
    .map(|number| number.unwrap_or(f64::NAN));
    let measured = penetration / (velocity * study.impact_time(epsilon));
    let evidence = format!("{measured:.5} for {exact:.5} at ε = {epsilon:.0e}");
    all(
        "the peak penetration of an impact is 0.858 v (ε √ζ)^(2/3), to half a per cent",
        Subject::of("peak penetration"),
        [within(measured / exact, 1.0, 5e-3, evidence)],
    )
}

fn newton_does_not_depend_on_epsilon(
    study: &RigidObstacles,
    compliances: &[Compliance<'_>],
    limit: &ShownImpact,
) -> Check {
    let bouncing: Vec<&ShownImpact> = compliances
        .iter()
        .map(|compliance| compliance.bouncing)
        .chain([limit])
        .collect();
    let means = bouncing
        .iter()
        .map(|run| run.mean_iterations.unwrap_or(f64::NAN));
    let softest = means.clone().next().unwrap_or(f64::NAN);
    let most = bouncing.iter().map(|run| run.most_iterations);
    let allowed = most.clone().next().unwrap_or(0) + 2;
    let most = most.max().unwrap_or(0);
    let evidence = format!(
        "mean from {softest:.3} at the softest to {:.3} at the stiffest, ε = {:.0e}",
        limit.mean_iterations.unwrap_or(f64::NAN),
        study.limit
    );
    all(
        "Newton's iterations do not grow as the obstacles become rigid",
        Subject::of("Newton's iterations"),
        [
            at_most(
                means.fold(f64::NEG_INFINITY, max_or_nan),
                1.1 * softest,
                evidence,
            ),
            Condition::that(most <= allowed, format!("most in a step: {most}")),
        ],
    )
}

fn fixed_point_fails_at_one(compliances: &[Compliance<'_>]) -> Check {
    let (failed, converged): (Vec<_>, Vec<_>) = compliances
        .iter()
        .partition(|compliance| compliance.fails());
    // Between SLOW and 1 either is allowed; NaN is neither.
    let holds = converged.iter().all(|compliance| compliance.alpha() <= 1.0)
        && failed.iter().all(|compliance| compliance.alpha() >= SLOW);
    Check::that(
        holds && !converged.is_empty() && !failed.is_empty(),
        "the fixed point converges while α < 1 and fails beyond; Newton's method does every step",
        format!(
            "last that converges: {}, first that fails: {}",
            label_with_alpha(converged.last()),
            label_with_alpha(failed.first())
        ),
    )
    .about(Subject::of("convergence of the fixed point").by(ItemMethod::FixedPoint))
}

/// A compliance and its predicted factor, in words.
fn label_with_alpha(compliance: Option<&&Compliance<'_>>) -> String {
    match compliance {
        Some(compliance) => format!("{} (α = {:.3})", compliance.label(), compliance.alpha()),
        None => "none".to_owned(),
    }
}

fn contraction_as_predicted(compliances: &[Compliance<'_>]) -> Check {
    let judged = compliances
        .iter()
        .filter(|compliance| compliance.factor_left_out().is_none());
    let deviations: Vec<f64> = judged
        .map(|compliance| (compliance.contraction() / compliance.alpha() - 1.0).abs())
        .collect();
    let worst = largest_of(deviations.iter().copied());
    let farthest = worst.map_or("no ratio".to_owned(), |worst| {
        format!("the farthest ratio {worst:.1e} from 1")
    });
    Check::that(
        worst.is_some_and(|worst| worst <= 0.1),
        "in contact the fixed point contracts by α = (dt/ε) [A_u⁻¹]_nn, to a tenth",
        format!(
            "{} compliances with α between {MEASURABLE} and {SLOW}, {farthest}",
            deviations.len()
        ),
    )
    .about(Subject::of("contraction").by(ItemMethod::FixedPoint))
}

/// The compliances that each statement judges; the orders have ranges of their own.
fn coverage(compliances: &[Compliance<'_>]) -> Vec<Coverage> {
    let mut unresolved = vec![];
    let mut stiff = vec![];
    let mut iterated = vec![];
    let mut factors = vec![];
    for compliance in compliances {
        unresolved.push((!compliance.is_averaged()).then_some("a time step resolves the impact"));
        stiff.push((!compliance.is_stiff()).then_some("too soft"));
        let is_near_one = (SLOW..=1.0).contains(&compliance.alpha());
        iterated.push(is_near_one.then_some("α just below 1"));
        factors.push(compliance.factor_left_out());
    }
    vec![
        Coverage::of("compliances on a fixed grid for an order", unresolved),
        Coverage::of("compliances at rest and in an impact for an order", stiff),
        Coverage::of("compliances for the end of convergence", iterated),
        Coverage::of("compliances for the factor α", factors),
    ]
}
