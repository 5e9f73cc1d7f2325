//! Curves of a run by elements of any degree and dG, which are read inside of steps, too.

use std::f64::consts::PI;

use thermobeam::dg::{self, Dg, DgLevel, DgStepping, Field};
use thermobeam::motion::Motion;

use super::{CurveRows, Curves, Instance, MOST_KEPT, NormPoint, run_within};
use crate::predict::{Cost, StopReason, Work};
use crate::run::ObservableMotion;
use crate::run::dg::DgMotion;
use crate::scene::Scene;

/// Times of comparison in a step of dG, including its end: dense at its ends, since a layer at the
/// start may be shorter than the step.
const POINTS: usize = 12;

/// Maximum number of compared steps of the largest length; longer runs skip steps evenly.
const MOST_LONG_STEPS: f64 = 20_000.0;

impl CurveRows {
    /// The points of the norm in a space.
    fn located(&self, space: &dg::Space) -> Vec<dg::BeamPoint> {
        match self {
            Self::Norm(points) => points.iter().map(|point| space.locate(point.x)).collect(),
            _ => vec![],
        }
    }

    fn of_dg(
        &self,
        simulation: &Dg,
        t: f64,
        located: &[dg::BeamPoint],
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
}

pub(super) fn curves(
    scene: &Scene,
    stepping: DgStepping,
    rows: &CurveRows,
    times: Option<&[f64]>,
    work: &mut Work<'_>,
) -> Result<Curves, StopReason> {
    let mut motion = DgMotion::new(scene, stepping).map_err(StopReason::of_run)?;
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
