//! No circle among the modules of a crate: of two rooms in one folder, only one may use the other,
//! also by a third.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use super::{files, root, without_comments};

/// The path of a module or an item, from the root of its crate.
type ModulePath = Vec<String>;

/// The sources of a crate by the paths of their modules.
struct Crate {
    modules: BTreeMap<ModulePath, String>,
}

impl Crate {
    fn read(folder: &Path) -> Self {
        let sources = files(folder, &["rs"]).into_iter();
        let sources = sources.filter(|path| !path.ends_with("tests.rs"));
        let modules = sources.map(|path| {
            let text = without_comments(&fs::read_to_string(&path).expect("a source"));
            (module_of(path.strip_prefix(folder).unwrap()), text)
        });
        Self {
            modules: modules.collect(),
        }
    }

    /// The module that a path leads to: its longest beginning that is one.
    fn owner(&self, path: &[String]) -> ModulePath {
        let mut owner = path.to_vec();
        while !self.modules.contains_key(&owner) && owner.pop().is_some() {}
        owner
    }

    /// Which room uses which, by the folder that both are in.
    fn uses_by_folder(&self) -> BTreeMap<ModulePath, BTreeSet<Use>> {
        let mut uses = BTreeMap::<ModulePath, BTreeSet<Use>>::new();
        for (module, text) in &self.modules {
            for path in paths(module, text) {
                let used = self.owner(&path);
                let shared = module.iter().zip(&used).take_while(|(a, b)| a == b).count();
                if let (Some(by), Some(of)) = (module.get(shared), used.get(shared)) {
                    uses.entry(module[..shared].to_vec())
                        .or_default()
                        .insert(Use {
                            by: by.clone(),
                            of: of.clone(),
                        });
                }
            }
        }
        uses
    }
}

/// One room uses another.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Use {
    by: String,
    of: String,
}

/// `a/b.rs` and `a/b/mod.rs` are `a::b`.
fn module_of(path: &Path) -> ModulePath {
    let path = path.with_extension("");
    let names = path.iter().map(|name| name.to_string_lossy().into_owned());
    let mut names: ModulePath = names.collect();
    if matches!(
        names.last().map(String::as_str),
        Some("mod" | "lib" | "main")
    ) {
        names.pop();
    }
    names
}

/// The paths into the crate that a module uses, outside of its tests.
fn paths(module: &[String], text: &str) -> Vec<ModulePath> {
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or("");
    let mut paths = vec![];
    for start in ["crate::", "super::", "self::"] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != ':') {
                branches(&code[at..], vec![], &mut paths);
            }
        }
    }
    let from_root = paths.into_iter().map(|path| absolute(module, path));
    from_root.collect()
}

/// The paths of a tree such as `crate::{a::B, c}`, which is the beginning of a text; adds them, and
/// returns the rest of the text.
fn branches<'t>(text: &'t str, mut path: ModulePath, found: &mut Vec<ModulePath>) -> &'t str {
    let mut rest = text.trim_start();
    loop {
        if let Some(mut list) = rest.strip_prefix('{') {
            loop {
                list = branches(list, path.clone(), found).trim_start();
                match list.strip_prefix(',') {
                    Some(next) if !next.trim_start().starts_with('}') => list = next,
                    Some(next) => return next.trim_start().strip_prefix('}').unwrap_or(""),
                    None => return list.strip_prefix('}').unwrap_or(""),
                }
            }
        }
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
        let end = end.unwrap_or(rest.len());
        path.push(rest[..end].to_owned());
        match rest[end..].strip_prefix("::") {
            Some(next) => rest = next,
            None => {
                found.push(path);
                let after = &rest[end..];
                let alias = after.trim_start().strip_prefix("as ");
                return alias.map_or(after, |alias| {
                    alias.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_')
                });
            }
        }
    }
}

/// A path from the root of the crate.
fn absolute(module: &[String], path: ModulePath) -> ModulePath {
    let mut from = module.to_vec();
    let mut names = path.into_iter().peekable();
    match names.next().as_deref() {
        Some("crate") => from.clear(),
        Some("super") => drop(from.pop()),
        _ => {}
    }
    while names.next_if(|name| name == "super").is_some() {
        from.pop();
    }
    from.extend(names.filter(|name| name != "self"));
    from
}

/// The rooms from which a room is reached again.
fn in_circles(uses: &BTreeSet<Use>) -> BTreeSet<String> {
    let mut reached = uses.clone();
    loop {
        let further = reached.iter().flat_map(|first| {
            let next = uses.iter().filter(|next| next.by == first.of);
            next.map(|next| Use {
                by: first.by.clone(),
                of: next.of.clone(),
            })
        });
        let more: BTreeSet<Use> = further.filter(|step| !reached.contains(step)).collect();
        if more.is_empty() {
            break;
        }
        reached.extend(more);
    }
    let circles = reached.into_iter().filter(|step| step.by == step.of);
    circles.map(|step| step.by).collect()
}

#[test]
fn no_module_uses_itself_by_others() {
    let crates = fs::read_dir(root().join("crates")).expect("crates");
    let folders = crates.map(|entry| entry.expect("a crate").path().join("src"));
    let folders = folders.chain([root().join("xtask/src")]);
    let mut folders: Vec<_> = folders.filter(|folder| folder.is_dir()).collect();
    folders.sort();
    assert!(folders.len() > 10, "{folders:?}");
    let mut found = vec![];
    for folder in folders {
        for (shared, uses) in Crate::read(&folder).uses_by_folder() {
            let circle: Vec<String> = in_circles(&uses).into_iter().collect();
            if !circle.is_empty() {
                let place = folder.join(shared.join("/"));
                let place = place.strip_prefix(root()).expect("below the root");
                found.push(format!("{}: {}", place.display(), circle.join(", ")));
            }
        }
    }
    assert!(
        found.is_empty(),
        "circles among modules:\n{}",
        found.join("\n")
    );
}

#[test]
fn a_circle_is_found() {
    let module = |name: &str| -> ModulePath { name.split("::").map(str::to_owned).collect() };
    let with = |b: &str| Crate {
        modules: [
            (vec![], "mod a;"),
            (module("a"), "use crate::b::{C, d::{self, E as F}};"),
            (module("b"), b),
            (module("c"), "fn f() { super::a::f() }"),
        ]
        .map(|(path, text)| (path, text.to_owned()))
        .into(),
    };
    let circles = |sources: &Crate| in_circles(&sources.uses_by_folder()[&vec![]]);
    assert!(circles(&with("use crate::text;")).is_empty());
    let three = ["a", "b", "c"].map(str::to_owned).into();
    assert_eq!(circles(&with("use crate::c;")), three);
    let tests_only = with("#[cfg(test)]\nmod tests {\n    use crate::c;\n}");
    assert!(circles(&tests_only).is_empty());
}
