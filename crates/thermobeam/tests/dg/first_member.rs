//! For q = 0 and p = 1 the family begins with (3.7)-(3.8), with three differences.

use crate::prelude::*;
use crate::scenes;

/// Largest difference of a nodal value of u, φ and their velocities between the first member and
/// the paper's scheme, after `steps` steps to t = 0.2.
fn difference(beam: Beam, steps: usize) -> f64 {
    let (dt, mesh) = (
        0.2 / steps as f64,
        Mesh::mapped(9, |s| 0.4 * s + 0.6 * s * s).unwrap(),
    );
    let problem = DgProblem {
        beam,
        obstacles: None,
        mesh: mesh.clone(),
        ..experiment((0.0, 0.0), 1)
    };
    let stepping = with(EULER_CRANK_NICOLSON, below(1e-14), dt);
    let level = after(&on_mesh(&problem, mesh.clone()), stepping, steps);
    let mut simulation = of_any_order(problem, equal_steps(0, dt));
    for _ in 0..steps {
        simulation.step(f64::INFINITY).unwrap();
    }
    let fields = [Field::U, Field::Phi, Field::V, Field::W];
    scenes::difference(&simulation, &level, &fields)
}

#[test]
fn without_its_three_other_rules_the_first_member_is_the_papers_scheme() {
    // No contact, N constant, no coupling with the temperature.
    for beta in [-0.5, 0.0, 5.0] {
        let beam = Beam {
            beta,
            rho: 0.0,
            a: 0.0,
            ..Beam::default()
        };
        let found = difference(beam, 100);
        assert!(found < 1e-11, "beta = {beta}: {found:e}");
    }
}

#[test]
fn the_three_other_rules_are_a_difference_of_first_order() {
    let beam = Beam {
        a: 0.5,
        rho: 2.0,
        beta: 0.3,
        ..Beam::default()
    };
    let differences = [400, 800].map(|steps| difference(beam, steps));
    close(rate(differences), 1.0, 0.1);
}
