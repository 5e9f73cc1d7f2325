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

use convergence_study::{About, CodeStudy, Study};
use experiments::digits;

/// All of them.
pub const STUDIES: [CodeStudy; 15] = [
    listed(bifurcation::ABOUT, || Box::new(bifurcation::study())),
    listed(dependence::ABOUT, || Box::new(dependence::study())),
    listed(equilibria::ABOUT, || Box::new(equilibria::study())),
    listed(experiments::ABOUT, || Box::new(experiments::study())),
    listed(experiments::FULL, || Box::new(experiments::full())),
    listed(digits::ABOUT, || Box::new(digits::study())),
    listed(digits::ERROR, || Box::new(digits::error())),
    listed(digits::SMALL_VISCOSITY, || {
        Box::new(digits::small_viscosity())
    }),
    listed(faults::ABOUT, || Box::new(faults::study())),
    listed(faults::ANY_ORDER, || Box::new(faults::any_order())),
    listed(projection::ABOUT, || Box::new(projection::study())),
    listed(projection::GRADED, || Box::new(projection::graded())),
    listed(rigid::ABOUT, || Box::new(rigid::study())),
    listed(solutions::ABOUT, || Box::new(solutions::study())),
    listed(written::ABOUT, || Box::new(written::study())),
];

const fn listed(about: About, study: fn() -> Box<dyn Study>) -> CodeStudy {
    let About { home, .. } = about;
    CodeStudy { home, study }
}
