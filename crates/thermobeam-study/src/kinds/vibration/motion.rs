//! Modes superposed: the reference motion, at the nodes and between them.

use super::clock::Path;
use crate::quadrature;
use std::f64::consts::PI;
use thermobeam::mesh::Mesh;
use thermobeam::norms::{TheoremSquares, l2_squared};
use thermobeam::simulation::Initial;
use thermobeam::solve::Level;
use thermobeam::vibration::Mode;

/// A shape in space: where it is P1 its nodal values say everything, else it is known at the quadrature points too.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shape {
    /// U, Φ and the temperature at the nodes.
    pub(super) nodal: [Vec<f64>; 3],
    /// At the points of [`quadrature::points`]; `None` for a P1 shape.
    pub(super) between: Option<Vec<Point>>,
}

/// A shape at one point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Point {
    u: f64,
    u_x: f64,
    phi: f64,
    phi_x: f64,
    theta: f64,
}

impl Shape {
    /// An exact mode of vibration.
    pub(super) fn vibration(mesh: &Mesh, mode: &Mode) -> Self {
        let at_nodes = |f: &dyn Fn(f64) -> f64| mesh.nodes().iter().map(|&x| f(x)).collect();
        let nodal = [at_nodes(&|x| mode.u(x)), at_nodes(&|x| mode.phi(x)), at_nodes(&|_| 0.0)];
        let point = |x| Point { u: mode.u(x), u_x: mode.u_x(x), phi: mode.phi(x), phi_x: mode.phi_x(x), theta: 0.0 };
        Self { nodal, between: Some(quadrature::points(mesh).into_iter().map(point).collect()) }
    }

    /// sin kπx of the temperature.
    pub(super) fn temperature(mesh: &Mesh, k: usize) -> Self {
        let sine = |x: f64| (k as f64 * PI * x).sin();
        let zeros = vec![0.0; mesh.nodes().len()];
        let nodal = [zeros.clone(), zeros, mesh.nodes().iter().map(|&x| sine(x)).collect()];
        let point = |x| Point { theta: sine(x), ..Point::default() };
        Self { nodal, between: Some(quadrature::points(mesh).into_iter().map(point).collect()) }
    }
}

/// A sum of shapes, each with its path in time. There is at least one, and all are P1 or none.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Motion {
    pub(super) parts: Vec<(Shape, Path)>,
}

/// u, û, φ, φ̂ and θ at the nodes.
type Fields = [Vec<f64>; 5];

impl Motion {
    /// Nodal values at time level n.
    fn at_nodes(&self, n: usize) -> Fields {
        let mut fields = [(); 5].map(|()| vec![0.0; self.parts[0].0.nodal[0].len()]);
        for (shape, path) in &self.parts {
            let [position, velocity] = path[n];
            let [u, phi, theta] = &shape.nodal;
            let terms = [(u, position), (u, velocity), (phi, position), (phi, velocity), (theta, position)];
            for (field, (values, factor)) in fields.iter_mut().zip(terms) {
                field.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
            }
        }
        fields
    }

    /// The state at t = 0, interpolated as (3.6) has it.
    pub(super) fn initial(&self) -> Initial {
        let [u, u_t, phi, phi_t, theta] = self.at_nodes(0);
        Initial { u, u_t, phi, phi_t, theta }
    }

    /// u(1) at time level n.
    pub(super) fn tip(&self, n: usize) -> f64 {
        self.parts.iter().map(|(shape, path)| shape.nodal[0][shape.nodal[0].len() - 1] * path[n][0]).sum()
    }

    /// Errors of a level at time level n, in the order of [`Norm::ALL`](crate::kinds::tables::Norm::ALL).
    pub(super) fn errors(&self, lengths: &[f64], n: usize, level: &Level) -> [f64; 8] {
        let [u, v, phi, w, theta] = self.at_nodes(n);
        let minus = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
        let (du, dphi) = (minus(&level.u, &u), minus(&level.phi, &phi));
        let (dv, dw, dtheta) = (minus(&level.v, &v), minus(&level.w, &w), minus(&level.theta, &theta));
        let nodal = TheoremSquares::of(lengths, &dv, &du, &dw, &dphi, &dtheta);
        let (squares, displacement) = match self.between(n) {
            Some(points) => between_squares(lengths, &points, level),
            None => (nodal, l2_squared(lengths, &du)),
        };
        [
            squares.velocity.sqrt(),
            squares.shear.sqrt(),
            squares.rotation_rate.sqrt(),
            squares.curvature.sqrt(),
            squares.temperature.sqrt(),
            squares.norm(),
            displacement.sqrt(),
            nodal.norm(),
        ]
    }

    /// Positions and velocities at the quadrature points at time level n; `None` for P1 shapes.
    fn between(&self, n: usize) -> Option<Vec<[Point; 2]>> {
        let count = self.parts[0].0.between.as_ref()?.len();
        let mut sums = vec![[Point::default(); 2]; count];
        for (shape, path) in &self.parts {
            for (sum, point) in sums.iter_mut().zip(shape.between.as_ref()?) {
                for (sum, factor) in sum.iter_mut().zip(path[n]) {
                    sum.add(factor, point);
                }
            }
        }
        Some(sums)
    }
}

impl Point {
    fn add(&mut self, factor: f64, other: &Self) {
        self.u += factor * other.u;
        self.u_x += factor * other.u_x;
        self.phi += factor * other.phi;
        self.phi_x += factor * other.phi_x;
        self.theta += factor * other.theta;
    }
}

/// The squares of Theorem 3.4 and ‖u_h - u‖², by quadrature of the differences themselves.
fn between_squares(lengths: &[f64], points: &[[Point; 2]], level: &Level) -> (TheoremSquares, f64) {
    let value = |y: &[f64], element: usize, s: f64| (1.0 - s) * y[element] + s * y[element + 1];
    let slope = |y: &[f64], element: usize| (y[element + 1] - y[element]) / lengths[element];
    let square = |error: &dyn Fn(usize, f64, &[Point; 2]) -> f64| {
        quadrature::integrate(lengths, |element, s, point| error(element, s, &points[point]).powi(2))
    };
    let squares = TheoremSquares {
        velocity: square(&|e, s, [_, rate]| value(&level.v, e, s) - rate.u),
        shear: square(&|e, s, [at, _]| slope(&level.u, e) - value(&level.phi, e, s) - (at.u_x - at.phi)),
        rotation_rate: square(&|e, s, [_, rate]| value(&level.w, e, s) - rate.phi),
        curvature: square(&|e, _, [at, _]| slope(&level.phi, e) - at.phi_x),
        temperature: square(&|e, s, [at, _]| value(&level.theta, e, s) - at.theta),
    };
    (squares, square(&|e, s, [at, _]| value(&level.u, e, s) - at.u))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_the_zero_level_are_the_norms_of_the_motion() {
        let mesh = Mesh::mapped(200, |s| 0.5 * s + 0.5 * s * s).expect("a mesh");
        let lengths: Vec<f64> = mesh.lengths().collect();
        let parts = vec![(Shape::temperature(&mesh, 2), vec![[3.0, 0.0]])];
        let errors = Motion { parts }.errors(&lengths, 0, &Level::new(201));
        assert!((errors[4] - 3.0 / 2.0_f64.sqrt()).abs() < 1e-13, "{errors:?}");
        let mode = Mode::new(1);
        let parts = vec![(Shape::vibration(&mesh, &mode), vec![[2.0, 5.0]])];
        let [velocity, shear, rotation_rate, curvature, _, theorem, displacement, _] =
            Motion { parts }.errors(&lengths, 0, &Level::new(201));
        // Rayleigh's quotient of the exact mode is ω².
        let (elastic, inertia) = (shear.powi(2) + curvature.powi(2), velocity.powi(2) + rotation_rate.powi(2));
        assert!((elastic / inertia - mode.omega().powi(2) * 4.0 / 25.0).abs() < 1e-12);
        assert!((theorem.powi(2) - elastic - inertia).abs() < 1e-12);
        assert!((displacement / velocity - 0.4).abs() < 1e-14);
    }
}
