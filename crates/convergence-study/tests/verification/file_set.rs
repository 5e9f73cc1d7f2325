use std::fs::{self, File};
use std::path::Path;
use std::time::{Duration, SystemTime};

use convergence_study::store::file_set::{ReportSet, Shelf, lock};

fn set(files: &[(&str, &str)]) -> ReportSet {
    let mut set = ReportSet::default();
    files.iter().for_each(|(path, bytes)| set.add(*path, *bytes).unwrap());
    set
}

fn shelf(folder: &Path) -> Shelf {
    Shelf { place: folder.join("reports"), workshop: folder.join("reports/local/workshop") }
}

/// All files below, the workshop's too, with their bytes.
fn found(folder: &Path) -> Vec<(String, String)> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
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
fn a_new_set_replaces_the_old_one_and_spares_what_is_not_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let shelf = shelf(folder.path());
    shelf.publish(&set(&[("README.md", "one"), ("figures/a.svg", "a"), ("figures/b.svg", "b")])).unwrap();
    fs::write(shelf.place.join("notes.txt"), "mine").unwrap();
    fs::write(shelf.place.join("local/times.json"), "mine").unwrap();
    shelf.publish(&set(&[("README.md", "two"), ("figures/b.svg", "b")])).unwrap();
    let expected = ["README.md", "figures/b.svg", "local/times.json", "manifest.txt", "notes.txt"];
    assert_eq!(names(&shelf.place), expected);
    assert_eq!(fs::read_to_string(shelf.place.join("README.md")).unwrap(), "two");
    shelf.publish(&set(&[("README.md", "three")])).unwrap();
    assert!(!shelf.place.join("figures").exists());
}

#[test]
fn what_has_not_changed_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let shelf = shelf(folder.path());
    shelf.publish(&set(&[("README.md", "one"), ("figures/a.svg", "a"), ("figures/b.svg", "b")])).unwrap();
    let long_ago = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
    let written = |path: &str| fs::metadata(shelf.place.join(path)).unwrap().modified().unwrap();
    for path in ["README.md", "figures/a.svg", "figures/b.svg", "manifest.txt"] {
        File::options().append(true).open(shelf.place.join(path)).unwrap().set_modified(long_ago).unwrap();
    }
    shelf.publish(&set(&[("README.md", "one"), ("figures/a.svg", "a"), ("figures/b.svg", "b")])).unwrap();
    assert_eq!(written("manifest.txt"), long_ago, "the same set again");
    shelf.publish(&set(&[("README.md", "two"), ("figures/a.svg", "a"), ("figures/b.svg", "c")])).unwrap();
    let is_untouched = ["README.md", "figures/a.svg", "figures/b.svg"].map(|path| written(path) == long_ago);
    assert_eq!(is_untouched, [false, true, false]);
    let expected = [("README.md", "two"), ("figures/a.svg", "a"), ("figures/b.svg", "c")];
    let found = found(&shelf.place);
    let found =
        found.iter().map(|(path, bytes)| (path.as_str(), bytes.as_str())).filter(|(path, _)| *path != "manifest.txt");
    assert!(found.eq(expected));
}

#[test]
fn a_replacement_that_was_interrupted_is_completed_by_the_next() {
    let files = [("README.md", "new"), ("figures/b.svg", "new"), ("results.json", "new")];
    // However many files had been moved when it happened.
    for moved in 0..=files.len() {
        let folder = tempfile::tempdir().unwrap();
        let shelf = shelf(folder.path());
        shelf.publish(&set(&[("README.md", "old"), ("figures/a.svg", "old")])).unwrap();
        let pending = shelf.workshop.join("pending");
        fs::create_dir_all(pending.join("figures")).unwrap();
        fs::create_dir_all(shelf.place.join("figures")).unwrap();
        for (i, (path, bytes)) in files.iter().enumerate() {
            fs::write(if i < moved { shelf.place.join(path) } else { pending.join(path) }, bytes).unwrap();
        }
        fs::write(pending.join("manifest.txt"), "README.md\nfigures/b.svg\nresults.json\n").unwrap();

        shelf.publish(&set(&[("README.md", "newest")])).unwrap();
        assert_eq!(names(&shelf.place), ["README.md", "manifest.txt"], "{moved} files moved");
    }
}

#[test]
fn a_crash_before_the_set_counts_leaves_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let shelf = shelf(folder.path());
    shelf.publish(&set(&[("README.md", "old")])).unwrap();
    fs::create_dir_all(shelf.workshop.join("staging")).unwrap();
    fs::write(shelf.workshop.join("staging/README.md"), "half").unwrap();
    assert_eq!(fs::read_to_string(shelf.place.join("README.md")).unwrap(), "old");
    shelf.publish(&set(&[("README.md", "new")])).unwrap();
    assert_eq!(fs::read_to_string(shelf.place.join("README.md")).unwrap(), "new");
}

#[test]
fn a_set_that_cannot_be_written_as_a_whole_leaves_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let shelf = shelf(folder.path());
    shelf.publish(&set(&[("README.md", "old"), ("a.svg", "old")])).unwrap();
    let before = found(&shelf.place);
    // The third file needs a folder where the second is a file.
    let torn = shelf.publish(&set(&[("README.md", "new"), ("a.svg", "new"), ("a.svg/b.svg", "new")]));
    assert!(torn.is_err());
    shelf.tidy().unwrap();
    assert_eq!(found(&shelf.place), before);
}

#[test]
fn a_manifest_that_leads_elsewhere_removes_nothing_there() {
    let folder = tempfile::tempdir().unwrap();
    let shelf = shelf(folder.path());
    let outside = folder.path().join("outside.txt");
    fs::write(&outside, "mine").unwrap();
    fs::create_dir_all(&shelf.place).unwrap();
    fs::write(shelf.place.join("manifest.txt"), format!("../outside.txt\n{}\n", outside.display())).unwrap();
    shelf.publish(&set(&[("README.md", "new")])).unwrap();
    assert!(outside.exists());
}

#[test]
fn names_that_leave_the_shelf_or_are_there_twice_are_refused() {
    for path in ["", "/etc/x", "../x", "a/../../x", "a\\b", "a\nb", "c:x", "manifest.txt", "readme.MD"] {
        let mut set = set(&[("README.md", "one")]);
        assert!(set.add(path, "bytes").is_err(), "{path:?}");
    }
}

#[test]
fn writers_at_the_same_time_leave_one_whole_set() {
    let folder = tempfile::tempdir().unwrap();
    let shelf = &shelf(folder.path());
    let lock_file = &shelf.place.join("local/lock");
    std::thread::scope(|scope| {
        for writer in 0..8 {
            scope.spawn(move || {
                let text = writer.to_string();
                let set = set(&[("README.md", &text), (&format!("figures/{writer}.svg"), &text)]);
                for _ in 0..5 {
                    let _held = lock(lock_file).unwrap();
                    shelf.publish(&set).unwrap();
                }
            });
        }
    });
    let files = found(&shelf.place);
    let last = files.iter().find(|(name, _)| name == "README.md").unwrap().1.clone();
    let figures: Vec<_> = files.iter().filter(|(name, _)| name.starts_with("figures/")).collect();
    assert_eq!(figures, [&(format!("figures/{last}.svg"), last)]);
}
