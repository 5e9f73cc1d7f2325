//! Unwritable places.

use std::fs;

use super::workspace::{quick, set, verify, workspace};
use super::{Folder, ended};

#[test]
fn reports_that_cannot_be_written_are_named_and_the_old_ones_stay() {
    let folder = Folder::new();
    let root = workspace(&folder, "w", &[("short", quick("short"))]);
    let reports = root.join("reports");
    fs::write(&reports, "a file").expect("a file");
    let refused = ended(&mut verify(&root, &[]));
    assert_eq!((refused.status, refused.stdout.as_str()), (Some(2), ""));
    assert!(
        refused
            .stderr
            .contains("reports: the reports cannot be written"),
        "{}",
        refused.stderr
    );
    assert_eq!(fs::read_to_string(&reports).expect("the file"), "a file");
    fs::remove_file(&reports).expect("it can be removed");
    assert_eq!(ended(&mut verify(&root, &[])).status, Some(1));
    let before = set(&reports);

    // A folder in the place of the lock.
    fs::remove_file(reports.join("local/lock")).expect("a lock");
    fs::create_dir(reports.join("local/lock")).expect("a folder");
    let refused = ended(&mut verify(&root, &[]));
    assert_eq!((refused.status, refused.stdout.as_str()), (Some(2), ""));
    assert_eq!(set(&reports), before);
}

#[test]
fn a_study_folder_that_cannot_be_read_is_named() {
    let folder = Folder::new();
    let root = workspace(&folder, "w", &[]);
    fs::create_dir(root.join("studies/folder.toml")).expect("a folder");
    let refused = ended(&mut verify(&root, &[]));
    assert_eq!((refused.status, refused.stdout.as_str()), (Some(2), ""));
    assert!(
        refused.stderr.contains("folder.toml: cannot be read"),
        "{}",
        refused.stderr
    );
    assert!(!root.join("reports").exists());
}
