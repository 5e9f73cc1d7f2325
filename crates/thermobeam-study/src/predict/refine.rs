//! Finer discretisations: those that a scene is compared with, and the next one of a search.

use thermobeam::dg::{DgStepping, MAX_DEGREE, MAX_TIME_DEGREE};
use thermobeam::mesh::Mesh;

use super::StopReason;
use super::curves::Apart;
use super::data::{GRADING, MOST_ELEMENTS};
use super::policy::Policy;
use crate::scene::{Method, Scene, resampled};

impl Policy {
    /// The scene, refined where a difference exceeds its share; `None` if no finer elements are
    /// possible.
    ///
    /// * `kinks`: points of the initial data from which layers begin at the start.
    pub(super) fn refined(
        &self,
        scene: &Scene,
        space: &Apart,
        time: &Apart,
        kinks: &[f64],
    ) -> Option<Scene> {
        let mut next = scene.clone();
        let mut stepping = scene.dg_stepping();
        if !(space.most() <= self.share) {
            next = self.more_space(&next, space, space.most() / self.share, kinks)?;
        }
        if !(time.late <= self.share) {
            stepping = self.more_time(stepping, time.late / self.share);
        }
        if !(time.early <= self.share) {
            let restart_dt =
                scene.dg_stepping().restart_dt / self.shortening(time.early / self.share);
            stepping.restart_dt = stepping.restart_dt.min(restart_dt);
        }
        Some(Scene {
            method: Method::Dg(stepping),
            ..next
        })
    }

    /// The scene with only space refined, and with only steps refined.
    ///
    /// For dG: p + 4 or the longest elements halved, and all steps halved, with even shorter first
    /// steps, since the error there falls more slowly. For a one-step scheme: twice the elements,
    /// and dt/2.
    pub(super) fn finer(&self, scene: &Scene) -> [Result<Scene, StopReason>; 2] {
        let Method::Dg(stepping) = scene.method else {
            let (elements, steps) = (scene.mesh.elements(), scene.steps());
            return [(2 * elements, steps), (elements, 2 * steps)].map(|(elements, steps)| {
                let mesh = resampled(&scene.mesh, elements).map_err(StopReason::of_run)?;
                Ok(scene.with_steps(mesh, steps, scene.t_end))
            });
        };
        let raised = scene.degree + self.finer_degrees;
        let space = if raised <= MAX_DEGREE {
            Some(Scene {
                degree: raised,
                ..scene.clone()
            })
        } else {
            self.halved(scene)
        };
        let half = self.shorter(stepping, 0.5);
        let method = Method::Dg(DgStepping {
            restart_dt: 0.5 * half.restart_dt,
            ..half
        });
        [
            space.ok_or(StopReason::Finest),
            Ok(Scene {
                method,
                ..scene.clone()
            }),
        ]
    }

    /// The long elements halved.
    fn halved(&self, scene: &Scene) -> Option<Scene> {
        let mesh = &scene.mesh;
        let mut nodes = vec![];
        for x in mesh.nodes().windows(2) {
            nodes.push(x[0]);
            if x[1] - x[0] >= self.long_element * mesh.size() {
                nodes.push(0.5 * (x[0] + x[1]));
            }
        }
        nodes.push(1.0);
        on(scene, nodes)
    }

    /// Space refined for an error smaller by `factor`; `apart` is the difference.
    fn more_space(
        &self,
        scene: &Scene,
        apart: &Apart,
        factor: f64,
        kinks: &[f64],
    ) -> Option<Scene> {
        let layer = (scene.beam.zeta * apart.since).sqrt();
        let kinks = if apart.is_before_events { kinks } else { &[] };
        let mut nodes = vec![0.0];
        for x in scene.mesh.nodes().windows(2) {
            let part = (x[1] - x[0]) / GRADING;
            let is_coarse =
                layer < self.resolved_layer * GRADING * part / (scene.degree * scene.degree) as f64;
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
        let wanted = (factor.ln() / self.fall_per_degree.ln()).ceil();
        let degrees = if wanted.is_finite() {
            (wanted as usize).clamp(2, self.most_degrees)
        } else {
            self.most_degrees
        };
        let degree = scene.degree + degrees + degrees % 2;
        if degree <= self.highest_degree {
            return Some(Scene {
                degree,
                ..scene.clone()
            });
        }
        self.halved(scene)
    }

    /// All steps multiplied by `part`.
    fn shorter(&self, stepping: DgStepping, part: f64) -> DgStepping {
        let DgStepping {
            dt,
            restart_dt,
            growth,
            ..
        } = stepping;
        let growth = (1.0 + part * (growth - 1.0)).max(self.least_growth.min(growth));
        DgStepping {
            dt: part * dt,
            restart_dt: part * restart_dt,
            growth,
            ..stepping
        }
    }

    /// The divisor of `restart_dt` for an error in the first steps smaller by `factor`.
    fn shortening(&self, factor: f64) -> f64 {
        let wanted = (1.5 * factor).powf(1.0 / self.start_rate);
        if wanted.is_finite() {
            wanted.clamp(self.start_divisors[0], self.start_divisors[1])
        } else {
            self.start_divisors[1]
        }
    }

    /// Steps refined for an error smaller by `factor`.
    fn more_time(&self, stepping: DgStepping, factor: f64) -> DgStepping {
        let part = (1.5 * factor).powf(-1.0 / self.event_rate);
        let part = if part.is_finite() {
            part.clamp(self.step_factors[0], self.step_factors[1])
        } else {
            self.step_factors[0]
        };
        let degree =
            (stepping.degree + usize::from(!(factor <= self.large_factor))).min(MAX_TIME_DEGREE);
        self.shorter(DgStepping { degree, ..stepping }, part)
    }
}

/// The scene on the mesh with these nodes; `None` if there are too many, or elements are too short.
fn on(scene: &Scene, nodes: Vec<f64>) -> Option<Scene> {
    let mesh = (nodes.len() <= MOST_ELEMENTS + 1)
        .then(|| Mesh::from_nodes(nodes).ok())
        .flatten()?;
    Some(Scene {
        mesh,
        ..scene.clone()
    })
}

/// Elements and degree of a scene, in words.
pub(super) fn elements_and_degree(scene: &Scene) -> String {
    format!(
        "{} elements of degree {}",
        scene.mesh.elements(),
        scene.degree
    )
}
