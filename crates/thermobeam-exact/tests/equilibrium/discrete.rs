//! Steady states and their stability against a discretisation with P1 elements.

use super::{scenes, states};
use crate::p1::P1Matrices;
use crate::prelude::*;
use nalgebra::{DMatrix, DVector};

fn interpolate(p1: &P1Matrices, u: impl Fn(f64) -> f64, phi: impl Fn(f64) -> f64) -> DVector<f64> {
    let n = p1.elements;
    let node = |i: usize| (i + 1) as f64 / n as f64;
    DVector::from_fn(
        2 * n,
        |i, _| if i < n { u(node(i)) } else { phi(node(i - n)) },
    )
}

/// First and second variation of the potential energy.
fn variations(
    p1: &P1Matrices,
    beam: &Beam,
    obstacles: Option<&Obstacles>,
    state: &DVector<f64>,
) -> (DVector<f64>, DMatrix<f64>) {
    let n = p1.elements;
    let u = state.rows(0, n);
    let bend = &p1.stiffness * u;
    let axial = beam.beta + beam.rho * bend.dot(&u);
    let mut second = p1.stiffness_form(axial);
    let mut first = &second * state;
    // The integrals of the hats: h inside, h/2 at the tip.
    let hat = |i: usize| (if i + 1 == n { 0.5 } else { 1.0 }) / n as f64;
    (0..n).for_each(|i| first[n + i] -= beam.a * beam.theta_a * hat(i));
    let mut block = second.view_mut((0, 0), (n, n));
    block += &bend * bend.transpose() * (2.0 * beam.rho);
    if let Some(o) = obstacles {
        let tip = u[n - 1];
        first[n - 1] += ((tip - o.g2).max(0.0) - (o.g1 - tip).max(0.0)) / o.epsilon;
        if tip > o.g2 || tip < o.g1 {
            second[(n - 1, n - 1)] += 1.0 / o.epsilon;
        }
    }
    (first, second)
}

/// Tip of the discrete state on n elements by Newton's method from the exact state, and its number
/// of negative eigenvalues.
fn discrete_state(
    beam: &Beam,
    obstacles: Option<&Obstacles>,
    state: &Equilibrium,
    n: usize,
) -> (f64, usize) {
    let discrete = P1Matrices::new(&uniform(n));
    let mut x = interpolate(&discrete, |x| state.shape.u(x), |x| state.shape.phi(x));
    for _ in 0..20 {
        let (first, second) = variations(&discrete, beam, obstacles, &x);
        let step = second.lu().solve(&first).expect("regular second variation");
        x -= &step;
        if step.amax() <= 1e-11 * (1.0 + x.amax()) {
            let (_, second) = variations(&discrete, beam, obstacles, &x);
            let negative = second
                .symmetric_eigenvalues()
                .iter()
                .filter(|e| **e < 0.0)
                .count();
            return (x[n - 1], negative);
        }
    }
    panic!("Newton's method does not settle near {state:?}");
}

#[test]
fn discrete_states_converge_at_second_order_and_have_as_many_unstable_directions() {
    for (beam, obstacles) in scenes() {
        for state in states(&beam, obstacles.as_ref()) {
            // Shorter waves need finer meshes than dense matrices allow.
            if state.n_value < -0.985 {
                continue;
            }
            let at = |n| discrete_state(&beam, obstacles.as_ref(), &state, n);
            let ((coarse, _), (fine, negative)) = (at(32), at(64));
            let errors = (coarse - state.u_tip, fine - state.u_tip);
            let rate = (errors.0 / errors.1).log2();
            let floor = 1e-10 * (1.0 + state.u_tip.abs());
            assert!(
                errors.1.abs() <= floor || (1.85..2.15).contains(&rate),
                "{beam:?} {state:?} {errors:?}"
            );
            // At a state that touches without pressing, the second variation does not exist.
            let touches = obstacles.is_some_and(|o| state.u_tip == o.g1 || state.u_tip == o.g2);
            if !touches {
                assert_eq!(
                    state.unstable_directions,
                    Some(negative),
                    "{beam:?} {state:?}"
                );
                assert_eq!(state.stable, negative == 0);
            }
        }
    }
}
