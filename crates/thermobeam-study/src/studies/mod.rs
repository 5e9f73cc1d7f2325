//! The studies in code: a page each, which reads like its paragraph of the paper: runs, then the
//! numbers that they show, and what these must be. A study with several files is a kind instead.

pub mod bifurcation;
pub mod dependence;
pub mod equilibria;
mod paper;
mod prelude;
pub mod projection;
pub mod rigid;
pub mod solutions;
pub mod written;

use convergence_study::{About, CodeStudy, Study};

/// All of them.
pub const STUDIES: [CodeStudy; 8] = [
    listed(bifurcation::ABOUT, || Box::new(bifurcation::study())),
    listed(dependence::ABOUT, || Box::new(dependence::study())),
    listed(equilibria::ABOUT, || Box::new(equilibria::study())),
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
