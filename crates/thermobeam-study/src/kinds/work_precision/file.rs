//! The study file: the problem, the grid of runs, and the claimed advantages.

use std::sync::OnceLock;

use super::method::{Degrees, METHODS, NamedMethod};
use super::{Advantage, OBSERVED, ROW, WorkPrecision, Yardstick};
use crate::kinds::convergence::Convergence;
use crate::kinds::prelude::*;
use crate::kinds::tables::discretisations;

/// A tolerance of the solver that does not affect the measured errors.
const TOLERANCE: f64 = 1e-11;
/// Default for the largest misfit of the law.
const MISFIT: f64 = 0.15;
/// The keys of the problem, which is a solution, a scene or a vibration, and those of the runs.
const PROBLEM: [&str; 6] = [
    "solution",
    "scene",
    "vibration",
    "zeta",
    "t_end",
    "agreement",
];
const RUNS: [&str; 6] = ["elements", "steps", "dg", "diagonal", "tolerance", "misfit"];

impl FromFile for WorkPrecision {
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", ROW.name, "reference", "advantage"])?;
        let section = root.table(ROW.name, &[RUNS, PROBLEM].concat())?;
        let steps = levels(&section, "steps", limits::STEPS)?;
        if let Some(odd) = steps.iter().find(|number| !number.is_multiple_of(steps[0])) {
            return Err(section.refuse("steps", odd.to_string(), "multiples of the first number"));
        }
        let elements = levels(&section, "elements", 1 << 20)?;
        let number = |key: &str, default: f64| {
            section
                .get(key)
                .map_or(Ok(default), |field| field.positive())
        };
        let diagonal = diagonal(&section, &elements, &steps)?;
        let (family, answer) = problem(root, &section, folder, diagonal.is_some())?;
        Ok(Self {
            family,
            answer,
            dg: dg(&section)?,
            diagonal,
            tolerance: number("tolerance", TOLERANCE)?,
            misfit: number("misfit", MISFIT)?,
            advantages: advantages(root)?,
            elements,
            steps,
        })
    }
}

/// An increasing list of at least two whole numbers.
fn levels(section: &Section<'_>, key: &str, most: usize) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of at least two increasing whole numbers >= 1";
    section.list(
        key,
        allowed,
        |item| item.count(1..=most),
        |list: &[usize]| list.len() > 1 && increases(list),
    )
}

/// The runs of dG.
fn dg(section: &Section<'_>) -> Result<Vec<Degrees>, InputError> {
    let allowed = "a list of [degree p, degree q, largest step]";
    let row = |item: &Field<'_>| {
        let [p, q, dt] = item
            .items(allowed)?
            .try_into()
            .map_err(|_| item.refuse_as_written(allowed))?;
        Ok(Degrees {
            p: p.count(1..=MAX_DEGREE)?,
            q: q.count(0..=MAX_TIME_DEGREE)?,
            dt: dt.positive()?,
        })
    };
    section
        .get("dg")
        .map_or(Ok(vec![]), |_| section.list("dg", allowed, row, |_| true))
}

/// The one-step method that is run with a single number of steps on each mesh.
fn diagonal(
    section: &Section<'_>,
    elements: &[usize],
    steps: &[usize],
) -> Result<Option<NamedMethod>, InputError> {
    let Some(field) = section.get("diagonal") else {
        return Ok(None);
    };
    let one_step: Vec<_> = METHODS
        .iter()
        .filter(|method| method.one_step.is_some())
        .map(|&m| (m.name, m))
        .collect();
    let doubled = |list: &[usize]| list.windows(2).all(|two| two[1] == 2 * two[0]);
    if elements.len() != steps.len()
        || !doubled(elements)
        || !doubled(steps)
        || !steps[0].is_multiple_of(OBSERVED)
    {
        let allowed = format!(
            "as many elements as steps, each twice the one before, steps multiples of {OBSERVED}"
        );
        return Err(section.refuse(
            "steps",
            format!("{steps:?} with {elements:?} elements"),
            allowed,
        ));
    }
    field.choice(&one_step).map(Some)
}

/// The problem, and the reference for its errors.
fn problem(
    root: &Section<'_>,
    section: &Section<'_>,
    folder: &Path,
    tip_alone: bool,
) -> Result<(Family, Yardstick), InputError> {
    for (table, key, owner) in [
        (section, "zeta", "vibration"),
        (section, "agreement", "scene"),
        (section, "diagonal", "scene"),
        (root, "reference", "scene"),
    ] {
        if let (Some(field), None) = (table.get(key), section.get(owner)) {
            return Err(field.refuse(
                format!("{key} without {owner}"),
                format!("{key} beside {owner}"),
            ));
        }
    }
    match (
        section.get("solution"),
        section.get("scene"),
        section.get("vibration"),
    ) {
        (Some(file), None, None) => {
            if let Some(field) = section.get("t_end") {
                return Err(field.refuse(
                    "t_end beside solution",
                    "no t_end: it is that of the solution",
                ));
            }
            let Convergence {
                exact,
                theory,
                refine,
                ..
            } = Convergence::read(file.file(folder)?)?;
            Ok((
                Family::of_solution(exact, theory.beam, theory.obstacles, refine.t_end),
                Yardstick::Exact,
            ))
        }
        (None, Some(file), None) => {
            let scene = Scene {
                t_end: section.positive("t_end")?,
                ..Scene::read(file.file(folder)?)?
            };
            let family = Family::of_scene(&scene);
            if tip_alone {
                return match root.get("reference").or_else(|| section.get("agreement")) {
                    Some(field) => {
                        Err(field
                            .refuse("beside diagonal", "no reference: a finer run of dG is one"))
                    }
                    None => Ok((family, Yardstick::Tip(OnceLock::new()))),
                };
            }
            let by = discretisations(root, "reference", None, scene.t_end)?;
            let agreement = section.positive("agreement")?;
            Ok((
                family,
                Yardstick::Agreed {
                    scene: Box::new(scene),
                    by: Box::new(by),
                    agreement,
                    computed: OnceLock::new(),
                },
            ))
        }
        (None, None, Some(_)) => Ok((vibration(section)?, Yardstick::Exact)),
        _ => Err(section.missing("solution", "exactly one of solution, scene and vibration")),
    }
}

/// The lowest modes, each released from a tip displacement of 0.1.
fn vibration(section: &Section<'_>) -> Result<Family, InputError> {
    const AMPLITUDE: f64 = 0.1;
    let allowed = "a list of at least one mode, numbered from 0";
    let mode = |item: &Field<'_>| Ok((item.count(0..=1000)?, AMPLITUDE));
    let modes = section.list("vibration", allowed, mode, |modes| !modes.is_empty())?;
    let (zeta, t_end) = (section.positive("zeta")?, section.positive("t_end")?);
    let exact = free_vibration::vibration(&modes, zeta);
    let exact = exact.map_err(|error| section.refuse("zeta", error.to_string(), "a viscosity"))?;
    Ok(Family::of_free_solution(
        exact,
        free_vibration::beam(zeta),
        t_end,
    ))
}

/// The claims: at least one advantage.
fn advantages(root: &Section<'_>) -> Result<Vec<Advantage>, InputError> {
    let methods = METHODS.map(|method| (method.name, method));
    let quantities = ErrorMeasure::ALL.map(|quantity| (quantity.name(), quantity));
    let advantage = |item: &Field<'_>| {
        let section = item.section()?;
        section.allow(&["norm", "error", "of", "over", "times"])?;
        let method = |key: &str| {
            section
                .require(key, "the name of a method")?
                .choice(&methods)
        };
        Ok(Advantage {
            quantity: section
                .require("norm", "the name of a norm")?
                .choice(&quantities)?,
            error: section.positive("error")?,
            of: method("of")?,
            over: method("over")?,
            times: section.positive("times")?,
        })
    };
    root.list(
        "advantage",
        "at least one table [[advantage]]",
        advantage,
        |list| !list.is_empty(),
    )
}
