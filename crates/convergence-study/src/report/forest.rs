//! The picture of the rates nearest to a failure at the head of a report.

use crate::chart::{Row, deviations, without_title};
use crate::run::Finished;
use crate::study::{Figure, NamedRate};
use convergence_judge::verdict::{RateVerdict, Verdict};

/// The name of its file.
///
/// Figures of studies are `<id>-<what>.svg`: a name without a hyphen is not that of a study's
/// figure.
const NAME: &str = "rates";

/// Most rates in the picture.
const MOST: usize = 10;

/// The judged rates that do not pass, then those whose intervals are the widest, in tolerances;
/// `None` if no rate was judged.
pub(super) fn figure(finished: &[Finished], has_titles: bool) -> Option<Figure> {
    let mut rates: Vec<StudyRate<'_>> = vec![];
    for study in finished {
        for NamedRate { name, rate, .. } in &study.outcome.rates {
            rates.push(StudyRate {
                study: &study.header.id,
                name,
                rate,
            });
        }
    }
    let count = rates.len();
    let failing = rates
        .iter()
        .filter(|entry| entry.rate.verdict != Verdict::Pass)
        .count();
    // Stable, so that equal rates keep the order of the studies.
    rates.sort_by(|StudyRate { rate: a, .. }, StudyRate { rate: b, .. }| {
        let worst_first = b.verdict.cmp(&a.verdict);
        worst_first.then(width(b).total_cmp(&width(a)))
    });
    rates.truncate(MOST);
    let title = match (count, failing) {
        (0, _) => return None,
        (_, 1..) => format!("{failing} of {count} judged rates do not pass"),
        (..=MOST, 0) => format!("All {count} judged rates lie within their tolerances"),
        (_, 0) => format!("The {MOST} widest of {count} intervals, within their tolerances"),
    };
    let caption = format!(
        "{} of {count} judged rates, those that do not pass first, then the widest intervals: 0 is the order claimed, \
         the shaded band its tolerance. A rate passes where its whole interval lies in the band.",
        rates.len()
    );
    let rows: Vec<Row> = rates.into_iter().map(row).collect();
    let svg = deviations(rows).titled(title).svg();
    let svg = if has_titles { svg } else { without_title(&svg) };
    Some(Figure::new(NAME, caption, svg))
}

/// The width of a rate's interval in units of its tolerance; infinite without one.
fn width(rate: &RateVerdict) -> f64 {
    match (rate.interval, rate.claimed) {
        (Some(interval), Some(band)) => interval.width() / band.tolerance,
        _ => f64::INFINITY,
    }
}

/// A judged rate of a study.
struct StudyRate<'f> {
    study: &'f str,
    name: &'f str,
    rate: &'f RateVerdict,
}

fn row(StudyRate { study, name, rate }: StudyRate<'_>) -> Row {
    let interval = rate.interval;
    Row {
        value: rate.fitted.map(|value| relative(rate, value)),
        interval: interval.map(|ends| ends.map(|end| relative(rate, end))),
        ..Row::new(format!("{study}: {name}"), rate)
    }
}

/// A value in units of its claim's tolerance; NaN without a claim, which no picture shows.
fn relative(rate: &RateVerdict, value: f64) -> f64 {
    rate.claimed.map_or(f64::NAN, |band| band.distance(value))
}
