//! The summary of a run for human readers.

use convergence_judge::text::number::counted;
use std::fmt::Write;
use std::path::PathBuf;

use thermobeam::dg::ContactEvent;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::solve::Stopping;
use thermobeam_study::figures::energy_at_rest;
use thermobeam_study::run::Sample;
use thermobeam_study::run::object::phase_name;
use thermobeam_study::run::ringing;
use thermobeam_study::run::simulate::Run;
use thermobeam_study::run::tally::{EnergySummary, Extremes};
use thermobeam_study::scene::Scene;

/// A line of the summary: name, value, meaning.
pub(super) type SummaryLine = (&'static str, String, String);

/// The note on a run whose errors are not known.
pub(super) const UNKNOWN: &str = "Six digits are shown; --target-error makes a run whose digits are right, --format json has all.";

/// The results in aligned columns; all quantities are dimensionless except times on the clock.
pub(super) fn summary(
    scene: &Scene,
    run: &Run,
    accuracy: Option<Vec<SummaryLine>>,
    written: &[PathBuf],
) -> String {
    let mut text = headline(scene, run);
    if let Some(lines) = accuracy {
        section(&mut text, "accuracy", lines);
    }
    section(&mut text, "work", work(scene, run));
    section(
        &mut text,
        &format!("at t = {}", run.last.t),
        state(&run.last, scene.obstacles),
    );
    let mut range = range(&run.extremes, scene.obstacles);
    if scene.obstacles.is_some() {
        range.push((
            "steps in contact",
            run.contact_steps.to_string(),
            String::new(),
        ));
    }
    section(&mut text, "over the whole time", range);
    let events: Vec<SummaryLine> = run
        .contact
        .iter()
        .flat_map(|contact| &contact.events)
        .map(event)
        .collect();
    if !events.is_empty() {
        section(&mut text, "contact events", events);
    }
    section(&mut text, "energy", energy(&scene.beam, &run.energy));
    let skipped = left_out(scene, run);
    if !skipped.is_empty() {
        section(&mut text, "left out", skipped);
    }
    list(&mut text, written);
    text
}

fn event(event: &ContactEvent) -> SummaryLine {
    (
        "",
        format!("{:.12}", event.t),
        format!("{} -> {}", phase_name(event.from), phase_name(event.to)),
    )
}

/// The files that were written.
fn list(text: &mut String, written: &[PathBuf]) {
    if !written.is_empty() {
        text.push_str("\nwrote\n");
    }
    for path in written {
        let _ = writeln!(text, "  {}", path.display());
    }
}

fn section(text: &mut String, title: &str, lines: Vec<SummaryLine>) {
    let _ = writeln!(text, "\n{title}");
    for (name, value, meaning) in lines {
        let line = format!("  {name:<18}{value:>20}   {meaning}");
        let _ = writeln!(text, "{}", line.trim_end());
    }
}

fn headline(scene: &Scene, run: &Run) -> String {
    let iteration = match scene.method.stopping() {
        Stopping::Converged { tolerance, .. } => format!("tolerance {tolerance:?}"),
        Stopping::Iterations(iterations) => {
            format!("{} in each step", counted(iterations, "iteration"))
        }
    };
    let mut text = format!("{}: {}, {iteration}\n", scene.name, scene.discretised());
    if let Some(failure) = &run.failure {
        let _ = writeln!(
            text,
            "\nFAILED after {}, at t = {}: {failure}",
            counted(run.steps, "step"),
            run.last.t
        );
    }
    if let Some(note) = ringing::note(scene, run) {
        let _ = writeln!(text, "\nNote: {note}");
    }
    text
}

fn work(scene: &Scene, run: &Run) -> Vec<SummaryLine> {
    let seconds = run.wall.as_secs_f64();
    let steps = run.steps as f64;
    let rate = 1e9 * (1.0 / steps) * seconds / scene.mesh.elements() as f64;
    let located = run.contact.as_ref().map_or(String::new(), |contact| {
        format!(
            "{} of them end where contact begins or ends",
            contact.events.len()
        )
    });
    let mut lines = vec![
        ("steps", run.steps.to_string(), located),
        (
            "iterations",
            run.iterations.total.to_string(),
            format!(
                "{:.2} a step, at most {}",
                run.iterations.total as f64 / steps,
                run.iterations.max
            ),
        ),
        ("linear solves", run.work.passes.to_string(), String::new()),
        (
            "factorizations",
            run.work.factorizations.to_string(),
            String::new(),
        ),
        (
            "time loop",
            format!("{seconds:.3} s"),
            format!("{rate:.1} ns per element and step, observing left out"),
        ),
    ];
    if run.steps == 0 {
        lines.truncate(1);
    }
    lines
}

/// Digits as appropriate for a coarse mesh; an error budget has its own format.
fn number(value: f64) -> String {
    format!("{value:.5e}")
}

/// The free end, and the temperature in the middle, at one time.
fn state(last: &Sample, obstacles: Option<Obstacles>) -> Vec<SummaryLine> {
    let mut lines = vec![
        (
            "u(1)",
            number(last.u_tip),
            "displacement of the free end".to_owned(),
        ),
        ("phi(1)", number(last.phi_tip), "its rotation".to_owned()),
        ("u_t(1)", number(last.u_t_tip), "its velocity".to_owned()),
        (
            "phi_t(1)",
            number(last.phi_t_tip),
            "its rate of rotation".to_owned(),
        ),
        (
            "theta(1/2)",
            number(last.theta_mid),
            "temperature in the middle".to_owned(),
        ),
    ];
    if obstacles.is_some() {
        let where_to = match last.contact_force {
            force if force > 0.0 => "presses against the upper obstacle",
            force if force < 0.0 => "presses against the lower obstacle",
            _ => "touches nothing",
        };
        lines.push((
            "contact force",
            number(last.contact_force),
            format!("the free end {where_to}"),
        ));
    }
    lines
}

/// The range of the free end.
fn range(extremes: &Extremes, obstacles: Option<Obstacles>) -> Vec<SummaryLine> {
    let [low, high] = match obstacles {
        Some(obstacles) => [
            format!("lower obstacle at {:?}", obstacles.g1),
            format!("upper one at {:?}", obstacles.g2),
        ],
        None => [String::new(), String::new()],
    };
    vec![
        ("smallest u(1)", number(extremes.u_tip_min), low),
        ("largest u(1)", number(extremes.u_tip_max), high),
    ]
}

/// The energy and the defect of its balance.
fn energy(beam: &Beam, energy: &EnergySummary) -> Vec<SummaryLine> {
    let mut lines = vec![
        ("initial", number(energy.initial), String::new()),
        ("final", number(energy.last), String::new()),
    ];
    if let Some(rest) = energy_at_rest(beam) {
        lines.push((
            "straight beam",
            number(rest),
            "beta^2/(4 rho), the straight beam at rest".to_owned(),
        ));
    }
    let increase = energy.largest_increase;
    let falls = if increase < 0.0 {
        "it falls in every step"
    } else if increase.is_nan() {
        "no step was done, or the energy is not a number"
    } else {
        "it does not fall in every step"
    };
    lines.push((
        "largest increase",
        format!("{increase:.3e}"),
        falls.to_owned(),
    ));
    let residual =
        "of the exact discrete balance: round-off, and what the tolerance leaves".to_owned();
    lines.push((
        "largest residual",
        format!("{:.3e}", energy.largest_balance_residual),
        residual,
    ));
    lines
}

fn left_out(scene: &Scene, run: &Run) -> Vec<SummaryLine> {
    let mut lines = Vec::new();
    if !run.is_heated {
        lines.push((
            "temperature",
            String::new(),
            "nothing heats the beam".to_owned(),
        ));
    }
    if scene.obstacles.is_none() {
        lines.push(("obstacles", String::new(), "the scene has none".to_owned()));
    }
    lines
}
