//! Numbers, columns and names as text.

pub(crate) mod columns;
pub mod names;
pub mod number;
pub mod visible;
