//! What a run is made of, as its case says it: a diagnosis names what failing cases share.

use std::collections::BTreeMap;

use serde::Serialize;
use thermobeam::{
    parameters::{Beam, Obstacles},
    scheme::{EULER_CRANK_NICOLSON, Scheme},
    solve::Solver,
};

use super::{Method, Scene, tables::Coefficients};

/// Terms of the equations, mesh, method, and what the motion is held against.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Parts {
    beam: BTreeMap<&'static str, f64>,
    obstacles: Option<BTreeMap<&'static str, f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    method: Option<MethodParts>,
    /// What the motion is held against, if that is one of these.
    #[serde(skip_serializing_if = "Option::is_none")]
    against: Option<Known>,
}

/// How the beam is stepped.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum MethodParts {
    OneStep {
        scheme: &'static str,
        solver: &'static str,
    },
    Dg {},
}

/// What is known exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) enum Known {
    /// A solution with its loads.
    #[serde(rename = "exact solution")]
    Solution,
    /// A vibration without loads.
    #[serde(rename = "free vibration")]
    Vibration,
    /// States at rest.
    #[serde(rename = "steady states")]
    SteadyStates,
}

impl Known {
    /// An exact solution with or without loads.
    pub(crate) fn with_loads(loaded: bool) -> Self {
        if loaded {
            Self::Solution
        } else {
            Self::Vibration
        }
    }
}

impl Parts {
    /// Of a beam, which nothing steps.
    pub(crate) fn new(beam: &Beam, obstacles: Option<&Obstacles>) -> Self {
        let mut all = Coefficients {
            beam: *beam,
            obstacles: obstacles.copied(),
        };
        let mut of = |names: &[&'static str]| -> BTreeMap<&'static str, f64> {
            let values = names.iter();
            let values = values.filter_map(|name| Some((*name, *all.get_mut(name)?)));
            values.collect()
        };
        Self {
            beam: of(&Coefficients::OF_BEAM),
            obstacles: obstacles.map(|_| of(&Coefficients::OF_OBSTACLES)),
            mesh: None,
            method: None,
            against: None,
        }
    }

    /// Of the run of a scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        // As the file says it, whatever is made of it.
        let mesh = match scene.listed.len() {
            0 if scene.is_mapped => "mapped",
            0 => "uniform",
            _ => "listed",
        };
        let parts = Self {
            mesh: Some(mesh),
            ..Self::new(&scene.beam, scene.obstacles.as_ref())
        };
        match scene.method {
            Method::OneStep(stepping) => parts.by(stepping.scheme, stepping.settings.solver),
            Method::Dg(_) => parts.by_dg(),
        }
    }

    /// The same on such a mesh.
    pub(crate) fn on(self, is_uniform: bool) -> Self {
        let mesh = Some(if is_uniform { "uniform" } else { "mapped" });
        Self { mesh, ..self }
    }

    /// The same by a one-step scheme.
    pub(crate) fn by(self, scheme: Scheme, solver: Solver) -> Self {
        let (scheme, solver) = (scheme.name, solver.name());
        let method = Some(MethodParts::OneStep { scheme, solver });
        Self { method, ..self }
    }

    /// The same by the paper's scheme.
    pub(crate) fn by_the_paper(self, solver: Solver) -> Self {
        self.by(EULER_CRANK_NICOLSON, solver)
    }

    /// The same by dG.
    pub(crate) fn by_dg(self) -> Self {
        let method = Some(MethodParts::Dg {});
        Self { method, ..self }
    }

    /// The same, held against what is known.
    pub(crate) fn against(self, known: Known) -> Self {
        let against = Some(known);
        Self { against, ..self }
    }
}

/// Whether all elements are equally long, but for rounding.
pub(crate) fn is_uniform(nodes: &[f64]) -> bool {
    let n = (nodes.len() - 1) as f64;
    let mut nodes = nodes.iter().enumerate();
    nodes.all(|(i, x)| (x - i as f64 / n).abs() <= 4.0 * f64::EPSILON)
}
