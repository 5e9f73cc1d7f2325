//! `equilibria SCENE`: all steady states of a scene.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use thermobeam_exact::equilibrium::{
    Completeness, Equilibrium, EquilibriumError, completeness, equilibria,
};
use thermobeam_study::run::object::phase_name;
use thermobeam_study::scene::Scene;

use convergence_harness::cli::exit::{Outcome, Unusable};
use convergence_harness::cli::flags::Flags;
use convergence_harness::cli::screen;
use convergence_harness::judge::verdict::Verdict;

/// List all steady states of a scene
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file; only its beam and its obstacles matter
    scene: PathBuf,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let scene = Scene::read(&arguments.scene)?;
    let states = match equilibria(&scene.beam, scene.obstacles.as_ref()) {
        Ok(states) => states,
        Err(error @ EquilibriumError::Parameter(_)) => {
            return Err(Unusable::file(&arguments.scene, &error));
        }
        Err(error) => {
            screen::complain(&format!("{}: {error}", arguments.scene.display()));
            return Ok(Verdict::Fail);
        }
    };
    let flags = &arguments.flags;
    let stable = states.iter().filter(|state| state.stable).count();
    let sentence = format!("{}, {stable} of them stable", counted(states.len()));
    let words = flags.words(Verdict::Pass, &sentence, || text(&scene, &states));
    Ok(flags.show(
        "equilibria",
        Verdict::Pass,
        &Listed::new(&scene, &states),
        &words,
    )?)
}

#[derive(Debug, Serialize)]
struct Listed {
    equilibria: Vec<ListedState>,
    /// Whether these are all. If not, unstable states with -1 < N < -0.9996 may be missing, or are.
    complete: bool,
}

#[derive(Debug, Serialize)]
struct ListedState {
    contact: &'static str,
    n_value: f64,
    u_tip: f64,
    phi_tip: f64,
    stable: bool,
    contact_force: f64,
    /// `null` if there are infinitely many.
    unstable_directions: Option<usize>,
}

impl Listed {
    fn new(scene: &Scene, states: &[Equilibrium]) -> Self {
        let mut equilibria = vec![];
        for state in states {
            equilibria.push(ListedState {
                contact: phase_name(state.contact),
                n_value: state.n_value,
                u_tip: state.u_tip,
                phi_tip: state.phi_tip,
                stable: state.stable,
                contact_force: state.contact_force,
                unstable_directions: state.unstable_directions,
            });
        }
        Self {
            equilibria,
            complete: known(scene) == Completeness::Complete,
        }
    }
}

fn known(scene: &Scene) -> Completeness {
    completeness(&scene.beam, scene.obstacles.as_ref())
}

fn counted(states: usize) -> String {
    match states {
        1 => "one steady state".to_owned(),
        n => format!("{n} steady states"),
    }
}

fn text(scene: &Scene, states: &[Equilibrium]) -> String {
    let count = counted(states.len());
    let beam = &scene.beam;
    let mut text = format!(
        "{}: {count} for beta = {:?}, theta_a = {:?}\n\n",
        scene.name, beam.beta, beam.theta_a
    );
    let _ = writeln!(
        text,
        "  {:<8}{:>20}{:>20}{:>20}{:>20}  stability",
        "contact", "u(1)", "phi(1)", "axial force N", "contact force"
    );
    for state in states {
        let stability = match (state.stable, state.unstable_directions) {
            (true, _) => "stable".to_owned(),
            (false, Some(0)) => "on the verge of stability".to_owned(),
            (false, Some(1)) => "unstable in 1 direction".to_owned(),
            (false, Some(n)) => format!("unstable in {n} directions"),
            (false, None) => "unstable in infinitely many directions".to_owned(),
        };
        let _ = writeln!(
            text,
            "  {:<8}{:>20.12e}{:>20.12e}{:>20.12e}{:>20.12e}  {stability}",
            phase_name(state.contact),
            state.u_tip,
            state.phi_tip,
            state.n_value,
            state.contact_force,
        );
    }
    text + match known(scene) {
        Completeness::Complete => "",
        Completeness::Unknown => {
            "\nPerhaps not all: unstable states with -1 < N < -0.9996 may be missing.\nEvery stable state is listed.\n"
        }
        Completeness::Infinite => {
            "\nNot all: infinitely many unstable states accumulate at N = -1.\nEvery stable state is listed.\n"
        }
    }
}
