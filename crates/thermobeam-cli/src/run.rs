//! `run SCENE`: simulates one scene.

mod accuracy;
mod summary;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use clap::Args;
use convergence_judge::time_limit;
use convergence_study::{
    Verdict,
    internal::{
        cli::{
            exit::{self, CommandOutcome, Unusable},
            flags::Flags,
            running::{self, seconds},
            screen,
        },
        store::atomic,
    },
};
use serde::Serialize;
use thermobeam_study::kinds::tables::cost_of_run;
use thermobeam_study::predict::Unreachable;
use thermobeam_study::predict::estimate::Budget;
use thermobeam_study::run::object::Object;
use thermobeam_study::run::simulate::{Recording, Run, Simulator};
use thermobeam_study::scene::Scene;

use crate::project::NODE_STEP;
use accuracy::Planned;

/// Simulate one scene
///
/// The --out folder gets the time history (history.csv), pictures (SVG) and run.json, the object
/// of --format json.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file, such as studies/scenes/paper-1-beta-0.toml
    scene: PathBuf,
    /// Measure the errors of the result against a run of any order, and find what to refine first
    /// by two further runs: one with only space refined, one with only the step length halved
    #[arg(long)]
    estimate_error: bool,
    /// Choose the cheapest run with at most this error; it uses dG for any scheme of the scene
    #[arg(long, value_name = "ERROR", value_parser = accuracy::target, allow_hyphen_values = true)]
    target_error: Option<f64>,
    /// Keep the scene's own scheme and choose elements and steps for it
    #[arg(long, requires = "target_error")]
    keep_scheme: bool,
    /// The quantity of the target error
    #[arg(long, value_enum, default_value_t, requires = "target_error")]
    quantity: accuracy::QuantityName,
    /// Time limit of the run; the results so far are then shown, and the exit status is 1
    /// [default: none]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    time_limit: Option<Duration>,
    /// Run also what is expected to take minutes
    #[arg(long)]
    yes: bool,
    #[command(flatten)]
    flags: Flags,
}

impl Arguments {
    /// Prints the result, and then the complaint if the verdict is fail.
    fn show(
        &self,
        complaint: Option<String>,
        object: &impl Serialize,
        sentence: &str,
        text: impl FnOnce() -> String,
    ) -> CommandOutcome {
        let verdict = if complaint.is_none() {
            Verdict::Pass
        } else {
            Verdict::Fail
        };
        self.flags.show(
            "run",
            verdict,
            object,
            &self.flags.words(verdict, sentence, text),
        )?;
        if let Some(complaint) = complaint {
            screen::complain(&format!("{}: {complaint}", self.scene.display()));
        }
        Ok(verdict)
    }
}

/// The JSON object, with the requested analyses at its top.
#[derive(Serialize)]
struct Printed<'a> {
    #[serde(flatten)]
    object: Object<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error_budget: Option<&'a Budget>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<accuracy::Object<'a>>,
}

/// Ticks of the progress bar over the scene's time.
const TICKS: f64 = 1000.0;

/// Runs the command. Nothing is written, and no folder is created, before the scene has proved
/// usable.
pub(crate) fn run(arguments: &Arguments) -> CommandOutcome {
    let read = Scene::read(&arguments.scene)?;
    let planned = match arguments
        .target_error
        .map(|target| accuracy::plan(arguments, &read, target))
        .transpose()
    {
        Ok(planned) => planned,
        Err(error @ Unreachable::Target { .. }) => {
            return Err(Unusable::file(&arguments.scene, &error));
        }
        Err(error) => {
            screen::complain(&format!("{}: {error}", arguments.scene.display()));
            return Ok(Verdict::Fail);
        }
    };
    let scene = planned.as_ref().map_or(&read, Planned::scene);
    if !arguments.yes && arguments.time_limit.is_none() {
        running::consent(
            &arguments.scene.display().to_string(),
            NODE_STEP * cost_of_run(scene),
            "--time-limit",
        )?;
    }
    let simulator =
        Simulator::new(scene).map_err(|error| Unusable::file(&arguments.scene, &error))?;
    let run = simulate(arguments, scene, simulator)?;
    let written = arguments
        .flags
        .out
        .as_deref()
        .map_or(Ok(vec![]), |folder| {
            let history = run
                .history
                .iter()
                .map(|history| ("history.csv", history.csv()));
            write_files(folder, history.chain(run.pictures(scene)))
        })?;
    let finished = Finished {
        scene,
        planned: planned.as_ref(),
        run: &run,
        written: &written,
    };
    finished.show(arguments)
}

/// A run that has ended, and what led to it.
struct Finished<'a> {
    scene: &'a Scene,
    /// The search for a target error.
    planned: Option<&'a Planned>,
    run: &'a Run,
    /// The files.
    written: &'a [PathBuf],
}

impl Finished<'_> {
    /// Estimates the error if it is asked for, and prints the result.
    fn show(&self, arguments: &Arguments) -> CommandOutcome {
        let Self {
            scene,
            planned,
            run,
            written,
        } = *self;
        // The error of a failed run cannot be estimated.
        let wanted = arguments.estimate_error && run.failure.is_none();
        let budget = wanted
            .then(|| accuracy::budget(arguments, scene))
            .transpose();
        let known = budget.as_ref().ok().and_then(Option::as_ref);
        let complaint = budget
            .as_ref()
            .err()
            .map(|reason| format!("error budget: {reason}"))
            .or(run.complaint());
        let accuracy = planned.map(Planned::object);
        let object = Printed {
            object: Object::new(scene, run),
            error_budget: known,
            accuracy,
        };
        let sentence = format!(
            "{}: {} steps, to t = {} of {}",
            scene.name, run.steps, run.last.t, scene.t_end
        );
        arguments.show(complaint, &object, &sentence, || {
            let worth = known.map_or(summary::UNKNOWN.to_owned(), ToString::to_string);
            let worth = if planned.is_some() && known.is_none() {
                String::new()
            } else {
                format!("\n{worth}\n")
            };
            summary::summary(scene, run, planned.map(Planned::lines), written) + &worth
        })
    }
}

/// Runs the scene, with a bar of the time reached, and a history if files are requested.
fn simulate(arguments: &Arguments, scene: &Scene, simulator: Simulator) -> io::Result<Run> {
    let recording = match &arguments.flags.out {
        Some(folder) => {
            atomic::prepare_folder(folder)?;
            Recording::History
        }
        None => Recording::Summary,
    };
    let bar = running::counting(
        &scene.name,
        TICKS as usize,
        "parts of the time",
        arguments.flags.quiet,
    );
    let (done, t_end) = (Arc::new(AtomicUsize::new(0)), scene.t_end);
    let steps_done = Arc::clone(&done);
    let shown = bar.clone();
    exit::say(move || {
        let percent = 100.0 * shown.position() as f64 / TICKS;
        format!(
            "{} steps were done, {percent} % of the time; nothing is kept of them",
            steps_done.load(Ordering::Relaxed)
        )
    });
    let mut tell = |step, t: f64| {
        done.store(step, Ordering::Relaxed);
        bar.set_position((TICKS * t / t_end) as u64);
    };
    let (run, _) = time_limit::within(arguments.time_limit, || simulator.run(recording, &mut tell));
    bar.finish_and_clear();
    Ok(run)
}

/// Writes files into a folder; returns their paths.
fn write_files(
    folder: &Path,
    files: impl Iterator<Item = (&'static str, String)>,
) -> io::Result<Vec<PathBuf>> {
    let mut written = Vec::new();
    for (name, content) in files {
        let path = folder.join(name);
        atomic::write(&path, content)?;
        written.push(path);
    }
    // Written with the result.
    written.push(folder.join("run.json"));
    Ok(written)
}
