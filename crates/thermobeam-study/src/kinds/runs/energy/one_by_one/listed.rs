//! The tables `[energy]` and `[[case]]`.

use super::EnergyRun;
use crate::kinds::prelude::*;
use crate::{
    kinds::{
        runs::{
            cases::End,
            energy::{beams::smooth, bound::Stability},
            watch::SOLVED,
        },
        tables::{Layout, Share},
    },
    run::simulate,
    scene::{
        Scene, SceneFile,
        file::{
            BeamTable, Formula, InitialTable, MeshTable, ObstacleTable, OfS, Schemes, TimeTable,
        },
        limits::{self, Elements},
        tables,
    },
};
use thermobeam::{
    one_step::{Problem, Stepping},
    solve::{Settings, Solver, Stopping},
};

/// The table `[energy]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::kinds::runs::energy) struct EnergyTable {
    /// scene files, relative to this file
    scenes: Vec<String>,
    /// the schemes, each applied to all beams
    schemes: Vec<OneOf<Schemes>>,
    /// number of elements
    elements: Elements,
    /// a function of s that places the nodes: 0 at 0, 1 at 1; without it s
    map: Option<Formula<OfS>>,
    /// time step
    dt: Positive,
    /// number of steps
    steps: Count<1, { limits::STEPS }>,
    /// random beams in addition
    #[serde(default)]
    random: u64,
    /// of the random beams
    #[serde(default)]
    seed: u64,
    /// part of the energy by which it may rise or its balance be off
    tolerance: Share,
}

impl EnergyTable {
    /// The names of the scene files.
    pub(super) fn scenes(&self) -> &[String] {
        &self.scenes
    }

    /// The runs: every scene, then every random beam, by each scheme in turn.
    pub(super) fn runs(&self, folder: &Path) -> Result<Vec<EnergyRun>, Refusal> {
        if self.schemes.is_empty() {
            return Err(Refusal::written("schemes", "a list of at least one scheme"));
        }
        limits::case_count("random", &[self.random as usize, self.schemes.len()])?;
        let layout = Layout::new(self.map.as_ref(), &[self.elements.get()], None)?;
        let mesh = tables::mapped("elements", layout.mesh(self.elements.get()))?;
        let mut scenes = vec![];
        for (place, name) in self.scenes.iter().enumerate() {
            let file = named_file(&format!("scenes[{place}]"), name, folder)?;
            scenes.push(Scene::read(file)?);
        }
        let mut runs = vec![];
        for scene in scenes {
            let mesh = mesh.clone();
            let name = scene.name.clone();
            runs.extend(self.of_beam(&name, &simulate::problem(&Scene { mesh, ..scene })));
            // Further schemes would crowd the figures.
            let first = runs.len() - self.schemes.len();
            runs[first].is_drawn = true;
        }
        for k in 0..self.random {
            let problem = smooth(&mesh, self.seed.wrapping_add(k));
            runs.extend(self.of_beam(&format!("random-{k}"), &problem));
        }
        Ok(runs)
    }

    /// The runs of a beam by each scheme.
    fn of_beam(&self, name: &str, problem: &Problem) -> Vec<EnergyRun> {
        let mut runs = vec![];
        for scheme in &self.schemes {
            runs.push(EnergyRun {
                name: format!("{name}, {}", scheme.name),
                problem: problem.clone(),
                stepping: Stepping {
                    scheme: scheme.value,
                    settings: solved(Settings::default()),
                    dt: self.dt.get(),
                    loaded: false,
                },
                steps: self.steps.get(),
                claim: "the energy falls and its balance closes".to_owned(),
                end: End::Answer,
                share: Some(self.tolerance.get()),
                drift: None,
                is_bounded: false,
                is_drawn: false,
            });
        }
        runs
    }
}

/// The balance holds for the exact solution of a step only.
fn solved(settings: Settings) -> Settings {
    Settings {
        stopping: Stopping::below(SOLVED),
        ..settings
    }
}

/// A table `[[case]]`: a scene, and what is claimed of its run.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::kinds::runs::energy) struct CaseTable {
    /// a name that no other case has
    name: String,
    /// the claim in words
    claim: String,
    /// how its run must end
    ends: OneOf<End>,
    /// part of the energy by which a beam without losses may drift; without it, it is not checked
    drift: Option<Share>,
    /// the bound of Corollary 3.2 is checked
    #[serde(default)]
    stability: bool,
    /// as in a scene
    #[serde(default)]
    beam: BeamTable,
    /// as in a scene
    obstacles: Option<ObstacleTable>,
    /// as in a scene
    #[serde(default)]
    initial: InitialTable,
    /// as in a scene
    #[serde(default)]
    mesh: MeshTable,
    /// as in a scene
    time: TimeTable,
}

impl CaseTable {
    /// The run.
    pub(super) fn run(self) -> Result<EnergyRun, Refusal> {
        let scene = SceneFile {
            beam: self.beam,
            obstacles: self.obstacles,
            initial: self.initial,
            mesh: self.mesh,
            time: self.time,
        };
        let scene = Scene::new(scene, self.name.clone())?;
        let mut stepping = scene
            .one_step()
            .map_err(|error| Refusal::new("time.scheme", "dg", error.to_string()))?;
        if stepping.settings.solver == Solver::Newton {
            stepping.settings = solved(stepping.settings);
        }
        if self.stability && Stability::of(&scene.beam, scene.obstacles.as_ref(), 1.0).is_none() {
            let found = "a beam for which Corollary 3.2 states nothing";
            return Err(Refusal::new(
                "stability",
                found,
                "rho > 0 or beta > -0.7116",
            ));
        }
        Ok(EnergyRun {
            name: self.name,
            problem: simulate::problem(&scene),
            stepping,
            steps: scene.steps(),
            claim: self.claim,
            end: self.ends.value,
            share: None,
            drift: self.drift.map(Share::get),
            is_bounded: self.stability,
            is_drawn: false,
        })
    }
}
