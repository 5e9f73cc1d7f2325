//! `fuzz`: damaged copies of the project's own files, as many as are asked for, to every reader of files.
//!
//! The work is done by the test `fuzz` of the study package, which damages a few in every run of the tests. Here it is given
//! more, and what it counts becomes a report.

use std::env;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use convergence_study::report::markdown;
use convergence_study::store::atomic;
use convergence_study::study::outcome::Table;

use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::cli::long::LongRun;
use convergence_study::cli::{output, screen, workspace};

/// The test that damages files.
const TEST: &str = "damaged_files_are_read_or_refused_with_their_place";

/// Feed damaged files to every reader: does each refuse with a message, or panic or hang?
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Damaged files
    #[arg(long, value_name = "N", default_value_t = 110_000, value_parser = clap::value_parser!(u64).range(200..))]
    inputs: u64,
    /// Number of the first; each is made from its number alone
    #[arg(long, value_name = "N", default_value_t = 0)]
    first: u64,
    /// Write reports/fuzz.md
    #[arg(long)]
    write: bool,
}

/// What became of the inputs of one kind.
#[derive(Debug, Clone, Default, PartialEq)]
struct Tally {
    kind: String,
    inputs: u64,
    read: u64,
    refused: u64,
    failed: u64,
    slowest_ms: f64,
}

impl Tally {
    /// A line of the test: `fuzz kind inputs read refused failed milliseconds`.
    fn parse(line: &str) -> Option<Self> {
        let fields: Vec<&str> = line.strip_prefix("fuzz ")?.split(' ').collect();
        let [kind, inputs, read, refused, failed, slowest] = fields[..] else { return None };
        let [inputs, read, refused, failed] = [inputs, read, refused, failed].map(str::parse);
        Some(Self {
            kind: kind.to_owned(),
            inputs: inputs.ok()?,
            read: read.ok()?,
            refused: refused.ok()?,
            failed: failed.ok()?,
            slowest_ms: slowest.parse().ok()?,
        })
    }

    fn sum(tallies: &[Self]) -> Self {
        let add = |sum: Self, one: &Self| Self {
            kind: sum.kind,
            inputs: sum.inputs + one.inputs,
            read: sum.read + one.read,
            refused: sum.refused + one.refused,
            failed: sum.failed + one.failed,
            slowest_ms: sum.slowest_ms.max(one.slowest_ms),
        };
        tallies.iter().fold(Self { kind: "all".to_owned(), ..Self::default() }, add)
    }

    fn row(&self) -> Vec<String> {
        let counts = [self.inputs, self.read, self.refused, self.failed].map(|count| count.to_string());
        [self.kind.clone()].into_iter().chain(counts).chain([format!("{:.1}", self.slowest_ms)]).collect()
    }
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let reported = root.join("reports/fuzz.md");
    let clock = LongRun::begin(&format!("{} damaged files", arguments.inputs), &reported, false);
    let (tallies, passed) = damage(&root, arguments)?;
    let all = Tally::sum(&tallies);
    if all.inputs != arguments.inputs {
        let reason = format!("the test {TEST} tried {} of {} inputs: see above", all.inputs, arguments.inputs);
        return Err(Unusable::because(&reason));
    }
    let head = ["file", "inputs", "read", "refused", "failed", "slowest (ms)"];
    let rows: Vec<_> = tallies.iter().chain([&all]).map(Tally::row).collect();
    output::print(&screen::table(&head, &rows))?;
    let table = Table { title: String::new(), head: head.map(str::to_owned).to_vec(), rows };
    output::print(&format!("{}\n", sentence(&all)))?;
    if arguments.write {
        atomic::write(&reported, page(arguments, &all, &table, &clock.ended(&root)))?;
        output::print(&format!("written to {}\n", reported.display()))?;
    }
    if !passed && all.failed == 0 {
        output::complain(&format!("no input failed, but the test {TEST} failed: see above"));
    }
    Ok(if passed && all.failed == 0 { Ended::Well } else { Ended::Badly })
}

/// The counts by kind of file, and whether the test passed. What else it prints is passed on.
fn damage(root: &Path, arguments: &Arguments) -> Result<(Vec<Tally>, bool), Unusable> {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["test", "--package", "thermobeam-study", "--test", "fuzz", "--", "--exact", TEST, "--nocapture"]);
    command.env("THERMOBEAM_FUZZ", arguments.inputs.to_string());
    command.env("THERMOBEAM_FUZZ_SEED", arguments.first.to_string());
    let mut child = command.current_dir(root).stdout(Stdio::piped()).spawn()?;
    let mut tallies = vec![];
    for line in child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines) {
        tallies.extend(Tally::parse(&line?));
    }
    Ok((tallies, child.wait()?.success()))
}

fn sentence(all: &Tally) -> String {
    let failed = match all.failed {
        0 => "none ended in a panic, a hang or a message without a place".to_owned(),
        failed => format!("{failed} ended in a panic, a hang or a message without a place"),
    };
    format!("{} damaged files: {} read, {} refused, {failed}", all.inputs, all.read, all.refused)
}

fn page(arguments: &Arguments, all: &Tally, table: &Table, ended: &str) -> String {
    format!(
        "# Damaged files\n\nWritten by `cargo xtask dev fuzz --write --inputs {} --first {}`. {ended} Files of the project are damaged as \
         programs, editors and people do it: bits flipped, the end lost, lines lost, doubled and mixed, pieces put in, ten \
         thousand brackets, words exchanged, numbers made huge, negative, infinite or NaN. Each goes to the reader that is \
         for it, and is read or refused by a message that begins with the file's name and says where.\n\n{}.\n\n{}",
        arguments.inputs,
        arguments.first,
        sentence(all),
        markdown(table)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_read_from_the_lines_of_the_test_and_from_no_others() {
        let scene = Tally::parse("fuzz scene 10 3 6 1 2.5").expect("a line of counts");
        assert_eq!(scene.row(), ["scene", "10", "3", "6", "1", "2.5"]);
        for other in
            ["", "fuzz", "fuzz scene 10 3 6 1", "fuzz scene 10 3 6 x 2.5", "test fuzz ... ok", "fuzz a 1 1 0 0 1 1"]
        {
            assert_eq!(Tally::parse(other), None, "{other}");
        }
        let sweep = Tally::parse("fuzz sweep 5 5 0 0 7.0").expect("a line of counts");
        let all = Tally::sum(&[scene, sweep]);
        assert_eq!(all.row(), ["all", "15", "8", "6", "1", "7.0"]);
        assert!(sentence(&all).contains("8 read, 6 refused, 1 ended in a panic"));
    }
}
