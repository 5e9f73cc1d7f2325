//! What registries, GitHub and citations read: the manifests of all crates and of the Python
//! package, CITATION.cff, the forms for issues.

#[cfg(unix)]
use std::fs;

use toml::{Table, Value};
use yaml_rust2::{Yaml, YamlLoader};

use crate::place::{read, root};

/// What a manifest takes from the workspace.
const SHARED: [&str; 7] = [
    "version",
    "edition",
    "rust-version",
    "license",
    "authors",
    "repository",
    "homepage",
];

fn toml(path: &str) -> Table {
    read(path)
        .parse()
        .unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn yaml(path: &str) -> Yaml {
    YamlLoader::load_from_str(&read(path))
        .unwrap_or_else(|error| panic!("{path}: {error}"))
        .remove(0)
}

fn texts(list: &Value) -> Vec<&str> {
    let values = list.as_array().expect("a list");
    values
        .iter()
        .map(|value| value.as_str().expect("a text"))
        .collect()
}

/// A crate that is published.
struct Package {
    folder: String,
    manifest: Table,
}

impl Package {
    fn field(&self, name: &str) -> &Value {
        let value = self.manifest["package"].get(name);
        value.unwrap_or_else(|| panic!("{}: found no `{name}`", self.folder))
    }

    fn name(&self) -> &str {
        self.field("name").as_str().expect("a text")
    }
}

fn published() -> Vec<Package> {
    let workspace = toml("Cargo.toml");
    let folders = texts(&workspace["workspace"]["members"]);
    let packages = folders.into_iter().map(|folder| Package {
        folder: folder.to_owned(),
        manifest: toml(&format!("{folder}/Cargo.toml")),
    });
    packages
        .filter(|package| package.manifest["package"].get("publish").is_none())
        .collect()
}

#[test]
fn the_manifest_of_each_published_crate_is_complete() {
    let packages = published();
    assert!(packages.len() >= 8, "{}", packages.len());
    for package in packages {
        let name = package.name();
        for inherited in SHARED {
            let value = package.field(inherited).get("workspace");
            assert_eq!(value, Some(&Value::Boolean(true)), "{name}: {inherited}");
        }
        let address = format!("https://docs.rs/{name}");
        assert_eq!(package.field("documentation").as_str(), Some(&*address));
        assert!(package.field("description").as_str().expect("a text").len() > 30);
        assert_eq!(
            package.field("metadata")["docs"]["rs"]["all-features"],
            Value::Boolean(true)
        );
        for file in ["README.md", "LICENSE-APACHE", "LICENSE-MIT"] {
            assert!(
                root().join(&package.folder).join(file).is_file(),
                "{name}: {file}"
            );
        }
    }
}

#[test]
fn a_package_has_what_can_be_used_from_it_and_nothing_else() {
    for package in published() {
        let name = package.name();
        let include = texts(package.field("include"));
        assert!(include.contains(&"/src") && include.contains(&"/LICENSE-*"));
        for entry in include.iter().filter(|entry| !entry.contains('*')) {
            let path = root().join(&package.folder).join(&entry[1..]);
            assert!(path.exists(), "{name}: found no {entry}");
            let is_left_out = ["/tests", "/benches", "/pictures", "/ci"].contains(entry);
            assert!(!is_left_out, "{name}: {entry}");
        }
    }
}

#[test]
fn each_copy_of_a_licence_is_that_of_the_repository() {
    let python = "crates/convergence-study-python".to_owned();
    let folders = published().into_iter().map(|package| package.folder);
    for folder in folders.chain([python]) {
        for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
            assert_eq!(read(&format!("{folder}/{licence}")), read(licence));
        }
    }
}

/// `cargo binstall` looks for the archives under the names that `.ci/archive` gives them.
#[test]
fn installers_find_the_archives() {
    let archive = read(".ci/archive");
    assert!(archive.contains("name=$program-$version-$target\n"));
    assert!(archive.contains("archive=$dist/$name.tar.gz\n"));
    let with_programs: Vec<Package> = published()
        .into_iter()
        .filter(|package| package.manifest.contains_key("bin"))
        .collect();
    assert_eq!(with_programs.len(), 2);
    for package in with_programs {
        let program = package.manifest["bin"][0]["name"].as_str().expect("a text");
        assert!(archive.contains(program), "{program}");
        let binstall = &package.field("metadata")["binstall"];
        let folder = format!("{program}-{{ version }}-{{ target }}");
        let address = format!("{{ repo }}/releases/download/v{{ version }}/{folder}.tar.gz");
        assert_eq!(binstall["pkg-url"].as_str(), Some(&*address));
        let place = format!("{folder}/{{ bin }}{{ binary-ext }}");
        assert_eq!(binstall["bin-dir"].as_str(), Some(&*place));
        assert_eq!(binstall["pkg-fmt"].as_str(), Some("tgz"));
    }
}

#[test]
fn the_python_package_has_the_metadata_of_the_workspace() {
    let workspace = toml("Cargo.toml");
    let shared = &workspace["workspace"]["package"];
    let manifest = toml("crates/convergence-study-python/Cargo.toml");
    for key in SHARED {
        assert_eq!(manifest["package"][key], shared[key], "{key}");
    }
    let project = &toml("crates/convergence-study-python/pyproject.toml")["project"];
    assert_eq!(texts(&project["dynamic"]), ["version"]);
    assert_eq!(project["license"], shared["license"]);
    assert_eq!(
        project["authors"][0]["name"].as_str(),
        texts(&shared["authors"]).first().copied()
    );
    assert_eq!(
        texts(&project["license-files"]),
        ["LICENSE-APACHE", "LICENSE-MIT"]
    );
    let repository = shared["repository"].as_str().expect("a text");
    let addresses = project["urls"].as_table().expect("a table");
    assert!(addresses.len() >= 5, "{addresses:?}");
    for (name, address) in addresses {
        let address = address.as_str().expect("a text");
        assert!(address.starts_with(repository), "{name}: {address}");
    }
}

/// The version in a script of its own, which the release runs as well: of each file it notices a
/// change.
#[cfg(unix)]
#[test]
fn the_version_is_the_same_in_all_files() {
    if !foreign_tools::are_here(&[foreign_tools::BASH]) {
        return;
    }
    use std::process::Command;

    const FILES: [&str; 4] = [
        "CHANGELOG.md",
        "CITATION.cff",
        "crates/convergence-study-python/Cargo.toml",
        "Cargo.toml",
    ];
    let copy = tempfile::tempdir().expect("a folder");
    for file in FILES.iter().chain([&".ci/agree"]) {
        let path = copy.path().join(file);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::copy(root().join(file), path).expect("a copy");
    }
    let agree = || {
        let script = copy.path().join(".ci/agree");
        let output = Command::new("bash").arg(script).output().expect("it runs");
        let complaints = String::from_utf8(output.stderr).expect("a text");
        (output.status.code(), complaints)
    };
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(agree(), (Some(0), String::new()));
    for file in FILES {
        let path = copy.path().join(file);
        let before = fs::read_to_string(&path).expect("a text");
        // In the last file, the manifest of the workspace, a dependency.
        let place = before.rfind(version).expect("the version");
        let mut changed = before.clone();
        changed.replace_range(place..place + version.len(), "99.0.0");
        fs::write(&path, changed).expect("written");
        let (status, complaints) = agree();
        assert_eq!(status, Some(1), "{file}");
        assert!(
            complaints.starts_with(file) && complaints.contains("found version 99.0.0"),
            "{complaints}"
        );
        fs::write(&path, before).expect("written");
    }
}

/// The required fields of the Citation File Format 1.2.0, and the version of the workspace.
#[test]
fn the_citation_is_valid() {
    let citation = yaml("CITATION.cff");
    assert_eq!(citation["cff-version"].as_str(), Some("1.2.0"));
    for key in ["message", "title"] {
        assert!(citation[key].as_str().is_some_and(|text| !text.is_empty()));
    }
    assert_eq!(citation["type"].as_str(), Some("software"));
    assert_eq!(
        citation["version"].as_str(),
        Some(env!("CARGO_PKG_VERSION"))
    );
    let authors = citation["authors"].as_vec().expect("a list");
    assert!(!authors.is_empty());
    assert!(
        authors
            .iter()
            .all(|author| author["name"].as_str().is_some())
    );
    let licences = citation["license"].as_vec().expect("a list");
    let licences: Vec<&str> = licences.iter().filter_map(Yaml::as_str).collect();
    let shared = &toml("Cargo.toml")["workspace"]["package"];
    assert_eq!(shared["license"].as_str(), Some(&*licences.join(" OR ")));
    assert_eq!(
        citation["repository-code"].as_str(),
        shared["repository"].as_str()
    );
    const KEYS: [&str; 11] = [
        "cff-version",
        "message",
        "type",
        "title",
        "abstract",
        "version",
        "authors",
        "license",
        "repository-code",
        "url",
        "keywords",
    ];
    for key in citation.as_hash().expect("a map").keys() {
        assert!(KEYS.contains(&key.as_str().expect("a text")), "{key:?}");
    }
}

/// What GitHub requires of a form.
#[test]
fn the_forms_for_issues_are_valid() {
    for form in ["verdict", "table", "bug"] {
        let form = yaml(&format!(".github/ISSUE_TEMPLATE/{form}.yml"));
        for key in ["name", "description"] {
            assert!(form[key].as_str().is_some_and(|text| !text.is_empty()));
        }
        let fields = form["body"].as_vec().expect("a list");
        let mut ids: Vec<&str> = fields
            .iter()
            .filter_map(|field| field["id"].as_str())
            .collect();
        assert!(ids.len() == fields.len() && ids.len() >= 3);
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), fields.len(), "an id twice: {ids:?}");
        for field in fields {
            let kind = field["type"].as_str().expect("a type");
            assert!(["textarea", "input"].contains(&kind), "{kind}");
            assert!(field["attributes"]["label"].as_str().is_some());
        }
        let required = |field: &&Yaml| field["validations"]["required"].as_bool() == Some(true);
        assert!(fields.iter().filter(required).count() >= 3);
    }
}
