use std::fs;
use std::path::{Path, PathBuf};

use convergence_study::FromFile as _;
use thermobeam_study::kinds;
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::Convergence;
use thermobeam_study::scene::Scene;

use proptest::prelude::*;

use super::says;
use crate::read_study;

/// A file in this test's own folder.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, bytes).expect("a writable folder");
    path
}

#[test]
fn a_file_that_cannot_be_read_is_named_with_the_reason() {
    let missing = Scene::read("no.toml").expect_err("no such file");
    assert_eq!((missing.file.as_str(), missing.place), ("no.toml", None));
    let folder = env!("CARGO_TARGET_TMPDIR");
    let folder_read = Scene::read(folder).expect_err("a folder");
    says(
        &folder_read.to_string(),
        &format!("{folder}: cannot be read: "),
    );
    let study = kinds::read(Path::new("no.toml"))
        .err()
        .expect("no such file");
    for error in [missing, study] {
        says(&error.to_string(), "no.toml: cannot be read: ");
    }
}

#[test]
fn a_file_that_another_names_is_missed_where_it_is_named() {
    let studies = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let mut missed = 0;
    for entry in fs::read_dir(studies).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        // On its own in a folder, a study lacks the scenes and studies that it names.
        let folder = tempfile::tempdir().expect("a folder");
        let alone = folder.path().join("alone.toml");
        fs::copy(&path, &alone).expect("a copy");
        let Err(error) = read_study(&alone) else {
            continue;
        };
        missed += 1;
        assert!(error.place.is_some() && error.field.is_some(), "{error}");
        let begin = format!("{}:", alone.display());
        let words = "found the text \" … expected the name of a file, relative to this";
        says(&error.to_string(), &format!("{begin} … {words}"));
    }
    assert!(missed > 10, "{missed} studies name files");
}

#[test]
fn bytes_that_are_not_text_and_a_file_larger_than_any_scene_are_refused() {
    let large = vec![b'#'; 10_000_001];
    for (name, bytes, words) in [
        (
            "latin-1.toml",
            &b"[beam]\n# \xe4\n"[..],
            ":2:3: found the byte 0xe4; expected UTF-8 text",
        ),
        ("large.toml", &large, ": found more than 10000000 bytes"),
    ] {
        let refused = Scene::read(file(name, bytes)).expect_err(name);
        says(&refused.to_string(), &format!("{name}{words}"));
    }
}

#[test]
fn text_that_is_not_toml_is_shown_where_it_goes_wrong() {
    for (text, pieces) in [
        ("[beam]\r\nzeta = \"ä", "f.toml:2: … not valid TOML: "),
        (
            "\"ää\".x = 1\r\nfoo = 1",
            "f.toml:2:1: foo: unknown key `foo`",
        ),
    ] {
        says(
            &Scene::parse(text, "f.toml").expect_err(text).to_string(),
            pieces,
        );
    }
    for deep in [
        format!("a = {}", "[".repeat(1_000_000)),
        format!("{}a = 1", "a.".repeat(1_000_000)),
    ] {
        says(
            &Scene::parse(&deep, "f.toml").expect_err("deep").to_string(),
            "not valid TOML: ",
        );
    }
}

proptest! {
    #[test]
    fn any_text_is_a_scene_or_refused_without_a_panic(text in any::<String>()) {
        if let Err(error) = Scene::parse(&text, "f.toml") {
            prop_assert!(error.to_string().starts_with("f.toml:"), "{}", error);
        }
        prop_assert!(Orders::<Convergence>::parse(&text, "f.toml".as_ref()).is_err());
    }
}
