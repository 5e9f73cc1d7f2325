//! Discretisations of any order: elements and steps, and two of them that are compared.

use thermobeam::dg::DgStepping;

use crate::kinds::prelude::*;
use crate::scene::{
    Method, Scene,
    file::{Degree, Growth, TimeDegree, first_where},
    limits::{self, Elements},
    resampled,
};

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
    pub stepping: DgStepping,
}

impl Discretisation {
    /// * `counts`: elements, degree p, degree q in time.
    /// * `steps`: the longest, the first after an event, and how fast they grow.
    pub(crate) fn new(
        [elements, degree, time_degree]: [usize; 3],
        [dt, restart_dt, growth]: [f64; 3],
    ) -> Self {
        Self {
            elements,
            degree,
            stepping: DgStepping {
                degree: time_degree,
                dt,
                restart_dt,
                growth,
                ..DgStepping::default()
            },
        }
    }

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
        format!(
            "{} x p = {}, q = {}",
            self.elements, self.degree, self.stepping.degree
        )
    }

    /// Cost of a run to t_end, in element-steps of a one-step scheme.
    pub fn cost(&self, t_end: f64) -> f64 {
        COST * (self.elements * self.degree * (self.stepping.degree + 1)) as f64 * t_end
            / self.stepping.dt
    }
}

/// A table of a discretisation of any order.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DiscretisationTable {
    /// number of elements
    elements: Elements,
    /// degree p in space
    degree: Degree,
    /// degree q in time
    time_degree: TimeDegree,
    /// the largest step
    dt: Positive,
    /// the first step, at the start and after each contact event
    restart_dt: Positive,
    /// factor of the steps in between, at least 1
    growth: Growth,
}

impl DiscretisationTable {
    /// For runs to `t_end`.
    fn discretisation(&self, t_end: f64) -> Result<Discretisation, Refusal> {
        let [dt, restart_dt] = [self.dt, self.restart_dt].map(Positive::get);
        limits::steps_to("dt", t_end, dt, limits::STEPS)?;
        if restart_dt > dt {
            let allowed = format!("a number > 0 and at most dt = {dt:?}");
            return Err(Refusal::written("restart_dt", allowed));
        }
        let [elements, degree] = [self.elements.get(), self.degree.get()];
        // Elements of different lengths need more memory.
        limits::memory_of_dg("elements", elements, 1, degree, self.time_degree.get())?;
        Ok(Discretisation::new(
            [elements, degree, self.time_degree.get()],
            [dt, restart_dt, self.growth.get()],
        ))
    }
}

/// The two discretisations of a list of tables.
///
/// * `elements`: for the semi-discrete system of a mesh, its number of linear elements, which both
///   must have; otherwise the two must differ in elements and degree.
/// * `t_end`: the final time of the runs.
pub(crate) fn two_discretisations(
    tables: &[DiscretisationTable],
    key: &str,
    elements: Option<usize>,
    t_end: f64,
) -> Result<[Discretisation; 2], Refusal> {
    let differing = match elements {
        None => "that differ in elements, degree, time_degree and dt".to_owned(),
        Some(n) => format!(
            "of {n} elements of degree 1, those refined in time, that differ in time_degree and dt"
        ),
    };
    let allowed = format!("two tables [[{key}]] {differing}");
    let list = Refusal::of_each(key, tables, |table| table.discretisation(t_end))?;
    let [one, other] = list[..] else {
        return Err(Refusal::written(key, allowed));
    };
    let is_of_mesh = elements.is_some();
    let same = first_where([
        ("elements", !is_of_mesh && one.elements == other.elements),
        ("degree", !is_of_mesh && one.degree == other.degree),
        ("time_degree", one.stepping.degree == other.stepping.degree),
        ("dt", one.stepping.dt == other.stepping.dt),
    ]);
    if let Some(same) = same {
        let found = format!("two with the same {same}");
        return Err(Refusal::new(key, found, allowed));
    }
    let is_other =
        |how: &Discretisation| elements.is_some_and(|n| (how.elements, how.degree) != (n, 1));
    match [one, other].into_iter().find(is_other) {
        Some(how) => {
            let found = format!("{} elements of degree {}", how.elements, how.degree);
            Err(Refusal::new(key, found, allowed))
        }
        None => Ok([one, other]),
    }
}
