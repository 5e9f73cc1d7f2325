//! Reading the file of a rigid-obstacle study.

use std::path::Path;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::judge::verdict::Judge;
use convergence_study::study::{FromFile, Header};

use super::RigidStudy;
use crate::kinds::steady::{at_resolution, listed_scene};
use crate::scene::{Scene, limits, tables};

impl FromFile for RigidStudy {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "obstacles", "moving", "rest", "impact"])?;
        let obstacles = root.require("obstacles", "a table with epsilon, limit and tolerance")?.section()?;
        obstacles.allow(&["epsilon", "limit", "tolerance"])?;
        let tolerance = obstacles.require("tolerance", "a number > 0 and < 0.5")?;
        let judge =
            Judge::new(tolerance.number()?).map_err(|_| tolerance.refuse_as_written("a number > 0 and < 0.5"))?;
        let moving = root.require("moving", "a table with scene, elements, dt, t_end and max_iterations")?.section()?;
        moving.allow(&["scene", "elements", "dt", "t_end", "max_iterations"])?;
        let rest = root.require("rest", "a table with scene, elements, dt, speed and t_max")?.section()?;
        rest.allow(&["scene", "elements", "dt", "speed", "t_max"])?;
        let impact = root.require("impact", "a table with scene and steps")?.section()?;
        impact.allow(&["scene", "steps"])?;
        let t_end = moving.positive("t_end")?;
        Ok(Self {
            header,
            epsilons: epsilons(&obstacles)?,
            limit: obstacles.positive("limit")?,
            judge,
            moving: scene(&moving, folder, Some(t_end))?,
            max_iterations: moving.require("max_iterations", "a whole number >= 1")?.count(1..=usize::MAX)?,
            resting: scene(&rest, folder, None)?,
            speed: rest.positive("speed")?,
            t_max: rest.positive("t_max")?,
            impact: impact_scene(&impact, folder)?,
            steps: impact.require("steps", "a whole number >= 1")?.count(1..=1_000_000)?,
        })
    }
}

/// The compliances.
fn epsilons(section: &Section<'_>) -> Result<Vec<f64>, InputError> {
    let allowed = "a list of at least three positive numbers, descending";
    let field = section.require("epsilon", allowed)?;
    let values = field.items(allowed)?.iter().map(Field::number).collect::<Result<Vec<f64>, _>>()?;
    let descending = values.windows(2).all(|pair| pair[0] > pair[1]);
    let positive = values.iter().all(|epsilon| *epsilon > 0.0);
    if values.len() >= 3 && descending && positive { Ok(values) } else { Err(field.refuse_as_written(allowed)) }
}

/// The scene of a table, at the table's resolution.
fn scene(section: &Section<'_>, folder: &Path, t_end: Option<f64>) -> Result<Scene, InputError> {
    let scene = listed_scene(&section.require("scene", "a scene file")?, folder)?;
    let field = section.require("elements", "a whole number >= 1")?;
    let scene = Scene { t_end: t_end.unwrap_or(scene.t_end), ..scene };
    let dt = section.require("dt", "a number")?;
    // The moving beam's tip is kept at every step.
    limits::steps_until(&dt, scene.t_end, section.positive("dt")?, limits::RECORDED_STEPS)?;
    if section.get("t_max").is_some() {
        limits::steps_until(&dt, section.positive("t_max")?, section.positive("dt")?, limits::STEPS)?;
    }
    at_resolution(&scene, tables::elements(&field)?, section.positive("dt")?)
        .map_err(|error| field.refuse(error.to_string(), "a mesh"))
}

/// The scene of the impact, whose free end must start on the upper obstacle and move into it.
fn impact_scene(section: &Section<'_>, folder: &Path) -> Result<Scene, InputError> {
    let field = section.require("scene", "a scene file")?;
    let scene = listed_scene(&field, folder)?;
    let at_tip = |function: &Option<crate::expression::Expression>| function.as_ref().map_or(0.0, |f| f.eval(1.0));
    let on_the_obstacle = scene.obstacles.is_some_and(|o| at_tip(&scene.initial.u) == o.g2);
    if on_the_obstacle && at_tip(&scene.initial.u_t) > 0.0 {
        return Ok(scene);
    }
    Err(field.refuse_as_written("a scene with u(1) = g2 and u_t(1) > 0"))
}
