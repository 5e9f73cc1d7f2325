//! ARCHITECTURE.md is the map: every file or folder of the sources is on it.

use std::fs;
use std::path::Path;

/// Entries of a source folder that a map lacks: `x.rs` and `x/` stand for each other.
fn missing(map: &str, names: &[String]) -> Vec<String> {
    let named =
        |name: &str| map.contains(&format!("`{name}.rs`")) || map.contains(&format!("`{name}/`"));
    names.iter().filter(|name| !named(name)).cloned().collect()
}

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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
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

#[test]
fn every_file_is_on_the_map() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let map = fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    for (sources, least) in [
        ("crates/thermobeam/src", 10),
        ("crates/thermobeam-exact/src", 5),
        ("crates/convergence-harness/src", 10),
        ("crates/thermobeam-study/src", 6),
        ("crates/thermobeam-cli/src", 6),
        ("xtask/src", 1),
    ] {
        let modules = modules(&root.join(sources));
        assert!(modules.len() > least);
        assert_eq!(
            missing(&map, &modules),
            Vec::<String>::new(),
            "of {sources} in ARCHITECTURE.md"
        );
    }
    assert_eq!(
        missing(&map, &["mesh".to_owned(), "lost".to_owned()]),
        ["lost"]
    );
}
