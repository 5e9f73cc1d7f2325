//! The study file: which frequencies, on which meshes.
//!
//! ```toml
//! [frequencies]
//! degree = 3            # of the elements; 1 unless told
//! first = 3             # the lowest mode judged: of those below it high degrees leave only round-off; 1 unless told
//! count = 6             # the highest
//! elements = [6, 8, 12]
//! order = 6.0
//! tolerance = 0.1
//! ```

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{FromFile, Header};
use thermobeam::dg::MAX_DEGREE;
use thermobeam::mesh::Mesh;

use super::Frequencies;
use crate::expression::{Expression, Variable};
use crate::scene::functions::FunctionField;
use crate::scene::{limits, tables};

impl FromFile for Frequencies {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "frequencies"])?;
        let section = root.require("frequencies", "a table with count, elements, order and tolerance")?.section()?;
        section.allow(&["first", "count", "elements", "degree", "map", "order", "tolerance"])?;
        let number = |key: &str| section.positive(key);
        let elements = increasing(&section)?;
        let degree = section.get("degree").map_or(Ok(1), |field| field.count(1..=MAX_DEGREE))?;
        // A mesh has twice as many frequencies, of which the upper ones approximate nothing.
        let most = (elements[0] * degree).min(limits::MODES);
        let count = section.require("count", "a whole number >= 1")?.count(1..=most)?;
        let first = section.get("first").map_or(Ok(1), |field| field.count(1..=count))?;
        let map = map(&section, &elements)?;
        Ok(Self {
            header,
            first,
            count,
            degree,
            map,
            elements,
            order: number("order")?,
            tolerance: number("tolerance")?,
        })
    }
}

fn increasing(section: &Section<'_>) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of increasing whole numbers >= 1";
    let field = section.require("elements", allowed)?;
    let items = field.items(allowed)?;
    let elements = items.iter().map(tables::elements).collect::<Result<Vec<_>, _>>()?;
    let increases = elements.windows(2).all(|pair| pair[0] < pair[1]) && !elements.is_empty();
    if increases { Ok(elements) } else { Err(field.refuse_as_written(allowed)) }
}

fn map(section: &Section<'_>, elements: &[usize]) -> Result<Option<Expression>, InputError> {
    let Some(field) = section.get("map") else { return Ok(None) };
    let map = field.expression(Variable::S)?;
    field.finite(&map, 1.0, 0)?;
    for &elements in elements {
        tables::checked_mesh(Mesh::mapped(elements, |s| map.eval(s)), &field)?;
    }
    Ok(Some(map))
}
