//! Shares of a sweep: the values of a case determine its share, not its position in the file.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

/// Share k of n, k from 1 to n; 1/1 is the whole sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    number: u64,
    of: u64,
}

/// A text that is not a share.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("expected k/n with 1 <= k <= n, such as 3/8; found {found:?}")]
pub struct ShareError {
    found: String,
}

impl Share {
    /// The whole sweep.
    pub const ALL: Self = Self { number: 1, of: 1 };

    /// Whether a case with this [`content_hash`](convergence_study::store::content_hash) belongs to it: to exactly one of n shares.
    pub fn holds(self, hash: u64) -> bool {
        hash % self.of == self.number - 1
    }
}

impl FromStr for Share {
    type Err = ShareError;

    fn from_str(text: &str) -> Result<Self, ShareError> {
        let share = text.split_once('/').and_then(|(number, of)| {
            let share = Self { number: number.parse().ok()?, of: of.parse().ok()? };
            (1..=share.of).contains(&share.number).then_some(share)
        });
        share.ok_or_else(|| ShareError { found: text.to_owned() })
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use convergence_study::store::content_hash;

    use super::*;

    #[test]
    fn the_hash_never_changes() {
        // Computed by an independent program; shares of runs that are under way depend on it.
        assert_eq!(content_hash(b""), 0xC381_7C01_6BA4_FF30);
        assert_eq!(content_hash(b"{\"beam.beta\":0.5}"), 0xC5F6_866D_E049_E3BB);
    }

    #[test]
    fn a_share_is_written_as_it_is_read_and_nonsense_is_refused() {
        for text in ["1/1", "3/8", "8/8"] {
            assert_eq!(text.parse::<Share>().unwrap().to_string(), text);
        }
        for text in ["", "1", "0/8", "9/8", "1/0", "-1/8", "a/b", "1/2/3"] {
            assert!(text.parse::<Share>().is_err(), "{text}");
        }
    }
}
