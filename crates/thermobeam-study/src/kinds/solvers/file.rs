//! The study file: which of the three parts, and their numbers.

use std::path::Path;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::study::{FromFile, Header};

use super::comparison::Comparison;
use super::contraction::Grid;
use super::map::{Map, Parameter};
use super::{ROW, Solvers};
use crate::scene::{Scene, limits, tables};

/// The parts of a study, one table each.
const PARTS: [&str; 3] = ["contraction", "comparison", "map"];

impl FromFile for Solvers {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&[&["study"], &PARTS[..]].concat())?;
        if PARTS.iter().all(|part| root.get(part).is_none()) {
            return Err(
                root.missing(PARTS[0], &format!("at least one table for kind \"{}\": {}", ROW.name, PARTS.join(", ")))
            );
        }
        Ok(Self {
            header,
            contraction: root.section(PARTS[0])?.map(|section| contraction(&section)).transpose()?,
            comparison: root.section(PARTS[1])?.map(|section| comparison(&section, folder)).transpose()?,
            map: root.section(PARTS[2])?.map(|section| map(&section)).transpose()?,
        })
    }
}

fn elements(section: &Section<'_>) -> Result<usize, InputError> {
    tables::elements(&section.require("elements", "a number of elements")?)
}

fn positive_numbers(section: &Section<'_>, key: &str) -> Result<Vec<f64>, InputError> {
    let allowed = "a list of at least one number > 0";
    let field = section.require(key, allowed)?;
    let items = field.items(allowed)?;
    if items.is_empty() {
        return Err(field.refuse_as_written(allowed));
    }
    items.iter().map(Field::positive).collect()
}

fn contraction(section: &Section<'_>) -> Result<Grid, InputError> {
    section.allow(&["elements", "dt", "epsilon", "zeta"])?;
    let list = |key: &str| positive_numbers(section, key);
    let [dt, epsilon, zeta] = [list("dt")?, list("epsilon")?, list("zeta")?];
    limits::cases(&section.require("dt", "a list")?, &[dt.len(), epsilon.len(), zeta.len()])?;
    Ok(Grid { elements: elements(section)?, dt, epsilon, zeta })
}

fn comparison(section: &Section<'_>, folder: &Path) -> Result<Comparison, InputError> {
    section.allow(&["scene", "elements", "steps", "tolerances"])?;
    Ok(Comparison {
        scene: Scene::read_one_step(&section.require("scene", "a scene file beside this one")?, folder)?,
        elements: elements(section)?,
        // Each is a point of a figure.
        steps: section.require("steps", "a number of steps")?.count(1..=limits::RECORDED_STEPS)?,
        tolerances: positive_numbers(section, "tolerances")?,
    })
}

fn map(section: &Section<'_>) -> Result<Map, InputError> {
    section.allow(&["over", "dt", "range", "points", "lines", "elements", "steps", "agreement"])?;
    let over = section.require("over", "a second parameter")?.choice(&Parameter::ALL)?;
    let range = section.require("range", "a range")?;
    if over == Parameter::Width {
        check_width(&range, interval(&range, false)?[0])?;
    }
    Ok(Map {
        over,
        dt: interval(&section.require("dt", "a range")?, false)?,
        range: interval(&range, over.is_linear())?,
        points: section.require("points", "a number of points")?.count(2..=limits::MAP_POINTS)?,
        lines: lines(section, over)?,
        elements: elements(section)?,
        steps: section.require("steps", "a number of steps")?.count(1..=limits::STEPS)?,
        agreement: section.positive("agreement")?,
    })
}

fn lines(section: &Section<'_>, over: Parameter) -> Result<Vec<f64>, InputError> {
    let allowed = "a list of at least one number";
    let field = section.require("lines", allowed)?;
    let items = field.items(allowed)?;
    if items.is_empty() {
        return Err(field.refuse_as_written(allowed));
    }
    // ζ = 0 has no place on a logarithmic axis, and is the value that the theory excludes.
    let fits = |value: f64| value > 0.0 || over == Parameter::Beta || (over == Parameter::Zeta && value == 0.0);
    let value = |item: &Field<'_>| {
        let value = item.number_where("a value of the parameter", fits)?;
        if over == Parameter::Width {
            check_width(item, value)?;
        }
        Ok(value)
    };
    items.iter().map(value).collect()
}

/// Refuses a mesh width for which the mesh does not fit into memory.
fn check_width(field: &Field<'_>, width: f64) -> Result<(), InputError> {
    let elements = (1.0 / width).round();
    if elements <= limits::ELEMENTS as f64 {
        return Ok(());
    }
    let found =
        format!("{}, of which the finest mesh would take {}", field.as_written(), limits::memory_of_elements(elements));
    Err(field.refuse(found, format!("h >= {:.1e}", 1.0 / limits::ELEMENTS as f64)))
}

/// Two ascending numbers, positive unless the axis is linear.
fn interval(field: &Field<'_>, linear: bool) -> Result<[f64; 2], InputError> {
    let allowed = if linear { "two ascending numbers" } else { "two ascending numbers > 0" };
    let items = field.items(allowed)?;
    let [low, high] = items.as_slice() else { return Err(field.refuse_as_written(allowed)) };
    let (low, high) = (low.number()?, high.number()?);
    if low < high && (linear || low > 0.0) { Ok([low, high]) } else { Err(field.refuse_as_written(allowed)) }
}
