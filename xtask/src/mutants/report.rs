//! `reports/mutants.md`.

use std::collections::BTreeMap;
use std::fmt::Write;

use convergence_study::report::markdown;
use convergence_study::store::provenance::Provenance;
use convergence_study::study::outcome::Table;

use super::accepted::Accepted;
use super::judge::Judged;
use super::list::{Mutant, PACKAGES};

/// A mutant of the sample and what became of it; `None` where it is still open.
type Finding<'m> = (&'m Mutant, Option<Judged>);

/// How many came to which end.
#[derive(Debug, Default, Clone, Copy)]
struct Counts {
    caught: usize,
    timeout: usize,
    accepted: usize,
    missed: usize,
    unviable: usize,
    open: usize,
}

impl Counts {
    fn of<'f>(findings: impl IntoIterator<Item = &'f Finding<'f>>, accepted: &Accepted) -> Self {
        let mut counts = Self::default();
        for (mutant, judged) in findings {
            *match judged {
                Some(Judged::Caught) => &mut counts.caught,
                Some(Judged::Timeout) => &mut counts.timeout,
                Some(Judged::Unviable) => &mut counts.unviable,
                Some(Judged::Missed) if accepted.reason(mutant).is_some() => &mut counts.accepted,
                Some(Judged::Missed) => &mut counts.missed,
                None => &mut counts.open,
            } += 1;
        }
        counts
    }

    /// Share of those noticed among those that could be: what does not compile is no mistake anybody could make.
    fn rate(&self) -> String {
        let noticed = self.caught + self.timeout;
        match noticed + self.accepted + self.missed {
            0 => "-".to_owned(),
            viable => format!("{:.1} %", 100.0 * noticed as f64 / viable as f64),
        }
    }

    fn row(&self, file: &str) -> Vec<String> {
        let Self { caught, timeout, accepted, missed, unviable, open } = self;
        let counts = [caught, timeout, accepted, missed, unviable, open].map(ToString::to_string);
        [file.to_owned()].into_iter().chain(counts).chain([self.rate()]).collect()
    }
}

/// The outcome in one line.
pub(super) fn sentence(findings: &[Finding<'_>], accepted: &Accepted) -> String {
    let counts = Counts::of(findings, accepted);
    let Counts { caught, timeout, accepted, missed, unviable, open } = counts;
    format!(
        "{} mutants: {caught} caught, {timeout} timed out, {accepted} accepted with a reason, {missed} missed, \
         {unviable} unviable, {open} open; noticed: {}",
        findings.len(),
        counts.rate()
    )
}

/// The page.
pub(super) fn page(
    findings: &[Finding<'_>],
    all: &[Mutant],
    seed: u64,
    accepted: &Accepted,
    here: &Provenance,
) -> String {
    let mut page =
        "# Mutation testing\n\nWritten by `cargo xtask dev mutants`. One mistake at a time is planted in the \
                    solver and in the code of fits, verdicts and exact solutions; it is caught where a test of its own \
                    package fails, or else the quick tier of `verify`.\n\n"
            .to_owned();
    page += &format!("{}\n\n", here.sentences().join(" "));
    let of = |package: &str| {
        let all = all.iter().filter(|mutant| mutant.target.package == package).count();
        let judged = findings.iter().filter(|(mutant, _)| mutant.target.package == package).count();
        format!("{judged} of {all} mutants of `{package}`")
    };
    let drawn = if findings.len() == all.len() {
        String::new()
    } else {
        format!(" so far: file by file, and a sample drawn at random, seed {seed}")
    };
    let sample = format!("{}{drawn}.", PACKAGES.map(of).join(", "));
    let mut files: BTreeMap<&str, Vec<&Finding<'_>>> = BTreeMap::new();
    findings.iter().for_each(|finding| files.entry(&finding.0.file).or_default().push(finding));
    let mut rows: Vec<_> = files.into_iter().map(|(file, findings)| Counts::of(findings, accepted).row(file)).collect();
    rows.push(Counts::of(findings, accepted).row("all"));
    let head = ["file", "caught", "timed out", "accepted", "missed", "unviable", "open", "noticed"];
    let _ = write!(page, "{sample}\n\n{}", table(&head, rows));
    page +=
        "\nA mutant that times out has been noticed. Noticed is the share of those that compile.\n\n## Survivors\n\n";
    let survivors: Vec<_> = findings.iter().filter(|(_, judged)| *judged == Some(Judged::Missed)).collect();
    if survivors.is_empty() {
        page += "None.\n";
        return page;
    }
    let row = |(mutant, _): &&Finding<'_>| {
        let Mutant { file, what, code, .. } = mutant;
        [file, what, &format!("`{code}`"), accepted.reason(mutant).unwrap_or("none")].map(str::to_owned).to_vec()
    };
    page + &table(&["file", "mutation", "line", "reason"], survivors.iter().map(row).collect())
}

fn table(head: &[&str], rows: Vec<Vec<String>>) -> String {
    markdown(&Table { title: String::new(), head: head.iter().map(|&name| name.to_owned()).collect(), rows })
}
