//! Newton's method on the whole step.
//!
//! # A step is one scalar equation
//!
//! For a given mean axial force m the step (3.7)-(3.8) is linear except at the tip, where it is
//! solved in closed form. So a step is a root of `F(m) = m - ½(N(u(m)) + N(u0))`. F <= 0 at
//! `m = ½(β + N(u0))`, and F → ∞ with m: a bracket exists.
//!
//! # Two iterations
//!
//! *Kept factorisation.* Start from velocities and N extrapolated in time (third order), do one
//! pass with the factorisation of an earlier step, and accept if the a-posteriori error bound of
//! `bound.rs` is below the tolerance. Most steps take one pass. The rank-one term of the Kirchhoff
//! force in the Jacobian is omitted; the bound accounts for its effect.
//!
//! *Safeguarded Newton* (`root.rs`), if that iteration would not contract: Newton's method for F,
//! with F'(m) from one more solve (Kirchhoff term as a rank-one change, contact as a change of the
//! tip's pivot), and bisection if an iterate leaves the bracket.

use crate::block_tridiagonal::{NodeFactors, factorize, uninitialised};
use crate::error::StepFailure;
use crate::lanes::{Kernel, Lane, MultiplyAdd, run_kernel};
use crate::motion::{StepReport, Work};
use crate::scheme::SteppedBeam;
use crate::solve::control::{Control, ElementLengths, Progress, Scalars};
use crate::solve::stepper::{Batch, Stepper};
use crate::solve::{Settings, Start, TimeLevel};

/// Passes with the kept factorisation before the safeguarded iteration takes over.
const KEPT_PASSES: usize = 6;
/// Largest contribution of a kept factorisation to the contraction bound q: renewing it costs about
/// ten passes.
const RENEWAL: f64 = 0.1;
/// Largest contraction bound q for which passes with the kept factorisation continue.
const CONTRACTION: f64 = 0.25;

/// Newton's method for one case per lane, with or without the temperature.
///
/// * `cases`, `levels`: one per lane, with the same scheme; all levels have the same number of
///   nodes.
/// * `heated`: whether the temperature is an unknown. Without it the temperature must be zero.
pub(crate) fn newton<T: Lane + 'static>(
    cases: Vec<SteppedBeam>,
    settings: Settings,
    levels: &[&TimeLevel],
    heated: bool,
) -> Box<dyn Batch<T>> {
    if heated {
        Box::new(Newton::<T, 3>::new(cases, settings, levels))
    } else {
        Box::new(Newton::<T, 2>::new(cases, settings, levels))
    }
}

/// Newton's method for one case (`T = f64`) or several in lanes; B = 2 without, B = 3 with the
/// temperature.
pub(crate) struct Newton<T, const B: usize> {
    pub(super) cases: Vec<SteppedBeam>,
    /// Bound on the increment of one more iteration.
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
    first_iterate: Start,
    pub(super) scalars: Scalars<T>,
    pub(super) elements: Vec<ElementLengths<T>>,
    /// The factorisation.
    pub(super) nodes: Vec<NodeFactors<T, B>>,
    /// (u, φ, θ~) at the old level.
    pub(super) old: Vec<[T; B]>,
    /// (u, φ, θ~) of the iterate.
    pub(super) new: Vec<[T; B]>,
    /// (v, w, -) at the old and at the new level; empty if V is the new velocity itself.
    pub(super) velocity: [Vec<[T; B]>; 2],
    /// The scheme's inertia: `v = v0 + weight (V - v0)`.
    weight: T,
    /// X of the current step and of the previous three; at the start, the initial velocities and
    /// temperature.
    pub(super) iterates: [Vec<[T; B]>; 4],
    /// The right-hand side after the forward sweep.
    pub(super) middle: Vec<[T; B]>,
    /// The loads, or empty.
    pub(super) load: Vec<[T; 3]>,
    pub(super) controls: Vec<Control>,
    /// The last level of the cases that have failed.
    pub(super) failed_levels: Vec<Option<TimeLevel>>,
    /// Passes over all lanes.
    passes: usize,
}

/// The coefficients of the cases in lanes.
fn scalars<T: Lane>(cases: &[SteppedBeam]) -> Scalars<T> {
    Scalars {
        dt: in_lanes(cases, |case| case.dt),
        half_dt: in_lanes(cases, |case| 0.5 * case.dt),
        zeta: in_lanes(cases, |case| case.beam.zeta),
        stiff: in_lanes(cases, |case| case.beam.zeta + 0.5 * case.dt),
        inertia: in_lanes(cases, |case| case.scheme.inertia / case.dt),
        two_over_dt: in_lanes(cases, |case| 2.0 / case.dt),
        half_a: in_lanes(cases, |case| 0.5 * case.beam.a),
        lift: in_lanes(cases, |case| case.beam.a * case.beam.theta_a),
    }
}

/// A number of each case.
fn in_lanes<T: Lane, C>(cases: &[C], value: impl Fn(&C) -> f64) -> T {
    T::from_fn(|k| value(&cases[k]))
}

/// Element i of the cases.
fn element<T: Lane>(cases: &[SteppedBeam], i: usize) -> ElementLengths<T> {
    ElementLengths {
        inverse: in_lanes(cases, |case| 1.0 / case.lengths[i]),
        sixth: in_lanes(cases, |case| case.lengths[i] / 6.0),
    }
}

impl<T: Lane, const B: usize> Newton<T, B> {
    /// The stepper at the given levels.
    ///
    /// Arguments as for [`newton`].
    pub(crate) fn new(cases: Vec<SteppedBeam>, settings: Settings, levels: &[&TimeLevel]) -> Self {
        let n = cases[0].lengths.len();
        let scheme = cases[0].scheme;
        // Entry 0, of the clamped end, is not read.
        let elements = (0..=n)
            .map(|i| element(&cases, i.saturating_sub(1)))
            .collect();
        let zeros = vec![[T::splat(0.0); B]; n + 1];
        let mut old = zeros.clone();
        let mut start = zeros.clone();
        for (i, (old, start)) in old.iter_mut().zip(&mut start).enumerate() {
            let theta = in_lanes(levels, |level| level.theta[i]);
            let state = [
                in_lanes(levels, |level| level.u[i]),
                in_lanes(levels, |level| level.phi[i]),
            ];
            let velocity = [
                in_lanes(levels, |level| level.v[i]),
                in_lanes(levels, |level| level.w[i]),
            ];
            *old = std::array::from_fn(|c| if c == 2 { theta } else { state[c] });
            // The initial temperature is the first guess of the mean temperature.
            *start = std::array::from_fn(|c| if c == 2 { theta } else { velocity[c] });
        }
        let velocity = if scheme.inertia == 1.0 {
            [vec![], vec![]]
        } else {
            [start.clone(), zeros.clone()]
        };
        let controls = (0..T::WIDTH)
            .map(|k| Control::new(&cases[k], levels[k]))
            .collect();
        Self {
            nodes: uninitialised(n),
            elements,
            new: zeros.clone(),
            iterates: [zeros.clone(), start.clone(), start.clone(), start],
            middle: zeros.clone(),
            load: vec![],
            old,
            velocity,
            weight: T::splat(scheme.inertia),
            controls,
            failed_levels: vec![None; cases.len()],
            scalars: scalars(&cases),
            // An iteration without a test is refused for Newton's method.
            tolerance: settings.stopping.tolerance().unwrap_or(0.0),
            max_iterations: settings.stopping.max_iterations(),
            first_iterate: settings.start,
            cases,
            passes: 0,
        }
    }

    /// Sets m from the extrapolated axial force, and renews the factorisation if that is too far
    /// from m.
    fn start(&mut self, k: usize) {
        let beam = self.cases[k].beam;
        let weights = self.weights();
        let control = &mut self.controls[k];
        let [n1, n2, n3] = control.forces;
        // N >= β, but an extrapolated value may be smaller.
        let predicted = (weights[0] * n1 + (weights[1] * n2 + weights[2] * n3)).max(beam.beta);
        control.m = 0.5 * (predicted + n1);
        control.iterations = 0;
        control.increment = f64::NAN;
        control.state = Progress::Iterating;
        let m = control.m;
        // NaN in the first step, which has no factorisation yet: the comparison then renews it.
        if !(self.kept_contraction(k, m) <= RENEWAL) && self.factorize(k, m).is_err() {
            // The predicted force may lie below the buckling force although the solution does not.
            self.controls[k].state = Progress::NeedsSafeguard;
        }
    }

    /// Weights of the last three levels in the initial iterate.
    pub(super) fn weights(&self) -> [f64; 3] {
        match self.first_iterate {
            Start::Previous => [1.0, 0.0, 0.0],
            Start::Extrapolated => [3.0, -3.0, 1.0],
        }
    }

    /// Whether a case is in this state.
    fn any(&self, state: Progress) -> bool {
        self.controls.iter().any(|control| control.state == state)
    }

    /// Factorises A(m) for case k.
    pub(super) fn factorize(&mut self, k: usize, m: f64) -> Result<(), StepFailure> {
        let scalars = scalars::<f64>(&self.cases[k..=k]);
        let count = self.elements.len();
        let elements = &self.elements;
        self.controls[k].work.factorizations += 1;
        // Invalid until the elimination has succeeded.
        self.controls[k].factorized = f64::NAN;
        factorize(&mut self.nodes, k, m, |i| {
            let right = (i + 1 < count).then(|| elements[i + 1].of_lane(k));
            scalars.blocks(m, elements[i].of_lane(k), right)
        })?;
        self.controls[k].factorized = m;
        Ok(())
    }

    /// Does one pass, a solve of `A(m̄) δ = -R`, for the cases in `state`; the iterates of the
    /// others stay.
    pub(super) fn pass(&mut self, state: Progress, first: bool) {
        let active = T::from_fn(|k| f64::from(self.controls[k].state == state));
        let m = T::from_fn(|k| self.controls[k].m);
        self.passes += 1;
        run_kernel(Forward {
            newton: self,
            m,
            first,
        });
        let tip = self.solve_tip(active);
        let [slope_squared, increment_squared] = run_kernel(Backward {
            newton: self,
            active,
            tip,
        });
        for (k, control) in self
            .controls
            .iter_mut()
            .enumerate()
            .filter(|(_, control)| control.state == state)
        {
            control.iterations += 1;
            control.work.passes += 1;
            control.new_slope_squared = slope_squared.lane(k);
            control.increment_slope = increment_squared.lane(k).sqrt();
        }
    }

    /// δ at the tip: the solution without contact, minus `F S⁻¹ e` with the contact force F in
    /// closed form.
    fn solve_tip(&mut self, active: T) -> [T; B] {
        let last = self.elements.len() - 1;
        let inverse = &self.nodes[last].inverse;
        let mut delta = self.middle[last];
        for k in 0..T::WIDTH {
            let Some(obstacles) = self.cases[k].obstacles else {
                continue;
            };
            if active.lane(k) == 0.0 {
                continue;
            }
            let (dt, u0) = (self.cases[k].dt, self.old[last][0].lane(k));
            let free = u0 + dt * (self.iterates[0][last][0].lane(k) + delta[0].lane(k));
            let tip = obstacles.solve_tip(
                self.cases[k].scheme.contact,
                free,
                dt * inverse[0][0].lane(k),
                u0,
            );
            self.controls[k].tip = tip;
            for (component, row) in delta.iter_mut().zip(inverse) {
                component.set_lane(k, component.lane(k) - tip.force * row[0].lane(k));
            }
        }
        delta
    }

    /// Accepts a case, sets m for another pass, or leaves the case to the safeguarded iteration.
    fn judge(&mut self, k: usize) {
        let bound = self.bound(k);
        let control = &mut self.controls[k];
        control.increment = bound.increment;
        if bound.remaining <= self.tolerance {
            control.state = Progress::Accepted;
        } else if bound.contraction <= CONTRACTION {
            control.m = bound.m;
        } else {
            // Also for NaN: the safeguarded iteration restarts from the initial iterate.
            control.state = Progress::NeedsSafeguard;
        }
    }

    /// Stores the outcome of the safeguarded iteration of case k.
    fn conclude(
        &mut self,
        k: usize,
        outcome: Result<(), StepFailure>,
        report: &mut [Result<StepReport, StepFailure>],
    ) {
        self.controls[k].state = if outcome.is_ok() {
            Progress::Accepted
        } else {
            Progress::Failed
        };
        if let Err(failure) = outcome {
            report[k] = Err(failure);
            if T::WIDTH > 1 {
                let mut level = TimeLevel::new(self.old.len());
                self.read(k, &mut level);
                self.failed_levels[k] = Some(level);
            }
        }
    }

    /// Makes the accepted iterate the new level: û and φ̂ of (3.7), u and φ of (3.8).
    fn commit(&mut self, report: &mut [Result<StepReport, StepFailure>]) {
        for (k, control) in self.controls.iter_mut().enumerate() {
            if control.state != Progress::Accepted {
                continue;
            }
            control.slope_squared = control.new_slope_squared;
            control.force = control.tip.force;
            let [n1, n2, _] = control.forces;
            control.forces = [
                self.cases[k].beam.axial_force(control.slope_squared),
                n1,
                n2,
            ];
            report[k] = Ok(StepReport {
                dt: self.cases[k].dt,
                iterations: control.iterations,
                increment: control.increment,
                contraction: None,
                in_contact: control.force != 0.0,
                event: None,
            });
        }
        if let [old, new] = &mut self.velocity
            && !old.is_empty()
        {
            // In this order it is v = 2 V - v0 to the bit for the midpoint rule.
            let (weight, rest) = (self.weight, T::splat(1.0) - self.weight);
            for ((new, old), x) in new.iter_mut().zip(old.iter()).zip(&self.iterates[0]) {
                *new = std::array::from_fn(|c| weight * x[c] + rest * old[c]);
            }
            std::mem::swap(old, new);
        }
        std::mem::swap(&mut self.old, &mut self.new);
        self.iterates.rotate_right(1);
    }
}

/// The forward sweep of a pass.
struct Forward<'n, T, const B: usize> {
    newton: &'n mut Newton<T, B>,
    m: T,
    first: bool,
}

impl<T: Lane, const B: usize> Kernel for Forward<'_, T, B> {
    type Output = ();

    #[inline(always)]
    fn run<A: MultiplyAdd>(self) {
        let Self { newton, m, first } = self;
        match (first, !newton.load.is_empty()) {
            (true, false) => newton.forward::<A, true, false>(m),
            (true, true) => newton.forward::<A, true, true>(m),
            (false, false) => newton.forward::<A, false, false>(m),
            (false, true) => newton.forward::<A, false, true>(m),
        }
    }
}

/// The backward sweep of a pass.
struct Backward<'n, T, const B: usize> {
    newton: &'n mut Newton<T, B>,
    active: T,
    tip: [T; B],
}

impl<T: Lane, const B: usize> Kernel for Backward<'_, T, B> {
    type Output = [T; 2];

    #[inline(always)]
    fn run<A: MultiplyAdd>(self) -> [T; 2] {
        self.newton.backward::<A>(self.active, self.tip)
    }
}

impl<T: Lane, const B: usize> Stepper<T> for Newton<T, B> {
    fn load_mut(&mut self) -> &mut [[T; 3]] {
        if self.load.is_empty() {
            self.load = vec![[T::splat(0.0); 3]; self.old.len()];
        }
        &mut self.load
    }

    fn advance(&mut self, report: &mut [Result<StepReport, StepFailure>]) {
        for k in 0..T::WIDTH {
            if T::WIDTH == 1 || self.controls[k].state != Progress::Failed {
                self.start(k);
            }
        }
        let mut first = true;
        for _ in 0..KEPT_PASSES.min(self.max_iterations) {
            if !self.any(Progress::Iterating) {
                break;
            }
            self.pass(Progress::Iterating, first);
            first = false;
            for k in 0..T::WIDTH {
                if self.controls[k].state == Progress::Iterating {
                    self.judge(k);
                }
            }
        }
        for k in 0..T::WIDTH {
            if matches!(
                self.controls[k].state,
                Progress::Iterating | Progress::NeedsSafeguard
            ) {
                let outcome = self.find_root(k);
                self.conclude(k, outcome, report);
            }
        }
        if self.any(Progress::Accepted) {
            self.commit(report);
        }
    }

    fn read(&self, k: usize, level: &mut TimeLevel) {
        if let Some(level_before) = &self.failed_levels[k] {
            level.copy_from(level_before);
            return;
        }
        let velocity = if self.velocity[0].is_empty() {
            &self.iterates[1]
        } else {
            &self.velocity[0]
        };
        for (i, (state, velocity)) in self.old.iter().zip(velocity).enumerate() {
            level.u[i] = state[0].lane(k);
            level.phi[i] = state[1].lane(k);
            level.theta[i] = if B == 3 { state[2].lane(k) } else { 0.0 };
            level.v[i] = velocity[0].lane(k);
            level.w[i] = velocity[1].lane(k);
        }
        level.contact_force = self.controls[k].force;
    }

    fn tip(&self, k: usize) -> f64 {
        let tip = self.old.len() - 1;
        self.failed_levels[k]
            .as_ref()
            .map_or(self.old[tip][0].lane(k), |level| level.u[tip])
    }

    fn work(&self) -> Work {
        let factorizations = self
            .controls
            .iter()
            .map(|control| control.work.factorizations)
            .sum();
        Work {
            passes: self.passes,
            factorizations,
        }
    }
}
