//! `mutants`: the solver and the verdicts with one mistake at a time, to see whether the tests notice.
//!
//! `cargo-mutants` makes the mistakes and runs the tests. What it found is kept in `target/mutants/`, one line a mutant, so
//! that a run that is killed goes on where it was, and a mutant is judged again only when the code of its file has changed. First
//! judge are the tests of its own package, the slow ones last; what they miss is for the quick tier of `verify`. A survivor must be on the
//! list of those that change nothing, each with its reason, or the command fails.

mod accepted;
mod judge;
mod ledger;
mod list;
mod report;

use std::num::NonZeroUsize;

use convergence_study::store::atomic;
use convergence_study::store::provenance::Provenance;

use accepted::Accepted;
use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::cli::{interrupt, output, workspace};
use judge::{JUDGES, Judged};
use ledger::Ledger;
use list::Mutant;

/// Mutants judged by one call of cargo-mutants, which first checks that the tests pass without any.
const BATCH: usize = 250;

/// Judge the tests: do they notice a mistake in the solver or in the verdicts?
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Judge the mutants of this package only
    #[arg(long, value_parser = list::PACKAGES)]
    package: Option<String>,
    /// Judge the mutants of files with this in their path only; may be given more than once
    #[arg(long, value_name = "PART")]
    file: Vec<String>,
    /// Judge so many mutants of each package, drawn at random; a larger sample holds a smaller one [default: all]
    #[arg(long, value_name = "N")]
    sample: Option<usize>,
    /// Which sample
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Mutants at a time, each with build folder and processes of its own
    #[arg(long, value_name = "N", default_value_t = NonZeroUsize::MIN)]
    jobs: NonZeroUsize,
    /// Judge those again that a judge has missed and that are not accepted, after a test was added, and no others
    #[arg(long)]
    again: bool,
    /// Judge nothing, and write the report on what has been judged
    #[arg(long)]
    report: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let accepted = Accepted::read(&root)?;
    judge::is_installed()?;
    let all = list::mutants(&root)?;
    let chosen = |package: &&str| arguments.package.as_ref().is_none_or(|name| name == *package);
    let of = |package| list::sample(&all, package, arguments.seed, arguments.sample);
    let mut sample: Vec<_> = list::PACKAGES.into_iter().filter(chosen).flat_map(of).collect();
    if !arguments.file.is_empty() {
        sample.retain(|mutant| arguments.file.iter().any(|part| mutant.file.contains(part)));
        if sample.is_empty() {
            return Err(Unusable::because(&format!("no mutant in a file of {}", arguments.file.join(" or "))));
        }
    }
    let mut ledger = Ledger::open(&root)?;
    let is_accepted = |mutant: &Mutant| accepted.reason(mutant).is_some();
    if arguments.again {
        sample.retain(|mutant| !is_accepted(mutant) && ledger.forget_missed(mutant));
    }
    let count = sample.len();
    interrupt::say(move || format!("the same command goes on where it was, with {count} mutants in all"));
    for (level, judge) in JUDGES.iter().enumerate().filter(|_| !arguments.report) {
        loop {
            // What is accepted needs one judge only, in case it is noticed after all.
            let is_open = |mutant: &&Mutant| ledger.is_open(mutant, level) && (level == 0 || !is_accepted(mutant));
            let mut open: Vec<&Mutant> = sample.iter().copied().filter(is_open).collect();
            // In the order of the sources: from one mutant to the next, the compiler then finds little that has changed.
            open.sort_by_key(|mutant| mutant.place());
            let Some(first) = open.first() else { break };
            let batch: Vec<_> =
                open.iter().filter(|mutant| mutant.target == first.target).take(BATCH).copied().collect();
            output::tell(&format!("{}: {} mutants left", judge.name, open.len()));
            for (mutant, judged) in judge.judge(&root, &batch, arguments.jobs)? {
                ledger.add(mutant, level, judged)?;
            }
        }
    }
    let last_word = |mutant: &Mutant| ledger.of(mutant, is_accepted(mutant));
    // One that the first judge missed counts as open until all have seen it: the others alone would make a better rate.
    let begun = |mutant: &&Mutant| ledger.is_begun(mutant) || sample.contains(mutant);
    let findings: Vec<_> = all.iter().filter(begun).map(|mutant| (mutant, last_word(mutant))).collect();
    let here = Provenance::collect(&root, String::new(), arguments.jobs.get(), &[]);
    let page = report::page(&findings, &all, arguments.seed, &accepted, &here);
    atomic::write(&root.join("reports/mutants.md"), &page)?;
    let survivors = findings.iter().filter(|(_, judged)| *judged == Some(Judged::Missed));
    let bare = survivors.filter(|(mutant, _)| !is_accepted(mutant)).count();
    let stale = accepted.stale(&all);
    output::print(&format!("{}\nreport: reports/mutants.md\n", report::sentence(&findings, &accepted)))?;
    stale.iter().for_each(|entry| output::complain(&format!("{}: no such mutant: {entry}", accepted::FILE)));
    let is_open = findings.iter().any(|(_, judged)| judged.is_none());
    Ok(if bare == 0 && stale.is_empty() && !is_open { Ended::Well } else { Ended::Badly })
}
