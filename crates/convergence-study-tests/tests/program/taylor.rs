//! Derivatives that a program computes.

use std::fs;

use super::{Place, SOLVER, project_of};

/// A test of the derivatives of the solver in this mode.
///
/// * `command`: what follows the mode; `more`: the rest of the file.
fn place(mode: &str, command: &str, more: &str) -> Place {
    let place = Place::new("ok", "");
    let token = place.token();
    place.write_text(&format!(
        "[study]\nid = \"s\"\nclaim = \"the gradient is right\"\ntier = \"quick\"\nkind = \"taylor\"\n\
         [program]\ncommand = [{SOLVER:?}, {token:?}, \"taylor-{mode}\", {command}]\n{more}"
    ));
    place
}

const BOTH: &str = r#""{eps}", "{seed}""#;

#[test]
fn right_derivatives_pass_with_their_size() {
    let ran = place("right", BOTH, "").study("");
    ran.says(0, "\ndJ·d is right to ");
    ran.says(0, " in 3 directions\n");
    ran.says(0, "45 of 45 cases completed");
    place("right", BOTH, "[taylor]\nsecond = true\n")
        .study("")
        .says(0, ", d'Hd is right to ");
    // Without {seed} there is one direction.
    let ran = place("right", r#""{eps}""#, "").study("");
    ran.says(0, " in 1 direction\n");
    ran.says_not(0, "seed");
}

#[test]
fn wrong_derivatives_fail() {
    for mode in ["1e-3", "1e-5", "sign", "component", "elsewhere"] {
        let ran = place(mode, BOTH, "").study("");
        ran.begins(1, "s: fail, ");
        ran.says(1, " is wrong: the differences of J tend to ");
    }
    let place = place("hessian", BOTH, "[taylor]\nsecond = true\n");
    place.study("").says(1, "d'Hd = ");
    let (_, out, _) = self::place("corner", BOTH, "").study("").parts();
    assert!(out.starts_with("s: fail, "), "{out}");
}

#[test]
fn what_tests_nothing_is_inconclusive() {
    for (mode, words) in [
        ("ignored", "nothing is tested: J is a line along d"),
        ("line", "nothing is tested: J is a line along d"),
        ("stationary", "dJ·d is zero along this direction"),
        ("digits", "or ask for less with to=1e-"),
    ] {
        let (status, out, _) = place(mode, BOTH, "").study("").parts();
        assert_eq!(status, Some(1), "{mode}: {out}");
        let is_said = out.starts_with("s: inconclusive, ") && out.contains(words);
        assert!(
            is_said || mode == "ignored" && out.starts_with("s: fail, "),
            "{mode}: {out}"
        );
    }
}

#[test]
fn a_direction_in_which_a_derivative_is_zero_is_replaced() {
    let ran = place("first-vanishes", BOTH, "").study("");
    ran.says(
        0,
        " in 3 directions; 1 direction drawn anew, in which a derivative is zero\n",
    );
    ran.says(0, "60 of 60 cases completed");
    ran.says_not(0, "seed = 1:");
}

#[test]
fn coarse_steps_outside_of_the_domain_are_left_out_and_crashes_fail() {
    place("outside", BOTH, "")
        .study("")
        .says(0, "; J is not finite at 2 coarse steps");
    place("crash", BOTH, "")
        .study("")
        .says(1, "no direction has a J at every step");
}

#[test]
fn what_a_file_may_get_wrong_is_named() {
    for (command, more, message) in [
        (
            r#""{n}""#,
            "",
            "program.command[3]: found the placeholder {n}; expected one that",
        ),
        (
            r#""{seed}""#,
            "",
            "expected a command with the placeholder {eps}, or without any",
        ),
        (
            r#""{eps}""#,
            "[taylor]\ndirections = 2",
            "taylor.directions: found 2; expected 1, or {seed} in the command",
        ),
        (
            BOTH,
            "[taylor]\nto = 1",
            "taylor.to: found 1; expected a finite number > 0 and < 1",
        ),
        (
            BOTH,
            "[taylor]\neps = 0",
            "taylor.eps: found 0; expected a finite number > 0",
        ),
        (BOTH, "floor = 1", "program.floor: unknown key `floor`"),
    ] {
        place("right", command, more).study("").refuses(message);
    }
}

#[test]
fn the_answered_numbers_are_guarded_and_a_looser_claim_is_found() {
    let place = project_of(place("right", BOTH, "[taylor]\nto = 1e-7\n"));
    let file = place.folder.path().join("studies/s.toml");
    let verify = |more: &str| place.verify(more);
    verify("--bless").says(0, "");
    verify("").says(0, "");
    // The page that is committed has no digits of round-off.
    let page = place.read("reports/README.md");
    assert!(
        page.contains("(dJ·d is right to 1e-7 in 3 directions)"),
        "{page}"
    );
    let baseline = place.read("studies/baseline.json");
    for name in ["seed = 3: dJ·d", "seed = 3: J", "dJ·d right to"] {
        assert!(baseline.contains(name), "{baseline}");
    }
    let text = fs::read_to_string(&file).unwrap().replace("1e-7", "1e-5");
    fs::write(&file, text).unwrap();
    let (status, out, err) = verify("--bless").parts();
    assert!(
        status == Some(1) && (out.clone() + &err).contains("dJ·d right to"),
        "{out}{err}"
    );
}
