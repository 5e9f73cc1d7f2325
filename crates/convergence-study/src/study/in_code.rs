//! A study in code: a [`Kind`] that no file describes.

use super::erased::{Described, Plan};
use super::header::{Header, Tier};
use super::kind::Kind;
use super::measured::Sheet;
use super::outcome::Outcome;
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
    /// Where it is: `file!()`.
    pub home: &'static str,
}

/// The word in place of the kind of a study's file.
const CODE: &str = "code";

impl About {
    /// The study of these cases.
    pub fn study<K: Kind>(self, kind: K) -> Described<K> {
        let header = Header {
            tier: self.tier,
            kind: CODE.to_owned(),
            group: self.group.to_owned(),
            home: Some(self.home),
            ..Header::new(self.id, self.claim)
        };
        Described { header, kind }
    }
}

/// What [`Study::unnoticed`](super::Study::unnoticed) says of the cases of a study.
pub(super) fn unnoticed(plan: &dyn Plan) -> Vec<String> {
    (0..plan.cases().len()).for_each(|run| plan.run(run));
    while let Some(run) = plan.more() {
        plan.run(run);
    }
    let sound = plan.judge();
    let mut list = vec![];
    let claims_nothing = sound.sheets.is_empty() && sound.rates.is_empty();
    if sound.verdict != Verdict::Pass || claims_nothing {
        list.push(format!("it does not pass: {}", sound.summary));
    }
    for (index, case) in plan.cases().iter().enumerate() {
        if plan.judge_without(index).verdict != Verdict::Fail {
            list.push(format!("{} without a result", case.label));
        }
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
            Outcome::of_sheets(sheets, "")
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
    use crate::study::{Case, CaseFailure, Ran, Study};

    /// Sums of 1 + 1/2 + 1/4 + ...
    struct Series {
        claim: Option<Must>,
        /// Whether nothing is judged unless every sum is there.
        is_judged_whole: bool,
    }

    impl Series {
        fn claiming(claim: Option<Must>) -> Self {
            let is_judged_whole = true;
            Self {
                claim,
                is_judged_whole,
            }
        }

        fn outcome(&self, shown: &[(&i32, &f64)]) -> Outcome {
            let sums = shown.iter().map(|(n, sum)| {
                measured(format!("n = {n}"), "sum", **sum)
                    .recorded("sum", 1e-12)
                    .must_be(self.claim)
            });
            Outcome::of_sheets([Sheet::new("Sums", "terms", sums)], "sum")
        }
    }

    impl Kind for Series {
        type Data = i32;
        type Found = f64;

        fn cases(&self) -> Vec<Case<i32>> {
            [10, 20]
                .map(|n| Case::new(format!("n = {n}"), 1.0, n))
                .to_vec()
        }

        fn run(&self, n: &i32) -> Result<f64, CaseFailure> {
            Ok((0..*n).map(|k| 0.5_f64.powi(k)).sum())
        }

        fn judge(&self, ran: &[Ran<i32, f64>]) -> Outcome {
            if self.is_judged_whole {
                return Outcome::of_complete(self, ran, |shown| self.outcome(shown));
            }
            let shown = ran.iter();
            let shown = shown.filter_map(|ran| Some((&ran.case.data, ran.ok()?)));
            self.outcome(&shown.collect::<Vec<_>>())
        }
    }

    const ABOUT: About = About {
        id: "series",
        claim: "the series tends to 2",
        tier: Tier::Quick,
        group: "series",
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
            let study = ABOUT.study(Series::claiming(Some(claim)));
            assert_eq!(study.unnoticed(), Vec::<String>::new(), "{claim}");
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
            let study = ABOUT.study(Series::claiming(claim));
            assert!(study.unnoticed()[0].contains("does not pass"), "{claim:?}");
        }
    }

    #[test]
    fn a_study_that_passes_without_a_run_is_noticed() {
        let careless = ABOUT.study(Series {
            claim: Some(Must::AtMost(2.0)),
            is_judged_whole: false,
        });
        let expected = ["n = 10 without a result", "n = 20 without a result"];
        assert_eq!(careless.unnoticed(), expected);
    }
}
