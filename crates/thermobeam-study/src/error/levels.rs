//! Levels of two meshes, one nested in the other: their distance, combinations, and the same functions by other nodes; distances of curves.

use convergence_study::text::number::max_or_nan;
use thermobeam::norms::TheoremSquares;
use thermobeam::solve::Level;

/// Distance of two levels of one mesh in the norm of Theorem 3.4.
pub fn distance(lengths: &[f64], a: &Level, b: &Level) -> f64 {
    let difference = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
    let [v, u, w, phi, theta] = [(&a.v, &b.v), (&a.u, &b.u), (&a.w, &b.w), (&a.phi, &b.phi), (&a.theta, &b.theta)]
        .map(|(a, b)| difference(a, b));
    TheoremSquares::of(lengths, &v, &u, &w, &phi, &theta).norm()
}

/// Largest difference of two curves at the same times; NaN where there is one, or where the curves do not match.
pub(crate) fn distance_of_curves(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() || a.is_empty() {
        return f64::NAN;
    }
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, max_or_nan)
}

fn map_fields(level: &Level, map: impl Fn(&[f64]) -> Vec<f64>) -> Level {
    Level {
        u: map(&level.u),
        v: map(&level.v),
        phi: map(&level.phi),
        w: map(&level.w),
        theta: map(&level.theta),
        contact_force: level.contact_force,
    }
}

/// `weight * a + (1 - weight) * b`, field by field.
pub fn combine(a: &Level, b: &Level, weight: f64) -> Level {
    let mix =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| weight * a + (1.0 - weight) * b).collect::<Vec<f64>>();
    Level {
        u: mix(&a.u, &b.u),
        v: mix(&a.v, &b.v),
        phi: mix(&a.phi, &b.phi),
        w: mix(&a.w, &b.w),
        theta: mix(&a.theta, &b.theta),
        contact_force: weight * a.contact_force + (1.0 - weight) * b.contact_force,
    }
}

/// Values at every `stride`-th node.
pub(crate) fn restrict(level: &Level, stride: usize) -> Level {
    map_fields(level, |y| y.iter().step_by(stride).copied().collect())
}

/// The same P1 functions by their values at the nodes of another mesh, which must contain the old nodes.
pub fn prolong(level: &Level, nodes: &[f64], fine: &[f64]) -> Level {
    map_fields(level, |y| {
        let mut left = 0;
        fine.iter()
            .map(|&x| {
                while left + 2 < nodes.len() && nodes[left + 1] <= x {
                    left += 1;
                }
                let fraction = (x - nodes[left]) / (nodes[left + 1] - nodes[left]);
                (1.0 - fraction) * y[left] + fraction * y[left + 1]
            })
            .collect()
    })
}
