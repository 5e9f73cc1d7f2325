//! Steps in contact, counted a second time.

use std::ops::ControlFlow;

use crate::{
    run::{AnyMotion, RunError, Watch, simulate},
    scene::Scene,
};
use thermobeam::{motion::StepReport, scheme::MIDPOINT};

/// Counts the steps of a one-step scheme whose report of contact disagrees with the free end.
///
/// The force of the paper's scheme is that of the law at the end of a step: it is not zero where
/// the end lies outside of the gap. That of the midpoint rule is a difference of the contact's
/// energy, which is zero in the gap: it is not zero where one end of the step lies outside.
pub(super) struct ContactCount<'s> {
    scene: &'s Scene,
    was_outside: bool,
    miscounted: usize,
}

impl<'s> ContactCount<'s> {
    /// The beam stands at t = 0.
    pub(super) fn new(scene: &'s Scene) -> Self {
        let mut count = Self {
            scene,
            was_outside: false,
            miscounted: 0,
        };
        let start = simulate::problem(scene).initial.u;
        count.was_outside = start.last().is_some_and(|u| count.is_outside(*u));
        count
    }

    /// The number of steps; `None` for the scheme of any order, which locates contact, and for a
    /// fixed number of iterations, which leaves the force of an earlier iterate.
    pub(super) fn miscounted(&self) -> Option<usize> {
        let stepping = self.scene.one_step().ok()?;
        let tolerance = stepping.settings.stopping.tolerance();
        tolerance.map(|_| self.miscounted)
    }

    fn is_outside(&self, u: f64) -> bool {
        let obstacles = self.scene.obstacles;
        obstacles.is_some_and(|obstacles| u < obstacles.g1 || u > obstacles.g2)
    }
}

impl Watch for ContactCount<'_> {
    fn see(
        &mut self,
        motion: &mut AnyMotion,
        report: &StepReport,
    ) -> Result<ControlFlow<()>, RunError> {
        let is_outside = self.is_outside(motion.sample().u_tip);
        let scheme = self.scene.one_step().map(|stepping| stepping.scheme);
        let is_midpoint = scheme.is_ok_and(|scheme| scheme == MIDPOINT);
        let touches = is_outside || (is_midpoint && self.was_outside);
        self.miscounted += usize::from(report.in_contact != touches);
        self.was_outside = is_outside;
        Ok(ControlFlow::Continue(()))
    }
}
