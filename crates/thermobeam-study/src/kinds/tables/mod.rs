//! Tables that several kinds of study share: exact solution, refinement, expected orders,
//! coefficients of a control, two discretisations of any order.

mod discretisation;
mod refine;

use convergence_study::{
    Order, Term,
    file::{Choices, Finite, Number, Range},
};
use serde::Serialize;
use thermobeam::parameters::Beam;

use super::prelude::*;
use crate::{
    exact::{
        norm::Norm,
        solution::{Manufactured, Product},
    },
    scene::{
        Coefficients, Method, Scene,
        file::{Formula, OfT, OfX},
        tables::given,
    },
};

pub use discretisation::Discretisation;
pub(crate) use discretisation::{DiscretisationTable, two_discretisations};
pub use refine::{Layout, Perturbation, Refine};
pub(crate) use refine::{RefineTable, level_of_mesh, mean_width};

/// The sources hold second derivatives, in space and in time.
const DERIVATIVES: usize = 2;

/// The table `[exact]`: of each field a sum of products.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExactTable {
    /// displacement; each x(0) = 0
    u: Option<Vec<ProductTable>>,
    /// rotation; each x(0) = 0
    phi: Option<Vec<ProductTable>>,
    /// temperature; theta_a at x = 0, 0 at x = 1
    theta: Option<Vec<ProductTable>>,
}

/// A product of an exact solution.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ProductTable {
    /// a function of x
    x: Formula<OfX>,
    /// a function of t
    t: Formula<OfT>,
}

impl ExactTable {
    /// The exact solution, which meets the boundary conditions until `t_end`.
    pub(crate) fn manufactured(&self, beam: &Beam, t_end: f64) -> Result<Manufactured, Refusal> {
        let exact = Manufactured {
            u: products("u", &self.u, t_end)?,
            phi: products("phi", &self.phi, t_end)?,
            theta: products("theta", &self.theta, t_end)?,
        };
        if exact.u.is_empty() && exact.phi.is_empty() && exact.theta.is_empty() {
            return Err(Refusal::written(
                "",
                "a table with at least one of u, phi, theta",
            ));
        }
        for end in [[0.0, beam.theta_a], [1.0, 0.0]] {
            meets(&exact.theta, end, t_end)?;
        }
        Ok(exact)
    }
}

/// The products of a field, if any; u and φ vanish at x = 0.
fn products(
    field: &str,
    tables: &Option<Vec<ProductTable>>,
    t_end: f64,
) -> Result<Vec<Product>, Refusal> {
    if tables.as_ref().is_some_and(Vec::is_empty) {
        let allowed = "a list of at least one { x = \"...\", t = \"...\" }";
        return Err(Refusal::written(field, allowed));
    }
    let mut products = vec![];
    for (place, table) in tables.iter().flatten().enumerate() {
        let path = |name: &str| format!("{field}[{place}].{name}");
        let product = Product {
            x: table.x.parse(&path("x"), 1.0, DERIVATIVES)?.into(),
            t: table.t.parse(&path("t"), t_end, DERIVATIVES)?.into(),
        };
        let found = product.x.eval(0.0);
        if field != "theta" && found.abs() > product.x.roundoff(1.0) {
            let found = format!("{found:?} at x = 0");
            return Err(Refusal::new(
                path("x"),
                found,
                "0 at x = 0, the clamped end",
            ));
        }
        products.push(product);
    }
    Ok(products)
}

/// θ(x, t) = `expected` at an end of the beam, at some times, up to round-off.
fn meets(theta: &[Product], [x, expected]: [f64; 2], t_end: f64) -> Result<(), Refusal> {
    // Unlikely to be a multiple of the period of a study.
    const TIMES: u32 = 7;
    // The error of X is proportional to X and amplified by T, and vice versa.
    let slack: f64 = theta
        .iter()
        .map(|p| 2.0 * p.x.roundoff(1.0) * p.t.size(t_end))
        .sum();
    for time in (0..=TIMES).map(|i| t_end * f64::from(i) / f64::from(TIMES)) {
        // An empty `sum` is -0, which would be shown.
        let found = theta
            .iter()
            .fold(0.0, |sum, p| sum + p.x.eval(x) * p.t.eval(time));
        if (found - expected).abs() > slack {
            let found = format!("theta = {found:?} at x = {x}, t = {time:?}");
            let end = if x == 0.0 {
                "beam.theta_a at x = 0"
            } else {
                "0 at x = 1"
            };
            let allowed = format!("theta = {expected:?}: it must be {end} at all times");
            return Err(Refusal::new("theta", found, allowed));
        }
    }
    Ok(())
}

/// The norms in the notation of the paper and in words, for the reference page, in the order of
/// [`Norm::ALL`].
pub const TERMS: [Term; Norm::ALL.len()] = [
    term(
        Norm::Velocity,
        "‖ûₕ−uₜ‖, the L2 norm of the error of the velocity u_t",
    ),
    term(
        Norm::Shear,
        "‖uₕₓ−φₕ−(uₓ−φ)‖, the L2 norm of the error of the shear u_x - phi: a derivative, so first order in h at best",
    ),
    term(
        Norm::RotationRate,
        "‖φ\u{302}ₕ−φₜ‖, the L2 norm of the error of the rate of rotation phi_t",
    ),
    term(
        Norm::Curvature,
        "‖φₕₓ−φₓ‖, the L2 norm of the error of phi_x: a derivative, so first order in h at best",
    ),
    term(
        Norm::Temperature,
        "‖θₕ−θ‖, the L2 norm of the error of the temperature",
    ),
    term(
        Norm::Theorem34,
        "The norm of (3.14), the left-hand side of Theorem 3.4: the root of the sum of the squares of velocity, shear, \
         rotation-rate, curvature and temperature at the same time, bounded there by c (h + dt)",
    ),
    term(
        Norm::Displacement,
        "‖uₕ−u‖, the L2 norm of the error of the displacement u",
    ),
    term(
        Norm::Superclose,
        "√Zₙ of (3.16): as theorem-3.4, but of the distance to the interpolant of the exact solution. The first order of \
         Theorem 3.4 is that of interpolation alone; to the interpolant the scheme is of order h^2 + dt. The sharpest guard: \
         it sees defects which the interpolation error hides",
    ),
];

const fn term(norm: Norm, text: &'static str) -> Term {
    Term {
        name: norm.name(),
        what: "a norm; its maximum over all time levels counts",
        text,
    }
}

/// A table `[[expect]]`: the order claimed of a norm.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExpectNorm {
    /// the norm of the error
    norm: OneOf<NormNames>,
    /// the order, or the least order
    order: Order,
    /// the ends of the C of error = C h^order
    #[schemars(extend("title" = "two numbers > 0, the smaller first"))]
    constant: Option<[Positive; 2]>,
    /// how far the rate may be from the order; without it 0.25, at most half of the order, a
    /// quarter of a least one
    tolerance: Option<Positive>,
}

/// A share that may be off: of one or more, nothing could be.
pub(crate) type Share = Number<AboveZeroBelowOne>;

/// The range of the numbers between 0 and 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum AboveZeroBelowOne {}

impl Range for AboveZeroBelowOne {
    const ENDS: &'static [(&'static str, f64)] =
        &[("exclusiveMinimum", 0.0), ("exclusiveMaximum", 1.0)];
}

/// The norms.
#[derive(Debug)]
pub(crate) enum NormNames {}

impl Choices for NormNames {
    type Value = Norm;

    fn all() -> Vec<(&'static str, Norm)> {
        Norm::ALL.map(|norm| (norm.name(), norm)).to_vec()
    }
}

/// The norms of tables `[[expect]]` and their orders.
pub(crate) fn expected_norms(tables: &[ExpectNorm]) -> Result<Vec<(Norm, Claim)>, Refusal> {
    claimed_once("norm", tables, |table| {
        let claim = table.order.claim(table.constant, table.tolerance);
        (table.norm.name, table.norm.value, claim)
    })
}

/// What tables `[[expect]]` claim, each quantity once.
///
/// * `key`: the key of the quantity; `claim`: its name, the quantity and what is claimed of it.
pub(crate) fn claimed_once<T, Q>(
    key: &str,
    tables: &[T],
    claim: impl Fn(&T) -> (&'static str, Q, Result<Claim, Refusal>),
) -> Result<Vec<(Q, Claim)>, Refusal> {
    let mut known = vec![];
    let mut claims = vec![];
    for (place, table) in tables.iter().enumerate() {
        let path = format!("expect[{place}]");
        let (name, quantity, claim) = claim(table);
        if known.contains(&name) {
            let found = format!("\"{name}\" a second time");
            return Err(Refusal::new(
                format!("{path}.{key}"),
                found,
                format!("each {key} once"),
            ));
        }
        known.push(name);
        claims.push((quantity, claim.map_err(Refusal::within(&path))?));
    }
    if claims.is_empty() {
        let allowed = format!("at least one table [[expect]] with {key}, order and tolerance");
        return Err(Refusal::written("expect", allowed));
    }
    Ok(claims)
}

/// The table `[control]`.
#[derive(Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ControlTable {
    /// the viscosity ζ
    zeta: Option<Finite>,
    /// the thermal coupling a
    a: Option<Finite>,
    /// the factor ρ of ‖u_x‖² in the axial force
    rho: Option<Finite>,
    /// the axial force β of the straight beam
    beta: Option<Finite>,
    /// the temperature θ_A at x = 0
    theta_a: Option<Finite>,
    /// the normal compliance ε
    epsilon: Option<Finite>,
    /// the lower obstacle
    g1: Option<Finite>,
    /// the upper obstacle
    g2: Option<Finite>,
}

/// The coefficients of a solver that differs from `theory` by the table `[control]`; without the
/// table they are equal.
pub(crate) fn controlled(
    table: Option<&ControlTable>,
    theory: Coefficients,
) -> Result<Coefficients, Refusal> {
    let Some(table) = table else {
        return Ok(theory);
    };
    let mut solver = theory;
    for (name, value) in given(table) {
        let path = format!("control.{name}");
        let Some(coefficient) = solver.get_mut(&name) else {
            let names = Coefficients::OF_BEAM.join(", ");
            return Err(Refusal::written_and(
                path,
                " without a table [obstacles]",
                names,
            ));
        };
        // A control that changes nothing would pass where it has to fail.
        if *coefficient == value {
            let more = ", which is the value of the sources";
            return Err(Refusal::written_and(path, more, "another value"));
        }
        *coefficient = value;
    }
    if solver == theory {
        let allowed = "a table that changes at least one coefficient";
        return Err(Refusal::written("control", allowed));
    }
    solver.checked(["control", "control"])?;
    Ok(solver)
}

/// What a study claims whose solver differs from its theory: its other claims fail. It never
/// passes, and says why; without a difference it claims nothing.
///
/// * `verdict`: on all other claims.
pub(crate) fn control(
    [mut theory, mut solver]: [Coefficients; 2],
    verdict: Verdict,
) -> Option<Measured> {
    let mut differences = vec![];
    for name in Coefficients::names() {
        if let (Some(theirs), Some(own)) = (theory.get_mut(name), solver.get_mut(name))
            && theirs != own
        {
            differences.push(format!("{name} = {own:?} in place of {theirs:?}"));
        }
    }
    let has_failed = verdict == Verdict::Fail;
    let words = if has_failed {
        "other claims fail, as they must"
    } else {
        "the control passes: no other claim fails"
    };
    let claim = format!(
        "a control: the solver has {}, and the study must fail",
        differences.join(", ")
    );
    (!differences.is_empty()).then(|| {
        measured("", "controls that pass", f64::from(!has_failed))
            .words(words)
            .must_be(Must::Count(0))
            .stated(claim)
    })
}

/// The cost of a run of a scene, in element-steps of a one-step scheme, which takes for a step as
/// long as for four elements.
pub fn cost_of_run(scene: &Scene) -> f64 {
    match scene.method {
        Method::OneStep(_) => scene.steps() as f64 * (scene.mesh.elements() as f64 + 4.0),
        Method::Dg(stepping) => Discretisation {
            elements: scene.mesh.elements(),
            degree: scene.degree,
            stepping,
        }
        .cost(scene.t_end),
    }
}
