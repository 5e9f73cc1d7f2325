//! One error on the levels of one record, and its values between them.

use super::{Order, SAME_STEP};
use crate::judge::fit::Level;
use crate::judge::verdict::{Aside, Judge, RateVerdict};
use crate::study::LevelErrors;
use crate::study::outcome::Outcome;

/// The error at a level.
pub(super) struct Point<'r> {
    /// The level.
    pub(super) level: &'r LevelErrors,
    /// Its step; NaN if it has none.
    pub(super) step: f64,
    /// The error.
    pub(super) error: f64,
}

/// A value, and by how much it may be off.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    /// The value.
    pub(super) value: f64,
    /// The uncertainty: 0 for a value that is known.
    pub(super) doubt: f64,
}

/// One error on the levels of one record that have it, and its rate.
pub(super) struct ErrorSequence<'r> {
    /// Coarse to fine.
    pub(super) points: Vec<Point<'r>>,
    /// Whether the steps fall from level to level; a grid of parameters has no single step.
    pub(super) is_sequence: bool,
    /// The rate that the study has judged.
    pub(super) rate: Option<&'r RateVerdict>,
    /// That rate, or one computed from the errors.
    pub(super) order: Option<Order>,
}

impl<'r> ErrorSequence<'r> {
    pub(super) fn new(outcome: &'r Outcome, name: &str, rule: &Judge) -> Self {
        let rate = outcome.rate(name);
        let mut points = vec![];
        for level in &outcome.levels {
            if let Some((_, error)) = level.errors.iter().find(|(other, _)| other == name) {
                points.push(Point {
                    level,
                    step: level.step.unwrap_or(f64::NAN),
                    error: *error,
                });
            }
        }
        let is_sequence = points.iter().all(|point| point.step > 0.0)
            && points.windows(2).all(|pair| pair[1].step < pair[0].step);
        let mut order = rate.and_then(order_of);
        if order.is_none() && is_sequence {
            let levels = points.iter().map(|point| Level {
                step: point.step,
                error: point.error,
            });
            order = order_of(&rule.judge(&levels.collect::<Vec<_>>(), 1.0));
        }
        Self {
            points,
            is_sequence,
            rate,
            order,
        }
    }

    /// Whether the study's own floor sets the level with these parameters aside.
    pub(super) fn is_at_floor(&self, level: &LevelErrors) -> bool {
        let place = self
            .points
            .iter()
            .position(|point| point.level.parameters == level.parameters);
        let mut set_aside = self.rate.into_iter().flat_map(|rate| &rate.set_aside);
        set_aside.any(|aside| Some(aside.level) == place && aside.because == Aside::AtFloor)
    }

    /// The error at the level with these parameters.
    pub(super) fn error_at(&self, level: &LevelErrors) -> Option<f64> {
        self.points
            .iter()
            .find(|point| point.level.parameters == level.parameters)
            .map(|point| point.error)
    }

    /// The logarithm of the error at a step between two levels; errors below the floor count as
    /// that.
    pub(super) fn error_at_step(&self, step: f64, floor: f64) -> Option<Estimate> {
        let places: Vec<[f64; 2]> = self
            .points
            .iter()
            .map(|point| [point.step.ln(), point.error.max(floor).ln()])
            .collect();
        interpolate(&places, step.ln())
    }

    /// The logarithm of the work that an error takes.
    pub(super) fn work_at_error(&self, error: f64) -> Option<Estimate> {
        let mut places = vec![];
        for point in &self.points {
            places.push([point.error.ln(), work(point.level)?.ln()]);
        }
        interpolate(&places, error.ln())
    }
}

fn order_of(rate: &RateVerdict) -> Option<Order> {
    let order = rate.fitted?;
    let interval = rate.interval?;
    order.is_finite().then_some(Order { order, interval })
}

/// The work of a level, if it is known.
pub(super) fn work(level: &LevelErrors) -> Option<f64> {
    level.work.filter(|work| *work > 0.0)
}

/// Linear interpolation between points with decreasing x.
///
/// The uncertainty is twice the bound Δ x / 8 of smooth data, Δ being the change of the slope to a
/// neighbouring interval and x the length of this one.
fn interpolate(points: &[[f64; 2]], x: f64) -> Option<Estimate> {
    let mut same = points.iter();
    if let Some([_, value]) = same.find(|point| (point[0] - x).abs() <= SAME_STEP) {
        return Some(Estimate {
            value: *value,
            doubt: 0.0,
        });
    }
    let k = points
        .windows(2)
        .position(|pair| pair[0][0] > x && x > pair[1][0])?;
    let slopes: Vec<f64> = points
        .windows(2)
        .map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]))
        .collect();
    let first = k.saturating_sub(1);
    let end = (k + 2).min(slopes.len());
    let changes = slopes[first..end]
        .iter()
        .map(|slope| (slope - slopes[k]).abs());
    let change = changes.fold(0.0, f64::max);
    Some(Estimate {
        value: points[k][1] + slopes[k] * (x - points[k][0]),
        doubt: 0.25 * change * (points[k][0] - points[k + 1][0]),
    })
}
