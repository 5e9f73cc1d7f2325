//! A study repeated with a planted fault: would it be noticed?

pub(in crate::kinds) mod fault;
pub(in crate::kinds) mod plantable;
pub(in crate::kinds) mod untested;
