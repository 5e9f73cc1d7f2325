//! The tables `[energy]` and `[[case]]`.

use super::EnergyRun;
use crate::kinds::prelude::*;
use crate::{
    kinds::{
        runs::{
            cases::{ClaimedScene, ENDS, End, NAMED},
            energy::{beams::smooth, bound::Stability},
            watch::SOLVED,
        },
        settings::Nodes,
        tables::{Layout, MAP},
    },
    run::simulate,
    scene::{self, Scene, limits, tables},
};
use thermobeam::{
    mesh::Mesh,
    one_step::{Problem, Stepping},
    scheme::SCHEMES,
    solve::{Settings, Solver, Stopping},
};

/// The keys of `[energy]`.
pub(super) const ENERGY: [Key; 9] = [
    Key::new(
        "scenes",
        Form::List(&Form::Text),
        "scene files, relative to this file",
    ),
    Key::new(
        "schemes",
        Form::List(&Form::Choice(|| SCHEMES.map(|scheme| scheme.name).to_vec())),
        "the schemes, each applied to all beams",
    ),
    Key::new("elements", Form::Count(1), "number of elements"),
    MAP,
    Key::new("dt", Form::Positive, "time step"),
    Key::new("steps", Form::Count(1), "number of steps"),
    Key::new("random", Form::Count(0), "random beams in addition").or("0"),
    Key::new("seed", Form::Count(0), "of the random beams").or("0"),
    Key::new(
        "tolerance",
        Form::Positive,
        "part of the energy by which it may rise or its balance be off",
    ),
];

/// The keys of `[[case]]`.
pub(super) const CASE: Keys = &[
    &NAMED,
    &[ENDS],
    &scene::KEYS,
    &[
        Key::new(
            "drift",
            Form::Positive,
            "part of the energy by which a beam without losses may drift",
        )
        .or("not checked"),
        Key::new(
            "stability",
            Form::Boolean,
            "the bound of Corollary 3.2 is checked",
        )
        .or("false"),
    ],
];

/// The runs of `[energy]`: every scene, then every random beam, by each scheme in turn.
pub(super) fn runs(section: &Section<'_>, folder: &Path) -> Result<Vec<EnergyRun>, InputError> {
    let names = SCHEMES.map(|scheme| (scheme.name, scheme));
    let schemes = section.list(
        "schemes",
        "a list of at least one scheme",
        |item| item.choice(&names),
        |list| !list.is_empty(),
    )?;
    let random = count(section, "random")?;
    if let Some(field) = section.get("random") {
        limits::cases(&field, &[random, schemes.len()])?;
    }
    let seed = count(section, "seed")? as u64;
    let field = section.require("elements", "a number of elements")?;
    let elements = tables::elements(&field)?;
    let mesh = Layout::read(section, &[elements], None)?.mesh(elements);
    let mesh = tables::checked_mesh(mesh, &field)?;
    let dt = section.positive("dt")?;
    let tolerance = section.positive("tolerance")?;
    let steps = section.count("steps", 1..=limits::STEPS)?;
    let scenes = section.list(
        "scenes",
        "a list of scene files beside this one",
        |item| Scene::read(item.file(folder)?),
        |_| true,
    )?;
    let mut runs = vec![];
    for beam in beams(scenes, &mesh, random as u64, seed) {
        for &scheme in &schemes {
            runs.push(EnergyRun {
                name: format!("{}, {}", beam.name, scheme.name),
                nodes: Nodes::of_mesh(&beam.problem.mesh),
                problem: beam.problem.clone(),
                stepping: Stepping {
                    scheme,
                    settings: solved(Settings::default()),
                    dt,
                    loaded: false,
                },
                steps,
                claim: "the energy falls and its balance closes".to_owned(),
                end: End::Answer,
                share: Some(tolerance),
                drift: None,
                is_bounded: false,
                // Random beams and further schemes would crowd the figures.
                is_drawn: beam.is_scene && scheme == schemes[0],
            });
        }
    }
    Ok(runs)
}

/// A beam of the table, on its mesh.
struct EnergyBeam {
    name: String,
    problem: Problem,
    /// Whether a scene has it; otherwise its coefficients are random.
    is_scene: bool,
}

/// The beams of the scenes, then the random ones.
fn beams(scenes: Vec<Scene>, mesh: &Mesh, random: u64, seed: u64) -> Vec<EnergyBeam> {
    let mut beams = vec![];
    for scene in scenes {
        let mesh = mesh.clone();
        beams.push(EnergyBeam {
            name: scene.name.clone(),
            problem: simulate::problem(&Scene { mesh, ..scene }),
            is_scene: true,
        });
    }
    for k in 0..random {
        beams.push(EnergyBeam {
            name: format!("random-{k}"),
            problem: smooth(mesh, seed.wrapping_add(k)),
            is_scene: false,
        });
    }
    beams
}

/// A number that may be left out, which is 0.
fn count(section: &Section<'_>, key: &str) -> Result<usize, InputError> {
    section
        .get(key)
        .map_or(Ok(0), |field| field.count(0..=usize::MAX))
}

/// The balance holds for the exact solution of a step only.
fn solved(settings: Settings) -> Settings {
    Settings {
        stopping: Stopping::below(SOLVED),
        ..settings
    }
}

/// A run of `[[case]]`.
pub(super) fn case(section: &Section<'_>, name: String) -> Result<EnergyRun, InputError> {
    let ClaimedScene {
        name,
        claim,
        end,
        scene,
    } = ClaimedScene::read(section, name)?;
    let mut stepping = scene
        .one_step()
        .map_err(|error| section.refuse("time.scheme", "dg", error.to_string()))?;
    if stepping.settings.solver == Solver::Newton {
        stepping.settings = solved(stepping.settings);
    }
    let is_bounded = section
        .get("stability")
        .map_or(Ok(false), |field| field.boolean())?;
    if is_bounded && Stability::of(&scene.beam, scene.obstacles.as_ref(), 1.0).is_none() {
        let allowed = "rho > 0 or beta > -0.7116";
        return Err(section.refuse(
            "stability",
            "a beam for which Corollary 3.2 states nothing",
            allowed,
        ));
    }
    let drift = section.get("drift").map(|field| field.positive());
    Ok(EnergyRun {
        name,
        nodes: Nodes::of_scene(&scene),
        problem: simulate::problem(&scene),
        stepping,
        steps: scene.steps(),
        claim,
        end,
        share: None,
        drift: drift.transpose()?,
        is_bounded,
        is_drawn: false,
    })
}
