//! Stability maps: what must make each fail.

use crate::{Results, file, passes_but_not_without_each_case, results, text};
use convergence_study::judge::verdict::Verdict;
use thermobeam_study::kinds::stability::Stability;
use thermobeam_study::kinds::{FromFile, Study};

fn map() -> Stability {
    Stability::read(file("stability-coarse.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// The results with one number of one case changed.
fn with(results: &Results, index: usize, name: &str, value: f64) -> Results {
    let mut results = results.clone();
    let measured = results[index].as_mut().expect("a result");
    let found = measured.values.iter_mut().find(|(key, _)| key == name);
    found.unwrap_or_else(|| panic!("no {name} in case {index}")).1 = value;
    results
}

/// The results with the values of a curve of the first case changed.
fn bent(results: &Results, name: &str, change: impl Fn(f64, f64) -> f64) -> Results {
    let mut results = results.clone();
    let measured = results[0].as_mut().expect("a result");
    let (_, points) = measured.series.iter_mut().find(|(key, _)| key == name).expect("a curve");
    points.iter_mut().for_each(|(x, y)| *y = change(*x, *y));
    results
}

#[test]
fn the_files_pass_but_not_without_each_case() {
    passes_but_not_without_each_case(&map());
}

#[test]
fn a_map_fails_on_each_of_its_claims() {
    let (study, sound) = (map(), results(&map()));
    let verdict = |results: Results| study.conclude(&results).verdict;
    let (first_line, last) = (12, sound.len() - 1);
    // The first row is the stiffest; its shortest step converges, its longest does not.
    for (name, at, to) in [("fixed point failed", 1e-6, 1.0), ("fixed point failed", 10.0, 0.0)] {
        let planted = |dt: f64, value: f64| if (dt / at - 1.0).abs() < 1e-9 { to } else { value };
        assert_eq!(verdict(bent(&sound, name, |_, value| value)), Verdict::Pass);
        assert_eq!(verdict(bent(&sound, name, planted)), Verdict::Fail, "{name} at {at}");
    }
    for (name, value) in [("contact", 0.0), ("newton iterations", 31.0), ("newton refused", 1.0)] {
        assert_eq!(verdict(bent(&sound, name, |_, _| value)), Verdict::Fail, "{name}");
    }
    for name in ["open", "risen"] {
        for value in [1.1, f64::NAN] {
            assert_eq!(verdict(with(&sound, 0, name, value)), Verdict::Fail, "{name} {value}");
        }
    }
    for index in [first_line, last] {
        for (name, value) in
            [("alpha", 1.03), ("alpha", 0.97), ("crosses", 0.0), ("should cross", 0.0), ("alpha", f64::NAN)]
        {
            assert_eq!(verdict(with(&sound, index, name, value)), Verdict::Fail, "{name} {value}");
        }
    }
}

#[test]
fn files_that_make_no_sense_are_refused() {
    let refuse = |message: &str, error: String| assert!(error.contains(message), "{error}");
    for (from, to, message) in [
        ("over = \"epsilon\"", "over = \"rho\"", "stability.over"),
        ("dt = [1e-6, 10.0]", "dt = [10.0, 1e-6]", "stability.dt"),
        ("range = [1e-8, 10.0]", "range = [0.0, 10.0]", "stability.range"),
        ("points = 12", "points = 1", "stability.points"),
        ("lines = [1e-6, 1e-3]", "lines = []", "stability.lines"),
        ("lines = [1e-6, 1e-3]", "lines = [0.0]", "stability.lines[0]"),
    ] {
        let changed = text("stability-coarse.toml").replace(from, to);
        refuse(message, Stability::parse(&changed, "s.toml".as_ref()).expect_err(to).to_string());
    }
}
