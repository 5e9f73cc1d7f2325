//! The workflow that publishes: only on a tag, with the least rights, by scripts of `.ci/`.

#[cfg(unix)]
use std::fs;

use yaml_rust2::Yaml;

#[cfg(unix)]
use crate::place::root;
use crate::workflow::{
    WORKFLOWS, assert_no_logic, assert_pinned, assert_rights, commands, keys, text, workflow,
};

#[test]
fn nothing_but_a_tag_starts_a_release() {
    let workflow = workflow("release.yml");
    assert_eq!(keys(&workflow["on"]), ["push"]);
    assert_eq!(keys(&workflow["on"]["push"]), ["tags"]);
    let tags = workflow["on"]["push"]["tags"].as_vec().expect("tags");
    assert_eq!(tags, &[Yaml::String("v*".to_owned())]);
}

#[test]
fn each_job_has_the_least_rights() {
    assert_rights(
        "release.yml",
        &[
            ("check", "contents: read"),
            ("binaries", "contents: read"),
            ("wheels", "contents: read"),
            ("page", "contents: read"),
            ("publish", "contents: read, id-token: write"),
            (
                "release",
                "attestations: write, contents: write, id-token: write",
            ),
        ],
    );
}

#[test]
fn publishing_waits_for_all_checks_and_for_a_reviewer() {
    let workflow = workflow("release.yml");
    let jobs = &workflow["jobs"];
    let needs: Vec<&str> = jobs["publish"]["needs"]
        .as_vec()
        .expect("jobs")
        .iter()
        .filter_map(Yaml::as_str)
        .collect();
    assert_eq!(needs, ["check", "binaries", "wheels", "page"]);
    assert_eq!(jobs["publish"]["environment"].as_str(), Some("release"));
    assert_eq!(jobs["release"]["needs"].as_str(), Some("publish"));
}

#[test]
fn only_the_job_publish_publishes_and_only_by_its_script() {
    for name in WORKFLOWS {
        let workflow = workflow(name);
        for (job, command) in commands(&workflow) {
            let publishes = ["publish", "twine", "gh release"]
                .iter()
                .any(|word| command.contains(word));
            let is_meant = name == "release.yml"
                && ((job == "publish" && command == ".ci/publish dist")
                    || (job == "release" && command.starts_with("gh release create ")));
            assert_eq!(publishes, is_meant, "{name}, {job}: {command}");
        }
    }
    let secrets = text("release.yml").contains("secrets.");
    assert!(
        !secrets,
        "no token is kept: the registries trust the workflow"
    );
}

#[test]
fn actions_are_pinned_by_commit() {
    assert_pinned("release.yml", 8);
}

#[test]
fn the_workflow_assert_no_logic_of_its_own() {
    assert!(text("release.yml").lines().count() <= 200);
    assert_no_logic("release.yml");
    let workflow = workflow("release.yml");
    let commands = commands(&workflow);
    for script in [
        ".ci/run",
        ".ci/release --dry-run \"$GITHUB_REF_NAME\"",
        ".ci/archive --target \"$TARGET\" dist",
        ".ci/wheel $MUSL dist",
    ] {
        assert!(
            commands.iter().any(|(_, command)| *command == script),
            "{script}"
        );
    }
    let oldest = env!("CARGO_PKG_RUST_VERSION");
    let toolchain = format!("rustup toolchain install --profile minimal {oldest}");
    assert!(commands.iter().any(|(_, command)| *command == toolchain));
}

#[cfg(unix)]
#[test]
fn the_script_refuses_to_publish_elsewhere() {
    if !foreign_tools::are_here(&[foreign_tools::BASH]) {
        return;
    }
    use std::process::Command;

    let folder = tempfile::tempdir().expect("a folder");
    for name in ["a.whl", "a.tar.gz"] {
        fs::write(folder.path().join(name), "").expect("a file");
    }
    // No tool of a registry can be reached.
    fs::create_dir(folder.path().join("bin")).expect("a folder");
    for tool in ["cargo", "python3"] {
        let fake = folder.path().join("bin").join(tool);
        fs::write(&fake, "#!/bin/sh\necho used >>used\n").expect("a file");
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(fake, fs::Permissions::from_mode(0o755)).expect("set");
    }
    let path = format!(
        "{}:{}",
        folder.path().join("bin").display(),
        std::env::var("PATH").expect("a path")
    );
    for environment in [
        [
            ("GITHUB_ACTIONS", "false"),
            ("GITHUB_WORKFLOW", "release"),
            ("GITHUB_REF_TYPE", "tag"),
        ],
        [
            ("GITHUB_ACTIONS", "true"),
            ("GITHUB_WORKFLOW", "ci"),
            ("GITHUB_REF_TYPE", "tag"),
        ],
        [
            ("GITHUB_ACTIONS", "true"),
            ("GITHUB_WORKFLOW", "release"),
            ("GITHUB_REF_TYPE", "branch"),
        ],
    ] {
        let mut command = Command::new("bash");
        command.arg(root().join(".ci/publish")).arg(folder.path());
        command.envs(environment).env("PATH", &path);
        command.env_remove("CARGO_REGISTRY_TOKEN");
        let output = command.output().expect("it runs");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{environment:?}: {message}");
        assert!(message.contains("only the workflow `release` publishes"));
    }
    assert!(!folder.path().join("used").exists());
}
