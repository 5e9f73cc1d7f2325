//! Pilot runs: the errors of space and time, each measured by halving its own step.
//!
//! A pilot with n elements and s steps has two companions, one with n/2 elements and one with s/2 steps. Their
//! differences to the pilot at the times of the coarser steps are, for errors that fall like h^p and dt^q, the pilot's
//! own errors times `2^p - 1` and `2^q - 1`. For the tip they are kept with their signs, for the errors of space and time
//! may add up or cancel; in the norm of Theorem 3.4 the interpolation error is orthogonal to all the rest, so that squares add,
//! and the difference of two meshes is `√(4^p - 1)` times the error of the finer.

use super::{Request, Trust};
use crate::error::evaluator::{ErrorMeasure, distance, prolong};
use crate::run::family::{Family, Spent};
use convergence_study::judge::fit::{Level, Quantiles, fit_line, pairwise_rates};
use convergence_study::judge::richardson::{growth, orthogonal_growth};
use convergence_study::study::CaseFailure;
use thermobeam::scheme::Scheme;
use thermobeam::solve::Settings;

/// A rate this close to its order is the order: closer than neighbouring orders, wider than what coarse levels show.
const FIRM: f64 = 0.25;
/// Rates outside these multiples of the order say nothing about errors to come.
const LOOSE: [f64; 2] = [0.3, 1.5];

/// The pilots of one scheme so far, coarse to fine.
#[derive(Debug, Clone)]
pub(super) struct Pilots {
    pub(super) scheme: Scheme,
    quantity: ErrorMeasure,
    /// Elements and steps of the last pilot.
    at: [usize; 2],
    /// Differences of the last pilot to the one on half the mesh and to the one with half the steps, over time.
    differences: Vec<[f64; 2]>,
    /// Largest differences of all pilots, over the step that was halved.
    space: Vec<Level>,
    time: Vec<Level>,
    /// Whether the tip of a pilot was in contact at a time of comparison.
    touched: bool,
    pub(super) spent: Spent,
}

/// What the last pilot foretells of finer runs.
#[derive(Debug, Clone)]
pub(super) struct Forecast<'a> {
    pilots: &'a Pilots,
    rates: [f64; 2],
    pub(super) trust: Trust,
}

impl Pilots {
    pub(super) fn new(scheme: Scheme, quantity: ErrorMeasure) -> Self {
        let spent = Spent::default();
        Self { scheme, quantity, at: [0; 2], differences: vec![], space: vec![], time: vec![], touched: false, spent }
    }

    /// Adds the pilot with so many elements and steps, both even.
    pub(super) fn add(&mut self, family: &Family, request: &Request, at: [usize; 2]) -> Result<(), CaseFailure> {
        let [elements, steps] = at;
        let settings = Settings { tolerance: request.tolerance(), ..Settings::default() };
        let (fine, coarse) = (family.on(elements)?, family.on(elements / 2)?);
        let mut pilot = fine.start(self.scheme, settings, steps)?;
        let mut wide = coarse.start(self.scheme, settings, steps)?;
        let mut slow = fine.start(self.scheme, settings, steps / 2)?;
        self.differences.clear();
        for _ in 0..steps / 2 {
            pilot.advance(2)?;
            wide.advance(2)?;
            slow.advance(1)?;
            let level = pilot.level();
            self.touched |= level.contact_force != 0.0;
            let pair = match self.quantity {
                ErrorMeasure::Tip => {
                    let tip = level.u[elements];
                    [tip - wide.level().u[elements / 2], tip - slow.level().u[elements]]
                }
                _ => {
                    let lengths = slow.lengths().to_vec();
                    let wide = prolong(wide.level(), coarse.mesh().nodes(), fine.mesh().nodes());
                    [distance(&lengths, level, &wide), distance(&lengths, level, slow.level())]
                }
            };
            self.differences.push(pair);
        }
        for run in [&pilot, &wide, &slow] {
            self.spent += run.spent();
        }
        self.at = at;
        let largest = [0, 1].map(|axis| largest(self.differences.iter().map(|pair| pair[axis].abs())));
        record(&mut self.space, Level { step: 1.0 / elements as f64, error: largest[0] });
        record(&mut self.time, Level { step: family.t_end / steps as f64, error: largest[1] });
        Ok(())
    }

    /// Orders in space and time that theory gives.
    fn orders(&self) -> [f64; 2] {
        [if self.quantity == ErrorMeasure::Tip { 2.0 } else { 1.0 }, self.scheme.order]
    }

    pub(super) fn forecast(&self, quantiles: &Quantiles) -> Forecast<'_> {
        let orders = self.orders();
        let [space, time] =
            [(&self.space, orders[0]), (&self.time, orders[1])].map(|(levels, order)| rate(levels, order, quantiles));
        let most = if self.touched { Trust::Loose } else { Trust::Firm };
        Forecast { pilots: self, rates: [space.0, time.0], trust: space.1.min(time.1).min(most) }
    }
}

/// Adds a level, or replaces the one of the same step by the new one, whose other step is finer.
fn record(levels: &mut Vec<Level>, level: Level) {
    if levels.last().is_some_and(|last| last.step == level.step) {
        levels.pop();
    }
    levels.push(level);
}

/// The rate to extrapolate with, and how far it can be trusted.
fn rate(levels: &[Level], order: f64, quantiles: &Quantiles) -> (f64, Trust) {
    let rates = pairwise_rates(levels);
    let Some(&last) = rates.last() else { return (order, Trust::None) };
    if (last - order).abs() <= FIRM {
        return (order, Trust::Firm);
    }
    let fitted = fit_line(&levels[levels.len().saturating_sub(3)..], quantiles).map_or(f64::NAN, |line| line.slope);
    if rates.len() >= 2 && fitted >= LOOSE[0] * order && fitted <= LOOSE[1] * order {
        return (fitted.min(order), Trust::Loose);
    }
    (fitted.clamp(LOOSE[0] * order, order), Trust::None)
}

/// The largest of absolute values; NaN if one is.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, value| if value.is_nan() || most.is_nan() { f64::NAN } else { most.max(value) })
}

impl Forecast<'_> {
    /// The scheme of the pilots.
    pub(super) fn scheme(&self) -> Scheme {
        self.pilots.scheme
    }

    /// Whether the tip was in contact: every impact is then resolved anew by every step, and errors fall by fits and starts.
    pub(super) fn touched(&self) -> bool {
        self.pilots.touched
    }

    /// Elements and steps of the last pilot.
    pub(super) fn at(&self) -> [usize; 2] {
        self.pilots.at
    }

    /// Errors of the pilot itself in space and in time, at each time of comparison, times their share in a finer run.
    fn parts(&self, shrink: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
        let [p, q] = self.rates;
        let space = if self.pilots.quantity == ErrorMeasure::Tip { growth(2.0, p) } else { orthogonal_growth(2.0, p) };
        let factors = [shrink[0] / space, shrink[1] / growth(2.0, q)];
        self.pilots.differences.iter().map(move |pair| [pair[0] * factors[0], pair[1] * factors[1]])
    }

    /// The error of a run with so many elements and steps, and the parts of space and time in it.
    pub(super) fn error(&self, [elements, steps]: [f64; 2]) -> (f64, [f64; 2]) {
        let [n, s] = self.pilots.at.map(|count| count as f64);
        let shrink = [(n / elements).powf(self.rates[0]), (s / steps).powf(self.rates[1])];
        let adds = self.pilots.quantity == ErrorMeasure::Tip;
        let (mut total, mut space, mut time) = (0.0_f64, 0.0_f64, 0.0_f64);
        for [a, b] in self.parts(shrink) {
            let here = match (adds, self.trust) {
                (false, _) => a.hypot(b),
                (true, Trust::Firm) => (a + b).abs(),
                // Nobody knows the signs of errors that have no rate.
                (true, _) => a.abs() + b.abs(),
            };
            total = if here.is_nan() { f64::NAN } else { total.max(here) };
            (space, time) = (space.max(a.abs()), time.max(b.abs()));
        }
        (total, [space, time])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(errors: &[f64]) -> Vec<Level> {
        errors.iter().enumerate().map(|(k, &error)| Level { step: 0.5_f64.powi(k as i32), error }).collect()
    }

    #[test]
    fn a_rate_is_trusted_as_far_as_it_is_one() {
        let quantiles = Quantiles::new(0.95).unwrap();
        assert_eq!(rate(&levels(&[1.0]), 2.0, &quantiles), (2.0, Trust::None));
        assert_eq!(rate(&levels(&[1.0, 0.26]), 2.0, &quantiles), (2.0, Trust::Firm));
        let (slope, trust) = rate(&levels(&[1.0, 0.4, 0.16]), 2.0, &quantiles);
        assert!(trust == Trust::Loose && (slope - 2.5_f64.log2()).abs() < 1e-12);
        for errors in [[1.0, 1.1, 1.2], [1.0, f64::NAN, 0.1], [1.0, 0.0, 0.0]] {
            assert_eq!(rate(&levels(&errors), 2.0, &quantiles).1, Trust::None, "{errors:?}");
        }
    }
}
