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
use convergence_study::study::{FromFile, Header};

use super::ExactExperiments;
use super::cases::TIP_TIMES;
use crate::kinds::tables::discretisations;
use crate::scene::Scene;

impl FromFile for ExactExperiments {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "experiments", "discretisations"])?;
        let section = root.require("experiments", "a table with scenes, times and agreement")?.section()?;
        section.allow(&["scenes", "times", "agreement", "compare"])?;
        let scenes = scenes(&section, folder)?;
        let times = times(&section, &scenes)?;
        let agreement = section.positive("agreement")?;
        let compare = section.get("compare").map_or(Ok(false), |field| field.boolean())?;
        if compare {
            comparable(&section, &scenes, &times)?;
        }
        let discretisations =
            discretisations(root, "discretisations", None, times.last().copied().unwrap_or_default())?;
        Ok(Self { header, scenes, times, discretisations, agreement, compare })
    }
}

fn scenes(section: &Section<'_>, folder: &Path) -> Result<Vec<Scene>, InputError> {
    let allowed = "a list of at least one scene file";
    let field = section.require("scenes", allowed)?;
    let items = field.items(allowed)?;
    if items.is_empty() {
        return Err(field.refuse_as_written(allowed));
    }
    items.iter().map(|item| Scene::read_one_step(item, folder)).collect()
}

/// Refuses scenes of which the times of comparison are no time levels: a difference in time would pass for an error.
fn comparable(section: &Section<'_>, scenes: &[Scene], times: &[f64]) -> Result<(), InputError> {
    let level = |scene: &Scene, t: f64| {
        let steps = t / scene.dt();
        ((steps - steps.round()).abs() <= 1e-9 * steps).then_some(steps.round() as usize)
    };
    for scene in scenes {
        let levels: Option<Vec<usize>> = times.iter().map(|&t| level(scene, t)).collect();
        if !levels.is_some_and(|levels| levels.last().is_some_and(|last| last.is_multiple_of(TIP_TIMES))) {
            let found = format!("{}, whose dt is {:?}", scene.name, scene.dt());
            let expected = format!(
                "scenes whose time levels include all `times`, the last after a multiple of {TIP_TIMES} steps, where compare = true"
            );
            return Err(section.refuse("scenes", found, expected));
        }
    }
    Ok(())
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
