//! A manufactured solution for the scheme of any order: loads, initial data and errors.

use thermobeam::dg::{Field, Initial, Level, Load, Space};
use thermobeam::parameters::{Beam, Obstacles};

use crate::factors::Factors;
use crate::solution::{Manufactured, Product};
use crate::sources::{BoundaryLoads, Sources};

/// Quadrature points an element beyond the degree p, for errors.
const EXTRA_POINTS: usize = 8;

/// The loads of a manufactured solution.
pub struct ManufacturedLoad {
    exact: Manufactured,
    obstacles: Option<Obstacles>,
    sources: Sources,
    factors: Factors,
}

impl ManufacturedLoad {
    /// The loads that make `exact` the solution for these coefficients.
    pub fn new(exact: &Manufactured, beam: &Beam, obstacles: Option<Obstacles>, space: &Space) -> Self {
        let sources = Sources::any_order(exact, beam, space);
        Self { exact: exact.clone(), obstacles, sources, factors: Factors::default() }
    }
}

impl Load for ManufacturedLoad {
    fn at(&mut self, t: f64, load: &mut [[f64; 3]]) {
        self.factors.at(&self.exact, t);
        let u = &self.factors.u.value;
        let force = self.obstacles.map_or(0.0, |obstacles| obstacles.force(self.sources.tip(u)));
        self.sources.fill(&self.factors, self.sources.axial_force(u), force, BoundaryLoads::Both, load);
    }
}

/// The exact solution at t = 0, as initial data.
pub fn initial(exact: &Manufactured) -> Initial {
    let sum = |products: &[Product], derivative: usize| -> Box<dyn Fn(f64) -> f64> {
        let products = products.to_vec();
        Box::new(move |x| products.iter().map(|p| p.x.eval(x) * p.t.derivatives(0.0)[derivative]).sum())
    };
    Initial {
        u: sum(&exact.u, 0),
        u_t: sum(&exact.u, 1),
        phi: sum(&exact.phi, 0),
        phi_t: sum(&exact.phi, 1),
        theta: sum(&exact.theta, 0),
    }
}

/// Errors of a level in L2, and of its slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelErrors {
    /// `‖u_h - u‖, ‖φ_h - φ‖, ‖v_h - u_t‖, ‖w_h - φ_t‖, ‖θ_h - θ‖`.
    pub values: [f64; 5],
    /// The same of the derivatives with respect to x.
    pub slopes: [f64; 5],
}

/// The errors of a level against the exact solution at its time.
///
/// * `theta_a`: temperature of the clamped end; a level holds the lifted temperature.
pub fn errors(exact: &Manufactured, theta_a: f64, space: &Space, level: &Level) -> LevelErrors {
    let fields = [
        (Field::U, &exact.u, 0),
        (Field::Phi, &exact.phi, 0),
        (Field::V, &exact.u, 1),
        (Field::W, &exact.phi, 1),
        (Field::Theta, &exact.theta, 0),
    ];
    let mut squares = [[0.0_f64; 2]; 5];
    let points = Space::gauss(space.degree() + EXTRA_POINTS);
    for ends in space.mesh().nodes().windows(2) {
        let half = 0.5 * (ends[1] - ends[0]);
        for (xi, weight) in &points {
            let x = ends[0] + half * (1.0 + xi);
            for (square, (field, products, derivative)) in squares.iter_mut().zip(fields) {
                let (mut value, mut slope) = level.value_and_slope(space, field, x);
                if field == Field::Theta {
                    value += theta_a * (1.0 - x);
                    slope -= theta_a;
                }
                for product in products {
                    let factor = product.t.derivatives(level.t)[derivative];
                    let [x0, x1, _] = product.x.derivatives(x);
                    value -= factor * x0;
                    slope -= factor * x1;
                }
                square[0] += half * weight * value * value;
                square[1] += half * weight * slope * slope;
            }
        }
    }
    LevelErrors { values: squares.map(|square| square[0].sqrt()), slopes: squares.map(|square| square[1].sqrt()) }
}
