//! One error in both records: the four questions, in their order.

use super::sequence::{ErrorSequence, LevelPoint, work};
use super::{ORDER_SHIFT, SAME_STEP, Shift, WORK_WITHIN};
use crate::judge::verdict::Verdict;
use crate::study::LevelErrors;
use crate::text::named::NamedNumber;
use crate::text::number::plain_text;

/// One error in both records.
pub(super) struct Both<'r> {
    /// In the old record.
    pub(super) old: ErrorSequence<'r>,
    /// In the new record.
    pub(super) new: ErrorSequence<'r>,
    /// Smaller errors count as this.
    pub(super) floor: f64,
    /// As for [`compare`](super::compare).
    pub(super) within: f64,
}

/// What became of an error, and why.
pub(super) struct ErrorShift {
    /// What became of it.
    pub(super) change: Shift,
    /// Why.
    pub(super) reason: String,
}

impl ErrorShift {
    fn new(change: Shift, reason: impl Into<String>) -> Self {
        Self {
            change,
            reason: reason.into(),
        }
    }
}

/// The logarithm of the new error over the old one at a level of both records.
struct Ratio<'r> {
    level: &'r LevelErrors,
    log: f64,
}

impl Both<'_> {
    /// The first question that finds a difference; a better order is a smaller matter than a
    /// larger error.
    pub(super) fn judge(&self) -> ErrorShift {
        if let Some(reason) = self.loss() {
            return ErrorShift::new(Shift::Lost, reason);
        }
        let order = self.change_of_order();
        if let Some(order) = &order
            && order.change == Shift::Worse
        {
            return ErrorShift::new(Shift::Worse, &order.reason);
        }
        let ratios = self.ratios();
        if let Some(reason) = self.loss_of_finite_errors() {
            return ErrorShift::new(Shift::Worse, reason);
        }
        if let Some(reason) = self.growth(&ratios) {
            return ErrorShift::new(Shift::Worse, reason);
        }
        order.unwrap_or_else(|| self.smaller_or_cheaper(&ratios))
    }

    /// What the new record lacks.
    fn loss(&self) -> Option<String> {
        let Self { old, new, .. } = self;
        if new.points.is_empty() && !old.points.is_empty() {
            return Some("the new record does not have the error".to_owned());
        }
        if old.rate.is_some() && new.rate.is_none() {
            return Some("the new record does not judge its rate".to_owned());
        }
        let finest = old.points.last()?;
        let is_lost = if old.is_sequence && new.is_sequence {
            (new.points.last()?.step / finest.step).ln() > SAME_STEP
        } else {
            new.at(finest.level, finest.step).is_none()
        };
        let level = label(finest.level);
        is_lost.then(|| format!("the new record does not have the finest level, {level}"))
    }

    /// Another order, or a claim that no longer passes.
    fn change_of_order(&self) -> Option<ErrorShift> {
        if let (Some(old), Some(new)) = (self.old.order, self.new.order) {
            let apart =
                old.interval.high < new.interval.low || new.interval.high < old.interval.low;
            if apart && (new.order - old.order).abs() > ORDER_SHIFT {
                let is_lower = new.order < old.order;
                let change = if is_lower {
                    Shift::Worse
                } else {
                    Shift::Better
                };
                return Some(ErrorShift::new(change, format!("order {old} → {new}")));
            }
        }
        let old = self.old.rate?;
        let new = self.new.rate?;
        if old.verdict != Verdict::Pass || new.verdict == Verdict::Pass {
            return None;
        }
        let reason = format!(
            "the claimed order was pass, is {}: {}",
            new.verdict, new.reason
        );
        Some(ErrorShift::new(Shift::Worse, reason))
    }

    /// Levels whose error has become negative, infinite or NaN.
    fn loss_of_finite_errors(&self) -> Option<String> {
        let mut levels = vec![];
        for LevelPoint { level, step, error } in &self.new.points {
            let before = self.old.at(level, *step);
            if !is_error(*error) && before.is_some_and(|point| is_error(point.error)) {
                levels.push(label(level));
            }
        }
        let list = levels.join("; ");
        (!levels.is_empty()).then(|| format!("no longer a finite number >= 0 at {list}"))
    }

    /// For each level of both records whose errors can be compared.
    fn ratios(&self) -> Vec<Ratio<'_>> {
        let points = self.new.points.iter();
        points
            .filter(|point| point.error >= 0.0)
            .filter(|point| {
                !self.old.is_at_floor(point.level) && !self.new.is_at_floor(point.level)
            })
            .filter_map(|point| self.ratio(point))
            .collect()
    }

    fn ratio<'p>(&self, point: &LevelPoint<'p>) -> Option<Ratio<'p>> {
        let before = self.old.at(point.level, point.step)?;
        let log = point.error.max(self.floor).ln() - before.error.max(self.floor).ln();
        Some(Ratio {
            level: point.level,
            // Two zeros without a floor are the same.
            log: if log.is_nan() { 0.0 } else { log },
        })
    }

    /// The largest difference of the logarithms of errors that are the same.
    fn limit(&self) -> f64 {
        self.within.ln_1p()
    }

    /// Levels with larger errors.
    fn growth(&self, ratios: &[Ratio<'_>]) -> Option<String> {
        let larger: Vec<&Ratio<'_>> = ratios
            .iter()
            .filter(|ratio| ratio.log > self.limit())
            .collect();
        let worst = larger.iter().max_by(|a, b| a.log.total_cmp(&b.log))?;
        Some(format!(
            "errors larger at {} of {} levels that both have: {}: {} times",
            larger.len(),
            ratios.len(),
            label(worst.level),
            plain_text(worst.log.exp())
        ))
    }

    /// What became of errors none of which is larger: smaller, unclear, or the same, for which the
    /// work is compared.
    fn smaller_or_cheaper(&self, ratios: &[Ratio<'_>]) -> ErrorShift {
        let count = ratios.len();
        let limit = self.limit();
        if count == 0 {
            let is_empty = self.old.points.is_empty() && self.new.points.is_empty();
            let explanation = if is_empty {
                "no errors are recorded, only rates"
            } else {
                "no level is at a step that both have"
            };
            let reason = format!("no difference of orders is proven; {explanation}");
            return ErrorShift::new(Shift::NotProven, reason);
        }
        let mut logs = ratios.iter().map(|ratio| ratio.log);
        if logs.clone().all(|log| log < -limit) {
            let most = logs.fold(f64::NEG_INFINITY, f64::max);
            let times = plain_text(most.exp());
            let reason = format!("errors smaller: {times} times or less at {count} levels");
            return ErrorShift::new(Shift::Better, reason);
        }
        if !logs.all(|log| log.abs() <= limit) {
            let reason = format!("no difference of errors is proven at {count} levels");
            return ErrorShift::new(Shift::NotProven, reason);
        }
        match self.work() {
            Some(work) if work.abs() > WORK_WITHIN.ln_1p() => {
                let change = if work > 0.0 {
                    Shift::Worse
                } else {
                    Shift::Better
                };
                let times = work.exp();
                let reason = format!("the same error takes {times:.3} times the work");
                ErrorShift::new(change, reason)
            }
            _ => ErrorShift::new(Shift::Same, format!("errors the same at {count} levels")),
        }
    }

    /// The logarithm of the new work over the old one at the finest level of both, where the errors
    /// are the same.
    fn work(&self) -> Option<f64> {
        let mut finest = self.new.points.iter().rev();
        let both = finest.find_map(|new| Some([self.old.at(new.level, new.step)?, new]));
        let [old, new] = both?;
        Some((work(new.level)? / work(old.level)?).ln())
    }
}

/// Whether a number can be an error.
fn is_error(number: f64) -> bool {
    number >= 0.0 && number.is_finite()
}

/// The parameters of a level.
fn label(level: &LevelErrors) -> String {
    let parameters = level.parameters.iter();
    let parameters: Vec<String> = parameters
        .map(|NamedNumber { name, value }| format!("{name} = {value}"))
        .collect();
    parameters.join(", ")
}
