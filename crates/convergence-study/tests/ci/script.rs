//! The script of the action as the runner runs it, with the program itself.

use super::*;

struct Ran {
    folder: tempfile::TempDir,
    status: Option<i32>,
    output: String,
}

fn run(asked: &str) -> Ran {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("bin")).unwrap();
    fs::create_dir(at("temporary files")).unwrap();
    std::os::unix::fs::symlink(
        env!("CARGO_BIN_EXE_convergence-study"),
        at("bin/convergence-study"),
    )
    .unwrap();
    fs::write(
        at("errors.csv"),
        "h,L2\n0.4,1.6e-1\n0.2,4e-2\n0.1,1e-2\n0.05,2.5e-3\n0.025,6.25e-4\n",
    )
    .unwrap();
    fs::create_dir(at("studies")).unwrap();
    let study = "[study]\nid = \"s\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"table\"\n\
                 [table]\nfile = \"../errors.csv\"\ninputs = [\"../errors.csv\"]\n\
                 [[expect]]\nerror = \"L2\"\norder = 2.0\n";
    fs::write(at("studies/s.toml"), study).unwrap();
    let path = format!("{}:{}", at("bin").display(), std::env::var("PATH").unwrap());
    let mut command = script("ci/run.sh");
    command
        .current_dir(folder.path())
        .env("PATH", path)
        .env("RUN", asked);
    command
        .env("RUNNER_TEMP", at("temporary files"))
        .env("GITHUB_OUTPUT", at("output"));
    let status = command
        .env_remove("GITHUB_ACTIONS")
        .output()
        .unwrap()
        .status
        .code();
    let output = fs::read_to_string(at("output")).unwrap_or_default();
    Ran {
        folder,
        status,
        output,
    }
}

#[test]
fn the_step_ends_as_the_program_does_and_hands_on_the_report() {
    foreign_tools::needs!(BASH, TIMEOUT);
    let rates = "# Rates of errors.csv\n";
    for (asked, status, heading) in [
        ("rates errors.csv --order 2", 0, rates),
        ("rates errors.csv --order 1", 1, rates),
        ("verify", 1, "## Verification, quick\n"),
        ("study studies/s.toml", 0, "## Verification, files\n"),
    ] {
        let ran = run(asked);
        assert_eq!(ran.status, Some(status));
        assert!(
            ran.output.starts_with(&format!("status={status}\nreport=")),
            "{}",
            ran.output
        );
        let mut lines = ran.output.lines();
        let comment = lines.find_map(|line| line.strip_prefix("comment="));
        let comment = comment.unwrap();
        assert!(
            comment.starts_with(&ran.folder.path().display().to_string()),
            "{comment}"
        );
        assert!(
            fs::read_to_string(comment).unwrap().starts_with(heading),
            "{comment}"
        );
    }
}

#[test]
fn where_no_report_was_written_nothing_is_handed_on() {
    foreign_tools::needs!(BASH, TIMEOUT);
    for (asked, status) in [
        ("rates missing.csv --order 2", 2),
        ("verify nothing", 2),
        ("nonsense", 2),
        ("verify --dry-run", 0),
        ("list", 0),
    ] {
        let ran = run(asked);
        let expected = (Some(status), format!("status={status}\n"));
        assert_eq!((ran.status, ran.output), expected, "{asked}");
    }
}
