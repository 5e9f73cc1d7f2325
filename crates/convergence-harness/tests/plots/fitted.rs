//! Lines of fitted rates: where they end, their markers, their digits.

use convergence_harness::interval::Interval;
use convergence_harness::judge::verdict::PowerLaw;
use convergence_harness::plots::*;

use super::laws::{elements, number, parse};
use super::{over_h, texts};

/// A straight line of errors; the rate uses all levels except the two coarsest.
fn partly_used() -> ErrorSeries {
    let points: Vec<_> = (2..8)
        .rev()
        .map(|k| 0.5_f64.powi(9 - k))
        .map(|h| (h, h * h))
        .collect();
    let fit = Some(PowerLaw::new(2.0, 1.0));
    ErrorSeries {
        label: "L2".into(),
        points,
        fit,
        used: Some(2..6),
        ..ErrorSeries::default()
    }
}

#[test]
fn a_fitted_line_ends_with_the_levels_that_it_uses() {
    let svg = over_h(&[partly_used()]);
    let doc = parse(&svg);
    let line = elements(&doc, "g")
        .find(|n| n.has_attribute("data-series"))
        .expect("the line comes first");
    let line = line
        .descendants()
        .find(|n| n.has_tag_name("polyline"))
        .expect("a line");
    let corners = line.attribute("points").unwrap().split_whitespace();
    let mut ends: Vec<f64> = corners
        .filter_map(|p| p.split_once(',')?.0.parse().ok())
        .collect();
    ends.sort_by(f64::total_cmp);
    let used = elements(&doc, "g")
        .find(|n| {
            n.attribute("data-points")
                .is_some_and(|points| !points.is_empty())
        })
        .unwrap();
    let mut markers: Vec<f64> = used
        .descendants()
        .filter(|n| n.has_tag_name("circle"))
        .map(|n| number(n, "cx"))
        .collect();
    markers.sort_by(f64::total_cmp);
    assert_eq!((markers.len(), ends.len()), (4, 2));
    assert!(
        (ends[0] - markers[0]).abs() < 2.0 && (ends[1] - markers[3]).abs() < 2.0,
        "{ends:?} {markers:?}"
    );
}

#[test]
fn levels_without_a_say_have_open_markers_and_a_note() {
    let note = "open markers: points that the rate does not use";
    let svg = over_h(&[partly_used()]);
    let white = elements(&parse(&svg), "circle")
        .filter(|n| n.attribute("fill") == Some("#FFFFFF"))
        .count();
    assert_eq!(white, 2);
    assert!(texts(&svg).iter().any(|text| text == note));
    let all = ErrorSeries {
        used: None,
        ..partly_used()
    };
    assert!(!texts(&over_h(&[all])).iter().any(|text| text == note));
}

/// The legend's text, and whether a line is drawn, for a rate with this interval.
fn rate_known_as(interval: Option<Interval>) -> (String, bool) {
    let svg = over_h(&[ErrorSeries {
        order: Some(2.0),
        interval,
        ..partly_used()
    }]);
    let doc = parse(&svg);
    let label = elements(&doc, "g")
        .find_map(|n| n.attribute("data-entry"))
        .expect("an entry")
        .to_owned();
    let lines = elements(&doc, "g").filter(|n| n.has_attribute("data-series"));
    let has_line = lines
        .flat_map(|n| n.descendants())
        .any(|n| n.has_tag_name("polyline"));
    (label, has_line)
}

#[test]
fn a_rate_has_the_digits_of_its_interval_and_none_with_its_line_where_that_says_nothing() {
    for (interval, label, has_line) in [
        (None, "L2, order 2, rate 2.000", true),
        (Some([1.99999, 2.00001]), "L2, order 2, rate 2.0000", true),
        (Some([1.98, 2.02]), "L2, order 2, rate 2.000", true),
        (Some([1.75, 2.25]), "L2, order 2, rate 2.00", true),
        (Some([1.74, 2.26]), "L2, order 2, no rate", false),
        (Some([-8.2, 12.2]), "L2, order 2, no rate", false),
        (Some([f64::NAN, 2.0]), "L2, order 2, no rate", false),
    ] {
        assert_eq!(
            rate_known_as(interval.map(|[low, high]| Interval { low, high })),
            (label.to_owned(), has_line),
            "{interval:?}"
        );
    }
}
