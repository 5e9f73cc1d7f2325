//! No code reads a sentence of a finding, so a better wording changes nothing else.
//!
//! The texts of findings are claim, evidence, summary, headline, because and reason. They are made
//! for people, from data that stands next to them, and only printed.

use std::fs;
use std::path::PathBuf;

use super::{files, root};

/// The names of the texts, as fields and as variables.
const TEXTS: [&str; 6] = [
    "claim", "evidence", "summary", "headline", "because", "reason",
];

/// Methods that give the same text in another form.
const NEUTRAL: [&str; 9] = [
    "as_str()",
    "as_deref()",
    "as_ref()",
    "clone()",
    "trim()",
    "lines()",
    "to_string()",
    "to_owned()",
    "to_lowercase()",
];

/// Beginnings of methods that read a text.
const READS: [&str; 12] = [
    "contains(",
    "starts_with(",
    "ends_with(",
    "split",
    "rsplit",
    "strip_",
    "find(",
    "rfind(",
    "replace",
    "matches(",
    "match_indices(",
    "trim_",
];

/// A source without white space around the points of method calls, and without its tests.
fn code(text: &str) -> String {
    let product = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text);
    let lines = product.lines().map(str::trim);
    let lines = lines.filter(|line| !line.starts_with("//"));
    let mut joined = String::new();
    for line in lines {
        if !line.starts_with('.') {
            joined.push('\n');
        }
        joined.push_str(line);
    }
    joined
}

/// The places at which a source reads a text.
fn reads(text: &str) -> Vec<String> {
    let code = code(text);
    let mut found = vec![];
    for name in TEXTS {
        for (start, _) in code.match_indices(name) {
            let before = code[..start].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_') {
                continue;
            }
            let mut rest = &code[start + name.len()..];
            while let Some(after) = NEUTRAL
                .iter()
                .find_map(|neutral| rest.strip_prefix('.')?.strip_prefix(neutral))
            {
                rest = after;
            }
            let method = rest.strip_prefix('.').unwrap_or_default();
            let is_read = READS.iter().any(|read| method.starts_with(read));
            let is_compared = [" == \"", " != \""]
                .iter()
                .any(|read| rest.starts_with(read));
            let is_matched = code[..start].ends_with("matches!(");
            if is_read || is_compared || is_matched {
                found.push(code[start..].chars().take(60).collect());
            }
        }
    }
    found
}

/// The sources of all crates.
fn all_sources() -> Vec<PathBuf> {
    let root = root();
    let mut paths = files(&root.join("xtask/src"), &["rs"]);
    for entry in fs::read_dir(root.join("crates")).unwrap().flatten() {
        let source = entry.path().join("src");
        if source.is_dir() {
            paths.extend(files(&source, &["rs"]));
        }
    }
    assert!(paths.len() > 200, "{}", paths.len());
    paths
}

/// A rate is put in words beside its claim in one place.
#[test]
fn one_source_writes_a_rate_with_its_claim() {
    let writes = |path: &PathBuf| {
        let code = code(&fs::read_to_string(path).unwrap());
        code.contains(", claimed {") || code.contains("(order {")
    };
    let writers: Vec<PathBuf> = all_sources().into_iter().filter(writes).collect();
    assert_eq!(writers.len(), 1, "{writers:?}");
    assert!(writers[0].ends_with("convergence-judge/src/judge/verdict/outcome.rs"));
}

#[test]
fn no_source_reads_a_sentence_of_a_finding() {
    let mut found = vec![];
    for path in all_sources() {
        let text = fs::read_to_string(&path).unwrap();
        let shown = path.display();
        found.extend(reads(&text).iter().map(|read| format!("{shown}: {read}")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn each_way_to_read_a_sentence_is_found() {
    for code in [
        "check.claim.contains(\"rho\")",
        "check\n    .claim\n    .rsplit_once(\": \")",
        "let Check { evidence, .. } = check;\nevidence.split(' ')",
        "outcome.summary.replacen(&a, &b, 1)",
        "rate.reason.as_str().strip_prefix(\"x\")",
        "check.claim == \"every case completes\"",
        "headline != \"\"",
        "matches!(because.as_str(), \"a\")",
    ] {
        assert_eq!(reads(code).len(), 1, "{code}");
    }
    for code in [
        "check.claim.clone()",
        "claim.order.max(1.0)",
        "claims.contains(&claim)",
        "outcome.summary.is_empty()",
    ] {
        assert_eq!(reads(code), Vec::<String>::new(), "{code}");
    }
}
