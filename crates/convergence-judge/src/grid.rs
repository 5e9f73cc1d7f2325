//! Errors over a grid of mesh widths and time steps: the order in h and the order in dt, each
//! judged by itself.
//!
//! # Derivation
//!
//! Let the contributions of space and time add, or let their squares add:
//!
//! ```text
//!     e(h, dt)^s = A(h)^s + B(dt)^s,        s = 1: they have the same shape;  s = 2: they are orthogonal       (a)
//!     A(h) = C_h h^p (1 + a h^r + ...),     B(dt) = C_t dt^q (1 + b dt^r' + ...)                               (b)
//! ```
//!
//! *One sequence for each order.* The differences of e^s over h at fixed dt do not contain B,
//! whatever its order and pollution:
//!
//! ```text
//!     e(h_k, dt)^s - e(h_(k+1), dt)^s = A(h_k)^s - A(h_(k+1))^s = A(h_(k+1))^s (ρ_k^(s p) - 1) (1 + s a (K_k - 1) h_(k+1)^r + ...)
//!     ρ_k = h_k / h_(k+1),    K_k = (ρ_k^(s p + r) - 1) / (ρ_k^(s p) - 1).
//! ```
//!
//! They are the differences of values of order s p, and are reduced as [those](crate::richardson):
//! their s-th roots are errors of order p at mean steps, with the pollution of A there.
//! [The rule](crate::verdict) judges them, with all that it knows of pollution, departure,
//! scatter and round-off. With one ratio ρ they are the differences themselves; otherwise p is the
//! number for which the rate read is p, and a pass needs the reading at the order claimed as well.
//! The same holds over dt for B and q.
//!
//! *Where.* At the finest dt, and for q at the finest h: there the other contribution has the least
//! scatter and round-off, and terms such as `h^i dt^k`, which (a) lacks, are smallest.
//!
//! *Whether (a) holds* is tested with the errors outside the two sequences. With M and N the finest
//! levels,
//!
//! ```text
//!     e_jk^s = e_jN^s + e_Mk^s - e_MN^s,          misfit μ = root mean square of log(right) / s - log(left).
//! ```
//!
//! *Floor.* If the other contribution is large, the last differences are small compared with e^s.
//! The misfit of (a) limits what is known of e, so e^s is uncertain by `s μ e^s`: differences up to
//! [`MISFITS`] times that, and up to the round-off, are not used.
//!
//! # Why not a surface
//!
//! `C_h h^p + C_t dt^q` fitted to all errors has intervals that are too narrow. m n errors that
//! obey (a) are m + n - 1 numbers, so there are fewer than m n - 4 degrees of freedom; and
//! residuals of smooth data bend, they do not scatter. For 202 smooth grids of 3 × 3 to 5 × 5
//! errors with a, b in [-0.8, 2], Student's intervals of 95 % held p 59 times and q 32 times.
//!
//! # Three steps beyond the rule
//!
//! *The neighbouring line.* If (a) holds, the differences at the next finest dt are the same. The
//! interval is extended on either side by the difference of their rates: for terms that (a) lacks,
//! and for scatter that a few differences do not show. (If those differences are below their floor,
//! as with a finest step far beyond the others, there is nothing to compare with.)
//!
//! *Two rates.* Four levels have three differences and two rates. If the true order is one lower
//! than that claimed and its term has just begun to show, the interval alone lets 7 of 100 such
//! tables pass (4 × 4, tolerance 0.2). A fading term moves the rates towards the order, an emerging
//! one moves them away. So with two rates, the second may be farther from the order than the first
//! by at most [`DEPARTURE_OF_TWO_RATES`] of the tolerance; otherwise a pass becomes inconclusive. A
//! claim whose differences change sign does not pass either.
//!
//! # What is left over
//!
//! Differences cancel a constant: `5 - h^2 - dt` grows, and its differences have the orders 2
//! and 1. So where both orders pass, we ask what is left of the finest error without h and dt. With
//! the pollution a h^r the rate between the differences k and k+1, at the mean steps x, is
//!
//! ```text
//!     q_k = p + a (K_k h_(k+1)^r - K_(k+1) h_(k+2)^r) / log(x_k / x_(k+1)),        A_M^s = d / (ρ^(s p) - 1) exp(-s a (K h_M^r - h_M^r)),
//! ```
//!
//! to first order in a, with d, ρ and K those of the last difference. The last two rates give r,
//! within [`APPROACH`] (1 if there is one rate), and the last one gives a; B_N is found the same
//! way. p is the order claimed, or the rate read if that order lies far outside the interval of it:
//! a claim has a tolerance. The remainder `e^s - A_M^s - B_N^s` is stated as a share λ of
//! `s e^s`: of the error itself, if it is small. Where the interval excludes the order claimed, v
//! is the change of λ from p to an end of the interval; else 0. Its uncertainty u is the change
//! from r = 1 instead, or a tenth of the correction, and [`MISFITS_OF_REST`] times the misfit; with
//! v added if p is the rate read.
//!
//! | λ | verdict |
//! | --- | --- |
//! | with v at most 0.075, and at most 0.005 or u | both orders pass |
//! | more than 0.1 and more than twice u + v | *fail*: a limit that is not zero, `(s λ)^(1/s) e` |
//! | otherwise | *inconclusive*, with the same number |
//!
//! # Measured
//!
//! Grids of 4 × 4 to 8 × 8 levels with ratio 2, p and q from 1/2 to 3, s = 1 or 2. If a constant of
//! 10 to 300 % of the finest error is added to the errors, none of them passes at a tolerance of
//! 0.2: the study `rule-calibration-full` has 400 grids of each number of levels. Three levels give
//! two differences: always inconclusive.

mod remainder;

use super::fit::Level;
use super::richardson::{
    RATES, StepValue, crossing, differences_of_order, have_one_ratio, judge_both, repeated_value,
};
use super::verdict::{Band, FEWEST_LEVELS, Judge, JudgeError, RateVerdict, Reason, Verdict};
use crate::text::number::error_text;
use remainder::Remainder;
pub use remainder::{APPROACH, MISFITS_OF_REST};

/// Share of the tolerance by which the second of two rates may be farther from the order than the
/// first.
pub const DEPARTURE_OF_TWO_RATES: f64 = 0.05;

/// Differences are known if they exceed the uncertainty from the misfit by this factor: three
/// standard deviations.
pub const MISFITS: f64 = 3.0;

/// Share of an error below which differences are round-off: a thousand times about a hundred
/// rounding errors.
const ROUND_OFF: f64 = 1e-10;

/// How the contributions of space and time combine to the error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Adding {
    /// e = A(h) + B(dt): they have the same shape.
    Plain,
    /// e² = A(h)² + B(dt)²: they are orthogonal.
    Squares,
}

impl Adding {
    fn power(self) -> f64 {
        match self {
            Self::Plain => 1.0,
            Self::Squares => 2.0,
        }
    }
}

/// The same of space, refined by the mesh width h, and of time, refined by the step dt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceTime<T> {
    /// Of space, in h.
    pub space: T,
    /// Of time, in dt.
    pub time: T,
}

impl<T> SpaceTime<T> {
    /// Both, that of space first.
    pub fn both(&self) -> [&T; 2] {
        [&self.space, &self.time]
    }

    /// Both, each turned into another.
    pub fn map<U>(self, turned: impl Fn(T) -> U) -> SpaceTime<U> {
        SpaceTime {
            space: turned(self.space),
            time: turned(self.time),
        }
    }
}

/// How far an error is from the value that those of the finest mesh and the finest step give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorMisfit {
    /// Its mesh width.
    pub h: f64,
    /// Its time step.
    pub dt: f64,
    /// The distance of log e from that value.
    pub misfit: f64,
}

/// Errors for all pairs of mesh widths and time steps.
///
/// ```
/// use convergence_judge::{Adding, Band, GridErrors, JudgeError, SpaceTime};
///
/// let steps = [0.4, 0.2, 0.1, 0.05, 0.025];
/// let mut errors = vec![];
/// for h in steps {
///     errors.extend(steps.map(|dt: f64| h * h + 0.5 * dt));
/// }
/// let grid = GridErrors { h: &steps, dt: &steps, errors: &errors };
/// let claims = SpaceTime { space: 2.0, time: 1.0 }.map(|order| Band { order, tolerance: 0.2 });
/// let rates = grid.judge(Adding::Plain, claims)?;
/// assert!(rates.space.verdict.is_pass() && rates.time.verdict.is_pass());
/// # Ok::<(), JudgeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GridErrors<'a> {
    /// Mesh widths, coarsest first.
    pub h: &'a [f64],
    /// Time steps, coarsest first.
    pub dt: &'a [f64],
    /// The errors: all time steps of the first mesh width, then those of the next;
    /// `h.len() * dt.len()`.
    pub errors: &'a [f64],
}

impl GridErrors<'_> {
    /// Root mean square distance of log e from the value that these give, over all errors except
    /// those of the finest mesh and the finest step.
    ///
    /// NaN if an error is not finite; infinite if the sum is negative, which no error can be.
    pub fn misfit(&self, adding: Adding) -> f64 {
        let misfits = self.misfits(adding);
        let squares = misfits.iter().map(|of_error| of_error.misfit.powi(2));
        (squares.sum::<f64>() / misfits.len() as f64).sqrt()
    }

    /// The error farthest from that value of those that are more than twice as far as the coarser
    /// ones beside them: what (a) lacks grows with h and dt, and is none.
    pub fn outlier(&self, adding: Adding) -> Option<ErrorMisfit> {
        let misfits = self.misfits(adding);
        let columns = self.dt.len().saturating_sub(1);
        let stands_out = |place: &usize| {
            let column = place % columns;
            let left = (column > 0).then(|| place - 1);
            let above = place.checked_sub(columns);
            let mut coarser = [left, above].into_iter().flatten();
            coarser.all(|beside| misfits[*place].misfit > 2.0 * misfits[beside].misfit)
        };
        // The coarsest has none beside it.
        let outliers = (1..misfits.len()).filter(stands_out);
        let outliers = outliers.map(|place| misfits[place]);
        outliers.max_by(|one, other| one.misfit.total_cmp(&other.misfit))
    }

    /// The distances of log e from that value.
    fn misfits(&self, adding: Adding) -> Vec<ErrorMisfit> {
        let rows = self.h.len();
        let columns = self.dt.len();
        if rows < 2 || columns < 2 || self.errors.len() != rows * columns {
            return vec![];
        }
        let cells = (0..rows - 1).flat_map(|j| (0..columns - 1).map(move |k| (j, k)));
        let misfits = cells.map(|(j, k)| ErrorMisfit {
            h: self.h[j],
            dt: self.dt[k],
            misfit: self.misfit_at(j, k, adding.power()),
        });
        misfits.collect()
    }

    /// The size of log(right) / s - log(left) for the error at the j-th mesh width and k-th time
    /// step.
    fn misfit_at(&self, j: usize, k: usize, power: f64) -> f64 {
        let columns = self.dt.len();
        let (row, last_row) = (j * columns, (self.h.len() - 1) * columns);
        // In units of the error itself, so that no power overflows.
        let share = |index: usize| (self.errors[index] / self.errors[row + k]).powf(power);
        let sum = share(row + columns - 1) + share(last_row + k) - share(last_row + columns - 1);
        if sum <= 0.0 {
            f64::INFINITY
        } else {
            (sum.ln() / power).abs()
        }
    }

    /// Judges the orders in h and dt. Level k of each verdict, from 0, is the difference of the
    /// refined levels k and k + 1.
    ///
    /// # Errors
    /// [`JudgeError`] for a meaningless tolerance.
    pub fn judge(
        &self,
        adding: Adding,
        claims: SpaceTime<Band>,
    ) -> Result<SpaceTime<RateVerdict>, JudgeError> {
        let judged = SpaceTime {
            space: self.judge_one(true, adding, claims.space)?,
            time: self.judge_one(false, adding, claims.time)?,
        };
        if self.errors.iter().any(|error| *error < 0.0) {
            // The differences, which are judged, do not show the sign of an error.
            let kind = Reason::NegativeError;
            return Ok(SpaceTime {
                space: judged.space.with_reason(kind, kind.text()),
                time: judged.time.with_reason(kind, kind.text()),
            });
        }
        if judged.both().iter().any(|rate| !rate.verdict.is_pass()) {
            return Ok(judged);
        }
        let left = Remainder::new(self, adding, &judged, claims);
        if left.is_nothing() {
            return Ok(judged);
        }
        let kind = if left.is_limit() {
            Reason::WrongLimit
        } else {
            Reason::LeftOver
        };
        let share = left.share.abs();
        let power = adding.power();
        let finest = self.errors.last().copied().unwrap_or(f64::NAN);
        let size = (power * share).powf(1.0 / power) * finest;
        let because = format!(
            "{} ({} of {})",
            kind.text(),
            error_text(size),
            error_text(finest)
        );
        Ok(SpaceTime {
            space: judged.space.with_reason(kind, &because),
            time: judged.time.with_reason(kind, &because),
        })
    }

    /// Judges one of the two orders by itself, that in h or that in dt.
    fn judge_one(
        &self,
        in_space: bool,
        adding: Adding,
        claim: Band,
    ) -> Result<RateVerdict, JudgeError> {
        let Band { order, tolerance } = claim;
        let judge = Judge::new(tolerance)?;
        let misfit = self.misfit(adding);
        let power = adding.power();
        let lines = [0, 1].map(|from_finest| self.line(in_space, from_finest));
        let [finest, next] = lines
            .each_ref()
            .map(|errors| judge.clone().with_floor(floor(errors, misfit, power)));
        let finest = finest?;
        let next = next?;
        let levels = reduce(&finest, &lines[0], power, order);
        let mut reading = finest.read(&levels).of_differences();
        if let (Some(fit), Some(other)) = (
            reading.fit,
            next.read(&reduce(&next, &lines[1], power, order)).fit,
        ) {
            reading.widen((fit.rate - other.rate).abs());
        }
        let mut judged = finest.judge_read(&reading, order);
        let at_order = contribution(&lines[0], power, order);
        if judged.verdict.is_pass() && !have_one_ratio(&powers(&lines[0], power)) {
            judged = judge_both(&finest, &mut reading, &at_order, order);
        }
        if judged.verdict.is_pass()
            && let Some(level) = repeats(&lines[0], finest.floor(), power, order)
        {
            return Ok(judged.with_repeated(level));
        }
        let doubtful = judged.verdict == Verdict::Pass
            && (turns(&lines[0], &judged) || leaves(&judged, order, tolerance));
        Ok(if doubtful {
            finest.judge_as(&reading, order, Reason::NotAsymptotic)
        } else {
            judged
        })
    }

    /// The errors over the refined levels, at the finest level of the other step or this many
    /// before it; NaN if there is none.
    fn line(&self, in_space: bool, from_finest: usize) -> Vec<Level> {
        let rows = self.h.len();
        let columns = self.dt.len();
        let steps = if in_space { self.h } else { self.dt };
        let mut levels = vec![];
        for (k, &step) in steps.iter().enumerate() {
            let index = if in_space {
                ((k + 1) * columns).checked_sub(1 + from_finest)
            } else {
                (rows * columns + k).checked_sub((1 + from_finest) * columns)
            };
            let error = index.and_then(|index| self.errors.get(index));
            levels.push(Level {
                step,
                error: error.copied().unwrap_or(f64::NAN),
            });
        }
        levels
    }
}

/// What the differences must exceed, in the unit of the errors.
fn floor(errors: &[Level], misfit: f64, power: f64) -> f64 {
    // A relative uncertainty m of e is one of s m e^s of e^s.
    let finest = errors.last().map_or(f64::NAN, |level| level.error.abs());
    let floor = finest * (power * (MISFITS * misfit + ROUND_OFF)).powf(1.0 / power);
    // If (a) misses everything, nothing is known.
    if floor.is_finite() { floor } else { f64::MAX }
}

/// One contribution by itself, with the divisors for the rate that it then has, or for `order` if
/// it has none.
fn reduce(judge: &Judge, errors: &[Level], power: f64, order: f64) -> Vec<Level> {
    let excess = |rate: f64| Some(judge.read(&contribution(errors, power, rate)).fit?.rate - rate);
    contribution(errors, power, crossing(excess, RATES).unwrap_or(order))
}

/// One contribution by itself at all levels except the finest, as errors of this order at
/// [mean steps](crate::richardson); the finest at the coarser of its steps,
/// `|e_k^s - e_(k+1)^s| / (1 - ρ_k^(-s p))` to the power 1/s.
///
/// * `power`: s.
/// * `rate`: p.
fn contribution(errors: &[Level], power: f64, rate: f64) -> Vec<Level> {
    let ratio = match errors {
        [.., before, finest] => before.step / finest.step,
        _ => f64::NAN,
    };
    let share = 1.0 - ratio.powf(-power * rate);
    let differences = differences_of_order(&powers(errors, power), power * rate).into_iter();
    let levels = differences.map(|level| Level {
        step: level.step * ratio,
        error: (level.error / share).powf(1.0 / power),
    });
    levels.collect()
}

/// e^s as values over their steps.
fn powers(errors: &[Level], power: f64) -> Vec<StepValue> {
    let values = errors.iter().map(|level| StepValue {
        step: level.step,
        value: level.error.powf(power),
    });
    values.collect()
}

/// The first level that has the error of the level before, though its contribution is above the
/// floor.
///
/// * `power`: s.
/// * `order`: of the contribution.
fn repeats(errors: &[Level], floor: f64, power: f64, order: f64) -> Option<usize> {
    repeated_value(&powers(errors, power), power * order, floor.powf(power))
}

/// Whether the errors fall on one of the refinements used and grow on another.
fn turns(errors: &[Level], judged: &RateVerdict) -> bool {
    let used = &errors[judged.used.start..=judged.used.end];
    let falls: Vec<bool> = used
        .windows(2)
        .map(|pair| pair[1].error < pair[0].error)
        .collect();
    falls.iter().any(|falls_here| *falls_here != falls[0])
}

/// Whether there are only two rates, and the second is farther from the order.
fn leaves(judged: &RateVerdict, order: f64, tolerance: f64) -> bool {
    let rates = &judged.pairwise[judged.used.start..judged.used.end - 1];
    let [first, second] = rates else { return false };
    let [first, second] = [first, second].map(|rate| (rate - order).abs());
    judged.used.len() == FEWEST_LEVELS && second > first + DEPARTURE_OF_TWO_RATES * tolerance
}

#[cfg(test)]
mod tests;
