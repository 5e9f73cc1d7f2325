//! Laws that every figure obeys, whatever its data.

mod figures;

use convergence_study::plots::*;
use roxmltree::{Document, Node};

/// Units of a page per px.
const UNITS: f64 = 10.0;

fn parse(svg: &str) -> Document<'_> {
    Document::parse(svg).unwrap_or_else(|e| panic!("not well-formed: {e}"))
}

fn elements<'a>(doc: &'a Document<'a>, tag: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    doc.descendants().filter(move |n| n.has_tag_name(tag))
}

fn number(node: Node<'_, '_>, attribute: &str) -> f64 {
    node.attribute(attribute).and_then(|v| v.parse().ok()).unwrap_or_else(|| panic!("{attribute} in {node:?}"))
}

fn texts(svg: &str) -> Vec<String> {
    elements(&parse(svg), "text").map(|n| n.text().unwrap_or("").trim().to_owned()).collect()
}

/// Points of all lines of a colour that are longer than a legend's.
fn points_of(svg: &str, colour: &str) -> usize {
    let doc = parse(svg);
    let lines = elements(&doc, "polyline").filter(|n| n.attribute("stroke") == Some(colour));
    lines.filter_map(|n| n.attribute("points")).map(|p| p.split_whitespace().count()).filter(|&n| n > 2).sum()
}

/// Left, top, right, bottom of a text in page units; widths estimated on the narrow side.
fn bounds(node: Node<'_, '_>) -> [f64; 4] {
    let size = number(node, "font-size");
    let width = 0.5 * size * node.text().unwrap_or("").trim().chars().count() as f64;
    let (x, y) = (number(node, "x"), number(node, "y"));
    let before = match node.attribute("text-anchor") {
        Some("start") => 0.0,
        Some("end") => width,
        _ => 0.5 * width,
    };
    if node.attribute("transform").is_some() {
        return [x - 0.5 * size, y - 0.5 * width, x + 0.5 * size, y + 0.5 * width];
    }
    [x - before, y - 0.4 * size, x - before + width, y + 0.4 * size]
}

#[test]
fn every_figure_is_in_the_gallery() {
    let (plots, gallery) = (include_str!("../src/plots/mod.rs"), include_str!("figures/mod.rs"));
    let exported = plots.lines().filter(|line| line.starts_with("pub use ")).flat_map(|line| {
        let names = line.split(['{', '}']).nth(1).unwrap_or_default();
        names.split(", ").filter(|name| name.starts_with(char::is_lowercase))
    });
    let figures: Vec<_> = exported.collect();
    assert!(figures.len() >= 10);
    for figure in figures {
        assert!(gallery.contains(&format!(", {figure}(")), "{figure} is not in the gallery");
        assert!(plots.contains(&format!("//! | [`{figure}`] | ")), "{figure} has no row at the head of plots/mod.rs");
    }
}

#[test]
fn every_figure_is_well_formed_and_free_of_nan() {
    for (name, svg) in figures::gallery() {
        let doc = parse(&svg);
        assert!(doc.root_element().has_tag_name("svg"), "{name}");
        let numbers = doc.descendants().flat_map(|n| n.attributes()).filter(|a| a.name() != "font-family");
        for a in numbers {
            let value = a.value().to_lowercase();
            assert!(!value.contains("nan") && !value.contains("inf"), "{name}: {a:?}");
        }
    }
}

#[test]
fn the_same_data_give_the_same_bytes() {
    assert_eq!(figures::gallery(), figures::gallery());
}

#[test]
fn every_text_is_large_enough_and_on_the_page() {
    for (name, svg) in figures::gallery() {
        let doc = parse(&svg);
        let page = doc.root_element();
        let (width, height) = (UNITS * number(page, "width"), UNITS * number(page, "height"));
        for text in elements(&doc, "text") {
            assert!(number(text, "font-size") >= 14.0 * UNITS, "{name}: {:?}", text.text());
            let [left, top, right, bottom] = bounds(text);
            let is_inside = left >= 0.0 && top >= 0.0 && right <= width && bottom <= height;
            assert!(is_inside, "{name}: {:?} at {:?}", text.text(), bounds(text));
        }
    }
}

#[test]
fn no_two_texts_overlap() {
    for (name, svg) in figures::gallery() {
        let doc = parse(&svg);
        let all: Vec<_> = elements(&doc, "text").map(|n| (n.text().unwrap_or(""), bounds(n))).collect();
        for (k, (a, p)) in all.iter().enumerate() {
            for (b, q) in &all[..k] {
                let apart = p[0] >= q[2] || q[0] >= p[2] || p[1] >= q[3] || q[1] >= p[3];
                assert!(apart, "{name}: {a:?} on {b:?}");
            }
        }
    }
}

#[test]
fn every_finite_point_is_drawn() {
    let figure = WorkPrecision {
        y_label: "error".into(),
        series: vec![Series {
            label: "s".into(),
            points: (1..40).map(|k| (f64::from(k), 1.0 / f64::from(k))).collect(),
        }],
        x_label: None,
        title: None,
    };
    let svg = work_precision(&figure);
    // One marker more in the legend.
    assert_eq!(elements(&parse(&svg), "circle").count(), 39 + 1);
    assert_eq!(points_of(&svg, "#0072B2"), 39);
}

#[test]
fn points_that_cannot_be_drawn_are_counted() {
    let points =
        vec![(1.0, 1.0), (2.0, f64::NAN), (f64::NEG_INFINITY, 1.0), (3.0, -1.0), (4.0, f64::INFINITY), (5.0, 2.0)];
    let series = vec![Series { label: "s".into(), points }];
    let log = history(&History { y: Axis::log("v"), series: series.clone(), ..Default::default() });
    assert!(texts(&log).contains(&"3 non-finite points not drawn".to_owned()));
    assert!(texts(&log).contains(&"1 non-positive point not drawn (logarithmic axis)".to_owned()));
    let linear = history(&History { y: Axis::linear("v"), series, ..Default::default() });
    assert!(texts(&linear).iter().all(|t| !t.contains("non-positive")));
}

#[test]
fn nothing_to_draw_is_no_reason_to_panic() {
    let empty = [
        convergence(&Convergence::default()),
        surface(&Surface::default()),
        history(&History::default()),
        space_time(&SpaceTime::default()),
        contraction(&Contraction::default()),
        iterations(&Iterations::default()),
        parameter_map(&ParameterMap::default()),
        bifurcation(&Bifurcation::default()),
        work_precision(&WorkPrecision::default()),
        animation(&Animation::default()),
    ];
    empty.iter().for_each(|svg| drop(parse(svg)));
}

#[test]
fn extreme_data_are_no_reason_to_panic() {
    let values = [0.0, -0.0, 1.0, -1.0, 1e-320, 1e308, -1e308, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for x in values {
        for y in values {
            let points = vec![(x, y), (y, x), (x, x)];
            let series = vec![Series { label: "s".into(), points: points.clone() }];
            let intervals = points.clone();
            let phases = Phases { label: "p".into(), intervals };
            let guides = vec![Guide { label: "g".into(), value: y }];
            for axis in [Axis::linear("y"), Axis::log("y")] {
                let (series, guides, phases) = (series.clone(), guides.clone(), phases.clone());
                parse(&history(&History { y: axis, series, guides, phases, ..Default::default() }));
            }
            let fit = Some(PowerLaw { rate: x, constant: y });
            let norm =
                ErrorSeries { points: points.clone(), order: Some(x), fit, baseline: points, ..Default::default() };
            parse(&convergence(&Convergence { series: vec![norm], slopes: vec![x, 1.0], ..Default::default() }));
            parse(&contraction(&Contraction { series: series.clone(), title: None }));
            let (x_values, y_values, values) = (vec![x, y, 1.0], vec![x, y], vec![vec![x, y, 2.0], vec![y]]);
            let cells = Surface { x_values, y_values, values, z: Axis::log("z"), ..Default::default() };
            parse(&surface(&cells));
            parse(&parameter_map(&ParameterMap {
                cells,
                marked: vec![vec![true]],
                boundaries: series,
                ..Default::default()
            }));
            let frames = vec![vec![x, y], vec![y, 1.0]];
            let (times, nodes) = (vec![x, y], vec![y, x]);
            parse(&space_time(&SpaceTime {
                times: times.clone(),
                nodes: nodes.clone(),
                frames: frames.clone(),
                ..Default::default()
            }));
            parse(&animation(&Animation { times, nodes, frames, obstacles: Some((x, y)), seconds: x, title: None }));
        }
    }
}

#[test]
fn constant_data_have_an_axis_with_ticks() {
    let series = vec![Series { label: "s".into(), points: vec![(0.0, 3.0), (1.0, 3.0)] }];
    let svg = history(&History { y: Axis::linear("v"), series, ..Default::default() });
    assert!(texts(&svg).iter().filter(|t| t.parse::<f64>().is_ok()).count() >= 5);
}

#[test]
fn a_spike_in_a_long_history_is_drawn() {
    let mut figure = figures::tip_history(200_000);
    figure.guides.clear();
    figure.series.truncate(1);
    figure.series[0].points[123_456].1 = 5.0;
    let svg = history(&figure);
    let doc = parse(&svg);
    let coordinates = elements(&doc, "polyline").filter(|n| n.attribute("stroke") == Some("#0072B2"));
    let heights = coordinates.flat_map(|n| n.attribute("points").unwrap_or("").split_whitespace());
    let highest = heights.filter_map(|p| p.split_once(',')?.1.parse::<f64>().ok()).fold(f64::INFINITY, f64::min);
    // The top of the plot is 16 px down the page, and 1/22 of the plot's 430 px are left free above the data.
    assert!(highest < UNITS * (16.0 + 430.0 / 20.0), "{highest}");
}

#[test]
fn figures_stay_small() {
    let noise = |k: usize| (k.wrapping_mul(2_654_435_761) % 1_000_003) as f64 / 1_000_003.0 - 0.5;
    let line = |s: usize| Series {
        label: format!("series {s}"),
        points: (0..100_000).map(|k| (k as f64, noise(k + 31 * s))).collect(),
    };
    let intervals = (0..50_000).map(|k| (2.0 * f64::from(k), 2.0 * f64::from(k) + 1.0)).collect();
    let phases = Phases { label: "contact".into(), intervals };
    let long = History { series: (0..8).map(line).collect(), y: Axis::linear("v"), phases, ..Default::default() };
    assert!(history(&long).len() < 200_000);

    let mut picture = figures::wave(600, 400);
    picture.frames.iter_mut().flatten().enumerate().for_each(|(k, u)| *u = noise(k * k));
    let noisy = space_time(&picture);
    assert!(noisy.len() < 400_000, "{}", noisy.len());

    let mut moving = figures::motion();
    let shape = moving.frames.clone();
    moving.times = (0..2000).map(f64::from).collect();
    moving.frames = (0..2000).map(|k| shape[k % shape.len()].clone()).collect();
    assert!(animation(&moving).len() < 300_000);
}

#[test]
fn labels_are_all_there() {
    let words = texts(&history(&figures::tip_history(1000)));
    for label in ["g₁ = −0.01", "g₂ = 0.1", "contact", "euler-crank-nicolson", "midpoint", "time t (dimensionless)"]
    {
        assert!(words.iter().any(|w| w == label), "{label}");
    }
    let words = texts(&convergence(&figures::space_errors()));
    for label in
        ["theorem-3.4, order 1, rate 1.002", "baseline (ring)", "mesh width h (dimensionless)", "10⁻³", "1", "2"]
    {
        assert!(words.iter().any(|w| w == label), "{label}");
    }
    assert!(texts(&contraction(&figures::contraction_factors())).contains(&"diverges (α ≥ 1)".to_owned()));
    assert!(texts(&parameter_map(&figures::stability_map())).contains(&"diverged".to_owned()));
}

#[test]
fn series_differ_without_colour() {
    let figure = figures::tip_history(1000);
    let svg = history(&figure);
    let doc = parse(&svg);
    let dashes = |colour: &'static str| {
        let of_colour = elements(&doc, "polyline").filter(move |n| n.attribute("stroke") == Some(colour));
        of_colour.filter_map(|n| n.parent()?.attribute("stroke-dasharray")).count()
    };
    assert_eq!(dashes("#0072B2"), 0);
    assert!(dashes("#D55E00") >= 2);
}

#[test]
fn stable_branches_are_solid_and_unstable_ones_dashed() {
    let points = vec![(0.0, 0.0), (1.0, 1.0)];
    let branch = |stable| Branch { label: "free".into(), points: points.clone(), stable };
    let count = |stable| {
        let svg = bifurcation(&Bifurcation { branches: vec![branch(stable)], ..Default::default() });
        elements(&parse(&svg), "g").filter(|n| n.attribute("stroke-dasharray").is_some()).count()
    };
    // Guides, of which there are none here, are dashed too.
    assert_eq!(count(false), count(true) + 2);
}

#[test]
fn the_animation_starts_and_ends_with_its_data() {
    let svg = animation(&figures::motion());
    let doc = parse(&svg);
    let animates: Vec<_> = elements(&doc, "animate").collect();
    assert_eq!(animates.len(), 3);
    for animate in animates {
        let list = |name| animate.attribute(name).unwrap_or("").split(';').collect::<Vec<_>>();
        let (keys, values) = (list("keyTimes"), list("values"));
        assert_eq!(keys.len(), values.len());
        assert_eq!((keys[0].parse(), keys[keys.len() - 1].parse()), (Ok(0.0), Ok(1.0)));
    }
}

#[test]
fn a_missing_cell_is_noted_unless_it_is_marked() {
    let mut map = figures::stability_map();
    assert!(!texts(&parameter_map(&map)).iter().any(|t| t.contains("not drawn")));
    map.marked.clear();
    assert!(texts(&parameter_map(&map)).iter().any(|t| t.contains("non-finite points not drawn")));
}

#[test]
fn what_is_drawn_can_be_read_back() {
    let svg = convergence(&figures::space_errors());
    let doc = parse(&svg);
    let root = doc.root_element();
    let words = |name: &str| root.attribute(name).unwrap().split(' ').map(str::to_owned).collect::<Vec<_>>();
    let plot: Vec<f64> = words("data-plot").iter().map(|v| v.parse().unwrap()).collect();
    let place = |axis: &str, value: f64, from: f64, to: f64| {
        let words = words(axis);
        assert_eq!(words[0], "log");
        let ends: Vec<f64> = words[1..].iter().map(|v| v.parse().unwrap()).collect();
        from + (value.log10() - ends[0]) / (ends[1] - ends[0]) * (to - from)
    };
    let is_velocity = |n: &Node<'_, '_>| n.attribute("data-series").is_some_and(|name| name.starts_with("velocity"));
    let group = elements(&doc, "g").find(|n| is_velocity(n) && n.has_attribute("data-points")).unwrap();
    let markers: Vec<_> = group.descendants().filter(|n| n.has_tag_name("circle")).collect();
    let points: Vec<&str> = group.attribute("data-points").unwrap().split(' ').collect();
    assert_eq!((markers.len(), points.len()), (10, 10));
    for (marker, point) in markers.iter().zip(points) {
        let (x, y) = point.split_once(',').unwrap();
        let at = (
            place("data-x", x.parse().unwrap(), plot[0], plot[2]),
            place("data-y", y.parse().unwrap(), plot[3], plot[1]),
        );
        assert!((at.0 - number(*marker, "cx")).abs() < 2.0 && (at.1 - number(*marker, "cy")).abs() < 2.0, "{point}");
    }
}

#[test]
fn every_curve_belongs_to_an_entry_of_the_legend() {
    for (name, svg) in figures::gallery() {
        let doc = parse(&svg);
        let named = |attribute: &'static str| elements(&doc, "g").filter_map(move |n| n.attribute(attribute));
        let entries: Vec<&str> = named("data-entry").collect();
        assert!(named("data-series").all(|series| entries.contains(&series)), "{name}: {entries:?}");
        let has_curves = !matches!(name, "surface" | "space-time" | "animation");
        assert_eq!(named("data-series").next().is_some(), has_curves, "{name}");
    }
}
