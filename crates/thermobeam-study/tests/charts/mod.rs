//! Figures of beams: the laws of all figures, and special ones.

#[path = "../../../convergence-study/src/tests/chart/back.rs"]
mod back;
mod committed;
mod figures;
#[path = "../../../convergence-study/src/chart/glyphs.rs"]
mod glyphs;
#[path = "../../../convergence-study/src/tests/chart/laws.rs"]
mod laws;

use std::path::Path;

use figures::{branch, series};
use glyphs::text_width;
use laws::{EXTREMES, LAWS, elements, parse};
use roxmltree::Node;
use thermobeam_study::figures::*;

#[test]
fn figures_of_beams_and_of_the_reports_obey_the_laws_of_all_figures() {
    let gallery = figures::gallery();
    for (name, svg) in &gallery {
        laws::every_curve_belongs_to_an_entry_of_the_legend(name, &parse(svg));
    }
    let of_reports = of_the_reports();
    assert!(of_reports.len() > 100, "{}", of_reports.len());
    for (name, svg) in gallery.into_iter().chain(of_reports) {
        LAWS.iter().for_each(|law| law(name, &parse(&svg)));
    }
}

#[test]
fn every_figure_is_in_the_gallery() {
    let (module, gallery) = (
        include_str!("../../src/figures/mod.rs"),
        include_str!("figures/mod.rs"),
    );
    // The pictures of a run consist of figures that are in a gallery.
    let drawn = module.lines().filter(|line| line.ends_with("-> String {"));
    let drawn = drawn.filter_map(|line| line.strip_prefix("pub fn ")?.split("(").next());
    let exported = module
        .lines()
        .filter_map(|line| line.strip_prefix("pub use ")?.split("::").next());
    let figures: Vec<_> = exported.chain(drawn).collect();
    assert_eq!(figures.len(), 2);
    for figure in figures {
        assert!(
            gallery.contains(&format!(" {figure}(")),
            "{figure} is not in the gallery"
        );
    }
}

/// Without obstacles and simulations.
fn with(branches: Vec<EquilibriumBranch>) -> Bifurcation {
    Bifurcation {
        branches,
        ..Bifurcation::default()
    }
}

/// Without estimates.
fn measured(measured: Vec<NamedPoints>) -> ContractionFactors {
    ContractionFactors {
        measured,
        ..ContractionFactors::default()
    }
}

#[test]
fn contraction_factors_of_one_and_more_are_labelled() {
    let svg = contraction(&figures::contraction_factors());
    assert!(
        elements(&parse(&svg), "text")
            .any(|n| { n.text().is_some_and(|text| text.trim() == "divergence") })
    );
}

#[test]
fn open_markers_of_a_contraction_have_a_legend() {
    let drawn = |series: Vec<NamedPoints>| contraction(&measured(series));
    let open_samples = |svg: &str| {
        let doc = parse(svg);
        let entries = elements(&doc, "g").filter(|n| n.has_attribute("data-entry"));
        let markers = entries
            .flat_map(|n| n.descendants())
            .filter(|n| n.attribute("fill") == Some("#FFFFFF"));
        markers.count()
    };
    let note = "open markers: divergence";
    let apart = drawn(vec![
        series("converges", vec![(0.1, 0.1), (0.5, 0.5)]),
        series("fails", vec![(2.0, 1.0)]),
    ]);
    assert_eq!((open_samples(&apart), apart.contains(note)), (1, false));
    let split = drawn(vec![series("both", vec![(0.1, 0.1), (2.0, 1.0)])]);
    assert_eq!((open_samples(&split), split.contains(note)), (0, true));
}

/// Its axis has limits of its own.
#[test]
fn a_bifurcation_of_nothing_and_of_extreme_data_is_a_document() {
    parse(&bifurcation(&Bifurcation::default()));
    for (x, y) in EXTREMES.into_iter().flat_map(|x| EXTREMES.map(|y| (x, y))) {
        parse(&bifurcation(&with(vec![branch(
            "b",
            true,
            vec![(x, y), (y, x)],
        )])));
    }
}

#[test]
fn stable_branches_are_solid_and_unstable_ones_dashed() {
    let points = vec![(0.0, 0.0), (1.0, 1.0)];
    let count = |stable| {
        let svg = bifurcation(&with(vec![branch("free", stable, points.clone())]));
        elements(&parse(&svg), "g")
            .filter(|n| n.attribute("stroke-dasharray").is_some())
            .count()
    };
    // Guides are dashed too, but there are none here.
    assert_eq!(count(false), count(true) + 2);
}

/// Where the corners of a line are across the page.
fn across<'a>(line: Node<'a, '_>) -> impl Iterator<Item = f64> {
    let lines = line.descendants().filter_map(|n| n.attribute("points"));
    lines.flat_map(back::pairs).map(|corner| corner[0])
}

#[test]
fn markers_are_filled_where_the_fixed_point_converges_and_the_identity_spans_them() {
    let points = vec![(0.1, 0.1), (0.5, 0.5), (2.0, 2.0), (100.0, 100.0)];
    let svg = contraction(&measured(vec![series("s", points)]));
    let doc = parse(&svg);
    let open = elements(&doc, "circle")
        .filter(|n| n.attribute("fill") == Some("#FFFFFF"))
        .count();
    assert_eq!(open, 2);
    let drawn = back::series(doc.root_element());
    let marks = drawn.iter().flat_map(|series| &series.marks);
    let furthest = marks.map(|at| at[0]).fold(0.0, f64::max);
    let identity = elements(&doc, "g")
        .find(|n| n.attribute("data-series") == Some("measured = predicted"))
        .unwrap();
    assert!(
        across(identity).fold(0.0, f64::max) >= furthest - 2.0,
        "it goes as far as the factors do"
    );
}

#[test]
fn branches_end_inside_the_frame() {
    let svg = figures::equilibria();
    let doc = parse(&svg);
    let plot: Vec<f64> = doc
        .root_element()
        .attribute("data-plot")
        .unwrap()
        .split(' ')
        .map(|v| v.parse().unwrap())
        .collect();
    let lines = elements(&doc, "g").filter(|n| n.has_attribute("data-series"));
    let across: Vec<f64> = lines.flat_map(across).collect();
    assert!(
        across
            .iter()
            .all(|x| *x > plot[0] + 50.0 && *x < plot[2] - 50.0),
        "{across:?}"
    );
}

/// Every picture of both tiers, with the name of its file; of a page with several panels, each.
/// Those that only the pages show are there once `verify` has run.
fn of_the_reports() -> Vec<(&'static str, String)> {
    let reports = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports");
    let mut figures = vec![];
    let of_the_page = ["figures/page", "full/figures/page"];
    let of_the_page = of_the_page
        .into_iter()
        .filter(|folder| reports.join(folder).is_dir());
    for folder in ["figures", "full/figures"].into_iter().chain(of_the_page) {
        for entry in std::fs::read_dir(reports.join(folder)).expect(folder) {
            let path = entry.expect(folder).path();
            if path.is_dir() {
                continue;
            }
            let name: &'static str = path.display().to_string().leak();
            let svg = std::fs::read_to_string(&path).expect("a picture");
            figures.extend(panels(&svg).into_iter().map(|panel| (name, panel)));
        }
    }
    figures
}

/// The documents in a document, or the document.
fn panels(svg: &str) -> Vec<String> {
    let doc = parse(svg);
    let inner = doc.root_element().children();
    let panels = inner.filter(|node| node.has_tag_name("svg") && node.has_attribute("data-plot"));
    let panels: Vec<String> = panels.map(|node| svg[node.range()].to_owned()).collect();
    if panels.is_empty() {
        vec![svg.to_owned()]
    } else {
        panels
    }
}
