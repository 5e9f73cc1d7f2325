//! Steady states over the axial force at rest: all branches, stable and unstable, and where moving beams come to rest.
//!
//! The branches are exact: they are continued from β to β by what stays the same along them, the state of contact, the side
//! and the number of unstable directions. Three independent answers meet at the buckling point: where the number of
//! exact steady states changes, the buckling force of P1 elements as the mesh is refined, and `-(π²/4)/(1 + π²/4)`.

mod branches;
mod buckling;
mod report;
mod spec;

use thermobeam::equilibrium::Contact;
use thermobeam::kirchhoff::BUCKLING;
use thermobeam::mesh::Mesh;

use super::Study;
use super::complete::{all_ran, or_nothing};
use super::steady::{at_resolution, exact_states, nearest, settle};
use crate::kinds::untyped::{Case, Measured};
use crate::scene::Scene;
use branches::Event;
use convergence_study::judge::fit::Level;
use convergence_study::judge::verdict::{Judge, RateVerdict};
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::{Check, Outcome};
use convergence_study::text::number::max_or_nan;

/// Width to which an event is bracketed.
const BRACKET: f64 = 1e-9;

/// A tip closer to zero than this is that of a straight beam.
const STRAIGHT: f64 = 1e-6;

/// Half the width of the picture of a fork, and its points.
const CLOSE: f64 = 0.025;
const FORK_POINTS: usize = 80;

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct BifurcationStudy {
    header: Header,
    /// One diagram each; their β is overridden.
    scenes: Vec<Scene>,
    /// β of the diagrams.
    grid: Vec<f64>,
    /// Meshes of the discrete buckling force.
    meshes: Vec<usize>,
    judge: Judge,
    /// β at which beams move and come to rest.
    betas: Vec<f64>,
    elements: usize,
    dt: f64,
    speed: f64,
    t_max: f64,
    /// How far from an exact steady state they may be.
    distance: f64,
}

/// What a case computes.
enum Task<'a> {
    Diagram(&'a Scene),
    Mesh(usize),
    Rest(&'a Scene, f64),
}

impl BifurcationStudy {
    fn tasks(&self) -> Vec<Task<'_>> {
        let diagrams = self.scenes.iter().map(Task::Diagram);
        let meshes = self.meshes.iter().map(|&n| Task::Mesh(n));
        let rests = self.scenes.iter().flat_map(|scene| self.betas.iter().map(move |&beta| Task::Rest(scene, beta)));
        diagrams.chain(meshes).chain(rests).collect()
    }

    fn diagram(&self, scene: &Scene) -> Result<Measured, CaseFailure> {
        let coarse = branches::sample(scene, &self.grid, 0)?;
        let bracket = branches::bracket(scene, &coarse, BRACKET)?;
        let grid = self.finer_at(scene, bracket[0]);
        let diagram = branches::trace(&branches::sample(scene, &grid, branches::HALVINGS)?);
        let mut measured = Measured::default();
        measured.push("ambiguous", diagram.ambiguous as f64);
        measured.push("event_low", bracket[0]);
        measured.push("event_high", bracket[1]);
        measured.series.push(("count".into(), diagram.counts));
        for family in diagram.families {
            measured.series.push((family_name(family.contact, family.stable), family.points));
        }
        Ok(measured)
    }

    /// The grid, with more points around a fork for the picture of it.
    fn finer_at(&self, scene: &Scene, fork: f64) -> Vec<f64> {
        if Event::of(scene) != Event::Buckling || fork.is_nan() {
            return self.grid.clone();
        }
        let more = (0..=FORK_POINTS).map(|k| fork + CLOSE * (2.0 * k as f64 / FORK_POINTS as f64 - 1.0));
        let mut grid: Vec<f64> = self.grid.iter().copied().chain(more).collect();
        grid.sort_by(f64::total_cmp);
        grid
    }

    fn rest(&self, scene: &Scene, beta: f64) -> Result<Measured, CaseFailure> {
        let mut scene = at_resolution(scene, self.elements, self.dt)?;
        scene.beam.beta = beta;
        let end = settle(&scene, self.speed, self.t_max)?;
        let mut measured = Measured::default();
        measured.push("u_tip", end.level.u[self.elements]);
        measured.push("t_rest", end.t);
        if let Some((state, (in_u, in_phi))) = nearest(&scene.mesh, &end.level, &exact_states(&scene)?) {
            measured.push("stable", f64::from(u8::from(state.stable)));
            measured.push("exact_u_tip", state.u_tip);
            measured.push("distance", max_or_nan(in_u, in_phi));
        }
        Ok(measured)
    }
}

/// The name of a branch among a case's curves; several branches may share it.
fn family_name(contact: Contact, stable: bool) -> String {
    let contact = match contact {
        Contact::Free => "free",
        Contact::Upper => "upper obstacle",
        Contact::Lower => "lower obstacle",
    };
    format!("{contact}, {}", if stable { "stable" } else { "unstable" })
}

impl Study for BifurcationStudy {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let case = |task: &Task<'_>| match task {
            // Some 50 microseconds for each β: as long as 3000 elements of a step.
            Task::Diagram(scene) => {
                Case { label: format!("branches, θ_A = {}", scene.beam.theta_a), cost: 3e3 * self.grid.len() as f64 }
            }
            Task::Mesh(n) => Case { label: format!("buckling force, n = {n}"), cost: *n as f64 },
            Task::Rest(scene, beta) => Case {
                label: format!("to rest, θ_A = {}, β = {beta}", scene.beam.theta_a),
                cost: 200.0 / self.dt * self.elements as f64,
            },
        };
        self.tasks().iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        match self.tasks()[index] {
            Task::Diagram(scene) => self.diagram(scene),
            Task::Mesh(n) => {
                let mut measured = Measured::default();
                measured.push("force", buckling::discrete_buckling_force(&Mesh::uniform(n)?)?);
                Ok(measured)
            }
            Task::Rest(scene, beta) => self.rest(scene, beta),
        }
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let cases = self.cases();
        let measured = or_nothing(cases.len(), results);
        let (diagrams, others) = measured.split_at(self.scenes.len());
        let (forces, rests) = others.split_at(self.meshes.len());
        let forces: Vec<f64> = forces.iter().map(|force| force.value("force")).collect();
        let mut checks = vec![all_ran(&cases, results), self.discrete_limit(&forces)];
        for (k, scene) in self.scenes.iter().enumerate() {
            let rests = &rests[k * self.betas.len()..(k + 1) * self.betas.len()];
            checks.push(unambiguous(scene, &diagrams[k]));
            checks.push(self.ends_are_stable(scene, rests));
            checks.extend(match Event::of(scene) {
                Event::Buckling => vec![buckles(&diagrams[k]), self.bent_below(rests)],
                Event::LiftOff => vec![lifts_off(&diagrams[k]), one_state(scene, &diagrams[k])],
            });
        }
        let rates = vec![("buckling force of P1 elements".to_owned(), self.rate(&forces))];
        report::outcome(self, diagrams, &forces, rests, rates, checks)
    }
}

impl BifurcationStudy {
    fn rate(&self, forces: &[f64]) -> RateVerdict {
        let level = |(n, force): (&usize, &f64)| Level { step: 1.0 / *n as f64, error: (force - BUCKLING).abs() };
        self.judge.judge(&self.meshes.iter().zip(forces).map(level).collect::<Vec<_>>(), 2.0)
    }

    /// The discrete buckling force for vanishing mesh width, from the last two meshes.
    fn extrapolated(&self, forces: &[f64]) -> f64 {
        let (&[.., coarse, fine], &[.., before, last]) = (self.meshes.as_slice(), forces) else { return f64::NAN };
        last + (last - before) / ((fine as f64 / coarse as f64).powi(2) - 1.0)
    }

    fn discrete_limit(&self, forces: &[f64]) -> Check {
        let limit = self.extrapolated(forces);
        Check::that(
            (limit - BUCKLING).abs() <= 1e-8,
            "P1 elements buckle at -(π²/4)/(1 + π²/4) as the mesh is refined, to 1e-8",
            format!("extrapolated -{limit:.10} for -{BUCKLING:.10}"),
        )
    }

    fn ends_are_stable(&self, scene: &Scene, rests: &[Measured]) -> Check {
        let arrived = |m: &Measured| m.value("stable") == 1.0 && m.value("distance") <= self.distance;
        let holds = !rests.is_empty() && rests.iter().all(arrived);
        let farthest = rests.iter().map(|m| m.value("distance")).fold(0.0, max_or_nan);
        let off = self.betas.iter().zip(rests).filter(|(_, m)| !arrived(m)).map(|(beta, _)| format!("{beta}"));
        let off: Vec<String> = off.collect();
        let list = if off.is_empty() { "none".to_owned() } else { off.join(", ") };
        Check::that(
            holds,
            format!("θ_A = {}: every moving beam comes to rest on a stable branch", scene.beam.theta_a),
            format!("{} runs, the farthest {farthest:.1e} away; those elsewhere: {list}", rests.len()),
        )
    }

    fn bent_below(&self, rests: &[Measured]) -> Check {
        let tips = || self.betas.iter().zip(rests).map(|(beta, m)| (*beta, m.value("u_tip").abs()));
        let as_expected = |(beta, tip): (f64, f64)| if beta < -BUCKLING { tip > STRAIGHT } else { tip <= STRAIGHT };
        let bent = tips().filter(|(_, tip)| *tip > STRAIGHT).map(|(beta, _)| beta).fold(f64::NEG_INFINITY, f64::max);
        let straight = tips().filter(|(_, tip)| *tip <= STRAIGHT).map(|(beta, _)| beta).fold(f64::INFINITY, f64::min);
        Check::that(
            bent < straight && tips().all(as_expected),
            "θ_A = 0: moving beams come to rest bent below β = -0.7116 and straight above",
            format!("bent up to β = {bent}, straight from β = {straight}"),
        )
    }
}

fn unambiguous(scene: &Scene, diagram: &Measured) -> Check {
    Check::that(
        diagram.value("ambiguous") == 0.0,
        format!(
            "θ_A = {}: contact, side and number of unstable directions tell all branches apart",
            scene.beam.theta_a
        ),
        format!("{} states could belong to two branches", diagram.value("ambiguous")),
    )
}

fn buckles(diagram: &Measured) -> Check {
    let [low, high] = [diagram.value("event_low"), diagram.value("event_high")];
    // The bracket's ends are found by counting, the number by analysis.
    let holds = low <= -BUCKLING + BRACKET && -BUCKLING <= high + BRACKET && high - low <= BRACKET;
    Check::that(
        holds,
        "θ_A = 0: the straight beam ceases to be the only steady state at β = -(π²/4)/(1 + π²/4)",
        format!("between {low:.10} and {high:.10}, for {:.10}", -BUCKLING),
    )
}

fn lifts_off(diagram: &Measured) -> Check {
    let [low, high] = [diagram.value("event_low"), diagram.value("event_high")];
    Check::that(
        high - low <= BRACKET,
        "the heated beam leaves the upper obstacle at one β, and is free above",
        format!("between {low:.9} and {high:.9}"),
    )
}

fn one_state(scene: &Scene, diagram: &Measured) -> Check {
    let counts = diagram.curve("count");
    let several: Vec<String> = counts.iter().filter(|(_, n)| *n != 1.0).map(|(beta, _)| format!("{beta}")).collect();
    let evidence = format!(
        "{} β looked at, more than one at: {}",
        counts.len(),
        if several.is_empty() { "none".into() } else { several.join(", ") }
    );
    let claim =
        format!("θ_A = {}: one steady state for every β of the diagram, even beyond buckling", scene.beam.theta_a);
    Check::that(!counts.is_empty() && several.is_empty(), claim, evidence)
}
