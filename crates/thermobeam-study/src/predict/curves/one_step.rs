//! Curves of a run by a one-step scheme, which are read at ends of steps.

use thermobeam::mesh::Mesh;
use thermobeam::motion::{Motion, TipRange};
use thermobeam::solve::Level;

use super::{CurveRows, Curves, Instance, MOST_KEPT, NormPoint, run_within};
use crate::predict::{Cost, StopReason, Work};
use crate::run::driver::Driver;
use crate::run::{ObservableMotion, simulate};
use crate::scene::Scene;

/// Maximum number of times at which a one-step scheme is read.
pub(super) const TIMES: usize = 4000;

impl CurveRows {
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

pub(super) fn curves(
    scene: &Scene,
    rows: &CurveRows,
    times: Option<&[f64]>,
    work: &mut Work<'_>,
) -> Result<Curves, StopReason> {
    let mut driver = simulate::driver(scene).map_err(StopReason::of_run)?.timed();
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
