//! The time limit of a case.

use super::workspace::{endless, quick, set, verify, workspace};
use super::{Folder, read};
use convergence_study_tests::ended;

#[test]
fn a_case_at_its_limit_fails_its_study_and_no_other() {
    let folder = Folder::new();
    let studies = [("short", quick("short")), ("long", endless("long"))];
    let root = workspace(&folder, "w", &studies);
    let ended = ended(&mut verify(&root, "--time-limit 1 --verbose"));
    assert_eq!((ended.status, ended.stderr.as_str()), (Some(1), ""));
    for [id, verdict] in [["short ", " pass "], ["long ", " fail "]] {
        let mut lines = ended.stdout.lines();
        assert!(
            lines.any(|line| line.starts_with(id) && line.contains(verdict)),
            "{ended:?}"
        );
    }
    let page = read(&root.join("reports/local/quick/index.html"));
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
    let sets = ["", "--time-limit 3600"].map(|arguments| {
        let root = workspace(&folder, "w", &[("short", quick("short"))]);
        let _ = std::fs::remove_dir_all(root.join("reports"));
        ended(&mut verify(&root, arguments)).complains(1, "");
        set(&root.join("reports/local/quick"))
    });
    assert_eq!(sets[0], sets[1]);
}
