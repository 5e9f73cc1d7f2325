//! A ready-made kind of study: errors over levels of refinement, computed by a function; by a seed,
//! too, if samples make a level.

use std::collections::BTreeSet;

use super::header::Header;
use super::kind::{Case, CaseFailure, Kind, Ran};
use super::outcome::{Check, Outcome};
use super::over_levels::{Claim, ErrorColumn, Levels, RefinedIn, Refinement};
use super::sampled::{Sampled, SampledLevel};
use super::subject::Subject;
use crate::text::named::NamedNumber;
use convergence_judge::claims::Bound;
use convergence_judge::verdict::{FEWEST_NUMBERS, Floor, Of, Verdict};

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
/// order; made by [`levels()`](levels()) or [`levels_of_samples`].
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
    counts: Vec<usize>,
    claims: Vec<(String, Claim)>,
    /// How many samples make a level; `None` if a level is no matter of chance.
    samples: Option<usize>,
    /// How samples make the errors of a name.
    of: Vec<(String, Of)>,
    floor: Floor,
    solve: F,
}

/// A case that was run: its count and its seed, which is 0 where samples make no level.
type CaseRun = Ran<(usize, usize), Vec<NamedNumber>>;

/// A level: its count, and its errors.
type LevelRun = Ran<usize, Vec<NamedNumber>>;

/// A study of the errors that a function computes on each level of refinement.
///
/// * `counts`: what distinguishes the levels, such as the number of cells in one direction, in any
///   order.
/// * `solve`: the errors at such a count, see [`IntoErrors`]; the same names on every level. The
///   step is 1/count, unless `solve` returns it with the errors under one of the names
///   [`Levels::STEPS`].
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
pub fn levels<R, F>(
    counts: impl IntoIterator<Item = usize>,
    solve: F,
) -> ErrorsOverLevels<impl Fn(usize, usize) -> R + Send + Sync>
where
    R: IntoErrors,
    F: Fn(usize) -> R + Send + Sync,
{
    ErrorsOverLevels::new(counts, None, move |count, _| solve(count))
}

/// A study of errors that scatter, as those of Monte Carlo: each level is made of samples, and its
/// rate is judged by how they scatter.
///
/// * `counts`: as of [`levels()`](levels()); `samples`: how many a level has, at least 10; with
///   `None` a level is what `solve` gives for the seed 0.
/// * `solve`: the errors at a count by a seed, which is 1, 2, 3, ..., the same on all levels. All
///   samples of a level have one step.
///
/// The page "My errors scatter" of the book has an example.
pub fn levels_of_samples<R, F>(
    counts: impl IntoIterator<Item = usize>,
    samples: impl Into<Option<usize>>,
    solve: F,
) -> ErrorsOverLevels<F>
where
    R: IntoErrors,
    F: Fn(usize, usize) -> R + Send + Sync,
{
    ErrorsOverLevels::new(counts, samples.into(), solve)
}

impl<F> ErrorsOverLevels<F> {
    fn new(counts: impl IntoIterator<Item = usize>, samples: Option<usize>, solve: F) -> Self {
        Self {
            header: Header::new("levels", "the errors fall with the orders claimed"),
            axis: RefinedIn::Space,
            counted: "n".to_owned(),
            counts: counts.into_iter().collect(),
            claims: vec![],
            samples,
            of: vec![],
            floor: Floor::default(),
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

    /// The same study, in which samples make the error of this name in this way; without it, a
    /// claimed error is their mean.
    pub fn made_of(mut self, error: impl Into<String>, of: Of) -> Self {
        self.of.push((error.into(), of));
        self
    }

    /// The same study, in which errors up to this one are round-off.
    pub fn with_floor(self, floor: Floor) -> Self {
        Self { floor, ..self }
    }

    /// How samples make the errors of a name.
    fn of(&self, name: &str) -> Option<Of> {
        let mut of = self.of.iter();
        let said = of.find(|(own, _)| own == name).map(|(_, of)| *of);
        let is_claimed = self.claims.iter().any(|(own, _)| own == name);
        said.or(is_claimed.then_some(Of::Mean))
    }

    /// What a level is called.
    fn label(&self, count: usize) -> String {
        format!("{} = {count}", self.counted)
    }

    /// The levels computed so far, coarse to fine.
    pub fn levels(&self, ran: &[CaseRun]) -> Levels {
        self.made(ran).levels(self)
    }

    /// The levels, each with the errors that its function or its samples have given.
    fn made(&self, ran: &[CaseRun]) -> MadeLevels {
        let sampled = self.samples.map(|count| {
            let levels = self.counts.iter().zip(ran.chunks(count.max(1)));
            let levels = levels.map(|(&count, ran)| SampledLevel {
                label: self.label(count),
                samples: ran.iter().map(|ran| ran.found.clone()).collect(),
            });
            Sampled(levels.collect())
        });
        let found = match &sampled {
            Some(sampled) => sampled.errors(&|name| self.of(name)),
            None => ran.iter().map(|ran| ran.found.clone()).collect(),
        };
        let levels = self.counts.iter().zip(found);
        let levels = levels.map(|(&count, found)| Ran {
            case: Case::new(self.label(count), count as f64, count),
            found,
        });
        MadeLevels {
            levels: levels.collect(),
            sampled,
        }
    }

    /// The levels from coarse to fine.
    fn sorted(&self, ran: &[LevelRun]) -> Levels {
        let mut ran: Vec<&LevelRun> = ran.iter().collect();
        let has_steps = ran.iter().any(|ran| reported_step(ran).is_some());
        // If some levels report their step, 1/n cannot stand in for that of the others.
        let step_of = |ran: &LevelRun| match reported_step(ran) {
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
        .with_floor(self.floor)
        .of_answers()
    }

    /// The outcome of levels, and whether all cases and claims are whole.
    fn outcome_of(&self, made: &MadeLevels, ran: &[CaseRun]) -> Outcome {
        let levels = made.levels(self);
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
        checks.extend(made.mixed_steps());
        if self.claims.is_empty() {
            let claim = "an order is claimed".to_owned();
            let evidence = "no order of any error is claimed".to_owned();
            let check = Check::new(Verdict::Inconclusive, claim, evidence);
            checks.push(check.about(Subject::of("claims")));
        }
        if let Some(name) = first_repeated(self.claims.iter().map(|(name, _)| name.as_str())) {
            let claim = "each error is claimed once".to_owned();
            let evidence = format!("`{name}` is claimed twice: only one of the claims is judged");
            checks.push(Check::that(false, claim, evidence).about(Subject::of("claims")));
        }
        levels.outcome("errors", None, "Errors over levels of refinement.", checks)
    }
}

/// The levels of a study, and the samples that they are made of, if there are some.
struct MadeLevels {
    levels: Vec<LevelRun>,
    sampled: Option<Sampled>,
}

impl MadeLevels {
    fn levels<F>(&self, study: &ErrorsOverLevels<F>) -> Levels {
        let levels = study.sorted(&self.levels);
        match &self.sampled {
            Some(sampled) => sampled.judging(levels, &|name| study.of(name)),
            None => levels,
        }
    }

    /// A failing check for each level whose samples have several steps.
    fn mixed_steps(&self) -> Vec<Check> {
        let samples = self.sampled.iter().flat_map(|sampled| &sampled.0);
        let levels = samples.zip(&self.levels);
        let mixed = levels.filter_map(|(level, made)| match (&level.samples, &made.found) {
            (Ok(_), Err(failure)) => Some(format!("{}: {}", level.label, failure.reason)),
            _ => None,
        });
        mixed
            .map(|evidence| Check::that(false, "a level has one step", evidence))
            .collect()
    }
}

pub(super) fn is_step(name: &str) -> bool {
    STEPS.contains(&name)
}

/// The step that a level reports among its errors.
fn reported_step(ran: &LevelRun) -> Option<f64> {
    let step = ran.ok()?.iter().find(|step| is_step(&step.name));
    step.map(|step| step.value)
}

/// The errors of a level; `None` if it failed.
fn without_step(ran: &LevelRun) -> Option<Vec<NamedNumber>> {
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
    F: Fn(usize, usize) -> R + Send + Sync,
{
    /// A count and a seed.
    type Data = (usize, usize);
    type Found = Vec<NamedNumber>;

    /// A finer level is assumed to cost more.
    fn cases(&self) -> Vec<Case<(usize, usize)>> {
        let mut cases = vec![];
        for &count in &self.counts {
            let label = self.label(count);
            let cost = count as f64;
            let Some(samples) = self.samples else {
                cases.push(Case::new(label, cost, (count, 0)));
                continue;
            };
            for seed in Sampled::seeds(samples) {
                let label = format!("{label}, seed = {seed}");
                cases.push(Case::new(label, cost, (count, seed)));
            }
        }
        cases
    }

    fn run(&self, (count, seed): &(usize, usize)) -> Result<Vec<NamedNumber>, CaseFailure> {
        (self.solve)(*count, *seed).into_errors()
    }

    fn judge(&self, ran: &[CaseRun]) -> Outcome {
        if let Some(few) = self.samples.filter(|count| *count < FEWEST_NUMBERS) {
            let claim = "a level has at least ten samples";
            let check = Check::that(false, claim, format!("{few} samples"));
            return Outcome::new("too few samples", vec![], vec![check]);
        }
        let mut outcome = self.outcome_of(&self.made(ran), ran);
        if let Some(count) = self.samples {
            outcome.add_to_summary(&Sampled::words(count));
        }
        outcome
    }
}

#[cfg(test)]
mod tests;
