use std::fs::{self, File};
use std::path::Path;
use std::time::{Duration, SystemTime};

use convergence_study::internal::store::{ReportFolder, ReportSet, lock};

fn set(files: &[(&str, &str)]) -> ReportSet {
    let mut set = ReportSet::default();
    files
        .iter()
        .for_each(|(path, bytes)| set.add(*path, *bytes).unwrap());
    set
}

fn reports(folder: &Path) -> ReportFolder {
    ReportFolder {
        folder: folder.join("reports"),
        workshop: folder.join("reports/local/workshop"),
    }
}

/// All files below, including the workshop's, with their bytes.
fn found(folder: &Path) -> Vec<(String, String)> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path
                    .strip_prefix(folder)
                    .unwrap()
                    .to_string_lossy()
                    .into_owned();
                files.push((name, fs::read_to_string(&path).unwrap()));
            }
        }
    }
    files.sort();
    files
}

fn names(folder: &Path) -> Vec<String> {
    found(folder).into_iter().map(|(name, _)| name).collect()
}

#[test]
fn a_new_set_replaces_the_old_one_and_leaves_other_files() {
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    reports
        .publish(&set(&[
            ("README.md", "one"),
            ("figures/a.svg", "a"),
            ("figures/b.svg", "b"),
        ]))
        .unwrap();
    fs::write(reports.folder.join("notes.txt"), "mine").unwrap();
    fs::write(reports.folder.join("local/times.json"), "mine").unwrap();
    reports
        .publish(&set(&[("README.md", "two"), ("figures/b.svg", "b")]))
        .unwrap();
    let expected = [
        "README.md",
        "figures/b.svg",
        "local/times.json",
        "manifest.txt",
        "notes.txt",
    ];
    assert_eq!(names(&reports.folder), expected);
    assert_eq!(
        fs::read_to_string(reports.folder.join("README.md")).unwrap(),
        "two"
    );
    reports.publish(&set(&[("README.md", "three")])).unwrap();
    assert!(!reports.folder.join("figures").exists());
}

#[test]
fn unchanged_files_are_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    reports
        .publish(&set(&[
            ("README.md", "one"),
            ("figures/a.svg", "a"),
            ("figures/b.svg", "b"),
        ]))
        .unwrap();
    let long_ago = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
    let written = |path: &str| {
        fs::metadata(reports.folder.join(path))
            .unwrap()
            .modified()
            .unwrap()
    };
    for path in [
        "README.md",
        "figures/a.svg",
        "figures/b.svg",
        "manifest.txt",
    ] {
        File::options()
            .append(true)
            .open(reports.folder.join(path))
            .unwrap()
            .set_modified(long_ago)
            .unwrap();
    }
    reports
        .publish(&set(&[
            ("README.md", "one"),
            ("figures/a.svg", "a"),
            ("figures/b.svg", "b"),
        ]))
        .unwrap();
    assert_eq!(written("manifest.txt"), long_ago, "the same set again");
    reports
        .publish(&set(&[
            ("README.md", "two"),
            ("figures/a.svg", "a"),
            ("figures/b.svg", "c"),
        ]))
        .unwrap();
    let is_untouched =
        ["README.md", "figures/a.svg", "figures/b.svg"].map(|path| written(path) == long_ago);
    assert_eq!(is_untouched, [false, true, false]);
    let expected = [
        ("README.md", "two"),
        ("figures/a.svg", "a"),
        ("figures/b.svg", "c"),
    ];
    let found = found(&reports.folder);
    let found = found
        .iter()
        .map(|(path, bytes)| (path.as_str(), bytes.as_str()))
        .filter(|(path, _)| *path != "manifest.txt");
    assert!(found.eq(expected));
}

#[test]
fn a_replacement_that_was_interrupted_is_completed_by_the_next() {
    let files = [
        ("README.md", "new"),
        ("figures/b.svg", "new"),
        ("results.json", "new"),
    ];
    // Whatever number of files had been moved when it happened.
    for moved in 0..=files.len() {
        let folder = tempfile::tempdir().unwrap();
        let reports = reports(folder.path());
        reports
            .publish(&set(&[("README.md", "old"), ("figures/a.svg", "old")]))
            .unwrap();
        let pending = reports.workshop.join("pending");
        fs::create_dir_all(pending.join("figures")).unwrap();
        fs::create_dir_all(reports.folder.join("figures")).unwrap();
        for (i, (path, bytes)) in files.iter().enumerate() {
            fs::write(
                if i < moved {
                    reports.folder.join(path)
                } else {
                    pending.join(path)
                },
                bytes,
            )
            .unwrap();
        }
        fs::write(
            pending.join("manifest.txt"),
            "README.md\nfigures/b.svg\nresults.json\n",
        )
        .unwrap();

        reports.publish(&set(&[("README.md", "newest")])).unwrap();
        assert_eq!(
            names(&reports.folder),
            ["README.md", "manifest.txt"],
            "{moved} files moved"
        );
    }
}

#[test]
fn a_crash_before_the_set_is_pending_leaves_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    reports.publish(&set(&[("README.md", "old")])).unwrap();
    fs::create_dir_all(reports.workshop.join("staging")).unwrap();
    fs::write(reports.workshop.join("staging/README.md"), "half").unwrap();
    assert_eq!(
        fs::read_to_string(reports.folder.join("README.md")).unwrap(),
        "old"
    );
    reports.publish(&set(&[("README.md", "new")])).unwrap();
    assert_eq!(
        fs::read_to_string(reports.folder.join("README.md")).unwrap(),
        "new"
    );
}

#[test]
fn a_set_that_cannot_be_written_as_a_whole_leaves_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    reports
        .publish(&set(&[("README.md", "old"), ("a.svg", "old")]))
        .unwrap();
    let before = found(&reports.folder);
    // The third file needs a folder where the second is a file.
    let torn = reports.publish(&set(&[
        ("README.md", "new"),
        ("a.svg", "new"),
        ("a.svg/b.svg", "new"),
    ]));
    assert!(torn.is_err());
    reports.tidy().unwrap();
    assert_eq!(found(&reports.folder), before);
}

#[test]
fn a_manifest_with_paths_outside_the_folder_removes_nothing_there() {
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    let outside = folder.path().join("outside.txt");
    fs::write(&outside, "mine").unwrap();
    fs::create_dir_all(&reports.folder).unwrap();
    fs::write(
        reports.folder.join("manifest.txt"),
        format!("../outside.txt\n{}\n", outside.display()),
    )
    .unwrap();
    reports.publish(&set(&[("README.md", "new")])).unwrap();
    assert!(outside.exists());
}

#[test]
fn a_pending_manifest_with_paths_outside_the_folder_moves_nothing() {
    for path in [
        "../outside.txt",
        "../../outside.txt",
        "/etc/outside.txt",
        "a/../../outside.txt",
        "manifest.txt",
    ] {
        let folder = tempfile::tempdir().unwrap();
        let reports = reports(folder.path());
        reports.publish(&set(&[("README.md", "old")])).unwrap();
        let pending = reports.workshop.join("pending");
        fs::create_dir_all(&pending).unwrap();
        fs::write(pending.join("README.md"), "new").unwrap();
        fs::write(pending.join("manifest.txt"), format!("README.md\n{path}\n")).unwrap();
        // What `pending/../../outside.txt` would take from the workshop and from the folder above.
        fs::write(reports.workshop.join("outside.txt"), "mine").unwrap();
        fs::write(reports.folder.join("local/outside.txt"), "mine").unwrap();
        let before = found(folder.path());
        let error = reports.tidy().unwrap_err().to_string();
        assert!(
            error.contains("pending/manifest.txt: found `") && error.contains("remove this folder"),
            "{error}"
        );
        assert_eq!(found(folder.path()), before, "{path}");
    }
}

#[cfg(unix)]
#[test]
fn pipes_in_place_of_files_do_not_hang() {
    if !foreign_tools::are_here(&[foreign_tools::MKFIFO]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    let pipe = |path: &Path| {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        assert!(
            std::process::Command::new("mkfifo")
                .arg(path)
                .status()
                .unwrap()
                .success()
        );
    };
    // A report is replaced whatever it is; a lock or a manifest must be a file.
    pipe(&reports.folder.join("README.md"));
    reports.publish(&set(&[("README.md", "one")])).unwrap();
    assert_eq!(
        fs::read_to_string(reports.folder.join("README.md")).unwrap(),
        "one"
    );
    pipe(&reports.workshop.join("pending/manifest.txt"));
    assert!(
        reports
            .tidy()
            .unwrap_err()
            .to_string()
            .contains("expected a regular file")
    );
    pipe(&folder.path().join("lock"));
    assert!(
        lock(&folder.path().join("lock"))
            .unwrap_err()
            .to_string()
            .contains("expected a regular file")
    );
}

#[test]
fn names_that_leave_the_folder_or_are_there_twice_are_refused() {
    for path in [
        "",
        "/etc/x",
        "../x",
        "a/../../x",
        "a\\b",
        "a\nb",
        "a\u{1b}b",
        "c:x",
        "manifest.txt",
        "readme.MD",
    ] {
        let mut set = set(&[("README.md", "one")]);
        assert!(set.add(path, "bytes").is_err(), "{path:?}");
    }
}

#[test]
fn writers_at_the_same_time_leave_one_whole_set() {
    let folder = tempfile::tempdir().unwrap();
    let reports = &reports(folder.path());
    let lock_file = &reports.folder.join("local/lock");
    std::thread::scope(|scope| {
        for writer in 0..8 {
            scope.spawn(move || {
                let text = writer.to_string();
                let set = set(&[
                    ("README.md", &text),
                    (&format!("figures/{writer}.svg"), &text),
                ]);
                for _ in 0..5 {
                    let _held = lock(lock_file).unwrap();
                    reports.publish(&set).unwrap();
                }
            });
        }
    });
    let files = found(&reports.folder);
    let last = files
        .iter()
        .find(|(name, _)| name == "README.md")
        .unwrap()
        .1
        .clone();
    let figures: Vec<_> = files
        .iter()
        .filter(|(name, _)| name.starts_with("figures/"))
        .collect();
    assert_eq!(figures, [&(format!("figures/{last}.svg"), last)]);
}
