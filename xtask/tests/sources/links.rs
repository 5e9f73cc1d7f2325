//! Links in Markdown files have targets: an existing file or folder, or an existing heading of a
//! page.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// Folders without files of the project: builds, git, and leftovers of runs on this machine.
const NOT_OURS: [&str; 3] = ["target", ".git", "local"];

/// The Markdown files below a folder.
pub(crate) fn pages(folder: &Path) -> Vec<PathBuf> {
    let mut found = vec![];
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap()) {
        let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
        if path.is_dir() && !NOT_OURS.contains(&name.as_str()) {
            found.extend(pages(&path));
        } else if name.ends_with(".md") {
            found.push(path);
        }
    }
    found
}

/// The links and pictures of a page.
fn links(text: &str) -> Vec<String> {
    let link = |event| match event {
        Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
            Some(dest_url.into_string())
        }
        _ => None,
    };
    Parser::new_ext(text, Options::all())
        .filter_map(link)
        .collect()
}

/// GitHub's anchor of a heading: small letters, digits, `-` and `_`; blanks become `-`, everything
/// else is dropped.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase().replace(' ', "-");
    kept.chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_'))
        .collect()
}

/// The anchors of the headings of a page.
fn anchors(text: &str) -> BTreeSet<String> {
    let (mut found, mut heading) = (BTreeSet::new(), None);
    for event in Parser::new_ext(text, Options::all()) {
        match (event, &mut heading) {
            (Event::Start(Tag::Heading { .. }), _) => heading = Some(String::new()),
            (Event::Text(text) | Event::Code(text), Some(heading)) => heading.push_str(&text),
            (Event::End(TagEnd::Heading(_)), Some(_)) => {
                found.extend(heading.take().map(|heading| anchor(&heading)));
            }
            _ => {}
        }
    }
    found
}

/// The broken links of a page.
fn broken(page: &Path) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap();
    let leads_nowhere = |link: &String| {
        let (file, heading) = link.split_once('#').unwrap_or((link, ""));
        let target = if file.is_empty() {
            page.to_owned()
        } else {
            page.parent().unwrap().join(file)
        };
        let lacks_heading =
            || !fs::read_to_string(&target).is_ok_and(|text| anchors(&text).contains(heading));
        !target.exists() || (!heading.is_empty() && lacks_heading())
    };
    let to_the_web = |link: &String| link.starts_with("https://");
    links(&text)
        .into_iter()
        .filter(|link| !to_the_web(link) && leads_nowhere(link))
        .collect()
}

/// Pages of the site that git ignores: `.ci/site` makes them before it builds the book.
const MADE: [&str; 2] = ["../../STUDIES.md", "../../../thermobeam-study/STUDIES.md"];

#[test]
fn every_link_leads_somewhere() {
    let root = super::root();
    let pages = pages(&root);
    assert!(pages.len() > 15, "{pages:?}");
    let found: Vec<String> = pages
        .iter()
        .flat_map(|page| {
            broken(page)
                .into_iter()
                .filter(|link| !(page.ends_with("SUMMARY.md") && MADE.contains(&link.as_str())))
                .map(move |link| format!("{}: {link}", page.display()))
        })
        .collect();
    assert_eq!(found, Vec::<String>::new());
}

#[test]
fn a_link_that_leads_nowhere_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("a.md");
    let text = "# One `two`, three\n\n[a](a.md) [b](#one-two-three) [c](https://example.org) [d](b.md) [e](#two) ![f](f.svg) [g][h]\n\n\
                [h]: lost.rs\n";
    fs::write(&page, text).unwrap();
    assert_eq!(broken(&page), ["b.md", "#two", "f.svg", "lost.rs"]);
}
