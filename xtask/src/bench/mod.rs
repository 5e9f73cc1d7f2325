//! `bench`: run time against error, and times of steps, on this machine. No verdict depends on it.
//!
//! The runs are kept in a record, [`record::FILE`], so that the benchmark can be made in pieces;
//! report and figures come from it.

mod page;
mod record;
mod search;
mod step_time;

use std::path::{Path, PathBuf};
use std::time::Instant;

use convergence_study::{
    CaseFailure, Project, Table, Verdict,
    internal::{
        cli::{
            exit::{CommandOutcome, Unusable},
            workspace,
        },
        input, report, run,
        store::{Provenance, atomic},
        study::Described,
    },
};
use serde::Deserialize;
use thermobeam_study::kinds::work_precision::WorkPrecision;
use thermobeam_study::kinds::work_precision::method::{METHODS, NamedMethod};
use thermobeam_study::scene::Scene;

use page::{LIBRARY, PROBLEMS};
use record::{Record, Timed};
use search::MethodSearch;

/// Elements of the scaling table.
const ELEMENTS: [usize; 6] = [10, 100, 1_000, 10_000, 100_000, 1_000_000];

/// The scene whose steps are timed.
const SCENE: &str = "studies/scenes/paper-1-beta-0.toml";

/// How the runs of the library are made.
const RECIPE: &str = "CVODE is run by hand: `apt-get install libsundials-dev`, compile `studies/programs/cvode.cpp` as \
                      `studies/programs/cvode.toml` says, `./cvode > cvode.json`, `cargo xtask bench --only CVODE --beside cvode.json --out \
                      reports`. Its space is that of dG, on one or two elements of degree p; its relative and absolute tolerance is given; its \
                      work, of dense matrices, is of another kind and not counted. Its errors are those to a run of its own with two \
                      elements of degree 30 and tolerance 1e-12.";

/// Run time against error, and time per step, on this machine
///
/// Takes half an hour of CPU time, or a piece of it with --only. With --out it keeps the runs in
/// DIR/bench/runs.json, and writes DIR/bench.md and its figures from all runs that are there; this
/// project's is in reports.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Makes only the runs of this method, of this problem (a study), or `steps`; again for more
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// CPU seconds that a run may take; for all pieces the same, since a dash means that it was not
    /// enough
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    limit: f64,
    /// Output of studies/programs/cvode.cpp on this machine
    #[arg(long, value_name = "FILE")]
    beside: Option<PathBuf>,
    /// Writes the report, its figures and the record there
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// CPU seconds of this thread: on a machine with other load the time of the clock on the wall means
/// little.
#[cfg(unix)]
fn cpu_seconds() -> f64 {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map_or(f64::NAN, |time| {
        time.tv_sec() as f64 + 1e-9 * time.tv_nsec() as f64
    })
}

/// Seconds since the program's first reading.
#[cfg(not(unix))]
fn cpu_seconds() -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static FIRST: OnceLock<Instant> = OnceLock::new();
    FIRST.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// The output of `studies/programs/cvode.cpp`.
#[derive(Debug, Deserialize)]
struct Library {
    runs: Vec<LibraryRun>,
}

#[derive(Debug, Deserialize)]
struct LibraryRun {
    elements: usize,
    degree: usize,
    tolerance: f64,
    norm: f64,
    tip: f64,
    milliseconds: f64,
}

/// Whether a name of `--only` is that of a problem.
fn is_problem(name: &str) -> bool {
    PROBLEMS.iter().any(|(id, _)| *id == name)
}

/// Whether it is that of a method, of the library or of the times of a step.
fn is_method(name: &str) -> bool {
    name == "steps" || name == LIBRARY || METHODS.iter().any(|method| method.name == name)
}

impl Arguments {
    /// Whether a part is to be run: all its names are selected, or nothing is.
    fn selects(&self, method: &str, problem: &str) -> bool {
        let mut problems = self.only.iter().filter(|name| is_problem(name)).peekable();
        let mut methods = self.only.iter().filter(|name| !is_problem(name)).peekable();
        let has_problem = problems.peek().is_none() || problems.any(|name| name == problem);
        let has_method = if methods.peek().is_none() {
            method != "steps" || self.only.is_empty()
        } else {
            methods.any(|name| name == method)
        };
        has_problem && has_method
    }

    fn check(&self) -> Result<(), Unusable> {
        let unknown = self
            .only
            .iter()
            .find(|name| !is_method(name) && !is_problem(name));
        match unknown {
            Some(name) => {
                let methods = METHODS.map(|method| method.name).join(", ");
                let problems = PROBLEMS.map(|problem| problem.0).join(", ");
                Err(Unusable::because(&format!(
                    "--only {name}: expected {methods}, {LIBRARY}, {problems} or steps"
                )))
            }
            None if self.limit > 0.0 => Ok(()),
            None => Err(Unusable::because(&format!(
                "--limit {}: expected a number above 0",
                self.limit
            ))),
        }
    }
}

/// Runs the command.
pub(crate) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    arguments.check()?;
    let root = workspace::root()?;
    let library = arguments.beside.as_deref().map(library).transpose()?;
    let folder = arguments.out.as_ref().map(|out| out.join("bench"));
    let started = Instant::now();
    // What the benchmark writes is no change of what it ran.
    let here = Provenance::collect(&root, String::new(), run::available().get(), &[]).sentences();
    let done = |part: &str| eprintln!("{part}, at {:.0} s", started.elapsed().as_secs_f64());
    let mut record = folder
        .as_deref()
        .map_or(Ok(Record::default()), Record::read)?;
    record.limit = arguments.limit;
    if let Some(runs) = library {
        record.replace(PROBLEMS[0].0, LIBRARY, runs);
    }
    for (id, _) in PROBLEMS {
        let file = root.join("studies").join(format!("{id}.toml"));
        let study = Described::<WorkPrecision>::read(&file)?.kind;
        for method in METHODS {
            if !arguments.selects(method.name, id) {
                continue;
            }
            add(&mut record, (id, &study), method, arguments)?;
            if let Some(folder) = &folder {
                record.write(folder)?;
            }
            done(&format!("{id}, {}", method.name));
        }
    }
    if arguments.selects("steps", PROBLEMS[0].0) {
        record.tables = step_tables(&root)?;
        done("steps");
    }
    let (text, drawings) = page::accuracy(&record);
    let mut text = heading(project, &record) + &text;
    for table in &record.tables {
        text += &format!("## {}\n\n{}\n", table.title, report::markdown(table));
    }
    match (&arguments.out, &folder) {
        (Some(out), Some(folder)) => {
            record.write(folder)?;
            for drawing in drawings {
                atomic::write(&folder.join(&drawing.file), &drawing.svg)?;
            }
            let page = out.join("bench.md");
            let took = started.elapsed().as_secs_f64();
            let end = format!("{} It took {took:.0} s.\n", here.join(" "));
            atomic::write(&page, text + &end)?;
            println!("written to {}", page.display());
        }
        _ => println!("{text}nothing is written without --out"),
    }
    Ok(Verdict::Pass)
}

/// Makes the runs of a method on a problem.
fn add(
    record: &mut Record,
    problem: (&str, &WorkPrecision),
    method: NamedMethod,
    arguments: &Arguments,
) -> Result<(), Unusable> {
    let reference = problem
        .1
        .reference()
        .map_err(|failure| unusable(problem.0, &failure))?;
    let error = reference.map_or([0.0; 2], |(_, error)| [error.norm, error.tip]);
    record.references.insert(problem.0.to_owned(), error);
    let runs = MethodSearch::new(problem, method, arguments.limit, cpu_seconds)
        .all()
        .map_err(|failure| unusable(problem.0, &failure))?;
    record.replace(problem.0, method.name, runs);
    Ok(())
}

/// The error of a problem that cannot be run.
fn unusable(problem: &str, failure: &CaseFailure) -> Unusable {
    Unusable::because(&format!("{problem}: {}", failure.reason))
}

fn step_tables(root: &Path) -> Result<Vec<Table>, Unusable> {
    let scene = Scene::read(root.join(SCENE))?;
    Ok(vec![
        step_time::ways(&scene, 100)?,
        step_time::ways(&scene, 1000)?,
        step_time::scaling(&scene, &ELEMENTS)?,
    ])
}

/// The runs of a library, from the output of its program.
fn library(path: &Path) -> Result<Vec<Timed>, Unusable> {
    let text = input::read_text(path)?;
    let library: Library = serde_json::from_str(&text).map_err(|error| {
        Unusable::because(&format!(
            "{}: {error}; expected what studies/programs/cvode.cpp prints",
            path.display()
        ))
    })?;
    let mut runs = vec![];
    for run in library.runs {
        let elements = if run.elements == 1 {
            ""
        } else {
            ", 2 elements"
        };
        runs.push(Timed {
            problem: PROBLEMS[0].0.to_owned(),
            method: LIBRARY.to_owned(),
            resolution: format!(
                "p = {}, tolerance {:e}{elements}",
                run.degree, run.tolerance
            ),
            norm: run.norm,
            tip: run.tip,
            work: None,
            seconds: 1e-3 * run.milliseconds,
        });
    }
    Ok(runs)
}

fn heading(project: &Project, record: &Record) -> String {
    let command = format!("{} bench --out reports", project.command);
    format!(
        "# Benchmarks\n\nWritten by `{command}`; the machine of the last piece is named at the end. All methods aim at the same \
         errors, the largest over equidistant times. A run may take {} seconds of CPU time; only that limits elements and steps. \
         Nothing is extrapolated. **A dash: not reached within that time.** Short runs are the fastest of several; the loads of the \
         manufactured solution count. Counted work is the same on every machine; another machine gives other times: compare \
         ratios.\n\n{RECIPE}\n\n",
        record.limit
    )
}
