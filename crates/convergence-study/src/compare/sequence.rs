//! One error on the levels of one record.

use super::{Order, SAME_STEP};
use crate::judge::fit::Level;
use crate::judge::verdict::{Aside, Floor, RateVerdict, observe};
use crate::study::LevelErrors;
use crate::study::outcome::Outcome;
use crate::text::named::NamedNumber;

/// The error at a level.
pub(super) struct LevelPoint<'r> {
    /// The level.
    pub(super) level: &'r LevelErrors,
    /// Its step; NaN if it has none.
    pub(super) step: f64,
    /// The error.
    pub(super) error: f64,
}

/// One error on the levels of one record that have it, and its rate.
pub(super) struct ErrorSequence<'r> {
    /// Coarse to fine.
    pub(super) points: Vec<LevelPoint<'r>>,
    /// Whether the steps fall from level to level; a grid of parameters has no single step.
    pub(super) is_sequence: bool,
    /// The rate that the study has judged.
    pub(super) rate: Option<&'r RateVerdict>,
    /// That rate, or one computed from the errors.
    pub(super) order: Option<Order>,
}

impl<'r> ErrorSequence<'r> {
    pub(super) fn new(outcome: &'r Outcome, name: &str, floor: Floor) -> Self {
        let rate = outcome.rate(name);
        let mut points = vec![];
        for level in &outcome.levels {
            if let Some(error) = NamedNumber::find(&level.errors, name) {
                points.push(LevelPoint {
                    level,
                    step: level.step.unwrap_or(f64::NAN),
                    error,
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
            order = order_of(&observe(&levels.collect::<Vec<_>>(), floor));
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

    /// The point at the level with these parameters, or else at this step.
    pub(super) fn at(&self, level: &LevelErrors, step: f64) -> Option<&LevelPoint<'r>> {
        let mut points = self.points.iter();
        let same = points.find(|point| point.level.parameters == level.parameters);
        same.or_else(|| {
            let mut points = self.points.iter();
            points.find(|point| (point.step / step).ln().abs() <= SAME_STEP)
        })
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
