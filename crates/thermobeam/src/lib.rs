//! Finite elements for a dynamic, thermoviscoelastic, nonlinear Timoshenko beam between two
//! obstacles.
//!
//! The scheme is that of C. Bernardi and M. I. M. Copetti, *Discretization of a dynamic
//! thermoviscoelastic Timoshenko beam* ([hal-00874579](https://hal.science/hal-00874579)); equation
//! numbers in this crate are those of that paper. All quantities are dimensionless.
//!
//! # The problem
//!
//! On 0 < x < 1, with the axial force `N(u) = β + ρ ∫ u_x²`, (2.3), the equations (1.1) are
//!
//! ```text
//! u_tt = u_xx - φ_x + ζ (u_xxt - φ_xt) + N(u) u_xx
//! φ_tt = φ_xx + u_x - φ + ζ (φ_xxt + u_xt - φ_t) - a θ_x
//! θ_t  = θ_xx - a φ_xt
//! ```
//!
//! with initial values of u, u_t, φ, φ_t and θ, (1.2), and the boundary conditions (1.3):
//! `u = φ = 0` and `θ = θ_A` at x = 0; `θ = 0`, `φ_x + ζ φ_xt = 0` and `σ = -g(u)` at x = 1, with
//! the stress `σ = u_x - φ + ζ (u_xt - φ_t) + N(u) u_x` and the contact force
//! `g(u) = ([u - g_2]_+ - [g_1 - u]_+)/ε`.
//!
//! | symbol | in the code | meaning |
//! | --- | --- | --- |
//! | u, û | `u`, `v` | displacement and its velocity |
//! | φ, φ̂ | `phi`, `w` | rotation of the cross section and its velocity |
//! | θ, θ~ | `theta` | temperature; in a [`TimeLevel`](solve::TimeLevel) lifted, `θ~ = θ - θ_A (1 - x)` |
//! | ζ, a, ρ, β, θ_A | [`Beam`](parameters::Beam) | viscosity, thermal coupling, Kirchhoff coefficient, axial force at rest, temperature at x = 0 |
//! | ε, g_1, g_2 | [`Obstacles`](parameters::Obstacles) | compliance and positions of the obstacles |
//! | h, δt | `lengths`, `dt` | element lengths, time step |
//!
//! # Where the equations are
//!
//! | equation | meaning | in |
//! | --- | --- | --- |
//! | (1.1), (1.3) | coefficients of the equations, of the boundary conditions and of the obstacles | [`parameters`] |
//! | (1.2), (3.6) | initial data, and their interpolation | [`one_step`] |
//! | (2.3), (2.5) | axial force, energy of the beam and of the obstacles | [`kirchhoff`], [`contact`] |
//! | (3.7), (3.8) | the scheme, solved by Newton's method | [`scheme`], `solve/sweeps.rs`, `solve/newton.rs` |
//! | (3.9) | discrete energy, and its exact balance | [`energy`] |
//! | (3.14) | the norm of Theorem 3.4 | [`norms`] |
//! | (4.1)-(4.3), (4.5) | the fixed-point iteration, and its contraction factors | `solve/fixed_point.rs`, [`contraction`], [`linearized`] |
//!
//! # From data to levels
//!
//! [`Problem`](one_step::Problem) (coefficients, [`mesh`], initial data) →
//! [`OneStep`](one_step::OneStep) (one [`scheme`], one [solver](solve)) →
//! [`TimeLevel`](solve::TimeLevel)s → [`energy`] and [`norms`]. [`Dg`](dg::Dg) solves the same
//! equations to any order in space and time. Both are a [`Motion`](motion::Motion): code that needs
//! only steps, times and counts takes either. Exact solutions for comparison are in the crate
//! `thermobeam-exact`, which nothing here uses. The results that the solver must satisfy are
//! derived in [`theory`]. The crate does no input or output and starts no threads. Every failure is
//! a value of a type in [`error`], and a failed step leaves the motion at its last level.
//!
//! ```
//! use thermobeam::mesh::Mesh;
//! use thermobeam::parameters::{Beam, Obstacles};
//! use thermobeam::scheme::EULER_CRANK_NICOLSON;
//! use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
//! use thermobeam::solve::Settings;
//!
//! // The paper's beam with an upward initial velocity reaches its upper obstacle.
//! let mesh = Mesh::uniform(50)?;
//! let mut initial = InitialValues::at_rest(&mesh, 0.0);
//! initial.u_t = mesh.nodes().iter().map(|x| 20.0 * x * (x - 1.0) * (x - 1.0)).collect();
//! let problem = Problem { beam: Beam::default(), obstacles: Some(Obstacles::default()), mesh, initial };
//! let stepping = Stepping { scheme: EULER_CRANK_NICOLSON, settings: Settings::default(), dt: 1e-3, loaded: false };
//! let mut simulation = OneStep::new(problem, stepping)?;
//! let mut old = simulation.level();
//! let mut touched = false;
//! for _ in 0..300 {
//!     simulation.step_once()?;
//!     let new = simulation.level();
//!     touched |= new.contact_force > 0.0;
//!     // Proposition 3.1: the energy does not rise.
//!     assert!(simulation.balance(&old, &new).change <= 0.0);
//!     old = new;
//! }
//! assert!(touched);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![allow(clippy::disallowed_methods, reason = "what steps beams is here")]

mod block_tridiagonal;
pub mod bracket;
pub mod contact;
pub mod contraction;
pub mod dg;
pub mod energy;
pub mod ensemble;
pub mod error;
pub mod kirchhoff;
mod lanes;
mod level;
pub mod linearized;
pub mod mesh;
pub mod motion;
pub mod norms;
pub mod one_step;
pub mod parameters;
pub mod scheme;
pub mod solve;
pub mod tridiagonal;

/// [energy]: crate::energy
/// [contraction]: crate::contraction
/// [linearized]: crate::linearized
/// [equilibrium]: ../../thermobeam_exact/equilibrium/index.html
/// [completeness]: ../../thermobeam_exact/equilibrium/enum.Completeness.html
/// [vibration]: ../../thermobeam_exact/vibration/index.html
/// [dg]: crate::dg
// The links above are for rustdoc, those at the end of THEORY.md for readers of that file.
#[doc = include_str!("../THEORY.md")]
pub mod theory {}
