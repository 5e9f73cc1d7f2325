//! The constant of Theorem 3.4, computed before any run and held against the finest error.

use super::Convergence;
use crate::kinds::prelude::*;
use crate::{
    exact::{
        constants,
        norm::{Norm, Norms},
    },
    kinds::tables::{Layout, Refine, Share},
};
use thermobeam::{mesh::MeshError, scheme::EULER_CRANK_NICOLSON};

/// The table `[constant]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ConstantTable {
    /// how far measured over predicted may be from 1, at the finest level
    within: Share,
}

/// Steps by which the equations of the error of order dt are integrated, a unit of time.
///
/// Four times as many change C_t by 2e-6 of its value for `theorem-3.4-time`, and by 1.4e-4, where
/// contact begins and ends within a step, for `theorem-3.4-data-time`, whose claims are within 1e-3
/// and 1e-2.
const STEPS: f64 = 1024.0;

impl ConstantTable {
    /// How far measured over predicted may be from 1.
    ///
    /// # Errors
    /// A table where no constant is known: a coupled study, a mesh that is not uniform, another
    /// scheme.
    pub(super) fn within(&self, refine: &Refine) -> Result<f64, Refusal> {
        let is_uniform = refine.layout == Layout::default();
        let is_papers = refine.scheme.name == EULER_CRANK_NICOLSON.name;
        if refine.isolates(RefinedIn::Space) && is_uniform
            || refine.isolates(RefinedIn::Time) && is_papers
        {
            return Ok(self.within.get());
        }
        let found = "a study whose constant is not known";
        let allowed =
            "a study that isolates space on uniform meshes, or time by euler-crank-nicolson";
        Err(Refusal::new("constant", found, allowed))
    }
}

impl Convergence {
    /// C_h or C_t, with its name.
    ///
    /// # Errors
    /// [`MeshError`] of the study's mesh.
    fn predicted(&self) -> Result<(&'static str, f64), MeshError> {
        let refine = &self.refine;
        if refine.isolates(RefinedIn::Space) {
            let steps = refine.steps.first().copied().unwrap_or(1);
            let times = (1..=steps).map(|n| n as f64 * refine.dt(steps));
            return Ok(("C_h", constants::in_space(&self.exact, times)));
        }
        let elements = refine.elements.first().copied().unwrap_or(1);
        let mesh = refine.layout.mesh(elements)?;
        let steps = (STEPS * refine.t_end).ceil() as usize;
        let problem = (&self.theory.beam, self.theory.obstacles.as_ref());
        let constant = constants::in_time(&self.exact, problem, &mesh, refine.t_end, steps);
        Ok(("C_t", constant))
    }

    /// The finest error is the predicted constant times its step; `None` if that is not claimed.
    pub(super) fn constant_met(
        &self,
        finest: Option<&Ran<(usize, usize), Norms>>,
    ) -> Option<Measured> {
        let within = self.constant?;
        let (name, predicted) = self.predicted().unwrap_or(("C", f64::NAN));
        let observed = finest.map_or(f64::NAN, |run| {
            let (elements, steps) = run.case.data;
            let error = run.ok().map_or(f64::NAN, |errors| errors[Norm::Theorem34]);
            error / self.refine.step_of(elements, steps)
        });
        let ratio = observed / predicted;
        let step = if name == "C_h" { "h" } else { "dt" };
        let words = format!("{ratio:.6}: {name} = {predicted:.6}, observed {observed:.6}");
        let name =
            format!("error in the norm of (3.14) over {name} {step}, {name} known before the run");
        let answer = Must::Near {
            answer: 1.0,
            within,
        };
        Some(measured("", name, ratio).words(words).must_be(answer))
    }
}
