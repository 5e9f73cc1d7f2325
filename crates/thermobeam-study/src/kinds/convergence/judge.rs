//! The verdict along a path of refinement, and what both paths and grids report.

use convergence_study::study::levels::{self, Levels};
use convergence_study::study::{Axis, Outcome, Ran};

use super::{Convergence, grid};
use crate::kinds::tables::{Norms, not_finite};

pub(super) type Run = Ran<(usize, usize), Norms>;

pub(super) fn judge(study: &Convergence, ran: &[Run]) -> Outcome {
    let levels = study.levels(ran);
    let mut outcome =
        if study.refine.grid { grid::judge(study, ran, &levels) } else { along_path(study, ran, &levels) };
    outcome.levels = levels.errors();
    outcome
}

fn along_path(study: &Convergence, ran: &[Run], levels: &Levels) -> Outcome {
    let rates = levels.judge();
    let what = match study.refine.axis {
        Axis::Space => "the mesh width 1/n",
        Axis::Time => "the time step",
        Axis::Both => "the mesh width 1/n, refined together with the time step",
    };
    let caption = format!("Errors over {what}, with the orders of theory (triangles).");
    let figure = levels.figure(format!("{}-rates.svg", study.header.id), None, caption, &rates);
    Outcome {
        figures: vec![figure],
        quantities: levels.quantities(&rates),
        ..Outcome::new(levels::summary(&rates), rates, vec![levels::completion(ran, not_finite)])
    }
}
