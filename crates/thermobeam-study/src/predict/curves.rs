//! Runs reduced to their curves: numbers over time, by any method, and the distance between two
//! such runs.

mod any_order;
mod one_step;

use std::ops::ControlFlow;

use convergence_judge::text::number::{max_or_nan, min_or_nan};
use thermobeam::dg::Space;
use thermobeam::motion::TipRange;

use super::{Cost, StopReason, Work};
use crate::run::{ObservableMotion, Report, run};
use crate::scene::{Method, Scene};

/// Maximum number of values kept from a run by a one-step scheme, or from the steps of the largest
/// length by dG.
const MOST_KEPT: usize = 4_000_000;

/// The compared quantities and the required difference: in u(1), φ(1) and the energy, or in the
/// norm.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wanted {
    pub(super) rows: CurveRows,
    pub(super) tolerance: [f64; 3],
}

/// The row of numbers read from a run at one time.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum CurveRows {
    /// u(1).
    Tip,
    /// u(1), φ(1) and the energy.
    Numbers,
    /// Integrands of the norm of Theorem 3.4 at these points.
    Norm(Vec<NormPoint>),
}

/// A Gauss point of the norm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NormPoint {
    x: f64,
    /// The square root of its weight.
    root_weight: f64,
}

impl CurveRows {
    /// The points for the norm: `count` Gauss points in each element.
    pub(super) fn of_norm(nodes: &[f64], count: usize) -> Self {
        let gauss = Space::gauss(count);
        let mut points = vec![];
        for x in nodes.windows(2) {
            let middle = 0.5 * (x[0] + x[1]);
            let half = 0.5 * (x[1] - x[0]);
            for (xi, weight) in &gauss {
                points.push(NormPoint {
                    x: middle + half * xi,
                    root_weight: (half * weight).sqrt(),
                });
            }
        }
        Self::Norm(points)
    }

    /// The same numbers, those of the norm at points of the scene's own mesh: exact for the squares
    /// of its polynomials' errors of degree p + 1, whose zeros are no points.
    pub(super) fn on(&self, scene: &Scene) -> Self {
        match self {
            Self::Norm(_) => Self::of_norm(scene.mesh.nodes(), scene.degree + 2),
            numbers => numbers.clone(),
        }
    }

    /// Numbers in a row.
    fn width(&self) -> usize {
        match self {
            Self::Tip => 1,
            Self::Numbers => 3,
            Self::Norm(points) => 5 * points.len(),
        }
    }

    /// The distance of two rows in units of a tolerance: the largest for single numbers, or that of
    /// the norm.
    fn distance(&self, one: &[f64], other: &[f64], tolerance: &[f64; 3]) -> f64 {
        let differences = one.iter().zip(other).map(|(a, b)| a - b);
        match self {
            Self::Norm(_) => differences.map(|d| d * d).sum::<f64>().sqrt() / tolerance[0],
            _ => differences
                .zip(tolerance)
                .map(|(d, tolerance)| d.abs() / tolerance)
                .fold(0.0, max_or_nan),
        }
    }

    /// Adds the entries of one point to a row, from u_x, φ, φ_x, v, w and θ there.
    fn push(row: &mut Vec<f64>, weight: f64, [u_x, phi, phi_x, v, w, theta]: [f64; 6]) {
        row.extend_from_slice(&[v, u_x - phi, w, phi_x, theta].map(|value| weight * value));
    }
}

/// One of a run's own times of comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Instance {
    pub(super) t: f64,
    /// Time since the start or the last contact event; 0 for a one-step scheme.
    pub(super) since: f64,
    /// Whether the step is longer than normal steps at that distance from the last event: a smaller
    /// `restart_dt` shortens it.
    pub(super) early: bool,
}

/// A run's curves.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Curves {
    /// Times at which they were read, unless these were given.
    pub(super) times: Vec<Instance>,
    /// Numbers in a row.
    pub(super) width: usize,
    /// One row for each time.
    pub(super) values: Vec<f64>,
    /// Smallest and largest u(1, t); for dG also between these times.
    pub(super) range: TipRange,
    /// The cost of the run.
    pub(super) cost: Cost,
}

impl Curves {
    fn new(rows: &CurveRows, u_tip: TipRange) -> Self {
        Self {
            width: rows.width(),
            range: u_tip,
            ..Self::default()
        }
    }

    /// Its own times.
    pub(super) fn own_times(&self) -> Vec<f64> {
        self.times.iter().map(|instance| instance.t).collect()
    }

    /// One number over time.
    pub(super) fn column(&self, k: usize) -> Vec<f64> {
        self.values
            .iter()
            .skip(k)
            .step_by(self.width.max(1))
            .copied()
            .collect()
    }

    fn include(&mut self, tip: TipRange) {
        self.range = TipRange {
            low: min_or_nan(self.range.low, tip.low),
            high: max_or_nan(self.range.high, tip.high),
        };
    }
}

/// Runs a scene.
///
/// * `at`: increasing times of reading, for a one-step scheme ends of steps. `None` selects the
///   run's own times: by dG also inside steps, by a one-step scheme the last level and at most
///   [`one_step::TIMES`] evenly spaced levels before.
///
/// # Errors
/// The scene is refused, a step fails, or the time limit or the work limit is reached.
pub(super) fn curves(
    scene: &Scene,
    rows: &CurveRows,
    times: Option<&[f64]>,
    work: &mut Work<'_>,
) -> Result<Curves, StopReason> {
    let curves = match scene.method {
        Method::OneStep(_) => one_step::curves(scene, rows, times, work),
        Method::Dg(stepping) => any_order::curves(scene, stepping, rows, times, work),
    }?;
    work.ran(&curves.cost);
    Ok(curves)
}

/// Steps a motion to `until`, or to the step at which `read` gives a reason to end.
fn run_within<M: ObservableMotion>(
    motion: &mut M,
    until: f64,
    read: &mut dyn FnMut(&mut M) -> Result<(), StopReason>,
) -> Result<(), StopReason> {
    let mut reason = None;
    let mut watch = |motion: &mut M, _: &Report| {
        reason = read(motion).err();
        Ok(if reason.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        })
    };
    let outcome = run(motion, until, &[], &mut [&mut watch]);
    match reason {
        Some(reason) => Err(reason),
        None => outcome.map_err(StopReason::of_run),
    }
}

/// The largest differences between a run, at its own times, and another, in units of the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Apart {
    /// In early steps.
    pub(super) early: f64,
    /// In the other steps.
    pub(super) late: f64,
    /// Time of the largest difference since the last event, or the start.
    pub(super) since: f64,
    /// Whether there was no event before.
    pub(super) is_before_events: bool,
}

impl Apart {
    /// Differences between `own` and `other`, read at the times of `own`; NaN if the curves do not
    /// match.
    pub(super) fn of(rows: &CurveRows, own: &Curves, other: &Curves, tolerance: &[f64; 3]) -> Self {
        if own.values.len() != other.values.len() || own.values.is_empty() {
            return Self {
                early: f64::NAN,
                late: f64::NAN,
                ..Self::default()
            };
        }
        let mut apart = Self::default();
        let pairs = own
            .values
            .chunks(own.width)
            .zip(other.values.chunks(own.width));
        for (instance, (one, other)) in own.times.iter().zip(pairs) {
            let difference = rows.distance(one, other, tolerance);
            if !(difference <= apart.most()) {
                apart.since = instance.since;
                apart.is_before_events = instance.since == instance.t;
            }
            let part = if instance.early {
                &mut apart.early
            } else {
                &mut apart.late
            };
            *part = max_or_nan(*part, difference);
        }
        apart
    }

    /// In all steps.
    pub(super) fn most(&self) -> f64 {
        max_or_nan(self.early, self.late)
    }
}
