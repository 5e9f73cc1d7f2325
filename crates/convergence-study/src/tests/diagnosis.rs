//! Which settings a diagnosis names, and its words.

use serde_json::{Value, json};

use super::fake::{converging, finished, says};
use crate::report::text_of_diagnosis;
use crate::store::GuardedChange;
use crate::store::diagnosis::diagnose;
use crate::{Case, Check, Finished, Header, Outcome, Subject};

/// A study that has run, with these cases and these checks.
fn study(id: &str, cases: &[(&str, Value)], checks: Vec<Check>) -> Finished {
    let mut study = finished(vec![converging("").erased()]).remove(0);
    let case = |(label, value): &(&str, Value)| Case::new(*label, 1.0, ()).described(value);
    study.header = Header::new(id, "c");
    study.header.cases = cases.iter().map(case).collect();
    study.outcome = Outcome::new("", vec![], checks);
    study
}

/// A check of a quantity of a case.
fn check(case: &str, quantity: &str, holds: bool) -> Check {
    Check::that(holds, "c", "").about(Subject::of(quantity).in_case(case))
}

/// A study of one case.
fn alone(id: &str, value: Value, holds: bool) -> Finished {
    study(id, &[("run", value)], vec![check("run", "u", holds)])
}

/// As many studies as it takes to see that cases pass without a setting.
fn passing(value: &Value) -> Vec<Finished> {
    let ids = ["p1", "p2", "p3", "p4", "p5"];
    ids.map(|id| alone(id, value.clone(), true)).into()
}

/// What is named of studies with these outcomes.
fn named(studies: Vec<Finished>) -> Vec<String> {
    let found = diagnose(&studies, &[]).expect("a check fails");
    assert_eq!(text_of_diagnosis(&found).is_empty(), found.shared.is_none());
    let settings = found.shared.map_or(vec![], |shared| shared.settings);
    settings.into_iter().map(|(_, words)| words).collect()
}

fn by(method: &str) -> Value {
    json!({ "method": method, "heat": { "rate": 2.0 } })
}

#[test]
fn what_all_failing_cases_have_is_named_if_cases_without_it_pass() {
    let fail = |one: &str, two: &str| {
        let [a, b] = [("a", one), ("b", two)].map(|(id, method)| alone(id, by(method), false));
        [vec![a, b], passing(&by("dg"))].concat()
    };
    assert_eq!(named(fail("midpoint", "midpoint")), ["method midpoint"]);
    // Not all have the method; and the heat, which all have, passing ones have too.
    assert_eq!(named(fail("midpoint", "dg")), [""; 0]);
    let [a, b] = ["a", "b"].map(|id| alone(id, by("midpoint"), false));
    assert_eq!(named(vec![a, b]), [""; 0], "nothing passes without it");
}

#[test]
fn what_a_single_study_shows_is_not_named() {
    let cases = [("1", by("midpoint")), ("2", by("midpoint"))];
    let checks = ["1", "2"].map(|case| check(case, "u", false)).into();
    let one = vec![study("a", &cases, checks)];
    assert_eq!(named([one, passing(&by("dg"))].concat()), [""; 0]);
}

/// A case may be blind to a mistake: that it passes with the setting counts, and decides nothing.
#[test]
fn cases_that_pass_with_a_setting_count_against_it() {
    let with = |failing: usize, blind: usize| {
        let studies = |name: &str, count: usize, holds| -> Vec<Finished> {
            let ids = (0..count).map(|k| format!("{name}{k}"));
            ids.map(|id| alone(&id, by("midpoint"), holds)).collect()
        };
        let midpoint = [studies("f", failing, false), studies("b", blind, true)];
        named([midpoint.concat(), passing(&by("dg"))].concat())
    };
    assert_eq!(with(4, 1), ["method midpoint"]);
    assert_eq!(with(4, 9), [""; 0]);
}

#[test]
fn cases_must_be_alike_but_for_the_setting() {
    let value = |method: &str, rate: f64| json!({ "method": method, "heat": { "rate": rate } });
    let failing = || ["a", "b"].map(|id| alone(id, value("midpoint", 1.0), false));
    let others = |value: &Value| [failing().to_vec(), passing(value)].concat();
    assert_eq!(named(others(&value("midpoint", 0.0))), ["heat.rate ≠ 0"]);
    // Either may be the reason why these pass.
    assert_eq!(named(others(&value("dg", 0.0))), [""; 0]);
    // A part that is missing lacks what is below it, too.
    let without = json!({ "method": "midpoint", "heat": null });
    assert_eq!(named(others(&without)), ["heat"]);
}

/// `n = 4` is each case with that part of its label; the runs of a ratio fail together.
#[test]
fn an_item_of_several_cases_blames_what_they_share() {
    let cases = [
        ("one, n = 4", by("midpoint")),
        ("two, n = 4", by("dg")),
        ("two, n = 8", by("dg")),
    ];
    let failing = |id: &str, checks: Vec<Check>| study(id, &cases, checks);
    let all = |checks: fn() -> Vec<Check>| {
        let failing = ["a", "b"].map(|id| failing(id, checks()));
        [
            failing.to_vec(),
            passing(&json!({ "method": "midpoint", "heat": null })),
        ]
        .concat()
    };
    assert_eq!(named(all(|| vec![check("n = 8", "u", false)])), [""; 0]);
    assert_eq!(named(all(|| vec![check("n = 4", "u", false)])), ["heat"]);
    let ratio = || {
        let subject = Subject::of("work").in_case("one").against("two");
        vec![Check::that(false, "c", "").about(subject)]
    };
    assert_eq!(named(all(ratio)), ["heat"]);
}

#[test]
fn a_quantity_is_named_where_it_alone_fails() {
    let value = by("midpoint");
    let cases = [("run", value.clone())];
    let failing = |others: bool| {
        let checks = || vec![check("run", "u", false), check("run", "v", others)];
        ["a", "b"].map(|id| study(id, &cases, checks())).to_vec()
    };
    assert_eq!(named(failing(true)), ["quantity u"]);
    assert_eq!(named(failing(false)), [""; 0]);
    assert_eq!(named(failing(true)[..1].to_vec()), [""; 0]);
}

/// Cases that say nothing of themselves have the values of their file.
#[test]
fn the_values_of_a_file_are_settings_of_its_cases() {
    let study = |id: &str, rate: &str, holds: bool| {
        let mut study = study(id, &[], vec![check("run", "u", holds)]);
        for (path, value) in [
            ("heat.rate", rate),
            ("command", "[\"./solve\", \"--implicit\"]"),
        ] {
            let setting = (path.to_owned(), value.to_owned());
            study.header.settings.push(setting);
        }
        study
    };
    let fail = ["a", "b"].map(|id| study(id, "0.5", false));
    let pass = ["c", "d", "e", "f", "g"].map(|id| study(id, "0", true));
    assert_eq!(named([&fail[..], &pass[..]].concat()), ["heat.rate ≠ 0"]);
    // They say nothing beside cases that speak for themselves.
    let described = ["h", "i"].map(|id| alone(id, by("midpoint"), false));
    let pass = passing(&by("dg"));
    let all = [&fail[..], &described[..], &pass[..]].concat();
    assert_eq!(named(all), ["method midpoint"]);
}

#[test]
fn numbers_that_moved_are_failing_cases() {
    let studies = ["a", "b"].map(|id| converging(id).erased());
    let ran = finished(studies.into());
    let changes = ["a", "b"].map(|id| GuardedChange::moved(id, "finest error", [2.0, 3.0]));
    let found = diagnose(&ran, &changes).expect("numbers moved");
    let shared = found.shared.expect("both are of one quantity");
    assert_eq!((shared.cases, shared.studies), (2, 2));
    assert_eq!(diagnose(&ran, &[]), None);
    let one = diagnose(&ran, &changes[..1]).expect("a number moved");
    assert_eq!(one.lines(), []);
}

#[test]
fn a_change_is_said_in_per_cent_or_in_numbers_that_differ() {
    for (from, to, words) in [
        (1.0, 8.0, "by +700 %"),
        (1.0, 0.99, "by -1 %"),
        (-1.0, -0.999, "by +0.1 %"),
    ] {
        let words_of = GuardedChange::moved("s", "loss", [from, to]).to_string();
        says(&words_of, words);
        assert!(!words_of.contains("-0.000"), "{words_of}");
    }
}
