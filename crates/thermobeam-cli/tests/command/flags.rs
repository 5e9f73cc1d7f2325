//! The common flags, tested with every command.

use convergence_study::Template;

use super::*;

/// Each command with arguments that work in [`place`], its exit status there, and the file that
/// `--out out` produces.
const COMMANDS: [(&str, i32, &str); 11] = [
    // Every number is new.
    ("verify", 1, "results.json"),
    ("study studies/short.toml", 0, "results.json"),
    ("list", 0, "list.json"),
    ("rates rates.csv --order 2", 0, "rates.json"),
    // Its object describes the report; the record is its input file.
    ("report reported/results.json", 0, "index.html"),
    ("run scene.toml", 0, "run.json"),
    ("equilibria scene.toml", 0, "equilibria.json"),
    ("sweep sweep.toml", 0, "results.jsonl"),
    ("sweep --merge swept", 0, "results.jsonl"),
    ("new study begun", 0, "begun.toml"),
    ("manufacture heat.toml", 0, "manufacture.json"),
];

/// Commands missing from [`COMMANDS`]: a script for a shell; the help; the schema.
const OTHERS: [&str; 3] = ["schema", "completions", "help"];

/// The first word of a command line.
fn name(line: &str) -> &str {
    line.split(' ').next().unwrap_or_default()
}

pub(super) fn place(folder: &Folder) -> PathBuf {
    let root = workspace(folder, "w", &[("short", quick("short"))]);
    let rates = "h,L2\n0.4,1.6e-1\n0.2,4e-2\n0.1,1e-2\n0.05,2.5e-3\n0.025,6.25e-4\n";
    let sweep = "[sweep]\nscene = \"scene.toml\"\n[grid]\nbeam.beta = [0, 1]\n";
    for (name, text) in [
        ("rates.csv", rates),
        ("scene.toml", &thrown("dt = 0.01")),
        ("sweep.toml", sweep),
        ("heat.toml", Template::MANUFACTURE.files[0].1),
    ] {
        fs::write(root.join(name), text).expect("a file");
    }
    for line in [
        "sweep sweep.toml --out swept",
        "study studies/short.toml --out reported",
    ] {
        ended(&mut command(&root, line)).well();
    }
    root
}

#[test]
fn every_command_is_tried() {
    let mut program = project("thermobeam").command_line::<Thermobeam>(&GROUPS, &PAGES);
    program.build();
    let tried = COMMANDS.map(|(line, ..)| name(line)).into_iter();
    let commands = program
        .get_subcommands()
        .filter(|command| !command.is_hide_set());
    assert_eq!(
        tried.chain(OTHERS).collect::<BTreeSet<_>>(),
        commands.map(clap::Command::get_name).collect()
    );
}

#[test]
fn every_json_has_a_schema_and_the_verdict_and_every_out_its_file() {
    for (line, status, file) in COMMANDS {
        let folder = Folder::new();
        let root = place(&folder);
        let flags = format!("{line} --format json --out out --jobs 1");
        let found = ended(&mut command(&root, &flags));
        found.complains(status, "");
        assert_eq!(found.stderr, "", "{line}");
        let object: Value = serde_json::from_str(&found.stdout)
            .unwrap_or_else(|error| panic!("{line}: {error}: {found:?}"));
        let schema = object["schema"].as_u64();
        assert!(schema.is_some_and(|schema| schema >= 1), "{line}: {object}");
        // The list contains a study that never ran; for all other commands verdict and exit status
        // agree.
        let verdict = match (line, status) {
            ("list", _) => "inconclusive",
            (_, 0) => "pass",
            _ => "fail",
        };
        assert_eq!(object["verdict"], verdict, "{line}");
        let text = read(&root.join("out").join(file));
        if file.ends_with(".json") {
            let written: Value = serde_json::from_str(&text).expect("JSON");
            for key in ["schema", "verdict"] {
                assert_eq!(written[key], object[key], "{line}: {key}");
            }
        }
    }
}

#[test]
fn quiet_leaves_the_verdict_and_what_went_wrong() {
    for (line, status, _) in COMMANDS {
        let out = if name(line) == "sweep" {
            "--out out"
        } else {
            ""
        };
        let [loud, quiet] = ["", "-q"].map(|flag| {
            let folder = Folder::new();
            let line = format!("{line} {out} {flag}");
            let ended = ended(&mut command(&place(&folder), &line));
            ended.complains(status, "");
            ended.stdout
        });
        // The verdict comes last if it passes and first if it fails, so that the cause is read at
        // once.
        let mut lines = quiet.lines();
        let verdict = if status == 0 {
            lines.last()
        } else {
            lines.next()
        };
        let verdict = verdict.unwrap_or_default();
        let is_first = verdict.starts_with("the study passes; not yet in the baseline: ");
        let words = ["pass: ", "fail: ", "inconclusive: "];
        let is_verdict = words.iter().any(|word| verdict.starts_with(word));
        assert!(is_verdict || is_first, "{line}: {verdict}");
        let [few, many] = [&quiet, &loud].map(|text| text.lines().count());
        assert!(few < many || many == 1, "{line}: {quiet}");
        assert_eq!(status == 0 || is_first, few == 1, "{line}: {quiet}");
    }
}
