//! What has been judged: one line a mutant and judge, written when it is known.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::Path;

use super::judge::{JUDGES, Judged};
use super::list::Mutant;

/// The outcomes known so far.
pub(super) struct Ledger {
    file: File,
    /// By the hash of the file and the mutant's name: what each judge said.
    known: HashMap<(u64, String), [Option<Judged>; JUDGES.len()]>,
}

impl Ledger {
    /// Opens it in the workspace's `target/mutants`.
    pub(super) fn open(root: &Path) -> io::Result<Self> {
        let path = root.join("target/mutants/outcomes.tsv");
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        let text = match fs::read_to_string(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
            text => text?,
        };
        let mut known: HashMap<_, [Option<Judged>; JUDGES.len()]> = HashMap::new();
        for (key, level, judged) in text.lines().filter_map(entry) {
            known.entry(key).or_insert([None; JUDGES.len()])[level] = Some(judged);
        }
        let mut file = OpenOptions::new().create(true).append(true).open(&path)?;
        if !text.is_empty() && !text.ends_with('\n') {
            // A line that a killed run has left torn is no entry; the next one begins on its own.
            file.write_all(b"\n")?;
        }
        Ok(Self { file, known })
    }

    /// Forgets who has missed a mutant; whether anybody has and nobody noticed it.
    pub(super) fn forget_missed(&mut self, mutant: &Mutant) -> bool {
        let Some(levels) = self.known.get_mut(&key(mutant)) else { return false };
        let is_missed = levels.iter().flatten().all(|judged| *judged == Judged::Missed);
        if is_missed {
            *levels = [None; JUDGES.len()];
        }
        is_missed
    }

    /// Keeps what a judge said.
    pub(super) fn add(&mut self, mutant: &Mutant, level: usize, judged: Judged) -> io::Result<()> {
        let line = format!("{:016x}\t{level}\t{}\t{}\n", mutant.text, judged.name(), mutant.name);
        self.file.write_all(line.as_bytes())?;
        self.known.entry(key(mutant)).or_insert([None; JUDGES.len()])[level] = Some(judged);
        Ok(())
    }

    /// Is a mutant still to be judged by this judge? Only if all judges before have missed it.
    pub(super) fn is_open(&self, mutant: &Mutant, level: usize) -> bool {
        let levels = self.known.get(&key(mutant)).copied().unwrap_or_default();
        levels[level].is_none() && levels[..level].iter().all(|judged| *judged == Some(Judged::Missed))
    }

    /// Has any judge seen this mutant?
    pub(super) fn is_begun(&self, mutant: &Mutant) -> bool {
        self.known.get(&key(mutant)).is_some_and(|levels| levels.iter().any(Option::is_some))
    }

    /// The last word on a mutant; `None` while it is open. One that is accepted need not be missed by more than the first
    /// judge.
    pub(super) fn of(&self, mutant: &Mutant, is_accepted: bool) -> Option<Judged> {
        let levels = self.known.get(&key(mutant)).copied().unwrap_or_default();
        if is_accepted {
            return levels.into_iter().flatten().last();
        }
        match levels.iter().find(|judged| **judged != Some(Judged::Missed)) {
            Some(judged) => *judged,
            None => Some(Judged::Missed),
        }
    }
}

fn key(mutant: &Mutant) -> (u64, String) {
    (mutant.text, mutant.name.clone())
}

fn entry(line: &str) -> Option<((u64, String), usize, Judged)> {
    let mut cells = line.splitn(4, '\t');
    let text = u64::from_str_radix(cells.next()?, 16).ok()?;
    let level = cells.next()?.parse().ok().filter(|level| *level < JUDGES.len())?;
    let judged = cells.next()?;
    let judged = Judged::ALL.iter().find(|(name, _)| *name == judged)?.1;
    Some(((text, cells.next()?.to_owned()), level, judged))
}
