//! The second half of the study: 29 laws, and three other rules beside ours.

use super::{Part, percent};
use convergence_study::input::{InputError, Section};
use convergence_study::judge::calibration::comparison::{
    CLAIMS, Comparison, HIDDEN_CASES, RULES, SLICES, Score, compare,
};
use convergence_study::judge::calibration::laws::HIDDEN_SHARES;
use convergence_study::plots::{self, Axis, History, Series};
use convergence_study::study::outcome::{Check, Figure, Table};
use convergence_study::study::{Case, CaseFailure};

/// Tables for each of `tables`: 29 laws on 24 and 12 meshes, and 20 of hidden terms in 15 cases.
const TABLES_EACH: f64 = 29.0 * 36.0 + 20.0 * 15.0;

/// Work of a table in the runner's unit, measured: 20 µs for four rules against 25 ns for an element and step.
const TABLE_COST: f64 = 800.0;

/// Place of the tolerance of 0.1 in [`CLAIMS`].
const MIDDLE: usize = 1;

/// Places of 8 levels at that tolerance in [`HIDDEN_CASES`] and of a tenth in [`HIDDEN_SHARES`].
const EIGHT_LEVELS: usize = 1;
const A_TENTH: usize = 2;

/// What the file says of the laws.
pub(super) struct Laws {
    tables: usize,
    seed: u64,
    true_pass: f64,
    false_pass: f64,
    hidden: f64,
}

impl Laws {
    pub(super) fn from_document(root: &Section<'_>) -> Result<Self, InputError> {
        let allowed = "a table with tables, seed, true_pass, false_pass and hidden";
        let section = root.require("laws", allowed)?.section()?;
        section.allow(&["tables", "seed", "true_pass", "false_pass", "hidden"])?;
        let share = |key: &str| {
            let allowed = "a number between 0 and 1";
            section.require(key, allowed)?.number_where(allowed, |share| share > 0.0 && share < 1.0)
        };
        Ok(Self {
            tables: section.require("tables", "a number of tables for each law and mesh")?.count(1..=10_000)?,
            seed: section.require("seed", "an integer >= 0")?.count(0..=usize::MAX)? as u64,
            true_pass: share("true_pass")?,
            false_pass: share("false_pass")?,
            hidden: share("hidden")?,
        })
    }

    pub(super) fn case(&self) -> Case<Part> {
        let cost = self.tables as f64 * TABLES_EACH * TABLE_COST;
        Case { label: format!("{} tables of each law", self.tables), cost, data: Part::Laws }
    }

    pub(super) fn run(&self) -> Result<Comparison, CaseFailure> {
        Ok(compare(self.tables, self.seed)?)
    }

    pub(super) fn checks(&self, found: &Comparison) -> Vec<Check> {
        let mut checks = vec![];
        // The parts of a set of meshes are shown; with few tables of each law chance moves them too far.
        for (slice, described) in SLICES.iter().enumerate().filter(|(_, slice)| slice.whole()) {
            for (claim, (tolerance, off)) in CLAIMS.into_iter().enumerate() {
                let share = found.scores[0][slice].false_pass(claim);
                let allowed = percent(self.false_pass);
                let claim = format!("{}: claims {off} off pass at ±{tolerance} in at most {allowed}", described.name);
                checks.push(Check::that(share <= self.false_pass, claim, percent(share)));
            }
        }
        let share = found.scores[0][0].true_pass(MIDDLE);
        let least = percent(self.true_pass);
        let claim = format!("{}: true claims pass at ±{} in {least} at least", SLICES[0].name, CLAIMS[MIDDLE].0);
        checks.push(Check::that(share >= self.true_pass, claim, percent(share)));
        let share = found.hidden[0][EIGHT_LEVELS][A_TENTH];
        let allowed = percent(self.hidden);
        let claim = format!("a hidden term of 10 % of the finest of 8 errors passes at ±0.1 in at most {allowed}");
        checks.push(Check::that(share <= self.hidden, claim, percent(share)));
        checks
    }

    pub(super) fn headline(found: &Comparison) -> String {
        let score = |rule: usize| &found.scores[rule][0];
        format!(
            "at ±{} this rule passes {:.0} % of true and {} % of wrong claims, least squares {:.0} % and {} %",
            CLAIMS[MIDDLE].0,
            100.0 * score(0).true_pass(MIDDLE),
            few(score(0).false_pass(MIDDLE)),
            100.0 * score(1).true_pass(MIDDLE),
            few(score(1).false_pass(MIDDLE))
        )
    }

    pub(super) fn tables(found: &Comparison) -> Vec<Table> {
        let of = |share: f64| format!("{:.2}", 100.0 * share);
        let score = |slice: usize| {
            let row = |(rule, name): (usize, &&str)| {
                let score = &found.scores[rule][slice];
                let shares = [Score::false_pass, Score::true_pass, Score::false_fail];
                let cells = shares.iter().flat_map(|share| (0..CLAIMS.len()).map(|claim| of(share(score, claim))));
                std::iter::once((*name).to_owned()).chain(cells).collect()
            };
            let heads = [("false pass", true), ("true pass", false), ("false fail", false)];
            let head = heads.into_iter().flat_map(|(what, wrong)| {
                CLAIMS.map(|(tolerance, off)| {
                    let off = if wrong { format!(", {off} off") } else { String::new() };
                    format!("{what} ±{tolerance}{off}")
                })
            });
            Table {
                title: format!("Share of claims that pass or fail (%), 29 error laws, {}", SLICES[slice].name),
                head: std::iter::once("rule".to_owned()).chain(head).collect(),
                rows: RULES.iter().enumerate().map(row).collect(),
            }
        };
        let hidden = |(case, (claim, levels)): (usize, (usize, usize))| {
            let row = |(rule, name): (usize, &&str)| {
                let cells = found.hidden[rule][case].iter().map(|share| of(*share));
                std::iter::once((*name).to_owned()).chain(cells).collect()
            };
            let heads = HIDDEN_SHARES.map(|share| format!("{:.0} %", 100.0 * share));
            Table {
                title: format!(
                    "Share of tables that pass (%) although a term of lower order makes up so much of the finest error, {levels} levels, ±{}",
                    CLAIMS[claim].0
                ),
                head: std::iter::once("rule".to_owned()).chain(heads).collect(),
                rows: RULES.iter().enumerate().map(row).collect(),
            }
        };
        (0..SLICES.len()).map(score).chain(HIDDEN_CASES.into_iter().enumerate().map(hidden)).collect()
    }

    pub(super) fn figures(found: &Comparison, id: &str) -> Vec<Figure> {
        let series = |points: &dyn Fn(usize) -> Vec<(f64, f64)>| -> Vec<Series> {
            let one = |(rule, name): (usize, &&str)| Series { label: (*name).to_owned(), points: points(rule) };
            RULES.iter().enumerate().map(one).collect()
        };
        let trade = History {
            title: Some(format!("Tolerances 0.05, 0.1, 0.2; {}", SLICES[0].name)),
            x_label: "true claims that pass (%)".to_owned(),
            y: Axis::linear("wrong claims that pass (%)"),
            series: series(&|rule| {
                let score = &found.scores[rule][0];
                let point = |k: usize| (100.0 * score.true_pass(k), 100.0 * score.false_pass(k));
                (0..CLAIMS.len()).map(point).collect()
            }),
            ..History::default()
        };
        let hidden = History {
            title: Some("A term of lower order, 8 levels, tolerance 0.1".to_owned()),
            x_label: "share of the finest error (%)".to_owned(),
            y: Axis::linear("tables that pass (%)"),
            series: series(&|rule| {
                let point = |(k, share): (usize, f64)| (100.0 * share, 100.0 * found.hidden[rule][EIGHT_LEVELS][k]);
                HIDDEN_SHARES.into_iter().enumerate().map(point).collect()
            }),
            ..History::default()
        };
        let figure = |what: &str, caption: &str, history: &History| Figure {
            file: format!("{id}-{what}.svg"),
            caption: caption.to_owned(),
            svg: plots::history(history),
        };
        vec![
            figure("trade", "What each rule pays for the true claims it passes: wrong claims that pass, too.", &trade),
            figure(
                "hidden",
                "How often a term of lower order goes unnoticed, by its share of the finest error.",
                &hidden,
            ),
        ]
    }
}

/// A small share in per cent: 0 only where it is none.
fn few(share: f64) -> String {
    let percent = 100.0 * share;
    let places = [1, 2, 3].into_iter().find(|places| percent >= 10f64.powi(-places)).unwrap_or(3);
    if percent == 0.0 { "0".to_owned() } else { format!("{percent:.0$}", places as usize) }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_share_that_is_not_zero_does_not_look_like_it() {
        let texts = [0.0, 0.0004, 0.102, 0.00123, 0.000_012].map(super::few);
        assert_eq!(texts, ["0", "0.04", "10.2", "0.1", "0.001"]);
    }
}
