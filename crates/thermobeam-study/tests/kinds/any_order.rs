//! Laws of studies of orders for the scheme of any order: they pass, and planted defects make them
//! fail.

use convergence_study::{Kind, Verdict, run_one};
use thermobeam_study::kinds::orders::{Orders, any_order};

use super::planted::{Change, verdict_of, verdict_with};
use super::typed::{changed, passes_but_not_without_each_case};
use super::{parsed, read, text};

type AnyOrder = Orders<any_order::AnyOrder>;

/// The study with one or more of its series: those that have one of these lines.
fn with_series(name: &str, lines: &[&str]) -> AnyOrder {
    let text = text(name);
    let (head, rest) = text.split_once("[[series]]").expect("series");
    let is_meant = |series: &&str| lines.iter().any(|line| series.contains(line));
    let series: Vec<&str> = rest.split("[[series]]").filter(is_meant).collect();
    assert_eq!(series.len(), lines.len());
    parsed(&format!("{head}[[series]]{}", series.join("[[series]]")))
}

#[test]
fn orders_in_time_pass_and_planted_errors_fail() {
    // The other two series take most of the time.
    let study = with_series(
        "any-order-time.toml",
        &["time_degree = 2", "time_degree = 3"],
    );
    let sound = passes_but_not_without_each_case(&study);
    // A floor, a wrong order, a lucky run and numbers that are not finite, in each error
    // separately.
    for k in 0..3 {
        let steps = |index: usize| sound[index].case.data.steps as f64;
        let verdict = |change: &dyn Fn(usize, f64) -> f64| {
            verdict_of(&study, &sound, |found| &mut found.named[k].1, change)
        };
        let floor = verdict(&|_, error| error + 1e-4);
        assert_eq!(floor, Verdict::Fail, "a floor under error {k}");
        let slow = verdict(&|index, error| error * steps(index) / 10.0);
        assert_eq!(slow, Verdict::Fail, "one order less in error {k}");
        for index in 0..sound.len() {
            for wrong in [f64::NAN, f64::INFINITY] {
                let verdict = verdict_with(&study, &sound, index, |found| found.named[k].1 = wrong);
                assert_eq!(verdict, Verdict::Fail);
            }
        }
    }
}

#[test]
fn orders_in_space_fail_where_slopes_or_fields_lose_an_order() {
    let study = with_series("any-order-space.toml", &["degree = 3"]);
    let sound = passes_but_not_without_each_case(&study);
    for k in 0..2 {
        for power in [-1.0, 1.0] {
            let of_case = |index: usize| (sound[index].case.data.elements as f64).powf(power);
            let verdict = verdict_of(
                &study,
                &sound,
                |found| &mut found.named[k].1,
                |index, error| error * of_case(index),
            );
            assert_eq!(verdict, Verdict::Fail, "error {k} by an order {power}");
        }
    }
    // Errors inside steps are time errors and are not measured here.
    let mut names = sound
        .iter()
        .flat_map(|ran| &ran.ok().expect("errors").named);
    assert!(names.all(|(name, _)| !name.contains("inside")));
}

#[test]
fn the_fall_over_degrees_must_be_steep_monotone_and_end_in_round_off_from_the_projections() {
    let study: AnyOrder = read("any-order-degree.toml");
    let sound = passes_but_not_without_each_case(&study);
    let verdict =
        |change: Change| verdict_of(&study, &sound, |found| &mut found.named[0].1, change);
    const LAST: usize = 9;
    let defects: [(&str, Change); 4] = [
        ("a floor above round-off", |_, error| error + 1e-11),
        (
            "a bump",
            |index, error| if index == 3 { 1e4 * error } else { error },
        ),
        ("an algebraic fall", |index, _| {
            ((index + 1) as f64).powi(-6)
        }),
        (
            "the end",
            |index, error| if index == LAST { 1e4 * error } else { error },
        ),
    ];
    assert_eq!(sound.len(), LAST + 1);
    assert_eq!(verdict(|_, error| error), Verdict::Pass);
    for (what, defect) in defects {
        assert_eq!(verdict(defect), Verdict::Fail, "{what}");
    }
    // Initial fields that are not the projections.
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
    assert_eq!(run_one(&parsed::<AnyOrder>(&text)).verdict, Verdict::Pass);
    for control in [
        "zeta = 0.10001",
        "a = 0.50005",
        "rho = 2.0002",
        "beta = 0.50005",
        "theta_a = 20.002",
        "epsilon = 0.010001",
    ] {
        let off = text.replace("[run]", &format!("[control]\n{control}\n\n[run]"));
        assert_eq!(
            run_one(&parsed::<AnyOrder>(&off)).verdict,
            Verdict::Fail,
            "{control}"
        );
    }
}

#[test]
fn free_vibrations_pass_and_a_wrong_viscosity_fails() {
    passes_but_not_without_each_case(&read::<AnyOrder>("any-order-vibration.toml"));
    for coefficient in ["zeta = 0.10001", "a = 1e-3", "beta = 1e-6"] {
        let planted = format!(
            "{}\n[control]\n{coefficient}\n",
            text("any-order-vibration.toml")
        );
        assert_eq!(
            run_one(&parsed::<AnyOrder>(&planted)).verdict,
            Verdict::Fail,
            "{coefficient}"
        );
    }
}
