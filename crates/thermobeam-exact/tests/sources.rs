//! The parts of the loads: the boundary loads, the nodal values, the factors and the forces of a
//! step. `loads.rs` has the loads.

use crate::prelude::*;
use thermobeam::scheme::{ContactRule, SCHEMES};
use thermobeam_exact::any_order;
use thermobeam_exact::defect::Defect;
use thermobeam_exact::formulas::{SchemeFormulas, axial_force};
use thermobeam_exact::solution::FieldFactors;
use thermobeam_exact::sources::Nodal;

const TIME: f64 = 0.7;
const FORCE: f64 = -0.3;
const BEAM: Beam = Beam {
    zeta: 0.4,
    a: 0.6,
    rho: 1.5,
    beta: -0.2,
    theta_a: 0.0,
};

fn exact() -> Manufactured {
    Manufactured {
        u: vec![product("sin(2*x)", "cos(2*t)"), product("x^2", "1 + t^3")],
        phi: vec![product("x*exp(x)", "exp(-t)"), product("sin(5*x)", "t^2")],
        theta: vec![
            product("x*(1-x)", "1 - t^2"),
            product("sin(3*pi*x)", "exp(t)"),
        ],
    }
}

fn mesh() -> Mesh {
    Mesh::from_nodes(vec![0.0, 0.2, 0.25, 0.4, 0.6, 0.8, 1.0]).unwrap()
}

fn factors(exact: &Manufactured) -> Factors {
    let mut factors = Factors::default();
    factors.at(exact, TIME);
    factors
}

/// The loads; the equation of the temperature holds only at the inner nodes.
fn fill(sources: &Sources, defect: Option<Defect>) -> Vec<[f64; 3]> {
    let factors = factors(&exact());
    let axial = sources.forces(&factors.u, None, None).axial;
    let mut load = vec![[f64::NAN; 3]; mesh().nodes().len()];
    sources.fill(
        &factors,
        Forces {
            axial,
            contact: FORCE,
        },
        defect,
        &mut load,
    );
    load
}

fn near(found: &[[f64; 3]], expected: &[[f64; 3]], tolerance: f64) {
    let last = found.len() - 1;
    for node in 1..=last {
        for equation in 0..if node < last { 3 } else { 2 } {
            let (found, expected) = (found[node][equation], expected[node][equation]);
            assert!(
                (found - expected).abs() < tolerance,
                "node {node}, equation {equation}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn omitting_a_boundary_load_removes_the_stress_or_the_moment_at_the_tip() {
    let (exact, mesh) = (exact(), mesh());
    let sources = Sources::strong(&exact, &BEAM, &mesh);
    let whole = fill(&sources, None);
    let at_the_end = |products: &[Product], k, j| derivative(products, (1.0, k), (TIME, j));
    let Manufactured { u, phi, .. } = &exact;
    let n_value = sources.forces(&factors(&exact).u, None, None).axial;
    let shear = |j| at_the_end(u, 1, j) - at_the_end(phi, 0, j);
    let stress = n_value * at_the_end(u, 1, 0) + shear(0) + BEAM.zeta * shear(1) + FORCE;
    let moment = at_the_end(phi, 1, 0) + BEAM.zeta * at_the_end(phi, 1, 1);
    for (defect, equation, dropped) in [
        (Defect::StressDropped, 0, stress),
        (Defect::MomentDropped, 1, moment),
    ] {
        let mut expected = whole.clone();
        expected[6][equation] -= dropped;
        near(&fill(&sources, Some(defect)), &expected, 1e-12);
    }
    let tip = at_the_end(u, 0, 0);
    assert!((sources.tip(&factors(&exact).u.value) - tip).abs() < 1e-15);
}

#[test]
fn nodal_values_are_exact_and_zero_at_the_clamped_end() {
    let mesh = mesh();
    let mut exact = exact();
    // sin(1000π(x + 1)) is 1e-13 at x = 0.
    exact.u[0].x = Expression::parse("sin(1000*pi*(x+1))", Variable::X)
        .unwrap()
        .into();
    assert_ne!(exact.u[0].x.eval(0.0), 0.0);
    let nodal = Nodal::of(&exact, &mesh);
    for (products, values) in [
        (&exact.u, &nodal.u),
        (&exact.phi, &nodal.phi),
        (&exact.theta, &nodal.theta),
    ] {
        assert_eq!(products.len(), values.len());
        for (product, values) in products.iter().zip(values) {
            assert_eq!(values[0], 0.0);
            let expected: Vec<f64> = mesh.nodes()[1..]
                .iter()
                .map(|&x| product.x.eval(x))
                .collect();
            assert_eq!(values[1..], expected);
        }
    }
    exact.theta[0].x = Expression::parse("1e-9 + x", Variable::X).unwrap().into();
    assert_eq!(Nodal::of(&exact, &mesh).theta[0][0], 1e-9);
}

#[test]
fn initial_data_are_those_of_the_solution_with_the_solvers_own_temperature_at_the_end() {
    let (exact, mesh) = (exact(), mesh());
    let mut factors = Factors::default();
    factors.at(&exact, 0.0);
    let [of_exact, own] = [0.4, 1.1];
    let nodal = Nodal::of(&exact, &mesh).initial(&mesh, &factors, of_exact, own);
    let smooth = any_order::initial(&exact);
    let theta = |x: f64| x * (1.0 - x) + (3.0 * std::f64::consts::PI * x).sin();
    let lifted = |x: f64| theta(x) + (own - of_exact) * (1.0 - x);
    let last = mesh.nodes().len() - 1;
    for (node, &x) in mesh.nodes().iter().enumerate() {
        let (u, phi) = ((2.0 * x).sin() + x * x, x * x.exp());
        for (name, found, expected) in [
            ("u", nodal.u[node], u),
            ("u_t", nodal.u_t[node], 0.0),
            ("phi", nodal.phi[node], phi),
            ("phi_t", nodal.phi_t[node], -phi),
            ("u", (smooth.u)(x), u),
            ("u_t", (smooth.u_t)(x), 0.0),
            ("phi", (smooth.phi)(x), phi),
            ("phi_t", (smooth.phi_t)(x), -phi),
            ("theta", (smooth.theta)(x), theta(x)),
        ] {
            assert!((found - expected).abs() < 1e-14, "{name} at {x}: {found}");
        }
        if node > 0 && node < last {
            assert!(
                (nodal.theta[node] - lifted(x)).abs() < 1e-14,
                "theta at {x}"
            );
        }
    }
    assert_eq!([nodal.theta[0], nodal.theta[last]], [own, 0.0]);
}

#[test]
fn the_factors_of_a_step_are_those_that_the_scheme_sees() {
    let exact = exact();
    let [dt, inertia] = [0.1, 2.0];
    let [mut old, mut new, mut middle] = [(); 3].map(|()| Factors::default());
    old.at(&exact, TIME);
    new.at(&exact, TIME + dt);
    let (before, after) = (old.u.value[1], new.u.value[1]);
    let (expected, rate) = ((after - before) / dt, old.u.rate[1]);
    middle.of_step(&old, &mut new, inertia, dt);
    for (factors, count) in [(&middle.u, 2), (&middle.phi, 2), (&middle.theta, 2)] {
        assert_eq!(
            [
                factors.value.len(),
                factors.rate.len(),
                factors.acceleration.len()
            ],
            [count; 3]
        );
    }
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
    };
    near(middle.u.value[1], 0.5 * (before + after));
    near(middle.u.rate[1], expected);
    near(middle.u.acceleration[1], (expected - rate) * inertia / dt);
    // The new velocity is 2 V - v_old by the midpoint rule.
    near(new.u.rate[1], 2.0 * expected - rate);
}

#[test]
fn the_forces_of_a_step_are_those_of_both_schemes() {
    let (exact, mesh) = (exact(), mesh());
    let sources = Sources::strong(&exact, &BEAM, &mesh);
    let obstacles = Obstacles {
        epsilon: 0.03,
        g1: -0.2,
        g2: 0.3,
    };
    let Obstacles { epsilon, g1, g2 } = obstacles;
    let energy = |u: f64| ((u - g2).max(0.0).powi(2) + (g1 - u).max(0.0).powi(2)) / (2.0 * epsilon);
    let force = |u: f64| ((u - g2).max(0.0) - (g1 - u).max(0.0)) / epsilon;
    // With these factors u(1) = T_0 sin 2 + T_1, below, between and above the obstacles.
    let at = |tip: f64| {
        let first = 0.7 * tip;
        FieldFactors {
            value: vec![first, tip - first * 2.0_f64.sin()],
            ..FieldFactors::default()
        }
    };
    let tips = [-0.7, -0.25, -0.1, 0.0, 0.2, 0.35, 0.9];
    for (u0, u) in tips.into_iter().flat_map(|u0| tips.map(|u| (u0, u))) {
        let (old, new) = (at(u0), at(u));
        let mean = [&old, &new]
            .map(|factors| sources.forces(factors, None, None).axial)
            .iter()
            .sum::<f64>()
            / 2.0;
        let quotient = if u == u0 {
            force(u)
        } else {
            (energy(u) - energy(u0)) / (u - u0)
        };
        for (name, expected) in [("euler-crank-nicolson", force(u)), ("midpoint", quotient)] {
            let scheme = SchemeFormulas::of(name).unwrap();
            let Forces { axial, contact } =
                sources.forces_of_step(scheme, [&old, &new], Some(&obstacles), None);
            assert!(
                (axial - mean).abs() <= 1e-14 * mean.abs(),
                "{name}, {u0} to {u}: {axial}, not {mean}"
            );
            assert!(
                (contact - expected).abs() < 1e-12,
                "{name}, {u0} to {u}: {contact}, not {expected}"
            );
        }
    }
}

#[test]
fn the_formulas_are_those_of_the_solver_to_the_last_bit() {
    for scheme in SCHEMES {
        let formulas = SchemeFormulas::of(scheme.name).unwrap();
        assert_eq!(formulas.inertia(), scheme.inertia, "{}", scheme.name);
        let obstacles = Obstacles::default();
        let positions = (-40..40)
            .map(|k| 0.2 * (f64::from(k) * 0.7).sin())
            .chain([-0.01, 0.1])
            .collect::<Vec<_>>();
        for (&u0, &u) in positions
            .iter()
            .flat_map(|u0| positions.iter().map(move |u| (u0, u)))
        {
            let solver = match scheme.contact {
                ContactRule::Implicit => obstacles.force(u),
                ContactRule::DiscreteGradient => obstacles.discrete_gradient(u, u0),
            };
            assert_eq!(
                formulas.contact_force(&obstacles, u, u0),
                solver,
                "{}: {u0} to {u}",
                scheme.name
            );
        }
        assert!(formulas.contact_force(&obstacles, f64::NAN, 0.0).is_nan());
    }
    assert_eq!(SchemeFormulas::of("euler"), None);
    for square in [0.0, 1e-9, 0.37, 12.5] {
        assert_eq!(axial_force(&BEAM, square), BEAM.axial_force(square));
    }
}
