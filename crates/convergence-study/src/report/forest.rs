//! The picture of all judged rates at the head of a report.

use super::words::range;
use crate::judge::verdict::{RateVerdict, Verdict, against_claim};
use crate::plots::{ForestRow, forest};
use crate::project::Project;
use crate::run::Finished;
use crate::study::Figure;
use crate::text::lists;
use crate::text::number::order_text;

/// The name of its file.
///
/// Figures of studies are `<id>-<what>.svg`: a name without a hyphen is not that of a study's figure.
pub(super) const FILE: &str = "rates.svg";

/// Every judged rate relative to its claim, studies in groups; `None` if no rate was judged.
pub(super) fn figure(project: &Project, finished: &[Finished]) -> Option<Figure> {
    let rows = |(label, studies): (_, Vec<&Finished>)| {
        (label, studies.into_iter().filter_map(row).collect())
    };
    let mut groups: Vec<(&str, Vec<ForestRow>)> =
        grouped(project, finished).into_iter().map(rows).collect();
    groups.retain(|(_, rows)| !rows.is_empty());
    let rates: usize = groups
        .iter()
        .flat_map(|(_, rows)| rows)
        .map(|row| row.rates.len())
        .sum();
    if rates == 0 {
        return None;
    }
    let title = format!("All {rates} judged rates, relative to their claims");
    let caption = format!(
        "All {rates} judged rates with their intervals: 0 is the order claimed, the shaded band its tolerance. A rate passes \
         where its whole interval lies in the band."
    );
    Some(Figure {
        file: FILE.to_owned(),
        caption,
        svg: forest(&title, &groups),
    })
}

/// Studies by the property they claim, in the project's order of groups; those of unknown groups last.
pub(super) fn grouped<'f>(
    project: &Project,
    finished: &'f [Finished],
) -> Vec<(&'f str, Vec<&'f Finished>)> {
    let mut groups = lists::grouped(
        finished
            .iter()
            .map(|study| (study.header.group.as_str(), study)),
    );
    let place = |label: &str| {
        project
            .groups
            .iter()
            .position(|group| *group == label)
            .unwrap_or(usize::MAX)
    };
    groups.sort_by_key(|(label, _)| place(label));
    groups
}

fn row(study: &Finished) -> Option<ForestRow> {
    let rates: Vec<RateVerdict> = study
        .outcome
        .rates
        .iter()
        .map(|(_, rate)| rate.clone())
        .collect();
    (!rates.is_empty()).then(|| ForestRow {
        label: study.header.id.clone(),
        rates,
        note: failed(study),
    })
}

/// Most claims that fit next to the rates of one study.
const MOST_CLAIMS: usize = 2;

/// The failing rates, grouped by order: `1.000 to 1.004, claimed 2`; empty if none fails.
fn failed(study: &Finished) -> String {
    let rates = study
        .outcome
        .rates
        .iter()
        .map(|(_, rate)| (rate.order, rate));
    let orders = lists::grouped(
        rates.filter(|(_, rate)| rate.verdict == Verdict::Fail && rate.fitted.is_some()),
    );
    let one = |(order, rates): &(f64, Vec<_>)| {
        against_claim(&range(rates.iter().copied()), &order_text(*order))
    };
    let more = if orders.len() > MOST_CLAIMS {
        "; \u{2026}"
    } else {
        ""
    };
    orders
        .iter()
        .take(MOST_CLAIMS)
        .map(one)
        .collect::<Vec<_>>()
        .join("; ")
        .replace('-', "\u{2212}")
        + more
}
