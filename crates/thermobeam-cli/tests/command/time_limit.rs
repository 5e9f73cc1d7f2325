//! The time limit of a case.

use super::workspace::{endless, quick, set, verify, workspace};
use super::{Folder, ended};

#[test]
fn a_case_at_its_limit_fails_its_study_and_no_other() {
    let folder = Folder::new();
    let root = workspace(
        &folder,
        "w",
        &[("short", quick("short")), ("long", endless("long"))],
    );
    let ended = ended(&mut verify(&root, &["--time-limit", "1", "--verbose"]));
    assert_eq!((ended.status, ended.stderr.as_str()), (Some(1), ""));
    let line = |id: &str| {
        ended
            .stdout
            .lines()
            .find(|line| line.starts_with(&format!("{id} ")))
            .unwrap_or_default()
            .to_owned()
    };
    assert!(
        line("short").contains(" pass ") && line("long").contains(" fail "),
        "{}",
        ended.stdout
    );
    let page =
        std::fs::read_to_string(root.join("reports/local/quick/index.html")).expect("a report");
    for piece in [
        "n = 8, 9000000000 steps: stopped at the time limit of 1 s, after step ",
        "<td>every case completes, with finite numbers</td><td>fail</td>",
    ] {
        assert!(page.contains(piece), "{piece}: {page}");
    }
}

#[test]
fn a_limit_that_is_not_reached_changes_no_bit() {
    let folder = Folder::new();
    let sets = ["plain", "limited"].map(|name| {
        let root = workspace(&folder, name, &[("short", quick("short"))]);
        let arguments = if name == "plain" {
            &[][..]
        } else {
            &["--time-limit", "3600"]
        };
        assert_eq!(ended(&mut verify(&root, arguments)).status, Some(1));
        set(&root.join("reports/local/quick"))
    });
    assert_eq!(sets[0], sets[1]);
}

#[test]
fn a_limit_that_is_none_is_unusable() {
    let folder = Folder::new();
    let root = workspace(&folder, "w", &[("short", quick("short"))]);
    for limit in ["0", "-1", "nan", "inf", "1e300", "soon"] {
        let ended = ended(&mut verify(&root, &[&format!("--time-limit={limit}")]));
        assert_eq!(
            (ended.status, ended.stdout.as_str()),
            (Some(2), ""),
            "{limit}"
        );
        assert!(ended.stderr.contains("--time-limit"), "{}", ended.stderr);
    }
}
