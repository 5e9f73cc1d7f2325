//! Studies whose cases are runs of another program, in any language.
//!
//! A case is one resolution. The program is started with it, without a shell. Its answer is the
//! last line of its standard output that is a JSON object, or lines of `name = value`: errors by
//! name, values, its own step, its work. If a program fails, hangs or answers nonsense, the case
//! fails, with a one-line reason; none of its processes outlives it.
//!
//! | file | holds |
//! | --- | --- |
//! | `file.rs`, `refine.rs`, `expectation.rs` | the study file: tables, resolutions, claims |
//! | `launch.rs`, `command.rs`, `output.rs`, `guard.rs` | a process: its words, time limit, output and end |
//! | `kept.rs` | answers that are taken again |
//! | `answer.rs`, `lines.rs` | its answer: an object, or lines |
//! | `judge.rs` | from answers to an outcome: errors along a path or over a grid |
//! | `samples.rs` | from runs with several seeds to one answer a level |
//! | `values.rs` | the same for values without an exact solution |
//! | `table.rs`, `sources.rs` | the kind of tables that exist, and the files that they were made from |
//! | `taylor.rs` | the kind that tests derivatives |
//! | `begin.rs` | what `new program` writes |

mod answer;
pub(crate) mod begin;
mod command;
mod expectation;
mod file;
pub(crate) mod guard;
mod judge;
mod kept;
mod launch;
mod lines;
mod output;
#[cfg(feature = "manufacture")]
pub(crate) mod printed;
mod refine;
mod samples;
mod sources;
mod table;
mod taylor;
mod values;

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::input::{Refusal, schema};
use crate::project::{Project, Template};
use crate::study::{Case, CaseFailure, Claim, FromFile, Header, Kind, KindRow, Outcome, Ran};
use command::Invocation;
use convergence_judge::verdict::Floor;
use expectation::Expectation;
use file::ProgramFile;
use kept::Kept;
use launch::Launch;
use refine::Refine;

pub(crate) use answer::Answer;
pub(crate) use refine::RefinedCase;

/// The row of the table of kinds.
const ROW: KindRow = KindRow {
    name: "program",
    schema: schema::of::<ProgramFile>,
    read: Program::read_study,
    why: "The program solves a problem whose exact solution is known, or one of whose results tends to a limit; theory gives the order.",
    judged: "The program is run at each resolution and answers with its errors. The rate at which each error falls is estimated with \
             an interval of measured reliability, which is held against the order: it must lie within the tolerance, whole. Above is as wrong as \
             below. What cannot be told is inconclusive, which is not a pass. A value without an exact solution is judged by the differences \
             of its levels in the same way; Richardson's extrapolation gives its limit and an interval for that, where the differences are \
             asymptotic, and beside it stands the grid convergence index. A run that ends with another exit status than 0, takes too long \
             or answers no finite numbers is a failed case, and fails the study.",
    failure: "The program does not have the order at these resolutions: a term, a boundary value or a quadrature is wrong, or another error, \
              such as that of the time steps, hides the one that was refined. Look which error fails, and from which level on.",
};

/// The files that `new program NAME` writes: a study of a program, and the program.
pub(crate) const TEMPLATE: Template = Template {
    name: "program",
    about: "A convergence study of a program in any language",
    files: &[
        (".toml", include_str!("begin/study.toml")),
        (".py", include_str!("begin/program.py")),
    ],
    ignored: "# Reports that are made anew.\n/report/\n/reports/local/\n",
    next: "study",
};

/// The file that `new manufacture NAME` writes: equations and a chosen solution.
#[cfg(feature = "manufacture")]
const MANUFACTURE: Template = Template {
    name: "manufacture",
    about: "Equations and a chosen exact solution, for sources and data",
    files: &[(".toml", include_str!("begin/manufacture.toml"))],
    ignored: "",
    next: "manufacture",
};

impl Project {
    /// The project of the program `convergence-study`: studies of any program, in the folder that
    /// it runs in.
    pub const PROGRAMS: Self = Self {
        kinds: &[KindRow::PROGRAM, KindRow::TABLE, KindRow::TAYLOR],
        templates: &[
            TEMPLATE,
            #[cfg(feature = "manufacture")]
            MANUFACTURE,
        ],
        ..Project::new("convergence-study", "convergence-study")
    };
}

impl KindRow {
    /// Programs in any language: the kind of `convergence-study` itself.
    pub const PROGRAM: Self = ROW;
    /// Tables of errors that exist.
    pub const TABLE: Self = table::ROW;
    /// Derivatives of programs, by Taylor's theorem.
    pub const TAYLOR: Self = taylor::ROW;
}

impl Template {
    /// A program and its study, in the language that the user chooses.
    pub const PROGRAM: Self = TEMPLATE;
    /// A file of `manufacture`.
    #[cfg(feature = "manufacture")]
    pub const MANUFACTURE: Self = MANUFACTURE;
}

/// A study of a program, validated.
#[derive(Debug, Clone)]
pub(crate) struct Program {
    launch: Launch,
    /// The answers that it keeps, if it does.
    kept: Option<Kept>,
    /// What is known of round-off.
    floor: Floor,
    refine: Refine,
    expect: Vec<Expectation>,
    /// The file of `manufacture` whose module the program uses, as an absolute path.
    manufactured: Option<PathBuf>,
    /// The number of levels, in place of that of the list.
    most_levels: Option<usize>,
}

/// The environment variable by which the module of `manufacture` chooses its solution.
const VARIANT: &str = "MANUFACTURE_VARIANT";

impl FromFile for Program {
    type File = ProgramFile;

    fn from_file(file: ProgramFile, header: &Header, folder: &Path) -> Result<Self, Refusal> {
        file.program(folder, header.guard)
    }
}

/// A case that was run.
type CaseRun = Ran<RefinedCase, Answer>;

impl Program {
    /// The claims about rates, of errors or of values.
    fn claims(&self, of_values: bool) -> Vec<(String, Claim)> {
        let expectations = self
            .expect
            .iter()
            .filter(|expected| expected.is_value == of_values && expected.exact.is_none());
        expectations
            .map(|expected| (expected.name.clone(), expected.claim))
            .collect()
    }

    /// Runs the program, and takes the time.
    fn timed(&self, invocation: &Invocation) -> Result<Answer, CaseFailure> {
        let started = Instant::now();
        let answer = invocation.run(&self.expect)?;
        Ok(Answer {
            seconds: started.elapsed().as_secs_f64(),
            ..answer
        })
    }
}

impl Kind for Program {
    type Data = RefinedCase;
    type Found = Answer;

    fn cases(&self) -> Vec<Case<RefinedCase>> {
        let cases = self.refine.cases().into_iter();
        let cases = cases.map(|data| Case::new(data.label.clone(), data.cost(), data));
        cases.take(self.most_levels.unwrap_or(usize::MAX)).collect()
    }

    fn more(&self, ran: &[CaseRun]) -> Option<Case<RefinedCase>> {
        let is_next = judge::goes_on(self, ran);
        let data = is_next.then(|| self.refine.finer(&ran[ran.len() - 1].case.data, ran.len()))?;
        Some(Case::new(data.label.clone(), data.cost(), data))
    }

    fn run(&self, case: &RefinedCase) -> Result<Answer, CaseFailure> {
        let invocation = self.launch.invocation(&case.parameters);
        let Some(kept) = &self.kept else {
            return self.timed(&invocation);
        };
        let of_cheapest = self.launch.invocation(&kept.cheapest.parameters);
        kept.answer(
            &case.label,
            [&invocation, &of_cheapest],
            &self.expect,
            || self.timed(&invocation),
        )
    }

    fn keep_answers(&self, folder: &Path, may_reuse: bool) {
        if let Some(kept) = &self.kept {
            kept.keep_in(folder, may_reuse);
        }
    }

    fn failure(&self, answer: &Answer) -> Option<CaseFailure> {
        answer.failure.clone()
    }

    fn judge(&self, ran: &[CaseRun]) -> Outcome {
        judge::judge(self, ran)
    }

    fn manufactured(&self) -> Option<&Path> {
        self.manufactured.as_deref()
    }

    fn with_variant(&self, variant: &str) -> Option<Self> {
        self.manufactured()?;
        let mut study = self.clone();
        study.kept = None;
        // The last one of a name counts.
        study
            .launch
            .0
            .variables
            .push((VARIANT.to_owned(), variant.to_owned()));
        Some(study)
    }

    fn levels(&self) -> Option<usize> {
        let listed = self.refine.resolutions().len();
        self.refine.can_add().then_some(listed)
    }

    fn with_levels(&self, count: usize) -> Option<Self> {
        self.levels()?;
        Some(Self {
            most_levels: Some(count),
            ..self.clone()
        })
    }
}
