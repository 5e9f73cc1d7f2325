//! The initial data of a scene against the functions that they project: (3.4), (3.5) and (3.6).
//!
//! A run starts from values at the nodes. In one dimension these are the projections P_h* and P_h0
//! of the paper; here that is checked by their definition, together with the orders and the bounds
//! of their errors: THEORY.md, "The projection". On a uniform mesh, and on the graded one of the
//! study `graded-mesh`.

use super::prelude::*;
use crate::kinds::tables::level_of_mesh;
use crate::run::simulate;
use crate::scene::Scene;
use convergence_study::{Claim, ErrorColumn, Levels, RefinedIn, Subject};
use thermobeam_exact::projection::{Projected, Target};

/// What the studies say about themselves.
pub const ABOUT: About = About {
    id: "projection",
    claim: "(3.4), (3.5): initial data (3.6) are projections: order 2, slopes 1; in H^1 alone 5/4, slopes 1/4",
    tier: Tier::Quick,
    group: "space",
    home: file!(),
};
/// On a graded mesh.
pub const GRADED: About = About {
    id: "projection-graded",
    claim: "(3.4), (3.5) on a graded mesh, neighbours in ratio up to 1.2",
    ..ABOUT
};

/// u, u_t and θ are those of (5.3) and (5.5). x^0.75 is in H¹ and not in H²: order s + 1/2 = 5/4 in
/// values, 1/4 in slopes.
const INITIAL: &str = "beam = { theta_a = 20.0 }
initial = { u = \"0.01*x*(x-2)\", u_t = \"20*x*(x-1)^2\", phi = \"0.4*x*exp(-x)\", phi_t = \"x^0.75\", theta = \"20*cos(5*pi*x/2)\" }
time = { dt = 0.1, t_end = 0.1 }
";
const MESHES: [usize; 6] = [16, 32, 64, 128, 256, 512];
/// Tolerance of the orders.
const TOLERANCE: f64 = 0.005;
/// Allowed size of `|((P_h η - η)_x, N_i')|`, relative to ‖η_x‖: the quadrature on the first of 16
/// elements leaves 1e-9.
const ORTHOGONAL: f64 = 1e-8;
/// Allowed distance of measured from predicted leading terms, on the finest mesh, relative.
const LEADING: f64 = 1e-3;

/// One of the initial data.
struct Datum {
    name: &'static str,
    /// The name of its slope.
    slope: &'static str,
    /// The space of (3.3) onto which it is projected.
    target: Target,
    /// Order of its values; that of its slope is one less.
    order: f64,
}

impl Datum {
    const fn new(name: &'static str, slope: &'static str, target: Target, order: f64) -> Self {
        Self {
            name,
            slope,
            target,
            order,
        }
    }

    /// Whether it is in H², so that (3.5) applies.
    fn is_smooth(&self) -> bool {
        self.order == 2.0
    }
}

const DATA: [Datum; 5] = [
    Datum::new("u", "u_x", Target::Clamped, 2.0),
    Datum::new("u_t", "u_tx", Target::Clamped, 2.0),
    Datum::new("phi", "phi_x", Target::Clamped, 2.0),
    Datum::new("phi_t", "phi_tx", Target::Clamped, 1.25),
    Datum::new("theta", "theta_x", Target::Closed, 2.0),
];

/// Projections of the initial data onto meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Projection {
    /// The nodes x(s).
    map: &'static str,
}

/// The study on uniform meshes.
pub fn study() -> Described<Projection> {
    ABOUT.study(Projection { map: "s" })
}

/// The study on graded meshes.
pub fn graded() -> Described<Projection> {
    let map = "s + 0.15*sin(2*pi*s)";
    GRADED.study(Projection { map })
}

impl Kind for Projection {
    /// Number of elements.
    type Data = usize;
    /// One for each of the data.
    type Found = Vec<Projected>;

    fn cases(&self) -> Vec<Case<usize>> {
        let is_uniform = self.map == "s";
        let parts = Parts::new(&thermobeam::parameters::Beam::default(), None).on(is_uniform);
        let cases = MESHES.map(|n| {
            // Quadrature takes some 20 evaluations of a function on an element.
            let cost = (20 * n * DATA.len()) as f64;
            Case::new(format!("n = {n}"), cost, n).described(&parts)
        });
        cases.to_vec()
    }

    fn run(&self, n: &usize) -> Result<Vec<Projected>, CaseFailure> {
        let mesh = format!("mesh = {{ elements = {n}, map = \"{}\" }}\n", self.map);
        let Scene {
            initial,
            mesh,
            beam,
            ..
        } = Scene::parse(&format!("{INITIAL}{mesh}"), "projection")?;
        let values = simulate::initial(&initial, beam.theta_a, &mesh);
        let nodal = [
            &values.u,
            &values.u_t,
            &values.phi,
            &values.phi_t,
            &values.theta,
        ];
        let functions = [
            &initial.u,
            &initial.u_t,
            &initial.phi,
            &initial.phi_t,
            &initial.theta,
        ];
        let mut found = vec![];
        for ((datum, function), nodal) in DATA.iter().zip(functions).zip(nodal) {
            let function = function.as_ref();
            let function = function.ok_or_else(|| CaseFailure::new("a function is missing"))?;
            found.push(Projected::measure(function, &mesh, nodal, datum.target));
        }
        Ok(found)
    }

    fn judge(&self, ran: &[Ran<usize, Vec<Projected>>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| {
            let levels = levels(shown);
            let rates = levels.judge();
            let caption = "Errors of the projected initial data over the mesh width: values, and slopes (with x).";
            let title = Some("Projections".to_owned());
            let figure = levels.figure("errors", title, caption.to_owned(), &rates);
            let mut found = vec![];
            for (place, datum) in DATA.iter().enumerate() {
                let projected = shown.iter().filter_map(|(_, all)| all.get(place).copied());
                found.extend(of_datum(datum, &projected.collect::<Vec<_>>()));
            }
            let title =
                "Projections: bounds with the best constants, leading terms known before the run";
            let sheet = Sheet::new(title, "function", found);
            Outcome {
                figures: vec![figure],
                ..Outcome::of_sheets([sheet], "")
            }
            .with_orders(&levels, rates)
        })
    }
}

/// An error of a projection.
type ErrorOf = fn(&Projected) -> f64;

/// The errors of values and slopes.
fn levels(shown: &[(&usize, &Vec<Projected>)]) -> Levels {
    let refinements = shown
        .iter()
        .map(|(n, _)| level_of_mesh(format!("n = {n}"), **n));
    let mut columns = vec![];
    for (place, datum) in DATA.iter().enumerate() {
        let value: ErrorOf = |projected| projected.value;
        let slope: ErrorOf = |projected| projected.slope;
        for (name, order, error) in [
            (datum.name, datum.order, value),
            (datum.slope, datum.order - 1.0, slope),
        ] {
            let errors = shown.iter().map(|(_, all)| all.get(place).map(error));
            columns.push(ErrorColumn {
                style: columns.len(),
                subject: Subject::of(name),
                ..ErrorColumn::new(name, Claim::new(order, TOLERANCE), errors)
            });
        }
    }
    Levels::new(RefinedIn::Space, refinements, columns)
}

/// The definition `((P_h η - η)_x, χ_x) = 0`, (3.4) on each mesh, and, for a function in H², (3.5)
/// and the leading terms on the finest mesh, which are known from η_xx.
fn of_datum(datum: &Datum, levels: &[Projected]) -> Vec<Measured> {
    let largest = |number: fn(&Projected) -> f64| largest_of(levels.iter().map(number));
    let one = |name: &str, value: Option<f64>| measured(datum.name, name, value);
    let residual = largest(|level| level.residual / level.function_slope);
    let mut found = vec![
        one("in", None).words(if datum.is_smooth() { "H²" } else { "H¹" }),
        one("largest residual of the definition, of ‖η_x‖", residual)
            .scientific(0)
            .must_be(Must::AtMost(ORTHOGONAL)),
        one(
            "of the bound (3.4)",
            largest(Projected::share_of_value_bound),
        )
        .fixed(4)
        .must_be(Must::AtMost(1.0)),
    ];
    if datum.is_smooth() {
        let predicted = Must::Near {
            answer: 1.0,
            within: LEADING,
        };
        let finest = levels.last();
        let value = finest.map(|level| level.value / level.leading_value);
        let slope = finest.map(|level| level.slope / level.leading_slope);
        found.extend([
            one(
                "of the bound (3.5)",
                largest(Projected::share_of_smooth_bound),
            )
            .fixed(4)
            .must_be(Must::AtMost(1.0)),
            one("value, measured/predicted", value)
                .fixed(6)
                .must_be(predicted),
            one("slope, measured/predicted", slope)
                .fixed(6)
                .must_be(predicted),
        ]);
    }
    found
}
