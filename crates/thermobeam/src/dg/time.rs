//! Polynomials in time on a step: the Legendre basis of [0, 1], ξ = (t - t_0)/τ, and the integrals
//! of scheme and loads.

use super::legendre;
use crate::lanes::fma;

/// The integrals for velocities of degree q = S - 1.
#[derive(Debug, Clone)]
pub(super) struct TimeForms<const S: usize> {
    /// `D_ij = ∫ L_j' L_i ds + L_j(0) L_i(0)`: a derivative, and the jump at the start of the step.
    pub(super) derivative: [[f64; S]; S],
    /// Its columns.
    pub(super) derivative_columns: [[f64; S]; S],
    /// `T_i = ∫ L_i² ds = 1/(2i + 1)`.
    pub(super) product: [f64; S],
    /// `S_ij = ∫ (∫_0^s L_j) L_i ds`.
    pub(super) integral: [[f64; S]; S],
    /// `L_i(0) = (-1)^i`.
    pub(super) start: [f64; S],
    /// 2q + 2 Gauss points, exact to degree 4q + 3.
    pub(super) gauss: Vec<GaussPoint>,
}

/// A Gauss point of [0, 1] and the Legendre polynomials L_0..L_{q+1} there.
#[derive(Debug, Clone, Copy)]
pub(super) struct GaussPoint {
    pub(super) s: f64,
    pub(super) weight: f64,
    pub(super) legendre: [f64; MAX_STAGES + 1],
}

/// A polynomial of degree q + 1 in time: coefficients 0..=q, and the last one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path<const S: usize> {
    pub(super) low: [f64; S],
    pub(super) top: f64,
}

/// q + 1 for the largest q.
pub(super) const MAX_STAGES: usize = 6;

/// `count` Gauss points on [0, 1].
pub(super) fn gauss_points(count: usize) -> Vec<GaussPoint> {
    legendre::gauss(count)
        .into_iter()
        .map(|(xi, weight)| gauss_point(xi, weight))
        .collect()
}

/// The point of [0, 1] for a Gauss point ξ of [-1, 1].
fn gauss_point(xi: f64, weight: f64) -> GaussPoint {
    let mut values = [0.0; MAX_STAGES + 1];
    legendre::values_into(xi, &mut values);
    GaussPoint {
        s: 0.5 * (1.0 + xi),
        weight: 0.5 * weight,
        legendre: values,
    }
}

/// `L_i(0) = (-1)^i`.
fn sign(i: usize) -> f64 {
    if i.is_multiple_of(2) { 1.0 } else { -1.0 }
}

impl<const S: usize> TimeForms<S> {
    /// A polynomial at the start of the step.
    pub(super) fn at_start(&self, y: &[f64; S]) -> f64 {
        y.iter().zip(&self.start).map(|(y, sign)| y * sign).sum()
    }

    pub(super) fn new() -> Self {
        let product: [f64; S] = std::array::from_fn(|i| 1.0 / (2 * i + 1) as f64);
        let derivative: [[f64; S]; S] = std::array::from_fn(|i| {
            // ∫ L_j' L_i = [L_j L_i] for j > i, 0 otherwise.
            std::array::from_fn(|j| if j > i { 1.0 - sign(i + j) } else { 0.0 } + sign(i + j))
        });
        let mut integral = [[0.0; S]; S];
        for (j, column) in (0..S).map(|j| (j, antiderivative(j))) {
            for (i, coefficient) in column.into_iter().filter(|(i, _)| *i < S) {
                integral[i][j] += product[i] * coefficient;
            }
        }
        let derivative_columns = std::array::from_fn(|j| derivative.map(|row| row[j]));
        let start = std::array::from_fn(sign);
        let gauss = gauss_points(2 * S);
        Self {
            derivative,
            derivative_columns,
            product,
            integral,
            start,
            gauss,
        }
    }

    /// `y_0 + τ ∫_0^ξ Σ_j v_j L_j`, with τ = `h`.
    pub(super) fn integrate(y0: f64, h: f64, v: &[f64; S]) -> Path<S> {
        let mut y = [0.0; S];
        y[0] = fma(0.5, h * v[0], y0);
        for i in 1..S {
            y[i] = h * v[i - 1] / (4 * i - 2) as f64;
        }
        for i in 0..S - 1 {
            y[i] -= h * v[i + 1] / (4 * i + 6) as f64;
        }
        Path {
            low: y,
            top: h * v[S - 1] * top::<S>(),
        }
    }
}

/// Loads F_u, F_φ, F_θ on the right-hand sides of the three equations, tested with the basis
/// functions.
///
/// Adds the load at a time, `(F_u, χ), (F_φ, ψ), (F_θ, η)`, to a vector with an entry for each
/// block, as [`Space::add_load`](super::Space::add_load) does for functions of x.
pub type Load = dyn FnMut(f64, &mut [[f64; 3]]) + Send;

/// The loads of a step, integrated: `moments[i]` is the integral with L_i.
pub(super) struct Forcing<const S: usize> {
    pub(super) moments: Vec<Vec<[f64; 3]>>,
    load: Vec<[f64; 3]>,
    points: Vec<GaussPoint>,
}

impl<const S: usize> Forcing<S> {
    /// For this number of blocks; by q + 9 Gauss points.
    pub(super) fn new(blocks: usize) -> Self {
        let zeros = vec![[0.0; 3]; blocks];
        Self {
            moments: vec![zeros.clone(); S],
            load: zeros,
            points: gauss_points(S + 8),
        }
    }

    /// Integrates a load over the step of length τ (`h`) from t.
    pub(super) fn integrate(&mut self, load: &mut Load, t: f64, h: f64) {
        self.moments
            .iter_mut()
            .for_each(|moments| moments.fill([0.0; 3]));
        for point in &self.points {
            self.load.fill([0.0; 3]);
            load(t + h * point.s, &mut self.load);
            for (moments, legendre) in self.moments.iter_mut().zip(&point.legendre) {
                let weight = h * point.weight * legendre;
                for (moment, load) in moments.iter_mut().zip(&self.load) {
                    for field in 0..3 {
                        moment[field] = fma(weight, load[field], moment[field]);
                    }
                }
            }
        }
    }
}

/// `∫_0^s L_j` as a sum: degrees and coefficients.
fn antiderivative(j: usize) -> [(usize, f64); 2] {
    if j == 0 {
        return [(0, 0.5), (1, 0.5)];
    }
    let factor = 0.5 / (2 * j + 1) as f64;
    [(j + 1, factor), (j - 1, -factor)]
}

/// The coefficient of `L_{q+1}` in `∫_0^s L_q`.
const fn top<const S: usize>() -> f64 {
    0.5 / (2 * S - 1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_is_that_of_the_path_of_each_velocity() {
        let forms = TimeForms::<6>::new();
        for j in 0..6 {
            let mut unit = [0.0; 6];
            unit[j] = 1.0;
            let path = TimeForms::<6>::integrate(0.0, 1.0, &unit);
            for i in 0..6 {
                let expected = forms.product[i] * path.low[i];
                assert!((forms.integral[i][j] - expected).abs() < 1e-15, "{i} {j}");
            }
        }
    }
}
