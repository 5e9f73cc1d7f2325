//! The numbers of a scene that a sweep may vary, a case with its number and their values, and the
//! share derived from them.

use std::fmt;
use std::str::FromStr;

use serde::ser::{Serialize, SerializeMap, Serializer};

use convergence_study::internal::store::content_hash;

/// A numeric key of a scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SceneKey {
    /// The table, such as `beam`.
    pub table: &'static str,
    /// The key in it, such as `beta`.
    pub name: &'static str,
    /// Whether its values are whole numbers.
    pub is_whole: bool,
}

const fn key(table: &'static str, name: &'static str, is_whole: bool) -> SceneKey {
    SceneKey {
        table,
        name,
        is_whole,
    }
}

/// All keys, in the order in which a case lists them.
pub(super) const KEYS: [SceneKey; 17] = [
    key("beam", "zeta", false),
    key("beam", "a", false),
    key("beam", "rho", false),
    key("beam", "beta", false),
    key("beam", "theta_a", false),
    key("obstacles", "epsilon", false),
    key("obstacles", "g1", false),
    key("obstacles", "g2", false),
    key("mesh", "elements", true),
    key("mesh", "degree", true),
    key("time", "dt", false),
    key("time", "t_end", false),
    key("time", "tolerance", false),
    key("time", "max_iterations", true),
    key("time", "degree", true),
    key("time", "restart_dt", false),
    key("time", "growth", false),
];

/// The tables that have numeric keys.
pub(super) const TABLES: [&str; 4] = ["beam", "obstacles", "mesh", "time"];

impl SceneKey {
    /// The dotted name, such as `beam.beta`.
    pub fn path(self) -> String {
        format!("{}.{}", self.table, self.name)
    }

    /// Whether it is the key with that table and name.
    pub(super) fn is(self, table: &str, name: &str) -> bool {
        self.table == table && self.name == name
    }

    /// A value as TOML, JSON and expressions write it; reading it back gives the same bits.
    pub(super) fn written(self, value: f64) -> String {
        if self.is_whole {
            format!("{value:.0}")
        } else {
            format!("{value:?}")
        }
    }
}

/// A case; its JSON is that of its parameters, with keys in the fixed order of a scene file.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepCase<'s> {
    /// Its number, from 0.
    pub index: usize,
    keys: &'s [SceneKey],
    values: Vec<f64>,
}

impl<'s> SweepCase<'s> {
    pub(super) fn new(index: usize, keys: &'s [SceneKey], values: Vec<f64>) -> Self {
        Self {
            index,
            keys,
            values,
        }
    }

    /// The varied keys, each with this case's value.
    pub fn parameters(&self) -> impl Iterator<Item = (SceneKey, f64)> + '_ {
        self.keys.iter().copied().zip(self.values.iter().copied())
    }

    /// One line of JSON which is the same for the same parameters, on every machine.
    pub fn canonical(&self) -> String {
        let pairs = self
            .parameters()
            .map(|(key, value)| format!("\"{}\":{}", key.path(), key.written(value)));
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
            // Integers were read as such and are far below 2^53.
            if key.is_whole {
                map.serialize_entry(&key.path(), &(value as u64))?;
            } else {
                map.serialize_entry(&key.path(), &value)?;
            }
        }
        map.end()
    }
}

/// Share k of n, k from 1 to n; 1/1 is the whole sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SweepShare {
    number: u64,
    count: u64,
}

impl SweepShare {
    /// The whole sweep.
    pub const ALL: Self = Self {
        number: 1,
        count: 1,
    };

    /// Whether it holds a case with this
    /// [`content_hash`](convergence_study::internal::store::content_hash): exactly one share does.
    pub fn holds(self, hash: u64) -> bool {
        hash % self.count == self.number - 1
    }
}

impl FromStr for SweepShare {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let share = text.split_once('/').and_then(|(number, count)| {
            let share = Self {
                number: number.parse().ok()?,
                count: count.parse().ok()?,
            };
            (1..=share.count).contains(&share.number).then_some(share)
        });
        share.ok_or_else(|| format!("expected k/n with 1 <= k <= n, such as 3/8; found {text:?}"))
    }
}

impl fmt::Display for SweepShare {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::tables;

    #[test]
    fn every_coefficient_can_be_varied() {
        let names = |table| {
            KEYS.iter()
                .filter(|key| key.table == table)
                .map(|key| key.name)
                .collect::<Vec<_>>()
        };
        assert_eq!(
            names("beam"),
            convergence_keys::names(&[&tables::BEAM_KEYS])
        );
        assert_eq!(
            names("obstacles"),
            convergence_keys::names(&[&tables::OBSTACLE_KEYS])
        );
        assert!(KEYS.iter().all(|key| TABLES.contains(&key.table)));
    }

    #[test]
    fn the_hash_never_changes() {
        // Computed by an independent program; running shares depend on it.
        assert_eq!(content_hash(b""), 0xC381_7C01_6BA4_FF30);
        assert_eq!(content_hash(b"{\"beam.beta\":0.5}"), 0xC5F6_866D_E049_E3BB);
    }

    #[test]
    fn a_share_is_written_as_it_is_read_and_nonsense_is_refused() {
        for text in ["1/1", "3/8", "8/8"] {
            assert_eq!(text.parse::<SweepShare>().unwrap().to_string(), text);
        }
        for text in ["", "1", "0/8", "9/8", "1/0", "-1/8", "a/b", "1/2/3"] {
            assert!(text.parse::<SweepShare>().is_err(), "{text}");
        }
    }
}
