use std::collections::BTreeSet;

use crate::{
    Figure, Finished, Front, Project, Statement, Tier, Verdict,
    chart::{Axis, Chart},
    report::{Findings, SeeAlso},
    store::Record,
};
use roxmltree::{Document, Node};

use super::fake::{Does, PROJECT, finished, passing, says, study};
use super::report::{compared, file, readme};

pub(crate) fn page_of(finished: &[Finished]) -> String {
    let see_also = Some(SeeAlso {
        tier: "full",
        folder: "full",
        has_page: true,
    });
    compared(finished, Some(&[]), |findings| {
        let findings = Findings {
            see_also,
            ..*findings
        };
        file(&findings, "index.html")
    })
}

/// One study that passes and one that fails, each with a picture of two curves.
pub(crate) fn two() -> Vec<Finished> {
    let mut both = finished(vec![passing("good-1.0"), study("bad", Does::Stay)]);
    for finished in &mut both {
        let mut chart = Chart::empty(Axis::log("mesh width h"), Axis::log("error"));
        for (label, order) in [("a<b", 1), ("c", 2)] {
            let errors = (3..8).map(|k| (0.5_f64.powi(k), 0.5_f64.powi(order * k)));
            let curve = chart.curve(label, errors);
            *curve = curve.clone().marked();
        }
        let name = format!("{}-errors", finished.header.id);
        finished.outcome.figures = vec![Figure::of(&name, "Two curves", chart)];
    }
    both
}

/// The page without its scripts, which are not XML.
fn parsed<T>(page: &str, read: impl FnOnce(&Document<'_>) -> T) -> T {
    let mut rest = page.strip_prefix("<!DOCTYPE html>\n").expect("a doctype");
    let mut text = String::new();
    while let Some((before, after)) = rest.split_once("<script>") {
        text += before;
        rest = after.split_once("</script>").expect("an end").1;
    }
    text += rest;
    read(&Document::parse(&text).unwrap_or_else(|error| panic!("{error} in\n{text}")))
}

fn named<'d>(document: &'d Document<'d>, name: &'d str) -> impl Iterator<Item = Node<'d, 'd>> {
    document
        .descendants()
        .filter(move |node| node.tag_name().name() == name)
}

fn with_class<'d>(
    document: &'d Document<'d>,
    class: &'d str,
) -> impl Iterator<Item = Node<'d, 'd>> {
    document
        .descendants()
        .filter(move |node| node.attribute("class") == Some(class))
}

#[test]
fn every_study_and_every_picture_is_there_and_can_be_linked_to() {
    parsed(&page_of(&two()), |document| {
        let studies: Vec<_> = with_class(document, "study").collect();
        assert_eq!(
            studies
                .iter()
                .map(|study| study.attribute("id").unwrap())
                .collect::<Vec<_>>(),
            ["bad", "good-1.0"]
        );
        for study in &studies {
            let pictures = study
                .descendants()
                .filter(|node| node.attribute("data-plot").is_some())
                .count();
            assert_eq!(pictures, 1);
            assert!(
                study
                    .descendants()
                    .any(|node| node.tag_name().name() == "table")
            );
        }
        let ids: Vec<&str> = document
            .descendants()
            .filter_map(|node| node.attribute("id"))
            .collect();
        assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len());
        let links: Vec<&str> = named(document, "a")
            .filter_map(|link| link.attribute("href"))
            .collect();
        // Failures come first.
        assert_eq!(links, ["#bad", "full/index.html", "#bad", "#good-1.0"]);
    });
}

#[test]
fn studies_that_do_not_pass_head_the_list_and_the_details_follow_its_order() {
    let mut studies = finished(
        [
            ("a", Does::Converge),
            ("b", Does::TooShort),
            ("c", Does::Converge),
            ("d", Does::Stay),
        ]
        .map(|(id, does)| study(id, does))
        .into(),
    );
    for (finished, group) in studies.iter_mut().zip(["time", "time", "space", "space"]) {
        finished.header.group = group.to_owned();
    }
    parsed(&page_of(&studies), |document| {
        let body = named(document, "tbody")
            .find(|body| body.children().any(|row| row.has_attribute("data-study")));
        let rows = body.unwrap().children().filter(Node::is_element);
        let label = |row: Node<'_, '_>| {
            row.attribute("data-study")
                .unwrap_or_else(|| row.first_child().unwrap().text().unwrap())
                .to_owned()
        };
        assert_eq!(
            rows.map(label).collect::<Vec<_>>(),
            ["did not pass", "d", "b", "time", "a", "space", "c"]
        );
        let details: Vec<_> = with_class(document, "study")
            .map(|study| study.attribute("id").unwrap())
            .collect();
        assert_eq!(details, ["d", "b", "a", "c"]);
    });
}

/// A text has these parts in this order.
#[track_caller]
fn in_order(text: &str, parts: &[&str]) {
    let places: Vec<Option<usize>> = parts.iter().map(|part| text.find(part)).collect();
    let is_whole = places.iter().all(Option::is_some);
    assert!(
        is_whole && places.is_sorted(),
        "{parts:?}, {places:?}: {text}"
    );
}

#[test]
fn what_wrote_the_page_is_said_below_what_failed_and_one_picture_is_wide() {
    let page = page_of(&two());
    in_order(
        &page,
        &["What did not pass", "Written by", "class=\"scroll wide\""],
    );
    assert_eq!(page.matches("class=\"scroll wide\"").count(), 1);
}

#[test]
fn verdicts_come_first_with_the_badges_of_what_failed() {
    let page = page_of(&two());
    in_order(&page, &["class=\"overview\"", "class=\"study\""]);
    parsed(&page, |document| {
        assert_eq!(with_class(document, "badge fail").count(), 4);
    });
}

#[test]
fn of_many_studies_that_fail_three_are_unfolded_and_so_is_the_only_one() {
    let five = (0..5).map(|k| study(&format!("s{k}"), Does::Stay));
    for (studies, open) in [
        (
            finished(five.collect()),
            &[true, true, true, false, false][..],
        ),
        (finished(vec![passing("a")]), &[true]),
        (two(), &[true, false]),
    ] {
        parsed(&page_of(&studies), |document| {
            let studies = with_class(document, "study");
            let found: Vec<bool> = studies.map(|study| study.has_attribute("open")).collect();
            assert_eq!(found, open);
        });
    }
}

const fn statement(text: &'static str, study: &'static str, rate: &'static str) -> Statement {
    Statement { text, study, rate }
}

#[test]
fn a_run_that_passes_begins_with_what_is_verified_and_the_numbers_of_its_record() {
    let front = Front {
        subject: "A rod.",
        picture: "a-errors.svg",
        finding: "It is not as printed.",
        statements: const {
            &[
                statement("First order", "a", "velocity"),
                statement("All checks", "a", ""),
                statement("Elsewhere", "gone", ""),
            ]
        },
        plot: "a-errors.svg",
        verified: "Errors fall.",
    };
    let project = Project { front, ..PROJECT };
    let page = |does: Does, verdict: Verdict| {
        let studies = finished(vec![study("a", does)]);
        let record = Record::new("quick", "verify", verdict, None, studies);
        readme(&Findings::of(&project, &record))
    };
    let passing = page(Does::Converge, Verdict::Pass);
    let parts = [
        "![A rod.](figures/a-errors.svg)",
        "It is not as printed.",
        "**First order",
        "![errors \\| h](figures/a-errors.svg)",
        "Errors fall.",
        "## All studies",
    ];
    in_order(&passing, &parts);
    assert!(
        passing.contains(": rate 1.0000 ± 0.00005, claimed 1 ± 0.1 (a)")
            && !passing.contains("Elsewhere"),
        "{passing}"
    );
    // The list of all studies does not repeat an answer.
    let answer = passing.split("**All checks**: ").nth(1);
    let answer = answer.and_then(|rest| rest.split(" (a)").next()).unwrap();
    assert!(!answer.is_empty(), "{passing}");
    assert_eq!(passing.matches(answer).count(), 1, "{passing}");
    assert!(!page(Does::Stay, Verdict::Fail).contains("What is verified"));
}

/// What the report on the quick tier has is not repeated in that on the full one.
#[test]
fn the_full_tier_lists_its_own_studies_and_those_that_do_not_pass() {
    let mut studies = finished(vec![
        passing("quick"),
        study("broken", Does::Stay),
        passing("full"),
    ]);
    studies[2].header.tier = Tier::Full;
    let text = |has_quick: bool| {
        let record = Record::new("full", "verify", Verdict::Fail, None, studies.clone());
        let quick = SeeAlso {
            tier: "quick",
            folder: "..",
            has_page: false,
        };
        readme(&Findings {
            see_also: has_quick.then_some(quick),
            ..Findings::of(&PROJECT, &record)
        })
    };
    let lists = |text: &str| {
        ["quick", "broken", "full"].map(|id| {
            let line = text.contains(&format!("** {id}: "));
            assert_eq!(line, text.contains(&format!("\n|{id}|")), "{id}");
            line
        })
    };
    let rest = text(true);
    assert_eq!(lists(&rest), [false, true, true]);
    says(&rest, "are in [its report](../README.md)");
    let alone = text(false);
    assert_eq!(lists(&alone), [true, true, true]);
    assert!(!alone.contains("../README.md"), "{alone}");
}

#[test]
fn the_page_loads_nothing_and_escapes_hostile_texts() {
    let hostile = "``` <script>alert(1)</script> ` ``\"><img src=http://x/y onerror=z> [a](javascript:b) ![c](//d) ]]> &amp;";
    let mut studies = two();
    for finished in &mut studies {
        finished.header.claim = hostile.to_owned();
        finished.outcome.summary = hostile.into();
        finished.outcome.checks[0].evidence = hostile.into();
        finished.outcome.tables[0].title = hostile.to_owned();
        finished.outcome.tables[0].rows = vec![vec![hostile.to_owned()]; 40];
        finished.outcome.figures[0].caption = hostile.to_owned();
    }
    let page = page_of(&studies);
    assert_eq!(page.matches("<script").count(), 3, "the page's own");
    assert!(page.contains("default-src 'none'"));
    parsed(&page, |document| {
        assert_eq!(
            named(document, "img")
                .chain(named(document, "iframe"))
                .chain(named(document, "object"))
                .count(),
            0
        );
        for node in document.descendants() {
            for attribute in node.attributes() {
                let (name, value) = (attribute.name(), attribute.value());
                assert!(!name.starts_with("on") && name != "src", "{name}");
                let stays =
                    value == "data:," || value.starts_with('#') || value == "full/index.html";
                assert!(name != "href" || stays, "{value}");
            }
        }
        // Claim twice, summary, evidence, title, caption under the picture, and forty rows.
        let shown = document
            .descendants()
            .filter(|node| node.is_element() && node.text().is_some());
        let text: String = shown
            .flat_map(|node| node.children())
            .filter_map(|node| node.text())
            .collect();
        assert!(
            text.matches("<script>alert(1)</script>").count() >= 2 * (6 + 40),
            "{text}"
        );
    });
}

#[test]
fn a_long_table_is_folded_and_unfolded_where_the_study_does_not_pass() {
    let mut studies = two();
    for finished in &mut studies {
        finished.outcome.tables[0].rows = vec![vec!["cell".to_owned()]; 40];
    }
    parsed(&page_of(&studies), |document| {
        let folded = named(document, "details").filter(|node| node.attribute("class").is_none());
        let open: Vec<bool> = folded.map(|node| node.has_attribute("open")).collect();
        assert_eq!(open, [true, false]);
    });
}
