use std::fs::{self, File};
use std::path::Path;
use std::time::{Duration, SystemTime};

use crate::store::{ReportFolder, ReportSet, lock, remove_folder};

fn set(files: &[(&str, &str)]) -> ReportSet {
    let mut set = ReportSet::default();
    files
        .iter()
        .for_each(|(path, bytes)| set.add(*path, *bytes).unwrap());
    set
}

/// A report with two figures.
const WITH_TWO_FIGURES: [(&str, &str); 3] = [
    ("README.md", "one"),
    ("figures/a.svg", "a"),
    ("figures/b.svg", "b"),
];

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
fn a_new_report_replaces_the_old_one_with_its_figures_and_leaves_other_files() {
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    reports.publish(&set(&WITH_TWO_FIGURES)).unwrap();
    fs::write(reports.folder.join("notes.txt"), "mine").unwrap();
    fs::write(reports.folder.join("local/times.json"), "mine").unwrap();
    reports
        .publish(&set(&[("README.md", "two"), ("figures/b.svg", "b")]))
        .unwrap();
    let expected = [
        "README.md",
        "figures/b.svg",
        "local/times.json",
        "notes.txt",
    ];
    assert_eq!(names(&reports.folder), expected);
    assert_eq!(
        fs::read_to_string(reports.folder.join("README.md")).unwrap(),
        "two"
    );
    // Of the folders of figures only what is no picture stays.
    for path in [
        "figures/notes.txt",
        "figures/stranger.svg",
        "figures/page/c.svg",
    ] {
        let path = reports.folder.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "mine").unwrap();
    }
    reports.publish(&set(&[("README.md", "three")])).unwrap();
    assert_eq!(names(&reports.folder.join("figures")), ["notes.txt"]);
    fs::remove_file(reports.folder.join("figures/notes.txt")).unwrap();
    reports
        .publish(&set(&[("README.md", "four"), ("figures/a.svg", "a")]))
        .unwrap();
    reports.publish(&set(&[("README.md", "five")])).unwrap();
    assert!(!reports.folder.join("figures").exists());
}

#[test]
fn unchanged_files_are_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    reports.publish(&set(&WITH_TWO_FIGURES)).unwrap();
    let long_ago = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
    let written = |path: &str| {
        fs::metadata(reports.folder.join(path))
            .unwrap()
            .modified()
            .unwrap()
    };
    for path in ["README.md", "figures/a.svg", "figures/b.svg"] {
        File::options()
            .append(true)
            .open(reports.folder.join(path))
            .unwrap()
            .set_modified(long_ago)
            .unwrap();
    }
    reports.publish(&set(&WITH_TWO_FIGURES)).unwrap();
    assert_eq!(written("README.md"), long_ago, "the same set again");
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
        .map(|(path, bytes)| (path.as_str(), bytes.as_str()));
    assert!(found.eq(expected));
}

/// Whatever number of files had been moved when a run was killed.
#[test]
fn after_a_kill_each_file_is_whole_and_the_next_run_makes_one_report() {
    let files = [
        ("figures/b.svg", "new"),
        ("results.json", "new"),
        ("README.md", "new"),
    ];
    for moved in 0..=files.len() {
        let folder = tempfile::tempdir().unwrap();
        let reports = reports(folder.path());
        reports
            .publish(&set(&[("README.md", "old"), ("figures/a.svg", "old")]))
            .unwrap();
        let staging = &reports.workshop;
        for (i, (path, bytes)) in files.iter().enumerate() {
            let place = if i < moved { &reports.folder } else { staging };
            fs::create_dir_all(place.join(path).parent().unwrap()).unwrap();
            fs::write(place.join(path), bytes).unwrap();
        }
        let readme = fs::read_to_string(reports.folder.join("README.md")).unwrap();
        assert_eq!(readme == "new", moved == files.len(), "{moved}");
        reports.publish(&set(&[("README.md", "newest")])).unwrap();
        assert!(!staging.exists());
        let mut expected = vec!["README.md"];
        // Only figures are removed.
        expected.extend((moved > 1).then_some("results.json"));
        assert_eq!(names(&reports.folder), expected, "{moved} files moved");
    }
}

/// A file that cannot take its place stops the others behind it; the report in Markdown is the last.
#[test]
fn the_markdown_takes_its_place_last() {
    let folder = tempfile::tempdir().unwrap();
    let reports = reports(folder.path());
    reports.publish(&set(&[("README.md", "old")])).unwrap();
    fs::create_dir_all(reports.folder.join("z.svg/full")).unwrap();
    let torn = reports.publish(&set(&[
        ("README.md", "new"),
        ("a.svg", "new"),
        ("z.svg", "new"),
    ]));
    assert!(torn.is_err());
    let read = |name: &str| fs::read_to_string(reports.folder.join(name)).unwrap();
    assert_eq!(
        (read("a.svg").as_str(), read("README.md").as_str()),
        ("new", "old")
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
    remove_folder(&reports.workshop).unwrap();
    assert_eq!(found(&reports.folder), before);
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
    // A report is replaced whatever it is; a lock must be a file.
    pipe(&reports.folder.join("README.md"));
    reports.publish(&set(&[("README.md", "one")])).unwrap();
    assert_eq!(
        fs::read_to_string(reports.folder.join("README.md")).unwrap(),
        "one"
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
