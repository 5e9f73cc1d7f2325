//! Laws of the cost of an error by the scheme of any order beside `midpoint`.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::{FromFile, Kind, run_here};
use thermobeam_study::kinds::any_order_cost::{AnyOrderCost, ROW, Way};

use crate::refused::refusal;
use crate::typed::{changed, passes_but_not_without_each_case, report};
use crate::{file, text};

/// The study with half of midpoint's runs: the finest take seconds here.
fn study(change: impl Fn(String) -> String) -> AnyOrderCost {
    let small = text("any-order-cost.toml").replace(", [500, 4000], [1000, 8000]", "");
    AnyOrderCost::parse(&change(small), &file("small.toml")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_thousandth_of_the_cost_and_planted_defects_fail() {
    let study = study(|text| text);
    let sound = passes_but_not_without_each_case(&study);
    let outcome = study.judge(&sound);
    assert!(report(&outcome).contains("extrapolated along error x cost"), "{}", report(&outcome));
    let midpoint = |index: usize| matches!(sound[index].case.data, Way::Midpoint(..));
    for (what, error, work) in [("inaccurate", 100.0, 1.0), ("dear", 1.0, 10.0), ("not finite", f64::NAN, 1.0)] {
        let planted = changed::<AnyOrderCost>(&sound, |index, found| {
            if !midpoint(index) {
                (found.error, found.work) = (found.error * error, found.work * work);
            }
        });
        assert_eq!(study.judge(&planted).verdict, Verdict::Fail, "dG(q) {what}");
    }
    // Twice the error in the coarser run is a fall of eight, in the finer one a fall of two.
    let coarsest = (0..sound.len()).find(|&index| midpoint(index)).expect("midpoint");
    for worse in [coarsest, coarsest + 1] {
        let planted = changed::<AnyOrderCost>(&sound, |index, found| {
            found.error *= if index == worse { 2.0 } else { 1.0 };
        });
        assert_eq!(study.judge(&planted).verdict, Verdict::Fail, "no second order");
    }
}

#[test]
fn the_figure_leaves_out_a_run_that_another_beats() {
    let study = study(|text| text);
    let sound = passes_but_not_without_each_case(&study);
    let points = |ran: &[_]| {
        let svg = study.judge(ran).figures.remove(0).svg;
        let line = svg.lines().find(|line| line.contains("data-series=\"dG(q)\"")).expect("a line").to_owned();
        line.split("data-points=").nth(1).expect("points").split_whitespace().count()
    };
    let before = points(&sound);
    // The cheapest run, whose error is the largest, is no better than the others are.
    let beaten = changed::<AnyOrderCost>(&sound, |index, found| found.work *= if index == 0 { 1e3 } else { 1.0 });
    assert_eq!(points(&beaten), before - 1);
}

#[test]
fn a_claim_that_is_too_bold_fails() {
    for (from, to) in [("times = 1000", "times = 100000"), ("error = 1e-8", "error = 1e-15")] {
        assert_eq!(run_here(&study(|text| text.replace(from, to))).verdict, Verdict::Fail, "{to}");
    }
}

#[test]
fn files_with_errors_are_refused_with_the_field() {
    for (from, to) in [
        ("error = 1e-8", "error = 0"),
        ("times = 1000", "times = -1"),
        ("t_end = 1.0", "t_end = 0"),
        ("[10, 1, 0.02]", "[10, 1]"),
        ("[10, 1, 0.02]", "[10, 6, 0.02]"),
        ("[250, 2000]", "[250, 1000]"),
        ("[125, 1000]", "[125, 1001]"),
    ] {
        let error = refusal(&ROW, "any-order-cost.toml", from, to);
        let field = from.split(" =").next().filter(|field| !field.starts_with('['));
        assert!(error.contains(&format!("any-order-cost.{}", field.unwrap_or(""))), "{to}: {error}");
    }
}
