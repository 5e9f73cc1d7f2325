//! `run` for scenes with `scheme = "dg"`.

use std::fmt::Write;

use convergence_study::cli::exit::{Outcome, Unusable};
use convergence_study::cli::{interrupt, progress};
use convergence_study::run::time_limit;
use convergence_study::store::atomic;
use convergence_study::text::number::counted;
use thermobeam_study::predict::estimate::Budget;
use thermobeam_study::run::any_order::{AnyOrderObject, AnyOrderRun, HISTORY_TIMES, phase_name, run};
use thermobeam_study::scene::Scene;

use super::accuracy::{self, Planned};
use super::{Arguments, complaint, summary, write_files};

/// Ticks of the progress bar over the scene's time.
const TICKS: f64 = 1000.0;

/// The JSON object, with what was asked for on top.
#[derive(serde::Serialize)]
struct Printed<'a> {
    #[serde(flatten)]
    object: AnyOrderObject<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error_budget: Option<&'a Budget>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<accuracy::Object<'a>>,
}

/// Runs the scene, writes what was asked for and prints the result.
pub(super) fn simulate(arguments: &Arguments, scene: &Scene, planned: Option<&Planned>) -> Outcome {
    let times = if arguments.flags.out.is_some() { HISTORY_TIMES } else { 0 };
    if let Some(folder) = &arguments.flags.out {
        atomic::prepare_folder(folder)?;
    }
    let bar = progress::counting(&scene.name, TICKS as usize, "parts of the time", arguments.flags.quiet);
    let (shown, t_end) = (bar.clone(), scene.t_end);
    interrupt::say(move || {
        format!("t = {:.3} of {t_end} was reached; nothing is kept", shown.position() as f64 / TICKS * t_end)
    });
    let simulate = || run(scene, times, &mut |t| bar.set_position((TICKS * t / t_end) as u64));
    let (found, _) = time_limit::within(arguments.time_limit, simulate);
    bar.finish_and_clear();
    let found = found.map_err(|error| Unusable::file(&arguments.scene, &error))?;
    let files = (times > 0).then(|| ("history.csv", found.csv())).into_iter().chain(found.pictures(scene));
    let written = arguments.flags.out.as_deref().map_or(Ok(vec![]), |folder| write_files(folder, files))?;
    // A run that failed has nothing whose error could be estimated.
    let wanted = arguments.estimate_error && found.failure.is_none();
    let budget = wanted.then(|| accuracy::budget(arguments, scene)).transpose();
    let known = budget.as_ref().ok().and_then(Option::as_ref);
    let complaint = complaint(found.complaint(), budget.as_ref().err());
    let accuracy = planned.map(Planned::object);
    let object = Printed { object: AnyOrderObject::new(scene, &found), error_budget: known, accuracy };
    let sentence = format!("{}: {} steps, to t = {} of {t_end}", scene.name, found.steps, found.ends[1].t);
    arguments.show(complaint, &object, &sentence, || {
        let mut text = text(scene, &found, planned);
        summary::list(&mut text, &written);
        if let Some(budget) = known {
            let _ = writeln!(text, "\n{budget}");
        }
        text
    })
}

fn text(scene: &Scene, run: &AnyOrderRun, planned: Option<&Planned>) -> String {
    let stepping = scene.dg_stepping();
    let mut text = format!(
        "{}: {} of degree {}, dG({}) in time, steps from {:.3e} to {:?}, to t = {:?}\ntolerance {:?}\n",
        scene.name,
        counted(scene.mesh.elements(), "element"),
        scene.degree,
        stepping.degree,
        stepping.restart_dt,
        stepping.dt,
        scene.t_end,
        stepping.tolerance,
    );
    let [_, last] = &run.ends;
    if let Some(failure) = &run.failure {
        let _ = writeln!(text, "\nFAILED at t = {}: {failure}", last.t);
    }
    if let Some(planned) = planned {
        summary::section(&mut text, "accuracy", planned.lines());
    }
    let work = vec![
        ("steps", run.steps.to_string(), format!("{} of them end where contact begins or ends", run.events.len())),
        ("iterations", run.iterations.total.to_string(), format!("at most {} a step", run.iterations.max)),
        ("linear solves", run.work.solves.to_string(), String::new()),
        ("factorizations", run.work.factorizations.to_string(), String::new()),
        ("time loop", format!("{:.2} ms", 1e3 * run.wall.as_secs_f64()), "observing left out".to_owned()),
    ];
    summary::section(&mut text, "work", work);
    summary::section(&mut text, &format!("at t = {}", last.t), summary::state(last, scene.obstacles));
    summary::section(&mut text, "over the whole time", summary::range(&run.extremes, scene.obstacles));
    if !run.events.is_empty() {
        let event = |event: &thermobeam::dg::ContactEvent| {
            ("", format!("{:.12}", event.t), format!("{} -> {}", phase_name(event.from), phase_name(event.to)))
        };
        summary::section(&mut text, "contact events", run.events.iter().map(event).collect());
    }
    summary::section(&mut text, "energy", summary::energy(&scene.beam, &run.energy));
    text
}
