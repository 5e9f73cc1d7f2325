use std::sync::Mutex;
use std::time::Duration;

use crate::{
    Finished, Header, RunError, Study, Verdict,
    run::{self, Effort},
    store::Works,
};

use super::fake::{Does, finished, jobs, passing, says, study};

/// What cases do, and what is said: the verdict, the number of failed cases, words of the summary.
const ALL: [(Does, Verdict, usize, &str); 8] = [
    (Does::Converge, Verdict::Pass, 0, "the rate agrees"),
    (Does::Stay, Verdict::Fail, 0, "does not fall"),
    (Does::NotANumber, Verdict::Fail, 0, "NaN or infinite"),
    (Does::Fail, Verdict::Fail, 1, "NaN or infinite"),
    (Does::Panic, Verdict::Fail, 1, "NaN or infinite"),
    (
        Does::PanicAtTheEnd,
        Verdict::Fail,
        0,
        "cannot judge its results: panicked at fake.rs",
    ),
    (Does::TooShort, Verdict::Inconclusive, 0, "too few levels"),
    (
        Does::Nothing,
        Verdict::Inconclusive,
        0,
        "nothing was judged",
    ),
];

fn all() -> Vec<Box<dyn Study>> {
    let studies = ALL.iter().enumerate();
    studies
        .map(|(i, (does, ..))| study(&format!("study-{i}"), *does))
        .collect()
}

#[test]
fn every_way_of_not_passing_is_reported_and_stops_no_other_study() {
    for (
        Finished {
            outcome,
            failed_cases,
            ..
        },
        (_, verdict, failed, words),
    ) in finished(all()).iter().zip(ALL)
    {
        assert_eq!(outcome.verdict, verdict, "{outcome:?}");
        assert_eq!(failed_cases.len(), failed, "{failed_cases:?}");
        says(&outcome.summary, words);
    }
}

#[test]
fn a_failed_case_keeps_its_label_and_reason() {
    let finished = finished(vec![
        study("panics", Does::Panic),
        study("fails", Does::Fail),
    ]);
    let [panic, failure] = [0, 1].map(|i| &finished[i].failed_cases[0]);
    assert_eq!(
        (panic.label.as_str(), failure.label.as_str()),
        ("n = 16", "n = 16")
    );
    assert!(
        panic.reason.starts_with("panicked at fake.rs:"),
        "{}",
        panic.reason
    );
    assert!(
        panic.reason.ends_with("a pivot of 0.01875 was lost"),
        "{}",
        panic.reason
    );
    assert_eq!(failure.reason, "step 3 | t = 0.1: diverged");
}

#[test]
fn a_case_stopped_at_its_limit_has_failed_even_if_it_returns_a_result() {
    let effort = Effort {
        time_limit: Some(Duration::from_millis(50)),
        ..jobs(2).into()
    };
    let studies = vec![study("dawdles", Does::Dawdle), passing("converges")];
    let finished = run::run(&studies, effort, &|_| {}).unwrap();
    let [stopped] = &finished[0].failed_cases[..] else {
        panic!("{:?}", finished[0].failed_cases)
    };
    assert!(
        stopped
            .reason
            .starts_with("stopped at the time limit of 0.05 s, after step "),
        "{}",
        stopped.reason
    );
    assert_eq!(
        (finished[0].outcome.verdict, finished[1].outcome.verdict),
        (Verdict::Fail, Verdict::Pass)
    );
}

#[test]
fn a_case_that_works_too_much_fails_at_the_same_step_for_any_number_of_threads() {
    let allowed = |header: &Header, label: &str| {
        (header.id == "dawdles" && label == "n = 16").then_some(1_000_000)
    };
    let run = |count| {
        let studies = vec![study("dawdles", Does::Dawdle), passing("converges")];
        run::run_within(&studies, jobs(count).into(), &allowed, &|_| {}).unwrap()
    };
    let [one, two] = [run(1), run(2)];
    let [stopped] = &one[0].failed_cases[..] else {
        panic!("{:?}", one[0].failed_cases)
    };
    assert!(
        stopped
            .reason
            .starts_with("stopped at the work limit of 1000000 passes over a node, three times"),
        "{}",
        stopped.reason
    );
    assert_eq!(
        (&one[0].failed_cases, &one[0].work),
        (&two[0].failed_cases, &two[0].work)
    );
    assert_eq!(
        (one[0].outcome.verdict, one[1].outcome.verdict),
        (Verdict::Fail, Verdict::Pass)
    );
    // A blessing allows three times as much, and a fiftieth of the total.
    let mut works = Works::default();
    works.take(&one);
    let done = one[0].work.iter().map(|(_, work)| *work).max().unwrap();
    let header = |id: &str| Header::new(id, "c");
    assert_eq!(
        works.allowed(&header("dawdles"), "n = 16"),
        Some(3 * done + done / 50)
    );
    assert_eq!(
        works.allowed(&header("dawdles"), "another"),
        Some(3 * done + done / 50)
    );
    assert_eq!(works.allowed(&header("converges"), "n = 16"), None);
}

#[test]
fn no_case_begins_once_a_study_has_failed_if_so_wished() {
    let studies: Vec<Box<dyn Study>> = (0..50)
        .map(|k| study(&format!("stays-{k}"), Does::Stay))
        .collect();
    let effort = Effort {
        fail_fast: true,
        ..jobs(1).into()
    };
    let finished = run::run(&studies, effort, &|_| {}).unwrap();
    assert!(
        !finished.is_empty() && finished.len() < 50,
        "{}",
        finished.len()
    );
    let passing = vec![passing("a"), study("b", Does::TooShort)];
    assert_eq!(run::run(&passing, effort, &|_| {}).unwrap().len(), 2);
}

#[test]
fn any_number_of_threads_gives_the_same_outcomes() {
    let outcomes = |count| {
        let finished = run::run(&all(), jobs(count), &|_| {}).unwrap();
        finished
            .into_iter()
            .map(|finished| format!("{:?}", finished.outcome))
            .collect::<Vec<_>>()
    };
    let one = outcomes(1);
    for count in [2, 3, 4, 16] {
        assert_eq!(outcomes(count), one);
    }
}

#[test]
fn one_thread_starts_with_the_costliest_and_progress_ends_with_everything() {
    let reports = Mutex::new(Vec::new());
    let studies = vec![passing("a"), study("b", Does::Panic)];
    run::run(&studies, jobs(1), &|progress| {
        reports.lock().unwrap().push(progress);
    })
    .unwrap();
    let reports = reports.into_inner().unwrap();
    let costs: Vec<f64> = reports
        .iter()
        .scan(0.0, |before, now| {
            Some(now.done_cost - std::mem::replace(before, now.done_cost))
        })
        .collect();
    assert_eq!(
        costs,
        [128.0, 128.0, 64.0, 64.0, 32.0, 32.0, 16.0, 16.0, 8.0, 8.0]
    );
    let last = reports.last().unwrap();
    assert_eq!((last.done_cases, last.cases), (10, 10));
    assert_eq!((last.done_cost, last.cost), (496.0, 496.0));
}

#[test]
fn two_studies_of_one_name_are_refused() {
    let studies = vec![passing("same"), passing("other"), study("same", Does::Stay)];
    let refused = run::run(&studies, jobs(1), &|_| panic!("nothing may run")).unwrap_err();
    assert!(
        matches!(&refused, RunError::DuplicateId(id) if id == "same"),
        "{refused}"
    );
}
