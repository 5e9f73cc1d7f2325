//! The report in Markdown and CSV: its parts, their order, and what it says of the baseline.

use crate::{
    Finished, Verdict,
    report::{Findings, LONGEST, junit, sentence},
    run::not_passed,
    store::{Baseline, GuardedChange, Movement, Record},
};

use super::fake::{Does, PROJECT, finished, passing, says, study};

pub(super) fn several() -> Vec<Finished> {
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

pub(super) fn with<T>(finished: &[Finished], read: impl FnOnce(&Findings<'_>) -> T) -> T {
    let mut changes = Baseline::default().compare(finished, None);
    // A baseline that has a number of a study that fails: without any, a report lists none.
    changes.extend(not_passed(finished).first().map(|failing| GuardedChange {
        study: failing.header.id.clone(),
        name: "gone".to_owned(),
        movement: Movement::Vanished { value: 1.0 },
    }));
    compared(finished, Some(&changes), read)
}

pub(super) fn compared<T>(
    finished: &[Finished],
    changes: Option<&[GuardedChange]>,
    read: impl FnOnce(&Findings<'_>) -> T,
) -> T {
    let record = Record::new(
        "quick",
        "cargo xtask verify",
        Verdict::Fail,
        changes,
        finished.to_vec(),
    );
    read(&Findings::of(&PROJECT, &record))
}

/// A file of the report.
pub(super) fn file(findings: &Findings<'_>, path: &str) -> String {
    let set = findings.files().unwrap();
    String::from_utf8(set.0[path].clone()).unwrap()
}

pub(super) fn readme(findings: &Findings<'_>) -> String {
    file(findings, "README.md")
}

pub(super) fn junit_of(findings: &Findings<'_>) -> String {
    junit(PROJECT.name, findings.record).unwrap()
}

/// Columns of a line of a table, from its unescaped pipes.
fn columns(line: &str) -> usize {
    line.replace("\\|", "").matches('|').count()
}

#[test]
fn every_table_is_well_formed() {
    let page = with(&several(), readme);
    let mut tables = 0;
    for block in page.split("\n\n").filter(|block| block.starts_with('|')) {
        let lines: Vec<&str> = block.lines().filter(|line| line.starts_with('|')).collect();
        assert!(
            lines.iter().all(|line| columns(line) == columns(lines[0])),
            "{block}"
        );
        assert!(lines[1].chars().all(|c| "|-: ".contains(c)), "{block}");
        tables += 1;
    }
    assert_eq!(tables, 1, "rates in\n{page}");
}

#[test]
fn the_verdict_comes_first_and_every_study_has_its_line() {
    let page = with(&several(), readme);
    let lines: Vec<&str> = page.lines().collect();
    assert_eq!(
        lines[2],
        "**fail**: 2 of 5 fail (study-1.0, study-4.0), 2 of 5 inconclusive (study-2.0, study-3.0); \
         3 numbers not yet in the baseline, 1 baseline value changed"
    );
    for part in [
        "\n- **pass** study-0.0: errors \\| fall < with \\*h\\* (",
        ") [errors](figures/study-0.0-errors.svg)\n",
        "\n- study-1.0: **fail**, errors \\| fall < with \\*h\\*\n  - case ",
        "a pivot of 0.01875 was lost",
        "\n- **fail** study-1.0: ",
        "\n|study-0.0|velocity|1 ± 0.1|1.0000|",
        "## Moved from the baseline",
        "\n- **inconclusive** study-3.0: ",
    ] {
        assert!(page.contains(part), "{part} is not in\n{page}");
    }
}

#[test]
fn a_comment_is_never_longer_than_it_may_be_and_what_failed_comes_first() {
    let studies = several();
    let digest = with(&studies, |findings| findings.digest().unwrap());
    assert!(
        digest.contains("<details>") && digest.find("study-1.0") < digest.find("Moved from"),
        "{digest}"
    );
    let change = |k: usize| GuardedChange {
        study: "gone".to_owned(),
        name: format!("claim {k}"),
        movement: Movement::VanishedStudy { numbers: 1 },
    };
    let many: Vec<GuardedChange> = (0..5000).map(change).collect();
    let long = compared(&studies, Some(&many), |findings| findings.digest().unwrap());
    assert!(
        long.len() <= LONGEST && long.ends_with("A comment holds no more: see the report.\n"),
        "{}",
        long.len()
    );
    assert!(long.contains("study-1.0") && !long.contains("claim 4999"));
}

#[test]
fn of_numbers_that_moved_the_worst_of_each_study_come_first_and_the_page_has_all() {
    let studies = finished(vec![passing("a"), passing("b-1.0")]);
    let changes = [
        GuardedChange::moved("a", "q0", [1.0, 1.002]),
        GuardedChange::moved("a", "q1", [1.0, 1.5]),
        GuardedChange::moved("a", "q2", [1.0, 1.1]),
        GuardedChange::moved("b-1.0", "q", [1.0, 4.0]),
    ];
    let moved_by =
        |to: &str, by: &str| format!("moved from 1 to {to}, by +{by} %, tolerated 0.1 %");
    let rows = [
        format!("- b-1.0: q {}", moved_by("4", "300")),
        format!("- a: q1 {}", moved_by("1.5", "50")),
        format!("- a: q2 {}", moved_by("1.1", "10")),
        format!("- a: q0 {}", moved_by("1.002", "0.2")),
        String::new(),
        "If it is meant: `cargo xtask verify --bless`.".to_owned(),
        String::new(),
    ]
    .join("\n");
    compared(&studies, Some(&changes), |findings| {
        let digest = findings.digest().unwrap();
        for text in [readme(findings), digest] {
            says(&text, &rows);
        }
        let page = file(findings, "index.html");
        for name in ["q0", "q1", "q2"] {
            assert!(page.contains(&format!("<li>a: {name} moved")), "{name}");
        }
    });
    // Of very many only the page has all.
    let many: Vec<GuardedChange> = (0..30)
        .map(|k| GuardedChange::moved("a", &format!("n{k}"), [1.0, 1.1 + f64::from(k)]))
        .collect();
    compared(&studies, Some(&many), |findings| {
        let page = file(findings, "index.html");
        let readme = readme(findings);
        assert!(
            page.contains("a: n0 moved") && page.contains("a: n29 moved"),
            "{page}"
        );
        assert!(
            !readme.contains("a: n9 moved") && readme.contains("\n- and 10 more\n"),
            "{readme}"
        );
    });
}

#[test]
fn a_number_that_moved_by_little_is_shown_with_the_digits_that_moved() {
    let movement = Movement::Moved {
        from: 0.008_482_598_7,
        to: 0.008_482_598_4,
        tolerance: 1e-8,
    };
    let sentence = "moved from 0.0084825987 to 0.0084825984, by -3.5e-6 %, tolerated 1e-6 %";
    assert_eq!(movement.to_string(), sentence);
}

#[test]
fn without_a_baseline_nothing_is_said_of_it() {
    let studies = finished(vec![passing("a")]);
    let speaks = |changes| {
        let text = compared(&studies, changes, junit_of);
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

#[test]
fn the_picture_of_rates_has_a_title_unless_pictures_have_none() {
    with(&several(), |findings| {
        for has_titles in [true, false] {
            let findings = Findings {
                has_titles,
                ..*findings
            };
            let picture = file(&findings, "figures/rates.svg");
            assert_eq!(picture.contains("data-title"), has_titles, "{picture}");
        }
    });
}
