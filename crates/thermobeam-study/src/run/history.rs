//! What is kept from a run for tables and pictures.

use std::fmt::Write;
use std::ops::ControlFlow;

use thermobeam::energy::Balance;
use thermobeam::motion::StepReport;

use super::{AnyMotion, RunError, Sample, Watch};

/// Maximum number of frames after the first: even noise, in which no neighbours are equal, then
/// makes a picture of less than 400 kB.
const FRAMES: usize = 200;

/// A row of the history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryRow {
    /// The state.
    pub sample: Sample,
    /// The terms of the energy's balance, summed over the steps since the previous row; zeros at
    /// the start and without pictures.
    pub balance: Balance,
}

/// u(x, t), thinned to the resolution of a picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Frames {
    /// Times of the frames.
    pub times: Vec<f64>,
    /// Points x, including both ends.
    pub points: Vec<f64>,
    /// `u[n][i]` belongs to `times[n]` and `points[i]`.
    pub u: Vec<Vec<f64>>,
}

/// The history of a run: start, end, and evenly thinned steps in between.
#[derive(Debug, Clone, PartialEq)]
pub struct RunHistory {
    /// The rows.
    pub rows: Vec<HistoryRow>,
    /// The displacement; empty without pictures.
    pub frames: Frames,
    t_end: f64,
    /// Number of equal time intervals, with a row at the end of each.
    parts: usize,
    since_row: Balance,
}

impl RunHistory {
    /// With frames.
    ///
    /// * `parts`: approximate number of rows after the first.
    pub(super) fn new(start: &AnyMotion, t_end: f64, parts: usize, first: Sample) -> Self {
        Self {
            frames: Frames {
                points: start.points(),
                times: vec![first.t],
                u: vec![start.shape(first.t)],
            },
            ..Self::without_frames(t_end, parts, first)
        }
    }

    /// The rows alone, see [`RunHistory::new`].
    pub(super) fn without_frames(t_end: f64, parts: usize, first: Sample) -> Self {
        Self {
            rows: vec![HistoryRow {
                sample: first,
                balance: Balance::default(),
            }],
            frames: Frames::default(),
            t_end,
            parts,
            since_row: Balance::default(),
        }
    }

    /// Adds the last level unless it is already there.
    pub(super) fn finish(&mut self, end: &AnyMotion, last: Sample) {
        if self.rows.last().is_none_or(|row| row.sample.t < last.t) {
            self.push_row(last);
        }
        if self.frames.times.last().is_some_and(|&t| t < last.t) {
            self.push_frame(end, last.t);
        }
    }

    fn push_row(&mut self, sample: Sample) {
        self.rows.push(HistoryRow {
            sample,
            balance: std::mem::take(&mut self.since_row),
        });
    }

    fn push_frame(&mut self, motion: &AnyMotion, t: f64) {
        self.frames.times.push(t);
        self.frames.u.push(motion.shape(t));
    }

    /// u(1) over time.
    pub fn tip(&self) -> Vec<(f64, f64)> {
        self.over_time(|sample| sample.u_tip)
    }

    /// A number over time.
    pub(crate) fn over_time(&self, value: fn(&Sample) -> f64) -> Vec<(f64, f64)> {
        self.rows
            .iter()
            .map(|row| (row.sample.t, value(&row.sample)))
            .collect()
    }

    /// The history as comma-separated values, with enough digits to read back every bit.
    pub fn csv(&self) -> String {
        let mut csv = String::from(
            "t,u_tip,phi_tip,u_t_tip,phi_t_tip,theta_mid,contact_force,energy,\
             energy_change,viscous,thermal,inertial,contact_gap,residual\n",
        );
        for HistoryRow {
            sample: s,
            balance: d,
        } in &self.rows
        {
            let sample = [
                s.t,
                s.u_tip,
                s.phi_tip,
                s.u_t_tip,
                s.phi_t_tip,
                s.theta_mid,
                s.contact_force,
                s.energy,
            ];
            let terms = [
                d.change, d.viscous, d.thermal, d.inertial, d.contact, d.residual,
            ];
            for (k, value) in sample.iter().chain(&terms).enumerate() {
                let comma = if k == 0 { "" } else { "," };
                // Unlike Display, Debug writes 1e-14 in this form. Writing to a string cannot fail.
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
        for HistoryRow { sample, .. } in &self.rows {
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

impl Watch for RunHistory {
    fn see(&mut self, motion: &mut AnyMotion, _: &StepReport) -> Result<ControlFlow<()>, RunError> {
        let is_drawn = !self.frames.times.is_empty();
        if is_drawn {
            self.since_row += motion.balance()?;
        }
        for t in motion.parts(self.t_end, self.parts) {
            self.push_row(motion.inside(t));
        }
        if is_drawn {
            for t in motion.parts(self.t_end, FRAMES) {
                self.push_frame(motion, t);
            }
        }
        Ok(ControlFlow::Continue(()))
    }
}
