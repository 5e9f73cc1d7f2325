//! The answer of the judge: a verdict, its reason, and the numbers behind it.

use std::ops::Range;

use super::cause::Cause;
use super::reading::Reading;
use super::reason::Reason;
use super::tendency::Tendency;
use super::words::{Aside, SetAside, Verdict};
use crate::claims::Bound;
use crate::interval::Interval;
use crate::text::json::{nan, nans};
use crate::text::number::{
    RATE_PLACES, committed_rate, counted, decimals, interval_places, interval_text, order_text,
    plain_text,
};
use crate::text::prose::Prose;

/// `error = constant · step^rate`, a straight line in a figure with logarithmic axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PowerLaw {
    /// Observed exponent.
    pub rate: f64,
    /// Error at step 1.
    pub constant: f64,
}

impl PowerLaw {
    /// The law of this rate and of this error at step 1.
    pub fn new(rate: f64, constant: f64) -> Self {
        Self { rate, constant }
    }

    /// The error that the law gives for a step.
    ///
    /// ```
    /// use convergence_judge::verdict::judge_pairs;
    ///
    /// let errors = [0.4, 0.2, 0.1, 0.05].map(|h: f64| (h, 3.0 * h * h));
    /// let law = judge_pairs(errors, 2.0, 0.05).power_law().expect("four levels give a rate");
    /// assert!((law.error_at(0.01) - 3e-4).abs() < 1e-12);
    /// ```
    pub fn error_at(&self, step: f64) -> f64 {
        self.constant * step.powf(self.rate)
    }
}

/// A rate, or several, with the claim about it: the words of every report.
pub fn against_claim(rate: &str, claim: &str) -> String {
    format!("{rate}, claimed {claim}")
}

/// The same with why it passes or does not: `1.5 (1.4 to 1.6), claimed 2 ± 0.01: too low`.
pub fn judged_in_words(rate: &str, claim: &str, why: &str) -> String {
    format!("{}: {why}", against_claim(rate, claim))
}

/// The rates that a claim accepts: those within a tolerance of an order.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Band {
    /// The order that theory claims.
    #[serde(deserialize_with = "nan")]
    pub order: f64,
    /// Half-width of the band about the order.
    #[serde(deserialize_with = "nan")]
    pub tolerance: f64,
}

impl Band {
    /// How far a rate is from the order, in units of the tolerance: above 0 for a higher rate.
    pub fn distance(self, rate: f64) -> f64 {
        (rate - self.order) / self.tolerance
    }

    /// What a pass confirms, and the nearest orders that it excludes: `2, not 1.5 or 2.5`.
    pub fn excludes(self) -> String {
        let others = [-2.0, 2.0]
            .map(|sides| self.order + sides * self.tolerance)
            .into_iter()
            .filter(|other| *other > 0.0);
        let others: Vec<String> = others
            .map(|other| order_text(committed_rate(other)))
            .collect();
        format!("{}, not {}", order_text(self.order), others.join(" or "))
    }
}

impl std::fmt::Display for Band {
    /// `2 ± 0.05`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} ± {}",
            order_text(self.order),
            plain_text(self.tolerance)
        )
    }
}

/// The judgement of one sequence of errors.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[must_use = "a verdict that is not read lets a lost order pass"]
#[non_exhaustive]
pub struct RateVerdict {
    /// What theory claims; `None` if nothing is claimed, and so nothing can be confirmed.
    #[serde(flatten)]
    pub claimed: Option<Band>,
    /// Which rates above the order agree with it.
    #[serde(default, skip_serializing_if = "Bound::is_both")]
    pub bound: Bound,
    /// All rates between neighbouring levels, as measured: NaN and infinite ones are kept. NaN next
    /// to a level without a result.
    #[serde(deserialize_with = "nans")]
    pub pairwise: Vec<f64>,
    /// The rate at h → 0 by [`rate_interval`](crate::fit::rate_interval): present whenever
    /// three levels above the floor have positive errors, whatever the verdict. If the asymptotic
    /// range is shorter, it is the rate of the three finest of them.
    pub fitted: Option<f64>,
    /// The constant C of error = C step^rate for that rate: the curve passes through the error of
    /// the finest level `used`.
    pub constant: Option<f64>,
    /// The interval of `fitted`, which is its middle unless it is [wider](Self::wider) by the digits
    /// of values. It decides the verdict, unless the reason is another one.
    #[serde(deserialize_with = "Option::deserialize")]
    pub interval: Option<Interval>,
    /// Limit of the finest pairwise rates,
    /// [`extrapolated_rate`](crate::fit::extrapolated_rate): for comparison with the
    /// interval; it is not judged.
    pub extrapolated: Option<f64>,
    /// Indices of the levels that the fit used; empty if there was no fit. Levels without a result
    /// in this range were not used.
    #[serde(default)]
    pub used: Range<usize>,
    /// Levels that the fit did not use, coarsest first, each with the reason: a table of errors
    /// should mark them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set_aside: Vec<SetAside>,
    /// The outcome.
    pub verdict: Verdict,
    /// The reason by name.
    #[serde(default)]
    pub code: Reason,
    /// The reason in a few words, naming the level if it concerns one.
    #[serde(default)]
    pub because: Prose,
    /// The reason in words, with its numbers.
    pub reason: Prose,
    /// What the errors tend to where the claim does not pass, if that is known: advice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tendency: Option<Tendency>,
    /// A law that explains why the claim does not pass, if one is known: advice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<Cause>,
    /// The least floor with which the claim passes, where the finest errors may be round-off. It is
    /// never taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offered_floor: Option<f64>,
}

impl RateVerdict {
    /// The rate with its constant, as a curve through the finest error used; `None` without a rate.
    pub fn power_law(&self) -> Option<PowerLaw> {
        Some(PowerLaw::new(self.fitted?, self.constant?))
    }

    /// The rate with its interval: `1.0007 (0.9977 to 1.0036)`, or `2.0000 ± 0.00005` if that is
    /// narrow; `None` without one. The levels follow unless all were used.
    ///
    /// * `most`: the largest number of decimals.
    pub fn interval_in_words(&self, most: usize) -> Option<String> {
        let fitted = self.fitted?;
        let interval = self.interval?;
        let fitted = decimals(fitted, interval_places(interval, most));
        let interval = interval_text(interval, most);
        // A narrow interval begins with its middle.
        let rate = if interval.contains(" ± ") {
            interval
        } else {
            format!("{fitted} ({interval})")
        };
        let all = self.used == (0..self.pairwise.len() + 1);
        Some(if all {
            rate
        } else {
            format!("{rate} {}", self.levels_in_words())
        })
    }

    /// The order that theory claims.
    pub fn order(&self) -> Option<f64> {
        self.claimed.map(|band| band.order)
    }

    /// The claim in words: `2 ± 0.05`, `at least 2 ± 0.25`, or `none`.
    pub fn claim(&self) -> String {
        match self.claimed {
            Some(band) => format!("{}{band}", self.bound.words()),
            None => "none".to_owned(),
        }
    }

    /// The rate with a claim: `1.0007 (0.9977 to 1.0036), claimed 2 ± 0.01`; without one, the rate.
    ///
    /// * `most`: the largest number of decimals.
    pub fn against(&self, most: usize) -> String {
        let rate = self.rate_in_words(most);
        match self.claimed {
            Some(_) => against_claim(&rate, &self.claim()),
            None => rate,
        }
    }

    /// Rate, claim and reason on one line: `1.0007 (0.9977 to 1.0036), claimed 2 ± 0.01: too low`.
    pub fn line(&self) -> String {
        format!("{}: {}", self.against(RATE_PLACES), self.because)
    }

    /// The same where nothing else is claimed: a pass says which orders it excludes.
    ///
    /// * `most`: the largest number of decimals.
    pub fn answer(&self, most: usize) -> String {
        let excluded = self.claimed.filter(|_| self.verdict.is_pass());
        let why = excluded.map_or_else(|| self.because.to_string(), Band::excludes);
        format!("{}: {why}", self.against(most))
    }

    /// The rate alone with its order: `1.001 (order 1)`.
    ///
    /// * `places`: the number of decimals of the rate.
    pub fn beside_order(&self, places: usize) -> String {
        let rate = match self.fitted {
            Some(fitted) => decimals(fitted, places),
            None => self.rate_in_words(RATE_PLACES),
        };
        match self.order() {
            Some(order) => format!("{rate} (order {})", order_text(order)),
            None => rate,
        }
    }

    /// What the errors tend to, or else what the reason means, with its cause if one is known, and
    /// what to do; `None` for a pass.
    pub fn advice(&self) -> Option<String> {
        if self.verdict.is_pass() {
            return None;
        }
        if let Some(tendency) = self.tendency {
            return Some(tendency.advice());
        }
        let cause = self
            .cause
            .map_or(String::new(), |cause| format!(" {}", cause.advice()));
        Some(self.code.advice().to_owned() + &cause)
    }

    /// The same in factors by which errors fall for each unit of a count n, where the step is
    /// exp(-n).
    pub fn as_factors(&self) -> Self {
        Self {
            pairwise: self.pairwise.iter().map(|rate| rate.exp()).collect(),
            fitted: self.fitted.map(f64::exp),
            interval: self.interval.map(|interval| interval.map(f64::exp)),
            extrapolated: self.extrapolated.map(f64::exp),
            ..self.clone()
        }
    }

    /// The last rate between neighbouring levels that is a number.
    pub fn finest_rate(&self) -> Option<f64> {
        self.pairwise
            .iter()
            .rev()
            .copied()
            .find(|rate| rate.is_finite())
    }

    /// Like [`interval_in_words`](Self::interval_in_words); without an interval, the rate between
    /// the finest levels.
    ///
    /// * `most`: the largest number of decimals.
    pub fn rate_in_words(&self, most: usize) -> String {
        if let Some(words) = self.interval_in_words(most) {
            return words;
        }
        match self.finest_rate() {
            Some(rate) => {
                let rate = decimals(rate, 3);
                format!("{rate} between the finest levels that have one")
            }
            None => "no rate".to_owned(),
        }
    }

    /// The levels that the fit used.
    fn levels_in_words(&self) -> String {
        let first = self.used.start + 1;
        let last = self.used.end;
        let levels = self.pairwise.len() + 1;
        format!("from levels {first} to {last} of {levels}")
    }

    /// Extends the verdict on the levels with a result to all levels: levels without one make it
    /// fail, and the rate is that of the others.
    ///
    /// * `self`: the verdict on the levels with a result.
    /// * `names`: of all levels.
    /// * `has_result`: whether each of them has a result.
    pub fn over_all_levels(self, names: &[&str], has_result: &[bool]) -> Self {
        let levels = has_result.len();
        let (present, absent): (Vec<usize>, Vec<usize>) =
            (0..levels).partition(|level| has_result[*level]);
        if absent.is_empty() {
            return self;
        }
        let mut pairwise = vec![f64::NAN; levels.saturating_sub(1)];
        for (pair, rate) in present.windows(2).zip(&self.pairwise) {
            if pair[0] + 1 == pair[1] {
                pairwise[pair[0]] = *rate;
            }
        }
        let used = match self.used {
            Range { start, end } if start < end => present[start]..present[end - 1] + 1,
            _ => 0..0,
        };
        let mut set_aside = vec![];
        for SetAside { level, because } in self.set_aside {
            let level = present[level];
            set_aside.push(SetAside { level, because });
        }
        for level in &absent {
            set_aside.push(SetAside {
                level: *level,
                because: Aside::NoResult,
            });
        }
        set_aside.sort_by_key(|aside| aside.level);
        let missing: Vec<&str> = absent
            .iter()
            .filter_map(|level| names.get(*level).copied())
            .collect();
        Self {
            pairwise,
            used,
            set_aside,
            ..self
        }
        .without_result(levels, &missing)
    }

    /// The same rate with a reason from another rule than that of its levels.
    pub fn with_reason(self, code: Reason, because: &str) -> Self {
        let reason = format!("{because}{}", self.numbers());
        let cause = self.cause.filter(|_| !code.verdict().is_pass());
        let tendency = self.tendency.filter(|_| code.is_about_the_errors());
        Self {
            verdict: code.verdict(),
            code,
            because: because.into(),
            reason: reason.into(),
            tendency,
            cause,
            ..self
        }
    }

    /// The same rate with an interval that holds this one, too.
    pub fn wider(self, other: Interval) -> Self {
        let interval = self.interval.map(|own| own.hull(other));
        Self { interval, ..self }.with_own_words()
    }

    /// The same with the reason in the words of its code, and its numbers.
    fn with_own_words(self) -> Self {
        let words = match self.code {
            // Of its level.
            Reason::Repeats => self.because.to_string(),
            code => code.text().to_owned(),
        };
        let reason = format!("{words}{}", self.numbers()).into();
        Self { reason, ..self }
    }

    /// The same rate where another error with a claim is equal to this one in all digits: it does
    /// not pass.
    pub fn equal_to(self, other: &str) -> Self {
        if !self.verdict.is_pass() {
            return self;
        }
        let words = format!("equal to `{other}` in all digits");
        self.with_reason(Reason::EqualColumns, &words)
    }

    /// What follows the reason: the interval and the claim; empty without an interval.
    fn numbers(&self) -> String {
        let Some(interval) = self.interval else {
            return String::new();
        };
        let interval = interval_text(interval, RATE_PLACES);
        let rate = format!("{interval} {}", self.levels_in_words());
        match self.claimed {
            Some(band) if self.code != Reason::ClaimUnusable => {
                format!(": {}", against_claim(&rate, &band.to_string()))
            }
            Some(_) => format!(": {rate}"),
            None => String::new(),
        }
    }

    /// The same rate with the verdict that some levels have no result.
    ///
    /// * `levels`: how many levels there are.
    /// * `missing`: the names of those without a result.
    pub fn without_result<S: AsRef<str>>(self, levels: usize, missing: &[S]) -> Self {
        const MOST_NAMED: usize = 4;
        let named: Vec<&str> = missing.iter().take(MOST_NAMED).map(AsRef::as_ref).collect();
        let named = named.join("; ");
        let more = if missing.len() > MOST_NAMED {
            "; ..."
        } else {
            ""
        };
        let levels = counted(levels, "level");
        let have = if missing.len() == 1 { "has" } else { "have" };
        let lacking = format!(
            "{} of {levels} {have} no result: {named}{more}",
            missing.len()
        );
        let reason = match self.interval {
            Some(interval) => {
                let interval = interval_text(interval, RATE_PLACES);
                let rate = format!("{interval} {}", self.levels_in_words());
                let rate = match self.claimed {
                    Some(band) => against_claim(&rate, &band.to_string()),
                    None => rate,
                };
                format!("{lacking}; {rate}")
            }
            None => lacking.clone(),
        };
        Self {
            verdict: Verdict::Fail,
            code: Reason::NoResult,
            because: lacking.into(),
            reason: reason.into(),
            ..self
        }
    }

    /// Builds the verdict, with the words that quote its numbers.
    pub(super) fn new(reading: &Reading<'_>, claimed: Option<Band>, code: Reason) -> Self {
        let cause = claimed.and_then(|band| reading.cause(band.order));
        let verdict = Self {
            claimed,
            bound: Bound::Both,
            pairwise: reading.pairwise.clone(),
            fitted: reading.fit.map(|fit| fit.rate),
            constant: reading.constant(),
            interval: reading.fit.map(|fit| fit.interval),
            extrapolated: reading.extrapolated(),
            used: reading.used.clone(),
            set_aside: reading.set_aside(),
            verdict: code.verdict(),
            code,
            because: reading.words(code).into(),
            reason: Prose::default(),
            tendency: reading.tendency().filter(|_| code.is_about_the_errors()),
            cause: cause.filter(|_| !code.verdict().is_pass()),
            offered_floor: None,
        };
        verdict.with_own_words()
    }
}

#[cfg(test)]
mod tests {
    use crate::verdict::judge_pairs;

    /// An error of 3^-n, over the step exp(-n) of which factors are orders.
    #[test]
    fn a_factor_is_that_by_which_errors_fall_with_each_count() {
        let levels = (1..=5).map(|n| (f64::from(-n).exp(), 3.0_f64.powi(-n)));
        let factors = judge_pairs(levels, 3.0_f64.ln(), 0.1).as_factors();
        let is_three = |factor: f64| (factor - 3.0).abs() < 1e-9;
        assert!(factors.pairwise.len() == 4 && factors.pairwise.iter().all(|one| is_three(*one)));
        assert!(factors.fitted.is_some_and(is_three));
        assert!(factors.extrapolated.is_some_and(is_three));
        let interval = factors.interval.expect("an interval");
        assert!(2.5 < interval.low && interval.low <= 3.0 && 3.0 <= interval.high);
        assert!(interval.high < 3.5, "{interval:?}");
    }
}
