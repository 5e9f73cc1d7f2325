//! The linearised fixed point from dense matrices of (4.2), and the solver's own linear map against
//! it.

use super::p1::{P1Matrices, blocks};
use super::system::affine;
use crate::prelude::*;
use nalgebra::{DMatrix, DVector};

/// The linearised iteration from dense matrices of (4.2), and three of its loops alone.
pub(crate) struct DenseIteration {
    /// All four loops, over (δV, δW).
    pub(crate) all: DMatrix<f64>,
    /// Over δW.
    pub(crate) heat: DMatrix<f64>,
    /// Over δV.
    pub(crate) contact: DMatrix<f64>,
    /// Over δV.
    pub(crate) axial: DMatrix<f64>,
}

pub(crate) fn spectral_radius(matrix: &DMatrix<f64>) -> f64 {
    let values = matrix.complex_eigenvalues();
    values
        .iter()
        .map(|value| value.norm())
        .fold(0.0, max_or_nan)
}

/// θ from W, then φ from θ and V, then u from φ, from its own contact force and from its own axial
/// force; the problem's u is both the old and the new level.
pub(crate) fn dense_iteration(problem: &Problem, scheme: &Scheme, dt: f64) -> DenseIteration {
    let P1Matrices {
        mass: m,
        stiffness: k,
        coupling: c,
        ..
    } = P1Matrices::new(&problem.mesh);
    let Problem {
        beam,
        obstacles,
        initial,
        ..
    } = problem;
    let n = m.nrows();
    let (kappa, s) = (scheme.inertia / dt, beam.zeta + 0.5 * dt);
    let u = DVector::from_column_slice(&initial.u[1..]);
    let bent = &k * &u;
    let axial_force = beam.beta + beam.rho * u.dot(&bent);
    // θ vanishes at the free end too.
    let of_theta = (&m * (2.0 / dt) + &k)
        .view((0, 0), (n - 1, n - 1))
        .into_owned();
    let of_phi = (&m * (kappa + s) + &k * s).lu();
    let of_u = (&m * kappa + &k * (s + 0.5 * dt * axial_force)).lu();
    let theta_of_w = of_theta
        .lu()
        .solve(&(c.transpose().rows(0, n - 1) * -beam.a))
        .unwrap();
    let phi_of_v = of_phi.solve(&(c.transpose() * s)).unwrap();
    let heat = of_phi
        .solve(&(c.columns(0, n - 1) * theta_of_w * beam.a))
        .unwrap();
    let touches = |obstacles: &Obstacles| u[n - 1] > obstacles.g2 || u[n - 1] < obstacles.g1;
    let slope = obstacles
        .filter(touches)
        .map_or(0.0, |obstacles| 1.0 / (scheme.inertia * obstacles.epsilon));
    let mut force = DMatrix::zeros(n, n);
    force[(n - 1, n - 1)] = dt * slope;
    let contact = of_u.solve(&force).unwrap();
    let axial = of_u
        .solve(&(&bent * bent.transpose() * (beam.rho * dt)))
        .unwrap();
    let u_of_phi = of_u.solve(&(&c * s)).unwrap();
    let all = blocks([
        [
            &(&u_of_phi * &phi_of_v - &contact - &axial),
            &(&u_of_phi * &heat),
        ],
        [&phi_of_v, &heat],
    ]);
    DenseIteration {
        all,
        heat,
        contact,
        axial,
    }
}

/// All loops at once, on a graded mesh: contact, rotation, heat and axial force.
fn coupled(scheme: &Scheme) -> Problem {
    let beam = Beam {
        a: 3.0,
        rho: 500.0,
        beta: 0.3,
        ..Beam::default()
    };
    let obstacles = soft(2e-3 / scheme.inertia);
    launched(
        graded(10),
        beam,
        Some(obstacles),
        [&|x| 0.15 * x * x, &|_| 0.0],
    )
}

#[test]
fn the_linearised_iteration_is_the_dense_matrix() {
    for scheme in SCHEMES {
        let (problem, dt) = (coupled(&scheme), 3e-3);
        let expected = dense_iteration(&problem, &scheme, dt).all;
        let case = problem.case(scheme, dt);
        let mut map = case.linearized_iteration(&problem.initial.u).unwrap();
        let n = map.elements();
        let (found, _) = affine(2 * n, |errors| {
            // Node 0 is clamped.
            let [mut v, mut w] = [0, n].map(|start| errors.rows(start, n).insert_row(0, 0.0));
            map.apply(v.as_mut_slice(), w.as_mut_slice());
            DVector::from_iterator(2 * n, v.iter().skip(1).chain(w.iter().skip(1)).copied())
        });
        let is_near = |difference: &f64| difference.abs() <= 1e-12 * expected.amax();
        let is_met = (&found - &expected).iter().all(is_near);
        assert!(is_met, "{}: {found} {expected}", scheme.name);
    }
}

#[test]
fn the_factor_of_each_loop_is_the_spectral_radius_of_its_dense_matrix() {
    for (scheme, dt) in SCHEMES
        .into_iter()
        .flat_map(|scheme| [1e-3, 0.1].map(|dt| (scheme, dt)))
    {
        let problem = coupled(&scheme);
        let (dense, case, u) = (
            dense_iteration(&problem, &scheme, dt),
            problem.case(scheme, dt),
            &problem.initial.u,
        );
        let n_value = case.beam.axial_force(slope_squared(&case.lengths, u));
        for (factor, matrix) in [
            (case.contact_contraction(n_value), dense.contact),
            (case.heat_contraction(), dense.heat),
            (case.axial_contraction(n_value, u), dense.axial),
        ] {
            close(factor, spectral_radius(&matrix), 1e-6 * factor);
        }
    }
}
