//! The summary of a run for human readers.

use convergence_judge::text::number::{counted, plain_text};
use std::fmt::{Display, Write};
use std::path::PathBuf;

use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::solve::Stopping;
use thermobeam_study::figures::energy_at_rest;
use thermobeam_study::run::Sample;
use thermobeam_study::run::energy::EnergySummary;
use thermobeam_study::run::object::phase_name;
use thermobeam_study::run::ringing;
use thermobeam_study::run::simulate::Run;
use thermobeam_study::run::tally::Iterations;
use thermobeam_study::scene::Scene;

use super::accuracy;

/// The note on a run whose errors are not known.
pub(super) const UNKNOWN: &str = "Six digits are shown; --target-error makes a run whose digits are right, --format json has all.";

/// Aligned lines below titles.
pub(super) struct Summary {
    text: String,
}

impl Summary {
    pub(super) fn title(&mut self, title: &str) {
        let _ = writeln!(self.text, "\n{title}");
    }

    /// A value, and what it means.
    pub(super) fn line(&mut self, name: &str, value: impl Display, meaning: impl Display) {
        let line = format!("  {name:<18}{value:>20}   {meaning}");
        let _ = writeln!(self.text, "{}", line.trim_end());
    }
}

/// The results in aligned columns; all quantities are dimensionless except times on the clock.
pub(super) fn summary(
    scene: &Scene,
    run: &Run,
    accuracy: Option<&accuracy::Object<'_>>,
    written: &[PathBuf],
) -> String {
    let mut summary = Summary {
        text: headline(scene, run),
    };
    if let Some(accuracy) = accuracy {
        accuracy.show(&mut summary);
    }
    summary.work(scene, run);
    summary.state(scene, &run.last);
    summary.range(run, scene.obstacles);
    let events = run.contact.iter().flat_map(|contact| &contact.events);
    let mut events = events.peekable();
    if events.peek().is_some() {
        summary.title("contact events");
    }
    for event in events {
        let [from, to] = [event.from, event.to].map(phase_name);
        summary.line("", format!("{:.12}", event.t), format!("{from} -> {to}"));
    }
    summary.energy(&scene.beam, &run.energy, scene.method.stopping());
    if !run.is_heated || scene.obstacles.is_none() {
        summary.title("left out");
    }
    if !run.is_heated {
        summary.line("temperature", "", "nothing heats the beam");
    }
    if scene.obstacles.is_none() {
        summary.line("obstacles", "", "the scene has none");
    }
    if !written.is_empty() {
        summary.title("wrote");
    }
    for path in written {
        let _ = writeln!(summary.text, "  {}", path.display());
    }
    summary.text
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
        let steps = counted(run.steps, "step");
        let _ = writeln!(
            text,
            "\nFAILED after {steps}, at t = {}: {failure}",
            plain_text(run.last.t)
        );
    }
    if let Some(note) = ringing::note(scene, run) {
        let _ = writeln!(text, "\nNote: {note}");
    }
    text
}

/// Digits as appropriate for a coarse mesh; an error budget has its own format.
fn number(value: f64) -> String {
    format!("{value:.5e}")
}

impl Summary {
    fn work(&mut self, scene: &Scene, run: &Run) {
        let seconds = run.wall.as_secs_f64();
        let steps = run.steps as f64;
        let rate = 1e9 * (1.0 / steps) * seconds / scene.mesh.elements() as f64;
        let located = run.contact.as_ref().map_or(String::new(), |contact| {
            let events = contact.events.len();
            format!("{events} of them end where contact begins or ends")
        });
        self.title("work");
        self.line("steps", run.steps, located);
        if run.steps == 0 {
            return;
        }
        let Iterations { total, max } = run.iterations;
        let mean = total as f64 / steps;
        self.line(
            "iterations",
            total,
            format!("{mean:.2} a step, at most {max}"),
        );
        self.line("linear solves", run.work.passes, "");
        self.line("factorizations", run.work.factorizations, "");
        self.line(
            "time loop",
            format!("{seconds:.3} s"),
            format!("{rate:.1} ns per element and step, observing left out"),
        );
    }

    /// The free end, and the temperature in the middle, at one time.
    fn state(&mut self, scene: &Scene, last: &Sample) {
        self.title(&format!("at t = {}", plain_text(last.t)));
        self.line("u(1)", number(last.u_tip), "displacement of the free end");
        self.line("phi(1)", number(last.phi_tip), "its rotation");
        self.line("u_t(1)", number(last.u_t_tip), "its velocity");
        self.line("phi_t(1)", number(last.phi_t_tip), "its rate of rotation");
        let theta = number(last.theta_mid);
        self.line("theta(1/2)", theta, "temperature in the middle");
        if scene.obstacles.is_some() {
            let meaning = match last.contact_force {
                force if force > 0.0 => "the free end presses against the upper obstacle",
                force if force < 0.0 => "the free end presses against the lower obstacle",
                _ => "the free end touches nothing",
            };
            // The midpoint scheme has the force of a step, not of its end.
            let when = match scene.method.name() {
                "midpoint" if last.t > 0.0 => "mean over the last step: ",
                _ => "",
            };
            let meaning = format!("{when}{meaning}");
            self.line("contact force", number(last.contact_force), meaning);
        }
    }

    /// The range of the free end, and its contact.
    fn range(&mut self, run: &Run, obstacles: Option<Obstacles>) {
        let [low, high] = obstacles.map_or([String::new(), String::new()], |obstacles| {
            let Obstacles { g1, g2, .. } = obstacles;
            [
                format!("lower obstacle at {g1:?}"),
                format!("upper one at {g2:?}"),
            ]
        });
        self.title("over the whole time");
        self.line("smallest u(1)", number(run.extremes.u_tip_min), low);
        self.line("largest u(1)", number(run.extremes.u_tip_max), high);
        if obstacles.is_some() {
            self.line("steps in contact", run.contact_steps, "");
        }
    }

    /// The energy and the defect of its balance.
    fn energy(&mut self, beam: &Beam, energy: &EnergySummary, stopping: Stopping) {
        self.title("energy");
        self.line("initial", number(energy.initial), "");
        self.line("final", number(energy.last), "");
        if let Some(rest) = energy_at_rest(beam) {
            let meaning = "beta^2/(4 rho), the straight beam at rest";
            self.line("straight beam", number(rest), meaning);
        }
        let increase = energy.largest_increase;
        let falls = if increase < 0.0 {
            "it falls in every step"
        } else if increase.is_nan() {
            "no step was done, or the energy is not a number"
        } else {
            "it does not fall in every step"
        };
        self.line("largest increase", format!("{increase:.3e}"), falls);
        let residual = format!("{:.3e}", energy.largest_balance_residual);
        let left = match stopping {
            Stopping::Converged { .. } => "round-off, and what the tolerance leaves",
            Stopping::Iterations(_) => "what the iterations leave, not judged",
        };
        let meaning = format!("of the exact discrete balance: {left}");
        self.line("largest residual", residual, meaning);
    }
}
