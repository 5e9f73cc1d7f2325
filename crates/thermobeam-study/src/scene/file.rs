//! A scene as its file has it: the tables of beam, obstacles, initial data, mesh and time steps.

use std::borrow::Cow;
use std::marker::PhantomData;

use convergence_study::file::{Choices, Count, Finite, OneOf, Positive, Refusal};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize};
use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{self, Scheme};
use thermobeam::solve::{Settings, Solver, Stopping};

use super::limits::Elements;
use super::method::DG;
use crate::expression::{Expression, Variable};

/// A scene.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// the coefficients of the equations (1.1)
    #[serde(default)]
    pub(crate) beam: BeamTable,
    /// the obstacles at the free end, (1.3); without the table there are none
    pub(crate) obstacles: Option<ObstacleTable>,
    /// the initial data, functions of x; each is 0 without it
    #[serde(default)]
    pub(crate) initial: InitialTable,
    /// the mesh: elements and map, or nodes
    #[serde(default)]
    pub(crate) mesh: MeshTable,
    /// the method, its steps, and where the run ends
    pub(crate) time: TimeTable,
}

/// The table `[beam]`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct BeamTable {
    /// the viscosity ζ
    #[schemars(extend("default" = Beam::default().zeta))]
    zeta: Option<Finite>,
    /// the thermal coupling a
    #[schemars(extend("default" = Beam::default().a))]
    a: Option<Finite>,
    /// the factor ρ of ‖u_x‖² in the axial force
    #[schemars(extend("default" = Beam::default().rho))]
    rho: Option<Finite>,
    /// the axial force β of the straight beam
    #[schemars(extend("default" = Beam::default().beta))]
    beta: Option<Finite>,
    /// the temperature θ_A at x = 0
    #[schemars(extend("default" = Beam::default().theta_a))]
    theta_a: Option<Finite>,
}

/// The table `[obstacles]`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ObstacleTable {
    /// the normal compliance ε
    #[schemars(extend("default" = Obstacles::default().epsilon))]
    epsilon: Option<Finite>,
    /// the lower obstacle
    #[schemars(extend("default" = Obstacles::default().g1))]
    g1: Option<Finite>,
    /// the upper obstacle
    #[schemars(extend("default" = Obstacles::default().g2))]
    g2: Option<Finite>,
}

/// The first of these keys whose condition holds.
pub(crate) fn first_where<const N: usize>(keys: [(&'static str, bool); N]) -> Option<&'static str> {
    let first = keys.into_iter().find(|(_, holds)| *holds);
    first.map(|(key, _)| key)
}

/// The table `[initial]`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct InitialTable {
    /// displacement; 0 at x = 0
    pub(super) u: Option<Formula<OfX>>,
    /// velocity; 0 at x = 0
    pub(super) u_t: Option<Formula<OfX>>,
    /// rotation; 0 at x = 0
    pub(super) phi: Option<Formula<OfX>>,
    /// rate of rotation; 0 at x = 0
    pub(super) phi_t: Option<Formula<OfX>>,
    /// temperature; theta_a at x = 0, 0 at x = 1
    pub(super) theta: Option<Formula<OfX>>,
}

/// The table `[mesh]`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshTable {
    /// number of elements; without it 100, or 1 with scheme = "dg"
    pub(super) elements: Option<Elements>,
    /// a function of s that places the nodes: 0 at 0, 1 at 1; without it s
    pub(super) map: Option<Formula<OfS>>,
    /// the nodes, increasing from 0 to 1, in place of elements and map
    #[schemars(extend("title" = "a list of at least two numbers that increase strictly from 0 to 1"))]
    pub(super) nodes: Option<Vec<Finite>>,
    /// degree p of the elements; without it 1, or 13 with scheme = "dg"
    pub(super) degree: Option<Degree>,
}

/// Degree p of elements.
pub(crate) type Degree = Count<1, MAX_DEGREE>;

/// Degree q in time.
pub(crate) type TimeDegree = Count<0, MAX_TIME_DEGREE>;

/// The table `[time]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TimeTable {
    /// the one-step scheme; or "dg": elements of any degree, dG(q) in time
    #[schemars(extend("default" = scheme::EULER_CRANK_NICOLSON.name))]
    pub(super) scheme: Option<OneOf<Methods>>,
    /// time step, which divides t_end; with "dg" the largest step, without it 0.02 and at most
    /// t_end
    pub(super) dt: Option<Positive>,
    /// final time
    pub(super) t_end: Positive,
    /// how a step of a one-step scheme is solved; without it by "newton"
    pub(super) solver: Option<OneOf<Solvers>>,
    /// the increment at which an iteration ends; without it 1e-10, with "dg" 1e-14
    pub(super) tolerance: Option<Positive>,
    /// iterations after which a step fails
    #[schemars(extend("default" = 100))]
    pub(super) max_iterations: Option<Count<1>>,
    /// of the fixed point in each step, in place of tolerance and max_iterations
    pub(super) iterations: Option<Count<1>>,
    /// with "dg": degree q in time; without it 2
    pub(super) degree: Option<TimeDegree>,
    /// with "dg": the first step, at the start and after each contact event; without it a fifth of
    /// the time scale of an impact
    pub(super) restart_dt: Option<Positive>,
    /// with "dg": factor of the steps in between, at least 1; without it 1.5
    pub(super) growth: Option<Growth>,
}

/// The factor of the steps of dG.
pub(crate) type Growth = convergence_study::file::Number<AtLeastOne>;

/// The range of the numbers >= 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum AtLeastOne {}

impl convergence_study::file::Range for AtLeastOne {
    const ENDS: &'static [(&'static str, f64)] = &[("minimum", 1.0)];
}

/// The one-step schemes.
#[derive(Debug)]
pub(crate) enum Schemes {}

impl Choices for Schemes {
    type Value = Scheme;

    fn all() -> Vec<(&'static str, Scheme)> {
        scheme::SCHEMES.map(|scheme| (scheme.name, scheme)).to_vec()
    }
}

/// The one-step schemes and dG, which is `None`.
#[derive(Debug)]
pub(crate) enum Methods {}

impl Choices for Methods {
    type Value = Option<Scheme>;

    fn all() -> Vec<(&'static str, Option<Scheme>)> {
        let schemes = Schemes::all().into_iter();
        let schemes = schemes.map(|(name, scheme)| (name, Some(scheme)));
        schemes.chain([(DG, None)]).collect()
    }
}

/// How a step is solved.
#[derive(Debug)]
pub(crate) enum Solvers {}

impl Choices for Solvers {
    type Value = Solver;

    fn all() -> Vec<(&'static str, Solver)> {
        Solver::ALL.map(|solver| (solver.name(), solver)).to_vec()
    }
}

/// How steps of a one-step scheme are solved: keys that several tables have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SolverKeys {
    pub(crate) solver: Option<OneOf<Solvers>>,
    pub(crate) tolerance: Option<Positive>,
    pub(crate) max_iterations: Option<Count<1>>,
    pub(crate) iterations: Option<Count<1>>,
}

impl SolverKeys {
    /// Whether there is any.
    pub(crate) fn are_given(&self) -> bool {
        self.solver.is_some()
            || self.tolerance.is_some()
            || self.max_iterations.is_some()
            || self.iterations.is_some()
    }

    /// The settings that the keys change.
    ///
    /// # Errors
    /// `iterations` beside another rule for the end of an iteration, or without the fixed point.
    pub(crate) fn over(self, settings: Settings) -> Result<Settings, Refusal> {
        let mut settings = settings;
        if let Some(solver) = self.solver {
            settings.solver = solver.value;
        }
        if let Some(iterations) = self.iterations {
            let other = first_where([
                ("tolerance", self.tolerance.is_some()),
                ("max_iterations", self.max_iterations.is_some()),
            ]);
            if let Some(key) = other {
                let found = "a second rule for the end of the iteration";
                return Err(Refusal::new(key, found, "`iterations` alone"));
            }
            if settings.solver != Solver::FixedPoint {
                let found = format!("solver \"{}\"", settings.solver.name());
                let allowed = "the solver \"fixed-point\" beside it";
                return Err(Refusal::new("iterations", found, allowed));
            }
            settings.stopping = Stopping::Iterations(iterations.get());
        }
        if let Stopping::Converged {
            tolerance,
            max_iterations,
        } = &mut settings.stopping
        {
            *tolerance = self.tolerance.map_or(*tolerance, Positive::get);
            *max_iterations = self.max_iterations.map_or(*max_iterations, Count::get);
        }
        Ok(settings)
    }
}

/// The variable of a formula.
pub(crate) trait Of {
    /// The variable.
    const VARIABLE: Variable;
}

/// Functions of x.
#[derive(Debug, Clone)]
pub(crate) enum OfX {}

/// Functions of t.
#[derive(Debug, Clone)]
pub(crate) enum OfT {}

/// Functions of s.
#[derive(Debug, Clone)]
pub(crate) enum OfS {}

impl Of for OfX {
    const VARIABLE: Variable = Variable::X;
}

impl Of for OfT {
    const VARIABLE: Variable = Variable::T;
}

impl Of for OfS {
    const VARIABLE: Variable = Variable::S;
}

/// The text of a function.
#[derive(Debug, Clone)]
pub(crate) struct Formula<V>(String, PhantomData<V>);

impl<V: Of> Formula<V> {
    /// The function, finite on [0, end] with its derivatives up to `order`.
    ///
    /// * `path`: the field that has it; a message points into the text.
    pub(crate) fn parse(&self, path: &str, end: f64, order: usize) -> Result<Expression, Refusal> {
        let function = Expression::parse(&self.0, V::VARIABLE).map_err(|error| {
            let reason = format!("{}\n{}", error.problem, error.excerpt());
            Refusal::misread(path, error.offset, reason)
        })?;
        let found = function.check_finite(end, order);
        found.map_err(|found| Refusal::invalid(path, found.to_string()))?;
        Ok(function)
    }
}

impl<'de, V> Deserialize<'de> for Formula<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer).map(|text| Self(text, PhantomData))
    }
}

impl<V: Of> JsonSchema for Formula<V> {
    fn schema_name() -> Cow<'static, str> {
        V::VARIABLE.name().into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let name = V::VARIABLE.name();
        let words = format!("a function of {name} in quotes, such as \"1 - {name}\"");
        json_schema!({ "type": "string", "title": words })
    }
}
