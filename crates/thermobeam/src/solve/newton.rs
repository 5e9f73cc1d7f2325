//! Newton's method on the whole step.
//!
//! # A step is one scalar equation
//!
//! For a given mean axial force m the step is linear but for the tip, which is closed form. Hence a step is the root of
//! `F(m) = m - ½(N(u(m)) + N(u0))`. At `m = ½(β + N(u0))` F <= 0, and F → ∞ with m, so a bracket is always at hand.
//!
//! # Two ways to the root
//!
//! *Kept factor.* Start from the velocities and N extrapolated in time (third order), pass once with the factorisation
//! at hand, and accept if the a-posteriori bound of `bound.rs` is under the tolerance. Over most steps that is one pass. Newton's
//! rank-one change of the Kirchhoff term is left to the next pass here, for its effect is bounded and small.
//!
//! *Safeguarded Newton.* Where that would not contract: Newton on F, with F'(m) from one more solve (the Kirchhoff term
//! as a rank-one change, contact as a change of the tip's pivot), and bisection whenever it leaves the bracket.

use crate::block_tridiagonal::Factor;
use crate::contact::Tip;
use crate::error::StepFailure;
use crate::lanes::Lane;
use crate::parameters::{Beam, Obstacles};
use crate::scheme::Scheme;
use crate::solve::sweeps::{Backward, Element, Forward, Scalars, Sums};
use crate::solve::{Level, Settings, Start, StepReport, Work};

/// Passes with the kept factor before the safeguarded iteration takes over.
const KEPT_PASSES: usize = 6;
/// A kept factor is renewed once its part of q exceeds this: a renewal costs about ten passes.
const RENEWAL: f64 = 0.1;
/// Contraction factor up to which passes with the kept factor are trusted.
const CONTRACTION: f64 = 0.25;

/// One case of the batch: what may differ from lane to lane.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) beam: Beam,
    pub(crate) obstacles: Option<Obstacles>,
    pub(crate) dt: f64,
    /// Length of each element.
    pub(crate) lengths: Vec<f64>,
}

/// Where one case stands in its iteration, and the scalars that outlive a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Control {
    /// ‖u_x‖² at the old level.
    pub(super) slope_squared: f64,
    /// N at the latest three levels, latest first.
    pub(super) forces: [f64; 3],
    /// m̄ of the factorisation.
    pub(super) factorized: f64,
    /// m of the present pass.
    pub(super) m: f64,
    /// ‖u_x‖² of the iterate.
    pub(super) new_slope_squared: f64,
    /// ‖δV_x‖ of the last pass.
    pub(super) increment_slope: f64,
    pub(super) tip: Tip,
    /// The contact force of the step that led to the old level.
    pub(super) force: f64,
    pub(super) iterations: usize,
    /// Bound on the next increment.
    pub(super) increment: f64,
    pub(super) state: Progress,
    /// Passes that the case took part in, and its factorisations: what it would have taken alone.
    work: Work,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Progress {
    /// Passing with the kept factor.
    Iterating,
    Accepted,
    /// Waiting for the safeguarded iteration.
    NeedsSafeguard,
    /// In the safeguarded iteration, one case at a time.
    Safeguarded,
    Failed,
}

/// The stepper: one case (`T = f64`) or several in lanes; B = 2 without, 3 with temperature.
pub(crate) struct Newton<T, const B: usize> {
    pub(super) cases: Vec<Case>,
    pub(super) scheme: Scheme,
    pub(super) settings: Settings,
    scalars: Scalars<T>,
    pub(super) elements: Vec<Element<T>>,
    pub(super) factor: Factor<T, B>,
    /// (u, φ, θ~) at the old level, and room for the new one.
    pub(super) old: Vec<[T; B]>,
    pub(super) new: Vec<[T; B]>,
    /// (v, w, -) at the old level and room for the new one; kept only where V is not the new velocity itself.
    pub(super) velocity: [Vec<[T; B]>; 2],
    /// The scheme's inertia: `v = v0 + weight (V - v0)`.
    weight: T,
    /// X: the present step's first, then those of the steps before; the initial velocities where there was none.
    pub(super) ring: [Vec<[T; B]>; 4],
    pub(super) middle: Vec<[T; B]>,
    load: Vec<[T; B]>,
    pub(super) controls: Vec<Control>,
    /// The last good level of the cases that have failed.
    frozen: Vec<Option<Level>>,
    /// Passes of the lanes, whoever took part in them.
    passes: usize,
}

impl<T: Lane, const B: usize> Newton<T, B> {
    /// Starts from `initial[case][node] = (u, φ, θ~)` and `velocity[case][node] = (v, w)`; one time scheme and as many
    /// elements for all cases.
    pub(crate) fn new(
        cases: Vec<Case>,
        scheme: Scheme,
        settings: Settings,
        initial: &[Vec<[f64; 3]>],
        velocity: &[Vec<[f64; 2]>],
    ) -> Self {
        let each = |value: &dyn Fn(&Case) -> f64| T::from_fn(|k| value(&cases[k]));
        let scalars = Scalars {
            dt: each(&|c| c.dt),
            half_dt: each(&|c| 0.5 * c.dt),
            zeta: each(&|c| c.beam.zeta),
            stiff: each(&|c| c.beam.zeta + 0.5 * c.dt),
            inertia: each(&|c| scheme.inertia / c.dt),
            two_over_dt: each(&|c| 2.0 / c.dt),
            half_a: each(&|c| 0.5 * c.beam.a),
            lift: each(&|c| c.beam.a * c.beam.theta_a),
        };
        let n = cases[0].lengths.len();
        let element = |i: usize| Element {
            inverse: T::from_fn(|k| 1.0 / cases[k].lengths[i]),
            sixth: T::from_fn(|k| cases[k].lengths[i] / 6.0),
        };
        // Entry 0 stands for the clamped end and is never read.
        let elements = (0..=n).map(|i| element(i.saturating_sub(1))).collect();
        let zeros = vec![[T::splat(0.0); B]; n + 1];
        let mut old = zeros.clone();
        let mut start = zeros.clone();
        for (i, (old, start)) in old.iter_mut().zip(&mut start).enumerate() {
            *old = std::array::from_fn(|c| T::from_fn(|k| initial[k][i][c]));
            // The first guess for the mean temperature is the initial one.
            *start = std::array::from_fn(|c| T::from_fn(|k| if c == 2 { initial[k][i][2] } else { velocity[k][i][c] }));
        }
        let velocity = if scheme.inertia == 1.0 { [vec![], vec![]] } else { [start.clone(), zeros.clone()] };
        let controls = (0..T::WIDTH).map(|k| Control::new(&cases[k], &initial[k])).collect();
        Self {
            factor: Factor::new(n),
            elements,
            new: zeros.clone(),
            ring: [zeros.clone(), start.clone(), start.clone(), start],
            middle: zeros.clone(),
            load: vec![],
            old,
            velocity,
            weight: T::splat(scheme.inertia),
            controls,
            frozen: vec![None; cases.len()],
            scalars,
            scheme,
            settings,
            cases,
            passes: 0,
        }
    }

    /// Room for loads, to be filled before each step.
    pub(crate) fn load_mut(&mut self) -> &mut [[T; B]] {
        if self.load.is_empty() {
            self.load = vec![[T::splat(0.0); B]; self.old.len()];
        }
        &mut self.load
    }

    /// Does one step of every case that has not failed before; the report of each case, or why it failed.
    ///
    /// A case that fails keeps its last level; the others are not touched by it. A case alone may try again.
    pub(crate) fn advance(&mut self, report: &mut [Result<StepReport, StepFailure>]) {
        for k in 0..T::WIDTH {
            if T::WIDTH == 1 || self.controls[k].state != Progress::Failed {
                self.start(k);
            }
        }
        let mut first = true;
        for _ in 0..KEPT_PASSES.min(self.settings.max_iterations) {
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
            if matches!(self.controls[k].state, Progress::Iterating | Progress::NeedsSafeguard) {
                let outcome = self.find_root(k);
                self.conclude(k, outcome, report);
            }
        }
        if self.any(Progress::Accepted) {
            self.commit(report);
        }
    }

    /// m from the extrapolated force, and a factorisation fit for it.
    fn start(&mut self, k: usize) {
        let beam = self.cases[k].beam;
        let weights = self.weights();
        let control = &mut self.controls[k];
        let [n1, n2, n3] = control.forces;
        // N never lies below β; an extrapolation may.
        let predicted = (weights[0] * n1 + (weights[1] * n2 + weights[2] * n3)).max(beam.beta);
        control.m = 0.5 * (predicted + n1);
        control.iterations = 0;
        control.increment = f64::NAN;
        control.state = Progress::Iterating;
        let m = control.m;
        // NaN on the first step: there is no factorisation yet, and the comparison then renews.
        if !(self.kept_contraction(k, m) <= RENEWAL) && self.factorize(k, m).is_err() {
            // The prediction may lie below the buckling force where the solution does not.
            self.controls[k].state = Progress::NeedsSafeguard;
        }
    }

    fn weights(&self) -> [f64; 3] {
        match self.settings.start {
            Start::Previous => [1.0, 0.0, 0.0],
            Start::Extrapolated => [3.0, -3.0, 1.0],
        }
    }

    fn any(&self, state: Progress) -> bool {
        self.controls.iter().any(|control| control.state == state)
    }

    pub(super) fn factorize(&mut self, k: usize, m: f64) -> Result<(), StepFailure> {
        let scalars = self.scalars.of_lane(k);
        let count = self.elements.len();
        let elements = &self.elements;
        let of_lane = |e: Element<T>| Element { inverse: e.inverse.lane(k), sixth: e.sixth.lane(k) };
        self.controls[k].work.factorizations += 1;
        // Unusable until the elimination has gone through.
        self.controls[k].factorized = f64::NAN;
        self.factor.factorize(k, m, |i| {
            let right = (i + 1 < count).then(|| of_lane(elements[i + 1]));
            scalars.blocks(m, of_lane(elements[i]), right)
        })?;
        self.controls[k].factorized = m;
        Ok(())
    }

    /// One pass for the cases in `state`; the others keep their iterate.
    pub(super) fn pass(&mut self, state: Progress, first: bool) {
        let active = T::from_fn(|k| f64::from(self.controls[k].state == state));
        let m = T::from_fn(|k| self.controls[k].m);
        self.passes += 1;
        self.forward(m, first);
        let tip = self.solve_tip(active);
        let [iterate, ..] = &mut self.ring;
        let sums = Backward {
            scalars: &self.scalars,
            elements: &self.elements,
            nodes: &self.factor.nodes,
            middle: &self.middle,
            active,
            tip,
            old: &self.old,
            iterate,
            new: &mut self.new,
        }
        .run();
        self.record(state, sums);
    }

    fn forward(&mut self, m: T, first: bool) {
        let weights = self.weights().map(T::splat);
        let [iterate, one, two, three] = &mut self.ring;
        let old_velocity = if self.velocity[0].is_empty() { &*one } else { &self.velocity[0] };
        let sweep = Forward {
            scalars: &self.scalars,
            m,
            elements: &self.elements,
            nodes: &self.factor.nodes,
            old: &self.old,
            old_velocity,
            history: [one, two, three],
            weights,
            load: &self.load,
            iterate,
            middle: &mut self.middle,
        };
        match (first, !self.load.is_empty()) {
            (true, false) => sweep.run::<true, false>(),
            (true, true) => sweep.run::<true, true>(),
            (false, false) => sweep.run::<false, false>(),
            (false, true) => sweep.run::<false, true>(),
        }
    }

    /// δ at the tip: the linear solution, less the contact force's share `F S⁻¹ e`.
    fn solve_tip(&mut self, active: T) -> [T; B] {
        let last = self.elements.len() - 1;
        let inverse = &self.factor.nodes[last].inverse;
        let mut delta = self.middle[last];
        for k in 0..T::WIDTH {
            let Some(obstacles) = self.cases[k].obstacles else { continue };
            if active.lane(k) == 0.0 {
                continue;
            }
            let (dt, u0) = (self.cases[k].dt, self.old[last][0].lane(k));
            let free = u0 + dt * (self.ring[0][last][0].lane(k) + delta[0].lane(k));
            let tip = obstacles.solve_tip(self.scheme.contact, free, dt * inverse[0][0].lane(k), u0);
            self.controls[k].tip = tip;
            for (component, row) in delta.iter_mut().zip(inverse) {
                component.set_lane(k, component.lane(k) - tip.force * row[0].lane(k));
            }
        }
        delta
    }

    /// Keeps what the pass has found for the cases that took part.
    fn record(&mut self, state: Progress, sums: Sums<T>) {
        for (k, control) in self.controls.iter_mut().enumerate() {
            if control.state == state {
                control.iterations += 1;
                control.work.passes += 1;
                control.new_slope_squared = sums.slope_squared.lane(k);
                control.increment_slope = sums.increment_slope_squared.lane(k).sqrt();
            }
        }
    }

    /// Accepts a case, lets it pass again with the force just found, or hands it to the safeguarded iteration.
    fn judge(&mut self, k: usize) {
        let bound = self.bound(k);
        let control = &mut self.controls[k];
        control.increment = bound.increment;
        if bound.remaining <= self.settings.tolerance {
            control.state = Progress::Accepted;
        } else if bound.contraction <= CONTRACTION {
            control.m = bound.m;
        } else {
            // NaN ends here too: the safeguarded iteration starts afresh.
            control.state = Progress::NeedsSafeguard;
        }
    }

    /// Files the outcome of a case's step.
    fn conclude(&mut self, k: usize, outcome: Result<(), StepFailure>, report: &mut [Result<StepReport, StepFailure>]) {
        self.controls[k].state = if outcome.is_ok() { Progress::Accepted } else { Progress::Failed };
        if let Err(failure) = outcome {
            report[k] = Err(failure);
            if T::WIDTH > 1 {
                let mut level = Level::new(self.old.len());
                self.read(k, &mut level);
                self.frozen[k] = Some(level);
            }
        }
    }

    /// Makes the accepted iterate the level to go on from.
    fn commit(&mut self, report: &mut [Result<StepReport, StepFailure>]) {
        for (k, control) in self.controls.iter_mut().enumerate() {
            if control.state != Progress::Accepted {
                continue;
            }
            control.slope_squared = control.new_slope_squared;
            control.force = control.tip.force;
            let [n1, n2, _] = control.forces;
            control.forces = [self.cases[k].beam.axial_force(control.slope_squared), n1, n2];
            report[k] =
                Ok(StepReport { iterations: control.iterations, increment: control.increment, contraction: None });
        }
        if let [old, new] = &mut self.velocity
            && !old.is_empty()
        {
            // Written so that it is v = 2 V - v0 to the bit where V is the mean velocity.
            let (weight, rest) = (self.weight, T::splat(1.0) - self.weight);
            for ((new, old), x) in new.iter_mut().zip(old.iter()).zip(&self.ring[0]) {
                *new = std::array::from_fn(|c| weight * x[c] + rest * old[c]);
            }
            std::mem::swap(old, new);
        }
        std::mem::swap(&mut self.old, &mut self.new);
        self.ring.rotate_right(1);
    }

    /// Copies the present level of case k; its last good one if it has failed.
    pub(crate) fn read(&self, k: usize, level: &mut Level) {
        if let Some(frozen) = &self.frozen[k] {
            level.copy_from(frozen);
            return;
        }
        let velocity = if self.velocity[0].is_empty() { &self.ring[1] } else { &self.velocity[0] };
        for (i, (state, velocity)) in self.old.iter().zip(velocity).enumerate() {
            level.u[i] = state[0].lane(k);
            level.phi[i] = state[1].lane(k);
            level.theta[i] = if B == 3 { state[2].lane(k) } else { 0.0 };
            level.v[i] = velocity[0].lane(k);
            level.w[i] = velocity[1].lane(k);
        }
        level.contact_force = self.controls[k].force;
    }

    /// The work done so far, all cases together: a pass of the lanes is one.
    pub(crate) fn work(&self) -> Work {
        let factorizations = self.controls.iter().map(|control| control.work.factorizations).sum();
        Work { passes: self.passes, factorizations, ..Work::default() }
    }

    /// The work that case k has needed so far, as much as it would have taken alone.
    pub(crate) fn work_of(&self, k: usize) -> Work {
        self.controls[k].work
    }

    /// u(1) of the present level of case k; its last good one if it has failed.
    pub(crate) fn tip(&self, k: usize) -> f64 {
        let tip = self.old.len() - 1;
        self.frozen[k].as_ref().map_or(self.old[tip][0].lane(k), |frozen| frozen.u[tip])
    }

    /// The contact force of the last step of case k.
    pub(crate) fn contact_force(&self, k: usize) -> f64 {
        self.controls[k].force
    }
}

impl Control {
    fn new(case: &Case, initial: &[[f64; 3]]) -> Self {
        let slope_squared: f64 =
            initial.windows(2).zip(&case.lengths).map(|(pair, h)| (pair[1][0] - pair[0][0]).powi(2) / h).sum();
        let u = initial[initial.len() - 1][0];
        let force = case.obstacles.map_or(0.0, |obstacles| obstacles.force(u));
        Self {
            slope_squared,
            forces: [case.beam.axial_force(slope_squared); 3],
            factorized: f64::NAN,
            m: f64::NAN,
            new_slope_squared: f64::NAN,
            increment_slope: f64::NAN,
            tip: Tip { u, force, stiffness: 0.0 },
            force,
            iterations: 0,
            increment: f64::NAN,
            state: Progress::Iterating,
            work: Work::default(),
        }
    }
}
