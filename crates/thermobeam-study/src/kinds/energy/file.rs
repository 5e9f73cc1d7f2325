//! The study file: `[energy]`, scene files and random beams by several schemes; or `[[case]]`, scenes with claims of their own.
//!
//! ```toml
//! [energy]
//! scenes = ["scenes/paper-1-beta-0.toml"]       # files beside this one
//! schemes = ["euler-crank-nicolson", "midpoint"]
//! elements = 50                                 # of the mesh, graded or uniform as below
//! map = "s"                                     # optional
//! dt = 1e-3
//! steps = 1000
//! random = 16                                   # beams with random coefficients and random smooth data
//! seed = 1
//! tolerance = 1e-12                             # of rise and residual, in units of the energy
//! ```
//!
//! ```toml
//! [[case]]
//! name = "long-steps"
//! claim = "..."                # in words
//! ends = "answer"              # or "indefinite", "iteration-limit", "not-finite": the failure
//! drift = 1e-10                # optional: bound of the sum of all residuals, in units of the energy
//! # and the tables of a scene
//! [case.time]
//! dt = 10.0
//! t_end = 1000.0
//! ```

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::Header;
use thermobeam::mesh::Mesh;
use thermobeam::scheme::SCHEMES;
use thermobeam::simulation::Stepping;
use thermobeam::solve::{Settings, Solver};

use super::End;
use super::runs::{Bound, Figures, Origin, Run, Runs};
use crate::expression::Variable;
use crate::kinds::watch::SOLVED;
use crate::scene::functions::FunctionField;
use crate::scene::{self, Scene, limits, tables};

pub(super) fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Runs, InputError> {
    match root.section("energy")? {
        Some(section) => Ok(Runs { header, runs: listed(&section, folder)?, figures: Figures::Histories }),
        None => Ok(Runs { header, runs: cases(root)?, figures: Figures::Drift }),
    }
}

/// The runs of `[energy]`: every scene, then every random beam, by each scheme in turn.
fn listed(section: &Section<'_>, folder: &Path) -> Result<Vec<Run>, InputError> {
    section.allow(&["scenes", "schemes", "elements", "map", "dt", "steps", "random", "seed", "tolerance"])?;
    let list = "a list of scene files beside this one";
    let files = section.require("scenes", list)?.items(list)?;
    let names = SCHEMES.map(|scheme| (scheme.name, scheme));
    let list = "a list of at least one scheme";
    let field = section.require("schemes", list)?;
    let schemes = field.items(list)?.iter().map(|scheme| scheme.choice(&names)).collect::<Result<Vec<_>, _>>()?;
    if schemes.is_empty() {
        return Err(field.refuse_as_written(list));
    }
    let count = |key: &str| section.get(key).map_or(Ok(0), |field| field.count(0..=usize::MAX));
    let random = count("random")?;
    if let Some(field) = section.get("random") {
        limits::cases(&field, &[random, schemes.len()])?;
    }
    let seed = count("seed")? as u64;
    let mesh = mesh(section)?;
    let (dt, tolerance) = (section.positive("dt")?, section.positive("tolerance")?);
    let steps = section.require("steps", "a number of steps")?.count(1..=limits::STEPS)?;
    let mut origins = vec![];
    for file in &files {
        let scene = Scene { mesh: mesh.clone(), ..Scene::read(file.file(folder)?)? };
        origins.push((scene.name.clone(), Origin::Scene(Box::new(scene))));
    }
    origins.extend((0..random as u64).map(|k| {
        let origin = Origin::Smooth { mesh: mesh.clone(), seed: seed.wrapping_add(k) };
        (format!("random-{k}"), origin)
    }));
    let settings = Settings { tolerance: SOLVED, ..Settings::default() };
    let by_scheme = |(name, origin): (String, Origin)| {
        schemes.iter().enumerate().map(move |(k, &scheme)| Run {
            name: format!("{name}, {}", scheme.name),
            // Random beams and further schemes would crowd the figures.
            is_drawn: k == 0 && matches!(origin, Origin::Scene(_)),
            origin: origin.clone(),
            stepping: Stepping { scheme, settings, dt, loaded: false },
            steps,
            claim: "the energy falls and its balance closes".to_owned(),
            end: End::Answer,
            bound: Bound::Share(tolerance),
            drift: None,
        })
    };
    Ok(origins.into_iter().flat_map(by_scheme).collect())
}

fn mesh(section: &Section<'_>) -> Result<Mesh, InputError> {
    let map = section.get("map").map(|field| field.expression(Variable::S)).transpose()?;
    let field = section.require("elements", "a number of elements")?;
    let mesh = Mesh::mapped(tables::elements(&field)?, |s| map.as_ref().map_or(s, |map| map.eval(s)));
    tables::checked_mesh(mesh, &field)
}

/// The runs of `[[case]]`.
fn cases(root: &Section<'_>) -> Result<Vec<Run>, InputError> {
    let allowed = "a list of at least one case, each [[case]]";
    let list = root.require("case", allowed)?;
    let mut runs: Vec<Run> = vec![];
    for item in list.items(allowed)? {
        let run = case(&item.section()?)?;
        if runs.iter().any(|earlier| earlier.name == run.name) {
            return Err(item.refuse(format!("a second \"{}\"", run.name), "a name that no other case has"));
        }
        runs.push(run);
    }
    let bounded = runs.iter().any(|run| run.drift.is_some());
    for run in &mut runs {
        // The drift of cases that claim a bound; of all where none does.
        run.is_drawn = run.drift.is_some() || !bounded;
    }
    if runs.is_empty() { Err(list.refuse_as_written(allowed)) } else { Ok(runs) }
}

fn case(section: &Section<'_>) -> Result<Run, InputError> {
    section.allow(&[&["name", "claim", "ends", "drift"], &scene::TABLES[..]].concat())?;
    let name = section.require("name", "a text")?.text()?.to_owned();
    let scene = Scene::from_tables(section, name.clone())?;
    let stepping = scene.one_step().map_err(|error| section.refuse("time.scheme", "dg", error.to_string()))?;
    let newton = stepping.settings.solver == Solver::Newton;
    // The balance holds for the exact solution of a step only.
    let settings = if newton { Settings { tolerance: SOLVED, ..stepping.settings } } else { stepping.settings };
    Ok(Run {
        name,
        claim: section.require("claim", "a text")?.text()?.to_owned(),
        end: section.require("ends", "\"answer\" or an error")?.choice(&End::ALL)?,
        drift: section.get("drift").map(|field| field.positive()).transpose()?,
        bound: Bound::Rounding,
        stepping: Stepping { settings, ..stepping },
        steps: scene.steps(),
        is_drawn: false,
        origin: Origin::Scene(Box::new(scene)),
    })
}
