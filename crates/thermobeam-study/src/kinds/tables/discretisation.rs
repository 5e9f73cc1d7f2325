//! Two discretisations of any order, as tables with elements, degrees and steps: each checks the other.

use convergence_study::input::POSITIVE;
use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE, Stepping};

use crate::kinds::prelude::*;

/// The keys of a discretisation.
pub(crate) const DISCRETISATION_KEYS: [&str; 6] = ["elements", "degree", "time_degree", "dt", "restart_dt", "growth"];

/// The cost of a solve per unknown, in steps of a one-step scheme.
const COST: f64 = 30.0;

/// Elements and steps of one discretisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Discretisation {
    /// Elements, distributed like those of the scene.
    pub elements: usize,
    /// Degree p.
    pub degree: usize,
    /// Degree q in time and the lengths of steps.
    pub stepping: Stepping,
}

impl Discretisation {
    /// Discretises a scene in this way.
    ///
    /// # Errors
    /// [`CaseFailure`] if the mesh has elements that are too small.
    pub fn of(&self, scene: &Scene, t_end: f64) -> Result<Scene, CaseFailure> {
        Ok(Scene {
            mesh: resampled(&scene.mesh, self.elements)?,
            degree: self.degree,
            method: Method::Dg(self.stepping),
            t_end,
            ..scene.clone()
        })
    }

    /// Its identification in words.
    pub fn label(&self) -> String {
        format!("{} x p = {}, q = {}", self.elements, self.degree, self.stepping.degree)
    }

    /// Cost of a run to t_end, in element-steps of a one-step scheme.
    pub fn cost(&self, t_end: f64) -> f64 {
        COST * (self.elements * self.degree * (self.stepping.degree + 1)) as f64 * t_end / self.stepping.dt
    }

    /// Reads a table that has [`DISCRETISATION_KEYS`], and possibly others, for runs to `t_end`.
    pub(crate) fn read(section: &Section<'_>, t_end: f64) -> Result<Self, InputError> {
        let field = section.require("dt", POSITIVE)?;
        let dt = field.positive()?;
        limits::steps_until(&field, t_end, dt, limits::STEPS)?;
        let restart = format!("a number > 0 and at most dt = {dt:?}");
        let growth = "a finite number >= 1";
        let field = section.require("elements", "a whole number >= 1")?;
        let elements = tables::elements(&field)?;
        let degree = section.count("degree", 1..=MAX_DEGREE)?;
        let time_degree = section.count("time_degree", 0..=MAX_TIME_DEGREE)?;
        // Elements of different lengths need more memory.
        limits::any_order_memory(&field, elements, 1, degree, time_degree)?;
        Ok(Self {
            elements,
            degree,
            stepping: Stepping {
                degree: time_degree,
                dt,
                restart_dt: section.require("restart_dt", &restart)?.number_where(&restart, |h| h > 0.0 && h <= dt)?,
                growth: section.require("growth", growth)?.number_where(growth, |value| value >= 1.0)?,
                ..Stepping::default()
            },
        })
    }
}

/// A list of two tables.
///
/// * `elements`: for the semi-discrete system of a mesh, its number of linear elements, which both must have; otherwise
///   the two must differ in elements and degree.
/// * `t_end`: the final time of the runs.
pub(crate) fn discretisations(
    root: &Section<'_>,
    key: &str,
    elements: Option<usize>,
    t_end: f64,
) -> Result<[Discretisation; 2], InputError> {
    let allowed = match elements {
        None => format!("two tables [[{key}]] that differ in elements, degree, time_degree and dt"),
        Some(n) => format!(
            "two tables [[{key}]] of {n} elements of degree 1, those refined in time, that differ in time_degree and dt"
        ),
    };
    let one = |item: &Field<'_>| {
        let section = item.section()?;
        section.allow(&DISCRETISATION_KEYS)?;
        Discretisation::read(&section, t_end)
    };
    let list = root.list(key, &allowed, one, |list| list.len() == 2)?;
    let (one, other) = (list[0], list[1]);
    let steps =
        [("time_degree", one.stepping.degree == other.stepping.degree), ("dt", one.stepping.dt == other.stepping.dt)];
    let space = [("elements", one.elements == other.elements), ("degree", one.degree == other.degree)];
    let same = if elements.is_some() { steps.to_vec() } else { [space, steps].concat() };
    if let Some((same, _)) = same.iter().find(|(_, is_same)| *is_same) {
        return Err(root.refuse(key, format!("two with the same {same}"), allowed));
    }
    match elements.and_then(|n| [one, other].into_iter().find(|how| (how.elements, how.degree) != (n, 1))) {
        Some(Discretisation { elements, degree, .. }) => {
            Err(root.refuse(key, format!("{elements} elements of degree {degree}"), allowed))
        }
        None => Ok([one, other]),
    }
}
