//! Shares of a sweep, and how they are joined.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::SweepError;
use super::lines::{Header, LineReader};
use convergence_study::atomic;

/// The file of a folder: a line that names the sweep, and one for each case in their order.
pub const RESULTS: &str = "results.jsonl";

/// Share k of n, k from 1 to n; 1/1 is the whole sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct SweepShare {
    number: usize,
    count: usize,
}

impl SweepShare {
    /// The whole sweep.
    pub const ALL: Self = Self {
        number: 1,
        count: 1,
    };

    /// The number of the share that holds a case. Of each n successive cases a share has one, each
    /// time at another place, so that no share has a value of the key that runs fastest for itself.
    fn number_of(case: usize, count: usize) -> usize {
        (case % count + case / count) % count + 1
    }

    /// Its cases out of so many.
    pub fn cases(self, cases: usize) -> impl Iterator<Item = usize> {
        (0..cases).filter(move |&case| Self::number_of(case, self.count) == self.number)
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

impl TryFrom<String> for SweepShare {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<SweepShare> for String {
    fn from(share: SweepShare) -> Self {
        share.to_string()
    }
}

impl fmt::Display for SweepShare {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

/// A finished file of results.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finished {
    /// Cases in the file.
    pub cases: usize,
    /// How many of them failed.
    pub failed: usize,
    /// The file, with a line for each case.
    pub results: PathBuf,
}

/// The open files of all shares, by their numbers.
struct Shares {
    header: Header,
    files: BTreeMap<usize, LineReader>,
}

impl Shares {
    /// Opens the file of each folder. All must be of one sweep, and each share must be there once.
    fn open(folders: &[PathBuf]) -> Result<Self, SweepError> {
        let Some((first, others)) = folders.split_first() else {
            return Err(io::Error::other("no folder of a share").into());
        };
        let (lines, header) = LineReader::open(first)?;
        let SweepShare { number, count } = header.share;
        let mut files = BTreeMap::from([(number, lines)]);
        for folder in others {
            let (lines, found) = LineReader::open(folder)?;
            let number = found.share.number;
            let share = SweepShare { number, count };
            lines.check(
                &found,
                &Header {
                    share,
                    ..header.clone()
                },
            )?;
            if files.contains_key(&number) {
                let found = format!("the share {share} a second time");
                return Err(lines.refuse("each share once", found));
            }
            files.insert(number, lines);
        }
        match (1..=count).find(|number| !files.contains_key(number)) {
            None => Ok(Self { header, files }),
            Some(number) => Err(SweepError::Refused {
                place: first.display().to_string(),
                expected: format!("beside it a folder for each share of {count}"),
                found: format!("none of the share {}", SweepShare { number, count }),
            }),
        }
    }

    /// Writes the lines of one run.
    fn join(&mut self, output: &mut impl Write) -> Result<(), SweepError> {
        let header = Header {
            share: SweepShare::ALL,
            ..self.header.clone()
        };
        writeln!(output, "{}", header.line())?;
        let count = self.header.share.count;
        for case in 0..header.cases {
            let number = SweepShare::number_of(case, count);
            // Every share from 1 to n has a file.
            let lines = self
                .files
                .get_mut(&number)
                .unwrap_or_else(|| unreachable!());
            if !lines.read(case)? {
                let found = format!("the end; run the share {number}/{count} again");
                return Err(lines.refuse(&format!("the line of case {case}"), found));
            }
            output.write_all(&lines.line)?;
        }
        self.files.values_mut().try_for_each(LineReader::finish)?;
        Ok(output.flush()?)
    }
}

/// Joins the shares in `folders` into [`RESULTS`] in the folder `out`, the file that a single run
/// would have written.
///
/// # Errors
/// [`SweepError`]: folders of different sweeps, a missing, repeated or foreign share or line,
/// results in `out`, a file that cannot be read or written. Nothing is written then.
pub fn merge(folders: &[PathBuf], out: &Path) -> Result<Finished, SweepError> {
    let results = out.join(RESULTS);
    if results.exists() {
        return Err(SweepError::Refused {
            place: results.display().to_string(),
            expected: "no file there before the shares are joined".to_owned(),
            found: "one; choose another folder, or remove it".to_owned(),
        });
    }
    // Once without writing, so that nothing is written where something is wrong.
    let mut shares = Shares::open(folders)?;
    shares.join(&mut io::sink())?;
    let finished = Finished {
        cases: shares.header.cases,
        failed: shares.files.values().map(|lines| lines.failed).sum(),
        results,
    };
    atomic::prepare_folder(out)?;
    let mut shares = Shares::open(folders)?;
    atomic::write_with(&finished.results, |file| {
        shares.join(file).map_err(io::Error::other)
    })?;
    Ok(finished)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_is_written_as_it_is_read_and_nonsense_is_refused() {
        for text in ["1/1", "3/8", "8/8"] {
            assert_eq!(text.parse::<SweepShare>().unwrap().to_string(), text);
        }
        for text in ["", "1", "0/8", "9/8", "1/0", "-1/8", "a/b", "1/2/3"] {
            assert!(text.parse::<SweepShare>().is_err(), "{text}");
        }
    }

    #[test]
    fn each_case_is_in_one_share_and_no_share_has_a_value_for_itself() {
        for count in [1, 2, 3, 8, 150] {
            let mut all = vec![];
            for number in 1..=count {
                let mine: Vec<usize> = SweepShare { number, count }.cases(1000).collect();
                assert!((1000 / count..=1000_usize.div_ceil(count)).contains(&mine.len()));
                assert!(mine.is_sorted());
                all.extend(mine);
            }
            all.sort_unstable();
            assert!(all.into_iter().eq(0..1000), "{count} shares");
        }
        // A last key of as many values as there are shares: each share has each of its values.
        for number in 1..=8 {
            let share = SweepShare { number, count: 8 };
            let mut places: Vec<usize> = share.cases(64).map(|case| case % 8).collect();
            places.sort_unstable();
            assert!(places.into_iter().eq(0..8), "{share}");
        }
    }
}
