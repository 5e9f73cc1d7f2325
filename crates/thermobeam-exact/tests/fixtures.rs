//! What several tests need: meshes, integrals, comparisons.

use thermobeam::mesh::Mesh;
use thermobeam_exact::expression::{Expression, Variable};
use thermobeam_exact::solution::Product;

#[track_caller]
pub(crate) fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected} to {tolerance:e}"
    );
}

pub(crate) fn uniform(elements: usize) -> Mesh {
    Mesh::uniform(elements).expect("a uniform mesh")
}

/// ∫₀¹ f by Simpson's rule.
pub(crate) fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let n = 4000;
    let weight = |i: i32| {
        if i == 0 || i == n {
            1.0
        } else {
            f64::from(2 + 2 * (i % 2))
        }
    };
    (0..=n)
        .map(|i| weight(i) * f(f64::from(i) / f64::from(n)))
        .sum::<f64>()
        / (3.0 * f64::from(n))
}

/// X(x) T(t) of these texts.
#[track_caller]
pub(crate) fn product(x: &str, t: &str) -> Product {
    let parse = |text, variable| Expression::parse(text, variable).unwrap().into();
    Product {
        x: parse(x, Variable::X),
        t: parse(t, Variable::T),
    }
}

/// The derivative of a sum of products, of the order k in x and j in t.
pub(crate) fn derivative(products: &[Product], (x, k): (f64, usize), (t, j): (f64, usize)) -> f64 {
    let terms = products.iter();
    terms
        .map(|product| product.x.derivatives(x)[k] * product.t.derivatives(t)[j])
        .sum()
}
