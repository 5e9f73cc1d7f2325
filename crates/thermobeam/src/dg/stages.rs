//! The polynomials of one step, and their computation.

use super::block::{Block, add_columns};
use super::contact_event::Polynomial;
use super::factor::Factor;
use super::iteration::Iteration;
use super::operator::Operator;
use super::residual::{BlockTerms, Equations};
use super::space::{Field, Space};
use super::time::{Forcing, Load, MAX_STAGES, Path, TimeForms};
use super::{DgLevel, DgStepping};
use crate::contact::Phase;
use crate::energy::Balance;
use crate::error::StepFailure;
use crate::motion::Work;
use crate::parameters::Beam;

/// Relative difference up to which lengths share a factorisation; the iteration then contracts by
/// about this factor.
const SAME_LENGTH: f64 = 5e-3;

/// Total memory of the factorisations in bytes, not counting two of them.
const FACTOR_BYTES: usize = 64 << 20;

/// Factorisations for steps that are cut.
const SPARE: usize = 3;

/// The step for any degree q in time, without q as a parameter of the type.
pub(super) trait Stages: Send {
    /// Starts the iteration from velocities and a temperature that are constant in time.
    fn guess_constant(&mut self, level: &DgLevel);
    /// Starts it from the last step's polynomials, continued over a step that is `ratio` times as
    /// long.
    fn guess_continued(&mut self, ratio: f64);
    /// Restricts the last solution to the first part, from 0 to `ratio`, of its step.
    fn restrict(&mut self, ratio: f64);
    /// Finds the polynomials of a step, from the guess; returns the number of iterations.
    fn solve(
        &mut self,
        task: &Equations<'_>,
        stepping: &DgStepping,
        load: Option<&mut Load>,
    ) -> Result<usize, StepFailure>;
    /// u(1, t).
    fn tip(&self, space: &Space) -> Polynomial;
    /// The contact force over the step from the balance of momentum, positive at the upper
    /// obstacle.
    fn contact_force(&self) -> Polynomial;
    /// The mean axial force over the step.
    fn axial_force(&self) -> f64;
    /// Accepts the solution as the last step, from the given level.
    fn accept(&mut self, start: &DgLevel);
    /// The level at s of the last step, 0 < s <= 1, from the level at its start.
    fn level_into(&self, s: f64, start: &DgLevel, h: f64, level: &mut DgLevel);
    /// One coefficient of the space, as a polynomial over the last step.
    fn coefficient(&self, field: Field, block: usize, place: usize) -> Polynomial;
    /// The losses of the last step, except those of contact; the other terms are zero.
    fn losses(&self, space: &Space, beam: &Beam, h: f64) -> Balance;
    /// The last increment of the last solution.
    fn increment(&self) -> f64;
    /// Counts.
    fn work(&self) -> Work;
}

/// A factorisation and the length for which it was made.
struct Slot<const S: usize> {
    h: f64,
    n_value: f64,
    used: usize,
    factor: Factor<S>,
}

impl<const S: usize> Slot<S> {
    fn unused(factor: Factor<S>) -> Self {
        Self {
            h: 0.0,
            n_value: 0.0,
            used: 0,
            factor,
        }
    }

    /// The relative difference of its length from h.
    fn distance(&self, h: f64) -> f64 {
        (self.h / h - 1.0).abs()
    }
}

/// The polynomials of one step.
struct Polynomials<const S: usize> {
    /// v, w, θ~.
    x: Vec<Block<S>>,
    /// u and φ, among others.
    terms: Vec<BlockTerms<S>>,
}

impl<const S: usize> Polynomials<S> {
    fn zero(blocks: usize) -> Self {
        Self {
            x: vec![[[0.0; S]; 3]; blocks],
            terms: vec![BlockTerms::ZERO; blocks],
        }
    }
}

/// [`Stages`] for q = S - 1.
pub(super) struct DgStepper<const S: usize> {
    forms: TimeForms<S>,
    trial: Polynomials<S>,
    accepted: Polynomials<S>,
    /// `y(0+) - y_0` of the last step, for v, w, θ~.
    jumps: Vec<[f64; 3]>,
    residual: Vec<Block<S>>,
    weights: Vec<[f64; 3]>,
    slots: Vec<Slot<S>>,
    forcing: Option<Forcing<S>>,
    /// Contact force of the last iteration.
    contact_force: [f64; S],
    /// Mean axial force of the last iteration.
    axial_force: f64,
    /// The last increment of the last solution.
    increment: f64,
    work: Work,
    clock: usize,
}

impl<const S: usize> DgStepper<S> {
    /// With room for one factorisation per length, and [`SPARE`] more; `loaded` if there will be
    /// loads.
    pub(super) fn new(space: &Space, lengths: usize, loaded: bool) -> Self {
        let blocks = space.blocks();
        let factor = Factor::new(space);
        let affordable = (FACTOR_BYTES / factor.bytes()).max(2);
        Self {
            forms: TimeForms::new(),
            trial: Polynomials::zero(blocks),
            accepted: Polynomials::zero(blocks),
            jumps: vec![[0.0; 3]; blocks],
            residual: vec![[[0.0; S]; 3]; blocks],
            weights: space.diagonal_mass(),
            slots: (0..affordable.min(lengths + SPARE))
                .map(|_| Slot::unused(factor.clone()))
                .collect(),
            forcing: loaded.then(|| Forcing::new(blocks)),
            contact_force: [0.0; S],
            axial_force: 0.0,
            increment: f64::NAN,
            work: Work::default(),
            clock: 0,
        }
    }

    /// The factorisation for a length: an existing one if suitable, or a new one instead of the
    /// least recently used.
    fn slot(&mut self, task: &Equations<'_>, n_value: f64) -> Result<usize, StepFailure> {
        self.clock += 1;
        let distance = |index: usize| self.slots[index].distance(task.h);
        let best = (0..self.slots.len()).min_by(|&i, &j| distance(i).total_cmp(&distance(j)));
        let index = match best.filter(|&index| distance(index) <= SAME_LENGTH) {
            Some(index) => index,
            None => {
                let index = (0..self.slots.len())
                    .min_by_key(|&index| self.slots[index].used)
                    .unwrap_or(0);
                self.factorize(index, task, n_value)?;
                index
            }
        };
        self.slots[index].used = self.clock;
        Ok(index)
    }

    /// Writes the residual of the equations into `residual`; returns the mean axial force.
    fn defect(&mut self, task: &Equations<'_>) -> f64 {
        let Polynomials { x, terms } = &mut self.trial;
        task.displace(x, terms);
        let axial = task.axial_force(&self.forms, terms);
        self.contact_force = task.residual(
            &self.forms,
            self.forcing.as_ref(),
            x,
            terms,
            &axial,
            &mut self.residual,
        );
        self.axial_force = axial.low[0][0];
        self.axial_force
    }

    fn factorize(
        &mut self,
        index: usize,
        task: &Equations<'_>,
        n_value: f64,
    ) -> Result<(), StepFailure> {
        let slot = &mut self.slots[index];
        let compliance = task
            .obstacles
            .map_or(f64::INFINITY, |obstacles| obstacles.epsilon);
        let operator = Operator::new(&self.forms, task.beam, task.h, n_value, compliance);
        self.work.factorizations += 1;
        (slot.h, slot.n_value) = (f64::NAN, n_value);
        slot.factor.factorize(task.space, &operator, n_value)?;
        slot.h = task.h;
        Ok(())
    }

    /// One iteration: the residual of the trial polynomials, and their correction by a
    /// factorisation, that of the iteration before or, in the first, a suitable one.
    ///
    /// # Errors
    /// [`StepFailure::NonFinite`], or a factorisation that fails.
    fn iterate(
        &mut self,
        task: &Equations<'_>,
        before: &Iteration,
    ) -> Result<Iteration, StepFailure> {
        let number = before.number + 1;
        let not_finite = StepFailure::NonFinite {
            iterations: number,
            increment: before.increment,
        };
        let n_value = self.defect(task);
        if !n_value.is_finite() {
            return Err(not_finite);
        }
        let slot = match before.slot {
            Some(slot) => slot,
            None => self.slot(task, n_value)?,
        };
        self.work.passes += 1;
        let in_contact = task.phase != Phase::Free;
        self.slots[slot]
            .factor
            .solve_in_place(task.space, in_contact, &mut self.residual);
        let (increment, mut size) = self.correct();
        if in_contact {
            // The contact force amplifies rounding errors of the position; over the step they
            // equal this velocity.
            size += task.level.places[task.space.tip()][0].abs() / task.h;
        }
        if !increment.is_finite() {
            return Err(not_finite);
        }
        Ok(Iteration {
            number,
            slot: Some(slot),
            n_value,
            increment,
            size,
            contraction: increment / before.increment,
        })
    }

    /// Replaces the factorisation of an iteration, if it was made for another length or another
    /// axial force.
    fn replace(&mut self, task: &Equations<'_>, last: &Iteration) -> Result<(), StepFailure> {
        let Some(index) = last.slot else {
            return Ok(());
        };
        let slot = &self.slots[index];
        let is_of_this_step = slot.h == task.h && slot.n_value == last.n_value;
        if is_of_this_step {
            Ok(())
        } else {
            self.factorize(index, task, last.n_value)
        }
    }

    /// Subtracts the correction in `residual` from the polynomials; returns their norms, as for
    /// velocities.
    fn correct(&mut self) -> (f64, f64) {
        let (mut change, mut size) = (0.0, 0.0);
        for ((x, correction), weights) in self
            .trial
            .x
            .iter_mut()
            .zip(&self.residual)
            .zip(&self.weights)
        {
            for field in 0..3 {
                let (mut changes, mut sizes) = (0.0, 0.0);
                for i in 0..S {
                    x[field][i] -= correction[field][i];
                    changes += self.forms.product[i] * correction[field][i] * correction[field][i];
                    sizes += self.forms.product[i] * x[field][i] * x[field][i];
                }
                change += weights[field] * changes;
                size += weights[field] * sizes;
            }
        }
        (change.sqrt(), size.sqrt())
    }

    /// Re-expands polynomials over the interval from `start` to `start + ratio` of their step: the
    /// columns of the matrix.
    fn re_expand(&self, start: f64, ratio: f64) -> [[f64; S]; S] {
        // The matrix of the change of basis, by Gauss points that are exact to degree 4q + 3.
        let mut columns = [[0.0; S]; S];
        for point in &self.forms.gauss {
            let mut values = [0.0; S];
            super::legendre::values_into(2.0 * (start + ratio * point.s) - 1.0, &mut values);
            for i in 0..S {
                let weight = point.weight * (2 * i + 1) as f64 * point.legendre[i];
                for j in 0..S {
                    columns[j][i] += weight * values[j];
                }
            }
        }
        columns
    }
}

fn transform<const S: usize>(columns: &[[f64; S]; S], y: &[f64; S]) -> [f64; S] {
    let mut sum = [0.0; S];
    add_columns(&mut sum, columns, y);
    sum
}

impl<const S: usize> Stages for DgStepper<S> {
    fn guess_constant(&mut self, level: &DgLevel) {
        for (x, rates) in self.trial.x.iter_mut().zip(&level.rates) {
            *x = [[0.0; S]; 3];
            for field in 0..3 {
                x[field][0] = rates[field];
            }
        }
    }

    fn guess_continued(&mut self, ratio: f64) {
        let columns = self.re_expand(1.0, ratio);
        for (x, accepted) in self.trial.x.iter_mut().zip(&self.accepted.x) {
            for field in 0..3 {
                x[field] = transform(&columns, &accepted[field]);
            }
        }
    }

    fn restrict(&mut self, ratio: f64) {
        let columns = self.re_expand(0.0, ratio);
        for x in &mut self.trial.x {
            for field in 0..3 {
                x[field] = transform(&columns, &x[field]);
            }
        }
    }

    fn solve(
        &mut self,
        task: &Equations<'_>,
        stepping: &DgStepping,
        load: Option<&mut Load>,
    ) -> Result<usize, StepFailure> {
        if let Some((forcing, load)) = self.forcing.as_mut().zip(load) {
            forcing.integrate(load, task.level.t, task.h);
        }
        let mut last = Iteration::START;
        let mut replaced = false;
        while last.number < stepping.max_iterations {
            last = self.iterate(task, &last)?;
            if last.has_converged(stepping.tolerance) {
                task.displace(&self.trial.x, &mut self.trial.terms);
                self.increment = last.increment;
                return Ok(last.number);
            }
            if last.is_slow() && !replaced {
                self.replace(task, &last)?;
                replaced = true;
            } else if let Some(failure) = last.divergence() {
                return Err(failure);
            }
        }
        Err(StepFailure::IterationLimit {
            iterations: stepping.max_iterations,
            increment: last.increment,
            contraction: last.contraction,
        })
    }

    fn tip(&self, space: &Space) -> Polynomial {
        polynomial(&self.trial.terms[space.tip()].places[0])
    }

    fn contact_force(&self) -> Polynomial {
        of_degree_q(&self.contact_force)
    }

    fn axial_force(&self) -> f64 {
        self.axial_force
    }

    fn accept(&mut self, start: &DgLevel) {
        std::mem::swap(&mut self.trial, &mut self.accepted);
        for ((jump, x), start) in self
            .jumps
            .iter_mut()
            .zip(&self.accepted.x)
            .zip(&start.rates)
        {
            *jump = std::array::from_fn(|field| self.forms.at_start(&x[field]) - start[field]);
        }
    }

    fn level_into(&self, s: f64, start: &DgLevel, h: f64, level: &mut DgLevel) {
        level.t = start.t + h * s;
        let motion = self.accepted.x.iter().zip(&self.accepted.terms);
        for ((x, terms), (places, rates)) in
            motion.zip(level.places.iter_mut().zip(&mut level.rates))
        {
            for field in 0..2 {
                places[field] = polynomial(&terms.places[field]).at(s);
            }
            for field in 0..3 {
                rates[field] = super::legendre::sum(&x[field], s);
            }
        }
    }

    fn coefficient(&self, field: Field, block: usize, place: usize) -> Polynomial {
        match field {
            Field::U | Field::Phi => polynomial(&self.accepted.terms[block].places[place]),
            Field::V | Field::W | Field::Theta => of_degree_q(&self.accepted.x[block][place]),
        }
    }

    fn losses(&self, space: &Space, beam: &Beam, h: f64) -> Balance {
        let x = &self.accepted.x;
        let mut losses = Balance::default();
        let (viscous, thermal) = space.dissipation(x);
        for i in 0..S {
            let duration = h * self.forms.product[i];
            losses.viscous += duration * beam.zeta * viscous[i];
            losses.thermal += duration * thermal[i];
        }
        losses.inertial = 0.5 * space.mass(|block| self.jumps[block], |block| self.jumps[block]);
        if let Some(forcing) = &self.forcing {
            for (stage, moments) in forcing.moments.iter().enumerate() {
                for (moment, x) in moments.iter().zip(x) {
                    losses.load -= (0..3)
                        .map(|field| moment[field] * x[field][stage])
                        .sum::<f64>();
                }
            }
        }
        losses
    }

    fn increment(&self) -> f64 {
        self.increment
    }

    fn work(&self) -> Work {
        self.work
    }
}

fn of_degree_q<const S: usize>(low: &[f64; S]) -> Polynomial {
    let mut coefficients = [0.0; MAX_STAGES + 1];
    coefficients[..S].copy_from_slice(low);
    Polynomial {
        coefficients,
        degree: S - 1,
    }
}

fn polynomial<const S: usize>(path: &Path<S>) -> Polynomial {
    let mut coefficients = [0.0; MAX_STAGES + 1];
    coefficients[..S].copy_from_slice(&path.low);
    coefficients[S] = path.top;
    Polynomial {
        coefficients,
        degree: S,
    }
}

/// The stepper of degree q in time.
pub(super) fn stepper(q: usize, space: &Space, lengths: usize, loaded: bool) -> Box<dyn Stages> {
    match q {
        0 => Box::new(DgStepper::<1>::new(space, lengths, loaded)),
        1 => Box::new(DgStepper::<2>::new(space, lengths, loaded)),
        2 => Box::new(DgStepper::<3>::new(space, lengths, loaded)),
        3 => Box::new(DgStepper::<4>::new(space, lengths, loaded)),
        4 => Box::new(DgStepper::<5>::new(space, lengths, loaded)),
        _ => Box::new(DgStepper::<6>::new(space, lengths, loaded)),
    }
}
