//! The verdict: each scene ends in its exact steady state, and converges to it at order 2 where that state is bent.

use convergence_study::judge::verdict::Judge;
use convergence_study::study::levels::{self, Claim, ErrorColumn, Levels, Refinement};
use convergence_study::study::{Axis, Check, Outcome, Quantity, Ran, Table};
use convergence_study::text::number::{decimals, max_or_nan};

use super::{AnyOrder, End, EndStates, Fields, OnMesh};
use crate::kinds::steady::name_of;
use crate::scene::Scene;
use convergence_study::judge::richardson;

/// Order of the elements in u and φ.
const ORDER: f64 = 2.0;

/// What is left of the tip's error when it is extrapolated from two meshes: the next term of the expansion, and the motion.
const EXTRAPOLATED: f64 = 1e-2;

/// Beyond so many times the velocity at rest an error is known: below, it is motion.
const MOTION: f64 = 10.0;

/// Relative changes that the baseline tolerates in the tips of discrete and of exact states.
const TIP_TOLERANCES: [f64; 2] = [1e-8, 1e-9];

pub(super) fn judge(study: &EndStates, ran: &[Ran<OnMesh, End>]) -> Outcome {
    let scenes: Vec<Ends<'_>> = (0..study.scenes.len()).map(|scene| Ends::of(study, ran, scene)).collect();
    let bent = errors(study, scenes.iter().filter(|ends| !ends.is_straight()));
    // What lies below the floor is known to the last of the motion only.
    let floor = MOTION * study.speed;
    let rates = bent.judge_by(|judge: Judge| judge.clone().with_floor(floor).unwrap_or(judge));
    let mut checks = vec![levels::completion(ran, not_finite)];
    checks.extend(scenes.iter().map(Ends::check));
    checks.extend(scenes.iter().filter_map(Ends::check_any_order));
    let figure = bent.figure(
        format!("{}-errors.svg", study.header.id),
        None,
        "Largest errors of u and φ at the nodes of beams at rest, against exact steady states.".to_owned(),
        &rates,
    );
    let quantities =
        scenes.iter().filter(|ends| !ends.is_straight()).flat_map(Ends::tips).chain(bent.quantities(&rates));
    let worst = scenes.iter().map(Ends::error).fold(0.0, max_or_nan);
    let summary = format!("{} long runs end at most {worst:.1e} from an exact steady state", scenes.len());
    Outcome {
        levels: errors(study, scenes.iter()).errors(),
        tables: vec![table(study, &scenes)],
        figures: vec![figure],
        quantities: quantities.collect(),
        headline: format!("largest error at the finest mesh {worst:.1e}, of {} ends", scenes.len()),
        ..Outcome::new(summary, rates, checks)
    }
}

fn not_finite(end: &End) -> Vec<String> {
    let End { t, tip, exact_tip, error, .. } = end;
    let pairs = [("tip", tip), ("exact tip", exact_tip), ("error", error)];
    let fields = pairs
        .into_iter()
        .flat_map(|(name, Fields { u, phi })| [(format!("{name} of u"), *u), (format!("{name} of φ"), *phi)]);
    let numbers = fields.chain([("time of rest".to_owned(), *t)]);
    numbers.filter(|(_, value)| !value.is_finite()).map(|(name, _)| name).collect()
}

/// Largest errors at the nodes over the mean mesh width.
fn errors<'e>(study: &EndStates, scenes: impl Iterator<Item = &'e Ends<'e>>) -> Levels {
    let refinement = |&elements: &usize| Refinement {
        label: format!("n = {elements}"),
        parameters: vec![("elements".to_owned(), elements as f64)],
        step: 1.0 / elements as f64,
    };
    let columns = scenes.enumerate().flat_map(|(k, ends)| {
        let column = |look: usize, field: &str, error: fn(&Fields) -> f64| ErrorColumn {
            name: format!("{}: {field}", ends.scene.name),
            errors: ends.ends.iter().map(|end| end.map(|end| error(&end.error))).collect(),
            claim: Some(Claim { order: ORDER, tolerance: study.tolerance }),
            look,
        };
        [column(2 * k, "u", |fields| fields.u), column(2 * k + 1, "φ", |fields| fields.phi)]
    });
    Levels {
        axis: Axis::Space,
        refinements: study.elements.iter().map(refinement).collect(),
        columns: columns.collect(),
    }
}

/// The ends of one scene, one for each mesh; `None` where the run failed.
struct Ends<'a> {
    study: &'a EndStates,
    scene: &'a Scene,
    ends: Vec<Option<&'a End>>,
    any_order: Option<&'a End>,
}

impl<'a> Ends<'a> {
    fn of(study: &'a EndStates, ran: &'a [Ran<OnMesh, End>], scene: usize) -> Self {
        let end = |elements: Option<usize>| {
            let place = OnMesh { scene, elements };
            ran.iter().find(|ran| ran.case.data == place).and_then(Ran::ok)
        };
        let ends = study.elements.iter().map(|&elements| end(Some(elements))).collect();
        Self { study, scene: &study.scenes[scene], ends, any_order: end(None) }
    }

    fn finest(&self) -> Option<&End> {
        self.ends.last().copied().flatten()
    }

    /// A number of the finest end; NaN where that run failed.
    fn number(&self, of: impl Fn(&End) -> f64) -> f64 {
        self.finest().map_or(f64::NAN, of)
    }

    /// The larger error on the finest mesh.
    fn error(&self) -> f64 {
        self.number(|end| max_or_nan(end.error.u, end.error.phi))
    }

    /// Whether the beam ends straight, where the mesh makes no error.
    fn is_straight(&self) -> bool {
        self.finest().is_some_and(|end| end.exact_tip == Fields { u: 0.0, phi: 0.0 })
    }

    /// The value that the two finest meshes give for vanishing mesh width.
    fn extrapolated(&self, of: impl Fn(&End) -> f64) -> f64 {
        let (&[.., coarse, fine], &[.., Some(before), Some(last)]) = (&self.study.elements[..], &self.ends[..]) else {
            return f64::NAN;
        };
        of(last) + richardson::correction(of(before), of(last), fine as f64 / coarse as f64, ORDER)
    }

    fn check(&self) -> Check {
        let allowed = self.study.error;
        let (u, exact) = (self.extrapolated(|end| end.tip.u), self.number(|end| end.exact_tip.u));
        // The beam may buckle to either side, but the errors are comparable only where all meshes agree on one.
        let contact = self.finest().map(|end| end.contact);
        let same_side = self.ends.iter().all(|end| end.is_some() && end.map(|end| end.contact) == contact);
        Check::that(
            self.error() <= allowed && (u - exact).abs() <= EXTRAPOLATED * allowed && same_side,
            format!("{} comes to rest in the exact steady state, to {allowed:.0e}", self.scene.name),
            format!(
                "largest error at {} elements: u {:.2e}, φ {:.2e}; u(1) extrapolated from the last two meshes {} for {}",
                self.study.elements.last().unwrap_or(&0),
                self.number(|end| end.error.u),
                self.number(|end| end.error.phi),
                decimals(u, 10),
                decimals(exact, 10)
            ),
        )
    }

    /// The run of any order ends in the exact state, whichever stable one that is.
    fn check_any_order(&self) -> Option<Check> {
        let AnyOrder { how, error: allowed, .. } = self.study.any_order.as_ref()?;
        let Fields { u, phi } = self.any_order.map_or(Fields { u: f64::NAN, phi: f64::NAN }, |end| end.error);
        Some(Check::that(
            max_or_nan(u, phi) <= *allowed,
            format!("{} by {} comes to rest in the exact steady state, to {allowed:.0e}", self.scene.name, how.label()),
            format!("largest error: u {u:.1e}, φ {phi:.1e}"),
        ))
    }

    /// Tips on the finest mesh and of the exact state.
    fn tips(&self) -> [Quantity; 4] {
        let guard = |name: &str, tolerance: f64, of: fn(&End) -> f64| Quantity {
            name: format!("{}: {name}", self.scene.name),
            value: self.number(of),
            tolerance,
        };
        let [discrete, exact] = TIP_TOLERANCES;
        [
            guard("u_tip", discrete, |end| end.tip.u),
            guard("phi_tip", discrete, |end| end.tip.phi),
            guard("exact_u_tip", exact, |end| end.exact_tip.u),
            guard("exact_phi_tip", exact, |end| end.exact_tip.phi),
        ]
    }
}

fn table(study: &EndStates, scenes: &[Ends<'_>]) -> Table {
    let row = |ends: &Ends<'_>| {
        vec![
            ends.scene.name.clone(),
            ends.finest().map_or("?", |end| name_of(end.contact)).to_owned(),
            decimals(ends.number(|end| end.tip.u), 10),
            decimals(ends.extrapolated(|end| end.tip.u), 10),
            decimals(ends.number(|end| end.exact_tip.u), 10),
            decimals(ends.extrapolated(|end| end.tip.phi), 10),
            decimals(ends.number(|end| end.exact_tip.phi), 10),
            format!("{:.0}", ends.number(|end| end.t)),
        ]
    };
    let elements = study.elements.last().unwrap_or(&0);
    Table {
        title: format!("Ends of long runs ({elements} elements, and extrapolated) and exact steady states"),
        head: ["scene", "at rest", "u(1)", "extrapolated", "exact", "φ(1) extrapolated", "exact", "at rest by t"]
            .map(String::from)
            .to_vec(),
        rows: scenes.iter().map(row).collect(),
    }
}
