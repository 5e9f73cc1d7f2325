//! How a program is started: what all kinds of study of a program have in their table `[program]`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use super::command::{Invocation, filled};
use crate::input::{Positive, Refusal, visible};
use crate::run::time_limit;

/// A number passed to a case, by its name.
pub(crate) type CaseParameter = (&'static str, f64);

/// The default time limit of a case.
const TIME_LIMIT: Duration = Duration::from_secs(600);

/// What `program.command` must be.
pub(super) const COMMAND: &str = "a list of the program and its arguments, each a text in quotes";
/// What a time limit must be.
pub(super) const SECONDS: &str = "a number of seconds > 0";
const WITHOUT_ZERO: &str = "a text without the character 0";

/// A program, ready to be started for any case: its command with placeholders, without input.
#[derive(Debug, Clone)]
pub(super) struct Launch(pub(super) Invocation);

/// The table `[program]`, as the kind `taylor` has it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct LaunchKeys {
    /// the program and its arguments, without a shell; `{eps}` stands for the step, `{seed}` for
    /// the number by which it draws the direction, without them the program reads both as JSON from
    /// standard input
    #[schemars(extend("title" = COMMAND))]
    pub(super) command: Vec<String>,
    /// the folder in which it runs, relative to that of this file, which it is without it
    pub(super) directory: Option<String>,
    /// variables of the program's environment, beside those of the harness
    #[serde(default)]
    pub(super) env: BTreeMap<String, String>,
    /// the time limit of a case in seconds; without it 600
    #[schemars(extend("title" = SECONDS))]
    pub(super) time_limit: Option<Positive>,
}

impl LaunchKeys {
    /// The program.
    ///
    /// * `folder`: the folder of the file; `values`: those of a case, whose names placeholders may
    ///   have.
    ///
    /// # Errors
    /// At a key of the table.
    pub(super) fn launch(self, folder: &Path, values: &[CaseParameter]) -> Result<Launch, Refusal> {
        let seconds = self.time_limit.map(Positive::get);
        let time_limit = seconds.map(Duration::try_from_secs_f64);
        Ok(Launch(Invocation {
            directory: directory(self.directory.as_deref(), folder)?,
            words: words(self.command, values)?,
            time_limit: time_limit
                .unwrap_or(Ok(TIME_LIMIT))
                .map_err(|_| Refusal::written("time_limit", SECONDS))?,
            variables: variables(self.env)?,
            input: String::new(),
        }))
    }
}

/// The folder in which the program runs, as an absolute path: the program's name is relative to
/// it, too.
fn directory(name: Option<&str>, folder: &Path) -> Result<PathBuf, Refusal> {
    let here = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let Some(name) = name else {
        return here
            .canonicalize()
            .map_err(|error| Refusal::new("directory", error.to_string(), "a folder"));
    };
    let path = here.join(name);
    let absolute = path.canonicalize().ok().filter(|path| path.is_dir());
    absolute.ok_or_else(|| {
        let more = format!(
            ", but {} is no folder",
            visible(&path.display().to_string())
        );
        let allowed = "a folder, relative to that of this file";
        Refusal::written_and("directory", more, allowed)
    })
}

/// The variables of `env`.
fn variables(env: BTreeMap<String, String>) -> Result<Vec<(String, String)>, Refusal> {
    for (name, value) in &env {
        let path = format!("env.{name}");
        if name.is_empty() || name.contains(['=', '\0']) {
            let found = format!("the name \"{}\"", visible(name));
            let allowed = "a name of a variable, without `=`";
            return Err(Refusal::new(path, found, allowed));
        }
        if value.contains('\0') {
            return Err(Refusal::written(path, WITHOUT_ZERO));
        }
    }
    Ok(env.into_iter().collect())
}

/// The words of the command, whose placeholders have values.
fn words(command: Vec<String>, values: &[CaseParameter]) -> Result<Vec<String>, Refusal> {
    match command.first().map(String::as_str) {
        None => return Err(Refusal::written("command", COMMAND)),
        Some("") => return Err(Refusal::written("command[0]", "the name of a program")),
        Some(_) => {}
    }
    for (place, word) in command.iter().enumerate() {
        let path = format!("command[{place}]");
        if word.contains('\0') {
            return Err(Refusal::written(path, WITHOUT_ZERO));
        }
        filled(word, values)
            .map_err(|unfilled| Refusal::misread(path, unfilled.offset, unfilled.reason))?;
    }
    Ok(command)
}

impl Launch {
    /// Whether the program receives the value of that name: its command has the placeholder, or no
    /// placeholder at all, and then it reads all values from standard input.
    ///
    /// * `values`: those of a case.
    pub(super) fn tells(&self, name: &str, values: &[CaseParameter]) -> bool {
        // Without its value the placeholder is refused.
        let others: Vec<CaseParameter> =
            values.iter().copied().filter(|one| one.0 != name).collect();
        let lacks = |word: &String| filled(word, &others).is_err();
        self.is_told_by_input() || self.0.words.iter().any(lacks)
    }

    /// Whether the command has no placeholder.
    fn is_told_by_input(&self) -> bool {
        // Without a value every placeholder is refused.
        self.0.words.iter().all(|word| filled(word, &[]).is_ok())
    }

    /// The command of a case. Without placeholders the program reads the case from standard input.
    pub(super) fn invocation(&self, parameters: &[CaseParameter]) -> Invocation {
        // The reader of the file has refused words whose placeholders have no value.
        let words = self.0.words.iter();
        let words = words.map(|word| filled(word, parameters).unwrap_or_else(|_| word.clone()));
        let input = if self.is_told_by_input() {
            json(parameters)
        } else {
            String::new()
        };
        Invocation {
            words: words.collect(),
            input,
            time_limit: time_limit::granted()
                .map_or(self.0.time_limit, |limit| limit.min(self.0.time_limit)),
            ..self.0.clone()
        }
    }
}

/// Everything that the program receives, as one JSON object on one line; whole numbers have no
/// decimal point.
pub(super) fn json(parameters: &[CaseParameter]) -> String {
    let entries: Vec<String> = parameters
        .iter()
        .map(|(name, value)| format!("\"{name}\": {value}"))
        .collect();
    format!("{{{}}}\n", entries.join(", "))
}
