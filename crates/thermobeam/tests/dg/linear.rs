//! The linear beam against the matrix exponential of its matrices.

use super::scenes::{advanced, close, equal_steps};
use crate::p1_matrices::P1Matrices;
use nalgebra::{DMatrix, DVector};
use thermobeam::dg::{DgProblem, Field, InitialFunctions};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::Beam;

const BEAM: Beam = Beam {
    zeta: 0.1,
    a: 0.5,
    rho: 0.0,
    beta: -0.3,
    theta_a: 3.0,
};
const ELEMENTS: usize = 5;

/// `y' = A y + b` for y = (u, φ, v, w, θ~) at the nodes 1..=n, θ~ without the last.
fn system() -> (DMatrix<f64>, DVector<f64>) {
    let beam = P1Matrices::new(&Mesh::uniform(ELEMENTS).unwrap());
    let n = beam.elements;
    let (m, k, c) = (&beam.mass, &beam.stiffness, &beam.coupling);
    let inverse = m.clone().try_inverse().unwrap();
    let inner = m
        .view((0, 0), (n - 1, n - 1))
        .into_owned()
        .try_inverse()
        .unwrap();
    let mut a = DMatrix::zeros(5 * n - 1, 5 * n - 1);
    let identity = DMatrix::identity(n, n);
    for field in 0..2 {
        a.view_mut((field * n, (2 + field) * n), (n, n))
            .copy_from(&identity);
    }
    // Rows v and w: from (u, φ) and, times ζ, from (v, w).
    let (place, rate) = (
        beam.stiffness_form(BEAM.beta),
        beam.stiffness_form(0.0) * BEAM.zeta,
    );
    for row in 0..2 {
        for (column, form) in [&place, &rate].into_iter().enumerate() {
            let rows = &inverse * form.rows(row * n, n);
            a.view_mut(((2 + row) * n, 2 * column * n), (n, 2 * n))
                .copy_from(&-rows);
        }
    }
    let from_heat = &inverse * c.columns(0, n - 1) * BEAM.a;
    a.view_mut((3 * n, 4 * n), (n, n - 1)).copy_from(&from_heat);
    let turning = &inner * c.transpose().rows(0, n - 1) * BEAM.a;
    a.view_mut((4 * n, 3 * n), (n - 1, n)).copy_from(&-turning);
    let conduction = &inner * k.view((0, 0), (n - 1, n - 1));
    a.view_mut((4 * n, 4 * n), (n - 1, n - 1))
        .copy_from(&-conduction);
    let h = 1.0 / n as f64;
    let integrals = DVector::from_fn(n, |i, _| if i + 1 == n { 0.5 * h } else { h });
    let mut b = DVector::zeros(5 * n - 1);
    b.rows_mut(3 * n, n)
        .copy_from(&(inverse * integrals * BEAM.a * BEAM.theta_a));
    (a, b)
}

fn initial() -> InitialFunctions {
    InitialFunctions {
        u: Box::new(|x| 0.1 * x * x),
        u_t: Box::new(|x| 3.0 * x * (1.0 - x)),
        phi: Box::new(|x| 0.2 * x),
        phi_t: Box::new(|x| (3.0 * x).sin()),
        theta: Box::new(|x| 3.0 * (1.0 - x) + 4.0 * x * (1.0 - x)),
    }
}

#[test]
fn steps_of_every_degree_lead_to_the_matrix_exponential() {
    let t = 0.5;
    let (a, b) = system();
    let size = b.len();
    let mut augmented = DMatrix::zeros(size + 1, size + 1);
    augmented.view_mut((0, 0), (size, size)).copy_from(&a);
    augmented.view_mut((0, size), (size, 1)).copy_from(&b);
    let start = initial();
    let nodes: Vec<f64> = (1..=ELEMENTS).map(|i| i as f64 / ELEMENTS as f64).collect();
    let mut y: Vec<f64> = vec![];
    for f in [&start.u, &start.phi, &start.u_t, &start.phi_t] {
        y.extend(nodes.iter().map(|x| f(*x)));
    }
    y.extend(
        nodes[..ELEMENTS - 1]
            .iter()
            .map(|x| (start.theta)(*x) - BEAM.theta_a * (1.0 - x)),
    );
    y.push(1.0);
    let end = (augmented * t).exp() * DVector::from_vec(y);
    for (q, steps, tolerance) in [
        (1, 400, 1e-7),
        (2, 100, 2e-9),
        (3, 100, 1e-11),
        (4, 50, 1e-11),
        (5, 40, 1e-11),
    ] {
        let mesh = Mesh::uniform(ELEMENTS).unwrap();
        let problem = DgProblem {
            beam: BEAM,
            obstacles: None,
            mesh,
            degree: 1,
            initial: initial(),
        };
        let simulation = advanced(problem, equal_steps(q, t / steps as f64), t);
        for (block, field) in [Field::U, Field::Phi, Field::V, Field::W, Field::Theta]
            .into_iter()
            .enumerate()
        {
            let count = if field == Field::Theta {
                ELEMENTS - 1
            } else {
                ELEMENTS
            };
            for i in 0..count {
                let found = simulation.value(field, nodes[i], t).expect("the end");
                close(found, end[block * ELEMENTS + i], tolerance);
            }
        }
    }
}
