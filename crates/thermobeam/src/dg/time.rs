//! Polynomials in time on a step: the Legendre basis of [0, 1], s = (t - t_0)/h, and the integrals of the scheme.

use super::legendre;

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

/// q + 1 for the largest q.
pub(super) const MAX_STAGES: usize = 6;

/// `count` Gauss points on [0, 1].
pub(super) fn gauss_points(count: usize) -> Vec<GaussPoint> {
    let point = |(xi, weight): (f64, f64)| {
        let mut values = [0.0; MAX_STAGES + 1];
        legendre::values_into(xi, &mut values);
        GaussPoint { s: 0.5 * (1.0 + xi), weight: 0.5 * weight, legendre: values }
    };
    legendre::gauss(count).into_iter().map(point).collect()
}

impl<const S: usize> TimeForms<S> {
    pub(super) fn new() -> Self {
        let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
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
        let (start, gauss) = (std::array::from_fn(sign), gauss_points(2 * S));
        Self { derivative, derivative_columns, product, integral, start, gauss }
    }

    /// `y_0 + h ∫_0^s Σ_j v_j L_j`, of degree q + 1: coefficients 0..=q, and the last one.
    pub(super) fn integrate(y0: f64, h: f64, v: &[f64; S]) -> ([f64; S], f64) {
        let mut y = [0.0; S];
        y[0] = 0.5_f64.mul_add(h * v[0], y0);
        for i in 1..S {
            y[i] = h * v[i - 1] / (4 * i - 2) as f64;
        }
        for i in 0..S - 1 {
            y[i] -= h * v[i + 1] / (4 * i + 6) as f64;
        }
        (y, h * v[S - 1] * top::<S>())
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

    fn forms_are_their_integrals<const S: usize>() {
        let forms = TimeForms::<S>::new();
        assert_eq!(forms.gauss.len(), 2 * S);
        let basis = |j: usize, s: f64| {
            let mut unit = [0.0; S];
            unit[j] = 1.0;
            legendre::sum(&unit, s)
        };
        for i in 0..S {
            for j in 0..S {
                let of =
                    |f: &dyn Fn(f64) -> f64| forms.gauss.iter().map(|p| p.weight * f(p.s) * basis(i, p.s)).sum::<f64>();
                let mut unit = [0.0; S];
                unit[j] = 1.0;
                let (low, last) = TimeForms::<S>::integrate(0.25, 3.0, &unit);
                let y = |s: f64| legendre::sum(&[&low[..], &[last]].concat(), s);
                let exact = of(&|s| y(s) - 0.25) / 3.0;
                assert!((forms.integral[i][j] - exact).abs() < 1e-15, "S {i} {j}: {exact}");
                let step = 1e-6;
                // d/ds of the integral is L_j.
                assert!(((y(0.4 + step) - y(0.4 - step)) / (6.0 * step) - basis(j, 0.4)).abs() < 1e-9);
                assert!((y(0.0) - 0.25).abs() < 1e-15);
                let slope = |s: f64| (basis(j, s + step) - basis(j, s - step)) / (2.0 * step);
                let exact = of(&slope) + basis(i, 0.0) * basis(j, 0.0);
                assert!((forms.derivative[i][j] - exact).abs() < 1e-8, "D {i} {j}: {exact}");
                let exact = of(&|s| basis(j, s));
                assert!((exact - if i == j { forms.product[i] } else { 0.0 }).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn every_form_is_its_integral() {
        forms_are_their_integrals::<1>();
        forms_are_their_integrals::<2>();
        forms_are_their_integrals::<3>();
        forms_are_their_integrals::<4>();
        forms_are_their_integrals::<5>();
        forms_are_their_integrals::<6>();
    }
}
