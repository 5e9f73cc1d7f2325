//! The study file: the problem, the runs, and the claimed ratios.

use std::sync::OnceLock;

use convergence_study::Tier;

use super::{
    ROW, Target, WorkPrecision,
    method::{Degrees, METHODS, NamedMethod, Resolution, Trial, UniformGrid},
};
use crate::kinds::prelude::*;
use crate::{
    error::{ErrorMeasure, free_vibration},
    kinds::orders::{Orders, manufactured::Convergence},
    run::family::Family,
    scene::Scene,
};
use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE};

/// The keys of the problem, which is a solution, a scene or a vibration.
const PROBLEM: &[Keys] = &[
    &[&[OBSERVATIONS, SOLUTION]],
    &[&[OBSERVATIONS, SCENE, T_END]],
    &[&[OBSERVATIONS, T_END], &FREE],
];
const OBSERVATIONS: Key = Key::new(
    "observations",
    Form::Count(1),
    "times at which errors are measured",
);
const SOLUTION: Key = Key::new(
    "solution",
    Form::Text,
    "a study file of kind orders/manufactured: its exact solution",
);
const SCENE: Key = Key::new(
    "scene",
    Form::Text,
    "a scene file; errors are distances to the reference",
);
const T_END: Key = Key::new("t_end", Form::Positive, "final time");
const FREE: [Key; 2] = [
    Key::new(
        "vibration",
        Form::List(&Form::Count(0)),
        "modes from 0, each released from a tip displacement of 0.1",
    ),
    Key::new("zeta", Form::Positive, "the viscosity ζ"),
];
const KEYS: [Key; 4] = [
    Key::new("work-precision", Form::Table(PROBLEM), "the problem"),
    Key::new(
        "reference",
        Form::List(&Form::Table(&[&[&REFERENCE]])),
        "two different runs by dG, for a scene",
    )
    .or("none"),
    Key::new(
        "runs",
        Form::List(&Form::Table(&[&[&BY_DG], &[&ONE_STEP]])),
        "the runs of each method",
    ),
    Key::new(
        "target",
        Form::List(&Form::Table(&[&[&TARGET]])),
        "an error, and the ratios of work claimed there",
    ),
];
const NODES: Key = Key::new(
    "nodes",
    Form::List(&Form::Number),
    "the nodes, increasing from 0 to 1",
);
const REFERENCE: [Key; 2] = [NODES, Key::new("runs", Form::List(&Form::Number), DEGREES)];
const PAIRS: Form = Form::List(&Form::List(&Form::Number));
const BY_DG: [Key; 3] = [
    Key::new("method", Form::Choice(|| named(false)), "dG"),
    NODES,
    Key::new(
        "runs",
        PAIRS,
        "a list of [degree p, degree q, largest step]",
    ),
];
const ONE_STEP: [Key; 3] = [
    Key::new("method", Form::Choice(|| named(true)), "a one-step method"),
    Key::new("grading", Form::Positive, "the nodes are s^grading").or("1"),
    Key::new(
        "runs",
        PAIRS,
        "a list of [elements, steps], steps multiples of observations",
    ),
];
const TARGET: [Key; 4] = [
    Key::new(
        "norm",
        Form::Choice(|| ErrorMeasure::ALL.map(ErrorMeasure::name).to_vec()),
        "how the error is measured",
    ),
    Key::new("error", Form::Positive, "the error"),
    Key::new(
        "methods",
        Form::List(&Form::Choice(|| METHODS.map(|method| method.name).to_vec())),
        "at least two, the dearest first",
    ),
    Key::new(
        "times",
        Form::List(&Form::Positive),
        "how many times dearer each is than the next",
    ),
];

/// The names of the one-step methods, or of the others.
fn named(one_step: bool) -> Vec<&'static str> {
    let methods = METHODS
        .iter()
        .filter(|method| method.one_step.is_some() == one_step);
    methods.map(|method| method.name).collect()
}

const DEGREES: &str = "[degree p, degree q, largest step]";
/// Element-steps of a run in the quick tier, and in the full one.
const QUICK: usize = 1_000_000;
const FULL: usize = 10_000_000;

impl FromFile for WorkPrecision {
    const KEYS: &'static [Keys] = &[&[&KEYS]];

    fn from_document(
        header: &Header,
        root: &Section<'_>,
        folder: &Path,
    ) -> Result<Self, InputError> {
        let section = root
            .require(ROW.name, "a table with observations and the problem")?
            .section()?;
        let observations = section
            .require("observations", "a number of times")?
            .count(1..=10_000)?;
        let family = problem(&section, folder)?;
        let most = if header.tier == Tier::Quick {
            QUICK
        } else {
            FULL
        };
        let trials = root.list(
            "runs",
            "at least one table [[runs]]",
            |item| trials(&item.section()?, observations, most),
            |list| !list.is_empty(),
        )?;
        Ok(Self {
            reference: reference(root, family.exact().is_none())?,
            family,
            observations,
            computed: OnceLock::new(),
            trials: trials.concat(),
            targets: root.list(
                "target",
                "at least one table [[target]]",
                |item| target(&item.section()?),
                |list| !list.is_empty(),
            )?,
        })
    }
}

/// The runs of one table.
fn trials(
    section: &Section<'_>,
    observations: usize,
    most: usize,
) -> Result<Vec<Trial>, InputError> {
    let methods = METHODS.map(|method| (method.name, method));
    let method = section
        .require("method", "the name of a method")?
        .choice(&methods)?;
    let resolutions = if method.one_step.is_some() {
        grids(section, observations, most)?
    } else {
        let nodes = nodes(section)?;
        let run = |item: &Field<'_>| dg(item, &nodes);
        let allowed = format!("a list of {DEGREES}");
        section.list("runs", &allowed, run, |list| !list.is_empty())?
    };
    let trial = |resolution| Trial { method, resolution };
    Ok(resolutions.into_iter().map(trial).collect())
}

fn grids(
    section: &Section<'_>,
    observations: usize,
    most: usize,
) -> Result<Vec<Resolution>, InputError> {
    let grading = section
        .get("grading")
        .map_or(Ok(1.0), |field| field.positive())?;
    let allowed = format!("a list of [elements, steps], steps multiples of {observations}");
    let run = |item: &Field<'_>| {
        let [elements, steps] = item
            .items(&allowed)?
            .try_into()
            .map_err(|_| item.refuse_as_written(&allowed))?;
        let elements = elements.count(1..=most)?;
        let steps = steps.count(1..=most)?;
        if !steps.is_multiple_of(observations) {
            return Err(item.refuse_as_written(&allowed));
        }
        if elements * steps > most {
            let limit = format!("at most {most} element-steps in this tier");
            return Err(item.refuse(format!("{} element-steps", elements * steps), limit));
        }
        Ok(Resolution::OneStep(UniformGrid {
            grading,
            elements,
            steps,
        }))
    };
    section.list("runs", &allowed, run, |list| !list.is_empty())
}

fn nodes(section: &Section<'_>) -> Result<Vec<f64>, InputError> {
    let allowed = "an increasing list of numbers from 0 to 1";
    section.list(
        "nodes",
        allowed,
        |item| item.number(),
        |list: &[f64]| increases(list) && list.first() == Some(&0.0) && list.last() == Some(&1.0),
    )
}

/// A run by dG.
fn dg(item: &Field<'_>, nodes: &[f64]) -> Result<Resolution, InputError> {
    let [p, q, dt] = item
        .items(DEGREES)?
        .try_into()
        .map_err(|_| item.refuse_as_written(DEGREES))?;
    let degrees = Degrees {
        p: p.count(1..=MAX_DEGREE)?,
        q: q.count(0..=MAX_TIME_DEGREE)?,
        dt: dt.positive()?,
    };
    Ok(Resolution::Dg {
        nodes: nodes.to_vec(),
        degrees,
    })
}

/// Two runs by dG for a scene; none where there is an exact solution.
fn reference(root: &Section<'_>, is_needed: bool) -> Result<Option<[Trial; 2]>, InputError> {
    if !is_needed {
        return match root.get("reference") {
            Some(field) => Err(field.refuse("reference without scene", "reference beside scene")),
            None => Ok(None),
        };
    }
    let dg_row = METHODS[METHODS.len() - 1];
    let run = |item: &Field<'_>| {
        let section = item.section()?;
        let resolution = dg(&section.require("runs", DEGREES)?, &nodes(&section)?)?;
        Ok(Trial {
            method: dg_row,
            resolution,
        })
    };
    let allowed = "two different tables [[reference]]";
    let differ = |list: &[Trial]| list.len() == 2 && list[0] != list[1];
    let two = root.list("reference", allowed, run, differ)?;
    Ok(two.try_into().ok())
}

/// The problem.
fn problem(section: &Section<'_>, folder: &Path) -> Result<Family, InputError> {
    if let (Some(field), None) = (section.get("zeta"), section.get("vibration")) {
        return Err(field.refuse("zeta without vibration", "zeta beside vibration"));
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
            let Orders(Convergence {
                exact,
                theory,
                refine,
                ..
            }) = Orders::read(file.file(folder)?)?;
            Ok(Family::of_solution(
                exact,
                theory.beam,
                theory.obstacles,
                refine.t_end,
            ))
        }
        (None, Some(file), None) => Ok(Family::of_scene(&Scene {
            t_end: section.positive("t_end")?,
            ..Scene::read(file.file(folder)?)?
        })),
        (None, None, Some(_)) => vibration(section),
        _ => Err(section.missing("solution", "exactly one of solution, scene and vibration")),
    }
}

/// The lowest modes, each released from a tip displacement of 0.1.
fn vibration(section: &Section<'_>) -> Result<Family, InputError> {
    const AMPLITUDE: f64 = 0.1;
    let allowed = "a list of at least one mode, numbered from 0";
    let mode = |item: &Field<'_>| Ok((item.count(0..=1000)?, AMPLITUDE));
    let modes = section.list("vibration", allowed, mode, |modes| !modes.is_empty())?;
    let zeta = section.positive("zeta")?;
    let t_end = section.positive("t_end")?;
    let exact = free_vibration::vibration(&modes, zeta);
    let exact = exact.map_err(|error| section.refuse("zeta", error.to_string(), "a viscosity"))?;
    Ok(Family::of_free_solution(
        exact,
        free_vibration::beam(zeta),
        t_end,
    ))
}

fn target(section: &Section<'_>) -> Result<Target, InputError> {
    let measures = ErrorMeasure::ALL.map(|measure| (measure.name(), measure));
    let methods = METHODS.map(|method| (method.name, method));
    let once = |list: &[NamedMethod]| {
        list.len() > 1 && (1..list.len()).all(|k| !list[..k].contains(&list[k]))
    };
    let methods = section.list(
        "methods",
        "at least two different methods, the dearest first",
        |item| item.choice(&methods),
        once,
    )?;
    let fits = |list: &[f64]| list.len() + 1 == methods.len();
    let allowed =
        "a number for each method but the last: how many times dearer it is than the next";
    Ok(Target {
        measure: section
            .require("norm", "the name of a norm")?
            .choice(&measures)?,
        error: section.positive("error")?,
        times: section.list("times", allowed, |item| item.positive(), fits)?,
        methods,
    })
}
