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
    kinds::{
        settings::{CONTACT, Exercise, Integration, axis_in_words},
        tables::{
            CLAIM_KEYS, DISCRETISATIONS, Discretisation, Refine, claims, discretisations, nested,
        },
    },
    scene::{Method, Scene, limits, resampled, tables},
};
use observable::Observable;
use thermobeam::{
    mesh::{Mesh, MeshError},
    one_step::Stepping,
};

/// A study of rates without an exact solution.
#[derive(Debug)]
pub struct SelfConvergence {
    /// The scene by the scheme of the study.
    scene: Scene,
    axis: Axis,
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

const KEYS: [Key; 4] = [
    Key::new("scene", Form::Table(&[&[&SCENE]]), "the beam"),
    Key::new(
        "refine",
        Form::Table(&[&[&LEVELS, &STEPPING]]),
        "the levels",
    ),
    Key {
        name: "reference",
        ..DISCRETISATIONS
    },
    Key::new(
        "expect",
        Form::List(&Form::Table(&[&[
            &[Key::new(
                "quantity",
                Form::Choice(observable::names),
                "what is compared",
            )],
            &CLAIM_KEYS,
        ]])),
        "the orders claimed, each quantity once",
    ),
];
const SCENE: [Key; 1] = [Key::new(
    "file",
    Form::Text,
    "a scene file, relative to this file",
)];
const STEPPING: [Key; 5] = convergence_keys::all_or(tables::STEPPING_KEYS, "that of the scene");
const COUNTS: Form = Form::OneOf(&[Form::Count(1), Form::List(&Form::Count(1))]);
const LEVELS: [Key; 7] = [
    Key::new(
        "axis",
        Form::Choice(|| vec!["time", "both"]),
        "what is refined",
    ),
    Key::new(
        "elements",
        COUNTS,
        "numbers of elements, each a multiple of the one before; one number where time is refined",
    ),
    Key::new(
        "steps",
        Form::List(&Form::Count(1)),
        "numbers of steps, each a multiple of the one before",
    ),
    Key::new("t_end", Form::Positive, "final time").or("that of the scene"),
    Key::new(
        "samples",
        Form::Count(1),
        "times at which runs are compared",
    ),
    Key::new(
        "every_step",
        Form::Boolean,
        "differences are the largest over every step of a level, not over the samples",
    )
    .or("false"),
    Key::new("contact", Form::Boolean, "the tip must meet an obstacle").or("false"),
];

impl ErrorSource for SelfConvergence {
    const ROW: KindRow = KindRow {
        name: "orders/self-convergence",
        keys: &[&[&KEYS]],
        schema: None,
        read: read_study::<Orders<Self>>,
        why: "For the paper's own data there is no closed form: rates come from the differences of three levels (Richardson) and from \
              the distance to a run by another discretisation, elements of high degree and dG(q), contact included.",
        judged: "Each quantity's rate by the rule of every rate. Two references must agree to a hundredth of the finest error.",
        failure: "With contact and rough data the order is lost, or the levels are too coarse for it. Where only the distances to the \
                  reference fail, scheme and reference solve different equations.",
    };

    /// Number of the run: the levels, then the two references.
    type Data = usize;
    type Found = Traced;

    fn read(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let named = root.table("scene", &[&SCENE])?;
        let file = named.require("file", "the path of a scene, from this file's folder")?;
        let scene = Scene::read(file.file(folder)?)?;
        let one_step = scene
            .one_step()
            .map_err(|error| file.refuse(error.to_string(), "a scene by a one-step scheme"))?;
        let section = root.table("refine", &[&LEVELS, &STEPPING])?;
        let axes = [("time", Axis::Time), ("both", Axis::Both)];
        let axis = section
            .require("axis", "\"time\", \"both\"")?
            .choice(&axes)?;
        let samples = section.count("samples", 1..=1000)?;
        let (levels, power) = levels(&section, axis, samples)?;
        let t_end = section
            .get("t_end")
            .map_or(Ok(scene.t_end), |field| field.positive())?;
        let stepping = stepping(&section, one_step)?;
        let observables: Vec<_> = Observable::all(axis, stepping.settings.stopping)
            .map(|observable| (observable.name, observable))
            .collect();
        let of_mesh = (axis == Axis::Time).then_some(levels[0].0);
        Ok(Self {
            axis,
            levels,
            order_in_time: stepping.scheme.order * power,
            references: discretisations(root, "reference", of_mesh, t_end)?,
            t_end,
            samples,
            every_step: section
                .get("every_step")
                .map_or(Ok(false), |field| field.boolean())?,
            contact: contact(&section, &scene)?,
            claims: claims(root, "quantity", &observables)?,
            scene: Scene {
                method: Method::OneStep(stepping),
                ..scene
            },
        })
    }

    fn exercise(&self) -> Exercise {
        let integration = Integration::of_scene(&self.scene);
        Exercise::of_scene(CONTACT, integration, &self.scene).refined_in(axis_in_words(self.axis))
    }

    fn cases(&self) -> Vec<Case<usize>> {
        let mut cases = vec![];
        for (run, &(n, steps)) in self.levels.iter().enumerate() {
            cases.push(Case::new(
                Refine::label(n, steps),
                n as f64 * steps as f64,
                run,
            ));
        }
        for reference in &self.references {
            let label = format!("reference, {}", reference.label());
            cases.push(Case::new(label, reference.cost(self.t_end), cases.len()));
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

    fn not_finite(&self, found: &Traced) -> Vec<String> {
        let mut broken = vec![];
        if !(found.tip_range.low.is_finite() && found.tip_range.high.is_finite()) {
            broken.push("the range of u(1)".to_owned());
        }
        let mut samples = found.levels.iter().zip(&found.energies);
        if let Some(k) =
            samples.position(|(level, energy)| !energy.is_finite() || !is_finite(level))
        {
            broken.push(format!("sample {}", k + 1));
        }
        broken
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
        let mut checks = vec![self.reference_known(runs)];
        checks.extend(self.meets_obstacle(runs));
        SourceResult {
            series,
            checks,
            tables: vec![self.values(runs)],
            figures: vec![self.to_reference(runs), self.tip(runs)],
            quantities: self.values_guarded(runs),
            ..SourceResult::default()
        }
    }
}

/// The method of the scene, with what `[refine]` says of it.
fn stepping(section: &Section<'_>, of_scene: Stepping) -> Result<Stepping, InputError> {
    let mut stepping = of_scene;
    if section.get("scheme").is_some() {
        stepping.scheme = tables::scheme(section)?;
    }
    let keys = ["solver", "tolerance", "max_iterations", "iterations"];
    if keys.iter().any(|key| section.get(key).is_some()) {
        stepping.settings = tables::settings(section)?;
    }
    Ok(stepping)
}

fn contact(section: &Section<'_>, scene: &Scene) -> Result<bool, InputError> {
    let contact = section
        .get("contact")
        .map_or(Ok(false), |field| field.boolean())?;
    if contact && scene.obstacles.is_none() {
        return Err(section.refuse(
            "contact",
            "true, of a scene without obstacles",
            "false, or a scene with obstacles",
        ));
    }
    Ok(contact)
}

/// The levels, coarse to fine, and the power of h that dt is proportional to if both are refined.
fn levels(
    section: &Section<'_>,
    axis: Axis,
    samples: usize,
) -> Result<(Vec<(usize, usize)>, f64), InputError> {
    let steps = nested(section, "steps", |item| item.count(1..=limits::STEPS))?;
    let (elements, power) = if axis == Axis::Time {
        let one = tables::elements(&section.require("elements", "a single whole number >= 1")?)?;
        (vec![one; steps.len()], 1)
    } else {
        let elements = nested(section, "elements", tables::elements)?;
        let finer = ratios(&elements);
        let is_power = |power: &u32| {
            let shorter = finer.iter().map(|ratio| ratio.pow(*power));
            shorter.eq(ratios(&steps))
        };
        let Some(power) = [1, 2].into_iter().find(is_power) else {
            let allowed = "as many as elements, multiplied from level to level by the factor of the elements, or by its square";
            return Err(section
                .require("steps", allowed)?
                .refuse_as_written(allowed));
        };
        (elements, power)
    };
    if !steps[0].is_multiple_of(samples) {
        let found = format!("{} steps", steps[0]);
        return Err(section.refuse("steps", found, format!("a multiple of samples = {samples}")));
    }
    Ok((elements.into_iter().zip(steps).collect(), f64::from(power)))
}

/// By how much each level is finer than its predecessor.
fn ratios(levels: &[usize]) -> Vec<usize> {
    levels.windows(2).map(|pair| pair[1] / pair[0]).collect()
}

impl SelfConvergence {
    /// The mesh on which levels are compared with the references.
    fn common_mesh(&self) -> Result<Mesh, MeshError> {
        let finest = self.levels.last().map_or(0, |(elements, _)| *elements);
        if self.axis == Axis::Time {
            resampled(&self.scene.mesh, finest)
        } else {
            fine_mesh(&self.scene, finest)
        }
    }
}
