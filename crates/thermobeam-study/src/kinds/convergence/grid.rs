//! The verdict over a grid of (h, dt): squares of space and time error add, and each order is judged by itself.

use convergence_study::study::grid::{Grid, GridColumn, GridVerdict, Model};
use convergence_study::study::levels::{self, Levels};
use convergence_study::study::{Claim, Outcome};

use super::Convergence;
use super::judge::Run;
use crate::kinds::tables::{Expectation, not_finite};

pub(super) fn judge(study: &Convergence, ran: &[Run], levels: &Levels) -> Outcome {
    let grid = grid(study, ran);
    let GridVerdict { rates, mut checks } = grid.judge();
    checks.push(levels::completion(ran, not_finite));
    Outcome {
        figures: grid.figures(&study.header.id, "norm"),
        quantities: levels.quantities(&rates),
        ..Outcome::new(levels::summary(&rates), rates, checks)
    }
}

/// The errors in each norm of which an order is expected, the same in h and in dt.
fn grid(study: &Convergence, ran: &[Run]) -> Grid {
    let refine = &study.refine;
    let column = |&Expectation { norm, order, tolerance }: &Expectation| GridColumn {
        name: norm.name().to_owned(),
        space: Claim { order, tolerance },
        time: order,
        errors: ran.iter().map(|run| run.ok().map_or(f64::NAN, |errors| errors[norm])).collect(),
    };
    let point = |run: &Run| [1.0 / run.case.data.0 as f64, refine.dt(run.case.data.1)];
    Grid {
        points: ran.iter().map(point).collect(),
        times: refine.steps.len(),
        columns: study.expect.iter().map(column).collect(),
        model: Model::Squares,
    }
}
