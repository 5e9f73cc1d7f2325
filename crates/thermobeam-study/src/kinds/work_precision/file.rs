//! The study file: the problem, the grid of runs, the advantages claimed.

use std::path::Path;
use std::sync::OnceLock;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{FromFile, Header};

use super::method::{METHODS, Method};
use super::{Advantage, AnyOrder, ROW, WorkPrecision};
use crate::error::evaluator::ErrorMeasure;
use crate::error::free_vibration;
use crate::kinds::convergence::Convergence;
use crate::kinds::tables::discretisations;
use crate::run::family::Family;
use crate::scene::{Scene, limits};

/// Tolerance of the solver that leaves no trace in the errors measured.
const TOLERANCE: f64 = 1e-11;
/// Largest misfit of the law, where a file does not say.
const MISFIT: f64 = 0.15;

impl FromFile for WorkPrecision {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", ROW.name, "reference", "advantage"])?;
        let section = root.require(ROW.name, "a table with elements, steps and a problem")?.section()?;
        let keys = ["solution", "scene", "vibration", "zeta", "t_end", "agreement", "elements", "steps"];
        section.allow(&[&keys[..], &["tolerance", "misfit"]].concat())?;
        let steps = levels(&section, "steps")?;
        if let Some(odd) = steps.iter().find(|number| !number.is_multiple_of(steps[0])) {
            return Err(section.refuse("steps", odd.to_string(), "multiples of the first number"));
        }
        let elements = levels(&section, "elements")?;
        let number = |key: &str, default: f64| section.get(key).map_or(Ok(default), |field| field.positive());
        let (family, reference) = problem(root, &section, folder)?;
        Ok(Self {
            header,
            family,
            reference,
            computed: OnceLock::new(),
            tolerance: number("tolerance", TOLERANCE)?,
            misfit: number("misfit", MISFIT)?,
            advantages: advantages(root)?,
            elements,
            steps,
        })
    }
}

/// An increasing list of at least two whole numbers.
fn levels(section: &Section<'_>, key: &str) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of at least two increasing whole numbers >= 1";
    let field = section.require(key, allowed)?;
    let items = field.items(allowed)?;
    let most = if key == "elements" { 1 << 20 } else { limits::STEPS };
    let levels = items.iter().map(|item| item.count(1..=most)).collect::<Result<Vec<_>, _>>()?;
    if levels.len() < 2 || levels.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Err(field.refuse_as_written(allowed));
    }
    Ok(levels)
}

/// The problem, and the reference where it has no exact solution.
fn problem(root: &Section<'_>, section: &Section<'_>, folder: &Path) -> Result<(Family, Option<AnyOrder>), InputError> {
    let only_with = |key: &str, owner: &str| match (section.get(key), section.get(owner)) {
        (Some(field), None) => Err(field.refuse(format!("{key} without {owner}"), format!("{key} beside {owner}"))),
        _ => Ok(()),
    };
    only_with("zeta", "vibration")?;
    only_with("agreement", "scene")?;
    if let (Some(field), None) = (root.get("reference"), section.get("scene")) {
        return Err(field.refuse("reference without scene", "reference beside a scene, which has no exact solution"));
    }
    match (section.get("solution"), section.get("scene"), section.get("vibration")) {
        (Some(file), None, None) => {
            if let Some(field) = section.get("t_end") {
                return Err(field.refuse("t_end beside solution", "no t_end: it is that of the solution"));
            }
            let spec = <Convergence as convergence_study::study::FromFile>::read(file.file(folder)?)?;
            Ok((Family::of_solution(spec.exact, spec.beam, spec.obstacles, spec.refine.t_end), None))
        }
        (None, Some(file), None) => {
            let mut scene = Scene::read(file.file(folder)?)?;
            scene.t_end = t_end(section)?;
            let by = discretisations(root, "reference", None, scene.t_end)?;
            let agreement = section.positive("agreement")?;
            Ok((Family::of_scene(&scene), Some(AnyOrder { scene, by, agreement })))
        }
        (None, None, Some(_)) => Ok((vibration(section)?, None)),
        _ => Err(section.missing("solution", "exactly one of solution, scene and vibration")),
    }
}

fn t_end(section: &Section<'_>) -> Result<f64, InputError> {
    section.positive("t_end")
}

/// The lowest modes, each released from a tip displacement of 0.1.
fn vibration(section: &Section<'_>) -> Result<Family, InputError> {
    const AMPLITUDE: f64 = 0.1;
    let allowed = "a list of at least one mode, numbered from 0";
    let field = section.require("vibration", allowed)?;
    let items = field.items(allowed)?;
    let modes = items.iter().map(|item| Ok((item.count(0..=1000)?, AMPLITUDE))).collect::<Result<Vec<_>, InputError>>();
    let modes = modes?;
    let zeta = section.positive("zeta")?;
    match free_vibration::vibration(&modes, zeta) {
        Ok(exact) if !modes.is_empty() => {
            Ok(Family::of_free_solution(exact, free_vibration::beam(zeta), t_end(section)?))
        }
        _ => Err(field.refuse_as_written(allowed)),
    }
}

fn advantages(root: &Section<'_>) -> Result<Vec<Advantage>, InputError> {
    let Some(field) = root.get("advantage") else { return Ok(vec![]) };
    let methods = METHODS.map(|method| (method.name, method));
    let quantities = ErrorMeasure::ALL.map(|quantity| (quantity.name(), quantity));
    let items = field.items("a list of tables [[advantage]]")?;
    let advantage = |section: Section<'_>| {
        section.allow(&["norm", "error", "of", "over", "times"])?;
        let method = |key: &str| -> Result<Method, InputError> {
            section.require(key, "the name of a method")?.choice(&methods)
        };
        let number = |key: &str| section.positive(key);
        Ok(Advantage {
            quantity: section.require("norm", "the name of a norm")?.choice(&quantities)?,
            error: number("error")?,
            of: method("of")?,
            over: method("over")?,
            times: number("times")?,
        })
    };
    items.iter().map(|item| advantage(item.section()?)).collect()
}
