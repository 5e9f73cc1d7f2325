//! Orders in ε, claims about both solvers, tables, and the numbers that the baseline guards.

use super::{EPSILONS, LIMIT, RunOf, ShownImpact, figures, impact_time, peak_penetration};
use crate::error::reference::largest_difference;
use crate::studies::prelude::*;
use convergence_judge::text::number::{min_or_nan, rate_text};
use convergence_study::{Claim, ErrorColumn, Levels, NamedRate, RefinedIn, Refinement, left_out};

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

/// Tolerance of the orders.
const TOLERANCE: f64 = 0.02;

/// A rate, and the name of its curve.
pub(super) const LARGEST: &str = "largest penetration, fixed h and dt";

/// The runs with one compliance.
pub(super) struct Compliance<'r> {
    pub(super) epsilon: f64,
    pub(super) bouncing: &'r ShownImpact,
    fixed_point: &'r ShownImpact,
    pub(super) rest: &'r ShownImpact,
    pub(super) impact: &'r ShownImpact,
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
    fn new(epsilon: f64, shown: &[(&(f64, RunOf), &'r ShownImpact)], limit: &ShownImpact) -> Self {
        let [bouncing, fixed_point, rest, impact] =
            RunOf::OF_EACH_COMPLIANCE.map(|run| of(shown, &(epsilon, run)));
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

    pub(super) fn alpha(&self) -> f64 {
        self.fixed_point.alpha.unwrap_or(f64::NAN)
    }

    pub(super) fn contraction(&self) -> f64 {
        self.fixed_point.contraction.unwrap_or(f64::NAN)
    }

    /// Whether the fixed point fails at a step.
    pub(super) fn fails(&self) -> bool {
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
    fn forces(&self) -> Vec<Measured> {
        let case = self.label();
        let number = |name: &str, value: Option<f64>| measured(&case, name, value).scientific(4);
        // * `known`: the name under which the baseline guards it.
        let penetration = |name: &str, run: &ShownImpact, known: &str| {
            number(name, run.penetration).recorded_as(format!("{known}, {case}"), 1e-6)
        };
        let bouncing = "bouncing: largest penetration";
        let impact = "impact, resolved: peak penetration";
        vec![
            penetration(bouncing, self.bouncing, "largest penetration"),
            number("largest force", self.bouncing.force),
            number("distance to the rigid limit", Some(self.distance)),
            penetration("at rest: penetration", self.rest, "penetration at rest"),
            number("force", self.rest.force),
            penetration(impact, self.impact, "peak penetration"),
            number("peak force", self.impact.force),
        ]
    }

    fn solvers(&self) -> Vec<Measured> {
        let case = self.label();
        let newton = self.bouncing;
        let fixed_point = self.fixed_point;
        let ended = fixed_point
            .failed_at
            .map_or("converges".to_owned(), |t| format!("fails at t = {t:.3}"));
        vec![
            measured(&case, "Newton's iterations", newton.mean_iterations).fixed(3),
            measured(&case, "most in a step", newton.most_iterations as f64).fixed(0),
            measured(
                &case,
                "fixed point's iterations",
                fixed_point.mean_iterations,
            )
            .fixed(2),
            measured(&case, "α", fixed_point.alpha).fixed(4),
            measured(&case, "contraction", fixed_point.contraction).fixed(4),
            measured(&case, "fixed point", fixed_point.failed_at).words(ended),
        ]
    }
}

pub(super) fn judge(shown: &[(&(f64, RunOf), &ShownImpact)]) -> Outcome {
    let limit = of(shown, &(LIMIT, RunOf::RigidLimit));
    let compliances = EPSILONS.map(|epsilon| Compliance::new(epsilon, shown, limit));
    let rates = rates(&compliances);
    let observed: Vec<String> = rates
        .iter()
        .map(|named| format!("{} {}", named.name, rate_text(named.rate.fitted)))
        .collect();
    let forces = compliances.iter().flat_map(Compliance::forces);
    let solvers = compliances.iter().flat_map(Compliance::solvers);
    let title = "Penetrations and forces as the obstacles become rigid";
    let sheets = [
        Sheet::new(title, "compliance", forces),
        Sheet::new("Solvers of the bouncing beam", "compliance", solvers),
        Sheet::new("What is claimed", "", claims(&compliances, limit)),
    ];
    let headline = format!("orders in ε: {}", observed.join("; "));
    let mut outcome = Outcome {
        figures: vec![
            figures::penetrations(&compliances),
            figures::tip(&compliances, limit),
            figures::contractions(&compliances),
        ],
        left_out: not_judged(&compliances),
        ..Outcome::of_sheets(sheets, "").headed(headline)
    };
    outcome.extend(Outcome::new("", rates, vec![]));
    outcome
}

/// The peak of an impact, and the iterations of both solvers.
fn claims(compliances: &[Compliance<'_>], limit: &ShownImpact) -> Vec<Measured> {
    let bouncing = compliances.iter().map(|compliance| compliance.bouncing);
    let bouncing: Vec<&ShownImpact> = bouncing.chain([limit]).collect();
    let means = bouncing
        .iter()
        .map(|run| run.mean_iterations.unwrap_or(f64::NAN));
    let mean = largest_of(means.clone()).zip(means.clone().next());
    let most = bouncing.iter().map(|run| run.most_iterations as f64);
    let most = largest_of(most.clone()).zip(most.clone().next());
    let (failed, converged): (Vec<_>, Vec<_>) = compliances
        .iter()
        .partition(|compliance| compliance.fails());
    let alphas = |list: &[&Compliance<'_>]| list.iter().map(|one| one.alpha()).collect::<Vec<_>>();
    let softest = alphas(&failed).into_iter().reduce(min_or_nan);
    let judged = compliances
        .iter()
        .filter(|compliance| compliance.factor_left_out().is_none());
    let deviations =
        judged.map(|compliance| (compliance.contraction() / compliance.alpha() - 1.0).abs());
    let half_a_per_cent = Must::Near {
        answer: 1.0,
        within: 5e-3,
    };
    let peak = "peak penetration of the stiffest impact over 0.858 v (ε √ζ)^(2/3)";
    let mean_name = "Newton's mean iterations over those at the softest obstacle, largest";
    let most_name = "Newton's iterations in a step beyond those at the softest obstacle, most";
    let converges = "α where the fixed point converges, largest";
    let factor = "in contact, distance of contraction/α from 1, largest";
    // Between SLOW and 1 the fixed point may converge or fail.
    vec![
        measured("", peak, compliances.last().and_then(peak_share))
            .fixed(5)
            .must_be(half_a_per_cent),
        measured(
            "",
            mean_name,
            mean.map(|(largest, softest)| largest / softest),
        )
        .fixed(3)
        .must_be(Must::AtMost(1.1)),
        measured(
            "",
            most_name,
            most.map(|(largest, softest)| largest - softest),
        )
        .fixed(0)
        .must_be(Must::AtMost(2.0)),
        measured("", converges, largest_of(alphas(&converged)))
            .fixed(3)
            .must_be(Must::AtMost(1.0)),
        measured("", "α where it fails, least", softest)
            .fixed(3)
            .must_be(Must::AtLeast(SLOW)),
        measured("", factor, largest_of(deviations)).must_be(Must::AtMost(0.1)),
    ]
}

/// The peak penetration of an impact, in units of the exact one.
fn peak_share(
    Compliance {
        epsilon, impact, ..
    }: &Compliance<'_>,
) -> Option<f64> {
    let measured = impact.penetration? / (impact.velocity? * impact_time(*epsilon));
    Some(measured / peak_penetration())
}

/// The four orders in ε.
fn rates(compliances: &[Compliance<'_>]) -> Vec<NamedRate> {
    let averaged: Vec<_> = compliances
        .iter()
        .filter(|compliance| compliance.is_averaged())
        .collect();
    let stiff: Vec<_> = compliances
        .iter()
        .filter(|compliance| compliance.is_stiff())
        .collect();
    let linear = Claim::new(1.0, TOLERANCE);
    let resolved = Claim::new(2.0 / 3.0, TOLERANCE);
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
    Levels::new(
        RefinedIn::Both,
        levels,
        [ErrorColumn::new(name, claim, errors)],
    )
    .judge()
}

/// The compliances that each statement does not judge; the orders have ranges of their own.
fn not_judged(compliances: &[Compliance<'_>]) -> Vec<String> {
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
    let all = [
        left_out("compliances on a fixed grid for an order", unresolved),
        left_out("compliances at rest and in an impact for an order", stiff),
        left_out("compliances for the end of convergence", iterated),
        left_out("compliances for the factor α", factors),
    ];
    all.into_iter().flatten().collect()
}
