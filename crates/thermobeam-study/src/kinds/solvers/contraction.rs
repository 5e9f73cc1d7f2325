//! The contraction factor of one step in contact, measured and predicted.

use std::fmt;

use super::with_all;
use convergence_study::left_out;

use super::{
    SolverResult, SolverTask, not_empty, results,
    spectrum::spectral_radius,
    step::{by_fixed_point, factors},
};
use crate::kinds::prelude::*;
use crate::{
    figures,
    run::{driver::Driver, run_to},
    scene::limits::{self, Elements},
};
use thermobeam::{
    mesh::{Mesh, MeshError},
    one_step::{InitialValues, Problem, Stepping},
    parameters::{Beam, Obstacles},
    scheme::EULER_CRANK_NICOLSON,
    solve::Stopping,
};

/// Smallest and largest number of iterations between the start and the last increment but one of a
/// measurement.
const FEWEST: usize = 3;
const ITERATIONS: usize = 60;
/// The increments of a measurement shrink or grow by about this factor: so much that the largest
/// eigenvalue dominates, and so little that rounding errors do not show.
const SPAN: f64 = 1e8;
/// Largest displacement of the free end by the disturbance, in all iterates: small against the
/// depth of the contact, 0.02.
const DISTURBANCE: f64 = 1e-5;
/// Largest relative difference between the measured factor and the spectral radius.
const AGREEMENT: f64 = 0.01;
/// Iterations from which the ratio of two increments shows the largest eigenvalue. The first
/// increment is not one of the linearised iteration, by (4.1), and with fewer ratios the other
/// eigenvalues still take part.
const SETTLED: usize = 5;
/// Largest distance of an increment to that of the linearised iteration.
const LINEAR: f64 = 1e-3;
/// Slope of the beam pressed into the upper obstacle by a fifth of the gap.
const PRESSED: f64 = 0.12;

/// The combinations of the table `[contraction]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ContractionGrid {
    /// number of elements
    elements: Elements,
    /// time steps
    dt: Vec<Positive>,
    /// normal compliances
    epsilon: Vec<Positive>,
    /// viscosities
    zeta: Vec<Positive>,
}

impl ContractionGrid {
    /// The grid, if each list has a number and there are not too many cases.
    pub(super) fn checked(self) -> Result<Self, Refusal> {
        not_empty("dt", &self.dt)?;
        not_empty("epsilon", &self.epsilon)?;
        not_empty("zeta", &self.zeta)?;
        let Self {
            dt, epsilon, zeta, ..
        } = &self;
        limits::case_count("dt", &[dt.len(), epsilon.len(), zeta.len()])?;
        Ok(self)
    }

    pub(super) fn cases(&self) -> Vec<Case<SolverTask>> {
        let cost = self.elements.get() as f64 * ITERATIONS as f64;
        let mut cases = vec![];
        for &zeta in &self.zeta {
            for &epsilon in &self.epsilon {
                for &dt in &self.dt {
                    let [dt, epsilon, zeta] = [dt, epsilon, zeta].map(Positive::get);
                    let place = MeasuredPoint { dt, epsilon, zeta };
                    let task = SolverTask::Contraction(place);
                    let parts = Parts::new(&place.beam(), Some(&place.obstacles()))
                        .on(true)
                        .by_the_paper(Solver::FixedPoint);
                    cases.push(Case::new(place.to_string(), cost, task).described(&parts));
                }
            }
        }
        cases
    }

    /// The beam at rest in contact, before it is disturbed.
    fn state(&self, place: MeasuredPoint) -> Result<Problem, MeshError> {
        let mesh = Mesh::uniform(self.elements.get())?;
        let mut initial = InitialValues::at_rest(&mesh, 0.0);
        initial.u = mesh.nodes().iter().map(|x| PRESSED * x).collect();
        Ok(Problem {
            beam: place.beam(),
            obstacles: Some(place.obstacles()),
            mesh,
            initial,
        })
    }

    /// The first step next to a state of rest in contact, after a disturbance of u_t.
    ///
    /// Loads hold the beam at u = p x, φ = 0, θ = 0, at a fifth of the gap behind the upper
    /// obstacle. On a uniform mesh they are, by (3.7) at rest, `(1 + N) p + g(p)` at the free end
    /// in the first equation, and `-p (1, χ_i)` in the second.
    pub(super) fn measure(&self, place: MeasuredPoint) -> Result<Contraction, CaseFailure> {
        let dt = place.dt;
        let mut problem = self.state(place)?;
        let n_value = problem.beam.axial_force(PRESSED * PRESSED);
        let [alpha, gamma] = factors(&problem, dt, n_value);
        let case = problem.case(EULER_CRANK_NICOLSON, dt);
        let mut map = case
            .linearized_iteration(&problem.initial.u)
            .ok_or_else(|| CaseFailure::new("a matrix of (4.2) is not positive definite"))?;
        let radius = spectral_radius(&mut map);
        let iterations =
            ((SPAN.ln() / radius.ln().abs()).ceil() as usize).clamp(FEWEST, ITERATIONS);
        let growth = radius.max(1.0).powi(iterations as i32 + 1);
        let speed = DISTURBANCE / (dt * growth);
        problem.initial.u_t = problem.mesh.nodes().iter().map(|x| speed * x).collect();
        let contact_force = problem
            .obstacles
            .map_or(0.0, |obstacles| obstacles.force(PRESSED));
        let held = Held {
            problem,
            dt,
            tip_load: (1.0 + n_value) * PRESSED + contact_force,
        };
        let before = held.iterate(iterations - 1)?;
        let one = held.iterate(iterations)?;
        let two = held.iterate(iterations + 1)?;
        let mut expected = difference(&one.velocities, &before.velocities);
        let (v, w) = expected.split_at_mut(self.elements.get() + 1);
        map.apply(v, w);
        let increment = difference(&two.velocities, &one.velocities);
        Ok(Contraction {
            place,
            alpha,
            gamma,
            radius,
            iterations: iterations + 1,
            measured: two.contraction,
            deviation: length(&difference(&increment, &expected)) / length(&increment),
        })
    }

    pub(super) fn judge(&self, ran: &[Ran<SolverTask, SolverResult>]) -> Outcome {
        let points = results(ran, |found| match found {
            SolverResult::Contraction(point) => Some(point),
            _ => None,
        });
        let all = self.cases().len();
        let summary = format!("{}; {}", increments(&points, all), known_factors(&points));
        let numbers = points.iter().flat_map(|point| point.numbers());
        let title = "Contraction factor in contact";
        let sheet = Sheet::new(title, "point", numbers);
        let settled = points.iter().filter(|point| point.is_settled()).count();
        let judged = Sheet::untabled([some_of("", "factors judged", settled)]);
        Outcome {
            headline: summary.clone().into(),
            left_out: factors_left_out(&points, all).into_iter().collect(),
            figures: vec![figure(&points)],
            ..Outcome::new(summary, vec![], vec![]).with_sheets([sheet, judged])
        }
    }
}

/// The parameters of a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPoint {
    dt: f64,
    epsilon: f64,
    zeta: f64,
}

impl MeasuredPoint {
    fn beam(self) -> Beam {
        Beam {
            zeta: self.zeta,
            ..Beam::default()
        }
    }

    fn obstacles(self) -> Obstacles {
        Obstacles {
            epsilon: self.epsilon,
            ..Obstacles::default()
        }
    }
}

impl fmt::Display for MeasuredPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { dt, epsilon, zeta } = self;
        write!(f, "dt = {dt:e}, epsilon = {epsilon:e}, zeta = {zeta}")
    }
}

/// The factor of an iteration in contact: predictions and measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contraction {
    /// Where it is measured.
    place: MeasuredPoint,
    /// Predicted factor of the contact alone; infinite if its operator is not definite.
    pub alpha: f64,
    /// Predicted factor of the coupling between rotation and displacement alone; infinite if its
    /// operator is not definite.
    pub gamma: f64,
    /// Spectral radius of the whole iteration, linearised at the state.
    pub radius: f64,
    /// Iterations done.
    pub iterations: usize,
    /// Ratio of the last two increments in the norm of (3.14).
    pub measured: f64,
    /// Distance of the last increment of (û, φ̂) to the image of the one before under the
    /// linearised iteration, relative.
    pub deviation: f64,
}

/// A step from a disturbed state of rest that loads hold.
struct Held {
    problem: Problem,
    dt: f64,
    /// Load of the first equation at the free end.
    tip_load: f64,
}

struct Iterate {
    /// û at the nodes, then φ̂.
    velocities: Vec<f64>,
    /// Ratio of the last two increments.
    contraction: f64,
}

impl Held {
    /// The iterate after this number of iterations.
    fn iterate(&self, iterations: usize) -> Result<Iterate, CaseFailure> {
        let stepping = Stepping {
            loaded: true,
            ..by_fixed_point(self.dt, Stopping::Iterations(iterations))
        };
        let driver = Driver::new(self.problem.clone(), stepping)?;
        let mut driver = driver.loaded(|_, load| {
            let n = load.len() - 1;
            let moment = -PRESSED / n as f64;
            load.iter_mut().for_each(|load| load[1] = moment);
            load[n] = [self.tip_load, 0.5 * moment, 0.0];
        });
        let mut contraction = None;
        run_to(&mut driver, self.dt, |_, report| {
            contraction = report.contraction;
        })?;
        let level = driver.level();
        Ok(Iterate {
            velocities: [&level.v[..], &level.w].concat(),
            contraction: contraction.unwrap_or(f64::NAN),
        })
    }
}

fn difference(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter()
        .zip(other)
        .map(|(one, other)| one - other)
        .collect()
}

/// Euclidean length.
fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// How far the increments are those of the linearised iteration.
fn increments(points: &[&Contraction], all: usize) -> String {
    let linear = points.iter().filter(|point| point.is_linear()).count();
    largest_of(points.iter().map(|point| point.deviation)).map_or(
        "no point has a result".to_owned(),
        |deviation| {
            format!(
                "increments are those of the linearised iteration to {deviation:.0e} at {linear} of {all} points"
            )
        },
    )
}

/// How far the factors are spectral radii.
fn known_factors(points: &[&Contraction]) -> String {
    let settled: Vec<f64> = points
        .iter()
        .filter(|point| point.is_settled())
        .map(|point| point.error())
        .collect();
    let count = settled.len();
    largest_of(settled).map_or("no factor is known".to_owned(), |worst| {
        format!(
            "the factor is its spectral radius to {:.1} % at {count}",
            100.0 * worst
        )
    })
}

/// The points whose factor is not compared with the spectral radius.
fn factors_left_out(points: &[&Contraction], all: usize) -> Option<String> {
    let unsettled = format!("fewer than {SETTLED} iterations");
    let reasons = points
        .iter()
        .map(|point| (!point.is_settled()).then_some(&unsettled[..]));
    left_out("factors", with_all(all, reasons))
}

impl Contraction {
    /// Relative difference of the measured factor to the spectral radius.
    fn error(&self) -> f64 {
        (self.measured / self.radius - 1.0).abs()
    }

    fn is_settled(&self) -> bool {
        self.iterations >= SETTLED
    }

    fn is_linear(&self) -> bool {
        self.deviation <= LINEAR
    }

    pub(super) fn numbers(&self) -> Vec<Measured> {
        let one = |name: &str, value: f64| measured(self.place.to_string(), name, value);
        let is_factor = self.is_settled();
        vec![
            one("alpha", self.alpha).fixed(5),
            one("gamma", self.gamma).hidden(),
            one("spectral radius", self.radius).fixed(5),
            one("measured", self.measured)
                .fixed(5)
                .recorded_as(format!("contraction, {}", self.place), 1e-2),
            one(
                "last increment apart from the linearised one",
                self.deviation,
            )
            .scientific(1)
            .must_be(Must::AtMost(LINEAR)),
            one("measured apart from the spectral radius", self.error())
                .scientific(1)
                .must_be(is_factor.then_some(Must::AtMost(AGREEMENT))),
            one("iterations", self.iterations as f64).fixed(0),
        ]
    }
}

fn figure(points: &[&Contraction]) -> Figure {
    let mut zetas: Vec<f64> = points.iter().map(|point| point.place.zeta).collect();
    zetas.dedup();
    let mut measured = vec![];
    for zeta in zetas {
        let series = points.iter().filter(|point| point.place.zeta == zeta);
        measured.push(figures::NamedPoints {
            label: format!("ζ = {zeta}"),
            points: series.map(|point| (point.radius, point.measured)).collect(),
        });
    }
    // Elsewhere α lies under the marker of the measured factor.
    let off = points
        .iter()
        .filter(|point| (point.alpha / point.measured - 1.0).abs() > 0.1)
        .map(|point| (point.radius, point.alpha));
    let svg = figures::contraction(&figures::ContractionFactors {
        title: "The fixed point contracts as its linearisation does".to_owned(),
        measured,
        predicted: "spectral radius of the linearised iteration".to_owned(),
        estimates: figures::NamedPoints {
            label: "α, where over 10 % off".to_owned(),
            points: off.collect(),
        },
    });
    let caption = "Contraction factor of the fixed point in contact: measured over the spectral radius of the linearised \
                   iteration, and the estimate α. From 1 on the iteration diverges.";
    Figure::new("contraction", caption, svg)
}
