//! Space and time rates at once, over a grid of (h, dt).
//!
//! The two contributions add in squares where they are orthogonal, as in (3.14): e² = (C_h h^p)² + (C_t dt^q)². It is fitted in log e, so that every
//! point of the grid has the same weight whatever the size of its error:
//!
//! ```text
//!     log e = ½ log(A² + B²),   A = exp(a + p log h),  B = exp(b + q log dt),  a = log C_h,  b = log C_t
//!     ∂ log e / ∂(a, p, b, q) = (w, w log h, 1 - w, (1 - w) log dt),   w = A² / (A² + B²).
//! ```

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::{DVector, Dyn, Matrix2, Matrix4, OMatrix, Owned, U4, Vector2, Vector4};
use thiserror::Error;

use super::Quantiles;

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
    /// The same for the best additive surface C_h h^p + C_t dt^q, for comparison; infinite when that fit fails.
    pub rms_additive: f64,
    /// Degrees of freedom: points - 4.
    pub dof: usize,
    /// Covariance of (log C_h, p, log C_t, q): rss / dof (JᵀJ)⁻¹.
    pub covariance: [[f64; 4]; 4],
    /// Student-t interval of p alone.
    pub p_interval: [f64; 2],
    /// Student-t interval of q alone.
    pub q_interval: [f64; 2],
    /// Region that holds (p, q) jointly.
    pub region: ConfidenceRegion,
}

/// Joint confidence region of (p, q): the ellipse `(θ - centre)ᵀ Σ⁻¹ (θ - centre) <= 2 F_{2, dof}`, Σ the covariance of (p, q).
///
/// For two parameters the F quantile has the closed form `F = (dof / 2) ((1 - confidence)^(-2/dof) - 1)`.
#[derive(Debug, Clone, PartialEq)]
pub struct ConfidenceRegion {
    /// The fitted (p, q).
    pub centre: [f64; 2],
    /// Semi-axes, the longer first.
    pub semi_axes: [f64; 2],
    /// Angle of the longer axis against the p axis, in radians, in (-π/2, π/2].
    pub angle: f64,
    /// Coverage that the region is made for.
    pub confidence: f64,
}

impl ConfidenceRegion {
    fn new(centre: [f64; 2], covariance: Matrix2<f64>, dof: usize, confidence: f64) -> Self {
        let eigen = covariance.symmetric_eigen();
        let major = usize::from(eigen.eigenvalues[1] > eigen.eigenvalues[0]);
        let reach = 2.0 * fisher_quantile_2(dof, confidence);
        let semi_axis = |k: usize| (reach * eigen.eigenvalues[k].max(0.0)).sqrt();
        let axis = eigen.eigenvectors.column(major);
        // An axis has no sense of direction: turn it into the right half plane.
        let sign = if axis[0] < 0.0 { -1.0 } else { 1.0 };
        let angle = (sign * axis[1]).atan2(sign * axis[0]);
        Self { centre, semi_axes: [semi_axis(major), semi_axis(1 - major)], angle, confidence }
    }

    /// Whether (p, q) lies in the region, its border included; never for NaN.
    pub fn contains(&self, p: f64, q: f64) -> bool {
        let (dp, dq) = (p - self.centre[0], q - self.centre[1]);
        let (sin, cos) = self.angle.sin_cos();
        let along = (cos * dp + sin * dq) / self.semi_axes[0];
        let across = (cos * dq - sin * dp) / self.semi_axes[1];
        along * along + across * across <= 1.0
    }
}

/// Quantile of Fisher's F with 2 and `dof` degrees of freedom: P(F > f) = (1 + 2 f / dof)^(-dof / 2), solved for f.
fn fisher_quantile_2(dof: usize, confidence: f64) -> f64 {
    let nu = dof as f64;
    0.5 * nu * ((1.0 - confidence).powf(-2.0 / nu) - 1.0)
}

/// How the two contributions make up the error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Adding {
    /// e² = (C_h h^p)² + (C_t dt^q)²: they are orthogonal.
    Squares,
    /// e = C_h h^p + C_t dt^q: they have the same shape.
    Plain,
}

impl Adding {
    fn power(self) -> f64 {
        match self {
            Self::Squares => 2.0,
            Self::Plain => 1.0,
        }
    }
}

/// Fits e² = (C_h h^p)² + (C_t dt^q)² in log e, by Levenberg-Marquardt from several starts.
///
/// * `points`: at least 5, in any order; h and dt must both vary.
/// * `quantiles`: carries the confidence of the intervals and of the region.
pub fn fit_surface(points: &[SurfacePoint], quantiles: &Quantiles) -> Result<SurfaceFit, SurfaceError> {
    fit_surface_by(points, Adding::Squares, quantiles)
}

/// As [`fit_surface`], the contributions adding in this way.
pub fn fit_surface_by(
    points: &[SurfacePoint],
    adding: Adding,
    quantiles: &Quantiles,
) -> Result<SurfaceFit, SurfaceError> {
    if points.len() < 5 {
        return Err(SurfaceError::TooFewPoints { found: points.len() });
    }
    let usable = |value: f64| value > 0.0 && value.is_finite();
    let unusable = |point: &SurfacePoint| ![point.h, point.dt, point.error].into_iter().all(usable);
    if let Some(index) = points.iter().position(unusable) {
        return Err(SurfaceError::Unusable { index, point: points[index] });
    }
    let fitted = minimize(points, adding.power())?;
    let rms_additive = match adding {
        Adding::Plain => fitted.rms(),
        Adding::Squares => minimize(points, Adding::Plain.power()).map_or(f64::INFINITY, |additive| additive.rms()),
    };
    summarize(&fitted, rms_additive, quantiles)
}

fn summarize(surface: &Surface<'_>, rms_additive: f64, quantiles: &Quantiles) -> Result<SurfaceFit, SurfaceError> {
    let dof = surface.points.len() - 4;
    let jacobian = surface.jacobian_matrix();
    let normal: Matrix4<f64> = jacobian.transpose() * &jacobian;
    let inverse = normal.cholesky().ok_or(SurfaceError::Undetermined)?.inverse();
    // Residuals are not known better than the round-off of a logarithm.
    let variance = surface.rss() / dof as f64 + (8.0 * f64::EPSILON).powi(2);
    let covariance = inverse * variance;
    let [a, p, b, q] = surface.parameters.into();
    let sound = covariance.iter().chain(&surface.parameters).all(|value: &f64| value.is_finite());
    if !sound {
        return Err(SurfaceError::Undetermined);
    }
    let interval = |centre: f64, k: usize| {
        let half = quantiles.t(dof) * covariance[(k, k)].sqrt();
        [centre - half, centre + half]
    };
    let joint = Matrix2::new(covariance[(1, 1)], covariance[(1, 3)], covariance[(3, 1)], covariance[(3, 3)]);
    Ok(SurfaceFit {
        p,
        q,
        c_h: a.exp(),
        c_t: b.exp(),
        rms: surface.rms(),
        rms_additive,
        dof,
        covariance: covariance.transpose().into(),
        p_interval: interval(p, 1),
        q_interval: interval(q, 3),
        region: ConfidenceRegion::new([p, q], joint, dof, quantiles.confidence()),
    })
}

/// Best of the minima found from orders 1 and 2 on either axis: one start alone can end in the exchange of the two contributions.
fn minimize(points: &[SurfacePoint], power: f64) -> Result<Surface<'_>, SurfaceError> {
    let mut best: Option<Surface<'_>> = None;
    let mut complaint = TerminationReason::NoImprovementPossible("no start given");
    for (p, q) in [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (2.0, 2.0)] {
        let (surface, report) = LevenbergMarquardt::new().minimize(Surface::start(points, power, p, q));
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

/// The least-squares problem; `power` is 2 where the contributions add in squares, 1 where they add.
#[derive(Clone)]
struct Surface<'a> {
    points: &'a [SurfacePoint],
    power: f64,
    /// (log C_h, p, log C_t, q)
    parameters: Vector4<f64>,
}

impl<'a> Surface<'a> {
    /// Orders p and q, with constants that share the error evenly in the (geometric) middle of the grid.
    fn start(points: &'a [SurfacePoint], power: f64, p: f64, q: f64) -> Self {
        let mean = |value: fn(&SurfacePoint) -> f64| {
            points.iter().map(|point| value(point).ln()).sum::<f64>() / points.len() as f64
        };
        let share = mean(|point| point.error) - 2.0_f64.ln() / power;
        let parameters = Vector4::new(share - p * mean(|point| point.h), p, share - q * mean(|point| point.dt), q);
        Self { points, power, parameters }
    }

    /// log of either contribution, (log A, log B).
    fn contributions(&self, point: &SurfacePoint) -> Vector2<f64> {
        let [a, p, b, q] = self.parameters.into();
        Vector2::new(a + p * point.h.ln(), b + q * point.dt.ln())
    }

    /// `log (A^s + B^s)^(1/s) - log e`, with the larger of the two taken out so that nothing overflows.
    fn residual(&self, point: &SurfacePoint) -> f64 {
        let [a, b] = self.contributions(point).into();
        let smaller = (self.power * (a.min(b) - a.max(b))).exp();
        a.max(b) + smaller.ln_1p() / self.power - point.error.ln()
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
            let w = 1.0 / (1.0 + (self.power * (b - a)).exp());
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
    use statrs::distribution::{ContinuousCDF, FisherSnedecor};

    use super::*;

    #[test]
    fn closed_form_of_the_f_quantile_agrees_with_the_distribution() {
        for dof in [1, 2, 5, 21, 60] {
            let f = fisher_quantile_2(dof, 0.95);
            let law = FisherSnedecor::new(2.0, dof as f64).expect("positive degrees of freedom");
            assert!((law.cdf(f) - 0.95).abs() < 1e-12, "dof {dof}: {}", law.cdf(f));
        }
    }

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
            let from = |(p, q)| LevenbergMarquardt::new().minimize(Surface::start(&points, 2.0, p, q)).0.rss();
            let minima = [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (2.0, 2.0)].map(from);
            let lowest = minima.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(minima.iter().any(|rss| *rss > 1.2 * lowest), "seed {seed} has one minimum: {minima:?}");
            assert_eq!(minimize(&points, 2.0).expect("regular").rss(), lowest, "seed {seed}");
            winners.extend(minima.iter().position(|rss| *rss == lowest));
        }
        assert!(winners.len() > 1, "{winners:?}");
    }
}
