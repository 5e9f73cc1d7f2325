//! Random scenes: all coefficients, meshes, initial data and time steps, both schemes, both
//! solvers.
//!
//! Each ends with a solution or a typed error. In each step the energy does not increase and its
//! balance closes, to 1e-12 of the energy or to the bound on rounding errors. A failing scene is
//! reduced to a small one. The scenes are the same in every run; `PROPTEST_RNG_SEED` and
//! `PROPTEST_CASES` select others.

use crate::prelude::*;
use proptest::prelude::*;

const STEPS: usize = 20;
/// Tolerance of the balance relative to the energy, unless the bound on rounding errors is larger.
const BALANCE_TOLERANCE: f64 = 1e-12;

/// η* of each solver, small because the balance holds for exactly solved steps only.
fn tolerance(solver: Solver) -> f64 {
    if solver == Solver::Newton {
        1e-14
    } else {
        1e-11
    }
}

fn log(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|exponent| 10f64.powf(exponent))
}

fn or_zero(strategy: impl Strategy<Value = f64> + 'static) -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 8 => strategy]
}

fn beam() -> impl Strategy<Value = Beam> {
    let coupling = or_zero(prop_oneof![log(-3.0, 0.0), log(-3.0, 0.0).prop_map(|a| -a)]);
    let beta = prop_oneof![-2.0..2.0, log(0.0, 3.0)];
    (
        or_zero(log(-6.0, 1.0)),
        coupling,
        or_zero(log(-2.0, 6.0)),
        beta,
        or_zero(-50.0..50.0),
    )
        .prop_map(|(zeta, a, rho, beta, theta_a)| Beam {
            zeta,
            a,
            rho,
            beta,
            theta_a,
        })
}

fn obstacles() -> impl Strategy<Value = Option<Obstacles>> {
    let gap = || or_zero(log(-6.0, 0.0));
    let pair = (log(-8.0, 1.0), gap(), gap()).prop_map(|(epsilon, below, g2)| Obstacles {
        epsilon,
        g1: -below,
        g2,
    });
    prop_oneof![1 => Just(None), 8 => pair.prop_map(Some)]
}

/// Coefficients of four modes or, if `rough`, nodal values in turn.
#[derive(Debug, Clone)]
struct Field {
    factors: [f64; 4],
    rough: bool,
}

impl Field {
    fn at(&self, x: f64, node: usize) -> f64 {
        if self.rough {
            return self.factors[node % 4];
        }
        let mode = |k: usize| self.factors[k] * ((k as f64 + 0.5) * std::f64::consts::PI * x).sin();
        (0..4).map(mode).sum()
    }
}

fn field(size: f64) -> impl Strategy<Value = Field> {
    (prop::array::uniform4(-size..size), any::<bool>())
        .prop_map(|(factors, rough)| Field { factors, rough })
}

fn problem() -> impl Strategy<Value = Problem> {
    let fields = (field(0.1), field(2.0), field(0.1), field(2.0), field(5.0));
    (beam(), obstacles(), mesh(23), fields).prop_map(
        |(beam, obstacles, mesh, (u, u_t, phi, phi_t, theta))| {
            let nodes = mesh.nodes();
            let values = |field: &Field| {
                let mut values: Vec<f64> = nodes
                    .iter()
                    .enumerate()
                    .map(|(i, &x)| field.at(x, i))
                    .collect();
                values[0] = 0.0;
                values
            };
            let mut theta = values(&theta);
            theta
                .iter_mut()
                .zip(nodes)
                .for_each(|(theta, x)| *theta += beam.theta_a * (1.0 - x));
            theta[nodes.len() - 1] = 0.0;
            let initial = InitialValues {
                u: values(&u),
                u_t: values(&u_t),
                phi: values(&phi),
                phi_t: values(&phi_t),
                theta,
            };
            Problem {
                beam,
                obstacles,
                mesh,
                initial,
            }
        },
    )
}

/// Bound on the residual of the balance that the fixed point leaves, from its last increment η in
/// the norm of (3.14): `‖δu_x‖ <= 2η`, `‖δφ_x‖ <= η`.
///
/// The first equation of (4.2) takes N(u) from the previous iterate, with an error of
/// `2ρ ‖u_x‖ 2η`; the second takes the displacement, `½ δu + ζ δV`; the third the rate of rotation,
/// δφ/dt. Each is multiplied by the test function of the balance.
fn lag(simulation: &OneStep, dt: f64, eta: f64, old: &TimeLevel, new: &TimeLevel) -> f64 {
    let (beam, lengths) = (simulation.problem().beam, simulation.lengths());
    let norm = |y: &[f64]| l2_squared(lengths, y).sqrt();
    let stretch = max_or_nan(
        slope_squared(lengths, &new.u),
        slope_squared(lengths, &old.u),
    );
    let (moved, turned) = (minus(&new.u, &old.u), minus(&new.phi, &old.phi));
    let kirchhoff = 2.0 * beam.rho * stretch * slope_squared(lengths, &moved).sqrt();
    let rotation = (1.0 + 2.0 * beam.zeta / dt) * norm(&turned);
    let heat = beam.a.abs() * max_or_nan(norm(&new.theta), norm(&old.theta));
    let tip = moved.last().unwrap().abs();
    let contact = simulation
        .problem()
        .obstacles
        .map_or(0.0, |obstacles| 2.0 * tip / obstacles.epsilon);
    eta * (kirchhoff + rotation + heat + contact)
}

/// Checks the balance and the decay of the energy in one step.
fn check(balance: &Balance, scale: f64, allowed: f64) -> Result<(), TestCaseError> {
    let largest = max_or_nan(BALANCE_TOLERANCE * scale, allowed);
    prop_assert!(
        balance.residual.abs() <= largest,
        "expected a residual of at most {:e}: {:?}",
        largest,
        balance
    );
    // The dissipative terms have a sign.
    prop_assert!(
        balance.change <= allowed,
        "expected an energy change of at most {:e}: {:?}",
        allowed,
        balance
    );
    prop_assert!(
        balance.viscous >= 0.0 && balance.thermal >= 0.0 && balance.inertial >= 0.0,
        "{:?}",
        balance
    );
    Ok(())
}

/// Runs a scene to its end or to its first error, which is returned.
fn run(
    problem: &Problem,
    scheme: Scheme,
    solver: Solver,
    dt: f64,
) -> Result<Option<StepError>, TestCaseError> {
    let settings = Settings {
        solver,
        ..below(tolerance(solver))
    };
    let mut simulation =
        OneStep::new(problem.clone(), with(scheme, settings, dt)).expect("a valid scene");
    let mut old = simulation.level();
    let mut scale = simulation.energy_scale(&old);
    for _ in 0..STEPS {
        let report = match simulation.step_once() {
            Ok(report) => report,
            Err(error) => {
                prop_assert_eq!(
                    simulation.level(),
                    old,
                    "a failed step leaves the level before"
                );
                return Ok(Some(error));
            }
        };
        prop_assert!(report.iterations <= settings.stopping.max_iterations());
        let new = simulation.level();
        prop_assert!(
            fields(&new)
                .into_iter()
                .flatten()
                .all(|value| value.is_finite())
        );
        scale = max_or_nan(scale, simulation.energy_scale(&new));
        let mut allowed = simulation.rounding(&old, &new).total();
        if solver == Solver::FixedPoint {
            allowed += lag(&simulation, dt, report.increment, &old, &new);
        }
        check(&simulation.balance(&old, &new), scale, allowed)?;
        old = new;
    }
    Ok(None)
}

/// Whether the matrix of a step is positive definite for every axial force, which is at least β.
fn definite(beam: &Beam, dt: f64) -> bool {
    beam.beta > -BUCKLING * (1.0 + 2.0 * beam.zeta / dt)
}

proptest! {
    #![proptest_config(at_least(300))]

    #[test]
    fn every_scene_ends_with_an_answer_or_a_typed_error(problem in problem(), dt in log(-6.0, 1.0)) {
        for scheme in SCHEMES {
            if let Some(error) = run(&problem, scheme, Solver::Newton, dt)? {
                prop_assert!(matches!(error.failure, StepFailure::Indefinite { .. }), "{}", error);
                prop_assert!(!definite(&problem.beam, dt), "expected a solution, because the matrix is definite: {}", error);
            }
            // The fixed point may fail in any way, but only with an error.
            run(&problem, scheme, Solver::FixedPoint, dt)?;
        }
    }
}
