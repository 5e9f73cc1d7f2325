//! The study file: the problem, the runs, and the claimed ratios.

use std::sync::OnceLock;

use convergence_study::{
    Tier,
    file::{Choices, Finite, Number, Range},
};

use super::{
    ROW, Target, WorkPrecision,
    method::{Degrees, METHODS, NamedMethod, Resolution, Trial, UniformGrid},
};
use crate::kinds::prelude::*;
use crate::{
    error::{ErrorMeasure, free_vibration},
    kinds::orders::{Orders, manufactured::Convergence},
    run::family::Family,
    scene::{Scene, file::first_where, sections::listed_nodes},
};
use thermobeam::{
    dg::{MAX_DEGREE, MAX_TIME_DEGREE},
    mesh::Mesh,
};

/// A study of work against errors, as it is written.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WorkPrecisionFile {
    /// the problem: a solution, a scene or a vibration
    #[serde(rename = "work-precision")]
    problem: ProblemTable,
    /// two different runs by dG, for a scene
    reference: Option<Vec<ReferenceTable>>,
    /// the runs of each method, at least one table
    #[serde(default)]
    runs: Vec<RunsTable>,
    /// an error, and the ratios of work claimed there, at least one table
    #[serde(default)]
    target: Vec<TargetTable>,
}

/// The table `[work-precision]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ProblemTable {
    /// times at which errors are measured
    observations: Count<1, 10_000>,
    /// a study file of kind orders/manufactured: its exact solution
    solution: Option<String>,
    /// a scene file; errors are distances to the reference
    scene: Option<String>,
    /// modes from 0, each released from a tip displacement of 0.1
    vibration: Option<Vec<Count<0, 1000>>>,
    /// of a vibration: the viscosity ζ
    zeta: Option<Positive>,
    /// of a scene or a vibration: final time
    t_end: Option<Positive>,
}

/// A run by dG, [degree p, degree q, largest step], or by a one-step method, [elements, steps].
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[schemars(extend(
    "title" = "[degree p, degree q, largest step] or [elements, steps]",
    "minItems" = 2,
    "maxItems" = 3
))]
struct ListedRun(Count<1>, Count<0>, #[serde(default)] Option<Positive>);

/// A table `[[reference]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ReferenceTable {
    /// the nodes, increasing from 0 to 1
    nodes: Vec<Finite>,
    /// degree p, degree q, largest step
    runs: ListedRun,
}

/// A table `[[runs]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RunsTable {
    /// the method
    method: OneOf<NamedMethod>,
    /// of dG: the nodes, increasing from 0 to 1
    nodes: Option<Vec<Finite>>,
    /// of a one-step method: the nodes are s^grading; without it 1
    grading: Option<Positive>,
    /// a list of [degree p, degree q, largest step] of dG, or of [elements, steps] of a one-step
    /// method, steps multiples of observations
    runs: Vec<ListedRun>,
}

/// A table `[[target]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TargetTable {
    /// how the error is measured
    norm: OneOf<ErrorMeasure>,
    /// the error
    error: Positive,
    /// at least two, the dearest first
    methods: Vec<OneOf<NamedMethod>>,
    /// how many times dearer each is than the next: about 1 or more
    #[serde(default)]
    times: Vec<Number<Dearer>>,
}

/// Ratios of a list that has the dearest first, where neighbours may be equally dear.
#[derive(Debug, Clone, Copy)]
enum Dearer {}

impl Range for Dearer {
    const ENDS: &'static [(&'static str, f64)] = &[("minimum", 0.95)];
}

impl Choices for NamedMethod {
    type Value = Self;

    fn all() -> Vec<(&'static str, Self)> {
        METHODS.map(|method| (method.name, method)).to_vec()
    }
}

impl Choices for ErrorMeasure {
    type Value = Self;

    fn all() -> Vec<(&'static str, Self)> {
        Self::ALL.map(|measure| (measure.name(), measure)).to_vec()
    }
}

/// Element-steps of a run in the quick tier, and in the full one.
const QUICK: usize = 1_000_000;
const FULL: usize = 10_000_000;

impl FromFile for WorkPrecision {
    type File = WorkPrecisionFile;

    fn from_file(file: WorkPrecisionFile, header: &Header, folder: &Path) -> Result<Self, Refusal> {
        let most = match header.tier {
            Tier::Quick => QUICK,
            Tier::Full => FULL,
        };
        file.study(folder, most)
    }

    fn named_files(file: &WorkPrecisionFile) -> Vec<&str> {
        let ProblemTable {
            solution, scene, ..
        } = &file.problem;
        [solution, scene]
            .into_iter()
            .flatten()
            .map(String::as_str)
            .collect()
    }
}

impl WorkPrecisionFile {
    /// * `most`: element-steps of a run.
    fn study(&self, folder: &Path, most: usize) -> Result<WorkPrecision, Refusal> {
        let observations = self.problem.observations.get();
        let family = self
            .problem
            .family(folder)
            .map_err(Refusal::within(ROW.name))?;
        let trials = Refusal::of_each("runs", &self.runs, |table| table.trials(observations, most));
        let trials = trials?.concat();
        let targets = Refusal::of_each("target", &self.target, TargetTable::target)?;
        let reference = self.reference(family.exact().is_none())?;
        if let Some(table) =
            first_where([("runs", trials.is_empty()), ("target", targets.is_empty())])
        {
            let allowed = format!("at least one table [[{table}]]");
            return Err(Refusal::written(table, allowed));
        }
        Ok(WorkPrecision {
            reference,
            family,
            observations,
            computed: OnceLock::new(),
            trials,
            targets,
        })
    }

    /// Two runs by dG for a scene; none where there is an exact solution.
    fn reference(&self, is_needed: bool) -> Result<Option<[Trial; 2]>, Refusal> {
        let tables = match (&self.reference, is_needed) {
            (None, false) => return Ok(None),
            (Some(_), false) => {
                let found = "reference without scene";
                return Err(Refusal::new("reference", found, "reference beside scene"));
            }
            (tables, true) => tables.as_deref().unwrap_or_default(),
        };
        let method = METHODS[METHODS.len() - 1];
        let trials = Refusal::of_each("reference", tables, |table| {
            let resolution = by_dg("runs", table.runs, &listed_nodes(&table.nodes)?)?;
            Ok(Trial { method, resolution })
        });
        match <[Trial; 2]>::try_from(trials?) {
            Ok([one, other]) if one != other => Ok(Some([one, other])),
            _ => Err(Refusal::written(
                "reference",
                "two different tables [[reference]]",
            )),
        }
    }
}

impl RunsTable {
    /// The runs of the table.
    fn trials(&self, observations: usize, most: usize) -> Result<Vec<Trial>, Refusal> {
        let method = self.method.value;
        let is_one_step = method.one_step.is_some();
        let foreign = first_where([
            ("nodes", self.nodes.is_some() && is_one_step),
            ("grading", self.grading.is_some() && !is_one_step),
        ]);
        if let Some(key) = foreign {
            let found = format!("{key} of the method \"{}\"", method.name);
            let allowed = "nodes for dG, grading for a one-step method";
            return Err(Refusal::new(key, found, allowed));
        }
        let mesh = self.nodes.as_deref().map(listed_nodes).transpose()?;
        let mut trials = vec![];
        for (place, run) in self.runs.iter().enumerate() {
            let path = format!("runs[{place}]");
            let resolution = match (&mesh, method.one_step) {
                (Some(mesh), _) => by_dg(&path, *run, mesh)?,
                (None, Some(scheme)) => {
                    let grid = self.grid(&path, *run, observations, most)?;
                    Resolution::OneStep(scheme, grid)
                }
                (None, None) => {
                    let allowed = "an increasing list of numbers from 0 to 1";
                    return Err(Refusal::missing("nodes", allowed));
                }
            };
            trials.push(Trial { method, resolution });
        }
        if trials.is_empty() {
            return Err(Refusal::written("runs", "a list of at least one run"));
        }
        Ok(trials)
    }

    /// A run by a one-step method: elements and steps.
    fn grid(
        &self,
        path: &str,
        ListedRun(elements, steps, step): ListedRun,
        observations: usize,
        most: usize,
    ) -> Result<UniformGrid, Refusal> {
        let [elements, steps] = [elements.get(), steps.get()];
        if step.is_some() || steps == 0 || !steps.is_multiple_of(observations) {
            let allowed = format!("[elements, steps], steps multiples of {observations}");
            return Err(Refusal::written(path, allowed));
        }
        let all = elements.saturating_mul(steps);
        if all > most {
            let limit = format!("at most {most} element-steps in this tier");
            return Err(Refusal::written_and(
                path,
                format!(", {all} element-steps"),
                limit,
            ));
        }
        Ok(UniformGrid {
            grading: self.grading.map_or(1.0, Positive::get),
            elements,
            steps,
        })
    }
}

/// A run by dG.
fn by_dg(path: &str, ListedRun(p, q, dt): ListedRun, mesh: &Mesh) -> Result<Resolution, Refusal> {
    let Some(dt) = dt else {
        return Err(Refusal::written(path, "[degree p, degree q, largest step]"));
    };
    let degrees = Degrees {
        p: degree(path, 0, p.get(), MAX_DEGREE)?,
        q: degree(path, 1, q.get(), MAX_TIME_DEGREE)?,
        dt: dt.get(),
    };
    Ok(Resolution::Dg {
        mesh: mesh.clone(),
        degrees,
    })
}

/// The degree at this place of a run.
fn degree(path: &str, place: usize, degree: usize, most: usize) -> Result<usize, Refusal> {
    if degree <= most {
        return Ok(degree);
    }
    let allowed = format!("a degree of at most {most}");
    Err(Refusal::written(format!("{path}[{place}]"), allowed))
}

impl ProblemTable {
    /// The problem.
    fn family(&self, folder: &Path) -> Result<Family, Refusal> {
        if self.zeta.is_some() && self.vibration.is_none() {
            let found = "zeta without vibration";
            return Err(Refusal::new("zeta", found, "zeta beside vibration"));
        }
        let t_end = || {
            let t_end = self.t_end.map(Positive::get);
            t_end.ok_or_else(|| Refusal::missing("t_end", "a finite number > 0: final time"))
        };
        match (&self.solution, &self.scene, &self.vibration) {
            (Some(name), None, None) => {
                if self.t_end.is_some() {
                    let allowed = "no t_end: it is that of the solution";
                    return Err(Refusal::new("t_end", "t_end beside solution", allowed));
                }
                let file = named_file("solution", name, folder)?;
                let Orders(Convergence {
                    exact,
                    theory,
                    refine,
                    ..
                }) = Orders::read(file)?;
                let (beam, obstacles) = (theory.beam, theory.obstacles);
                Ok(Family::of_solution(exact, beam, obstacles, refine.t_end))
            }
            (None, Some(name), None) => Ok(Family::of_scene(&Scene {
                t_end: t_end()?,
                ..Scene::read(named_file("scene", name, folder)?)?
            })),
            (None, None, Some(modes)) => self.vibration(modes, t_end()?),
            _ => {
                let allowed = "exactly one of solution, scene and vibration";
                Err(Refusal::missing("solution", allowed))
            }
        }
    }

    /// The modes, each released from a tip displacement of 0.1.
    fn vibration(&self, modes: &[Count<0, 1000>], t_end: f64) -> Result<Family, Refusal> {
        const AMPLITUDE: f64 = 0.1;
        if modes.is_empty() {
            let allowed = "a list of at least one mode, numbered from 0";
            return Err(Refusal::written("vibration", allowed));
        }
        let modes: Vec<_> = modes.iter().map(|mode| (mode.get(), AMPLITUDE)).collect();
        let zeta = self.zeta.map(Positive::get);
        let zeta =
            zeta.ok_or_else(|| Refusal::missing("zeta", "a finite number > 0: the viscosity"))?;
        let exact = free_vibration::vibration(&modes, zeta)
            .map_err(|error| Refusal::new("zeta", error.to_string(), "a viscosity"))?;
        Ok(Family::of_free_solution(
            exact,
            free_vibration::beam(zeta),
            t_end,
        ))
    }
}

impl TargetTable {
    fn target(&self) -> Result<Target, Refusal> {
        let methods: Vec<NamedMethod> = self.methods.iter().map(|method| method.value).collect();
        if methods.len() < 2 || (1..methods.len()).any(|k| methods[..k].contains(&methods[k])) {
            let allowed = "at least two different methods, the dearest first";
            return Err(Refusal::written("methods", allowed));
        }
        if self.times.len() + 1 != methods.len() {
            let allowed =
                "a number for each method but the last: how many times dearer it is than the next";
            return Err(Refusal::written("times", allowed));
        }
        Ok(Target {
            measure: self.norm.value,
            error: self.error.get(),
            times: self.times.iter().map(|times| times.get()).collect(),
            methods,
        })
    }
}
