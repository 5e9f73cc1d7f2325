//! Convergence studies: a manufactured solution, levels of refinement, orders expected.
//!
//! `[refine]` selects one of three shapes: one axis, a path on which both are refined together (h =
//! dt), or the full grid of (h, dt) with `e² = A(h)² + B(dt)²`, where each order is judged by
//! itself. The step of a level is 1/n, the mean mesh width, or dt.
//!
//! ```toml
//! [study]
//! id = "theorem-3.4-space"
//! claim = "Theorem 3.4: first order in h"
//! tier = "quick"
//!
//! [exact]                     # sums of products, functions of x and of t; `[beam]`, `[obstacles]` as in a scene
//! u     = [{ x = "0.3*sin(1.3*pi*x)", t = "cos(3*t) + 0.2*t" }]
//! theta = [{ x = "(1+x)*sin(pi*x)", t = "exp(-t)" }]
//!
//! [refine]
//! axis = "space"
//! isolate = true
//! elements = [8, 16, 32, 64]  # or "auto": levels until it is decided, for at most `budget` node-steps (1e7)
//! steps = 20
//! t_end = 1.0
//!
//! [control]                   # optional: coefficients in which the solver differs from the sources
//! zeta = 0.101
//!
//! [constant]                  # optional: C_h or C_t, computed before the runs, judged at the finest level
//! within = 1e-3
//!
//! [[expect]]
//! norm = "theorem-3.4"
//! order = 1.0                 # or ">= 1"; with `constant = [0.9, 1.1]`: C of C h^p
//! tolerance = 0.05
//! ```

mod constant;
pub(in crate::kinds) mod design;
mod untested;
mod variants;

use convergence_study::{Budget, Grid, GridColumn, SpaceTime, Untested, variants::Variants};

use super::{
    ErrorSource, Finer, Orders, Runs, Series, SourceResult,
    one_step::{self, levels},
};
pub use crate::exact::defect::Defect;
use crate::kinds::prelude::*;
use crate::{
    exact::{
        formulas::SchemeFormulas,
        norm::{Norm, Norms},
        solution::Manufactured,
    },
    kinds::tables::{
        ControlTable, ExactTable, ExpectNorm, Refine, RefineTable, controlled, expected_norms,
        mean_width,
    },
    scene::{
        Coefficients,
        file::{BeamTable, ObstacleTable},
    },
};
pub use design::Prepared;

/// Preparing the space vectors of a mesh costs as much as this many steps.
const PREPARATION: f64 = 50.0;

/// A study of errors against a manufactured solution.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ManufacturedFile {
    /// the coefficients of the equations (1.1)
    #[serde(default)]
    beam: BeamTable,
    /// the obstacles at the free end, (1.3); without the table there are none
    obstacles: Option<ObstacleTable>,
    /// the exact solution: of each field a sum of products
    exact: ExactTable,
    /// the meshes and steps of the runs
    refine: RefineTable,
    /// coefficients in which the solver differs from the sources: the study must fail
    control: Option<ControlTable>,
    /// the constant of the norm of (3.14) is computed before the runs and judged
    constant: Option<constant::ConstantTable>,
    /// the orders claimed, each norm once
    expect: Vec<ExpectNorm>,
}

/// A convergence study, validated.
#[derive(Debug, Clone)]
pub struct Convergence {
    /// Coefficients from which the sources are derived.
    pub theory: Coefficients,
    /// The solver's own coefficients; if they differ, the study must fail.
    pub solver: Coefficients,
    /// The exact solution, which satisfies the essential boundary conditions.
    pub exact: Manufactured,
    /// What is refined, and how.
    pub refine: Refine,
    /// How far the measured constant of (3.14) may be from the predicted one, relatively; `None` if
    /// that is not claimed.
    pub constant: Option<f64>,
    /// The expected orders: at least one, and each norm at most once.
    pub expect: Vec<(Norm, Claim)>,
    /// The formulas of a scheme that files do not know; `None` for one that they name.
    pub formulas: Option<SchemeFormulas>,
}

impl ErrorSource for Convergence {
    const ROW: KindRow = KindRow {
        name: "orders/manufactured",
        schema: schema::<ManufacturedFile>,
        read: <Orders<Self>>::read_study,
        why: "An exact solution is chosen, and the loads are derived from it by putting it into the equations in their strong form; \
              the solver works with the weak form and knows nothing of it. So the error is known at every step. Theorem 3.4 bounds \
              it by c (h + dt).",
        judged: "At each level of refinement the error is measured in each norm, as the maximum over all time levels. The rate at \
                 which it falls is estimated with an interval of measured reliability, which is held against the order: it must lie \
                 within the tolerance, whole. Above is as wrong as below. Where this is open, the verdict is inconclusive, which is not a pass.",
        failure: "The scheme, as it is programmed, does not have the order: a term is missing, belongs to another time level, has a \
                  wrong coefficient, or the quadrature is too coarse. Look which norm fails, and from which level on.",
    };

    type File = ManufacturedFile;
    /// Elements and steps.
    type Data = (usize, usize);
    /// The error in each norm, the maximum over the time levels.
    type Found = Norms;

    fn from_file(file: ManufacturedFile, _: &Path) -> Result<Self, Refusal> {
        let theory = Coefficients::new(&file.beam, file.obstacles.as_ref())?;
        let refine = file.refine.refine().map_err(Refusal::within("refine"))?;
        let exact = file.exact.manufactured(&theory.beam, refine.t_end);
        let expect = expected_norms(&file.expect)?;
        let is_order =
            |(_, claim): &(Norm, Claim)| *claim == Claim::new(claim.order, claim.tolerance);
        if refine.grid && !expect.iter().all(is_order) {
            let allowed = "orders alone, for a grid has one in h and in dt";
            return Err(Refusal::new(
                "expect",
                "a least order or a constant",
                allowed,
            ));
        }
        let constant = file.constant.map(|constant| constant.within(&refine));
        Ok(Self {
            constant: constant.transpose()?,
            theory,
            solver: controlled(file.control.as_ref(), theory)?,
            exact: exact.map_err(Refusal::within("exact"))?,
            refine,
            expect,
            formulas: None,
        })
    }

    fn variants(&self) -> Option<Variants> {
        Some(self.own_variants())
    }

    fn with_variant(&self, variant: &str) -> Option<Self> {
        self.varied(variant)
    }

    fn coefficients(&self) -> Option<[Coefficients; 2]> {
        Some([self.theory, self.solver])
    }

    fn cases(&self) -> Vec<Case<(usize, usize)>> {
        let parts = one_step::parts(&self.solver, &self.refine, Known::Solution);
        let cases = self.refine.cases().into_iter();
        cases.map(|data| case(data).described(&parts)).collect()
    }

    fn run(&self, &(elements, steps): &(usize, usize)) -> Result<Norms, CaseFailure> {
        Prepared::new(self, elements)?.run(steps, self.solver, None)
    }

    fn measured(&self, runs: &Runs<Self>) -> SourceResult {
        let what = match self.refine.axis {
            RefinedIn::Space => "the mesh width 1/n",
            RefinedIn::Time => "the time step",
            RefinedIn::Both => "the mesh width 1/n, refined together with the time step",
        };
        let caption = format!("Errors over {what}, with the orders of theory (triangles).");
        let errors = runs.iter().map(|run| (run.case.data, run.ok()));
        let levels = levels(&self.refine, &self.expect, errors);
        let series = if self.refine.grid {
            Series::on_grid(levels, self.grid(runs))
        } else {
            Series::new(levels).drawn("rates", None, &caption)
        };
        SourceResult {
            series: vec![series],
            sheets: vec![Sheet::untabled(self.constant_met(runs.last()))],
            ..SourceResult::default()
        }
    }

    fn finer(&self, runs: &Runs<Self>) -> Option<Finer<(usize, usize)>> {
        let limit = self.refine.budget?;
        let data = self.refine.finer(runs.last()?.case.data);
        Some(Finer {
            case: case(data),
            budget: Budget {
                next: node_steps(data),
                spent: runs.iter().map(|run| node_steps(run.case.data)).sum(),
                limit,
                unit: "node-steps",
            },
        })
    }

    fn untested(&self) -> Vec<Untested> {
        let is_wrong_on_purpose = self.solver != self.theory;
        if is_wrong_on_purpose || self.refine.grid {
            return vec![];
        }
        untested::untested(self)
    }
}

fn case(data: (usize, usize)) -> Case<(usize, usize)> {
    let (elements, steps) = data;
    // A step takes as long as four elements in addition to its own.
    let cost = (elements as f64 + 4.0) * steps as f64 + elements as f64 * PREPARATION;
    Case::new(Refine::label(elements, steps), cost, data)
}

fn node_steps((elements, steps): (usize, usize)) -> f64 {
    elements as f64 * steps as f64
}

impl Convergence {
    /// The errors on a grid of mesh widths 1/n and time steps.
    fn grid(&self, runs: &Runs<Self>) -> Grid {
        let mut points = vec![];
        for run in runs {
            let (elements, steps) = run.case.data;
            points.push(SpaceTime {
                space: mean_width(elements),
                time: self.refine.dt(steps),
            });
        }
        let mut columns = vec![];
        for &(norm, claim) in &self.expect {
            columns.push(GridColumn {
                name: norm.name().to_owned(),
                space: claim,
                time: claim,
                errors: runs
                    .iter()
                    .map(|run| run.ok().map_or(f64::NAN, |errors| errors[norm]))
                    .collect(),
            });
        }
        Grid {
            points,
            times: self.refine.steps.len(),
            columns,
            squares_add: true,
        }
    }
}
