//! Numbers, columns and names as text.

pub mod columns;
pub mod names;
pub mod number;
pub mod visible;
