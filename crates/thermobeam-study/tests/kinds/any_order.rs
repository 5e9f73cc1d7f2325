//! Laws of studies of orders for the scheme of any order: they pass, and planted defects make them
//! fail.

use thermobeam_study::kinds::orders::any_order;

use super::*;

type AnyOrder = Orders<any_order::AnyOrder>;

/// The study with one or more of its series: those that have one of these lines.
fn with_series(name: &str, lines: &[&str]) -> Sound<AnyOrder> {
    let text = text(name);
    let (head, rest) = text.split_once("[[series]]").expect("series");
    let is_meant = |series: &&str| lines.iter().any(|line| series.contains(line));
    let series: Vec<&str> = rest.split("[[series]]").filter(is_meant).collect();
    assert_eq!(series.len(), lines.len());
    Sound::checked(parsed(&format!(
        "{head}[[series]]{}",
        series.join("[[series]]")
    )))
}

#[test]
fn orders_in_time_pass_and_planted_errors_fail() {
    // The other two series take most of the time.
    let lines = ["time_degree = 2", "time_degree = 3"];
    let sound = with_series("any-order-time.toml", &lines);
    // A floor, a wrong order, a lucky run and numbers that are not finite, in each error
    // separately.
    for k in 0..3 {
        let steps = |index: usize| sound.runs[index].case.data.steps as f64;
        let verdict = |change: &dyn Fn(usize, f64) -> f64| {
            sound.verdict_of(|found| &mut found.named[k].1, change)
        };
        let floor = verdict(&|_, error| error + 1e-4);
        assert_eq!(floor, Verdict::Fail, "a floor under error {k}");
        let slow = verdict(&|index, error| error * steps(index) / 10.0);
        assert_eq!(slow, Verdict::Fail, "one order less in error {k}");
        for index in 0..sound.runs.len() {
            for wrong in [f64::NAN, f64::INFINITY] {
                let outcome = sound.at(index, |found| found.named[k].1 = wrong);
                assert_eq!(outcome.verdict, Verdict::Fail, "{wrong} in error {k}");
            }
        }
    }
}

#[test]
fn orders_in_space_fail_where_slopes_or_fields_lose_an_order() {
    let sound = with_series("any-order-space.toml", &["degree = 3"]);
    for k in 0..2 {
        for power in [-1, 1] {
            let elements = |index: usize| sound.runs[index].case.data.elements as f64;
            let verdict = sound.verdict_of(
                |found| &mut found.named[k].1,
                |index, error| error * elements(index).powi(power),
            );
            assert_eq!(verdict, Verdict::Fail, "error {k} by an order {power}");
        }
    }
    // Errors inside steps are time errors and are not measured here.
    let mut runs = (0..sound.runs.len()).flat_map(|index| &sound.found(index).named);
    assert!(runs.all(|(name, _)| !name.contains("inside")));
}

#[test]
fn the_fall_over_degrees_must_be_steep_monotone_and_end_in_round_off_from_the_projections() {
    const LAST: usize = 9;
    let sound = Sound::checked(read::<AnyOrder>("any-order-degree.toml"));
    assert_eq!(sound.runs.len(), LAST + 1);
    let defects: Named<fn(usize, f64) -> f64, 5> = [
        ("a small solution, of any law", |_, error| 1e-7 * error),
        ("a floor above round-off", |_, error| error + 1e-11),
        ("a bump", |k, error| error * if k == 3 { 1e4 } else { 1.0 }),
        ("an algebraic fall", |k, _| ((k + 1) as f64).powi(-6)),
        ("the end", |k, error| {
            error * if k == LAST { 1e4 } else { 1.0 }
        }),
    ];
    for (what, defect) in defects {
        let verdict = sound.verdict_of(|found| &mut found.named[0].1, defect);
        assert_eq!(verdict, Verdict::Fail, "{what}");
    }
    // Initial fields that are not the projections.
    for start in [2e-11, f64::NAN] {
        let wrong = sound.with(|k, found| found.start = if k == 3 { start } else { 0.0 });
        assert_eq!(wrong.verdict, Verdict::Fail, "{start}");
    }
}
