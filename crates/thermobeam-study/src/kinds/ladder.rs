//! Errors down a ladder of refinements: what every study of rates judges, prints, draws and guards.

use convergence_study::judge::fit::Level;
use convergence_study::judge::verdict::{RateVerdict, judge};
use convergence_study::plots::{self, Convergence, ErrorSeries, PowerLaw};
use convergence_study::study::{Axis, Figure, Quantity, Table};

/// Relative change of an error that the baseline lets pass: other machines round sines and logarithms differently.
const ERROR_DRIFT: f64 = 1e-6;

/// The same for a fitted rate.
const RATE_DRIFT: f64 = 1e-4;

/// Errors of one kind, one for each level, coarse to fine.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Family {
    /// Name in tables, figures and verdicts.
    pub(crate) name: String,
    /// As measured; NaN where the case failed.
    pub(crate) errors: Vec<f64>,
    /// What theory says.
    pub(crate) order: f64,
    /// How far the rate may be from it.
    pub(crate) tolerance: f64,
}

/// Families over the same steps.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ladder {
    /// What is refined.
    pub(crate) axis: Axis,
    /// h, dt, or h = c dt, decreasing.
    pub(crate) steps: Vec<f64>,
    /// The errors.
    pub(crate) families: Vec<Family>,
}

impl Ladder {
    fn levels(&self, family: &Family) -> Vec<Level> {
        self.steps.iter().zip(&family.errors).map(|(&step, &error)| Level { step, error }).collect()
    }

    /// One verdict for each family.
    pub(crate) fn judge(&self) -> Vec<(String, RateVerdict)> {
        let verdict = |family: &Family| judge(&self.levels(family), family.order, family.tolerance);
        self.families.iter().map(|family| (family.name.clone(), verdict(family))).collect()
    }

    /// The plot of all families, each with the line of its judged rate.
    pub(crate) fn figure(&self, file: String, title: &str, caption: String, rates: &[(String, RateVerdict)]) -> Figure {
        let series = self.families.iter().map(|family| {
            let rate = rates.iter().find(|(name, _)| *name == family.name);
            ErrorSeries {
                label: family.name.clone(),
                points: self.steps.iter().copied().zip(family.errors.iter().copied()).collect(),
                order: Some(family.order),
                fit: rate.and_then(|(_, rate)| line(&self.levels(family), rate)),
                ..ErrorSeries::default()
            }
        });
        let mut slopes: Vec<f64> = self.families.iter().map(|family| family.order).collect();
        slopes.sort_by(f64::total_cmp);
        slopes.dedup();
        let labels = match self.axis {
            Axis::Space => Convergence::in_space(),
            Axis::Time => Convergence::in_time(),
            Axis::Both => Convergence {
                x_label: "mesh width h and time step dt, refined together".into(),
                ..Convergence::in_space()
            },
        };
        let figure = Convergence { title: Some(title.to_owned()), series: series.collect(), slopes, ..labels };
        Figure { file, caption, svg: plots::convergence(&figure) }
    }

    /// The finest error and the rate of each family.
    pub(crate) fn quantities(&self, rates: &[(String, RateVerdict)]) -> Vec<Quantity> {
        let finest = self.families.iter().map(|family| Quantity {
            name: format!("{}, finest error", family.name),
            value: family.errors.last().copied().unwrap_or(f64::NAN),
            tolerance: ERROR_DRIFT,
        });
        finest.chain(rate_quantities(rates)).collect()
    }
}

/// The fitted rates, as numbers that must not move unnoticed.
pub(crate) fn rate_quantities(rates: &[(String, RateVerdict)]) -> impl Iterator<Item = Quantity> {
    rates.iter().map(|(name, rate)| Quantity {
        name: format!("{name}, rate"),
        value: rate.fitted.unwrap_or(f64::NAN),
        tolerance: RATE_DRIFT,
    })
}

/// The judged rate as a line through the finest level that it rests on.
///
/// Not least squares: the rate is the one at h → 0, and coarse levels that leave its line show how far they are from there.
fn line(levels: &[Level], rate: &RateVerdict) -> Option<PowerLaw> {
    let finest = levels.get(rate.used.clone())?.last()?;
    let rate = rate.fitted?;
    Some(PowerLaw { rate, constant: finest.error / finest.step.powf(rate) })
}

/// Order, rate, error bar and verdict of each, in a table.
pub(crate) fn rate_table(title: &str, rates: &[(String, RateVerdict)]) -> Table {
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4}"));
    let row = |(name, rate): &(String, RateVerdict)| {
        let pairwise: Vec<String> = rate.pairwise.iter().map(|rate| format!("{rate:.3}")).collect();
        let interval = rate.interval.map_or_else(|| "-".to_owned(), |[low, high]| format!("{low:.4} to {high:.4}"));
        vec![
            name.clone(),
            rate.order.to_string(),
            pairwise.join(" "),
            number(rate.fitted),
            interval,
            rate.verdict.to_string(),
            rate.kind.text().to_owned(),
        ]
    };
    Table {
        title: title.to_owned(),
        head: ["error of", "order", "pairwise rates", "rate", "95 % interval", "verdict", "because"]
            .map(str::to_owned)
            .into(),
        rows: rates.iter().map(row).collect(),
    }
}

/// `tip 1.000 (order 1)` for each.
pub(crate) fn summary(rates: &[(String, RateVerdict)]) -> String {
    let one = |(name, rate): &(String, RateVerdict)| match rate.fitted {
        Some(fitted) => format!("{name} {fitted:.3} (order {})", rate.order),
        None => format!("{name} {} ({})", rate.verdict, rate.kind.text()),
    };
    rates.iter().map(one).collect::<Vec<_>>().join("; ")
}

pub(crate) use super::untyped::{completion, value};
