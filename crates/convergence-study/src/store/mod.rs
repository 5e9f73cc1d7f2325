//! What a run compares with and leaves behind: baseline, records, JUnit, provenance, and files written as one set.

pub mod atomic;
pub mod baseline;
mod content;
pub mod file_set;
pub mod junit;
pub mod provenance;
pub mod record;
pub mod regular;
pub mod writing;

pub use content::content_hash;
