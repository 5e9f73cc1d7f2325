//! Commands that take minutes: they announce their duration and report their progress.

use std::fs;
use std::path::Path;
use std::time::Instant;

use super::output;
use crate::run;
use crate::store::provenance::Provenance;

/// A command that takes minutes, and writes the page that records how many.
#[derive(Debug)]
pub struct LongRun {
    started: Instant,
    /// Seconds of the run that wrote the existing page.
    before: Option<f64>,
    quiet: bool,
}

impl LongRun {
    /// Starts the clock, and says how long the run took that wrote the existing page.
    /// * `what`: the work, in words.
    /// * `what`: what is done, in words.
    /// * `page`: written by an earlier run, with [`ended`](Self::ended) in it.
    pub fn begin(what: &str, page: &Path, quiet: bool) -> Self {
        let before = fs::read_to_string(page).ok().and_then(|text| seconds(&text));
        let run = Self { started: Instant::now(), before, quiet };
        let known = match before {
            Some(before) => format!("took {before:.0} s when {} was written", page.display()),
            None => format!("minutes; how many is not known: {} does not say", page.display()),
        };
        run.tell(&format!("{what}: {known}"));
        run
    }

    /// Says what has been done, and the time since the start.
    pub fn done(&self, what: &str) {
        let of = self.before.map_or(String::new(), |before| format!(" of about {before:.0}"));
        self.tell(&format!("{what}, at {:.0}{of} s", self.started.elapsed().as_secs_f64()));
    }

    /// Where and when the run was made and how long it took, for the page.
    ///
    /// * `root`: the project's folder.
    pub fn ended(&self, root: &Path) -> String {
        let here = Provenance::collect(root, String::new(), run::available().get(), &[]);
        let took = sentence(self.started.elapsed().as_secs_f64());
        here.sentences().into_iter().chain([took]).collect::<Vec<_>>().join(" ")
    }

    fn tell(&self, message: &str) {
        if !self.quiet {
            output::tell(message);
        }
    }
}

const BEFORE: &str = "It took ";
const AFTER: &str = " s.";

fn sentence(seconds: f64) -> String {
    format!("{BEFORE}{seconds:.0}{AFTER}")
}

/// The seconds in the [`sentence`] of a page.
fn seconds(page: &str) -> Option<f64> {
    let (number, _) = page.split_once(BEFORE)?.1.split_once(AFTER)?;
    number.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::{seconds, sentence};

    #[test]
    fn the_next_run_reads_what_the_page_says() {
        let page = format!("# Drift\n\nWritten by a program. {}\n\n| a | b |\n", sentence(143.4));
        assert_eq!(seconds(&page), Some(143.0));
        for without in ["", "It took long.", "It took x s."] {
            assert_eq!(seconds(without), None, "{without}");
        }
    }
}
