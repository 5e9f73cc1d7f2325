//! Emitted files, built and run where their tool chain is found.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use super::{Finding, finding};
use crate::against::{Right, ask, questions};
use crate::emit::{Language, accept, emit};
use crate::model::Model;
use crate::problem::InputError;

/// Values of an emitted file may differ by this times their size.
const SAME: f64 = 1e3 * f64::EPSILON;

/// An emitted program that takes longer is wrong.
const LIMIT: Duration = Duration::from_secs(600);

/// The command that succeeds if the tool chain is there, and what is missing if not.
fn probe(language: Language) -> Option<(&'static [&'static str], &'static str)> {
    match language {
        Language::C => Some((&["cc", "--version"], "C compiler")),
        Language::Fortran => Some((&["gfortran", "--version"], "gfortran")),
        Language::Python => Some((&["python3", "-c", "import numpy"], "Python with NumPy")),
        Language::Octave => Some((&["octave", "--version"], "Octave")),
        Language::Rust => Some((&["rustc", "--version"], "rustc")),
        Language::Ufl => None,
    }
}

fn succeeds(command: &[&str]) -> bool {
    let status = Command::new(command[0])
        .args(&command[1..])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.is_ok_and(|status| status.success())
}

/// Builds and runs the files of a language in a folder, which must exist.
pub(crate) fn emitted(
    model: &Model,
    language: Language,
    folder: &Path,
    seed: u64,
    points: usize,
) -> Result<Vec<Finding>, InputError> {
    accept(model, language)?;
    let name = language.name();
    let not_run = |reason: &str| {
        vec![Finding {
            fails: false,
            ..finding("emitted", name, format!("not run: {reason}"), None)
        }]
    };
    let Some((command, missing)) = probe(language) else {
        return Ok(not_run(
            "values need fenics-ufl and basix, which are not run here; Python has the same statements",
        ));
    };
    if !succeeds(command) {
        return Ok(not_run(&format!("no {missing}")));
    }
    for file in emit(model, language) {
        let path = folder.join(&file.name);
        let failed = |error: std::io::Error| {
            InputError::whole(&path.display().to_string(), error.to_string())
        };
        fs::write(&path, file.text).map_err(failed)?;
    }
    run(model, language, folder, seed, points)
}

/// Builds and runs the files of a language that are in a folder.
pub(crate) fn run(
    model: &Model,
    language: Language,
    folder: &Path,
    seed: u64,
    points: usize,
) -> Result<Vec<Finding>, InputError> {
    let name = language.name();
    let mut commands = language.commands(&model.problem.name, folder);
    let Some(answer) = commands.pop() else {
        return Ok(vec![]);
    };
    for build in commands {
        let output = Command::new(&build[0]).args(&build[1..]).output();
        let output =
            output.map_err(|error| InputError::whole(&build.join(" "), error.to_string()))?;
        if !output.status.success() {
            let message = String::from_utf8_lossy(&output.stderr);
            let first: Vec<&str> = message.lines().take(4).collect();
            let text = format!("does not compile: {}", first.join(" / "));
            return Ok(vec![finding("emitted", name, text, None)]);
        }
    }
    let faces = model
        .problem
        .faces
        .iter()
        .filter(|face| !face.data.is_empty());
    let faces = faces.map(|face| Some(face.name.as_str()));
    let mut findings = vec![];
    for face in std::iter::once(None).chain(faces) {
        let questions = questions(model, face, seed, points)?;
        let right = Right::new(model, &questions);
        let mut command = answer.clone();
        command.extend(face.map(str::to_owned));
        let compared = ask::run(&command, questions.text.clone(), LIMIT)
            .and_then(|text| ask::read(&text, name, &right.names(), questions.points.len()));
        match compared {
            Ok(answers) => findings.extend(differences(&right, &answers, name)),
            Err(error) => findings.push(finding("emitted", name, error.to_string(), None)),
        }
    }
    Ok(findings)
}

fn differences(right: &Right<'_>, answers: &[ask::Answer], language: &str) -> Vec<Finding> {
    let mut findings = vec![];
    for place in right.places() {
        let name = right.name(place);
        let Some(answer) = answers.iter().find(|answer| answer.name == name) else {
            let text = format!("no answer about {name}");
            findings.push(finding("emitted", language, text, None));
            continue;
        };
        let values = right.values(place);
        let shares = values.iter().zip(&answer.values).map(|(right, found)| {
            let difference = (right.value - found).abs();
            // Not a difference of zero over a size of zero.
            if difference <= SAME * right.size {
                0.0
            } else {
                difference / right.size
            }
        });
        let worst = shares.fold(0.0, f64::max);
        if worst > 0.0 {
            let text = format!("{name} differs by {worst:.3e} of its size");
            findings.push(finding("emitted", language, text, Some(worst)));
        }
    }
    findings
}
