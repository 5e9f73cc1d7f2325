//! The initial data of a scene against the functions that they project: (3.4), (3.5) and (3.6).
//!
//! A run starts from values at the nodes. In one dimension these are the projections P_h* and P_h0
//! of the paper; here that is checked by their definition, together with the orders and the bounds
//! of their errors: THEORY.md, "The projection".
//!
//! ```toml
//! [beam]                # optional: theta_a, the value of theta at x = 0
//! [initial]             # as in a scene
//! u = "0.01*x*(x-2)"
//! u_t = "x^0.75"        # in H¹, not in H²
//!
//! [projection]
//! elements = [8, 16, 32, 64]
//! map = "s"             # optional
//! rough = ["u_t"]       # functions that are not in H²: (3.5) does not apply
//!
//! [[expect]]
//! error = "u_x"         # of the slope of u; "u" of its value
//! order = 1.0
//! tolerance = 0.005
//! ```

use thermobeam_exact::projection::{Projected, SMOOTH_BOUND, Target, VALUE_BOUND};

use super::{ErrorSource, Orders, Runs, Series, SourceResult};
use crate::kinds::prelude::*;
use crate::{
    expression::Expression,
    kinds::{
        settings::{ActiveTerms, Exercise, INITIAL_DATA, Integration, ItemMethod},
        tables::{CLAIM_KEYS, Layout, MAP, claims, increasing, level_of_mesh},
    },
    run::simulate,
    scene::{Coefficients, INITIAL, Initial, tables},
};
use convergence_study::internal::study::over_levels::{ErrorColumn, Levels};
use thermobeam::{one_step::InitialValues, parameters::Beam};

/// Allowed size of `|((P_h η - η)_x, N_i')|`, relative to ‖η_x‖: the quadrature on the first of 16
/// elements leaves 1e-9.
const ORTHOGONAL: f64 = 1e-8;

/// Allowed distance of measured from predicted leading terms, on the finest mesh, relative.
const LEADING: f64 = 1e-3;

/// One of the initial data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum InitialDatum {
    U,
    Velocity,
    Phi,
    RotationRate,
    Theta,
}

impl InitialDatum {
    const ALL: [InitialDatum; 5] = [
        InitialDatum::U,
        InitialDatum::Velocity,
        InitialDatum::Phi,
        InitialDatum::RotationRate,
        InitialDatum::Theta,
    ];

    /// Its key in a scene.
    const fn name(self) -> &'static str {
        match self {
            InitialDatum::U => "u",
            InitialDatum::Velocity => "u_t",
            InitialDatum::Phi => "phi",
            InitialDatum::RotationRate => "phi_t",
            InitialDatum::Theta => "theta",
        }
    }

    /// The space of (3.3) onto which it is projected.
    const fn target(self) -> Target {
        match self {
            InitialDatum::Theta => Target::Closed,
            _ => Target::Clamped,
        }
    }

    fn function(self, initial: &Initial) -> Option<&Expression> {
        match self {
            InitialDatum::U => initial.u.as_ref(),
            InitialDatum::Velocity => initial.u_t.as_ref(),
            InitialDatum::Phi => initial.phi.as_ref(),
            InitialDatum::RotationRate => initial.phi_t.as_ref(),
            InitialDatum::Theta => initial.theta.as_ref(),
        }
    }

    /// The values from which a run starts.
    fn values(self, values: &InitialValues) -> &[f64] {
        match self {
            InitialDatum::U => &values.u,
            InitialDatum::Velocity => &values.u_t,
            InitialDatum::Phi => &values.phi,
            InitialDatum::RotationRate => &values.phi_t,
            InitialDatum::Theta => &values.theta,
        }
    }
}

/// The error of a projection: of its values, or of its slope.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ProjectionError {
    datum: InitialDatum,
    is_slope: bool,
}

impl ProjectionError {
    const ALL: [(&'static str, ProjectionError); 10] = [
        Self::row("u", InitialDatum::U, false),
        Self::row("u_x", InitialDatum::U, true),
        Self::row("u_t", InitialDatum::Velocity, false),
        Self::row("u_tx", InitialDatum::Velocity, true),
        Self::row("phi", InitialDatum::Phi, false),
        Self::row("phi_x", InitialDatum::Phi, true),
        Self::row("phi_t", InitialDatum::RotationRate, false),
        Self::row("phi_tx", InitialDatum::RotationRate, true),
        Self::row("theta", InitialDatum::Theta, false),
        Self::row("theta_x", InitialDatum::Theta, true),
    ];

    const fn row(name: &'static str, datum: InitialDatum, is_slope: bool) -> (&'static str, Self) {
        (name, Self { datum, is_slope })
    }

    fn name(self) -> &'static str {
        let row = Self::ALL.iter().find(|(_, error)| *error == self);
        row.map_or("", |(name, _)| name)
    }

    fn of(self, projected: &Projected) -> f64 {
        if self.is_slope {
            projected.slope
        } else {
            projected.value
        }
    }
}

/// A study of projections.
#[derive(Debug, Clone, PartialEq)]
pub struct Projection {
    beam: Beam,
    initial: Initial,
    /// The data that are given.
    data: Vec<InitialDatum>,
    /// Those that are not in H².
    rough: Vec<InitialDatum>,
    elements: Vec<usize>,
    layout: Layout,
    expect: Vec<(ProjectionError, Claim)>,
}

const KEYS: [Key; 3] = [
    Key::new(
        "elements",
        Form::List(&Form::Count(1)),
        "numbers of elements, increasing",
    ),
    MAP,
    Key::new(
        "rough",
        Form::List(&Form::Choice(|| {
            InitialDatum::ALL.map(InitialDatum::name).to_vec()
        })),
        "functions of [initial] that are not in H^2, to which (3.5) does not apply",
    )
    .or("none"),
];

const EXPECT: Key = Key::new(
    "expect",
    Form::List(&Form::Table(&[&[
        &[Key::new(
            "error",
            Form::Choice(|| ProjectionError::ALL.map(|(name, _)| name).to_vec()),
            "the function of [initial] whose error is judged; with x that of its slope",
        )],
        &CLAIM_KEYS,
    ]])),
    "the orders claimed, each error once",
);

impl ErrorSource for Projection {
    const ROW: KindRow = KindRow {
        name: "orders/projection",
        keys: &[&[&[
            tables::BEAM,
            INITIAL,
            Key::new(
                "projection",
                Form::Table(&[&[&KEYS]]),
                "the meshes, and which functions are rough",
            ),
            EXPECT,
        ]]],
        read: read_study::<Orders<Self>>,
        why: "A run starts from values at the nodes. In one dimension they are the projections (3.6) of the initial data, whose errors \
              (3.4) and (3.5) bound on every mesh.",
        judged: "The orthogonality that defines the projection; the rate of each claimed error; its bound with the best constant, and \
                 the leading term, known before the run.",
        failure: "The initial data of a scene are not its projections on this mesh.",
    };

    /// Number of elements.
    type Data = usize;
    /// One for each datum that is given.
    type Found = Vec<Projected>;

    fn read(root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        let beam = Coefficients::read(root)?.beam;
        let section = root.table("projection", &[&KEYS])?;
        let allowed = "a list of increasing whole numbers >= 1";
        let elements = increasing(&section, "elements", allowed, 1, tables::elements)?;
        let layout = Layout::read(&section, &elements, None)?;
        let mut initial = Initial::default();
        for &elements in &elements {
            let mesh = layout.mesh(elements);
            let mesh = mesh.map_err(|error| {
                section.refuse(
                    "elements",
                    error.to_string(),
                    "meshes with increasing nodes",
                )
            })?;
            // Each mesh has nodes of its own, at which the functions must be finite.
            initial = Initial::read(root, &beam, &mesh)?;
        }
        let is_given = |datum: &InitialDatum| datum.function(&initial).is_some();
        let data: Vec<InitialDatum> = InitialDatum::ALL.into_iter().filter(is_given).collect();
        let rough = rough(&section, &data)?;
        let expect = claims(root, "error", &ProjectionError::ALL)?;
        for (error, _) in &expect {
            if !data.contains(&error.datum) {
                let found = format!(
                    "\"{}\" without initial.{}",
                    error.name(),
                    error.datum.name()
                );
                return Err(root.refuse("expect", found, "errors of functions in [initial]"));
            }
        }
        Ok(Self {
            beam,
            data,
            rough,
            initial,
            elements,
            layout,
            expect,
        })
    }

    fn exercise(&self) -> Exercise {
        let terms = ActiveTerms::of(&self.beam, None);
        Exercise::new(INITIAL_DATA, Integration::Exact, terms).on(self.layout.nodes())
    }

    fn cases(&self) -> Vec<Case<usize>> {
        let mut cases = vec![];
        for &n in &self.elements {
            // Quadrature takes some 20 evaluations of a function on an element.
            let cost = (20 * n * self.data.len()) as f64;
            cases.push(Case::new(format!("n = {n}"), cost, n));
        }
        cases
    }

    fn run(&self, &elements: &usize) -> Result<Vec<Projected>, CaseFailure> {
        let mesh = self.layout.mesh(elements)?;
        let values = simulate::initial(&self.initial, self.beam.theta_a, &mesh);
        let mut found = vec![];
        for datum in &self.data {
            if let Some(function) = datum.function(&self.initial) {
                let nodal = datum.values(&values);
                found.push(Projected::measure(function, &mesh, nodal, datum.target()));
            }
        }
        Ok(found)
    }

    fn not_finite(&self, found: &Vec<Projected>) -> Vec<String> {
        let mut names = vec![];
        for (datum, projected) in self.data.iter().zip(found) {
            let Projected { value, slope, .. } = projected;
            if !(value.is_finite() && slope.is_finite()) {
                names.push(datum.name().to_owned());
            }
        }
        if found.len() != self.data.len() {
            names.push("a missing function".to_owned());
        }
        names
    }

    fn measured(&self, runs: &Runs<Self>) -> SourceResult {
        let mut checks = vec![];
        let mut rows = vec![];
        for (index, &datum) in self.data.iter().enumerate() {
            let of_datum: Vec<Projected> = runs
                .iter()
                .filter_map(|run| run.ok()?.get(index).copied())
                .collect();
            let is_smooth = !self.rough.contains(&datum);
            checks.push(orthogonal(datum, &of_datum));
            checks.push(bounded(datum, is_smooth, &of_datum));
            if is_smooth {
                checks.push(leading(datum, of_datum.last()));
            }
            rows.push(row(datum, is_smooth, &of_datum));
        }
        let caption = "Errors of the projected initial data over the mesh width: values, and slopes (with x).";
        let series = Series::new(self.levels(runs)).drawn("errors", Some("Projections"), caption);
        SourceResult {
            checks,
            tables: vec![Table::new(
                "Projections: bounds with the best constants, leading terms known before the run",
                [
                    "function",
                    "in",
                    "largest residual of the definition, of ‖η_x‖",
                    "of the bound (3.4)",
                    "of the bound (3.5)",
                    "value, measured/predicted",
                    "slope, measured/predicted",
                ],
                rows,
            )],
            series: vec![series],
            ..SourceResult::default()
        }
    }
}

impl Projection {
    fn levels(&self, runs: &Runs<Self>) -> Levels {
        let cases = runs.iter().map(|run| &run.case);
        let refinements = cases.map(|case| level_of_mesh(&case.label, case.data));
        let mut columns = vec![];
        for (look, (error, claim)) in self.expect.iter().enumerate() {
            let place = self.data.iter().position(|datum| *datum == error.datum);
            let errors = runs
                .iter()
                .map(|run| Some(error.of(run.ok()?.get(place?)?)));
            columns.push(ErrorColumn {
                look,
                ..ErrorColumn::new(error.name(), *claim, errors)
            });
        }
        Levels::new(Axis::Space, refinements, columns)
    }
}

/// The key `rough`.
fn rough(section: &Section<'_>, data: &[InitialDatum]) -> Result<Vec<InitialDatum>, InputError> {
    if section.get("rough").is_none() {
        return Ok(vec![]);
    }
    let names: Vec<&str> = data.iter().map(|datum| datum.name()).collect();
    let choices: Vec<(&str, InitialDatum)> =
        data.iter().map(|datum| (datum.name(), *datum)).collect();
    section.list(
        "rough",
        &format!("a list of functions of [initial]: {}", names.join(", ")),
        |item| item.choice(&choices),
        |_| true,
    )
}

/// `((P_h η - η)_x, χ_x) = 0`, which defines the projection.
fn orthogonal(datum: InitialDatum, levels: &[Projected]) -> Check {
    let largest = largest_residual(levels).unwrap_or(f64::NAN);
    Check::that(
        largest <= ORTHOGONAL,
        format!(
            "{} starts from its projection: ((P_h η - η)_x, χ_x) = 0 for all hat functions, within {ORTHOGONAL:e} of ‖η_x‖",
            datum.name()
        ),
        format!("largest residual {largest:.1e} of ‖η_x‖"),
    )
    .about(subject(datum))
}

fn largest_residual(levels: &[Projected]) -> Option<f64> {
    largest_of(
        levels
            .iter()
            .map(|level| level.residual / level.function_slope),
    )
}

/// (3.4) on each mesh, and (3.5) for a function in H².
fn bounded(datum: InitialDatum, is_smooth: bool, levels: &[Projected]) -> Check {
    let value = largest_of(levels.iter().map(Projected::share_of_value_bound)).unwrap_or(f64::NAN);
    let smooth = largest_of(levels.iter().map(Projected::share_of_smooth_bound));
    let smooth = smooth.unwrap_or(f64::NAN);
    let name = datum.name();
    let (claim, evidence) = if is_smooth {
        (
            format!(
                "{name} is within (3.4) with c = {VALUE_BOUND:.4}, and (3.5) with c = {SMOOTH_BOUND:.4}"
            ),
            format!("largest shares of the bounds {value:.4}, {smooth:.4}"),
        )
    } else {
        (
            format!("{name}, which is not in H^2, is within (3.4) with c = {VALUE_BOUND:.4}"),
            format!("largest share of the bound {value:.4}"),
        )
    };
    Check::that(
        value <= 1.0 && (!is_smooth || smooth <= 1.0),
        claim,
        evidence,
    )
    .about(subject(datum))
}

/// The errors on the finest mesh are those of their leading terms.
fn leading(datum: InitialDatum, finest: Option<&Projected>) -> Check {
    let Ratios { value, slope } = Ratios::of(finest);
    Check::that(
        (value - 1.0).abs() <= LEADING && (slope - 1.0).abs() <= LEADING,
        format!(
            "{}: the errors on the finest mesh are those predicted from η_xx, within {LEADING:e}",
            datum.name()
        ),
        format!("measured over predicted: value {value:.6}, slope {slope:.6}"),
    )
    .about(subject(datum))
}

/// Measured over predicted errors.
struct Ratios {
    value: f64,
    slope: f64,
}

impl Ratios {
    fn of(level: Option<&Projected>) -> Self {
        level.map_or(
            Self {
                value: f64::NAN,
                slope: f64::NAN,
            },
            |level| Self {
                value: level.value / level.leading_value,
                slope: level.slope / level.leading_slope,
            },
        )
    }
}

fn subject(datum: InitialDatum) -> Subject {
    Subject::of(datum.name()).by(ItemMethod::Exact)
}

/// A row of the table.
fn row(datum: InitialDatum, is_smooth: bool, levels: &[Projected]) -> Vec<String> {
    let shown = |number: Option<f64>, digits: usize| {
        number.map_or_else(|| "-".to_owned(), |number| format!("{number:.digits$}"))
    };
    let residual = largest_residual(levels);
    let Ratios { value, slope } = Ratios::of(levels.last());
    let smooth = |number: Option<f64>| number.filter(|_| is_smooth);
    vec![
        datum.name().to_owned(),
        if is_smooth { "H²" } else { "H¹" }.to_owned(),
        residual.map_or_else(|| "-".to_owned(), |number| format!("{number:.0e}")),
        shown(
            largest_of(levels.iter().map(Projected::share_of_value_bound)),
            4,
        ),
        shown(
            smooth(largest_of(
                levels.iter().map(Projected::share_of_smooth_bound),
            )),
            4,
        ),
        shown(smooth(Some(value)), 6),
        shown(smooth(Some(slope)), 6),
    ]
}
