//! Cases on all threads, their lines as they come.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::panic::{self, AssertUnwindSafe};
use std::time::Duration;

use rayon::ThreadPoolBuilder;
use rayon::iter::{ParallelBridge, ParallelIterator};
use serde::Serialize;

use super::{Case, Sweep};
use crate::simulate::{Object, Recording, Simulator};
use crate::time_limit;

/// The result of one case: a line of JSON without its newline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// The case's number.
    pub case: usize,
    /// Whether it came to its end.
    pub passed: bool,
    /// The line.
    pub json: String,
}

/// What a line holds; names are a contract, more may be added.
#[derive(Serialize)]
struct Record<'a> {
    case: usize,
    status: &'static str,
    parameters: &'a Case<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    result: Option<Object<'a>>,
}

impl Line {
    /// Computes a case. Whatever becomes of it, there is a line.
    ///
    /// * `limit`: the longest that it may take; the line then says where it was stopped.
    pub fn compute(sweep: &Sweep, index: usize, limit: Option<Duration>) -> Self {
        let compute = || time_limit::within(limit, || simulate(sweep, index)).0;
        // A panic is a mistake of the program's, yet no reason to lose the other cases.
        panic::catch_unwind(AssertUnwindSafe(compute)).unwrap_or_else(|_| {
            let case = sweep.case(index);
            Self::failed(&case, "the program panicked".to_owned())
        })
    }

    fn failed(case: &Case<'_>, reason: String) -> Self {
        Self::of(&Record { case: case.index, status: "failed", parameters: case, reason: Some(reason), result: None })
    }

    fn of(record: &Record<'_>) -> Self {
        // Plain structs, numbers and texts: there is nothing that cannot be written.
        let json = serde_json::to_string(record).unwrap_or_else(|error| unreachable!("{error}"));
        Self { case: record.case, passed: record.reason.is_none(), json }
    }
}

fn simulate(sweep: &Sweep, index: usize) -> Line {
    let case = sweep.case(index);
    let scene = match sweep.scene(&case) {
        Ok(scene) => scene,
        Err(error) => {
            // The place is one in a text that nobody has written.
            let field = error.field.map(|field| format!("{field}: ")).unwrap_or_default();
            return Line::failed(&case, format!("{field}{}", error.complaint));
        }
    };
    let run = match Simulator::new(&scene) {
        Ok(simulator) => simulator.run(Recording::Summary, &mut |_| ()),
        Err(error) => return Line::failed(&case, error.to_string()),
    };
    let reason = run.failure.as_ref().map(ToString::to_string);
    let status = if reason.is_none() { "done" } else { "failed" };
    let result = Some(Object::reproducible(&scene, &run));
    Line::of(&Record { case: index, status, parameters: &case, reason, result })
}

/// Computes the cases on `jobs` threads (0: all there are), each for as long as `limit` allows, and hands each line to
/// `sink` as soon as it is there.
///
/// Cases are begun in the order given, so that lines come nearly in that order; `sink` is called from every thread.
///
/// # Errors
/// That of `sink`, which ends the sweep, or of threads that cannot be started.
pub fn run(
    sweep: &Sweep,
    cases: impl Iterator<Item = usize> + Send,
    jobs: usize,
    limit: Option<Duration>,
    sink: impl Fn(Line) -> io::Result<()> + Sync,
) -> io::Result<()> {
    let pool = ThreadPoolBuilder::new().num_threads(jobs).build().map_err(io::Error::other)?;
    pool.install(|| cases.par_bridge().try_for_each(|index| sink(Line::compute(sweep, index, limit))))
}

/// Puts lines back into the order of their cases, holding those back that came early.
pub struct InOrder<W> {
    output: W,
    /// Cases whose line has not been written, in order.
    expected: std::vec::IntoIter<usize>,
    next: Option<usize>,
    early: BTreeMap<usize, String>,
}

impl<W: Write> InOrder<W> {
    /// * `expected`: the cases whose lines will come, increasing.
    pub fn new(output: W, expected: Vec<usize>) -> Self {
        let mut expected = expected.into_iter();
        let next = expected.next();
        Self { output, expected, next, early: BTreeMap::new() }
    }

    /// Takes a line and writes what is due.
    ///
    /// # Errors
    /// That of the output.
    pub fn add(&mut self, line: Line) -> io::Result<()> {
        self.early.insert(line.case, line.json);
        while let Some(json) = self.next.and_then(|next| self.early.remove(&next)) {
            writeln!(self.output, "{json}")?;
            self.next = self.expected.next();
        }
        self.output.flush()
    }
}
