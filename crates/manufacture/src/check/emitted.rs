//! Emitted files, built and run where their tool chain is found.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use super::session::{Question, Session, printed};
use super::{Finding, finding};
use crate::Sampling;
use crate::against::{Questions, questions};
use crate::arithmetic::NodeId;
use crate::arithmetic::tape::{SizedValue, Tape};
use crate::emit::{
    Alternative, AnsweredTogether, Answering, Language, accept, answered_together, emit, functions,
};
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
    let name = language.name();
    let Some(tools) = &language.row().tools else {
        return Ok(vec![]);
    };
    let file = &model.problem.name;
    if let Some(build) = tools.build {
        let build = language.command(build, file, folder);
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
    let mut program = Program::new(tools.answering, language, file, folder);
    let of_file = Alternative {
        name: String::new(),
        model,
    };
    let base = &model.graph.parameters;
    let mut findings = vec![];
    for Alternative {
        name: variant,
        model,
    } in std::iter::once(&of_file).chain(alternatives)
    {
        let mut answer = AnswerProgram {
            program: &mut program,
            variant,
        };
        let points = match variant.is_empty() {
            true => sampling.points,
            false => sampling.points.min(POINTS_OF_VARIANTS),
        };
        let sampling = &Sampling {
            points,
            ..*sampling
        };
        // All models read parameters by the same statements; these differ where a value does.
        let with_others = variant.is_empty() || model.graph.parameters != *base;
        for mut finding in values(model, language, &mut answer, sampling, with_others)? {
            name.clone_into(&mut finding.key);
            if !variant.is_empty() {
                finding.text = format!("{variant}: {}", finding.text);
            }
            findings.push(finding);
        }
    }
    Ok(findings)
}

/// What runs the answering program.
enum Program {
    /// It is started for each question, which a file holds.
    Alone {
        command: Vec<String>,
        question: PathBuf,
    },
    Session(Session),
}

impl Program {
    fn new(answering: Answering, language: Language, file: &str, folder: &Path) -> Self {
        match answering {
            Answering::Alone(command) => Program::Alone {
                command: language.command(command, file, folder),
                question: folder.join("question"),
            },
            Answering::Session { interpreter, text } => {
                let mut command = language.command(interpreter, file, folder);
                let arguments = [text, &folder.display().to_string(), file];
                command.extend(arguments.map(str::to_owned));
                Program::Session(Session::new(command, LIMIT))
            }
        }
    }
}

/// The answering program, for a variant.
struct AnswerProgram<'p> {
    program: &'p mut Program,
    /// Empty for the solution of the file.
    variant: &'p str,
}

impl AnswerProgram<'_> {
    fn to(&mut self, arguments: &[String], text: &str) -> Result<String, InputError> {
        let variant = self.variant;
        match self.program {
            Program::Alone { command, question } => {
                let file = fs::write(&*question, text).and_then(|()| File::open(&*question));
                let file = file.map_err(|error| {
                    InputError::whole(&question.display().to_string(), error.to_string())
                })?;
                let command = [command, arguments].concat();
                printed(&command, file, variant, LIMIT)
                    .map_err(|error| InputError::whole(&command.join(" "), error.to_string()))
            }
            Program::Session(session) => session.answer(&Question {
                variant,
                arguments,
                text,
            }),
        }
    }
}

/// What differs from the values of a model, with the parameters of the file, then with others.
///
/// * `with_others`: whether other parameters are tried, too.
fn values(
    model: &Model,
    language: Language,
    answer: &mut AnswerProgram<'_>,
    sampling: &Sampling,
    with_others: bool,
) -> Result<Vec<Finding>, InputError> {
    let functions = functions(model, language);
    let rounds = answered_together(model, &functions);
    let other = settings(model);
    let mut settings: Vec<&[ParameterValue]> = vec![&[]];
    if with_others && !other.is_empty() {
        settings.push(&other);
    }
    // Drawn once for each part of the domain: every point costs an evaluation of all quantities.
    let mut drawn = BTreeMap::new();
    for round in &rounds {
        if let Entry::Vacant(entry) = drawn.entry(round.face) {
            let Sampling { seed, points, .. } = *sampling;
            entry.insert(questions(model, round.face, seed, points)?);
        }
    }
    let mut findings = vec![];
    for settings in settings {
        for round in &rounds {
            findings.extend(round.held(model, answer, settings, &drawn[&round.face])?);
        }
    }
    Ok(findings)
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

impl AnsweredTogether<'_> {
    /// Holds the functions to their values, with other parameters. A definition may lack a value
    /// where no source has it: there nothing is compared.
    fn held(
        &self,
        model: &Model,
        answer: &mut AnswerProgram<'_>,
        settings: &[ParameterValue],
        questions: &Questions,
    ) -> Result<Vec<Finding>, InputError> {
        let functions = self.functions.iter();
        let names: Vec<&str> = functions
            .flat_map(|f| f.components.iter().map(String::as_str))
            .collect();
        let roots: Vec<NodeId> = self
            .functions
            .iter()
            .flat_map(|f| f.roots.clone())
            .collect();
        let mut arguments = vec![self.argument.to_owned()];
        for ParameterValue { parameter, value } in settings {
            let name = &model.problem.parameters[*parameter].name;
            arguments.push(format!("{name}={value:?}"));
        }
        let rows = answer
            .to(&arguments, &questions.text)
            .map_err(|error| error.to_string())
            .and_then(|text| rows(&text, &names, questions.points.len()));
        let rows = match rows {
            Ok(rows) => rows,
            Err(text) => return Ok(vec![finding("emitted", "", text, None)]),
        };
        let parameters = model.problem.parameter_values(settings)?;
        let tape = Tape::new(&model.graph, &roots);
        let mut worst = vec![0.0_f64; names.len()];
        for (point, row) in questions.points.iter().zip(rows) {
            let right = tape.with(point, &parameters).roots;
            for ((right, found), worst) in right.iter().zip(row).zip(&mut worst) {
                let share = difference(right, found);
                if right.value.is_finite() {
                    *worst = worst.max(if share.is_nan() { f64::INFINITY } else { share });
                }
            }
        }
        let changed = if settings.is_empty() {
            ""
        } else {
            " with other parameters"
        };
        let wrong = names.iter().zip(worst).filter(|pair| pair.1 > 0.0);
        let findings = wrong.map(|(name, worst)| {
            let text = format!("{name} differs{changed} by {worst:.3e} of its size");
            finding("emitted", "", text, Some(worst))
        });
        Ok(findings.collect())
    }
}

fn number_or_nan(word: &str) -> f64 {
    word.parse().unwrap_or(f64::NAN)
}

/// A line of these names, then a line of numbers for each point; what is none is NaN.
fn rows(text: &str, names: &[&str], points: usize) -> Result<Vec<Vec<f64>>, String> {
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
