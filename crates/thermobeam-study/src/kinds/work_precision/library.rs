//! The outside references of benchmarks: the semi-discrete system, given to DOP853 of the `ode_solvers` library and to Radau5
//! of `differential-equations`.
//!
//! ```text
//! M v' = F_u - K ((1 + N) u + ζ v) + C (φ + ζ w) - g(u(1)) e
//! M w' = F_φ - (K + M)(φ + ζ w) + Cᵀ (u + ζ v) + a C (θ~ + θ_A (1 - x))
//! M θ' = F_θ - K θ~ - a Cᵀ w
//! ```
//!
//! An explicit method of order 8 pays for stability, not for accuracy: its steps shrink like h². Its cost is counted in
//! elements times evaluations, each with three solves with M. An implicit one, Radau IIA of order 5, does not; but it
//! knows nothing of the system's structure, and pays for dense matrices, which differences fill column by column.

use super::{Timed, WorkPrecision};
use crate::error::evaluator::Evaluator;
use crate::exact::factors::Factors;
use crate::kinds::work_precision::method::Measurement;
use crate::run::family::{OnMesh, Spent};
use convergence_study::study::CaseFailure;
use convergence_study::text::number::max_or_nan;
use differential_equations::ivp::IVP;
use differential_equations::methods::ImplicitRungeKutta;
use differential_equations::ode::ODE;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{DVector, Dop853, System};
use std::time::Instant;
use thermobeam::assembly::{Tridiagonal, coupling, mass, stiffness};
use thermobeam::norms::slope_squared;
use thermobeam::solve::Level;
use thermobeam::tridiagonal::TridiagonalFactor;

/// Relative and absolute tolerance of the library: its error in time is then far below that of space.
const TOLERANCE: f64 = 1e-8;

/// The semi-discrete system; the unknowns are u, v, φ, w, θ~ at the nodes 0..=n, one below the other, and the time.
///
/// The time is an unknown because version 0.6.2 of the library evaluates its last stage at t instead of t + h (the table
/// of its nodes has a zero there), which leaves a system that depends on time with first order.
struct SemiDiscrete<'a> {
    on: &'a OnMesh<'a>,
    lengths: Vec<f64>,
    matrices: [Tridiagonal; 4],
    /// M with the tip free, and with the tip fixed.
    factors: [TridiagonalFactor; 2],
    /// θ_A (1 - x).
    lifting: Vec<f64>,
}

impl<'a> SemiDiscrete<'a> {
    fn new(on: &'a OnMesh<'a>) -> Result<Self, CaseFailure> {
        let (mesh, beam) = (on.mesh(), on.problem().beam);
        let lengths: Vec<f64> = mesh.lengths().collect();
        let n = lengths.len();
        let mut factors = [n, n - 1].map(TridiagonalFactor::new);
        for factor in &mut factors {
            let failure = |_| CaseFailure { reason: "the mass matrix is not definite".to_owned() };
            factor.factorize(&lengths, 1.0, 0.0, 0.0).map_err(failure)?;
        }
        let c = coupling(mesh);
        let matrices = [mass(mesh), stiffness(mesh), c.transpose(), c];
        let lifting = mesh.nodes().iter().map(|x| beam.theta_a * (1.0 - x)).collect();
        Ok(Self { on, lengths, matrices, factors, lifting })
    }

    fn start(&self) -> Vec<f64> {
        let initial = &self.on.problem().initial;
        let theta: Vec<f64> = initial.theta.iter().zip(&self.lifting).map(|(theta, lift)| theta - lift).collect();
        let parts = [&initial.u, &initial.u_t, &initial.phi, &initial.phi_t, &theta];
        parts.into_iter().flatten().copied().chain([0.0]).collect()
    }

    fn level(&self, y: &[f64]) -> Level {
        let part = |k: usize| y.chunks(self.lengths.len() + 1).nth(k).map_or(vec![], <[f64]>::to_vec);
        Level { u: part(0), v: part(1), phi: part(2), w: part(3), theta: part(4), contact_force: 0.0 }
    }
}

impl SemiDiscrete<'_> {
    /// The right-hand side.
    fn rates(&self, y: &[f64], dy: &mut [f64]) {
        let beam = self.on.problem().beam;
        let (n, t) = (self.lengths.len(), y[y.len() - 1]);
        let Level { u, v, phi, w, theta, .. } = self.level(y);
        let mix = |a: &[f64], x: f64, b: &[f64], y: f64| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| x * a + y * b).collect()
        };
        let [m, k, slope, c] = &self.matrices;
        let n_value = beam.axial_force(slope_squared(&self.lengths, &u));
        let (stretch, shear) = (mix(&u, 1.0 + n_value, &v, beam.zeta), mix(&u, 1.0, &v, beam.zeta));
        let turn = mix(&phi, 1.0, &w, beam.zeta);
        let mut load = vec![[0.0; 3]; n + 1];
        self.on.fill(t, &mut Factors::default(), &mut load);
        let column = |component: usize| load.iter().map(|load| load[component]).collect::<Vec<f64>>();
        let mut force = mix(&c.multiply(&turn), 1.0, &k.multiply(&stretch), -1.0);
        force[n] -= self.on.problem().obstacles.map_or(0.0, |obstacles| obstacles.force(u[n]));
        let elastic = mix(&k.multiply(&turn), 1.0, &m.multiply(&turn), 1.0);
        let heat = c.multiply(&mix(&theta, beam.a, &self.lifting, beam.a));
        let moment = mix(&mix(&slope.multiply(&shear), 1.0, &elastic, -1.0), 1.0, &heat, 1.0);
        let flux = mix(&k.multiply(&theta), -1.0, &slope.multiply(&w), -beam.a);
        let mut rates = [force, moment, flux];
        for (k, rate) in rates.iter_mut().enumerate() {
            rate.iter_mut().zip(column(k)).for_each(|(rate, load)| *rate += load);
            self.factors[usize::from(k == 2)].solve_in_place(rate);
            rate[0] = 0.0;
        }
        rates[2][n] = 0.0;
        let [v_t, w_t, theta_t] = rates;
        let parts = [&v, &v_t, &w, &w_t, &theta_t];
        dy.iter_mut().zip(parts.into_iter().flatten().chain([&1.0])).for_each(|(dy, part)| *dy = *part);
    }
}

impl System<f64, DVector<f64>> for &SemiDiscrete<'_> {
    fn system(&self, _: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        self.rates(y.as_slice(), dy.as_mut_slice());
    }
}

/// Of fixed size: version 0.7 of the library fills up states of other sizes with empty ones, and panics.
impl<const N: usize> ODE<f64, [f64; N]> for SemiDiscrete<'_> {
    fn diff(&self, _: f64, y: &[f64; N], dy: &mut [f64; N]) {
        self.rates(y, dy);
    }
}

/// Radau IIA of order 5 from one time to another, of a system with N unknowns.
fn radau5<const N: usize>(
    system: &SemiDiscrete<'_>,
    [from, to]: [f64; 2],
    y: &[f64],
    tolerance: f64,
) -> Result<(Vec<f64>, f64), CaseFailure> {
    let y: [f64; N] = y.try_into()?;
    let method = ImplicitRungeKutta::radau5().rtol(tolerance).atol(tolerance);
    let solved = IVP::ode(system, from, to, y).method(method).solve();
    let solution = solved.map_err(|error| CaseFailure { reason: format!("{error:?}") })?;
    let last = solution.y.last().ok_or_else(|| CaseFailure { reason: "no result".to_owned() })?;
    // Each Jacobian takes an evaluation for every unknown, and one more.
    let evaluations = solution.evals.function + solution.evals.jacobian * (N + 1);
    Ok((last.to_vec(), evaluations as f64))
}

/// An integrator of another library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Library {
    Dop853,
    Radau5,
}

impl Library {
    const ALL: [Library; 2] = [Library::Dop853, Library::Radau5];

    fn name(self) -> &'static str {
        match self {
            Library::Dop853 => "dop853",
            Library::Radau5 => "radau5",
        }
    }

    /// Whether it is given so many elements: beyond 32 dense matrices take minutes.
    fn takes(self, elements: usize) -> bool {
        self == Library::Dop853 || [4, 8, 16, 32].contains(&elements)
    }

    /// Integrates from one time to another. Returns the state there and the evaluations of the right-hand side.
    fn integrate(
        self,
        system: &SemiDiscrete<'_>,
        [from, to]: [f64; 2],
        y: Vec<f64>,
        tolerance: f64,
    ) -> Result<(Vec<f64>, f64), CaseFailure> {
        let nothing = || CaseFailure { reason: "no result".to_owned() };
        match self {
            Library::Dop853 => {
                let y = DVector::from_vec(y);
                let mut integrator = Dop853::new(system, from, to, to - from, y, tolerance, tolerance);
                integrator.set_output(OutputType::Sparse);
                let stats = integrator.integrate()?;
                let y = integrator.y_out().last().ok_or_else(nothing)?;
                Ok((y.as_slice().to_vec(), f64::from(stats.num_eval)))
            }
            // 5 (n + 1) + 1 unknowns.
            Library::Radau5 => match system.lengths.len() {
                4 => radau5::<26>(system, [from, to], &y, tolerance),
                8 => radau5::<46>(system, [from, to], &y, tolerance),
                16 => radau5::<86>(system, [from, to], &y, tolerance),
                32 => radau5::<166>(system, [from, to], &y, tolerance),
                n => Err(CaseFailure { reason: format!("radau5 is set up for 4, 8, 16 and 32 elements, not {n}") }),
            },
        }
    }
}

impl WorkPrecision {
    /// The libraries' runs on the meshes of the study, at the times at which all other methods are measured. Their
    /// `node_steps` and `node_solves` are elements times evaluations of the right-hand side; `steps` is 0, for they choose
    /// their own.
    ///
    /// # Errors
    /// [`CaseFailure`] where a library gives up.
    pub fn timed_library(&self) -> Result<Vec<Timed>, CaseFailure> {
        let runs = Library::ALL.into_iter().flat_map(|library| {
            let elements = self.elements.iter().copied().filter(move |&elements| library.takes(elements));
            elements.map(move |elements| (library, elements))
        });
        runs.map(|(library, elements)| self.integrated(library, elements, TOLERANCE)).collect()
    }

    fn integrated(&self, library: Library, elements: usize, tolerance: f64) -> Result<Timed, CaseFailure> {
        let on = self.family.on(elements)?;
        let mut evaluator = Evaluator::new(&self.family, &on, self.reference()?)?;
        let system = SemiDiscrete::new(&on)?;
        let (mut y, mut errors, mut spent) = (system.start(), [0.0_f64; 3], Spent::default());
        let pause = self.family.t_end / self.observations() as f64;
        for index in 0..self.observations() {
            let from = index as f64 * pause;
            let start = Instant::now();
            let (next, evaluations) = library.integrate(&system, [from, from + pause], y, tolerance)?;
            spent.seconds += start.elapsed().as_secs_f64();
            spent.node_steps += system.lengths.len() as f64 * evaluations;
            y = next;
            let found = evaluator.measure(&system.level(&y), index, from + pause);
            for (worst, error) in errors.iter_mut().zip(found) {
                *worst = max_or_nan(*worst, error);
            }
        }
        spent.node_solves = spent.node_steps;
        Ok(Timed { method: library.name(), elements, steps: 0, measurement: Measurement { errors, spent } })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use convergence_study::study::FromFile;
    use std::path::Path;

    #[test]
    fn the_libraries_leave_the_error_of_space_alone() {
        for file in ["work-precision-manufactured.toml", "work-precision-vibration.toml"] {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies").join(file);
            let study = WorkPrecision::read(&path).unwrap();
            for (library, meshes) in [(Library::Dop853, [8, 16, 32]), (Library::Radau5, [4, 8, 16])] {
                let runs = meshes.map(|elements| study.integrated(library, elements, TOLERANCE).unwrap());
                for pair in runs.windows(2) {
                    let rate = (pair[0].measurement.errors[1] / pair[1].measurement.errors[1]).log2();
                    assert!((rate - 2.0).abs() < 0.1, "{file}: {rate}, {runs:?}");
                    assert!(pair[1].measurement.spent.node_steps > 2.0 * pair[0].measurement.spent.node_steps);
                }
            }
        }
    }
}
