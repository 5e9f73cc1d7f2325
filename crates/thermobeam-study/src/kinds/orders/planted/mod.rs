//! A study repeated with a planted fault: would it be noticed?

pub(crate) mod fault;
pub(crate) mod plantable;
mod sources;
pub(in crate::kinds) mod untested;
