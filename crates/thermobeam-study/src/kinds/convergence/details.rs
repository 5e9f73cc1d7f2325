//! What a convergence study does, for `explain`.

use convergence_study::study::Axis;

use super::Convergence;
use crate::kinds::terms;

pub(super) fn details(study: &Convergence) -> Vec<(String, String)> {
    let orders = study.expect.iter().map(|expectation| {
        let (norm, order, tolerance) = (expectation.norm, expectation.order, expectation.tolerance);
        (format!("{}, order {order} ± {tolerance}", norm.name()), format!("{}.", terms::text(norm)))
    });
    [("what is done".to_owned(), design(study))].into_iter().chain(orders).collect()
}

/// What is refined, and why the other error does not disturb.
fn design(study: &Convergence) -> String {
    let refine = &study.refine;
    let what = match (refine.axis, refine.isolate) {
        (Axis::Space, true) => {
            "The mesh is refined. The exact solution is replaced by its own time sequence and the loads by the scheme's \
             time-discrete operator on it, so that the time error is exactly zero and few steps are enough."
        }
        (Axis::Space, false) => {
            "The mesh is refined; the time step is fixed, and its error must be far below that of the mesh."
        }
        (Axis::Time, true) => {
            "The time step is refined. The exact solution is replaced by its interpolant and the loads use the discrete \
             matrices, so that the space error is exactly zero and a coarse mesh is enough."
        }
        (Axis::Time, false) => {
            "The time step is refined; the mesh is fixed, and its error must be far below that of the steps."
        }
        (Axis::Both, _) if refine.grid => {
            "All combinations of meshes and time steps. With e^2 = A(h)^2 + B(dt)^2 the differences over h at the finest \
             time step hold nothing of B, and those over dt on the finest mesh nothing of A: each order by itself."
        }
        (Axis::Both, _) => "Mesh and time step are refined together: the theorem as it stands.",
    };
    let control = study.control.as_ref().map_or(String::new(), |control| {
        let changed = control.changed.join(", ");
        format!(" The solver differs from the sources in {changed}: a negative control, which must fail.")
    });
    format!("{what} {} levels; scheme {}.{control}", refine.cases().len(), refine.scheme.name)
}
