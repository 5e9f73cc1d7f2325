//! The study file: the scenes of the three groups, when a run ends, and the runs to rest.

use std::path::Path;

use thermobeam::equilibrium::Contact;

use super::{Experiment, Experiments, Group, ToRest, Until};
use crate::kinds::steady::{at_resolution, listed_scene, listed_scenes};
use crate::scene::Scene;
use crate::scene::limits;
use crate::scene::tables;
use convergence_study::input::{Field, InputError, POSITIVE, Section};
use convergence_study::study::{FromFile, Header};

impl FromFile for Experiments {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "experiments", "run", "steady"])?;
        let run = root.require("run", "a table with t_max, window and rate")?.section()?;
        run.allow(&["elements", "dt", "t_max", "window", "rate"])?;
        let until =
            Until { t_max: run.positive("t_max")?, window: run.positive("window")?, rate: run.positive("rate")? };
        let mut experiments = experiments(root, folder)?;
        let t_max = run.require("t_max", POSITIVE)?;
        for experiment in &mut experiments {
            refine(&run, &mut experiment.scene)?;
            limits::steps_until(&t_max, until.t_max, experiment.scene.dt(), limits::STEPS)?;
        }
        let (betas, rest) = steady(root)?;
        Ok(Self { header, experiments, until, betas, rest })
    }
}

/// The table `[experiments]`: the scenes of the three groups.
fn experiments(root: &Section<'_>, folder: &Path) -> Result<Vec<Experiment>, InputError> {
    let section = root.require("experiments", "a table with first, second, rests and third")?.section()?;
    section.allow(&["first", "second", "rests", "third"])?;
    let first = ascending(&section, "first", folder)?;
    let second = ascending(&section, "second", folder)?;
    let rests = rests(&section, second.len())?;
    let third = listed_scene(&section.require("third", "a scene file")?, folder)?;
    let group = |group: Group, scene: Scene| Experiment { group, scene };
    let mut experiments: Vec<Experiment> = first.into_iter().map(|scene| group(Group::First, scene)).collect();
    experiments.extend(second.into_iter().zip(rests).map(|(scene, contact)| group(Group::Second(contact), scene)));
    experiments.push(group(Group::Third, third));
    Ok(experiments)
}

/// At least two scenes in ascending order of β, because what is claimed of them is an order.
fn ascending(section: &Section<'_>, key: &str, folder: &Path) -> Result<Vec<Scene>, InputError> {
    let allowed = "a list of at least two scene files, beta ascending";
    let field = section.require(key, allowed)?;
    let scenes = listed_scenes(&field, folder)?;
    let ordered = scenes.windows(2).all(|pair| pair[0].beam.beta < pair[1].beam.beta);
    if scenes.len() >= 2 && ordered { Ok(scenes) } else { Err(field.refuse_as_written(allowed)) }
}

/// What each beam of the second group is said to rest on.
fn rests(section: &Section<'_>, count: usize) -> Result<Vec<Contact>, InputError> {
    let allowed = "a list of \"upper\", \"lower\" or \"free\", one for each scene of second";
    let field = section.require("rests", allowed)?;
    let choices = [("upper", Contact::Upper), ("lower", Contact::Lower), ("free", Contact::Free)];
    let contacts = field.items(allowed)?.iter().map(|item| item.choice(&choices)).collect::<Result<Vec<_>, _>>()?;
    if contacts.len() == count { Ok(contacts) } else { Err(field.refuse_as_written(allowed)) }
}

/// Another mesh and time step, where `[run]` has them.
fn refine(run: &Section<'_>, scene: &mut Scene) -> Result<(), InputError> {
    let field = run.get("elements");
    let elements = field.as_ref().map_or(Ok(scene.mesh.nodes().len() - 1), tables::elements)?;
    let dt = run.get("dt").map_or(Ok(scene.dt()), |field| field.positive())?;
    if field.is_some() || run.get("dt").is_some() {
        *scene =
            at_resolution(scene, elements, dt).map_err(|error| run.refuse("elements", error.to_string(), "a mesh"))?;
    }
    Ok(())
}

/// The table `[steady]`: the axial forces at which steady states are counted, and how the runs to rest are done.
fn steady(root: &Section<'_>) -> Result<(Vec<f64>, ToRest), InputError> {
    let section = root.require("steady", "a table with beta, elements, dt, speed and t_max")?.section()?;
    section.allow(&["beta", "elements", "dt", "speed", "t_max"])?;
    let allowed = "a list of numbers, ascending";
    let field = section.require("beta", allowed)?;
    let betas = field.items(allowed)?.iter().map(Field::number).collect::<Result<Vec<f64>, _>>()?;
    if betas.is_empty() || betas.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(field.refuse_as_written(allowed));
    }
    let rest = ToRest {
        elements: tables::elements(&section.require("elements", "a whole number >= 1")?)?,
        dt: section.positive("dt")?,
        speed: section.positive("speed")?,
        t_max: section.positive("t_max")?,
    };
    limits::steps_until(&section.require("t_max", POSITIVE)?, rest.t_max, rest.dt, limits::STEPS)?;
    Ok((betas, rest))
}
