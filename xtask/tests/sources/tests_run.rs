//! Every file of tests is a module of its crate's test program, so that it is run.

use std::fs;
use std::path::Path;

/// The modules of a folder, except the crate's root.
fn modules(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let names = names.map(|name| name.trim_end_matches(".rs").to_owned());
    names
        .filter(|name| name != "lib" && name != "main")
        .collect()
}

/// The files and folders of tests that are no modules of `main`.
fn lost(main: &str, tests: &[String]) -> Vec<String> {
    let is_declared = |name: &str| main.lines().any(|line| line == format!("mod {name};"));
    tests
        .iter()
        .filter(|name| !is_declared(name))
        .cloned()
        .collect()
}

#[test]
fn every_file_of_tests_is_run() {
    let root = super::root();
    let crates = fs::read_dir(root.join("crates"))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut read = 0;
    for folder in crates
        .chain([root.join("xtask")])
        .map(|path| path.join("tests"))
    {
        let Ok(main) = fs::read_to_string(folder.join("main.rs")) else {
            continue;
        };
        let mut tests = modules(&folder);
        tests.retain(|name| {
            [".rs", "/mod.rs", "/main.rs"]
                .iter()
                .any(|end| folder.join(format!("{name}{end}")).is_file())
        });
        assert!(!tests.is_empty());
        assert_eq!(
            lost(&main, &tests),
            Vec::<String>::new(),
            "of {}",
            folder.display()
        );
        read += 1;
    }
    assert!(read >= 7, "{read}");
    assert_eq!(
        lost("mod a;\n// mod b;\n", &["a".to_owned(), "b".to_owned()]),
        ["b"]
    );
}
