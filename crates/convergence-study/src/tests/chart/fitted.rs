//! Lines of fitted rates: where they end, their markers, their digits.

use crate::Interval;
use crate::chart::{Chart, Mark};
use convergence_judge::verdict::judge_pairs;
use roxmltree::Node;

use super::back::{pairs, series};
use super::gallery::{errors_over_h, judged, over_h};
use super::laws::{elements, number, parse};
use super::shows;

/// Errors of second order, of which the rate does not use the two coarsest.
fn partly_used() -> Chart {
    let mut chart = judged(&[("L2", 1.0, 2.0)]);
    chart.series[0].used = Some(2..10);
    chart
}

/// The discs and the ends of the line of the first series, from left to right.
fn first_series(svg: &str) -> [Vec<f64>; 2] {
    let doc = parse(svg);
    let group = elements(&doc, "g").find(|n| n.has_attribute("data-series"));
    let group = group.expect("a series");
    let discs = group.descendants().filter(|n| n.has_tag_name("circle"));
    let is_blue = |n: &Node<'_, '_>| {
        let mut colours = ["fill", "stroke"].into_iter();
        colours.any(|name| n.attribute(name) == Some("#0072B2"))
    };
    let discs = discs.filter(is_blue);
    let lines = group.descendants().filter_map(|n| n.attribute("points"));
    let corners = lines.flat_map(pairs).map(|corner| corner[0]);
    let mut places = [
        discs.map(|n| number(n, "cx")).collect(),
        corners.collect::<Vec<f64>>(),
    ];
    places
        .iter_mut()
        .for_each(|places| places.sort_by(f64::total_cmp));
    places
}

#[test]
fn a_fitted_line_ends_with_the_levels_that_it_uses() {
    let [discs, ends] = first_series(&partly_used().svg());
    assert_eq!((discs.len(), ends.len()), (10, 2));
    assert!(
        (ends[0] - discs[0]).abs() < 2.0 && (ends[1] - discs[7]).abs() < 2.0,
        "{ends:?} {discs:?}"
    );
}

#[test]
fn levels_without_a_say_have_open_markers_and_a_note() {
    let note = "open markers: points that the rate does not use";
    let open = |svg: &str| {
        let doc = parse(svg);
        let discs = elements(&doc, "circle");
        discs
            .filter(|n| n.attribute("fill") == Some("#FFFFFF"))
            .count()
    };
    let mut chart = partly_used();
    let svg = chart.svg();
    assert!(shows(&svg, note) && open(&svg) == 2);
    // That of the legend is open where all are.
    chart.series[0].used = Some(0..0);
    assert_eq!(open(&chart.svg()), 11);
    let mut all = judged(&[("L2", 1.0, 2.0)]);
    all.series[0].used = None;
    assert!(!shows(&all.svg(), note));
}

#[test]
fn a_rate_has_the_digits_of_its_interval_and_none_with_its_line_where_that_says_nothing() {
    let steps = (3..=12).map(|k| 0.5_f64.powi(k));
    let rate = judge_pairs(steps.map(|h| (h, h * h)), 2.0, 0.1);
    for (interval, label, has_line) in [
        (None, "L2, order 2, rate 2.000", true),
        (Some([1.99999, 2.00001]), "L2, order 2, rate 2.0000", true),
        (Some([1.98, 2.02]), "L2, order 2, rate 2.000", true),
        (Some([1.75, 2.25]), "L2, order 2, rate 2.00", true),
        (Some([1.74, 2.26]), "L2, order 2, no rate", false),
        (Some([f64::NAN, 2.0]), "L2, order 2, no rate", false),
    ] {
        let mut rate = rate.clone();
        rate.interval = interval.map(|[low, high]| Interval { low, high });
        let mut chart = over_h(&[("L2", 1.0, 2.0)]);
        chart.series[0] = chart.series[0].clone().claiming(2.0).judged(&rate);
        let svg = chart.svg();
        assert_eq!(chart.series[0].label, label);
        assert_eq!(
            first_series(&svg)[1].len(),
            if has_line { 2 } else { 0 },
            "{interval:?}"
        );
    }
}

/// Where the errors of two norms agree, the markers of both are seen.
#[test]
fn markers_under_those_of_another_series_are_larger() {
    let largest = |factor: f64| {
        let svg = judged(&[("L2", 1.0, 2.0), ("H1", factor, 2.0)]).svg();
        let doc = parse(&svg);
        elements(&doc, "circle")
            .map(|n| number(n, "r"))
            .fold(0.0, f64::max)
    };
    let [apart, together] = [100.0, 1.001].map(largest);
    assert!(together > 1.4 * apart, "{together} {apart}");
}

/// A line over nearly a decade without points would show what nobody measured.
#[test]
fn no_line_crosses_a_gap_of_errors() {
    let lines = |is_over_steps: bool| {
        let mut chart = over_h(&[("L2", 1.0, 1.0)]);
        let series = &mut chart.series[0];
        series.is_over_steps = is_over_steps;
        let steps = [0.1, 0.05, 0.025, 0.001];
        chart.table = crate::chart::Columns::new([("h", steps.to_vec()), ("L2", steps.to_vec())]);
        first_series(&chart.svg())[1].len()
    };
    assert_eq!([lines(false), lines(true)], [4, 3]);
}

/// A triangle stands below a line of its order and touches neither lines nor markers.
#[test]
fn triangles_touch_no_line() {
    for chart in [
        errors_over_h(),
        over_h(&[("L2", 1.0, 2.0), ("H1", 1.0, 1.0)]),
    ] {
        let chart = Chart {
            slopes: vec![1.0, 2.0],
            ..chart
        };
        let svg = chart.svg();
        let doc = parse(&svg);
        let triangles =
            elements(&doc, "polyline").filter(|n| n.attribute("stroke-width") == Some("16"));
        let triangles: Vec<_> = triangles
            .map(|n| pairs(n.attribute("points").unwrap_or_default()))
            .collect();
        assert_eq!(triangles.len(), 2);
        let markers = series(doc.root_element());
        for corners in triangles {
            let [[left, base], [right, _], [_, top], ..] = corners[..] else {
                panic!("{corners:?}")
            };
            let inside = |[x, y]: &[f64; 2]| {
                let edge = base - (x - left) / (right - left) * (base - top);
                *x > left && *x < right && *y > edge && *y < base
            };
            assert!(
                !markers.iter().flat_map(|series| &series.marks).any(inside),
                "{corners:?}"
            );
        }
    }
}

#[test]
fn an_open_marker_has_a_white_inside_whatever_its_shape() {
    for k in 0..8 {
        let mut chart = over_h(&[("L2", 1.0, 2.0)]);
        chart.series[0].style = Some(k);
        chart.series[0].mark = Mark::Open;
        let svg = chart.svg();
        let doc = parse(&svg);
        let shapes = doc
            .descendants()
            .filter(|n| n.has_tag_name("circle") || n.has_tag_name("polygon"));
        let white = shapes
            .filter(|n| n.attribute("fill") == Some("#FFFFFF"))
            .count();
        // Ten points, and the entry of the legend.
        assert_eq!(white, 11, "{k}");
    }
}
