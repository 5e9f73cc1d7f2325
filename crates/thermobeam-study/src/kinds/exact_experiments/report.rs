//! The numbers as a table to be cited, and the error of the scenes' own schemes.

use convergence_study::plots::{self, Axis, History, Series};
use convergence_study::study::{Figure, Table};
use convergence_study::text::number::max_or_nan;

use super::judge::{OfScene, difference, numbers};
use super::{ExactExperiments, Shown};
use crate::figures::looks;
use crate::kinds::tables::Discretisation;
use crate::run::object::phase_name;

pub(super) fn headline(study: &ExactExperiments, scenes: &[OfScene<'_>], worst: f64) -> String {
    let agreement = format!("two discretisations agree within {worst:.1e}");
    if !study.compare {
        return agreement;
    }
    let largest = scenes.iter().map(own_error).fold(0.0, max_or_nan);
    format!("{agreement}; the scenes' own schemes at their resolution are off by up to {largest:.1e} in u(1, t)")
}

pub(super) fn tables(study: &ExactExperiments, scenes: &[OfScene<'_>]) -> Vec<Table> {
    let mut tables = vec![values(scenes), events(scenes)];
    if study.compare {
        tables.push(errors(scenes));
    }
    let how = |(k, how): (usize, &Discretisation)| {
        let steps = |scene: &OfScene<'_>| scene.any_order[k].map_or("-".to_owned(), |shown| shown.steps.to_string());
        let steps: Vec<String> = scenes.iter().map(steps).collect();
        vec![
            how.elements.to_string(),
            how.degree.to_string(),
            how.stepping.degree.to_string(),
            format!("{:?}", how.stepping.dt),
            format!("{:?}", how.stepping.restart_dt),
            format!("{:?}", how.stepping.growth),
            steps.join(", "),
        ]
    };
    tables.push(table(
        "The two discretisations",
        &["elements", "degree p", "degree q", "largest step", "first step", "growth", "steps of each scene"],
        study.discretisations.iter().enumerate().map(how).collect(),
    ));
    tables
}

fn table(title: &str, head: &[&str], rows: Vec<Vec<String>>) -> Table {
    Table { title: title.to_owned(), head: head.iter().map(|&name| name.to_owned()).collect(), rows }
}

/// Digits that both discretisations agree on, and one more.
fn digits(value: f64, apart: f64) -> String {
    let decimals = if apart > 0.0 { (-apart.log10()).floor().clamp(0.0, 14.0) as usize } else { 14 };
    format!("{value:.decimals$}")
}

fn values(scenes: &[OfScene<'_>]) -> Table {
    let mut rows = vec![];
    for scene in scenes {
        let apart = difference(scene);
        for state in scene.any_order[0].iter().flat_map(|shown| &shown.states) {
            let mut row = vec![scene.name.to_owned(), format!("{}", state.t)];
            row.extend(numbers(state).iter().map(|(_, value)| digits(*value, apart)));
            row.push(format!("{apart:.0e}"));
            rows.push(row);
        }
    }
    let head = ["scene", "t", "u(1)", "φ(1)", "u_t(1)", "φ_t(1)", "θ(1/2)", "E", "largest difference"];
    table("The free end and the energy, to the digits on which two discretisations agree", &head, rows)
}

fn events(scenes: &[OfScene<'_>]) -> Table {
    let mut rows = vec![];
    for scene in scenes {
        for event in scene.any_order[0].iter().flat_map(|shown| &shown.events) {
            let [from, to] = [event.from, event.to].map(phase_name);
            rows.push(vec![scene.name.to_owned(), format!("{:.10}", event.t), format!("{from} to {to}")]);
        }
    }
    table("Contact events", &["scene", "t", "free end"], rows)
}

/// `(t, error)` of u(1, t) by the scene's own scheme.
fn error_over_time(scene: &OfScene<'_>) -> Vec<(f64, f64)> {
    let (Some(own), Some(exact)) = (scene.own, scene.any_order[0]) else { return vec![] };
    // The history of the exact run begins at t = 0. The reader has made sure that both have the same times.
    own.tip.iter().zip(&exact.tip).skip(1).map(|((t, u), (_, exact))| (*t, (u - exact).abs())).collect()
}

fn own_error(scene: &OfScene<'_>) -> f64 {
    let errors = error_over_time(scene);
    if errors.is_empty() { f64::NAN } else { errors.iter().map(|(_, error)| *error).fold(0.0, max_or_nan) }
}

fn errors(scenes: &[OfScene<'_>]) -> Table {
    let mut rows = vec![];
    for scene in scenes {
        let (Some(own), Some(exact)) = (scene.own, scene.any_order[0]) else { continue };
        for (a, b) in own.states.iter().zip(&exact.states) {
            let mut row = vec![scene.name.to_owned(), format!("{}", b.t)];
            let (a, b) = (numbers(a), numbers(b));
            row.extend((0..a.len()).map(|i| format!("{:.2e}", a[i].1 - b[i].1)));
            row.push(format!("{:.2e}", own_error(scene)));
            rows.push(row);
        }
    }
    let head = ["scene", "t", "u(1)", "φ(1)", "u_t(1)", "φ_t(1)", "θ(1/2)", "E", "largest |error| of u(1, t)"];
    table("Errors of the scenes' own scheme at their own resolution", &head, rows)
}

pub(super) fn figures(study: &ExactExperiments, scenes: &[OfScene<'_>]) -> Vec<Figure> {
    let id = &study.header.id;
    let tip = |shown: &Shown| shown.tip.clone();
    let series = |points: &dyn Fn(&OfScene<'_>) -> Vec<(f64, f64)>| -> Vec<Series> {
        scenes.iter().map(|scene| Series { label: scene.name.to_owned(), points: points(scene) }).collect()
    };
    let looks = || looks(scenes.iter().map(|scene| scene.name));
    let mut figures = vec![Figure {
        file: format!("{id}-tip.svg"),
        caption: "The free end of every experiment, to ten digits.".into(),
        svg: plots::history(&History {
            title: Some("Displacement of the free end".into()),
            y: Axis::linear("displacement u(1, t) (dimensionless)"),
            series: series(&|scene| scene.any_order[0].map(tip).unwrap_or_default()),
            looks: looks(),
            ..History::default()
        }),
    }];
    if study.compare {
        figures.push(Figure {
            file: format!("{id}-error.svg"),
            caption:
                "Error of the scenes' own schemes at their own resolution over time, in the displacement of the free end."
                    .into(),
            svg: plots::history(&History {
                title: Some("Error of the scenes' own scheme at their own resolution".into()),
                y: Axis::log("error of u(1, t) (dimensionless)"),
                series: series(&error_over_time),
                looks: looks(),
                ..History::default()
            }),
        });
    }
    figures
}
