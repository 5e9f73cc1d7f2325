//! How far the verdicts can be trusted: the rules of this module applied to errors whose order is known.
//!
//! One generator serves most of them: the 29 [laws], most of them not designed for the rule. The counts are reported as [sheets](Sheet) of shares.
//!
//! * *rules*: every table is judged against its order, and against claims that are too high or too low by twice the tolerance. Five rules judge: this rule; this rule with finer
//!   levels added, from four on, while it is inconclusive; and what people use: the slope of a straight line, the finest pairwise rate, and the defaults of physverify 0.6, which
//!   passes if the slope of the four finest levels lies between 0.3 below and 1 above the order and the last refinement reduces the error by a factor of 1.2. Only our rule has a
//!   third answer. Where the errors have no order, the wrong claims lie around the p that they show.
//! * *levels*: the same at the default tolerance with steps halved, by number of levels. A claim is *visibly off* if it differs from the p that the coarse levels show.
//!   Also how often the interval holds the order, and how often a table passes only without its coarsest level.
//! * *held-out*: the same under [ten laws](held_out) with which nothing was tuned.
//! * *three*: three levels, of which a wrong limit or a lower order makes up 5 to 60 % of the finest error.
//! * *laws*: claims 0.1 off at ±0.05, on 3 to 8 levels with equal and unequal ratios, and how often the interval holds
//!   the order. Laws that intervals are not made for are in brackets.
//! * *hidden*: the order that the levels show is claimed, but a term of lower order makes up a share of the finest error.
//! * *limits*: second order with a wrong limit, `|h^2 (1 + a h^r) ± f|`, f from 1 to 90 % of the finest of eight errors; and three terms of either sign, the hidden one
//!   `h^(p-1)` of 10 to 22 %.
//! * *claims*: a least order, claimed half an order too high and too low; and the constant of laws that have one, 1, held against 0.8 to 1.25 and against 1.25 to 2. Steps halved, ±0.25.
//! * *bars*: values `q_k = Q ± e_k`, Q uniform in [-1, 1], and how often their error bar, and the grid convergence index of ASME V&V 20, hold the error.
//! * *noise*: limits of values `1 + h^2` whose errors scatter by 2 %.
//! * *grids*: see [`grids`].
//!
//! # Measured
//!
//! 100 tables of each law and mesh, with a seed with which nothing was tuned (the laws are those of the tuning), in per cent; the report of the study `rule-calibration-full` has all sheets.
//!
//! | 4 to 8 levels, ratios 1.5 to 3 | wrong pass at ±0.05, 0.1, 0.25 | true pass | true fail |
//! | --- | --: | --: | --: |
//! | this rule | 0.07, 0.09, 0.23 | 32.7, 42.5, 57.7 | 3.0, 1.8, 1.2 |
//! | this rule, levels added | 0.17, 0.21, 0.41 | 35.5, 45.4, 60.8 | 7.4, 5.5, 4.4 |
//! | least squares | 9.43, 9.64, 8.06 | 44.8, 56.6, 73.3 | 55.2, 43.4, 26.7 |
//! | last pair | 8.02, 8.95, 9.06 | 46.8, 57.0, 73.1 | 53.2, 43.0, 26.9 |
//! | physverify 0.6 | 81.36, 78.29, 48.01 | 87.9, 87.9, 87.9 | 12.1, 12.1, 12.1 |
//!
//! physverify passes from 0.3 below to 1 above the order, whatever the tolerance of the others: its wrong passes are those that it is not designed to catch.
//!
//! Certainty is paid for in inconclusive verdicts, and its price falls with the number of levels: a fifth level is worth its run, and adding levels until there is a decision is cheaper than any fixed number. Added
//! levels cannot reveal a lower order that shows only on still finer ones. The bar is a seventh of the index and holds the error as often as an interval of 95 % should. For *five* noisy values it holds the limit only 9
//! times in 10, because two rates may agree by chance. No difference of values can show that their limit is wrong.
//!
//! The generator is splitmix64: the same seed gives the same numbers on every machine with the same libm.

use thiserror::Error;

use self::held_out::HELD_OUT;
use self::laws::{
    Group, HIDDEN_SHARES, LAWS, Law, Meshes, Table, USUAL, WIDE, hidden_term, three_terms,
    wrong_limit,
};
use crate::judge::claims;
use crate::judge::fit::{Level, fit_line, pairwise_rates};
use crate::judge::random::SplitMix;
use crate::judge::verdict::{
    DEFAULT_TOLERANCE, FEWEST_LEVELS, Judge, JudgeError, Reading, Reason, Verdict,
};
use crate::time_limit::{Patience, TimeUp};

pub mod bars;
pub mod grids;
pub mod held_out;
pub mod laws;

/// Tolerances, each with the distance of the wrong claims from the order.
pub const CLAIMS: [(f64, f64); 3] = [
    (0.05, 0.1),
    (0.1, 0.2),
    (DEFAULT_TOLERANCE, 2.0 * DEFAULT_TOLERANCE),
];

/// The rules, ours first.
pub const RULES: [&str; 5] = [
    "this rule",
    "this rule, levels added",
    "least squares",
    "last pair",
    "physverify 0.6",
];

/// Tolerances and numbers of levels at which hidden terms are tested.
const HIDDEN: [(&str, f64, usize); 3] = [
    ("hidden-6", 0.1, 6),
    ("hidden-8", 0.1, 8),
    ("hidden-wide", 0.2, 8),
];

/// Tables of hidden terms for each table of a law.
const HIDDEN_TABLES: usize = 20;

/// Levels at the first look when levels are added.
const FIRST_LOOK: usize = 4;

/// Numbers of levels drawn: 3 to 8.
const LEVEL_COUNTS: usize = 6;

/// Laws that intervals are not made for: far from asymptotic, or with rates that wander too slowly or endlessly.
const NO_INTERVAL: [&str; 12] = [
    "h^p |1 + a h^r|, r 0.25 to 0.5, |a| < 0.5",
    "h^p (1 + a h^(1/3)), a 0.5 to 3",
    "h^p (1 + a h), a 1 to 30",
    "h^p (1 + a h^2), a 1 to 100",
    "h^p |1 - a h^r|, a 1 to 30",
    "h^p (L - log h)^k",
    "h^p (1 ± a), odd and even",
    "h^p (1 + a cos)",
    "h^p + b h^(p - 1/2 or 1)",
    "h^p / (h + h0)^g",
    "noise 30 %",
    "one outlier, up to a factor of 3",
];

/// Shares that were counted, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Its name in a study file.
    pub key: &'static str,
    /// What it is.
    pub title: String,
    /// What each column counts.
    pub columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Row>,
}

/// A row of a [`Sheet`].
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Whether the rule answers for it.
    pub declared: bool,
    /// Shares, or medians of a length; NaN if nothing was counted.
    pub values: Vec<f64>,
}

impl Sheet {
    fn new(
        key: &'static str,
        title: &str,
        columns: &[&str],
        rows: impl IntoIterator<Item = Row>,
    ) -> Self {
        let columns = columns.iter().map(|&column| column.to_owned()).collect();
        Self {
            key,
            title: title.to_owned(),
            columns,
            rows: rows.into_iter().collect(),
        }
    }
}

fn row(name: impl Into<String>, declared: bool, shares: &[Share]) -> Row {
    Row {
        name: name.into(),
        declared,
        values: shares.iter().map(|share| share.value()).collect(),
    }
}

/// How often something was true.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    hits: usize,
    of: usize,
}

impl Share {
    fn count(&mut self, hit: bool) {
        self.hits += usize::from(hit);
        self.of += 1;
    }

    /// NaN if nothing was counted.
    fn value(self) -> f64 {
        self.hits as f64 / self.of as f64
    }
}

/// Cost of judging a table, in elements advanced by a step: 65 µs against 25 ns.
pub const ELEMENTS_OF_A_TABLE: usize = 2600;

/// Why a calibration was not completed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum CalibrationError {
    /// The rule cannot be set up as declared.
    #[error(transparent)]
    Judge(#[from] JudgeError),
    /// The case reached its time limit.
    #[error(transparent)]
    TimeUp(#[from] TimeUp),
}

/// Random numbers; the clock is checked for each table.
struct Draw {
    random: SplitMix,
    patience: Patience,
    drawn: usize,
}

impl Draw {
    fn new(seed: u64) -> Self {
        Self {
            random: SplitMix::new(seed),
            patience: Patience::new(ELEMENTS_OF_A_TABLE),
            drawn: 0,
        }
    }

    fn next(&mut self) -> Result<&mut SplitMix, TimeUp> {
        self.patience.check(self.drawn, || self.drawn as f64)?;
        self.drawn += 1;
        Ok(&mut self.random)
    }
}

/// The errors of the laws are exact to the last digit: no floor is needed.
fn judge(tolerance: f64) -> Result<Judge, JudgeError> {
    Judge::new(tolerance)?.with_floor(0.0)
}

/// The order, or the one shown if there is none, and claims that are `off` on either side of it.
fn wrong(table: &Table, off: f64) -> [f64; 2] {
    [-off, off].map(|off| table.order.unwrap_or(table.shown) + off)
}

/// The sheets of the rule: *rules* on two sets of meshes, *levels*, *held-out*, *three*, *laws*, *hidden* three times, *limits*, *claims*.
///
/// * `tables`: number of tables for each law and mesh.
///
/// # Errors
/// [`CalibrationError`].
pub fn of_the_rule(tables: usize, seed: u64) -> Result<Vec<Sheet>, CalibrationError> {
    let seed = |part: u64| seed.wrapping_add(part);
    let mut sheets = vec![
        rules(
            "rules",
            "4 to 8 levels, ratios 1.5 to 3",
            USUAL,
            tables,
            &mut Draw::new(seed(0)),
        )?,
        rules(
            "rules-wide",
            "3 to 12 levels, ratios 1.1 to 4",
            WIDE,
            tables,
            &mut Draw::new(seed(1)),
        )?,
        levels("levels", &LAWS, 10 * tables, &mut Draw::new(seed(2)))?,
        levels("held-out", &HELD_OUT, 10 * tables, &mut Draw::new(seed(7)))?,
        three(40 * tables, &mut Draw::new(seed(8)))?,
        intervals(20 * tables, &mut Draw::new(seed(3)))?,
    ];
    for (key, tolerance, levels) in HIDDEN {
        sheets.push(hidden(
            key,
            tolerance,
            levels,
            HIDDEN_TABLES * tables,
            &mut Draw::new(seed(4)),
        )?);
    }
    sheets.push(limits(HIDDEN_TABLES * tables, &mut Draw::new(seed(5)))?);
    sheets.push(other_claims(10 * tables, &mut Draw::new(seed(6)))?);
    Ok(sheets)
}

/// What each of the [`RULES`] decides by.
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

    /// The verdict of the rule at this place in [`RULES`].
    fn decide(&self, rule: usize, judge: &Judge, order: f64) -> Verdict {
        let inside = |rate: f64, [low, high]: [f64; 2]| {
            if order - low <= rate && rate <= order + high {
                Verdict::Pass
            } else {
                Verdict::Fail
            }
        };
        let band = [judge.tolerance(); 2];
        match rule {
            0 => judge.decide(self.all(), order),
            1 => self.added(judge, order).0,
            2 => inside(self.line, band),
            3 => inside(self.last, band),
            _ if self.has_fallen => inside(self.four, [0.3, 1.0]),
            _ => Verdict::Fail,
        }
    }

    /// The verdict when levels are added while it is inconclusive, and how many were added.
    fn added(&self, judge: &Judge, order: f64) -> (Verdict, usize) {
        let mut looks = self
            .looks
            .iter()
            .map(|look| judge.decide(look, order))
            .enumerate();
        let decided = looks.find(|(_, verdict)| *verdict != Verdict::Inconclusive);
        decided.map_or(
            (Verdict::Inconclusive, self.looks.len() - 1),
            |(added, verdict)| (verdict, added),
        )
    }
}

/// Slope of the least-squares line through the logarithms.
fn slope(levels: &[Level]) -> f64 {
    fit_line(levels).map_or(f64::NAN, |line| line.slope)
}

fn rules(
    key: &'static str,
    meshes_in_words: &str,
    meshes: Meshes,
    tables: usize,
    draw: &mut Draw,
) -> Result<Sheet, CalibrationError> {
    let judges = CLAIMS.map(|(tolerance, _)| judge(tolerance));
    let mut shares = [[Share::default(); 3 * CLAIMS.len()]; RULES.len()];
    for ((levels, ratio), law) in meshes
        .each()
        .flat_map(|mesh| LAWS.iter().map(move |law| (mesh, law)))
    {
        for _ in 0..tables {
            let table = law.draw(levels, ratio, draw.next()?);
            let evidence = Evidence::new(&Judge::default().with_floor(0.0)?, &table.levels);
            for (place, (judge, (_, off))) in judges.iter().zip(CLAIMS).enumerate() {
                let judge = judge.as_ref().map_err(|error| *error)?;
                for (rule, shares) in shares.iter_mut().enumerate() {
                    let verdict = |order| evidence.decide(rule, judge, order);
                    wrong(&table, off)
                        .into_iter()
                        .for_each(|claim| shares[3 * place].count(verdict(claim).is_pass()));
                    if let Some(order) = table.order {
                        shares[3 * place + 1].count(verdict(order).is_pass());
                        shares[3 * place + 2].count(verdict(order) == Verdict::Fail);
                    }
                }
            }
        }
    }
    let title = format!("Share of claims that pass or fail, 29 error laws, {meshes_in_words}");
    let columns: Vec<String> = CLAIMS
        .iter()
        .flat_map(|(tolerance, off)| {
            [
                format!("wrong pass, ±{tolerance}, {off} off"),
                format!("true pass, ±{tolerance}"),
                format!("true fail, ±{tolerance}"),
            ]
        })
        .collect();
    let rows = RULES
        .iter()
        .zip(&shares)
        .enumerate()
        .map(|(rule, (name, shares))| row(*name, rule == 0, shares));
    Ok(Sheet {
        columns,
        ..Sheet::new(key, &title, &[], rows)
    })
}

/// Numbers of levels, or to how many levels are added.
const LOOKS: [(&str, usize, bool); 7] = [
    ("3 levels", 3, false),
    ("4 levels", 4, false),
    ("5 levels", 5, false),
    ("6 levels", 6, false),
    ("8 levels", 8, false),
    ("added up to 6", 6, true),
    ("added up to 8", 8, true),
];

/// Steps halved, at the default tolerance: a fixed number of levels, or levels added up to that number.
fn levels(
    key: &'static str,
    laws: &[Law],
    tables: usize,
    draw: &mut Draw,
) -> Result<Sheet, CalibrationError> {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for (name, levels, is_added) in LOOKS {
        let (mut shares, mut work) = ([Share::default(); 6], Share::default());
        for law in laws {
            for _ in 0..tables {
                let table = law.draw(levels, 2.0, draw.next()?);
                let evidence = Evidence::new(&judge, &table.levels);
                let decide = |order: f64| evidence.decide(usize::from(is_added), &judge, order);
                if let Some(order) = table.order {
                    let verdict = decide(order);
                    shares[0].count(verdict.is_pass());
                    shares[1].count(verdict == Verdict::Fail);
                    work.hits += if is_added {
                        FIRST_LOOK + evidence.added(&judge, order).1
                    } else {
                        levels
                    };
                    work.of += 1;
                    if let (Some(fit), false, false) =
                        (evidence.all().fit, is_added, law.group == Group::Emerging)
                    {
                        shares[4].count(fit.interval[0] <= order && order <= fit.interval[1]);
                    }
                }
                for claim in wrong(&table, 2.0 * DEFAULT_TOLERANCE) {
                    let passes = decide(claim).is_pass();
                    shares[2].count(passes);
                    if (claim - table.shown).abs() > DEFAULT_TOLERANCE {
                        shares[3].count(passes);
                    }
                }
                if levels > FEWEST_LEVELS && !is_added {
                    let without = judge.decide(&judge.read(&table.levels[1..]), table.shown);
                    shares[5].count(without.is_pass() && !decide(table.shown).is_pass());
                }
            }
        }
        rows.push(row(name, true, &[&shares[..], &[work]].concat()));
    }
    let columns = [
        "true pass",
        "true fail",
        "wrong pass",
        "visibly wrong pass",
        "interval holds the order",
        "passes without its coarsest level only",
        "levels",
    ];
    let title = format!(
        "Share of claims that pass or fail at ±0.25, {} error laws, steps halved; wrong claims are half an order off",
        laws.len()
    );
    Ok(Sheet::new(key, &title, &columns, rows))
}

/// Three levels, of which a wrong limit or a lower order makes up 5 to 60 % of the finest error.
fn three(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut shares = [Share::default(); 2];
    for _ in 0..tables {
        let random = draw.next()?;
        let part = random.within([0.05, 0.6]);
        let table = hidden_term(FEWEST_LEVELS, part, random);
        let passes = judge
            .decide(&judge.read(&table.levels), table.shown)
            .is_pass();
        shares[usize::from(table.order.is_some())].count(passes);
    }
    let title = "Share of tables with three levels that pass at ±0.25 although something else makes up 5 to 60 % of the finest error";
    Ok(Sheet::new(
        "three",
        title,
        &["wrong limit passes", "lower order passes"],
        [row("3 levels", true, &shares)],
    ))
}

/// What each law does to claims 0.1 off at ±0.05 and to intervals.
fn intervals(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let (tolerance, off) = CLAIMS[0];
    let judge = judge(tolerance)?;
    let mut of_laws = [[Share::default(); 4]; LAWS.len()];
    let mut of_levels = [[Share::default(); 4]; LEVEL_COUNTS];
    let mut of_all = [Share::default(); 4];
    for (law, shares) in LAWS.iter().zip(&mut of_laws) {
        for _ in 0..tables {
            let random = draw.next()?;
            let count = FEWEST_LEVELS + random.below(LEVEL_COUNTS);
            let table = law.draw_at(&steps(random, count), random);
            let reading = judge.read(&table.levels);
            let count_in = |shares: &mut [Share; 4]| {
                wrong(&table, off)
                    .into_iter()
                    .for_each(|claim| shares[0].count(judge.decide(&reading, claim).is_pass()));
                if let Some(order) = table.order {
                    let verdict = judge.decide(&reading, order);
                    shares[1].count(verdict == Verdict::Fail);
                    shares[2].count(verdict == Verdict::Inconclusive);
                    if let Some([low, high]) = reading.fit.map(|fit| fit.interval) {
                        shares[3].count(low <= order && order <= high);
                    }
                }
            };
            count_in(shares);
            if is_declared(law, &NO_INTERVAL) {
                count_in(&mut of_levels[count - FEWEST_LEVELS]);
                count_in(&mut of_all);
            }
        }
    }
    let columns = [
        "wrong pass",
        "true fail",
        "inconclusive",
        "interval holds the order",
    ];
    let title = "Claims 0.1 off at ±0.05, 3 to 8 levels, equal and unequal ratios";
    let laws = LAWS
        .iter()
        .zip(&of_laws)
        .map(|(law, shares)| row(law.name, is_declared(law, &NO_INTERVAL), shares));
    Ok(Sheet::new(
        "laws",
        title,
        &columns,
        laws.chain(by_levels("levels", &of_levels))
            .chain([row(ALL, true, &of_all)]),
    ))
}

/// The row of all laws that are declared.
pub const ALL: &str = "all declared";

fn is_declared(law: &Law, not: &[&str]) -> bool {
    law.group != Group::Stagnating && !not.contains(&law.name)
}

fn by_levels<'s>(what: &str, shares: &'s [[Share; 4]]) -> impl Iterator<Item = Row> + use<'s> {
    let what = what.to_owned();
    shares
        .iter()
        .zip(FEWEST_LEVELS..)
        .map(move |(shares, count)| row(format!("{count} {what}"), false, shares))
}

/// `count` steps from 1 downwards, with ratio 2 (in two of five cases), 3/2, 3, or a new one in [1.4, 2.5] each time.
fn steps(random: &mut SplitMix, count: usize) -> Vec<f64> {
    let fixed = [Some(2.0), Some(2.0), Some(1.5), Some(3.0), None][random.below(5)];
    let mut step = 1.0;
    let mut next = || {
        let here = step;
        step /= fixed.unwrap_or_else(|| random.within([1.4, 2.5]));
        here
    };
    (0..count).map(|_| next()).collect()
}

fn hidden(
    key: &'static str,
    tolerance: f64,
    levels: usize,
    tables: usize,
    draw: &mut Draw,
) -> Result<Sheet, CalibrationError> {
    let judge = judge(tolerance)?;
    let mut shares = [[Share::default(); HIDDEN_SHARES.len()]; RULES.len()];
    for (place, part) in HIDDEN_SHARES.into_iter().enumerate() {
        for _ in 0..tables {
            let table = hidden_term(levels, part, draw.next()?);
            let evidence = Evidence::new(&judge, &table.levels);
            for (rule, shares) in shares.iter_mut().enumerate() {
                shares[place].count(evidence.decide(rule, &judge, table.shown).is_pass());
            }
        }
    }
    let title = format!(
        "Share of tables that pass although a term of lower order makes up so much of the finest error, {levels} levels, ±{tolerance}"
    );
    let columns: Vec<String> = HIDDEN_SHARES
        .iter()
        .map(|share| format!("{:.0} %", 100.0 * share))
        .collect();
    let rows = RULES
        .iter()
        .zip(&shares)
        .enumerate()
        .map(|(rule, (name, shares))| row(*name, rule == 0, shares));
    Ok(Sheet {
        columns,
        ..Sheet::new(key, &title, &[], rows)
    })
}

fn limits(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let mut rows = vec![];
    for tolerance in [0.05, 0.1, 0.2] {
        let judge = judge(tolerance)?;
        let mut shares = [Share::default(); 3];
        for _ in 0..tables {
            let table = wrong_limit(draw.next()?);
            let passes = judge
                .decide(&judge.read(&table.levels), table.shown)
                .is_pass();
            shares[0].count(passes);
            shares[1].count(
                passes && judge.judge(&table.levels[3..], table.shown).kind == Reason::Departs,
            );
            let table = three_terms(draw.next()?);
            shares[2].count(
                judge
                    .decide(&judge.read(&table.levels), table.shown)
                    .is_pass(),
            );
        }
        rows.push(row(format!("±{tolerance}"), true, &shares));
    }
    let columns = [
        "wrong limit passes",
        "and departs without its coarsest levels",
        "three terms pass",
    ];
    Ok(Sheet::new(
        "limits",
        "Share of wrong claims that pass with 8 levels, steps halved",
        &columns,
        rows,
    ))
}

/// Laws that are h^p to leading order.
const HAS_CONSTANT: [&str; 7] = [
    "h^p",
    "h^p |1 + a h^r|, r 1 to 4, |a| < 0.5",
    "h^p |1 + a h^r|, r 0.5 to 1, |a| < 0.5",
    "noise 0.1 %",
    "noise 1 %",
    "noise 3 %",
    "pollution, noise 1 %",
];

fn other_claims(tables: usize, draw: &mut Draw) -> Result<Sheet, CalibrationError> {
    let judge = judge(DEFAULT_TOLERANCE)?;
    let mut rows = vec![];
    for levels in [4, 5, 6, 8] {
        let mut shares = [Share::default(); 7];
        for law in &LAWS {
            for _ in 0..tables {
                let table = law.draw(levels, 2.0, draw.next()?);
                let reading = judge.read(&table.levels);
                let least =
                    |order: f64| claims::at_least(judge.judge_read(&reading, order)).verdict;
                let Some(order) = table.order else {
                    shares[0].count(least(table.shown + 2.0 * DEFAULT_TOLERANCE).is_pass());
                    continue;
                };
                shares[0].count(least(table.shown.max(order) + 2.0 * DEFAULT_TOLERANCE).is_pass());
                shares[1].count(least(order).is_pass());
                shares[2].count(least(order - 2.0 * DEFAULT_TOLERANCE).is_pass());
                let rate = judge.judge_read(&reading, order);
                if HAS_CONSTANT.contains(&law.name) && rate.verdict.is_pass() {
                    if let Some([low, high]) = claims::constant(&table.levels, &rate) {
                        // A pure power is known to the last digit.
                        shares[3].count(low <= 1.0 + 1e-12 && 1.0 - 1e-12 <= high);
                    }
                    let with = |between| {
                        claims::with_constant(&table.levels, rate.clone(), between).verdict
                    };
                    shares[4].count(with([0.8, 1.25]).is_pass());
                    shares[5].count(with([0.8, 1.25]) == Verdict::Fail);
                    shares[6].count(with([1.25, 2.0]).is_pass());
                }
            }
        }
        rows.push(row(format!("{levels} levels"), true, &shares));
    }
    let columns = [
        "at least half an order too much passes",
        "at least the order passes",
        "at least half an order less passes",
        "interval holds the constant",
        "right constant passes",
        "right constant fails",
        "wrong constant passes",
    ];
    Ok(Sheet::new(
        "claims",
        "Other claims at ±0.25, steps halved",
        &columns,
        rows,
    ))
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
                evidence.decide(4, &judge, order).is_pass(),
                expected,
                "{order}"
            );
        }
        assert!(
            evidence.decide(2, &judge, 2.35).is_pass()
                && !evidence.decide(2, &judge, 2.45).is_pass()
        );
        assert!(
            evidence.decide(3, &judge, 4.05).is_pass()
                && !evidence.decide(3, &judge, 4.15).is_pass()
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
            Evidence::new(&judge, &stopped).decide(4, &judge, slope(&stopped)),
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
        assert_eq!(evidence.decide(1, &judge, 2.0), Verdict::Pass);
    }

    #[test]
    fn a_share_of_nothing_is_none_and_each_law_that_is_excepted_is_a_law() {
        assert!(Share::default().value().is_nan());
        assert!(
            NO_INTERVAL
                .iter()
                .all(|name| LAWS.iter().any(|law| law.name == *name))
        );
    }
}
