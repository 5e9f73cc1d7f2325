//! Orders of convergence: errors over levels of refinement, from several sources.

pub mod any_order;
pub mod frequencies;
pub mod manufactured;
pub mod self_convergence;
pub mod vibration;
