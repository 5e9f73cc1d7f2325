//! Exact solutions for the [`thermobeam`] solver: functions given as text, loads derived from them,
//! and errors.
//!
//! With `u = Σ X_j(x) T_j(t)`, `φ = Σ Y_k S_k`, `θ = Σ Z_l Q_l`, every load of the scheme is a sum
//! of time coefficients times space vectors that are computed once, and every error norm is a few
//! dot products. A step then needs a few vector operations instead of quadrature.
//!
//! * [`expression`]: functions of one variable, with exact derivatives.
//! * [`function`]: any function with two derivatives, as a factor of a product.
//! * [`solution`]: the sums of products, and T, T', T'' and the like at one time, exact or in the
//!   scheme's time-discrete form.
//! * [`sources`]: the space vectors, from the strong form (1.1) or from the discrete matrices.
//! * [`errors`]: the errors in each [`norm`].
//! * [`any_order`]: the same for elements of any degree.
//! * [`equilibrium`], [`vibration`]: steady states and free vibrations in closed form, without
//!   loads.
//! * [`assembly`]: the matrices of P1 elements.
//! * [`dense`]: solutions, eigenvalues and spectral radii of dense matrices.
//! * [`quadrature`]: the rule for loads and errors.
//! * [`formulas`]: N(u), the contact law and the formulas of the time schemes, not those of the
//!   solver.
//! * [`projection`]: the projections of (3.4) and (3.5), by their definition.
//! * [`constants`]: the constants of Theorem 3.4, known before a run.
//! * [`defect`]: deliberate mistakes in the loads.
//!
//! Of the solver this crate uses data types (coefficients, meshes, levels, initial data), the basis
//! of [`Space`](thermobeam::dg::Space) and [bisection](thermobeam::bracket), and for the
//! frequencies of a mesh the matrices of its elements, which those frequencies judge: otherwise
//! what judges shares no function with what is judged. The solver does not depend on this crate, so
//! it cannot use its own answers.
//!
//! The code that runs in every step of a convergence study is a separate crate, because it is
//! compiled with optimisation and the code that reads files and reports is not: a clean build takes
//! a fifth less time.

pub mod any_order;
pub mod assembly;
pub mod constants;
pub mod defect;
pub mod dense;
pub mod equilibrium;
pub mod errors;
pub mod expression;
pub mod formulas;
pub mod function;
pub mod interval;
pub mod norm;
pub mod projection;
pub mod quadrature;
pub mod solution;
pub mod sources;
mod stumpff;
pub mod vibration;

/// The code of the README, run by the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
