//! Observed rates: from (step, error) levels to slopes, intervals and limits.
//!
//! The error of a convergent scheme is, for a step h small enough,
//!
//! ```text
//!     e(h) = C h^p (1 + c h^r + ...),        log e = log C + p log h + log(1 + c h^r + ...)      (a)
//! ```
//!
//! and the order p is what theory claims. The data are deterministic: the *pollution* c h^r bends log e away from a
//! straight line, and apparent noise is small. Each reading here answers one part of the question:
//!
//! * [`pairwise_rates`]: the raw rates, level by level, nothing left out;
//! * [`fit_line`]: least squares with a Student-t interval, right when the scatter outweighs the bend;
//! * [`rate_interval`]: several weighted least-squares fits, with and without the bend: right in both cases;
//! * [`extrapolated_rate`]: the limit of the pairwise rates (Aitken's process, for any step ratios);
//! * [`asymptotic_range`]: which levels any of these may use;

mod candidates;
mod line;
mod range;

pub use candidates::{
    PENALTY, POLLUTION_EXPONENTS, RateInterval, SAFETY, SCATTER_EXPONENTS, SLOW, SLOW_PENALTY, SLOWEST_POLLUTION,
    rate_interval,
};
pub use line::{LineFit, extrapolated_rate, fit_line, pairwise_rates};
pub use range::{AsymptoticRange, FADING_SPREAD, FLOOR_MARGIN, PRE_ASYMPTOTIC_SPREAD, asymptotic_range, scatter};
pub(crate) use range::{changes, outlier};

/// One level of a refinement study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Step size, h or dt; positive, and smaller from level to level.
    pub step: f64,
    /// Norm of the error at that step. Kept as measured: the judge deals with NaN, infinite, zero and negative values.
    pub error: f64,
}

/// Two-sided 95 % quantiles of Student's t for 1, 2, ... degrees of freedom, as statistics libraries compute them.
const STUDENT: [f64; 30] = [
    12.70620473617469,
    4.302652729749467,
    3.1824463052837046,
    2.776445105197795,
    2.570581835636315,
    2.4469118511449652,
    2.364624251592785,
    2.3060041352041707,
    2.2621571627982036,
    2.2281388519862744,
    2.200985160091634,
    2.1788128296672054,
    2.1603686564628095,
    2.1447866879177897,
    2.131449545559734,
    2.1199052992212404,
    2.109815577833272,
    2.1009220402409565,
    2.0930240544082417,
    2.0859634472657946,
    2.0796138447275436,
    2.0738730679038766,
    2.068657610418929,
    2.0638985616278602,
    2.059538552753143,
    2.0555294386426555,
    2.0518305164800905,
    2.048407141795102,
    2.0452296421323903,
    2.042272456301077,
];

/// `t` such that a Student variable with `dof` degrees of freedom lies in [-t, t] at 95 % confidence; infinite if `dof` is 0.
///
/// Above 30 degrees of freedom it returns the last entry of the table, which is larger and therefore safe.
pub fn student_t(dof: usize) -> f64 {
    dof.checked_sub(1).map_or(f64::INFINITY, |above| STUDENT[above.min(STUDENT.len() - 1)])
}
