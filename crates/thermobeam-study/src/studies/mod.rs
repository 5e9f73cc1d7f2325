//! The studies in code: a page each, which reads like its paragraph of the paper: runs, then the
//! numbers that they show, and what these must be. A study with several files is a kind instead.

pub mod dependence;
mod prelude;
pub mod solutions;
pub mod written;

use convergence_study::CodeStudy;

/// All of them.
pub const STUDIES: [CodeStudy; 3] = [
    CodeStudy {
        home: dependence::ABOUT.home,
        study: || Box::new(dependence::study()),
    },
    CodeStudy {
        home: solutions::ABOUT.home,
        study: || Box::new(solutions::study()),
    },
    CodeStudy {
        home: written::ABOUT.home,
        study: || Box::new(written::study()),
    },
];
