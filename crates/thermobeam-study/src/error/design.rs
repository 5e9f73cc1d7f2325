//! The three designs of a convergence study: coupled, space isolated, time isolated.
//!
//! * **Coupled**: loads from the strong form at t_{n-½}, errors against the exact solution at t_n.
//! * **Space isolated**: the exact solution is replaced by its own time sequence `U^n = Σ X_j T_j(t_n)` with the
//!   velocities of the scheme, and the loads are the time-discrete operator applied to it, space still exact. The time
//!   error is then exactly zero, whatever dt.
//! * **Time isolated**: the exact solution is replaced by its nodal interpolant and the loads use the discrete matrices.
//!   The space error is then exactly zero, whatever the mesh.
//!
//! Theory and solver differ by a [`Defect`] only in a negative control.

use crate::exact::errors::ErrorMeter;
use crate::exact::factors::Factors;
use crate::exact::norm::Norms;
use crate::exact::solution::Manufactured;
use crate::exact::sources::{BoundaryLoads, Nodal, Sources};
use crate::run::driver::Driver;
use convergence_study::study::{Axis, CaseFailure};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{ContactRule, Scheme};
use thermobeam::simulation::{Initial, Problem, Stepping};
use thermobeam::solve::Settings;

/// A mistake made on purpose in the sources, for negative controls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Defect {
    /// Values taken at t_n where the scheme has t_{n-½}.
    SourceAtNewLevel,
    /// The load σ(1, t) + g(u(1, t)) is dropped.
    StressDropped,
    /// The load φ_x(1, t) + ζ φ_xt(1, t) is dropped.
    MomentDropped,
    /// N(u^n) in place of the mean ½(N(u^n) + N(u^{n-1})).
    ForceAtNewLevel,
    /// Contact at t_{n-½} where the scheme has t_n.
    ContactAtMiddle,
}

impl Defect {
    /// All defects.
    pub const ALL: [Defect; 5] = [
        Defect::SourceAtNewLevel,
        Defect::StressDropped,
        Defect::MomentDropped,
        Defect::ForceAtNewLevel,
        Defect::ContactAtMiddle,
    ];

    /// What it does, in words.
    pub fn name(self) -> &'static str {
        match self {
            Defect::SourceAtNewLevel => "source at t_n instead of the middle",
            Defect::StressDropped => "boundary load of the stress dropped",
            Defect::MomentDropped => "boundary load of the moment dropped",
            Defect::ForceAtNewLevel => "N(u^n) instead of the mean of N",
            Defect::ContactAtMiddle => "contact at the middle instead of t_n",
        }
    }
}

/// What solver and sources of a run disagree in; nothing in an honest one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disagreement {
    /// The solver's coefficients.
    pub beam: Beam,
    /// The solver's obstacles.
    pub obstacles: Option<Obstacles>,
    /// A mistake in the sources.
    pub defect: Option<Defect>,
}

/// What runs on all meshes share: the exact solution, the design, and how it is stepped.
#[derive(Debug, Clone, Copy)]
pub struct Theory<'a> {
    /// The exact solution.
    pub exact: &'a Manufactured,
    /// Coefficients from which the sources are derived.
    pub beam: Beam,
    /// Obstacles from which the boundary load is derived.
    pub obstacles: Option<Obstacles>,
    /// The axis whose error is isolated; `None`: coupled.
    pub isolated: Option<Axis>,
    /// Final time.
    pub t_end: f64,
    /// Time scheme.
    pub scheme: Scheme,
    /// How each step is solved.
    pub settings: Settings,
}

/// Space vectors and error meter of one mesh: what several runs on it share.
pub struct Prepared<'a> {
    theory: Theory<'a>,
    mesh: Mesh,
    nodal: Nodal,
    sources: Sources,
    meter: ErrorMeter,
}

impl<'a> Prepared<'a> {
    /// Computes the space vectors of the design.
    pub fn new(theory: Theory<'a>, mesh: Mesh) -> Self {
        let Theory { exact, ref beam, .. } = theory;
        let time_isolated = theory.isolated == Some(Axis::Time);
        let sources =
            if time_isolated { Sources::discrete(exact, beam, &mesh) } else { Sources::strong(exact, beam, &mesh) };
        let (meter, nodal) = (ErrorMeter::new(exact, &mesh, time_isolated), Nodal::of(exact, &mesh));
        Self { theory, mesh, nodal, sources, meter }
    }

    /// Runs so many steps and returns the errors, each the maximum over n = 1..N.
    ///
    /// A maximum keeps NaN: an error that is not a number at one time is not a number at all.
    ///
    /// # Errors
    /// [`CaseFailure`] with the solver's own words.
    pub fn run(&mut self, steps: usize, disagreement: Disagreement) -> Result<Norms, CaseFailure> {
        self.meter.lift(&self.mesh, disagreement.beam.theta_a);
        let mut run = DesignRun::new(self, steps, disagreement)?;
        let mut worst = Norms::ZERO;
        for n in 1..=steps {
            worst = worst.max(&run.step(n)?);
        }
        Ok(worst)
    }
}

struct DesignRun<'a> {
    theory: Theory<'a>,
    dt: f64,
    defect: Option<Defect>,
    sources: &'a Sources,
    meter: &'a mut ErrorMeter,
    driver: Driver,
    /// Factors at t_{n-1} and t_n, and those of the sources.
    old: Factors,
    new: Factors,
    source: Factors,
}

impl<'a> DesignRun<'a> {
    fn new(prepared: &'a mut Prepared<'_>, steps: usize, disagreement: Disagreement) -> Result<Self, CaseFailure> {
        let Prepared { theory, mesh, nodal, sources, meter } = prepared;
        let theory = *theory;
        let Disagreement { beam, obstacles, defect } = disagreement;
        let mut old = Factors::default();
        old.at(theory.exact, 0.0);
        let initial = initial(nodal, &theory.beam, mesh, &old, beam.theta_a);
        let dt = theory.t_end / steps as f64;
        let stepping = Stepping { scheme: theory.scheme, settings: theory.settings, dt, loaded: true };
        let driver = Driver::new(Problem { beam, obstacles, mesh: mesh.clone(), initial }, stepping)?;
        let (new, source) = (old.clone(), old.clone());
        Ok(Self { theory, dt, defect, sources, meter, driver, old, new, source })
    }

    /// Step n and its errors.
    fn step(&mut self, n: usize) -> Result<Norms, CaseFailure> {
        let exact = self.theory.exact;
        self.new.at(exact, n as f64 * self.dt);
        let (n_value, force) =
            if self.theory.isolated == Some(Axis::Space) { self.discrete_factors() } else { self.exact_factors(n) };
        let loads = match self.defect {
            Some(Defect::StressDropped) => BoundaryLoads::WithoutStress,
            Some(Defect::MomentDropped) => BoundaryLoads::WithoutMoment,
            _ => BoundaryLoads::Both,
        };
        let (sources, source) = (self.sources, &self.source);
        self.driver.advance(|_, load| sources.fill(source, n_value, force, loads, load))?;
        let errors = self.meter.measure(self.driver.level(), &self.new);
        std::mem::swap(&mut self.old, &mut self.new);
        Ok(errors)
    }

    /// Source factors, N and contact force at t_{n-½}.
    fn exact_factors(&mut self, n: usize) -> (f64, f64) {
        let at = if self.defect == Some(Defect::SourceAtNewLevel) { n as f64 } else { n as f64 - 0.5 };
        self.source.at(self.theory.exact, at * self.dt);
        let values = &self.source.u.value;
        let force = self.theory.obstacles.map_or(0.0, |obstacles| obstacles.force(self.sources.tip(values)));
        (self.sources.axial_force(values), force)
    }

    /// What the scheme makes of the time sequence between t_{n-1} and t_n.
    fn discrete_factors(&mut self) -> (f64, f64) {
        let scheme = self.theory.scheme;
        self.source.of_step(&self.old, &mut self.new, scheme.inertia, self.dt);
        if self.defect == Some(Defect::SourceAtNewLevel) {
            self.source.u.value.clone_from(&self.new.u.value);
        }
        let [old, new] = [&self.old, &self.new].map(|factors| &factors.u.value);
        let (n_old, n_new) = (self.sources.axial_force(old), self.sources.axial_force(new));
        let n_value = if self.defect == Some(Defect::ForceAtNewLevel) { n_new } else { 0.5 * (n_old + n_new) };
        let (u_old, u_new) = (self.sources.tip(old), self.sources.tip(new));
        let force =
            self.theory.obstacles.map_or(0.0, |obstacles| self.contact(&obstacles, scheme.contact, u_new, u_old));
        (n_value, force)
    }

    fn contact(&self, obstacles: &Obstacles, rule: ContactRule, u: f64, u_old: f64) -> f64 {
        match rule {
            _ if self.defect == Some(Defect::ContactAtMiddle) => obstacles.force(0.5 * (u + u_old)),
            ContactRule::Implicit => obstacles.force(u),
            ContactRule::DiscreteGradient => obstacles.discrete_gradient(u, u_old),
        }
    }
}

/// Nodal values of the exact solution at t = 0, by (3.6); the temperature is made to meet the solver's own θ_A.
///
/// * `nodal`: the products of the exact solution on this mesh, `factors`: their factors at t = 0.
/// * `theory`: the coefficients that the exact solution belongs to; `theta_a`: the solver's own.
pub(crate) fn initial(nodal: &Nodal, theory: &Beam, mesh: &Mesh, factors: &Factors, theta_a: f64) -> Initial {
    let sum = |products: &[Vec<f64>], factors: &[f64]| {
        let mut values = vec![0.0; mesh.nodes().len()];
        for (product, factor) in products.iter().zip(factors) {
            for (value, x) in values.iter_mut().zip(product) {
                *value += factor * x;
            }
        }
        values
    };
    let mut theta = sum(&nodal.theta, &factors.theta.value);
    for (theta, x) in theta.iter_mut().zip(mesh.nodes()) {
        *theta += (theta_a - theory.theta_a) * (1.0 - x);
    }
    let last = theta.len() - 1;
    // Checked up to round-off when the study was read.
    (theta[0], theta[last]) = (theta_a, 0.0);
    Initial {
        u: sum(&nodal.u, &factors.u.value),
        u_t: sum(&nodal.u, &factors.u.rate),
        phi: sum(&nodal.phi, &factors.phi.value),
        phi_t: sum(&nodal.phi, &factors.phi.rate),
        theta,
    }
}
