//! Emitted files: built, run and compared; and what a person reads in them.

use std::path::Path;

use manufacture::{Finding, Language, Sampling};

use crate::files::{HEAT, LIMIT, read};

const BEAM: &str = include_str!("../../../studies/manufactured/beam.toml");
const SOLID: &str = include_str!("files/solid.toml");
const PIECES: &str = include_str!("files/pieces.toml");

fn sampling() -> Sampling {
    Sampling {
        points: 60,
        ..Sampling::default()
    }
}

/// The findings about the files of a language, which is not found missing silently.
fn findings(text: &str, language: Language) -> Vec<Finding> {
    let folder = tempfile::tempdir().unwrap();
    read(text)
        .check_emitted(language, folder.path(), &sampling())
        .unwrap()
}

/// C, Python and Rust are there wherever this is tested; the others are tested where they are.
#[track_caller]
fn agrees(language: Language, is_needed: bool) {
    for text in [HEAT, BEAM, SOLID, PIECES] {
        let findings = findings(text, language);
        let is_missing = findings
            .iter()
            .all(|finding| finding.text.starts_with("not run: no "));
        if is_missing && !findings.is_empty() && !is_needed {
            eprintln!("skipped: {}", findings[0].text);
            return;
        }
        assert!(findings.is_empty(), "{findings:#?}");
    }
}

#[test]
fn c_agrees() {
    agrees(Language::C, true);
}

/// A project that builds with warnings as errors can take the files as they are.
#[test]
fn emitted_c_compiles_without_a_warning() {
    let files = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/files")).unwrap();
    let mut texts = vec![HEAT.to_owned(), BEAM.to_owned()];
    for file in files {
        texts.push(std::fs::read_to_string(file.unwrap().path()).unwrap());
    }
    assert!(texts.len() > 10, "{}", texts.len());
    let folder = tempfile::tempdir().unwrap();
    for text in texts {
        let files = read(&text).emit(Language::C);
        for file in &files {
            std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
        }
        for file in files.iter().filter(|file| file.name.ends_with(".c")) {
            let output = std::process::Command::new("cc")
                .args("-std=c99 -Wall -Wextra -Werror -O1 -c".split(' '))
                .arg(&file.name)
                .current_dir(folder.path())
                .output()
                .unwrap();
            let errors = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {errors}", file.name);
        }
    }
}

#[test]
fn rust_agrees() {
    agrees(Language::Rust, true);
}

#[test]
fn python_agrees() {
    agrees(Language::Python, false);
}

#[test]
fn fortran_agrees() {
    agrees(Language::Fortran, false);
}

#[test]
fn octave_agrees() {
    agrees(Language::Octave, false);
}

#[test]
fn lines_have_at_most_100_columns_and_no_file_has_a_date() {
    for text in [HEAT, BEAM, SOLID, PIECES] {
        for (_, language) in Language::ALL {
            for file in read(text).emit(language) {
                let widest = file.text.lines().max_by_key(|line| line.len()).unwrap();
                assert!(widest.len() <= 100, "{}: {widest}", file.name);
                assert!(
                    !file.text.contains('@'.to_string().as_str()) || language == Language::Octave,
                    "{}",
                    file.name
                );
            }
            assert_eq!(read(text).emit(language), read(text).emit(language));
        }
    }
}

#[test]
fn a_slip_in_emitted_c_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let manufacture = read(HEAT);
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let files = manufacture.emit(Language::C);
    for file in &files {
        write(&file.name, &file.text);
    }
    let source = &files[0].text;
    let body = source.find("double heat_source_heat").unwrap();
    let build = |text: &str| {
        write("heat.c", text);
        let path = |name: &str| folder.path().join(name);
        let status = std::process::Command::new("cc")
            .args(["-O1", "-o"])
            .args([path("answer"), path("heat.c"), path("heat_answer.c")])
            .arg("-lm")
            .status();
        assert!(status.unwrap().success());
        let command = format!("{}", Path::new(&path("answer")).display());
        manufacture
            .against(&command, None, &sampling(), LIMIT)
            .unwrap()
            .remove(0)
    };
    assert_eq!(build(source).cause, "equal");
    for (old, new) in [
        ("cos(", "sin("),
        (" + ", " - "),
        ("0.3*", "0.2*"),
        ("x[1]", "x[0]"),
    ] {
        let place = body + source[body..].find(old).unwrap();
        let changed = format!("{}{new}{}", &source[..place], &source[place + old.len()..]);
        let comparison = build(&changed);
        assert_ne!(comparison.cause, "equal", "{old} {new}: {comparison:?}");
        assert!(comparison.difference > 1e-6);
    }
}

/// Fortran does not tell capitals from small letters: names get a trailing `_`, and the first
/// comment lists them.
#[test]
fn names_that_fortran_cannot_tell_apart_are_listed() {
    let text = crate::files::plane(
        "u = \"a*sin(x)\"\nU = \"A*cos(y)\"",
        "",
        "u = \"u + d(U, y)\"\nU = \"U\"",
    );
    let text = text.replace("[exact]", "[parameters]\na = 2\nA = 3\n[exact]");
    let library = &read(&text).emit(Language::Fortran)[0].text;
    let comment: String = library
        .lines()
        .take_while(|line| line.starts_with('!'))
        .map(|line| line.trim_start_matches("! "))
        .collect::<Vec<_>>()
        .join(" ");
    for name in ["exact_u_", "gradient_u_", "source_u_", "parameter_a_"] {
        assert!(comment.contains(name), "{name}: {comment}");
    }
    assert!(
        findings(&text, Language::Fortran)
            .iter()
            .all(|finding| !finding.fails),
    );
    let python = &read(&text).emit(Language::Python)[0].text;
    assert!(!python.contains("Written with _ behind"));
}
