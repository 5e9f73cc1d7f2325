//! The rates by variant, with their intervals, against the order that is claimed.

use super::words::order;
use crate::chart::{Row, rates_of};
use crate::run::{Fate, WhereLost};
use crate::study::{Figure, Header, Outcome};
use convergence_judge::verdict::Verdict;

/// What the colours mean.
const COLOURS: [&str; 3] = ["order reached", "undecided", "lost"];

impl WhereLost {
    /// Rates of the first error that has lost its order: the study's own, then those of its
    /// variants; `None` if it claims nothing.
    ///
    /// * `base`: the study itself.
    pub fn figure(&self, header: &Header, base: &Outcome) -> Option<Figure> {
        let of_base = base.rates.iter().find(|rate| {
            let mut rates = self.variants.iter().flat_map(|row| &row.rates);
            rates.any(|found| found.error == rate.name)
        });
        let error = &of_base?.name;
        let rate = base.rate(error)?;
        let mut rows = vec![Row::new("the solution itself".to_owned(), rate)];
        for variant in &self.variants {
            let Some(found) = variant.rates.iter().find(|found| found.error == *error) else {
                continue;
            };
            let verdict = match variant.order {
                Fate::Back | Fate::RoundOff => Verdict::Pass,
                Fate::Unknown => Verdict::Inconclusive,
                Fate::Lost => Verdict::Fail,
            };
            let name = format!("{}: {}", variant.name, order(variant));
            rows.push(Row {
                verdict,
                ..Row::new(name, &found.rate)
            });
        }
        let title = format!("{}: rate of the error {error} by variant", header.id);
        let caption = format!(
            "Rates of the error {error} with variants of the solution: {}",
            self.conclusion
        );
        let chart = rates_of(rate.claimed?, COLOURS, rows).titled(title);
        Some(Figure::of(&format!("{}-where", header.id), caption, chart))
    }
}
