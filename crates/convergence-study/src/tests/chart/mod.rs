//! Laws that every figure obeys, whatever its data.

pub(crate) mod back;
mod fitted;
mod gallery;
pub(crate) mod laws;
mod rows;

use crate::chart::{glyphs::text_width, *};
use gallery::{errors_over_h, gallery};
use laws::{EXTREMES, LAWS, UNITS, elements, parse};

#[test]
fn every_figure_obeys_the_laws_of_all_figures() {
    for (name, svg) in gallery() {
        LAWS.iter().for_each(|law| law(name, &parse(&svg)));
        laws::every_curve_belongs_to_an_entry_of_the_legend(name, &parse(&svg));
    }
}

pub(crate) fn texts(svg: &str) -> Vec<String> {
    elements(&parse(svg), "text")
        .map(|n| n.text().unwrap_or("").trim().to_owned())
        .collect()
}

/// Whether a picture has a text.
pub(crate) fn shows(svg: &str, text: &str) -> bool {
    texts(svg).iter().any(|one| one == text)
}

#[test]
fn the_same_data_give_the_same_bytes() {
    assert_eq!(gallery(), gallery());
}

/// A chart of one curve.
fn curve(y: Axis, points: &[(f64, f64)]) -> Chart {
    let mut chart = Chart::empty(Axis::linear("time t"), y);
    chart.curve("s", points.iter().copied());
    chart
}

#[test]
fn points_that_cannot_be_drawn_are_counted() {
    let points = [
        (1.0, 1.0),
        (2.0, f64::NAN),
        (f64::NEG_INFINITY, 1.0),
        (3.0, -1.0),
        (4.0, f64::INFINITY),
        (5.0, 2.0),
    ];
    for (y, note) in [
        (
            Axis::log("v"),
            "4 points not drawn: not finite, or not positive (logarithmic axis)",
        ),
        (Axis::linear("v"), "3 points not drawn: not finite"),
    ] {
        assert!(shows(&curve(y, &points).svg(), note), "{note}");
    }
}

#[test]
fn a_missing_cell_is_noted_unless_it_is_hatched() {
    let mut map = gallery::stability_map();
    let is_noted = |map: &Chart| {
        texts(&map.svg())
            .iter()
            .any(|t| t.contains("not drawn: not finite"))
    };
    assert!(!is_noted(&map));
    map.cells.as_mut().expect("cells").missing.clear();
    assert!(is_noted(&map));
}

#[test]
fn charts_of_nothing_and_of_extreme_data_are_documents() {
    parse(&Chart::default().svg());
    parse(&deviations(vec![]).svg());
    parse(&Chart::panels("", &[]));
    for (x, y) in EXTREMES.into_iter().flat_map(|x| EXTREMES.map(|y| (x, y))) {
        for is_log in [false, true] {
            let axis = Axis {
                is_log,
                ..Axis::linear("y")
            };
            let mut chart = Chart {
                guides: vec![Guide {
                    label: "g".into(),
                    value: y,
                }],
                bands: vec![Shade {
                    label: "b".into(),
                    intervals: vec![(x, y), (y, x)],
                }],
                slopes: vec![x, 1.0],
                ..curve(axis.clone(), &[(x, y), (y, x), (x, x)])
            };
            chart.x.is_log = is_log;
            parse(&chart.svg());
            chart.cells = Some(Cells {
                x: chart.series[0].x.clone(),
                y: chart.series[0].y.clone(),
                value: chart.series[0].x.clone(),
                colours: axis,
                missing: "m".into(),
            });
            parse(&chart.svg());
        }
    }
}

#[test]
fn constant_data_have_an_axis_with_ticks() {
    let svg = curve(Axis::linear("v"), &[(0.0, 3.0), (1.0, 3.0)]).svg();
    assert!(
        texts(&svg)
            .iter()
            .filter(|t| t.parse::<f64>().is_ok())
            .count()
            >= 5
    );
}

#[test]
fn a_spike_in_a_long_history_is_drawn() {
    let points: Vec<(f64, f64)> = (0..200_000)
        .map(|k| (f64::from(k), if k == 123_456 { 5.0 } else { 0.0 }))
        .collect();
    let svg = curve(Axis::linear("v"), &points).svg();
    let doc = parse(&svg);
    let marks = back::series(doc.root_element()).remove(0).marks;
    let highest = marks.iter().map(|at| at[1]).fold(f64::INFINITY, f64::min);
    // The top of the plot is 48 px down the page, and 1/22 of the plot's 430 px stays free above
    // the data.
    assert!(highest < UNITS * (48.0 + 430.0 / 20.0), "{highest}");
}

#[test]
fn figures_stay_small() {
    let mut long = gallery::noise(100_000, 8);
    let intervals = (0..50_000).map(|k| (2.0 * f64::from(k), 2.0 * f64::from(k) + 1.0));
    long.bands = vec![Shade {
        label: "at a stop".into(),
        intervals: intervals.collect(),
    }];
    let [long, field] = [long, gallery::field(200, 110)].map(|chart| chart.svg().len());
    assert!(long < 250_000 && field < 400_000, "{long} {field}");
}

#[test]
fn labels_are_all_there() {
    for (chart, labels) in [
        (
            gallery::long_history(1000),
            &[
                "g₁ = −0.01",
                "g₂ = 0.1",
                "at a stop",
                "euler-crank-nicolson",
                "midpoint",
                "time t",
            ][..],
        ),
        (
            errors_over_h(),
            &[
                "energy norm, order 1, rate 1.0000",
                "mesh width h",
                "10⁻³",
                "1",
                "2",
            ],
        ),
        (gallery::stability_map(), &["diverged"]),
        (
            gallery::over_variants(),
            &[
                "undecided",
                "0.5",
                "2.5",
                "triangles at the rim: beyond the plot",
            ],
        ),
    ] {
        let svg = chart.svg();
        for label in labels {
            assert!(shows(&svg, label), "{label}: {:?}", texts(&svg));
        }
    }
}

#[test]
fn series_differ_without_colour() {
    let svg = gallery::long_history(1000).svg();
    let doc = parse(&svg);
    let dashes = |colour: &'static str| {
        let lines =
            elements(&doc, "polyline").filter(move |n| n.attribute("stroke") == Some(colour));
        lines
            .filter_map(|n| n.parent()?.attribute("stroke-dasharray"))
            .count()
    };
    assert_eq!(dashes("#0072B2"), 0);
    assert!(dashes("#D55E00") >= 2);
}

#[test]
fn the_first_64_styles_differ() {
    let drawn = |k: usize| {
        let mut chart = curve(Axis::linear("v"), &[(0.0, 1.0), (1.0, 2.0)]);
        chart.series[0] = chart.series[0].clone().scattered().styled(k);
        chart.svg()
    };
    let styles: Vec<_> = (0..64).map(drawn).collect();
    for (k, one) in styles.iter().enumerate() {
        assert!(!styles[..k].contains(one), "{k}");
    }
}

#[test]
fn counts_have_whole_ticks() {
    let y = Axis::linear("iterations per step").showing([0.0, 5.0]);
    let svg = curve(y, &[(0.1, 3.0), (0.2, 3.0)]).svg();
    let doc = parse(&svg);
    let heights = elements(&doc, "text").filter(|n| n.attribute("text-anchor") == Some("end"));
    let heights: Vec<_> = heights.filter_map(|n| n.text()).map(str::trim).collect();
    assert!(
        heights.len() >= 4 && heights.iter().all(|text| text.parse::<u32>().is_ok()),
        "{heights:?}"
    );
}

/// For papers: nothing but the title goes, and its row.
#[test]
fn a_title_can_be_left_out() {
    let panels = ("panels", gallery::both_panels());
    for (name, svg) in gallery().into_iter().chain([panels]) {
        let without = without_title(&svg);
        let [all, rest] = [&svg, &without].map(|svg| texts(svg));
        let titles = svg.matches("data-title").count();
        assert_eq!(rest.len() + titles, all.len(), "{name}");
        let [before, after] =
            [&svg, &without].map(|svg| laws::number(parse(svg).root_element(), "height"));
        assert_eq!(before - after, 32.0, "{name}");
        laws::every_figure_is_well_formed_and_free_of_nan(name, &parse(&without));
    }
    assert_eq!(without_title("no picture"), "no picture");
}

#[test]
fn each_panel_lies_below_the_one_before() {
    let document = gallery::both_panels();
    let doc = parse(&document);
    let panels: Vec<_> = doc
        .descendants()
        .filter(|n| n.has_attribute("data-plot"))
        .collect();
    let [first, second] = panels[..] else {
        panic!("two panels")
    };
    assert_eq!(laws::number(second, "y"), laws::number(first, "height"));
    let left = |panel: roxmltree::Node<'_, '_>| {
        panel
            .attribute("data-plot")
            .and_then(|plot| plot.split(' ').next().map(str::to_owned))
    };
    assert_eq!(
        left(first),
        left(second),
        "the plots begin at the same place"
    );
}

/// A reader of the picture finds the numbers of the table.
#[test]
fn marks_stand_where_the_numbers_of_the_table_are() {
    let chart = errors_over_h();
    let svg = chart.svg();
    let doc = parse(&svg);
    let series = back::series(doc.root_element());
    assert_eq!(series.len(), 8);
    for (drawn, of) in series.iter().zip(&chart.series) {
        assert_eq!(drawn.columns, [of.x.clone(), of.y.clone()]);
        let listed = elements(&doc, "g").find(|n| n.attribute("data-series") == Some(&drawn.label));
        let listed = listed
            .and_then(|n| n.attribute("data-points"))
            .expect("points");
        let points = back::pairs(listed);
        assert_eq!(points.len(), 10);
        assert!(
            rows::misfit(doc.root_element(), &drawn.marks, &points) < 0.2,
            "{}",
            drawn.label
        );
    }
}
