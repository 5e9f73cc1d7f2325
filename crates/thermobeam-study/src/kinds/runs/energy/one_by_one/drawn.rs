//! Figures of the runs that are drawn.

use super::{EnergyAt, EnergyHistory, EnergyRun, EnergyRuns};
use crate::figures::styles;
use crate::kinds::prelude::*;
use convergence_study::chart::{self, Chart, Guide};

/// The quantities in which the runs of a study differ.
fn quantities(run: &EnergyRun) -> String {
    let beam = &run.problem.beam;
    format!("θ_A = {}, β = {}", beam.theta_a, beam.beta).replace('-', "−")
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
}

/// The change of the energy is negative; a rise would have no place on a logarithmic axis, and
/// would be counted below the figure.
fn energies(drawn: &[(&EnergyRun, &EnergyHistory)]) -> Figure {
    let y = chart::Axis::log("least energy lost in a step / initial energy");
    let mut loss = Chart::empty(chart::Axis::linear("time t"), y);
    let styles = styles(drawn.iter().map(|(run, _)| run.scene()));
    for ((run, found), style) in drawn.iter().zip(styles) {
        let points = found
            .samples
            .iter()
            .map(|sample| (sample.t, -sample.change));
        let known = points.filter(|(_, loss)| !loss.is_nan());
        loss.curve(quantities(run), known).style = Some(style);
    }
    let rises = |sample: &EnergyAt| sample.change > 0.0;
    let rises = drawn
        .iter()
        .any(|(_, found)| found.samples.iter().any(rises));
    let loss = loss.titled_where(!rises, "Every step loses energy");
    let caption =
        "Least loss of energy in a step, in units of the initial energy: it is never negative.";
    Figure::of("energy", caption, loss)
}

/// With a line for each bound that the runs drawn must keep.
fn drifts(drawn: &[(&EnergyRun, &EnergyHistory)]) -> Figure {
    let mut bounds: Vec<f64> = drawn.iter().filter_map(|(run, _)| run.drift).collect();
    bounds.sort_by(f64::total_cmp);
    bounds.dedup();
    let mut guides = vec![];
    for value in bounds {
        guides.push(Guide {
            label: "allowed".to_owned(),
            value,
        });
    }
    let y = chart::Axis::log("|sum of residuals| / energy");
    let mut drift = Chart {
        guides,
        ..Chart::empty(chart::Axis::linear("steps"), y)
    };
    let mut is_within = true;
    for (run, found) in drawn {
        let points = found
            .samples
            .iter()
            .map(|sample| (sample.step as f64, sample.drift.abs()));
        // Exactly zero, such as at the start, has no place on a logarithmic axis.
        let shown = points.filter(|(_, value)| *value != 0.0);
        is_within &= shown
            .clone()
            .all(|(_, value)| run.drift.is_none_or(|most| value <= most));
        drift.curve(run.scene(), shown);
    }
    let caption = "Sum of the signed residuals of the energy balance up to each step.";
    let title = "The residuals of the balance do not add up";
    Figure::of("drift", caption, drift.titled_where(is_within, title))
}
