//! The file of a study without exact solution: a scene, what is refined, what is claimed.

use std::path::Path;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::study::levels::Claim;
use convergence_study::study::{Axis, Header};
use thermobeam::scheme::{SCHEMES, Scheme};

use super::{Observable, Resolution, SelfConvergence};
use crate::scene::{Scene, tables};

pub(super) fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<SelfConvergence, InputError> {
    root.allow(&["study", "scene", "refine", "expect"])?;
    let named = root.require("scene", "a table with the scene's file")?.section()?;
    named.allow(&["file"])?;
    let scene = Scene::read(named.require("file", "the path of a scene, from this file's folder")?.file(folder)?)?;
    let section = root.require("refine", "a table with axis, elements, steps and reference")?.section()?;
    section.allow(&KEYS)?;
    let axis =
        section.require("axis", "\"space\", \"time\"")?.choice(&[("space", Axis::Space), ("time", Axis::Time)])?;
    let samples = section.require("samples", "a whole number >= 1")?.count(1..=1000)?;
    let (elements, steps) = resolutions(&section, axis, samples)?;
    let positive = "a finite number > 0";
    let t_end = section.get("t_end").map_or(Ok(scene.t_end), |f| f.number_where(positive, |t_end| t_end > 0.0))?;
    let own = scheme(&section, "scheme", scene.scheme)?;
    let of_reference = scheme(&section, "reference_scheme", own)?;
    let last = elements.len() - 1;
    let run = |(k, (elements, steps)): (usize, (usize, usize))| {
        let scheme = if k == last { of_reference } else { own };
        Resolution { elements, steps, scheme }
    };
    Ok(SelfConvergence {
        header,
        axis,
        runs: elements.into_iter().zip(steps).enumerate().map(run).collect(),
        t_end,
        samples,
        contact: contact(&section, &scene)?,
        claims: claims(root, axis)?,
        scene,
    })
}

fn contact(section: &Section<'_>, scene: &Scene) -> Result<bool, InputError> {
    let Some(field) = section.get("contact") else { return Ok(false) };
    let contact = field.boolean()?;
    if contact && scene.obstacles.is_none() {
        return Err(field.refuse("true, of a scene without obstacles", "false, or a scene with obstacles"));
    }
    Ok(contact)
}

const KEYS: [&str; 9] =
    ["axis", "elements", "steps", "reference", "t_end", "samples", "scheme", "reference_scheme", "contact"];

fn scheme(section: &Section<'_>, key: &str, default: Scheme) -> Result<Scheme, InputError> {
    section.get(key).map_or(Ok(default), |field| field.choice(&SCHEMES.map(|scheme| (scheme.name, scheme))))
}

/// Elements and steps of each run, the reference last.
fn resolutions(section: &Section<'_>, axis: Axis, samples: usize) -> Result<(Vec<usize>, Vec<usize>), InputError> {
    let (refined, fixed) = if axis == Axis::Space { ("elements", "steps") } else { ("steps", "elements") };
    let allowed = "a list of at least two whole numbers, each a multiple of the one before";
    let list = section.require(refined, allowed)?;
    let mut levels = vec![];
    for item in list.items(allowed)? {
        nested(&item, &mut levels)?;
    }
    if levels.len() < 2 {
        return Err(list.refuse_as_written(allowed));
    }
    nested(&section.require("reference", "a multiple of the finest level")?, &mut levels)?;
    let other = tables::elements(&section.require(fixed, "a single whole number >= 1")?)?;
    let all_others = vec![other; levels.len()];
    let (elements, steps) = if axis == Axis::Space { (levels, all_others) } else { (all_others, levels) };
    if !steps[0].is_multiple_of(samples) {
        return Err(section.refuse(
            "steps",
            format!("{} steps", steps[0]),
            format!("a multiple of samples = {samples}"),
        ));
    }
    Ok((elements, steps))
}

/// A level that the one before divides.
fn nested(field: &Field<'_>, levels: &mut Vec<usize>) -> Result<(), InputError> {
    let level = tables::elements(field)?;
    match levels.last() {
        Some(&before) if level <= before || level % before != 0 => {
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
        let positive = "a finite number > 0";
        let number = |key: &str| section.require(key, positive)?.number_where(positive, |value| value > 0.0);
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
