//! Rates without an exact solution: the paper's own data, contact included.
//!
//! Two readings of the same runs:
//!
//! * *successive* (three-level Richardson): with `q_h = q + C h^p` the difference of neighbouring
//!   levels is `q_h - q_{h/2} = C (1 - 2^-p) h^p`: it falls with the order p, and two differences
//!   (three levels) give a rate;
//! * *reference*: the difference to a run of any order, see [`crate::error::reference`]. If h and
//!   dt are refined together, this is the error against the equations themselves, contact included;
//!   if only time is refined, against the semi-discrete system of the mesh. A second reference with
//!   other degrees and steps shows the accuracy of the first.
//!
//! Only the second reading sees a fault of the scheme that does not vanish with h and dt, such as a
//! wrong coefficient.
//!
//! The effect of contact is not assumed. The contact force is Lipschitz, so it has a kink in time
//! where the tip enters or leaves an obstacle. That costs one step a local error of dt² instead of
//! dt³, once for each event: first and second order should survive at fixed times, but the constant
//! depends on where in its step the event falls, so rates scatter. No order can be expected of the
//! largest displacement over all levels: it misses the true maximum by a share of a step. Only the
//! claims under `[[expect]]` are judged; other rates are shown with the verdict they would get.
//!
//! ```toml
//! [scene]
//! file = "scenes/paper-1-beta-0.toml"
//!
//! [refine]
//! axis = "both"                      # dt = c h, or dt = c h^2; or "time", on one mesh
//! elements = [10, 20, 40]
//! steps = [200, 800, 3200]
//! samples = 10                       # times of comparison
//! every_step = false                 # optional: true for the largest difference over every step
//! solver = "fixed-point"             # optional, as are scheme, tolerance, max_iterations and iterations: else those of the scene
//! iterations = 2
//!
//! [[reference]]                      # two of them, that share nothing; with axis = "time" elements of degree 1 on the mesh
//! elements = 1
//! degree = 28
//! time_degree = 4
//! dt = 0.003
//! restart_dt = 1e-4
//! growth = 1.3
//!
//! [[expect]]
//! quantity = "tip"
//! order = 2.0
//! tolerance = 0.1
//! ```

mod judge;
mod observable;

use super::{ErrorSource, Orders, Runs, Series, SourceResult};
pub use crate::error::reference::Traced;
use crate::kinds::prelude::*;
use crate::{
    error::reference::fine_mesh,
    kinds::tables::{
        Discretisation, DiscretisationTable, Refine, claimed_once, two_discretisations,
    },
    scene::{
        Method, Scene,
        file::{Schemes, SolverKeys, Solvers},
        limits::{self, Elements},
        resampled,
    },
};
use convergence_study::{
    Order, Untested,
    file::{Ascending, Choices, Counts},
};
use observable::Observable;
use thermobeam::{
    mesh::{Mesh, MeshError},
    one_step::Stepping,
    solve::{Settings, Stopping},
};

/// A study of rates without an exact solution.
#[derive(Debug)]
pub struct SelfConvergence {
    /// The scene by the scheme of the study.
    scene: Scene,
    axis: RefinedIn,
    /// Elements and steps, coarse to fine; at least two.
    levels: Vec<(usize, usize)>,
    /// The scheme's order in the step that is refined: with dt = c h² twice as high.
    order_in_time: f64,
    /// The levels are compared with the first.
    references: [Discretisation; 2],
    t_end: f64,
    /// Times of comparison.
    samples: usize,
    /// Whether each level is compared at the end of each of its steps; the samples are then those
    /// of the table and of the figure.
    every_step: bool,
    /// Must the tip meet an obstacle?
    contact: bool,
    /// Claims about both readings.
    claims: Vec<(&'static Observable, Claim)>,
}

/// A study of rates without an exact solution, as it is written.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SelfConvergenceFile {
    /// the beam
    scene: SceneTable,
    /// the levels
    refine: LevelsTable,
    /// the two discretisations by dG that are compared
    reference: Vec<DiscretisationTable>,
    /// the orders claimed, each quantity once
    expect: Vec<ExpectTable>,
}

/// The table `[scene]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SceneTable {
    /// a scene file, relative to this file
    file: String,
}

/// The table `[refine]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct LevelsTable {
    /// what is refined
    axis: OneOf<TimeOrBoth>,
    /// numbers of elements, each a multiple of the one before; one number where time is refined
    elements: Counts<Elements>,
    /// numbers of steps, each a multiple of the one before
    steps: Ascending<Count<1, { limits::STEPS }>, 2>,
    /// final time; without it that of the scene
    t_end: Option<Positive>,
    /// times at which runs are compared
    samples: Count<1, 1000>,
    /// differences are the largest over every step of a level, not over the samples
    #[serde(default)]
    every_step: bool,
    /// the tip must meet an obstacle
    #[serde(default)]
    contact: bool,
    /// the one-step scheme; without it that of the scene
    scheme: Option<OneOf<Schemes>>,
    /// how a step is solved; without it and the following keys as in the scene
    solver: Option<OneOf<Solvers>>,
    /// the increment at which an iteration ends
    tolerance: Option<Positive>,
    /// iterations after which a step fails
    max_iterations: Option<Count<1>>,
    /// of the fixed point in each step, in place of tolerance and max_iterations
    iterations: Option<Count<1>>,
}

/// What can be refined.
#[derive(Debug)]
enum TimeOrBoth {}

impl Choices for TimeOrBoth {
    type Value = RefinedIn;

    fn all() -> Vec<(&'static str, RefinedIn)> {
        vec![("time", RefinedIn::Time), ("both", RefinedIn::Both)]
    }
}

/// A table `[[expect]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ExpectTable {
    /// what is compared
    quantity: OneOf<Observable>,
    /// the order, or the least order
    order: Order,
    /// the ends of the C of error = C h^order
    #[schemars(extend("title" = "two numbers > 0, the smaller first"))]
    constant: Option<[Positive; 2]>,
    /// how far the rate may be from the order; without it 0.25
    tolerance: Option<Positive>,
}

impl SelfConvergenceFile {
    fn study(&self, folder: &Path) -> Result<SelfConvergence, Refusal> {
        let scene = Scene::read(named_file("scene.file", &self.scene.file, folder)?)?;
        let one_step = scene.one_step().map_err(|error| {
            Refusal::new(
                "scene.file",
                error.to_string(),
                "a scene by a one-step scheme",
            )
        })?;
        let refine = &self.refine;
        let axis = refine.axis.value;
        let in_refine = Refusal::within("refine");
        let (levels, power) = refine.levels().map_err(&in_refine)?;
        let t_end = refine.t_end.map_or(scene.t_end, Positive::get);
        let stepping = refine.stepping(one_step).map_err(&in_refine)?;
        if refine.contact && scene.obstacles.is_none() {
            let found = "true, of a scene without obstacles";
            let allowed = "false, or a scene with obstacles";
            return Err(Refusal::new("refine.contact", found, allowed));
        }
        let of_mesh = (axis == RefinedIn::Time).then_some(levels[0].0);
        Ok(SelfConvergence {
            axis,
            levels,
            order_in_time: stepping.scheme.order * power,
            references: two_discretisations(&self.reference, "reference", of_mesh, t_end)?,
            t_end,
            samples: refine.samples.get(),
            every_step: refine.every_step,
            contact: refine.contact,
            claims: self.claims(axis, stepping.settings.stopping)?,
            scene: Scene {
                method: Method::OneStep(stepping),
                ..scene
            },
        })
    }

    /// What is claimed of quantities that the refinement tells apart.
    fn claims(
        &self,
        axis: RefinedIn,
        stopping: Stopping,
    ) -> Result<Vec<(&'static Observable, Claim)>, Refusal> {
        let known: Vec<&str> = Observable::all(axis, stopping)
            .map(|known| known.name)
            .collect();
        for (place, table) in self.expect.iter().enumerate() {
            if !known.contains(&table.quantity.name) {
                let names: Vec<String> = known.iter().map(|name| format!("\"{name}\"")).collect();
                let path = format!("expect[{place}].quantity");
                return Err(Refusal::written(path, names.join(", ")));
            }
        }
        claimed_once("quantity", &self.expect, |table| {
            let claim = table.order.claim(table.constant, table.tolerance);
            (table.quantity.name, table.quantity.value, claim)
        })
    }
}

impl ErrorSource for SelfConvergence {
    const ROW: KindRow = KindRow {
        name: "orders/self-convergence",
        schema: schema::<SelfConvergenceFile>,
        read: <Orders<Self>>::read_study,
        why: "For the paper's own data there is no closed form: rates come from the differences of three levels (Richardson) and from \
              the distance to a run by another discretisation, elements of high degree and dG(q), contact included.",
        judged: "Each quantity's rate by the rule of every rate. Two references must agree to a hundredth of the finest error.",
        failure: "With contact and rough data the order is lost, or the levels are too coarse for it. Where only the distances to the \
                  reference fail, scheme and reference solve different equations.",
    };

    type File = SelfConvergenceFile;
    /// Number of the run: the levels, then the two references.
    type Data = usize;
    type Found = Traced;

    fn from_file(file: SelfConvergenceFile, folder: &Path) -> Result<Self, Refusal> {
        file.study(folder)
    }

    fn named_files(file: &SelfConvergenceFile) -> Vec<&str> {
        vec![&file.scene.file]
    }

    fn untested(&self) -> Vec<Untested> {
        let why = "scheme and references share it: differences of runs cannot see a wrong limit";
        vec![Untested {
            what: "the scene itself".to_owned(),
            why: why.to_owned(),
        }]
    }

    fn cases(&self) -> Vec<Case<usize>> {
        let parts = Parts::of(&self.scene);
        let mut cases = vec![];
        for (run, &(n, steps)) in self.levels.iter().enumerate() {
            let case = Case::new(Refine::label(n, steps), n as f64 * steps as f64, run);
            cases.push(case.described(&parts));
        }
        for reference in &self.references {
            let label = format!("reference, {}", reference.label());
            let case = Case::new(label, reference.cost(self.t_end), cases.len());
            cases.push(case.described(&parts.clone().by_dg()));
        }
        cases
    }

    fn run(&self, &run: &usize) -> Result<Traced, CaseFailure> {
        let (scene, mesh) = match self.levels.get(run) {
            Some(&(elements, steps)) => {
                let mesh = resampled(&self.scene.mesh, elements)?;
                (self.scene.with_steps(mesh.clone(), steps, self.t_end), mesh)
            }
            None => (
                self.references[run - self.levels.len()].of(&self.scene, self.t_end)?,
                self.common_mesh()?,
            ),
        };
        // A reference has the times of the finest level, which are those of all.
        let of_run = self.levels.get(run).or(self.levels.last());
        let steps = of_run.filter(|_| self.every_step).map(|(_, steps)| *steps);
        Traced::compute(&scene, mesh, steps.unwrap_or(self.samples))
    }

    fn measured(&self, runs: &Runs<Self>) -> SourceResult {
        let mut series = vec![];
        for reading in judge::READINGS {
            for is_claimed in [true, false] {
                let levels = self.differences(runs, reading, |claim| claim.is_some() == is_claimed);
                series.push(Series {
                    is_claimed,
                    ..Series::new(levels)
                });
            }
        }
        let mut numbers = self.references(runs);
        numbers.extend(self.meets_obstacle(runs));
        numbers.extend(self.values_guarded(runs));
        SourceResult {
            series,
            sheets: vec![Sheet::untabled(numbers)],
            tables: vec![self.values(runs)],
            figures: vec![self.to_reference(runs), self.tip(runs)],
            ..SourceResult::default()
        }
    }
}

impl LevelsTable {
    /// The method of the scene, with what the table says of it.
    fn stepping(&self, of_scene: Stepping) -> Result<Stepping, Refusal> {
        let mut stepping = of_scene;
        stepping.scheme = self.scheme.map_or(stepping.scheme, |scheme| scheme.value);
        let keys = SolverKeys {
            solver: self.solver,
            tolerance: self.tolerance,
            max_iterations: self.max_iterations,
            iterations: self.iterations,
        };
        if keys.are_given() {
            stepping.settings = keys.over(Settings::default())?;
        }
        Ok(stepping)
    }

    /// The levels, coarse to fine, and the power of h that dt is proportional to if both are
    /// refined.
    fn levels(&self) -> Result<(Vec<(usize, usize)>, f64), Refusal> {
        let steps: Vec<usize> = self.steps.iter().map(|steps| steps.get()).collect();
        multiples("steps", &steps)?;
        let (elements, power) = match (&self.elements, self.axis.value) {
            (Counts::One(elements), RefinedIn::Time) => (vec![elements.get(); steps.len()], 1),
            (_, RefinedIn::Time) => {
                return Err(Refusal::written("elements", "a single whole number >= 1"));
            }
            (Counts::List(elements), _) => {
                let elements: Vec<usize> = elements.iter().map(|elements| elements.get()).collect();
                multiples("elements", &elements)?;
                let finer = ratios(&elements);
                let is_power = |power: &u32| {
                    let shorter = finer.iter().map(|ratio| ratio.pow(*power));
                    shorter.eq(ratios(&steps))
                };
                let Some(power) = [1, 2].into_iter().find(is_power) else {
                    let allowed = "as many as elements, multiplied from level to level by the factor of the elements, or by its square";
                    return Err(Refusal::written("steps", allowed));
                };
                (elements, power)
            }
            _ => return Err(Refusal::written("elements", NESTED)),
        };
        let samples = self.samples.get();
        if !steps[0].is_multiple_of(samples) {
            let found = format!("{} steps", steps[0]);
            let allowed = format!("a multiple of samples = {samples}");
            return Err(Refusal::new("steps", found, allowed));
        }
        Ok((elements.into_iter().zip(steps).collect(), f64::from(power)))
    }
}

const NESTED: &str = "a list of at least two whole numbers, each a multiple of the one before";

/// Refuses levels that are not multiples of their predecessors.
fn multiples(path: &str, levels: &[usize]) -> Result<(), Refusal> {
    if levels.len() < 2 {
        return Err(Refusal::written(path, NESTED));
    }
    let mut pairs = levels.windows(2);
    match pairs.position(|pair| !pair[1].is_multiple_of(pair[0])) {
        None => Ok(()),
        Some(place) => {
            let allowed = format!("a multiple of {}, the level before", levels[place]);
            Err(Refusal::written(format!("{path}[{}]", place + 1), allowed))
        }
    }
}

/// By how much each level is finer than its predecessor.
fn ratios(levels: &[usize]) -> Vec<usize> {
    levels.windows(2).map(|pair| pair[1] / pair[0]).collect()
}

impl SelfConvergence {
    /// The mesh on which levels are compared with the references.
    fn common_mesh(&self) -> Result<Mesh, MeshError> {
        let finest = self.levels.last().map_or(0, |(elements, _)| *elements);
        if self.axis == RefinedIn::Time {
            resampled(&self.scene.mesh, finest)
        } else {
            fine_mesh(&self.scene, finest)
        }
    }
}
