//! Tables that several kinds of study share: exact solution, refinement, expected orders,
//! coefficients of a control, two discretisations of any order.

mod refine;

use convergence_study::{Term, internal::input::POSITIVE};
use thermobeam::{
    dg::{DgStepping, MAX_DEGREE, MAX_TIME_DEGREE},
    parameters::Beam,
};

use super::prelude::*;
use crate::{
    exact::{
        function::Factor,
        norm::Norm,
        solution::{Manufactured, Product},
    },
    expression::Variable,
    scene::{Coefficients, Method, Scene, limits, resampled, tables},
};

pub use refine::{Layout, Perturbation, Refine};
pub(crate) use refine::{MAP, REFINE, increasing, level_of_mesh, mean_width, nested, refine};

/// The sources hold second derivatives, in space and in time.
const DERIVATIVES: usize = 2;

/// The table `[exact]`.
pub(crate) const EXACT: Key = Key::new(
    "exact",
    Form::Table(&[&[&[
        Key::new("u", PRODUCTS, "displacement; each x(0) = 0").or("0"),
        Key::new("phi", PRODUCTS, "rotation; each x(0) = 0").or("0"),
        Key::new(
            "theta",
            PRODUCTS,
            "temperature; theta_a at x = 0, 0 at x = 1",
        )
        .or("0"),
    ]]]),
    "the exact solution: of each field a sum of products",
);
const PRODUCTS: Form = Form::List(&Form::Table(&[&[&[
    Key::new("x", Form::Text, "a function of x"),
    Key::new("t", Form::Text, "a function of t"),
]]]));

/// The table `[exact]`: for each field a sum of products of a function of x and a function of t.
pub(crate) fn manufactured(
    root: &Section<'_>,
    beam: &Beam,
    t_end: f64,
) -> Result<Manufactured, InputError> {
    let allowed = "a table with at least one of u, phi, theta";
    let section = root.require("exact", allowed)?.section()?;
    let exact = Manufactured {
        u: products(&section, "u", t_end)?,
        phi: products(&section, "phi", t_end)?,
        theta: products(&section, "theta", t_end)?,
    };
    if exact.u.is_empty() && exact.phi.is_empty() && exact.theta.is_empty() {
        return Err(root.refuse("exact", "an empty table", allowed));
    }
    for end in [[0.0, beam.theta_a], [1.0, 0.0]] {
        meets(&section, &exact.theta, end, t_end)?;
    }
    Ok(exact)
}

/// The products of a field, if any; u and φ vanish at x = 0.
fn products(section: &Section<'_>, key: &str, t_end: f64) -> Result<Vec<Product>, InputError> {
    let allowed = "a list of at least one { x = \"...\", t = \"...\" }";
    let product = |item: &Field<'_>| {
        let section = item.section()?;
        let factor = |key: &str, variable: Variable, end: f64| {
            let field =
                section.require(key, &format!("a function of {} in quotes", variable.name()))?;
            Ok::<Factor, InputError>(tables::function(&field, variable, end, DERIVATIVES)?.into())
        };
        let product = Product {
            x: factor("x", Variable::X, 1.0)?,
            t: factor("t", Variable::T, t_end)?,
        };
        let found = product.x.eval(0.0);
        if key != "theta" && found.abs() > product.x.roundoff(1.0) {
            return Err(section.refuse(
                "x",
                format!("{found:?} at x = 0"),
                "0 at x = 0, the clamped end",
            ));
        }
        Ok(product)
    };
    section.get(key).map_or(Ok(vec![]), |_| {
        section.list(key, allowed, product, |list| !list.is_empty())
    })
}

/// θ(x, t) = `expected` at an end of the beam, at some times, up to round-off.
fn meets(
    section: &Section<'_>,
    theta: &[Product],
    [x, expected]: [f64; 2],
    t_end: f64,
) -> Result<(), InputError> {
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
            return Err(section.refuse(
                "theta",
                found,
                format!("theta = {expected:?}: it must be {end} at all times"),
            ));
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

/// The keys of a claim, beside that of its quantity.
pub(crate) const CLAIM_KEYS: [Key; 3] = [
    Key::new(
        "order",
        Form::OneOf(&[Form::Positive, Form::Text]),
        "the order, or the least order as \">= 1\"",
    ),
    Key::new(
        "constant",
        Form::List(&Form::Positive),
        "the ends of the C of error = C h^order",
    )
    .or(""),
    Key::new(
        "tolerance",
        Form::Positive,
        "how far the rate may be from the order",
    )
    .or("0.25, at most half of the order, a quarter of a least one"),
];

/// The tables `[[expect]]` with norms.
pub(crate) const EXPECT: Key = Key::new(
    "expect",
    Form::List(&Form::Table(&[&[
        &[Key::new(
            "norm",
            Form::Choice(|| Norm::ALL.map(Norm::name).to_vec()),
            "the norm of the error",
        )],
        &CLAIM_KEYS,
    ]])),
    "the orders claimed, each norm once",
);

/// All tables `[[expect]]`: the norms and their orders.
pub(crate) fn expectations(root: &Section<'_>) -> Result<Vec<(Norm, Claim)>, InputError> {
    claims(root, "norm", &Norm::ALL.map(|norm| (norm.name(), norm)))
}

/// An order with its tolerance.
pub(crate) fn claim(section: &Section<'_>) -> Result<Claim, InputError> {
    let claim = read_claim(section, "order")?;
    let tolerance = match section.get("tolerance") {
        Some(field) => field.positive()?,
        None => claim.tolerance,
    };
    Ok(Claim { tolerance, ..claim })
}

/// All tables `[[expect]]`: of what which order, each once.
///
/// * `key`: the key of the quantity; `choices`: its allowed values.
pub(crate) fn claims<T: Copy>(
    root: &Section<'_>,
    key: &str,
    choices: &[(&'static str, T)],
) -> Result<Vec<(T, Claim)>, InputError> {
    let names = choices
        .iter()
        .map(|(name, _)| format!("\"{name}\""))
        .collect::<Vec<_>>()
        .join(", ");
    let mut known = vec![];
    root.tables(
        "expect",
        &format!(" with {key}, order and tolerance"),
        |section| {
            let field = section.require(key, &names)?;
            let (of, name) = (field.choice(choices)?, field.text()?);
            if known.contains(&name) {
                return Err(section.refuse(
                    key,
                    format!("\"{name}\" a second time"),
                    format!("each {key} once"),
                ));
            }
            known.push(name);
            Ok((of, claim(section)?))
        },
    )
}

/// The table `[control]`.
pub(crate) const CONTROL: Key = Key::new(
    "control",
    Form::Table(&[&[
        &convergence_keys::all_or(tables::BEAM_KEYS, "the value of the sources"),
        &convergence_keys::all_or(tables::OBSTACLE_KEYS, "the value of the sources"),
    ]]),
    "coefficients in which the solver differs from the sources: the study must fail",
)
.or("none");

/// The table `[control]`: coefficients in which the solver differs from `theory`; without the table
/// they are equal.
pub(crate) fn control(
    root: &Section<'_>,
    theory: Coefficients,
) -> Result<Coefficients, InputError> {
    let Some(section) = root.section("control")? else {
        return Ok(theory);
    };
    let names: Vec<&str> = Coefficients::names().collect();
    let mut solver = theory;
    for name in names {
        let Some(field) = section.get(name) else {
            continue;
        };
        let value = field.number()?;
        let Some(coefficient) = solver.get_mut(name) else {
            let found = format!("{} without a table [obstacles]", field.as_written());
            return Err(field.refuse(
                found,
                convergence_keys::names(&[&tables::BEAM_KEYS]).join(", "),
            ));
        };
        // A control that changes nothing would pass where it has to fail.
        if *coefficient == value {
            let found = format!("{}, which is the value of the sources", field.as_written());
            return Err(field.refuse(found, "another value"));
        }
        *coefficient = value;
    }
    if solver == theory {
        return Err(root.refuse(
            "control",
            "an empty table",
            "a table that changes at least one coefficient",
        ));
    }
    solver.check(&section)?;
    Ok(solver)
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

/// The keys of a discretisation.
pub(crate) const DISCRETISATION_KEYS: [Key; 6] = [
    Key::new("elements", Form::Count(1), "number of elements"),
    Key::new("degree", Form::Count(1), "degree p in space"),
    Key::new("time_degree", Form::Count(0), "degree q in time"),
    Key::new("dt", Form::Positive, "the largest step"),
    Key::new(
        "restart_dt",
        Form::Positive,
        "the first step, at the start and after each contact event",
    ),
    Key::new(
        "growth",
        Form::Number,
        "factor of the steps in between, at least 1",
    ),
];

/// Two tables with these keys.
pub(crate) const DISCRETISATIONS: Key = Key::new(
    "discretisations",
    Form::List(&Form::Table(&[&[&DISCRETISATION_KEYS]])),
    "the two discretisations by dG that are compared",
);

/// The cost of a solve per unknown, in steps of a one-step scheme.
const COST: f64 = 30.0;

/// Elements and steps of one discretisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Discretisation {
    /// Elements, distributed like those of the scene.
    pub elements: usize,
    /// Degree p.
    pub degree: usize,
    /// Degree q in time and the lengths of steps.
    pub stepping: DgStepping,
}

impl Discretisation {
    /// * `counts`: elements, degree p, degree q in time.
    /// * `steps`: the longest, the first after an event, and how fast they grow.
    pub(crate) fn new(
        [elements, degree, time_degree]: [usize; 3],
        [dt, restart_dt, growth]: [f64; 3],
    ) -> Self {
        Self {
            elements,
            degree,
            stepping: DgStepping {
                degree: time_degree,
                dt,
                restart_dt,
                growth,
                ..DgStepping::default()
            },
        }
    }

    /// Discretises a scene in this way.
    ///
    /// # Errors
    /// [`CaseFailure`] if the mesh has elements that are too small.
    pub fn of(&self, scene: &Scene, t_end: f64) -> Result<Scene, CaseFailure> {
        Ok(Scene {
            mesh: resampled(&scene.mesh, self.elements)?,
            degree: self.degree,
            method: Method::Dg(self.stepping),
            t_end,
            ..scene.clone()
        })
    }

    /// Its identification in words.
    pub fn label(&self) -> String {
        format!(
            "{} x p = {}, q = {}",
            self.elements, self.degree, self.stepping.degree
        )
    }

    /// Cost of a run to t_end, in element-steps of a one-step scheme.
    pub fn cost(&self, t_end: f64) -> f64 {
        COST * (self.elements * self.degree * (self.stepping.degree + 1)) as f64 * t_end
            / self.stepping.dt
    }

    /// Reads a table that has [`DISCRETISATION_KEYS`], and possibly others, for runs to `t_end`.
    pub(crate) fn read(section: &Section<'_>, t_end: f64) -> Result<Self, InputError> {
        let field = section.require("dt", POSITIVE)?;
        let dt = field.positive()?;
        limits::steps_until(&field, t_end, dt, limits::STEPS)?;
        let restart = format!("a number > 0 and at most dt = {dt:?}");
        let growth = "a finite number >= 1";
        let field = section.require("elements", "a whole number >= 1")?;
        let elements = tables::elements(&field)?;
        let degree = section.count("degree", 1..=MAX_DEGREE)?;
        let time_degree = section.count("time_degree", 0..=MAX_TIME_DEGREE)?;
        // Elements of different lengths need more memory.
        limits::any_order_memory(&field, elements, 1, degree, time_degree)?;
        Ok(Self {
            elements,
            degree,
            stepping: DgStepping {
                degree: time_degree,
                dt,
                restart_dt: section
                    .require("restart_dt", &restart)?
                    .number_where(&restart, |h| h > 0.0 && h <= dt)?,
                growth: section
                    .require("growth", growth)?
                    .number_where(growth, |value| value >= 1.0)?,
                ..DgStepping::default()
            },
        })
    }
}

/// A list of two tables.
///
/// * `elements`: for the semi-discrete system of a mesh, its number of linear elements, which both
///   must have; otherwise the two must differ in elements and degree.
/// * `t_end`: the final time of the runs.
pub(crate) fn discretisations(
    root: &Section<'_>,
    key: &str,
    elements: Option<usize>,
    t_end: f64,
) -> Result<[Discretisation; 2], InputError> {
    let differing = match elements {
        None => "that differ in elements, degree, time_degree and dt".to_owned(),
        Some(n) => format!(
            "of {n} elements of degree 1, those refined in time, that differ in time_degree and dt"
        ),
    };
    let allowed = format!("two tables [[{key}]] {differing}");
    let one = |item: &Field<'_>| {
        let section = item.section()?;
        Discretisation::read(&section, t_end)
    };
    let list = root.list(key, &allowed, one, |list| list.len() == 2)?;
    let (one, other) = (list[0], list[1]);
    let steps = [
        ("time_degree", one.stepping.degree == other.stepping.degree),
        ("dt", one.stepping.dt == other.stepping.dt),
    ];
    let space = [
        ("elements", one.elements == other.elements),
        ("degree", one.degree == other.degree),
    ];
    let same = if elements.is_some() {
        steps.to_vec()
    } else {
        [space, steps].concat()
    };
    if let Some((same, _)) = same.iter().find(|(_, is_same)| *is_same) {
        return Err(root.refuse(key, format!("two with the same {same}"), allowed));
    }
    match elements.and_then(|n| {
        [one, other]
            .into_iter()
            .find(|how| (how.elements, how.degree) != (n, 1))
    }) {
        Some(Discretisation {
            elements, degree, ..
        }) => Err(root.refuse(
            key,
            format!("{elements} elements of degree {degree}"),
            allowed,
        )),
        None => Ok([one, other]),
    }
}
