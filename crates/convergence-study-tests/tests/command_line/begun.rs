//! What `new` writes, where, and that it runs.

use std::fs;

use foreign_tools::Tool;

use super::{command, read, run, run_words, texts, workspace};

#[test]
fn a_study_goes_into_the_studies_of_the_project() {
    if !crate::awk_is_here() {
        return;
    }
    let root = workspace(false);
    let (status, out, err) = run(&root, "new program mine --language shell").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert_eq!(
        out,
        "wrote studies/mine.toml, studies/mine.sh\nrun: powers study studies/mine.toml\n"
    );
    run(&root, "study studies/mine.toml").says(0, "");
    // From a folder below it, too: the study runs in the same place.
    fs::create_dir_all(root.path().join("src/deep")).unwrap();
    let arguments = ["new", "program", "other", "--language", "shell"];
    let (status, out, _) = texts(&mut command(&root.path().join("src/deep"), &arguments)).parts();
    assert!(
        status == Some(0) && out.ends_with("run: powers study ../../studies/other.toml\n"),
        "{out}"
    );
    let study = ["study", "../../studies/other.toml"];
    texts(&mut command(&root.path().join("src/deep"), &study)).says(0, "");
    assert_eq!(
        read(&root, "studies/mine.toml").replace("mine", "other"),
        read(&root, "studies/other.toml")
    );
    assert!(read(&root, ".gitignore").contains("/reports/local/"));
    // What is no study does not go there, where `verify` would read it.
    run(&root, "new manufacture heat").says(0, "");
    assert!(root.path().join("heat.toml").exists());
    // Nothing is overwritten.
    run(&root, "new program mine").complains(2, "studies/mine.toml: expected a new file");
    assert!(!root.path().join("studies/mine.py").exists());
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

#[test]
fn a_study_of_a_command_needs_no_program_file() {
    if !foreign_tools::are_here(&[foreign_tools::AWK]) {
        return;
    }
    let root = tempfile::tempdir().unwrap();
    let program = "awk 'BEGIN { printf \"L2 = %e\\n\", 3 / ({n} * {n}) }'";
    let (status, out, err) =
        run_words(&root, &["new", "program", "mine", "--command", program]).parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert!(out.starts_with("wrote mine.toml\n"), "{out}");
    run(&root, "study mine.toml").says(0, "L2 2.0000 (order 2)");
    for (command, words) in [
        (
            "solver {N}",
            "--command: found the placeholder {N}, did you mean `n`?",
        ),
        ("solver 'mesh {n}", "--command: found ' without its end"),
        ("  ", "--command: found no word; expected a program"),
    ] {
        run_words(&root, &["new", "program", "bad", "--command", command]).refuses(words);
    }
    for (line, words) in [
        (
            "new manufacture bad --command x",
            "--language, --command: found `new manufacture`; expected `new program`",
        ),
        (
            "new program bad --language cobol",
            "[possible values: python, octave, fortran, c++, freefem, openfoam, julia, shell]",
        ),
        (
            "new program bad --language shell --command x",
            "cannot be used with",
        ),
    ] {
        run(&root, line).complains(2, words);
    }
    assert_eq!(
        fs::read_dir(root.path()).unwrap().count(),
        2,
        "mine.toml and .gitignore"
    );
}
