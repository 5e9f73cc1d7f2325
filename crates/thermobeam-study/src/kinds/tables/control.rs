//! The table `[control]`: coefficients in which the solver differs from the sources.

use thermobeam::parameters::{Beam, Obstacles};

use crate::scene::tables;
use convergence_study::input::{InputError, Section};

/// The solver's coefficients in a negative control.
#[derive(Debug, Clone, PartialEq)]
pub struct Control {
    /// The solver's coefficients.
    pub beam: Beam,
    /// The solver's obstacles.
    pub obstacles: Option<Obstacles>,
    /// The names of those that differ; at least one.
    pub changed: Vec<&'static str>,
}

/// The table `[control]`, on top of the coefficients of the sources.
pub(crate) fn control(
    root: &Section<'_>,
    beam: Beam,
    obstacles: Option<Obstacles>,
) -> Result<Option<Control>, InputError> {
    let Some(section) = root.section("control")? else { return Ok(None) };
    let keys = [&tables::BEAM_KEYS[..], &tables::OBSTACLE_KEYS[..]].concat();
    section.allow(&keys)?;
    let mut control = Control { beam, obstacles, changed: Vec::new() };
    for key in keys {
        change(&section, key, &mut control)?;
    }
    if control.changed.is_empty() {
        return Err(root.refuse("control", "an empty table", "a table that changes at least one coefficient"));
    }
    control.beam.validate().map_err(|error| tables::out_of_range(&section, &error))?;
    if let Some(obstacles) = control.obstacles {
        obstacles.validate().map_err(|error| tables::out_of_range(&section, &error))?;
    }
    Ok(Some(control))
}

fn change(section: &Section<'_>, key: &'static str, control: &mut Control) -> Result<(), InputError> {
    let Some(field) = section.get(key) else { return Ok(()) };
    let value = field.number()?;
    let of_obstacles = control.obstacles.as_mut().and_then(|obstacles| tables::obstacle_coefficient(obstacles, key));
    let Some(coefficient) = tables::beam_coefficient(&mut control.beam, key).or(of_obstacles) else {
        let found = format!("{} without a table [obstacles]", field.as_written());
        return Err(field.refuse(found, tables::BEAM_KEYS.join(", ")));
    };
    // A control that changes nothing can only pass where it has to fail.
    if *coefficient == value {
        let found = format!("{}, which is the value of the sources", field.as_written());
        return Err(field.refuse(found, "another value"));
    }
    *coefficient = value;
    control.changed.push(key);
    Ok(())
}
