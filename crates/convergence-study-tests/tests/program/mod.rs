//! Studies of programs: `powers` is the harness, `solver` the program that its studies run.

mod processes;

use convergence_study_tests::{Ended, PATIENCE, output, started};
use std::fs;
use std::path::Path;
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

mod answers;
mod kept;
mod levels;
mod samples;
mod table;
mod taylor;

const HARNESS: &str = env!("CARGO_BIN_EXE_powers");

const SOLVER: &str = env!("CARGO_BIN_EXE_solver");

/// A folder with the study `s.toml` of the solver in this mode; the path of the folder marks its
/// processes.
pub(crate) struct Place {
    pub(crate) folder: TempDir,
    /// More keys of `[program]`.
    pub(crate) more: String,
}

impl Place {
    pub(crate) fn new(mode: &str, more: &str) -> Self {
        let place = Self {
            folder: tempfile::tempdir().unwrap(),
            more: more.to_owned(),
        };
        place.write(mode);
        place
    }

    pub(crate) fn write(&self, mode: &str) {
        let command = [SOLVER, self.token(), mode, "{n}"].map(|word| format!("{word:?}"));
        // There is no placeholder if the case is read from standard input.
        let command = command
            .join(", ")
            .replace("{n}", if mode == "stdin" { "-" } else { "{n}" });
        self.write_text(&format!(
            "[study]\nid = \"s\"\nclaim = \"second order\"\ntier = \"quick\"\nkind = \"program\"\n\
             [program]\ncommand = [{command}]\n{}\n[refine]\nn = [4, 8, 16, 32, 64]\n\
             [[expect]]\nerror = \"L2\"\norder = 2.0\ntolerance = 0.05\n",
            self.more
        ));
    }

    pub(crate) fn write_text(&self, text: &str) {
        fs::write(self.folder.path().join("s.toml"), text).unwrap();
    }

    /// A file of the folder.
    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.folder.path().join(name)).unwrap()
    }

    /// The study file.
    pub(crate) fn text(&self) -> String {
        self.read("s.toml")
    }

    fn token(&self) -> &str {
        self.folder.path().to_str().unwrap()
    }

    pub(crate) fn command(&self, line: &str) -> Command {
        let mut command = Command::new(HARNESS);
        command
            .args(line.split_whitespace())
            .current_dir(self.folder.path())
            .env_remove("CARGO_MANIFEST_DIR");
        command
            .env_remove("GITHUB_ACTIONS")
            .env_remove("GITHUB_STEP_SUMMARY");
        command
    }

    /// Exit status, standard output and standard error of `study s.toml` with these arguments.
    pub(crate) fn study(&self, more: &str) -> Ended {
        texts(&mut self.command(&format!("study s.toml {more}")))
    }

    /// `study` of a file with this text.
    pub(crate) fn study_of(&self, text: &str) -> Ended {
        self.write_text(text);
        self.study("")
    }

    /// `verify` with these arguments.
    pub(crate) fn verify(&self, more: &str) -> Ended {
        texts(&mut self.command(&format!("verify {more}")))
    }

    pub(crate) fn start(&self) -> Child {
        started(&mut self.command("study s.toml --jobs 2"))
    }

    /// Command lines of the running processes of this test.
    fn running(&self) -> Vec<String> {
        let processes = fs::read_dir("/proc").unwrap().flatten();
        let command_line = |entry: fs::DirEntry| {
            let bytes = fs::read(entry.path().join("cmdline")).ok()?;
            Some(String::from_utf8_lossy(&bytes).replace('\0', " "))
        };
        processes
            .filter_map(command_line)
            .filter(|line| line.contains(self.token()))
            .collect()
    }

    /// Waits until the number of running processes satisfies `so_many`.
    pub(crate) fn wait_for(&self, so_many: impl Fn(usize) -> bool) {
        let start = Instant::now();
        while !so_many(self.running().len()) {
            assert!(
                start.elapsed() < PATIENCE,
                "still running: {:#?}",
                self.running()
            );
            sleep(Duration::from_millis(5));
        }
    }
}

/// Exit status, standard output and standard error.
pub(crate) fn texts(command: &mut Command) -> Ended {
    output(command).into()
}

#[test]
fn a_program_is_judged_by_its_errors() {
    let place = Place::new("ok", "");
    place.study("").says(0, "L2 2.0000 (order 2)");
    place
        .study_of(&place.text().replace("order = 2.0", "order = 1.0"))
        .says(1, "");
    // The same bytes for any number of simultaneous processes, except for the seconds.
    let record = |jobs| place.study(&format!("--format json --jobs {jobs}")).stdout;
    assert_eq!(record("1"), record("4"));
    // Work and step are in the record.
    let object: serde_json::Value = serde_json::from_str(&record("1")).unwrap();
    let levels = object["studies"][0]["levels"].as_array().unwrap();
    assert!(
        levels
            .iter()
            .all(|level| level["work"].is_number() && level["step"].is_number()),
        "{levels:?}"
    );
}

#[test]
fn a_value_is_judged_by_its_differences() {
    let place = Place::new("ok", "");
    let text = place.text().replace("error = \"L2\"", "value = \"flux\"");
    place.write_text(&text);
    let (status, out, err) = place.study("").parts();
    assert_eq!(status, Some(0), "{out}{err}");
    // 3 + 0.7 h^2.
    assert!(
        out.contains("value flux 2.0000 (order 2); flux tends to 3.000"),
        "{out}"
    );
    for (old, new, told) in [
        (
            "order = 2.0",
            "order = 1.0",
            "value flux: 2.0000 ± 0.00005, claimed 1 ± ",
        ),
        (
            "[4, 8, 16, 32, 64]",
            "[4, 8]",
            "none: 2 values; three are the fewest that tell an order",
        ),
    ] {
        place.study_of(&text.replace(old, new)).says(1, told);
    }
}

#[test]
fn a_grid_finds_both_orders() {
    let place = Place::new("ok", "");
    let text = place.text();
    let text = text
        .replace("\"{n}\"]", "\"{n}\", \"{dt}\"]")
        .replace("64]", "64]\ndt = [0.1, 0.05, 0.025, 0.0125]\ngrid = true");
    place
        .study_of(&text.replace("order = 2.0", "order = 2.0\norder_dt = 1.0"))
        .says(0, "L2 in h 2.0000 (order 2); L2 in dt 1.0000 (order 1)");
    // The same order in both, which the error in time does not have.
    place
        .study_of(&text)
        .says(1, "L2 in dt: 1.0000 ± 0.00005, claimed 2 ± 0.05: too low");
    // Refined together, where nothing hides the error in time.
    place
        .study_of(
            &text
                .replace("\ngrid = true", "")
                .replace("[4, 8, 16, 32, 64]", "[4, 8, 16, 32]"),
        )
        .says(1, "");
    for (old, new, message) in [
        (
            "error = \"L2\"",
            "value = \"flux\"",
            "expect[0].value: found value with grid = true; expected error",
        ),
        (
            "grid = true",
            "",
            "refine.dt: found 4 values beside 5; expected lists of the same length",
        ),
    ] {
        place
            .study_of(&text.replace(old, new))
            .complains(2, message);
    }
}

#[test]
fn a_program_without_placeholders_reads_the_case() {
    Place::new("stdin", "").study("").says(0, "");
    // With placeholders, the program finds standard input at its end.
    Place::new("read", "").study("").says(0, "");
}

#[test]
fn what_a_study_file_may_get_wrong_is_named() {
    let place = Place::new("ok", "time_limit = 9");
    let text = place.text();
    for (old, new, message) in [
        (
            "\"{n}\"",
            "\"--dt={dt}\"",
            "program.command[3]: found the placeholder {dt}; expected one that `refine` gives",
        ),
        (
            "command = [",
            "command = [] # [",
            "program.command: found the list []; expected a list of the program",
        ),
        (
            "time_limit = 9",
            "time_limit = 0",
            "s.toml:8:14: program.time_limit: found 0; expected a number of seconds > 0",
        ),
        (
            "time_limit = 9",
            "directory = \"x\"",
            "program.directory: found the text \"x\", but ./x is no folder",
        ),
        (
            "time_limit = 9",
            "files = [\"x\"]",
            "program.files: found the list [\"x\"]; expected files beside cache = true",
        ),
        (
            "time_limit = 9",
            "cache = true",
            "program.cache: found true; expected true beside `files`, all files that a result depends on",
        ),
        (
            "time_limit = 9",
            "shell = true",
            "program.shell: unknown key `shell`; expected command, directory, env, manufacture, files, cache, time_limit",
        ),
        (
            "n = [4, ",
            "n = [8, ",
            "refine.n[1]: found 8; expected a number > 8, the level before",
        ),
        (
            "error = \"L2\"",
            "norm = \"L2\"",
            "expect[0].norm: unknown key `norm`",
        ),
        (
            "tolerance = 0.05",
            "tolerance = 0.5",
            "expect[0].tolerance: found 0.5; expected a finite number > 0 and < 0.5",
        ),
        (
            "kind = \"program\"",
            "",
            "s.toml:1:1: study.kind: missing; expected \"power\", \"program\", \"table\", \"taylor\"",
        ),
        (
            "[[expect]]",
            "[[expct]]",
            "unknown key `expct`, did you mean `expect`?",
        ),
    ] {
        assert!(text.contains(old), "{old}");
        place.study_of(&text.replace(old, new)).refuses(message);
    }
}

/// A project with the study `studies/s.toml`.
fn project(mode: &str) -> Place {
    project_of(Place::new(mode, ""))
}

/// The same for a study that has been written.
pub(crate) fn project_of(place: Place) -> Place {
    let root = place.folder.path();
    fs::write(root.join("Cargo.toml"), "").unwrap();
    fs::create_dir(root.join("studies")).unwrap();
    fs::rename(root.join("s.toml"), root.join("studies/s.toml")).unwrap();
    place
}

#[test]
fn a_value_that_only_some_answers_have_is_guarded_there() {
    let place = project("optional");
    let studies = place.folder.path().join("studies");
    let verify = |more: &str| place.verify(more);
    fs::write(studies.join("all"), "").unwrap();
    verify("--bless").says(0, "");
    verify("").says(0, "");
    let baseline = fs::read_to_string(studies.join("baseline.json")).unwrap();
    for (name, is_guarded) in [
        ("value lift, n = 16", true),
        ("value lift, n = 8", false),
        ("error H1, n = 16", true),
    ] {
        assert_eq!(
            baseline.contains(&format!("\"{name}\"")),
            is_guarded,
            "{name}: {baseline}"
        );
    }
    // A guarded number that no longer exists.
    fs::remove_file(studies.join("all")).unwrap();
    verify("").says(1, "value lift, n = 16");
}

#[test]
fn an_error_that_only_some_answers_have_fails() {
    let (status, out, _) = Place::new("lacking", "").study("").parts();
    assert_eq!(status, Some(1), "{out}");
    for missing in ["max", "H1"] {
        let words = format!("its answer has no error `{missing}`, which that of another level has");
        assert!(out.contains(&words), "{missing}: {out}");
    }
}

#[test]
fn a_study_of_a_program_is_guarded() {
    let place = project("ok");
    let root = place.folder.path();
    let run = |line: &str| texts(&mut place.command(line));
    run("verify --bless").says(0, "");
    run("verify").says(0, "");
    let baseline = fs::read_to_string(root.join("studies/baseline.json")).unwrap();
    assert!(
        baseline.contains("error H1, n = 64") && baseline.contains("\"settings\": \""),
        "{baseline}"
    );
    let figures = Path::new("reports/figures");
    assert!(
        ["s-errors.svg", "s-work.svg"]
            .iter()
            .all(|name| root.join(figures).join(name).is_file())
    );
    assert!(run("list").stdout.contains("program"), "the kind is listed");
    // Only the harness starts guards: one started by hand would end the group of its caller.
    assert!(!run("--help").stdout.contains("guard"));
    run("guard mark").says(2, "");
}
