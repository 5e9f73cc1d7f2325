//! `run SCENE`: simulates one scene.

mod accuracy;
mod any_order;
mod summary;

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use convergence_study::run::time_limit;
use convergence_study::store::atomic;
use serde::Serialize;
use thermobeam_study::predict::Unreachable;
use thermobeam_study::run::simulate::{Object, Recording, Simulator, figures};
use thermobeam_study::scene::{Method, Scene};

use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::cli::flags::Flags;
use convergence_study::cli::interrupt;
use convergence_study::cli::output;
use convergence_study::cli::progress;
use convergence_study::cli::running::seconds;
use convergence_study::judge::verdict::Verdict;

use accuracy::Planned;

/// Simulate one scene
///
/// The folder that --out names gets the time history (history.csv), pictures (SVG) and run.json, the object of --format json.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file, such as studies/scenes/paper-1-beta-0.toml
    scene: PathBuf,
    /// Measure the errors of the result by a run of any order, and what to refine first: by two further runs, with a finer space
    /// alone and with half the steps alone
    #[arg(long)]
    estimate_error: bool,
    /// Choose the cheapest run whose error is no larger than this; it is by dG, whatever the scene's scheme
    #[arg(long, value_name = "ERROR", value_parser = accuracy::target, allow_hyphen_values = true)]
    target_error: Option<f64>,
    /// Keep the scene's own scheme and choose elements and steps for it
    #[arg(long, requires = "target_error")]
    keep_scheme: bool,
    /// What the target error is about
    #[arg(long, value_enum, default_value_t, requires = "target_error")]
    quantity: accuracy::Quantity,
    /// The longest that the run may take; what was done until then is shown, and the exit status is 1 [default: as long as it takes]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_hyphen_values = true)]
    time_limit: Option<Duration>,
    #[command(flatten)]
    flags: Flags,
}

impl Arguments {
    /// Shows the result, and then the complaint if there is one: the verdict is fail.
    fn show(
        &self,
        complaint: Option<String>,
        object: &impl Serialize,
        sentence: &str,
        text: impl FnOnce() -> String,
    ) -> Outcome {
        let verdict = if complaint.is_none() { Verdict::Pass } else { Verdict::Fail };
        self.flags.show("run", verdict, object, &self.flags.words(verdict, sentence, text))?;
        if let Some(complaint) = complaint {
            output::complain(&format!("{}: {complaint}", self.scene.display()));
        }
        Ok(verdict.into())
    }
}

/// The JSON object, with what was asked for on top.
#[derive(Serialize)]
struct Printed<'a> {
    #[serde(flatten)]
    object: Object<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<accuracy::Object<'a>>,
}

/// Runs the command. Nothing is written, not even the folder made, before the scene has proved usable.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let read = Scene::read(&arguments.scene)?;
    let planned = match arguments.target_error.map(|target| accuracy::plan(arguments, &read, target)).transpose() {
        Ok(planned) => planned,
        Err(error @ Unreachable::Target { .. }) => return Err(Unusable::file(&arguments.scene, &error)),
        Err(error) => {
            output::complain(&format!("{}: {error}", arguments.scene.display()));
            return Ok(Ended::Badly);
        }
    };
    let scene = planned.as_ref().map_or(&read, Planned::scene);
    match scene.method {
        Method::Dg(_) => any_order::simulate(arguments, scene, planned.as_ref()),
        Method::OneStep(_) => one_step(arguments, scene, planned.as_ref()),
    }
}

fn one_step(arguments: &Arguments, scene: &Scene, planned: Option<&Planned>) -> Outcome {
    let simulator = Simulator::new(scene).map_err(|error| Unusable::file(&arguments.scene, &error))?;
    let recording = match &arguments.flags.out {
        Some(folder) => {
            atomic::prepare_folder(folder)?;
            Recording::History
        }
        None => Recording::Summary,
    };
    let bar = progress::bar(&scene.name, scene.steps(), arguments.flags.quiet);
    let (told, steps) = (bar.clone(), scene.steps());
    interrupt::say(move || format!("{} of {steps} steps were done; nothing is kept of them", told.position()));
    let simulate = || simulator.run(recording, &mut |step| bar.set_position(step as u64));
    let (run, _) = time_limit::within(arguments.time_limit, simulate);
    bar.finish_and_clear();
    let written = arguments.flags.out.as_deref().map_or(Ok(vec![]), |folder| {
        let history = run.history.iter().map(|history| ("history.csv", history.csv()));
        write_files(folder, history.chain(figures(scene, &run)))
    })?;
    // A run that failed has nothing whose error could be estimated.
    let wanted = arguments.estimate_error && run.failure.is_none();
    let budget = wanted.then(|| accuracy::budget(arguments, scene)).transpose();
    let known = budget.as_ref().ok().and_then(Option::as_ref);
    let complaint = complaint(run.energy.complaint(run.steps, run.failure.as_ref()), budget.as_ref().err());
    let object = Object::new(scene, &run).with_budget(known);
    let object = Printed { object, accuracy: planned.map(Planned::object) };
    let sentence = format!("{}: {} of {} steps, to t = {}", scene.name, run.steps, scene.steps(), run.last.t);
    arguments.show(complaint, &object, &sentence, || {
        let budget = known.map_or(String::new(), |budget| format!("\n{budget}\n"));
        summary::summary(scene, &run, planned, &written) + &budget
    })
}

/// Why a run has not done what was asked for: there is no error budget, or the `complaint` about its numbers.
fn complaint(complaint: Option<String>, no_budget: Option<&impl Display>) -> Option<String> {
    no_budget.map(|reason| format!("error budget: {reason}")).or(complaint)
}

/// Writes files into a folder; returns their paths.
fn write_files(folder: &Path, files: impl Iterator<Item = (&'static str, String)>) -> io::Result<Vec<PathBuf>> {
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
