//! ARCHITECTURE.md is the map: every file or folder of the sources is on it.

use std::fs;
use std::path::Path;

/// Entries of a source folder that a map lacks: `x.rs` and `x/` stand for each other.
fn missing(map: &str, names: &[String]) -> Vec<String> {
    let named = |name: &str| map.contains(&format!("`{name}.rs`")) || map.contains(&format!("`{name}/`"));
    names.iter().filter(|name| !named(name)).cloned().collect()
}

/// The modules of a folder, except the crate's root.
fn modules(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let names = names.map(|name| name.trim_end_matches(".rs").to_owned());
    names.filter(|name| name != "lib" && name != "main").collect()
}

#[test]
fn every_file_is_on_the_map() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let map = fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    for (sources, least) in [
        ("crates/thermobeam/src", 10),
        ("crates/thermobeam-exact/src", 5),
        ("crates/convergence-study/src", 10),
        ("crates/thermobeam-study/src", 6),
        ("crates/thermobeam-cli/src", 6),
        ("xtask/src", 1),
    ] {
        let modules = modules(&root.join(sources));
        assert!(modules.len() > least);
        assert_eq!(missing(&map, &modules), Vec::<String>::new(), "of {sources} in ARCHITECTURE.md");
    }
    assert_eq!(missing(&map, &["mesh".to_owned(), "lost".to_owned()]), ["lost"]);
}
