//! The numbers of each run, declared once: they give completion, tables and guarded numbers.

use super::{AtRest, MeasuredRun, PaperRun, SectionGroup, Trace, group::OfExperiment};
use crate::kinds::prelude::*;
use crate::kinds::settings::ItemMethod;

/// Tolerance of a number that depends smoothly on the data: far above round-off, below any change
/// of method.
const SMOOTH: f64 = 1e-6;

/// The same if many bounces lie between the data and the number: each amplifies a perturbation.
const AFTER_BOUNCES: f64 = 1e-4;

/// The same for numbers that depend on when an iteration stops: rounding decides where an increment
/// is close to the tolerance.
const OF_ITERATIONS: f64 = 1e-2;

impl OfExperiment<'_> {
    /// The numbers of the experiment.
    pub(super) fn readings(&self) -> Vec<Reading> {
        let bent = self.experiment.group != SectionGroup::First;
        let mut readings = self.trace().readings(self.name());
        readings.extend(self.first.readings(self.name(), bent));
        readings
    }
}

impl Trace {
    /// * `name`: the experiment's.
    pub(super) fn readings(&self, name: &str) -> Vec<Reading> {
        vec![
            Reading::new("first contact above", self.first_upper)
                .fixed(4)
                .guarded(format!("{name}: first_upper"), SMOOTH),
            Reading::new("below", self.first_lower)
                .fixed(4)
                .guarded(format!("{name}: first_lower"), AFTER_BOUNCES),
            Reading::new("frequency of u(1)", self.frequency)
                .fixed(4)
                .guarded(format!("{name}: frequency"), AFTER_BOUNCES),
            Reading::new("range of φ(1)", self.phi_amplitude)
                .fixed(4)
                .guarded(format!("{name}: phi_amplitude"), AFTER_BOUNCES),
            Reading::new("largest change of the energy", self.largest_increase),
            Reading::new("largest residual of the balance", self.largest_residual),
        ]
    }
}

impl PaperRun {
    /// * `name`: the experiment's.
    pub(super) fn readings(&self, name: &str) -> Vec<Reading> {
        let solvers = &self.solvers;
        vec![
            Reading::new("iterations per step", solvers.mean_iterations)
                .fixed(4)
                .guarded_in(name, "iterations_per_step", OF_ITERATIONS),
            Reading::text("most", solvers.most_iterations.to_string()),
            Reading::new("distance to Newton's solution", solvers.distance)
                .scientific(2)
                .guarded_in(name, "distance_to_newton", OF_ITERATIONS),
            Reading::new("largest change of the energy", self.trace.largest_increase).scientific(1),
            Reading::new(
                "largest residual of its balance",
                self.trace.largest_residual,
            )
            .scientific(1),
        ]
    }
}

impl MeasuredRun {
    /// * `name`: the experiment's; `bent`: whether the end is nonzero; the digits of zero are those
    ///   of the remaining motion.
    pub(super) fn readings(&self, name: &str, bent: bool) -> Vec<Reading> {
        let exact = self.end.nearest.map(|nearest| nearest.state.u_tip);
        let mut energy = Reading::new("E at the end", self.energy).fixed(8);
        let mut exact = Reading::new("u(1) of the exact state", exact);
        if bent {
            energy = energy.guarded_in(name, "energy", SMOOTH);
            exact = exact.guarded_in(name, "exact_u_tip", SMOOTH);
        }
        let exact_subject = Subject::of("exact_u_tip")
            .in_case(name)
            .by(ItemMethod::Exact);
        vec![
            Reading::new("steady by t", self.end.t).fixed(0),
            energy,
            Reading::new("u(1)", self.end.tip[0]).scientific(3),
            Reading::new("φ(1)", self.end.tip[1]).scientific(3),
            exact.about(exact_subject),
            Reading::new("contact force", self.contact_force),
            Reading::new("largest field", self.largest_field),
            Reading::new("distance to a steady state", self.end.distance()),
        ]
    }
}

impl AtRest {
    pub(super) fn readings(&self) -> Vec<Reading> {
        let distance = Reading::new("distance to the nearest", self.distance());
        vec![
            Reading::text("steady states", self.count()),
            Reading::text("stable", self.stable.to_string()),
            Reading::new("u(1) at rest", self.tip[0]).scientific(6),
            distance.shown(|distance| {
                if self.nearest.is_some() {
                    format!("{distance:.1e}")
                } else {
                    "-".to_owned()
                }
            }),
            Reading::new("at rest by t", self.t).fixed(0),
        ]
    }
}
