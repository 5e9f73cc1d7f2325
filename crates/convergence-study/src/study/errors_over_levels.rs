//! A ready-made kind of study: errors over levels of refinement, computed by a function.

use std::collections::BTreeSet;

use super::header::Header;
use super::kind::{Case, CaseFailure, Kind, Ran};
use super::outcome::{Check, Outcome};
use super::over_levels::{Claim, ErrorColumn, Levels, RefinedIn, Refinement};
use super::subject::Subject;
use crate::text::named::NamedNumber;
use convergence_judge::claims::Bound;
use convergence_judge::verdict::Verdict;

/// Names under which a level reports its own step, if that is not 1/n.
pub(super) const STEPS: [&str; 2] = ["h", "dt"];

/// The first name that a list has twice.
fn first_repeated<'l>(mut names: impl Iterator<Item = &'l str>) -> Option<&'l str> {
    let mut known = BTreeSet::new();
    names.find(|name| !known.insert(*name))
}

/// What the function of a study may return: errors with their names, or a single error, which is
/// then called `error`; or a [`Result`] of either.
pub trait IntoErrors {
    /// The errors by name.
    ///
    /// # Errors
    /// The case failed, or a name is given twice: one of the two would not be judged.
    fn into_errors(self) -> Result<Vec<NamedNumber>, CaseFailure>;
}

impl IntoErrors for f64 {
    fn into_errors(self) -> Result<Vec<NamedNumber>, CaseFailure> {
        Ok(vec![NamedNumber::new("error", self)])
    }
}

impl<N: Into<String>> IntoErrors for Vec<(N, f64)> {
    fn into_errors(self) -> Result<Vec<NamedNumber>, CaseFailure> {
        let errors: Vec<NamedNumber> = self
            .into_iter()
            .map(|(name, error)| NamedNumber::new(name, error))
            .collect();
        match first_repeated(errors.iter().map(|error| error.name.as_str())) {
            Some(name) => Err(CaseFailure::new(format!(
                "expected each name of an error once, found `{name}` twice"
            ))),
            None => Ok(errors),
        }
    }
}

impl<N: Into<String>, const COUNT: usize> IntoErrors for [(N, f64); COUNT] {
    fn into_errors(self) -> Result<Vec<NamedNumber>, CaseFailure> {
        Vec::from(self).into_errors()
    }
}

impl<T: IntoErrors, E: Into<CaseFailure>> IntoErrors for Result<T, E> {
    fn into_errors(self) -> Result<Vec<NamedNumber>, CaseFailure> {
        self.map_err(Into::into)?.into_errors()
    }
}

/// A study that computes errors on every level of refinement and judges each against its claimed
/// order; made by [`levels()`](levels()).
///
/// Its outcome holds a rate with its verdict for each claim, all errors, a figure, and the numbers
/// that the baseline guards. Errors without a claim are only recorded. If a level fails, or lacks
/// an error that others have, the study fails.
#[derive(Debug, Clone)]
#[must_use = "levels are computed and judged by `run` or `assert_passes`"]
pub struct ErrorsOverLevels<F> {
    pub(crate) header: Header,
    axis: RefinedIn,
    counted: String,
    pub(super) counts: Vec<usize>,
    pub(super) claims: Vec<(String, Claim)>,
    pub(super) solve: F,
}

/// A study of the errors that a function computes on each level of refinement.
///
/// * `counts`: what distinguishes the levels, such as the number of cells in one direction, in any
///   order.
/// * `solve`: the errors at such a count, see [`IntoErrors`]; the same names on every level. The
///   step is 1/count, unless `solve` returns it with the errors under one of the names [`Levels::STEPS`](super::Levels::STEPS).
///
/// ```
/// // The midpoint rule for the integral of exp over (0, 1).
/// let solve = |n: usize| {
///     let h = 1.0 / n as f64;
///     let sum: f64 = (0..n).map(|i| h * ((i as f64 + 0.5) * h).exp()).sum();
///     [("h", h), ("integral", (sum - 1f64.exp_m1()).abs())]
/// };
/// let study = convergence_study::levels([4, 8, 16, 32, 64], solve);
/// study.claim("integral", 2.0).assert_passes();
/// ```
pub fn levels<R, F>(counts: impl IntoIterator<Item = usize>, solve: F) -> ErrorsOverLevels<F>
where
    R: IntoErrors,
    F: Fn(usize) -> R + Send + Sync,
{
    ErrorsOverLevels::of(counts, solve)
}

impl<F> ErrorsOverLevels<F> {
    pub(super) fn of(counts: impl IntoIterator<Item = usize>, solve: F) -> Self {
        Self {
            header: Header::new("levels", "the errors fall with the orders claimed"),
            axis: RefinedIn::Space,
            counted: "n".to_owned(),
            counts: counts.into_iter().collect(),
            claims: vec![],
            solve,
        }
    }

    /// The same study under a name, with a claim in words.
    pub fn described(self, header: Header) -> Self {
        Self { header, ..self }
    }

    /// The same study with a word for the counts, such as `cells`, and the refined quantity, which
    /// names the step in figures.
    pub fn counting(self, counted: impl Into<String>, axis: RefinedIn) -> Self {
        Self {
            counted: counted.into(),
            axis,
            ..self
        }
    }

    /// The same study with a claim: the error of this name falls like `step^order`, within
    /// the tolerance of [`Claim::usual`].
    pub fn claim(self, error: impl Into<String>, order: f64) -> Self {
        self.claiming(error, Claim::usual(order, Bound::Both))
    }

    /// The same with any claim, for example with another tolerance: 0 < tolerance < 0.5.
    pub fn claiming(mut self, error: impl Into<String>, claim: Claim) -> Self {
        self.claims.push((error.into(), claim));
        self
    }

    /// What a level is called.
    pub(super) fn label(&self, count: usize) -> String {
        format!("{} = {count}", self.counted)
    }

    /// The levels computed so far, coarse to fine, which `until_decided`
    /// judges as they grow.
    pub fn levels(&self, ran: &[Ran<usize, Vec<NamedNumber>>]) -> Levels {
        let mut ran: Vec<&Ran<usize, Vec<NamedNumber>>> = ran.iter().collect();
        let has_steps = ran.iter().any(|ran| reported_step(ran).is_some());
        // If some levels report their step, 1/n cannot stand in for that of the others.
        let step_of = |ran: &Ran<usize, Vec<NamedNumber>>| match reported_step(ran) {
            Some(step) => step,
            None if has_steps => f64::NAN,
            None => 1.0 / ran.case.data as f64,
        };
        // A level without a step has no place among the others: then none is moved.
        if ran.iter().all(|ran| !step_of(ran).is_nan()) {
            ran.sort_by(|one, other| step_of(other).total_cmp(&step_of(one)));
        }
        let refinements = ran.iter().map(|ran| {
            let parameters = [(self.counted.as_str(), ran.case.data)];
            Refinement::new(ran.case.label.clone(), &parameters, step_of(ran))
        });
        let errors: Vec<Option<Vec<NamedNumber>>> =
            ran.iter().map(|ran| without_step(ran)).collect();
        let errors: Vec<_> = errors.iter().map(Option::as_deref).collect();
        Levels::new(
            self.axis,
            refinements,
            ErrorColumn::of(&self.claims, &errors),
        )
        .of_answers()
    }

    /// The outcome of levels, and whether all cases and claims are whole.
    pub(super) fn outcome_of<D>(
        &self,
        levels: &Levels,
        ran: &[Ran<D, Vec<NamedNumber>>],
    ) -> Outcome {
        let names: Vec<&str> = levels
            .columns
            .iter()
            .filter(|column| column.has_some_result())
            .map(|column| column.name.as_str())
            .collect();
        let completion = Check::completion(ran, |errors| {
            let names = names
                .iter()
                .filter(|name| !error_of(errors, name).is_finite());
            names.map(|name| format!("the error `{name}`")).collect()
        });
        let mut checks = vec![completion];
        if self.claims.is_empty() {
            let claim = "an order is claimed".to_owned();
            let evidence = "no order of any error is claimed".to_owned();
            checks.push(Check {
                verdict: Verdict::Inconclusive,
                ..Check::that(false, claim, evidence).about(Subject::of("claims"))
            });
        }
        if let Some(name) = first_repeated(self.claims.iter().map(|(name, _)| name.as_str())) {
            let claim = "each error is claimed once".to_owned();
            let evidence = format!("`{name}` is claimed twice: only one of the claims is judged");
            checks.push(Check::that(false, claim, evidence).about(Subject::of("claims")));
        }
        levels.outcome("errors", None, "Errors over levels of refinement.", checks)
    }
}

pub(super) fn is_step(name: &str) -> bool {
    STEPS.contains(&name)
}

/// The step that a level reports among its errors.
fn reported_step(ran: &Ran<usize, Vec<NamedNumber>>) -> Option<f64> {
    let step = ran.ok()?.iter().find(|step| is_step(&step.name));
    step.map(|step| step.value)
}

/// The errors of a level; `None` if it failed.
fn without_step(ran: &Ran<usize, Vec<NamedNumber>>) -> Option<Vec<NamedNumber>> {
    let errors = ran.ok()?.iter();
    let errors = errors.filter(|error| !is_step(&error.name));
    Some(errors.cloned().collect())
}

/// The error of that name; NaN if there is none.
fn error_of(errors: &[NamedNumber], name: &str) -> f64 {
    NamedNumber::find(errors, name).unwrap_or(f64::NAN)
}

impl<R, F> Kind for ErrorsOverLevels<F>
where
    R: IntoErrors,
    F: Fn(usize) -> R + Send + Sync,
{
    type Data = usize;
    type Found = Vec<NamedNumber>;

    /// A finer level is assumed to cost more.
    fn cases(&self) -> Vec<Case<usize>> {
        self.counts
            .iter()
            .map(|&count| Case::new(self.label(count), count as f64, count))
            .collect()
    }

    fn run(&self, count: &usize) -> Result<Vec<NamedNumber>, CaseFailure> {
        (self.solve)(*count).into_errors()
    }

    fn judge(&self, ran: &[Ran<usize, Vec<NamedNumber>>]) -> Outcome {
        self.outcome_of(&self.levels(ran), ran)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use convergence_judge::verdict::Reason;

    const COUNTS: [usize; 5] = [4, 8, 16, 32, 64];

    fn judged<R: IntoErrors, F: Fn(usize) -> R + Send + Sync>(
        study: &ErrorsOverLevels<F>,
    ) -> Outcome {
        study.judge(&study.run_here())
    }

    /// The outcome for an error of second order, claimed to be of this order, changed by `change`.
    fn outcome<R: IntoErrors>(
        order: f64,
        change: impl Fn(usize, f64) -> R + Send + Sync,
    ) -> Outcome {
        let study =
            levels(COUNTS, |n| change(n, (n as f64).powi(-2))).counting("cells", RefinedIn::Space);
        judged(&study.claiming("e", Claim::new(order, 0.05)))
    }

    #[test]
    fn a_level_may_say_its_own_step_and_a_higher_rate_may_do() {
        let solve = |n: usize| [("dt", 2.0 / n as f64), ("e", (n as f64).powi(-3))];
        assert_eq!(
            judged(&levels(COUNTS, solve).claim("e", 2.0)).verdict,
            Verdict::Fail
        );
        let found = judged(&levels(COUNTS, solve).claiming(
            "e",
            Claim {
                bound: Bound::AtLeast,
                ..Claim::new(2.0, 0.1)
            },
        ));
        assert_eq!(
            (found.verdict, found.levels[0].step),
            (Verdict::Pass, Some(0.5))
        );
        assert_eq!(found.levels[0].errors, [NamedNumber::new("e", 1.0 / 64.0)]);
        let some = |n: usize| {
            if n == 8 {
                vec![("e", 1.0)]
            } else {
                vec![("h", 1.0 / n as f64), ("e", (n as f64).powi(-2))]
            }
        };
        assert_eq!(
            judged(&levels(COUNTS, some).claim("e", 2.0)).rates[0]
                .rate
                .code,
            Reason::StepsNotDecreasing
        );
        assert_eq!(
            judged(&levels(COUNTS, |n| (n as f64).powi(-2)).claim("error", 2.0)).verdict,
            Verdict::Pass
        );
    }

    #[test]
    fn a_claim_about_an_error_that_no_level_has_names_those_there_are() {
        let found =
            judged(&levels(COUNTS, |n| [("L2", 1.0 / n as f64), ("up", 1.0)]).claim("L3", 2.0));
        assert_eq!(
            (found.verdict, found.rates[0].rate.code),
            (Verdict::Fail, Reason::NoResult)
        );
        assert_eq!(
            found.rates[0].rate.reason.to_string(),
            "no level has an error `L3`; there are L2, up"
        );
    }

    #[test]
    fn a_right_claim_passes_and_a_wrong_one_fails() {
        let of = |order| outcome(order, |_, error| [("e", error), ("f", 1.0)]);
        assert_eq!(
            (of(2.0).verdict, of(1.0).verdict),
            (Verdict::Pass, Verdict::Fail)
        );
        let right = of(2.0);
        assert_eq!(right.levels.len(), COUNTS.len());
        assert_eq!(
            right.levels[2].parameters,
            [NamedNumber::new("cells", 16.0)]
        );
        assert_eq!(
            right.levels[2].errors,
            [
                NamedNumber::new("e", 1.0 / 256.0),
                NamedNumber::new("f", 1.0)
            ]
        );
        // A rate, and two errors on five levels.
        assert_eq!(right.quantities.len(), 1 + 2 * 5);
        assert_eq!(right.quantities[1].name, "error e, cells = 4");
        let drawn: Vec<&str> = right
            .figures
            .iter()
            .map(|figure| figure.file.as_str())
            .collect();
        assert_eq!(
            drawn,
            ["errors.svg"][..usize::from(cfg!(feature = "reports"))]
        );
    }

    #[test]
    fn a_level_that_fails_or_lacks_an_error_fails_the_study() {
        let failure = || Err(CaseFailure::new("diverged"));
        let failed = outcome(2.0, |n, error| {
            if n == 8 {
                failure()
            } else {
                Ok([("e", error)])
            }
        });
        assert_eq!(failed.verdict, Verdict::Fail);
        assert!(
            failed.checks[0]
                .evidence
                .to_string()
                .contains("cells = 8: diverged"),
            "{:?}",
            failed.checks
        );
        let expected = "e 2.0000 (order 2): 1 of 5 levels has no result: cells = 8; 2.0000 ± 0.00005 from levels 1 to 5 of 5";
        assert!(
            failed.summary.to_string().starts_with(expected),
            "{}",
            failed.summary
        );
        let rate = &failed.rates[0].rate;
        assert_eq!(
            (rate.code, rate.set_aside.len(), rate.set_aside[0].level),
            (Reason::NoResult, 1, 1)
        );
        assert!(
            rate.pairwise[..2].iter().all(|rate| rate.is_nan())
                && rate.pairwise[2..].iter().all(|r| (r - 2.0).abs() < 1e-9)
        );
        // An error that was computed and is NaN is a different case.
        let nan = outcome(2.0, |n, error| {
            [("e", if n == 8 { f64::NAN } else { error })]
        });
        assert_eq!(
            (nan.verdict, nan.rates[0].rate.code),
            (Verdict::Fail, Reason::NonFiniteError)
        );
        let lacks = |n, error| {
            if n == 8 {
                vec![("e", error)]
            } else {
                vec![("e", error), ("f", 1.0)]
            }
        };
        let lacking = outcome(2.0, lacks);
        assert_eq!(lacking.verdict, Verdict::Fail);
        assert!(
            lacking.checks[0]
                .evidence
                .to_string()
                .contains("cells = 8: the error `f`"),
            "{:?}",
            lacking.checks
        );
        assert_eq!(
            outcome(2.0, |_, error| [("another", error)]).verdict,
            Verdict::Fail
        );
    }

    #[test]
    fn a_name_that_is_given_twice_does_not_pass() {
        let twice = |n: usize| [("e", (n as f64).powi(-2)), ("e", 1.0 / n as f64)];
        let found = judged(&levels(COUNTS, twice).claim("e", 2.0));
        assert_eq!(found.verdict, Verdict::Fail);
        let evidence = found.checks[0].evidence.to_string();
        assert!(evidence.contains("found `e` twice"), "{evidence}");
        let solve = |n: usize| [("e", (n as f64).powi(-2))];
        let found = judged(&levels(COUNTS, solve).claim("e", 2.0).claim("e", 1.0));
        assert_eq!(found.verdict, Verdict::Fail);
    }

    #[test]
    fn levels_come_in_any_order_and_each_once() {
        let solve = |n: usize| [("e", (n as f64).powi(-2))];
        let found = judged(&levels([16, 4, 64, 8, 32], solve).claim("e", 2.0));
        assert_eq!(found.verdict, Verdict::Pass);
        assert_eq!(found.levels[0].parameters, [NamedNumber::new("n", 4.0)]);
        let found = judged(&levels([16, 4, 16, 64, 8], solve).claim("e", 2.0));
        assert_eq!(found.rates[0].rate.code, Reason::StepsNotDecreasing);
        assert_ne!(found.verdict, Verdict::Pass);
    }

    #[test]
    fn a_study_that_claims_nothing_does_not_pass() {
        assert_eq!(
            judged(&levels(COUNTS, |_| [("e", 1.0)])).verdict,
            Verdict::Inconclusive
        );
    }
}
