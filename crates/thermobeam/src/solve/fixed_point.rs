//! The paper's fixed-point iteration (4.1)-(4.5): the problem (4.2) is solved for θ, φ and u, in
//! this order.
//!
//! One iteration ℓ solves three scalar tridiagonal systems, the three equations of (4.2). In the
//! notation of `sweeps.rs`, with the previous iterate marked by ⁻ and n-½ and the update of u and φ
//! as in (4.3):
//!
//! ```text
//! (2/dt M + K) Θ         = 2/dt M θ~0 - a Cᵀ W⁻ + F_θ
//! ((κ + s) M + s K) W    = κ M w0 - (K + M) φ0 + Cᵀ(u½⁻ + ζ V⁻) + a C Θ + a θ_A C (1 - x) + F_φ
//! (κ M + (ζ + (1 + m⁻) dt/2) K) V = κ M v0 - (1 + m⁻) K u0 + C (φ0 + s W) - F(u⁻(1)) e + F_u
//! ```
//!
//! The increment is measured in the norm of (3.14); [`theory`](crate::theory), "The norm of the
//! stopping test", says why. The convergence is analysed in [`contraction`](crate::contraction).

use crate::error::{Loop, StepFailure};
use crate::motion::{StepReport, Work};
use crate::norms::{TheoremSquares, slope_squared};
use crate::scheme::{ContactRule, SteppedBeam};
use crate::solve::stepper::Stepper;
use crate::solve::{Settings, Stopping, TimeLevel};
use crate::tridiagonal::TridiagonalFactor;

/// Ratio of the last two increments above which the iteration counts as diverging. In a cycle, for
/// example between both sides of an obstacle, the ratio is one up to round-off.
const STALLED: f64 = 1.0 - 1e-6;

/// The fixed-point iteration for one case.
pub(crate) struct FixedPoint {
    case: SteppedBeam,
    stopping: Stopping,
    old: TimeLevel,
    /// V, W, Θ of the current and of the previous iterate.
    now: Iterate,
    before: Iterate,
    /// u^{n,ℓ-1}; u^{n-1} in the first iteration, by (4.1).
    u_before: Vec<f64>,
    force: f64,
    load: Vec<[f64; 3]>,
    factor_u: TridiagonalFactor,
    factor_phi: TridiagonalFactor,
    factor_theta: TridiagonalFactor,
    /// Differences of the last two iterates, for the increment.
    difference: [Vec<f64>; 5],
    work: Work,
}

/// The unknowns of a step.
#[derive(Clone)]
struct Iterate {
    v: Vec<f64>,
    w: Vec<f64>,
    theta: Vec<f64>,
}

impl FixedPoint {
    /// The iteration at the given level, with the matrices of θ and φ factorised.
    ///
    /// # Errors
    /// [`StepFailure::Indefinite`] if a matrix is not positive definite in floating-point
    /// arithmetic: dt is too small or too large.
    pub(crate) fn new(
        case: SteppedBeam,
        settings: Settings,
        level: &TimeLevel,
    ) -> Result<Self, StepFailure> {
        let n = case.lengths.len();
        let (kappa, s) = (
            case.scheme.inertia / case.dt,
            case.beam.zeta + 0.5 * case.dt,
        );
        let mut factor_phi = TridiagonalFactor::new(n);
        factor_phi.factorize(&case.lengths, kappa + s, s, 0.0)?;
        let mut factor_theta = TridiagonalFactor::new(n - 1);
        factor_theta.factorize(&case.lengths, 2.0 / case.dt, 1.0, 0.0)?;
        let iterate = Iterate {
            v: level.v.clone(),
            w: level.w.clone(),
            theta: level.theta.clone(),
        };
        Ok(Self {
            stopping: settings.stopping,
            old: level.clone(),
            now: iterate.clone(),
            before: iterate,
            u_before: level.u.clone(),
            force: 0.0,
            load: vec![],
            factor_u: TridiagonalFactor::new(n),
            factor_phi,
            factor_theta,
            difference: std::array::from_fn(|_| vec![0.0; n + 1]),
            work: Work::default(),
            case,
        })
    }

    /// Does one step; if it fails, the level stays unchanged.
    fn step(&mut self) -> Result<StepReport, StepFailure> {
        self.start();
        let (mut increment, mut contraction) = (f64::NAN, f64::NAN);
        let iterations = self.stopping.max_iterations();
        for iteration in 1..=iterations {
            self.iterate()?;
            let previous = increment;
            increment = self.increment(iteration);
            if !increment.is_finite() {
                return Err(StepFailure::NonFinite {
                    iterations: iteration,
                    increment: previous,
                });
            }
            contraction = increment / previous;
            let ends = match self.stopping {
                Stopping::Converged { tolerance, .. } => increment <= tolerance,
                Stopping::Iterations(last) => iteration == last,
            };
            if ends {
                self.commit();
                let contraction = contraction.is_finite().then_some(contraction);
                return Ok(StepReport {
                    dt: self.case.dt,
                    iterations: iteration,
                    increment,
                    contraction,
                    in_contact: self.force != 0.0,
                    event: None,
                });
            }
            self.remember();
        }
        // NaN, after a single iteration, does not indicate divergence.
        if contraction >= STALLED {
            Err(StepFailure::Diverged {
                iterations,
                increment,
                contraction,
                of: Some(self.largest_loop()),
            })
        } else {
            Err(StepFailure::IterationLimit {
                iterations,
                increment,
                contraction,
            })
        }
    }

    /// The loop with the largest factor at the initial level of the step, in contact if the last
    /// iterate is.
    fn largest_loop(&self) -> Loop {
        let tip = self.u_before[self.case.lengths.len()];
        let obstacles = self
            .case
            .obstacles
            .filter(|obstacles| self.force != 0.0 || obstacles.force(tip) != 0.0);
        SteppedBeam {
            obstacles,
            ..self.case.clone()
        }
        .contraction(&self.old.u)
        .1
    }

    /// Sets the initial iterate to the previous level, (4.1).
    fn start(&mut self) {
        self.before.v.clone_from(&self.old.v);
        self.before.w.clone_from(&self.old.w);
        self.before.theta.clone_from(&self.old.theta);
        self.u_before.clone_from(&self.old.u);
    }

    /// One iteration of (4.2).
    fn iterate(&mut self) -> Result<(), StepFailure> {
        self.work.passes += 1;
        self.solve_theta();
        self.solve_phi();
        self.solve_u()
    }

    /// Third equation of (4.2), for Θ.
    fn solve_theta(&mut self) {
        let lengths = &self.case.lengths;
        let a = self.case.beam.a;
        let two_over_dt = 2.0 / self.case.dt;
        let n = lengths.len();
        let theta = &mut self.now.theta;
        theta.fill(0.0);
        for (i, h) in lengths.iter().enumerate() {
            let (t, w) = (&self.old.theta[i..=i + 1], &self.before.w[i..=i + 1]);
            let heating = 0.5 * a * (w[1] - w[0]);
            let mass = two_over_dt * h / 6.0;
            theta[i] += mass * (2.0 * t[0] + t[1]) - heating;
            theta[i + 1] += mass * (t[0] + 2.0 * t[1]) - heating;
        }
        add_load(theta, &self.load, 2);
        self.factor_theta.solve_in_place(theta);
        (theta[0], theta[n]) = (0.0, 0.0);
    }

    /// Second equation of (4.2), for W.
    fn solve_phi(&mut self) {
        let SteppedBeam {
            beam,
            scheme,
            dt,
            lengths,
            ..
        } = &self.case;
        let kappa = scheme.inertia / dt;
        let w = &mut self.now.w;
        w.fill(0.0);
        for (i, &h) in lengths.iter().enumerate() {
            let ends = [i, i + 1];
            let phi = ends.map(|j| self.old.phi[j]);
            let theta = ends.map(|j| self.now.theta[j]);
            let slope = ends
                .map(|j| 0.5 * (self.old.u[j] + self.u_before[j]) + beam.zeta * self.before.v[j]);
            let mass =
                ends.map(|j| kappa * self.old.w[j] - self.old.phi[j] + beam.a * beam.theta_a);
            let shear = 0.5 * (slope[1] - slope[0]);
            let moment = (phi[1] - phi[0]) / h - 0.5 * beam.a * (theta[0] + theta[1]);
            w[i] += h / 6.0 * (2.0 * mass[0] + mass[1]) + shear + moment;
            w[i + 1] += h / 6.0 * (mass[0] + 2.0 * mass[1]) + shear - moment;
        }
        add_load(w, &self.load, 1);
        w[0] = 0.0;
        self.factor_phi.solve_in_place(w);
    }

    /// First equation of (4.2), for V, with N(u) and g(u) of the previous iterate.
    fn solve_u(&mut self) -> Result<(), StepFailure> {
        let SteppedBeam {
            beam,
            dt,
            lengths,
            obstacles,
            scheme,
        } = &self.case;
        let n = lengths.len();
        let kappa = scheme.inertia / dt;
        let s = beam.zeta + 0.5 * dt;
        let before = beam.axial_force(slope_squared(lengths, &self.u_before));
        let old = beam.axial_force(slope_squared(lengths, &self.old.u));
        let m = 0.5 * (before + old);
        self.work.factorizations += 1;
        self.factor_u
            .factorize(lengths, kappa, beam.zeta + 0.5 * (1.0 + m) * dt, m)?;
        let v = &mut self.now.v;
        v.fill(0.0);
        for (i, &h) in lengths.iter().enumerate() {
            let ends = [i, i + 1];
            let turn = ends.map(|j| self.old.phi[j] + s * self.now.w[j]);
            let stress =
                (1.0 + m) * (self.old.u[i + 1] - self.old.u[i]) / h - 0.5 * (turn[0] + turn[1]);
            let mass = ends.map(|j| kappa * self.old.v[j]);
            v[i] += h / 6.0 * (2.0 * mass[0] + mass[1]) + stress;
            v[i + 1] += h / 6.0 * (mass[0] + 2.0 * mass[1]) - stress;
        }
        add_load(v, &self.load, 0);
        if let Some(obstacles) = obstacles {
            self.force = match scheme.contact {
                ContactRule::Implicit => obstacles.force(self.u_before[n]),
                ContactRule::DiscreteGradient => {
                    obstacles.discrete_gradient(self.u_before[n], self.old.u[n])
                }
            };
            v[n] -= self.force;
        }
        v[0] = 0.0;
        self.factor_u.solve_in_place(v);
        Ok(())
    }

    /// Difference of the last two iterates of (û, u, φ̂, φ, θ) in the norm of (3.14); u and φ by
    /// (4.3).
    ///
    /// * `iteration`: its number ℓ, from 1.
    fn increment(&mut self, iteration: usize) -> f64 {
        let (dt, inertia) = (self.case.dt, self.case.scheme.inertia);
        let [v, u, w, phi, theta] = &mut self.difference;
        for i in 0..self.old.u.len() {
            let dw = self.now.w[i] - self.before.w[i];
            v[i] = inertia * (self.now.v[i] - self.before.v[i]);
            u[i] = self.old.u[i] + dt * self.now.v[i] - self.u_before[i];
            w[i] = inertia * dw;
            phi[i] = dt * dw;
            theta[i] = 2.0 * (self.now.theta[i] - self.before.theta[i]);
        }
        if iteration == 1 {
            // In the first iteration φ^{n,0} = φ^{n-1}, which is not φ^{n-1} + dt φ̂^{n,0}.
            for (phi, w) in phi.iter_mut().zip(&self.now.w) {
                *phi = dt * w;
            }
        }
        TheoremSquares::of(&self.case.lengths, v, u, w, phi, theta).norm()
    }

    /// Makes the current iterate the previous one, with u^{n,ℓ} by (4.3).
    fn remember(&mut self) {
        for (u, (u0, v)) in self
            .u_before
            .iter_mut()
            .zip(self.old.u.iter().zip(&self.now.v))
        {
            *u = u0 + self.case.dt * v;
        }
        std::mem::swap(&mut self.now, &mut self.before);
    }

    /// Makes the last iterate the new level, (4.5), with u and φ by (3.8).
    fn commit(&mut self) {
        let dt = self.case.dt;
        // The new velocity is V itself, or 2 V - v0 for the midpoint rule.
        let weight = self.case.scheme.inertia;
        for i in 0..self.old.u.len() {
            self.old.u[i] += dt * self.now.v[i];
            self.old.phi[i] += dt * self.now.w[i];
            self.old.v[i] = weight * self.now.v[i] + (1.0 - weight) * self.old.v[i];
            self.old.w[i] = weight * self.now.w[i] + (1.0 - weight) * self.old.w[i];
            self.old.theta[i] = 2.0 * self.now.theta[i] - self.old.theta[i];
        }
        self.old.contact_force = self.force;
    }
}

impl Stepper<f64> for FixedPoint {
    fn advance(&mut self, outcomes: &mut [Result<StepReport, StepFailure>]) {
        outcomes[0] = self.step();
    }

    fn load_mut(&mut self) -> &mut [[f64; 3]] {
        if self.load.is_empty() {
            self.load = vec![[0.0; 3]; self.old.u.len()];
        }
        &mut self.load
    }

    fn read(&self, _: usize, level: &mut TimeLevel) {
        level.copy_from(&self.old);
    }

    fn tip(&self, _: usize) -> f64 {
        self.old.u[self.old.u.len() - 1]
    }

    fn work(&self) -> Work {
        self.work
    }
}

/// Adds one component of the loads to a right-hand side.
fn add_load(right: &mut [f64], load: &[[f64; 3]], component: usize) {
    for (right, load) in right.iter_mut().zip(load) {
        *right += load[component];
    }
}
