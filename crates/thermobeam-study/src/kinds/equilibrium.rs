//! The ends of long runs, compared with exact steady states, which no source term keeps in place.
//!
//! A beam at rest solves the discrete static problem to round-off for any time step. What remains
//! is the error of P1 elements, O(h²) at the nodes in u and in φ; with elements of high degree and
//! dG(q) it nearly vanishes. A straight steady state has no such error: the beam is only checked to
//! end straight, up to the remaining motion.

use super::prelude::*;
use super::settings;
pub use super::steady::{AtRest, Nearest};
use super::steady::{
    cost_to_rest, listed_scenes, meshes, name_of, settle, steps_to_rest, tolerance,
};
use super::tables::{DISCRETISATION_KEYS, Discretisation};
use crate::error::reference::Traced;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/equilibrium",
    read: reader::<EndStates>,
    why: "All steady states are roots of a function of one variable, known to round-off. A damped beam must come to rest at one.",
    judged: "Beams are run to rest on several meshes; their end states converge at second order to an exact \
             state; a run of any order ends in it.",
    failure: "The steady part of the equations is discretised wrongly, or the beam has not come to rest.",
    settings: settings::of_ends,
};

/// Order of the elements in u and φ.
const ORDER: f64 = 2.0;

/// Remaining share of the tip's error after extrapolation from two meshes: the next term of the
/// expansion, and the motion.
const EXTRAPOLATED: f64 = 1e-2;

/// Errors below this multiple of the velocity at rest are motion.
const MOTION: f64 = 10.0;

/// Relative changes that the baseline tolerates in the tips of discrete and of exact states.
const TIP_TOLERANCES: [f64; 2] = [1e-8, 1e-9];

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
    /// The same scenes by the scheme of any order: discretisation, final time, and allowed error.
    any_order: Option<(Discretisation, f64, f64)>,
}

impl FromFile for EndStates {
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "run", "any-order", "expect"])?;
        let run = root.table("run", &["scenes", "elements", "dt", "speed", "t_max"])?;
        let expect = root.table("expect", &["tolerance", "error"])?;
        let (dt, t_max) = steps_to_rest(&run)?;
        let elements = meshes(&run)?;
        let any_order = |section: Section<'_>| {
            section.allow(&[&["t_end", "error"][..], &DISCRETISATION_KEYS].concat())?;
            let t_end = section.positive("t_end")?;
            Ok((
                Discretisation::read(&section, t_end)?,
                t_end,
                section.positive("error")?,
            ))
        };
        Ok(Self {
            scenes: listed_scenes(&run, folder)?,
            elements,
            dt,
            speed: run.positive("speed")?,
            t_max,
            tolerance: tolerance(&expect)?,
            error: expect.positive("error")?,
            any_order: root.section("any-order")?.map(any_order).transpose()?,
        })
    }
}

impl Kind for EndStates {
    /// Index of a scene, and its number of linear elements; `None` for the run of any order.
    type Data = (usize, Option<usize>);
    /// Its end, and the nearest stable state.
    type Found = AtRest;

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let case = |(scene, elements): (usize, Option<usize>)| {
            let (how, cost) = match (elements, &self.any_order) {
                (None, Some((how, t_end, _))) => (how.label(), how.cost(*t_end)),
                (elements, _) => {
                    let n = elements.unwrap_or(0);
                    (format!("n = {n}"), cost_to_rest(n, self.dt))
                }
            };
            Case::new(
                format!("{}, {how}", self.scenes[scene].name),
                cost,
                (scene, elements),
            )
        };
        let scenes = || 0..self.scenes.len();
        let linear =
            scenes().flat_map(|scene| self.elements.iter().map(move |&n| (scene, Some(n))));
        let any_order = scenes()
            .filter(|_| self.any_order.is_some())
            .map(|scene| (scene, None));
        linear.chain(any_order).map(case).collect()
    }

    fn run(&self, &(scene, elements): &Self::Data) -> Result<AtRest, CaseFailure> {
        let scene = &self.scenes[scene];
        let is_stable = |state: &Equilibrium| state.stable;
        let absent = |what: &'static str| move || CaseFailure::new(what);
        let end = if let Some(elements) = elements {
            let scene = scene.at(Mesh::uniform(elements)?, self.dt);
            let (t, level) = settle(&scene, self.speed, self.t_max)?;
            AtRest::of(&scene, &scene.mesh, t, &level, is_stable)
        } else {
            let (how, t_end, _) = self
                .any_order
                .as_ref()
                .ok_or_else(absent("the study has no run of any order"))?;
            let Traced { mesh, levels, .. } =
                Traced::compute(&how.of(scene, *t_end)?, Mesh::uniform(COMPARED)?, 1)?;
            AtRest::of(
                scene,
                &mesh,
                *t_end,
                levels.last().ok_or_else(absent("the run has no end"))?,
                is_stable,
            )
        }?;
        end.nearest
            .map(|_| end)
            .ok_or_else(absent("there is no stable steady state"))
    }

    fn judge(&self, ran: &[Ran<(usize, Option<usize>), AtRest>]) -> Outcome {
        let scenes: Vec<Ends<'_>> = (0..self.scenes.len())
            .map(|scene| Ends::of(self, ran, scene))
            .collect();
        // Errors below the floor cannot be distinguished from the remaining motion.
        let bent = self
            .levels(scenes.iter().filter(|ends| !ends.is_straight()))
            .with_floor(MOTION * self.speed);
        let rates = bent.judge();
        let mut checks = vec![completion(ran, |end| {
            let fields = [
                ("tip", end.tip),
                ("exact tip", end.exact_tip()),
                ("error", end.errors()),
            ];
            let of_fields =
                fields.map(|(name, [u, phi])| Reading::new(format!("{name} of u or φ"), u + phi));
            readings::not_finite(&[&of_fields[..], &[Reading::new("time of rest", end.t)]].concat())
        })];
        checks.extend(scenes.iter().map(Ends::check));
        checks.extend(scenes.iter().filter_map(Ends::check_any_order));
        let caption =
            "Largest errors of u and φ at the nodes of beams at rest, against exact steady states.";
        let figure = bent.figure(
            "errors",
            Some("Steady states".to_owned()),
            caption.to_owned(),
            &rates,
        );
        let rows: Vec<_> = scenes
            .iter()
            .map(|ends| (vec![ends.scene.name.clone()], ends.readings()))
            .collect();
        let bent_rows = rows
            .iter()
            .zip(&scenes)
            .filter(|(_, ends)| !ends.is_straight());
        let tips = readings::guarded(bent_rows.flat_map(|((_, readings), _)| readings));
        let elements = self.elements.last().unwrap_or(&0);
        let title = format!(
            "Ends of long runs ({elements} elements, and extrapolated) and exact steady states"
        );
        let worst = scenes.iter().map(Ends::error).fold(0.0, max_or_nan);
        let summary = format!(
            "{} long runs end at most {worst:.1e} from an exact steady state",
            scenes.len()
        );
        let straight = |ends: &Ends<'_>| {
            ends.is_straight()
                .then_some("straight, so that the mesh causes no error")
        };
        Outcome {
            coverage: vec![Coverage::of(
                "ends for the order",
                scenes.iter().map(straight),
            )],
            levels: self.levels(scenes.iter()).errors(),
            rate_subjects: bent.subjects.clone(),
            tables: vec![readings::table(title, &["scene"], &rows)],
            figures: vec![figure],
            quantities: [tips, bent.quantities(&rates)].concat(),
            headline: format!(
                "largest error at the finest mesh {worst:.1e}, of {} ends",
                scenes.len()
            ),
            ..Outcome::new(summary, rates, checks)
        }
    }
}

impl EndStates {
    /// Largest errors at the nodes over the mean mesh width.
    fn levels<'e>(&self, scenes: impl Iterator<Item = &'e Ends<'e>>) -> Levels {
        let mut columns = vec![];
        let mut subjects = vec![];
        for (k, ends) in scenes.enumerate() {
            for (field, name) in ["u", "φ"].into_iter().enumerate() {
                let scene = &ends.scene.name;
                let column = ErrorColumn {
                    name: format!("{scene}: {name}"),
                    symbol: None,
                    errors: ends
                        .ends
                        .iter()
                        .map(|end| end.map(|end| end.errors()[field]))
                        .collect(),
                    claim: Some(Claim::new(ORDER, self.tolerance)),
                    look: 2 * k + field,
                };
                subjects.push((column.name.clone(), Subject::of(name).in_case(scene)));
                columns.push(column);
            }
        }
        let refinement =
            |&n: &usize| Refinement::new(format!("n = {n}"), &[("elements", n)], 1.0 / n as f64);
        Levels::new(Axis::Space, self.elements.iter().map(refinement), columns)
            .with_subjects(subjects)
    }
}

/// The ends of one scene, one for each mesh; `None` if the run failed.
struct Ends<'a> {
    study: &'a EndStates,
    scene: &'a Scene,
    ends: Vec<Option<&'a AtRest>>,
    any_order: Option<&'a AtRest>,
}

impl<'a> Ends<'a> {
    fn of(
        study: &'a EndStates,
        ran: &'a [Ran<(usize, Option<usize>), AtRest>],
        scene: usize,
    ) -> Self {
        let end = |elements: Option<usize>| found(ran, &(scene, elements));
        let ends = study
            .elements
            .iter()
            .map(|&elements| end(Some(elements)))
            .collect();
        Self {
            study,
            scene: &study.scenes[scene],
            ends,
            any_order: end(None),
        }
    }

    fn finest(&self) -> Option<&AtRest> {
        self.ends.last().copied().flatten()
    }

    /// A number of the finest end; NaN if that run failed.
    fn number(&self, of: impl Fn(&AtRest) -> f64) -> f64 {
        self.finest().map_or(f64::NAN, of)
    }

    /// The larger error on the finest mesh.
    fn error(&self) -> f64 {
        self.number(|end| max_or_nan(end.errors()[0], end.errors()[1]))
    }

    /// Whether the beam ends straight, in which case the mesh causes no error.
    fn is_straight(&self) -> bool {
        self.finest()
            .is_some_and(|end| end.exact_tip() == [0.0, 0.0])
    }

    /// The tip extrapolated from the two finest meshes to vanishing mesh width.
    fn extrapolated(&self, field: usize) -> f64 {
        let (&[.., coarse, fine], &[.., Some(before), Some(last)]) =
            (&self.study.elements[..], &self.ends[..])
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
        let (u, exact) = (self.extrapolated(0), self.number(|end| end.exact_tip()[0]));
        // The beam may buckle to either side, but errors are comparable only if it is the same side
        // on all meshes.
        let contact = self.finest().and_then(AtRest::contact);
        let same_side = self
            .ends
            .iter()
            .all(|end| end.is_some() && end.and_then(AtRest::contact) == contact);
        let n = self.study.elements.last().unwrap_or(&0);
        let [of_u, of_phi] = self.finest().map_or([f64::NAN; 2], AtRest::errors);
        let [found, expected] = [u, exact].map(|u| decimals(u, 10));
        let errors = format!("largest error at {n} elements: u {of_u:.2e}, φ {of_phi:.2e}");
        Check::that(
            self.error() <= allowed && (u - exact).abs() <= EXTRAPOLATED * allowed && same_side,
            format!("the beam comes to rest in the exact steady state, to {allowed:.0e}"),
            format!("{errors}; u(1) extrapolated from the last two meshes {found} for {expected}"),
        )
        .about(self.end())
    }

    /// The run of any order must end in an exact state, whichever of the stable ones it is.
    fn check_any_order(&self) -> Option<Check> {
        let (how, _, allowed) = self.study.any_order.as_ref()?;
        let [u, phi] = self.any_order.map_or([f64::NAN; 2], AtRest::errors);
        Some(
            Check::that(
                max_or_nan(u, phi) <= *allowed,
                format!(
                    "by {} the beam comes to rest in the exact steady state, to {allowed:.0e}",
                    how.label()
                ),
                format!("largest error: u {u:.1e}, φ {phi:.1e}"),
            )
            .about(self.end()),
        )
    }

    /// Tips on the finest mesh, extrapolated, and of the exact state.
    fn readings(&self) -> Vec<Reading> {
        let [discrete, exact] = TIP_TOLERANCES;
        let shown =
            |head: &str, value: f64| Reading::new(head, value).shown(|value| decimals(value, 10));
        let tip = |reading: Reading, name: &str, tolerance: f64| {
            reading.guarded_in(&self.scene.name, name, tolerance)
        };
        let exact_tip = |reading: Reading, name: &str| {
            let subject = Subject::of(name)
                .in_case(&self.scene.name)
                .by(ItemMethod::Exact);
            tip(reading, name, exact).about(subject)
        };
        vec![
            Reading::text(
                "at rest",
                self.finest().and_then(AtRest::contact).map_or("?", name_of),
            ),
            tip(
                shown("u(1)", self.number(|end| end.tip[0])),
                "u_tip",
                discrete,
            ),
            // The table shows the extrapolated value instead.
            tip(
                Reading::new("φ(1)", self.number(|end| end.tip[1])),
                "phi_tip",
                discrete,
            ),
            shown("extrapolated", self.extrapolated(0)),
            exact_tip(
                shown("exact", self.number(|end| end.exact_tip()[0])),
                "exact_u_tip",
            ),
            shown("φ(1) extrapolated", self.extrapolated(1)),
            exact_tip(
                shown("φ(1) exact", self.number(|end| end.exact_tip()[1])),
                "exact_phi_tip",
            ),
            Reading::new("at rest by t", self.number(|end| end.t)).fixed(0),
        ]
    }
}
