//! Laws of studies of orders for the scheme of any order: they pass, and planted defects make them
//! fail.

use convergence_study::{CaseFailure, FromFile, Kind, Verdict, run_one};
use thermobeam_study::kinds::orders::any_order::{self, JudgedErrors};
use thermobeam_study::kinds::orders::{ErrorSource, Orders};

type AnyOrder = Orders<any_order::AnyOrder>;

use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::{Runs, changed, passes_but_not_without_each_case, report};
use super::{file, text};

fn parse(text: &str) -> AnyOrder {
    AnyOrder::parse(text, &file("changed.toml")).unwrap_or_else(|error| panic!("{error}"))
}

fn read(name: &str) -> AnyOrder {
    AnyOrder::read(file(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// Two series of `any-order-time.toml`: the other two take most of its time.
fn time() -> AnyOrder {
    let text = text("any-order-time.toml");
    let (head, rest) = text.split_once("[[series]]").expect("series");
    let of = |q: &str| {
        let series = rest.split("[[series]]").find(|series| series.contains(q));
        series.unwrap_or_else(|| panic!("no {q}")).to_owned()
    };
    parse(&format!(
        "{head}[[series]]{}[[series]]{}",
        of("time_degree = 2"),
        of("time_degree = 3")
    ))
}

#[test]
fn orders_in_time_pass_and_planted_errors_fail() {
    let study = time();
    let sound = passes_but_not_without_each_case(&study);
    // A floor, a wrong order, a lucky run and numbers that are not finite, in each error
    // separately.
    for k in 0..3 {
        let floor = changed::<AnyOrder>(&sound, |_, found| found.named[k].1 += 1e-4);
        assert_eq!(
            study.judge(&floor).verdict,
            Verdict::Fail,
            "a floor under error {k}"
        );
        let slow = changed::<AnyOrder>(&sound, |index, found| {
            let coarser = sound[index].case.data.steps as f64 / 10.0;
            found.named[k].1 *= coarser;
        });
        assert_eq!(
            study.judge(&slow).verdict,
            Verdict::Fail,
            "one order less in error {k}"
        );
        for index in 0..sound.len() {
            for wrong in [f64::NAN, f64::INFINITY] {
                assert_eq!(
                    verdict_with(&study, &sound, index, |found| found.named[k].1 = wrong),
                    Verdict::Fail
                );
            }
        }
    }
}

#[test]
fn orders_in_space_fail_where_slopes_or_fields_lose_an_order() {
    let text = text("any-order-space.toml");
    let (head, rest) = text.split_once("[[series]]").expect("series");
    let series = rest
        .split("[[series]]")
        .find(|series| series.contains("degree = 3"))
        .expect("p = 3");
    let study = parse(&format!("{head}[[series]]{series}"));
    let sound = passes_but_not_without_each_case(&study);
    for k in 0..2 {
        for power in [-1.0, 1.0] {
            let wrong = changed::<AnyOrder>(&sound, |index, found| {
                found.named[k].1 *= (sound[index].case.data.elements as f64).powf(power);
            });
            assert_eq!(
                study.judge(&wrong).verdict,
                Verdict::Fail,
                "error {k} by an order {power}"
            );
        }
    }
    // Errors inside steps are time errors and are not measured here.
    assert!(sound.iter().all(|ran| {
        ran.found
            .as_ref()
            .expect("errors")
            .named
            .iter()
            .all(|(name, _)| !name.contains("inside"))
    }));
}

#[test]
fn the_fall_over_degrees_must_be_steep_monotone_and_end_in_round_off() {
    let study = read("any-order-degree.toml");
    let sound = passes_but_not_without_each_case(&study);
    let with = |change: &dyn Fn(usize, &mut JudgedErrors)| {
        let runs = changed::<AnyOrder>(&sound, |index, found| change(index, found));
        study.judge(&runs).verdict
    };
    assert_eq!(with(&|_, _| ()), Verdict::Pass);
    assert_eq!(
        with(&|_, found| found.named[0].1 += 1e-11),
        Verdict::Fail,
        "a floor above round-off"
    );
    assert_eq!(
        with(&|index, found| found.named[0].1 *= if index == 3 { 1e4 } else { 1.0 }),
        Verdict::Fail,
        "a bump"
    );
    let algebraic =
        |index: usize, found: &mut JudgedErrors| found.named[0].1 = ((index + 1) as f64).powi(-6);
    assert_eq!(with(&algebraic), Verdict::Fail, "an algebraic fall");
    let last = sound.len() - 1;
    assert_eq!(
        with(&|index, found| found.named[0].1 *= if index == last { 1e4 } else { 1.0 }),
        Verdict::Fail,
        "the end"
    );
}

#[test]
fn initial_fields_that_are_not_the_projections_fail() {
    let study = read("any-order-degree.toml");
    let sound = passes_but_not_without_each_case(&study);
    for start in [2e-11, f64::NAN] {
        let wrong = changed::<AnyOrder>(&sound, |index, found| {
            found.start = if index == 3 { start } else { 0.0 }
        });
        assert_eq!(study.judge(&wrong).verdict, Verdict::Fail, "{start}");
    }
}

#[test]
fn the_control_table_makes_a_study_fail() {
    let text = text("any-order-coefficients.toml");
    assert_eq!(run_one(&parse(&text)).verdict, Verdict::Pass);
    for control in [
        "zeta = 0.10001",
        "a = 0.50005",
        "rho = 2.0002",
        "beta = 0.50005",
        "theta_a = 20.002",
        "epsilon = 0.010001",
    ] {
        let off = text.replace("[run]", &format!("[control]\n{control}\n\n[run]"));
        assert_eq!(run_one(&parse(&off)).verdict, Verdict::Fail, "{control}");
    }
}

#[test]
fn a_failed_run_is_told_with_its_reason_and_an_empty_study_does_not_pass() {
    let study = read("any-order-coefficients.toml");
    let mut runs: Runs<AnyOrder> = study.run_here();
    runs[0].found = Err(CaseFailure::new("the iteration diverged"));
    let outcome = study.judge(&runs);
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert!(report(&outcome).contains("the iteration diverged"));
    assert_ne!(study.judge(&[]).verdict, Verdict::Pass);
}

#[test]
fn files_with_errors_are_refused_with_the_field() {
    for (name, from, to, message) in [
        (
            "any-order-space.toml",
            "over = \"space\"",
            "over = \"mesh\"",
            "run.over",
        ),
        (
            "any-order-space.toml",
            "t_end = 0.3",
            "t_end = -0.3",
            "run.t_end",
        ),
        (
            "any-order-space.toml",
            "time_degree = 4",
            "time_degree = 6",
            "run.time_degree",
        ),
        (
            "any-order-space.toml",
            "degree = 1\n",
            "degree = 41\n",
            "degree",
        ),
        (
            "any-order-space.toml",
            "[16, 32, 64, 128, 256]",
            "[16, 32]",
            "elements",
        ),
        (
            "any-order-space.toml",
            "[16, 32, 64, 128, 256]",
            "[16, 64, 32]",
            "elements",
        ),
        (
            "any-order-space.toml",
            "tolerance = 0.01",
            "tolerance = 0",
            "tolerance",
        ),
        (
            "any-order-space.toml",
            "0.8*s + 0.2*s^2",
            "0.8*s",
            "run.map",
        ),
        (
            "any-order-time.toml",
            "degree = 3",
            "degree = 3\ntime_degree = 1",
            "time_degree",
        ),
        (
            "any-order-degree.toml",
            "factor = 5.0",
            "factor = 1.0",
            "factor",
        ),
        (
            "any-order-degree.toml",
            "factor = 5.0",
            "tolerance = 0.1",
            "tolerance",
        ),
        (
            "any-order-degree.toml",
            "[run]",
            "[control]\n[run]",
            "control",
        ),
        (
            "any-order-degree.toml",
            "[run]",
            "[control]\na = 0.5\n[run]",
            "control.a",
        ),
        (
            "any-order-degree.toml",
            "[run]",
            "[control]\nepsilon = 0.5\n[run]",
            "control.epsilon",
        ),
    ] {
        let error = refusal(&any_order::AnyOrder::ROW, name, from, to);
        assert!(error.contains(message), "{to}: {error}");
    }
}

#[test]
fn free_vibrations_pass_and_a_wrong_viscosity_fails() {
    passes_but_not_without_each_case(&read("any-order-vibration.toml"));
    for coefficient in ["zeta = 0.10001", "a = 1e-3", "beta = 1e-6"] {
        let planted = format!(
            "{}\n[control]\n{coefficient}\n",
            text("any-order-vibration.toml")
        );
        assert_eq!(
            run_one(&parse(&planted)).verdict,
            Verdict::Fail,
            "{coefficient}"
        );
    }
    for (from, to, message) in [
        ("modes = [1, 2, 5]", "modes = []", "vibration.modes"),
        ("modes = [1, 2, 5]", "modes = [0]", "vibration.modes"),
        ("zeta = 0.1", "zeta = -0.1", "vibration.zeta"),
        ("[vibration]", "[beam]\na = 0.0\n[vibration]", "beam"),
    ] {
        let error = refusal(
            &any_order::AnyOrder::ROW,
            "any-order-vibration.toml",
            from,
            to,
        );
        assert!(error.contains(message), "{to}: {error}");
    }
}
