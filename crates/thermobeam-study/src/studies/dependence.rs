//! Continuous dependence on the data, which gives Theorem 2.6: runs whose data are δ apart stay
//! within C δ of each other, and difference/δ is constant as δ → 0.
//!
//! The scene is run by dG, whose solution is known to round-off; the differences are those of the
//! norm of (3.14) at several times, before and after contacts. There they stay below a bound by
//! Lipschitz constants along the run: THEORY.md, "Continuous dependence". The bound grows with
//! every contact, so it is judged where a difference is at least a thousandth of it.

use super::prelude::*;
use crate::error::reference::{Traced, distance};
use crate::exact::norm::slope_squared;
use crate::expression::{Expression, Variable};
use crate::run::levels::equidistant_time;
use crate::scene::Scene;
use thermobeam::{kirchhoff::BUCKLING, mesh::Mesh, parameters::Beam};

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "theorem-2.6",
    claim: "Theorem 2.6: the difference of two solutions is proportional to that of their data, through contacts too",
    tier: Tier::Quick,
    group: "contact",
    home: file!(),
};

/// Free flight until t = 0.203, then the upper obstacle, then the lower one at t = 0.858.
const SCENE: &str = r#"
beam = { zeta = 0.1, a = 0.017, rho = 1.0, beta = 0.0, theta_a = 0.0 }
obstacles = { epsilon = 1e-3, g1 = -0.01, g2 = 0.1 }
initial = { u = "0.01*x*(x-2)", u_t = "20*x*(x-1)^2", theta = "sin(pi*x)" }
mesh = { elements = 1, degree = 16 }
time = { scheme = "dg", degree = 3, dt = 0.02, restart_dt = 1e-3, growth = 1.5, t_end = 1.2 }
"#;
/// What δ multiplies in u(x, 0).
const DIRECTION: &str = "x^2*(1-x)^2";
const DELTAS: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10];
const T_END: f64 = 1.2;
/// Times of comparison.
const SAMPLES: usize = 12;
/// More of them, soon after the first contact.
const AFTER_CONTACT: [f64; 3] = [0.204, 0.206, 0.208];
/// The largest δ for which difference/δ is constant there: δ moves the contact by O(δ), which is a
/// share of the few thousandths that the impact takes.
const SMALL: f64 = 1e-4;
/// Share of the bound below which a difference says nothing of it.
const TELLING: f64 = 1e-3;
/// Times from one comparison to the next at which the Lipschitz constant is taken.
const FINE: usize = 10;
/// Elements on whose nodes runs are compared.
const COMPARED: usize = 64;
/// Relative change of difference/δ allowed.
const WITHIN: f64 = 1e-3;
/// Relative change of a ratio that the baseline tolerates: round-off over the smallest δ.
const GUARDED: f64 = 1e-3;

const CHANGE: &str = "relative change of difference/δ";

/// Runs with data δ apart, δ = 0 first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dependence;

/// The study.
pub fn study() -> Described<Dependence> {
    ABOUT.study(Dependence)
}

impl Kind for Dependence {
    /// δ.
    type Data = f64;
    type Found = Traced;

    fn cases(&self) -> Vec<Case<f64>> {
        // A run of the scene to t = 1 takes about as long as 1e6 steps of an element.
        let parts = Scene::parse(SCENE, file!()).ok();
        let parts = parts.map(|scene| Parts::of(&scene));
        let base = Case::new("δ = 0", 1e6 * T_END, 0.0);
        let others = DELTAS.map(|delta| Case::new(format!("δ = {delta:e}"), 1e6 * T_END, delta));
        let cases = [base].into_iter().chain(others);
        cases.map(|case| case.described(&parts)).collect()
    }

    fn run(&self, delta: &f64) -> Result<Traced, CaseFailure> {
        let mut scene = Scene::parse(SCENE, file!())?;
        if let (Some(u), true) = (&scene.initial.u, *delta > 0.0) {
            let sum = format!("({u}) + {delta:e}*({DIRECTION})");
            scene.initial.u = Some(Expression::parse(&sum, Variable::X)?);
        }
        // All runs have the same steps, which end at these times.
        let times: Vec<f64> = moments().iter().map(|moment| moment.t).collect();
        Traced::at(&scene, Mesh::uniform(COMPARED)?, &times)
    }

    fn judge(&self, ran: &[Ran<f64, Traced>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| {
            let [(_, base), others @ ..] = shown else {
                return Outcome::of_sheets([], CHANGE);
            };
            let moments = moments();
            let bounds = bounds(&moments, base);
            let mut found: Vec<Measured> = vec![];
            let mut telling = 0;
            for (index, moment) in moments.into_iter().enumerate() {
                let Some(case) = moment.case else { continue };
                let ratios = ratios(base, others, index);
                let last = ratios.last().copied();
                let bound = bounds.get(index);
                let used = last.zip(bound).map(|(last, bound)| last / bound.value);
                let says_nothing = used.is_some_and(|used| used < TELLING);
                telling +=
                    usize::from(!says_nothing && bound.is_some_and(|bound| bound.is_after_contact));
                let small = others
                    .iter()
                    .map(|(delta, _)| **delta <= moment.largest_delta);
                let small = ratios.iter().zip(small).filter(|(_, is_small)| *is_small);
                let small: Vec<f64> = small.map(|(ratio, _)| *ratio).collect();
                found.extend([
                    measured(&case, "difference/δ, largest δ", ratios.first().copied()).fixed(6),
                    measured(&case, "smallest δ", last)
                        .fixed(6)
                        .must_be(Must::Above(0.0))
                        .recorded("ratio", GUARDED),
                    measured(&case, CHANGE, change(&small))
                        .scientific(1)
                        .must_be(Must::AtMost(WITHIN)),
                    measured(
                        &case,
                        "bound by Lipschitz constants",
                        bound.map(|bound| bound.value),
                    ),
                    measured(&case, "difference/δ over the bound", used)
                        .scientific(1)
                        .must_be((!says_nothing).then_some(Must::AtMost(1.0))),
                ]);
            }
            let times = "times after the first contact at which the bound is judged";
            let times = measured("", times, telling as f64).must_be(Must::AtLeast(3.0));
            found.push(times.hidden());
            let title = "Difference of two solutions in the norm of (3.14), over δ. Below 1e-3 of the bound it says nothing of it";
            Outcome::of_sheets([Sheet::new(title, "time", found)], CHANGE)
        })
    }
}

/// A time at which a step ends.
struct Moment {
    t: f64,
    /// The name of a time at which solutions are compared.
    case: Option<String>,
    /// The largest δ for which difference/δ is constant.
    largest_delta: f64,
}

/// The times at which steps end, ascending.
fn moments() -> Vec<Moment> {
    let steps = FINE * SAMPLES;
    let equidistant = (1..=steps).map(|k| {
        let t = equidistant_time(T_END, k, steps);
        let case = k.is_multiple_of(FINE).then(|| format!("t = {t:.2}"));
        let largest_delta = f64::INFINITY;
        Moment {
            t,
            case,
            largest_delta,
        }
    });
    let after_contact = AFTER_CONTACT.map(|t| Moment {
        t,
        case: Some(format!("t = {t}")),
        largest_delta: SMALL,
    });
    let mut moments: Vec<Moment> = equidistant.chain(after_contact).collect();
    moments.sort_by(|a, b| a.t.total_cmp(&b.t));
    moments
}

/// What difference/δ is at most at a moment, as δ → 0.
struct Bound {
    value: f64,
    /// Whether the tip has touched an obstacle.
    is_after_contact: bool,
}

/// At each moment the norm of the direction times `exp(∫ L²/(4ζB²) dt) Π √(1 + 1/(εB))`,
/// L = |β| + 3ρ‖u_x‖², with a factor for each contact that has begun. Empty for a scene that cannot
/// be read.
fn bounds(moments: &[Moment], base: &Traced) -> Vec<Bound> {
    let (Ok(scene), Ok(direction)) = (
        Scene::parse(SCENE, file!()),
        Expression::parse(DIRECTION, Variable::X),
    ) else {
        return vec![];
    };
    let Beam {
        zeta, beta, rho, ..
    } = scene.beam;
    let values: Vec<f64> = base
        .mesh
        .nodes()
        .iter()
        .map(|x| direction.eval(*x))
        .collect();
    let lengths: Vec<f64> = base.mesh.lengths().collect();
    // The norm of (3.14) of the direction, which is one of u alone.
    let mut logarithm = slope_squared(&lengths, &values).sqrt().ln();
    let mut is_in_contact = false;
    let mut is_after_contact = false;
    let mut before = 0.0;
    let mut bounds = vec![];
    for (Moment { t, .. }, level) in moments.iter().zip(&base.levels) {
        let lipschitz = beta.abs() + 3.0 * rho * slope_squared(&lengths, &level.u);
        logarithm += (t - before) * lipschitz.powi(2) / (4.0 * zeta * BUCKLING.powi(2));
        before = *t;
        let tip = level.u.last().copied().unwrap_or(f64::NAN);
        let touched = scene
            .obstacles
            .filter(|held| tip < held.g1 || tip > held.g2);
        if let (Some(held), false) = (touched, is_in_contact) {
            logarithm += 0.5 * (1.0 + 1.0 / (held.epsilon * BUCKLING)).ln();
        }
        is_in_contact = touched.is_some();
        is_after_contact |= is_in_contact;
        bounds.push(Bound {
            value: logarithm.exp(),
            is_after_contact,
        });
    }
    bounds
}

/// Difference/δ at a moment for each δ; empty if a run ended before.
fn ratios(base: &Traced, others: &[(&f64, &Traced)], at: usize) -> Vec<f64> {
    let lengths: Vec<f64> = base.mesh.lengths().collect();
    let ratios = others.iter().map(|(delta, other)| {
        Some(distance(&lengths, base.levels.get(at)?, other.levels.get(at)?) / *delta)
    });
    let ratios: Option<_> = ratios.collect();
    ratios.unwrap_or_default()
}

/// The largest relative change of numbers against the last.
fn change(ratios: &[f64]) -> Option<f64> {
    let last = ratios.last()?;
    largest_of(ratios.iter().map(|ratio| (ratio / last - 1.0).abs()))
}
