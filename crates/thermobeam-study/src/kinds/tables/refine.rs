//! The table `[refine]`: the meshes and time steps of a study.

use convergence_study::{Refinement, internal::study::until_decided};

use crate::kinds::prelude::*;
use crate::{
    expression::{Expression, Variable},
    kinds::settings::{ActiveTerms, Exercise, Integration, Nodes, axis_in_words},
    scene::{
        file::{Formula, OfS},
        limits::{self, Elements},
        tables,
    },
};
use convergence_judge::judge::random::SplitMix;
use thermobeam::{
    mesh::{Mesh, MeshError},
    one_step::Stepping,
    scheme::Scheme,
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
    /// What the meshes are like.
    pub(crate) fn nodes(&self) -> Nodes {
        match self {
            Self { map: Some(_), .. } => Nodes::Graded,
            Self {
                perturbation: Some(_),
                ..
            } => Nodes::Perturbed,
            _ => Nodes::Uniform,
        }
    }

    /// Nodes at the images of a map, which is checked on every mesh.
    pub(crate) fn new(
        map: Option<&Formula<OfS>>,
        elements: &[Elements],
        perturbation: Option<Perturbation>,
    ) -> Result<Self, Refusal> {
        let mut layout = Self {
            perturbation,
            map: None,
        };
        if let Some(map) = map {
            layout.map = Some(map.parse("map", 1.0, 0)?);
            for elements in elements {
                tables::mapped("map", layout.mesh(elements.get()))?;
            }
        }
        Ok(layout)
    }

    /// The key `map`, checked on every mesh.
    pub(crate) fn read(
        section: &Section<'_>,
        elements: &[usize],
        perturbation: Option<Perturbation>,
    ) -> Result<Self, InputError> {
        let mut layout = Self {
            perturbation,
            map: None,
        };
        if let Some(field) = section.get("map") {
            layout.map = Some(tables::function(&field, Variable::S, 1.0, 0)?);
            for &elements in elements {
                tables::checked_mesh(layout.mesh(elements), &field)?;
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
    pub axis: Axis,
    /// Is the error of the other axis removed exactly? Always false for [`Axis::Both`].
    pub isolate: bool,
    /// Elements, increasing; a single number if only time is refined.
    pub elements: Vec<usize>,
    /// Time steps, increasing; a single number if only space is refined.
    pub steps: Vec<usize>,
    /// With [`Axis::Both`]: all combinations of elements and steps, instead of pairs.
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
    /// What a study with this refinement exercises.
    pub(crate) fn exercise(&self, topic: &'static str, terms: ActiveTerms) -> Exercise {
        Exercise::new(
            topic,
            Integration::of(&self.scheme, self.settings.solver),
            terms,
        )
        .refined_in(axis_in_words(self.axis))
        .on(self.layout.nodes())
    }

    /// The runs as (elements, steps), coarse to fine.
    pub fn cases(&self) -> Vec<(usize, usize)> {
        if self.axis == Axis::Both && !self.grid {
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
            [Axis::Time, Axis::Space].map(|other| 1 + usize::from(self.axis != other));
        (in_space * elements, in_time * steps)
    }

    /// Whether the error of the other axis is removed when this one is studied.
    pub(crate) fn isolates(&self, axis: Axis) -> bool {
        self.isolate && self.axis == axis
    }

    /// Identifies a run in words.
    pub fn label(elements: usize, steps: usize) -> String {
        format!("n = {elements}, {steps} steps")
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

/// The keys that place the nodes of meshes.
pub(crate) const MAP: Key = Key::new(
    "map",
    Form::Text,
    "a function of s that places the nodes: 0 at 0, 1 at 1",
)
.or("\"s\"");

const LEVELS: Form = Form::OneOf(&[
    Form::Count(1),
    Form::List(&Form::Count(1)),
    Form::Choice(|| vec!["auto"]),
]);

/// The table `[refine]`.
pub(crate) const REFINE: Key = Key::new(
    "refine",
    Form::Table(&[
        &[&KEYS, &tables::STEPPING_KEYS],
        &[&KEYS, &PERTURBED, &tables::STEPPING_KEYS],
    ]),
    "the meshes and steps of the runs",
);

const PERTURBED: [Key; 2] = [
    Key::new(
        "perturb",
        Form::Number,
        "part of half an element by which nodes are displaced at random, below 1",
    ),
    Key::new("seed", Form::Count(0), "of the displacements").or("0"),
];

const KEYS: [Key; 8] = [
    Key::new(
        "axis",
        Form::Choice(|| Axis::ALL.map(Axis::name).to_vec()),
        "what is refined",
    ),
    Key::new(
        "isolate",
        Form::Boolean,
        "the error of the other axis is removed exactly",
    )
    .or("false"),
    Key::new(
        "elements",
        LEVELS,
        "numbers of elements, increasing, or `\"auto\"`: doubled until it is decided; one number where time is refined",
    ),
    Key::new(
        "steps",
        LEVELS,
        "numbers of steps, as elements; one number where space is refined",
    ),
    Key::new(
        "grid",
        Form::Boolean,
        "all pairs of elements and steps, where the axis is both",
    )
    .or("false"),
    Key::new("t_end", Form::Positive, "final time"),
    MAP,
    Key::new(
        "budget",
        Form::Positive,
        "with `\"auto\"`: elements times steps of all levels",
    )
    .or("1e7"),
];

/// The table `[refine]`.
pub(crate) fn refine(root: &Section<'_>) -> Result<Refine, InputError> {
    let section = root
        .require("refine", "a table with axis, elements, steps and t_end")?
        .section()?;
    let axis = section.require("axis", "\"space\", \"time\", \"both\"")?;
    let axis = axis.choice(&Axis::ALL.map(|axis| (axis.name(), axis)))?;
    let elements = levels(
        &section,
        "elements",
        axis,
        axis != Axis::Time,
        tables::elements,
    )?;
    let grid = flag(
        &section,
        "grid",
        axis == Axis::Both,
        "true only where the axis is \"both\"",
    )?;
    let node_steps = "a number of elements times time steps > 0";
    let refine = Refine {
        axis,
        budget: until_decided::budget(&section, &["elements", "steps"], grid, BUDGET, node_steps)?,
        isolate: flag(
            &section,
            "isolate",
            axis != Axis::Both,
            "false where the axis is \"both\"",
        )?,
        steps: levels(&section, "steps", axis, axis != Axis::Space, |field| {
            field.count(1..=limits::STEPS)
        })?,
        grid,
        t_end: section.positive("t_end")?,
        layout: Layout::read(&section, &elements, perturbation(&section)?)?,
        elements,
        scheme: tables::scheme(&section)?,
        settings: tables::settings(&section)?,
    };
    if axis == Axis::Both {
        check_pairs(&section, &refine)?;
    }
    Ok(refine)
}

/// Refuses lists of both axes that make too many runs, or no pairs.
fn check_pairs(section: &Section<'_>, refine: &Refine) -> Result<(), InputError> {
    let [elements, steps] = [refine.elements.len(), refine.steps.len()];
    if refine.grid {
        limits::cases(&section.require("elements", "a list")?, &[elements, steps])
    } else if elements != steps {
        let found = format!("{steps} numbers of steps for {elements} of elements");
        let allowed = "lists of the same length, or grid = true for all combinations";
        Err(section.refuse("steps", found, allowed))
    } else {
        Ok(())
    }
}

/// A key that may be true only if `possible`.
fn flag(
    section: &Section<'_>,
    key: &str,
    possible: bool,
    allowed: &str,
) -> Result<bool, InputError> {
    let Some(field) = section.get(key) else {
        return Ok(false);
    };
    let value = field.boolean()?;
    if value && !possible {
        Err(field.refuse_as_written(allowed))
    } else {
        Ok(value)
    }
}

/// An increasing list if the key is refined, otherwise one number.
fn levels(
    section: &Section<'_>,
    key: &str,
    axis: Axis,
    refined: bool,
    read: impl Fn(&Field<'_>) -> Result<usize, InputError>,
) -> Result<Vec<usize>, InputError> {
    let what = if refined {
        "a list of increasing whole numbers >= 1, or \"auto\""
    } else {
        "a single whole number >= 1"
    };
    let allowed = format!("{what}, because axis = \"{}\"", axis.name());
    let field = section.require(key, &allowed)?;
    if refined && until_decided::is_auto(&field) {
        return Ok(until_decided::FIRST.into());
    }
    if !refined {
        let single = if field.is_list() {
            Err(field.refuse_as_written(allowed))
        } else {
            read(&field)
        };
        return Ok(vec![single?]);
    }
    increasing(section, key, &allowed, 1, read)
}

/// A list of at least `least` increasing levels.
pub(crate) fn increasing(
    section: &Section<'_>,
    key: &str,
    allowed: &str,
    least: usize,
    read: impl Fn(&Field<'_>) -> Result<usize, InputError>,
) -> Result<Vec<usize>, InputError> {
    let relation = "a whole number >";
    section.sequence(
        (key, allowed, least),
        read,
        (relation, |before, level| level > before),
    )
}

/// A list of at least two levels, each a multiple of its predecessor.
pub(crate) fn nested(
    section: &Section<'_>,
    key: &str,
    read: impl Fn(&Field<'_>) -> Result<usize, InputError>,
) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of at least two whole numbers, each a multiple of the one before";
    section.multiples(key, allowed, read)
}

fn perturbation(section: &Section<'_>) -> Result<Option<Perturbation>, InputError> {
    let (seed, perturb) = (section.get("seed"), section.get("perturb"));
    if let (Some(seed), None) = (&seed, &perturb) {
        return Err(seed.refuse(
            format!("{} without perturb", seed.as_written()),
            "perturb beside it",
        ));
    }
    let Some(field) = perturb else {
        return Ok(None);
    };
    let amount = field.number_where("a number >= 0 and < 1", |amount| {
        (0.0..1.0).contains(&amount)
    })?;
    let seed = seed.map_or(Ok(0), |seed| seed.count(0..=usize::MAX))? as u64;
    Ok(Some(Perturbation { amount, seed }))
}
