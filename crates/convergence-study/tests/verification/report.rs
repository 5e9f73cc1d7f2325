use convergence_study::judge::verdict::{Verdict, judge_pairs};
use convergence_study::report::{Findings, LONGEST, sentence, tables};
use convergence_study::run::{Finished, Item, not_passed};
use convergence_study::store::{Baseline, Change, Movement, Record, junit};
use convergence_study::study::levels;
use convergence_study::study::outcome::{LevelErrors, Table};
use roxmltree::Document;

use super::fake::{Does, PROJECT, finished, study};

fn several() -> Vec<Finished> {
    let does = [
        Does::Converge,
        Does::Panic,
        Does::TooShort,
        Does::Nothing,
        Does::PanicAtTheEnd,
    ];
    finished(
        does.iter()
            .enumerate()
            .map(|(i, does)| study(&format!("study-{i}.0"), *does))
            .collect(),
    )
}

fn with<T>(finished: &[Finished], read: impl FnOnce(&Findings<'_>) -> T) -> T {
    compared(
        finished,
        Some(&Baseline::default().compare(finished, None)),
        read,
    )
}

fn compared<T>(
    finished: &[Finished],
    changes: Option<&[Change]>,
    read: impl FnOnce(&Findings<'_>) -> T,
) -> T {
    let record = Record::new(
        "quick",
        "cargo xtask verify",
        Verdict::Fail,
        changes,
        finished.to_vec(),
    );
    read(&Findings {
        project: &PROJECT,
        record: &record,
        see_also: None,
        provenance: None,
    })
}

/// Columns of a line of a table, from its unescaped pipes.
fn columns(line: &str) -> usize {
    line.replace("\\|", "").matches('|').count()
}

#[test]
fn every_table_is_well_formed_and_lined_up() {
    let page = with(&several(), |findings| findings.readme());
    let mut tables = 0;
    for block in page.split("\n\n").filter(|block| block.starts_with('|')) {
        let lines: Vec<&str> = block.lines().filter(|line| line.starts_with('|')).collect();
        assert!(
            lines.iter().all(|line| columns(line) == columns(lines[0])),
            "{block}"
        );
        assert!(
            lines
                .iter()
                .all(|line| line.chars().count() == lines[0].chars().count()),
            "{block}"
        );
        assert!(lines[1].chars().all(|c| "|-: ".contains(c)), "{block}");
        tables += 1;
    }
    assert!(tables >= 12, "{tables} tables in\n{page}");
}

#[test]
fn the_verdict_comes_first_and_every_study_has_its_section() {
    let page = with(&several(), |findings| findings.readme());
    let lines: Vec<&str> = page.lines().collect();
    assert_eq!(
        lines[2],
        "**fail**: 2 of 5 fail (study-1.0, study-4.0), 2 of 5 inconclusive (study-2.0, study-3.0); \
         3 not yet in the baseline"
    );
    for part in [
        "| [study-0.0](#study-00) | errors \\| fall < with \\*h\\* | pass ",
        "## study-1.0\n\n> errors | fall < with \\*h\\*\n\n**fail**: an error is NaN or infinite",
        "![errors | h](figures/study-0.0-errors.svg)",
        "Again: `cargo xtask verify study-3.0` (tier quick, kind fake)",
        "**Cases without a result**",
        "a pivot of 0.01875 was lost",
        "## Moved from the baseline",
        "**inconclusive**: all well; nothing was judged",
    ] {
        assert!(page.contains(part), "{part} is not in\n{page}");
    }
}

#[test]
fn a_comment_is_never_longer_than_it_may_be_and_what_failed_comes_first() {
    let studies = several();
    let digest = with(&studies, |findings| findings.digest());
    assert!(
        digest.contains("<details>") && digest.find("study-1.0") < digest.find("Moved from"),
        "{digest}"
    );
    let change = |k: usize| Change {
        study: "study-0.0".to_owned(),
        name: format!("error {k}"),
        movement: Movement::Vanished { value: 1.0 },
    };
    let many: Vec<Change> = (0..5000).map(change).collect();
    let long = compared(&studies, Some(&many), |findings| findings.digest());
    assert!(
        long.len() <= LONGEST && long.ends_with("A comment holds no more: see the report.\n"),
        "{}",
        long.len()
    );
    assert!(long.contains("study-1.0") && !long.contains("error 4999"));
}

#[test]
fn csv_has_one_error_a_line() {
    let mut studies = several();
    studies[0].outcome.levels[0].errors[0].0 = "a, \"b\"".to_owned();
    let csv = with(&studies, |findings| findings.errors_csv());
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "study,elements,steps,norm,error");
    assert_eq!(lines[1], "study-0.0,8,20,\"a, \"\"b\"\"\",0.0375");
    assert_eq!(lines[2], "study-0.0,16,20,velocity,0.01875");
    assert_eq!(lines[7], "study-1.0,16,20,velocity,NaN");
    assert_eq!(lines.len(), 1 + 5 + 5 + 2);
}

#[test]
fn junit_has_a_failure_for_everything_that_does_not_pass() {
    let studies = several();
    let text = with(&studies, |findings| {
        junit(PROJECT.name, findings.record).unwrap()
    });
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
    assert_eq!(failures, ["0", "1", "1", "1", "1", "3"]);
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
            "fail",
            "inconclusive",
            "inconclusive",
            "fail",
            "fail",
            "fail",
            "fail"
        ]
    );
    assert!(!text.contains("time"), "times vary: {text}");
}

#[test]
fn texts_are_escaped_in_xml_and_markdown() {
    let mut studies = several();
    studies[1].outcome.checks[0].evidence = "a < b & \"c\" \u{1b}[31m | ]]>\nnext".to_owned();
    studies[1].outcome.checks[0].verdict = Verdict::Fail;
    let text = compared(&studies, None, |findings| {
        junit(PROJECT.name, findings.record).unwrap()
    });
    let document = Document::parse(&text).unwrap();
    let message = document
        .descendants()
        .filter_map(|node| node.attribute("message"))
        .find(|text| text.contains("a < b"));
    assert!(message.is_some(), "{text}");
    let page = with(&studies, |findings| findings.readme());
    assert!(
        page.contains("a < b & \"c\"  \\[31m \\| \\]\\]> next"),
        "{page}"
    );
}

#[test]
fn the_same_outcomes_give_the_same_bytes() {
    let files = || with(&several(), |findings| findings.files().unwrap());
    assert_eq!(files(), files());
}

#[test]
fn a_reason_is_given_where_a_rate_does_not_hold() {
    let studies = finished(vec![
        study("good", Does::Converge),
        study("bad", Does::Stay),
    ]);
    let heads: Vec<bool> = studies
        .iter()
        .map(|finished| {
            tables(finished, false)[0]
                .head
                .contains(&"reason".to_owned())
        })
        .collect();
    assert_eq!(heads, [false, true]);
    assert_eq!(
        tables(&studies[1], false)[0].rows[0].last().unwrap(),
        "the error does not fall on the finest refinement"
    );
    let rates = &tables(&studies[0], false)[0];
    assert_eq!(rates.head.len(), rates.rows[0].len());
    assert_eq!(rates.rows[0][1..3], ["1 ± 0.1", "1.0000"]);
    assert_eq!(rates.rows[0][5], "1-5 of 5");
}

#[test]
fn the_picture_for_the_front_page_has_a_name_of_its_own() {
    let mut studies = finished(vec![study("a", Does::Converge)]);
    let has_front = |studies: &[Finished]| {
        let files = with(studies, |findings| findings.files().unwrap());
        files
            .files()
            .any(|(path, bytes)| path == "front.svg" && bytes == b"<svg/>")
    };
    assert!(!has_front(&studies));
    studies[0].outcome.figures[0].file = "a-front.svg".to_owned();
    assert!(has_front(&studies));
}

fn moved(study: &str, name: &str, to: f64) -> Change {
    let movement = Movement::Moved {
        from: 1.0,
        to,
        tolerance: 1e-3,
    };
    Change {
        study: study.to_owned(),
        name: name.to_owned(),
        movement,
    }
}

#[test]
fn of_numbers_that_moved_each_study_shows_the_worst_and_all_are_folded() {
    let studies = finished(vec![
        study("a", Does::Converge),
        study("b-1.0", Does::Converge),
    ]);
    let changes = [
        moved("a", "q0", 1.002),
        moved("a", "q1", 1.5),
        moved("a", "q2", 1.1),
        moved("b-1.0", "q", 4.0),
    ];
    let page = |changes: &[Change]| compared(&studies, Some(changes), |findings| findings.readme());
    let readme = page(&changes);
    let section = readme
        .split("## Moved from the baseline\n\n")
        .nth(1)
        .unwrap();
    let lines: Vec<&str> = section.lines().collect();
    assert!(lines[0].starts_with(
        "The worst number of each study; first those that moved by the largest multiple"
    ));
    let cells = |line: &str| {
        line.split(" | ")
            .map(|cell| cell.trim_matches(['|', ' ']).to_owned())
            .collect::<Vec<_>>()
    };
    let row = |cells: [&str; 5]| cells.map(str::to_owned).to_vec();
    let moved_by =
        |to: &str, by: &str| format!("moved from 1 to {to}, by +{by} %, tolerated 0.1 %");
    assert_eq!(
        cells(lines[4]),
        row(["[b-1.0](#b-10)", "1", "q", &moved_by("4", "300"), "3000"])
    );
    assert_eq!(
        cells(lines[5]),
        row(["[a](#a)", "3", "q1", &moved_by("1.5", "50"), "500"])
    );
    // Empty lines separate the parts, which would otherwise form one paragraph.
    assert_eq!(
        lines[6..10],
        [
            "",
            "If it is meant: `cargo xtask verify --bless`.",
            "",
            "<details>"
        ]
    );
    assert_eq!(lines[10], "<summary>all 4 numbers</summary>");
    assert!(
        readme.contains("</details>\n\n![All 2 judged rates"),
        "{readme}"
    );
    let short = page(&changes[2..]);
    assert!(
        !short.contains("<details>") && short.contains("`.\n\n![All 2 judged rates"),
        "{short}"
    );
    // A comment has no sections to link to.
    let digest = compared(&studies, Some(&changes), |findings| findings.digest());
    assert!(
        digest.contains("| b-1.0 |") && !digest.contains("]("),
        "{digest}"
    );
}

#[test]
fn a_number_that_moved_by_little_is_shown_with_the_digits_that_moved() {
    let movement = Movement::Moved {
        from: 0.008_482_598_7,
        to: 0.008_482_598_4,
        tolerance: 1e-8,
    };
    let told = "moved from 0.0084825987 to 0.0084825984, by -3.5e-6 %, tolerated 1e-6 %";
    assert_eq!(movement.to_string(), told);
}

#[test]
fn where_a_study_fails_the_report_says_that_nothing_is_blessed() {
    let studies = finished(vec![study("a", Does::Stay)]);
    let page = with(&studies, |findings| findings.readme());
    let said = "\n\n`--bless` refuses until the studies that did not pass are mended.\n\n";
    assert!(
        page.contains(said) && !page.contains("If it is meant"),
        "{page}"
    );
}

#[test]
fn a_study_that_fails_for_another_ones_sake_comes_after_it() {
    let mut studies = finished(vec![
        study("a-controls", Does::Converge),
        study("b", Does::TooShort),
        study("c-1.0", Does::Stay),
    ]);
    let order = |studies: &[Finished]| {
        not_passed(studies)
            .into_iter()
            .map(|study| study.id().to_owned())
            .collect::<Vec<_>>()
    };
    studies[0].outcome.verdict = Verdict::Fail;
    studies[0].outcome.checks[0].verdict = Verdict::Fail;
    for (others, expected) in [
        (&["c-1.0"][..], ["c-1.0", "b", "a-controls"]),
        // Neither itself nor a study that passes is a cause.
        (&["a-controls", "d"], ["a-controls", "c-1.0", "b"]),
        (&[], ["a-controls", "c-1.0", "b"]),
    ] {
        let check = &mut studies[0].outcome.checks[0];
        check.other_studies = others.iter().map(|id| (*id).to_owned()).collect();
        assert_eq!(order(&studies), expected, "{others:?}");
    }
}

#[test]
fn rates_that_fail_alike_are_one_sentence_and_each_has_its_line() {
    let mut finished = judged(&[("L2", 1.0), ("H1", 1.001), ("L1", 3.0)], |_, _| false);
    let steps = || (0..5).map(|level| 0.5_f64.powi(level + 3));
    for ((_, rate), order) in finished.outcome.rates.iter_mut().zip([1.0, 1.001, 3.0]) {
        *rate = judge_pairs(steps().map(|h| (h, h.powf(order))), 2.0, 0.01);
    }
    finished.outcome.verdict = Verdict::Fail;
    finished.outcome.summary = levels::summary(&finished.outcome.rates);
    finished.outcome.after_rates = Some(String::new());
    let studies = [finished];
    let together = "2 of 3 rates too low: 1.0000 to 1.0010, claimed 2 ± 0.01; L1: 3.0000 ± 0.00005, claimed 2 ± 0.01: too high";
    let page = with(&studies, |findings| findings.readme());
    assert!(page.contains(&format!("**fail**: {together}\n")), "{page}");
    assert!(
        page.contains("\n  - L2: 1.0000 ± 0.00005, claimed 2 ± 0.01: too low (too-low)\n"),
        "{page}"
    );
}

#[test]
fn a_claim_without_a_rate_and_an_order_with_many_digits_are_short() {
    let mut finished = judged(&[("L2", 1.0)], |_, _| false);
    let steps = (0..6).map(|level| 0.5_f64.powi(level + 3));
    finished.outcome.rates[0].1 = judge_pairs(steps.map(|h| (h, f64::NAN)), 2.0 / 3.0, 0.02);
    finished.outcome.verdict = Verdict::Fail;
    let studies = [finished];
    let failing = not_passed(&studies).remove(0);
    let advice = failing.advice();
    let reasons: Vec<String> = failing.items.iter().map(Item::to_string).collect();
    assert_eq!(
        reasons[0],
        "L2: no rate, claimed 0.6667 ± 0.02: an error is NaN or infinite (non-finite)"
    );
    assert!(
        reasons.len() == 1 && advice.len() == 1 && advice[0].starts_with("non-finite: "),
        "{reasons:?}, {advice:?}"
    );
}

/// Errors of several names, each with its order, on levels that may lack some of them.
fn judged(names: &[(&str, f64)], lacks: impl Fn(usize, usize) -> bool) -> Finished {
    let mut finished = finished(vec![study("a", Does::Converge)]).remove(0);
    let steps = || (0..6).map(|level| 0.5_f64.powi(level + 3));
    let outcome = &mut finished.outcome;
    outcome.levels = steps()
        .enumerate()
        .map(|(level, h)| {
            let present = names.iter().enumerate().filter(|(k, _)| !lacks(*k, level));
            let errors = present
                .map(|(_, (name, order))| ((*name).to_owned(), h.powf(*order)))
                .collect();
            let parameters = vec![("cells".to_owned(), 1.0 / h)];
            LevelErrors {
                parameters,
                step: Some(h),
                work: None,
                errors,
                without: vec![],
            }
        })
        .collect();
    let rate = |(k, (name, order)): (usize, &(&str, f64))| {
        let pairs = steps()
            .enumerate()
            .filter(|(level, _)| !lacks(k, *level))
            .map(|(_, h)| (h, h.powf(*order)));
        ((*name).to_owned(), judge_pairs(pairs, *order, 0.05))
    };
    outcome.rates = names.iter().enumerate().map(rate).collect();
    finished
}

fn errors_of(finished: &Finished) -> Vec<Table> {
    tables(finished, false)
        .into_iter()
        .filter(|table| table.title.starts_with("Errors"))
        .collect()
}

#[test]
fn the_rate_from_the_level_before_stands_beside_each_error() {
    let tables = errors_of(&judged(&[("L2", 2.0), ("H1", 1.0)], |_, _| false));
    assert_eq!(tables.len(), 1);
    assert_eq!(tables[0].head, ["cells", "L2", "rate", "H1", "rate"]);
    assert_eq!(tables[0].rows[0], ["8", "1.562e-2", "-", "1.250e-1", "-"]);
    assert_eq!(
        tables[0].rows[5],
        ["256", "1.526e-5", "2.000", "3.906e-3", "1.000"]
    );
    // An unjudged number has no rate.
    let mut unclaimed = judged(&[("L2", 2.0), ("H1", 1.0)], |_, _| false);
    unclaimed.outcome.rates.pop();
    assert_eq!(errors_of(&unclaimed)[0].head, ["cells", "L2", "rate", "H1"]);
}

#[test]
fn many_errors_are_several_tables_of_which_none_is_wide() {
    let names: Vec<String> = (0..20).map(|k| format!("norm number {k}")).collect();
    let names: Vec<(&str, f64)> = names.iter().map(|name| (name.as_str(), 2.0)).collect();
    let tables = errors_of(&judged(&names, |_, _| false));
    let width = |table: &Table| {
        let widest = |k: usize| {
            table
                .rows
                .iter()
                .chain([&table.head])
                .map(|row| row[k].chars().count())
                .max()
                .unwrap()
        };
        (0..table.head.len()).map(|k| widest(k) + 3).sum::<usize>()
    };
    assert!(
        tables.len() > 2 && tables.iter().all(|table| width(table) <= 120),
        "{tables:?}"
    );
    let shown: Vec<&String> = tables
        .iter()
        .flat_map(|table| &table.head)
        .filter(|name| name.starts_with("norm"))
        .collect();
    assert_eq!(
        shown,
        names.iter().map(|(name, _)| name).collect::<Vec<_>>()
    );
}

#[test]
fn errors_on_other_levels_are_a_table_without_gaps() {
    let tables = errors_of(&judged(&[("coarse", 1.0), ("fine", 2.0)], |k, level| {
        (k == 0) == (level >= 3)
    }));
    assert_eq!(
        tables
            .iter()
            .map(|table| table.rows.len())
            .collect::<Vec<_>>(),
        [3, 3]
    );
    assert_eq!(tables[1].rows[0], ["64", "2.441e-4", "-"]);
    assert_eq!(tables[1].rows[1][2], "2.000");
}

#[test]
fn without_a_baseline_nothing_is_said_of_it() {
    let studies = finished(vec![study("a", Does::Converge)]);
    let speaks = |changes| {
        let text = compared(&studies, changes, |findings| {
            junit(PROJECT.name, findings.record).unwrap()
        });
        (
            text.contains("baseline"),
            sentence(&studies, changes).contains("baseline"),
        )
    };
    assert_eq!(
        (speaks(Some(&[])), speaks(None)),
        ((true, true), (false, false))
    );
}
