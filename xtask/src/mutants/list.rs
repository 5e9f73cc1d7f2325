//! Which mutants there are, and a sample of them.

use std::path::Path;
use std::process::Command;

use thermobeam_study::sweep::content_hash;

use crate::exit::Unusable;

/// What is mutated, and by which tests it is judged first.
#[derive(Debug, PartialEq)]
pub(super) struct Target {
    /// The package.
    pub(super) package: &'static str,
    /// Its files; none for all.
    files: &'static [&'static str],
    /// Files of it that other targets hold.
    except: &'static [&'static str],
    /// Those of its own tests that notice most mistakes: each binary is linked anew for each mutant.
    pub(super) first: &'static [&'static str],
    /// Tests that the first judge leaves out, because they take longer than all others together.
    pub(super) slow: &'static [&'static str],
    /// All tests that are about it: a package, and arguments of `cargo test`.
    pub(super) tests: (&'static str, &'static [&'static str]),
}

/// Tests of the solver that take longer than all others together.
const SLOW: &[&str] = &[
    "a_blind_scan_with_the_textbook_formula_finds_the_same_states",
    "a_fixed_point_step_solves_the_equations_of_the_scheme",
    "a_newton_step_solves_the_equations_of_the_scheme",
    "an_accepted_step_is_within_the_tolerance_of_its_solution",
    "discrete_states_converge_at_second_order_and_have_as_many_unstable_directions",
    "newton_converges_for_every_compliance_step_force_and_stiffness",
    "no_coefficient_is_too_extreme",
    "the_default_tolerance_is_enough_for_the_balance",
    "the_energy_falls_and_its_balance_closes_to_round_off",
];

/// Files of the solver, or all but some, and the tests of it that notice most mistakes in them.
const fn solver(
    files: &'static [&'static str],
    except: &'static [&'static str],
    first: &'static [&'static str],
) -> Target {
    Target { package: "thermobeam", files, except, first, slow: SLOW, tests: ("thermobeam", &["--tests"]) }
}

const EQUILIBRIUM: &str = "crates/thermobeam/src/equilibrium/*.rs";
const VIBRATION: &str = "crates/thermobeam/src/vibration/*.rs";
const SOLVE: &str = "crates/thermobeam/src/solve/*.rs";
const BOUND: &str = "crates/thermobeam/src/solve/bound.rs";
const BALANCE: &str = "crates/thermobeam/src/solve/balance.rs";
const ENSEMBLE: &str = "crates/thermobeam/src/ensemble.rs";
const LANES: &str = "crates/thermobeam/src/lanes.rs";

/// The numerics, and what turns them into verdicts.
const TARGETS: [Target; 8] = [
    solver(&[], &[EQUILIBRIUM, VIBRATION, SOLVE, ENSEMBLE, LANES], &["--lib", "--test=solver"]),
    solver(&[SOLVE], &[BOUND, BALANCE], &["--test=solver", "--test=lanes"]),
    solver(&[BOUND], &[], &["--lib"]),
    solver(&[BALANCE, ENSEMBLE, LANES], &[], &["--test=lanes"]),
    solver(&[EQUILIBRIUM], &[], &["--lib", "--test=equilibrium"]),
    solver(&[VIBRATION], &[], &["--lib", "--test=vibration"]),
    Target {
        package: "thermobeam-exact",
        files: &[],
        except: &[],
        first: &["--tests"],
        slow: &[],
        tests: ("thermobeam-study", &["--test=manufactured", "--test=input"]),
    },
    Target {
        package: "thermobeam-study",
        files: &[
            "crates/thermobeam-study/src/fit.rs",
            "crates/thermobeam-study/src/fit/*.rs",
            "crates/thermobeam-study/src/verdict.rs",
            "crates/thermobeam-study/src/verdict/*.rs",
        ],
        except: &[],
        first: &["--test=fit", "--test=verdict_laws"],
        slow: &["the_joint_region_holds_the_orders_95_times_in_100"],
        tests: (
            "thermobeam-study",
            &["--lib", "--test=fit", "--test=verdict_laws", "--test=manufactured", "--test=calibration"],
        ),
    },
];

/// The packages of the targets.
pub(super) const PACKAGES: [&str; 3] = ["thermobeam", "thermobeam-exact", "thermobeam-study"];

/// One mistake.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mutant {
    /// As cargo-mutants calls it: file, line, column and what is replaced.
    pub(super) name: String,
    /// The file, from the workspace's folder.
    pub(super) file: String,
    /// What is replaced, without the place.
    pub(super) what: String,
    /// The line of the file, without blanks at its ends.
    pub(super) code: String,
    /// Hash of the file but for its tests: an outcome holds for this text only.
    pub(super) text: u64,
    /// Of which package.
    pub(super) target: &'static Target,
}

impl Mutant {
    /// Where it is: mutants that sort side by side stand side by side.
    pub(super) fn place(&self) -> (&'static str, &str, usize) {
        let line = self.name.split(':').nth(1).and_then(|line| line.parse().ok());
        (self.target.package, &self.file, line.unwrap_or(0))
    }
}

/// All mutants, as cargo-mutants lists them.
pub(super) fn mutants(root: &Path) -> Result<Vec<Mutant>, Unusable> {
    let mut mutants = vec![];
    for target in &TARGETS {
        let mut command = Command::new("cargo");
        command.args(["mutants", "--list", "--colors=never", "--package", target.package]).current_dir(root);
        command.args(target.files.iter().flat_map(|file| ["--file", file]));
        command.args(target.except.iter().flat_map(|file| ["--exclude", file]));
        let output = command.output()?;
        if !output.status.success() {
            return Err(Unusable::because(&format!(
                "cargo mutants --list: {}",
                String::from_utf8_lossy(&output.stderr)
            )));
        }
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        mutants.extend(text.lines().filter_map(|line| mutant(root, line, target)));
    }
    Ok(mutants)
}

/// A line `file:line:column: what`.
fn mutant(root: &Path, name: &str, target: &'static Target) -> Option<Mutant> {
    let (place, what) = name.split_once(": ")?;
    let mut place = place.split(':');
    let (file, line) = (place.next()?, place.next()?.parse::<usize>().ok()?);
    let text = std::fs::read_to_string(root.join(file)).ok()?;
    let code = text.lines().nth(line - 1)?.trim().to_owned();
    let text = content_hash(without_tests(&text).as_bytes());
    Some(Mutant { name: name.to_owned(), file: file.to_owned(), what: what.to_owned(), code, text, target })
}

/// A source up to its tests, which stand at its end: a test that is added does not undo what others have noticed.
fn without_tests(text: &str) -> &str {
    text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or(text)
}

/// The first `count` of a package in an order that the seed and each mutant's own name make.
pub(super) fn sample<'m>(all: &'m [Mutant], package: &str, seed: u64, count: Option<usize>) -> Vec<&'m Mutant> {
    let mut sample: Vec<&Mutant> = all.iter().filter(|mutant| mutant.target.package == package).collect();
    sample.sort_by_key(|mutant| content_hash(format!("{seed}\0{}", mutant.name).as_bytes()));
    sample.truncate(count.unwrap_or(usize::MAX));
    sample
}
