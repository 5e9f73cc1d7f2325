//! The motion of a scene by dG.

use std::time::{Duration, Instant};

use convergence_judge::time_limit::Patience;
use thermobeam::dg::{Dg, DgLevel, DgProblem, DgStepping, Field, InitialFunctions};
use thermobeam::energy::Balance;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::motion::{Motion, StepReport};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::solve::TimeLevel;

use super::levels::{MOST_POINTS, equidistant_time, nodal};
use super::{BALANCE, EnergySize, Loaded, ObservableMotion, RunError, Sample};
use crate::exact::any_order;
use crate::exact::defect::Defect;
use crate::exact::solution::Manufactured;
use crate::scene::{Coefficients, Scene};

/// Times of a history: more than a figure has columns.
const ROWS: usize = 4000;

/// A problem by dG.
pub(crate) struct DgMotion {
    simulation: Dg,
    theta_a: f64,
    obstacles: Option<Obstacles>,
    level: DgLevel,
    patience: Patience,
    wall: Duration,
}

impl DgMotion {
    /// Starts at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] if the solver refuses the scene's numbers.
    pub(crate) fn new(scene: &Scene, stepping: DgStepping) -> Result<Self, SetupError> {
        let simulation = Dg::new(scene.dg_problem(), stepping)?;
        Ok(Self::of(simulation, &scene.beam, scene.obstacles, stepping))
    }

    /// A manufactured solution at t = 0.
    ///
    /// * `loads`: the coefficients of the loads that keep it in place; a free vibration of a cold
    ///   beam needs none.
    /// * `defect`: a mistake in loads and initial data, for a negative control.
    /// * `solver`: the solver's own coefficients.
    ///
    /// # Errors
    /// [`SetupError`] if the solver refuses the numbers.
    pub(crate) fn manufactured(
        exact: &Manufactured,
        loads: Option<&Coefficients>,
        defect: Option<Defect>,
        Coefficients { beam, obstacles }: Coefficients,
        mesh: Mesh,
        degree: usize,
        stepping: DgStepping,
    ) -> Result<Self, SetupError> {
        // A clamped end that is too hot is so from the start: the initial data must match it, or
        // the first step fails.
        let exact_theta_a = loads.map_or(0.0, |theory| theory.beam.theta_a);
        let shift = beam.theta_a - exact_theta_a;
        let start = any_order::initial(exact);
        let theta = start.theta;
        let missing = if defect == Some(Defect::StartNotLifted) {
            exact_theta_a
        } else {
            0.0
        };
        // The value at x = 0 stays: the solver refuses initial data that contradict the boundary
        // conditions.
        let initial = InitialFunctions {
            theta: Box::new(move |x| {
                theta(x) + (if x == 0.0 { shift } else { shift - missing }) * (1.0 - x)
            }),
            ..start
        };
        let problem = DgProblem {
            beam,
            obstacles,
            mesh,
            degree,
            initial,
        };
        let simulation = match loads {
            None => Dg::new(problem, stepping),
            Some(theory) => Dg::with_load(problem, stepping, |space| {
                any_order::load(exact, &theory.beam, theory.obstacles, space, defect)
            }),
        }?;
        Ok(Self::of(simulation, &beam, obstacles, stepping))
    }

    pub(super) fn of(
        simulation: Dg,
        beam: &Beam,
        obstacles: Option<Obstacles>,
        stepping: DgStepping,
    ) -> Self {
        Self {
            level: simulation.level().clone(),
            // The blocks of a step are dense in time.
            patience: Patience::new(simulation.space().blocks() * (stepping.degree + 1).pow(2)),
            simulation,
            theta_a: beam.theta_a,
            obstacles,
            wall: Duration::ZERO,
        }
    }

    /// The simulation.
    pub(crate) fn simulation(&self) -> &Dg {
        &self.simulation
    }
}

impl ObservableMotion for DgMotion {
    fn motion(&self) -> &dyn Motion {
        &self.simulation
    }

    #[expect(clippy::disallowed_methods, reason = "the loop steps by it")]
    fn step(&mut self, until: f64) -> Result<Option<StepReport>, RunError> {
        let Self {
            simulation,
            patience,
            wall,
            ..
        } = self;
        patience.check(simulation.steps(), || simulation.t())?;
        let started = Instant::now();
        let outcome = simulation.step(until);
        *wall += started.elapsed();
        let report = outcome?;
        if let Some(report) = &report {
            patience.also(report.iterations.saturating_sub(1));
        }
        Ok(report)
    }

    fn sample(&mut self) -> Sample {
        self.inside(self.simulation.t())
    }

    fn inside(&mut self, t: f64) -> Sample {
        let Self {
            simulation, level, ..
        } = self;
        simulation.level_into(t, level);
        let end = level.values_and_slopes(simulation.space(), 1.0);
        let [u_tip, phi_tip, u_t_tip, phi_t_tip, _] = end.map(|(value, _)| value);
        let (theta, _) = level.value_and_slope(simulation.space(), Field::Theta, 0.5);
        Sample {
            t,
            u_tip,
            phi_tip,
            u_t_tip,
            phi_t_tip,
            theta_mid: theta + 0.5 * self.theta_a,
            contact_force: self
                .obstacles
                .map_or(0.0, |obstacles| obstacles.force(u_tip)),
            energy: simulation.energy(level).total(),
        }
    }

    fn balance(&self) -> Result<Balance, Loaded> {
        self.refuse_loads(BALANCE)?;
        Ok(self.simulation.balance())
    }

    fn wall(&self) -> Duration {
        self.wall
    }

    fn dg(&self) -> Option<&Dg> {
        Some(&self.simulation)
    }

    fn energy_size(&self) -> EnergySize {
        EnergySize {
            terms: self.simulation.energy_scale(),
            rounding: self.simulation.rounding(),
            is_solved: true,
        }
    }

    fn parts(&self, t_end: f64, count: usize) -> Vec<f64> {
        let (from, to) = (self.simulation.old_level().t, self.simulation.t());
        let first = (from / t_end * count as f64).floor() as usize;
        (first.max(1)..=count)
            .map(|k| equidistant_time(t_end, k, count))
            .skip_while(|&t| t <= from)
            .take_while(|&t| t <= to)
            .collect()
    }

    fn rows(&self) -> usize {
        ROWS
    }

    fn points(&self) -> Vec<f64> {
        let last = MOST_POINTS - 1;
        (0..=last).map(|i| i as f64 / last as f64).collect()
    }

    fn shape(&self, t: f64) -> Vec<f64> {
        let points = self.points().into_iter();
        let shape = points.map(|x| self.simulation.value(Field::U, x, t).unwrap_or(f64::NAN));
        shape.collect()
    }

    fn on(&self, mesh: &Mesh) -> TimeLevel {
        let simulation = &self.simulation;
        nodal(simulation.space(), simulation.level(), mesh.nodes())
    }
}
