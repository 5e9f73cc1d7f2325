//! `bench`: run time against error, and times of steps, on this machine. No verdict depends on it.
//!
//! The runs and their errors are those that the studies of work list; the benchmark adds a clock.

mod page;
mod step_time;

use std::path::{Path, PathBuf};

use convergence_study::{
    CaseFailure, Described, Project, Table, Verdict, atomic,
    command_line::{Titles, Unusable},
};
use serde::Serialize;
use thermobeam_study::kinds::work_precision::method::{Trial, no_clock};
use thermobeam_study::kinds::work_precision::{Target, WorkPrecision};
use thermobeam_study::scene::Scene;

use page::{Drawing, page};

/// The studies whose runs are timed, and their problems in words.
const PROBLEMS: [(&str, &str); 2] = [
    (
        "work-precision-paper",
        "the paper's first experiment over [0, 1]",
    ),
    ("work-precision-manufactured", "the manufactured solution"),
];

/// Elements of the scaling table.
const ELEMENTS: [usize; 6] = [10, 100, 1_000, 10_000, 100_000, 1_000_000];

/// The scene whose steps are timed.
const SCENE: &str = "studies/scenes/paper-1-beta-0.toml";

/// How often a run is timed; the fastest counts, since other load on the machine only slows a run.
const REPEATS: usize = 5;

/// Run time against error, and time per step, on this machine
///
/// Times the runs that the studies work-precision-* list. With --out it writes DIR/bench.md, its
/// figures, and the times as DIR/bench/runs.json; this project's are in reports.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Writes the report, its figures and the times there
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    titles: Titles,
}

/// A timed run.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Timed {
    /// The method.
    method: &'static str,
    /// Elements and steps, or degrees and largest step.
    resolution: String,
    /// Largest error in the norm of Theorem 3.4.
    norm: f64,
    /// Largest error of u(1, t).
    tip: f64,
    /// CPU seconds.
    seconds: f64,
}

/// The timed runs of a problem.
#[derive(Debug, Serialize)]
struct Problem {
    /// The study that lists them.
    study: &'static str,
    #[serde(skip)]
    in_words: &'static str,
    runs: Vec<Timed>,
    /// The errors for which the study lists them.
    #[serde(skip)]
    targets: Vec<Target>,
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

/// Runs the command.
pub(crate) fn run(project: &Project, arguments: &Arguments) -> Result<Verdict, Unusable> {
    let root = Project::root()?;
    // What the benchmark writes is no change of what it ran.
    let here = Project::provenance(&root);
    let mut problems = vec![];
    for (study, in_words) in PROBLEMS {
        problems.push(Problem::timed(&root, study, in_words)?);
    }
    let text = page(project, &problems, &step_tables(&root)?) + &here.join(" ") + "\n";
    let Some(out) = &arguments.out else {
        println!("{text}nothing is written without --out");
        return Ok(Verdict::Pass);
    };
    let folder = out.join("bench");
    atomic::prepare_folder(&folder)?;
    atomic::write(
        &folder.join("runs.json"),
        serde_json::to_string_pretty(&problems)? + "\n",
    )?;
    for Drawing { file, svg, .. } in problems.iter().flat_map(Problem::drawings) {
        atomic::write(&folder.join(file), arguments.titles.of(svg))?;
    }
    let file = out.join("bench.md");
    atomic::write(&file, text)?;
    println!("written to {}", file.display());
    Ok(Verdict::Pass)
}

impl Problem {
    /// Times the runs that a study lists.
    ///
    /// # Errors
    /// A study that cannot be read, or a run that does not finish.
    fn timed(root: &Path, id: &'static str, in_words: &'static str) -> Result<Self, Unusable> {
        let file = root.join("studies").join(format!("{id}.toml"));
        let study = Described::<WorkPrecision>::read(&file)?.kind;
        let runs = study.trials().iter().map(|trial| timed(&study, trial));
        let runs: Result<Vec<Timed>, CaseFailure> = runs.collect();
        let runs =
            runs.map_err(|failure| Unusable::because(&format!("{id}: {}", failure.reason)))?;
        Ok(Self {
            study: id,
            in_words,
            runs,
            targets: study.targets().to_vec(),
        })
    }
}

/// A run, with the time of the fastest repetition. Looking at the errors would lengthen it: the
/// repetitions do not.
///
/// # Errors
/// A run that does not finish.
fn timed(study: &WorkPrecision, trial: &Trial) -> Result<Timed, CaseFailure> {
    let errors = study.measure(trial, no_clock)?.errors;
    let mut seconds = f64::INFINITY;
    for _ in 0..REPEATS {
        seconds = seconds.min(study.seconds(trial, cpu_seconds)?);
    }
    let resolution = trial.resolution.to_string();
    eprintln!("{}, {resolution}: {seconds:.1e} s", trial.method.name);
    Ok(Timed {
        method: trial.method.name,
        resolution,
        norm: errors.norm,
        tip: errors.tip,
        seconds,
    })
}

fn step_tables(root: &Path) -> Result<[Table; 3], Unusable> {
    let scene = Scene::read(root.join(SCENE))?;
    Ok([
        step_time::ways(&scene, 100)?,
        step_time::ways(&scene, 1000)?,
        step_time::scaling(&scene, &ELEMENTS)?,
    ])
}
