use std::fs;
use std::path::PathBuf;

use convergence_study::FromFile as _;
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::Convergence;
use thermobeam_study::scene::Scene;

use proptest::prelude::*;

use super::says;
use crate::read_study;

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
fn a_file_larger_than_any_scene_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.toml");
    fs::write(&path, vec![b'#'; 10_000_001]).expect("a file");
    let refused = Scene::read(path).expect_err("too large");
    says(
        &refused.to_string(),
        "large.toml: found more than 10000000 bytes",
    );
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
