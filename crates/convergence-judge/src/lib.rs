//! The judge of `convergence-study`: from steps and errors to a rate with an interval, and from a
//! rate and a claim to a verdict.
//!
//! [`judge`] is the rule; it writes numbers with [`text`], and cases ask [`time_limit`] for the
//! time left. `convergence-study` re-exports all three. It is a crate of its own because only this
//! part is worth optimising: the rest of the harness reads, draws and writes.

pub mod time_limit;

/// From steps and errors to a rate with an interval, and from a rate and a claim to a verdict.
pub mod judge {
    pub mod claims;
    pub mod fit;
    pub mod grid;
    pub mod random;
    pub mod richardson;
    pub mod shown;
    pub mod verdict;
}

/// Numbers, columns and names as text.
pub mod text {
    pub mod columns;
    pub mod json;
    pub mod lists;
    #[cfg(feature = "names")]
    pub mod names;
    pub mod number;
    pub mod visible;
}
