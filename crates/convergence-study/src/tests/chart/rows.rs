//! Figures are drawn from the rows that the report lists, and their titles say what the verdicts
//! do.

use crate::study::over_levels::{ErrorColumn, Levels};
use crate::{Claim, Grid, GridColumn, Outcome, RefinedIn, Refinement, SpaceTime, Verdict};

use super::back::{place, series};
use super::laws::parse;
use super::shows;
use roxmltree::Node;

/// The largest distance between marks and points, each to the nearest of the others, in px.
pub(crate) fn misfit(picture: Node<'_, '_>, marks: &[[f64; 2]], points: &[[f64; 2]]) -> f64 {
    let points: Vec<[f64; 2]> = points
        .iter()
        .map(|at| [0, 1].map(|axis| place(picture, axis, at[axis])))
        .collect();
    let nearest = |at: &[f64; 2], others: &[[f64; 2]]| {
        let distances = others
            .iter()
            .map(|to| (at[0] - to[0]).abs().max((at[1] - to[1]).abs()));
        distances.fold(f64::INFINITY, f64::min)
    };
    let of_marks = marks.iter().map(|mark| nearest(mark, &points));
    let of_points = points.iter().map(|point| nearest(point, marks));
    of_marks.chain(of_points).fold(0.0, f64::max) / 10.0
}

/// Errors of three norms over seven meshes.
///
/// * `off`: the third norm falls with this order, and claims 2.
fn outcome(off: f64) -> Outcome {
    let meshes = (2..9).map(|k| 2usize.pow(k));
    let levels = meshes.map(|n| Refinement::new(format!("n = {n}"), &[("n", n)], 1.0 / n as f64));
    let levels: Vec<Refinement> = levels.collect();
    let column = |name: &str, claimed: f64, constant: f64, order: f64| {
        let errors = levels
            .iter()
            .map(|level| Some(constant * level.step.powf(order)));
        ErrorColumn::new(name, Claim::new(claimed, 0.1), errors)
    };
    let columns = [
        column("L2", 2.0, 1.0, 2.0),
        column("H1", 1.0, 3.0, 1.0),
        column("max", 2.0, 7.0, off),
    ];
    Levels::new(RefinedIn::Space, levels.clone(), columns).outcome(
        "errors",
        None,
        "Errors.",
        vec![],
    )
}

#[test]
fn every_line_shows_the_rows_of_the_error_that_it_names() {
    let outcome = outcome(2.0);
    let svg = outcome.figures[0].svg();
    let doc = parse(svg);
    let drawn = series(doc.root_element());
    assert_eq!(drawn.len(), 3);
    for line in drawn {
        let name = line.label.split(", ").next().expect("a name");
        assert_eq!(line.columns[1], name);
        let rows = outcome.levels_of(name);
        let rows: Vec<[f64; 2]> = rows.iter().map(|row| [row.step, row.error]).collect();
        let worst = misfit(doc.root_element(), &line.marks, &rows);
        assert!(worst < 1.0, "{name} is drawn {worst} px from its rows");
        let other = outcome.levels_of(if name == "L2" { "H1" } else { "L2" });
        let other: Vec<[f64; 2]> = other.iter().map(|row| [row.step, row.error]).collect();
        assert!(misfit(doc.root_element(), &line.marks, &other) > 10.0);
    }
}

#[test]
fn a_title_says_what_the_verdicts_say() {
    for (off, verdict, title) in [
        (2.0, Verdict::Pass, "Errors fall with h as the triangles do"),
        (1.0, Verdict::Fail, "The order in h fails for 1 of 3 errors"),
    ] {
        let outcome = outcome(off);
        assert_eq!(outcome.verdict, verdict);
        assert!(shows(outcome.figures[0].svg(), title), "{title}");
    }
}

/// A grid whose errors fall with dt as claimed, and with h as claimed or not.
fn grid(order: f64) -> Grid {
    let steps = [0.4_f64, 0.2, 0.1, 0.05, 0.025];
    let points = steps
        .into_iter()
        .flat_map(|space| steps.map(|time| SpaceTime { space, time }));
    let points: Vec<_> = points.collect();
    let errors = points
        .iter()
        .map(|point| point.space.powf(order) + 0.5 * point.time);
    Grid {
        columns: vec![GridColumn {
            name: "L2".to_owned(),
            space: Claim::new(2.0, 0.2),
            time: Claim::new(1.0, 0.2),
            errors: errors.collect(),
        }],
        points,
        times: steps.len(),
        squares_add: false,
    }
}

#[test]
fn lines_of_a_grid_show_the_points_of_their_time_step() {
    let grid = grid(2.0);
    let rates = grid.judge().rates;
    let figure = grid
        .figures(&rates, |name| format!("error, {name}"))
        .remove(0);
    let doc = parse(figure.svg());
    let drawn = series(doc.root_element());
    assert_eq!(drawn.len(), 5);
    for line in drawn {
        let dt: f64 = line
            .label
            .trim_start_matches("dt = ")
            .parse()
            .expect("a step");
        let rows = grid.points.iter().zip(&grid.columns[0].errors);
        let rows = rows.filter(|(point, _)| point.time == dt);
        let rows: Vec<[f64; 2]> = rows.map(|(point, error)| [point.space, *error]).collect();
        let worst = misfit(doc.root_element(), &line.marks, &rows);
        assert!(worst < 1.0, "{}: {worst} px", line.label);
    }
}

/// Some file systems ignore case, and a name of a file has plain letters only.
#[test]
fn figures_of_a_grid_have_names_of_their_own_whatever_its_errors_are_called() {
    for (names, files) in [
        (["L2", "H1", "u max"], ["L2", "H1", "u-max"]),
        (["u", "U", "u-1"], ["u-1", "U-2", "u-1-3"]),
        (["φ", "θ", "p"], ["--1", "--2", "p-3"]),
    ] {
        let mut grid = grid(2.0);
        let column = grid.columns.remove(0);
        grid.columns.extend(names.map(|name| GridColumn {
            name: name.to_owned(),
            ..column.clone()
        }));
        let figures = grid.figures(&[], str::to_owned).into_iter();
        let found: Vec<String> = figures.map(|figure| figure.file).collect();
        assert_eq!(found, files.map(|name| format!("over-h-{name}.svg")));
    }
}

#[test]
fn a_grid_that_fails_is_not_titled_as_one_that_passes() {
    let seen = "Errors fall with h until the error of dt is left";
    let is_said = |order: f64| {
        let grid = grid(order);
        let outcome = grid.judge();
        let figure = grid.figures(&outcome.rates, str::to_owned).remove(0);
        (outcome.verdict.is_pass(), shows(figure.svg(), seen))
    };
    assert_eq!([is_said(2.0), is_said(1.0)], [(true, true), (false, false)]);
}
