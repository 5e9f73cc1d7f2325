//! One scene on one mesh a case: run to rest, and the exact stable state next to where it ends.

use convergence_study::study::{Case, CaseFailure};

use super::{End, EndStates, Fields, OnMesh};
use crate::kinds::steady::{at_resolution, exact_states, nearest, settle};

/// About when beams come to rest.
const REST: f64 = 200.0;

pub(super) fn cases(study: &EndStates) -> Vec<Case<OnMesh>> {
    let places = (0..study.scenes.len()).flat_map(|scene| study.elements.iter().map(move |&n| (scene, n)));
    let case = |(scene, elements): (usize, usize)| Case {
        label: format!("{}, n = {elements}", study.scenes[scene].name),
        cost: REST / study.dt * elements as f64,
        data: OnMesh { scene, elements },
    };
    places.map(case).collect()
}

pub(super) fn run(study: &EndStates, OnMesh { scene, elements }: OnMesh) -> Result<End, CaseFailure> {
    let scene = at_resolution(&study.scenes[scene], elements, study.dt)?;
    let end = settle(&scene, study.speed, study.t_max)?;
    let stable: Vec<_> = exact_states(&scene)?.into_iter().filter(|state| state.stable).collect();
    let none = || CaseFailure { reason: "there is no stable steady state".to_owned() };
    let (state, (u, phi)) = nearest(&scene.mesh, &end.level, &stable).ok_or_else(none)?;
    Ok(End {
        t: end.t,
        tip: Fields { u: end.level.u[elements], phi: end.level.phi[elements] },
        exact_tip: Fields { u: state.u_tip, phi: state.phi_tip },
        contact: state.contact,
        error: Fields { u, phi },
    })
}
