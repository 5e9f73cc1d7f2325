//! Lines of results in files: finding, sorting and copying them.
//!
//! The lines stay on disk; memory holds their positions, 40 bytes a case.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::SweepError;
use convergence_study::store::atomic;

/// Where a line is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) case: usize,
    pub(super) passed: bool,
    file: usize,
    offset: u64,
    bytes: u64,
}

/// The part of a line that is read.
#[derive(Deserialize)]
struct Head<'a> {
    case: usize,
    status: &'a str,
}

/// The places of all complete lines of a file, and the offset at which they end; an incomplete line may follow.
pub(super) fn places(path: &Path, file: usize, cases: usize) -> Result<(Vec<Place>, u64), SweepError> {
    let mut reader = BufReader::new(File::open(path).map_err(|error| atomic::naming(path, &error))?);
    let (mut places, mut offset, mut line) = (vec![], 0, vec![]);
    loop {
        line.clear();
        let bytes = reader.read_until(b'\n', &mut line).map_err(|error| atomic::naming(path, &error))? as u64;
        if line.last() != Some(&b'\n') {
            return Ok((places, offset));
        }
        let damaged =
            |reason: String| SweepError::Damaged { file: path.to_owned(), line: Some(places.len() + 1), reason };
        let head: Head<'_> =
            serde_json::from_slice(&line).map_err(|error| damaged(format!("not a line of results: {error}")))?;
        if head.case >= cases {
            return Err(damaged(format!("expected a case below {cases}, the number of cases, found {}", head.case)));
        }
        places.push(Place { case: head.case, passed: head.status == "done", file, offset, bytes });
        offset += bytes;
    }
}

/// Sorts by case.
///
/// # Errors
/// [`SweepError::Duplicate`] where a case has two lines.
pub(super) fn sort(places: &mut [Place], files: &[PathBuf]) -> Result<(), SweepError> {
    places.sort_by_key(|place| place.case);
    match places.windows(2).find(|pair| pair[0].case == pair[1].case) {
        None => Ok(()),
        Some(pair) => {
            let [first, second] = [pair[0], pair[1]].map(|place| files[place.file].clone());
            Err(SweepError::Duplicate { case: pair[0].case, first, second })
        }
    }
}

/// Writes the lines at `places` in that order.
pub(super) fn copy(places: &[Place], files: &[PathBuf], out: &Path) -> io::Result<()> {
    let open = |path: &PathBuf| File::open(path).map(BufReader::new).map_err(|error| atomic::naming(path, &error));
    let mut readers = files.iter().map(open).collect::<io::Result<Vec<_>>>()?;
    atomic::write_with(out, |output: &mut BufWriter<File>| {
        for place in places {
            let reader = &mut readers[place.file];
            // Relative, so that neighbours come from the buffer.
            let here = reader.stream_position()?;
            reader.seek_relative(place.offset.wrapping_sub(here) as i64)?;
            let copied = io::copy(&mut reader.take(place.bytes), output)?;
            if copied < place.bytes {
                return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "a file of results became shorter"));
            }
        }
        output.flush()
    })
}
