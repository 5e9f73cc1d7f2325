//! Laws of whole scenes: planted differences fail, and every possible key of a scene is used in
//! some case.

use convergence_study::{Complaint, FromFile, Outcome, Quantity, Verdict, run_one};
use thermobeam_study::kinds::runs::RunStudy;
use thermobeam_study::kinds::runs::cases::End;
use thermobeam_study::kinds::runs::scenes::{self, NUMBERS, ROW, Shown};
use thermobeam_study::scene::Scene;

use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::{counted, leaves_one_out, passes_but_not_without_each_case};
use super::{file, text};

type Scenes = RunStudy<scenes::Scenes>;

const STUDY: &str = "whole-scenes.toml";

fn parsed(text: &str) -> Result<Scenes, String> {
    Scenes::parse(text, &file(STUDY)).map_err(|error| error.to_string())
}

#[test]
fn scenes_meet_their_answers_and_every_planted_difference_fails() {
    let study = parsed(&text(STUDY)).unwrap_or_else(|error| panic!("{error}"));
    let sound = passes_but_not_without_each_case(&study);
    let answered = |index: usize| {
        sound[index]
            .found
            .as_ref()
            .is_ok_and(|found| found.end == End::Answer)
    };
    for index in 0..sound.len() {
        if answered(index) {
            for number in 0..6 {
                for by in [2e-4, -2e-4, f64::NAN] {
                    let verdict =
                        verdict_with(&study, &sound, index, |found| found.numbers[number] += by);
                    assert_eq!(
                        verdict,
                        Verdict::Fail,
                        "{} by {by} in case {index}",
                        NUMBERS[number]
                    );
                }
            }
        }
        let other = |end: End| {
            if end == End::Answer {
                End::IterationLimit
            } else {
                End::Answer
            }
        };
        let verdict = verdict_with(&study, &sound, index, |found| found.end = other(found.end));
        assert_eq!(verdict, Verdict::Fail, "another end in case {index}");
    }
    assert_eq!((0..sound.len()).filter(|&index| answered(index)).count(), 8);
    let in_lanes = (0..sound.len()).find(|&index| {
        let found = sound[index].found.as_ref();
        found.is_ok_and(|found| found.alike_in_lanes.is_some())
    });
    for (steps, expected) in [(Some(1), Verdict::Fail), (None, Verdict::Pass)] {
        let verdict = verdict_with(&study, &sound, 0, |found| found.miscounted = steps);
        assert_eq!(verdict, expected, "{steps:?} steps with a wrong contact");
    }
    let reason = "without a scheme that runs in lanes";
    let index = in_lanes.expect("a scene in lanes");
    leaves_one_out(
        &study,
        &sound,
        index,
        ["scenes in lanes", reason],
        |found| {
            found.alike_in_lanes = None;
        },
    );
    let outcome = convergence_study::Kind::judge(&study, &sound);
    assert_eq!(counted(&outcome, "scenes against an answer").judged, 8);
}

#[test]
fn a_run_of_two_iterations_is_told_from_one_of_three() {
    let two = text(STUDY);
    assert!(two.contains("iterations = 2"));
    for other in ["iterations = 3", "iterations = 1", "tolerance = 1e-6"] {
        let study = parsed(&two.replace("iterations = 2", other));
        let study = study.unwrap_or_else(|error| panic!("{error}"));
        let outcome = run_one(&study);
        let failed: Vec<_> = outcome
            .checks
            .iter()
            .filter(|check| check.verdict == Verdict::Fail)
            .filter_map(|check| check.subject.case.as_deref())
            .collect();
        assert_eq!(failed, ["fixed-point-twice"], "{other}");
    }
}

/// The keys known to the readers of scenes, table by table: their messages about other keys list
/// them.
fn keys_of_the_reader(scheme: &str) -> Vec<(String, String)> {
    let allowed = |text: &str| match Scene::parse(text, "s.toml").map_err(|error| *error.complaint)
    {
        Err(Complaint::UnknownKey { allowed, .. }) => {
            allowed.split(", ").map(str::to_owned).collect::<Vec<_>>()
        }
        other => panic!("{other:?}"),
    };
    let time = format!("dt = 0.1\nt_end = 1.0\nscheme = \"{scheme}\"\n");
    let of = |table: &str| {
        let probe = match table {
            "time" => format!("[time]\n{time}nosuchkey = 1\n"),
            other => format!("[time]\n{time}[{other}]\nnosuchkey = 1\n"),
        };
        allowed(&probe)
            .into_iter()
            .map(|key| (table.to_owned(), key))
            .collect::<Vec<_>>()
    };
    allowed("nosuchkey = 1\n")
        .iter()
        .flat_map(|table| of(table))
        .collect()
}

/// The study without one key of a case; `None` if the case lacks it.
fn without(cases: &[&str], index: usize, table: &str, key: &str) -> Option<String> {
    let head = format!("[case.{table}]\n");
    let (before, rest) = cases[index].split_once(&head)?;
    let (inside, after) = rest
        .split_once("\n[")
        .map_or((rest, String::new()), |(inside, after)| {
            (inside, format!("\n[{after}"))
        });
    let kept: Vec<&str> = inside
        .lines()
        .filter(|line| !line.starts_with(&format!("{key} = ")))
        .collect();
    if kept.len() == inside.lines().count() {
        return None;
    }
    let mut cases = cases.to_vec();
    let changed = format!("{before}{head}{}\n{after}", kept.join("\n"));
    cases[index] = &changed;
    Some(cases.join("[[case]]"))
}

/// Whether a guarded number changes, or a check fails.
fn differs(sound: &Outcome, found: &Outcome) -> bool {
    let moved = |one: &Quantity, other: &Quantity| {
        (one.value - other.value).abs() > one.tolerance * one.value.abs()
    };
    found.verdict != Verdict::Pass
        || found.quantities.len() != sound.quantities.len()
        || sound
            .quantities
            .iter()
            .zip(&found.quantities)
            .any(|(one, other)| one.name != other.name || moved(one, other))
}

#[test]
fn every_key_of_a_scene_is_at_work_in_some_case() {
    let whole = text(STUDY);
    let cases: Vec<&str> = whole.split("[[case]]").collect();
    let sound = run_one(&parsed(&whole).expect("a study"));
    for scheme in ["midpoint", "dg"] {
        let keys = keys_of_the_reader(scheme);
        assert!(keys.len() > 20, "{keys:?}");
        let of_scheme: Vec<usize> = (1..cases.len())
            .filter(|&k| cases[k].contains("scheme = \"dg\"") == (scheme == "dg"))
            .collect();
        let foreign = match scheme {
            "dg" => &["solver", "iterations"][..],
            _ => &["degree", "restart_dt", "growth"],
        };
        for (table, key) in keys {
            if table == "time" && foreign.contains(&&*key) {
                continue;
            }
            let left_out: Vec<String> = of_scheme
                .iter()
                .filter_map(|&k| without(&cases, k, &table, &key))
                .collect();
            assert!(
                !left_out.is_empty(),
                "no case by {scheme} sets {table}.{key}"
            );
            // One-step schemes have elements of degree 1, and no others.
            let only_value = scheme != "dg" && (table.as_str(), key.as_str()) == ("mesh", "degree");
            let notices = |text: &String| {
                parsed(text).map_or(true, |study| differs(&sound, &run_one(&study)))
            };
            assert!(
                only_value || left_out.iter().any(notices),
                "{table}.{key} by {scheme} changes nothing"
            );
        }
    }
}

/// The committed scenes share one group, whose first case is a cold one; a lane with other bits
/// fails.
#[test]
fn unlike_scenes_share_a_group_of_lanes() {
    let study = parsed(&text("unlike-lanes.toml")).unwrap_or_else(|error| panic!("{error}"));
    let sound = passes_but_not_without_each_case(&study);
    for index in 0..sound.len() {
        let shown = sound[index].found.as_ref().expect("a run");
        assert_eq!(shown.alike_in_lanes, Some(true), "case {index}");
        let verdict = verdict_with(&study, &sound, index, |found| {
            found.alike_in_lanes = Some(false);
        });
        assert_eq!(verdict, Verdict::Fail, "case {index}");
    }
    let elements = text("unlike-lanes.toml").matches("elements = 12").count();
    assert_eq!((elements, sound.len()), (5, 5));
}

const BOUNDS: &str = "iterations.toml";

#[test]
fn bounds_on_iterations_and_on_the_distance_to_solved_steps_hold_and_can_fail() {
    let study = parsed(&text(BOUNDS)).unwrap_or_else(|error| panic!("{error}"));
    let sound = passes_but_not_without_each_case(&study);
    let mut bounded = 0;
    for index in 0..sound.len() {
        let unsolved = sound[index].found.as_ref().expect("a run").unsolved;
        bounded += usize::from(unsolved.is_some());
        // Numbers without a bound may be anything.
        let more = |found: &mut Shown| found.counts[1] *= 2;
        let expected = if unsolved.is_none() {
            Verdict::Fail
        } else {
            Verdict::Pass
        };
        assert_eq!(
            verdict_with(&study, &sound, index, more),
            expected,
            "twice the iterations in case {index}"
        );
        for share in [Some(1.01), Some(f64::NAN), None] {
            let expected = if unsolved.is_some() {
                Verdict::Fail
            } else {
                Verdict::Pass
            };
            let verdict = verdict_with(&study, &sound, index, |found| found.unsolved = share);
            assert_eq!(verdict, expected, "{share:?} in case {index}");
        }
    }
    assert_eq!((bounded, sound.len()), (2, 6));
}

#[test]
fn bounds_that_cannot_be_are_refused() {
    for (from, to, words) in [
        (
            "iterations_per_step = 4.3",
            "iterations = 4.3",
            "case[0].most.iterations: unknown key",
        ),
        (
            "iterations_per_step = 4.3",
            "iterations_per_step = 0",
            "case[0].most.iterations_per_step: found 0",
        ),
        (
            "iterations_per_step = 4.3\n",
            "",
            "case[0].most.iterations_per_step: missing",
        ),
        (
            "iterations_per_step = 2.0",
            "unsolved = 1.0",
            "case[3].most.unsolved: found a bound for dg",
        ),
        (
            "[case.most]\niterations_per_step = 4.3\n",
            "",
            "case[0].answer: missing",
        ),
        (
            "ends = \"answer\"",
            "ends = \"indefinite\"",
            "case[0].most: found bounds",
        ),
    ] {
        let message = refusal(&ROW, BOUNDS, from, to);
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn what_a_case_cannot_claim_is_refused() {
    for (from, to, words) in [
        (
            "[case.answer]\nwithin",
            "[case.other]\nwithin",
            "case[0].other: unknown key",
        ),
        ("within = 1e-9\n", "", "case[0].answer.within: missing"),
        ("u_tip = ", "utip = ", "case[0].answer.utip: unknown key"),
        (
            "ends = \"answer\"",
            "ends = \"indefinite\"",
            "case[0].answer: found an answer",
        ),
        (
            "name = \"midpoint\"",
            "name = \"listed-nodes\"",
            "a second \"listed-nodes\"",
        ),
        (
            "t_end = 1.0",
            "t_end = -1.0",
            "case[0].time.t_end: found -1.0",
        ),
    ] {
        let message = refusal(&ROW, STUDY, from, to);
        assert!(message.contains(words), "{message}");
    }
}
