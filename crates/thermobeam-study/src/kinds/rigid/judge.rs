//! Orders in ε, claims about both solvers, tables, figures, and the numbers that the baseline
//! guards.

use convergence_study::judge::fit::Level;
use convergence_study::text::number::rate_text;

use super::{RigidStudy, RunOf, ShownImpact, peak_penetration};
use crate::figures::{ContractionFactors, contraction, obstacle_lines};
use crate::kinds::prelude::*;

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

/// The runs with one compliance; `None` if the case failed.
struct Compliance<'r> {
    epsilon: f64,
    bouncing: Option<&'r ShownImpact>,
    fixed_point: Option<&'r ShownImpact>,
    rest: Option<&'r ShownImpact>,
    impact: Option<&'r ShownImpact>,
    /// Largest distance over time between the free ends of the bouncing beam and of the beam with
    /// rigid obstacles.
    distance: f64,
}

/// A number of a run; NaN if missing.
fn number(run: Option<&ShownImpact>, of: fn(&ShownImpact) -> Option<f64>) -> f64 {
    run.and_then(of).unwrap_or(f64::NAN)
}

fn penetration(run: Option<&ShownImpact>) -> f64 {
    number(run, |run| run.penetration)
}

impl<'r> Compliance<'r> {
    fn new(
        epsilon: f64,
        ran: &'r [Ran<(f64, RunOf), ShownImpact>],
        limit: Option<&ShownImpact>,
    ) -> Self {
        let of = |run: RunOf| found(ran, &(epsilon, run));
        let bouncing = of(RunOf::Bouncing);
        let distance = match (bouncing, limit) {
            (Some(ShownImpact { tip, .. }), Some(limit)) if tip.len() == limit.tip.len() => tip
                .iter()
                .zip(&limit.tip)
                .map(|(a, b)| (a.1 - b.1).abs())
                .fold(0.0, max_or_nan),
            _ => f64::NAN,
        };
        let [fixed_point, rest, impact] = [RunOf::FixedPoint, RunOf::Rest, RunOf::Impact].map(of);
        Self {
            epsilon,
            bouncing,
            fixed_point,
            rest,
            impact,
            distance,
        }
    }

    fn alpha(&self) -> f64 {
        number(self.fixed_point, |found| found.alpha)
    }

    /// Whether a time step averages over the impact. The predicted α tells; if the case failed it
    /// is NaN, which must not drop a level.
    fn is_averaged(&self) -> bool {
        !(self.alpha() < AVERAGED)
    }

    fn is_stiff(&self) -> bool {
        self.epsilon <= STIFF
    }

    /// Why the factor of the fixed point is not compared with α; `None` if it is.
    fn factor_left_out(&self) -> Option<&'static str> {
        match self.alpha() {
            alpha if alpha.is_nan() => Some(NO_RESULT),
            alpha if alpha < MEASURABLE => Some("too few iterations to show a factor"),
            alpha if alpha >= SLOW => Some("α near 1 or above"),
            _ => None,
        }
    }

    /// Penetrations and forces.
    fn forces(&self) -> Vec<Reading> {
        let guarded = |head: &str, run: Option<&ShownImpact>, name: &str| {
            let epsilon = format!("ε = {:.1e}", self.epsilon);
            Reading::new(head, penetration(run))
                .scientific(4)
                .guarded(format!("{name}, {epsilon}"), 1e-6)
                .about(Subject::of(name).at(epsilon))
        };
        let shown = |head: &str, value: f64| Reading::new(head, value).scientific(4);
        let force =
            |head: &str, run: Option<&ShownImpact>| shown(head, number(run, |run| run.force));
        vec![
            guarded(
                "bouncing: largest penetration",
                self.bouncing,
                "largest penetration",
            ),
            force("largest force", self.bouncing),
            shown("distance to the rigid limit", self.distance),
            guarded("at rest: penetration", self.rest, "penetration at rest"),
            force("force", self.rest),
            guarded(
                "impact, resolved: peak penetration",
                self.impact,
                "peak penetration",
            ),
            force("peak force", self.impact),
        ]
    }

    fn solvers(&self) -> Vec<Reading> {
        let (newton, fixed_point) = (self.bouncing, self.fixed_point);
        let ended = |run: &ShownImpact| {
            run.failed_at
                .map_or("converges".into(), |t| format!("fails at t = {t:.3}"))
        };
        vec![
            Reading::new(
                "Newton's iterations",
                newton.and_then(|found| found.mean_iterations),
            )
            .fixed(3),
            Reading::new(
                "most in a step",
                newton.map(|found| found.most_iterations as f64),
            )
            .fixed(0),
            Reading::new(
                "fixed point's iterations",
                fixed_point.and_then(|found| found.mean_iterations),
            )
            .fixed(2),
            Reading::new("α", fixed_point.and_then(|found| found.alpha)).fixed(4),
            Reading::new(
                "contraction",
                fixed_point.and_then(|found| found.contraction),
            )
            .fixed(4),
            Reading::text("fixed point", fixed_point.map_or("-".to_owned(), ended)),
        ]
    }
}

fn numbers_not_finite(found: &ShownImpact) -> Vec<String> {
    let tip = found
        .tip
        .iter()
        .map(|(t, u)| t.abs() + u.abs())
        .fold(0.0, max_or_nan);
    not_finite([
        ("velocity", found.velocity),
        ("force", found.force),
        ("penetration", found.penetration),
        ("alpha", found.alpha),
        ("contraction", found.contraction),
        ("iterations", found.mean_iterations),
        ("tip", Some(tip)),
        ("time of failure", found.failed_at),
    ])
}

pub(super) fn judge(study: &RigidStudy, ran: &[Ran<(f64, RunOf), ShownImpact>]) -> Outcome {
    let limit = found(ran, &(study.limit, RunOf::RigidLimit));
    let all: Vec<Compliance<'_>> = study
        .epsilons
        .iter()
        .map(|&epsilon| Compliance::new(epsilon, ran, limit))
        .collect();
    let rates = rates(study, &all);
    let observed: Vec<String> = rates
        .iter()
        .map(|(name, rate)| format!("{name} {}", rate_text(rate.fitted)))
        .collect();
    let checks = vec![
        completion(ran, numbers_not_finite),
        peak_as_predicted(study, all.last()),
        newton_does_not_depend_on_epsilon(study, &all, limit),
        fixed_point_fails_at_one(&all),
        contraction_as_predicted(&all),
    ];
    let rows = |readings: fn(&Compliance<'_>) -> Vec<Reading>| -> Vec<(Vec<String>, Vec<Reading>)> {
        all.iter()
            .map(|of| (vec![format!("{:.1e}", of.epsilon)], readings(of)))
            .collect()
    };
    let forces = rows(|of| of.forces());
    let title = "Penetrations and forces as the obstacles become rigid";
    Outcome {
        tables: vec![
            readings::table(title, &["ε"], &forces),
            readings::table(
                "Solvers of the bouncing beam",
                &["ε"],
                &rows(|of| of.solvers()),
            ),
        ],
        figures: figures(study, &all, limit),
        quantities: readings::guarded(forces.iter().flat_map(|(_, readings)| readings)),
        coverage: coverage(&all),
        ..Outcome::new(
            format!("orders in ε: {}", observed.join("; ")),
            rates,
            checks,
        )
    }
}

/// The four orders in ε.
fn rates(study: &RigidStudy, all: &[Compliance<'_>]) -> Vec<(String, RateVerdict)> {
    let averaged = |of: &Compliance<'_>| of.is_averaged();
    let stiff = |of: &Compliance<'_>| of.is_stiff();
    let rate = |name: &str,
                order,
                belongs: &dyn Fn(&Compliance<'_>) -> bool,
                error: fn(&Compliance<'_>) -> f64| {
        let level = |of: &Compliance<'_>| Level {
            step: of.epsilon,
            error: error(of),
        };
        let levels: Vec<Level> = all.iter().filter(|of| belongs(of)).map(level).collect();
        (name.to_owned(), study.judge.judge(&levels, order))
    };
    vec![
        rate(LARGEST, 1.0, &averaged, |of| penetration(of.bouncing)),
        rate(
            "distance to the rigid limit, fixed h and dt",
            1.0,
            &averaged,
            |of| of.distance,
        ),
        rate("penetration at rest", 1.0, &stiff, |of| {
            penetration(of.rest)
        }),
        rate(
            "peak penetration of an impact, resolved",
            2.0 / 3.0,
            &stiff,
            |of| penetration(of.impact),
        ),
    ]
}

fn peak_as_predicted(study: &RigidStudy, last: Option<&Compliance<'_>>) -> Check {
    let exact = peak_penetration();
    let (epsilon, impact) = last.map_or((f64::NAN, None), |of| (of.epsilon, of.impact));
    let time = Obstacles {
        epsilon,
        ..Obstacles::default()
    }
    .impact_time(study.impact.beam.zeta);
    let measured = penetration(impact) / (number(impact, |found| found.velocity) * time);
    Check::that(
        (measured / exact - 1.0).abs() <= 5e-3,
        "the peak penetration of an impact is 0.858 v (ε √ζ)^(2/3), to half a per cent",
        format!("{measured:.5} for {exact:.5} at ε = {epsilon:.0e}"),
    )
    .about(Subject::of("peak penetration"))
}

fn newton_does_not_depend_on_epsilon(
    study: &RigidStudy,
    all: &[Compliance<'_>],
    limit: Option<&ShownImpact>,
) -> Check {
    let claim = "Newton's iterations do not grow as the obstacles become rigid";
    let subject = Subject::of("Newton's iterations");
    let bouncing: Vec<&ShownImpact> = all
        .iter()
        .filter_map(|of| of.bouncing)
        .chain(limit)
        .collect();
    let (Some(softest), Some(limit)) = (bouncing.first(), limit) else {
        return Check::that(false, claim, "no bouncing beam was run to its end").about(subject);
    };
    let mean = |found: &ShownImpact| number(Some(found), |found| found.mean_iterations);
    let holds = |found: &&ShownImpact| {
        mean(found) <= 1.1 * mean(softest) && found.most_iterations <= softest.most_iterations + 2
    };
    let (first, last, epsilon) = (mean(softest), mean(limit), study.limit);
    let means = format!(
        "mean from {first:.3} at the softest to {last:.3} at the stiffest, ε = {epsilon:.0e}"
    );
    let most = bouncing
        .iter()
        .map(|found| found.most_iterations)
        .max()
        .unwrap_or(0);
    let evidence = format!("{means}; most in a step: {most}");
    Check::that(
        bouncing.len() == study.epsilons.len() + 1 && bouncing.iter().all(holds),
        claim,
        evidence,
    )
    .about(subject)
}

fn fixed_point_fails_at_one(all: &[Compliance<'_>]) -> Check {
    let runs = || {
        all.iter()
            .filter_map(|of| Some((of, of.fixed_point?.failed_at)))
    };
    let as_predicted = |(of, failed_at): (&Compliance<'_>, Option<f64>)| match of.alpha() {
        alpha if alpha < SLOW => failed_at.is_none(),
        alpha if alpha > 1.0 => failed_at.is_some(),
        // In between, either is allowed; NaN is neither.
        alpha => alpha.is_finite(),
    };
    let last = runs().rfind(|(_, failed_at)| failed_at.is_none());
    let first = runs().find(|(_, failed_at)| failed_at.is_some());
    let name = |run: Option<(&Compliance<'_>, _)>| {
        run.map_or("none".to_owned(), |(of, _)| {
            format!("ε = {:.1e} (α = {:.3})", of.epsilon, of.alpha())
        })
    };
    Check::that(
        runs().all(as_predicted) && last.is_some() && first.is_some(),
        "the fixed point converges while α < 1 and fails beyond; Newton's method does every step",
        format!(
            "last that converges: {}, first that fails: {}",
            name(last),
            name(first)
        ),
    )
    .about(Subject::of("convergence of the fixed point").by(ItemMethod::FixedPoint))
}

fn contraction_as_predicted(all: &[Compliance<'_>]) -> Check {
    let judged = all.iter().filter(|of| of.factor_left_out().is_none());
    let ratios: Vec<f64> = judged
        .map(|of| number(of.fixed_point, |run| run.contraction) / of.alpha())
        .collect();
    let worst = largest_of(ratios.iter().map(|ratio| (ratio - 1.0).abs()));
    let farthest = worst.map_or("no ratio".to_owned(), |worst| {
        format!("the farthest ratio {worst:.1e} from 1")
    });
    Check::that(
        worst.is_some_and(|worst| worst <= 0.1),
        "in contact the fixed point contracts by α = (dt/ε) [A_u⁻¹]_nn, to a tenth",
        format!(
            "{} compliances with α between {MEASURABLE} and {SLOW}, {farthest}",
            ratios.len()
        ),
    )
    .about(Subject::of("contraction").by(ItemMethod::FixedPoint))
}

/// The compliances that each statement judges; the orders have ranges of their own.
fn coverage(all: &[Compliance<'_>]) -> Vec<Coverage> {
    let count = |items: &str, reason: fn(&Compliance<'_>) -> Option<&'static str>| {
        Coverage::of(items, all.iter().map(reason))
    };
    vec![
        count("compliances on a fixed grid for an order", |of| {
            (!of.is_averaged()).then_some("a time step resolves the impact")
        }),
        count("compliances at rest and in an impact for an order", |of| {
            (!of.is_stiff()).then_some("too soft")
        }),
        count("compliances for the end of convergence", |of| {
            if of.fixed_point.is_none() {
                return Some(NO_RESULT);
            }
            (SLOW..=1.0)
                .contains(&of.alpha())
                .then_some("α just below 1")
        }),
        count("compliances for the factor α", |of| of.factor_left_out()),
    ]
}

/// The first figure omits the distance to the rigid limit: on its scale it coincides with the
/// largest penetration.
fn figures(study: &RigidStudy, all: &[Compliance<'_>], limit: Option<&ShownImpact>) -> Vec<Figure> {
    let of_fixed_point = |label: &str, converges: bool| {
        let runs = all.iter().filter(|of| {
            of.fixed_point
                .is_some_and(|run| run.failed_at.is_none() == converges)
        });
        plots::Series::new(
            label,
            runs.map(|of| (of.alpha(), number(of.fixed_point, |run| run.contraction))),
        )
    };
    let factors = ContractionFactors {
        title: "The fixed point contracts by α, and fails from α = 1 on".to_owned(),
        measured: vec![
            of_fixed_point("converges", true),
            of_fixed_point("fails", false),
        ],
        predicted: "predicted factor α".to_owned(),
        estimates: plots::Series::default(),
    };
    let orders = "Penetrations over ε: order 1 at rest and where a time step averages over the impact, left of α = 1; \
                  order 2/3 where it is resolved.";
    let contracts = "Contraction of the fixed point in contact, measured over predicted; right of α = 1 it fails.";
    vec![
        Figure::new("penetration", orders, penetrations(all)),
        Figure::new(
            "tip",
            "Displacement of the free end as the obstacles become rigid.",
            tip(study, all, limit),
        ),
        Figure::new("contraction", contracts, contraction(&factors)),
    ]
}

fn penetrations(all: &[Compliance<'_>]) -> String {
    let over_epsilon = |label: &str, number: fn(&Compliance<'_>) -> f64| plots::ErrorSeries {
        label: label.into(),
        points: all.iter().map(|of| (of.epsilon, number(of))).collect(),
        ..plots::ErrorSeries::default()
    };
    let resolved = all.first().map(|of| of.alpha() * of.epsilon);
    let series = [
        over_epsilon(LARGEST, |of| penetration(of.bouncing)),
        over_epsilon("peak of a resolved impact", |of| penetration(of.impact)),
        over_epsilon("at rest", |of| penetration(of.rest)),
    ];
    let xy = Xy {
        title: Some(
            "Penetration vanishes with ε: order 1, and 2/3 in a resolved impact".to_owned(),
        ),
        x: plots::Axis::log("compliance of the obstacles ε"),
        y: plots::Axis::log("penetration (dimensionless)"),
        beyond: resolved.map(|epsilon| (epsilon, "impact resolved (α < 1)".into())),
        ..Xy::default()
    };
    plots::convergence(xy, &series, &[1.0, 2.0 / 3.0])
}

/// Only the first decades, so that the curves stay distinct.
fn tip(study: &RigidStudy, all: &[Compliance<'_>], limit: Option<&ShownImpact>) -> String {
    let decades = [(1e-1, "ε = 10⁻¹"), (1e-2, "ε = 10⁻²"), (1e-3, "ε = 10⁻³")];
    let label = |epsilon: f64| {
        decades
            .iter()
            .find(|(decade, _)| (epsilon / decade - 1.0).abs() < 1e-6)
    };
    let series = |label: &str, of: &ShownImpact| plots::Series::new(label, of.tip.clone());
    let curve = |of: &Compliance<'_>| Some(series(label(of.epsilon)?.1, of.bouncing?));
    let y = plots::Axis::linear("tip displacement u(1, t) (dimensionless)");
    let series: Vec<_> = all
        .iter()
        .filter_map(curve)
        .chain(limit.map(|limit| series("rigid", limit)))
        .collect();
    Xy {
        guides: obstacle_lines(study.moving.obstacles),
        ..plots::history(y, &series)
    }
    .titled("The motion tends to that between rigid obstacles")
    .draw()
}
