//! Numbers, columns and names as text.

#[cfg(feature = "reports")]
pub(crate) mod columns;
pub(crate) mod json;
pub mod lists;
#[cfg(feature = "files")]
pub mod names;
pub mod number;
pub mod visible;
