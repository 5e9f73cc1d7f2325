//! Levels that are made of samples.

use std::fs;

use super::{Place, SOLVER, project_of};

/// A study of the solver with errors that scatter, in this mode, by 40 samples.
fn place(mode: &str) -> Place {
    let place = Place::new("ok", "");
    let token = place.token();
    place.write_text(&format!(
        "[study]\nid = \"s\"\nclaim = \"strong and weak order\"\ntier = \"quick\"\nkind = \"program\"\n\
         [program]\ncommand = [{SOLVER:?}, {token:?}, \"random-{mode}\", \"{{n}}\", \"{{seed}}\"]\n\
         [refine]\nn = [4, 8, 16, 32, 64]\nsamples = 40\n\
         [[expect]]\nerror = \"strong\"\norder = 0.5\n\
         [[expect]]\nerror = \"weak\"\nof = \"weak\"\norder = 1.0\n"
    ));
    place
}

#[test]
fn means_of_samples_are_judged_by_their_scatter() {
    let (status, out, err) = place("ok").study("").parts();
    assert_eq!(status, Some(0), "{out}{err}");
    for words in [
        "; each level is made of 40 samples, by the same seeds on all levels\n",
        "strong    0.5 ± 0.25",
        "1-5 of 5     pass",
    ] {
        assert!(out.contains(words), "{words}: {out}");
    }
    // The same bytes for any number of simultaneous processes.
    let record = |jobs| {
        place("ok")
            .study(&format!("--format json --jobs {jobs}"))
            .stdout
    };
    let [one, other] = ["1", "4"].map(record);
    let levels = |text: &str| {
        let object: serde_json::Value = serde_json::from_str(text).unwrap();
        object["studies"][0]["levels"].clone()
    };
    assert_eq!(levels(&one), levels(&other));
}

#[test]
fn wrong_orders_of_samples_do_not_pass() {
    for (from, to) in [
        ("order = 0.5", "order = 1.0"),
        ("order = 1.0", "order = 2.0"),
    ] {
        let place = place("ok");
        let file = place.folder.path().join("s.toml");
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.contains(from));
        place
            .study_of(&text.replacen(from, to, 1))
            .begins(1, "s: fail");
    }
}

#[test]
fn a_level_that_tells_nothing_says_how_many_samples_would() {
    place("wide").study("").says(
        1,
        "tells nothing: two standard errors exceed its mean; more than ",
    );
}

#[test]
fn a_failed_sample_fails_its_level() {
    for (mode, words) in [
        (
            "crash",
            "n = 16: 1 of 40 samples failed: n = 16, seed = 7: ",
        ),
        ("nan", "n = 16: 1 of 40 samples failed: n = 16, seed = 7: "),
        (
            "step",
            "n = 16: its samples answer different steps; expected one step of a level",
        ),
    ] {
        place(mode).study("").says(1, words);
    }
}

#[test]
fn the_errors_of_levels_are_guarded() {
    let place = project_of(place("ok"));
    let verify = |more: &str| place.verify(more);
    verify("--bless").says(0, "");
    verify("").says(0, "");
    let studies = place.folder.path().join("studies");
    let baseline = fs::read_to_string(studies.join("baseline.json")).unwrap();
    let has = |name: &str| baseline.contains(&format!("\"{name}\""));
    assert!(
        has("error weak, n = 64") && !baseline.contains("seed ="),
        "{baseline}"
    );
    // Other samples are other settings.
    let file = studies.join("s.toml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("samples = 40", "samples = 30")).unwrap();
    let (status, out, err) = verify("--bless").parts();
    assert!(
        status == Some(1) && (out + &err).contains("settings"),
        "{err}"
    );
}

#[test]
fn what_samples_do_not_have_is_refused() {
    for (from, to, message) in [
        (
            ", \"{seed}\"",
            "",
            "expected a command with the placeholder {seed}, which tells",
        ),
        (
            "samples = 40",
            "samples = 9",
            "refine.samples: found 9; expected a whole number >= 10",
        ),
        (
            "samples = 40",
            "",
            "expect[1].of: found the text \"weak\"; expected of only where refine",
        ),
        (
            "[4, 8, 16, 32, 64]",
            "\"auto\"",
            "refine.samples: found 40; expected samples of levels",
        ),
        (
            "of = \"weak\"",
            "of = \"median\"",
            "expected \"mean\", \"rms\", \"weak\"",
        ),
        (
            "[refine]",
            "floor = 1e-9\n[refine]",
            "program.floor: found 1e-9; expected no floor beside",
        ),
        (
            "order = 0.5",
            "factor = 3",
            "expect[0].factor: found 3; expected error and order beside",
        ),
        (
            "samples = 40",
            "samples = 4000",
            "found 4000 samples of 5 levels; expected at most 10000",
        ),
    ] {
        let place = place("ok");
        let file = place.folder.path().join("s.toml");
        let text = fs::read_to_string(&file).unwrap();
        let text = text.replacen(from, to, 1);
        // The place-holder is then unknown.
        let text = if to.is_empty() && from.starts_with("samples") {
            text.replace(", \"{seed}\"", "")
        } else {
            text
        };
        place.study_of(&text).refuses(message);
    }
}
