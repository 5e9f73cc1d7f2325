//! Continuous dependence on the data, which gives Theorem 2.6: runs whose data are δ apart stay
//! within C δ of each other, and difference/δ is constant as δ → 0.
//!
//! The scene is run by dG, whose solution is known to round-off; the differences are those of the
//! norm of (3.14) at several times, before and after contacts. There they stay below a bound by
//! Lipschitz constants along the run: THEORY.md, "Continuous dependence".

use super::prelude::*;
use crate::error::reference::{Traced, distance};
use crate::expression::{Expression, Variable};
use crate::scene::Scene;
use thermobeam::{kirchhoff::BUCKLING, mesh::Mesh, parameters::Beam};

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "theorem-2.6",
    claim: "Theorem 2.6: the difference of two solutions is proportional to that of their data, through contacts too",
    tier: Tier::Quick,
    group: "contact",
    headline: CHANGE,
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
pub fn study() -> Described<InCode<Dependence>> {
    ABOUT.study(Dependence)
}

impl Runs for Dependence {
    /// δ.
    type Run = f64;
    type Shown = Traced;

    fn runs(&self) -> Vec<Case<f64>> {
        // A run of the scene to t = 1 takes about as long as 1e6 steps of an element.
        let case = |delta| Case::new(format!("δ = {delta:e}"), 1e6 * T_END, delta);
        let base = Case::new("δ = 0", 1e6 * T_END, 0.0);
        [base].into_iter().chain(DELTAS.map(case)).collect()
    }

    fn run(&self, delta: &f64) -> Result<Traced, CaseFailure> {
        let mut scene = Scene::parse(SCENE, file!())?;
        if let (Some(u), true) = (&scene.initial.u, *delta > 0.0) {
            let sum = format!("({u}) + {delta:e}*({DIRECTION})");
            scene.initial.u = Some(Expression::parse(&sum, Variable::X)?);
        }
        // All runs have the same steps, which end at these times.
        Traced::compute(&scene, Mesh::uniform(COMPARED)?, FINE * SAMPLES)
    }

    fn judge(&self, shown: &[(&f64, &Traced)]) -> Findings {
        let [(_, base), others @ ..] = shown else {
            return Findings::default();
        };
        let bounds = bounds(base);
        let mut found: Vec<Measured> = vec![];
        for sample in 0..SAMPLES {
            let case = format!("t = {:.2}", T_END * (sample + 1) as f64 / SAMPLES as f64);
            let ratios = ratios(base, others, sample);
            let last = ratios.last().copied();
            let bound = bounds.get(sample).copied();
            let used = last.zip(bound).map(|(last, bound)| last / bound);
            found.extend([
                measured(&case, "difference/δ, largest δ", ratios.first().copied()).fixed(6),
                measured(&case, "smallest δ", last)
                    .fixed(6)
                    .must_be(Must::Above(0.0))
                    .recorded("ratio", GUARDED),
                measured(&case, CHANGE, change(&ratios))
                    .scientific(1)
                    .must_be(Must::AtMost(WITHIN)),
                measured(&case, "bound by Lipschitz constants", bound),
                measured(&case, "difference/δ over the bound", used)
                    .scientific(1)
                    .must_be(Must::AtMost(1.0)),
            ]);
        }
        let title = "Difference of two solutions in the norm of (3.14), over δ";
        Sheet::new(title, "time", found).into()
    }
}

/// At each sample the bound of difference/δ as δ → 0: the norm of the direction times
/// `exp(∫ L²/(4ζB²) dt) Π √(1 + 1/(εB))`, L = |β| + 3ρ‖u_x‖², with a factor for each contact that
/// has begun. Empty for a scene that cannot be read.
fn bounds(base: &Traced) -> Vec<f64> {
    let (Ok(scene), Ok(direction)) = (
        Scene::parse(SCENE, file!()),
        Expression::parse(DIRECTION, Variable::X),
    ) else {
        return vec![];
    };
    let Beam {
        zeta, beta, rho, ..
    } = scene.beam;
    let length = T_END / (FINE * SAMPLES) as f64;
    let values: Vec<f64> = base
        .mesh
        .nodes()
        .iter()
        .map(|x| direction.eval(*x))
        .collect();
    // The norm of (3.14) of the direction, which is one of u alone.
    let mut logarithm = slope_squared(base, &values).sqrt().ln();
    let mut was_in_contact = false;
    let mut bounds = vec![];
    for (index, level) in base.levels.iter().enumerate() {
        let lipschitz = beta.abs() + 3.0 * rho * slope_squared(base, &level.u);
        logarithm += length * lipschitz.powi(2) / (4.0 * zeta * BUCKLING.powi(2));
        let tip = level.u.last().copied().unwrap_or(f64::NAN);
        let touched = scene
            .obstacles
            .filter(|held| tip < held.g1 || tip > held.g2);
        if let (Some(held), false) = (touched, was_in_contact) {
            logarithm += 0.5 * (1.0 + 1.0 / (held.epsilon * BUCKLING)).ln();
        }
        was_in_contact = touched.is_some();
        if (index + 1).is_multiple_of(FINE) {
            bounds.push(logarithm.exp());
        }
    }
    bounds
}

/// Difference/δ at a time for each δ; empty if a run ended before.
fn ratios(base: &Traced, others: &[(&f64, &Traced)], sample: usize) -> Vec<f64> {
    let at = FINE * (sample + 1) - 1;
    let lengths: Vec<f64> = base.mesh.lengths().collect();
    let ratio = |(delta, other): &(&f64, &Traced)| {
        Some(distance(&lengths, base.levels.get(at)?, other.levels.get(at)?) / *delta)
    };
    let ratios: Option<_> = others.iter().map(ratio).collect();
    ratios.unwrap_or_default()
}

/// ‖u_x‖² of a function with these values at the nodes on which runs are compared.
fn slope_squared(traced: &Traced, values: &[f64]) -> f64 {
    let pairs = values.windows(2).zip(traced.mesh.lengths());
    pairs
        .map(|(pair, length)| (pair[1] - pair[0]).powi(2) / length)
        .sum()
}

/// The largest relative change of numbers against the last.
fn change(ratios: &[f64]) -> Option<f64> {
    let last = ratios.last()?;
    largest_of(ratios.iter().map(|ratio| (ratio / last - 1.0).abs()))
}
