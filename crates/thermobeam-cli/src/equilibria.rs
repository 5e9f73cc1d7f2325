//! `equilibria SCENE`: all steady states of a scene.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use thermobeam_exact::equilibrium::{
    Completeness, Equilibrium, EquilibriumError, Proof, equilibria, prove,
};
use thermobeam_exact::interval::Enclosure;
use thermobeam_study::run::object::phase_name;
use thermobeam_study::scene::Scene;

use convergence_study::{
    Verdict,
    command_line::{Flags, Unusable},
};

/// List all steady states of a scene
///
/// Each is proved by interval arithmetic, with bounds of N and u(1). At a fold, at a buckling value
/// and where a tip just touches an obstacle no enclosure decides how many there are: the verdict is
/// then inconclusive, with the reason, and the exit status 1.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file, which `run` would take; only its beam and its obstacles matter to the states
    scene: PathBuf,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Result<Verdict, Unusable> {
    let scene = Scene::read(&arguments.scene)?;
    let states = match equilibria(&scene.beam, scene.obstacles.as_ref()) {
        Ok(states) => states,
        Err(error @ EquilibriumError::Parameter(_)) => {
            return Err(Unusable::file(&arguments.scene, &error));
        }
        Err(error) => {
            Flags::complain(&format!("{}: {error}", arguments.scene.display()));
            return Ok(Verdict::Fail);
        }
    };
    let proof = prove(&scene.beam, scene.obstacles.as_ref())
        .map_err(|error| Unusable::file(&arguments.scene, &error))?;
    let flags = &arguments.flags;
    let (verdict, sentence) = headline(&states, &proof);
    let words = flags.words(verdict, &sentence, || {
        text(&scene, &sentence, &states, &proof)
    });
    Ok(flags.show(
        "equilibria",
        verdict,
        &EquilibriaList::new(&states, &proof),
        &words,
    )?)
}

/// The verdict, and the sentence that leads: a number of states only if the proof decides it.
fn headline(states: &[Equilibrium], proof: &Proof) -> (Verdict, String) {
    if proof.decides(states) {
        let count = match proof.completeness {
            Completeness::Infinite => format!("{} of infinitely many steady states", states.len()),
            _ => counted(states.len()),
        };
        let stability = match states {
            [only] if only.stable => "which is stable".to_owned(),
            [_] => "which is unstable".to_owned(),
            _ => {
                let stable = states.iter().filter(|state| state.stable).count();
                format!("{stable} of them stable")
            }
        };
        return (Verdict::Pass, format!("{count}, {stability}"));
    }
    let sentence = "the number of steady states is undecided".to_owned();
    (Verdict::Inconclusive, sentence)
}

#[derive(Debug, Serialize)]
struct EquilibriaList {
    equilibria: Vec<ListedState>,
    /// Whether these are all, each once. If not, unstable states with -1 < N < -0.9996 may be
    /// missing, or are; or the proof does not decide.
    complete: bool,
    /// Whether it is proved that these are all, each once.
    proved: bool,
    /// Where the proof decides nothing.
    undecided: Vec<ListedUndecided>,
}

#[derive(Debug, Serialize)]
struct ListedUndecided {
    contact: &'static str,
    n_value: [f64; 2],
    reason: &'static str,
    width: f64,
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
    /// Whether the state is proved to exist.
    proved: bool,
    /// Bounds of N; `null` if the state is not proved.
    n_enclosure: Option<[f64; 2]>,
    /// Bounds of u(1); `null` if the state is not proved.
    u_tip_enclosure: Option<[f64; 2]>,
}

fn bounds(interval: Enclosure) -> [f64; 2] {
    [interval.lo, interval.hi]
}

impl EquilibriaList {
    fn new(states: &[Equilibrium], proof: &Proof) -> Self {
        let mut equilibria = vec![];
        for state in states {
            let proved = proof.of(state);
            equilibria.push(ListedState {
                contact: phase_name(state.contact),
                n_value: state.n_value,
                u_tip: state.u_tip,
                phi_tip: state.phi_tip,
                stable: state.stable,
                contact_force: state.contact_force,
                unstable_directions: state.unstable_directions,
                proved: proved.is_some(),
                n_enclosure: proved.map(|proved| bounds(proved.n_value)),
                u_tip_enclosure: proved.map(|proved| bounds(proved.u_tip)),
            });
        }
        let mut undecided = vec![];
        for part in &proof.undecided {
            undecided.push(ListedUndecided {
                contact: phase_name(part.contact),
                n_value: bounds(part.n_value),
                reason: part.reason.words(),
                width: part.width,
            });
        }
        Self {
            equilibria,
            complete: proof.count_of(states).is_some(),
            proved: proof.count_of(states).is_some(),
            undecided,
        }
    }
}

fn counted(states: usize) -> String {
    match states {
        1 => "one steady state".to_owned(),
        n => format!("{n} steady states"),
    }
}

fn text(scene: &Scene, sentence: &str, states: &[Equilibrium], proof: &Proof) -> String {
    let beam = &scene.beam;
    let mut text = format!(
        "{}: {sentence}, for beta = {:?}, theta_a = {:?}\n\n",
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
    text += &proof_text(states, proof);
    text + match proof.completeness {
        Completeness::Complete => "",
        Completeness::Unknown => {
            "\nPerhaps not all: unstable states with -1 < N < -0.9996 may be missing.\nEvery stable state is listed.\n"
        }
        Completeness::Infinite => {
            "\nNot all: infinitely many unstable states accumulate at N = -1.\nEvery stable state is listed.\n"
        }
    }
}

/// What is proved: each state with its enclosure, and whether there are others.
fn proof_text(states: &[Equilibrium], proof: &Proof) -> String {
    let mut text = "\n".to_owned();
    for state in states {
        let contact = phase_name(state.contact);
        let _ = match proof.of(state) {
            Some(proved) => writeln!(
                text,
                "  {contact:<8}proved: N in {}, u(1) in {}",
                bounds_text(proved.n_value),
                bounds_text(proved.u_tip)
            ),
            None => writeln!(text, "  {contact:<8}undecided: N = {:?}", state.n_value),
        };
    }
    for part in &proof.undecided {
        let _ = writeln!(
            text,
            "  Undecided, {}, N in {}: {}, given up at a width of {:.1e}.",
            phase_name(part.contact),
            bounds_text(part.n_value),
            part.reason.words(),
            part.width
        );
    }
    if let Some(count) = proof.count_of(states) {
        let _ = writeln!(text, "Proved: {}, and no other.", counted(count));
    }
    text
}

fn bounds_text(interval: Enclosure) -> String {
    format!("[{:?}, {:?}]", interval.lo, interval.hi)
}
