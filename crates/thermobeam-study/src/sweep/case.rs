//! One case of a sweep: its number and the values of the keys that vary.

use serde::ser::{Serialize, SerializeMap, Serializer};

use super::Key;
use convergence_study::store::content_hash;

/// A case; its JSON is that of its parameters, keys in the fixed order of a scene file.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepCase<'s> {
    /// Its number, from 0.
    pub index: usize,
    keys: &'s [Key],
    values: Vec<f64>,
}

impl<'s> SweepCase<'s> {
    pub(super) fn new(index: usize, keys: &'s [Key], values: Vec<f64>) -> Self {
        Self { index, keys, values }
    }

    /// The keys that vary, each with this case's value.
    pub fn parameters(&self) -> impl Iterator<Item = (Key, f64)> + '_ {
        self.keys.iter().copied().zip(self.values.iter().copied())
    }

    /// One line of JSON which is the same for the same parameters, on every machine.
    pub fn canonical(&self) -> String {
        let pairs = self.parameters().map(|(key, value)| format!("\"{}\":{}", key.path(), key.written(value)));
        format!("{{{}}}", pairs.collect::<Vec<_>>().join(","))
    }

    /// The hash of [`SweepCase::canonical`], which determines the share of the case.
    pub fn hash(&self) -> u64 {
        content_hash(self.canonical().as_bytes())
    }
}

impl Serialize for SweepCase<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.values.len()))?;
        for (key, value) in self.parameters() {
            // Whole numbers were read as such and are far below 2^53.
            if key.is_whole {
                map.serialize_entry(&key.path(), &(value as u64))?;
            } else {
                map.serialize_entry(&key.path(), &value)?;
            }
        }
        map.end()
    }
}
