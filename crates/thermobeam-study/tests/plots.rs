//! Figures of beams: the laws of all figures, and their own.

mod figures;
#[path = "../../convergence-study/tests/plots/laws.rs"]
mod laws;

use convergence_study::plots::Series;
use laws::{elements, parse};
use thermobeam_study::figures::*;

#[test]
fn every_figure_is_well_formed_and_free_of_nan() {
    laws::every_figure_is_well_formed_and_free_of_nan(&figures::gallery());
}

#[test]
fn every_text_is_large_enough_and_on_the_page() {
    laws::every_text_is_large_enough_and_on_the_page(&figures::gallery());
}

#[test]
fn no_two_texts_overlap() {
    laws::no_two_texts_overlap(&figures::gallery());
}

#[test]
fn every_curve_belongs_to_an_entry_of_the_legend() {
    laws::every_curve_belongs_to_an_entry_of_the_legend(&figures::gallery());
}

#[test]
fn the_same_data_give_the_same_bytes() {
    assert_eq!(figures::gallery(), figures::gallery());
}

#[test]
fn every_figure_is_in_the_gallery() {
    let (module, gallery) = (include_str!("../src/figures/mod.rs"), include_str!("figures/mod.rs"));
    // The pictures of a run are made of figures that have their place in a gallery.
    let exported = module.lines().filter_map(|line| line.strip_prefix("pub use ")?.split("::").next());
    let exported = exported.filter(|name| *name != "scene");
    let figures: Vec<_> = exported.collect();
    assert!(figures.len() >= 3);
    for figure in figures {
        assert!(gallery.contains(&format!(", {figure}(")), "{figure} is not in the gallery");
    }
}

#[test]
fn a_long_animation_stays_small() {
    let mut moving = figures::motion();
    let shape = moving.frames.clone();
    moving.times = (0..2000).map(f64::from).collect();
    moving.frames = (0..2000).map(|k| shape[k % shape.len()].clone()).collect();
    assert!(animation(&moving).len() < 300_000);
}

#[test]
fn contraction_factors_of_one_and_more_are_labelled() {
    let svg = contraction(&figures::contraction_factors());
    assert!(elements(&parse(&svg), "text").any(|n| n.text().is_some_and(|text| text.trim() == "diverges (α ≥ 1)")));
}

#[test]
fn nothing_to_draw_is_no_reason_to_panic() {
    let empty =
        [contraction(&Contraction::default()), bifurcation(&Bifurcation::default()), animation(&Animation::default())];
    empty.iter().for_each(|svg| drop(parse(svg)));
}

#[test]
fn extreme_data_are_no_reason_to_panic() {
    let values = [0.0, -0.0, 1.0, -1.0, 1e-320, 1e308, -1e308, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for x in values {
        for y in values {
            let points = vec![(x, y), (y, x), (x, x)];
            let series = vec![Series { label: "s".into(), points: points.clone() }];
            parse(&contraction(&Contraction { series, title: None }));
            let branches = vec![Branch { label: "b".into(), points, stable: true }];
            parse(&bifurcation(&Bifurcation { branches, ..Default::default() }));
            let frames = vec![vec![x, y], vec![y, 1.0]];
            let (times, nodes) = (vec![x, y], vec![y, x]);
            parse(&animation(&Animation { times, nodes, frames, obstacles: Some((x, y)), seconds: x, title: None }));
        }
    }
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
