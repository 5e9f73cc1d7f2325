//! Runs reduced to their curves: numbers over time, by any method, and the distance between two
//! such runs.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use convergence_judge::text::number::{max_or_nan, min_or_nan};
use thermobeam::dg::{self, Dg, DgLevel, DgStepping, Field};
use thermobeam::mesh::Mesh;
use thermobeam::motion::{Motion, TipRange};
use thermobeam::solve::Level;

use super::{Cost, Reason, Work};
use crate::run::dg::DgMotion;
use crate::run::driver::Driver;
use crate::run::{ObservableMotion, Report, run, simulate};
use crate::scene::{Method, Scene};

/// Times of comparison in a step of dG, including its end: dense at its ends, since a layer at the
/// start may be shorter than the step.
const POINTS: usize = 12;

/// Maximum number of compared steps of the largest length; longer runs skip steps evenly.
const MOST_LONG_STEPS: f64 = 20_000.0;

/// Maximum number of times at which a one-step scheme is read.
const TIMES: usize = 4000;

/// Maximum number of values kept from a run by a one-step scheme, or from the steps of the largest
/// length by dG.
const MOST_KEPT: usize = 4_000_000;

/// The compared quantities and the required difference: in u(1), φ(1) and the energy, or in the
/// norm.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wanted {
    pub(super) rows: Rows,
    pub(super) tolerance: [f64; 3],
}

/// The row of numbers read from a run at one time.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Rows {
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

impl Rows {
    /// The points for the norm: `count` Gauss points in each element.
    pub(super) fn of_norm(nodes: &[f64], count: usize) -> Self {
        let gauss = dg::Space::gauss(count);
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

    /// The points of the norm in a space.
    fn located(&self, space: &dg::Space) -> Vec<dg::Point> {
        match self {
            Self::Norm(points) => points.iter().map(|point| space.locate(point.x)).collect(),
            _ => vec![],
        }
    }

    fn of_dg(
        &self,
        simulation: &Dg,
        t: f64,
        located: &[dg::Point],
        level: &mut DgLevel,
        row: &mut Vec<f64>,
    ) {
        if let Self::Tip = self {
            row.push(simulation.value(Field::U, 1.0, t).unwrap_or(f64::NAN));
            return;
        }
        simulation.level_into(t, level);
        let space = simulation.space();
        let Self::Norm(points) = self else {
            row.extend(
                [Field::U, Field::Phi].map(|field| level.value_and_slope(space, field, 1.0).0),
            );
            return row.push(simulation.energy(level).total());
        };
        for (NormPoint { root_weight, .. }, point) in points.iter().zip(located) {
            let [(_, u_x), (phi, phi_x), (v, _), (w, _), (theta, _)] =
                level.values_and_slopes_at(space, point);
            Self::push(row, *root_weight, [u_x, phi, phi_x, v, w, theta]);
        }
    }

    fn of_one_step(
        &self,
        mesh: &Mesh,
        level: &Level,
        energy: impl FnOnce() -> f64,
        row: &mut Vec<f64>,
    ) {
        let (last, nodes) = (mesh.elements(), mesh.nodes());
        let Self::Norm(points) = self else {
            row.push(level.u[last]);
            if let Self::Numbers = self {
                row.extend([level.phi[last], energy()]);
            }
            return;
        };
        let mut i = 0;
        for &NormPoint { x, root_weight } in points {
            while nodes[i + 1] < x {
                i += 1;
            }
            let h = nodes[i + 1] - nodes[i];
            let value = |y: &[f64]| y[i] + (y[i + 1] - y[i]) * ((x - nodes[i]) / h);
            let slope = |y: &[f64]| (y[i + 1] - y[i]) / h;
            let [v, w, theta] = [&level.v, &level.w, &level.theta].map(|y| value(y));
            Self::push(
                row,
                root_weight,
                [
                    slope(&level.u),
                    value(&level.phi),
                    slope(&level.phi),
                    v,
                    w,
                    theta,
                ],
            );
        }
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
    fn new(rows: &Rows, u_tip: TipRange) -> Self {
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
///   [`TIMES`] evenly spaced levels before.
///
/// # Errors
/// The scene is refused, a step fails, or the time limit or the work limit is reached.
pub(super) fn curves(
    scene: &Scene,
    rows: &Rows,
    times: Option<&[f64]>,
    work: &mut Work<'_>,
) -> Result<Curves, Reason> {
    let curves = match scene.method {
        Method::OneStep(_) => by_one_step(scene, rows, times, work),
        Method::Dg(stepping) => by_dg(scene, stepping, rows, times, work),
    }?;
    work.ran(&curves.cost);
    Ok(curves)
}

/// Steps a motion to `until`, or to the step at which `read` gives a reason to end.
fn run_within<M: ObservableMotion>(
    motion: &mut M,
    until: f64,
    read: &mut dyn FnMut(&mut M) -> Result<(), Reason>,
) -> Result<(), Reason> {
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
        None => outcome.map_err(Reason::of_run),
    }
}

fn by_dg(
    scene: &Scene,
    stepping: DgStepping,
    rows: &Rows,
    times: Option<&[f64]>,
    work: &mut Work<'_>,
) -> Result<Curves, Reason> {
    let mut motion = DgMotion::new(scene, stepping).map_err(Reason::of_run)?;
    let unknowns = 3 * motion.simulation().space().blocks() * (stepping.degree + 1);
    let mut curves = Curves::new(rows, motion.motion().tip_range());
    let mut level = motion.simulation().level().clone();
    let located = rows.located(motion.simulation().space());
    let mut passed = 0;
    let mut long = 0_usize;
    let mut solves = 0;
    let early = stepping.restart_dt / (stepping.growth - 1.0);
    let most = MOST_LONG_STEPS.min((MOST_KEPT / (POINTS * rows.width())).max(1) as f64);
    let stride = (scene.t_end / stepping.dt / most).ceil().max(1.0) as usize;
    let mut read = |motion: &mut DgMotion| {
        let simulation = motion.simulation();
        let done = simulation.work().passes;
        work.add((unknowns * (done - solves)) as f64)?;
        solves = done;
        let (from, to) = (simulation.old_level().t, simulation.t());
        curves.include(simulation.tip_range());
        if let Some(times) = times {
            while let Some(&t) = times.get(passed).filter(|t| **t <= to) {
                rows.of_dg(simulation, t, &located, &mut level, &mut curves.values);
                passed += 1;
            }
            return Ok(());
        }
        let is_long = to - from >= stepping.dt && to < scene.t_end;
        long += usize::from(is_long);
        if is_long && !long.is_multiple_of(stride) {
            return Ok(());
        }
        for instance in instances(simulation, early) {
            rows.of_dg(
                simulation,
                instance.t,
                &located,
                &mut level,
                &mut curves.values,
            );
            curves.times.push(instance);
        }
        Ok(())
    };
    run_within(&mut motion, scene.t_end, &mut read)?;
    curves.cost = Cost {
        work: (unknowns * solves) as f64,
        seconds: motion.work().wall.as_secs_f64(),
        runs: 1,
    };
    Ok(curves)
}

/// Times in the last step; a step is early if it is closer than `early` to the start or an event.
fn instances(simulation: &Dg, early: f64) -> [Instance; POINTS] {
    let (from, to) = (simulation.old_level().t, simulation.t());
    let event = simulation
        .events()
        .iter()
        .rev()
        .map(|event| event.t)
        .find(|t| *t <= from)
        .unwrap_or(0.0);
    std::array::from_fn(|point| {
        let s = 0.5 * (1.0 - (PI * (point + 1) as f64 / POINTS as f64).cos());
        let t = if point + 1 == POINTS {
            to
        } else {
            from + s * (to - from)
        };
        Instance {
            t,
            since: t - event,
            early: from - event < early,
        }
    })
}

fn by_one_step(
    scene: &Scene,
    rows: &Rows,
    times: Option<&[f64]>,
    work: &mut Work<'_>,
) -> Result<Curves, Reason> {
    let mut driver = simulate::driver(scene).map_err(Reason::of_run)?.timed();
    let (elements, steps) = (scene.mesh.elements(), scene.steps());
    let every = steps.div_ceil(TIMES.min(MOST_KEPT / rows.width()).max(1));
    let tip = driver.level().u[elements];
    let mut curves = Curves::new(rows, TipRange::at(tip));
    let mut read = |driver: &mut Driver<'_>| {
        let simulation = driver.simulation();
        let new = driver.level();
        let n = driver.work().steps;
        curves.include(TipRange::at(new.u[elements]));
        let t = simulation.t();
        let is_read = match times {
            None => n.is_multiple_of(every) || n == steps,
            // Up to rounding, steps of half the length end there.
            Some(times) => times
                .get(curves.times.len())
                .is_some_and(|time| t >= time - 0.5 * simulation.dt()),
        };
        if is_read {
            curves.times.push(Instance {
                t,
                since: 0.0,
                early: false,
            });
            rows.of_one_step(
                &scene.mesh,
                new,
                || simulation.energy(new).total(),
                &mut curves.values,
            );
        }
        work.add(elements as f64)
    };
    run_within(&mut driver, scene.t_end, &mut read)?;
    curves.cost = Cost {
        work: (elements * steps) as f64,
        seconds: driver.work().wall.as_secs_f64(),
        runs: 1,
    };
    Ok(curves)
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
    pub(super) fn of(rows: &Rows, own: &Curves, other: &Curves, tolerance: &[f64; 3]) -> Self {
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
