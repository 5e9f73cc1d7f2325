//! The study file: which scenes, on which meshes, until when.

use std::path::Path;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::judge::verdict::Judge;
use convergence_study::study::{FromFile, Header};

use super::{AnyOrder, EndStates};
use crate::kinds::steady::listed_scenes;
use crate::kinds::tables::{DISCRETISATION_KEYS, Discretisation};
use crate::scene::{limits, tables};

impl FromFile for EndStates {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "run", "any-order", "expect"])?;
        let run = root.require("run", "a table with scenes, elements, dt, speed and t_max")?.section()?;
        run.allow(&["scenes", "elements", "dt", "speed", "t_max"])?;
        let expect = root.require("expect", "a table with tolerance and error")?.section()?;
        expect.allow(&["tolerance", "error"])?;
        let (dt, t_max) = (run.positive("dt")?, run.positive("t_max")?);
        limits::steps_until(&run.require("t_max", "a number")?, t_max, dt, limits::STEPS)?;
        Ok(Self {
            header,
            scenes: listed_scenes(&run.require("scenes", "a list of scene files")?, folder)?,
            elements: mesh_sizes(&run)?,
            dt,
            speed: run.positive("speed")?,
            t_max,
            tolerance: tolerance(&expect)?,
            error: expect.positive("error")?,
            any_order: root.section("any-order")?.map(|section| any_order(&section)).transpose()?,
        })
    }
}

fn any_order(section: &Section<'_>) -> Result<AnyOrder, InputError> {
    section.allow(&[&["t_end", "error"][..], &DISCRETISATION_KEYS].concat())?;
    let t_end = section.positive("t_end")?;
    Ok(AnyOrder { how: Discretisation::read(section, t_end)?, t_end, error: section.positive("error")? })
}

fn tolerance(expect: &Section<'_>) -> Result<f64, InputError> {
    let allowed = "a number > 0 and < 0.5";
    let field = expect.require("tolerance", allowed)?;
    field.number_where(allowed, |tolerance| Judge::new(tolerance).is_ok())
}

fn mesh_sizes(run: &Section<'_>) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of at least three numbers of elements, ascending";
    let field: Field<'_> = run.require("elements", allowed)?;
    let sizes = field.items(allowed)?.iter().map(tables::elements).collect::<Result<Vec<_>, _>>()?;
    let ascending = sizes.windows(2).all(|pair| pair[0] < pair[1]);
    if sizes.len() >= 3 && ascending { Ok(sizes) } else { Err(field.refuse_as_written(allowed)) }
}
