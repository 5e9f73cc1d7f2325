//! One scene on one mesh a case: run to rest, and the exact stable state next to where it ends.

use convergence_study::study::{Case, CaseFailure};

use thermobeam::mesh::Mesh;
use thermobeam::solve::Level;

use super::{AnyOrder, End, EndStates, Fields, OnMesh};
use crate::error::reference::Reference;
use crate::kinds::steady::{Rest, at_resolution, exact_states, nearest, settle};
use crate::scene::Scene;

/// About when beams come to rest.
const REST: f64 = 200.0;

/// Elements on which a run of any order is compared with the exact state.
const COMPARED: usize = 64;

pub(super) fn cases(study: &EndStates) -> Vec<Case<OnMesh>> {
    let linear = |(scene, elements): (usize, usize)| Case {
        label: format!("{}, n = {elements}", study.scenes[scene].name),
        cost: REST / study.dt * elements as f64,
        data: OnMesh { scene, elements: Some(elements) },
    };
    let places = (0..study.scenes.len()).flat_map(|scene| study.elements.iter().map(move |&n| (scene, n)));
    let any_order = study.any_order.iter().flat_map(|AnyOrder { how, t_end, .. }| {
        study.scenes.iter().enumerate().map(move |(scene, of)| Case {
            label: format!("{}, {}", of.name, how.label()),
            cost: how.cost(*t_end),
            data: OnMesh { scene, elements: None },
        })
    });
    places.map(linear).chain(any_order).collect()
}

pub(super) fn run(study: &EndStates, OnMesh { scene, elements }: OnMesh) -> Result<End, CaseFailure> {
    let scene = &study.scenes[scene];
    match (elements, &study.any_order) {
        (Some(elements), _) => {
            let scene = at_resolution(scene, elements, study.dt)?;
            let Rest { t, level } = settle(&scene, study.speed, study.t_max)?;
            end(&scene, &scene.mesh, t, &level)
        }
        (None, Some(AnyOrder { how, t_end, .. })) => {
            let found = Reference::compute(scene, how, Mesh::uniform(COMPARED)?, *t_end, 1, 0)?;
            let none = || CaseFailure { reason: "the run has no end".to_owned() };
            end(scene, &found.mesh, *t_end, found.levels.last().ok_or_else(none)?)
        }
        (None, None) => Err(CaseFailure { reason: "no run of any order is asked for".to_owned() }),
    }
}

/// The end of a run, and the stable state next to it.
fn end(scene: &Scene, mesh: &Mesh, t: f64, level: &Level) -> Result<End, CaseFailure> {
    let stable: Vec<_> = exact_states(scene)?.into_iter().filter(|state| state.stable).collect();
    let none = || CaseFailure { reason: "there is no stable steady state".to_owned() };
    let (state, (u, phi)) = nearest(mesh, level, &stable).ok_or_else(none)?;
    Ok(End {
        t,
        tip: Fields { u: level.u[mesh.elements()], phi: level.phi[mesh.elements()] },
        exact_tip: Fields { u: state.u_tip, phi: state.phi_tip },
        contact: state.contact,
        error: Fields { u, phi },
    })
}
