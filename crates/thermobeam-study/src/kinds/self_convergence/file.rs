//! The file of a study without exact solution: a scene, what is refined, what it is compared with, what is claimed.
//!
//! ```toml
//! [scene]
//! file = "scenes/paper-1-beta-0.toml"
//!
//! [refine]
//! axis = "both"                      # dt = c h, or dt = c h^2; or "time", on one mesh
//! elements = [10, 20, 40]
//! steps = [200, 800, 3200]
//! samples = 10                       # times of comparison
//!
//! [[reference]]                      # two of them, that share nothing; with axis = "time" elements of degree 1 on the mesh
//! elements = 1
//! degree = 28
//! time_degree = 4
//! dt = 0.003
//! restart_dt = 1e-4
//! growth = 1.3
//!
//! [[expect]]
//! quantity = "tip"
//! order = 2.0
//! tolerance = 0.1
//! ```

use std::path::Path;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::study::levels::Claim;
use convergence_study::study::{Axis, FromFile, Header};
use thermobeam::scheme::SCHEMES;

use super::{Observable, Resolution, SelfConvergence};
use crate::kinds::tables::discretisations;
use crate::scene::{Scene, limits, tables};

impl FromFile for SelfConvergence {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "scene", "refine", "reference", "expect"])?;
        let named = root.require("scene", "a table with the scene's file")?.section()?;
        named.allow(&["file"])?;
        let file = named.require("file", "the path of a scene, from this file's folder")?;
        let scene = Scene::read(file.file(folder)?)?;
        let own = scene.one_step().map_err(|error| file.refuse(error.to_string(), "a scene by a one-step scheme"))?;
        let section = root.require("refine", "a table with axis, elements and steps")?.section()?;
        section.allow(&["axis", "elements", "steps", "t_end", "samples", "scheme", "contact"])?;
        let axis =
            section.require("axis", "\"time\", \"both\"")?.choice(&[("time", Axis::Time), ("both", Axis::Both)])?;
        let samples = section.require("samples", "a whole number >= 1")?.count(1..=1000)?;
        let (levels, power) = levels(&section, axis, samples)?;
        let t_end = section.get("t_end").map_or(Ok(scene.t_end), |field| field.positive())?;
        let scheme = section
            .get("scheme")
            .map_or(Ok(own.scheme), |field| field.choice(&SCHEMES.map(|scheme| (scheme.name, scheme))))?;
        let of_mesh = (axis == Axis::Time).then_some(levels[0].elements);
        Ok(Self {
            header,
            axis,
            scheme,
            levels,
            power,
            references: discretisations(root, "reference", of_mesh, t_end)?,
            t_end,
            samples,
            contact: contact(&section, &scene)?,
            claims: claims(root, axis)?,
            scene,
        })
    }
}

fn contact(section: &Section<'_>, scene: &Scene) -> Result<bool, InputError> {
    let Some(field) = section.get("contact") else { return Ok(false) };
    let contact = field.boolean()?;
    if contact && scene.obstacles.is_none() {
        return Err(field.refuse("true, of a scene without obstacles", "false, or a scene with obstacles"));
    }
    Ok(contact)
}

/// The levels, coarse to fine, and the power of h that dt is proportional to where both are refined.
fn levels(section: &Section<'_>, axis: Axis, samples: usize) -> Result<(Vec<Resolution>, f64), InputError> {
    let steps = nested_list(section, "steps")?;
    let (elements, power) = if axis == Axis::Time {
        let one = tables::elements(&section.require("elements", "a single whole number >= 1")?)?;
        (vec![one; steps.len()], 1.0)
    } else {
        let elements = nested_list(section, "elements")?;
        (elements.clone(), power(section, &elements, &steps)?)
    };
    if !steps[0].is_multiple_of(samples) {
        let found = format!("{} steps", steps[0]);
        return Err(section.refuse("steps", found, format!("a multiple of samples = {samples}")));
    }
    let level = |(elements, steps)| Resolution { elements, steps };
    Ok((elements.into_iter().zip(steps).map(level).collect(), power))
}

fn nested_list(section: &Section<'_>, key: &str) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of at least two whole numbers, each a multiple of the one before";
    let list = section.require(key, allowed)?;
    let mut levels = vec![];
    for item in list.items(allowed)? {
        let level = if key == "elements" { tables::elements(&item)? } else { item.count(1..=limits::STEPS)? };
        nested(&item, level, &mut levels)?;
    }
    if levels.len() < 2 { Err(list.refuse_as_written(allowed)) } else { Ok(levels) }
}

/// 1 for dt = c h from level to level, 2 for dt = c h².
fn power(section: &Section<'_>, elements: &[usize], steps: &[usize]) -> Result<f64, InputError> {
    let ratios = |list: &[usize]| list.windows(2).map(|pair| pair[1] / pair[0]).collect::<Vec<usize>>();
    let (finer, shorter) = (ratios(elements), ratios(steps));
    let of = |power: u32| finer.iter().map(|ratio| ratio.pow(power)).eq(shorter.iter().copied());
    match (of(1), of(2)) {
        (true, _) => Ok(1.0),
        (_, true) => Ok(2.0),
        _ => {
            let allowed =
                "as many as elements, multiplied from level to level by the factor of the elements, or by its square";
            Err(section.require("steps", allowed)?.refuse_as_written(allowed))
        }
    }
}

/// A level that the one before divides.
fn nested(field: &Field<'_>, level: usize, levels: &mut Vec<usize>) -> Result<(), InputError> {
    match levels.last() {
        Some(&before) if level <= before || !level.is_multiple_of(before) => {
            Err(field.refuse_as_written(format!("a multiple of {before}, the level before")))
        }
        _ => {
            levels.push(level);
            Ok(())
        }
    }
}

fn claims(root: &Section<'_>, axis: Axis) -> Result<Vec<(Observable, Claim)>, InputError> {
    let allowed = "at least one table [[expect]] with quantity, order and tolerance";
    let field = root.require("expect", allowed)?;
    let observables: Vec<_> = Observable::of(axis).map(|observable| (observable.name(), observable)).collect();
    let names = observables.iter().map(|(name, _)| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let read = |item: &Field<'_>| {
        let section = item.section()?;
        section.allow(&["quantity", "order", "tolerance"])?;
        let number = |key: &str| section.positive(key);
        let observable = section.require("quantity", &names)?.choice(&observables)?;
        Ok((observable, Claim { order: number("order")?, tolerance: number("tolerance")? }))
    };
    let mut claims: Vec<(Observable, Claim)> = vec![];
    for item in field.items(allowed)? {
        let claim = read(&item)?;
        if claims.iter().any(|(earlier, _)| *earlier == claim.0) {
            let found = format!("\"{}\" a second time", claim.0.name());
            return Err(item.section()?.refuse("quantity", found, "each quantity once"));
        }
        claims.push(claim);
    }
    if claims.is_empty() { Err(field.refuse_as_written(allowed)) } else { Ok(claims) }
}
