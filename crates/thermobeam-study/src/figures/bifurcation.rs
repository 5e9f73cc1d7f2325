//! Equilibria over a parameter.

use convergence_study::plots::legend::{Entry, Swatch};
use convergence_study::plots::look::{Look, look};
use convergence_study::plots::marker::{Marker, Marks};
use convergence_study::plots::style::{self, Dash};
use convergence_study::plots::xy::{Curve, Xy};
use convergence_study::plots::{Axis, Guide, Series};

/// A family of equilibria, all stable or all unstable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Branch {
    /// Contact state; branches of the same label share a colour and an entry in the legend.
    pub label: String,
    /// `(parameter, tip displacement)`, along the branch.
    pub points: Vec<(f64, f64)>,
    /// Stable branches are solid, unstable ones dashed.
    pub stable: bool,
}

/// A bifurcation diagram.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bifurcation {
    /// Above the plot.
    pub title: Option<String>,
    /// The parameter.
    pub x_label: String,
    /// The displacement.
    pub y_label: String,
    /// The equilibria.
    pub branches: Vec<Branch>,
    /// Where the obstacles are.
    pub obstacles: Vec<Guide>,
    /// `(parameter, tip displacement)` in which simulations ended, drawn as open markers.
    pub states: Vec<Series>,
}

/// Draws tip displacements of equilibria over a parameter.
pub fn bifurcation(figure: &Bifurcation) -> String {
    let mut labels: Vec<&str> = Vec::new();
    for branch in &figure.branches {
        if !labels.contains(&branch.label.as_str()) {
            labels.push(&branch.label);
        }
    }
    let family = |b: &Branch| labels.iter().position(|l| *l == b.label).unwrap_or(0);
    let mut curves: Vec<Curve> = figure.branches.iter().map(|b| curve(b, look(family(b)))).collect();
    let states = figure.states.iter().enumerate();
    curves.extend(states.map(|(k, s)| end_states(s, look(labels.len() + k))));
    let parameters = || curves.iter().flat_map(|c| &c.points).map(|p| p.0).filter(|x| x.is_finite());
    let (low, high) = (parameters().fold(f64::INFINITY, f64::min), parameters().fold(f64::NEG_INFINITY, f64::max));
    // Branches end at the ends of the parameter's range: they must not lie on the frame.
    let room = 0.03 * (high - low);
    Xy {
        title: figure.title.clone(),
        show_x: vec![low - room, high + room],
        x: Axis::linear(&*figure.x_label),
        y: Axis::linear(&*figure.y_label),
        curves,
        guides: figure.obstacles.clone(),
        legend: entries(&labels, &figure.branches),
        ..Xy::default()
    }
    .draw()
}

fn curve(branch: &Branch, look: Look) -> Curve {
    // A branch known at one point only would leave no trace as a line.
    let marks = match (branch.points.len(), branch.stable) {
        (2.., _) => Marks::None,
        (_, true) => Marks::Filled,
        (_, false) => Marks::Open,
    };
    let dash = dash(branch.stable);
    let look = Look { dash, marker: Marker::Circle, ..look };
    Curve {
        name: entry_label(&branch.label, branch.stable),
        noted_as: None,
        is_listed: false,
        points: branch.points.clone(),
        look,
        width: 2.6,
        marks,
        is_data: true,
    }
}

fn dash(stable: bool) -> Dash {
    if stable { Dash::Solid } else { Dash::Short }
}

fn end_states(series: &Series, look: Look) -> Curve {
    let look = Look { colour: style::INK, ..look };
    Curve { look, width: 0.0, marks: Marks::Open, ..Curve::line(0, series) }
}

fn entry_label(label: &str, stable: bool) -> String {
    format!("{label}, {}", if stable { "stable" } else { "unstable" })
}

/// Colour says which contact state, dashes say whether it is stable.
fn entries(labels: &[&str], branches: &[Branch]) -> Vec<Entry> {
    let line =
        |look: Look, label: String| Entry { swatch: Swatch::Line { look, width: 2.6, marks: Marks::None }, label };
    let mut entries = Vec::new();
    for (k, label) in labels.iter().enumerate() {
        for stable in [true, false] {
            if branches.iter().any(|b| b.label == *label && b.stable == stable) {
                let look = Look { dash: dash(stable), ..look(k) };
                entries.push(line(look, entry_label(label, stable)));
            }
        }
    }
    entries
}
