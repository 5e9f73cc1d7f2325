//! Both solvers over the time step and a second parameter.
//!
//! # The scene
//!
//! A beam touches the upper obstacle and is driven into it, by its velocity for short steps and by
//! the heat of its clamped end for long ones. So the tip is in contact at the end of the first step
//! for every parameter on the map. That step measures the fixed point: whether it converges, in how
//! many iterations, and the factor by which the last increment shrank. Newton's method does more
//! steps: its iterations, the largest rise of the energy, and the largest residual of the energy
//! balance are compared with the effect of rounding errors.
//!
//! # The prediction
//!
//! The eigenvalues of the error propagation lie between `-α` (contact) and `γ` (coupling between
//! rotation and displacement). The boundary of convergence therefore lies at α = 1 if γ is small,
//! and otherwise above it by a share of γ. On lines through the map it is found by bisection in dt.
//!
//! Newton's method needs a definite operator: `B (ζ + dt/2) + m dt/2 > 0` is sufficient, with the
//! buckling force B and the mean axial force m >= β.

use super::{
    SolverTask,
    step::{FixedPointStep, factors},
};
use crate::exact::norm::slope_squared;
use crate::kinds::prelude::*;
use crate::{
    kinds::{
        runs::watch::{Watched, Worst, watched},
        tables::Share,
    },
    scene::limits::{self, Elements},
};
use convergence_judge::text::number::plain_text;
use convergence_study::file::{Choices, Finite};
use thermobeam::{
    mesh::{Mesh, MeshError},
    one_step::{InitialValues, Problem},
    parameters::{Beam, Obstacles},
    scheme::EULER_CRANK_NICOLSON,
};

/// The obstacles, close enough that the heat presses the beam against them for every β on the maps.
const GAP: f64 = 0.01;
/// Temperature of the clamped end.
const HEAT: f64 = 20.0;
/// Velocity of the tip.
const SPEED: f64 = 0.1;
/// Iterations after which the fixed point iteration is abandoned on the map.
const ITERATIONS: usize = 150;
/// Halvings of the logarithm of dt: seven decades to one part in ten thousand.
const HALVINGS: usize = 20;
/// Iterations after which the ratio of two increments equals the factor of the slowest mode.
const SETTLED: usize = 400;
/// Largest α at which the boundary is sought. Far beyond it the iterates grow so large that the
/// Kirchhoff term stiffens the beam: the increments may shrink for many iterations without
/// convergence. The map shows the failure there.
const FAR: f64 = 4.0;
/// Consecutive ratios that must be below 1: past the boundary the iteration may enter a cycle in
/// which some are.
const CONSECUTIVE: usize = 8;

/// Both solvers over two parameters: the table `[map]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Map {
    /// the second parameter, beside dt
    pub(super) over: OneOf<MapParameter>,
    /// the shortest and the longest step
    #[schemars(extend("title" = "two ascending numbers > 0"))]
    dt: [Finite; 2],
    /// the ends of the second parameter
    #[schemars(extend("title" = "two ascending numbers"))]
    range: [Finite; 2],
    /// points in each direction
    pub(super) points: Count<2, { limits::MAP_POINTS }>,
    /// values on which the boundary is searched
    pub(super) lines: Vec<Finite>,
    /// number of elements
    elements: Elements,
    /// steps of a run
    steps: Count<1, { limits::STEPS }>,
    /// relative distance allowed between measured and predicted boundary
    pub(super) agreement: Share,
}

/// The second parameter of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MapParameter {
    Epsilon,
    Beta,
    Zeta,
    /// Mesh width; the number of elements is the nearest whole one.
    Width,
}

impl Choices for MapParameter {
    type Value = Self;

    fn all() -> Vec<(&'static str, Self)> {
        vec![
            ("epsilon", Self::Epsilon),
            ("beta", Self::Beta),
            ("zeta", Self::Zeta),
            ("h", Self::Width),
        ]
    }
}

impl MapParameter {
    pub(super) fn is_linear(self) -> bool {
        self == MapParameter::Beta
    }
}

impl Map {
    /// The map, if there are lines and the parameters have such values.
    pub(super) fn checked(self) -> Result<Self, Refusal> {
        let over = self.over.value;
        ascending("range", self.range, over.is_linear())?;
        let is_width = over == MapParameter::Width;
        if is_width {
            check_width("range", self.range[0].get())?;
        }
        for (place, value) in self.lines().enumerate() {
            let path = format!("lines[{place}]");
            // ζ = 0 has no place on a logarithmic axis, and the theory excludes it.
            let fits = value > 0.0
                || over == MapParameter::Beta
                || (over == MapParameter::Zeta && value == 0.0);
            if !fits {
                return Err(Refusal::written(path, "a value of the parameter"));
            }
            if is_width {
                check_width(&path, value)?;
            }
        }
        if self.lines.is_empty() {
            return Err(Refusal::written("lines", "a list of at least one number"));
        }
        ascending("dt", self.dt, false)?;
        Ok(self)
    }

    fn lines(&self) -> impl Iterator<Item = f64> {
        self.lines.iter().map(|line| line.get())
    }

    /// So many time steps from the shortest to the longest.
    pub(super) fn time_steps(&self, points: usize) -> Vec<f64> {
        sampled(self.dt, false, points)
    }

    /// The second parameter of each row.
    fn values(&self) -> Vec<f64> {
        sampled(self.range, self.over.value.is_linear(), self.points.get())
    }

    /// Whether a value is between the ends of the second parameter.
    pub(super) fn has(&self, value: f64) -> bool {
        let [low, high] = self.range.map(Finite::get);
        (low..high).contains(&value)
    }

    /// The coefficients at a value of the second parameter.
    pub(super) fn beam(&self, value: f64) -> Beam {
        let mut beam = Beam {
            theta_a: HEAT,
            ..Beam::default()
        };
        match self.over.value {
            MapParameter::Beta => beam.beta = value,
            MapParameter::Zeta => beam.zeta = value,
            MapParameter::Epsilon | MapParameter::Width => {}
        }
        beam
    }

    /// The scene at a value of the second parameter.
    fn problem(&self, value: f64) -> Result<Problem, MeshError> {
        let mut obstacles = Obstacles {
            g1: -GAP,
            g2: GAP,
            ..Obstacles::default()
        };
        if self.over.value == MapParameter::Epsilon {
            obstacles.epsilon = value;
        }
        let mesh = Mesh::uniform(self.elements(value).round().max(1.0) as usize)?;
        let mut initial = InitialValues::at_rest(&mesh, HEAT);
        initial.u = mesh.nodes().iter().map(|x| GAP * x * (2.0 - x)).collect();
        initial.u_t = mesh.nodes().iter().map(|x| SPEED * x).collect();
        Ok(Problem {
            beam: self.beam(value),
            obstacles: Some(obstacles),
            mesh,
            initial,
        })
    }

    fn parts(&self, value: f64) -> Parts {
        Parts::new(&self.beam(value), Some(&Obstacles::default()))
            .on(true)
            .by_the_paper(Solver::FixedPoint)
    }

    pub(super) fn cases(&self) -> Vec<Case<SolverTask>> {
        let name = self.over.name;
        let row = (self.points.get() * (ITERATIONS + 4 * self.steps.get())) as f64;
        let boundary = (2 * HALVINGS * SETTLED) as f64;
        let mut cases = vec![];
        for value in self.values() {
            let label = format!("{name} = {value:.3e}");
            let cost = row * self.elements(value);
            let case = Case::new(label, cost, SolverTask::Row(value));
            cases.push(case.described(&self.parts(value)));
        }
        for value in self.lines() {
            let label = format!("boundary at {name} = {}", plain_text(value));
            let cost = boundary * self.elements(value);
            let case = Case::new(label, cost, SolverTask::Boundary(value));
            cases.push(case.described(&self.parts(value)));
        }
        cases
    }

    /// The number of elements for the cost of a case; the mesh has the nearest whole number.
    fn elements(&self, value: f64) -> f64 {
        if self.over.value == MapParameter::Width {
            1.0 / value
        } else {
            self.elements.get() as f64
        }
    }
}

/// The axial force at the start, which hardly changes in the first steps.
fn axial_force(problem: &Problem) -> f64 {
    let lengths: Vec<f64> = problem.mesh.lengths().collect();
    let slope = slope_squared(&lengths, &problem.initial.u);
    problem.beam.axial_force(slope)
}

/// Refuses the width of a mesh that does not fit into memory.
fn check_width(path: &str, width: f64) -> Result<(), Refusal> {
    let most = limits::ELEMENTS as f64;
    if (1.0 / width).round() <= most {
        return Ok(());
    }
    Err(Refusal::written(path, format!("h >= {:.1e}", 1.0 / most)))
}

/// Both solvers with one time step.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPoint {
    /// The first step by the fixed point.
    pub step: FixedPointStep,
    /// Whether Newton's method completed all steps.
    pub newton_completes: bool,
    /// The completed steps; `None` if the first one failed.
    pub newton: Option<NewtonSteps>,
}

/// Steps by Newton's method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonSteps {
    /// Largest number of iterations in a step.
    pub iterations: usize,
    /// The contact force after the first step.
    pub contact_force: f64,
    /// Rise of the energy and residual of its balance.
    pub worst: Worst,
}

impl MapPoint {
    pub(super) fn numbers(&self) -> Vec<Measured> {
        let step = self.step;
        let contraction = step.contraction.filter(|_| step.converged);
        let mut numbers = vec![
            measured("", "alpha", unless_infinite(step.alpha)),
            measured("", "gamma", unless_infinite(step.gamma)),
            measured("", "contraction", contraction),
        ];
        if let Some(steps) = self.newton {
            numbers.push(measured("", "contact force", steps.contact_force));
            numbers.extend(
                steps
                    .worst
                    .named()
                    .map(|(name, value)| measured("", name, value)),
            );
        }
        numbers
    }
}

/// A row of the map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapRow {
    /// The second parameter.
    pub(super) value: f64,
    /// One point for each time step, ascending.
    pub points: Vec<MapPoint>,
}

impl Map {
    pub(super) fn row(&self, value: f64) -> Result<MapRow, CaseFailure> {
        let problem = self.problem(value)?;
        let dts = self.time_steps(self.points.get());
        let n_value = axial_force(&problem);
        let mut newton: Vec<Option<NewtonSteps>> = vec![None; dts.len()];
        let runs = watched(
            vec![problem.clone(); dts.len()],
            &dts,
            EULER_CRANK_NICOLSON,
            self.steps.get(),
            |k, iterations, level| {
                let steps = newton[k].get_or_insert(NewtonSteps {
                    iterations,
                    contact_force: level.contact_force,
                    worst: Worst::default(),
                });
                steps.iterations = iterations.max(steps.iterations);
            },
        )?;
        let mut points = Vec::with_capacity(dts.len());
        for ((Watched { worst, failure }, dt), newton) in runs.into_iter().zip(dts).zip(newton) {
            points.push(MapPoint {
                step: FixedPointStep::run(&problem, dt, n_value, ITERATIONS)?,
                newton_completes: failure.is_none(),
                newton: newton.map(|steps| NewtonSteps { worst, ..steps }),
            });
        }
        Ok(MapRow { value, points })
    }
}

/// Predicted and measured boundary on a line of constant second parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boundary {
    /// The second parameter and its value.
    pub(super) over: &'static str,
    pub(super) value: f64,
    /// The dt at which α = 1; `None` if α does not cross 1 within the map.
    pub predicted: Option<f64>,
    /// The step with the dt above which the fixed point fails; `None` if the outcome is the same at
    /// both ends of the map.
    pub found: Option<FixedPointStep>,
}

impl Map {
    /// The dt in the map at which the predicted factor α is `limit`; `None` if there is none.
    fn dt_of_alpha(
        &self,
        problem: &Problem,
        n_value: f64,
        limit: f64,
    ) -> Result<Option<f64>, CaseFailure> {
        let [low, high] = self.dt.map(Finite::get);
        bisect(low, high, |dt| Ok(factors(problem, dt, n_value)[0] < limit))
    }

    pub(super) fn boundary(&self, value: f64) -> Result<Boundary, CaseFailure> {
        let problem = self.problem(value)?;
        let [low, high] = self.dt.map(Finite::get);
        let n_value = axial_force(&problem);
        let far = self.dt_of_alpha(&problem, n_value, FAR)?.unwrap_or(high);
        let found = bisect(low, far, |dt| contracts(&problem, dt, n_value))?
            .map(|dt| FixedPointStep::run(&problem, dt, n_value, ITERATIONS))
            .transpose()?;
        Ok(Boundary {
            over: self.over.name,
            value,
            predicted: self.dt_of_alpha(&problem, n_value, 1.0)?,
            found,
        })
    }
}

/// Whether the increments shrink, however slowly.
fn contracts(problem: &Problem, dt: f64, n_value: f64) -> Result<bool, CaseFailure> {
    for iterations in SETTLED - CONSECUTIVE..SETTLED {
        let FixedPointStep {
            converged,
            contraction,
            ..
        } = FixedPointStep::run(problem, dt, n_value, iterations)?;
        if converged || !contraction.is_some_and(|ratio| ratio < 1.0) {
            return Ok(converged);
        }
    }
    Ok(true)
}

/// A predicted factor; an infinite one has no value in the records.
fn unless_infinite(factor: f64) -> Option<f64> {
    (!factor.is_infinite()).then_some(factor)
}

/// Refuses ends that do not ascend, or are not positive on a logarithmic scale.
fn ascending(path: &str, ends: [Finite; 2], is_linear: bool) -> Result<(), Refusal> {
    let [low, high] = ends.map(Finite::get);
    if low < high && (is_linear || low > 0.0) {
        return Ok(());
    }
    let positive = if is_linear { "" } else { " > 0" };
    let allowed = format!("two ascending numbers{positive}");
    Err(Refusal::written(path, allowed))
}

/// At least two values from the first end to the last, equally spaced on their scale.
fn sampled(ends: [Finite; 2], is_linear: bool, points: usize) -> Vec<f64> {
    let [low, high] = ends.map(Finite::get);
    let values = (0..points).map(|k| {
        let share = k as f64 / (points - 1) as f64;
        if is_linear {
            low + (high - low) * share
        } else {
            low * (high / low).powf(share)
        }
    });
    values.collect()
}

/// The boundary between a `low` that satisfies the condition and a `high` that does not; `None` for
/// any other pair.
fn bisect(
    mut low: f64,
    mut high: f64,
    holds: impl Fn(f64) -> Result<bool, CaseFailure>,
) -> Result<Option<f64>, CaseFailure> {
    if !holds(low)? || holds(high)? {
        return Ok(None);
    }
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        *(if holds(middle)? { &mut low } else { &mut high }) = middle;
    }
    Ok(Some((low * high).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::{Finite, bisect, sampled};

    #[test]
    fn values_are_equally_spaced_on_their_scale() {
        let ends = [1.0, 100.0].map(|end| Finite::new(end).unwrap());
        assert_eq!(sampled(ends, true, 3), [1.0, 50.5, 100.0]);
        assert_eq!(sampled(ends, false, 3), [1.0, 10.0, 100.0]);
    }

    #[test]
    fn a_threshold_is_found_to_a_part_in_ten_thousand() {
        let found = bisect(1e-6, 10.0, |dt| Ok(dt < 4.6e-3)).unwrap().unwrap();
        assert!((found / 4.6e-3 - 1.0).abs() < 1e-4);
        assert_eq!(bisect(1.0, 2.0, |_| Ok(true)).unwrap(), None);
        assert_eq!(bisect(1.0, 2.0, |_| Ok(false)).unwrap(), None);
    }
}
