//! The cost of an error: the law behind the grid of runs, and the best path through the grid.
//!
//! With `e² = (C_h h^p)² + (C_t dt^q)²` fitted to the grid and T/(h dt) node-steps, the cheapest way to an error E has
//!
//! ```text
//! (C_h h^p)² = q/(p+q) E²,   (C_t dt^q)² = p/(p+q) E²,   that is   dt(h) = (√(p/q) C_h h^p / C_t)^(1/q),
//! ```
//!
//! and costs `T/(h dt) = K E^-(1/p + 1/q)`.
//!
//! The law describes the computed range and makes no statement about h, dt → 0; [`judge::grid`](convergence_study::judge::grid)
//! gives rates with intervals. The two contributions add in squares if they are orthogonal. The fit uses log e, so that every point
//! of the grid has the same weight for any size of its error:
//!
//! ```text
//!     log e = ½ log(A² + B²),   A = exp(a + p log h),  B = exp(b + q log dt),  a = log C_h,  b = log C_t
//!     ∂ log e / ∂(a, p, b, q) = (w, w log h, 1 - w, (1 - w) log dt),   w = A² / (A² + B²).
//! ```

use convergence_study::judge::fit::{self, fit_line};
use convergence_study::text::number::{max_or_nan, min_or_nan};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::{DVector, Dyn, Matrix4, OMatrix, Owned, U4, Vector2, Vector4};

/// The errors of one method in one quantity: the law, and the cost that follows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CostLaw {
    /// Rates and constants, and the root mean square of log e about them.
    pub(super) fit: SurfaceFit,
    t_end: f64,
    /// Node-steps per element and step: 3 for two simultaneous runs.
    runs: f64,
    /// The smallest measured error: below it, the law is extrapolated.
    pub(super) reach: f64,
}

/// A run of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GridPoint {
    /// Mesh size h > 0.
    pub h: f64,
    /// Time step dt > 0.
    pub dt: f64,
    /// Norm of the error.
    pub error: f64,
    /// Elements times steps.
    pub node_steps: f64,
    /// Elements times solves.
    pub node_solves: f64,
}

impl CostLaw {
    /// Fits the law.
    ///
    /// # Errors
    /// A message if no law can be fitted: errors that are not finite, rates that are not positive.
    pub(super) fn fit(points: &[GridPoint], t_end: f64, runs: f64) -> Result<Self, String> {
        Self {
            fit: fit_surface(points)?,
            t_end,
            runs,
            reach: 0.0,
        }
        .over(points)
    }

    /// The law of errors in the norm of Theorem 3.4, from the law of the distances to the interpolant in the same runs.
    ///
    /// The two differ by the interpolation error, which is orthogonal to the scheme's contribution and independent of
    /// dt: `e² = (C h^p)² + s²`. The scheme's time error is visible in s, but negligible in e.
    pub(super) fn with_interpolation(
        points: &[GridPoint],
        distances: &[GridPoint],
        law: &Self,
    ) -> Result<Self, String> {
        let finest = points
            .iter()
            .map(|point| point.dt)
            .fold(f64::INFINITY, f64::min);
        let of_finest = points
            .iter()
            .zip(distances)
            .filter(|(point, _)| point.dt == finest);
        let level = |(e, s): (&GridPoint, &GridPoint)| fit::Level {
            step: e.h,
            error: ((e.error - s.error) * (e.error + s.error)).sqrt(),
        };
        let line = fit_line(&of_finest.map(level).collect::<Vec<_>>())
            .ok_or("no line through the interpolation errors")?;
        let fit = SurfaceFit {
            p: line.slope,
            c_h: line.intercept.exp(),
            ..law.fit.clone()
        };
        Self { fit, ..law.clone() }.over(points)
    }

    /// Measures the misfit and the reach, and refuses rates that are not positive.
    fn over(mut self, points: &[GridPoint]) -> Result<Self, String> {
        let SurfaceFit { p, q, .. } = self.fit;
        if !(p > 0.0 && q > 0.0) {
            return Err(format!(
                "the errors do not fall: rates {p:.3} in space, {q:.3} in time"
            ));
        }
        let square = |p: &GridPoint| (self.error(p.h, p.dt) / p.error).ln().powi(2);
        self.fit.rms = (points.iter().map(square).sum::<f64>() / points.len() as f64).sqrt();
        self.reach = points
            .iter()
            .map(|p| p.error)
            .fold(f64::INFINITY, min_or_nan);
        Ok(self)
    }

    fn error(&self, h: f64, dt: f64) -> f64 {
        (self.fit.c_h * h.powf(self.fit.p)).hypot(self.fit.c_t * dt.powf(self.fit.q))
    }

    /// h and dt of the cheapest run with error `error`.
    pub(super) fn best(&self, error: f64) -> [f64; 2] {
        let SurfaceFit { p, q, c_h, c_t, .. } = self.fit;
        let share = |weight: f64| error * (weight / (p + q)).sqrt();
        [
            (share(q) / c_h).powf(1.0 / p),
            (share(p) / c_t).powf(1.0 / q),
        ]
    }

    /// Node-steps of that run.
    pub(super) fn cost(&self, error: f64) -> f64 {
        let [h, dt] = self.best(error);
        self.runs * self.t_end / (h * dt)
    }

    /// The exponent b of `cost = K E^-b`.
    pub(super) fn exponent(&self) -> f64 {
        1.0 / self.fit.p + 1.0 / self.fit.q
    }

    /// Largest factor by which a run of the grid is cheaper than the best path; about 1 if the path is optimal.
    pub(super) fn undercut(&self, points: &[GridPoint]) -> f64 {
        let factor = |point: &GridPoint| self.cost(point.error) / point.node_steps;
        points.iter().map(factor).fold(0.0, max_or_nan)
    }
}

/// The runs, as (cost, error), that no other run beats in both, from cheapest to most expensive.
pub(crate) fn front(runs: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut sorted: Vec<(f64, f64)> = runs.into_iter().collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut front: Vec<(f64, f64)> = vec![];
    for (cost, error) in sorted {
        if front.last().is_none_or(|&(_, best)| error < best) {
            front.push((cost, error));
        }
    }
    front
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
    /// Root mean square of the residuals of log e: 0.03 means 3 %.
    pub rms: f64,
}

/// Fits e² = (C_h h^p)² + (C_t dt^q)² in log e, by Levenberg-Marquardt from several starts.
///
/// * `points`: at least 5, in any order; h and dt must both vary.
///
/// # Errors
/// A message: too few points for four unknowns and a deviation, a point without finite logarithms, an iteration that stops before a
/// minimum, or a grid that cannot separate p and q from the constants.
pub fn fit_surface(points: &[GridPoint]) -> Result<SurfaceFit, String> {
    if points.len() < 5 {
        return Err(format!("{} points: at least 5 are needed", points.len()));
    }
    let usable = |value: f64| value > 0.0 && value.is_finite();
    let unusable = |point: &GridPoint| ![point.h, point.dt, point.error].into_iter().all(usable);
    if let Some(index) = points.iter().position(unusable) {
        let point = points[index];
        return Err(format!(
            "point {index}: h, dt and the error must be positive and finite, found {point:?}"
        ));
    }
    let surface = minimize(points)?;
    let jacobian = surface.jacobian_matrix();
    let normal: Matrix4<f64> = jacobian.transpose() * &jacobian;
    let [a, p, b, q] = surface.parameters.into();
    let determined = normal
        .cholesky()
        .is_some_and(|normal| normal.inverse().iter().all(|value| value.is_finite()));
    if !determined || !surface.parameters.iter().all(|value| value.is_finite()) {
        return Err("the grid does not determine all of C_h, p, C_t, q".to_owned());
    }
    Ok(SurfaceFit {
        p,
        q,
        c_h: a.exp(),
        c_t: b.exp(),
        rms: surface.rms(),
    })
}

/// Best of the minima found from orders 1 and 2 on either axis: a single start may exchange the two contributions.
fn minimize(points: &[GridPoint]) -> Result<Surface<'_>, String> {
    let mut best: Option<Surface<'_>> = None;
    let mut complaint = TerminationReason::NoImprovementPossible("no start given");
    for (p, q) in [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (2.0, 2.0)] {
        let (surface, report) = LevenbergMarquardt::new().minimize(Surface::start(points, p, q));
        // At a perfect fit only round-off remains, which the library does not count as success.
        let done = report.termination.was_successful()
            || matches!(
                report.termination,
                TerminationReason::NoImprovementPossible(_)
            );
        if !done || !surface.rss().is_finite() {
            complaint = report.termination;
        } else if best.as_ref().is_none_or(|best| surface.rss() < best.rss()) {
            best = Some(surface);
        }
    }
    best.ok_or_else(|| format!("the fit did not converge: {complaint:?}"))
}

/// The least-squares problem.
#[derive(Clone)]
struct Surface<'a> {
    points: &'a [GridPoint],
    /// (log C_h, p, log C_t, q)
    parameters: Vector4<f64>,
}

impl<'a> Surface<'a> {
    /// Orders p and q, with constants that share the error equally in the (geometric) centre of the grid.
    fn start(points: &'a [GridPoint], p: f64, q: f64) -> Self {
        let mean = |value: fn(&GridPoint) -> f64| {
            points.iter().map(|point| value(point).ln()).sum::<f64>() / points.len() as f64
        };
        let share = mean(|point| point.error) - 2.0_f64.ln() / 2.0;
        let parameters = Vector4::new(
            share - p * mean(|point| point.h),
            p,
            share - q * mean(|point| point.dt),
            q,
        );
        Self { points, parameters }
    }

    /// log of either contribution, (log A, log B).
    fn contributions(&self, point: &GridPoint) -> Vector2<f64> {
        let [a, p, b, q] = self.parameters.into();
        Vector2::new(a + p * point.h.ln(), b + q * point.dt.ln())
    }

    /// `½ log(A² + B²) - log e`, scaled by the larger of the two so that nothing overflows.
    fn residual(&self, point: &GridPoint) -> f64 {
        let [a, b] = self.contributions(point).into();
        let smaller = (2.0 * (a.min(b) - a.max(b))).exp();
        a.max(b) + 0.5 * smaller.ln_1p() - point.error.ln()
    }

    fn rss(&self) -> f64 {
        self.points
            .iter()
            .map(|point| self.residual(point).powi(2))
            .sum()
    }

    fn rms(&self) -> f64 {
        (self.rss() / self.points.len() as f64).sqrt()
    }

    fn jacobian_matrix(&self) -> OMatrix<f64, Dyn, U4> {
        let row = |point: &GridPoint| {
            let [a, b] = self.contributions(point).into();
            let w = 1.0 / (1.0 + (2.0 * (b - a)).exp());
            [w, w * point.h.ln(), 1.0 - w, (1.0 - w) * point.dt.ln()]
        };
        OMatrix::<f64, Dyn, U4>::from_row_iterator(
            self.points.len(),
            self.points.iter().flat_map(row),
        )
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
        Some(DVector::from_iterator(
            self.points.len(),
            self.points.iter().map(|point| self.residual(point)),
        ))
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U4>> {
        Some(self.jacobian_matrix())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(error: impl Fn(f64, f64) -> f64) -> Vec<GridPoint> {
        let mut points = vec![];
        for elements in [8.0, 16.0, 32.0, 64.0] {
            for steps in [10.0, 20.0, 40.0, 80.0] {
                let (h, dt, node_steps) = (1.0 / elements, 2.0 / steps, elements * steps);
                points.push(GridPoint {
                    h,
                    dt,
                    error: error(h, dt),
                    node_steps,
                    node_solves: node_steps,
                });
            }
        }
        points
    }

    #[test]
    fn the_best_path_is_the_cheapest_of_all_with_that_error() {
        let points = grid(|h, dt| (3.0 * h * h).hypot(0.5 * dt));
        let law = CostLaw::fit(&points, 2.0, 1.0).unwrap();
        let [h, dt] = law.best(1e-3);
        assert!(((3.0 * h * h).hypot(0.5 * dt) / 1e-3 - 1.0).abs() < 1e-6);
        assert!((law.exponent() - 1.5).abs() < 1e-6);
        for factor in [0.5, 0.9, 1.1, 1.5] {
            let other = h * factor;
            let rest = (1e-6 - (3.0 * other * other).powi(2)).sqrt() / 0.5;
            assert!(rest.is_nan() || 2.0 / (other * rest) > law.cost(1e-3));
        }
        assert!(law.undercut(&points) <= 1.0 + 1e-6);
    }

    #[test]
    fn there_is_no_law_where_errors_are_no_numbers_or_do_not_fall() {
        let mut points = grid(|h, dt| h.hypot(dt));
        points[3].error = f64::NAN;
        assert!(CostLaw::fit(&points, 2.0, 1.0).is_err());
        assert!(CostLaw::fit(&grid(|h, dt| (1.0 / h).hypot(1.0 / dt)), 2.0, 1.0).is_err());
    }

    #[test]
    fn the_front_leaves_out_what_is_beaten() {
        let point = |node_steps, error| GridPoint {
            error,
            node_steps,
            ..GridPoint::default()
        };
        let points = [
            point(4.0, 0.1),
            point(1.0, 0.5),
            point(2.0, 0.7),
            point(3.0, f64::NAN),
        ];
        assert_eq!(
            front(points.iter().map(|p| (p.node_steps, p.error))),
            vec![(1.0, 0.5), (4.0, 0.1)]
        );
    }

    /// A few scattered points have several minima, and the best starting point varies.
    #[test]
    fn the_lowest_of_the_minima_found_is_the_fit() {
        let mut winners = std::collections::BTreeSet::new();
        for seed in [19, 66, 97, 185, 195_u64] {
            let mut state = seed * 7919 + 1;
            let mut next = || {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1_u64 << 53) as f64
            };
            let (p, q, ratio) = (
                0.5 + 2.0 * next(),
                0.5 + 2.0 * next(),
                (4.0 * next() - 2.0).exp(),
            );
            let mut point = || {
                let (h, dt) = (0.5 * (-3.0 * next()).exp(), 0.5 * (-3.0 * next()).exp());
                let error = h.powf(p).hypot(ratio * dt.powf(q)) * (0.1 * next()).exp();
                GridPoint {
                    h,
                    dt,
                    error,
                    ..GridPoint::default()
                }
            };
            let points: Vec<GridPoint> = (0..5 + seed % 6).map(|_| point()).collect();
            let from = |(p, q)| {
                LevenbergMarquardt::new()
                    .minimize(Surface::start(&points, p, q))
                    .0
                    .rss()
            };
            let minima = [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (2.0, 2.0)].map(from);
            let lowest = minima.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(
                minima.iter().any(|rss| *rss > 1.2 * lowest),
                "seed {seed} has one minimum: {minima:?}"
            );
            assert_eq!(
                minimize(&points).expect("regular").rss(),
                lowest,
                "seed {seed}"
            );
            winners.extend(minima.iter().position(|rss| *rss == lowest));
        }
        assert!(winners.len() > 1, "{winners:?}");
    }
}
