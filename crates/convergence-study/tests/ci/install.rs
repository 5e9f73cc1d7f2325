//! The installation of a released program, from a folder in place of the releases.

use std::process::Output;

use super::*;

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A folder with the releases of this version for Linux, whose program is a script.
fn releases() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let name = format!("convergence-study-{VERSION}-x86_64-unknown-linux-musl");
    let pack = format!(
        "mkdir -p 'v{VERSION}' {name} && printf '#!/bin/sh\\necho released\\n' >{name}/convergence-study && \
         chmod +x {name}/convergence-study && tar -czf 'v{VERSION}/{name}.tar.gz' {name} && \
         cd 'v{VERSION}' && sha256sum {name}.tar.gz >{name}.tar.gz.sha256"
    );
    let mut shell = Command::new("sh");
    shell.args(["-euc", &pack]).current_dir(folder.path());
    assert!(shell.status().unwrap().success());
    folder
}

#[derive(Debug)]
struct Installed {
    output: Output,
    /// What the step adds to the PATH.
    path: String,
}

fn install(releases: &Path, version: &str, architecture: &str) -> Installed {
    let file = releases.join("path");
    let mut command = script("ci/install.sh");
    command.envs([
        ("VERSION", version),
        ("RUNNER_OS", "Linux"),
        ("RUNNER_ARCH", architecture),
    ]);
    command
        .env("DOWNLOADS", format!("file://{}", releases.display()))
        .env("RUNNER_TEMP", releases)
        .env("GITHUB_PATH", &file);
    Installed {
        output: command.output().unwrap(),
        path: fs::read_to_string(file).unwrap_or_default(),
    }
}

#[track_caller]
fn is_refused(installed: &Installed, reason: &str) {
    let printed = String::from_utf8_lossy(&installed.output.stdout);
    assert_eq!(installed.output.status.code(), Some(2), "{printed}");
    assert!(printed.contains(reason), "{printed}");
    assert_eq!(installed.path, "");
}

#[test]
fn the_program_of_a_version_is_installed_with_its_sum() {
    foreign_tools::needs!(BASH, TIMEOUT);
    for version in ["", VERSION, concat!("v", env!("CARGO_PKG_VERSION"))] {
        let releases = releases();
        let installed = install(releases.path(), version, "X64");
        assert_eq!(installed.output.status.code(), Some(0), "{installed:?}");
        let program = Path::new(installed.path.trim_end()).join("convergence-study");
        let released = Command::new(program).output().unwrap();
        assert_eq!(released.stdout, b"released\n");
    }
}

#[test]
fn a_program_with_another_sum_is_not_installed() {
    foreign_tools::needs!(BASH, TIMEOUT);
    let releases = releases();
    let name = format!("v{VERSION}/convergence-study-{VERSION}-x86_64-unknown-linux-musl.tar.gz");
    let archive = releases.path().join(name);
    let mut bytes = fs::read(&archive).unwrap();
    bytes.push(0);
    fs::write(&archive, bytes).unwrap();
    is_refused(&install(releases.path(), "", "X64"), "found the sum");
}

#[test]
fn what_is_not_released_is_named() {
    foreign_tools::needs!(BASH, TIMEOUT);
    let releases = releases();
    let missing = install(releases.path(), "99.0.0", "X64");
    is_refused(&missing, "expected a released `version`");
    let unknown = install(releases.path(), "", "RISCV64");
    is_refused(&unknown, "no program is released for Linux RISCV64");
}
