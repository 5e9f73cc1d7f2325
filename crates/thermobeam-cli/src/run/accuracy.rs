//! `run SCENE --target-error E` and `--estimate-error`: a run chosen by its error, and the error of
//! a run.

use clap::ValueEnum;
use convergence_judge::{SpaceTime, time_limit};
use convergence_study::internal::cli::{exit, running};
use serde::Serialize;
use thermobeam_study::predict::choice::{self, Choice, choose, keep_scheme};
use thermobeam_study::predict::estimate::{Budget, estimate};
use thermobeam_study::predict::{Cost, MOST_WORK, MOST_WORK_KEPT, Unreachable, Work};
use thermobeam_study::scene::Scene;

use super::Arguments;
use super::summary::SummaryLine;

/// Ticks of the progress bar over the work limit.
const TICKS: f64 = 1000.0;

/// The quantity whose error is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum QuantityName {
    /// Maximum over [0, T] of the error of u(1, t)
    #[default]
    Tip,
    /// Maximum over [0, T] of the norm of Theorem 3.4
    #[value(name = "theorem-3.4")]
    Theorem34,
}

/// A target error from the command line.
pub(super) fn target(text: &str) -> Result<f64, String> {
    let target = text
        .parse()
        .ok()
        .filter(|target: &f64| *target > 0.0 && target.is_finite());
    target.ok_or_else(|| "expected a finite number > 0".to_owned())
}

/// The request, and the chosen run.
pub(crate) struct Planned {
    quantity: choice::ErrorQuantity,
    target: f64,
    choice: Choice,
    spent: Cost,
}

/// Searches with a work limit and a bar that shows the part used; also ends at the time limit.
fn search<T>(
    arguments: &Arguments,
    scene: &Scene,
    limit: f64,
    find: impl FnOnce(&mut Work<'_>) -> T,
) -> (T, Cost) {
    let unit = "thousandths of the work allowed";
    let bar = running::counting(
        &format!("{}: its error", scene.name),
        TICKS as usize,
        unit,
        arguments.flags.quiet,
    );
    exit::say(|| "the error was not known yet".to_owned());
    let mut show_part = |part: f64| bar.set_position((TICKS * part) as u64);
    let mut work = Work::new(limit, &mut show_part);
    let (found, _) = time_limit::within(arguments.time_limit, || find(&mut work));
    let spent = work.spent();
    bar.finish_and_clear();
    (found, spent)
}

/// The run with the requested error.
pub(super) fn plan(
    arguments: &Arguments,
    scene: &Scene,
    target: f64,
) -> Result<Planned, Unreachable> {
    let quantity = match arguments.quantity {
        QuantityName::Tip => choice::ErrorQuantity::Tip,
        QuantityName::Theorem34 => choice::ErrorQuantity::Norm,
    };
    let (choose, limit): (fn(&Scene, _, _, &mut Work<'_>) -> _, f64) = if arguments.keep_scheme {
        (keep_scheme, MOST_WORK_KEPT)
    } else {
        (choose, MOST_WORK)
    };
    let (choice, spent) = search(arguments, scene, limit, |work| {
        choose(scene, quantity, target, work)
    });
    Ok(Planned {
        quantity,
        target,
        choice: choice?,
        spent,
    })
}

/// The errors of a scene.
pub(super) fn budget(arguments: &Arguments, scene: &Scene) -> Result<Budget, Unreachable> {
    search(arguments, scene, MOST_WORK, |work| estimate(scene, work)).0
}

/// The key `accuracy` of the JSON object.
#[derive(Debug, Serialize)]
pub(super) struct Object<'a> {
    quantity: &'static str,
    target_error: f64,
    /// The error of the run, as far as it is known.
    believed_error: f64,
    space_error: f64,
    time_error: f64,
    nodes: &'a [f64],
    #[serde(skip_serializing_if = "Option::is_none")]
    node_steps: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unknown_solves: Option<f64>,
    search_work: f64,
    search_runs: usize,
    search_seconds: f64,
}

impl Planned {
    /// The scene with the chosen run.
    pub(super) fn scene(&self) -> &Scene {
        &self.choice.scene
    }

    pub(super) fn object(&self) -> Object<'_> {
        let Choice {
            scene,
            parts:
                SpaceTime {
                    space: space_error,
                    time: time_error,
                },
            run,
            ..
        } = &self.choice;
        let is_dg = scene.method.dg().is_some();
        Object {
            quantity: self.quantity.name(),
            target_error: self.target,
            believed_error: self.choice.error,
            space_error: *space_error,
            time_error: *time_error,
            nodes: scene.mesh.nodes(),
            node_steps: (!is_dg).then_some(run.work),
            unknown_solves: is_dg.then_some(run.work),
            search_work: self.spent.work,
            search_runs: self.spent.runs,
            search_seconds: self.spent.seconds,
        }
    }

    /// Lines of the summary: name, value, meaning.
    pub(super) fn lines(&self) -> Vec<SummaryLine> {
        let Choice {
            scene,
            parts: SpaceTime { space, time },
            parts_by,
            error,
            run,
            is_kept,
        } = &self.choice;
        let why = if *is_kept {
            "the scene's own, as --keep-scheme asks for"
        } else {
            "the cheapest: the error of any other run is its difference to such a run"
        };
        let mut lines = vec![
            line(
                "target",
                format!("{:.3e}", self.target),
                self.quantity.meaning(),
            ),
            line(
                "made",
                format!("{error:.3e}"),
                "estimated: the sum of the differences below, or the difference to a run of any order",
            ),
            line(
                "space",
                format!("{space:.3e}"),
                &format!("{parts_by}, in space"),
            ),
            line(
                "time",
                format!("{time:.3e}"),
                &format!("{parts_by}, in time"),
            ),
            line("scheme", scene.method.name().to_owned(), why),
        ];
        if let Some(stepping) = scene.method.dg() {
            lines.extend(lines_of_dg(scene, stepping.growth));
        }
        let ratio = self.spent.work / run.work;
        let meaning = format!(
            "in {} runs to find it, {ratio:.1} times the work of this one",
            self.spent.runs
        );
        lines.push(line(
            "search",
            format!("{:.3} s", self.spent.seconds),
            &meaning,
        ));
        lines
    }
}

fn line(name: &'static str, value: String, meaning: &str) -> SummaryLine {
    (name, value, meaning.to_owned())
}

/// What a run by dG has that one-step schemes have not.
fn lines_of_dg(scene: &Scene, growth: f64) -> [SummaryLine; 2] {
    let nodes: Vec<String> = scene
        .mesh
        .nodes()
        .iter()
        .map(|x| format!("{x:.4}"))
        .collect();
    let elements = scene.mesh.elements().to_string();
    [
        line(
            "growth",
            format!("{growth:.4}"),
            "of the steps after a contact event",
        ),
        line(
            "elements",
            elements,
            &format!("between x = {}", nodes.join(", ")),
        ),
    ]
}
