//! A ready-made kind of study: levels that are made of samples, which a function computes by a seed.

use super::errors_over_levels::{ErrorsOverLevels, IntoErrors};
use super::header::Header;
use super::kind::{Case, CaseFailure, Kind, Ran};
use super::outcome::{Check, Outcome};
use super::over_levels::{Claim, RefinedIn};
use super::sampled::{Sampled, SampledLevel};
use crate::text::named::NamedNumber;
use convergence_judge::claims::Bound;
use convergence_judge::verdict::{FEWEST_NUMBERS, Of};

/// A study of levels of which each is made of samples, by the same seeds on all levels; made by
/// [`levels_of_samples`].
#[derive(Debug, Clone)]
#[must_use = "levels are computed and judged by `run` or `assert_passes`"]
pub struct LevelsOfSamples<F> {
    pub(crate) levels: ErrorsOverLevels<F>,
    samples: usize,
    /// How samples make the errors that are claimed.
    of: Vec<(String, Of)>,
}

/// A study of errors that scatter, as those of Monte Carlo: each level is made of samples, and its
/// rate is judged by how they scatter.
///
/// * `counts`: as of [`levels`](crate::levels()); `samples`: how many a level has, at least 10.
/// * `solve`: the errors at a count by a seed, which is 1, 2, 3, ..., the same on all levels. All
///   samples of a level have one step.
///
/// The page "My errors scatter" of the book has an example.
pub fn levels_of_samples<R, F>(
    counts: impl IntoIterator<Item = usize>,
    samples: usize,
    solve: F,
) -> LevelsOfSamples<F>
where
    R: IntoErrors,
    F: Fn(usize, usize) -> R + Send + Sync,
{
    LevelsOfSamples {
        levels: ErrorsOverLevels::of(counts, solve),
        samples,
        of: vec![],
    }
}

impl<F> LevelsOfSamples<F> {
    /// The same study under a name, with a claim in words.
    pub fn described(self, header: Header) -> Self {
        Self {
            levels: self.levels.described(header),
            ..self
        }
    }

    /// As [`ErrorsOverLevels::counting`].
    pub fn counting(self, counted: impl Into<String>, axis: RefinedIn) -> Self {
        Self {
            levels: self.levels.counting(counted, axis),
            ..self
        }
    }

    /// The same study with a claim: the error of this name, made of its samples in this way, falls
    /// like `step^order`, within the tolerance of [`Claim::usual`].
    pub fn claim(self, error: impl Into<String>, order: f64, of: Of) -> Self {
        self.claiming(error, Claim::usual(order, Bound::Both), of)
    }

    /// The same with any claim.
    pub fn claiming(mut self, error: impl Into<String>, claim: Claim, of: Of) -> Self {
        let error = error.into();
        self.of.push((error.clone(), of));
        self.levels = self.levels.claiming(error, claim);
        self
    }

    fn of(&self, name: &str) -> Option<Of> {
        let mut claimed = self.of.iter();
        claimed
            .find(|claimed| claimed.0 == name)
            .map(|claimed| claimed.1)
    }
}

impl<R, F> Kind for LevelsOfSamples<F>
where
    R: IntoErrors,
    F: Fn(usize, usize) -> R + Send + Sync,
{
    /// A count and a seed.
    type Data = (usize, usize);
    type Found = Vec<NamedNumber>;

    fn cases(&self) -> Vec<Case<(usize, usize)>> {
        let seeds = |&count: &usize| {
            let case = move |seed| {
                let label = format!("{}, seed = {seed}", self.levels.label(count));
                Case::new(label, count as f64, (count, seed))
            };
            Sampled::seeds(self.samples).map(case)
        };
        self.levels.counts.iter().flat_map(seeds).collect()
    }

    fn run(&self, (count, seed): &(usize, usize)) -> Result<Vec<NamedNumber>, CaseFailure> {
        (self.levels.solve)(*count, *seed).into_errors()
    }

    fn judge(&self, ran: &[Ran<(usize, usize), Vec<NamedNumber>>]) -> Outcome {
        if self.samples < FEWEST_NUMBERS {
            let claim = "a level has at least ten samples";
            let check = Check::that(false, claim, format!("{} samples", self.samples));
            return Outcome::new("too few samples", vec![], vec![check]);
        }
        let of = |name: &str| self.of(name);
        let counts = self.levels.counts.iter();
        let levels = counts.zip(ran.chunks(self.samples));
        let levels = levels.map(|(&count, ran)| SampledLevel {
            label: self.levels.label(count),
            samples: ran.iter().map(|ran| ran.found.clone()).collect(),
        });
        let sampled = Sampled(levels.collect());
        let mut levels: Vec<Ran<usize, Vec<NamedNumber>>> = vec![];
        let mut mixed = vec![];
        let made = sampled.0.iter().zip(sampled.errors(&of));
        for (&count, (level, found)) in self.levels.counts.iter().zip(made) {
            let label = level.label.clone();
            if let (Ok(_), Err(failure)) = (&level.samples, &found) {
                let evidence = format!("{label}: {}", failure.reason);
                mixed.push(Check::that(false, "a level has one step", evidence));
            }
            let case = Case::new(label, count as f64, count);
            levels.push(Ran { case, found });
        }
        let judged = sampled.judging(self.levels.levels(&levels), &of);
        let mut outcome = self.levels.outcome_of(&judged, ran);
        if !mixed.is_empty() {
            outcome.extend(Outcome::new("", vec![], mixed));
        }
        outcome.add_to_summary(&Sampled::words(self.samples));
        outcome
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use convergence_judge::random::SplitMix;
    use convergence_judge::verdict::Verdict;

    /// A strong error of order one half, and a signed weak one of order one.
    fn errors(n: usize, seed: usize) -> [(&'static str, f64); 2] {
        let mut random = SplitMix::new((seed * 4096 + n) as u64);
        let h = 1.0 / n as f64;
        let strong = h.sqrt() * (1.0 + 0.3 * random.normal()).abs();
        [
            ("strong", strong),
            ("weak", h * (1.0 + 0.3 * random.normal())),
        ]
    }

    const COUNTS: [usize; 5] = [64, 4, 16, 8, 32];

    #[test]
    fn levels_are_judged_by_the_scatter_of_their_samples() {
        let study = |strong: f64, weak: f64| {
            let study = levels_of_samples(COUNTS, 40, errors);
            let study = study.claim("strong", strong, Of::Mean);
            study.claim("weak", weak, Of::Weak).run().outcome
        };
        let right = study(0.5, 1.0);
        assert!(right.verdict.is_pass(), "{}", right.summary);
        assert!(right.summary.to_string().contains("made of 40 samples"));
        assert_eq!(right.levels.len(), 5);
        assert_eq!(study(1.0, 1.0).verdict, Verdict::Fail);
        assert_eq!(study(0.5, 2.0).verdict, Verdict::Fail);
    }

    #[test]
    fn few_samples_a_failed_one_and_no_claim_do_not_pass() {
        let few = levels_of_samples(COUNTS, 9, errors).claim("weak", 1.0, Of::Weak);
        assert_eq!(few.run().outcome.verdict, Verdict::Fail);
        let failing = |n: usize, seed: usize| {
            if (n, seed) == (16, 7) {
                Err(CaseFailure::new("diverged"))
            } else {
                Ok(errors(n, seed))
            }
        };
        let failed = levels_of_samples(COUNTS, 20, failing).claim("weak", 1.0, Of::Weak);
        let failed = failed.run().outcome;
        assert_eq!(failed.verdict, Verdict::Fail);
        let evidence = failed.checks[0].evidence.to_string();
        assert!(
            evidence.contains("n = 16, seed = 7: diverged"),
            "{evidence}"
        );
        let nothing = levels_of_samples(COUNTS, 20, errors).run().outcome;
        assert_eq!(nothing.verdict, Verdict::Inconclusive);
    }

    /// All levels report their step or none does, and all samples of one level report the same.
    #[test]
    fn levels_whose_samples_do_not_agree_on_their_steps_do_not_pass() {
        let with_steps = |step: fn(usize, usize) -> Option<f64>| {
            let solve = move |n: usize, seed: usize| {
                let [(name, error), _] = errors(n, seed);
                let step = step(n, seed).map(|step| ("h", step));
                step.into_iter().chain([(name, error)]).collect::<Vec<_>>()
            };
            let study = levels_of_samples(COUNTS, 40, solve);
            study.claim("strong", 0.5, Of::Mean).run().outcome
        };
        let right = with_steps(|n, _| Some(2.0 / n as f64));
        assert!(right.verdict.is_pass(), "{}", right.summary);
        assert_eq!(right.levels[0].step, Some(0.5));
        let mixed = with_steps(|n, seed| {
            Some(if (n, seed) == (8, 3) {
                0.3
            } else {
                1.0 / n as f64
            })
        });
        assert_eq!(mixed.verdict, Verdict::Fail);
        let evidence: Vec<String> = mixed
            .checks
            .iter()
            .map(|check| check.evidence.to_string())
            .collect();
        assert!(
            evidence
                .iter()
                .any(|one| one.contains("n = 8: expected one step")),
            "{evidence:?}"
        );
        let some = with_steps(|n, _| (n != 8).then_some(1.0 / n as f64));
        assert!(!some.verdict.is_pass(), "{}", some.summary);
        // 1/n as the order of levels would be wrong.
        let reversed = with_steps(|n, _| Some(n as f64 / 64.0));
        assert_eq!(reversed.verdict, Verdict::Fail, "{}", reversed.summary);
    }

    #[test]
    fn a_nan_of_one_sample_fails() {
        let broken = |n: usize, seed: usize| if seed == 3 { f64::NAN } else { 1.0 / n as f64 };
        let study = levels_of_samples(COUNTS, 20, broken).claim("error", 1.0, Of::Mean);
        assert_eq!(study.run().outcome.verdict, Verdict::Fail);
    }
}
