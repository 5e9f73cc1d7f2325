//! Values without an exact solution: the rates of their differences, and their limits.

use super::{CaseRun, Program};
use crate::column::Column;
use crate::study::over_levels::{self, ERROR_TOLERANCE, ErrorColumn, Levels, Refinement};
use crate::study::{Claim, Figure, NamedRate, Outcome, Quantity, Subject, Table};
use crate::text::number::{error_text, plain_text, rate_text};
use convergence_judge::richardson::{Bar, Estimate, Estimator, Gci};
use convergence_judge::verdict::{Level, Reason, Verdict};

/// The findings on the values of a study: the rates of their differences, and the limits in a
/// sentence.
///
/// * `refinements`: one for each of `ran`, with its step.
pub(super) fn judge(study: &Program, ran: &[CaseRun], refinements: &[Refinement]) -> Outcome {
    let found: Vec<_> = ran
        .iter()
        .map(|ran| ran.ok().map(|answer| answer.values.as_slice()))
        .collect();
    let columns = ErrorColumn::of(&study.claims(true), &found);
    let estimates: Vec<(&ErrorColumn, Estimate)> = columns
        .iter()
        .filter_map(|column| Some((column, estimate(column, &columns, refinements)?)))
        .collect();
    let rates: Vec<_> = estimates
        .iter()
        .map(|(column, estimate)| NamedRate::new(name(column), estimate.judged.clone()))
        .collect();
    let guarded = refinements.iter().enumerate();
    let guarded = guarded.flat_map(|(level, Refinement { label, .. })| {
        columns
            .iter()
            .map(move |column| quantity(column, level, label))
    });
    let summary = estimates
        .iter()
        .filter_map(|(column, estimate)| sentence(column, estimate))
        .collect::<Vec<_>>();
    let limits = (!estimates.is_empty()).then(|| limits(&estimates));
    let values = (!columns.is_empty()).then(|| table_of_values(&columns, refinements));
    let figure =
        (!estimates.is_empty()).then(|| differences(study, &estimates, refinements, &rates));
    Outcome {
        tables: limits.into_iter().chain(values).collect(),
        figures: figure.into_iter().collect(),
        quantities: over_levels::rate_quantities(&rates, &[])
            .into_iter()
            .chain(guarded)
            .collect(),
        ..Outcome::new(summary.join("; "), rates, vec![])
    }
}

/// The name of a value among the rates: an error may have the same name.
fn name(column: &ErrorColumn) -> String {
    format!("value {}", column.name)
}

/// The value on a level, which the baseline guards.
fn quantity(column: &ErrorColumn, level: usize, label: &str) -> Quantity {
    let value = name(column);
    Quantity::new(
        format!("{value}, {label}"),
        column.errors[level].unwrap_or(f64::NAN),
        ERROR_TOLERANCE,
    )
    .about(Subject::of(value).in_case(label))
}

/// `None` if nothing is claimed about the value. A level without a result makes the verdict fail;
/// the estimate uses the others.
///
/// * `columns`: all values.
fn estimate(
    column: &ErrorColumn,
    columns: &[ErrorColumn],
    refinements: &[Refinement],
) -> Option<Estimate> {
    let Claim {
        order, tolerance, ..
    } = column.claim?;
    let levels = refinements.iter().zip(&column.errors);
    let values = levels.clone().filter_map(|(level, value)| {
        Some(Level {
            step: level.step,
            error: (*value)?,
        })
    });
    let answered = Column::of_answers(&column.name, values.collect());
    let estimate = answered.estimate(&Estimator::new(tolerance).ok()?, Some(order));
    let without = levels.filter(|(_, value)| value.is_none());
    let missing: Vec<&str> = without.map(|(level, _)| level.label.as_str()).collect();
    if missing.is_empty() {
        return Some(estimate);
    }
    let judged = estimate.judged.without_result(refinements.len(), &missing);
    let judged = match column.unknown("a value", columns) {
        Some(unknown) => judged.with_reason(Reason::NoResult, &unknown),
        None => judged,
    };
    Some(Estimate { judged, ..estimate })
}

/// The differences of neighbouring levels, each at the finer of its steps, with the lines of their
/// rates.
fn differences(
    study: &Program,
    estimates: &[(&ErrorColumn, Estimate)],
    refinements: &[Refinement],
    rates: &[NamedRate],
) -> Figure {
    let columns = estimates.iter().map(|(column, _)| {
        let pairs = column.errors.windows(2);
        let differences = pairs.map(|pair| Some((pair[0]? - pair[1]?).abs()));
        ErrorColumn {
            claim: column.claim,
            style: column.style,
            ..ErrorColumn::without_claim(name(column), differences)
        }
    });
    let levels = Levels::new(study.refine.axis(), refinements[1..].to_vec(), columns);
    let levels = levels.of_differences();
    let caption = "Differences of neighbouring levels, each at the finer of its steps.";
    // A rate across a gap is fitted to other differences than those drawn.
    let drawn: Vec<_> = rates
        .iter()
        .filter(|named| named.rate.code != Reason::NoResult)
        .cloned()
        .collect();
    levels.figure("differences", None, caption.to_owned(), &drawn)
}

const HEAD: [&str; 9] = [
    "value",
    "finest",
    "rate",
    "limit",
    "limit, between",
    "finest - limit",
    "error, between",
    "GCI",
    "GCI's order, factor",
];

/// Limit, error bar and grid convergence index of each value with a claimed order, or why they are
/// missing.
fn limits(estimates: &[(&ErrorColumn, Estimate)]) -> Table {
    Table::new(
        "Limits without an exact solution, and how far the finest level is from them",
        HEAD,
        estimates
            .iter()
            .map(|(column, estimate)| limit_cells(column, estimate)),
    )
}

fn limit_cells(column: &ErrorColumn, estimate: &Estimate) -> Vec<String> {
    let finest = column.errors.iter().rev().copied().flatten().next();
    let finest = finest.map_or("-".to_owned(), |value| digits(value, width(estimate)));
    let rate = estimate
        .judged
        .fitted
        .or_else(|| estimate.judged.finest_rate());
    let mut row = vec![column.name.clone(), finest, rate_text(rate)];
    row.extend(match &estimate.bar {
        Ok(bar) => bar_cells(bar),
        Err(refusal) => [
            format!("none: {refusal}"),
            "-".into(),
            "-".into(),
            "-".into(),
        ],
    });
    row.extend(match &estimate.gci {
        Ok(Gci {
            half_width,
            order,
            factor,
            ..
        }) => [error_text(*half_width), format!("{order:.3}, {factor}")],
        Err(refusal) => [format!("none: {refusal}"), "-".into()],
    });
    row
}

fn bar_cells(bar: &Bar) -> [String; 4] {
    let [limit, low, high] = limit_and_ends(bar);
    let [least, most] = <[f64; 2]>::from(bar.error_interval).map(error_text);
    [
        limit,
        format!("{low} to {high}"),
        error_text(bar.error),
        format!("{least} to {most}"),
    ]
}

/// The limit, and the ends of its interval.
fn limit_and_ends(bar: &Bar) -> [String; 3] {
    let [low, high] = bar.limit.into();
    [bar.extrapolated, low, high].map(|number| digits(number, bar.limit.width()))
}

/// The width of the interval of the limit; NaN if there is none.
fn width(estimate: &Estimate) -> f64 {
    estimate
        .bar
        .as_ref()
        .map_or(f64::NAN, |bar| bar.limit.width())
}

/// A number with enough decimals to show two digits of `width`; with an exponent if that takes more
/// than 15.
fn digits(value: f64, width: f64) -> String {
    let places = 1.0 - width.log10().floor();
    if (0.0..=15.0).contains(&places) {
        return format!("{value:.*}", places as usize);
    }
    let after_the_first = value.abs().log10().floor() + places;
    let is_plain =
        (1e-3..1e6).contains(&value.abs()) && !(5.0..f64::INFINITY).contains(&after_the_first);
    if value == 0.0 || !value.is_finite() || is_plain {
        return plain_text(value);
    }
    // No more digits than a floating-point number has; six if the width is unknown.
    let digits = if after_the_first.is_finite() {
        after_the_first.clamp(1.0, 16.0)
    } else {
        5.0
    };
    format!("{value:.*e}", digits as usize)
}

/// The values, each with enough decimals to show its last change.
fn table_of_values(columns: &[ErrorColumn], refinements: &[Refinement]) -> Table {
    let rows = refinements.iter().enumerate().map(|(level, refinement)| {
        let values = columns.iter().map(|column| match column.errors[level] {
            Some(value) => digits(value, last_change(column)),
            None => "-".to_owned(),
        });
        [refinement.label.clone()]
            .into_iter()
            .chain(values)
            .collect()
    });
    let head = ["level"]
        .into_iter()
        .chain(columns.iter().map(|column| column.name.as_str()));
    Table::new("Values", head, rows)
}

/// The distance of the last two values; NaN without them.
fn last_change(column: &ErrorColumn) -> f64 {
    let values: Vec<f64> = column.errors.iter().copied().flatten().collect();
    match values[..] {
        [.., before, last] => (last - before).abs(),
        _ => f64::NAN,
    }
}

/// The limit with its interval, if the rate is the claimed one; otherwise the summary of the rates
/// says what is wrong.
fn sentence(column: &ErrorColumn, estimate: &Estimate) -> Option<String> {
    let bar = estimate
        .bar
        .as_ref()
        .ok()
        .filter(|_| estimate.judged.verdict == Verdict::Pass)?;
    let [limit, low, high] = limit_and_ends(bar);
    let name = &column.name;
    Some(format!("{name} tends to {limit} ({low} to {high})"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rows::rows;

    #[test]
    fn two_digits_of_the_interval_are_shown() {
        for [value, half, shown] in rows(include_str!("values/digits.md")) {
            let [value, half] = [value, half].map(|text| text.parse().expect("a number"));
            assert_eq!(digits(value, half), shown);
        }
    }
}
