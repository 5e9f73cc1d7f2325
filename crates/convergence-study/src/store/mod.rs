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

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::judge::random::SplitMix;
use crate::text::visible;
use regular::if_there;

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
    /// The file has another format.
    #[error("{}: {}; {expected}", visible::path(.path), visible::visible(&.error.to_string()))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What was wrong, with line and column.
        error: serde_json::Error,
        /// What is expected, or what to do.
        expected: &'static str,
    },
    /// A version with another format wrote the file.
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

/// The content of a file. Another schema has other keys, so its number is read first.
///
/// * `schema`: its version, if it has one.
/// * `expected`: advice for a file with another format or schema.
pub(crate) fn parsed<T: DeserializeOwned>(
    text: &str,
    path: &Path,
    schema: Option<u32>,
    expected: [&'static str; 2],
) -> Result<T, StoreError> {
    #[derive(Deserialize)]
    struct Version {
        schema: u32,
    }
    let malformed = |error| StoreError::Malformed { path: path.to_owned(), error, expected: expected[0] };
    if let Some(schema) = schema {
        let Version { schema: found } = serde_json::from_str(text).map_err(malformed)?;
        if found != schema {
            return Err(StoreError::Schema { path: path.to_owned(), found, expected: expected[1] });
        }
    }
    serde_json::from_str(text).map_err(malformed)
}

/// The same for a file; `None` if it does not exist.
pub(crate) fn read_if_there<T: DeserializeOwned>(
    path: &Path,
    schema: Option<u32>,
    expected: [&'static str; 2],
) -> Result<Option<T>, StoreError> {
    let text = if_there(regular::read_to_string(path));
    let text = text.map_err(|error| StoreError::File { path: path.to_owned(), error })?;
    text.map(|text| parsed(&text, path, schema, expected)).transpose()
}

/// An object as JSON text with a line end, as in files; a number that is not finite becomes `null`, because JSON has none.
pub fn json(object: &impl Serialize) -> io::Result<String> {
    Ok(serde_json::to_string_pretty(object)? + "\n")
}

/// Writes an object to a file, atomically.
pub(crate) fn write_json(path: &Path, object: &impl Serialize) -> Result<(), StoreError> {
    let written = json(object).and_then(|text| atomic::write(path, text));
    written.map_err(|error| StoreError::File { path: path.to_owned(), error })
}

/// A 64-bit hash that is the same on every machine and in every version: FNV-1a, mixed by splitmix64.
///
/// Not cryptographic. With FNV alone the low bits of similar texts would be correlated.
pub fn content_hash(bytes: &[u8]) -> u64 {
    const OFFSET: u64 = 0xCBF2_9CE4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01B3;
    let fnv = bytes.iter().fold(OFFSET, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(PRIME));
    SplitMix::new(fnv).next_u64()
}
