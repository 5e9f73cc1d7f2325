//! The motion of a scene by dG.

use std::time::{Duration, Instant};

use convergence_study::run::time_limit::Patience;
use thermobeam::dg::{self, ContactEvent, Field, Phase};
use thermobeam::energy::Balance;
use thermobeam::error::SetupError;
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::solve::Level;

use super::tally::EnergySize;
use super::{Motion, Report, RunError, Sample, Solves};
use crate::exact::any_order;
use crate::exact::defect::Defect;
use crate::exact::solution::Manufactured;
use crate::scene::{Coefficients, Scene};

/// Maximum number of times of a history by dG: more than a figure has columns.
const ROWS: usize = 4000;

/// Points of a frame by dG.
const POINTS: usize = 141;

/// A problem by dG.
pub(crate) struct DgMotion {
    simulation: dg::Simulation,
    theta_a: f64,
    obstacles: Option<Obstacles>,
    level: dg::Level,
    patience: Patience,
    wall: Duration,
}

impl DgMotion {
    /// Starts at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] if the solver refuses the scene's numbers.
    pub(crate) fn new(scene: &Scene, stepping: dg::Stepping) -> Result<Self, SetupError> {
        let simulation = dg::Simulation::new(scene.dg_problem(), stepping)?;
        Ok(Self::of(simulation, &scene.beam, scene.obstacles, stepping))
    }

    /// A manufactured solution at t = 0.
    ///
    /// * `loads`: the coefficients of the loads that keep it in place; a free vibration of a cold beam needs none.
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
        by: dg::Stepping,
    ) -> Result<Self, SetupError> {
        // A clamped end that is too hot is so from the start: the initial data must match it, or the first step fails.
        let exact_theta_a = loads.map_or(0.0, |theory| theory.beam.theta_a);
        let shift = beam.theta_a - exact_theta_a;
        let start = any_order::initial(exact);
        let theta = start.theta;
        let missing = if defect == Some(Defect::StartNotLifted) {
            exact_theta_a
        } else {
            0.0
        };
        // The value at x = 0 stays: the solver refuses initial data that contradict the boundary conditions.
        let planted =
            move |x: f64| theta(x) + (if x == 0.0 { shift } else { shift - missing }) * (1.0 - x);
        let initial = dg::Initial {
            theta: Box::new(planted),
            ..start
        };
        let problem = dg::Problem {
            beam,
            obstacles,
            mesh,
            degree,
            initial,
        };
        let simulation = match loads {
            None => dg::Simulation::new(problem, by),
            Some(theory) => dg::Simulation::with_load(problem, by, |space| {
                any_order::load(exact, &theory.beam, theory.obstacles, space, defect)
            }),
        }?;
        Ok(Self::of(simulation, &beam, obstacles, by))
    }

    fn of(
        simulation: dg::Simulation,
        beam: &Beam,
        obstacles: Option<Obstacles>,
        by: dg::Stepping,
    ) -> Self {
        Self {
            level: simulation.level().clone(),
            // The blocks of a step are dense in time.
            patience: Patience::new(simulation.space().blocks() * (by.degree + 1).pow(2)),
            simulation,
            theta_a: beam.theta_a,
            obstacles,
            wall: Duration::ZERO,
        }
    }

    /// The simulation.
    pub(crate) fn simulation(&self) -> &dg::Simulation {
        &self.simulation
    }
}

impl Motion for DgMotion {
    fn step(&mut self, until: f64) -> Result<Option<Report>, RunError> {
        let Self {
            simulation,
            patience,
            wall,
            ..
        } = self;
        patience.check(simulation.work().steps, || simulation.t())?;
        let started = Instant::now();
        let outcome = simulation.step(until);
        *wall += started.elapsed();
        Ok(outcome?.map(|done| {
            patience.also(done.iterations.saturating_sub(1));
            let phase = done.event.map_or(simulation.phase(), |event| event.from);
            Report {
                dt: done.dt,
                iterations: done.iterations,
                contraction: None,
                in_contact: phase != Phase::Free,
                unsound: None,
            }
        }))
    }

    fn t(&self) -> f64 {
        self.simulation.t()
    }

    fn steps(&self) -> usize {
        self.simulation.work().steps
    }

    fn at(&mut self, t: f64) -> Sample {
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

    fn parts(&self, t_end: f64, count: usize) -> Vec<f64> {
        let (from, to) = (self.simulation.old_level().t, self.simulation.t());
        let time = |k: usize| {
            if k == count {
                t_end
            } else {
                t_end * k as f64 / count as f64
            }
        };
        let first = (from / t_end * count as f64).floor() as usize;
        (first.max(1)..=count)
            .map(time)
            .skip_while(|&t| t <= from)
            .take_while(|&t| t <= to)
            .collect()
    }

    fn rows(&self) -> usize {
        ROWS
    }

    fn points(&self) -> Vec<f64> {
        (0..POINTS)
            .map(|i| i as f64 / (POINTS - 1) as f64)
            .collect()
    }

    fn shape(&self, t: f64) -> Vec<f64> {
        let u = |x: f64| self.simulation.value(Field::U, x, t).unwrap_or(f64::NAN);
        self.points().into_iter().map(u).collect()
    }

    fn on(&self, mesh: &Mesh) -> Level {
        nodal(
            self.simulation.space(),
            self.simulation.level(),
            mesh.nodes(),
        )
    }

    fn extremes(&self) -> [f64; 2] {
        self.simulation.tip_range()
    }

    fn balance(&self) -> Balance {
        self.simulation.balance()
    }

    fn energy_size(&self) -> EnergySize {
        let [terms, rounding] = [self.simulation.energy_scale(), self.simulation.rounding()];
        EnergySize { terms, rounding }
    }

    fn solves(&self) -> Solves {
        let dg::Work {
            solves,
            factorizations,
            ..
        } = self.simulation.work();
        Solves {
            passes: solves,
            factorizations,
        }
    }

    fn wall(&self) -> Duration {
        self.wall
    }

    fn contact(&self) -> Option<(Phase, &[ContactEvent])> {
        Some((self.simulation.phase(), self.simulation.events()))
    }
}

/// A level of any order by its values at the nodes, without the contact force.
pub(crate) fn nodal(space: &dg::Space, level: &dg::Level, nodes: &[f64]) -> Level {
    let mut nodal = Level {
        u: Vec::with_capacity(nodes.len()),
        v: Vec::with_capacity(nodes.len()),
        phi: Vec::with_capacity(nodes.len()),
        w: Vec::with_capacity(nodes.len()),
        theta: Vec::with_capacity(nodes.len()),
        contact_force: 0.0,
    };
    for &x in nodes {
        let [u, phi, v, w, theta] = level.values_and_slopes(space, x).map(|(value, _)| value);
        nodal.u.push(u);
        nodal.phi.push(phi);
        nodal.v.push(v);
        nodal.w.push(w);
        nodal.theta.push(theta);
    }
    nodal
}
