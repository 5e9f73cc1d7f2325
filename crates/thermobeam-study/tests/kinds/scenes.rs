//! Laws of whole scenes: planted differences fail, and every possible key of a scene is used in
//! some case.

use convergence_study::Quantity;
use thermobeam_study::kinds::runs::scenes::{NUMBERS, Scenes};
use thermobeam_study::scene::Scene;

use super::*;

const STUDY: &str = "whole-scenes.toml";

#[test]
fn scenes_meet_their_answers_and_every_planted_difference_fails() {
    let sound = Sound::checked(read::<Scenes>(STUDY));
    let mut answered = 0;
    for index in 0..sound.runs.len() {
        let is_answered = sound.found(index).end == End::Answer;
        for (number, name) in NUMBERS.into_iter().enumerate().take(6) {
            for by in [2e-4, -2e-4, f64::NAN] {
                let moved = sound.at(index, |found| found.numbers[number] += by);
                let fails = moved.verdict == Verdict::Fail;
                assert!(fails || !is_answered, "{name} by {by} in case {index}");
            }
        }
        answered += usize::from(is_answered);
        let other = if is_answered {
            End::IterationLimit
        } else {
            End::Answer
        };
        let ended = sound.at(index, |found| found.end = other).verdict;
        assert_eq!(ended, Verdict::Fail, "another end in case {index}");
    }
    for (steps, expected) in [(Some(1), Verdict::Fail), (None, Verdict::Pass)] {
        let verdict = sound.at(0, |found| found.miscounted = steps).verdict;
        assert_eq!(verdict, expected, "{steps:?} steps with a wrong contact");
    }
    let items = ["scenes in lanes", "without a scheme that runs in lanes"];
    let is_in_lanes = |index: &usize| sound.found(*index).alike_in_lanes.is_some();
    let in_lanes = (0..sound.runs.len()).find(is_in_lanes).expect("a scene");
    sound.leaves_one_out(in_lanes, items, |found| found.alike_in_lanes = None);
    let count = counted(&sound.with(|_, _| ()), "scenes against an answer");
    let judged = count.expect("some are left out").judged;
    assert_eq!([judged, answered], [8, 8]);
}

/// A study of one scene.
fn one_scene(answer: &str, more: &str) -> Outcome {
    run_one(&parsed::<Scenes>(&format!(
        "[study]\nid = \"s\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"runs/scenes\"\n[[case]]\nname = \"one\"\n\
         claim = \"c\"\nends = \"answer\"\n[case.answer]\nwithin = 1e-6\n{answer}\n{more}"
    )))
}

#[test]
fn a_beam_at_rest_fails_and_a_scene_that_runs_alone_is_not_asked_for_lanes() {
    // β²/(4ρ), which every scheme keeps.
    let rest = "[case.beam]\nbeta = 2.0\n[case.time]\ndt = 0.1\nt_end = 1.0\n";
    let rest = one_scene("energy = 1.0", rest);
    let evidence = &rest
        .checks
        .iter()
        .find(|check| check.verdict == Verdict::Fail);
    let evidence = evidence.expect("a claim that fails").evidence.to_string();
    assert!(evidence.contains("nothing moves"), "{evidence}");
    // Rigid rotation: u_t = φ_t x... of a beam by any order, which has no lanes.
    let alone = "[case.initial]\nu_t = \"x\"\n[case.mesh]\ndegree = 8\n[case.time]\nscheme = \"dg\"\ndegree = 2\n\
                 dt = 0.01\nrestart_dt = 0.01\nt_end = 0.02\n";
    let alone = one_scene("energy = 0.16666", alone);
    let mut checks = alone.checks.iter();
    let asks = checks.any(|check| check.statement().contains("lanes"));
    assert!(!asks, "{:?}", alone.checks);
}

/// The keys known to the readers of scenes, table by table: their messages about other keys list
/// them.
fn keys_of_the_reader(scheme: &str) -> Vec<(String, String)> {
    let allowed = |text: &str| {
        let error = Scene::parse(text, "s.toml").expect_err(text);
        let words = error.complaint();
        let (problem, allowed) = words.split_once("; expected ").expect(&words);
        assert!(problem.starts_with("unknown key"), "{words}");
        allowed.split(", ").map(str::to_owned).collect::<Vec<_>>()
    };
    let time = format!("[time]\ndt = 0.1\nt_end = 1.0\nscheme = \"{scheme}\"\n");
    let of = |table: String| {
        let head = if table == "time" {
            String::new()
        } else {
            format!("[{table}]\n")
        };
        let keys = allowed(&format!("{time}{head}nosuchkey = 1\n")).into_iter();
        keys.map(move |key| (table.clone(), key))
    };
    allowed("nosuchkey = 1\n")
        .into_iter()
        .flat_map(of)
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
    let moved = |(one, other): (&Quantity, &Quantity)| {
        one.name != other.name || (one.value - other.value).abs() > one.tolerance * one.value.abs()
    };
    found.verdict != Verdict::Pass
        || found.quantities.len() != sound.quantities.len()
        || sound.quantities.iter().zip(&found.quantities).any(moved)
}

#[test]
fn every_key_of_a_scene_is_at_work_in_some_case() {
    let whole = text(STUDY);
    let cases: Vec<&str> = whole.split("[[case]]").collect();
    let sound = run_one(&parsed::<Scenes>(&whole));
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
                let study = Scenes::parse(text, &file(STUDY));
                study.map_or(true, |study| differs(&sound, &run_one(&study)))
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
    let sound = Sound::checked(read::<Scenes>("unlike-lanes.toml"));
    for index in 0..sound.runs.len() {
        assert_eq!(
            sound.found(index).alike_in_lanes,
            Some(true),
            "case {index}"
        );
        let unlike = sound.at(index, |found| found.alike_in_lanes = Some(false));
        assert_eq!(unlike.verdict, Verdict::Fail, "case {index}");
    }
    let elements = text("unlike-lanes.toml").matches("elements = 12").count();
    assert_eq!((elements, sound.runs.len()), (5, 5));
}

#[test]
fn bounds_on_iterations_and_on_the_distance_to_solved_steps_hold_and_can_fail() {
    let sound = Sound::checked(read::<Scenes>("iterations.toml"));
    let mut bounded = 0;
    for index in 0..sound.runs.len() {
        let is_bounded = sound.found(index).unsolved.is_some();
        bounded += usize::from(is_bounded);
        // Numbers without a bound may be anything.
        let more = sound.at(index, |found| found.counts[1] *= 2);
        let is_seen = more.verdict == Verdict::Fail;
        assert_eq!(is_seen, !is_bounded, "twice the iterations in case {index}");
        for share in [Some(1.01), Some(f64::NAN), None] {
            let far = sound.at(index, |found| found.unsolved = share);
            let is_seen = far.verdict == Verdict::Fail;
            assert_eq!(is_seen, is_bounded, "{share:?} in case {index}");
        }
    }
    assert_eq!((bounded, sound.runs.len()), (2, 6));
}
