//! Files that the tests have in common, and their values.

use std::io::{Seek as _, Write as _};
use std::process::Command;

use manufacture::{Check, Comparison, Finding, InputError, Language, Manufacture, Sampling};
use serde_json::Value;

pub(crate) const HEAT: &str = include_str!("files/heat.toml");

/// Allen-Cahn's equation, benchmark 7 of PFHub.
pub(crate) const PFHUB: &str = include_str!("files/pfhub.toml");

pub(crate) const BEAM: &str = include_str!("../../../studies/manufactured/beam.toml");

/// An elastic solid at large strains.
pub(crate) const SOLID: &str = include_str!("files/solid.toml");

pub(crate) const PIECES: &str = include_str!("files/pieces.toml");

/// So many points.
pub(crate) fn points(points: usize) -> Sampling {
    Sampling {
        points,
        ..Sampling::default()
    }
}

/// A file that must be sound.
#[track_caller]
pub(crate) fn read(text: &str) -> Manufacture {
    match Manufacture::parse(text, "test.toml") {
        Ok(manufacture) => manufacture,
        Err(error) => panic!("{error}"),
    }
}

/// The message of a file that must be refused.
#[track_caller]
pub(crate) fn refusal(text: &str) -> String {
    match Manufacture::parse(text, "test.toml") {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error.to_string(),
    }
}

#[track_caller]
pub(crate) fn check(text: &str) -> Check {
    let sampling = points(100);
    read(text).check(&sampling).unwrap()
}

/// The findings with that code.
pub(crate) fn found<'c>(check: &'c Check, code: &str) -> Vec<&'c Finding> {
    check
        .findings
        .iter()
        .filter(|finding| finding.code == code)
        .collect()
}

/// None of the findings fails.
#[track_caller]
pub(crate) fn none_fails(findings: &[Finding]) {
    let failures: Vec<_> = findings.iter().filter(|finding| finding.fails).collect();
    assert!(failures.is_empty(), "{failures:#?}");
}

/// The module of a file in a language.
pub(crate) fn library(text: &str, language: Language) -> String {
    read(text).emit(language).swap_remove(0).text
}

/// A stationary file in the plane with these fields, definitions and equations, each `KEY = "TEXT"`
/// a line.
pub(crate) fn plane(exact: &str, define: &str, equations: &str) -> String {
    format!(
        "[manufacture]\nname = \"test\"\ncoordinates = [\"x\", \"y\"]\n[domain]\nx = [0.2, 1.1]\ny = [0.3, 1.4]\n\
         [exact]\n{exact}\n[define]\n{define}\n[equations]\n{equations}\n"
    )
}

/// The values at points, each a line of a table under its header.
#[track_caller]
pub(crate) fn at(text: &str, table: &str) -> Value {
    match read(text).at(table, "points.csv") {
        Ok(values) => values,
        Err(error) => panic!("{error}"),
    }
}

/// Holds a number to another within 1e-10 of a size.
#[track_caller]
pub(crate) fn close(found: &Value, expected: f64, size: f64) {
    let found = found.as_f64().unwrap_or(f64::NAN);
    assert!(
        (found - expected).abs() <= 1e-10 * size.max(expected.abs()),
        "{found} {expected}"
    );
}

/// Holds the sources at the first point of a table to these values, which have that size.
#[track_caller]
pub(crate) fn sources(text: &str, table: &str, size: f64, expected: &[(&str, f64)]) -> Value {
    let values = at(text, table);
    for (component, value) in expected {
        close(&values["sources"][component][0], *value, size);
    }
    values
}

/// What is said of a program in Python that computes `f`, the quantity of that name, from the
/// variables of these names.
#[track_caller]
pub(crate) fn against(
    text: &str,
    face: Option<&str>,
    variables: &str,
    quantity: &str,
    statements: &str,
) -> Comparison {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.py");
    let program = format!(
        "import sys\nfrom math import *\nsys.stdin.readline()\nprint('{quantity}')\nfor line in sys.stdin:\n    \
         {variables} = [float(word) for word in line.split()]\n    {statements}\n    print(repr(float(f)))\n"
    );
    std::fs::write(&path, program).unwrap();
    let sampling = points(100);
    let mut command = Command::new("python3");
    answered(&read(text), command.arg(path), face, &sampling)
        .unwrap()
        .swap_remove(0)
}

/// What is said of the values that a command prints.
pub(crate) fn answered(
    manufacture: &Manufacture,
    command: &mut Command,
    face: Option<&str>,
    sampling: &Sampling,
) -> Result<Vec<Comparison>, InputError> {
    let question = manufacture.question(face, sampling)?;
    let mut file = tempfile::tempfile().unwrap();
    file.write_all(question.text().as_bytes()).unwrap();
    file.rewind().unwrap();
    let output = command.stdin(file).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    question.compare(&String::from_utf8(output.stdout).unwrap(), "other")
}
