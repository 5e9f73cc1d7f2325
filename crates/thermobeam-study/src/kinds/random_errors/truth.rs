//! True errors: runs against one run by dG on a mesh and with steps that no search tries, at own
//! times and in an own norm.
//!
//! Nothing here comes from the searches, so a mistake in their times, their norm or their extremes
//! shows.

use thermobeam::{
    dg::{self, Field},
    mesh::Mesh,
    motion::Motion,
};

use crate::kinds::prelude::*;
use crate::{
    predict::estimate::{Estimate, QuantityKind},
    run::{ObservableMotion, Sample, dg::DgMotion, run_to, simulate},
    scene::{Method, Scene},
};

/// Times in a step of dG at which it is read, in units of its length.
const PARTS: [f64; 5] = [0.04, 0.2, 0.5, 0.85, 1.0];

/// Parts of a step between which the extremes of u(1, t) are located.
const EXTREME_PARTS: usize = 8;

/// Parts of an element in each of which the norm has three points.
const NORM_PARTS: usize = 2;

/// A point of the quadrature of the norm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct QuadraturePoint {
    x: f64,
    weight: f64,
}

/// Three Gauss points in each part of the elements that have the nodes of all meshes.
pub(super) fn points<'m>(meshes: impl Iterator<Item = &'m Mesh>) -> Vec<QuadraturePoint> {
    let mut nodes: Vec<f64> = meshes
        .flat_map(|mesh| mesh.nodes().iter().copied())
        .collect();
    nodes.sort_by(f64::total_cmp);
    nodes.dedup();
    let mut points = vec![];
    for x in nodes.windows(2) {
        let half = 0.5 * (x[1] - x[0]) / NORM_PARTS as f64;
        for part in 0..NORM_PARTS {
            let middle = x[0] + half * (2 * part + 1) as f64;
            for (s, weight) in [
                (-0.6_f64.sqrt(), 5.0 / 9.0),
                (0.0, 8.0 / 9.0),
                (0.6_f64.sqrt(), 5.0 / 9.0),
            ] {
                points.push(QuadraturePoint {
                    x: middle + half * s,
                    weight: half * weight,
                });
            }
        }
    }
    points
}

fn located(motion: &DgMotion, points: &[QuadraturePoint]) -> Vec<dg::BeamPoint> {
    points
        .iter()
        .map(|point| motion.simulation().space().locate(point.x))
        .collect()
}

/// A run at one time.
#[derive(Debug, Clone, PartialEq)]
struct State {
    t: f64,
    /// u(1), φ(1) and the energy.
    numbers: [f64; 3],
    /// v, u_x - φ, w, φ_x and θ at each point of the norm; empty if it is not wanted.
    integrands: Vec<[f64; 5]>,
}

impl State {
    /// * `located`: the points of the norm, if it is wanted.
    fn of_dg(motion: &mut DgMotion, t: f64, located: &[dg::BeamPoint]) -> Self {
        let Sample {
            u_tip,
            phi_tip,
            energy,
            ..
        } = motion.inside(t);
        let simulation = motion.simulation();
        let mut integrands = vec![];
        if !located.is_empty() {
            let mut level = simulation.level().clone();
            simulation.level_into(t, &mut level);
            integrands.extend(located.iter().map(|point| {
                let [(_, u_x), (phi, phi_x), (v, _), (w, _), (theta, _)] =
                    level.values_and_slopes_at(simulation.space(), point);
                [v, u_x - phi, w, phi_x, theta]
            }));
        }
        Self {
            t,
            numbers: [u_tip, phi_tip, energy],
            integrands,
        }
    }
}

/// A run at its own times.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Trace {
    states: Vec<State>,
}

impl Trace {
    /// Runs a scene; with `points`, of the norm, it is by dG.
    pub(super) fn of(scene: &Scene, points: &[QuadraturePoint]) -> Result<Self, CaseFailure> {
        let mut states = vec![];
        match scene.method {
            Method::OneStep(_) => {
                let mut motion = simulate::motion(scene)?;
                run_to(&mut *motion, scene.t_end, |motion, _| {
                    let Sample {
                        t,
                        u_tip,
                        phi_tip,
                        energy,
                        ..
                    } = motion.sample();
                    states.push(State {
                        t,
                        numbers: [u_tip, phi_tip, energy],
                        integrands: vec![],
                    });
                })?;
            }
            Method::Dg(stepping) => {
                let mut motion = DgMotion::new(scene, stepping)?;
                let located = located(&motion, points);
                run_to(&mut motion, scene.t_end, |motion, _| {
                    let (from, to) = (motion.simulation().old_level().t, motion.simulation().t());
                    for part in PARTS {
                        states.push(State::of_dg(
                            motion,
                            (from + part * (to - from)).min(to),
                            &located,
                        ));
                    }
                })?;
            }
        }
        Ok(Self { states })
    }
}

/// The motion that is taken for the true one, at the times of each trace.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Truth {
    traces: Vec<Trace>,
    range: [f64; 2],
    last: [f64; 3],
}

impl Truth {
    /// Runs `scene`, by dG, once for all traces.
    pub(super) fn of(
        scene: &Scene,
        traces: &[&Trace],
        points: &[QuadraturePoint],
    ) -> Result<Self, CaseFailure> {
        let mut motion = DgMotion::new(scene, scene.dg_stepping())?;
        let located = located(&motion, points);
        let mut read: Vec<Trace> = traces.iter().map(|_| Trace { states: vec![] }).collect();
        let mut tips = vec![(0.0, motion.sample().u_tip)];
        run_to(&mut motion, scene.t_end, |motion, _| {
            let (from, to) = (motion.simulation().old_level().t, motion.simulation().t());
            for (trace, read) in traces.iter().zip(&mut read) {
                while let Some(state) = trace.states.get(read.states.len()) {
                    let t = state.t.min(scene.t_end);
                    if t > to {
                        break;
                    }
                    let located = if state.integrands.is_empty() {
                        &[]
                    } else {
                        &located[..]
                    };
                    read.states.push(State::of_dg(motion, t.max(from), located));
                }
            }
            for part in 1..=EXTREME_PARTS {
                let t = (from + (to - from) * part as f64 / EXTREME_PARTS as f64).min(to);
                tips.push((
                    t,
                    motion
                        .simulation()
                        .value(Field::U, 1.0, t)
                        .unwrap_or(f64::NAN),
                ));
            }
        })?;
        let Sample {
            u_tip,
            phi_tip,
            energy,
            ..
        } = motion.sample();
        let range = [
            -largest(tips.iter().map(|(t, u)| (*t, -u)).collect()),
            largest(tips),
        ];
        Ok(Self {
            traces: read,
            range,
            last: [u_tip, phi_tip, energy],
        })
    }

    /// The largest error of a number of trace k.
    pub(super) fn of_curve(&self, k: usize, trace: &Trace, number: usize) -> f64 {
        self.worst(k, trace, |own, exact| {
            (own.numbers[number] - exact.numbers[number]).abs()
        })
    }

    /// The largest error of trace k in the norm of Theorem 3.4.
    pub(super) fn of_norm(&self, k: usize, trace: &Trace, points: &[QuadraturePoint]) -> f64 {
        self.worst(k, trace, |own, exact| {
            let mut square = 0.0;
            for (point, (own, exact)) in points
                .iter()
                .zip(own.integrands.iter().zip(&exact.integrands))
            {
                square += point.weight
                    * own
                        .iter()
                        .zip(exact)
                        .map(|(a, b)| (a - b).powi(2))
                        .sum::<f64>();
            }
            square.sqrt()
        })
    }

    /// The error of an estimated number or curve of trace k.
    pub(super) fn of_estimate(&self, k: usize, trace: &Trace, estimate: &Estimate) -> f64 {
        let number = ["u(1)", "phi(1)", "energy"]
            .iter()
            .position(|name| estimate.name.contains(name))
            .unwrap_or(0);
        match estimate.kind {
            QuantityKind::Curve => self.of_curve(k, trace, number),
            QuantityKind::Largest => (estimate.value - self.range[1]).abs(),
            QuantityKind::Smallest => (estimate.value - self.range[0]).abs(),
            QuantityKind::End => (estimate.value - self.last[number]).abs(),
        }
    }

    fn worst(&self, k: usize, trace: &Trace, distance: impl Fn(&State, &State) -> f64) -> f64 {
        let exact = &self.traces[k].states;
        if exact.len() != trace.states.len() || exact.is_empty() {
            return f64::NAN;
        }
        trace
            .states
            .iter()
            .zip(exact)
            .map(|(own, exact)| distance(own, exact))
            .fold(0.0, max_or_nan)
    }
}

/// The largest value of a curve: that of the parabola through the largest of its points and both
/// neighbours.
fn largest(curve: Vec<(f64, f64)>) -> f64 {
    let most = curve
        .iter()
        .map(|point| point.1)
        .fold(f64::NEG_INFINITY, max_or_nan);
    let peak = curve.windows(3).find(|points| points[1].1 == most);
    let Some([(t0, u0), (t1, u1), (t2, u2)]) =
        peak.and_then(|points| <[_; 3]>::try_from(points).ok())
    else {
        return most;
    };
    let slopes = [(u1 - u0) / (t1 - t0), (u2 - u1) / (t2 - t1)];
    let bend = (slopes[1] - slopes[0]) / (t2 - t0);
    let slope = slopes[0] + bend * (t1 - t0);
    if bend < 0.0 {
        u1 - slope * slope / (4.0 * bend)
    } else {
        most
    }
}
