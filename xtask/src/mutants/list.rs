//! Which mutants there are, and a sample of them.

use std::path::Path;
use std::process::Command;

use convergence_study::store::content_hash;

use convergence_study::cli::exit::Unusable;

/// What is mutated, and by which tests it is judged first.
#[derive(Debug, PartialEq)]
pub(super) struct Target {
    /// The package.
    pub(super) package: &'static str,
    /// How the paths of its files begin.
    paths: &'static [&'static str],
    /// Those of its own tests that notice most mistakes: each binary is linked anew for each mutant.
    pub(super) first: &'static [&'static str],
    /// Tests that the first judge leaves out, because they take longer than all others together.
    pub(super) slow: &'static [&'static str],
    /// All tests that are about it: a package, and arguments of `cargo test`.
    pub(super) tests: (&'static str, &'static [&'static str]),
}

/// Tests of the solver that take longer than all others together.
const SLOW: &[&str] = &[
    "a_fine_scan_of_the_textbook_formula_finds_the_same_states",
    "a_fixed_point_step_solves_the_equations_of_the_scheme",
    "a_newton_step_solves_the_equations_of_the_scheme",
    "an_accepted_step_is_within_the_tolerance_of_its_solution",
    "discrete_states_converge_at_second_order_and_have_as_many_unstable_directions",
    "newton_converges_for_every_compliance_step_force_and_stiffness",
    "equilibria_are_found_for_extreme_coefficients",
    "the_default_tolerance_is_enough_for_the_balance",
    "the_energy_falls_and_its_balance_closes_to_round_off",
];

/// Files of the solver, and the tests of it that notice most mistakes in them.
const fn solver(paths: &'static [&'static str], first: &'static [&'static str]) -> Target {
    Target { package: "thermobeam", paths, first, slow: SLOW, tests: ("thermobeam", &["--tests"]) }
}

/// The numerics, and what turns them into verdicts. A file belongs to the first target that names it.
const TARGETS: [Target; 8] = [
    solver(&["crates/thermobeam/src/equilibrium/"], &["--lib", "--test=equilibrium"]),
    solver(&["crates/thermobeam/src/vibration/"], &["--lib", "--test=vibration"]),
    solver(&["crates/thermobeam/src/solve/bound.rs"], &["--lib"]),
    solver(
        &[
            "crates/thermobeam/src/solve/balance.rs",
            "crates/thermobeam/src/ensemble.rs",
            "crates/thermobeam/src/lanes.rs",
        ],
        &["--test=lanes"],
    ),
    solver(&["crates/thermobeam/src/solve/"], &["--lib", "--test=solver", "--test=lanes"]),
    solver(&[""], &["--lib", "--test=solver"]),
    Target {
        package: "thermobeam-exact",
        paths: &[""],
        first: &["--tests"],
        slow: &[],
        tests: ("thermobeam-study", &["--test=manufactured", "--test=input"]),
    },
    Target {
        package: "convergence-study",
        paths: &["crates/convergence-study/src/judge/fit", "crates/convergence-study/src/judge/verdict"],
        first: &["--test=fit", "--test=verdict_laws"],
        slow: &["the_joint_region_holds_the_orders_95_times_in_100"],
        tests: ("convergence-study", &["--lib", "--test=fit", "--test=verdict_laws", "--test=calibration"]),
    },
];

impl Target {
    fn holds(&self, package: &str, file: &str) -> bool {
        self.package == package && self.paths.iter().any(|path| file.starts_with(path))
    }
}

/// The packages of the targets.
pub(super) const PACKAGES: [&str; 3] = ["thermobeam", "thermobeam-exact", "convergence-study"];

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
    for package in PACKAGES {
        let mut command = Command::new("cargo");
        command.args(["mutants", "--list", "--colors=never", "--package", package]).current_dir(root);
        let output = command.output()?;
        if !output.status.success() {
            let reason = format!("cargo mutants --list: {}", String::from_utf8_lossy(&output.stderr));
            return Err(Unusable::because(&reason));
        }
        let text = String::from_utf8_lossy(&output.stdout);
        mutants.extend(text.lines().filter_map(|line| mutant(root, line, package)));
    }
    Ok(mutants)
}

/// A line `file:line:column: what`, where a target holds the file.
fn mutant(root: &Path, name: &str, package: &str) -> Option<Mutant> {
    let (place, what) = name.split_once(": ")?;
    let mut place = place.split(':');
    let (file, line) = (place.next()?, place.next()?.parse::<usize>().ok()?);
    let target = TARGETS.iter().find(|target| target.holds(package, file))?;
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
