//! The ends of long runs, compared with exact steady states, which no source term keeps in place.
//!
//! A beam at rest solves the discrete static problem to round-off for any time step. What remains
//! is the error of P1 elements, O(h²) at the nodes in u and in φ; with elements of high degree and
//! dG(q) it nearly vanishes. A straight steady state has no such error: the beam is only checked to
//! end straight, up to the remaining motion. Such large time steps do not resolve the bounces, but
//! the final state is a steady state of the same discrete beam.

use super::paper::{Experiment, experiments};
use super::prelude::*;
pub use super::steady::{AtRest, Nearest};
use super::steady::{cost_to_rest, name_of, settle};
use crate::error::reference::Traced;
use crate::kinds::tables::{Discretisation, level_of_mesh};
use convergence_judge::richardson;
use convergence_study::{Claim, ErrorColumn, Floor, Levels, RefinedIn, Subject, left_out};
use thermobeam::mesh::Mesh;
use thermobeam_exact::equilibrium::Equilibrium;

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "equilibria",
    claim: "Beams at rest are exact steady states, and the discrete ones converge to them at order 2",
    tier: Tier::Quick,
    group: "steady states",
    home: file!(),
};

const MESHES: [usize; 4] = [20, 40, 80, 160];
const DT: f64 = 0.04;
/// The largest velocity of a beam at rest, and when it must rest.
const SPEED: f64 = 1e-13;
const T_MAX: f64 = 2000.0;
/// The same scenes on one element of high degree, until they are at rest.
fn any_order() -> Discretisation {
    Discretisation::new([1, 24, 1], [0.5, 1e-3, 1.5])
}
const T_END: f64 = 400.0;
/// Elements on whose nodes a run of any order is compared with the exact state.
const COMPARED: usize = 64;

/// Order of the elements in u and φ, and the tolerance of its rate.
const ORDER: f64 = 2.0;
const TOLERANCE: f64 = 0.02;
/// Error allowed on the finest mesh, and by the run of any order.
const ALLOWED: f64 = 1e-6;
const ALLOWED_ANY_ORDER: f64 = 1e-13;
/// Remaining share of the tip's error after extrapolation from two meshes: the next term of the
/// expansion, and the motion.
const EXTRAPOLATED: f64 = 1e-2;
/// Errors below this multiple of the velocity at rest are motion.
const MOTION: f64 = 10.0;
/// Relative change that the baseline tolerates in the tip of a discrete and of an exact state.
const TIP: f64 = 1e-8;
const EXACT_TIP: f64 = 1e-9;

const ERROR: &str = "largest error at the finest mesh";

/// Long runs of the paper's seven scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EndStates;

/// The study.
pub fn study() -> Described<EndStates> {
    ABOUT.study(EndStates)
}

impl Kind for EndStates {
    /// A scene, and its number of linear elements; `None` for the run of any order.
    type Data = (Experiment, Option<usize>);
    /// Its end, and the nearest stable state.
    type Found = AtRest;

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let parts = |scene: Experiment| scene.parts().on(true).against(Known::SteadyStates);
        let mut runs = vec![];
        for scene in experiments() {
            for n in MESHES {
                let label = format!("{}, n = {n}", scene.name);
                let case = Case::new(label, cost_to_rest(n, DT), (scene, Some(n)));
                runs.push(case.described(&parts(scene).by_the_paper(Solver::Newton)));
            }
        }
        for scene in experiments() {
            let label = format!("{}, {}", scene.name, any_order().label());
            let case = Case::new(label, any_order().cost(T_END), (scene, None));
            runs.push(case.described(&parts(scene).by_dg()));
        }
        runs
    }

    fn run(&self, &(experiment, elements): &Self::Data) -> Result<AtRest, CaseFailure> {
        let scene = experiment.scene()?;
        let is_stable = |state: &Equilibrium| state.stable;
        let end = match elements {
            Some(elements) => {
                let scene = scene.at(Mesh::uniform(elements)?, DT);
                let (t, level) = settle(&scene, SPEED, T_MAX)?;
                AtRest::of(&scene, &scene.mesh, t, &level, is_stable)
            }
            None => {
                let mesh = Mesh::uniform(COMPARED)?;
                let traced = Traced::compute(&any_order().of(&scene, T_END)?, mesh, 1)?;
                let last = traced.levels.last();
                let last = last.ok_or_else(|| CaseFailure::new("the run has no end"))?;
                AtRest::of(&scene, &traced.mesh, T_END, last, is_stable)
            }
        }?;
        match end.nearest {
            Some(_) => Ok(end),
            None => Err(CaseFailure::new("there is no stable steady state")),
        }
    }

    fn judge(&self, ran: &[Ran<Self::Data, AtRest>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| {
            let scenes: Vec<Ends<'_>> =
                experiments().map(|scene| Ends::new(scene, shown)).collect();
            // Errors below the floor cannot be distinguished from the remaining motion.
            let bent = levels(scenes.iter().filter(|ends| !ends.is_straight()))
                .with_floor(Floor::new(MOTION * SPEED).unwrap_or_default());
            let rates = bent.judge();
            let caption = "Largest errors of u and φ at the nodes of beams at rest, against exact steady states.";
            let title = Some("Steady states".to_owned());
            let figure = bent.figure("errors", title, caption.to_owned(), &rates);
            let straight = scenes.iter().map(|ends| {
                ends.is_straight()
                    .then_some("straight, so that the mesh causes no error")
            });
            let title = format!(
                "Ends of long runs ({} elements, and extrapolated) and exact steady states",
                MESHES[MESHES.len() - 1]
            );
            let ends = scenes.iter().flat_map(Ends::measured);
            let runs = shown
                .iter()
                .flat_map(|((scene, elements), end)| of_run(scene.name, *elements, end));
            let sheets = [
                Sheet::new(title, "scene", ends),
                Sheet::new("Each run", "run", runs),
            ];
            let left_out = left_out("ends for the order", straight);
            Outcome {
                left_out: left_out.into_iter().collect(),
                figures: vec![figure],
                levels: levels(scenes.iter()).errors(),
                ..Outcome::of_sheets(sheets, ERROR).with_orders(&bent, rates)
            }
        })
    }
}

/// The end of a run, in no table.
fn of_run(scene: &str, elements: Option<usize>, end: &AtRest) -> Vec<Measured> {
    let by = elements.map_or(any_order().label(), |n| format!("n = {n}"));
    let case = format!("{scene}, {by}");
    let [[u, phi], [exact_u, exact_phi], [error_u, error_phi]] =
        [end.tip, end.exact_tip(), end.errors()];
    let numbers = [
        ("u(1)", u),
        ("φ(1)", phi),
        ("exact u(1)", exact_u),
        ("exact φ(1)", exact_phi),
        ("error of u", error_u),
        ("error of φ", error_phi),
        ("time of rest", end.t),
    ];
    numbers
        .map(|(name, value)| measured(&case, name, value).hidden())
        .to_vec()
}

/// Largest errors at the nodes over the mean mesh width.
fn levels<'e>(scenes: impl Iterator<Item = &'e Ends<'e>>) -> Levels {
    let mut columns = vec![];
    for (k, ends) in scenes.enumerate() {
        for (field, name) in ["u", "φ"].into_iter().enumerate() {
            let scene = ends.scene.name;
            let errors = ends.ends.iter().map(|end| Some(end.errors()[field]));
            let claim = Claim::new(ORDER, TOLERANCE);
            columns.push(ErrorColumn {
                subject: Subject::of(name).in_case(scene),
                style: 2 * k + field,
                ..ErrorColumn::new(format!("{scene}: {name}"), claim, errors)
            });
        }
    }
    let refinements = MESHES.map(|n| level_of_mesh(format!("n = {n}"), n));
    Levels::new(RefinedIn::Space, refinements, columns)
}

/// The ends of one scene.
struct Ends<'r> {
    scene: Experiment,
    /// One for each mesh.
    ends: [&'r AtRest; MESHES.len()],
    any_order: &'r AtRest,
}

impl<'r> Ends<'r> {
    fn new(scene: Experiment, shown: &[(&<EndStates as Kind>::Data, &'r AtRest)]) -> Self {
        Self {
            scene,
            ends: MESHES.map(|n| of(shown, &(scene, Some(n)))),
            any_order: of(shown, &(scene, None)),
        }
    }

    fn finest(&self) -> &AtRest {
        self.ends[MESHES.len() - 1]
    }

    /// Recorded for a bent beam: the zero of a straight one has no digits to guard.
    fn bent(&self, tip: Measured, known: &str, tolerance: f64) -> Measured {
        if self.is_straight() {
            tip
        } else {
            tip.recorded(known, tolerance)
        }
    }

    /// Whether the beam ends straight, in which case the mesh causes no error.
    fn is_straight(&self) -> bool {
        self.finest().exact_tip() == [0.0, 0.0]
    }

    /// The tip extrapolated from the two finest meshes to vanishing mesh width.
    fn extrapolated(&self, field: usize) -> f64 {
        let [.., before, last] = self.ends.map(|end| end.tip[field]);
        let [.., coarse, fine] = MESHES;
        last + richardson::correction(before, last, fine as f64 / coarse as f64, ORDER)
    }

    /// The end on the finest mesh, extrapolated, and the exact state, whose tips are guarded if the
    /// beam is bent; and what is claimed of them.
    fn measured(&self) -> Vec<Measured> {
        let name = self.scene.name;
        let end = self.finest();
        let [[u, phi], [exact_u, exact_phi]] = [end.tip, end.exact_tip()];
        let tip = |what: &str, value: f64| measured(name, what, value).fixed(10);
        let near_zero = Must::Near {
            answer: 0.0,
            within: EXTRAPOLATED * ALLOWED,
        };
        // The beam may buckle to either side, but errors are comparable only if it is the same side
        // on all meshes.
        let elsewhere = self
            .ends
            .iter()
            .filter(|other| other.contact() != end.contact());
        let error = |end: &AtRest| largest_of(end.errors());
        vec![
            measured(name, "at rest", None).words(end.contact().map_or("?", name_of)),
            self.bent(tip("u(1)", u), "u_tip", TIP),
            // The table shows the extrapolated value instead.
            self.bent(tip("φ(1)", phi).hidden(), "phi_tip", TIP),
            tip("extrapolated", self.extrapolated(0)),
            self.bent(tip("exact", exact_u), "exact_u_tip", EXACT_TIP),
            measured(
                name,
                "extrapolated less exact",
                self.extrapolated(0) - exact_u,
            )
            .scientific(1)
            .must_be(near_zero),
            tip("φ(1) extrapolated", self.extrapolated(1)),
            self.bent(tip("φ(1) exact", exact_phi), "exact_phi_tip", EXACT_TIP),
            measured(name, "at rest by t", end.t).fixed(0),
            measured(name, ERROR, error(end)).must_be(Must::AtMost(ALLOWED)),
            measured(
                name,
                "meshes that end in another contact",
                elsewhere.count() as f64,
            )
            .fixed(0)
            .must_be(Must::Count(0)),
            measured(
                name,
                format!("error by {}", any_order().label()),
                error(self.any_order),
            )
            .must_be(Must::AtMost(ALLOWED_ANY_ORDER)),
        ]
    }
}
