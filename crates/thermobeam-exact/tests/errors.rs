//! The error meter against an independent quadrature.

use crate::prelude::*;
use thermobeam::dg::DgLevel;
use thermobeam::solve::TimeLevel;
use thermobeam_exact::any_order;
use thermobeam_exact::errors::ErrorMeter;
use thermobeam_exact::norm::Norm;

/// The root of `∫ f²` over [0, 1], by the midpoint rule on many panels of each element.
fn l2_norm(mesh: &Mesh, f: impl Fn(usize, f64) -> f64) -> f64 {
    const PANELS: usize = 2000;
    let on_element = |(i, ends): (usize, &[f64])| {
        let h = (ends[1] - ends[0]) / PANELS as f64;
        (0..PANELS)
            .map(|k| f(i, ends[0] + (k as f64 + 0.5) * h).powi(2) * h)
            .sum::<f64>()
    };
    mesh.nodes()
        .windows(2)
        .enumerate()
        .map(on_element)
        .sum::<f64>()
        .sqrt()
}

fn exact() -> Manufactured {
    Manufactured {
        u: vec![product("sin(2*x)", "cos(t)"), product("x^2", "1 + t")],
        phi: vec![product("x*exp(x)", "exp(-t)"), product("sin(5*x)", "t^2")],
        theta: vec![product("cos(3*x)", "1 - t^2")],
    }
}

fn mesh() -> Mesh {
    Mesh::from_nodes(vec![0.0, 0.3, 0.45, 1.0]).unwrap()
}

/// Those of a level of zeros are norms of the solution.
#[test]
fn the_errors_of_any_order_agree_with_fine_quadrature() {
    let (exact, t) = (exact(), 0.7);
    let space = Space::new(mesh(), 4).unwrap();
    let level = DgLevel {
        t,
        ..DgLevel::new(&space)
    };
    let found = any_order::ErrorMeter::new(&exact, 0.0, &space).errors(&level);
    let Manufactured { u, phi, theta } = &exact;
    let fields = [(u, 0), (phi, 0), (u, 1), (phi, 1), (theta, 0)];
    for (k, found) in found.iter().enumerate() {
        for ((products, j), found) in fields.iter().zip(found) {
            let norm = l2_norm(space.mesh(), |_, x| derivative(products, (x, k), (t, *j)));
            assert!(
                (found / norm - 1.0).abs() < 2e-6,
                "{k}, {j}: {found} {norm}"
            );
        }
    }
}

#[test]
fn the_errors_agree_with_fine_quadrature() {
    let (exact, mesh) = (exact(), mesh());
    let (t, theta_a) = (0.7, 2.0);
    let mut factors = Factors::default();
    factors.at(&exact, t);
    let level = TimeLevel {
        u: vec![0.0, 0.5, -0.2, 1.0],
        v: vec![0.0, -1.0, 0.3, 0.4],
        phi: vec![0.0, 0.7, 0.1, 2.0],
        w: vec![0.0, 0.2, -0.6, 1.5],
        theta: vec![0.4, -0.3, 0.8, 0.0],
        contact_force: 0.0,
    };
    let value = |y: &[f64], i: usize, x: f64| {
        let [a, b] = [mesh.nodes()[i], mesh.nodes()[i + 1]];
        y[i] + (y[i + 1] - y[i]) * (x - a) / (b - a)
    };
    let slope = |y: &[f64], i: usize| (y[i + 1] - y[i]) / (mesh.nodes()[i + 1] - mesh.nodes()[i]);
    let sum = |products: &[Product], x, k, j| derivative(products, (x, k), (t, j));
    let Manufactured { u, phi, theta } = &exact;
    let parts = [
        l2_norm(&mesh, |i, x| value(&level.v, i, x) - sum(u, x, 0, 1)),
        l2_norm(&mesh, |i, x| {
            slope(&level.u, i) - value(&level.phi, i, x) - (sum(u, x, 1, 0) - sum(phi, x, 0, 0))
        }),
        l2_norm(&mesh, |i, x| value(&level.w, i, x) - sum(phi, x, 0, 1)),
        l2_norm(&mesh, |i, x| slope(&level.phi, i) - sum(phi, x, 1, 0)),
        l2_norm(&mesh, |i, x| {
            value(&level.theta, i, x) + theta_a * (1.0 - x) - sum(theta, x, 0, 0)
        }),
    ];
    let norm = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
    let displacement = l2_norm(&mesh, |i, x| value(&level.u, i, x) - sum(u, x, 0, 0));
    let mut meter = ErrorMeter::new(&exact, &mesh, false);
    meter.lift(&mesh, theta_a);
    let found = meter.measure(&level, &factors);
    for (norm, expected) in Norm::ALL
        .into_iter()
        .zip(parts.into_iter().chain([norm, displacement]))
    {
        assert!(
            (found[norm] / expected - 1.0).abs() < 2e-6,
            "{norm:?}: {} {expected}",
            found[norm]
        );
    }
    // Only nodal values enter the errors against the interpolant.
    let mut nodal = ErrorMeter::new(&exact, &mesh, true);
    nodal.lift(&mesh, theta_a);
    assert!(
        (nodal.measure(&level, &factors)[Norm::Theorem34] / found[Norm::Superclose] - 1.0).abs()
            < 1e-14
    );
}

#[test]
fn norm_names_are_those_of_the_study_files() {
    let names = Norm::ALL.map(Norm::name);
    let expected = [
        "velocity",
        "shear",
        "rotation-rate",
        "curvature",
        "temperature",
        "theorem-3.4",
        "displacement",
        "superclose",
    ];
    assert_eq!(names, expected);
}
