//! What `new` writes, where, and that it runs.

use std::fs;

use foreign_tools::Tool;

use super::{command, run, run_words, texts, workspace};

/// The study runs in the same place.
#[test]
fn a_study_that_is_begun_below_the_project_goes_into_its_studies() {
    if !crate::awk_is_here() {
        return;
    }
    let root = workspace();
    let below = root.path().join("src/deep");
    fs::create_dir_all(&below).unwrap();
    for line in [
        "new program other --language shell",
        "study ../../studies/other.toml",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        texts(&mut command(&below, &words)).says(0, "other");
    }
}

/// The languages, each with what must be there to run it. (`.ci/programs` runs the others.)
const LANGUAGES: [(&str, &[Tool]); 8] = [
    ("python", &[foreign_tools::PYTHON]),
    ("octave", &[foreign_tools::OCTAVE_CLI]),
    ("fortran", &[foreign_tools::FORTRAN, foreign_tools::SHELL]),
    ("c++", &[foreign_tools::CPLUSPLUS, foreign_tools::SHELL]),
    ("freefem", &[]),
    ("openfoam", &[]),
    ("julia", &[]),
    ("shell", &[foreign_tools::AWK, foreign_tools::SHELL]),
];

#[test]
fn a_program_in_each_language_passes_where_it_can_run() {
    for (language, tools) in LANGUAGES {
        let root = tempfile::tempdir().unwrap();
        run_words(&root, &["new", "program", "mine", "--language", language]).says(0, "");
        for entry in fs::read_dir(root.path()).unwrap() {
            let text = fs::read_to_string(entry.unwrap().path()).unwrap();
            let has_word = ["NAME", "PROGRAM", "BELOW", "DIRECTORY"]
                .iter()
                .any(|word| text.contains(word));
            assert!(!has_word, "{language}: {text}");
        }
        if !tools.is_empty() && foreign_tools::are_here(tools) {
            run(&root, "study mine.toml -j 2").says(0, "(order 2); value middle ");
        }
    }
}
