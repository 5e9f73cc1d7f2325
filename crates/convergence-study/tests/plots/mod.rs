//! Laws that every figure obeys, whatever its data.

mod fitted;
mod gallery;
mod laws;

use convergence_judge::judge::verdict::PowerLaw;
use convergence_study::internal::plots::xy::Xy;
use convergence_study::internal::plots::*;
use gallery::over_h;
use laws::{UNITS, elements, number, parse};
use roxmltree::Node;

#[test]
fn every_figure_is_in_the_gallery() {
    let (plots, gallery) = (
        include_str!("../../src/plots/mod.rs"),
        include_str!("gallery.rs"),
    );
    let exported = plots
        .lines()
        .filter(|line| line.starts_with("pub use "))
        .flat_map(|line| {
            let names = line.split(['{', '}']).nth(1).unwrap_or_default();
            names
                .split(", ")
                .filter(|name| name.starts_with(char::is_lowercase))
        });
    let figures: Vec<_> = exported.collect();
    assert!(figures.len() >= 7);
    for figure in figures {
        let is_drawn = gallery
            .match_indices(&format!("{figure}("))
            .any(|(start, _)| gallery[..start].ends_with([' ', '.']));
        assert!(is_drawn, "{figure} is not in the gallery");
        assert!(
            plots.contains(&format!("//! | [`{figure}`] | ")),
            "{figure} has no row at the head of plots/mod.rs"
        );
    }
}

#[test]
fn every_figure_is_well_formed_and_free_of_nan() {
    laws::every_figure_is_well_formed_and_free_of_nan(&gallery::gallery());
}

#[test]
fn every_text_is_large_enough_and_on_the_page() {
    laws::every_text_is_large_enough_and_on_the_page(&gallery::gallery());
}

#[test]
fn every_figure_has_a_title_that_says_more_than_its_axes() {
    laws::every_figure_has_a_title_that_says_more_than_its_axes(&gallery::gallery());
}

#[test]
fn no_two_texts_overlap() {
    laws::no_two_texts_overlap(&gallery::gallery());
}

#[test]
fn every_curve_belongs_to_an_entry_of_the_legend() {
    laws::every_curve_belongs_to_an_entry_of_the_legend(&gallery::gallery());
}

#[test]
fn every_axis_says_what_it_shows_and_that_it_has_no_unit_once_at_most() {
    laws::every_axis_says_what_it_shows_and_that_it_has_no_unit_once_at_most(&gallery::gallery());
}

#[test]
fn no_two_entries_of_a_legend_look_alike() {
    laws::no_two_entries_of_a_legend_look_alike(&gallery::gallery());
}

fn texts(svg: &str) -> Vec<String> {
    elements(&parse(svg), "text")
        .map(|n| n.text().unwrap_or("").trim().to_owned())
        .collect()
}

/// Number of points of all lines in a colour that are longer than a legend's.
fn points_of(svg: &str, colour: &str) -> usize {
    let doc = parse(svg);
    let lines = elements(&doc, "polyline").filter(|n| n.attribute("stroke") == Some(colour));
    lines
        .filter_map(|n| n.attribute("points"))
        .map(|p| p.split_whitespace().count())
        .filter(|&n| n > 2)
        .sum()
}

#[test]
fn the_same_data_give_the_same_bytes() {
    assert_eq!(gallery::gallery(), gallery::gallery());
}

#[test]
fn every_finite_point_is_drawn() {
    let points = (1..40)
        .map(|k| (f64::from(k), 1.0 / f64::from(k)))
        .collect();
    let svg = work_precision(
        "run time (s)",
        "error",
        &[Series {
            label: "s".into(),
            points,
        }],
    )
    .draw();
    // The legend has one more marker.
    assert_eq!(elements(&parse(&svg), "circle").count(), 39 + 1);
    assert_eq!(points_of(&svg, "#0072B2"), 39);
}

#[test]
fn points_that_cannot_be_drawn_are_counted() {
    let points = vec![
        (1.0, 1.0),
        (2.0, f64::NAN),
        (f64::NEG_INFINITY, 1.0),
        (3.0, -1.0),
        (4.0, f64::INFINITY),
        (5.0, 2.0),
    ];
    let series = vec![Series {
        label: "s".into(),
        points,
    }];
    let log = history(Axis::log("v"), &series).draw();
    assert!(texts(&log).contains(&"3 non-finite points not drawn".to_owned()));
    assert!(texts(&log).contains(&"1 non-positive point not drawn (logarithmic axis)".to_owned()));
    let linear = history(Axis::linear("v"), &series).draw();
    assert!(texts(&linear).iter().all(|t| !t.contains("non-positive")));
}

#[test]
fn figures_without_data_do_not_panic() {
    let empty = [
        convergence(Xy::of_errors(""), &[], &[]),
        surface(&ColouredCells::default()),
        history(Axis::default(), &[]).draw(),
        space_time(&SpaceTime::default()),
        iterations(&[]).draw(),
        work_precision("", "", &[]).draw(),
    ];
    empty.iter().for_each(|svg| drop(parse(svg)));
}

#[test]
fn figures_of_extreme_data_do_not_panic() {
    let values = [
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
    for x in values {
        for y in values {
            let points = vec![(x, y), (y, x), (x, x)];
            let series = vec![Series {
                label: "s".into(),
                points: points.clone(),
            }];
            let intervals = points.clone();
            let phases = Phases {
                label: "p".into(),
                intervals,
            };
            let guides = vec![Guide {
                label: "g".into(),
                value: y,
            }];
            for axis in [Axis::linear("y"), Axis::log("y")] {
                let (guides, phases) = (guides.clone(), phases.clone());
                parse(
                    &Xy {
                        guides,
                        phases,
                        ..history(axis, &series)
                    }
                    .draw(),
                );
            }
            let fit = Some(PowerLaw::new(x, y));
            let norm = ErrorSeries {
                points: points.clone(),
                order: Some(x),
                fit,
                ..Default::default()
            };
            parse(&convergence(Xy::of_errors(""), &[norm], &[x, 1.0]));
            let (x_values, y_values, values) =
                (vec![x, y, 1.0], vec![x, y], vec![vec![x, y, 2.0], vec![y]]);
            let cells = ColouredCells {
                x_values,
                y_values,
                values,
                z: Axis::log("z"),
                ..Default::default()
            };
            parse(&surface(&cells));
            parse(&surface(&ColouredCells {
                marked: vec![vec![true]],
                boundaries: series,
                ..cells
            }));
            let frames = vec![vec![x, y], vec![y, 1.0]];
            let (times, nodes) = (vec![x, y], vec![y, x]);
            parse(&space_time(&SpaceTime {
                times,
                nodes,
                frames,
                ..Default::default()
            }));
        }
    }
}

#[test]
fn constant_data_have_an_axis_with_ticks() {
    let series = vec![Series {
        label: "s".into(),
        points: vec![(0.0, 3.0), (1.0, 3.0)],
    }];
    let svg = history(Axis::linear("v"), &series).draw();
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
    let mut figure = gallery::long_history(200_000);
    figure.guides.clear();
    figure.curves.truncate(1);
    figure.curves[0].points[123_456].1 = 5.0;
    let svg = figure.draw();
    let doc = parse(&svg);
    let coordinates =
        elements(&doc, "polyline").filter(|n| n.attribute("stroke") == Some("#0072B2"));
    let heights = coordinates.flat_map(|n| n.attribute("points").unwrap_or("").split_whitespace());
    let highest = heights
        .filter_map(|p| p.split_once(',')?.1.parse::<f64>().ok())
        .fold(f64::INFINITY, f64::min);
    // The top of the plot is 48 px down the page, and 1/22 of the plot's 430 px stays free above
    // the data.
    assert!(highest < UNITS * (48.0 + 430.0 / 20.0), "{highest}");
}

#[test]
fn figures_stay_small() {
    let noise = |k: usize| (k.wrapping_mul(2_654_435_761) % 1_000_003) as f64 / 1_000_003.0 - 0.5;
    let line = |s: usize| Series {
        label: format!("series {s}"),
        points: (0..100_000)
            .map(|k| (k as f64, noise(k + 31 * s)))
            .collect(),
    };
    let intervals = (0..50_000)
        .map(|k| (2.0 * f64::from(k), 2.0 * f64::from(k) + 1.0))
        .collect();
    let phases = Phases {
        label: "at a stop".into(),
        intervals,
    };
    let long = Xy {
        phases,
        ..history(Axis::linear("v"), &(0..8).map(line).collect::<Vec<_>>())
    };
    assert!(long.draw().len() < 200_000);

    let mut picture = gallery::wave(600, 400);
    picture
        .frames
        .iter_mut()
        .flatten()
        .enumerate()
        .for_each(|(k, u)| *u = noise(k * k));
    let noisy = space_time(&picture);
    assert!(noisy.len() < 400_000, "{}", noisy.len());
}

#[test]
fn labels_are_all_there() {
    let words = texts(&gallery::long_history(1000).draw());
    for label in [
        "g₁ = −0.01",
        "g₂ = 0.1",
        "at a stop",
        "euler-crank-nicolson",
        "midpoint",
        "time t",
    ] {
        assert!(words.iter().any(|w| w == label), "{label}");
    }
    let words = texts(&over_h(&gallery::space_errors()));
    for label in [
        "energy norm, order 1, rate 1.002",
        "mesh width h",
        "10⁻³",
        "1",
        "2",
    ] {
        assert!(words.iter().any(|w| w == label), "{label}");
    }
    assert!(texts(&surface(&gallery::stability_map())).contains(&"diverged".to_owned()));
}

#[test]
fn series_differ_without_colour() {
    let figure = gallery::long_history(1000);
    let svg = figure.draw();
    let doc = parse(&svg);
    let dashes = |colour: &'static str| {
        let of_colour =
            elements(&doc, "polyline").filter(move |n| n.attribute("stroke") == Some(colour));
        of_colour
            .filter_map(|n| n.parent()?.attribute("stroke-dasharray"))
            .count()
    };
    assert_eq!(dashes("#0072B2"), 0);
    assert!(dashes("#D55E00") >= 2);
}

#[test]
fn a_missing_cell_is_noted_unless_it_is_marked() {
    let mut map = gallery::stability_map();
    assert!(
        !texts(&surface(&map))
            .iter()
            .any(|t| t.contains("not drawn"))
    );
    map.marked.clear();
    assert!(
        texts(&surface(&map))
            .iter()
            .any(|t| t.contains("non-finite points not drawn"))
    );
}

#[test]
fn markers_lie_where_the_values_in_the_picture_say() {
    let svg = over_h(&gallery::space_errors());
    let doc = parse(&svg);
    let root = doc.root_element();
    let words = |name: &str| {
        root.attribute(name)
            .unwrap()
            .split(' ')
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let plot: Vec<f64> = words("data-plot")
        .iter()
        .map(|v| v.parse().unwrap())
        .collect();
    let place = |axis: &str, value: f64, from: f64, to: f64| {
        let words = words(axis);
        assert_eq!(words[0], "log");
        let ends: Vec<f64> = words[1..].iter().map(|v| v.parse().unwrap()).collect();
        from + (value.log10() - ends[0]) / (ends[1] - ends[0]) * (to - from)
    };
    let is_velocity = |n: &Node<'_, '_>| {
        n.attribute("data-series")
            .is_some_and(|name| name.starts_with("velocity"))
    };
    let group = elements(&doc, "g")
        .find(|n| is_velocity(n) && n.has_attribute("data-points"))
        .unwrap();
    let markers: Vec<_> = group
        .descendants()
        .filter(|n| n.has_tag_name("circle"))
        .collect();
    let points: Vec<&str> = group.attribute("data-points").unwrap().split(' ').collect();
    // Of ten levels the rate uses seven; the others form a separate group.
    assert_eq!((markers.len(), points.len()), (7, 7));
    for (marker, point) in markers.iter().zip(points) {
        let (x, y) = point.split_once(',').unwrap();
        let at = (
            place("data-x", x.parse().unwrap(), plot[0], plot[2]),
            place("data-y", y.parse().unwrap(), plot[3], plot[1]),
        );
        assert!(
            (at.0 - number(*marker, "cx")).abs() < 2.0
                && (at.1 - number(*marker, "cy")).abs() < 2.0,
            "{point}"
        );
    }
}

#[test]
fn a_series_keeps_its_look_in_every_figure() {
    let mut norm = gallery::time_errors().remove(0);
    norm.look = Some(3);
    let alone = over_h(&[norm.clone()]);
    let last = over_h(&[gallery::time_errors(), vec![norm]].concat());
    let is_purple = |svg: &str| points_of(svg, "#AA4499") > 0;
    assert!(is_purple(&alone) && is_purple(&last) && !is_purple(&over_h(&gallery::time_errors())));
}

#[test]
fn the_series_of_a_history_have_the_looks_that_they_are_given() {
    let series = vec![Series {
        label: "s".into(),
        points: vec![(0.0, 1.0), (1.0, 2.0)],
    }];
    let drawn = |looks: &[usize]| history(Axis::default(), &series).with_looks(looks).draw();
    let is_purple = |svg: &str| svg.contains("#AA4499");
    assert!(is_purple(&drawn(&[3])) && !is_purple(&drawn(&[])));
}

#[test]
fn the_first_64_looks_differ() {
    let looks: Vec<_> = (0..64)
        .map(look::look)
        .map(|look| (look.colour, look.marker))
        .collect();
    for (k, one) in looks.iter().enumerate() {
        assert!(!looks[..k].contains(one), "{k}");
    }
}

#[test]
fn ticks_of_counts_are_whole() {
    let series = vec![Series {
        label: "solver".into(),
        points: vec![(0.1, 3.0), (0.2, 3.0)],
    }];
    let svg = iterations(&series).draw();
    let is_height = |n: &Node<'_, '_>| n.attribute("text-anchor") == Some("end");
    let doc = parse(&svg);
    let heights: Vec<_> = elements(&doc, "text")
        .filter(is_height)
        .filter_map(|n| n.text())
        .collect();
    assert!(
        heights.len() >= 4
            && heights
                .iter()
                .all(|text| text.trim().parse::<u32>().is_ok()),
        "{heights:?}"
    );
}
