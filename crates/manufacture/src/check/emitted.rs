//! Emitted files, built and run where their tool chain is found.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::rc::Rc;
use std::time::Duration;

use super::process::printed;
use super::{Finding, finding};
use crate::Sampling;
use crate::against::{Questions, questions};
use crate::arithmetic::NodeId;
use crate::arithmetic::tape::{SizedValue, Tape};
use crate::emit::{Alternative, Answering, Language, accept, answered_together, emit, functions};
use crate::language::tree::Tree;
use crate::model::Model;
use crate::problem::{InputError, ParameterValue, mentions};

/// Values of an emitted file may differ by this times their size.
const SAME: f64 = 1e3 * f64::EPSILON;

/// Points at which the values of a variant are compared, whose statements are those of the file but
/// for the solution.
const POINTS_OF_VARIANTS: usize = 200;

/// An emitted program that takes longer is wrong.
const LIMIT: Duration = Duration::from_secs(600);

fn succeeds(command: &str) -> bool {
    let mut words = command.split(' ');
    let status = Command::new(words.next().unwrap_or_default())
        .args(words)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.is_ok_and(|status| status.success())
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
    let name = language.name();
    let not_run = |reason: &str| {
        vec![Finding {
            fails: false,
            ..finding("emitted", name, format!("not run: {reason}"), None)
        }]
    };
    let Some(tools) = &language.row().tools else {
        return Ok(not_run(
            "values need fenics-ufl and basix, which are not run here; Python has the same statements",
        ));
    };
    if !succeeds(tools.probe) {
        return Ok(not_run(&format!("no {}", tools.missing)));
    }
    for file in emit(model, alternatives, language) {
        let path = folder.join(&file.name);
        let failed = |error: std::io::Error| {
            InputError::whole(&path.display().to_string(), error.to_string())
        };
        fs::write(&path, file.text).map_err(failed)?;
    }
    run(model, alternatives, language, folder, sampling)
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
    let place = Place {
        language,
        name: &model.problem.name,
        folder,
    };
    let failed = |text: String| finding("emitted", language.name(), text, None);
    if let Some(build) = tools.build {
        let build = language.command(build, place.name, folder);
        let output = Command::new(&build[0]).args(&build[1..]).output();
        let output =
            output.map_err(|error| InputError::whole(&build.join(" "), error.to_string()))?;
        if !output.status.success() {
            let message = String::from_utf8_lossy(&output.stderr);
            let first: Vec<&str> = message.lines().take(4).collect();
            let text = format!("does not compile: {}", first.join(" / "));
            return Ok(vec![failed(text)]);
        }
    }
    let mut asked = asked("", model, language, sampling, true)?;
    for alternative in alternatives {
        let sampling = Sampling {
            points: sampling.points.min(POINTS_OF_VARIANTS),
            ..*sampling
        };
        // All models read parameters by the same statements; these differ where a value does.
        let parameters = &alternative.model.graph.parameters;
        let with_others = *parameters != model.graph.parameters;
        let Alternative { name, model } = alternative;
        asked.extend(self::asked(name, model, language, &sampling, with_others)?);
    }
    let mut findings = vec![];
    for (asked, answer) in asked.iter().zip(place.answers(tools.answering, &asked)) {
        let wrong = answer.and_then(|answer| asked.compared(&answer, language));
        for mut wrong in wrong.unwrap_or_else(|text| vec![failed(text)]) {
            if !asked.variant.is_empty() {
                wrong.text = format!("{}: {}", asked.variant, wrong.text);
            }
            findings.push(wrong);
        }
    }
    Ok(findings)
}

/// The module of a language, in a folder.
struct Place<'p> {
    language: Language,
    name: &'p str,
    folder: &'p Path,
}

impl Place<'_> {
    /// What the answering program prints about each question, or why it does not.
    fn answers(&self, answering: Answering, asked: &[Asked<'_>]) -> Vec<Result<String, String>> {
        let Self {
            language,
            name,
            folder,
        } = *self;
        let printed = |command: &[String], text: &str, variant: &str| {
            let question = folder.join("question");
            let file = fs::write(&question, text).and_then(|()| File::open(&question));
            let printed = file.and_then(|file| printed(command, file, variant, LIMIT));
            printed.map_err(|error| format!("{}: {error}", command[0]))
        };
        match answering {
            Answering::OneByOne(command) => {
                let command = language.command(command, name, folder);
                let asked = asked.iter().map(|one| {
                    let command = [command.as_slice(), &one.arguments].concat();
                    printed(&command, &one.questions.text, one.variant)
                });
                asked.collect()
            }
            Answering::Together { interpreter, text } => {
                let mut command = language.command(interpreter, name, folder);
                let arguments = [text, &folder.display().to_string(), name];
                command.extend(arguments.map(str::to_owned));
                let lines: String = asked
                    .iter()
                    .map(|one| format!("{}\n", one.json()))
                    .collect();
                let answers = printed(&command, &lines, "");
                let mut lines = answers.as_deref().unwrap_or("").lines();
                let mut answer = || {
                    answers.as_ref().map_err(String::clone)?;
                    let line = lines
                        .next()
                        .and_then(|line| serde_json::from_str(line).ok());
                    line.ok_or_else(|| format!("{}: ended without an answer", command[0]))
                };
                asked.iter().map(|_| answer()).collect()
            }
        }
    }
}

/// Functions that the answering program evaluates together, with some parameters.
struct Asked<'a> {
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
fn asked<'a>(
    variant: &'a str,
    model: &'a Model,
    language: Language,
    sampling: &Sampling,
    with_others: bool,
) -> Result<Vec<Asked<'a>>, InputError> {
    let functions = functions(model, language);
    let rounds = answered_together(model, &functions);
    let other = settings(model);
    let mut settings = vec![vec![]];
    if with_others && !other.is_empty() {
        settings.push(other);
    }
    // Drawn once for each part of the domain: every point costs an evaluation of all quantities.
    let mut drawn = BTreeMap::new();
    for round in &rounds {
        if let Entry::Vacant(entry) = drawn.entry(round.face) {
            let Sampling { seed, points, .. } = *sampling;
            entry.insert(Rc::new(questions(model, round.face, seed, points)?));
        }
    }
    let mut asked = vec![];
    for settings in settings {
        for round in &rounds {
            let of_settings = settings.iter().map(|ParameterValue { parameter, value }| {
                format!("{}={value:?}", model.problem.parameters[*parameter].name)
            });
            let functions = || round.functions.iter();
            asked.push(Asked {
                variant,
                model,
                arguments: std::iter::once(round.argument.to_owned())
                    .chain(of_settings)
                    .collect(),
                questions: Rc::clone(&drawn[&round.face]),
                settings: settings.clone(),
                names: functions().flat_map(|f| f.components.clone()).collect(),
                roots: functions().flat_map(|f| f.roots.clone()).collect(),
            });
        }
    }
    Ok(asked)
}

/// All parameters that depend on no other, a thousandth larger.
fn settings(model: &Model) -> Vec<ParameterValue> {
    let problem = &model.problem;
    let is_free = |tree: &Tree| {
        let mut others = problem.parameters.iter();
        !others.any(|other| mentions(tree, &other.name))
    };
    let values = problem.parameters.iter().zip(&model.graph.parameters);
    values
        .enumerate()
        .filter(|(_, (parameter, _))| is_free(&parameter.expression.tree))
        .map(|(parameter, (_, value))| ParameterValue {
            parameter,
            value: 1.001 * value,
        })
        .collect()
}

impl Asked<'_> {
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
        let rows = rows(answer, &self.names, points.len())?;
        let parameters = self.model.problem.parameter_values(&self.settings);
        let parameters = parameters.map_err(|error| error.to_string())?;
        let tape = Tape::new(&self.model.graph, &self.roots);
        let mut worst = vec![0.0_f64; self.names.len()];
        for (point, row) in points.iter().zip(rows) {
            let right = tape.with(point, &parameters).roots;
            for ((right, found), worst) in right.iter().zip(row).zip(&mut worst) {
                let share = difference(right, found);
                if right.value.is_finite() {
                    *worst = worst.max(if share.is_nan() { f64::INFINITY } else { share });
                }
            }
        }
        let changed = if self.settings.is_empty() {
            ""
        } else {
            " with other parameters"
        };
        let wrong = self.names.iter().zip(worst).filter(|pair| pair.1 > 0.0);
        let findings = wrong.map(|(name, worst)| {
            let text = format!("{name} differs{changed} by {worst:.3e} of its size");
            finding("emitted", language.name(), text, Some(worst))
        });
        Ok(findings.collect())
    }
}

fn number_or_nan(word: &str) -> f64 {
    word.parse().unwrap_or(f64::NAN)
}

/// A line of these names, then a line of numbers for each point; what is none is NaN.
fn rows(text: &str, names: &[String], points: usize) -> Result<Vec<Vec<f64>>, String> {
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or("").split_whitespace().collect();
    if head != names {
        return Err(format!("expected the names {names:?}, found {head:?}"));
    }
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split_whitespace().map(number_or_nan).collect())
        .collect();
    if let Some(row) = rows.iter().find(|row| row.len() != names.len()) {
        return Err(format!(
            "expected {} numbers, found {}",
            names.len(),
            row.len()
        ));
    }
    if rows.len() != points {
        return Err(format!(
            "expected {points} lines of numbers, found {}",
            rows.len()
        ));
    }
    Ok(rows)
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
