//! Finer discretisations: those that a scene is compared with, and the next one of a search.

use thermobeam::dg::{DgStepping, MAX_DEGREE, MAX_TIME_DEGREE};
use thermobeam::mesh::Mesh;

use super::Reason;
use super::curves::Apart;
use super::data::{GRADING, MOST_ELEMENTS};
use crate::scene::{Method, Scene, resampled};

/// Share of the target allowed for each of the two differences.
pub(super) const SHARE: f64 = 0.5;

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

/// Growth of steps below which it is kept: slower growth would never reach dt.
const LEAST_GROWTH: f64 = 1.02;

/// Elements longer than this part of the longest are halved; shorter ones wait until the lengths
/// are closer.
const LONG: f64 = 0.25;

/// Degrees added in one round.
const MOST_DEGREES: usize = 8;

/// The degree above which elements are halved instead.
const HIGHEST_DEGREE: usize = 27;

/// The scene, refined where a difference exceeds its share; `None` if no finer elements are
/// possible.
///
/// * `kinks`: points of the initial data from which layers begin at the start.
pub(super) fn refined(scene: &Scene, space: &Apart, time: &Apart, kinks: &[f64]) -> Option<Scene> {
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
    let method = Method::Dg(DgStepping {
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
fn shorter(stepping: DgStepping, part: f64) -> DgStepping {
    let DgStepping {
        dt,
        restart_dt,
        growth,
        ..
    } = stepping;
    let growth = (1.0 + part * (growth - 1.0)).max(LEAST_GROWTH.min(growth));
    DgStepping {
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
fn more_time(stepping: DgStepping, factor: f64) -> DgStepping {
    let part = (1.5 * factor).powf(-1.0 / EVENT_RATE);
    let part = if part.is_finite() {
        part.clamp(SHORTER[0], SHORTER[1])
    } else {
        SHORTER[0]
    };
    let degree = (stepping.degree + usize::from(!(factor <= MUCH))).min(MAX_TIME_DEGREE);
    shorter(DgStepping { degree, ..stepping }, part)
}

/// Elements and degree of a scene, in words.
pub(super) fn elements_and_degree(scene: &Scene) -> String {
    format!(
        "{} elements of degree {}",
        scene.mesh.elements(),
        scene.degree
    )
}
