//! Common imports of the studies in code.

pub(super) use crate::kinds::prelude::largest_of;
pub(super) use convergence_study::{
    About, Case, CaseFailure, Described, Findings, InCode, Measured, Must, Runs, Sheet, Tier,
    measured,
};
