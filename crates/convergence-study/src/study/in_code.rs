//! A study in code: a list of runs, and the numbers that they show.

use super::erased::{Described, Study};
use super::header::{Header, Tier};
use super::kind::{Case, CaseFailure, Kind, Ran};
use super::measured::Sheet;
use super::outcome::{Check, Figure, LevelErrors, NamedRate, Outcome, Quantity};
use super::over_levels::Levels;
use convergence_judge::verdict::Verdict;

/// What a study in code says about itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct About {
    /// The study's name: small letters, digits, `.` and `-`.
    pub id: &'static str,
    /// The claim, in one line.
    pub claim: &'static str,
    /// When it is run.
    pub tier: Tier,
    /// The group under which reports list it.
    pub group: &'static str,
    /// The name of the numbers to read first.
    pub headline: &'static str,
    /// Where it is: `file!()`.
    pub home: &'static str,
}

/// A list of runs, and the numbers that they show. Its value is the setting of the study, which a
/// test may change.
pub trait Runs: Send + Sync {
    /// What distinguishes a run from the others.
    type Run: Clone + Send + Sync;
    /// What a run shows.
    type Shown: Send;

    /// The runs, in the order in which they are judged.
    fn runs(&self) -> Vec<Case<Self::Run>>;

    /// One run: the same result on every thread, at every time.
    ///
    /// # Errors
    /// Why there is no result, with step, time and numbers.
    fn run(&self, run: &Self::Run) -> Result<Self::Shown, CaseFailure>;

    /// The numbers, and what else the runs show; asked only if every run has a result.
    ///
    /// * `shown`: in the order of the runs.
    fn judge(&self, shown: &[(&Self::Run, &Self::Shown)]) -> Findings;
}

/// What the runs of a study show.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Findings {
    /// Its numbers.
    pub sheets: Vec<Sheet>,
    /// The numbers to read first, where the numbers of one name do not sum up the study.
    pub headline: Option<String>,
    /// Figures.
    pub figures: Vec<Figure>,
    /// Judged rates.
    pub rates: Vec<NamedRate>,
    /// The errors of these rates.
    pub levels: Vec<LevelErrors>,
    /// What the baseline guards of errors and rates.
    pub quantities: Vec<Quantity>,
    /// Of items other than runs: how many were judged, and why not the others, by
    /// [`left_out`](crate::left_out).
    pub left_out: Vec<String>,
}

impl Findings {
    /// The same with the rates of these errors: guarded, like the errors themselves.
    #[must_use]
    pub fn with_orders(mut self, levels: &Levels, rates: Vec<NamedRate>) -> Self {
        self.quantities.extend(levels.quantities(&rates));
        Self {
            levels: levels.errors(),
            rates,
            ..self
        }
    }
}

impl From<Sheet> for Findings {
    fn from(sheet: Sheet) -> Self {
        Self {
            sheets: vec![sheet],
            ..Self::default()
        }
    }
}

/// A study of these runs.
#[derive(Debug, Clone, PartialEq)]
pub struct InCode<R> {
    /// What it says about itself.
    pub about: About,
    /// Its runs.
    pub runs: R,
}

/// A study in code, as a project lists it.
#[derive(Debug, Clone, Copy)]
pub struct CodeStudy {
    /// Where it is.
    pub home: &'static str,
    /// How it is made.
    pub study: fn() -> Box<dyn Study>,
}

/// The word in place of the kind of a study's file.
const CODE: &str = "code";

impl About {
    /// The study of these runs.
    pub fn study<R: Runs>(self, runs: R) -> Described<InCode<R>> {
        let header = Header {
            tier: self.tier,
            kind: CODE.to_owned(),
            group: self.group.to_owned(),
            ..Header::new(self.id, self.claim)
        };
        let kind = InCode { about: self, runs };
        Described { header, kind }
    }
}

impl<R: Runs> Kind for InCode<R> {
    type Data = R::Run;
    type Found = R::Shown;

    fn cases(&self) -> Vec<Case<R::Run>> {
        self.runs.runs()
    }

    fn run(&self, run: &R::Run) -> Result<R::Shown, CaseFailure> {
        self.runs.run(run)
    }

    fn judge(&self, ran: &[Ran<R::Run, R::Shown>]) -> Outcome {
        let completion = Check::completion(ran, |_| vec![]);
        let shown = ran
            .iter()
            .filter_map(|ran| Some((&ran.case.data, ran.ok()?)));
        let shown: Vec<_> = shown.collect();
        let all = self.runs.runs().len();
        if shown.len() < all {
            let have = shown.len();
            let words = format!("{have} of {all} runs have a result, so nothing else is judged");
            // A run that was not made fails as one without a result does.
            let verdict = Verdict::Fail;
            let completion = Check {
                verdict,
                ..completion
            };
            return Outcome::new(words, vec![], vec![completion]);
        }
        let Findings {
            sheets,
            headline,
            figures,
            rates,
            levels,
            quantities,
            left_out,
        } = self.runs.judge(&shown);
        let mut outcome = Outcome::of_sheets(completion, sheets, self.about.headline);
        if let Some(headline) = headline {
            outcome.summary = headline.as_str().into();
            outcome.headline = headline.into();
        }
        let verdicts = rates.iter().map(|rate| rate.rate.verdict);
        outcome.verdict = Verdict::worst([outcome.verdict].into_iter().chain(verdicts));
        outcome.quantities.extend(quantities);
        let outcome = Outcome {
            figures,
            rates,
            levels,
            left_out,
            ..outcome
        };
        if outcome.headline.is_empty() {
            return outcome.summed_up_by_rates("");
        }
        outcome
    }
}

/// What a passing study in code does not notice: each of its claims with a number just past it,
/// NaN, or without a number; each guarded number that moves by twice its tolerance. Empty for a
/// sound study. A run without a result fails every study.
pub fn unnoticed(study: &dyn Study) -> Vec<String> {
    let plan = study.plan();
    (0..plan.cases().len()).for_each(|run| plan.run(run));
    let sound = plan.judge();
    let mut list = vec![];
    if sound.verdict != Verdict::Pass || sound.sheets.is_empty() {
        list.push(format!("it does not pass: {}", sound.summary));
    }
    list.extend(unnoticed_numbers(&sound));
    list
}

/// The numbers of an outcome that may change without a change of its verdict or of what the
/// baseline guards.
fn unnoticed_numbers(sound: &Outcome) -> Vec<String> {
    let mut list = vec![];
    let numbers = |(k, sheet): (usize, &Sheet)| (0..sheet.measured.len()).map(move |j| (k, j));
    for (sheet, number) in sound.sheets.iter().enumerate().flat_map(numbers) {
        let one = &sound.sheets[sheet].measured[number];
        let with = |value: Option<f64>| {
            let mut sheets = sound.sheets.clone();
            sheets[sheet].measured[number].value = value;
            Outcome::of_sheets(sound.checks[0].clone(), sheets, "")
        };
        let name = one.in_case(&one.name);
        if let Some(claim) = one.claim {
            for value in [Some(claim.past()), Some(f64::NAN), None] {
                if with(value).verdict != Verdict::Fail {
                    list.push(format!("{name} = {value:?}, which must be {claim}"));
                }
            }
        }
        if let (Some(record), Some(value)) = (&one.record, one.value) {
            let moved = value + 2.0 * record.tolerance * value.abs().max(1.0);
            if with(Some(moved)).quantities == with(Some(value)).quantities {
                list.push(format!("{name}: the baseline does not see it move"));
            }
        }
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::measured::measured;
    use crate::study::must::Must;

    /// Sums of 1 + 1/2 + 1/4 + ...
    struct Series(Option<Must>);

    impl Runs for Series {
        type Run = i32;
        type Shown = f64;

        fn runs(&self) -> Vec<Case<i32>> {
            [10, 20]
                .map(|n| Case::new(format!("n = {n}"), 1.0, n))
                .to_vec()
        }

        fn run(&self, n: &i32) -> Result<f64, CaseFailure> {
            Ok((0..*n).map(|k| 0.5_f64.powi(k)).sum())
        }

        fn judge(&self, shown: &[(&i32, &f64)]) -> Findings {
            let sums = shown.iter().map(|(n, sum)| {
                measured(format!("n = {n}"), "sum", **sum)
                    .recorded("sum", 1e-12)
                    .must_be(self.0)
            });
            Sheet::new("Sums", "terms", sums).into()
        }
    }

    const ABOUT: About = About {
        id: "series",
        claim: "the series tends to 2",
        tier: Tier::Quick,
        group: "series",
        headline: "sum",
        home: file!(),
    };

    #[test]
    fn every_claim_is_noticed_and_a_study_without_one_does_not_pass() {
        let near = Must::Near {
            answer: 2.0,
            within: 2e-3,
        };
        for claim in [
            Must::AtMost(2.0),
            Must::AtLeast(1.9),
            Must::Above(1.9),
            near,
        ] {
            let study = ABOUT.study(Series(Some(claim)));
            assert_eq!(unnoticed(&study), Vec::<String>::new(), "{claim}");
            let sound = study.kind.run_here();
            for run in 0..sound.len() {
                let mut failed = sound.clone();
                failed[run].found = Err(CaseFailure::new("dropped"));
                let mut missing = sound.clone();
                missing.remove(run);
                for ran in [failed, missing] {
                    let outcome = study.kind.judge(&ran);
                    assert_eq!((outcome.verdict, outcome.checks.len()), (Verdict::Fail, 1));
                }
            }
        }
        for claim in [
            None,
            Some(Must::AtMost(f64::INFINITY)),
            Some(Must::Count(2)),
        ] {
            let study = ABOUT.study(Series(claim));
            assert!(unnoticed(&study)[0].contains("does not pass"), "{claim:?}");
        }
    }
}
