//! The studies of the quick tier: no claim, no guarded number and no run of theirs is without
//! effect.

use convergence_study::{Study, Tier};
use std::fs;
use thermobeam_study::kinds;
use thermobeam_study::studies::STUDIES;

use super::*;

/// What the quick ones among these do not notice, below their ids.
fn unnoticed_in(studies: impl IntoIterator<Item = Box<dyn Study>>) -> Vec<String> {
    let mut list = vec![];
    for study in studies {
        let header = study.header();
        if header.tier == Tier::Quick {
            let own = study.unnoticed().into_iter();
            list.extend(own.map(|one| format!("{}: {one}", header.id)));
        }
    }
    list
}

#[test]
fn every_claim_and_every_run_of_the_studies_in_code_counts() {
    assert_eq!(
        unnoticed_in(STUDIES.map(|study| study())),
        Vec::<String>::new()
    );
}

#[test]
fn every_claim_and_every_run_of_the_studies_with_files_counts() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let files = fs::read_dir(folder).expect("the studies");
    let paths = files.map(|file| file.expect("a file").path());
    let tables = paths.filter(|path| path.extension().is_some_and(|end| end == "toml"));
    let studies: Vec<_> = tables
        .map(|path| kinds::read(&path).expect("a study"))
        .collect();
    assert!(studies.len() > 70, "{} studies", studies.len());
    assert_eq!(unnoticed_in(studies), Vec::<String>::new());
}

/// Else a scene could be emptied beside a study that records none of its numbers.
#[test]
fn the_values_of_a_file_that_a_study_names_are_settings_of_the_study() {
    for (study, setting) in [
        ("energy-decay.toml", "scenes/"),
        ("fixed-point.toml", "scenes/"),
        ("reference-space.toml", "scenes/"),
        ("work-precision-paper.toml", "scenes/"),
        ("work-precision-manufactured.toml", "midpoint-coupled.toml"),
    ] {
        let read = kinds::read(&file(study)).expect("a study");
        let mut settings = read.header().settings.iter();
        let is_of_file = |path: &str| path.starts_with(setting) && path.contains(".toml: ");
        assert!(settings.any(|(path, _)| is_of_file(path)), "{study}");
    }
}
