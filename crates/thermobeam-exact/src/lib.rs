//! Exact solutions for the [`thermobeam`] solver: functions as text, sources that are derived from them, errors against them.
//!
//! With `u = Σ X_j(x) T_j(t)`, `φ = Σ Y_k S_k`, `θ = Σ Z_l Q_l`, every load of the scheme is a sum of a time coefficient
//! times a space vector that is computed once, and every error norm is a few dot products. A step then costs a few vector
//! updates instead of quadrature.
//!
//! * [`expression`]: functions of one variable, with exact derivatives.
//! * [`function`]: any function with two derivatives, of which a product is made.
//! * [`solution`]: the sums of products.
//! * [`factors`]: T, T', T'' and their like at one time, exact or as the scheme sees them.
//! * [`sources`]: the space vectors, from the strong form (1.1) or from the discrete matrices.
//! * [`errors`]: the errors in each [`norm`].
//! * [`quadrature`]: errors against functions that are no sum of products.
//!
//! What runs in every step of a convergence study is here, in a crate of its own: this one is optimised for speed, and what
//! reads files, draws and reports on it is not, which makes a clean build a fifth shorter.

pub mod errors;
pub mod expression;
pub mod factors;
pub mod function;
pub mod nearest;
pub mod norm;
pub mod quadrature;
pub mod solution;
pub mod sources;

/// The code of the README, held by the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
