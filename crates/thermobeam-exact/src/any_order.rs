//! A manufactured solution for the scheme of any order: loads, initial data and errors.

use thermobeam::dg::{DgLevel, Field, InitialFunctions, Load, Space};
use thermobeam::parameters::{Beam, Obstacles};

use crate::defect::Defect;
use crate::solution::{Factors, Manufactured, Product};
use crate::sources::Sources;

/// Additional quadrature points per element for errors, beyond the degree p.
const EXTRA_POINTS: usize = 8;

/// The loads that make `exact` the solution with these coefficients.
///
/// * `defect`: a mistake in the loads, for a negative control.
pub fn load(
    exact: &Manufactured,
    beam: &Beam,
    obstacles: Option<Obstacles>,
    space: &Space,
    defect: Option<Defect>,
) -> Box<Load> {
    let sources = Sources::any_order(exact, beam, space);
    let exact = exact.clone();
    let mut factors = Factors::default();
    Box::new(move |t, load| {
        factors.at(&exact, t);
        sources.fill(
            &factors,
            sources.forces(&factors.u, obstacles.as_ref(), defect),
            defect,
            load,
        );
    })
}

/// The exact solution at t = 0, as initial data.
pub fn initial(exact: &Manufactured) -> InitialFunctions {
    InitialFunctions {
        u: start(&exact.u, 0),
        u_t: start(&exact.u, 1),
        phi: start(&exact.phi, 0),
        phi_t: start(&exact.phi, 1),
        theta: start(&exact.theta, 0),
    }
}

/// A derivative of a field with respect to t, at t = 0.
fn start(products: &[Product], derivative: usize) -> Box<dyn Fn(f64) -> f64> {
    let products = products.to_vec();
    Box::new(move |x| {
        products
            .iter()
            .map(|p| p.x.eval(x) * p.t.derivatives(0.0)[derivative])
            .sum()
    })
}

/// Measures the errors of levels against a manufactured solution, whose functions of x are
/// evaluated once.
pub struct ErrorMeter<'a> {
    exact: &'a Manufactured,
    theta_a: f64,
    space: Space,
    /// x and weight of the quadrature points.
    points: Vec<(f64, f64)>,
    /// X and X' for each product of u, φ, θ at each point.
    shapes: [Vec<Vec<[f64; 2]>>; 3],
    factors: Factors,
}

/// X and X' of a product at quadrature points.
fn shape(product: &Product, points: &[(f64, f64)]) -> Vec<[f64; 2]> {
    let mut shape = Vec::with_capacity(points.len());
    for (x, _) in points {
        let [value, slope, _] = product.x.derivatives(*x);
        shape.push([value, slope]);
    }
    shape
}

impl<'a> ErrorMeter<'a> {
    /// Creates a meter for levels on this space.
    ///
    /// * `theta_a`: temperature of the clamped end; a level holds the lifted temperature.
    pub fn new(exact: &'a Manufactured, theta_a: f64, space: &Space) -> Self {
        let gauss = Space::gauss(space.degree() + EXTRA_POINTS);
        let mut points = vec![];
        for ends in space.mesh().nodes().windows(2) {
            let half = 0.5 * (ends[1] - ends[0]);
            for (xi, weight) in &gauss {
                points.push((ends[0] + half * (1.0 + xi), half * weight));
            }
        }
        let shapes = [&exact.u, &exact.phi, &exact.theta].map(|products| {
            products
                .iter()
                .map(|product| shape(product, &points))
                .collect()
        });
        Self {
            exact,
            theta_a,
            space: space.clone(),
            points,
            shapes,
            factors: Factors::default(),
        }
    }

    /// The errors of a level against the exact solution at its time:
    /// `‖u_h - u‖, ‖φ_h - φ‖, ‖v_h - u_t‖, ‖w_h - φ_t‖, ‖θ_h - θ‖` in L2, and those of the
    /// derivatives with respect to x.
    pub fn errors(&mut self, level: &DgLevel) -> [[f64; 5]; 2] {
        self.factors.at(self.exact, level.t);
        let mut squares = [[0.0_f64; 2]; Field::ALL.len()];
        for (k, (_, weight)) in self.points.iter().enumerate() {
            for (square, [value, slope]) in
                squares
                    .iter_mut()
                    .zip(self.errors_at(k, level, self.theta_a))
            {
                square[0] += weight * value * value;
                square[1] += weight * slope * slope;
            }
        }
        [
            squares.map(|square| square[0].sqrt()),
            squares.map(|square| square[1].sqrt()),
        ]
    }

    /// The error of a level in the norm of Theorem 3.4, the left-hand side of (3.14), at its time.
    pub fn theorem_34(&mut self, level: &DgLevel) -> f64 {
        self.factors.at(self.exact, level.t);
        let mut square = 0.0;
        for (k, (_, weight)) in self.points.iter().enumerate() {
            let [[_, u_x], [phi, phi_x], [v, _], [w, _], [theta, _]] =
                self.errors_at(k, level, self.theta_a);
            let terms = [v, u_x - phi, w, phi_x, theta];
            square += weight * terms.iter().map(|term| term * term).sum::<f64>();
        }
        square.sqrt()
    }

    /// |u_h(1) - u(1)| of a level at its time.
    pub fn tip(&mut self, level: &DgLevel) -> f64 {
        self.factors.at(self.exact, level.t);
        let products = self.exact.u.iter().zip(&self.factors.u.value);
        let exact: f64 = products.map(|(p, t)| t * p.x.eval(1.0)).sum();
        (level.value_and_slope(&self.space, Field::U, 1.0).0 - exact).abs()
    }

    /// The largest `|∫ e_x P_k(ξ) dξ|` over fields, elements and degrees k < p: e is the error of a
    /// level, P_k Legendre's polynomial on ξ in [-1, 1]. The slopes of the space are these
    /// polynomials, so it is zero for the projection (3.6), and for no other level.
    ///
    /// * `theta_a`: temperature of the clamped end in the initial data.
    pub fn slope_moments(&mut self, level: &DgLevel, theta_a: f64) -> f64 {
        self.factors.at(self.exact, level.t);
        let degree = self.space.degree();
        let nodes = self.space.mesh().nodes();
        let mut largest = 0.0;
        let of_element = degree + EXTRA_POINTS;
        let mut moments = vec![[0.0; Field::ALL.len()]; degree];
        for (element, ends) in nodes.windows(2).enumerate() {
            let h = ends[1] - ends[0];
            moments.fill([0.0; Field::ALL.len()]);
            for k in element * of_element..(element + 1) * of_element {
                let (x, weight) = self.points[k];
                let xi = (2.0 * x - ends[0] - ends[1]) / h;
                let errors = self.errors_at(k, level, theta_a);
                let (mut polynomial, mut before) = (1.0, 0.0);
                for (m, sums) in moments.iter_mut().enumerate() {
                    for (sum, [_, slope]) in sums.iter_mut().zip(errors) {
                        *sum += 2.0 / h * weight * slope * polynomial;
                    }
                    // (m + 1) P_{m+1} = (2m + 1) ξ P_m - m P_{m-1}.
                    let m = m as f64;
                    let next = ((2.0 * m + 1.0) * xi * polynomial - m * before) / (m + 1.0);
                    (before, polynomial) = (polynomial, next);
                }
            }
            for moment in moments.as_flattened() {
                // A comparison that keeps NaN.
                if !(moment.abs() <= largest) {
                    largest = moment.abs();
                }
            }
        }
        largest
    }

    /// Errors of value and slope of all fields at the k-th point, for the current factors.
    fn errors_at(&self, k: usize, level: &DgLevel, theta_a: f64) -> [[f64; 2]; 5] {
        let Factors { u, phi, theta } = &self.factors;
        let [shapes_u, shapes_phi, shapes_theta] = &self.shapes;
        // In the order of `Field::ALL`.
        let exact = [
            (shapes_u, &u.value),
            (shapes_phi, &phi.value),
            (shapes_u, &u.rate),
            (shapes_phi, &phi.rate),
            (shapes_theta, &theta.value),
        ];
        let x = self.points[k].0;
        let mut fields = level.values_and_slopes(&self.space, x);
        let (temperature, its_slope) = &mut fields[4];
        *temperature += theta_a * (1.0 - x);
        *its_slope -= theta_a;
        let mut errors = fields.map(|(value, slope)| [value, slope]);
        for ([value, slope], (shapes, factors)) in errors.iter_mut().zip(exact) {
            for (shape, factor) in shapes.iter().zip(factors) {
                *value -= factor * shape[k][0];
                *slope -= factor * shape[k][1];
            }
        }
        errors
    }
}
