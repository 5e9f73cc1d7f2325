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

/// Draws tip displacements of equilibria over β, and those in which simulations ended as open markers.
pub fn bifurcation(branches: &[Branch], obstacles: Vec<Guide>, ends: &Series) -> String {
    let mut labels: Vec<&str> = Vec::new();
    for branch in branches {
        if !labels.contains(&branch.label.as_str()) {
            labels.push(&branch.label);
        }
    }
    let family = |b: &Branch| labels.iter().position(|l| *l == b.label).unwrap_or(0);
    let mut curves: Vec<Curve> = branches.iter().map(|b| curve(b, look(family(b)))).collect();
    let ends_look = Look { colour: style::INK, ..look(labels.len()) };
    curves.push(Curve { look: ends_look, width: 0.0, marks: Marks::Open, ..Curve::line(0, ends) });
    let parameters = || curves.iter().flat_map(|c| &c.points).map(|p| p.0).filter(|x| x.is_finite());
    let (low, high) = (parameters().fold(f64::INFINITY, f64::min), parameters().fold(f64::NEG_INFINITY, f64::max));
    // Branches end at the ends of the parameter's range: they must not lie on the frame.
    let room = 0.03 * (high - low);
    Xy {
        show_x: vec![low - room, high + room],
        x: Axis::linear("axial force at rest β"),
        y: Axis::linear("tip displacement u(1) (dimensionless)"),
        curves,
        guides: obstacles,
        legend: entries(&labels, branches),
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
