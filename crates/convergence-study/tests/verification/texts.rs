//! The wording of findings decides nothing: verdicts, order, diagnosis and comparison are those of
//! the data next to it.

use convergence_study::{
    Check, Finished, NamedRate, Outcome, Reason, Subject, Verdict,
    internal::{
        run::not_passed,
        store::{
            Baseline, GuardedChange,
            diagnosis::{Diagnosis, diagnose},
        },
        study::outcome::settle,
    },
};

use super::fake::{Does, PROJECT, finished, study};

/// Replaces each text by a word that occurs nowhere else.
struct Words(usize);

impl Words {
    fn replace(&mut self, text: &mut String) {
        self.0 += 1;
        *text = format!("word{}", self.0);
    }

    fn replace_all(&mut self, outcome: &mut Outcome) {
        self.replace(&mut outcome.summary);
        self.replace(&mut outcome.headline);
        if let Some(more) = &mut outcome.after_rates {
            self.replace(more);
        }
        for NamedRate { rate, .. } in &mut outcome.rates {
            self.replace(&mut rate.because);
            self.replace(&mut rate.reason);
        }
        for check in &mut outcome.checks {
            self.replace(&mut check.claim);
            self.replace(&mut check.evidence);
        }
    }
}

/// Studies with failing rates, checks and cases, checks of several cases, and a check of other
/// studies.
fn failing() -> Vec<Finished> {
    let mut studies = finished(vec![
        study("a-controls", Does::Converge),
        study("b", Does::Fail),
        study("c", Does::Stay),
        study("d", Does::TooShort),
        study("e", Does::Converge),
    ]);
    for (k, study) in studies.iter_mut().enumerate() {
        let outcome = &mut study.outcome;
        for case in ["one", "two"] {
            let claim = format!("the norm of {case} stays below {k}");
            let subject = Subject::of("norm").in_case(case);
            let check = Check::that(k != 4, claim, "largest 2.0").about(subject);
            outcome.checks.push(check);
        }
        outcome
            .quantities
            .iter_mut()
            .for_each(|quantity| quantity.value *= 1.5);
    }
    let controls = &mut studies[0].outcome;
    let others = Check::that(false, "every study passes", "not c");
    controls.checks.push(Check {
        other_studies: vec!["c".to_owned()],
        ..others.about(Subject::of("no fault"))
    });
    let rate = &mut studies[4].outcome.rates[0].rate;
    *rate = rate.clone().with_reason(Reason::TooLow, "too low");
    let settled = |study: Finished| Finished {
        outcome: settle(&study.header.id, study.outcome),
        ..study
    };
    studies.into_iter().map(settled).collect()
}

/// What is concluded from a run.
#[derive(Debug, PartialEq)]
struct Conclusions {
    verdicts: Vec<Verdict>,
    order: Vec<(String, Verdict)>,
    changes: Vec<GuardedChange>,
    diagnosis: Diagnosis,
}

fn conclusions(studies: &[Finished], baseline: &Baseline) -> Conclusions {
    let changes = baseline.compare(studies, None);
    let verdict = |study: &Finished| settle("id", study.outcome.clone()).verdict;
    let diagnosis = diagnose(&PROJECT, &[], studies, &changes);
    Conclusions {
        verdicts: studies.iter().map(verdict).collect(),
        order: not_passed(studies)
            .into_iter()
            .map(|study| (study.id().to_owned(), study.verdict()))
            .collect(),
        changes,
        diagnosis: diagnosis.expect("a run that fails"),
    }
}

#[test]
fn random_words_in_place_of_all_texts_change_no_conclusion() {
    let passing = ["a-controls", "b", "c", "d", "e"].map(|id| study(id, Does::Converge));
    let mut baseline = Baseline::default();
    baseline
        .bless(&finished(passing.into()), None, None)
        .unwrap();
    let studies = failing();
    let mut reworded = studies.clone();
    let mut words = Words(0);
    for study in &mut reworded {
        words.replace_all(&mut study.outcome);
    }
    assert!(words.0 > 40, "{}", words.0);
    let mut before = conclusions(&studies, &baseline);
    let mut after = conclusions(&reworded, &baseline);
    let (last, _) = before.order.last().unwrap();
    assert_eq!(last, "a-controls", "it fails for another's sake");
    assert!(!before.changes.is_empty());
    // The diagnosis quotes the claims; their number and order are conclusions.
    let mut quoted = [&mut before, &mut after].map(|of| {
        let counts: Vec<usize> = of
            .diagnosis
            .checks
            .iter()
            .map(|(_, count)| *count)
            .collect();
        of.diagnosis.checks.clear();
        counts
    });
    assert_eq!(quoted[0], quoted[1]);
    quoted[0].retain(|count| *count > 1);
    assert!(!quoted[0].is_empty(), "no two checks of one quantity");
    assert_eq!(before, after);
}
