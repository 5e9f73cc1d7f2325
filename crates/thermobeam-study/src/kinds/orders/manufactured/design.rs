//! The three designs of a convergence study: coupled, space isolated, time isolated.
//!
//! * **Coupled**: loads from the strong form at t_{n-½}, errors against the exact solution at t_n.
//! * **Space isolated**: the exact solution is replaced by its own time sequence
//!   `U^n = Σ X_j T_j(t_n)` with the velocities of the scheme, and the loads are the time-discrete
//!   operator applied to it, with space still exact. The time error is then exactly zero for every
//!   dt.
//! * **Time isolated**: the exact solution is replaced by its nodal interpolant and the loads use
//!   the discrete matrices. The space error is then exactly zero on every mesh.
//!
//! Theory and solver differ by a [`Defect`] only in a negative control.

use std::cell::RefCell;

use super::Convergence;
use crate::kinds::prelude::*;
use crate::{
    exact::{
        defect::Defect,
        errors::ErrorMeter,
        norm::Norms,
        solution::Factors,
        sources::{Nodal, Sources},
    },
    kinds::orders::one_step::{formulas_of, largest_errors},
    run::driver::Driver,
    scene::Coefficients,
};
use thermobeam::{
    mesh::{Mesh, MeshError},
    motion::TipRange,
    one_step::Problem,
};

/// Space vectors and error meter of one mesh, shared by several runs.
pub struct Prepared<'a> {
    study: &'a Convergence,
    mesh: Mesh,
    nodal: Nodal,
    sources: Sources,
    meter: ErrorMeter,
}

impl<'a> Prepared<'a> {
    /// Computes the space vectors of the design.
    ///
    /// # Errors
    /// [`MeshError`] if the study's map gives no valid mesh.
    pub fn new(study: &'a Convergence, elements: usize) -> Result<Self, MeshError> {
        let exact = &study.exact;
        let beam = &study.theory.beam;
        let mesh = study.refine.layout.mesh(elements)?;
        let is_nodal = study.refine.isolates(RefinedIn::Time);
        let sources = if is_nodal {
            Sources::discrete(exact, beam, &mesh)
        } else {
            Sources::strong(exact, beam, &mesh)
        };
        Ok(Self {
            study,
            nodal: Nodal::of(exact, &mesh),
            sources,
            meter: ErrorMeter::new(exact, &mesh, is_nodal),
            mesh,
        })
    }

    /// Runs this number of steps and returns the errors, each the maximum over n = 1..N; NaN stays.
    ///
    /// * `solver`: the solver's coefficients; without a fault those of the study's theory.
    ///
    /// # Errors
    /// [`CaseFailure`] with the solver's message.
    pub fn run(
        &mut self,
        steps: usize,
        solver: Coefficients,
        defect: Option<Defect>,
    ) -> Result<Norms, CaseFailure> {
        let Convergence {
            exact,
            theory,
            refine,
            ..
        } = self.study;
        let scheme = self
            .study
            .formulas
            .map_or_else(|| formulas_of(refine.scheme), Ok)?;
        let obstacles = theory.obstacles.as_ref();
        let dt = refine.dt(steps);
        let mut start = Factors::default();
        start.at(exact, 0.0);
        let problem = self.problem(&start, solver, defect);
        let driver = Driver::new(problem, refine.stepping(steps, true))?;
        self.meter.lift(&self.mesh, solver.beam.theta_a);
        // The exact solution at the end of the step whose loads are filled, for the watch too.
        let reached = RefCell::new(start.clone());
        let mut old = start.clone();
        let mut source = start;
        let mut n = 0.0;
        let sources = &self.sources;
        let fill = |_, load: &mut [[f64; 3]]| {
            let mut new = reached.borrow_mut();
            std::mem::swap(&mut old, &mut new);
            n += 1.0;
            new.at(exact, n * dt);
            let forces = if refine.isolates(RefinedIn::Space) {
                source.of_step(&old, &mut new, scheme.inertia(), dt);
                if defect == Some(Defect::SourceAtNewLevel) {
                    source.u.value.clone_from(&new.u.value);
                }
                sources.forces_of_step(scheme, [&old.u, &new.u], obstacles, defect)
            } else {
                let middle = if defect == Some(Defect::SourceAtNewLevel) {
                    n
                } else {
                    n - 0.5
                };
                source.at(exact, middle * dt);
                sources.forces(&source.u, obstacles, defect)
            };
            sources.fill(&source, forces, defect, load);
        };
        let meter = &mut self.meter;
        Ok(largest_errors(
            &mut driver.loaded(fill),
            steps as f64 * dt,
            |driver| meter.measure(driver.level(), &reached.borrow()),
        )?)
    }

    /// The solver's problem, with the exact solution at t = 0.
    ///
    /// * `factors`: those of the exact solution at t = 0; the rest as in [`Self::run`].
    fn problem(
        &self,
        factors: &Factors,
        Coefficients { beam, obstacles }: Coefficients,
        defect: Option<Defect>,
    ) -> Problem {
        let mesh = self.mesh.clone();
        let exact_theta_a = self.study.theory.beam.theta_a;
        let mut initial = self
            .nodal
            .initial(&mesh, factors, exact_theta_a, beam.theta_a);
        if defect == Some(Defect::StartNotLifted) {
            // Without the ends: the solver refuses initial data that contradict the boundary
            // conditions.
            let inner = 1..mesh.elements();
            let temperatures = initial.theta[inner.clone()].iter_mut();
            for (theta, x) in temperatures.zip(&mesh.nodes()[inner]) {
                *theta -= exact_theta_a * (1.0 - x);
            }
        }
        Problem {
            beam,
            obstacles,
            mesh,
            initial,
        }
    }
}

/// Smallest and largest u(1, t) of the exact solution over the time levels of the finest run.
pub(super) fn range_of_the_tip(study: &Convergence) -> TipRange {
    let steps = study.refine.steps.iter().copied().max().unwrap_or(1);
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    for n in 0..=steps {
        let u = study.exact.tip(n as f64 * study.refine.dt(steps));
        low = low.min(u);
        high = high.max(u);
    }
    TipRange { low, high }
}
