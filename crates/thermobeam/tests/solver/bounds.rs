//! Bounds of Section 2 and limits of Section 3, each next to a beam that attains it.

use crate::prelude::*;
use std::f64::consts::FRAC_PI_2;

use crate::dense::P1Matrices;

/// A linear beam without heat that buckles in its lowest shape, at the speed of that shape without
/// inertia.
fn buckling(beta: f64, zeta: f64) -> Problem {
    let mesh = uniform(32);
    let k = FRAC_PI_2;
    let rate = (-beta / BUCKLING - 1.0) / zeta;
    let u = |factor: f64| {
        on_nodes(&mesh, &|x| {
            factor * (1.0 + k * k) / k * (1.0 - (k * x).cos())
        })
    };
    let phi = |factor: f64| on_nodes(&mesh, &|x| factor * (k * x).sin());
    let initial = InitialValues {
        u: u(1.0),
        u_t: u(rate),
        phi: phi(1.0),
        phi_t: phi(rate),
        ..InitialValues::at_rest(&mesh, 0.0)
    };
    let beam = Beam {
        zeta,
        a: 0.0,
        rho: 0.0,
        beta,
        theta_a: 0.0,
    };
    Problem {
        beam,
        obstacles: None,
        mesh,
        initial,
    }
}

/// The growth of √(2D) until t, over `exp(β² t/(4ζB²))`.
fn share_of_bound(beta: f64, zeta: f64) -> f64 {
    let problem = buckling(beta, zeta);
    let (dt, steps) = (0.02, 1000);
    let size = |steps: usize| {
        let level = after(&problem, stepping(dt), steps);
        distance(&problem.mesh, &level, &TimeLevel::new(level.u.len()))
    };
    let t = dt * steps as f64;
    size(steps) / size(0) / (beta.powi(2) * t / (4.0 * zeta * BUCKLING.powi(2))).exp()
}

/// Two solutions of a linear beam differ by a solution. Without inertia the lowest shape grows at
/// the rate (b - 1)/ζ, b = -β/B, and the bound of Theorem 2.6 at b²/(4ζ), the same for b = 2.
#[test]
fn a_buckling_beam_attains_the_bound_of_two_solutions() {
    for (zeta, least) in [(10.0, 0.97), (20.0, 0.99)] {
        let share = share_of_bound(-2.0 * BUCKLING, zeta);
        assert!((least..=1.0).contains(&share), "ζ = {zeta}: {share}");
    }
    for factor in [1.5, 2.5] {
        let share = share_of_bound(-factor * BUCKLING, 10.0);
        assert!((0.8..0.99).contains(&share), "β = -{factor} B: {share}");
    }
}

/// The smallest eigenvalue, against the mass matrices, of dt times the symmetric part of the matrix
/// of a linear step in the velocities of u and φ: `κM + σ(shear and bending) + m dt/2 K`, κ = 1/dt.
fn lowest_eigenvalue(elements: usize, zeta: f64, axial: f64, dt: f64) -> f64 {
    let beam = P1Matrices::new(&uniform(elements));
    let mass = beam.mass_of_both();
    let elastic = beam.stiffness_form(0.0);
    let with_axial = beam.stiffness_form(axial);
    let sigma = zeta + 0.5 * dt;
    let step = &mass / dt + &elastic * sigma + (with_axial - &elastic) * (0.5 * dt);
    let inverse = mass.cholesky().expect("definite").l();
    let inverse = inverse.try_inverse().expect("regular");
    let pencil = &inverse * step * inverse.transpose() * dt;
    pencil.symmetric_eigenvalues().min()
}

/// Up to the limit 2ζB/(-B - m) of THEORY.md the form without inertia is not negative, which leaves
/// the 1 of κM; inertia allows somewhat more, and then the step can be singular, on any mesh.
#[test]
fn the_linear_step_is_definite_up_to_its_limit_and_not_far_beyond() {
    let (zeta, axial) = (0.1, -0.9);
    let limit = 2.0 * zeta * BUCKLING / (-BUCKLING - axial);
    for elements in [20, 40] {
        for (dt, expected, within) in [
            (limit, 1.0, 1e-3),
            (1.5, 0.50, 0.005),
            (2.0, -0.24, 0.01),
            (5.0, -12.4, 0.1),
        ] {
            let lowest = lowest_eigenvalue(elements, zeta, axial, dt);
            let case = format!("{elements} elements, dt = {dt}");
            near(case, lowest, expected, within);
        }
    }
}

/// A ρ_0 of Theorem 2.8 that did not depend on the data would be every ρ: λ times the data and the
/// obstacles with ρ/λ² have λ times the solution. For λ = 4 all bits are the same.
#[test]
fn four_times_the_data_with_a_sixteenth_of_rho_are_four_times_the_solution() {
    let problem = paper(uniform(20), (-0.8, 20.0));
    let mut scaled = problem.clone();
    scaled.beam.rho /= 16.0;
    scaled.beam.theta_a *= 4.0;
    let obstacles = scaled.obstacles.as_mut().expect("obstacles");
    obstacles.g1 *= 4.0;
    obstacles.g2 *= 4.0;
    let InitialValues {
        u,
        u_t,
        phi,
        phi_t,
        theta,
    } = &mut scaled.initial;
    for field in [u, u_t, phi, phi_t, theta] {
        field.iter_mut().for_each(|value| *value *= 4.0);
    }
    let stepping = with(EULER_CRANK_NICOLSON, below(1e-300), 1e-3);
    let [one, four] = [&problem, &scaled].map(|problem| after(problem, stepping, 300));
    assert!(one.contact_force > 0.0, "no contact");
    let quarter = fields(&four).concat().into_iter().map(|value| value / 4.0);
    assert_eq!(quarter.collect::<Vec<_>>(), fields(&one).concat());
}
