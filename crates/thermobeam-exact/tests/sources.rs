//! Loads against the weak form of (1.1) and (1.3), which the solution satisfies for every hat function.

use thermobeam::mesh::Mesh;
use thermobeam::parameters::Beam;
use thermobeam_exact::expression::{Expression, Variable};
use thermobeam_exact::solution::{Factors, Manufactured, Product};
use thermobeam_exact::sources::{BoundaryLoads, Nodal, Sources};

const TIME: f64 = 0.7;
const FORCE: f64 = -0.3;
const BEAM: Beam = Beam { zeta: 0.4, a: 0.6, rho: 1.5, beta: -0.2, theta_a: 0.0 };

fn exact() -> Manufactured {
    let product = |x: &str, t: &str| Product {
        x: Expression::parse(x, Variable::X).unwrap().into(),
        t: Expression::parse(t, Variable::T).unwrap().into(),
    };
    Manufactured {
        u: vec![product("sin(2*x)", "cos(2*t)"), product("x^2", "1 + t^3")],
        phi: vec![product("x*exp(x)", "exp(-t)"), product("sin(5*x)", "t^2")],
        theta: vec![product("x*(1-x)", "1 - t^2"), product("sin(3*pi*x)", "exp(t)")],
    }
}

fn mesh() -> Mesh {
    Mesh::from_nodes(vec![0.0, 0.2, 0.25, 0.4, 0.6, 0.8, 1.0]).unwrap()
}

/// Value and slope in x of each product of a field.
type Shape<'a> = dyn Fn(&[Product], usize, f64) -> [f64; 2] + 'a;

/// Value and slope at x of the j-th time derivative of a field.
fn field(products: &[Product], shape: &Shape<'_>, x: f64, j: usize) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (k, product) in products.iter().enumerate() {
        let rate = product.t.derivatives(TIME)[j];
        let [value, slope] = shape(products, k, x);
        sum = [sum[0] + rate * value, sum[1] + rate * slope];
    }
    sum
}

/// The weak form, by the midpoint rule on many panels of each element, and N(u).
fn weak_form(exact: &Manufactured, mesh: &Mesh, shape: &Shape<'_>) -> (Vec<[f64; 3]>, f64) {
    const PANELS: usize = 4000;
    let Beam { zeta, a, .. } = BEAM;
    let points: Vec<(usize, f64, f64, f64)> = mesh
        .nodes()
        .windows(2)
        .enumerate()
        .flat_map(|(i, ends)| {
            let h = ends[1] - ends[0];
            (0..PANELS).map(move |k| {
                let s = (k as f64 + 0.5) / PANELS as f64;
                (i, ends[0] + s * h, s, h)
            })
        })
        .collect();
    let stretch: f64 =
        points.iter().map(|&(_, x, _, h)| field(&exact.u, shape, x, 0)[1].powi(2) * h / PANELS as f64).sum();
    let n_value = BEAM.beta + BEAM.rho * stretch;
    let mut load = vec![[0.0; 3]; mesh.nodes().len()];
    for (i, x, s, h) in points {
        let of = |products: &[Product], j: usize| field(products, shape, x, j);
        let ([_, u_x], [_, u_xt], [u_tt, _]) = (of(&exact.u, 0), of(&exact.u, 1), of(&exact.u, 2));
        let ([phi, phi_x], [phi_t, phi_xt], [phi_tt, _]) = (of(&exact.phi, 0), of(&exact.phi, 1), of(&exact.phi, 2));
        let ([_, theta_x], [theta_t, _]) = (of(&exact.theta, 0), of(&exact.theta, 1));
        let shear = u_x - phi + zeta * (u_xt - phi_t);
        for (node, hat, hat_x) in [(i, 1.0 - s, -1.0 / h), (i + 1, s, 1.0 / h)] {
            let terms = [
                u_tt * hat + (n_value * u_x + shear) * hat_x,
                phi_tt * hat + (phi_x + zeta * phi_xt) * hat_x - shear * hat + a * theta_x * hat,
                theta_t * hat + theta_x * hat_x + a * phi_xt * hat,
            ];
            for (load, term) in load[node].iter_mut().zip(terms) {
                *load += term * h / PANELS as f64;
            }
        }
    }
    let tip = load.len() - 1;
    load[tip][0] += FORCE;
    (load, n_value)
}

fn factors(exact: &Manufactured) -> Factors {
    let mut factors = Factors::default();
    factors.at(exact, TIME);
    factors
}

/// The loads; the equation of the temperature holds only at the inner nodes.
fn fill(sources: &Sources, loads: BoundaryLoads) -> Vec<[f64; 3]> {
    let factors = factors(&exact());
    let mut load = vec![[f64::NAN; 3]; mesh().nodes().len()];
    sources.fill(&factors, sources.axial_force(&factors.u.value), FORCE, loads, &mut load);
    load
}

fn near(found: &[[f64; 3]], expected: &[[f64; 3]], tolerance: f64) {
    let last = found.len() - 1;
    for node in 1..=last {
        for equation in 0..if node < last { 3 } else { 2 } {
            let (found, expected) = (found[node][equation], expected[node][equation]);
            assert!((found - expected).abs() < tolerance, "node {node}, equation {equation}: {found}, not {expected}");
        }
    }
}

#[test]
fn sources_from_the_strong_form_are_those_of_the_weak_form() {
    let (exact, mesh) = (exact(), mesh());
    let shape = |products: &[Product], k: usize, x: f64| {
        let [value, slope, _] = products[k].x.derivatives(x);
        [value, slope]
    };
    let (expected, n_value) = weak_form(&exact, &mesh, &shape);
    let sources = Sources::strong(&exact, &BEAM, &mesh);
    assert!((sources.axial_force(&factors(&exact).u.value) - n_value).abs() < 1e-6);
    near(&fill(&sources, BoundaryLoads::Both), &expected, 1e-6);
}

#[test]
fn sources_from_the_matrices_are_those_of_the_weak_form_of_the_interpolant() {
    let (exact, mesh) = (exact(), mesh());
    let shape = |products: &[Product], k: usize, x: f64| {
        let nodes = mesh.nodes();
        let i = (nodes.partition_point(|&node| node <= x) - 1).min(nodes.len() - 2);
        let [left, right] = [nodes[i], nodes[i + 1]].map(|x| products[k].x.eval(x));
        let slope = (right - left) / (nodes[i + 1] - nodes[i]);
        [left + slope * (x - nodes[i]), slope]
    };
    let (expected, n_value) = weak_form(&exact, &mesh, &shape);
    let sources = Sources::discrete(&exact, &BEAM, &mesh);
    assert!((sources.axial_force(&factors(&exact).u.value) - n_value).abs() < 1e-10);
    near(&fill(&sources, BoundaryLoads::Both), &expected, 1e-6);
}

#[test]
fn omitting_a_boundary_load_removes_the_stress_or_the_moment_at_the_tip() {
    let (exact, mesh) = (exact(), mesh());
    let sources = Sources::strong(&exact, &BEAM, &mesh);
    let whole = fill(&sources, BoundaryLoads::Both);
    let at_the_end = |products: &[Product], k: usize, j: usize| -> f64 {
        products.iter().map(|p| p.x.derivatives(1.0)[k] * p.t.derivatives(TIME)[j]).sum()
    };
    let Manufactured { u, phi, .. } = &exact;
    let n_value = sources.axial_force(&factors(&exact).u.value);
    let shear = |j| at_the_end(u, 1, j) - at_the_end(phi, 0, j);
    let stress = n_value * at_the_end(u, 1, 0) + shear(0) + BEAM.zeta * shear(1) + FORCE;
    let moment = at_the_end(phi, 1, 0) + BEAM.zeta * at_the_end(phi, 1, 1);
    for (loads, equation, dropped) in
        [(BoundaryLoads::WithoutStress, 0, stress), (BoundaryLoads::WithoutMoment, 1, moment)]
    {
        let mut expected = whole.clone();
        expected[6][equation] -= dropped;
        near(&fill(&sources, loads), &expected, 1e-12);
    }
    let tip: f64 = at_the_end(u, 0, 0);
    assert!((sources.tip(&factors(&exact).u.value) - tip).abs() < 1e-15);
}

#[test]
fn nodal_values_are_exact_and_zero_at_the_clamped_end() {
    let mesh = mesh();
    let mut exact = exact();
    // sin(1000π(x + 1)) is 1e-13 at x = 0.
    exact.u[0].x = Expression::parse("sin(1000*pi*(x+1))", Variable::X).unwrap().into();
    assert_ne!(exact.u[0].x.eval(0.0), 0.0);
    let nodal = Nodal::of(&exact, &mesh);
    for (products, values) in [(&exact.u, &nodal.u), (&exact.phi, &nodal.phi), (&exact.theta, &nodal.theta)] {
        assert_eq!(products.len(), values.len());
        for (product, values) in products.iter().zip(values) {
            assert_eq!(values[0], 0.0);
            let expected: Vec<f64> = mesh.nodes()[1..].iter().map(|&x| product.x.eval(x)).collect();
            assert_eq!(values[1..], expected);
        }
    }
    exact.theta[0].x = Expression::parse("1e-9 + x", Variable::X).unwrap().into();
    assert_eq!(Nodal::of(&exact, &mesh).theta[0][0], 1e-9);
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
        assert_eq!([factors.value.len(), factors.rate.len(), factors.acceleration.len()], [count; 3]);
    }
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
    near(middle.u.value[1], 0.5 * (before + after));
    near(middle.u.rate[1], expected);
    near(middle.u.acceleration[1], (expected - rate) * inertia / dt);
    // The new velocity is 2 V - v_old by the midpoint rule.
    near(new.u.rate[1], 2.0 * expected - rate);
}
