//! The law behind errors over a grid of (h, dt): a description of what was computed, which says nothing of h, dt → 0.
//!
//! Rates with intervals are the business of [`judge::grid`](convergence_study::judge::grid).
//!
//! The two contributions add in squares where they are orthogonal: e² = (C_h h^p)² + (C_t dt^q)². It is fitted in log e, so that every
//! point of the grid has the same weight whatever the size of its error:
//!
//! ```text
//!     log e = ½ log(A² + B²),   A = exp(a + p log h),  B = exp(b + q log dt),  a = log C_h,  b = log C_t
//!     ∂ log e / ∂(a, p, b, q) = (w, w log h, 1 - w, (1 - w) log dt),   w = A² / (A² + B²).
//! ```

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::{DVector, Dyn, Matrix4, OMatrix, Owned, U4, Vector2, Vector4};
use thiserror::Error;

/// One point of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Mesh size h > 0.
    pub h: f64,
    /// Time step dt > 0.
    pub dt: f64,
    /// Norm of the error.
    pub error: f64,
}

/// Why no surface can be fitted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SurfaceError {
    /// Four unknowns and a deviation need at least 5 points.
    #[error("{found} points: at least 5 are needed")]
    TooFewPoints {
        /// Points given.
        found: usize,
    },
    /// A step or an error without a finite logarithm.
    #[error("point {index}: h, dt and the error must be positive and finite, found {point:?}")]
    Unusable {
        /// Index of the point.
        index: usize,
        /// The point.
        point: SurfacePoint,
    },
    /// The iteration stopped without a minimum.
    #[error("the fit did not converge: {0}")]
    NotConverged(String),
    /// One contribution is nowhere to be seen, or a step never changes: p and q cannot be told from the constants.
    #[error("the grid does not determine all of C_h, p, C_t, q")]
    Undetermined,
}

/// The fitted surface.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFit {
    /// Rate p in space.
    pub p: f64,
    /// Rate q in time.
    pub q: f64,
    /// Constant C_h.
    pub c_h: f64,
    /// Constant C_t.
    pub c_t: f64,
    /// Root mean square of the residuals of log e: 0.03 is a misfit of 3 %.
    pub rms: f64,
}

/// Fits e² = (C_h h^p)² + (C_t dt^q)² in log e, by Levenberg-Marquardt from several starts.
///
/// * `points`: at least 5, in any order; h and dt must both vary.
///
/// # Errors
/// [`SurfaceError`].
pub fn fit_surface(points: &[SurfacePoint]) -> Result<SurfaceFit, SurfaceError> {
    if points.len() < 5 {
        return Err(SurfaceError::TooFewPoints { found: points.len() });
    }
    let usable = |value: f64| value > 0.0 && value.is_finite();
    let unusable = |point: &SurfacePoint| ![point.h, point.dt, point.error].into_iter().all(usable);
    if let Some(index) = points.iter().position(unusable) {
        return Err(SurfaceError::Unusable { index, point: points[index] });
    }
    let surface = minimize(points)?;
    let jacobian = surface.jacobian_matrix();
    let normal: Matrix4<f64> = jacobian.transpose() * &jacobian;
    let [a, p, b, q] = surface.parameters.into();
    let determined = normal.cholesky().is_some_and(|normal| normal.inverse().iter().all(|value| value.is_finite()));
    if !determined || !surface.parameters.iter().all(|value| value.is_finite()) {
        return Err(SurfaceError::Undetermined);
    }
    Ok(SurfaceFit { p, q, c_h: a.exp(), c_t: b.exp(), rms: surface.rms() })
}

/// Best of the minima found from orders 1 and 2 on either axis: one start alone can end in the exchange of the two contributions.
fn minimize(points: &[SurfacePoint]) -> Result<Surface<'_>, SurfaceError> {
    let mut best: Option<Surface<'_>> = None;
    let mut complaint = TerminationReason::NoImprovementPossible("no start given");
    for (p, q) in [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (2.0, 2.0)] {
        let (surface, report) = LevenbergMarquardt::new().minimize(Surface::start(points, p, q));
        // At a perfect fit round-off leaves nothing to improve, which the library does not count as success.
        let done = report.termination.was_successful()
            || matches!(report.termination, TerminationReason::NoImprovementPossible(_));
        if !done || !surface.rss().is_finite() {
            complaint = report.termination;
        } else if best.as_ref().is_none_or(|best| surface.rss() < best.rss()) {
            best = Some(surface);
        }
    }
    best.ok_or_else(|| SurfaceError::NotConverged(format!("{complaint:?}")))
}

/// The least-squares problem.
#[derive(Clone)]
struct Surface<'a> {
    points: &'a [SurfacePoint],
    /// (log C_h, p, log C_t, q)
    parameters: Vector4<f64>,
}

impl<'a> Surface<'a> {
    /// Orders p and q, with constants that share the error evenly in the (geometric) middle of the grid.
    fn start(points: &'a [SurfacePoint], p: f64, q: f64) -> Self {
        let mean = |value: fn(&SurfacePoint) -> f64| {
            points.iter().map(|point| value(point).ln()).sum::<f64>() / points.len() as f64
        };
        let share = mean(|point| point.error) - 2.0_f64.ln() / 2.0;
        let parameters = Vector4::new(share - p * mean(|point| point.h), p, share - q * mean(|point| point.dt), q);
        Self { points, parameters }
    }

    /// log of either contribution, (log A, log B).
    fn contributions(&self, point: &SurfacePoint) -> Vector2<f64> {
        let [a, p, b, q] = self.parameters.into();
        Vector2::new(a + p * point.h.ln(), b + q * point.dt.ln())
    }

    /// `½ log(A² + B²) - log e`, with the larger of the two taken out so that nothing overflows.
    fn residual(&self, point: &SurfacePoint) -> f64 {
        let [a, b] = self.contributions(point).into();
        let smaller = (2.0 * (a.min(b) - a.max(b))).exp();
        a.max(b) + 0.5 * smaller.ln_1p() - point.error.ln()
    }

    fn rss(&self) -> f64 {
        self.points.iter().map(|point| self.residual(point).powi(2)).sum()
    }

    fn rms(&self) -> f64 {
        (self.rss() / self.points.len() as f64).sqrt()
    }

    fn jacobian_matrix(&self) -> OMatrix<f64, Dyn, U4> {
        let mut jacobian = OMatrix::<f64, Dyn, U4>::zeros(self.points.len());
        for (row, point) in self.points.iter().enumerate() {
            let [a, b] = self.contributions(point).into();
            let w = 1.0 / (1.0 + (2.0 * (b - a)).exp());
            let entries = [w, w * point.h.ln(), 1.0 - w, (1.0 - w) * point.dt.ln()];
            entries.into_iter().enumerate().for_each(|(column, entry)| jacobian[(row, column)] = entry);
        }
        jacobian
    }
}

impl LeastSquaresProblem<f64, Dyn, U4> for Surface<'_> {
    type ParameterStorage = Owned<f64, U4>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U4>;

    fn set_params(&mut self, parameters: &Vector4<f64>) {
        self.parameters = *parameters;
    }

    fn params(&self) -> Vector4<f64> {
        self.parameters
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(DVector::from_iterator(self.points.len(), self.points.iter().map(|point| self.residual(point))))
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U4>> {
        Some(self.jacobian_matrix())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Few scattered points have several minima, and it is not always the same start that finds the lowest.
    #[test]
    fn the_lowest_of_the_minima_found_is_the_fit() {
        let mut winners = std::collections::BTreeSet::new();
        for seed in [19, 66, 97, 185, 195_u64] {
            let mut state = seed * 7919 + 1;
            let mut next = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1_u64 << 53) as f64
            };
            let (p, q, ratio) = (0.5 + 2.0 * next(), 0.5 + 2.0 * next(), (4.0 * next() - 2.0).exp());
            let mut point = || {
                let (h, dt) = (0.5 * (-3.0 * next()).exp(), 0.5 * (-3.0 * next()).exp());
                SurfacePoint { h, dt, error: h.powf(p).hypot(ratio * dt.powf(q)) * (0.1 * next()).exp() }
            };
            let points: Vec<SurfacePoint> = (0..5 + seed % 6).map(|_| point()).collect();
            let from = |(p, q)| LevenbergMarquardt::new().minimize(Surface::start(&points, p, q)).0.rss();
            let minima = [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (2.0, 2.0)].map(from);
            let lowest = minima.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(minima.iter().any(|rss| *rss > 1.2 * lowest), "seed {seed} has one minimum: {minima:?}");
            assert_eq!(minimize(&points).expect("regular").rss(), lowest, "seed {seed}");
            winners.extend(minima.iter().position(|rss| *rss == lowest));
        }
        assert!(winners.len() > 1, "{winners:?}");
    }
}
