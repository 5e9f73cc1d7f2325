use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use tempfile::TempDir;

use crate::store::{ReportSet, beside, clear, lock, place, remove_other_figures};

fn set(files: &[(&str, &str)]) -> ReportSet {
    let mut set = ReportSet::default();
    files
        .iter()
        .for_each(|(path, bytes)| set.add(*path, *bytes).unwrap());
    set
}

/// Replaces the report in a folder, as a run does.
fn publish(folder: &Path, set: &ReportSet) -> io::Result<()> {
    clear(folder)?;
    place(beside(folder, set)?)?;
    remove_other_figures(folder, set)
}

/// A report with two figures.
const WITH_TWO_FIGURES: [(&str, &str); 3] = [
    ("README.md", "one"),
    ("figures/a.svg", "a"),
    ("figures/b.svg", "b"),
];

/// A folder for reports.
struct Place {
    _root: TempDir,
    folder: PathBuf,
}

impl Place {
    fn new() -> Self {
        let root = tempfile::tempdir().unwrap();
        Self {
            folder: root.path().join("reports"),
            _root: root,
        }
    }

    /// With a report of these files.
    fn with(files: &[(&str, &str)]) -> Self {
        let place = Self::new();
        place.publish(files);
        place
    }

    fn publish(&self, files: &[(&str, &str)]) {
        publish(&self.folder, &set(files)).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// A file of somebody else.
    fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// All files below, with their bytes.
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
    let place = Place::with(&WITH_TWO_FIGURES);
    place.write("notes.txt", "mine");
    place.write("local/times.json", "mine");
    place.publish(&[("README.md", "two"), ("figures/b.svg", "b")]);
    let expected = [
        "README.md",
        "figures/b.svg",
        "local/times.json",
        "notes.txt",
    ];
    assert_eq!(names(&place.folder), expected);
    assert_eq!(place.read("README.md"), "two");
    // Of the folders of figures only what is no picture stays.
    for name in ["notes.txt", "stranger.svg", "page/c.svg"] {
        place.write(&format!("figures/{name}"), "mine");
    }
    place.publish(&[("README.md", "three")]);
    assert_eq!(names(&place.path("figures")), ["notes.txt"]);
    fs::remove_file(place.path("figures/notes.txt")).unwrap();
    place.publish(&[("README.md", "four"), ("figures/a.svg", "a")]);
    place.publish(&[("README.md", "five")]);
    assert!(!place.path("figures").exists());
}

#[test]
fn unchanged_files_are_not_written() {
    let place = Place::with(&WITH_TWO_FIGURES);
    let long_ago = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
    let paths = WITH_TWO_FIGURES.map(|(path, _)| place.path(path));
    for path in &paths {
        let file = File::options().append(true).open(path).unwrap();
        file.set_modified(long_ago).unwrap();
    }
    let is_untouched = || {
        paths
            .each_ref()
            .map(|path| fs::metadata(path).unwrap().modified().unwrap() == long_ago)
    };
    place.publish(&WITH_TWO_FIGURES);
    assert_eq!(is_untouched(), [true; 3], "the same set again");
    let changed = [
        ("README.md", "two"),
        ("figures/a.svg", "a"),
        ("figures/b.svg", "c"),
    ];
    place.publish(&changed);
    assert_eq!(is_untouched(), [false, true, false]);
    let expected = changed.map(|(path, text)| (path.to_owned(), text.to_owned()));
    assert_eq!(found(&place.folder), expected);
}

/// Whatever number of files had been moved when a run was killed.
#[test]
fn after_a_kill_each_file_is_whole_and_the_next_run_makes_one_report() {
    let files = ["figures/b.svg", "results.json", "README.md"];
    for moved in 0..=files.len() {
        let place = Place::with(&[("README.md", "old"), ("figures/a.svg", "old")]);
        for (i, path) in files.iter().enumerate() {
            let (folder, name) = path.rsplit_once('/').unwrap_or((".", path));
            let beside = format!("{folder}/.{name}.unfinished-1-{i}");
            place.write(if i < moved { path } else { &beside }, "new");
        }
        let is_new = place.read("README.md") == "new";
        assert_eq!(is_new, moved == files.len(), "{moved}");
        place.publish(&[("README.md", "newest")]);
        let mut expected = vec!["README.md"];
        // Only figures are removed.
        expected.extend((moved > 1).then_some("results.json"));
        assert_eq!(names(&place.folder), expected, "{moved} files moved");
    }
}

/// A file that cannot take its place stops the others behind it; the report in Markdown is the
/// last.
#[test]
fn the_markdown_takes_its_place_last() {
    let place = Place::with(&[("README.md", "old")]);
    fs::create_dir_all(place.path("z.svg/full")).unwrap();
    let files = ["README.md", "a.svg", "z.svg"].map(|name| (name, "new"));
    assert!(publish(&place.folder, &set(&files)).is_err());
    let texts = ["a.svg", "README.md"].map(|name| place.read(name));
    assert_eq!(texts, ["new", "old"]);
}

#[test]
fn a_set_that_cannot_be_written_as_a_whole_leaves_the_old_one() {
    let place = Place::with(&[("README.md", "old"), ("a.svg", "old")]);
    let before = found(&place.folder);
    // The third file needs a folder where the second is a file.
    let files = ["README.md", "a.svg", "a.svg/b.svg"].map(|name| (name, "new"));
    assert!(publish(&place.folder, &set(&files)).is_err());
    assert_eq!(found(&place.folder), before);
}

/// A report is replaced whatever it is. (A lock must be a file: the transcript of places.)
#[cfg(unix)]
#[test]
fn a_pipe_in_place_of_a_report_does_not_hang() {
    foreign_tools::needs!(MKFIFO);
    let place = Place::new();
    fs::create_dir_all(&place.folder).unwrap();
    let mut pipe = std::process::Command::new("mkfifo");
    assert!(
        pipe.arg(place.path("README.md"))
            .status()
            .unwrap()
            .success()
    );
    place.publish(&[("README.md", "one")]);
    assert_eq!(place.read("README.md"), "one");
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
    let place = &Place::new();
    let lock_file = &place.path("local/lock");
    std::thread::scope(|scope| {
        for writer in 0..8 {
            scope.spawn(move || {
                let text = writer.to_string();
                let figure = format!("figures/{writer}.svg");
                for _ in 0..5 {
                    let _held = lock(lock_file).unwrap();
                    place.publish(&[("README.md", &text), (&figure, &text)]);
                }
            });
        }
    });
    let last = place.read("README.md");
    let mut files = found(&place.folder);
    files.retain(|(name, _)| name.starts_with("figures/"));
    assert_eq!(files, [(format!("figures/{last}.svg"), last)]);
}
