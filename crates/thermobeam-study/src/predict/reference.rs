//! A run of any order whose own error is known: degrees, elements and steps are refined until it is
//! small enough.
//!
//! Two comparisons judge a discretisation by its curves, at several times inside each of its steps:
//! with a finer space (p + 4, or the longest elements halved) and with finer steps. Finer steps
//! have half the length *everywhere*: dt, `restart_dt` and `growth - 1` are halved, since at a
//! distance s from a contact event a step is about `(growth - 1) s` long; `restart_dt` is halved
//! twice. The difference estimates the error of the coarser run: p + 4 leaves up to a third of the
//! error where elements do not resolve a layer, halved steps leave less. If a difference exceeds
//! half of the target, space or time is refined according to their ratio, and both runs are
//! compared again. Before that, the first two steps are refined on their own.
//!
//! * The start: initial data that violate the condition at x = 1 make u(1, t) behave like t^(3/2).
//!   The error peaks inside the first steps, which only `restart_dt` makes shorter, and in the
//!   element at x = 1, which is split.
//! * Steps: at the peak of an impact, on the time scale (ε √ζ)^(2/3), u_tt behaves like t^(1/2);
//!   there the error peaks inside steps, and is not visible at their ends. The degree q helps
//!   between impacts, short steps during them.
//! * Elements: the last one, at x = 1, covers the layer that an impact sends into the beam; after
//!   time t its width is √(ζ t).
//! * Initial data: nodes at narrow features and at kinks, see `data`. From a kink a layer of width
//!   √(ζ t) begins at the start: the elements on both sides of it are split like the last one,
//!   until there is a contact event.
//! * Short waves: u ~ e^(λt) sin(kx) has λ² + ζk²λ + (1 + N)k² = 0. While N < -1 every wave grows,
//!   shorter waves faster, up to the rate s/ζ, s = -(1 + N), which waves with k > √s/ζ come close
//!   to. Unresolved waves grow most, and p and p + 4 agree on waves that both lack: errors of 300
//!   times the difference were observed. N ≥ β, so this requires β < -1. Then the first mesh
//!   resolves k = √s/ζ, in elements no longer than 2p/k, and the first steps are at most 2ζ/s long,
//!   with s at N = β.

use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE, Stepping};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::Beam;

use super::curves::{Apart, Curves, Rows, Wanted, curves};
use super::data::{Data, GRADING, MOST_ELEMENTS, add_node};
use super::{Cost, Reason, Unreachable, Work};
use crate::error::reference::distance_of_curves;
use crate::scene::{Method, Scene, resampled};

/// Share of the target allowed for each of the two differences.
const SHARE: f64 = 0.5;

/// Least factor by which each degree lowers the error in x, measured in the worst scene: a front
/// after an impact.
const FALL_PER_DEGREE: f64 = 1.8;

/// Rate of the error inside steps near a contact event, where u_tt behaves like t^(1/2).
const EVENT_RATE: f64 = 2.5;

/// Rate of the error in the first steps, where data that violate a condition at x = 1 make u_tt
/// behave like t^(-1/2).
const START_RATE: f64 = 1.5;

/// Smallest and largest divisor of `restart_dt` in one round.
const SHORTENED: [f64; 2] = [2.0, 32.0];

/// A layer at x = 1 is resolved if its width is at least this multiple of length / p², the finest
/// detail of an element.
const RESOLVED: f64 = 12.0;

/// Smallest and largest factor of all steps in one round: a large difference gives no reliable
/// factor.
const SHORTER: [f64; 2] = [0.25, 0.8];

/// A difference that must fall by more than this also raises the degree in time.
const MUCH: f64 = 4.0;

/// Extra degrees of the finer space: two would give only half of the error where a layer is not
/// resolved.
const FINER_DEGREES: usize = 4;

/// Degrees added in one round, and the degree above which elements are halved instead.
const MOST_DEGREES: usize = 8;
const HIGHEST_DEGREE: usize = 27;

/// Growth of steps below which it is kept: slower growth would never reach dt.
const LEAST_GROWTH: f64 = 1.02;

/// A node this close to one that is kept, in units of the distance from x = 1, is left out.
const CLOSE: f64 = 0.2;

/// Elements longer than this part of the longest are halved; shorter ones wait until the lengths
/// are closer.
const LONG: f64 = 0.25;

/// Rounds of refinement: each at least halves something.
const ROUNDS: usize = 14;

/// A round that lowers the difference by less than this factor has stalled.
const STALLED: f64 = 0.7;

/// Below this difference a stalled round has reached round-off: that of the solver's stopping rule,
/// 1e-14 per step.
const ROUND_OFF: f64 = 1e-11;

/// Upper bound on the first time steps, in units of the time in which the fastest wave grows by e.
const RISE: f64 = 2.0;

/// Shortest of the equal elements of the first mesh.
const SHORTEST: f64 = 1.0 / 48.0;

/// Longest step for an error of 1e-5: a tenth of the shortest period that carries much energy.
const LONGEST: f64 = 0.02;

/// Axial force below which short waves grow.
const SHORT_WAVES_GROW: f64 = -1.0;

/// A run whose own error is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The scene with the chosen mesh, degrees and steps.
    pub scene: Scene,
    /// Largest difference to a finer space: of u(1, t), φ(1, t) and the energy, or once in the
    /// norm.
    pub space: [f64; 3],
    /// The same to finer steps.
    pub time: [f64; 3],
    /// Both together at the end, in units of the largest value of the curve; the largest of all
    /// curves.
    pub(super) end: f64,
    /// The cost of the run.
    pub run: Cost,
    /// The finer space of the last comparison, in words.
    pub finer_space: String,
}

impl Reference {
    /// The error of curve k.
    pub(super) fn error(&self, k: usize) -> f64 {
        self.space[k] + self.time[k]
    }
}

/// Refines until both differences are at most half of the tolerance.
///
/// * `scene`: its own mesh, degrees and steps have no influence.
/// * `start`: the first discretisation; without it, a guess.
///
/// # Errors
/// [`Unreachable`]: why there is no such run, and the error reached.
pub(super) fn reference(
    scene: &Scene,
    start: Option<&Scene>,
    wanted: &Wanted,
    work: &mut Work<'_>,
) -> Result<Reference, Unreachable> {
    let target = wanted.tolerance[0];
    if !(target > 0.0 && target.is_finite()) {
        return Err(Unreachable::Target { target });
    }
    let data = Data::of(scene);
    let first = start
        .cloned()
        .unwrap_or_else(|| first(scene, wanted, &data.kept));
    let (first, _) = data.resolve(first, wanted)?;
    let mut search = Search {
        wanted,
        data,
        work,
        last: 0.0,
        best: [f64::INFINITY; 2],
    };
    let begun = if start.is_some() {
        first
    } else {
        search.begin(&first)
    };
    search.last = 0.0;
    search.refine(begun).map_err(|reason| {
        let [space, time] = search.best.map(|part| part * target);
        Unreachable::NotReached {
            target,
            reached: space.max(time) / SHARE,
            space,
            time,
            reason,
        }
    })
}

/// Two finer runs and their distances from a run.
struct Compared {
    finer: Curves,
    shorter: Curves,
    space: Apart,
    time: Apart,
}

/// The state of a search for a discretisation.
struct Search<'s, 'w> {
    wanted: &'s Wanted,
    data: Data,
    work: &'s mut Work<'w>,
    /// Work of the last run.
    last: f64,
    /// The differences of the round whose sum was smallest.
    best: [f64; 2],
}

impl Search<'_, '_> {
    /// Refines for the first two steps only, which cost little: the start often needs the shortest
    /// steps of all.
    ///
    /// Returns the given discretisation if that fails.
    fn begin(&mut self, first: &Scene) -> Scene {
        let mut scene = first.clone();
        for _ in 0..ROUNDS {
            let Stepping { dt, restart_dt, .. } = scene.dg_stepping();
            let t_end = 2.0 * restart_dt;
            // Only shorter steps: each step length needs memory, and only these lengths occur.
            let method = Method::Dg(Stepping {
                dt: t_end.min(dt),
                ..scene.dg_stepping()
            });
            let short = Scene {
                t_end: t_end.min(scene.t_end),
                method,
                ..scene.clone()
            };
            let rows = self.wanted.rows.on(&short);
            let compared = self
                .run(&short, &rows, None)
                .and_then(|base| self.compare(&short, &rows, &base));
            let Ok(Compared { space, time, .. }) = compared else {
                return first.clone();
            };
            if space.most() <= SHARE && time.most() <= SHARE {
                return scene;
            }
            match refined(&scene, &space, &time, &self.data.kinks) {
                Some(next) => scene = next,
                None => return first.clone(),
            }
        }
        first.clone()
    }

    /// Refines a discretisation until both differences are small enough.
    fn refine(&mut self, mut scene: Scene) -> Result<Reference, Reason> {
        for _ in 0..ROUNDS {
            let rows = self.wanted.rows.on(&scene);
            let base = self.run(&scene, &rows, None)?;
            let compared = self.compare(&scene, &rows, &base)?;
            let (space, time) = (&compared.space, &compared.time);
            if space.most() <= SHARE && time.most() <= SHARE {
                return Ok(self.found(scene, &base, &compared));
            }
            self.judge(space.most(), time.most())?;
            scene = refined(&scene, space, time, &self.data.kinks).ok_or(Reason::Finest)?;
        }
        Err(Reason::Rounds)
    }

    fn found(&self, scene: Scene, base: &Curves, compared: &Compared) -> Reference {
        let mut found = Reference {
            finer_space: finer(&scene)[0]
                .as_ref()
                .map_or_else(|_| String::new(), words),
            scene,
            space: [compared.space.most() * self.wanted.tolerance[0]; 3],
            time: [compared.time.most() * self.wanted.tolerance[0]; 3],
            end: 0.0,
            run: base.cost,
        };
        if !matches!(self.wanted.rows, Rows::Norm(_)) {
            for k in 0..base.width {
                let [own, finer, shorter] =
                    [base, &compared.finer, &compared.shorter].map(|run| run.column(k));
                (found.space[k], found.time[k]) = (
                    distance_of_curves(&own, &finer),
                    distance_of_curves(&own, &shorter),
                );
                let last = own.len() - 1;
                let end = (own[last] - finer[last]).abs() + (own[last] - shorter[last]).abs();
                found.end = found
                    .end
                    .max(end / distance_of_curves(&own, &vec![0.0; own.len()]));
            }
        }
        found
    }

    /// The two comparisons of a scene; `base` is its run.
    fn compare(&mut self, scene: &Scene, rows: &Rows, base: &Curves) -> Result<Compared, Reason> {
        let times = base.own_times();
        let [finer, shorter] = finer(scene);
        let finer = self.run(&finer?, rows, Some(&times))?;
        let shorter = self.run(&shorter?, rows, Some(&times))?;
        let tolerance = &self.wanted.tolerance;
        let [space, time] = [&finer, &shorter].map(|finer| Apart::of(rows, base, finer, tolerance));
        Ok(Compared {
            finer,
            shorter,
            space,
            time,
        })
    }

    /// Runs a scene for comparison with the run whose times are `at`.
    fn run(&mut self, scene: &Scene, rows: &Rows, at: Option<&[f64]>) -> Result<Curves, Reason> {
        // A run has at most four times the steps of its predecessor; higher degrees cost more on
        // top.
        self.work.leaves(2.0 * self.last)?;
        let run = curves(scene, rows, at, self.work)?;
        self.last = run.cost.work;
        Ok(run)
    }

    /// Records the result of a round; stops if refinement has reached round-off.
    fn judge(&mut self, space: f64, time: f64) -> Result<(), Reason> {
        let ([best_space, best_time], found) = (self.best, space + time);
        let stalled = !(found <= STALLED * (best_space + best_time));
        if found < best_space + best_time {
            self.best = [space, time];
        }
        if !found.is_finite() {
            return Err(Reason::NotFinite);
        }
        if stalled && found * self.wanted.tolerance[0] <= ROUND_OFF {
            Err(Reason::RoundOff)
        } else {
            Ok(())
        }
    }
}

/// Time scale t* of the peak of an impact; without obstacles, the longest step.
pub(super) fn impact(scene: &Scene) -> f64 {
    scene
        .obstacles
        .map_or(LONGEST, |obstacles| obstacles.impact_time(scene.beam.zeta))
}

/// The first discretisation, from experience with the scenes of the paper: two degrees in space for
/// every decimal digit, half a degree in time, and steps that shrink by two for every four digits.
///
/// * `kept`: nodes that the mesh must have.
pub(super) fn first(scene: &Scene, wanted: &Wanted, kept: &[f64]) -> Scene {
    let digits = (-wanted.tolerance[0].log10()).clamp(1.0, 11.0);
    let shrink = 10.0_f64.powf(-(digits - 5.0).max(0.0) / 11.0);
    let [wave, rise] = short_waves(&scene.beam);
    let dt = (LONGEST * shrink).min(0.125 * scene.t_end).min(RISE * rise);
    let impact = impact(scene);
    let stepping = Stepping {
        degree: ((0.5 * digits).round() as usize).clamp(1, MAX_TIME_DEGREE),
        dt,
        restart_dt: (0.2 * impact * shrink).min(dt),
        growth: 1.0 + 0.5 * shrink,
        ..Stepping::default()
    };
    // Width of the layer at x = 1 some four impacts after a touch.
    let layer = (2.0 * (scene.beam.zeta * 4.0 * impact).sqrt()).clamp(1e-3, 0.5);
    let nodes = if scene.obstacles.is_some() {
        graded(layer)
    } else {
        vec![0.0, 1.0]
    };
    // An odd degree has as many unknowns as the even one below it, so only odd degrees are used.
    let degree = (4.0 + 1.2 * digits).round() as usize | 1;
    let nodes = with_nodes(kept, &no_longer(&nodes, 2.0 * degree as f64 * wave));
    // Nodes that increase from 0 to 1.
    let mesh = Mesh::from_nodes(nodes).unwrap_or_else(|_| scene.mesh.clone());
    Scene {
        mesh,
        degree,
        method: Method::Dg(stepping),
        ..scene.clone()
    }
}

/// 1/k of the shortest wave that still grows faster, and the time in which it grows by e, at the
/// axial force at rest: infinite if no wave grows.
fn short_waves(beam: &Beam) -> [f64; 2] {
    let beyond = (SHORT_WAVES_GROW - beam.beta).max(0.0);
    [beam.zeta / beyond.sqrt(), beam.zeta / beyond]
}

/// The nodes, with equidistant nodes added wherever they are further apart than `length`.
fn no_longer(nodes: &[f64], length: f64) -> Vec<f64> {
    let length = length.max(SHORTEST);
    let between = |x: &[f64]| {
        let (from, to) = (x[0], x[1]);
        let parts = ((to - from) / length).ceil().max(1.0);
        (0..parts as usize).map(move |part| from + (to - from) * (part as f64 / parts))
    };
    nodes.windows(2).flat_map(between).chain([1.0]).collect()
}

/// Nodes that are kept, and those others that are not close to them, measured by their distance
/// from x = 1.
fn with_nodes(kept: &[f64], others: &[f64]) -> Vec<f64> {
    let mut nodes = vec![0.0, 1.0];
    for &x in kept {
        add_node(&mut nodes, x, f64::MIN_POSITIVE);
    }
    for &x in &others[1..others.len() - 1] {
        add_node(&mut nodes, x, CLOSE * (1.0 - x));
    }
    nodes
}

/// Elements towards x = 1 that grow by [`GRADING`] away from it; the last one has the given width.
fn graded(layer: f64) -> Vec<f64> {
    let widths = std::iter::successors(Some(layer), |width| Some(GRADING * width));
    let inner: Vec<f64> = widths
        .take_while(|width| *width <= 0.5)
        .map(|width| 1.0 - width)
        .collect();
    let ends = [0.0].into_iter().chain(inner.into_iter().rev());
    ends.chain([1.0]).collect()
}

/// The scene, refined where a difference exceeds its share; `None` if no finer elements are
/// possible.
///
/// * `kinks`: points of the initial data from which layers begin at the start.
fn refined(scene: &Scene, space: &Apart, time: &Apart, kinks: &[f64]) -> Option<Scene> {
    let (mut next, mut stepping) = (scene.clone(), scene.dg_stepping());
    if !(space.most() <= SHARE) {
        next = more_space(&next, space, space.most() / SHARE, kinks)?;
    }
    if !(time.late <= SHARE) {
        stepping = more_time(stepping, time.late / SHARE);
    }
    if !(time.early <= SHARE) {
        let restart_dt = scene.dg_stepping().restart_dt / shortening(time.early / SHARE);
        stepping.restart_dt = stepping.restart_dt.min(restart_dt);
    }
    Some(Scene {
        method: Method::Dg(stepping),
        ..next
    })
}

/// The scene with only space refined, and with only steps refined: p + 4 or the longest elements
/// halved, and all steps halved, with even shorter first steps, since the error there falls more
/// slowly; for a one-step scheme twice the elements, and dt/2.
pub(super) fn finer(scene: &Scene) -> [Result<Scene, Reason>; 2] {
    let Method::Dg(stepping) = scene.method else {
        let (elements, steps) = (scene.mesh.elements(), scene.steps());
        return [(2 * elements, steps), (elements, 2 * steps)].map(|(elements, steps)| {
            let mesh = resampled(&scene.mesh, elements).map_err(Reason::of_run)?;
            Ok(scene.with_steps(mesh, steps, scene.t_end))
        });
    };
    let raised = scene.degree + FINER_DEGREES;
    let space = if raised <= MAX_DEGREE {
        Some(Scene {
            degree: raised,
            ..scene.clone()
        })
    } else {
        halved(scene)
    };
    let half = shorter(stepping, 0.5);
    let method = Method::Dg(Stepping {
        restart_dt: 0.5 * half.restart_dt,
        ..half
    });
    [
        space.ok_or(Reason::Finest),
        Ok(Scene {
            method,
            ..scene.clone()
        }),
    ]
}

fn halved(scene: &Scene) -> Option<Scene> {
    let mesh = &scene.mesh;
    let mut nodes = vec![];
    for x in mesh.nodes().windows(2) {
        nodes.push(x[0]);
        if x[1] - x[0] >= LONG * mesh.size() {
            nodes.push(0.5 * (x[0] + x[1]));
        }
    }
    nodes.push(1.0);
    on(scene, nodes)
}

fn on(scene: &Scene, nodes: Vec<f64>) -> Option<Scene> {
    let mesh = (nodes.len() <= MOST_ELEMENTS + 1)
        .then(|| Mesh::from_nodes(nodes).ok())
        .flatten()?;
    Some(Scene {
        mesh,
        ..scene.clone()
    })
}

/// Space refined for an error smaller by `factor`; `apart` is the difference.
fn more_space(scene: &Scene, apart: &Apart, factor: f64, kinks: &[f64]) -> Option<Scene> {
    let layer = (scene.beam.zeta * apart.since).sqrt();
    let kinks = if apart.is_before_events { kinks } else { &[] };
    let mut nodes = vec![0.0];
    for x in scene.mesh.nodes().windows(2) {
        let part = (x[1] - x[0]) / GRADING;
        let is_coarse = layer < RESOLVED * GRADING * part / (scene.degree * scene.degree) as f64;
        if is_coarse && kinks.contains(&x[0]) {
            nodes.push(x[0] + part);
        }
        if is_coarse && (x[1] == 1.0 || kinks.contains(&x[1])) {
            nodes.push(x[1] - part);
        }
        nodes.push(x[1]);
    }
    if nodes.len() > scene.mesh.nodes().len() {
        return on(scene, nodes);
    }
    let wanted = (factor.ln() / FALL_PER_DEGREE.ln()).ceil();
    let degrees = if wanted.is_finite() {
        (wanted as usize).clamp(2, MOST_DEGREES)
    } else {
        MOST_DEGREES
    };
    let degree = scene.degree + degrees + degrees % 2;
    if degree <= HIGHEST_DEGREE {
        return Some(Scene {
            degree,
            ..scene.clone()
        });
    }
    halved(scene)
}

/// All steps multiplied by `part`.
fn shorter(stepping: Stepping, part: f64) -> Stepping {
    let Stepping {
        dt,
        restart_dt,
        growth,
        ..
    } = stepping;
    let growth = (1.0 + part * (growth - 1.0)).max(LEAST_GROWTH.min(growth));
    Stepping {
        dt: part * dt,
        restart_dt: part * restart_dt,
        growth,
        ..stepping
    }
}

/// The divisor of `restart_dt` for an error in the first steps smaller by `factor`.
fn shortening(factor: f64) -> f64 {
    let wanted = (1.5 * factor).powf(1.0 / START_RATE);
    if wanted.is_finite() {
        wanted.clamp(SHORTENED[0], SHORTENED[1])
    } else {
        SHORTENED[1]
    }
}

/// Steps refined for an error smaller by `factor`.
fn more_time(stepping: Stepping, factor: f64) -> Stepping {
    let part = (1.5 * factor).powf(-1.0 / EVENT_RATE);
    let part = if part.is_finite() {
        part.clamp(SHORTER[0], SHORTER[1])
    } else {
        SHORTER[0]
    };
    let degree = (stepping.degree + usize::from(!(factor <= MUCH))).min(MAX_TIME_DEGREE);
    shorter(Stepping { degree, ..stepping }, part)
}

fn words(scene: &Scene) -> String {
    format!(
        "{} elements of degree {}",
        scene.mesh.elements(),
        scene.degree
    )
}
