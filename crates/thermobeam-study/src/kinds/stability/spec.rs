//! The table `[stability]`.

use super::{KIND, Parameter, Stability};
use crate::scene::limits;
use crate::scene::tables;
use convergence_study::input::{Field, InputError, Section};
use convergence_study::study::Header;

const KEYS: [&str; 8] = ["over", "dt", "range", "points", "lines", "elements", "steps", "agreement"];

pub(super) fn from_document(root: &Section<'_>) -> Result<Stability, InputError> {
    root.allow(&["study", KIND])?;
    let section = root.require(KIND, "a table with over, dt, range, points, lines and steps")?.section()?;
    section.allow(&KEYS)?;
    let over = section.require("over", "a second parameter")?.choice(&Parameter::ALL)?;
    let positive = "a finite number > 0";
    let values = "a list of at least one number";
    let lines = section.require("lines", values)?;
    let items = lines.items(values)?;
    if items.is_empty() {
        return Err(lines.refuse_as_written(values));
    }
    // ζ = 0 has no place on a logarithmic axis, and is the line that the theory excludes.
    let fits = |value: f64| value > 0.0 || over == Parameter::Beta || (over == Parameter::Zeta && value == 0.0);
    let range = section.require("range", "a range")?;
    if over == Parameter::Width {
        finest(&range, interval(&range, false)?[0])?;
        items.iter().try_for_each(|item| finest(item, item.number()?))?;
    }
    Ok(Stability {
        header: Header::from_document(root)?,
        over,
        dt: interval(&section.require("dt", "a range")?, false)?,
        range: interval(&range, over.is_linear())?,
        points: section.require("points", "a number of points")?.count(2..=limits::MAP_POINTS)?,
        lines: items
            .iter()
            .map(|item| item.number_where("a value of the parameter", fits))
            .collect::<Result<_, _>>()?,
        elements: tables::elements(&section.require("elements", "a number of elements")?)?,
        steps: section.require("steps", "a number of steps")?.count(1..=limits::STEPS)?,
        agreement: section.require("agreement", positive)?.number_where(positive, |a| a > 0.0)?,
    })
}

/// Refuses a mesh width for which the mesh does not fit into memory.
fn finest(field: &Field<'_>, width: f64) -> Result<(), InputError> {
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
