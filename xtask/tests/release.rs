//! The workflow that publishes: only on a tag, with the least rights, by scripts of `.ci/`.

#[cfg(unix)]
use std::fs;

use yaml_rust2::{Yaml, YamlLoader};

use crate::place::read;
#[cfg(unix)]
use crate::place::root;

fn text(name: &str) -> String {
    read(&format!(".github/workflows/{name}"))
}

fn workflow(name: &str) -> Yaml {
    YamlLoader::load_from_str(&text(name))
        .expect("YAML")
        .remove(0)
}

fn keys(map: &Yaml) -> Vec<&str> {
    let map = map.as_hash().expect("a map");
    map.keys()
        .map(|key| key.as_str().expect("a text"))
        .collect()
}

fn steps(job: &Yaml) -> &Vec<Yaml> {
    job["steps"].as_vec().expect("steps")
}

/// All commands of a workflow, with the names of their jobs.
fn commands(workflow: &Yaml) -> Vec<(&str, &str)> {
    let jobs = workflow["jobs"].as_hash().expect("jobs");
    let of_job = |(name, job)| -> Vec<(&str, &str)> {
        let name: &Yaml = name;
        let runs = steps(job).iter().filter_map(|step| step["run"].as_str());
        runs.map(|run| (name.as_str().expect("a name"), run))
            .collect()
    };
    jobs.iter().flat_map(of_job).collect()
}

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
    let workflow = workflow("release.yml");
    assert!(workflow["permissions"].as_hash().expect("none").is_empty());
    let jobs = &workflow["jobs"];
    assert_eq!(
        keys(jobs),
        ["check", "binaries", "wheels", "publish", "release"]
    );
    for (job, rights) in [
        ("check", "contents: read"),
        ("binaries", "contents: read"),
        ("wheels", "contents: read"),
        ("publish", "contents: read, id-token: write"),
        (
            "release",
            "attestations: write, contents: write, id-token: write",
        ),
    ] {
        let permissions = &jobs[job]["permissions"];
        let given = keys(permissions).into_iter().map(|right| {
            let value = permissions[right].as_str().expect("a text");
            format!("{right}: {value}")
        });
        let given: Vec<String> = given.collect();
        assert_eq!(given.join(", "), rights, "{job}");
        let is_left = |step: &&Yaml| {
            let uses = step["uses"].as_str().unwrap_or_default();
            uses.starts_with("actions/checkout@")
                && step["with"]["persist-credentials"].as_bool() != Some(false)
        };
        let left = steps(&jobs[job]).iter().find(is_left);
        assert_eq!(left, None, "{job} leaves its token in the checkout");
    }
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
    assert_eq!(needs, ["check", "binaries", "wheels"]);
    assert_eq!(jobs["publish"]["environment"].as_str(), Some("release"));
    assert_eq!(jobs["release"]["needs"].as_str(), Some("publish"));
}

#[test]
fn only_the_job_publish_publishes_and_only_by_its_script() {
    for name in ["release.yml", "ci.yml"] {
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
    let text = text("release.yml");
    let uses: Vec<&str> = text
        .lines()
        .filter_map(|line| line.trim_start().split_once("uses: "))
        .map(|(_, action)| action)
        .collect();
    assert!(uses.len() >= 8, "{uses:?}");
    for action in uses {
        let (_, pin) = action.split_once('@').expect("a version");
        let (commit, version) = pin.split_once(" # v").expect("a commit and its version");
        let is_commit = commit.len() == 40 && commit.chars().all(|c| c.is_ascii_hexdigit());
        assert!(is_commit && !version.is_empty(), "{action}");
    }
}

/// Whatever a job does, a developer can run.
#[test]
fn the_workflow_has_no_logic_of_its_own() {
    let text = text("release.yml");
    assert!(text.lines().count() <= 200);
    let workflow = workflow("release.yml");
    let commands = commands(&workflow);
    for (job, command) in &commands {
        let has_logic = command.contains('\n')
            || ["if ", "for ", "|"]
                .iter()
                .any(|word| command.contains(word));
        assert!(!has_logic, "{job}: {command}");
    }
    for script in [
        ".ci/run",
        ".ci/release --dry-run \"$GITHUB_REF_NAME\"",
        ".ci/archive --target \"$TARGET\" dist",
        ".ci/wheel dist",
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
