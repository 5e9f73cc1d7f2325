//! Continuous dependence on the data, which gives Theorem 2.6: runs whose data are δ apart stay
//! within C δ of each other, and difference/δ is constant as δ → 0.
//!
//! The scene is run by dG, whose solution is known to round-off; the differences are those of the
//! norm of (3.14) at several times, before and after contacts. There they stay below a bound by
//! Lipschitz constants along the run: THEORY.md, "Continuous dependence".

use super::{
    Findings, Listing, Results, RunStudy, Runs,
    checks::{Condition, all, at_most},
};
use crate::kinds::prelude::*;
use crate::{
    error::reference::{Traced, distance},
    expression::{Expression, Variable},
    kinds::settings::{CONTACT, Exercise, Integration},
    scene::{Method, Scene, tables},
};
use thermobeam::{kirchhoff::BUCKLING, mesh::Mesh, parameters::Beam};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/dependence",
    keys: Dependence::KEYS,
    read: read_study::<RunStudy<Dependence>>,
    why: "Theorem 2.6: a solution is unique. Its proof is an estimate for the difference of two solutions, by which data δ apart \
          cause a difference of at most C δ.",
    judged: "A scene is run with data δ apart. At each time difference/δ is the same for every δ, through contacts too, and at most \
             the bound that Lipschitz constants along the run give.",
    failure: "The motion depends on its data by jumps: a contact event is missed, or a step has several solutions.",
};

/// Elements on whose nodes runs are compared.
const COMPARED: usize = 64;

/// Times from one comparison to the next at which the Lipschitz constant is taken.
const FINE: usize = 10;

/// Relative change of a ratio that the baseline tolerates: round-off over the smallest δ.
const GUARDED: f64 = 1e-3;

/// Runs of a scene with data δ apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Dependence {
    scene: Scene,
    /// What δ multiplies in u(x, 0).
    direction: Expression,
    t_end: f64,
    samples: usize,
    /// δ, descending; at least two.
    differences: Vec<f64>,
    /// Relative change of difference/δ allowed.
    within: f64,
}

const KEYS: [Key; 6] = [
    Key::new("scene", Form::Text, "a scene file, by dG"),
    Key::new(
        "direction",
        Form::Text,
        "the function of x that δ multiplies in u(x, 0)",
    ),
    Key::new("t_end", Form::Positive, "final time"),
    Key::new("samples", Form::Count(1), "times of comparison"),
    Key::new(
        "differences",
        Form::List(&Form::Positive),
        "the numbers δ, descending",
    ),
    Key::new(
        "within",
        Form::Positive,
        "relative change allowed of difference/δ",
    ),
];

impl Runs for Dependence {
    const KEYS: &'static [Keys] = &[&[&KEYS]];

    /// The place of δ; `None` for δ = 0.
    type Run = Option<usize>;
    type Shown = Traced;

    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let file = root.require("scene", "the path of a scene, from this file's folder")?;
        let scene = Scene::read(file.file(folder)?)?;
        if !matches!(scene.method, Method::Dg(_)) {
            return Err(file.refuse("a scene by a one-step scheme", "a scene by dG"));
        }
        let direction = root.require("direction", "a function of x")?;
        Ok(Self {
            direction: tables::function(&direction, Variable::X, 1.0, 0)?,
            t_end: root.positive("t_end")?,
            samples: root.count("samples", 1..=1000)?,
            differences: root.list(
                "differences",
                "a list of at least two numbers > 0, descending",
                |item| item.positive(),
                |list| list.len() >= 2 && list.is_sorted_by(|a, b| a > b),
            )?,
            within: root.positive("within")?,
            scene,
        })
    }

    fn exercise(&self, _case: Option<&str>) -> Exercise {
        Exercise::of_scene(CONTACT, Integration::AnyOrder, &self.scene)
    }

    fn runs(&self) -> Vec<Case<Option<usize>>> {
        // A run of the scene to t = 1 takes about as long as 1e6 steps of an element.
        let cost = 1e6 * self.t_end;
        let mut runs = vec![Case::new("δ = 0", cost, None)];
        for (place, delta) in self.differences.iter().enumerate() {
            runs.push(Case::new(format!("δ = {delta:e}"), cost, Some(place)));
        }
        runs
    }

    fn run(&self, place: &Option<usize>) -> Result<Traced, CaseFailure> {
        let mut scene = self.scene.clone();
        scene.t_end = self.t_end;
        if let Some(place) = *place {
            let u = scene.initial.u.as_ref();
            let u = u.map_or_else(|| "0".to_owned(), Expression::to_string);
            let text = format!("({u}) + {:e}*({})", self.differences[place], self.direction);
            let sum = Expression::parse(&text, Variable::X);
            scene.initial.u = Some(sum.map_err(|error| CaseFailure::new(error.to_string()))?);
        }
        // All runs have the same steps, which end at these times.
        Traced::compute(&scene, Mesh::uniform(COMPARED)?, FINE * self.samples)
    }

    fn numbers(&self, _: &Option<usize>, traced: &Traced) -> Vec<Reading> {
        let tip = traced
            .levels
            .last()
            .and_then(|level| level.u.last().copied());
        vec![Reading::new("u(1) at the end", tip)]
    }

    fn judge(&self, results: &Results<'_, Self>) -> Findings {
        let mut rows = vec![];
        let mut checks = vec![];
        let mut largest = 0.0;
        let bounds = self.bounds(results.of(&None));
        for sample in 0..self.samples {
            let t = self.t_end * (sample + 1) as f64 / self.samples as f64;
            let case = format!("t = {t:.2}");
            let ratios = self.ratios(results, sample);
            let change = change(&ratios);
            largest = max_or_nan(largest, change);
            let smallest = ratios.last().copied();
            let bound = bounds.get(sample).copied().unwrap_or(f64::NAN);
            let used = smallest.unwrap_or(f64::NAN) / bound;
            rows.push((
                vec![case.clone()],
                vec![
                    Reading::new("difference/δ, largest δ", ratios.first().copied()).fixed(6),
                    Reading::new("smallest δ", smallest)
                        .fixed(6)
                        .guarded_in(&case, "ratio", GUARDED),
                    Reading::new("relative change", change).scientific(1),
                    Reading::new("bound", bound).scientific(2),
                    Reading::new("of the bound", used).scientific(1),
                ],
            ));
            checks.push(below_bound(&case, used, bound));
            let evidence = format!("relative change {change:.1e}");
            checks.push(all(
                format!(
                    "difference/δ is the same for every δ, within {:e}",
                    self.within
                ),
                Subject::of("difference of solutions").in_case(case),
                [
                    at_most(change, self.within, evidence),
                    Condition::or(smallest.is_some_and(|ratio| ratio > 0.0), "no difference"),
                ],
            ));
        }
        let range = [self.differences.first(), self.differences.last()];
        let [from, to] = range.map(|delta| delta.copied().unwrap_or(f64::NAN));
        let summary =
            format!("difference/δ changes by at most {largest:.1e} from δ = {from:e} to {to:e}");
        Findings {
            headline: summary.clone(),
            summary,
            checks,
            listings: vec![Listing::of(
                "Difference of two solutions in the norm of (3.14), over δ",
                &["time"],
                rows,
            )],
            ..Findings::default()
        }
    }
}

impl Dependence {
    /// At each sample the bound of difference/δ as δ → 0: the norm of the direction times
    /// `exp(∫ L²/(4ζB²) dt) Π √(1 + 1/(εB))`, L = |β| + 3ρ‖u_x‖², with a factor for each contact that
    /// has begun.
    fn bounds(&self, base: &Traced) -> Vec<f64> {
        let Beam {
            zeta, beta, rho, ..
        } = self.scene.beam;
        let length = self.t_end / (FINE * self.samples) as f64;
        let mut logarithm = self.direction_slope(base).ln();
        let mut was_in_contact = false;
        let mut bounds = vec![];
        for (index, level) in base.levels.iter().enumerate() {
            let lipschitz = beta.abs() + 3.0 * rho * slope_squared(base, &level.u);
            logarithm += length * lipschitz.powi(2) / (4.0 * zeta * BUCKLING.powi(2));
            let tip = level.u.last().copied().unwrap_or(f64::NAN);
            let compliance = self
                .scene
                .obstacles
                .as_ref()
                .filter(|obstacles| tip < obstacles.g1 || tip > obstacles.g2)
                .map(|obstacles| obstacles.epsilon);
            if let (Some(epsilon), false) = (compliance, was_in_contact) {
                logarithm += 0.5 * (1.0 + 1.0 / (epsilon * BUCKLING)).ln();
            }
            was_in_contact = compliance.is_some();
            if (index + 1).is_multiple_of(FINE) {
                bounds.push(logarithm.exp());
            }
        }
        bounds
    }

    /// The norm of (3.14) of the direction, which is one of u alone.
    fn direction_slope(&self, base: &Traced) -> f64 {
        let values: Vec<f64> = base
            .mesh
            .nodes()
            .iter()
            .map(|x| self.direction.eval(*x))
            .collect();
        slope_squared(base, &values).sqrt()
    }

    /// Difference/δ at a time for each δ; empty if a run ended before.
    fn ratios(&self, results: &Results<'_, Self>, sample: usize) -> Vec<f64> {
        let base = results.of(&None);
        let index = FINE * (sample + 1) - 1;
        let lengths: Vec<f64> = base.mesh.lengths().collect();
        let mut ratios = vec![];
        for (place, delta) in self.differences.iter().enumerate() {
            let other = results.of(&Some(place));
            let (Some(one), Some(other)) = (base.levels.get(index), other.levels.get(index)) else {
                return vec![];
            };
            ratios.push(distance(&lengths, one, other) / delta);
        }
        ratios
    }
}

/// * `used`: difference/δ in units of the bound.
fn below_bound(case: &str, used: f64, bound: f64) -> Check {
    let evidence = format!("{used:.1e} of the bound {bound:.2e}");
    all(
        "difference/δ is at most the bound by Lipschitz constants",
        Subject::of("bound of the difference").in_case(case),
        [at_most(used, 1.0, evidence)],
    )
}

/// ‖u_x‖² of a function with these values at the nodes on which runs are compared.
fn slope_squared(traced: &Traced, values: &[f64]) -> f64 {
    let pairs = values.windows(2).zip(traced.mesh.lengths());
    pairs
        .map(|(pair, length)| (pair[1] - pair[0]).powi(2) / length)
        .sum()
}

/// The largest relative change of numbers against the last; NaN without numbers.
fn change(ratios: &[f64]) -> f64 {
    let last = ratios.last().copied().unwrap_or(f64::NAN);
    let changes = ratios.iter().map(|ratio| (ratio / last - 1.0).abs());
    largest_of(changes).unwrap_or(f64::NAN)
}
