//! Explanations printed for studies, reasons and the terms of a project.

use std::collections::BTreeSet;
use std::path::Path;

use convergence_study::{
    Axis, Claim, Header, InputError, KindRow, Project, Section, Study, Term, boxed_study,
    internal::cli::explain::{contents, nearest_name, study, term, terms},
    levels,
};

const KIND: KindRow = KindRow {
    name: "quadrature",
    keys: &[],
    read,
    why: "The error of a quadrature rule of order p falls like h^p where the integrand is smooth, as Taylor's formula \
          shows for each cell, and adding the errors of all cells loses one power that the smallness of a cell gains.",
    judged: "By the rate at h -> 0.",
    failure: "A wrong weight or node.",
};

const PROJECT: Project = Project {
    kinds: &[KIND],
    terms: &[
        Term {
            name: "l2",
            what: "a norm",
            text: "The square root of the integral of the square",
        },
        Term {
            name: "sup",
            what: "a norm",
            text: "The largest absolute value",
        },
        Term {
            name: "node",
            what: "a part of a rule",
            text: "A point at which the integrand is evaluated",
        },
    ],
    ..Project::new("quadrature", "cargo xtask")
};

fn read(header: Header, _: &Section<'_>, _: &Path) -> Result<Box<dyn Study>, InputError> {
    let study =
        levels([4, 8, 16, 32, 64], |n| [("l2", 1.0 / n as f64)]).counting("cells", Axis::Space);
    Ok(boxed_study(
        header,
        study.claiming("l2", Claim::new(1.0, 0.05)),
    ))
}

fn example(kind: &str) -> Box<dyn Study> {
    let header = Header {
        kind: kind.to_owned(),
        ..Header::new("left-rule", "the left rule is of first order")
    };
    let text = "[study]\nid = \"a\"\nclaim = \"c\"\ntier = \"quick\"\n";
    convergence_study::internal::input::parse(text, "a.toml", |root| {
        read(header, root, Path::new("."))
    })
    .unwrap()
}

#[track_caller]
fn check_lines(text: &str) {
    assert!(
        text.lines().all(|line| line.chars().count() <= 100),
        "{text}"
    );
}

#[test]
fn every_term_has_one_meaning() {
    let names = terms(&PROJECT);
    assert_eq!(
        names.iter().collect::<BTreeSet<_>>().len(),
        names.len(),
        "{names:?}"
    );
    assert!(
        names.len() > 20
            && ["l2", "node", "too-low", "quadrature"]
                .iter()
                .all(|name| names.contains(name))
    );
    let contents = contents(&PROJECT);
    check_lines(&contents);
    for name in names {
        let text = term(&PROJECT, name).unwrap_or_else(|| panic!("{name}"));
        assert!(text.starts_with(&format!("{name}, a")), "{text}");
        check_lines(&text);
        assert!(contents.contains(name), "{name} is not in {contents}");
    }
    assert!(contents.contains("\na norm\n  l2, sup\n"), "{contents}");
    assert_eq!(term(&PROJECT, "magic"), None);
}

#[test]
fn a_study_is_explained_by_its_claim_its_kind_and_its_details() {
    let text = study(&PROJECT, example("quadrature").as_ref()).unwrap();
    assert!(
        text.starts_with("left-rule (quadrature, tier quick)\n"),
        "{text}"
    );
    let titles = [
        "what is claimed",
        "why it should hold",
        "levels",
        "how it is judged",
        "what a failure would mean",
    ];
    let places: Vec<Option<usize>> = titles
        .iter()
        .map(|title| text.find(&format!("\n{title}\n")))
        .collect();
    assert!(
        places.iter().all(Option::is_some) && places.is_sorted(),
        "{text}"
    );
    assert!(
        text.contains("cells = 4, cells = 8") && text.contains("l2 1 ± 0.05"),
        "{text}"
    );
    check_lines(&text);
    assert_eq!(study(&PROJECT, example("another").as_ref()), None);
}

#[test]
fn a_misspelt_name_is_recognised_among_ids_and_terms() {
    assert_eq!(
        nearest_name(&PROJECT, ["left-rule"], "left-rul").as_deref(),
        Some("left-rule")
    );
    assert_eq!(
        nearest_name(&PROJECT, ["left-rule"], "too-lwo").as_deref(),
        Some("too-low")
    );
    assert_eq!(
        nearest_name(&PROJECT, ["left-rule"], "completely-different"),
        None
    );
}
