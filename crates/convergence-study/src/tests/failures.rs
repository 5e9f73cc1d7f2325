//! What did not pass: one list, printed by terminal, Markdown, page, JUnit and JSON.

use crate::{
    Finished, NamedRate, Prose, Verdict, judge_pairs,
    report::{tables, text_of_failures},
    run::{Item, advice, items_not_passed, not_passed},
    study::over_levels,
};
use roxmltree::Document;

use super::fake::{Does, finished, passing, says, study};
use super::report::{compared, file, junit_of, readme, several, with};
use super::tables_of_errors::judged;

#[test]
fn junit_has_a_failure_for_everything_that_does_not_pass() {
    let studies = several();
    let text = with(&studies, junit_of);
    let document = Document::parse(&text).unwrap();
    let suites: Vec<_> = document
        .root_element()
        .children()
        .filter(|node| node.is_element())
        .collect();
    let failures: Vec<&str> = suites
        .iter()
        .map(|suite| suite.attribute("failures").unwrap())
        .collect();
    assert_eq!(failures, ["0", "1", "1", "1", "1", "9"]);
    assert_eq!(document.root_element().attribute("failures"), Some("13"));
    let types: Vec<&str> = document
        .descendants()
        .filter(|node| node.has_tag_name("failure"))
        .map(|failure| {
            assert!(!failure.attribute("message").unwrap().is_empty());
            failure.attribute("type").unwrap()
        })
        .collect();
    assert_eq!(
        types,
        [
            &["fail", "inconclusive", "inconclusive", "fail"][..],
            &["fail"; 9]
        ]
        .concat()
    );
    assert!(!text.contains("time"), "times vary: {text}");
}

#[test]
fn texts_are_escaped_in_xml_and_markdown() {
    let mut studies = several();
    studies[1].outcome.checks[0].evidence = "a < b & \"c\" \u{1b}[31m | ]]>\nnext".into();
    studies[1].outcome.checks[0].verdict = Verdict::Fail;
    let text = compared(&studies, None, junit_of);
    let document = Document::parse(&text).unwrap();
    let message = document
        .descendants()
        .filter_map(|node| node.attribute("message"))
        .find(|text| text.contains("a < b"));
    assert!(message.is_some(), "{text}");
    let page = with(&studies, readme);
    says(&page, "a < b & \"c\"  \\[31m \\| \\]\\]> next");
}

#[test]
fn a_reason_is_given_where_a_rate_does_not_hold() {
    let studies = finished(vec![passing("good"), study("bad", Does::Stay)]);
    let heads: Vec<bool> = studies
        .iter()
        .map(|finished| tables(finished)[0].head.contains(&"reason".to_owned()))
        .collect();
    assert_eq!(heads, [false, true]);
    assert_eq!(
        tables(&studies[1])[0].rows[0].last().unwrap(),
        "the error does not fall on the finest refinement"
    );
    let rates = &tables(&studies[0])[0];
    assert_eq!(rates.head.len(), rates.rows[0].len());
    assert_eq!(rates.rows[0][1..3], ["1 ± 0.1", "1.0000"]);
    assert_eq!(rates.rows[0][5], "1-5 of 5");
}

#[test]
fn where_a_study_fails_the_report_says_that_nothing_is_blessed() {
    let studies = finished(vec![study("a", Does::Stay)]);
    let page = with(&studies, readme);
    let said = "\n\n`--bless` refuses until the studies that did not pass are mended.\n\n";
    assert!(
        page.contains(said) && !page.contains("If it is meant"),
        "{page}"
    );
}

#[test]
fn a_study_that_fails_for_another_ones_sake_comes_after_it() {
    let mut studies = finished(vec![
        passing("a-controls"),
        study("b", Does::TooShort),
        study("c-1.0", Does::Stay),
    ]);
    let order = |studies: &[Finished]| {
        not_passed(studies)
            .into_iter()
            .map(|study| study.header.id.clone())
            .collect::<Vec<_>>()
    };
    studies[0].outcome.verdict = Verdict::Fail;
    studies[0].outcome.checks[0].verdict = Verdict::Fail;
    for (about, expected) in [
        (Some("c-1.0"), ["c-1.0", "b", "a-controls"]),
        // Neither itself nor a study that passes is a cause.
        (Some("a-controls"), ["a-controls", "c-1.0", "b"]),
        (Some("d"), ["a-controls", "c-1.0", "b"]),
        (None, ["a-controls", "c-1.0", "b"]),
    ] {
        let check = &mut studies[0].outcome.checks[0];
        check.subject.case = about.map(str::to_owned);
        assert_eq!(order(&studies), expected, "{about:?}");
    }
}

#[test]
fn rates_that_fail_alike_are_one_sentence_and_each_has_its_line() {
    let mut finished = judged(&[("L2", 1.0), ("H1", 1.001), ("L1", 3.0)], |_, _| false);
    let steps = || (0..5).map(|level| 0.5_f64.powi(level + 3));
    for (NamedRate { rate, .. }, order) in finished.outcome.rates.iter_mut().zip([1.0, 1.001, 3.0])
    {
        *rate = judge_pairs(steps().map(|h| (h, h.powf(order))), 2.0, 0.01);
    }
    finished.outcome.verdict = Verdict::Fail;
    finished.outcome.summary = over_levels::summary(&finished.outcome.rates).into();
    finished.outcome.after_rates = Some(Prose::default());
    let studies = [finished];
    let together = "2 of 3 rates too low: 1.0000 to 1.0010, claimed 2 ± 0.01; L1: 3.0000 ± 0.00005, claimed 2 ± 0.01: too high";
    let page = with(&studies, |findings| file(findings, "index.html"));
    says(&page, &format!("<p>{together}</p>"));
    let page = with(&studies, readme);
    says(
        &page,
        "\n  - L2: 1.0000 ± 0.00005, claimed 2 ± 0.01: too low (too-low)\n",
    );
}

#[test]
fn a_claim_without_a_rate_and_an_order_with_many_digits_are_short() {
    let mut finished = judged(&[("L2", 1.0)], |_, _| false);
    let steps = (0..6).map(|level| 0.5_f64.powi(level + 3));
    finished.outcome.rates[0].rate = judge_pairs(steps.map(|h| (h, f64::NAN)), 2.0 / 3.0, 0.02);
    finished.outcome.verdict = Verdict::Fail;
    let studies = [finished];
    let failing = not_passed(&studies).remove(0);
    let advice = advice(failing);
    let reasons = items_not_passed(failing).into_iter();
    let reasons: Vec<String> = reasons.map(|item| item.line).collect();
    assert_eq!(
        reasons[0],
        "L2: no rate, claimed 0.6667 ± 0.02: an error is NaN or infinite (non-finite)"
    );
    assert!(
        reasons.len() == 1 && advice.len() == 1 && advice[0].starts_with("non-finite: "),
        "{reasons:?}, {advice:?}"
    );
}

/// Studies of which cases, rates, checks and a whole study do not pass.
fn failing_in_every_way() -> Vec<Finished> {
    let mut studies = finished(vec![
        study("cases", Does::Fail),
        study("rates", Does::TooShort),
        passing("checks"),
        study("whole", Does::Nothing),
        passing("none"),
    ]);
    let checks = &mut studies[2].outcome;
    checks.verdict = Verdict::Fail;
    checks.checks[0].verdict = Verdict::Fail;
    studies
}

/// The text of an item as a reader sees it in Markdown, XML or on a page.
fn letters(text: &str) -> String {
    text.chars().filter(|c| c.is_alphanumeric()).collect()
}

const TITLE: &str = "What did not pass";

/// The part of a text after its first `start`, up to `end`.
fn between<'t>(text: &'t str, start: &str, end: &str) -> &'t str {
    let (_, rest) = text.split_once(start).expect(start);
    rest.split_once(end).expect(end).0
}

/// The list at the head of the page, as a document of its own.
fn page_list(page: &str) -> String {
    let list = between(page, &format!("<h2>{TITLE}</h2>"), "<h2");
    format!("<div>{list}</div>")
}

/// All text and attributes of a document.
fn text_of(document: &str) -> String {
    let document = Document::parse(document).unwrap();
    let mut all = String::new();
    for node in document.descendants() {
        all += node.text().unwrap_or_default();
        for attribute in node.attributes() {
            all += attribute.value();
        }
    }
    all
}

#[test]
fn every_output_has_every_item_that_did_not_pass() {
    let studies = failing_in_every_way();
    let list = not_passed(&studies);
    let ids: Vec<&str> = list.iter().map(|study| &*study.header.id).collect();
    assert_eq!(ids, ["cases", "checks", "rates", "whole"]);
    let items: Vec<Item> = list
        .iter()
        .flat_map(|study| items_not_passed(study))
        .collect();
    for name in [
        "case n = 16",
        "velocity: order 1",
        "|error| < 10",
        "verdict",
    ] {
        assert!(
            items.iter().any(|item| item.name == name),
            "{name}: {items:?}"
        );
    }
    let outputs = with(&studies, |findings| {
        let record = findings.record;
        [
            ("terminal", text_of_failures(&record.studies, None)),
            (
                "Markdown",
                between(&readme(findings), TITLE, "\n## ").to_owned(),
            ),
            ("page", text_of(&page_list(&file(findings, "index.html")))),
            ("JUnit", text_of(&junit_of(findings))),
            ("JSON", serde_json::to_string(record).unwrap()),
        ]
        .map(|(name, text)| (name, letters(&text)))
    });
    for item in &items {
        for (name, text) in &outputs {
            assert!(text.contains(&letters(&item.why)), "{name}: {}", item.line);
        }
    }
}

#[test]
fn the_list_in_a_record_has_names_reasons_codes_and_advice() {
    let studies = failing_in_every_way();
    let written: Vec<serde_json::Value> = studies
        .iter()
        .map(|study| serde_json::to_value(study).unwrap())
        .collect();
    for (study, written) in studies.iter().zip(&written) {
        let items = items_not_passed(study);
        let list = written.get("not_passed").and_then(|list| list.as_array());
        assert_eq!(list.map_or(0, Vec::len), items.len(), "{written}");
        for (item, written) in items.iter().zip(list.into_iter().flatten()) {
            assert_eq!(written["item"], item.name);
            assert_eq!(written["verdict"], item.verdict.name());
            assert_eq!(written["why"], item.why);
            assert_eq!(
                written.get("code").and_then(|code| code.as_str()),
                item.code
            );
            assert_eq!(written.get("advice").is_some(), item.advice.is_some());
        }
        let read: Finished = serde_json::from_value(written.clone()).unwrap();
        assert_eq!(items_not_passed(&read), items);
    }
    assert!(written[4].get("not_passed").is_none());
    assert_eq!(written[1]["not_passed"][0]["code"], "levels");
}
