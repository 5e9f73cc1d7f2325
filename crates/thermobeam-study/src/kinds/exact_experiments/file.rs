//! The study file.
//!
//! ```toml
//! [experiments]
//! scenes = ["scenes/paper-1-beta-0.toml"]   # one-step scenes; their own scheme is what is compared
//! times = [1.0, 10.0]
//! agreement = 1e-10                         # of the two discretisations, in every number
//! compare = true                            # run the scenes' own schemes as well
//!
//! [[discretisations]]                       # two of them
//! elements = 1
//! degree = 20
//! time_degree = 3
//! dt = 0.02
//! restart_dt = 5e-4
//! growth = 1.5
//! ```

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::Header;
use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE, Stepping};

use super::{Discretisation, ExactExperiments};
use crate::scene::{Scene, tables};

const POSITIVE: &str = "a finite number > 0";

pub(super) fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<ExactExperiments, InputError> {
    root.allow(&["study", "experiments", "discretisations"])?;
    let section = root.require("experiments", "a table with scenes, times and agreement")?.section()?;
    section.allow(&["scenes", "times", "agreement", "compare"])?;
    let scenes = scenes(&section, folder)?;
    let times = times(&section, &scenes)?;
    let agreement = section.require("agreement", POSITIVE)?.number_where(POSITIVE, |value| value > 0.0)?;
    let compare = section.get("compare").map_or(Ok(false), |field| field.boolean())?;
    let allowed = "two tables [[discretisations]] that differ in elements, degree, time_degree and dt";
    let field = root.require("discretisations", allowed)?;
    let items = field.items(allowed)?;
    let list = items.iter().map(|item| discretisation(&item.section()?)).collect::<Result<Vec<_>, _>>()?;
    let [one, other]: [Discretisation; 2] = list.try_into().map_err(|_| field.refuse_as_written(allowed))?;
    let differ = one.elements != other.elements
        && one.degree != other.degree
        && one.stepping.degree != other.stepping.degree
        && one.stepping.dt != other.stepping.dt;
    if !differ {
        return Err(field.refuse("two that share one of these", allowed));
    }
    Ok(ExactExperiments { header, scenes, times, discretisations: [one, other], agreement, compare })
}

fn scenes(section: &Section<'_>, folder: &Path) -> Result<Vec<Scene>, InputError> {
    let allowed = "a list of at least one scene file";
    let field = section.require("scenes", allowed)?;
    let items = field.items(allowed)?;
    if items.is_empty() {
        return Err(field.refuse_as_written(allowed));
    }
    items.iter().map(|item| Scene::read(item.file(folder)?)).collect()
}

fn times(section: &Section<'_>, scenes: &[Scene]) -> Result<Vec<f64>, InputError> {
    let end = scenes.iter().map(|scene| scene.t_end).fold(f64::INFINITY, f64::min);
    let allowed = format!("a list of increasing times > 0, the last at most {end:?}, where the first scene ends");
    let field = section.require("times", &allowed)?;
    let times = field.items(&allowed)?.iter().map(|item| item.number()).collect::<Result<Vec<f64>, _>>()?;
    let increasing = times.windows(2).all(|pair| pair[0] < pair[1]);
    let fits = increasing && times.first().is_some_and(|t| *t > 0.0) && times.last().is_some_and(|t| *t <= end);
    if fits { Ok(times) } else { Err(field.refuse_as_written(allowed)) }
}

fn discretisation(section: &Section<'_>) -> Result<Discretisation, InputError> {
    section.allow(&["elements", "degree", "time_degree", "dt", "restart_dt", "growth"])?;
    let positive = |key: &str| section.require(key, POSITIVE)?.number_where(POSITIVE, |value| value > 0.0);
    let dt = positive("dt")?;
    let restart = format!("a number > 0 and at most dt = {dt:?}");
    let growth = "a finite number >= 1";
    Ok(Discretisation {
        elements: tables::elements(&section.require("elements", "a whole number >= 1")?)?,
        degree: section.require("degree", "a whole number >= 1")?.count(1..=MAX_DEGREE)?,
        stepping: Stepping {
            degree: section.require("time_degree", "a whole number >= 0")?.count(0..=MAX_TIME_DEGREE)?,
            dt,
            restart_dt: section.require("restart_dt", &restart)?.number_where(&restart, |h| h > 0.0 && h <= dt)?,
            growth: section.require("growth", growth)?.number_where(growth, |value| value >= 1.0)?,
            ..Stepping::default()
        },
    })
}
