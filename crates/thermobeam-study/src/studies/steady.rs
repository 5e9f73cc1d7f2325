//! Runs to rest, and the exact steady states in which they should end.

use std::ops::ControlFlow;

use thermobeam_exact::equilibrium::{
    Completeness, Equilibrium, EquilibriumError, Phase, completeness, equilibria,
};

use super::prelude::*;
use crate::{
    kinds::tables::Discretisation,
    run::{ObservableMotion, RunError, run, simulate},
    scene::{Method, Scene, resampled},
};
use thermobeam::{mesh::Mesh, motion::StepReport, solve::TimeLevel};

/// Runs until the beam is slow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ToRest {
    pub(super) method: MethodToRest,
    /// Largest velocity that counts as rest.
    pub(super) speed: f64,
    /// A longer run fails.
    pub(super) t_max: f64,
}

/// How a beam is stepped until it rests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MethodToRest {
    /// By the scheme of its scene, on a uniform mesh.
    OneStep { elements: usize, dt: f64 },
    /// By dG.
    AnyOrder(Discretisation),
}

/// Elements of the mesh on whose nodes a run by dG is compared with speeds and steady states: more
/// than two nodes for each half wave of a polynomial of degree 12.
const COMPARED: usize = 32;

impl ToRest {
    /// What a run costs.
    pub(super) fn cost(&self) -> f64 {
        match &self.method {
            MethodToRest::OneStep { elements, dt } => cost_to_rest(*elements, *dt),
            MethodToRest::AnyOrder(discretisation) => discretisation.cost(RESTS),
        }
    }

    /// Runs the scene with this β to rest.
    ///
    /// # Errors
    /// As [`settle`], and if the steady states cannot be found.
    pub(super) fn run(&self, scene: &Scene, beta: f64) -> Result<AtRest, CaseFailure> {
        let mut scene = match &self.method {
            MethodToRest::OneStep { elements, dt } => scene.at(Mesh::uniform(*elements)?, *dt),
            MethodToRest::AnyOrder(discretisation) => discretisation.of(scene, self.t_max)?,
        };
        scene.beam.beta = beta;
        scene.name = format!("beta = {beta}");
        let (t, level) = settle(&scene, self.speed, self.t_max)?;
        AtRest::of(&scene, &compared(&scene)?, t, &level, |_| true)
    }
}

/// The mesh on whose nodes a run is compared with exact steady states.
///
/// # Errors
/// The mesh has elements that are too small.
pub(super) fn compared(scene: &Scene) -> Result<Mesh, CaseFailure> {
    Ok(match scene.method {
        Method::OneStep(_) => scene.mesh.clone(),
        Method::Dg(_) => resampled(&scene.mesh, COMPARED)?,
    })
}

/// When a beam has come to rest, roughly.
const RESTS: f64 = 200.0;

/// The cost until a beam has come to rest.
pub(super) fn cost_to_rest(elements: usize, dt: f64) -> f64 {
    RESTS / dt * elements as f64
}

/// Where a moving beam comes to rest, and the exact steady states. Pairs are of u and of φ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtRest {
    /// When it came to rest.
    pub t: f64,
    /// u(1) and φ(1).
    pub tip: [f64; 2],
    /// Number of exact steady states.
    pub states: usize,
    /// Whether there are no others.
    pub is_complete: bool,
    /// Number of those that are stable.
    pub stable: usize,
    /// The nearest exact steady state; `None` if there is none.
    pub nearest: Option<Nearest>,
}

impl AtRest {
    /// The beam at rest since `t`, by its values at the nodes of `mesh`.
    ///
    /// * `is_candidate`: the exact states of which the nearest is found.
    ///
    /// # Errors
    /// The steady states cannot be found.
    pub(super) fn of(
        scene: &Scene,
        mesh: &Mesh,
        t: f64,
        level: &TimeLevel,
        is_candidate: impl Fn(&Equilibrium) -> bool,
    ) -> Result<Self, CaseFailure> {
        let states = exact_states(scene)?;
        Ok(Self {
            t,
            tip: [&level.u, &level.phi].map(|field| field[mesh.elements()]),
            states: states.len(),
            is_complete: completeness(&scene.beam, scene.obstacles.as_ref())
                == Completeness::Complete,
            stable: states.iter().filter(|state| state.stable).count(),
            nearest: Nearest::of(mesh, level, states.into_iter().filter(is_candidate)),
        })
    }

    /// The number of steady states, in words: a list that may lack some gives only a least number.
    pub(super) fn count(&self) -> String {
        if self.is_complete {
            self.states.to_string()
        } else {
            format!("at least {}", self.states)
        }
    }

    /// u(1) and φ(1) of the nearest exact steady state; NaN if there is none.
    pub(super) fn exact_tip(&self) -> [f64; 2] {
        self.nearest.map_or([f64::NAN; 2], |Nearest { state, .. }| {
            [state.u_tip, state.phi_tip]
        })
    }

    /// Its distances in u and in φ; NaN if there is none.
    pub(super) fn errors(&self) -> [f64; 2] {
        self.nearest.map_or([f64::NAN; 2], |nearest| nearest.errors)
    }

    /// Its state of contact.
    pub(super) fn contact(&self) -> Option<Phase> {
        self.nearest.map(|nearest| nearest.state.contact)
    }

    /// Distance to the nearest exact steady state; NaN if there is none.
    pub(super) fn distance(&self) -> f64 {
        self.nearest.map_or(f64::NAN, |nearest| nearest.distance)
    }

    /// Whether the nearest state is stable.
    pub(super) fn is_stable(&self) -> bool {
        self.nearest.is_some_and(|nearest| nearest.state.stable)
    }
}

/// A beam is at rest when it has been slow for this time: at the turning points of an oscillation
/// it is slow for a moment, and near buckling the slowest oscillation differs from rest by its
/// speed alone.
const QUIET: f64 = 5.0;

/// Runs until no node has been faster than `speed`, in u or φ, for a while; returns that time and
/// level.
///
/// * `scene`: by any method; a run by dG is observed at the nodes of its mesh of comparison.
///
/// # Errors
/// A step that fails, or motion beyond `t_max`.
pub(super) fn settle(
    scene: &Scene,
    speed: f64,
    t_max: f64,
) -> Result<(f64, TimeLevel), CaseFailure> {
    match scene.method {
        Method::OneStep(_) => quiet(
            &mut simulate::driver(scene)?,
            t_max,
            |driver| driver.level().is_slow(speed),
            |driver| driver.level().clone(),
        )?,
        Method::Dg(_) => {
            let mesh = compared(scene)?;
            quiet(
                &mut *simulate::motion(scene)?,
                t_max,
                |motion| motion.on(&mesh).is_slow(speed),
                |motion| motion.on(&mesh),
            )?
        }
    }
    .ok_or_else(|| {
        CaseFailure::new(format!(
            "{} still moves faster than {speed:e} at t = {t_max}",
            scene.name
        ))
    })
}

/// Steps a motion until it has been slow for a while; `None` if it still moves at `t_max`.
fn quiet<M: ObservableMotion + ?Sized>(
    motion: &mut M,
    t_max: f64,
    is_slow: impl Fn(&M) -> bool,
    level: impl Fn(&M) -> TimeLevel,
) -> Result<Option<(f64, TimeLevel)>, RunError> {
    motion.refuse_loads("rest at a steady state")?;
    let mut moved = 0.0;
    let mut watch = |motion: &mut M, _: &StepReport| {
        let t = motion.motion().t();
        if !is_slow(motion) {
            moved = t;
        }
        Ok(if t - moved >= QUIET {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        })
    };
    run(motion, t_max, &[], &mut [&mut watch])?;
    let t = motion.motion().t();
    Ok((t - moved >= QUIET).then(|| (t, level(motion))))
}

/// All exact steady states of the scene.
pub(super) fn exact_states(scene: &Scene) -> Result<Vec<Equilibrium>, EquilibriumError> {
    equilibria(&scene.beam, scene.obstacles.as_ref())
}

/// The exact steady state nearest to the end of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The state.
    pub state: Equilibrium,
    /// Largest difference over all nodes, in u and φ.
    pub distance: f64,
    /// The same in u and in φ.
    pub errors: [f64; 2],
}

/// The largest difference of nodal values to a function.
fn largest_error(mesh: &Mesh, values: &[f64], exact: impl Fn(f64) -> f64) -> f64 {
    let pairs = mesh.nodes().iter().zip(values);
    pairs
        .map(|(&x, value)| (value - exact(x)).abs())
        .fold(0.0, max_or_nan)
}

impl Nearest {
    /// `None` if there is no state.
    fn of(
        mesh: &Mesh,
        level: &TimeLevel,
        states: impl Iterator<Item = Equilibrium>,
    ) -> Option<Self> {
        let measured = states.map(|state| {
            let errors = [
                largest_error(mesh, &level.u, |x| state.shape.u(x)),
                largest_error(mesh, &level.phi, |x| state.shape.phi(x)),
            ];
            Self {
                state,
                distance: max_or_nan(errors[0], errors[1]),
                errors,
            }
        });
        measured.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}

/// A contact state in words.
pub(super) fn name_of(contact: Phase) -> &'static str {
    match contact {
        Phase::Free => "free",
        Phase::Upper => "on the upper obstacle",
        Phase::Lower => "on the lower obstacle",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_with_loads_is_refused() {
        let text =
            "[initial]\nu_t = \"0.1*x\"\n[mesh]\nelements = 4\n[time]\ndt = 0.1\nt_end = 1.0\n";
        let mut scene = Scene::parse(text, "s.toml").expect("a scene");
        assert!(settle(&scene, 1e-2, 500.0).is_ok());
        if let Method::OneStep(stepping) = &mut scene.method {
            stepping.loaded = true;
        }
        let refused = settle(&scene, 1e-2, 500.0).expect_err("a refusal");
        assert!(
            refused
                .reason
                .starts_with("rest at a steady state: found a beam with loads"),
            "{refused:?}"
        );
    }
}
