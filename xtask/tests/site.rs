//! The site: its pages are short, and its workflow publishes only what is on `main`, with the least
//! rights, by `.ci/site`.

use std::fs;
use std::path::Path;

use yaml_rust2::Yaml;

use crate::place::root;
use crate::workflow::{
    assert_no_logic, assert_pinned, assert_rights, commands, keys, steps, workflow,
};

/// The pages of the book.
const BOOK: &str = "crates/convergence-study/book/src";

/// Words of the longest page of the site.
const LONGEST: usize = 900;

/// References that a program writes, and the rule, may be longer.
const REFERENCES: [&str; 5] = [
    "inconclusive.md",
    "reading-tables.md",
    "../../STUDIES.md",
    "../../../thermobeam-study/STUDIES.md",
    "../../../convergence-judge/src/judge/verdict/RULE.md",
];

#[test]
fn the_site_has_each_page_once_and_no_long_one() {
    let folder = root().join(BOOK);
    let summary = fs::read_to_string(folder.join("SUMMARY.md")).unwrap();
    let links = summary.split("](").skip(1);
    let mut listed: Vec<&str> = links.map(|rest| rest.split_once(')').unwrap().0).collect();
    for page in &listed {
        let text = fs::read_to_string(folder.join(page)).unwrap();
        let words = text.split_whitespace().count();
        assert!(
            words <= LONGEST || REFERENCES.contains(page),
            "{page}: {words} words"
        );
    }
    // All pages of the book and of its gallery, beside those of other folders.
    listed.retain(|page| !page.starts_with("../"));
    listed.sort_unstable();
    let mut pages = [pages_in(&folder, ""), pages_in(&folder, "gallery/")].concat();
    pages.retain(|name| name != "SUMMARY.md");
    pages.sort_unstable();
    assert_eq!(listed, pages);
}

/// The pages in a part of a folder, by their paths from that folder.
fn pages_in(folder: &Path, part: &str) -> Vec<String> {
    let entries = fs::read_dir(folder.join(part)).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let pages = names.filter(|name| name.ends_with(".md"));
    pages.map(|name| format!("{part}{name}")).collect()
}

#[test]
fn nothing_but_a_push_to_main_publishes_the_site() {
    let workflow = workflow("site.yml");
    assert_eq!(keys(&workflow["on"]), ["push"]);
    assert_eq!(keys(&workflow["on"]["push"]), ["branches"]);
    let branches = workflow["on"]["push"]["branches"]
        .as_vec()
        .expect("branches");
    assert_eq!(branches, &[Yaml::String("main".to_owned())]);
}

#[test]
fn each_job_of_the_site_has_the_least_rights() {
    assert_rights(
        "site.yml",
        &[
            ("build", "contents: read"),
            ("publish", "id-token: write, pages: write"),
        ],
    );
}

#[test]
fn actions_of_the_site_are_pinned_by_commit() {
    assert_pinned("site.yml", 3);
}

#[test]
fn what_is_published_is_what_the_script_has_built_and_checked() {
    assert_no_logic("site.yml");
    let workflow = workflow("site.yml");
    let build = &workflow["jobs"]["build"];
    let commands = commands(&workflow);
    assert!(commands.contains(&("build", ".ci/site dist")));
    let upload = steps(build).last().expect("a step");
    assert_eq!(upload["with"]["path"].as_str(), Some("dist"));
    assert_eq!(workflow["jobs"]["publish"]["needs"].as_str(), Some("build"));
}
