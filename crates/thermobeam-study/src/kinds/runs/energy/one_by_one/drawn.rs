//! Figures of the runs that are drawn, and the table of their largest residuals.

use super::{EnergyAt, EnergyHistory, EnergyRun, EnergyRuns};
use crate::figures::looks;
use crate::kinds::prelude::*;
use convergence_judge::text::number::plain_text;
use convergence_study::internal::plots::{self, xy::Xy};

/// Curves of all runs drawn.
fn curves(
    drawn: &[(&EnergyRun, &EnergyHistory)],
    label: fn(&EnergyRun) -> String,
    point: fn(&EnergyAt) -> (f64, f64),
) -> Vec<plots::Series> {
    let mut curves = vec![];
    for (run, found) in drawn {
        let points = found.samples.iter().map(point);
        curves.push(plots::Series::new(label(run), points));
    }
    curves
}

/// The quantities in which the runs of a study differ.
fn quantities(run: &EnergyRun) -> String {
    let beam = &run.problem.beam;
    format!("θ_A = {}, β = {}", beam.theta_a, beam.beta).replace('-', "−")
}

fn scene(run: &EnergyRun) -> String {
    run.scene().to_owned()
}

impl EnergyRuns {
    pub(super) fn figure(&self, drawn: &[(&EnergyRun, &EnergyHistory)]) -> Option<Figure> {
        if drawn.is_empty() {
            None
        } else if self.histories {
            Some(energies(drawn))
        } else {
            Some(drifts(drawn))
        }
    }

    /// The largest residual of the runs drawn: it is reached within a few steps, so that a curve
    /// shows no more.
    pub(super) fn balance(&self, drawn: &[(&EnergyRun, &EnergyHistory)]) -> Option<Table> {
        let rows = drawn.iter().map(|(run, found)| {
            vec![
                run.scene().to_owned(),
                format!("{:.1e}", found.worst.residual),
                run.share.map_or_else(String::new, plain_text),
            ]
        });
        let title = "Largest residual of the energy balance in a step, over the initial energy";
        let head = ["scene", "residual", "allowed"];
        (self.histories && !drawn.is_empty()).then(|| Table::new(title, head, rows))
    }
}

/// The change of the energy is negative; a rise would have no place on a logarithmic axis, and
/// would be counted below the figure.
fn energies(drawn: &[(&EnergyRun, &EnergyHistory)]) -> Figure {
    let mut losses = curves(drawn, quantities, |sample| (sample.t, -sample.change));
    for series in &mut losses {
        series.points.retain(|(_, loss)| !loss.is_nan());
    }
    let axis = plots::Axis::log("least energy lost in a step / initial energy");
    let loss = plots::history(axis, &losses)
        .with_looks(&looks(drawn.iter().map(|(run, _)| run.scene())))
        .titled("Every step loses energy");
    let caption =
        "Least loss of energy in a step, in units of the initial energy: it is never negative.";
    Figure::new("energy", caption, loss.draw())
}

/// With a line for each bound that the runs drawn must keep.
fn drifts(drawn: &[(&EnergyRun, &EnergyHistory)]) -> Figure {
    let mut bounds: Vec<f64> = drawn.iter().filter_map(|(run, _)| run.drift).collect();
    bounds.sort_by(f64::total_cmp);
    bounds.dedup();
    let mut guides = vec![];
    for value in bounds {
        guides.push(plots::Guide {
            label: "allowed".to_owned(),
            value,
        });
    }
    let mut drifts = curves(drawn, scene, |sample| {
        (sample.step as f64, sample.drift.abs())
    });
    // Exactly zero, such as at the start, has no place on a logarithmic axis.
    for series in &mut drifts {
        series.points.retain(|(_, value)| *value != 0.0);
    }
    let drift = Xy {
        x: plots::Axis::linear("steps"),
        guides,
        ..plots::history(plots::Axis::log("|sum of residuals| / energy"), &drifts)
    };
    let caption = "Sum of the signed residuals of the energy balance up to each step.";
    let title = "The residuals of the balance do not add up";
    Figure::new("drift", caption, drift.titled(title).draw())
}
