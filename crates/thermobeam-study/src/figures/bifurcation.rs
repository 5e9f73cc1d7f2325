//! Equilibria over a parameter.

use convergence_study::plots::look::{Look, Marker, Marks, look};
use convergence_study::plots::style::{self, Dash};
use convergence_study::plots::xy::{Curve, Xy};
use convergence_study::plots::{Axis, Guide, Series};
use convergence_study::text::lists::distinct;

/// A family of equilibria, all stable or all unstable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Branch {
    /// Contact state; branches with the same label share a colour and a legend entry.
    pub label: String,
    /// `(parameter, tip displacement)`, along the branch.
    pub points: Vec<(f64, f64)>,
    /// Stable branches are solid, unstable ones dashed.
    pub stable: bool,
}

/// Draws tip displacements of equilibria over β; open markers show those in which simulations ended.
pub fn bifurcation(branches: &[Branch], obstacles: Vec<Guide>, ends: &Series) -> String {
    let labels = distinct(branches.iter().map(|branch| branch.label.as_str()));
    let family = |b: &Branch| labels.iter().position(|l| *l == b.label).unwrap_or(0);
    let mut curves: Vec<Curve> = branches.iter().map(|b| curve(b, look(family(b)))).collect();
    let ends_look = Look { colour: style::INK, ..look(labels.len()) };
    curves.push(Curve { look: ends_look, width: 0.0, marks: Marks::Open, ..Curve::line(0, ends) });
    let parameters = || curves.iter().flat_map(|c| &c.points).map(|p| p.0).filter(|x| x.is_finite());
    let (low, high) = (parameters().fold(f64::INFINITY, f64::min), parameters().fold(f64::NEG_INFINITY, f64::max));
    // Branches end at the limits of the parameter, so these must not coincide with the frame.
    let room = 0.03 * (high - low);
    Xy {
        show_x: vec![low - room, high + room],
        x: Axis::linear("axial force at rest β"),
        y: Axis::linear("tip displacement u(1) (dimensionless)"),
        curves,
        guides: obstacles,
        ..Xy::default()
    }
    .draw()
}

fn curve(branch: &Branch, look: Look) -> Curve {
    // A single point would be invisible as a line.
    let marks = match (branch.points.len(), branch.stable) {
        (2.., _) => Marks::None,
        (_, true) => Marks::Filled,
        (_, false) => Marks::Open,
    };
    // The colour shows the contact state, dashes show instability.
    let (dash, stability) = if branch.stable { (Dash::Solid, "stable") } else { (Dash::Short, "unstable") };
    let series = Series { label: format!("{}, {stability}", branch.label), points: branch.points.clone() };
    Curve { look: Look { dash, marker: Marker::Circle, ..look }, width: 2.6, marks, ..Curve::line(0, &series) }
}
