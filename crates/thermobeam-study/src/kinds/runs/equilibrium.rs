//! The ends of long runs, compared with exact steady states, which no source term keeps in place.
//!
//! A beam at rest solves the discrete static problem to round-off for any time step. What remains
//! is the error of P1 elements, O(h²) at the nodes in u and in φ; with elements of high degree and
//! dG(q) it nearly vanishes. A straight steady state has no such error: the beam is only checked to
//! end straight, up to the remaining motion.

pub use super::steady::{AtRest, Nearest};
use super::{
    Findings, Listing, Results, RunStudy, Runs,
    checks::{Condition, all, at_most, within},
    steady::{
        self, cost_to_rest, listed_scenes, meshes, name_of, settle, steps_to_rest, tolerance,
    },
};
use crate::kinds::prelude::*;
use crate::{
    error::reference::Traced,
    kinds::{
        settings::{Exercise, Integration, ItemMethod},
        tables::{DISCRETISATION_KEYS, Discretisation, level_of_mesh},
    },
    scene::Scene,
};
use convergence_judge::{judge::richardson, text::number::decimals};
use convergence_study::{
    Coverage, Floor,
    internal::study::over_levels::{ErrorColumn, Levels},
};
use thermobeam::mesh::Mesh;
use thermobeam_exact::equilibrium::Equilibrium;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/equilibrium",
    keys: EndStates::KEYS,
    read: read_study::<RunStudy<EndStates>>,
    why: "All steady states are roots of a function of one variable, known to round-off. A damped beam must come to rest at one.",
    judged: "Beams are run to rest on several meshes; their end states converge at second order to an exact \
             state; a run of any order ends in it.",
    failure: "The steady part of the equations is discretised wrongly, or the beam has not come to rest.",
};

/// Order of the elements in u and φ.
const ORDER: f64 = 2.0;

/// Remaining share of the tip's error after extrapolation from two meshes: the next term of the
/// expansion, and the motion.
const EXTRAPOLATED: f64 = 1e-2;

/// Errors below this multiple of the velocity at rest are motion.
const MOTION: f64 = 10.0;

/// Relative change that the baseline tolerates in the tip of a discrete state.
const TIP: f64 = 1e-8;

/// The same of an exact state.
const EXACT_TIP: f64 = 1e-9;

/// Elements on which a run of any order is compared with the exact state.
const COMPARED: usize = 64;

/// A study of the steady states in which long runs end.
#[derive(Debug, Clone, PartialEq)]
pub struct EndStates {
    scenes: Vec<Scene>,
    /// At least three numbers of elements, ascending.
    elements: Vec<usize>,
    dt: f64,
    /// The largest velocity that counts as rest.
    speed: f64,
    t_max: f64,
    /// Allowed deviation of the observed rate from the order 2.
    tolerance: f64,
    /// The error allowed on the finest mesh.
    error: f64,
    any_order: Option<AnyOrder>,
}

/// The same scenes by the scheme of any order.
#[derive(Debug, Clone, PartialEq)]
struct AnyOrder {
    how: Discretisation,
    t_end: f64,
    /// The error allowed.
    error: f64,
}

impl AnyOrder {
    fn read(section: &Section<'_>) -> Result<Self, InputError> {
        let t_end = section.positive("t_end")?;
        Ok(Self {
            how: Discretisation::read(section, t_end)?,
            t_end,
            error: section.positive("error")?,
        })
    }
}

/// A run of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LongRun {
    /// The place of the scene.
    scene: usize,
    /// Its number of linear elements; `None` for the run of any order.
    elements: Option<usize>,
}

const KEYS: [Key; 3] = [
    Key::new("run", Form::Table(&[&[&RUN]]), "the runs"),
    Key::new(
        "any-order",
        Form::Table(&[&[&ANY_ORDER, &DISCRETISATION_KEYS]]),
        "the same scenes by dG",
    )
    .or("not run"),
    Key::new(
        "expect",
        Form::Table(&[&[&EXPECTED]]),
        "what is claimed of their ends",
    ),
];
const RUN: [Key; 5] = [
    steady::SCENES,
    steady::MESHES,
    Key::new("dt", Form::Positive, "time step"),
    steady::SPEED,
    steady::T_MAX,
];
const ANY_ORDER: [Key; 2] = [
    Key::new("t_end", Form::Positive, "final time"),
    Key::new("error", Form::Positive, "error allowed"),
];
const EXPECTED: [Key; 2] = [
    steady::TOLERANCE,
    Key::new("error", Form::Positive, "error allowed on the finest mesh"),
];

impl Runs for EndStates {
    const KEYS: &'static [Keys] = &[&[&KEYS]];

    type Run = LongRun;
    /// Its end, and the nearest stable state.
    type Shown = AtRest;

    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let run = root.table("run", &[&RUN])?;
        let expect = root.table("expect", &[&EXPECTED])?;
        let (dt, t_max) = steps_to_rest(&run)?;
        let any_order = root.section("any-order")?;
        Ok(Self {
            elements: meshes(&run)?,
            scenes: listed_scenes(&run, folder)?,
            dt,
            speed: run.positive("speed")?,
            t_max,
            tolerance: tolerance(&expect)?,
            error: expect.positive("error")?,
            any_order: any_order.as_ref().map(AnyOrder::read).transpose()?,
        })
    }

    fn exercise(&self, case: Option<&str>) -> Exercise {
        Exercise::of_scenes("steady states", Integration::PAPER, &self.scenes, case)
    }

    fn runs(&self) -> Vec<Case<LongRun>> {
        let mut runs = vec![];
        for (scene, Scene { name, .. }) in self.scenes.iter().enumerate() {
            for &n in &self.elements {
                let elements = Some(n);
                let run = LongRun { scene, elements };
                let cost = cost_to_rest(n, self.dt);
                runs.push(Case::new(format!("{name}, n = {n}"), cost, run));
            }
        }
        if let Some(AnyOrder { how, t_end, .. }) = &self.any_order {
            for (scene, Scene { name, .. }) in self.scenes.iter().enumerate() {
                let elements = None;
                let run = LongRun { scene, elements };
                let label = format!("{name}, {}", how.label());
                runs.push(Case::new(label, how.cost(*t_end), run));
            }
        }
        runs
    }

    fn run(&self, &LongRun { scene, elements }: &LongRun) -> Result<AtRest, CaseFailure> {
        let scene = &self.scenes[scene];
        let end = match (elements, &self.any_order) {
            (Some(elements), _) => {
                let scene = scene.at(Mesh::uniform(elements)?, self.dt);
                let (t, level) = settle(&scene, self.speed, self.t_max)?;
                AtRest::of(&scene, &scene.mesh, t, &level, is_stable)
            }
            (None, Some(AnyOrder { how, t_end, .. })) => {
                let mesh = Mesh::uniform(COMPARED)?;
                let Traced { mesh, levels, .. } =
                    Traced::compute(&how.of(scene, *t_end)?, mesh, 1)?;
                let last = levels.last();
                let last = last.ok_or_else(|| CaseFailure::new("the run has no end"))?;
                AtRest::of(scene, &mesh, *t_end, last, is_stable)
            }
            (None, None) => Err(CaseFailure::new("the study has no run of any order")),
        }?;
        match end.nearest {
            Some(_) => Ok(end),
            None => Err(CaseFailure::new("there is no stable steady state")),
        }
    }

    fn numbers(&self, _: &LongRun, end: &AtRest) -> Vec<Reading> {
        let [[u, phi], [exact_u, exact_phi], [error_u, error_phi]] =
            [end.tip, end.exact_tip(), end.errors()];
        vec![
            Reading::new("u(1)", u),
            Reading::new("φ(1)", phi),
            Reading::new("exact u(1)", exact_u),
            Reading::new("exact φ(1)", exact_phi),
            Reading::new("error of u", error_u),
            Reading::new("error of φ", error_phi),
            Reading::new("time of rest", end.t),
        ]
    }

    fn judge(&self, results: &Results<'_, Self>) -> Findings {
        let scenes: Vec<Ends<'_>> = (0..self.scenes.len())
            .map(|scene| self.ends(results, scene))
            .collect();
        // Errors below the floor cannot be distinguished from the remaining motion.
        let bent = self
            .levels(scenes.iter().filter(|ends| !ends.is_straight()))
            .with_floor(Floor::new(MOTION * self.speed).unwrap_or_default());
        let rates = bent.judge();
        let caption =
            "Largest errors of u and φ at the nodes of beams at rest, against exact steady states.";
        let title = Some("Steady states".to_owned());
        let figure = bent.figure("errors", title, caption.to_owned(), &rates);
        let rows = scenes
            .iter()
            .map(|ends| (vec![ends.scene.name.clone()], ends.readings()));
        let elements = self.elements.last().unwrap_or(&0);
        let title = format!(
            "Ends of long runs ({elements} elements, and extrapolated) and exact steady states"
        );
        let worst = scenes.iter().map(Ends::error).fold(0.0, max_or_nan);
        let count = scenes.len();
        let checks = scenes.iter().map(Ends::check);
        let findings = Findings {
            summary: format!(
                "{count} long runs end at most {worst:.1e} from an exact steady state"
            ),
            headline: format!("largest error at the finest mesh {worst:.1e}, of {count} ends"),
            checks: checks
                .chain(scenes.iter().filter_map(Ends::check_any_order))
                .collect(),
            coverage: vec![Coverage::of(
                "ends for the order",
                scenes.iter().map(|ends| {
                    ends.is_straight()
                        .then_some("straight, so that the mesh causes no error")
                }),
            )],
            listings: vec![Listing::of(title, &["scene"], rows)],
            figures: vec![figure],
            ..Findings::default()
        };
        Findings {
            levels: self.levels(scenes.iter()).errors(),
            ..findings.with_orders(&bent, rates)
        }
    }
}

impl EndStates {
    /// Largest errors at the nodes over the mean mesh width.
    fn levels<'e>(&self, scenes: impl Iterator<Item = &'e Ends<'e>>) -> Levels {
        let mut columns = vec![];
        for (k, ends) in scenes.enumerate() {
            for (field, name) in ["u", "φ"].into_iter().enumerate() {
                let scene = &ends.scene.name;
                let errors = ends.ends.iter();
                let errors = errors.map(|end| Some(end.errors()[field]));
                let claim = Claim::new(ORDER, self.tolerance);
                columns.push(ErrorColumn {
                    subject: Subject::of(name).in_case(scene),
                    look: 2 * k + field,
                    ..ErrorColumn::new(format!("{scene}: {name}"), claim, errors)
                });
            }
        }
        let refinements = self
            .elements
            .iter()
            .map(|&n| level_of_mesh(format!("n = {n}"), n));
        Levels::new(Axis::Space, refinements, columns)
    }

    fn ends<'r>(&'r self, results: &Results<'r, Self>, scene: usize) -> Ends<'r> {
        let mut ends = vec![];
        for &n in &self.elements {
            ends.push(results.of(&LongRun {
                scene,
                elements: Some(n),
            }));
        }
        Ends {
            study: self,
            scene: &self.scenes[scene],
            ends,
            any_order: results.optional(&LongRun {
                scene,
                elements: None,
            }),
        }
    }
}

/// The ends of one scene, one for each mesh.
struct Ends<'r> {
    study: &'r EndStates,
    scene: &'r Scene,
    ends: Vec<&'r AtRest>,
    /// By the scheme of any order, where the study runs that.
    any_order: Option<&'r AtRest>,
}

fn is_stable(state: &Equilibrium) -> bool {
    state.stable
}

/// A number in the digits of the table.
fn tip_reading(head: &str, value: f64) -> Reading {
    Reading::new(head, value).shown(|value| decimals(value, 10))
}

impl Ends<'_> {
    fn finest(&self) -> Option<&AtRest> {
        self.ends.last().copied()
    }

    /// Two numbers of the finest end, of u and of φ.
    fn numbers(&self, numbers: fn(&AtRest) -> [f64; 2]) -> [f64; 2] {
        self.finest().map_or([f64::NAN; 2], numbers)
    }

    /// The larger error on the finest mesh.
    fn error(&self) -> f64 {
        let [u, phi] = self.numbers(AtRest::errors);
        max_or_nan(u, phi)
    }

    /// Whether the beam ends straight, in which case the mesh causes no error.
    fn is_straight(&self) -> bool {
        self.numbers(AtRest::exact_tip) == [0.0, 0.0]
    }

    /// The tip extrapolated from the two finest meshes to vanishing mesh width.
    fn extrapolated(&self, field: usize) -> f64 {
        let (&[.., coarse, fine], &[.., before, last]) = (&self.study.elements[..], &self.ends[..])
        else {
            return f64::NAN;
        };
        let [before, last] = [before.tip[field], last.tip[field]];
        last + richardson::correction(before, last, fine as f64 / coarse as f64, ORDER)
    }

    /// The end of a run, which either the run or the exact state may miss: other items tell the
    /// methods apart.
    fn end(&self) -> Subject {
        Subject::of("end")
            .in_case(&self.scene.name)
            .by(ItemMethod::Exact)
    }

    fn check(&self) -> Check {
        let allowed = self.study.error;
        let u = self.extrapolated(0);
        let [exact, _] = self.numbers(AtRest::exact_tip);
        // The beam may buckle to either side, but errors are comparable only if it is the same side
        // on all meshes.
        let contact = self.finest().and_then(AtRest::contact);
        let is_same = self.ends.iter().all(|end| end.contact() == contact);
        let n = self.study.elements.last().unwrap_or(&0);
        let [of_u, of_phi] = self.numbers(AtRest::errors);
        let [extrapolated, expected] = [u, exact].map(|u| decimals(u, 10));
        let errors = format!("largest error at {n} elements: u {of_u:.2e}, φ {of_phi:.2e}");
        let tips =
            format!("u(1) extrapolated from the last two meshes {extrapolated} for {expected}");
        all(
            format!("the beam comes to rest in the exact steady state, to {allowed:.0e}"),
            self.end(),
            [
                at_most(self.error(), allowed, errors),
                within(u, exact, EXTRAPOLATED * allowed, tips),
                Condition::or(is_same, "not all meshes end in the same state of contact"),
            ],
        )
    }

    /// The run of any order must end in an exact state, whichever of the stable ones it is.
    fn check_any_order(&self) -> Option<Check> {
        let AnyOrder { how, error, .. } = self.study.any_order.as_ref()?;
        let [u, phi] = self.any_order?.errors();
        let how = how.label();
        let claim =
            format!("by {how} the beam comes to rest in the exact steady state, to {error:.0e}");
        let errors = format!("largest error: u {u:.1e}, φ {phi:.1e}");
        let condition = at_most(max_or_nan(u, phi), *error, errors);
        Some(all(claim, self.end(), [condition]))
    }

    /// Tips on the finest mesh, extrapolated, and of the exact state; those of bent beams are
    /// guarded.
    fn readings(&self) -> Vec<Reading> {
        let contact = self.finest().and_then(AtRest::contact);
        let [u, phi] = self.numbers(|end| end.tip);
        let [exact_u, exact_phi] = self.numbers(AtRest::exact_tip);
        vec![
            Reading::text("at rest", contact.map_or("?", name_of)),
            self.guarded(tip_reading("u(1)", u), "u_tip", TIP),
            // The table shows the extrapolated value instead.
            self.guarded(Reading::new("φ(1)", phi), "phi_tip", TIP),
            tip_reading("extrapolated", self.extrapolated(0)),
            self.exact_reading("exact", exact_u, "exact_u_tip"),
            tip_reading("φ(1) extrapolated", self.extrapolated(1)),
            self.exact_reading("φ(1) exact", exact_phi, "exact_phi_tip"),
            Reading::new("at rest by t", self.finest().map_or(f64::NAN, |end| end.t)).fixed(0),
        ]
    }

    /// The reading, guarded if the beam is bent.
    fn guarded(&self, reading: Reading, quantity: &str, tolerance: f64) -> Reading {
        if self.is_straight() {
            return reading;
        }
        reading.guarded_in(&self.scene.name, quantity, tolerance)
    }

    /// A number of the exact state.
    fn exact_reading(&self, head: &str, value: f64, quantity: &str) -> Reading {
        let subject = Subject::of(quantity)
            .in_case(&self.scene.name)
            .by(ItemMethod::Exact);
        self.guarded(tip_reading(head, value), quantity, EXACT_TIP)
            .about(subject)
    }
}
