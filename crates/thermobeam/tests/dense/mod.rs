//! The beam as dense matrices, written from the weak form (2.2) and the equations of a step, and
//! the solver against them.

mod exact;
mod iteration;
mod p1;
mod step;
mod system;

pub(crate) use iteration::{dense_iteration, spectral_radius};
pub(crate) use p1::P1Matrices;
