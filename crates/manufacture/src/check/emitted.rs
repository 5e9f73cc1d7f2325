//! Emitted files, built and run where their tool chain is found.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::rc::Rc;

use super::{Finding, finding};
use crate::Sampling;
use crate::against::{Questions, ask, questions};
use crate::arithmetic::NodeId;
use crate::arithmetic::tape::{SizedValue, Tape};
use crate::emit::{Alternative, Answering, Language, accept, answered_together, emit, functions};
use crate::model::Model;
use crate::problem::{InputError, Parameter, ParameterValue};

/// Values of an emitted file may differ by this times their size.
const SAME: f64 = 1e3 * f64::EPSILON;

/// Points at which the values of a variant are compared, whose statements are those of the file but
/// for the solution.
const POINTS_OF_VARIANTS: usize = 200;

/// What a program prints about its input; in words why it prints nothing.
///
/// * `variant`: of the solution; empty for that of the file.
fn printed(command: &[String], input: Stdio, variant: &str) -> Result<String, String> {
    let output = Command::new(&command[0])
        .args(&command[1..])
        .env("MANUFACTURE_VARIANT", variant)
        .stdin(input)
        .output()
        .map_err(|error| format!("{}: {error}", command[0]))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let message = String::from_utf8_lossy(&output.stderr);
    let first: Vec<&str> = message.lines().take(4).collect();
    Err(format!(
        "{}: {}: {}",
        command[0],
        output.status,
        first.join(" / ")
    ))
}

/// Builds and runs the files of a language in a folder, which must exist.
pub(crate) fn emitted(
    model: &Model,
    alternatives: &[Alternative<'_>],
    language: Language,
    folder: &Path,
    sampling: &Sampling,
) -> Result<Vec<Finding>, InputError> {
    accept(model, language)?;
    let Some(tools) = &language.row().tools else {
        let reason = "values need fenics-ufl and basix, which are not run here; Python has the same statements";
        return Ok(vec![not_run(language, reason)]);
    };
    let probe = language.command(tools.probe, &model.problem.name, folder);
    if printed(&probe, Stdio::null(), "").is_err() {
        let reason = format!("no {}", tools.missing);
        return Ok(vec![not_run(language, &reason)]);
    }
    for file in emit(model, alternatives, language) {
        let path = folder.join(&file.name);
        fs::write(&path, file.text)
            .map_err(|error| InputError::whole(&path.display().to_string(), error.to_string()))?;
    }
    run(model, alternatives, language, folder, sampling)
}

fn not_run(language: Language, reason: &str) -> Finding {
    let text = format!("not run: {reason}");
    Finding {
        fails: false,
        ..finding("emitted", language.name(), text, None)
    }
}

/// Builds and runs the files of a language that are in a folder.
pub(crate) fn run(
    model: &Model,
    alternatives: &[Alternative<'_>],
    language: Language,
    folder: &Path,
    sampling: &Sampling,
) -> Result<Vec<Finding>, InputError> {
    let Some(tools) = &language.row().tools else {
        return Ok(vec![]);
    };
    let name = &model.problem.name;
    let failed = |text: String| finding("emitted", language.name(), text, None);
    if let Some(build) = tools.build {
        let build = language.command(build, name, folder);
        if let Err(message) = printed(&build, Stdio::null(), "") {
            return Ok(vec![failed(format!("does not compile: {message}"))]);
        }
    }
    let mut evaluations = evaluations("", model, language, sampling, true)?;
    for alternative in alternatives {
        let sampling = Sampling {
            points: sampling.points.min(POINTS_OF_VARIANTS),
            ..*sampling
        };
        // All models read parameters by the same statements; these differ where a value does.
        let parameters = &alternative.model.graph.parameters;
        let with_others = *parameters != model.graph.parameters;
        let Alternative { name, model } = alternative;
        evaluations.extend(self::evaluations(
            name,
            model,
            language,
            &sampling,
            with_others,
        )?);
    }
    let mut findings = vec![];
    let answers = answers(language, name, folder, tools.answering, &evaluations);
    for (evaluation, answer) in evaluations.iter().zip(answers) {
        let wrong = answer.and_then(|answer| evaluation.compared(&answer, language));
        for mut wrong in wrong.unwrap_or_else(|text| vec![failed(text)]) {
            if !evaluation.variant.is_empty() {
                wrong.text = format!("{}: {}", evaluation.variant, wrong.text);
            }
            findings.push(wrong);
        }
    }
    Ok(findings)
}

/// What the answering program of a module in a folder prints about each question, or why it does
/// not.
fn answers(
    language: Language,
    name: &str,
    folder: &Path,
    answering: Answering,
    evaluations: &[Evaluation<'_>],
) -> Vec<Result<String, String>> {
    match answering {
        Answering::OneByOne(command) => {
            let command = language.command(command, name, folder);
            let answers = evaluations.iter().map(|one| {
                let command = [command.as_slice(), &one.arguments].concat();
                answered(folder, &command, &one.questions.text, one.variant)
            });
            answers.collect()
        }
        Answering::Together { interpreter, text } => {
            let mut command = language.command(interpreter, name, folder);
            let arguments = [text, &folder.display().to_string(), name];
            command.extend(arguments.map(str::to_owned));
            let lines = evaluations.iter().map(|one| format!("{}\n", one.json()));
            let answers = answered(folder, &command, &lines.collect::<String>(), "");
            let mut lines = answers.as_deref().unwrap_or("").lines();
            let answers = evaluations.iter().map(|_| {
                answers.as_ref().map_err(String::clone)?;
                let line = lines.next();
                let line = line.and_then(|line| serde_json::from_str(line).ok());
                line.ok_or_else(|| format!("{}: ended without an answer", command[0]))
            });
            answers.collect()
        }
    }
}

/// What a command prints about a question, which it reads from a file of the folder.
fn answered(
    folder: &Path,
    command: &[String],
    question: &str,
    variant: &str,
) -> Result<String, String> {
    let path = folder.join("question");
    let file = fs::write(&path, question).and_then(|()| File::open(&path));
    let file = file.map_err(|error| format!("{}: {error}", path.display()))?;
    printed(command, file.into(), variant)
}

/// Functions that the answering program evaluates together, with some parameters.
struct Evaluation<'a> {
    /// Empty for the solution of the file.
    variant: &'a str,
    model: &'a Model,
    arguments: Vec<String>,
    questions: Rc<Questions>,
    settings: Vec<ParameterValue>,
    /// Of all components.
    names: Vec<String>,
    roots: Vec<NodeId>,
}

/// What is asked about a model, with the parameters of the file, then with others.
///
/// * `with_others`: whether other parameters are tried, too.
fn evaluations<'a>(
    variant: &'a str,
    model: &'a Model,
    language: Language,
    sampling: &Sampling,
    with_others: bool,
) -> Result<Vec<Evaluation<'a>>, InputError> {
    let functions = functions(model, language);
    let rounds = answered_together(model, &functions);
    let other = settings(model);
    let mut settings = vec![vec![]];
    if with_others && !other.is_empty() {
        settings.push(other);
    }
    let mut evaluations = vec![];
    for round in rounds {
        let questions = Rc::new(questions(model, round.face, sampling)?);
        for settings in &settings {
            let of_settings = settings.iter().map(|ParameterValue { parameter, value }| {
                format!("{}={value:?}", model.problem.parameters[*parameter].name)
            });
            let functions = round.functions.iter();
            evaluations.push(Evaluation {
                variant,
                model,
                arguments: std::iter::once(round.argument.to_owned())
                    .chain(of_settings)
                    .collect(),
                questions: Rc::clone(&questions),
                settings: settings.clone(),
                names: functions
                    .clone()
                    .flat_map(|f| f.components.clone())
                    .collect(),
                roots: functions.flat_map(|f| f.roots.clone()).collect(),
            });
        }
    }
    Ok(evaluations)
}

/// All parameters that depend on no other, a thousandth larger.
fn settings(model: &Model) -> Vec<ParameterValue> {
    let parameters = &model.problem.parameters;
    let is_free = |one: &Parameter| !parameters.iter().any(|other| one.depends_on(other));
    let values = parameters.iter().zip(&model.graph.parameters);
    values
        .enumerate()
        .filter(|(_, (parameter, _))| is_free(parameter))
        .map(|(parameter, (_, value))| ParameterValue {
            parameter,
            value: 1.001 * value,
        })
        .collect()
}

impl Evaluation<'_> {
    /// The question as a line.
    fn json(&self) -> serde_json::Value {
        serde_json::json!({
            "variant": self.variant,
            "arguments": self.arguments,
            "text": self.questions.text,
        })
    }

    /// What differs from the values of the model. A definition may lack a value where no source
    /// has it: there nothing is compared.
    fn compared(&self, answer: &str, language: Language) -> Result<Vec<Finding>, String> {
        let points = &self.questions.points;
        let found = ask::read(answer, language.name(), &self.names, points.len(), |_| true);
        let found = found.map_err(|error| error.problem)?;
        if !found.iter().map(|one| &one.name).eq(&self.names) {
            return Err(format!("expected the names {:?}, found others", self.names));
        }
        let parameters = self.model.problem.parameter_values(&self.settings);
        let parameters = parameters.map_err(|error| error.to_string())?;
        let tape = Tape::new(&self.model.graph, &self.roots);
        let mut worst = vec![0.0_f64; self.names.len()];
        for (place, point) in points.iter().enumerate() {
            let right = tape.with(point, &parameters).roots;
            for ((right, found), worst) in right.iter().zip(&found).zip(&mut worst) {
                let share = difference(right, found.values[place]);
                if right.value.is_finite() {
                    *worst = worst.max(if share.is_nan() { f64::INFINITY } else { share });
                }
            }
        }
        let changed = match self.settings.is_empty() {
            true => "",
            false => " with other parameters",
        };
        let wrong = self.names.iter().zip(worst).filter(|pair| pair.1 > 0.0);
        let findings = wrong.map(|(name, worst)| {
            let text = format!("{name} differs{changed} by {worst:.3e} of its size");
            finding("emitted", language.name(), text, Some(worst))
        });
        Ok(findings.collect())
    }
}

/// A difference as a share of the size; 0 if it is rounding.
fn difference(right: &SizedValue, found: f64) -> f64 {
    let difference = (right.value - found).abs();
    // Not a difference of zero over a size of zero.
    if difference <= SAME * right.size {
        0.0
    } else {
        difference / right.size
    }
}
