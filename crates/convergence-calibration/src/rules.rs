//! This rule next to those that people use, and with levels added: wrong and true claims, and
//! hidden terms.

use convergence_judge::{
    fit::{Level, fit_line, pairwise_rates},
    text::number::counted,
    verdict::{DEFAULT_TOLERANCE, FEWEST_LEVELS, Judge, Reading},
};
use convergence_study::{Budget, Verdict};

use crate::draw::{Counted, Draw};
use crate::hidden::{HIDDEN_SHARES, hidden_term};
use crate::laws::{LAWS, Law, LawErrors, LawGroup, Meshes};
use crate::sheet::{Sheet, SheetRow};
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

    /// Its row, for which only our rule answers.
    fn row(self, columns: &[String]) -> SheetRow {
        SheetRow::new(self.name(), self == Self::Ours, columns)
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
            if Budget::is_settled(now, before) {
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

/// Counts the verdicts at one tolerance.
///
/// * `columns`: of wrong claims that pass, and of orders that pass and fail.
/// * `off`: distance of the wrong claims from the order.
fn count_claims(
    row: &mut SheetRow,
    [wrong_pass, true_pass, true_fail]: &[String; 3],
    table: &LawErrors,
    off: f64,
    verdict: impl Fn(f64) -> Verdict,
) {
    for claim in wrong(table, off) {
        row.count(wrong_pass, verdict(claim).is_pass());
    }
    if let Some(order) = table.order {
        row.count(true_pass, verdict(order).is_pass());
        row.count(true_fail, verdict(order) == Verdict::Fail);
    }
}

/// The sheet that compares all rules on one set of meshes.
pub(crate) fn rules(
    key: &'static str,
    meshes_in_words: &str,
    meshes: Meshes,
    tables: usize,
    draw: &mut Draw,
) -> Counted {
    let mut judges = vec![];
    let mut columns = vec![];
    for (tolerance, off) in CLAIMS {
        judges.push(judge(tolerance)?);
        columns.push([
            wrong_pass(tolerance, off),
            true_pass(tolerance),
            format!("true fail, ±{tolerance}"),
        ]);
    }
    let reader = Judge::default().with_floor(0.0)?;
    let mut rows = Rule::ALL.map(|rule| rule.row(columns.as_flattened()));
    for ((levels, ratio), law) in meshes
        .each()
        .flat_map(|mesh| LAWS.iter().map(move |law| (mesh, law)))
    {
        for _ in 0..tables {
            let table = law.draw(levels, ratio, draw.next()?);
            let evidence = Evidence::new(&reader, &table.levels);
            for (rule, row) in Rule::ALL.into_iter().zip(&mut rows) {
                for ((judge, columns), (_, off)) in judges.iter().zip(&columns).zip(CLAIMS) {
                    let verdict = |order| evidence.decide(rule, judge, order);
                    count_claims(row, columns, &table, off, verdict);
                }
            }
        }
    }
    Ok(Sheet {
        key,
        title: format!("Share of claims that pass or fail, 29 error laws, {meshes_in_words}"),
        rows: rows.to_vec(),
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
    look("3 levels", 3, Rule::Ours),
    look("4 levels", 4, Rule::Ours),
    look("5 levels", 5, Rule::Ours),
    look("6 levels", 6, Rule::Ours),
    look("8 levels", 8, Rule::Ours),
    look("added up to 6", 6, Rule::LevelsAdded),
    look("added up to 8", 8, Rule::LevelsAdded),
];

const fn look(name: &'static str, levels: usize, rule: Rule) -> Look {
    Look { name, levels, rule }
}

/// What one number of levels decides at the default tolerance. A claim is visibly wrong if it
/// differs from the exponent that the coarse levels show; *levels* is the mean number that a
/// decision took.
const LEVELS_COLUMNS: [&str; 7] = [
    "true pass",
    "true fail",
    "wrong pass",
    "visibly wrong pass",
    "interval holds the order",
    "passes without its coarsest level only",
    "levels",
];

fn count_look(row: &mut SheetRow, law: &Law, table: &LawErrors, judge: &Judge, look: &Look) {
    let evidence = Evidence::new(judge, &table.levels);
    let is_added = look.rule == Rule::LevelsAdded;
    if let Some(order) = table.order {
        let verdict = evidence.decide(look.rule, judge, order);
        row.count("true pass", verdict.is_pass());
        row.count("true fail", verdict == Verdict::Fail);
        let levels = if is_added {
            FIRST_LOOK + evidence.added(judge, order).1
        } else {
            look.levels
        };
        row.add("levels", levels as f64);
        if let Some(fit) = evidence.all().fit
            && !is_added
            && law.group != LawGroup::Emerging
        {
            row.count("interval holds the order", fit.interval.holds(order));
        }
    }
    for claim in wrong(table, 2.0 * DEFAULT_TOLERANCE) {
        let passes = evidence.decide(look.rule, judge, claim).is_pass();
        row.count("wrong pass", passes);
        if (claim - table.shown).abs() > DEFAULT_TOLERANCE {
            row.count("visibly wrong pass", passes);
        }
    }
    if look.levels > FEWEST_LEVELS && !is_added {
        let with = evidence.decide(look.rule, judge, table.shown);
        let without = judge.decide(&judge.read(&table.levels[1..]), table.shown);
        let is_excused = without.is_pass() && !with.is_pass();
        row.count("passes without its coarsest level only", is_excused);
    }
}

/// Steps halved, at the default tolerance: a fixed number of levels, or levels added up to that
/// number.
pub(crate) fn levels(key: &'static str, laws: &[Law], tables: usize, draw: &mut Draw) -> Counted {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for look in &LOOKS {
        let mut row = SheetRow::new(look.name, true, &LEVELS_COLUMNS);
        for law in laws {
            for _ in 0..tables {
                let table = law.draw(look.levels, 2.0, draw.next()?);
                count_look(&mut row, law, &table, &judge, look);
            }
        }
        rows.push(row);
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
) -> Counted {
    let judge = judge(tolerance)?;
    let columns = HIDDEN_SHARES.map(hidden_part);
    let mut rows = Rule::ALL.map(|rule| rule.row(&columns));
    for (part, column) in HIDDEN_SHARES.into_iter().zip(&columns) {
        for _ in 0..tables {
            let table = hidden_term(levels, part, draw.next()?);
            let evidence = Evidence::new(&judge, &table.levels);
            for (rule, row) in Rule::ALL.into_iter().zip(&mut rows) {
                row.count(column, evidence.decide(rule, &judge, table.shown).is_pass());
            }
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
