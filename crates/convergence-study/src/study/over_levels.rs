//! Errors over levels of refinement: judged, guarded, drawn and listed in the same way for all
//! kinds of study.

mod boundary;
mod equal;
#[cfg(feature = "reports")]
mod figure;
mod looks;
mod rates;
mod refinement;

use super::outcome::{Check, LevelErrors, NamedRate, Outcome, Quantity};
use super::subject::{Sort, Subject};
use crate::column::Column;
use crate::text::lists::distinct;
use crate::text::named::NamedNumber;
pub(crate) use convergence_judge::claims::Claim;
use convergence_judge::claims::unless_algebraic;
use convergence_judge::fit::Level;
use convergence_judge::verdict::{Floor, RateVerdict, Reason, Samples};
pub(crate) use rates::rate_quantities;
pub(crate) use rates::summary;
pub use refinement::{RefinedIn, Refinement};

/// Relative change of an error that the baseline tolerates: another processor or mathematical
/// library changes it by at most 1e-8, a change of the computation by more.
pub(crate) const ERROR_TOLERANCE: f64 = 1e-6;

/// One error on every level, coarse to fine.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorColumn {
    /// Its name: a norm, a quantity.
    pub name: String,
    /// What the baseline calls its numbers: `error`; `value` where their differences are judged.
    pub noun: &'static str,
    /// What it is about.
    pub subject: Subject,
    /// Its notation in the legends of figures; `None`: its name.
    pub symbol: Option<String>,
    /// As measured; `None` without a result: the case failed, or found no such error.
    pub errors: Vec<Option<f64>>,
    /// The numbers that these errors are made of, if they are.
    pub samples: Option<Samples>,
    /// The claim about it, if there is one.
    pub claim: Option<Claim>,
    /// Whether the claim is only drawn, for comparison: nobody makes it.
    pub is_only_drawn: bool,
    /// Its style in figures, of `chart::style`: the same wherever this error is drawn.
    pub style: usize,
}

impl ErrorColumn {
    /// Whether any level has a result.
    pub(super) fn has_some_result(&self) -> bool {
        self.errors.iter().any(Option::is_some)
    }

    /// Why no level has a result, if others have one: the name is that of nothing.
    ///
    /// * `what`: `an error` or `a value`; `columns`: all of these.
    pub(crate) fn unknown(&self, what: &str, columns: &[Self]) -> Option<String> {
        let known = columns.iter().filter(|column| column.has_some_result());
        let known: Vec<&str> = known.map(|column| column.name.as_str()).collect();
        if self.has_some_result() || known.is_empty() {
            return None;
        }
        let verb = if known.len() == 1 { "is" } else { "are" };
        let name = &self.name;
        let known = known.join(", ");
        Some(format!(
            "no level has {what} `{name}`; there {verb} {known}"
        ))
    }

    /// An error with a claim, called by its name in figures.
    ///
    /// * `errors`: coarse to fine; `None` without a result.
    pub fn new(
        name: impl Into<String>,
        claim: Claim,
        errors: impl IntoIterator<Item = Option<f64>>,
    ) -> Self {
        Self {
            claim: Some(claim),
            ..Self::without_claim(name, errors)
        }
    }

    /// An error without a claim, about what its name says, and called by it in figures.
    ///
    /// * `errors`: coarse to fine; `None` without a result.
    pub fn without_claim(
        name: impl Into<String>,
        errors: impl IntoIterator<Item = Option<f64>>,
    ) -> Self {
        let name = name.into();
        Self {
            noun: "error",
            subject: Subject::of(&name),
            name,
            symbol: None,
            errors: errors.into_iter().collect(),
            samples: None,
            claim: None,
            is_only_drawn: false,
            style: 0,
        }
    }

    /// A column for every error claimed or computed: claimed ones first, then the others in order
    /// of occurrence.
    ///
    /// * `levels`: the errors of each level by name, coarse to fine; `None` if the case failed.
    pub fn of<N: AsRef<str>>(
        claims: &[(N, Claim)],
        levels: &[Option<&[NamedNumber]>],
    ) -> Vec<Self> {
        let claimed_names = claims.iter().map(|(name, _)| name.as_ref());
        let computed = levels.iter().copied().flatten().flatten();
        let computed_names = computed.map(|error| error.name.as_str());
        distinct(claimed_names.chain(computed_names))
            .into_iter()
            .enumerate()
            .map(|(style, name)| {
                let errors = levels.iter();
                let errors = errors.map(|errors| NamedNumber::find(errors.as_deref()?, name));
                Self {
                    claim: claim_of(claims, name),
                    style,
                    ..Self::without_claim(name, errors)
                }
            })
            .collect()
    }
}

/// The claim about the error of that name.
fn claim_of<N: AsRef<str>>(claims: &[(N, Claim)], name: &str) -> Option<Claim> {
    let entry = claims.iter().find(|(other, _)| other.as_ref() == name);
    entry.map(|(_, claim)| *claim)
}

/// Errors over levels.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// What is refined.
    pub axis: RefinedIn,
    /// The levels, steps decreasing.
    pub refinements: Vec<Refinement>,
    /// The errors.
    pub columns: Vec<ErrorColumn>,
    /// Fine levels with errors up to this one are not used: a thousand times the round-off, where
    /// that is known.
    pub floor: Floor,
    /// What is measured, in the titles and at the axes of figures.
    measured: &'static str,
    /// Whether programs or functions have answered the errors, of which two with claims must not be
    /// equal: norms that a kind computes may be.
    are_answers: bool,
    /// Whether programs have printed the errors: their last places are rounded.
    are_printed: bool,
    /// Whether the steps are those of degrees.
    are_degrees: bool,
}

impl Levels {
    /// The names under which a level reports its step beside its errors.
    pub const STEPS: [&'static str; 2] = super::errors_over_levels::STEPS;

    /// * `refinements`: steps decreasing.
    pub fn new(
        axis: RefinedIn,
        refinements: impl IntoIterator<Item = Refinement>,
        columns: impl IntoIterator<Item = ErrorColumn>,
    ) -> Self {
        let refinements = refinements.into_iter().collect();
        let columns = columns.into_iter().collect();
        Self {
            axis,
            refinements,
            columns,
            floor: Floor::NONE,
            measured: "error",
            are_answers: false,
            are_printed: false,
            are_degrees: false,
        }
    }

    /// The same of errors that programs or functions have answered.
    pub(crate) fn of_answers(self) -> Self {
        Self {
            are_answers: true,
            ..self
        }
    }

    /// The same of errors that programs have printed, with so many digits as they have.
    pub(crate) fn printed(self) -> Self {
        Self {
            are_printed: true,
            ..self
        }
    }

    /// The same over steps of degrees, if this is true.
    pub(crate) fn over_degrees(self, are_degrees: bool) -> Self {
        Self {
            are_degrees,
            ..self
        }
    }

    /// The same of differences between results, which figures do not call errors.
    pub fn of_differences(self) -> Self {
        Self {
            measured: "difference",
            ..self
        }
    }

    /// The same where errors up to this one are round-off.
    pub fn with_floor(self, floor: Floor) -> Self {
        Self { floor, ..self }
    }

    /// The errors of this name.
    pub(crate) fn column(&self, name: &str) -> Option<&ErrorColumn> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The errors of a column over their steps, without levels that lack a result.
    fn points(&self, column: &ErrorColumn) -> Vec<Level> {
        let levels = self.refinements.iter().enumerate();
        levels
            .filter_map(|(i, level)| {
                Some(Level {
                    step: level.step,
                    error: result_at(&column.errors, i)?,
                })
            })
            .collect()
    }

    /// The same as they are judged.
    fn as_column(&self, column: &ErrorColumn) -> Column {
        let levels = self.points(column);
        let samples = column.samples.clone();
        let new = match self.are_printed {
            true => Column::of_answers,
            false => Column::exact,
        };
        Column {
            samples: samples.filter(|samples| samples.numbers.len() == levels.len()),
            ..new(&column.name, levels)
        }
    }

    /// For each level whether it has a result.
    fn has_result(&self, column: &ErrorColumn) -> Vec<bool> {
        (0..self.refinements.len())
            .map(|i| result_at(&column.errors, i).is_some())
            .collect()
    }

    /// One verdict for each error with a claimed order. A level without a result makes it fail; the
    /// rate is that of the others.
    pub fn judge(&self) -> Vec<NamedRate> {
        let mut verdicts = vec![];
        let pairs = self.equal_pairs();
        for column in &self.columns {
            if let Some(claim) = &column.claim {
                verdicts.push(NamedRate {
                    name: column.name.clone(),
                    subject: column.subject.clone(),
                    rate: self.unless_equal(&pairs, &column.name, self.verdict(column, claim)),
                });
            }
        }
        verdicts
    }

    /// The verdict on the claim about an error.
    fn verdict(&self, column: &ErrorColumn, claim: &Claim) -> RateVerdict {
        let judged = self.as_column(column).judge(claim, self.floor);
        let judged = match self.are_degrees {
            true => unless_algebraic(&self.points(column), judged),
            false => judged,
        };
        let labels: Vec<&str> = self
            .refinements
            .iter()
            .map(|level| level.label.as_str())
            .collect();
        let judged = judged.over_all_levels(&labels, &self.has_result(column));
        match column.unknown("an error", &self.columns) {
            Some(unknown) => judged.with_reason(Reason::NoResult, &unknown),
            None => judged,
        }
    }

    /// The outcome of errors over levels: rates with their verdicts, errors, guarded numbers and
    /// the figure `what`.
    ///
    /// * `subject`, `caption`: as in [`figure`](Self::figure).
    pub fn outcome(
        &self,
        what: &str,
        subject: Option<&str>,
        caption: &str,
        checks: Vec<Check>,
    ) -> Outcome {
        let outcome = self.outcome_without_figure(checks);
        #[cfg(feature = "reports")]
        let figure = Some(self.figure(
            what,
            subject.map(str::to_owned),
            caption.to_owned(),
            &outcome.rates,
        ));
        #[cfg(not(feature = "reports"))]
        let (figure, _) = (None, (what, subject, caption));
        Outcome {
            figures: figure.into_iter().collect(),
            ..outcome
        }
    }

    /// The same without the figure.
    pub(crate) fn outcome_without_figure(&self, mut checks: Vec<Check>) -> Outcome {
        checks.extend(self.equal_columns());
        let rates = self.judge();
        checks.extend(self.boundary(&rates));
        Outcome {
            levels: self.errors(),
            quantities: self.quantities(&rates),
            ..Outcome::new("", rates, checks).summed_up_by_rates("")
        }
    }

    /// Every error of every level, for record and report.
    pub fn errors(&self) -> Vec<LevelErrors> {
        let levels = self.refinements.iter().enumerate();
        levels.map(|(i, level)| self.errors_at(i, level)).collect()
    }

    /// The errors of the i-th level.
    fn errors_at(&self, i: usize, level: &Refinement) -> LevelErrors {
        let mut errors = vec![];
        let mut without = vec![];
        for column in &self.columns {
            errors.push(NamedNumber::new(&column.name, number_at(&column.errors, i)));
            if result_at(&column.errors, i).is_none() {
                without.push(column.name.clone());
            }
        }
        LevelErrors {
            parameters: level.parameters.clone(),
            step: Some(level.step),
            work: None,
            errors,
            without,
        }
    }

    /// The numbers that the baseline guards: every observed rate, then every error of every level.
    pub fn quantities(&self, rates: &[NamedRate]) -> Vec<Quantity> {
        let mut quantities = rate_quantities(rates, &self.columns);
        for (i, Refinement { label, .. }) in self.refinements.iter().enumerate() {
            for column in &self.columns {
                let error = number_at(&column.errors, i);
                let name = format!("{} {}, {label}", column.noun, column.name);
                let subject = column.subject.clone().in_case(label);
                quantities.push(Quantity {
                    sort: Sort::Error,
                    ..Quantity::new(name, error, ERROR_TOLERANCE).about(subject)
                });
            }
        }
        quantities
    }
}

/// The error of a level; `None` without a result.
fn result_at(errors: &[Option<f64>], level: usize) -> Option<f64> {
    errors.get(level).copied().flatten()
}

/// The same as a number of the record: NaN without a result.
fn number_at(errors: &[Option<f64>], level: usize) -> f64 {
    result_at(errors, level).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Table;
    use convergence_judge::verdict::Verdict;

    #[test]
    fn a_column_that_is_too_short_fails_and_a_wrong_tolerance_keeps_the_rate() {
        let refinements = halved();
        let judged = |count: usize, tolerance: f64| {
            let errors = refinements
                .iter()
                .take(count)
                .map(|level| Some(level.step * level.step));
            let claim = Claim::new(2.0, tolerance);
            let column = ErrorColumn::new("L2", claim, errors);
            Levels::new(RefinedIn::Space, refinements.clone(), [column])
                .judge()
                .remove(0)
                .rate
        };
        assert_eq!(judged(5, 0.1).verdict, Verdict::Pass);
        assert_eq!(
            judged(4, 0.1).verdict,
            Verdict::Fail,
            "the finest level has no error"
        );
        for tolerance in [-0.1, 0.7, f64::NAN] {
            let judged = judged(5, tolerance);
            assert_eq!(judged.verdict, Verdict::Inconclusive, "{tolerance}");
            assert!(
                judged.fitted.is_some_and(|rate| (rate - 2.0).abs() < 1e-6),
                "{tolerance}"
            );
        }
    }

    fn halved() -> Vec<Refinement> {
        [4, 8, 16, 32, 64]
            .map(|n| Refinement::new(format!("cells = {n}"), &[("cells", n)], 1.0 / n as f64))
            .into()
    }

    /// Errors of second order on five levels, times these factors.
    fn scattered(factors: [f64; 5]) -> Levels {
        let refinements = halved();
        let errors = refinements
            .iter()
            .zip(factors)
            .map(|(level, factor)| Some(factor * level.step * level.step));
        let column = ErrorColumn::new("L2", Claim::new(2.0, 0.1), errors);
        Levels::new(RefinedIn::Space, refinements.clone(), [column])
    }

    /// The errors zigzag: their rate may be anything.
    const ZIGZAG: [f64; 5] = [1.0, 3.0, 1.0, 3.0, 1.0];

    #[test]
    fn a_table_of_rates_has_the_digits_of_the_interval_and_no_rate_where_that_says_nothing() {
        let cells = |factors| {
            let table = Table::of_rates("", &scattered(factors).judge());
            [table.rows[0][3].clone(), table.rows[0][4].clone()]
        };
        assert_eq!(cells([1.0; 5]), ["2.0000", "2.0000 ± 0.00005"]);
        let [rate, interval] = cells([1.0, 1.02, 1.0, 1.02, 1.0]);
        assert!(
            (4..=5).contains(&rate.len()) && interval.contains(" to "),
            "{rate}, {interval}"
        );
        assert_eq!(cells(ZIGZAG)[0], "no rate");
    }

    #[cfg(feature = "reports")]
    #[test]
    fn a_caption_speaks_of_lines_only_where_there_are_some() {
        let caption = |factors, rates: bool| {
            let levels = scattered(factors);
            let rates = if rates { levels.judge() } else { vec![] };
            levels.figure("f", None, "Errors.".into(), &rates).caption
        };
        assert_eq!(caption([1.0; 5], true), format!("Errors.{}", figure::LINES));
        assert_eq!(caption([1.0; 5], false), "Errors.");
        assert_eq!(caption(ZIGZAG, true), "Errors.");
    }
}
