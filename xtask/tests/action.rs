//! The script of the GitHub action, run as by the runner, with a fake `cargo`.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use convergence_study_tests::output;
use tempfile::TempDir;

use crate::place::read;

/// Records its arguments, writes a report and exits with STATUS.
const CARGO: &str = r#"#!/usr/bin/env bash
printf '%s\n' "$@" >arguments
if [ "$STATUS" -le 1 ] && [ -n "$PLACE" ]; then
    mkdir -p "$PLACE/figures" reports/local
    for file in README.md index.html junit.xml summary.md; do
        echo new >"$PLACE/$file"
    done
    echo new >"$PLACE/figures/a b.svg"
    echo new >"$PLACE/figures/rates.svg"
    mkdir -p "$PLACE/figures/page"
    echo new >"$PLACE/figures/page/d.svg"
    printf '{ "figures": [\n  { "file": "a b.svg" },\n  { "file": "d.svg" }\n] }\n' >"$PLACE/results.json"
    echo new >reports/local/provenance.json
    # Programs see the newest run of a tier in the place of the accepted report.
    if [ "$PLACE" = reports/local/quick ]; then cp "$PLACE/results.json" reports; fi
    if [ "$PLACE" = reports/local/full ]; then mkdir -p reports/full; cp "$PLACE/results.json" reports/full; fi
fi
exit "$STATUS"
"#;

struct Ran {
    folder: TempDir,
    status: Option<i32>,
    arguments: String,
    output: String,
}

/// * `place`: where the fake run writes its report.
fn run(tier: &str, ids: &str, status: i32, place: &str) -> Ran {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("bin")).unwrap();
    fs::write(at("bin/cargo"), CARGO).unwrap();
    fs::set_permissions(at("bin/cargo"), fs::Permissions::from_mode(0o755)).unwrap();
    // A checkout contains the report of an earlier run.
    fs::create_dir_all(at("reports")).unwrap();
    fs::create_dir_all(at("reports/figures")).unwrap();
    fs::create_dir_all(at("reports/local/partial")).unwrap();
    for stale in [
        "README.md",
        "results.json",
        "stale.svg",
        "figures/stale.svg",
        "local/partial/README.md",
        "local/partial/results.json",
    ] {
        fs::write(at("reports").join(stale), "old\n").unwrap();
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../.github/actions/verify/run.sh");
    let path = format!("{}:{}", at("bin").display(), std::env::var("PATH").unwrap());
    let mut command = Command::new("bash");
    command
        .arg(script.canonicalize().unwrap())
        .current_dir(folder.path());
    command.envs([
        ("PATH", path.as_str()),
        ("TIER", tier),
        ("IDS", ids),
        ("PLACE", place),
    ]);
    command
        .env("STATUS", status.to_string())
        .env("RUNNER_TEMP", folder.path())
        .env("GITHUB_OUTPUT", at("output"));
    let status = output(&mut command).status.code();
    let text = |name: &str| fs::read_to_string(at(name)).unwrap_or_default();
    Ran {
        status,
        arguments: text("arguments"),
        output: text("output"),
        folder,
    }
}

impl Ran {
    fn report(&self) -> Option<&str> {
        self.output
            .lines()
            .find_map(|line| line.strip_prefix("report="))
    }
}

#[test]
fn the_step_ends_as_verify_does_and_hands_on_what_this_run_wrote() {
    foreign_tools::needs!(BASH);
    let partial = "reports/local/partial";
    for (tier, ids, passing, failing) in [
        ("quick", "", "reports", "reports/local/quick"),
        ("full", "", "reports/full", "reports/local/full"),
        ("quick", "a-space  b-*", partial, partial),
    ] {
        for (status, place) in [(0, passing), (1, failing)] {
            let ran = run(tier, ids, status, place);
            assert_eq!(ran.status, Some(status));
            assert!(
                ran.output.starts_with(&format!("status={status}\n")),
                "{}",
                ran.output
            );
            let report = Path::new(ran.report().unwrap());
            assert!(report.starts_with(ran.folder.path()));
            for new in [
                "README.md",
                "figures/a b.svg",
                "figures/rates.svg",
                "figures/page/d.svg",
                "junit.xml",
                "provenance.json",
            ] {
                assert_eq!(
                    fs::read_to_string(report.join(new)).unwrap(),
                    "new\n",
                    "{new}"
                );
            }
            assert!(!report.join("stale.svg").exists());
            assert!(!report.join("figures/stale.svg").exists());
        }
    }
}

#[test]
fn where_nothing_was_written_no_old_report_is_handed_on() {
    foreign_tools::needs!(BASH);
    for (ids, status, place) in [
        ("", 2, "reports"),
        ("", 101, "reports"),
        ("--dry-run", 0, ""),
        ("studies/a.toml", 0, ""),
        ("studies/a.toml", 1, ""),
    ] {
        let ran = run("quick", ids, status, place);
        assert_eq!((ran.status, ran.report()), (Some(status), None), "{ids}");
        assert_eq!(ran.output, format!("status={status}\n"));
    }
}

#[test]
fn patterns_reach_the_program_as_they_are() {
    foreign_tools::needs!(BASH);
    // The folder of the fake run contains a file that matches the pattern.
    let ran = run("quick", "a-space reports/*", 0, "reports/local/partial");
    assert_eq!(
        ran.arguments,
        "xtask\nverify\n--tier\nquick\na-space\nreports/*\n"
    );
}

#[test]
fn what_the_action_builds_is_what_it_runs() {
    let profile = |path: &str, command: &str| {
        read(path)
            .split_once(command)
            .map(|(_, rest)| rest.split(' ').next().unwrap().to_owned())
    };
    let run = profile(".cargo/config.toml", "xtask = \"run --profile ");
    let built = profile(
        ".github/actions/verify/action.yml",
        "cargo build --profile ",
    );
    assert!(run.is_some() && run == built, "{run:?} {built:?}");
}
