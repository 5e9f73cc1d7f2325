//! `run SCENE --target-error E`: a run with a wanted error.

use convergence_judge::time_limit;
use convergence_study::command_line::Flags;
use convergence_study::file::Positive;
use serde::Serialize;
use thermobeam_study::accuracy::{OutOfReach, Reached, reach};
use thermobeam_study::scene::Scene;

use super::Arguments;
use super::summary::Summary;

/// Ticks of the progress bar over the work limit.
const TICKS: f64 = 1000.0;

/// A target error from the command line.
pub(super) fn target(text: &str) -> Result<Positive, String> {
    let target = text.parse().ok().and_then(Positive::new);
    target.ok_or_else(|| "expected a finite number > 0".to_owned())
}

/// The run with the requested error, with a bar that shows the part of the allowed work that is
/// used; ends at the time limit.
pub(super) fn search(
    arguments: &Arguments,
    scene: &Scene,
    target: Positive,
) -> Result<Reached, OutOfReach> {
    let bar = arguments.flags.bar(
        &format!("{}: its error", scene.name),
        TICKS as usize,
        "thousandths of the work allowed",
    );
    Flags::when_interrupted(|| "no run with this error was found yet".to_owned());
    let mut show = |part: f64| bar.set_position((TICKS * part) as u64);
    let (found, _) = time_limit::within(arguments.time_limit, || {
        reach(scene, target, arguments.recording(), &mut show)
    });
    bar.finish_and_clear();
    found
}

/// The key `accuracy` of the JSON object.
#[derive(Debug, Serialize)]
pub(super) struct Object<'a> {
    target_error: Positive,
    /// The error of the run, as far as it is known.
    believed_error: f64,
    nodes: &'a [f64],
    search_work: f64,
    search_runs: usize,
}

impl<'a> Object<'a> {
    pub(super) fn new(target_error: Positive, reached: &'a Reached) -> Self {
        Self {
            target_error,
            believed_error: reached.estimate,
            nodes: reached.scene.mesh.nodes(),
            search_work: reached.work,
            search_runs: reached.runs,
        }
    }

    /// Adds it to a summary.
    pub(super) fn show(&self, summary: &mut Summary) {
        let nodes: Vec<String> = self.nodes.iter().map(|x| format!("{x:.4}")).collect();
        summary.title("accuracy");
        summary.line(
            "target",
            format!("{:.3e}", self.target_error.get()),
            "largest error of u(1, t) over [0, T]",
        );
        summary.line(
            "estimated",
            format!("{:.3e}", self.believed_error),
            "the difference to a coarser run, at 4000 times and at its contact events",
        );
        summary.line(
            "runs",
            self.search_runs,
            "each finer than the one before; this is the last",
        );
        let places = format!("between x = {}", nodes.join(", "));
        summary.line("elements", nodes.len() - 1, places);
    }
}
