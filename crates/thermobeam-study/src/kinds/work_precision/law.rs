//! What an error costs: the law behind the grid of runs, and the best path through it.
//!
//! With `e² = (C_h h^p)² + (C_t dt^q)²` fitted to the grid and T/(h dt) node-steps, the cheapest way to an error E has
//!
//! ```text
//! (C_h h^p)² = q/(p+q) E²,   (C_t dt^q)² = p/(p+q) E²,   that is   dt(h) = (√(p/q) C_h h^p / C_t)^(1/q),
//! ```
//!
//! and costs `T/(h dt) = K E^-(1/p + 1/q)`.

use super::surface::{SurfacePoint, fit_surface};
use convergence_study::judge::fit::{self, fit_line};
use convergence_study::text::number::max_or_nan;

/// The errors of one method in one quantity: rates, constants and the cost that follows.
#[derive(Debug, Clone, PartialEq)]
pub struct CostLaw {
    /// Rate in space.
    pub p: f64,
    /// Constant in space.
    pub c_h: f64,
    /// Rate in time.
    pub q: f64,
    /// Constant in time.
    pub c_t: f64,
    /// Root mean square of log e about the law.
    pub misfit: f64,
    /// Final time.
    pub t_end: f64,
    /// Node-steps per element and step: 3 for two runs side by side.
    pub runs: f64,
    /// The smallest error measured: below, the law is extrapolated.
    pub reach: f64,
}

/// A point of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridPoint {
    /// Elements.
    pub elements: usize,
    /// Time steps.
    pub steps: usize,
    /// The error.
    pub error: f64,
    /// Node-steps.
    pub node_steps: f64,
    /// Node-solves.
    pub node_solves: f64,
}

impl CostLaw {
    /// Fits the law.
    ///
    /// # Errors
    /// A text where no law can be fitted: errors that are not finite, rates that are not positive.
    pub fn fit(points: &[GridPoint], t_end: f64, runs: f64) -> Result<Self, String> {
        let surface: Vec<SurfacePoint> = points
            .iter()
            .map(|p| SurfacePoint { h: 1.0 / p.elements as f64, dt: t_end / p.steps as f64, error: p.error })
            .collect();
        let fit = fit_surface(&surface).map_err(|error| error.to_string())?;
        Self { p: fit.p, c_h: fit.c_h, q: fit.q, c_t: fit.c_t, misfit: fit.rms, t_end, runs, reach: 0.0 }.over(points)
    }

    /// The law of errors in the norm of Theorem 3.4, given that of the distances to the interpolant in the same runs.
    ///
    /// The two differ by the interpolation error, which is orthogonal to what the scheme adds and knows nothing of dt:
    /// `e² = (C h^p)² + s²`. What the scheme adds in time, s knows better than e, in which it is next to nothing.
    ///
    /// # Errors
    /// As for [`CostLaw::fit`].
    pub fn with_interpolation(points: &[GridPoint], superclose: (&[GridPoint], &CostLaw)) -> Result<Self, String> {
        let (distances, law) = superclose;
        let finest = points.iter().map(|point| point.steps).max().unwrap_or(0);
        let levels: Vec<fit::Level> = points
            .iter()
            .zip(distances)
            .filter(|(point, _)| point.steps == finest)
            .map(|(e, s)| fit::Level {
                step: 1.0 / e.elements as f64,
                error: ((e.error - s.error) * (e.error + s.error)).sqrt(),
            })
            .collect();
        let line = fit_line(&levels).ok_or("no line through the interpolation errors")?;
        Self { p: line.slope, c_h: line.intercept.exp(), misfit: f64::NAN, ..law.clone() }.over(points)
    }

    /// Measures the misfit and the reach, and refuses rates that are not positive.
    fn over(mut self, points: &[GridPoint]) -> Result<Self, String> {
        if !(self.p > 0.0 && self.q > 0.0) {
            return Err(format!("the errors do not fall: rates {:.3} in space, {:.3} in time", self.p, self.q));
        }
        let square =
            |p: &GridPoint| (self.error(1.0 / p.elements as f64, self.t_end / p.steps as f64) / p.error).ln().powi(2);
        self.misfit = (points.iter().map(square).sum::<f64>() / points.len() as f64).sqrt();
        self.reach = points.iter().map(|p| p.error).fold(f64::INFINITY, |least, error| -max_or_nan(-least, -error));
        Ok(self)
    }

    /// The error of a run.
    pub fn error(&self, h: f64, dt: f64) -> f64 {
        (self.c_h * h.powf(self.p)).hypot(self.c_t * dt.powf(self.q))
    }

    /// h and dt of the cheapest run with error `error`.
    pub fn best(&self, error: f64) -> [f64; 2] {
        let Self { p, q, c_h, c_t, .. } = *self;
        let share = |weight: f64| error * (weight / (p + q)).sqrt();
        [(share(q) / c_h).powf(1.0 / p), (share(p) / c_t).powf(1.0 / q)]
    }

    /// Node-steps of that run.
    pub fn cost(&self, error: f64) -> f64 {
        let [h, dt] = self.best(error);
        self.runs * self.t_end / (h * dt)
    }

    /// The exponent b of `cost = K E^-b`.
    pub fn exponent(&self) -> f64 {
        1.0 / self.p + 1.0 / self.q
    }

    /// Largest factor by which a run of the grid is cheaper than the best path; about 1 where the path is the best.
    pub fn undercut(&self, points: &[GridPoint]) -> f64 {
        let factor = |point: &GridPoint| self.cost(point.error) / point.node_steps;
        points.iter().map(factor).fold(0.0, max_or_nan)
    }
}

/// Of runs as (cost, error) those that no other run beats in both, from cheap to dear.
pub fn front(runs: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(error: impl Fn(f64, f64) -> f64) -> Vec<GridPoint> {
        let mut points = vec![];
        for elements in [8, 16, 32, 64] {
            for steps in [10, 20, 40, 80] {
                let error = error(1.0 / elements as f64, 2.0 / steps as f64);
                let node_steps = (elements * steps) as f64;
                points.push(GridPoint { elements, steps, error, node_steps, node_solves: node_steps });
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
        let point = |node_steps, error| GridPoint { elements: 1, steps: 1, error, node_steps, node_solves: 0.0 };
        let points = [point(4.0, 0.1), point(1.0, 0.5), point(2.0, 0.7), point(3.0, f64::NAN)];
        assert_eq!(front(points.iter().map(|p| (p.node_steps, p.error))), vec![(1.0, 0.5), (4.0, 0.1)]);
    }
}
