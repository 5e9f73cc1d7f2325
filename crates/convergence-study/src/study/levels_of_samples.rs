//! A ready-made kind of study: levels that are made of samples, which a function computes by a seed.

use super::errors_over_levels::{IntoErrors, STEPS};
use super::header::Header;
use super::kind::{Case, CaseFailure, Kind, Ran, completion_check};
use super::outcome::{Check, Outcome};
use super::over_levels::{Axis, Claim, ErrorColumn, Levels, Refinement};
use super::sampled::Sampled;
use super::subject::Subject;
use crate::judge::claims::Bound;
use crate::judge::verdict::{Of, Verdict};
use crate::text::named::NamedNumber;

/// A study of levels of which each is made of samples, by the same seeds on all levels; made by
/// [`levels_of_samples`].
#[derive(Debug, Clone)]
#[must_use = "levels are computed and judged by `run` or `assert_passes`"]
pub struct LevelsOfSamples<F> {
    pub(crate) header: Header,
    counts: Vec<usize>,
    samples: usize,
    claims: Vec<(String, Claim, Of)>,
    solve: F,
}

/// A study of errors that scatter, as those of Monte Carlo: each level is made of samples, and its
/// rate is judged by how they scatter.
///
/// * `counts`: as of [`levels`](crate::levels()); `samples`: how many a level has, at least 10.
/// * `solve`: the errors at a count by a seed, which is 1, 2, 3, ..., the same on all levels.
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
    let mut counts: Vec<usize> = counts.into_iter().collect();
    counts.sort_unstable();
    LevelsOfSamples {
        header: Header::new("levels", "the errors fall with the orders claimed"),
        counts,
        samples,
        claims: vec![],
        solve,
    }
}

impl<F> LevelsOfSamples<F> {
    /// The same study under a name, with a claim in words.
    pub fn described(self, header: Header) -> Self {
        Self { header, ..self }
    }

    /// The same study with a claim: the error of this name, made of its samples in this way, falls
    /// like `step^order`, within the tolerance of [`Claim::usual`].
    pub fn claim(self, error: impl Into<String>, order: f64, of: Of) -> Self {
        self.claiming(error, Claim::usual(order, Bound::Both), of)
    }

    /// The same with any claim.
    pub fn claiming(mut self, error: impl Into<String>, claim: Claim, of: Of) -> Self {
        self.claims.push((error.into(), claim, of));
        self
    }

    fn of(&self, name: &str) -> Option<Of> {
        let mut claims = self.claims.iter();
        claims.find(|claim| claim.0 == name).map(|claim| claim.2)
    }

    /// The levels that have all samples, with these.
    fn levels(&self, ran: &[Ran<(usize, usize), Vec<NamedNumber>>]) -> Levels {
        let whole = |level: &[Ran<(usize, usize), Vec<NamedNumber>>]| {
            let samples = level.iter().map(|ran| ran.ok().cloned());
            samples.collect::<Option<Vec<_>>>()
        };
        let found: Vec<_> = ran.chunks(self.samples).map(whole).collect();
        let sampled = Sampled(found.iter().flatten().cloned().collect());
        let of = |name: &str| self.of(name);
        let mut made = sampled.errors(&of).into_iter();
        let errors = found
            .iter()
            .map(|level| level.as_ref().and_then(|_| made.next()));
        let errors: Vec<Option<Vec<NamedNumber>>> = errors.collect();
        let refinements = self.counts.iter().zip(&errors).map(|(count, errors)| {
            let own = errors
                .iter()
                .flatten()
                .find(|one| STEPS.contains(&&*one.name));
            let step = own.map_or(1.0 / *count as f64, |step| step.value);
            Refinement::new(format!("n = {count}"), &[("n", *count)], step)
        });
        let without_step = |errors: &Option<Vec<NamedNumber>>| {
            let errors = errors.iter().flatten().cloned();
            let errors = errors.filter(|one| !STEPS.contains(&&*one.name));
            errors.collect::<Vec<_>>()
        };
        let kept: Vec<Vec<NamedNumber>> = errors.iter().map(without_step).collect();
        let kept = errors.iter().zip(&kept);
        let kept: Vec<_> = kept
            .map(|(level, kept)| level.as_ref().map(|_| &kept[..]))
            .collect();
        let claims: Vec<(&String, Claim)> = self
            .claims
            .iter()
            .map(|(name, claim, _)| (name, *claim))
            .collect();
        let levels = Levels::new(Axis::Space, refinements, ErrorColumn::of(&claims, &kept));
        sampled.judging(levels.of_answers(), &of)
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
                Case::new(
                    format!("n = {count}, seed = {seed}"),
                    count as f64,
                    (count, seed),
                )
            };
            Sampled::seeds(self.samples).map(case)
        };
        self.counts.iter().flat_map(seeds).collect()
    }

    fn run(&self, (count, seed): &(usize, usize)) -> Result<Vec<NamedNumber>, CaseFailure> {
        (self.solve)(*count, *seed).into_errors()
    }

    fn judge(&self, ran: &[Ran<(usize, usize), Vec<NamedNumber>>]) -> Outcome {
        let mut checks = vec![completion_check(ran, |_| vec![])];
        if self.samples < crate::judge::verdict::FEWEST_NUMBERS {
            let claim = "a level has at least ten samples";
            let check = Check::that(false, claim, format!("{} samples", self.samples));
            return Outcome::new("too few samples", vec![], vec![check]);
        }
        if self.claims.is_empty() {
            let evidence = "no order of any error is claimed";
            checks.push(Check {
                verdict: Verdict::Inconclusive,
                ..Check::that(false, "an order is claimed", evidence).about(Subject::of("claims"))
            });
        }
        let levels = self.levels(ran);
        let caption = "Errors over levels of refinement.";
        let mut outcome = levels.outcome("errors", None, caption, checks);
        outcome.add_to_summary(&Sampled::words(self.samples));
        outcome
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::random::SplitMix;

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

    #[test]
    fn a_nan_of_one_sample_fails() {
        let broken = |n: usize, seed: usize| if seed == 3 { f64::NAN } else { 1.0 / n as f64 };
        let study = levels_of_samples(COUNTS, 20, broken).claim("error", 1.0, Of::Mean);
        assert_eq!(study.run().outcome.verdict, Verdict::Fail);
    }
}
