//! Levels on other meshes and at equidistant times, for pictures, histories and comparisons.

use thermobeam::dg::{self, DgLevel};
use thermobeam::mesh::Mesh;
use thermobeam::solve::TimeLevel;

/// Points along the beam in a picture, at most.
pub(super) const MOST_POINTS: usize = 111;

/// At most `most` of some values, evenly spaced, including both ends.
pub(super) fn thinned(values: &[f64], most: usize) -> Vec<f64> {
    if values.len() <= most {
        return values.to_vec();
    }
    let last = values.len() - 1;
    (0..most).map(|k| values[k * last / (most - 1)]).collect()
}

/// A level with each field replaced.
pub(crate) fn map_fields(level: &TimeLevel, map: impl Fn(&[f64]) -> Vec<f64>) -> TimeLevel {
    let TimeLevel {
        u,
        v,
        phi,
        w,
        theta,
        contact_force,
    } = level;
    TimeLevel {
        u: map(u),
        v: map(v),
        phi: map(phi),
        w: map(w),
        theta: map(theta),
        contact_force: *contact_force,
    }
}

/// The end of the part with number `k` from 1, if the time to `t_end` has `count` equal parts; the
/// last one is `t_end` to the last bit.
pub(crate) fn equidistant_time(t_end: f64, k: usize, count: usize) -> f64 {
    if k == count {
        t_end
    } else {
        t_end * k as f64 / count as f64
    }
}

/// The P1 functions of a level at the nodes of another mesh.
pub(crate) fn on_mesh(level: &TimeLevel, mesh: &Mesh, other: &Mesh) -> TimeLevel {
    let nodes = mesh.nodes();
    let mut elements = vec![];
    let mut left = 0;
    for &x in other.nodes() {
        while left + 2 < nodes.len() && nodes[left + 1] <= x {
            left += 1;
        }
        elements.push((left, (x - nodes[left]) / (nodes[left + 1] - nodes[left])));
    }
    map_fields(level, |y| {
        elements
            .iter()
            .map(|&(i, s)| (1.0 - s) * y[i] + s * y[i + 1])
            .collect()
    })
}

/// A level of any order by its values at the nodes, without the contact force.
pub(crate) fn nodal(space: &dg::Space, level: &DgLevel, nodes: &[f64]) -> TimeLevel {
    let mut nodal = TimeLevel {
        u: Vec::with_capacity(nodes.len()),
        v: Vec::with_capacity(nodes.len()),
        phi: Vec::with_capacity(nodes.len()),
        w: Vec::with_capacity(nodes.len()),
        theta: Vec::with_capacity(nodes.len()),
        contact_force: 0.0,
    };
    for &x in nodes {
        let [u, phi, v, w, theta] = level.values_and_slopes(space, x).map(|(value, _)| value);
        nodal.u.push(u);
        nodal.phi.push(phi);
        nodal.v.push(v);
        nodal.w.push(w);
        nodal.theta.push(theta);
    }
    nodal
}

/// A level of linear elements as polynomials of degree 1.
pub(crate) fn linear(level: &TimeLevel, t: f64) -> DgLevel {
    let TimeLevel {
        u,
        v,
        phi,
        w,
        theta,
        ..
    } = level;
    DgLevel {
        t,
        places: (0..u.len()).map(|i| [u[i], phi[i]]).collect(),
        rates: (0..u.len()).map(|i| [v[i], w[i], theta[i]]).collect(),
    }
}

/// Polynomials of degree 1 as a level of linear elements, without the contact force.
pub(crate) fn of_linear(DgLevel { places, rates, .. }: &DgLevel) -> TimeLevel {
    TimeLevel {
        u: places.iter().map(|[u, _]| *u).collect(),
        v: rates.iter().map(|[v, ..]| *v).collect(),
        phi: places.iter().map(|[_, phi]| *phi).collect(),
        w: rates.iter().map(|[_, w, _]| *w).collect(),
        theta: rates.iter().map(|[.., theta]| *theta).collect(),
        contact_force: 0.0,
    }
}
