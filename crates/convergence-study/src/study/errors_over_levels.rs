//! A ready-made kind of study: errors over levels of refinement, computed by a function.

use super::axis::Axis;
use super::case::{Case, CaseFailure, Ran};
use super::header::Header;
use super::kind::Kind;
use super::levels::{self, Claim, ErrorColumn, Levels, Refinement};
use super::outcome::{Check, Outcome};
use crate::judge::verdict::Verdict;

/// Errors by name, as one level has them.
pub type NamedErrors = Vec<(&'static str, f64)>;

/// A study that computes errors on every level of refinement and judges each against its claimed order.
///
/// Its outcome holds a rate with its verdict for each claim, all errors, a figure, and the numbers that the baseline guards.
/// Errors of which nothing is claimed are recorded only. A level that fails, or lacks an error that others have, fails the
/// study.
///
/// ```
/// use convergence_study::judge::verdict::Verdict;
/// use convergence_study::study::{Axis, ErrorsOverLevels, Header, Refinement, run_here};
///
/// // The midpoint rule for the integral of exp over (0, 1).
/// let error = |n: usize| {
///     let h = 1.0 / n as f64;
///     let sum: f64 = (0..n).map(|i| h * ((i as f64 + 0.5) * h).exp()).sum();
///     (sum - 1f64.exp_m1()).abs()
/// };
/// let header = Header::new("midpoint-rule", "the midpoint rule is of second order");
/// let levels = Refinement::counted("cells", [4, 8, 16, 32, 64], |n| 1.0 / n as f64);
/// let study = ErrorsOverLevels::new(header, Axis::Space, levels, |&n| Ok(vec![("integral", error(n))]));
/// assert_eq!(run_here(&study.claiming("integral", 2.0, 0.05)).verdict, Verdict::Pass);
/// ```
#[derive(Debug, Clone)]
pub struct ErrorsOverLevels<D, E> {
    header: Header,
    axis: Axis,
    levels: Vec<(Refinement, D)>,
    claims: Vec<(&'static str, Claim)>,
    errors: E,
}

impl<D, E> ErrorsOverLevels<D, E>
where
    D: Clone + Send + Sync,
    E: Fn(&D) -> Result<NamedErrors, CaseFailure> + Send + Sync,
{
    /// * `axis`: what is refined; it names the step in figures.
    /// * `levels`: coarse to fine, each with what `errors` needs to know; see [`Refinement::counted`].
    /// * `errors`: computes the errors of one level, each under its name; the same names on every level.
    pub fn new(header: Header, axis: Axis, levels: impl IntoIterator<Item = (Refinement, D)>, errors: E) -> Self {
        Self { header, axis, levels: levels.into_iter().collect(), claims: vec![], errors }
    }

    /// The same study with a claim: the error of this name falls like `step^order`.
    ///
    /// * `tolerance`: how far the rate may be from the order, above or below; 0 < tolerance < 0.5.
    pub fn claiming(mut self, error: &'static str, order: f64, tolerance: f64) -> Self {
        self.claims.push((error, Claim::new(order, tolerance)));
        self
    }

    #[cfg(feature = "reports")]
    fn figure(&self, levels: &Levels, rates: &levels::Rates) -> super::outcome::Figure {
        let file = format!("{}-errors.svg", self.header.id);
        let caption = "Errors over levels of refinement.".to_owned();
        levels.figure(file, None, caption, rates)
    }

    fn levels(&self, ran: &[Ran<D, NamedErrors>]) -> Levels {
        let found: Vec<_> = ran.iter().map(|ran| ran.ok().map(Vec::as_slice)).collect();
        Levels {
            axis: self.axis,
            refinements: self.levels.iter().map(|(refinement, _)| refinement.clone()).collect(),
            columns: ErrorColumn::of(&self.claims, &found),
        }
    }
}

/// The error of that name; NaN where there is none.
fn named(errors: &NamedErrors, name: &str) -> f64 {
    errors.iter().find(|(known, _)| *known == name).map_or(f64::NAN, |(_, error)| *error)
}

impl<D, E> Kind for ErrorsOverLevels<D, E>
where
    D: Clone + Send + Sync,
    E: Fn(&D) -> Result<NamedErrors, CaseFailure> + Send + Sync,
{
    type Data = D;
    type Found = NamedErrors;

    fn header(&self) -> &Header {
        &self.header
    }

    /// A finer level is taken to cost more: in inverse proportion to its step.
    fn cases(&self) -> Vec<Case<D>> {
        let case = |(refinement, data): &(Refinement, D)| Case {
            label: refinement.label.clone(),
            cost: 1.0 / refinement.step,
            data: data.clone(),
        };
        self.levels.iter().map(case).collect()
    }

    fn run(&self, data: &D) -> Result<NamedErrors, CaseFailure> {
        (self.errors)(data)
    }

    fn judge(&self, ran: &[Ran<D, NamedErrors>]) -> Outcome {
        let levels = self.levels(ran);
        let rates = levels.judge();
        let names: Vec<&str> = levels.columns.iter().map(|column| column.name.as_str()).collect();
        let not_finite = |errors: &NamedErrors| {
            let names = names.iter().filter(|name| !named(errors, name).is_finite());
            names.map(|name| format!("the error `{name}`")).collect()
        };
        let mut checks = vec![levels::completion(ran, not_finite)];
        if self.claims.is_empty() {
            let (claim, evidence) = ("an order is claimed".to_owned(), "no order of any error is claimed".to_owned());
            checks.push(Check { claim, verdict: Verdict::Inconclusive, evidence });
        }
        Outcome {
            levels: levels.errors(),
            #[cfg(feature = "reports")]
            figures: vec![self.figure(&levels, &rates)],
            quantities: levels.quantities(&rates),
            ..Outcome::new(levels::summary(&rates), rates, checks)
        }
    }

    fn details(&self) -> Vec<(String, String)> {
        let labels: Vec<&str> = self.levels.iter().map(|(refinement, _)| refinement.label.as_str()).collect();
        let order = |(name, Claim { order, tolerance, .. }): &(&str, Claim)| format!("{name} {order} ± {tolerance}");
        let orders: Vec<String> = self.claims.iter().map(order).collect();
        vec![("orders claimed".to_owned(), orders.join(", ")), ("levels".to_owned(), labels.join(", "))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::verdict::Reason;
    use crate::study::run_here;

    const COUNTS: [usize; 5] = [4, 8, 16, 32, 64];

    /// The outcome for an error of second order, claimed to be of this order, changed by `change`.
    fn outcome(order: f64, change: impl Fn(usize, f64) -> Result<NamedErrors, CaseFailure> + Send + Sync) -> Outcome {
        let levels = Refinement::counted("cells", COUNTS, |n| 1.0 / n as f64);
        let errors = |&n: &usize| change(n, (n as f64).powi(-2));
        run_here(&ErrorsOverLevels::new(Header::new("id", "c"), Axis::Space, levels, errors).claiming("e", order, 0.05))
    }

    #[test]
    fn a_right_claim_passes_and_a_wrong_one_fails() {
        let of = |order| outcome(order, |_, error| Ok(vec![("e", error), ("f", 1.0)]));
        assert_eq!((of(2.0).verdict, of(1.0).verdict), (Verdict::Pass, Verdict::Fail));
        let right = of(2.0);
        assert_eq!(right.levels.len(), COUNTS.len());
        assert_eq!(right.levels[2].parameters, [("cells".to_owned(), 16.0)]);
        assert_eq!(right.levels[2].errors, [("e".to_owned(), 1.0 / 256.0), ("f".to_owned(), 1.0)]);
        // A rate, and two errors on five levels.
        assert_eq!(right.quantities.len(), 1 + 2 * 5);
        assert_eq!(right.quantities[1].name, "error e, cells = 4");
        let drawn: Vec<&str> = right.figures.iter().map(|figure| figure.file.as_str()).collect();
        assert_eq!(drawn, ["id-errors.svg"][..usize::from(cfg!(feature = "reports"))]);
    }

    #[test]
    fn a_level_that_fails_or_lacks_an_error_fails_the_study() {
        let failure = || Err(CaseFailure { reason: "diverged".to_owned() });
        let failed = outcome(2.0, |n, error| if n == 8 { failure() } else { Ok(vec![("e", error)]) });
        assert_eq!(failed.verdict, Verdict::Fail);
        assert!(failed.checks[0].evidence.contains("cells = 8: diverged"), "{:?}", failed.checks);
        let told =
            "e 2.0000 (order 2): 1 of 5 levels has no result: cells = 8; 2.0000 ± 0.00005 from levels 1 to 5 of 5";
        assert!(failed.summary.starts_with(told), "{}", failed.summary);
        let rate = &failed.rates[0].1;
        assert_eq!((rate.kind, rate.set_aside.len(), rate.set_aside[0].level), (Reason::NoResult, 1, 1));
        assert!(
            rate.pairwise[..2].iter().all(|rate| rate.is_nan())
                && rate.pairwise[2..].iter().all(|r| (r - 2.0).abs() < 1e-9)
        );
        // An error that was computed and is NaN is another thing.
        let nan = outcome(2.0, |n, error| Ok(vec![("e", if n == 8 { f64::NAN } else { error })]));
        assert_eq!((nan.verdict, nan.rates[0].1.kind), (Verdict::Fail, Reason::NonFiniteError));
        let lacks = |n, error| Ok(if n == 8 { vec![("e", error)] } else { vec![("e", error), ("f", 1.0)] });
        let lacking = outcome(2.0, lacks);
        assert_eq!(lacking.verdict, Verdict::Fail);
        assert!(lacking.checks[0].evidence.contains("cells = 8: the error `f`"), "{:?}", lacking.checks);
        assert_eq!(outcome(2.0, |_, error| Ok(vec![("another", error)])).verdict, Verdict::Fail);
    }

    #[test]
    fn a_study_that_claims_nothing_does_not_pass() {
        let levels = Refinement::counted("cells", COUNTS, |n| 1.0 / n as f64);
        let study = ErrorsOverLevels::new(Header::new("id", "c"), Axis::Space, levels, |_| Ok(vec![("e", 1.0)]));
        assert_eq!(run_here(&study).verdict, Verdict::Inconclusive);
    }
}
