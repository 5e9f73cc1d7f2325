//! Observed rates: from (step, error) levels to slopes, intervals and limits.
//!
//! The error of a convergent scheme is, for a step h small enough,
//!
//! ```text
//!     e(h) = C h^p (1 + c h^r + ...),        log e = log C + p log h + log(1 + c h^r + ...)      (a)
//! ```
//!
//! and the order p is what theory claims. Its data are deterministic: what bends log e away from a straight line is
//! the *pollution* c h^r, and what looks like noise is small. Each of the readings here answers one part of that:
//!
//! * [`pairwise_rates`]: the raw rates, level by level, nothing left out;
//! * [`fit_line`]: least squares with a Student-t interval, right when the scatter outweighs the bend;
//! * [`rate_interval`]: several least-squares fits, with the bend and without, weighed against each other: right in both cases;
//! * [`extrapolated_rate`]: the limit of the pairwise rates (Aitken's process, for any step ratios);
//! * [`asymptotic_range`]: which levels any of these may use;
//! * [`fit_surface`]: a law for errors over a grid of (h, dt), to predict others.
//!
//! Only this module knows the statistics and the least-squares libraries.

mod candidates;
mod line;
mod range;
mod surface;

use std::sync::LazyLock;

use statrs::distribution::{ContinuousCDF, StudentsT};

pub use candidates::{
    PENALTY, POLLUTION_EXPONENTS, RateInterval, SAFETY, SCATTER_EXPONENTS, SLOW, SLOW_PENALTY, SLOWEST_POLLUTION,
    rate_interval,
};
pub use line::{LineFit, extrapolated_rate, fit_line, pairwise_rates};
pub use range::{AsymptoticRange, FLOOR_MARGIN, PRE_ASYMPTOTIC_SPREAD, asymptotic_range};
pub use surface::{SurfaceError, SurfaceFit, SurfacePoint, fit_surface};

/// One level of a refinement study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Step size, h or dt; positive, and smaller from level to level.
    pub step: f64,
    /// Norm of the error at that step. Kept as measured: NaN, infinite, zero and negative values are for the judge to see.
    pub error: f64,
}

/// Two-sided quantiles of Student's t, tabulated once per confidence: inverting the distribution costs more than a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantiles {
    confidence: f64,
    t: Vec<f64>,
}

impl Quantiles {
    /// Degrees of freedom that are tabulated; above, the last entry is used, which is the wider (safe) side.
    pub const TABULATED: usize = 30;

    /// * `confidence`: coverage of a two-sided interval, in (0, 1), for example 0.95.
    /// * Returns `None` outside (0, 1), NaN included.
    pub fn new(confidence: f64) -> Option<Self> {
        if !(confidence > 0.0 && confidence < 1.0) {
            return None;
        }
        let quantile = |dof: usize| {
            let law = StudentsT::new(0.0, 1.0, dof as f64).ok()?;
            Some(law.inverse_cdf(0.5 + 0.5 * confidence))
        };
        let t = (1..=Self::TABULATED).map(quantile).collect::<Option<Vec<f64>>>()?;
        Some(Self { confidence, t })
    }

    /// The quantiles of all intervals: 95 %.
    pub fn standard() -> &'static Self {
        static STANDARD: LazyLock<Quantiles> = LazyLock::new(|| Quantiles::new(0.95).expect("a confidence"));
        &STANDARD
    }

    /// The confidence that these quantiles stand for.
    pub fn confidence(&self) -> f64 {
        self.confidence
    }

    /// `t` such that a Student variable lies in [-t, t] with the confidence; infinite without degrees of freedom.
    pub fn t(&self, dof: usize) -> f64 {
        if dof == 0 { f64::INFINITY } else { self.t[dof.min(Self::TABULATED) - 1] }
    }
}
