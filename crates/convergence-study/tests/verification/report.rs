//! The report in Markdown and CSV: its parts, their order, and what it says of the baseline.

use convergence_study::{
    Finished, Verdict,
    internal::{
        report::{Findings, LONGEST, sentence},
        run::not_passed,
        store::{Baseline, GuardedChange, Movement, Record, junit},
    },
};

use super::fake::{Does, PROJECT, finished, study};

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
        study: failing.id().to_owned(),
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
         1 baseline value changed, 3 numbers not yet in the baseline"
    );
    for part in [
        "- **pass** [study-0.0](#study-00): errors | fall < with \\*h\\* (",
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
    let change = |k: usize| GuardedChange {
        study: "study-0.0".to_owned(),
        name: format!("error {k}"),
        movement: Movement::Vanished { value: 1.0 },
    };
    let many: Vec<GuardedChange> = (0..5000).map(change).collect();
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
    studies[0].outcome.levels[0].errors[0].name = "a, \"b\"".to_owned();
    let csv = with(&studies, |findings| findings.errors_csv());
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "study,elements,steps,norm,error");
    assert_eq!(lines[1], "study-0.0,8,20,\"a, \"\"b\"\"\",0.0375");
    assert_eq!(lines[2], "study-0.0,16,20,velocity,0.01875");
    assert_eq!(lines[7], "study-1.0,16,20,velocity,NaN");
    assert_eq!(lines.len(), 1 + 5 + 5 + 2);
}

#[test]
fn the_same_outcomes_give_the_same_bytes() {
    let files = || with(&several(), |findings| findings.files().unwrap());
    assert_eq!(files(), files());
}

fn moved(study: &str, name: &str, to: f64) -> GuardedChange {
    let movement = Movement::Moved {
        from: 1.0,
        to,
        tolerance: 1e-3,
    };
    GuardedChange {
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
    let page =
        |changes: &[GuardedChange]| compared(&studies, Some(changes), |findings| findings.readme());
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
    let sentence = "moved from 0.0084825987 to 0.0084825984, by -3.5e-6 %, tolerated 1e-6 %";
    assert_eq!(movement.to_string(), sentence);
}

#[test]
fn without_a_baseline_nothing_is_said_of_it() {
    let studies = finished(vec![study("a", Does::Converge)]);
    let speaks = |changes| {
        let text = compared(&studies, changes, |findings| {
            junit(PROJECT.name, findings.record)
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
