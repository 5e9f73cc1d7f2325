//! Numbers, columns and names as text.

pub mod columns;
pub mod json;
pub mod lists;
#[cfg(feature = "names")]
pub mod names;
pub mod number;
pub mod visible;
