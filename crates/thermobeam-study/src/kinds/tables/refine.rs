//! The table `[refine]`: the meshes and time steps of a study.

use convergence_study::{
    Budget, Refinement,
    file::{Choices, Counts, Number, Range},
};

use crate::kinds::prelude::*;
use crate::{
    expression::Expression,
    scene::{
        file::{Formula, OfS, Schemes, SolverKeys, Solvers},
        limits::{self, Elements},
        tables,
    },
};
use convergence_judge::random::SplitMix;
use thermobeam::{
    mesh::{Mesh, MeshError},
    one_step::Stepping,
    scheme::{EULER_CRANK_NICOLSON, Scheme},
    solve::Settings,
};

/// A random displacement of the interior nodes, the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perturbation {
    /// Each node of the uniform mesh moves by up to `amount * h / 2`; 0 <= amount < 1.
    pub amount: f64,
    /// Seed of the displacement.
    pub seed: u64,
}

impl Perturbation {
    /// New position of node `i` of `elements`; the ends stay in place.
    fn displaced(&self, i: usize, elements: usize) -> f64 {
        let n = elements as f64;
        if i == 0 || i == elements {
            return i as f64 / n;
        }
        // Every level has its own random numbers: nested displacements would not be random.
        let level = scramble(self.seed ^ scramble(elements as u64));
        let seed = scramble(level.wrapping_add(i as u64));
        let unit = SplitMix::new(seed).within([-1.0, 1.0]);
        (i as f64 + 0.5 * self.amount * unit) / n
    }
}

/// A number of 64 random bits for each state.
fn scramble(state: u64) -> u64 {
    SplitMix::new(state).next_u64()
}

/// Positions of the nodes of a mesh: equidistant, displaced, then mapped.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// Random displacement of the nodes.
    pub perturbation: Option<Perturbation>,
    /// A function of s.
    pub map: Option<Expression>,
}

impl Layout {
    /// Nodes at the images of a map, which is checked on every mesh.
    pub(crate) fn new(
        map: Option<&Formula<OfS>>,
        elements: &[usize],
        perturbation: Option<Perturbation>,
    ) -> Result<Self, Refusal> {
        let mut layout = Self {
            perturbation,
            map: None,
        };
        if let Some(map) = map {
            layout.map = Some(map.parse("map", 1.0, 0)?);
            for &elements in elements {
                tables::mapped("map", layout.mesh(elements))?;
            }
        }
        Ok(layout)
    }

    /// The mesh with this number of elements.
    ///
    /// # Errors
    /// [`MeshError`] if its nodes do not increase from 0 to 1.
    pub fn mesh(&self, elements: usize) -> Result<Mesh, MeshError> {
        Mesh::mapped(elements, |s| {
            let index = (s * elements as f64).round() as usize;
            let s = self
                .perturbation
                .map_or(s, |perturbation| perturbation.displaced(index, elements));
            self.map.as_ref().map_or(s, |map| map.eval(s))
        })
    }
}

/// The mean mesh width 1/n of n elements: the step against which errors are judged.
///
/// The images of uniform meshes under one map have errors in proportion to powers of 1/n. Their
/// longest element is `max |map'| / n + O(1/n²)`: rates over it would have an error of the first
/// order in 1/n, which at order 6 and 4 to 14 elements moved the rate from 6.00 to 6.08.
pub(crate) fn mean_width(elements: usize) -> f64 {
    1.0 / elements as f64
}

/// The level of a mesh of so many elements, over the mean mesh width.
pub(crate) fn level_of_mesh(label: impl Into<String>, elements: usize) -> Refinement {
    let parameters = [("elements", elements)];
    Refinement::new(label.into(), &parameters, mean_width(elements))
}

/// What is refined, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Refine {
    /// What is refined.
    pub axis: RefinedIn,
    /// Is the error of the other axis removed exactly? Always false for [`RefinedIn::Both`].
    pub isolate: bool,
    /// Elements, increasing; a single number if only time is refined.
    pub elements: Vec<usize>,
    /// Time steps, increasing; a single number if only space is refined.
    pub steps: Vec<usize>,
    /// With [`RefinedIn::Both`]: all combinations of elements and steps, instead of pairs.
    pub grid: bool,
    /// Final time.
    pub t_end: f64,
    /// Positions of the nodes of each mesh.
    pub layout: Layout,
    /// Time scheme.
    pub scheme: Scheme,
    /// How each step is solved.
    pub settings: Settings,
    /// Levels are added until there is a verdict or the budget of node-steps (elements times time
    /// steps) is used up.
    pub budget: Option<f64>,
}

impl Refine {
    /// The runs as (elements, steps), coarse to fine.
    pub fn cases(&self) -> Vec<(usize, usize)> {
        if self.axis == RefinedIn::Both && !self.grid {
            return self
                .elements
                .iter()
                .copied()
                .zip(self.steps.iter().copied())
                .collect();
        }
        // The list of a fixed axis has one member.
        self.elements
            .iter()
            .flat_map(|&elements| self.steps.iter().map(move |&steps| (elements, steps)))
            .collect()
    }

    /// The next level, twice as fine in the refined axes.
    pub fn finer(&self, (elements, steps): (usize, usize)) -> (usize, usize) {
        let [in_space, in_time] =
            [RefinedIn::Time, RefinedIn::Space].map(|other| 1 + usize::from(self.axis != other));
        (in_space * elements, in_time * steps)
    }

    /// Whether the error of the other axis is removed when this one is studied.
    pub(crate) fn isolates(&self, axis: RefinedIn) -> bool {
        self.isolate && self.axis == axis
    }

    /// Identifies a run in words.
    pub fn label(elements: usize, steps: usize) -> String {
        format!("n = {elements}, {steps} steps")
    }

    /// The step of a level: 1/n, the mean mesh width, or dt if only time is refined.
    pub(crate) fn step_of(&self, elements: usize, steps: usize) -> f64 {
        match self.axis {
            RefinedIn::Space | RefinedIn::Both => mean_width(elements),
            RefinedIn::Time => self.dt(steps),
        }
    }

    /// A run as a level of refinement.
    pub(crate) fn level(elements: usize, steps: usize, step: f64) -> Refinement {
        Refinement::new(
            Self::label(elements, steps),
            &[("elements", elements), ("steps", steps)],
            step,
        )
    }

    /// How a run with this number of steps is stepped.
    pub(crate) fn stepping(&self, steps: usize, loaded: bool) -> Stepping {
        Stepping {
            scheme: self.scheme,
            settings: self.settings,
            dt: self.dt(steps),
            loaded,
        }
    }

    /// The length of a step.
    pub fn dt(&self, steps: usize) -> f64 {
        self.t_end / steps as f64
    }
}

/// Default budget in node-steps of a study that adds levels: a quarter of a second.
const BUDGET: f64 = 1e7;

/// The table `[refine]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RefineTable {
    /// what is refined
    axis: OneOf<Axes>,
    /// the error of the other axis is removed exactly
    #[serde(default)]
    isolate: bool,
    /// numbers of elements, increasing, or "auto": doubled until it is decided; one number where
    /// time is refined
    elements: Counts<Elements>,
    /// numbers of steps, as elements; one number where space is refined
    steps: Counts<Count<1, { limits::STEPS }>>,
    /// all pairs of elements and steps, where the axis is both
    #[serde(default)]
    grid: bool,
    /// final time
    t_end: Positive,
    /// a function of s that places the nodes: 0 at 0, 1 at 1; without it s
    map: Option<Formula<OfS>>,
    /// with "auto": elements times steps of all levels; without it 1e7
    budget: Option<Positive>,
    /// part of half an element by which nodes are displaced at random, below 1
    perturb: Option<Number<BelowOne>>,
    /// of the displacements; without it 0
    seed: Option<Count<0>>,
    /// the one-step scheme
    #[schemars(extend("default" = EULER_CRANK_NICOLSON.name))]
    scheme: Option<OneOf<Schemes>>,
    /// how a step is solved; without it by "newton"
    solver: Option<OneOf<Solvers>>,
    /// the increment at which an iteration ends; without it 1e-10
    tolerance: Option<Positive>,
    /// iterations after which a step fails
    #[schemars(extend("default" = 100))]
    max_iterations: Option<Count<1>>,
    /// of the fixed point in each step, in place of tolerance and max_iterations
    iterations: Option<Count<1>>,
}

/// What can be refined.
#[derive(Debug)]
pub(crate) enum Axes {}

impl Choices for Axes {
    type Value = RefinedIn;

    fn all() -> Vec<(&'static str, RefinedIn)> {
        RefinedIn::ALL.map(|axis| (axis.name(), axis)).to_vec()
    }
}

/// The range of the numbers from 0 that are below 1.
#[derive(Debug, Clone, Copy)]
pub(crate) enum BelowOne {}

impl Range for BelowOne {
    const ENDS: &'static [(&'static str, f64)] = &[("minimum", 0.0), ("exclusiveMaximum", 1.0)];
}

impl RefineTable {
    /// What is refined, and how.
    ///
    /// # Errors
    /// Values that do not go together.
    pub(crate) fn refine(&self) -> Result<Refine, Refusal> {
        let axis = self.axis.value;
        let elements = levels("elements", &self.elements, axis, axis != RefinedIn::Time)?;
        let steps = levels("steps", &self.steps, axis, axis != RefinedIn::Space)?;
        if self.grid && axis != RefinedIn::Both {
            return Err(Refusal::written(
                "grid",
                "true only where the axis is \"both\"",
            ));
        }
        if self.isolate && axis == RefinedIn::Both {
            return Err(Refusal::written(
                "isolate",
                "false where the axis is \"both\"",
            ));
        }
        let autos = [
            ("elements", self.elements == Counts::Auto),
            ("steps", self.steps == Counts::Auto),
        ];
        let refined = match axis {
            RefinedIn::Space => &autos[..1],
            RefinedIn::Time => &autos[1..],
            RefinedIn::Both => &autos[..],
        };
        let perturbation = match (self.perturb, self.seed) {
            (None, Some(_)) => {
                let more = " without perturb";
                return Err(Refusal::written_and("seed", more, "perturb beside it"));
            }
            (perturb, seed) => perturb.map(|amount| Perturbation {
                amount: amount.get(),
                seed: seed.map_or(0, Count::get) as u64,
            }),
        };
        let keys = SolverKeys {
            solver: self.solver,
            tolerance: self.tolerance,
            max_iterations: self.max_iterations,
            iterations: self.iterations,
        };
        let refine = Refine {
            axis,
            budget: Budget::read(refined, self.grid, self.budget, BUDGET)?,
            isolate: self.isolate,
            grid: self.grid,
            t_end: self.t_end.get(),
            layout: Layout::new(self.map.as_ref(), &elements, perturbation)?,
            elements,
            steps,
            scheme: self
                .scheme
                .map_or(EULER_CRANK_NICOLSON, |scheme| scheme.value),
            settings: keys.over(Settings::default())?,
        };
        check_pairs(&refine)?;
        Ok(refine)
    }
}

/// Refuses lists of both axes that make too many runs, or no pairs.
fn check_pairs(refine: &Refine) -> Result<(), Refusal> {
    let [elements, steps] = [refine.elements.len(), refine.steps.len()];
    if refine.grid {
        limits::case_count("elements", &[elements, steps])
    } else if refine.axis == RefinedIn::Both && elements != steps {
        let found = format!("{steps} numbers of steps for {elements} of elements");
        let allowed = "lists of the same length, or grid = true for all combinations";
        Err(Refusal::new("steps", found, allowed))
    } else {
        Ok(())
    }
}

/// An increasing list if the key is refined, otherwise one number.
fn levels<T: Copy + Into<usize>>(
    key: &str,
    counts: &Counts<T>,
    axis: RefinedIn,
    is_refined: bool,
) -> Result<Vec<usize>, Refusal> {
    match counts {
        Counts::Auto if is_refined => Ok(Budget::FIRST_LEVELS.into()),
        Counts::List(list) if is_refined => Ok(list.iter().map(|&level| level.into()).collect()),
        &Counts::One(level) if !is_refined => Ok(vec![level.into()]),
        _ => {
            let what = if is_refined {
                "a list of increasing whole numbers >= 1, or \"auto\""
            } else {
                "a single whole number >= 1"
            };
            let allowed = format!("{what}, because axis = \"{}\"", axis.name());
            Err(Refusal::written(key, allowed))
        }
    }
}
