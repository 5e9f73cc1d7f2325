//! Ask for an accuracy: scheme, elements and steps that make an error no larger than wanted, at little cost.
//!
//! Pilot runs on coarse levels measure the errors of space and time (`pilot`). From their rates follow the error of any
//! finer run and the cheapest run whose error is `AIM` of the one asked for. Pilots are refined until their prediction can be
//! trusted, or until they reach the accuracy themselves: where the tip meets an obstacle, the observed rate of the
//! second-order scheme drops, and it is the observed rate that counts.
//!
//! The error of the tip is the maximum of |u_h(1, t) - u(1, t)| over the time levels in [0, T]; that in the norm of Theorem 3.4
//! the maximum of that norm. Both are predictions: the answer gives the predicted error and the cost of the pilots.
//!
//! ```
//! use thermobeam_study::predict::accuracy::{Request, choose};
//! use thermobeam_study::run::family::Family;
//! use thermobeam_study::scene::Scene;
//! use thermobeam_study::error::evaluator::ErrorMeasure;
//!
//! let text = "[initial]\nu_t = \"x\"\n[time]\ndt = 0.01\nt_end = 1.0";
//! let family = Family::of_scene(&Scene::parse(text, "swing.toml")?);
//! let choice = choose(&family, &Request::new(ErrorMeasure::Tip, 1e-4))?;
//! assert!(choice.expected_error <= 1e-4 && choice.scheme.name == "midpoint");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod outlook;
mod pilot;

use crate::error::evaluator::ErrorMeasure;
use crate::run::family::{Family, Spent};
use convergence_study::judge::fit::Quantiles;
use convergence_study::study::CaseFailure;
use outlook::{CANCELLATION, Outlook, PILOT_SHARE, cheapest, leader};
use pilot::{Forecast, Pilots};
use thermobeam::scheme::{SCHEMES, Scheme};
use thermobeam::solve::Settings;
use thiserror::Error;

/// Node-steps of pilots after which a forecast without the rates of theory is good enough to give up by: about a tenth
/// of a second.
const SETTLED: f64 = 3e6;
/// Node-steps of the costliest run that is begun: some ten minutes.
pub const MAX_NODE_STEPS: f64 = 2e10;
/// Elements of the first pilot.
const ELEMENTS: usize = 4;
/// Steps of the first pilot per unit of time, of which the slowest vibration takes five.
const STEPS_PER_TIME: f64 = 4.0;
/// Round-off of the solution in units of ε n², which is about the condition of the stiffness, with a safety factor of 40:
/// vibrations with 4000 to 32000 elements, whose errors in space have to fall fourfold, show 2.5e-6.
const ROUND_OFF: f64 = 1e-4;
/// The part of an error that round-off may make up.
const ROUND_OFF_SHARE: f64 = 0.1;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// The tip or the norm of Theorem 3.4.
    pub quantity: ErrorMeasure,
    /// The error asked for.
    pub target: f64,
    /// Node-steps that may be spent.
    pub max_node_steps: f64,
}

impl Request {
    /// With the usual limit of cost.
    pub fn new(quantity: ErrorMeasure, target: f64) -> Self {
        Self { quantity, target, max_node_steps: MAX_NODE_STEPS }
    }

    /// Tolerance of the solver that leaves no trace in an error of the size asked for.
    pub fn tolerance(&self) -> f64 {
        (1e-4 * self.target).clamp(1e-13, 1e-9)
    }
}

/// How far a forecast can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Trust {
    /// Not at all.
    None,
    /// The errors fall, but not at the order of theory: contact, or data that are not smooth.
    Loose,
    /// The rates are those of theory.
    Firm,
}

/// The run that is predicted to make the error asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The time scheme.
    pub scheme: Scheme,
    /// Elements.
    pub elements: usize,
    /// Time steps.
    pub steps: usize,
    /// How each step is solved.
    pub settings: Settings,
    /// The predicted error.
    pub expected_error: f64,
    /// The parts of space and of time in it.
    pub parts: [f64; 2],
    /// How far the forecast can be trusted.
    pub trust: Trust,
    /// What the pilots have cost.
    pub pilots: Spent,
}

impl Choice {
    /// Node-steps of the run itself.
    pub fn node_steps(&self) -> f64 {
        self.elements as f64 * self.steps as f64
    }
}

/// Why there is no such run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Unreachable {
    /// The target is not a positive number.
    #[error("target error {target}: expected a finite number > 0")]
    Target {
        /// As asked for.
        target: f64,
    },
    /// It would cost too much.
    #[error(
        "an error of {target:.3e} in {quantity} would take {}, more than the {limit:.1e} allowed: \
         within them about {reachable:.1e} can be reached", node_steps(*.cost)
    )]
    Cost {
        /// As asked for.
        target: f64,
        /// The quantity's name.
        quantity: &'static str,
        /// Node-steps.
        cost: f64,
        /// Node-steps allowed.
        limit: f64,
        /// The smallest error within that cost.
        reachable: f64,
    },
    /// Rounding errors would be larger.
    #[error(
        "an error of {target:.3e} in {quantity} is below what rounding errors leave on the mesh that it takes: \
         about {reachable:.1e} can be reached"
    )]
    RoundOff {
        /// As asked for.
        target: f64,
        /// The quantity's name.
        quantity: &'static str,
        /// The smallest error above round-off.
        reachable: f64,
    },
    /// A pilot did not come to its end.
    #[error("a pilot run failed: {0}")]
    Pilot(String),
}

/// A cost in words; without end where not even 1e12 steps would do.
fn node_steps(cost: f64) -> String {
    if cost.is_finite() { format!("about {cost:.1e} node-steps") } else { "more than 1e12 steps".to_owned() }
}

impl From<CaseFailure> for Unreachable {
    fn from(failure: CaseFailure) -> Self {
        Unreachable::Pilot(failure.reason)
    }
}

/// Chooses scheme, elements and steps.
///
/// # Errors
/// [`Unreachable`]: why there is no such run, and the error that can be reached.
pub fn choose(family: &Family, request: &Request) -> Result<Choice, Unreachable> {
    if !(request.target > 0.0 && request.target.is_finite()) {
        return Err(Unreachable::Target { target: request.target });
    }
    let Some(quantiles) = Quantiles::new(0.95) else { return Err(Unreachable::Pilot("no quantiles".to_owned())) };
    let mut candidates = first_pilots(family, request)?;
    loop {
        let mut spent = Spent::default();
        candidates.iter().for_each(|pilots| spent += pilots.spent);
        let outlooks: Vec<Outlook<'_>> =
            candidates.iter().map(|pilots| Outlook::new(pilots.forecast(&quantiles), request.target)).collect();
        let leader = leader(&outlooks);
        let refined: Vec<(usize, [usize; 2])> = (0..outlooks.len())
            .filter(|&k| k == leader || outlooks[k].may_win(&outlooks[leader]))
            .map(|k| (k, outlooks[k].next))
            .collect();
        let outlook = &outlooks[leader];
        let total = spent.node_steps + refined.iter().map(|(_, [n, s])| 2.0 * *n as f64 * *s as f64).sum::<f64>();
        let settled = match outlook.forecast.trust {
            Trust::Firm => true,
            Trust::Loose => spent.node_steps >= SETTLED,
            Trust::None => false,
        };
        let hopeless = settled && !within(request, outlook.best.at, spent);
        if let Some(at) = outlook.verdict(request.target, total).or(hopeless.then_some(outlook.best.at)) {
            return finish(&outlook.forecast, request, at, spent);
        }
        if !(total <= request.max_node_steps) {
            let (target, quantity, limit) = (request.target, request.quantity.name(), request.max_node_steps);
            let reachable = CANCELLATION * outlook.own;
            return Err(Unreachable::Cost { target, quantity, cost: total, limit, reachable });
        }
        for (k, at) in refined {
            candidates[k].add(family, request, at)?;
        }
    }
}

/// Bound on the round-off of a run, as a part of which rounding in every step adds up at worst.
fn round_off([elements, steps]: [f64; 2]) -> f64 {
    f64::EPSILON * (ROUND_OFF * elements * elements + steps)
}

/// Whether round-off and the limit of cost allow a run.
fn within(request: &Request, at: [f64; 2], pilots: Spent) -> bool {
    at[0] * at[1] + pilots.node_steps <= request.max_node_steps && round_off(at) <= ROUND_OFF_SHARE * request.target
}

/// The first two pilots of every scheme. A scheme whose pilots fail is left out.
fn first_pilots(family: &Family, request: &Request) -> Result<Vec<Pilots>, Unreachable> {
    let steps = 2 * ((0.5 * STEPS_PER_TIME * family.t_end).ceil() as usize).max(4);
    let mut candidates = vec![];
    let mut failure = None;
    for scheme in SCHEMES {
        let mut pilots = Pilots::new(scheme, request.quantity);
        match [1, 2].into_iter().try_for_each(|k| pilots.add(family, request, [ELEMENTS * k, steps * k])) {
            Ok(()) => candidates.push(pilots),
            Err(reason) => failure = Some(reason),
        }
    }
    match failure {
        Some(failure) if candidates.is_empty() => Err(failure.into()),
        _ => Ok(candidates),
    }
}

/// Rounds up to whole numbers, and refuses what is out of reach.
fn finish(forecast: &Forecast<'_>, request: &Request, at: [f64; 2], pilots: Spent) -> Result<Choice, Unreachable> {
    let (target, quantity) = (request.target, request.quantity.name());
    let at = at.map(f64::ceil);
    let cost = at[0] * at[1];
    let limit = request.max_node_steps;
    // What costs too much may be lost in round-off as well, and the other way round.
    let reachable = || {
        reachable(forecast, target, |error, at| {
            (1.0 + 2.0 * PILOT_SHARE) * at[0] * at[1] <= limit && round_off(at) <= ROUND_OFF_SHARE * error
        })
    };
    if !(cost + pilots.node_steps <= limit) {
        return Err(Unreachable::Cost { target, quantity, cost, limit, reachable: reachable() });
    }
    if !(round_off(at) <= ROUND_OFF_SHARE * target) {
        return Err(Unreachable::RoundOff { target, quantity, reachable: reachable() });
    }
    let (expected_error, parts) = forecast.error(at);
    Ok(Choice {
        scheme: forecast.scheme(),
        elements: at[0] as usize,
        steps: at[1] as usize,
        settings: Settings { tolerance: request.tolerance(), ..Settings::default() },
        expected_error,
        parts,
        trust: forecast.trust,
        pilots,
    })
}

/// The smallest error above `target` whose cheapest run is allowed.
fn reachable(forecast: &Forecast<'_>, target: f64, is_allowed: impl Fn(f64, [f64; 2]) -> bool) -> f64 {
    let mut error = target;
    while !is_allowed(error, cheapest(forecast, error).at) && error < 1e3 {
        error *= 1.1;
    }
    error
}
