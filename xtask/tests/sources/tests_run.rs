//! Every file of tests is a module of its crate's test program, so that it is run.

use std::fs;
use std::path::{Path, PathBuf};

/// Whether this is a file or folder of tests, and no module of `main`.
fn is_lost(main: &str, path: &Path) -> bool {
    let name = path.file_stem().unwrap().display().to_string();
    let is_file = path.extension().is_some_and(|end| end == "rs");
    let is_module = is_file
        || ["mod.rs", "main.rs"]
            .iter()
            .any(|own| path.join(own).is_file());
    let declared = format!("mod {name};");
    is_module && name != "main" && main.lines().all(|line| line != declared)
}

fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().path())
}

#[test]
fn every_file_of_tests_is_run() {
    let root = super::root();
    let mut read = 0;
    for folder in entries(&root.join("crates")).chain([root.join("xtask")]) {
        let folder = folder.join("tests");
        if let Ok(main) = fs::read_to_string(folder.join("main.rs")) {
            let lost: Vec<PathBuf> = entries(&folder)
                .filter(|path| is_lost(&main, path))
                .collect();
            assert_eq!(lost, Vec::<PathBuf>::new());
            read += 1;
        }
    }
    assert!(read >= 7, "{read}");
    let is_lost = |name| is_lost("mod a;\n// mod b;\n", Path::new(name));
    assert_eq!(
        ["a.rs", "b.rs", "main.rs"].map(is_lost),
        [false, true, false]
    );
}
