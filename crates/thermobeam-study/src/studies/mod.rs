//! The studies in code: a page each, which reads like its paragraph of the paper: runs, then the
//! numbers that they show, and what these must be. A study with several files is a kind instead.

pub mod bifurcation;
pub mod dependence;
pub mod equilibria;
pub mod experiments;
pub mod faults;
mod paper;
mod prelude;
pub mod projection;
pub mod rigid;
pub mod solutions;
mod steady;
pub mod written;

use convergence_study::Study;
use experiments::digits;

/// All of them.
pub const STUDIES: [fn() -> Box<dyn Study>; 15] = [
    || Box::new(bifurcation::study()),
    || Box::new(dependence::study()),
    || Box::new(equilibria::study()),
    || Box::new(experiments::study()),
    || Box::new(experiments::full()),
    || Box::new(digits::study()),
    || Box::new(digits::error()),
    || Box::new(digits::small_viscosity()),
    || Box::new(faults::study()),
    || Box::new(faults::any_order()),
    || Box::new(projection::study()),
    || Box::new(projection::graded()),
    || Box::new(rigid::study()),
    || Box::new(solutions::study()),
    || Box::new(written::study()),
];
