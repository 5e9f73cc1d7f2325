//! A project's description of itself for the harness.

use serde_json::Value;

use crate::study::{KindRow, Study};

/// A project whose studies the harness runs, judges and reports on.
#[derive(Debug, Clone, Copy)]
pub struct Project {
    /// Its name, for JUnit reports.
    pub name: &'static str,
    /// The command that users type before the harness's commands, such as `cargo xtask`.
    pub command: &'static str,
    /// A one-sentence description, for `--help`.
    pub about: &'static str,
    /// The kinds of study that it has.
    pub kinds: &'static [KindRow],
    /// The studies that it has in code, beside those of files.
    pub studies: &'static [fn() -> Box<dyn Study>],
    /// The groups that studies may name, in the order of reports: the property claimed, such as
    /// `space`.
    pub groups: &'static [&'static str],
    /// Its own words, such as norms: the reference page of its files says what they mean.
    pub terms: &'static [Term],
    /// The files that it reads beside studies, by name, such as `mesh`, with the JSON schema of the
    /// struct that they are read into.
    pub tables: fn() -> Vec<(&'static str, Value)>,
    /// Files that `new` writes.
    pub templates: &'static [Template],
    /// The beginning of the report of a passing run.
    pub front: Front,
    /// About how many seconds a unit of the cost of its cases takes on one thread; `None` if that
    /// is not known.
    pub seconds_per_cost: Option<f64>,
}

impl Project {
    /// A project without kinds, terms and templates;
    /// `Project { kinds: &KINDS, ..Project::new(name, command) }` adds kinds.
    pub const fn new(name: &'static str, command: &'static str) -> Self {
        let about = "Run convergence studies, judge them and report on them";
        Self {
            name,
            command,
            about,
            kinds: &[],
            studies: &[],
            groups: &[],
            terms: &[],
            tables: Vec::new,
            templates: &[],
            front: Front {
                subject: "",
                picture: "",
                finding: "",
                statements: &[],
                plot: "",
                verified: "",
            },
            seconds_per_cost: None,
        }
    }
}

/// What a passing run has verified, in the order of the page. Figures are named by their files; a
/// text may be empty.
#[derive(Debug, Clone, Copy)]
pub struct Front {
    /// What is studied, in one sentence.
    pub subject: &'static str,
    /// A figure of it.
    pub picture: &'static str,
    /// The most important result, in two sentences.
    pub finding: &'static str,
    /// What has been verified, in this order.
    pub statements: &'static [Statement],
    /// The figure that shows the claim of one study.
    pub plot: &'static str,
    /// What was verified and how, in a few sentences.
    pub verified: &'static str,
}

/// A statement that a study answers.
#[derive(Debug, Clone, Copy)]
pub struct Statement {
    /// What is stated.
    pub text: &'static str,
    /// The id of the study whose numbers answer it.
    pub study: &'static str,
    /// The name of the rate that does; empty for the study's key numbers.
    pub rate: &'static str,
}

/// Commented files to start from, which run unchanged.
#[derive(Debug, Clone, Copy)]
pub struct Template {
    /// What is started, such as `study`.
    pub name: &'static str,
    /// The same in a few words, for `--help`.
    pub about: &'static str,
    /// What follows the user's name in the name of each file, such as `.toml`, and its text. In the
    /// text `NAME` stands for that name, `PROGRAM` for the project's command, `DIRECTORY` for the
    /// folder that it runs in, as seen from the files, and `BELOW` for their folder as seen from
    /// there, such as `studies/`.
    pub files: &'static [(&'static str, &'static str)],
    /// The text of `.gitignore` in the folder that the command runs in, if there is none yet; may
    /// be empty.
    pub ignored: &'static str,
    /// The command that takes the first file, as the user's next step.
    pub next: &'static str,
}

/// A word of a project, for the reference page of its files.
#[derive(Debug, Clone, Copy)]
pub struct Term {
    /// The word.
    pub name: &'static str,
    /// What it is, such as `a norm`.
    pub what: &'static str,
    /// What it means.
    pub text: &'static str,
}
