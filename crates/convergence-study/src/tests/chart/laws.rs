//! Laws that every figure obeys, whatever its data.

use roxmltree::{Document, Node};

use super::back::{mean, pairs};
use super::text_width;

/// A law of figures, of their names and pictures.
type Law = fn(&str, &Document<'_>);

/// The laws of figures of any study, whose curves need not be in a legend.
pub(crate) const LAWS: [Law; 6] = [
    every_figure_is_well_formed_and_free_of_nan,
    every_text_is_large_enough_and_on_the_page,
    every_figure_has_a_title_that_says_more_than_its_axes,
    no_two_texts_overlap,
    every_axis_says_what_it_shows_and_that_it_has_no_unit_once_at_most,
    no_two_entries_of_a_legend_look_alike,
];

/// Units of a page per px.
pub(crate) const UNITS: f64 = 10.0;

/// Numbers that data may hold.
pub(crate) const EXTREMES: [f64; 10] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e-320,
    1e308,
    -1e308,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
];

pub(crate) fn parse(svg: &str) -> Document<'_> {
    Document::parse(svg).unwrap_or_else(|e| panic!("not well-formed: {e}"))
}

pub(crate) fn elements<'a>(
    doc: &'a Document<'a>,
    tag: &'a str,
) -> impl Iterator<Item = Node<'a, 'a>> {
    doc.descendants().filter(move |n| n.has_tag_name(tag))
}

pub(crate) fn number(node: Node<'_, '_>, attribute: &str) -> f64 {
    node.attribute(attribute)
        .and_then(|v| v.parse().ok())
        .unwrap_or_else(|| panic!("{attribute} in {node:?}"))
}

/// Left, top, right, bottom of a text in page units; widths a tenth below those of the layout,
/// which are generous.
pub(crate) fn bounds(node: Node<'_, '_>) -> [f64; 4] {
    let size = number(node, "font-size");
    let width = 0.9 * text_width(node.text().unwrap_or("").trim(), size);
    let (x, y) = (number(node, "x"), number(node, "y"));
    let before = match node.attribute("text-anchor") {
        Some("start") => 0.0,
        Some("end") => width,
        _ => 0.5 * width,
    };
    if node.attribute("transform").is_some() {
        return [
            x - 0.5 * size,
            y - 0.5 * width,
            x + 0.5 * size,
            y + 0.5 * width,
        ];
    }
    // Labels of ticks hang from their place; all other texts stand around its height.
    let y = if text_hangs(node) { y + 0.4 * size } else { y };
    [
        x - before,
        y - 0.4 * size,
        x - before + width,
        y + 0.4 * size,
    ]
}

fn text_hangs(text: Node<'_, '_>) -> bool {
    text.attribute("dy") == Some("0.76em")
}

pub(crate) fn every_figure_is_well_formed_and_free_of_nan(name: &str, doc: &Document<'_>) {
    assert!(doc.root_element().has_tag_name("svg"), "{name}");
    let numbers = doc
        .descendants()
        .flat_map(|n| n.attributes())
        .filter(|a| a.name() != "font-family");
    for a in numbers {
        let value = a.value().to_lowercase();
        assert!(
            !value.contains("nan") && !value.contains("inf"),
            "{name}: {a:?}"
        );
    }
}

fn every_text_is_large_enough_and_on_the_page(name: &str, doc: &Document<'_>) {
    let page = doc.root_element();
    let (width, height) = (
        UNITS * number(page, "width"),
        UNITS * number(page, "height"),
    );
    for text in elements(doc, "text") {
        assert!(
            number(text, "font-size") >= 18.0 * UNITS,
            "{name}: {:?}",
            text.text()
        );
        let [left, top, right, bottom] = bounds(text);
        let is_inside = left >= 0.0 && top >= 0.0 && right <= width && bottom <= height;
        assert!(is_inside, "{name}: {:?} at {:?}", text.text(), bounds(text));
    }
}

/// Above the plot, in larger letters than anything else, and not cut.
fn every_figure_has_a_title_that_says_more_than_its_axes(name: &str, doc: &Document<'_>) {
    const LARGE: f64 = 21.0 * UNITS;
    // One title is there to be cut.
    if name == "hostile" {
        return;
    }
    let page = doc.root_element();
    let mut titles = elements(doc, "text").filter(|n| number(*n, "font-size") > LARGE);
    let title = titles.next().and_then(|n| n.text()).unwrap_or("").trim();
    assert!(titles.next().is_none(), "{name}: two titles");
    let label = |axis| {
        page.attribute(axis)
            .and_then(|label| label.split(" (").next())
    };
    let [y, x] = ["data-y-label", "data-x-label"].map(|axis| label(axis).unwrap_or(""));
    let of_axes = format!("{y} over {x}");
    let says_more = !title.is_empty() && !title.ends_with('…') && title != of_axes;
    assert!(says_more, "{name}: {title:?}");
}

fn no_two_texts_overlap(name: &str, doc: &Document<'_>) {
    let all: Vec<_> = elements(doc, "text")
        .map(|n| (n.text().unwrap_or(""), bounds(n)))
        // An inset has no labels at its axes.
        .filter(|(text, _)| !text.trim().is_empty())
        .collect();
    for (k, (a, p)) in all.iter().enumerate() {
        for (b, q) in &all[..k] {
            let apart = p[0] >= q[2] || q[0] >= p[2] || p[1] >= q[3] || q[1] >= p[3];
            assert!(apart, "{name}: {a:?} on {b:?}");
        }
    }
}

pub(crate) fn every_curve_belongs_to_an_entry_of_the_legend(name: &str, doc: &Document<'_>) {
    let named =
        |attribute: &'static str| elements(doc, "g").filter_map(move |n| n.attribute(attribute));
    let entries: Vec<&str> = named("data-entry").collect();
    assert!(
        named("data-series").all(|series| entries.contains(&series)),
        "{name}: {entries:?}"
    );
    let has_curves = name != "field";
    assert_eq!(named("data-series").next().is_some(), has_curves, "{name}");
}

fn every_axis_says_what_it_shows_and_that_it_has_no_unit_once_at_most(
    name: &str,
    doc: &Document<'_>,
) {
    let page = doc.root_element();
    if page.has_attribute("data-plot") {
        let label = |axis| {
            page.attribute(axis)
                .is_some_and(|label| !label.trim().is_empty())
        };
        assert!(label("data-x-label") && label("data-y-label"), "{name}");
    }
    let texts = elements(doc, "text")
        .filter(|n| n.text().is_some_and(|text| text.contains("dimensionless")));
    assert!(texts.count() <= 1, "{name}");
}

/// How many corners a marker has, and which way the first one points, in px.
fn corners(points: &str) -> String {
    let corners = pairs(points);
    let middle = mean(&corners);
    let from_middle = [0, 1].map(|k| ((corners[0][k] - middle[k]) / UNITS).round());
    format!("{} {from_middle:?}", corners.len())
}

/// What distinguishes the sample of a legend's entry from the others: shapes, colours and dashes,
/// without positions.
fn sample(entry: Node<'_, '_>) -> Vec<String> {
    let shapes = entry
        .descendants()
        .filter(|n| n.is_element() && !n.has_tag_name("text"));
    let attribute = |n: &Node<'_, '_>, name| n.attribute(name).unwrap_or("").to_owned();
    let shape = |n: Node<'_, '_>| {
        let [fill, stroke, dash] =
            ["fill", "stroke", "stroke-dasharray"].map(|name| attribute(&n, name));
        let corners = if n.has_tag_name("polygon") {
            corners(attribute(&n, "points").as_str())
        } else {
            String::new()
        };
        format!("{} {fill} {stroke} {dash} {corners}", n.tag_name().name())
    };
    shapes.map(shape).collect()
}

fn no_two_entries_of_a_legend_look_alike(name: &str, doc: &Document<'_>) {
    let entries: Vec<_> = elements(doc, "g")
        .filter(|n| n.has_attribute("data-entry"))
        .collect();
    for (k, one) in entries.iter().enumerate() {
        for other in &entries[..k] {
            let names = [one, other].map(|n| n.attribute("data-entry"));
            assert_ne!(sample(*one), sample(*other), "{name}: {names:?}");
        }
    }
}
