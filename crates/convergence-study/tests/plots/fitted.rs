//! Lines of fitted rates: where they end, their markers, their digits.

use convergence_judge::judge::verdict::PowerLaw;
use convergence_study::Interval;
use convergence_study::internal::plots::*;

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

/// The radii of all discs, ascending.
fn radii(svg: &str) -> Vec<f64> {
    let mut radii: Vec<f64> = elements(&parse(svg), "circle")
        .map(|n| number(n, "r"))
        .collect();
    radii.sort_by(f64::total_cmp);
    radii
}

/// Where the errors of two norms agree, the markers of both are seen.
#[test]
fn markers_under_those_of_another_series_are_larger() {
    let one = ErrorSeries {
        used: None,
        ..partly_used()
    };
    let other = |factor: f64| ErrorSeries {
        label: "H1".to_owned(),
        points: one.points.iter().map(|(h, e)| (*h, factor * e)).collect(),
        ..one.clone()
    };
    let largest = |factor: f64| radii(&over_h(&[one.clone(), other(factor)])).pop();
    let [apart, together] = [100.0, 1.001].map(|factor| largest(factor).expect("a disc"));
    assert!(together > 1.4 * apart, "{together} {apart}");
}

/// Strokes have no inside: a level without a say is encircled.
#[test]
fn strokes_of_levels_without_a_say_stand_in_a_circle() {
    let series = |used| ErrorSeries {
        look: Some(5),
        used,
        ..partly_used()
    };
    assert_eq!(radii(&over_h(&[series(None)])), Vec::<f64>::new());
    assert_eq!(radii(&over_h(&[series(partly_used().used)])).len(), 4);
}

/// A line over nearly a decade without points would show what nobody measured.
#[test]
fn no_line_crosses_a_gap() {
    let lines = |steps: [f64; 4]| {
        let series = ErrorSeries {
            points: steps.map(|h| (h, h * h)).to_vec(),
            ..ErrorSeries::default()
        };
        let doc = over_h(&[series]);
        let doc = parse(&doc);
        elements(&doc, "g")
            .filter(|n| n.has_attribute("data-series"))
            .flat_map(|n| n.descendants())
            .filter(|n| n.has_tag_name("polyline"))
            .map(|n| n.attribute("points").unwrap_or_default().split(' ').count())
            .collect::<Vec<_>>()
    };
    assert_eq!(lines([0.1, 0.05, 0.025, 0.0125]), [4]);
    assert_eq!(lines([0.1, 0.05, 0.025, 0.001]), [3]);
}
