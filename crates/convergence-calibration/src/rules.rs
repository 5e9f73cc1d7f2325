//! This rule next to those that people use, and with levels added: wrong and true claims, and
//! hidden terms.

use convergence_judge::{
    judge::{
        fit::{Level, fit_line, pairwise_rates},
        verdict::{DEFAULT_TOLERANCE, FEWEST_LEVELS, Judge, Reading},
    },
    text::number::counted,
};
use convergence_study::{Verdict, internal::study::until_decided::is_settled};

use crate::draw::{CalibrationError, Draw};
use crate::hidden::{HIDDEN_SHARES, hidden_term};
use crate::laws::{LAWS, Law, LawErrors, LawGroup, Meshes};
use crate::sheet::{HitShare, Sheet, SheetCell, SheetRow};
use crate::{judge, wrong};

/// Tolerances, each with the distance of the wrong claims from the order.
pub const CLAIMS: [(f64, f64); 3] = [
    (0.05, 0.1),
    (0.1, 0.2),
    (DEFAULT_TOLERANCE, 2.0 * DEFAULT_TOLERANCE),
];

/// Levels at the first look when levels are added.
const FIRST_LOOK: usize = 4;

/// What judges a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// The rule of `convergence-judge` on all levels.
    Ours,
    /// The same with finer levels added, from four on, until the verdict is settled.
    LevelsAdded,
    /// The slope of a straight line.
    LeastSquares,
    /// The finest pairwise rate.
    LastPair,
    /// The defaults of physverify 0.6.
    Physverify,
}

impl Rule {
    /// All rules, ours first.
    pub const ALL: [Self; 5] = [
        Self::Ours,
        Self::LevelsAdded,
        Self::LeastSquares,
        Self::LastPair,
        Self::Physverify,
    ];

    /// Its name in sheets and study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ours => "this rule",
            Self::LevelsAdded => "this rule, levels added",
            Self::LeastSquares => "least squares",
            Self::LastPair => "last pair",
            Self::Physverify => "physverify 0.6",
        }
    }
}

/// What each of the rules decides by.
struct Evidence<'a> {
    /// Four levels, five, and so on to all of them.
    looks: Vec<Reading<'a>>,
    line: f64,
    last: f64,
    four: f64,
    has_fallen: bool,
}

impl<'a> Evidence<'a> {
    fn new(judge: &Judge, levels: &'a [Level]) -> Self {
        let fewest = FIRST_LOOK.min(levels.len());
        let [.., before, finest] = levels else {
            unreachable!("a mesh has three levels at least")
        };
        Self {
            looks: (fewest..=levels.len())
                .map(|count| judge.read(&levels[..count]))
                .collect(),
            line: slope(levels),
            last: pairwise_rates(&[*before, *finest])[0],
            four: slope(&levels[levels.len() - fewest..]),
            has_fallen: before.error / finest.error >= 1.2,
        }
    }

    /// All levels.
    fn all(&self) -> &Reading<'a> {
        &self.looks[self.looks.len() - 1]
    }

    /// The verdict of a rule on this order.
    fn decide(&self, rule: Rule, judge: &Judge, order: f64) -> Verdict {
        let band = [judge.tolerance(); 2];
        match rule {
            Rule::Ours => judge.decide(self.all(), order),
            Rule::LevelsAdded => self.added(judge, order).0,
            Rule::LeastSquares => in_band(self.line, order, band),
            Rule::LastPair => in_band(self.last, order, band),
            Rule::Physverify if self.has_fallen => in_band(self.four, order, [0.3, 1.0]),
            Rule::Physverify => Verdict::Fail,
        }
    }

    /// The verdict when levels are added until one is settled, and how many were added.
    fn added(&self, judge: &Judge, order: f64) -> (Verdict, usize) {
        let mut before = None;
        let mut added = 0;
        for look in &self.looks[..self.looks.len() - 1] {
            let now = judge.decide(look, order);
            if is_settled(now, before) {
                return (now, added);
            }
            before = Some(now);
            added += 1;
        }
        (judge.decide(self.all(), order), added)
    }
}

/// Slope of the least-squares line through the logarithms.
fn slope(levels: &[Level]) -> f64 {
    fit_line(levels).map_or(f64::NAN, |line| line.slope)
}

/// The column of claims that are `off` the order, and pass.
pub fn wrong_pass(tolerance: f64, off: f64) -> String {
    format!("wrong pass, ±{tolerance}, {off} off")
}

/// The column of orders that pass.
pub fn true_pass(tolerance: f64) -> String {
    format!("true pass, ±{tolerance}")
}

/// Verdicts at one tolerance.
#[derive(Debug, Clone, Copy, Default)]
struct Verdicts {
    wrong_pass: HitShare,
    true_pass: HitShare,
    true_fail: HitShare,
}

impl Verdicts {
    /// * `off`: distance of the wrong claims from the order.
    fn count(&mut self, table: &LawErrors, off: f64, verdict: impl Fn(f64) -> Verdict) {
        for claim in wrong(table, off) {
            self.wrong_pass.count(verdict(claim).is_pass());
        }
        if let Some(order) = table.order {
            self.true_pass.count(verdict(order).is_pass());
            self.true_fail.count(verdict(order) == Verdict::Fail);
        }
    }

    fn cells(&self, tolerance: f64, off: f64) -> [SheetCell; 3] {
        [
            self.wrong_pass.cell(wrong_pass(tolerance, off)),
            self.true_pass.cell(true_pass(tolerance)),
            self.true_fail.cell(format!("true fail, ±{tolerance}")),
        ]
    }
}

/// The sheet that compares all rules on one set of meshes.
pub(crate) fn rules(
    key: &'static str,
    meshes_in_words: &str,
    meshes: Meshes,
    tables: usize,
    draw: &mut Draw,
) -> Result<Sheet, CalibrationError> {
    let judges = CLAIMS.map(|(tolerance, _)| judge(tolerance));
    let reader = Judge::default().with_floor(0.0)?;
    let mut counted = [[Verdicts::default(); CLAIMS.len()]; Rule::ALL.len()];
    for ((levels, ratio), law) in meshes
        .each()
        .flat_map(|mesh| LAWS.iter().map(move |law| (mesh, law)))
    {
        for _ in 0..tables {
            let table = law.draw(levels, ratio, draw.next()?);
            let evidence = Evidence::new(&reader, &table.levels);
            for (rule, verdicts) in Rule::ALL.into_iter().zip(&mut counted) {
                for ((judge, (_, off)), verdicts) in judges.iter().zip(CLAIMS).zip(verdicts) {
                    let judge = judge.as_ref().map_err(|error| *error)?;
                    verdicts.count(&table, off, |order| evidence.decide(rule, judge, order));
                }
            }
        }
    }
    let mut rows = vec![];
    for (rule, verdicts) in Rule::ALL.into_iter().zip(&counted) {
        let mut cells = vec![];
        for ((tolerance, off), verdicts) in CLAIMS.into_iter().zip(verdicts) {
            cells.extend(verdicts.cells(tolerance, off));
        }
        rows.push(SheetRow::new(rule.name(), rule == Rule::Ours, cells));
    }
    Ok(Sheet {
        key,
        title: format!("Share of claims that pass or fail, 29 error laws, {meshes_in_words}"),
        rows,
    })
}

/// The verdict of a rule that compares a rate with an order: by how much it may be lower, and
/// higher.
fn in_band(rate: f64, order: f64, [lower, higher]: [f64; 2]) -> Verdict {
    if order - lower <= rate && rate <= order + higher {
        Verdict::Pass
    } else {
        Verdict::Fail
    }
}

/// A number of levels, or to how many levels are added.
struct Look {
    name: &'static str,
    levels: usize,
    rule: Rule,
}

const LOOKS: [Look; 7] = [
    fixed("3 levels", 3),
    fixed("4 levels", 4),
    fixed("5 levels", 5),
    fixed("6 levels", 6),
    fixed("8 levels", 8),
    added("added up to 6", 6),
    added("added up to 8", 8),
];

const fn fixed(name: &'static str, levels: usize) -> Look {
    Look {
        name,
        levels,
        rule: Rule::Ours,
    }
}

const fn added(name: &'static str, levels: usize) -> Look {
    Look {
        name,
        levels,
        rule: Rule::LevelsAdded,
    }
}

/// What one number of levels decides at the default tolerance.
#[derive(Debug, Clone, Copy, Default)]
struct AtLevels {
    true_pass: HitShare,
    true_fail: HitShare,
    wrong_pass: HitShare,
    /// Of claims that differ from the exponent that the coarse levels show.
    visibly_wrong_pass: HitShare,
    interval_holds: HitShare,
    passes_without_coarsest: HitShare,
    /// The mean number of levels that a decision took.
    levels: HitShare,
}

impl AtLevels {
    fn count(&mut self, law: &Law, table: &LawErrors, judge: &Judge, look: &Look) {
        let evidence = Evidence::new(judge, &table.levels);
        let is_added = look.rule == Rule::LevelsAdded;
        if let Some(order) = table.order {
            let verdict = evidence.decide(look.rule, judge, order);
            self.true_pass.count(verdict.is_pass());
            self.true_fail.count(verdict == Verdict::Fail);
            self.levels.add(if is_added {
                FIRST_LOOK + evidence.added(judge, order).1
            } else {
                look.levels
            });
            if let Some(fit) = evidence.all().fit
                && !is_added
                && law.group != LawGroup::Emerging
            {
                self.interval_holds.count(fit.interval.holds(order));
            }
        }
        for claim in wrong(table, 2.0 * DEFAULT_TOLERANCE) {
            let passes = evidence.decide(look.rule, judge, claim).is_pass();
            self.wrong_pass.count(passes);
            if (claim - table.shown).abs() > DEFAULT_TOLERANCE {
                self.visibly_wrong_pass.count(passes);
            }
        }
        if look.levels > FEWEST_LEVELS && !is_added {
            let with = evidence.decide(look.rule, judge, table.shown);
            let without = judge.decide(&judge.read(&table.levels[1..]), table.shown);
            self.passes_without_coarsest
                .count(without.is_pass() && !with.is_pass());
        }
    }

    fn cells(&self) -> Vec<SheetCell> {
        vec![
            self.true_pass.cell("true pass"),
            self.true_fail.cell("true fail"),
            self.wrong_pass.cell("wrong pass"),
            self.visibly_wrong_pass.cell("visibly wrong pass"),
            self.interval_holds.cell("interval holds the order"),
            self.passes_without_coarsest
                .cell("passes without its coarsest level only"),
            self.levels.cell("levels"),
        ]
    }
}

/// Steps halved, at the default tolerance: a fixed number of levels, or levels added up to that
/// number.
pub(crate) fn levels(
    key: &'static str,
    laws: &[Law],
    tables: usize,
    draw: &mut Draw,
) -> Result<Sheet, CalibrationError> {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for look in &LOOKS {
        let mut counted = AtLevels::default();
        for law in laws {
            for _ in 0..tables {
                let table = law.draw(look.levels, 2.0, draw.next()?);
                counted.count(law, &table, &judge, look);
            }
        }
        rows.push(SheetRow::new(look.name, true, counted.cells()));
    }
    let title = format!(
        "Share of claims that pass or fail at ±0.25, {}, steps halved; wrong claims are half an order off",
        counted(laws.len(), "error law")
    );
    Ok(Sheet { key, title, rows })
}

/// The column of a hidden term that makes up this share of the finest error.
pub fn hidden_part(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// How often a term of lower order goes unnoticed, by its share of the finest error.
pub(crate) fn hidden(
    key: &'static str,
    tolerance: f64,
    levels: usize,
    tables: usize,
    draw: &mut Draw,
) -> Result<Sheet, CalibrationError> {
    let judge = judge(tolerance)?;
    let mut rows = Rule::ALL.map(|rule| SheetRow::new(rule.name(), rule == Rule::Ours, vec![]));
    for part in HIDDEN_SHARES {
        let mut passing = [HitShare::default(); Rule::ALL.len()];
        for _ in 0..tables {
            let table = hidden_term(levels, part, draw.next()?);
            let evidence = Evidence::new(&judge, &table.levels);
            for (rule, passing) in Rule::ALL.into_iter().zip(&mut passing) {
                passing.count(evidence.decide(rule, &judge, table.shown).is_pass());
            }
        }
        for (row, passing) in rows.iter_mut().zip(passing) {
            row.cells.push(passing.cell(hidden_part(part)));
        }
    }
    let title = format!(
        "Share of tables that pass although a term of lower order makes up so much of the finest error, {levels} levels, ±{tolerance}"
    );
    Ok(Sheet {
        key,
        title,
        rows: rows.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_other_rules_are_what_they_are_called() {
        // Rates 1, 2, 4 with halved steps.
        let levels: Vec<Level> = [0.0, -1.0, -3.0, -7.0_f64]
            .iter()
            .zip(0..)
            .map(|(exponent, k)| Level {
                step: 0.5_f64.powi(k),
                error: exponent.exp2(),
            })
            .collect();
        let judge = judge(0.1).expect("a tolerance");
        let evidence = Evidence::new(&judge, &levels);
        for (found, expected) in [
            (evidence.line, 2.3),
            (evidence.last, 4.0),
            (evidence.four, 2.3),
        ] {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        for (order, expected) in [(1.31, true), (2.59, true), (1.29, false), (2.61, false)] {
            assert_eq!(
                evidence.decide(Rule::Physverify, &judge, order).is_pass(),
                expected,
                "{order}"
            );
        }
        assert!(
            evidence.decide(Rule::LeastSquares, &judge, 2.35).is_pass()
                && !evidence.decide(Rule::LeastSquares, &judge, 2.45).is_pass()
        );
        assert!(
            evidence.decide(Rule::LastPair, &judge, 4.05).is_pass()
                && !evidence.decide(Rule::LastPair, &judge, 4.15).is_pass()
        );
        let stopped = [1.0, 0.25, 0.06, 0.055]
            .iter()
            .zip(0..)
            .map(|(&error, k)| Level {
                step: 0.5_f64.powi(k),
                error,
            });
        let stopped: Vec<Level> = stopped.collect();
        assert_eq!(
            Evidence::new(&judge, &stopped).decide(Rule::Physverify, &judge, slope(&stopped)),
            Verdict::Fail
        );
    }

    #[test]
    fn levels_are_added_while_nothing_is_decided() {
        let law = |h: f64| Level {
            step: h,
            error: h * h * (1.0 + 2.0 * h),
        };
        let levels: Vec<Level> = (0..8).map(|k| law(0.5_f64.powi(k))).collect();
        let judge = judge(0.25).expect("a tolerance");
        let evidence = Evidence::new(&judge, &levels);
        let (verdict, added) = evidence.added(&judge, 2.0);
        assert!(verdict.is_pass() && (1..4).contains(&added), "{added}");
        let before = &evidence.looks[added - 1];
        assert_eq!(judge.decide(before, 2.0), Verdict::Inconclusive);
        assert_eq!(
            evidence.decide(Rule::LevelsAdded, &judge, 2.0),
            Verdict::Pass
        );
    }
}
