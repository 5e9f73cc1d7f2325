//! The study file: the diagrams, the meshes of the buckling force, the runs to rest.

use std::path::Path;

use super::BifurcationStudy;
use crate::kinds::steady::listed_scenes;
use crate::scene::limits;
use crate::scene::tables;
use convergence_study::input::{Field, InputError, Section};
use convergence_study::judge::verdict::Judge;
use convergence_study::study::{FromFile, Header};

impl FromFile for BifurcationStudy {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "diagram", "buckling", "rest"])?;
        let diagram = root.require("diagram", "a table with scenes, beta and points")?.section()?;
        diagram.allow(&["scenes", "beta", "points"])?;
        let (meshes, tolerance) = buckling(root)?;
        let rest = root.require("rest", "a table with beta, elements, dt, speed, t_max and distance")?.section()?;
        rest.allow(&["beta", "elements", "dt", "speed", "t_max", "distance"])?;
        let t_max = rest.require("t_max", "a number")?;
        limits::steps_until(&t_max, rest.positive("t_max")?, rest.positive("dt")?, limits::STEPS)?;
        Ok(Self {
            header,
            scenes: listed_scenes(&diagram.require("scenes", "a list of scene files")?, folder)?,
            grid: grid(&diagram)?,
            meshes,
            tolerance,
            betas: ascending(&rest, "beta", 1)?,
            elements: tables::elements(&rest.require("elements", "a whole number >= 1")?)?,
            dt: rest.positive("dt")?,
            speed: rest.positive("speed")?,
            t_max: rest.positive("t_max")?,
            distance: rest.positive("distance")?,
        })
    }
}

/// The β of the diagrams.
fn grid(diagram: &Section<'_>) -> Result<Vec<f64>, InputError> {
    let allowed = "a list of two numbers, ascending";
    let field = diagram.require("beta", allowed)?;
    let ends = numbers(&field, allowed)?;
    let &[low, high] = ends.as_slice() else { return Err(field.refuse_as_written(allowed)) };
    if low >= high {
        return Err(field.refuse_as_written(allowed));
    }
    let points = diagram.require("points", "a whole number >= 2")?.count(2..=100_000)?;
    let last = (points - 1) as f64;
    Ok((0..points).map(|k| low + (high - low) * (k as f64 / last)).collect())
}

fn buckling(root: &Section<'_>) -> Result<(Vec<usize>, f64), InputError> {
    let section = root.require("buckling", "a table with elements and tolerance")?.section()?;
    section.allow(&["elements", "tolerance"])?;
    let allowed = "a list of at least three numbers of elements, ascending";
    let field = section.require("elements", allowed)?;
    let meshes = field.items(allowed)?.iter().map(tables::elements).collect::<Result<Vec<_>, _>>()?;
    if meshes.len() < 3 || meshes.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(field.refuse_as_written(allowed));
    }
    let tolerance = section.require("tolerance", "a number > 0 and < 0.5")?;
    Judge::new(tolerance.number()?).map_err(|_| tolerance.refuse_as_written("a number > 0 and < 0.5"))?;
    Ok((meshes, tolerance.number()?))
}

fn ascending(section: &Section<'_>, key: &str, least: usize) -> Result<Vec<f64>, InputError> {
    let allowed = "a list of numbers, ascending";
    let field = section.require(key, allowed)?;
    let values = numbers(&field, allowed)?;
    let ordered = values.windows(2).all(|pair| pair[0] < pair[1]);
    if values.len() >= least && ordered { Ok(values) } else { Err(field.refuse_as_written(allowed)) }
}

fn numbers(field: &Field<'_>, allowed: &str) -> Result<Vec<f64>, InputError> {
    field.items(allowed)?.iter().map(Field::number).collect()
}
