//! One problem on any mesh and with any step: the basis of everything that trades cost against
//! error.
//!
//! A [`Family`] is a problem without its discretisation: a scene, a manufactured solution with its
//! loads, or a free vibration. `Family::on_nodes` adds a mesh, [`OnMesh::start`] a scheme and a
//! step. The caller steps the [`ObservableMotion`], so that several can proceed together and be
//! compared at common times. Its cost is counted: [`Spent`].

use std::sync::Arc;

use crate::exact::solution::{Factors, Manufactured};
use crate::exact::sources::{Nodal, Sources};
use crate::run::ObservableMotion;
use crate::run::dg::DgMotion;
use crate::run::driver::Driver;
use crate::run::simulate;
use crate::scene::{
    Coefficients, Scene,
    parts::{Known, Parts},
};
use convergence_study::CaseFailure;
use thermobeam::dg::DgStepping;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::one_step::{Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::Scheme;
use thermobeam::solve::Settings;

/// The cost of a computation, counted: the same on every machine.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spent {
    /// Elements times time steps.
    pub node_steps: f64,
    /// Elements times solves of a step's linear system and factorisations: Newton's method
    /// factorises hardly ever, the fixed point factorises the equation of u in each iteration.
    pub node_solves: f64,
}

impl Spent {
    /// The cost of a motion by a one-step scheme so far.
    pub(crate) fn of(motion: &impl ObservableMotion, elements: usize) -> Self {
        let (elements, motion) = (elements as f64, motion.motion());
        let work = motion.work();
        Self {
            node_steps: elements * motion.steps() as f64,
            node_solves: elements * (work.passes + work.factorizations) as f64,
        }
    }
}

/// The source of the initial data.
#[derive(Debug, Clone)]
enum Start {
    Scene(Box<Scene>),
    Exact(Manufactured),
}

/// A problem on [0, `t_end`], without mesh and time step.
#[derive(Debug, Clone)]
pub struct Family {
    /// Coefficients of (1.1).
    pub beam: Beam,
    /// The obstacles of (1.3), if any.
    pub obstacles: Option<Obstacles>,
    /// Final time.
    pub t_end: f64,
    start: Start,
    /// Whether the exact solution needs loads; a free vibration needs none.
    loaded: bool,
}

impl Family {
    /// What a run is made of, but for mesh and method.
    pub(crate) fn parts(&self) -> Parts {
        let parts = Parts::new(&self.beam, self.obstacles.as_ref());
        match &self.start {
            Start::Scene(_) => parts,
            Start::Exact(_) => parts.against(Known::with_loads(self.loaded)),
        }
    }

    /// The problem of a scene; its mesh and its steps have no influence.
    pub fn of_scene(scene: &Scene) -> Self {
        Self {
            beam: scene.beam,
            obstacles: scene.obstacles,
            t_end: scene.t_end,
            start: Start::Scene(Box::new(scene.clone())),
            loaded: false,
        }
    }

    /// The problem that `exact` solves with the loads derived from it.
    pub fn of_solution(
        exact: Manufactured,
        beam: Beam,
        obstacles: Option<Obstacles>,
        t_end: f64,
    ) -> Self {
        Self {
            beam,
            obstacles,
            t_end,
            start: Start::Exact(exact),
            loaded: true,
        }
    }

    /// The problem that `exact` solves without any load.
    pub fn of_free_solution(exact: Manufactured, beam: Beam, t_end: f64) -> Self {
        Self {
            loaded: false,
            ..Self::of_solution(exact, beam, None, t_end)
        }
    }

    /// The exact solution, if there is one.
    pub fn exact(&self) -> Option<&Manufactured> {
        match &self.start {
            Start::Exact(exact) => Some(exact),
            Start::Scene(_) => None,
        }
    }

    /// The problem on elements of any degree, by dG, at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] if the solver refuses the numbers.
    pub(crate) fn dg(
        &self,
        mesh: Mesh,
        degree: usize,
        stepping: DgStepping,
    ) -> Result<DgMotion, SetupError> {
        let Self {
            beam, obstacles, ..
        } = *self;
        let exact = match &self.start {
            Start::Scene(scene) => {
                return DgMotion::new(
                    &Scene {
                        mesh,
                        degree,
                        ..Scene::clone(scene)
                    },
                    stepping,
                );
            }
            Start::Exact(exact) => exact,
        };
        let own = Coefficients { beam, obstacles };
        DgMotion::manufactured(
            exact,
            self.loaded.then_some(&own),
            None,
            own,
            mesh,
            degree,
            stepping,
        )
    }

    /// The problem on linear elements.
    pub(crate) fn on_nodes(&self, mesh: Mesh) -> OnMesh<'_> {
        let (initial, sources) = match &self.start {
            Start::Scene(scene) => (
                simulate::initial(&scene.initial, scene.beam.theta_a, &mesh),
                None,
            ),
            Start::Exact(exact) => {
                let mut factors = Factors::default();
                factors.at(exact, 0.0);
                let theta_a = self.beam.theta_a;
                let initial = Nodal::of(exact, &mesh).initial(&mesh, &factors, theta_a, theta_a);
                (
                    initial,
                    self.loaded
                        .then(|| Arc::new(Sources::strong(exact, &self.beam, &mesh))),
                )
            }
        };
        let problem = Problem {
            beam: self.beam,
            obstacles: self.obstacles,
            mesh,
            initial,
        };
        OnMesh {
            family: self,
            problem,
            sources,
        }
    }
}

/// A problem on a mesh, shared by runs with different steps.
pub struct OnMesh<'a> {
    family: &'a Family,
    problem: Problem,
    sources: Option<Arc<Sources>>,
}

impl OnMesh<'_> {
    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.problem.mesh
    }

    /// Final time.
    pub(crate) fn t_end(&self) -> f64 {
        self.family.t_end
    }

    /// Starts at t = 0 with a scheme and `steps` steps to do.
    ///
    /// # Errors
    /// [`CaseFailure`] if the solver refuses the numbers.
    pub fn start(
        &self,
        scheme: Scheme,
        settings: Settings,
        steps: usize,
    ) -> Result<impl ObservableMotion, CaseFailure> {
        let dt = self.family.t_end / steps as f64;
        let stepping = Stepping {
            scheme,
            settings,
            dt,
            loaded: self.sources.is_some(),
        };
        let driver = Driver::new(self.problem.clone(), stepping)?;
        let (Some(sources), Some(exact)) = (&self.sources, self.family.exact()) else {
            return Ok(driver);
        };
        let sources = sources.clone();
        let exact = exact.clone();
        let obstacles = self.family.obstacles;
        let mut factors = Factors::default();
        Ok(driver.loaded(move |t, load| {
            factors.at(&exact, t);
            sources.fill(
                &factors,
                sources.forces(&factors.u, obstacles.as_ref(), None),
                None,
                load,
            );
        }))
    }
}
