//! Figures of a convergence study.

use crate::kinds::convergence::file::ConvergenceSpec;
use convergence_study::judge::verdict::RateVerdict;
use convergence_study::plots;
use convergence_study::study::Axis;
use convergence_study::study::outcome::{Figure, LevelErrors};

/// Errors over the step in the norms judged, with fitted lines and slope triangles.
pub(super) fn rates(
    spec: &ConvergenceSpec,
    levels: &[LevelErrors],
    rates: &[(String, RateVerdict)],
    step: impl Fn(&LevelErrors) -> f64,
) -> Figure {
    let series = rates.iter().map(|(norm, rate)| {
        let points: Vec<(f64, f64)> = levels.iter().map(|level| (step(level), level.error(norm))).collect();
        let fit = rate.fitted.and_then(|rate| through_finest(&points, rate));
        plots::ErrorSeries { label: norm.clone(), points, order: Some(rate.order), fit, baseline: vec![] }
    });
    let mut slopes: Vec<f64> = rates.iter().map(|(_, rate)| rate.order).collect();
    slopes.sort_by(f64::total_cmp);
    slopes.dedup();
    let figure = match spec.refine.axis {
        Axis::Time => plots::Convergence::in_time(),
        Axis::Space | Axis::Both => plots::Convergence::in_space(),
    };
    let svg = plots::convergence(&plots::Convergence { series: series.collect(), slopes, ..figure });
    let what = match spec.refine.axis {
        Axis::Space => "the mesh width 1/n",
        Axis::Time => "the time step",
        Axis::Both => "the mesh width 1/n, refined together with the time step",
    };
    Figure {
        file: format!("{}-rates.svg", spec.id),
        caption: format!("Errors over {what}, with the rates observed (lines) and the orders of theory (triangles)."),
        svg,
    }
}

/// The line of that rate through the finest point.
fn through_finest(points: &[(f64, f64)], rate: f64) -> Option<plots::PowerLaw> {
    let &(step, error) = points.last()?;
    (error > 0.0).then(|| plots::PowerLaw { rate, constant: error / step.powf(rate) })
}

/// The error over the grid of (h, dt).
pub(super) fn surface(spec: &ConvergenceSpec, levels: &[LevelErrors], norm: &str) -> Figure {
    let h: Vec<f64> = spec.refine.elements.iter().map(|&n| 1.0 / n as f64).collect();
    let dt: Vec<f64> = spec.refine.steps.iter().map(|&steps| spec.refine.dt(steps)).collect();
    // The cases run over the steps first, elements being the outer loop.
    let error = |k: usize, j: usize| levels.get(j * dt.len() + k).map_or(f64::NAN, |level| level.error(norm));
    let values = (0..dt.len()).map(|k| (0..h.len()).map(|j| error(k, j)).collect()).collect();
    let svg = plots::surface(&plots::Surface {
        x: plots::Axis::log("mesh width h (dimensionless)"),
        y: plots::Axis::log("time step dt (dimensionless)"),
        z: plots::Axis::log(format!("error, {norm}")),
        x_values: h,
        y_values: dt,
        values,
        ..plots::Surface::default()
    });
    Figure {
        file: format!("{}-surface-{norm}.svg", spec.id),
        caption: format!("Error in the norm `{norm}` over mesh width and time step."),
        svg,
    }
}
