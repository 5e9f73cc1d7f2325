//! What is kept of a run for tables and pictures.

use std::fmt::Write;

use thermobeam::energy::Balance;

use super::Sample;

/// Rows of a history at most: every step up to that many, beyond it every second, third, ... step.
pub const MOST_ROWS: usize = 200_000;

/// Frames at most: twice the columns of a picture over space and time.
const MOST_FRAMES: usize = 440;

/// Nodes of a frame at most: twice the rows of such a picture.
const MOST_FRAME_NODES: usize = 281;

/// Terms of the energy's balance, added up over the steps since the row before: they add up to `residual`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dissipation {
    /// Change of E.
    pub change: f64,
    /// What viscosity takes.
    pub viscous: f64,
    /// What heat conduction takes.
    pub thermal: f64,
    /// What the scheme's inertia takes, beyond physics.
    pub inertial: f64,
    /// What the scheme's contact takes, beyond physics.
    pub contact_gap: f64,
    /// The sum of the five: round-off.
    pub residual: f64,
}

impl Dissipation {
    fn add(&mut self, balance: &Balance) {
        self.change += balance.change;
        self.viscous += balance.viscous;
        self.thermal += balance.thermal;
        self.inertial += balance.inertial;
        self.contact_gap += balance.contact;
        self.residual += balance.residual;
    }
}

/// A row of the history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// The level.
    pub sample: Sample,
    /// What happened to the energy on the way to it; zeros at the start.
    pub dissipation: Dissipation,
}

/// u(x, t), thinned to what a picture can show.
#[derive(Debug, Clone, PartialEq)]
pub struct Frames {
    /// Times of the frames.
    pub times: Vec<f64>,
    /// The nodes that are kept, both ends among them.
    pub nodes: Vec<f64>,
    /// `u[n][i]` belongs to `times[n]` and `nodes[i]`.
    pub u: Vec<Vec<f64>>,
    kept: Vec<usize>,
}

/// The history of a run: start and end always, in between evenly thinned.
#[derive(Debug, Clone, PartialEq)]
pub struct RunHistory {
    /// The rows.
    pub rows: Vec<Row>,
    /// Steps from one row to the next; the last may follow sooner.
    pub steps_per_row: usize,
    /// The displacement.
    pub frames: Frames,
    steps_per_frame: usize,
    since_row: Dissipation,
}

impl RunHistory {
    pub(super) fn new(nodes: &[f64], steps: usize, first: Sample, u: &[f64]) -> Self {
        let steps_per_row = steps.div_ceil(MOST_ROWS).max(1);
        let steps_per_frame = steps.div_ceil(MOST_FRAMES).max(1);
        let mut rows = Vec::with_capacity(steps / steps_per_row + 2);
        rows.push(Row { sample: first, dissipation: Dissipation::default() });
        let mut frames = Frames::new(nodes);
        frames.push(first.t, u);
        Self { rows, steps_per_row, frames, steps_per_frame, since_row: Dissipation::default() }
    }

    pub(super) fn add(&mut self, step: usize, balance: &Balance, u: &[f64], sample: impl FnOnce() -> Sample) {
        self.since_row.add(balance);
        let (row, frame) = (step.is_multiple_of(self.steps_per_row), step.is_multiple_of(self.steps_per_frame));
        if !row && !frame {
            return;
        }
        let sample = sample();
        if row {
            self.push_row(sample);
        }
        if frame {
            self.frames.push(sample.t, u);
        }
    }

    /// Adds the last level, unless it is there already.
    pub(super) fn finish(&mut self, last: Sample, u: &[f64]) {
        if self.rows.last().is_none_or(|row| row.sample.t < last.t) {
            self.push_row(last);
        }
        if self.frames.times.last().is_none_or(|&t| t < last.t) {
            self.frames.push(last.t, u);
        }
    }

    fn push_row(&mut self, sample: Sample) {
        self.rows.push(Row { sample, dissipation: std::mem::take(&mut self.since_row) });
    }

    /// The history as comma-separated values, with enough digits to read back every bit.
    pub fn csv(&self) -> String {
        let mut csv = String::from(
            "t,u_tip,phi_tip,u_t_tip,phi_t_tip,theta_mid,contact_force,energy,\
             energy_change,viscous,thermal,inertial,contact_gap,residual\n",
        );
        for Row { sample: s, dissipation: d } in &self.rows {
            let sample = [s.t, s.u_tip, s.phi_tip, s.u_t_tip, s.phi_t_tip, s.theta_mid, s.contact_force, s.energy];
            let terms = [d.change, d.viscous, d.thermal, d.inertial, d.contact_gap, d.residual];
            for (k, value) in sample.iter().chain(&terms).enumerate() {
                let comma = if k == 0 { "" } else { "," };
                // Debug, unlike Display, writes 1e-14 as such. Writing to a string cannot fail.
                let _ = write!(csv, "{comma}{value:?}");
            }
            csv.push('\n');
        }
        csv
    }

    /// Intervals of time in which the free end was in contact, from the rows.
    pub(super) fn contact_phases(&self) -> Vec<(f64, f64)> {
        let mut phases: Vec<(f64, f64)> = Vec::new();
        let mut touching = false;
        for Row { sample, .. } in &self.rows {
            match (sample.contact_force != 0.0, phases.last_mut()) {
                (true, Some(phase)) if touching => phase.1 = sample.t,
                (true, _) => phases.push((sample.t, sample.t)),
                (false, _) => {}
            }
            touching = sample.contact_force != 0.0;
        }
        phases
    }
}

impl Frames {
    fn new(nodes: &[f64]) -> Self {
        let last = nodes.len() - 1;
        let intervals = last.min(MOST_FRAME_NODES - 1);
        let kept: Vec<usize> = (0..=intervals).map(|k| k * last / intervals).collect();
        Self { times: vec![], nodes: kept.iter().map(|&i| nodes[i]).collect(), u: vec![], kept }
    }

    fn push(&mut self, t: f64, u: &[f64]) {
        self.times.push(t);
        self.u.push(self.kept.iter().map(|&i| u[i]).collect());
    }
}
