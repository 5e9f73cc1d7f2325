//! The searches of one scene, and their errors against runs that no search tries.

use super::{
    Drawn, RandomErrors,
    truth::{QuadraturePoint, Trace, Truth, points},
};
use crate::kinds::prelude::*;
use crate::{
    predict::{
        MOST_WORK, Unreachable, Work,
        choice::{self, choose},
        estimate::{Estimate, estimate},
    },
    scene::Scene,
};

/// Why a search was abandoned.
#[derive(Debug, Clone, PartialEq)]
pub struct AbandonedSearch {
    /// The search and the reason, in words.
    pub words: String,
    /// Whether data with features may be refused so: no mesh resolves them, or a finer run
    /// contradicts the search.
    pub is_of_features: bool,
}

impl AbandonedSearch {
    fn new(search: &str, why: &Unreachable) -> Self {
        let is_of_features = matches!(
            why,
            Unreachable::Unresolved { .. } | Unreachable::Contradicted { .. }
        );
        Self {
            words: format!("{search}: {why}"),
            is_of_features,
        }
    }
}

/// The results of a scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PredictedErrors {
    /// The largest error of a number, in units of its estimate.
    pub over_estimate: f64,
    /// The largest error of u(1, t) of a chosen run, in units of its target.
    pub over_target: f64,
    /// The same in the norm.
    pub over_norm_target: f64,
    /// Why searches were abandoned.
    pub refused: Vec<AbandonedSearch>,
    /// Whether a search may be refused, because the data have features that no mesh resolves.
    pub may_be_refused: bool,
    /// Errors of linear elements, and of four times as many with four times the steps.
    pub linear: Option<[f64; 2]>,
    /// Work of the searches.
    pub work: f64,
}

impl PredictedErrors {
    pub(super) fn readings(&self) -> Vec<Reading> {
        vec![
            Reading::new("error over estimate", self.over_estimate).fixed(2),
            Reading::new("error over target", self.over_target).fixed(2),
            Reading::new("the same in the norm", self.over_norm_target).fixed(2),
            Reading::new("linear elements", self.linear.map(|of| of[0])).scientific(1),
            Reading::new("four times as many", self.linear.map(|of| of[1])).scientific(1),
            Reading::new("work", self.work).scientific(1),
        ]
    }
}

impl RandomErrors {
    /// The run chosen for each target; a refusal is noted.
    fn chosen(
        &self,
        scene: &Scene,
        quantity: choice::ErrorQuantity,
        refused: &mut Vec<AbandonedSearch>,
        work: &mut Work<'_>,
    ) -> Vec<(f64, Scene)> {
        let targets = if quantity == choice::ErrorQuantity::Tip {
            &self.targets
        } else {
            &self.norm_targets
        };
        let mut chosen = vec![];
        for &target in targets {
            match choose(scene, quantity, target, work) {
                Ok(choice) => chosen.push((target, choice.scene)),
                Err(why) => {
                    let search = format!("{} {target:e}", quantity.name());
                    refused.push(AbandonedSearch::new(&search, &why));
                }
            }
        }
        chosen
    }

    /// The searches of a scene, and the runs on linear elements if it has them.
    fn search(&self, drawn: Drawn, scene: &Scene) -> Result<Searched, CaseFailure> {
        let mut no_progress = |_: f64| ();
        let work = &mut Work::new(MOST_WORK, &mut no_progress);
        let mut refused = vec![];
        let estimates = estimate(scene, work).map_or_else(
            |why: Unreachable| {
                refused.push(AbandonedSearch::new("estimate", &why));
                vec![]
            },
            |budget| budget.quantities,
        );
        let chosen = self.chosen(scene, choice::ErrorQuantity::Tip, &mut refused, work);
        let in_norm = self.chosen(scene, choice::ErrorQuantity::Norm, &mut refused, work);
        let is_refined = matches!(drawn, Drawn::Smooth(number) if self.refined > 0 && number.is_multiple_of(self.refined));
        let times: &[usize] = if is_refined { &[1, 4] } else { &[] };
        let linear = times
            .iter()
            .map(|times| Self::linear(scene, *times))
            .collect::<Result<Vec<Scene>, _>>()?;
        Ok(Searched {
            estimates,
            chosen,
            linear,
            in_norm,
            refused,
            work: work.spent().work,
        })
    }

    /// The errors of the runs of a scene.
    ///
    /// # Errors
    /// A run fails, or its scene cannot be made.
    pub(super) fn measure(&self, drawn: Drawn) -> Result<PredictedErrors, CaseFailure> {
        let (scene, feature) = self.scene(drawn)?;
        let exact = self.independent(&scene, feature.as_ref())?;
        let searched = self.search(drawn, &scene)?;
        let meshes = searched.in_norm.iter().map(|(_, chosen)| &chosen.mesh);
        let points = points(meshes.chain([&exact.mesh]));
        let traces = searched.traces(&scene, &points)?;
        let truth = Truth::of(&exact, &traces.iter().collect::<Vec<_>>(), &points)?;
        let errors = searched.errors(&truth, &traces, &points);
        Ok(PredictedErrors {
            refused: searched.refused,
            may_be_refused: feature.is_some(),
            work: searched.work,
            ..errors
        })
    }
}

/// The results of the searches of a scene.
struct Searched {
    estimates: Vec<Estimate>,
    /// Runs for u(1, t), with their targets.
    chosen: Vec<(f64, Scene)>,
    /// Runs on linear elements, the coarser first; none for most scenes.
    linear: Vec<Scene>,
    /// Runs for the norm, with their targets.
    in_norm: Vec<(f64, Scene)>,
    refused: Vec<AbandonedSearch>,
    work: f64,
}

impl Searched {
    /// The scene's own run, those for u(1, t), those on linear elements, and those for the norm.
    fn traces(&self, scene: &Scene, points: &[QuadraturePoint]) -> Result<Vec<Trace>, CaseFailure> {
        let mut traces = vec![Trace::of(scene, &[])?];
        for (_, run) in &self.chosen {
            traces.push(Trace::of(run, &[])?);
        }
        for run in &self.linear {
            traces.push(Trace::of(run, &[])?);
        }
        for (_, run) in &self.in_norm {
            traces.push(Trace::of(run, points)?);
        }
        Ok(traces)
    }

    /// The errors of these runs, the rest being empty.
    ///
    /// * `traces`: as [`Self::traces`] gives them.
    fn errors(
        &self,
        truth: &Truth,
        traces: &[Trace],
        points: &[QuadraturePoint],
    ) -> PredictedErrors {
        let mut found = PredictedErrors::default();
        for estimate in &self.estimates {
            let error = truth.of_estimate(0, &traces[0], estimate);
            found.over_estimate = max_or_nan(found.over_estimate, error / estimate.total);
        }
        for (k, (target, _)) in (1..).zip(&self.chosen) {
            let error = truth.of_curve(k, &traces[k], 0);
            found.over_target = max_or_nan(found.over_target, error / target);
        }
        let first_linear = 1 + self.chosen.len();
        if !self.linear.is_empty() {
            let linear = [first_linear, first_linear + 1];
            found.linear = Some(linear.map(|k| truth.of_curve(k, &traces[k], 0)));
        }
        let first_in_norm = first_linear + self.linear.len();
        for (k, (target, _)) in (first_in_norm..).zip(&self.in_norm) {
            let error = truth.of_norm(k, &traces[k], points);
            found.over_norm_target = max_or_nan(found.over_norm_target, error / target);
        }
        found
    }
}
