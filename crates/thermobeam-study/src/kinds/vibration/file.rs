//! The file of a vibration study: modes, what is refined, orders.

use std::path::Path;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::study::{Axis, FromFile, Header};
use thermobeam::parameters::Beam;

use super::{Cooling, Vibrating, Vibration};
use crate::kinds::tables::{Refine, control, expectations, refine};
use crate::scene::{limits, tables};

impl FromFile for Vibration {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "beam", "mode", "heat", "refine", "control", "expect"])?;
        let beam = beam(root)?;
        let refine = refine(root)?;
        bounded(root, &refine)?;
        let modes = modes(root, &refine)?;
        let heat = heat(root, &refine)?;
        let solver = control(root, beam, None)?.map_or(beam, |control| control.beam);
        Ok(Self { header, beam, solver, modes, heat, refine, expect: expectations(root)? })
    }
}

/// The beam, which must be one whose modes are exact.
fn beam(root: &Section<'_>) -> Result<Beam, InputError> {
    let beam = tables::beam(root)?;
    for (key, value) in [("a", beam.a), ("rho", beam.rho), ("beta", beam.beta), ("theta_a", beam.theta_a)] {
        if value != 0.0 {
            let allowed = "0, written out: damped modes are exact for a = rho = beta = theta_a = 0 only";
            let section = root.require("beam", "a table with zeta, a = 0 and rho = 0")?.section()?;
            return Err(section.refuse(key, format!("{value:?}"), allowed));
        }
    }
    Ok(beam)
}

/// The tip is kept at every step, and the modes of a mesh are found by a dense method.
fn bounded(root: &Section<'_>, refine: &Refine) -> Result<(), InputError> {
    let section = root.require("refine", "a table")?.section()?;
    let (steps, elements) = (section.require("steps", "a number")?, section.require("elements", "a number")?);
    for &level in &refine.steps {
        limits::steps_until(&steps, refine.t_end, refine.dt(level), limits::RECORDED_STEPS)?;
    }
    let of_mesh = refine.isolate && refine.axis == Axis::Time;
    if of_mesh { limits::dense(&elements, refine.elements[0]) } else { Ok(()) }
}

/// The most modes that may be asked for: a study that starts from the modes of its mesh has `of_mesh` of them.
fn most(refine: &Refine, of_mesh: usize) -> usize {
    if refine.isolate && refine.axis == Axis::Time { of_mesh } else { usize::MAX }
}

fn modes(root: &Section<'_>, refine: &Refine) -> Result<Vec<Vibrating>, InputError> {
    let allowed = "at least one table [[mode]] with index and amplitude or velocity";
    let most = most(refine, 2 * refine.elements[0]).min(limits::MODES);
    let read = |item: &Field<'_>| {
        let section = item.section()?;
        section.allow(&["index", "amplitude", "velocity"])?;
        let index = section.require("index", "a whole number >= 1")?.count(1..=most)? - 1;
        let amplitude = section.get("amplitude").map_or(Ok(0.0), |field| field.number())?;
        let velocity = section.get("velocity").map_or(Ok(0.0), |field| field.number())?;
        if amplitude == 0.0 && velocity == 0.0 {
            return Err(section.refuse(
                "amplitude",
                "a mode that does not move",
                "an amplitude or a velocity other than 0",
            ));
        }
        Ok(Vibrating { index, start: [amplitude, velocity] })
    };
    let field = root.require("mode", allowed)?;
    let modes = field.items(allowed)?.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    if modes.is_empty() { Err(field.refuse_as_written(allowed)) } else { Ok(modes) }
}

fn heat(root: &Section<'_>, refine: &Refine) -> Result<Vec<Cooling>, InputError> {
    let Some(field) = root.get("heat") else { return Ok(vec![]) };
    let most = most(refine, refine.elements[0].saturating_sub(1).max(1)).min(limits::MODES);
    let read = |item: &Field<'_>| {
        let section = item.section()?;
        section.allow(&["index", "amplitude"])?;
        let allowed = "a finite number other than 0";
        Ok(Cooling {
            k: section.require("index", "a whole number >= 1")?.count(1..=most)?,
            amplitude: section.require("amplitude", allowed)?.number_where(allowed, |value| value != 0.0)?,
        })
    };
    field.items("tables [[heat]] with index and amplitude")?.iter().map(read).collect()
}
