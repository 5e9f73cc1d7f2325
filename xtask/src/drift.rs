//! `drift`: the guarded numbers again, by programs that round differently; what the baseline's tolerances are for.
//!
//! The number of threads must not change a bit. Fused multiply-adds and the optimiser may: each moves a rounding error
//! here and there, which is all that another machine or another compiler does. No number may come out farther from this
//! program's than its tolerance.

use std::collections::BTreeMap;
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::judge::verdict::Verdict;
use convergence_study::report;
use convergence_study::store::StoreError;
use convergence_study::store::atomic;
use convergence_study::store::record::Record;
use convergence_study::study::Quantity;
use convergence_study::study::Tier;
use convergence_study::study::outcome::Table;

use crate::PROJECT;

use convergence_study::cli::long::LongRun;
use convergence_study::cli::{output, screen, selection, workspace};

/// Compare the guarded numbers of other builds and thread counts with this one's
///
/// Builds this project three times and runs the tier six times, which takes minutes; says at the beginning how many the last one took.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Tier of the studies
    #[arg(long, value_parser = selection::tier_parser(), default_value = Tier::Quick.name())]
    tier: Tier,
    /// Write reports/drift.md
    #[arg(long)]
    write: bool,
}

/// A way to the same numbers.
struct Variant {
    name: &'static str,
    /// Profile of `cargo build`, its folder below the target folder, and RUSTFLAGS; `None` is the program that runs.
    build: Option<[&'static str; 3]>,
    /// Its folder below `target`.
    folder: &'static str,
    jobs: usize,
    /// Whether not a bit may differ.
    same_bits: bool,
}

const SHIPPED: Variant = Variant { name: "release, 1 thread", build: None, folder: "", jobs: 1, same_bits: true };

const VARIANTS: [Variant; 5] = [
    Variant { name: "release, 2 threads", jobs: 2, ..SHIPPED },
    Variant { name: "release, 7 threads", jobs: 7, ..SHIPPED },
    Variant {
        name: "release, without fused multiply-add",
        build: Some(["release", "release", "-C target-cpu=x86-64-v3 -C target-feature=-fma"]),
        folder: "drift-no-fma",
        same_bits: false,
        ..SHIPPED
    },
    Variant {
        name: "release, for any x86-64 (neither FMA nor AVX)",
        build: Some(["release", "release", "-C target-cpu=x86-64"]),
        folder: "drift-any",
        same_bits: false,
        ..SHIPPED
    },
    Variant {
        name: "debug",
        build: Some(["dev", "debug", "-C target-cpu=x86-64-v3"]),
        folder: "drift-debug",
        same_bits: false,
        ..SHIPPED
    },
];

/// Value and tolerance by study and name, and the studies that do not pass.
#[derive(Debug, Default, PartialEq)]
struct Numbers {
    values: BTreeMap<String, (f64, f64)>,
    not_passing: Vec<String>,
}

impl Numbers {
    /// * `path`: of the program that printed the record.
    fn parse(json: &str, path: &Path) -> Result<Self, StoreError> {
        let mut numbers = Self::default();
        for study in Record::parse(json, path)?.studies {
            if study.outcome.verdict != Verdict::Pass {
                numbers.not_passing.push(study.header.id.clone());
            }
            for Quantity { name, value, tolerance } in study.outcome.quantities {
                numbers.values.insert(format!("{}: {name}", study.header.id), (value, tolerance));
            }
        }
        Ok(numbers)
    }
}

/// How far one run's numbers lie from another's.
#[derive(Debug, PartialEq)]
struct Distance {
    same_bits: usize,
    of: usize,
    /// Median and largest relative difference of those that differ.
    median: f64,
    largest: f64,
    /// The largest in units of its tolerance, and whose it is.
    strain: f64,
    strained: String,
}

impl Distance {
    fn between(ours: &Numbers, theirs: &Numbers) -> Self {
        let mut differences = vec![];
        let (mut strain, mut strained) = (0.0, "none".to_owned());
        for (name, &(value, tolerance)) in &ours.values {
            let other = theirs.values.get(name).map_or(f64::NAN, |(other, _)| *other);
            if other.to_bits() == value.to_bits() {
                continue;
            }
            let relative = (other - value).abs() / value.abs();
            differences.push(relative);
            // NaN is as far away as can be.
            if !(relative / tolerance <= strain) {
                (strain, strained) = (relative / tolerance, name.clone());
            }
        }
        let of = ours.values.len().max(theirs.values.len());
        differences.sort_by(f64::total_cmp);
        let median = differences.get(differences.len() / 2).copied().unwrap_or(0.0);
        let largest = differences.last().copied().unwrap_or(0.0);
        Self { same_bits: ours.values.len() - differences.len(), of, median, largest, strain, strained }
    }

    /// Whether it is what the variant promises.
    fn is_kept(&self, same_bits: bool) -> bool {
        if same_bits { self.same_bits == self.of } else { self.strain <= 1.0 }
    }
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let files = workspace::studies(&PROJECT, &root)?;
    let files: Vec<PathBuf> =
        files.into_iter().filter(|file| file.study.header().tier <= arguments.tier).map(|file| file.path).collect();
    let own = env::current_exe()?;
    let reported = root.join("reports/drift.md");
    let clock = LongRun::begin("three builds, and the tier by six programs", &reported, false);
    let ours = numbers_of(&own, SHIPPED.jobs, &files)?;
    let mut rows = vec![];
    let mut kept = ours.not_passing.is_empty();
    let variants: Vec<&Variant> =
        VARIANTS.iter().filter(|variant| variant.build.is_none() || cfg!(target_arch = "x86_64")).collect();
    for (k, variant) in variants.iter().enumerate() {
        let program = match variant.build {
            None => own.clone(),
            Some(how) => build(&root, how, &root.join("target").join(variant.folder))?,
        };
        let theirs = numbers_of(&program, variant.jobs, &files)?;
        let distance = Distance::between(&ours, &theirs);
        let good = distance.is_kept(variant.same_bits) && theirs.not_passing == ours.not_passing;
        kept &= good;
        rows.push(row(variant, &distance, &theirs.not_passing, good));
        clock.done(&format!("{} of {}: {}", k + 1, variants.len(), variant.name));
    }
    let head = ["variant", "promised", "same bits", "median", "largest", "largest / tolerance", "of", "verdict"];
    let title = "Guarded numbers against those of the release on one thread".to_owned();
    let table = Table { title, head: head.map(str::to_owned).to_vec(), rows };
    output::print(&screen::table(&head, &table.rows))?;
    if arguments.write {
        atomic::write(&reported, page(&table, &clock.ended(&root)))?;
        output::print(&format!("written to {}\n", reported.display()))?;
    }
    Ok(if kept { Ended::Well } else { Ended::Badly })
}

fn row(variant: &Variant, distance: &Distance, not_passing: &[String], good: bool) -> Vec<String> {
    let Distance { same_bits, of, median, largest, strain, strained } = distance;
    let verdict = match (good, not_passing) {
        (true, _) => "pass".to_owned(),
        (false, []) => "fail".to_owned(),
        (false, studies) => format!("fail: {}", studies.join(", ")),
    };
    vec![
        variant.name.to_owned(),
        if variant.same_bits { "same bits" } else { "within tolerance" }.to_owned(),
        format!("{same_bits} of {of}"),
        format!("{median:.1e}"),
        format!("{largest:.1e}"),
        format!("{strain:.1e}"),
        strained.clone(),
        verdict,
    ]
}

fn page(table: &Table, ended: &str) -> String {
    format!(
        "# Drift\n\nWritten by `cargo xtask dev drift --write`. Differences are relative; `median` is that of the numbers that \
         differ. {ended}\n\n## {}\n\n{}",
        table.title,
        report::markdown(table)
    )
}

/// The guarded numbers by a program.
fn numbers_of(program: &Path, jobs: usize, files: &[PathBuf]) -> Result<Numbers, Unusable> {
    let output = Command::new(program)
        .args(["study", "--format", "json", "--jobs", &jobs.to_string()])
        .args(files)
        .output()
        .map_err(|error| Unusable::file(program, &error))?;
    let text = String::from_utf8_lossy(&output.stdout);
    Numbers::parse(&text, program).map_err(|error| {
        let complaint = String::from_utf8_lossy(&output.stderr);
        Unusable::because(&format!("{error}\n{complaint}"))
    })
}

/// Builds this program differently.
fn build(root: &Path, [profile, below, flags]: [&str; 3], folder: &Path) -> Result<PathBuf, Unusable> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .current_dir(root)
        .args(["build", "--quiet", "--package", "xtask", "--profile", profile, "--target-dir"])
        .arg(folder)
        .env("RUSTFLAGS", flags)
        .status()?;
    if !status.success() {
        return Err(Unusable::because(&format!("cargo could not build {}", folder.display())));
    }
    Ok(folder.join(below).join(format!("xtask{}", env::consts::EXE_SUFFIX)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(values: &[(&str, &str)]) -> Numbers {
        let quantity =
            |(name, value): &(&str, &str)| format!(r#"{{"name": "{name}", "value": {value}, "tolerance": 1e-3}}"#);
        let quantities: Vec<String> = values.iter().map(quantity).collect();
        let json = format!(
            r#"{{"schema": 1, "crate_version": "0", "scope": "files", "verdict": "pass", "baseline_changes": [], "studies": [{{
                "id": "s", "claim": "c", "tier": "quick", "kind": "k", "verdict": "pass", "summary": "", "levels": [], "rates": [],
                "checks": [], "quantities": [{}], "failed_cases": [], "not_finite": []}}]}}"#,
            quantities.join(", ")
        );
        Numbers::parse(&json, Path::new("program")).unwrap()
    }

    #[test]
    fn a_difference_of_one_bit_is_seen_and_measured_in_tolerances() {
        let ours = numbers(&[("a", "1.0"), ("b", "2.0")]);
        let same = Distance::between(&ours, &numbers(&[("a", "1.0"), ("b", "2.0")]));
        assert!(same.is_kept(true) && same.is_kept(false), "{same:?}");
        let bit = Distance::between(&ours, &numbers(&[("a", "1.0000000000000002"), ("b", "2.0")]));
        assert!(!bit.is_kept(true) && bit.is_kept(false), "{bit:?}");
        assert_eq!((bit.same_bits, bit.strained.as_str()), (1, "s: a"));
        let far = Distance::between(&ours, &numbers(&[("a", "1.0"), ("b", "2.004")]));
        assert!(!far.is_kept(false) && (far.strain - 2.0).abs() < 1e-9, "{far:?}");
    }

    #[test]
    fn what_is_missing_or_not_finite_is_never_kept() {
        let ours = numbers(&[("a", "1.0"), ("b", "2.0")]);
        for theirs in [numbers(&[("a", "1.0")]), numbers(&[("a", "1.0"), ("b", "null")])] {
            let distance = Distance::between(&ours, &theirs);
            assert!(!distance.is_kept(true) && !distance.is_kept(false), "{distance:?}");
        }
        let more = Distance::between(&numbers(&[("a", "1.0")]), &ours);
        assert!(!more.is_kept(true), "{more:?}");
    }
}
