use std::{fs, io};

use crate::{Finished, Quantity, store::Baseline};

use super::fake::{Does, Fake, fake, finished, ids, study};

fn blessed(studies: Vec<Fake>) -> Baseline {
    let mut baseline = Baseline::default();
    baseline.bless(&run(studies), None, false).unwrap();
    baseline
}

fn run(studies: Vec<Fake>) -> Vec<Finished> {
    finished(studies.into_iter().map(Fake::erased).collect())
}

/// The changes in words.
fn changes(baseline: &Baseline, studies: Vec<Fake>, known: Option<&[&str]>) -> Vec<String> {
    let known = known.map(ids);
    baseline
        .compare(&run(studies), known.as_deref())
        .iter()
        .map(ToString::to_string)
        .collect()
}

#[test]
fn a_blessed_run_agrees_with_its_baseline() {
    let baseline = blessed(vec![fake("a", Does::Converge)]);
    assert_eq!(baseline.guards("a"), 1);
    assert!(changes(&baseline, vec![fake("a", Does::Converge)], Some(&["a"])).is_empty());
}

#[test]
fn a_number_that_moved_is_named_with_how_far() {
    let baseline = blessed(vec![fake("a", Does::Converge)]);
    for (scale, words) in [
        (1.0009, None),
        (0.9991, None),
        (
            1.0011,
            Some(
                "a: finest error moved from 0.00234375 to 0.00234633, by +0.11 %, tolerated 0.1 %",
            ),
        ),
        (
            0.4,
            Some("a: finest error moved from 0.00234375 to 9.375e-4, by -60 %, tolerated 0.1 %"),
        ),
        (
            f64::NAN,
            Some(
                "a: finest error moved from 0.00234375 to NaN, which is not finite and matches nothing",
            ),
        ),
        (
            f64::INFINITY,
            Some(
                "a: finest error moved from 0.00234375 to inf, which is not finite and matches nothing",
            ),
        ),
    ] {
        let found = changes(
            &baseline,
            vec![Fake {
                scale,
                ..fake("a", Does::Converge)
            }],
            None,
        );
        assert_eq!(
            found,
            words.map(str::to_owned).into_iter().collect::<Vec<_>>(),
            "{scale}"
        );
    }
}

#[test]
fn new_and_vanished_numbers_are_named() {
    let baseline = blessed(vec![
        fake("a", Does::Converge),
        fake("gone", Does::Converge),
    ]);
    let renamed = || {
        vec![
            Fake {
                quantity: "coarsest error",
                ..fake("a", Does::Converge)
            },
            fake("new", Does::Converge),
        ]
    };
    let in_these = [
        "a: coarsest error is new: 0.00234375",
        "a: finest error has vanished: was 0.00234375",
        "new: study is new",
        "new: finest error is new: 0.00234375",
    ];
    assert_eq!(changes(&baseline, renamed(), None), in_these);
    let in_all = changes(&baseline, renamed(), Some(&["a", "new"]));
    assert_eq!(in_all[..4], in_these);
    assert_eq!(
        in_all[4..],
        ["gone: study was deleted: it had 1 guarded number"]
    );
    // An existing study that was not run has not vanished.
    assert_eq!(
        changes(&baseline, renamed(), Some(&["a", "new", "gone"])),
        in_these
    );
}

#[test]
fn a_changed_tolerance_is_reported_and_not_applied() {
    let baseline = blessed(vec![fake("a", Does::Converge)]);
    let loose = || Fake {
        tolerance: 10.0,
        ..fake("a", Does::Converge)
    };
    assert_eq!(
        changes(&baseline, vec![loose()], None),
        ["a: finest error has another tolerance: was 1e-3, is 1e1"]
    );
    let moved = changes(
        &baseline,
        vec![Fake {
            scale: 1.1,
            ..loose()
        }],
        None,
    );
    assert_eq!(
        moved,
        [
            "a: finest error moved from 0.00234375 to 0.00257813, by +10 %, tolerated 0.1 %",
            "a: finest error has another tolerance: was 1e-3, is 1e1"
        ]
    );
}

#[test]
fn nan_in_the_baseline_meets_nothing_not_even_nan() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    blessed(vec![fake("a", Does::Converge)])
        .write(&file)
        .unwrap();
    let text = fs::read_to_string(&file).unwrap();
    for (broken, moved) in [
        ("[null, 0.001]", "a: finest error moved from NaN to "),
        ("[0.00234375, null]", "a: finest error moved from 0.0023"),
    ] {
        let text = text.replace("[0.00234375, 0.001]", broken);
        fs::write(&file, text).unwrap();
        let baseline = Baseline::read(&file).unwrap();
        for scale in [1.0, f64::NAN] {
            let scaled = Fake {
                scale,
                ..fake("a", Does::Converge)
            };
            let found = changes(&baseline, vec![scaled], None);
            assert!(found[0].starts_with(moved), "{found:?}");
        }
    }
}

#[test]
fn a_run_that_does_not_pass_is_not_blessed() {
    for (does, verdict) in [
        (Does::Stay, "fail"),
        (Does::TooShort, "inconclusive"),
        (Does::Nothing, "inconclusive"),
    ] {
        let mut baseline = blessed(vec![fake("a", Does::Converge)]);
        let before = baseline.clone();
        let refused = baseline
            .bless(
                &finished(vec![study("b", Does::Converge), study("a", does)]),
                None,
                true,
            )
            .unwrap_err();
        assert!(
            refused
                .to_string()
                .contains(&format!("the verdict on `a` is {verdict}")),
            "{refused}"
        );
        assert_eq!(baseline, before);
    }
}

#[test]
fn a_number_that_no_run_can_meet_is_not_blessed() {
    for (value, tolerance) in [
        (f64::NAN, 0.1),
        (f64::INFINITY, 0.1),
        (1.0, f64::NAN),
        (1.0, -0.1),
        (1.0, f64::INFINITY),
    ] {
        let mut run = run(vec![fake("a", Does::Converge)]);
        let odd = Quantity::new("odd", value, tolerance);
        run[0].outcome.quantities.push(odd);
        let refused = Baseline::default().bless(&run, None, true).unwrap_err();
        assert!(
            refused
                .to_string()
                .starts_with("not blessed: `odd` of `a` is "),
            "{refused}"
        );
    }
}

#[test]
fn blessing_some_studies_keeps_the_others_and_drops_vanished_ones() {
    let mut baseline = blessed(vec![fake("a", Does::Converge), fake("b", Does::Converge)]);
    baseline
        .bless(
            &run(vec![Fake {
                scale: 2.0,
                ..fake("a", Does::Converge)
            }]),
            None,
            false,
        )
        .unwrap();
    assert_eq!((baseline.guards("a"), baseline.guards("b")), (1, 1));
    assert!(
        changes(
            &baseline,
            vec![
                Fake {
                    scale: 2.0,
                    ..fake("a", Does::Converge)
                },
                fake("b", Does::Converge)
            ],
            None
        )
        .is_empty()
    );
    let before = baseline.clone();
    let mut drop_b = |loosened| {
        let ran = run(vec![fake("a", Does::Converge)]);
        baseline.bless(&ran, Some(&ids(&["a"])), loosened)
    };
    let refused = drop_b(false).unwrap_err().to_string();
    assert!(
        refused.ends_with("\n  b: study was deleted: it had 1 guarded number"),
        "{refused}"
    );
    assert_eq!(drop_b(true).unwrap().len(), 1);
    assert_ne!(baseline, before);
    assert_eq!((baseline.guards("a"), baseline.guards("b")), (1, 0));
}

#[test]
fn a_number_that_did_not_move_keeps_its_digits_when_others_are_blessed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    let text = |baseline: &Baseline| {
        baseline.write(&file).unwrap();
        fs::read_to_string(&file).unwrap()
    };
    let mut baseline = blessed(vec![fake("a", Does::Converge), fake("b", Does::Converge)]);
    let before = text(&baseline);
    assert_eq!(before.matches("0.00234375,").count(), 2, "{before}");
    // Within the tolerance of 1e-3, `a` has other digits; `b` has moved.
    let scaled = |id, scale| Fake {
        scale,
        ..fake(id, Does::Converge)
    };
    baseline
        .bless(
            &run(vec![scaled("a", 1.0005), scaled("b", 2.0)]),
            None,
            false,
        )
        .unwrap();
    let after = text(&baseline);
    assert_eq!(
        after,
        before
            .replacen("0.00234375,", "0.0046875,", 2)
            .replacen("0.0046875,", "0.00234375,", 1)
    );
}

#[test]
fn a_baseline_comes_back_from_its_file_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    let exact = || Fake {
        scale: std::f64::consts::PI * 1e-5,
        tolerance: 0.0,
        ..fake("a", Does::Converge)
    };
    blessed(vec![exact()]).write(&file).unwrap();
    assert!(changes(&Baseline::read(&file).unwrap(), vec![exact()], None).is_empty());
}

#[test]
fn a_file_that_is_no_baseline_is_refused_and_none_at_all_is_empty() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    assert_eq!(Baseline::read(&file).unwrap(), Baseline::default());
    for text in [
        "",
        "{}",
        "[1",
        r#"{ "schema": 3 }"#,
        r#"{ "schema": 3, "studies": { "a": {} } }"#,
        r#"{ "schema": 3, "studies": { "a": { "numbers": { "x": [1.0] } } } }"#,
        r#"{ "schema": 3, "studies": { "a": { "numbers": { "x": [1.0, 0.1, "<= NaN"] } } } }"#,
        r#"{ "schema": 3, "studies": { "a": { "numbers": { "x": [1.0, 0.1, "<= 1", 2] } } } }"#,
        r#"{ "schema": 3, "studies": {}, "more": 1 }"#,
    ] {
        fs::write(&file, text).unwrap();
        let refused = Baseline::read(&file).unwrap_err();
        assert!(refused.kind() == io::ErrorKind::InvalidData, "{text}");
        assert!(refused.to_string().contains("baseline.json: "), "{refused}");
    }
    for version in [1, 2, 4] {
        fs::write(
            &file,
            format!(r#"{{ "schema": {version}, "studies": {{}} }}"#),
        )
        .unwrap();
        let refused = Baseline::read(&file).unwrap_err().to_string();
        assert!(
            refused.contains(&format!("schema: found {version}; expected 3")),
            "{refused}"
        );
        assert!(
            refused.contains("run `verify --bless`, then `verify --tier full --bless`"),
            "{refused}"
        );
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_in_place_of_the_baseline_is_refused_and_does_not_hang() {
    if !foreign_tools::are_here(&[foreign_tools::MKFIFO]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("baseline.json");
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&file)
            .status()
            .unwrap()
            .success()
    );
    let refused = Baseline::read(&file).unwrap_err().to_string();
    assert!(
        refused.contains("baseline.json: expected a regular file"),
        "{refused}"
    );
}
