//! Errors with the lines of their rates.

use std::ops::Range;

use super::Series;
use crate::text::number::{RATE_PLACES, WIDEST_INTERVAL, decimals, interval_places};
use convergence_judge::verdict::RateVerdict;

/// Of a line that only shows a law, in px.
const LAW: f64 = 1.2;

impl Series {
    /// Errors over steps.
    pub fn errors(label: impl Into<String>, x: impl Into<String>, y: impl Into<String>) -> Self {
        Self {
            is_over_steps: true,
            ..Self::new(label, x, y).marked()
        }
    }

    /// The same with this order in theory.
    #[must_use]
    pub fn claiming(self, order: f64) -> Self {
        Self {
            label: format!("{}, order {order}", self.label),
            order: Some(order),
            ..self
        }
    }

    /// The same with the line of its rate, whose digits are those that its interval knows. Of a
    /// rate whose interval is wider than [`WIDEST_INTERVAL`], neither number nor line is drawn.
    #[must_use]
    pub fn judged(self, rate: &RateVerdict) -> Self {
        let Some(law) = rate.power_law() else {
            return self;
        };
        let is_known = rate
            .interval
            .is_none_or(|interval| interval.width() <= WIDEST_INTERVAL);
        if !is_known {
            return Self {
                label: self.label + ", no rate",
                width: 0.0,
                ..self
            };
        }
        let places = rate.interval.map_or(RATE_PLACES - 1, |interval| {
            interval_places(interval, RATE_PLACES)
        });
        let digits = decimals(law.rate, places);
        let words = if law.rate.is_finite() {
            format!(", rate {digits}")
        } else {
            String::new()
        };
        let used: Range<usize> = rate.used.clone();
        Self {
            label: self.label + &words,
            width: LAW,
            law: Some(law),
            used: Some(used),
            ..self
        }
    }
}
