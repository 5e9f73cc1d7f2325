//! Unwritable places.

use std::fs;

use super::workspace::{quick, set, verify, workspace};
use super::{Folder, read};
use convergence_study_tests::ended;

#[test]
fn reports_that_cannot_be_written_are_named_and_the_old_ones_stay() {
    let folder = Folder::new();
    let root = workspace(&folder, "w", &[("short", quick("short"))]);
    let verified = || ended(&mut verify(&root, ""));
    let reports = root.join("reports");
    fs::write(&reports, "a file").expect("a file");
    verified().refuses("reports: the reports cannot be written");
    assert_eq!(read(&reports), "a file");
    fs::remove_file(&reports).expect("it can be removed");
    assert_eq!(verified().status, Some(1));
    let before = set(&reports);

    // A folder in the place of the lock.
    fs::remove_file(reports.join("local/lock")).expect("a lock");
    fs::create_dir(reports.join("local/lock")).expect("a folder");
    verified().refuses("");
    assert_eq!(set(&reports), before);
}

#[test]
fn a_study_folder_that_cannot_be_read_is_named() {
    let folder = Folder::new();
    let root = workspace(&folder, "w", &[]);
    fs::create_dir(root.join("studies/folder.toml")).expect("a folder");
    ended(&mut verify(&root, "")).refuses("folder.toml: cannot be read");
    assert!(!root.join("reports").exists());
}
