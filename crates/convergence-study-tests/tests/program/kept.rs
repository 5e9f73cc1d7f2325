//! Levels whose answers are kept.

use std::fs;
use std::path::PathBuf;

use super::{Place, project_of, texts};

/// A project whose study runs a script that notes each run, and answers with the factor of a file.
fn place(more: &str) -> Place {
    place_with(more, "factor")
}

/// The same, whose study does not list the file of the factor: the answers depend on what no listed
/// file shows.
fn place_of_unlisted(more: &str) -> Place {
    place_with(more, "solver.sh")
}

/// * `more`: a key of the study; `listed`: the file that it lists.
fn place_with(more: &str, listed: &str) -> Place {
    let place = Place::new("ok", "");
    let script = "echo \"$1\" >> runs\nfactor=$(cat factor)\n\
                  awk -v n=\"$1\" -v c=\"$factor\" 'BEGIN { printf \"L2 = %.17g\\n\", c / (n * n) }'\n";
    place.write_text(&format!(
        "[study]\nid = \"s\"\nclaim = \"second order\"\ntier = \"quick\"\nkind = \"program\"\n{more}\n\
         [program]\ncommand = [\"sh\", \"solver.sh\", \"{{n}}\"]\nfiles = [\"{listed}\"]\ncache = true\n\
         [refine]\nn = [4, 8, 16, 32, 64]\n[[expect]]\nerror = \"L2\"\norder = 2.0\n"
    ));
    let place = project_of(place);
    let write = |name: &str, text: &str| fs::write(place.studies().join(name), text).unwrap();
    write("solver.sh", script);
    write("factor", "1\n");
    place
}

impl Place {
    fn studies(&self) -> PathBuf {
        self.folder.path().join("studies")
    }

    /// The runs since the last call.
    fn runs(&self) -> Vec<String> {
        let file = self.studies().join("runs");
        let text = fs::read_to_string(&file).unwrap_or_default();
        let _ = fs::remove_file(file);
        let mut runs: Vec<String> = text.lines().map(str::to_owned).collect();
        runs.sort_by_key(|run| run.parse::<usize>().unwrap());
        runs
    }
}

const ALL: [&str; 5] = ["4", "8", "16", "32", "64"];

#[test]
fn levels_are_taken_again_but_for_the_cheapest_and_never_blessed() {
    if !crate::awk_is_here() {
        return;
    }
    let place = place("");
    place.verify("--bless").says(0, "");
    assert_eq!(place.runs(), ALL);
    place.verify("").begins(0, "4 of 5 levels reused\n");
    assert_eq!(place.runs(), ["4"]);
    // The reports are the same.
    let report = || fs::read(place.folder.path().join("reports/results.json")).unwrap();
    let reused = report();
    place.verify("--bless").says_not(0, "reused");
    assert_eq!(place.runs(), ALL);
    assert_eq!(reused, report());
    // A level that is new is run.
    let file = place.studies().join("s.toml");
    let study = fs::read_to_string(&file).unwrap();
    fs::write(&file, study.replace("64]", "64, 128]")).unwrap();
    let text = place.verify("").stdout;
    assert!(text.starts_with("4 of 6 levels reused\n"), "{text}");
    assert_eq!(place.runs(), ["4", "128"]);
    // The command `study` takes no answers.
    fs::copy(&file, place.studies().join("../s.toml")).unwrap();
    let out = texts(&mut place.command("study studies/s.toml")).stdout;
    assert!(!out.contains("reused"), "{out}");
    assert_eq!(place.runs().len(), 6);
}

#[test]
fn a_file_or_a_command_that_has_changed_runs_all_levels() {
    if !crate::awk_is_here() {
        return;
    }
    let place = place("");
    place.verify("--bless").says(0, "");
    place.runs();
    // Of a listed file, and of one that the command names.
    for (name, change) in [("factor", "1.0\n"), ("solver.sh", "# new\n")] {
        let path = place.studies().join(name);
        let text = fs::read_to_string(&path).unwrap();
        let text = if name == "factor" {
            change.to_owned()
        } else {
            change.to_owned() + &text
        };
        fs::write(path, text).unwrap();
        place.verify("").says_not(0, "reused");
        assert_eq!(place.runs(), ALL, "{name}");
    }
    let file = place.studies().join("s.toml");
    let study = fs::read_to_string(&file).unwrap();
    fs::write(&file, study.replace("\"{n}\"]", "\"{n}\", \"more\"]")).unwrap();
    place.verify("").says_not(1, "reused");
    assert_eq!(place.runs(), ALL);
}

/// What no file says: a library, a variable, the machine.
#[test]
fn a_change_that_no_file_shows_is_seen_at_the_cheapest_level() {
    if !crate::awk_is_here() {
        return;
    }
    let place = place_of_unlisted("");
    place.verify("--bless").says(0, "");
    fs::write(place.studies().join("factor"), "1.001\n").unwrap();
    // As often as it is run.
    for _ in 0..2 {
        let ran = place.verify("");
        ran.begins(1, "4 of 5 levels reused\nfail");
        let moved = "L2 was 6.250e-2, is 6.256e-2: what changed is not in program.files";
        ran.says(1, moved);
    }
    // A blessing runs all, and the answers are of this version again.
    place.verify("--bless").says(0, "");
    place.verify("").begins(0, "4 of 5 levels reused\n");
}

#[test]
fn without_the_answer_of_the_cheapest_level_all_are_run() {
    if !crate::awk_is_here() {
        return;
    }
    let place = place("");
    place.verify("--bless").says(0, "");
    place.runs();
    let answers = place.folder.path().join("reports/local/answers/s");
    for entry in fs::read_dir(&answers).unwrap() {
        let path = entry.unwrap().path();
        let text = fs::read_to_string(&path).unwrap();
        if text.contains("\"solver.sh\",\n      \"4\"") {
            fs::write(&path, "{").unwrap();
        }
    }
    place.verify("--jobs 1").says_not(0, "reused");
    assert_eq!(place.runs(), ALL);
}

/// A guard says how far a program scatters.
#[test]
fn the_cheapest_level_may_scatter_by_the_guard() {
    if !crate::awk_is_here() {
        return;
    }
    let place = place_of_unlisted("guard = 1e-4");
    place.verify("--bless").says(0, "");
    fs::write(place.studies().join("factor"), "1.00001\n").unwrap();
    place.verify("").begins(0, "4 of 5 levels reused\n");
    fs::write(place.studies().join("factor"), "1.0003\n").unwrap();
    place.verify("").says(1, "");
}
