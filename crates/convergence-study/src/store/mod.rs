//! What a run compares with and leaves behind: baseline, records, JUnit, provenance, and files written as one set.

pub mod atomic;
pub mod baseline;
pub mod diagnosis;
pub mod file_set;
pub mod junit;
pub mod provenance;
pub mod record;
pub mod regular;
pub mod work;
pub mod writing;

use std::io;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use crate::judge::random::SplitMix;
use crate::text::visible;

/// A file of the harness that cannot be read or written.
#[derive(Debug, Error)]
pub enum StoreError {
    /// The file cannot be read or written.
    #[error("{}: {error}", visible::path(.path))]
    File {
        /// The file.
        path: PathBuf,
        /// What was wrong.
        error: io::Error,
    },
    /// Another form.
    #[error("{}: {}; {expected}", visible::path(.path), visible::visible(&.error.to_string()))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What was wrong, with line and column.
        error: serde_json::Error,
        /// What is expected, or what to do.
        expected: &'static str,
    },
    /// Written by a version with another form.
    #[error("{}: schema: found {found}; expected {expected}", visible::path(.path))]
    Schema {
        /// The file.
        path: PathBuf,
        /// The version found.
        found: u32,
        /// The version that is read.
        expected: &'static str,
    },
}

/// What a file holds in the form of a schema. Another schema has other keys, so the number is read first.
///
/// * `expected`: what to do about a file of another form, and about another schema.
pub(crate) fn parsed<T: DeserializeOwned>(
    text: &str,
    path: &Path,
    schema: u32,
    expected: [&'static str; 2],
) -> Result<T, StoreError> {
    #[derive(Deserialize)]
    struct Version {
        schema: u32,
    }
    let path = path.to_owned();
    match serde_json::from_str(text) {
        Ok(Version { schema: found }) if found != schema => {
            Err(StoreError::Schema { path, found, expected: expected[1] })
        }
        Ok(_) => {
            serde_json::from_str(text).map_err(|error| StoreError::Malformed { path, error, expected: expected[0] })
        }
        Err(error) => Err(StoreError::Malformed { path, error, expected: expected[0] }),
    }
}

/// What a JSON file holds; nothing where it is not there.
///
/// * `expected`: what to do about a file that cannot be parsed.
pub(crate) fn read_if_there<T: DeserializeOwned + Default>(
    path: &Path,
    expected: &'static str,
) -> Result<T, StoreError> {
    let path = path.to_owned();
    match regular::read_to_string(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(T::default()),
        Err(error) => Err(StoreError::File { path, error }),
        Ok(text) => serde_json::from_str(&text).map_err(|error| StoreError::Malformed { path, error, expected }),
    }
}

/// A 64-bit hash that is the same on every machine and in every version: FNV-1a, its bits mixed by splitmix64.
///
/// Not cryptographic. With FNV alone the low bits of similar texts would be correlated.
pub fn content_hash(bytes: &[u8]) -> u64 {
    const OFFSET: u64 = 0xCBF2_9CE4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01B3;
    let fnv = bytes.iter().fold(OFFSET, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(PRIME));
    SplitMix::new(fnv).next_u64()
}
