//! How far the verdicts can be trusted: the rule of `convergence-judge`, and others, applied to
//! errors whose order is known.
//!
//! The [`studies`] give each share its limit. One generator serves most of them:
//! the 29 [laws], most of them not designed for the rule. The counts are reported as
//! [sheets](sheet::Sheet) of shares.
//!
//! * *rules*: every table is judged against its order, and against claims that are too high or too
//!   low by twice the tolerance. Five rules judge: this rule; this rule with finer levels added,
//!   from four on, until a look passes or two in a row fail; and what people use: the slope of a
//!   straight line, the finest pairwise rate, and the defaults of physverify 0.6, which passes if
//!   the slope of the four finest levels lies between 0.3 below and 1 above the order and the last
//!   refinement reduces the error by a factor of 1.2. Only our rule has a third answer. Where the
//!   errors have no order, the wrong claims lie around the p that they show.
//! * *levels*: the same at the default tolerance with steps halved, by number of levels. A claim is
//!   *visibly off* if it differs from the p that the coarse levels show. Also how often the
//!   interval holds the order, and how often a table passes only without its coarsest level.
//! * *held-out*: the same under [ten laws](held_out) that were seen twice, and not fitted.
//! * *benign*: the same under a smooth power with small pollution; *differences*: finite
//!   differences of random smooth problems; see [`benign`].
//! * *noisy*: a lower order of a tenth of the finest error under noise; see [`noisy`].
//! * *compared*: this rule and what people do today on nine [laws](fresh) written for it, each with
//!   the band that lets as many wrong claims pass.
//! * *three*: three levels, of which a wrong limit or a lower order makes up 5 to 60 % of the
//!   finest error.
//! * *laws*: claims 0.1 off at ±0.05, on 3 to 8 levels with equal and unequal ratios, and how often
//!   the interval holds the order. Laws that intervals are not made for are in brackets.
//! * *hidden*: the order that the levels show is claimed, but a term of lower order makes up a
//!   share of the finest error.
//! * *limits*: second order with a wrong limit, `|h^2 (1 + a h^r) ± f|`, f from 1 to 90 % of the
//!   finest of eight errors; and three terms of either sign, the hidden one `h^(p-1)` of 10 to 22
//!   %.
//! * *claims*: a least order, claimed half an order too high and too low; and the constant of laws
//!   that have one, 1, held against 0.8 to 1.25 and against 1.25 to 2. Steps halved, ±0.25.
//! * *noise*: limits of values `1 + h^2` whose errors scatter by 2 %.
//! * *grids*: grids of h and dt whose errors do not tend to zero; see [`grids`].
//!
//! # Measured
//!
//! 100 tables of each law and mesh, with a seed with which nothing was tuned (the laws are those of
//! the tuning), in per cent; the report of the study `rule-calibration-full` has all sheets.
//!
//! | 4 to 8 levels, ratios 1.5 to 3 | wrong pass at ±0.05, 0.1, 0.25 | true pass | true fail |
//! | --- | --: | --: | --: |
//! | this rule | 0.05, 0.06, 0.04 | 33.2, 43.1, 57.7 | 2.8, 1.6, 1.2 |
//! | this rule, levels added | 0.13, 0.16, 0.18 | 35.8, 45.9, 60.8 | 3.7, 2.2, 1.6 |
//! | least squares | 9.43, 9.64, 8.06 | 44.8, 56.6, 73.3 | 55.2, 43.4, 26.7 |
//! | last pair | 8.02, 8.95, 9.06 | 46.8, 57.0, 73.1 | 53.2, 43.0, 26.9 |
//! | physverify 0.6 | 81.36, 78.29, 48.01 | 87.9, 87.9, 87.9 | 12.1, 12.1, 12.1 |
//!
//! physverify passes from 0.3 below to 1 above the order, whatever the tolerance of the others: its
//! wrong passes are those that it is not designed to catch.
//!
//! Certainty is paid for in inconclusive verdicts, and its price falls with the number of levels: a
//! fifth level is worth its run, and adding levels until there is a decision is cheaper than any
//! fixed number. Added levels cannot reveal a lower order that shows only on still finer ones. For
//! *five* noisy values the interval of the limit holds it only 9 times in 10, because two rates may
//! agree by chance. No difference of values can show that their limit is wrong.
//!
//! The generator is splitmix64: the same seed gives the same numbers on every machine with the same
//! libm.

pub mod benign;
pub mod claims;
mod compared;
mod draw;
pub mod fresh;
pub mod grids;
pub mod held_out;
pub mod hidden;
pub mod intervals;
pub mod laws;
pub mod noise;
pub mod noisy;
pub mod rules;
mod shapes;
pub mod sheet;
pub mod studies;

use convergence_judge::verdict::Judge;
use convergence_study::{CaseFailure, JudgeError};

use benign::{BENIGN, differences};
use claims::{limits, other_claims, three};
use compared::compared;
use draw::Draw;
use held_out::HELD_OUT;
use intervals::intervals;
use laws::{LAWS, LawErrors, USUAL, WIDE};
use noisy::noisy;
use rules::{hidden, levels, rules};
use sheet::Sheet;

pub use draw::ELEMENTS_OF_A_TABLE;

/// Fewest tables, as `tables` counts them, of shares that the first page of the project states.
const FEWEST_OF_STATED: usize = 20;

/// Tables of hidden terms for each table of a law.
const HIDDEN_TABLES: usize = 20;

/// The errors of the laws are exact to the last digit: no floor is needed.
fn judge(tolerance: f64) -> Result<Judge, JudgeError> {
    Judge::new(tolerance)?.with_floor(0.0)
}

/// The order, or the one shown if there is none, and claims that are `off` on either side of it.
fn wrong(table: &LawErrors, off: f64) -> [f64; 2] {
    [-off, off].map(|off| table.order.unwrap_or(table.shown) + off)
}

/// The sheets of the rule: *rules* on two sets of meshes, *levels*, *held-out*, *three*, *laws*,
/// *hidden* three times, *limits*, *claims*, *benign*, *differences*, *noisy*,
/// *compared*.
///
/// * `tables`: number of tables for each law and mesh.
///
/// # Errors
/// [`CaseFailure`] if the rule cannot be set up as declared, or the time is up.
pub fn of_the_rule(tables: usize, seed: u64) -> Result<Vec<Sheet>, CaseFailure> {
    let usual = "4 to 8 levels, ratios 1.5 to 3";
    let wide = "3 to 12 levels, ratios 1.1 to 4";
    let hidden_tables = HIDDEN_TABLES * tables;
    let stated = tables.max(FEWEST_OF_STATED);
    Ok(vec![
        rules("rules", usual, USUAL, tables, &mut draw(seed, 0))?,
        rules("rules-wide", wide, WIDE, tables, &mut draw(seed, 1))?,
        levels("levels", &LAWS, 10 * tables, &mut draw(seed, 2))?,
        levels("held-out", &HELD_OUT, 10 * stated, &mut draw(seed, 7))?,
        three(40 * tables, &mut draw(seed, 8))?,
        intervals(20 * tables, &mut draw(seed, 3))?,
        hidden("hidden-6", 0.1, 6, hidden_tables, &mut draw(seed, 4))?,
        hidden("hidden-8", 0.1, 8, hidden_tables, &mut draw(seed, 4))?,
        hidden("hidden-wide", 0.2, 8, hidden_tables, &mut draw(seed, 4))?,
        limits(hidden_tables, &mut draw(seed, 5))?,
        other_claims(10 * tables, &mut draw(seed, 6))?,
        levels("benign", &BENIGN, 25 * stated, &mut draw(seed, 9))?,
        differences(3 * tables, &mut draw(seed, 10))?,
        noisy(20 * stated, &mut draw(seed, 11))?,
        compared(40 * tables, &mut draw(seed, 12))?,
    ])
}

/// The random numbers of a part of the sheets.
fn draw(seed: u64, part: u64) -> Draw {
    Draw::new(seed.wrapping_add(part))
}
