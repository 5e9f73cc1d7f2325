//! Runs that reach a wanted error, by refinement.
//!
//! Runs by dG of rising degree and falling step are made until two successive ones agree within
//! the wanted error E in u(1), at all times of a history and at the contact events of the coarser
//! run. The finer one is returned, with the difference as its estimate.
//!
//! # Why the difference bounds the error
//!
//! Let d_k be the difference of the runs k and k + 1, at each of these times. The error of run
//! k + 1 is a sum of later differences, `d_(k+1) + d_(k+2) + ...`. If each is at most half of the
//! one before, that is at most d_k, so `d_k <= E` is enough. A refinement divides the parts of the
//! error by more than 2, with rates measured in the scenes of the paper: 0.7 of all steps by
//! `0.7^-2.5 = 2.4` at the peak of an impact, where u_tt is like t^(1/2), whatever the degree in
//! time; a quarter of the first step by `4^1.5 = 8` where data violate the condition at x = 1 and
//! u is like t^(3/2); four more degrees by `1.8^4 = 10` at a front after an impact.
//!
//! Two runs may agree by chance, or because both lack the same thing. Therefore:
//!
//! * A third run must confirm that the differences fall: `d_k <= d_(k-1)/2`, or both are round-off.
//! * Both runs must have the same contact events in the same order. A curve that crosses another
//!   at some time does not agree with it at 4000 times.
//! * A feature of the data that all meshes miss is in no difference. At t = 0 the solution is
//!   known: elements are halved until the data differ by at most E/10 from their projections, at
//!   10 000 points. A jump is refused, a kink is a node. (u(1) changes by at most about the
//!   largest difference: the displacement at x = 1 after a unit impulse at x is at most about 1.)
//! * While N < -1, and N >= β, each wave grows, the shorter the faster, up to the rate s/ζ with
//!   `s = -(1 + β)`, for wave numbers k > √s/ζ. Runs that lack such waves agree. The first mesh
//!   resolves `k = √s/ζ`, and the first steps are at most 2ζ/s long.
//!
//! Layers of width √(ζ t) begin at x = 1 with each impact: elements there shrink by a factor of 6
//! each, down to what the first step needs. Kinks of the data are nodes.

use std::ops::ControlFlow;

use convergence_judge::text::number::max_or_nan;
use convergence_study::file::Positive;
use thermobeam::dg::{Dg, DgStepping, Field, MAX_DEGREE, MAX_TIME_DEGREE, Phase};
use thermobeam::mesh::Mesh;
use thermobeam::motion::{Motion, StepReport};
use thiserror::Error;

use crate::error::reference::largest_difference;
use crate::expression::Expression;
use crate::run::simulate::{Recording, Run, Simulator};
use crate::run::{AnyMotion, RunError};
use crate::scene::{Method, Scene};

/// Allowed work: unknowns times linear solves, about half a minute.
const MOST_WORK: f64 = 1.5e9;

/// Differences that may be rounding errors: those of the solver's stopping rule, 1e-14 a step.
const ROUND_OFF: f64 = 1e-11;

/// Equidistant times of comparison.
const TIMES: usize = 4000;

/// Failed runs after which finer ones are not tried: coarse steps may fail.
const FAILURES: usize = 3;

/// Elements of a mesh at most.
const MOST_ELEMENTS: usize = 256;

/// Nodes that are closer are one.
const SHORTEST: f64 = 1e-6;

/// Ratio of the lengths of neighbouring elements in a layer.
const GRADING: f64 = 6.0;

/// Points at which initial data are compared: features of width 1e-4 are seen.
const POINTS: usize = 10_000;

/// A run with the wanted error.
#[derive(Debug, Clone)]
pub struct Reached {
    /// The scene with the chosen mesh, degrees and steps.
    pub scene: Scene,
    /// Its run.
    pub run: Run,
    /// Its difference to the run before: a bound on its error, by the head of this module.
    pub estimate: f64,
    /// Number of runs, this one included.
    pub runs: usize,
    /// Their work: unknowns times linear solves.
    pub work: f64,
}

/// Refinement ended before two runs agreed.
#[derive(Debug, Clone, Error)]
#[error("an error of {target:.1e} was not reached: {reason}{}", reachable(*reached))]
pub struct OutOfReach {
    /// The given target.
    pub target: f64,
    /// The smallest difference of two successive runs; infinite before the second.
    pub reached: f64,
    /// Why it ended.
    pub reason: StopReason,
}

/// Why refinement ended.
#[derive(Debug, Clone, Error)]
pub enum StopReason {
    /// Finer runs differ by rounding errors.
    #[error("finer runs differ by as much: rounding errors")]
    RoundOff,
    /// The limit of work was reached.
    #[error(
        "finer runs exceed the limit of {MOST_WORK:.1e} unknowns times solves, about half a minute"
    )]
    Work,
    /// Finer elements are not possible.
    #[error("{MOST_ELEMENTS} elements do not resolve the beam, or its initial data")]
    Finest,
    /// A run failed.
    #[error("a run failed: {0}")]
    Run(#[from] RunError),
}

/// The error that can be reached, in words; empty before the first comparison.
fn reachable(reached: f64) -> String {
    if reached.is_finite() {
        format!("; about {reached:.1e} can be reached")
    } else {
        String::new()
    }
}

/// The run of a scene whose error is at most `target`.
///
/// * `scene`: its own mesh, steps and method have no influence, but nodes that it lists are kept.
/// * `progress`: receives the used part of the allowed work after each step.
///
/// # Errors
/// [`OutOfReach`]
pub fn reach(
    scene: &Scene,
    target: Positive,
    recording: Recording,
    progress: &mut dyn FnMut(f64),
) -> Result<Reached, OutOfReach> {
    let target = target.get();
    let mut search = Search {
        target,
        recording,
        progress,
        work: 0.0,
        reached: f64::INFINITY,
    };
    let first = first(scene, target).ok_or(StopReason::Finest);
    let found = first.and_then(|first| search.refine(first));
    found.map_err(|reason| OutOfReach {
        target,
        reached: search.reached,
        reason,
    })
}

/// A run, and its states where it is compared.
struct Observed {
    run: Run,
    /// Its own times: equidistant ones, and its contact events.
    times: Vec<f64>,
    /// u(1) at its own times.
    own: Vec<f64>,
    /// u(1) at the times of the run before.
    given: Vec<f64>,
}

impl Observed {
    /// The contact events, without their times.
    fn passages(&self) -> Vec<(Phase, Phase)> {
        let contact = self.run.contact.iter();
        let events = contact.flat_map(|contact| &contact.events);
        events.map(|event| (event.from, event.to)).collect()
    }
}

struct Search<'p> {
    target: f64,
    recording: Recording,
    progress: &'p mut dyn FnMut(f64),
    /// Work of all runs.
    work: f64,
    /// The smallest difference.
    reached: f64,
}

impl Search<'_> {
    /// Refines a scene until two runs agree.
    fn refine(&mut self, mut scene: Scene) -> Result<Reached, StopReason> {
        while !(misfit(&scene)? <= (0.1 * self.target).max(ROUND_OFF)) {
            let nodes = halved(&scene);
            scene = on(scene, nodes).ok_or(StopReason::Finest)?;
        }
        let mut before: Option<Observed> = None;
        let (mut last, mut failures) = (f64::NAN, 0);
        for runs in 1.. {
            let given = before.as_ref().map_or(&[][..], |before| &before.times);
            let now = match self.observe(&scene, given) {
                Err(StopReason::Run(error))
                    if failures < FAILURES && !matches!(error, RunError::TimeUp(_)) =>
                {
                    failures += 1;
                    None
                }
                now => Some(now?),
            };
            let mut difference = f64::NAN;
            if let (Some(before), Some(now)) = (&before, &now) {
                difference = largest_difference(&before.own, &now.given);
                self.reached = self.reached.min(difference);
                let falls = difference <= 0.5 * last;
                let is_round_off = difference <= ROUND_OFF && last <= ROUND_OFF;
                let is_met = difference <= self.target && before.passages() == now.passages();
                if is_met && (falls || is_round_off) {
                    return Ok(Reached {
                        scene,
                        run: now.run.clone(),
                        estimate: difference,
                        runs,
                        work: self.work,
                    });
                }
                if is_round_off && !falls {
                    return Err(StopReason::RoundOff);
                }
            }
            (before, last) = (now, difference);
            scene = finer(&scene).ok_or(StopReason::Finest)?;
        }
        Err(StopReason::Work)
    }

    /// Runs a scene.
    ///
    /// * `at`: the times of the run before.
    fn observe(&mut self, scene: &Scene, at: &[f64]) -> Result<Observed, StopReason> {
        if (scene.steps() * scene.degree) as f64 > MOST_WORK {
            return Err(StopReason::Work);
        }
        let stages = scene.dg_stepping().degree + 1;
        let mut times = vec![];
        let mut own = vec![];
        let mut given = vec![];
        let mut events = 0;
        let before = self.work;
        let mut watch = |motion: &mut AnyMotion, _: &StepReport| {
            let Some(simulation) = motion.dg() else {
                return Ok(ControlFlow::Break(()));
            };
            let u_tip = |&t: &f64| simulation.value(Field::U, 1.0, t).unwrap_or(f64::NAN);
            let to = simulation.level().t;
            let mut new = motion.parts(scene.t_end, TIMES);
            if simulation.events().len() > events && new.last() != Some(&to) {
                new.push(to);
            }
            events = simulation.events().len();
            own.extend(new.iter().map(u_tip));
            times.append(&mut new);
            while let Some(t) = at.get(given.len()).filter(|t| **t <= to) {
                given.push(u_tip(t));
            }
            let unknowns = 3 * simulation.space().blocks() * stages;
            self.work = before + (unknowns * simulation.work().passes) as f64;
            (self.progress)(self.work / MOST_WORK);
            Ok(if self.work > MOST_WORK {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            })
        };
        let run = Simulator::new(scene)?.watched(self.recording, &[], &mut watch);
        match run.failure {
            Some(failure) => Err(failure.into()),
            None if self.work > MOST_WORK => Err(StopReason::Work),
            None => Ok(Observed {
                run,
                times,
                own,
                given,
            }),
        }
    }
}

/// The first discretisation, from experience with the scenes of the paper: coarser than needed.
fn first(scene: &Scene, target: f64) -> Option<Scene> {
    let digits = (-target.log10()).clamp(2.0, 12.0);
    let shrink = 10.0_f64.powf(-(digits - 5.0).max(0.0) / 11.0);
    let beam = &scene.beam;
    let grow = (-1.0 - beam.beta).max(0.0);
    let impact = scene
        .obstacles
        .map_or(0.02, |obstacles| obstacles.impact_time(beam.zeta));
    let dt = (0.03 * shrink)
        .min(0.125 * scene.t_end)
        .min(2.0 * beam.zeta / grow);
    let stepping = DgStepping {
        degree: (0.5 * digits).round() as usize - 1,
        dt,
        restart_dt: (0.8 * impact * shrink).min(dt),
        growth: 1.0 + 0.7 * shrink,
        ..DgStepping::default()
    };
    let degree = 1.2 * digits;
    // An odd degree has as many unknowns as the even one below it.
    let degree = degree.round() as usize | 1;
    let longest = 2.0 * degree as f64 * beam.zeta / grow.sqrt();
    let fields = scene.initial.fields().into_iter().flatten();
    let kinks = fields.flat_map(Expression::kinks);
    let kinks = kinks.filter(|x| (SHORTEST..1.0 - SHORTEST).contains(x));
    let mut nodes: Vec<f64> = kinks
        .chain([0.0, 1.0])
        .chain(scene.listed.clone())
        .collect();
    let parts = (1.0 / longest).ceil().min(2.0 * MOST_ELEMENTS as f64);
    nodes.extend((1..parts as usize).map(|k| k as f64 / parts));
    nodes.sort_by(f64::total_cmp);
    nodes.dedup_by(|next, x| *next - *x < SHORTEST);
    let scene = Scene {
        degree,
        method: Method::Dg(stepping),
        ..scene.clone()
    };
    on(scene, nodes)
}

/// Four more degrees; all steps shorter, the first most of all. `None` beyond the highest degree.
fn finer(scene: &Scene) -> Option<Scene> {
    let by = scene.dg_stepping();
    let stepping = DgStepping {
        degree: (by.degree + 1).min(MAX_TIME_DEGREE),
        dt: 0.7 * by.dt,
        restart_dt: 0.25 * by.restart_dt,
        growth: 1.0 + 0.7 * (by.growth - 1.0),
        ..by
    };
    let scene = Scene {
        degree: scene.degree + 4,
        method: Method::Dg(stepping),
        ..scene.clone()
    };
    let nodes = scene.mesh.nodes().to_vec();
    on(scene, nodes).filter(|finer| finer.degree <= MAX_DEGREE)
}

/// The scene on the mesh with these nodes, and more that resolve a layer at x = 1 after the first
/// step: the finest detail of an element of length h is about
/// 12 h/p². `None` if there are too many.
fn on(scene: Scene, mut nodes: Vec<f64>) -> Option<Scene> {
    let layer = (scene.beam.zeta * scene.dg_stepping().restart_dt).sqrt();
    let longest = (layer * (scene.degree * scene.degree) as f64 / 12.0).max(1e-3);
    let mut length = 1.0 - nodes[nodes.len() - 2];
    while length > longest {
        length /= GRADING;
        nodes.insert(nodes.len() - 1, 1.0 - length);
    }
    if nodes.len() > MOST_ELEMENTS + 1 {
        return None;
    }
    let mesh = Mesh::from_nodes(nodes).ok()?;
    Some(Scene { mesh, ..scene })
}

/// The nodes, and the middles of the elements.
fn halved(scene: &Scene) -> Vec<f64> {
    let mut nodes = vec![0.0];
    for x in scene.mesh.nodes().windows(2) {
        nodes.extend([0.5 * (x[0] + x[1]), x[1]]);
    }
    nodes
}

/// The largest difference of the initial data to their projections, all fields added.
fn misfit(scene: &Scene) -> Result<f64, RunError> {
    let simulation = Dg::new(scene.dg_problem(), scene.dg_stepping())?;
    let (space, level) = (simulation.space(), simulation.level());
    let mut misfit = 0.0;
    for x in (0..POINTS).map(|k| (k as f64 + 0.5) / POINTS as f64) {
        let mut values = level.values_and_slopes(space, x).map(|(value, _)| value);
        values[4] += scene.beam.theta_a * (1.0 - x);
        let mut difference = 0.0;
        for (value, field) in values.iter().zip(scene.initial.fields()) {
            difference += (value - field.as_ref().map_or(0.0, |field| field.eval(x))).abs();
        }
        misfit = max_or_nan(misfit, difference);
    }
    Ok(misfit)
}
