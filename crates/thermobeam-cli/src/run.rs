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
use convergence_study::file::Positive;
use convergence_study::{
    Verdict, atomic,
    command_line::{Flags, Titles, Unusable},
};
use serde::Serialize;
use thermobeam_study::kinds::tables::cost_of_run;
use thermobeam_study::run::object::Object;
use thermobeam_study::run::simulate::{Recording, Run, Simulator};
use thermobeam_study::scene::Scene;

use crate::project::NODE_STEP;

/// Simulate one scene
///
/// The --out folder gets the time history (history.csv), pictures (SVG) and run.json, the object
/// of --format json.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file, such as studies/scenes/paper-1-beta-0.toml
    scene: PathBuf,
    /// Refine, by dG for any scheme of the scene, until two successive runs agree within this error
    /// in u(1, t), and show the finer one; data are looked at in 10 000 points, and what is
    /// narrower may be missed
    #[arg(long, value_name = "ERROR", value_parser = accuracy::target, allow_hyphen_values = true)]
    target_error: Option<Positive>,
    /// Time limit of the run; the results so far are then shown, and the exit status is 1
    /// [default: none]
    #[arg(long, value_name = "SECONDS", value_parser = Flags::seconds, allow_hyphen_values = true)]
    time_limit: Option<Duration>,
    /// Run also what is expected to take minutes
    #[arg(long)]
    yes: bool,
    #[command(flatten)]
    titles: Titles,
    #[command(flatten)]
    flags: Flags,
}

impl Arguments {
    /// A history if files are requested.
    fn recording(&self) -> Recording {
        match &self.flags.out {
            Some(_) => Recording::History,
            None => Recording::Summary,
        }
    }
}

/// The JSON object, with the accuracy at its top if one was requested.
#[derive(Serialize)]
struct Printed<'a> {
    #[serde(flatten)]
    object: Object<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<accuracy::Object<'a>>,
}

/// The file of the time history.
const HISTORY: &str = "history.csv";

/// Ticks of the progress bar over the scene's time.
const TICKS: f64 = 1000.0;

/// Runs the command. Nothing is written, and no folder is created, before the scene has proved
/// usable.
pub(crate) fn run(arguments: &Arguments) -> Result<Verdict, Unusable> {
    let scene = Scene::read(&arguments.scene)?;
    let read = [arguments.scene.display().to_string()];
    let pictures = Run::PICTURES.map(|name| (name, Flags::SVG));
    let own = pictures.into_iter().chain([(HISTORY, "t,u_tip,")]);
    arguments.flags.refuse_others("run", own, &read)?;
    let unusable = |error: &dyn std::error::Error| Unusable::file(&arguments.scene, error);
    let Some(target) = arguments.target_error else {
        if !arguments.yes && arguments.time_limit.is_none() {
            Flags::consent(
                &arguments.scene.display().to_string(),
                NODE_STEP * cost_of_run(&scene),
                "--time-limit",
            )?;
        }
        let simulator = Simulator::new(&scene).map_err(|error| unusable(&error))?;
        let run = simulate(arguments, &scene, simulator)?;
        return show(arguments, &scene, &run, None);
    };
    match accuracy::search(arguments, &scene, target) {
        Ok(reached) => {
            if let Some(folder) = &arguments.flags.out {
                atomic::prepare_folder(folder)?;
            }
            let accuracy = accuracy::Object::new(target, &reached);
            show(arguments, &reached.scene, &reached.run, Some(accuracy))
        }
        Err(error) => {
            Flags::complain(&format!("{}: {error}", arguments.scene.display()));
            Ok(Verdict::Fail)
        }
    }
}

/// Writes the files of a run that has ended, prints the result, and then the complaint if the
/// verdict is fail.
fn show(
    arguments: &Arguments,
    scene: &Scene,
    run: &Run,
    accuracy: Option<accuracy::Object<'_>>,
) -> Result<Verdict, Unusable> {
    let written = arguments
        .flags
        .out
        .as_deref()
        .map_or(Ok(vec![]), |folder| {
            let history = run.history.iter().map(|history| (HISTORY, history.csv()));
            let pictures = run.pictures(scene).into_iter();
            let pictures = pictures.map(|(name, svg)| (name, arguments.titles.of(svg)));
            write_files(folder, history.chain(pictures))
        })?;
    let worth = match accuracy {
        None => format!("\n{}\n", summary::UNKNOWN),
        Some(_) => String::new(),
    };
    let object = Printed {
        object: Object::new(scene, run),
        accuracy,
    };
    let accuracy = object.accuracy.as_ref();
    let sentence = format!(
        "{}: {} steps, to t = {} of {}",
        scene.name, run.steps, run.last.t, scene.t_end
    );
    let complaint = run.complaint();
    let verdict = match complaint {
        None => Verdict::Pass,
        Some(_) => Verdict::Fail,
    };
    let flags = &arguments.flags;
    let words = flags.words(verdict, &sentence, || {
        summary::summary(scene, run, accuracy, &written) + &worth
    });
    flags.show("run", verdict, &object, &words)?;
    if let Some(complaint) = complaint {
        Flags::complain(&format!("{}: {complaint}", arguments.scene.display()));
    }
    Ok(verdict)
}

/// Runs the scene, with a bar of the time reached, and a history if files are requested.
fn simulate(arguments: &Arguments, scene: &Scene, simulator: Simulator) -> io::Result<Run> {
    if let Some(folder) = &arguments.flags.out {
        atomic::prepare_folder(folder)?;
    }
    let bar = arguments
        .flags
        .bar(&scene.name, TICKS as usize, "parts of the time");
    let (done, t_end) = (Arc::new(AtomicUsize::new(0)), scene.t_end);
    let steps_done = Arc::clone(&done);
    let shown = bar.clone();
    Flags::when_interrupted(move || {
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
    let (run, _) = time_limit::within(arguments.time_limit, || {
        simulator.run(arguments.recording(), &mut tell)
    });
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
