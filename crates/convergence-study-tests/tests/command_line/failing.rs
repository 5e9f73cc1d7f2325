//! What a person reads when something fails: changed claims, missing studies, and the last lines on
//! the terminal.

use std::fs;

use super::{command, read, run, study, texts, workspace, write};

#[test]
fn a_changed_setting_fails_until_it_is_blessed_on_demand() {
    let root = workspace(false);
    let file = root.path().join("studies/one.toml");
    run(&root, "verify --bless").says(0, "");
    // The same number written differently is the same claim.
    fs::write(&file, study("one", "c", 1.0).replace("1.0", "10e-1")).unwrap();
    run(&root, "verify").says(0, "");
    fs::write(&file, study("one", "another claim", 1.0)).unwrap();
    let change = "one: settings have changed: hash ";
    let ran = texts(command(root.path(), &["verify"]).env("GITHUB_ACTIONS", "true"));
    ran.says(1, &format!("claims changed\n  {change}"));
    ran.says(1, "\nif that is meant: powers verify --bless --loosened\n");
    ran.says(1, &format!("::error title=baseline::{change}"));
    let baseline = || read(&root, "studies/baseline.json");
    let before = baseline();
    run(&root, "verify --bless").says(1, &format!("--bless --loosened\n  {change}"));
    assert_eq!(baseline(), before);
    run(&root, "verify --bless --loosened").says(0, &format!("loosened: {change}"));
    // The hash alone is new: the numbers and their claims are the same.
    let after = baseline();
    let changed = before
        .lines()
        .zip(after.lines())
        .filter(|(old, new)| old != new);
    assert_eq!(changed.count(), 1, "{after}");
    run(&root, "verify").says(0, "");
}

#[test]
fn claims_of_the_full_tier_are_compared_in_the_quick_one() {
    let root = workspace(true);
    let file = root.path().join("studies/two.toml");
    let full = |exponent| study("two", "c", exponent).replace("\"quick\"", "\"full\"");
    fs::write(&file, full(1.0)).unwrap();
    run(&root, "verify --tier full --bless").says(0, "");
    run(&root, "verify").says(0, "");
    fs::write(&file, full(1.001)).unwrap();
    let ran = run(&root, "verify");
    ran.says(1, "claims changed\n  two: settings have changed: hash ");
    ran.says(
        1,
        "if that is meant: powers verify --tier full --bless --loosened\n",
    );
    // Blessing the quick tier does not change the claim of a study that was not run.
    run(&root, "verify --bless --loosened").says(1, "");
    // Moved to another tier.
    write(
        &root,
        "studies/one.toml",
        study("one", "c", 1.0).replace("\"quick\"", "\"full\""),
    );
    fs::write(&file, full(1.0).replace("\"full\"", "\"quick\"")).unwrap();
    run(&root, "verify").says(1, "  one: settings have changed: hash ");
}

/// All of it fits on a screen.
#[test]
fn the_failure_of_a_single_study_is_said_by_its_own_checks() {
    let root = workspace(true);
    write(&root, "studies/three.toml", study("three", "c", 1.0));
    run(&root, "verify one three --bless").says(0, "");
    let (status, out, _) = run(&root, "verify").parts();
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(status, Some(1), "{out}");
    assert!(
        lines[0].starts_with("fail in ") && lines[0].contains(" s: 1 of 3 fail (two); "),
        "{out}"
    );
    let end = &lines[2..];
    assert_eq!(
        end[..2],
        [
            "two: fail",
            "  error: 0.5000 ± 0.00005, claimed 1 ± 0.05: too low (too-low)"
        ],
        "{out}"
    );
    assert!(
        end[2].starts_with("  too-low: The whole interval lies below the band")
            && end[3].ends_with("/inconclusive.md")
            && end[4].is_empty(),
        "{out}"
    );
    assert_eq!(
        end[6..],
        [
            "report: reports/local/quick/index.html, reports/local/quick/README.md",
            "a run that does not pass leaves the committed report as it is"
        ]
    );
    let (_, out, _) = run(&root, "verify --verbose").parts();
    assert!(
        out.contains("\none    pass")
            && out.contains("\nthree  pass")
            && !out.contains("--verbose"),
        "{out}"
    );
}

#[test]
fn a_run_that_stops_at_a_failure_is_that_of_a_selection_and_the_slowest_are_listed() {
    let root = workspace(true);
    let ran = run(&root, "verify --fail-fast --durations");
    ran.says(1, "seconds  slowest studies\n");
    ran.says(1, "partial/index");
}

#[test]
fn a_deleted_study_is_one_change_and_is_named() {
    let root = workspace(false);
    write(&root, "studies/three.toml", study("three", "c", 1.0));
    run(&root, "verify --bless").says(0, "");
    fs::remove_file(root.path().join("studies/three.toml")).unwrap();
    let (status, out, _) = run(&root, "verify --quiet").parts();
    let said = "fail: the study passes; 1 study deleted\n\n\
                claims changed\n  three: study was deleted: it had 6 guarded numbers\n\
                if that is meant: powers verify --bless --loosened\n";
    assert_eq!((status, out.as_str()), (Some(1), said));
    for file in ["README.md", "summary.md"] {
        let folder = root.path().join("reports/local/quick");
        let page = fs::read_to_string(folder.join(file)).unwrap();
        assert!(page.contains("; 1 study deleted\n"), "{page}");
        assert!(
            page.contains(
                "\n## Claims changed\n\n- three: study was deleted: it had 6 guarded numbers\n\n"
            ) && !page.contains("Moved from"),
            "{page}"
        );
    }
    let page = read(&root, "reports/index.html");
    assert!(
        page.contains("<h2>Claims changed</h2>\n<ul>\n<li>three: study was deleted: it had 6 guarded numbers</li>\n</ul>"),
        "{page}"
    );
    run(&root, "verify --bless").says(1, "");
    let ran = run(&root, "verify --bless --loosened");
    ran.says(
        0,
        "loosened: three: study was deleted: it had 6 guarded numbers\n",
    );
    ran.says(0, "baseline: blessed");
    let baseline = read(&root, "studies/baseline.json");
    let baseline: serde_json::Value = serde_json::from_str(&baseline).unwrap();
    assert!(
        baseline["studies"].get("one").is_some() && baseline["studies"].get("three").is_none(),
        "{baseline}"
    );
}

#[test]
fn the_page_links_to_what_is_there_of_the_full_tier() {
    let root = workspace(false);
    let page = || {
        run(&root, "verify --bless");
        let read = |name: &str| fs::read_to_string(root.path().join("reports").join(name)).unwrap();
        (read("index.html"), read("README.md"))
    };
    assert!(!page().0.contains("full/"));
    run(&root, "verify --tier full").says(0, "");
    let (with, committed) = page();
    assert!(
        with.contains("href=\"full/index.html\"") && committed.contains("](full/README.md)"),
        "{committed}"
    );
    // As in a fresh checkout: pages are not committed.
    fs::remove_file(root.path().join("reports/full/index.html")).unwrap();
    let (without, same) = page();
    assert!(without.contains("href=\"full/README.md\"") && !without.contains("full/index.html"));
    assert_eq!(same, committed);
}

/// The report on the full tier leaves the studies of the quick one to its neighbour, and its page
/// has them with their figures.
#[test]
fn the_full_report_is_made_anew_and_its_page_has_the_quick_studies() {
    let root = workspace(false);
    run(&root, "verify --bless");
    run(&root, "verify --tier full").says(0, "");
    let full = root.path().join("reports/full");
    let read =
        || ["README.md", "index.html"].map(|name| fs::read_to_string(full.join(name)).unwrap());
    let before = read();
    assert!(
        before[0].contains("[its report](../README.md)") && !before[0].contains("one-errors"),
        "{}",
        before[0]
    );
    assert!(before[1].contains("<details class=\"study\" id=\"one\""));
    fs::remove_file(full.join("index.html")).unwrap();
    let (status, out, err) = run(&root, "report reports/full/results.json").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert_eq!(read(), before);
}
