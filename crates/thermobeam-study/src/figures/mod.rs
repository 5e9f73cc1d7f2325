//! Figures of beams, drawn with the harness's canvas: plain data in, a self-contained SVG document
//! out.

mod pictures;

use convergence_judge::text::lists::distinct;
use convergence_study::internal::plots::{
    Axis, Guide, Series,
    look::{Look, Marker, Marks, look},
    style,
    xy::{Curve, Xy},
};
use thermobeam::parameters::{Beam, Obstacles};

/// The experiments of the paper, in the order of its Section 5.
const PAPER: [&str; 7] = [
    "paper-1-beta-minus-0.5",
    "paper-1-beta-0",
    "paper-1-beta-5",
    "paper-2-beta-minus-0.5",
    "paper-2-beta-0",
    "paper-2-beta-5",
    "paper-3-beta-minus-0.8",
];

/// A line for each obstacle.
pub(crate) fn obstacle_lines(obstacles: Option<Obstacles>) -> Vec<Guide> {
    let Some(Obstacles { g1, g2, .. }) = obstacles else {
        return vec![];
    };
    vec![
        Guide {
            label: "g₁".to_owned(),
            value: g1,
        },
        Guide {
            label: "g₂".to_owned(),
            value: g2,
        },
    ]
}

/// The [`look`](convergence_study::internal::plots::look::look) of each scene of a figure: an
/// experiment of the paper has its own; any other scene gets, by its place in the figure, one that
/// no experiment has.
pub(crate) fn looks<'n>(scenes: impl IntoIterator<Item = &'n str>) -> Vec<usize> {
    let mut looks = vec![];
    for (place, name) in scenes.into_iter().enumerate() {
        let paper = PAPER.iter().position(|known| *known == name);
        looks.push(paper.unwrap_or(PAPER.len() + place));
    }
    looks
}

/// The values of β in the paper's experiments.
const BETAS: [f64; 4] = [-0.5, 0.0, 5.0, -0.8];

/// The [`look`](convergence_study::internal::plots::look::look) of a value of β, the same in all
/// figures whose curves are its values; of other values the next one.
pub(crate) fn look_of_beta(beta: f64) -> usize {
    BETAS
        .iter()
        .position(|known| *known == beta)
        .unwrap_or(BETAS.len())
}

/// The name of a beam by its axial force at rest.
pub(crate) fn beta_label(beam: &Beam) -> String {
    // A minus sign, not a hyphen.
    format!("β = {}", beam.beta).replace('-', "−")
}

/// Energy β²/(4ρ) of the straight beam at rest; `None` without a Kirchhoff term.
pub fn energy_at_rest(beam: &Beam) -> Option<f64> {
    (beam.rho > 0.0).then(|| beam.beta * beam.beta / (4.0 * beam.rho))
}

/// A family of equilibria, all stable or all unstable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EquilibriumBranch {
    /// Contact state; branches with the same label share a colour and a legend entry.
    pub label: String,
    /// `(parameter, tip displacement)`, along the branch.
    pub points: Vec<(f64, f64)>,
    /// Stable branches are solid, unstable ones dashed.
    pub stable: bool,
}

/// Tip displacements of equilibria over β.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bifurcation {
    /// What the reader should see.
    pub title: String,
    /// Families of equilibria.
    pub branches: Vec<EquilibriumBranch>,
    /// A line for each obstacle.
    pub obstacles: Vec<Guide>,
    /// Those in which simulations ended.
    pub ends: Series,
}

/// Draws families of equilibria; open markers show those in which simulations ended.
pub fn bifurcation(figure: &Bifurcation) -> String {
    let branches = &figure.branches;
    let labels = distinct(branches.iter().map(|branch| branch.label.as_str()));
    let mut curves = vec![];
    for branch in branches {
        let family = labels.iter().position(|label| *label == branch.label);
        curves.push(branch_curve(branch, look(family.unwrap_or(0))));
    }
    let ends_look = Look {
        colour: style::INK,
        ..look(labels.len())
    };
    curves.push(Curve {
        look: ends_look,
        width: 0.0,
        marks: Marks::Open,
        ..Curve::line(0, &figure.ends)
    });
    let parameters: Vec<f64> = curves
        .iter()
        .flat_map(|curve| &curve.points)
        .map(|point| point.0)
        .filter(|x| x.is_finite())
        .collect();
    let low = parameters.iter().copied().fold(f64::INFINITY, f64::min);
    let high = parameters.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Branches end at the limits of the parameter, so these must not coincide with the frame.
    let room = 0.03 * (high - low);
    Xy {
        title: Some(figure.title.clone()),
        show_x: vec![low - room, high + room],
        x: Axis::linear("axial force at rest β"),
        y: Axis::linear("tip displacement u(1) (dimensionless)"),
        curves,
        guides: figure.obstacles.clone(),
        ..Xy::default()
    }
    .draw()
}

fn branch_curve(branch: &EquilibriumBranch, look: Look) -> Curve {
    // A single point would be invisible as a line.
    let marks = match (branch.points.len(), branch.stable) {
        (2.., _) => Marks::None,
        (_, true) => Marks::Filled,
        (_, false) => Marks::Open,
    };
    // The colour shows the contact state, dashes show instability.
    let (dash, stability) = if branch.stable {
        (style::SOLID, "stable")
    } else {
        (style::SHORT, "unstable")
    };
    let series = Series::new(
        format!("{}, {stability}", branch.label),
        branch.points.clone(),
    );
    Curve {
        look: Look {
            dash,
            marker: Marker::Circle,
            ..look
        },
        width: 2.6,
        marks,
        ..Curve::line(0, &series)
    }
}

/// Contraction factors over the predicted one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContractionFactors {
    /// What the reader should see.
    pub title: String,
    /// What predicts them: the horizontal axis.
    pub predicted: String,
    /// `(predicted, measured)`, one series for each kind of case.
    pub measured: Vec<Series>,
    /// `(predicted, estimated)`; not drawn if there are no points.
    pub estimates: Series,
}

/// Draws measured over predicted contraction, log-log, with the identity and the region where the
/// iteration diverges. Markers there are open.
pub fn contraction(factors: &ContractionFactors) -> String {
    let measured = &factors.measured;
    let mut xy = Xy {
        title: Some(factors.title.clone()),
        x: Axis::log(factors.predicted.clone()),
        y: Axis::log("measured factor per iteration"),
        curves: measured.iter().enumerate().flat_map(sides).collect(),
        beyond: Some((1.0, "divergence".into())),
        ..Xy::default()
    };
    if measured.iter().any(has_both_sides) {
        xy.notes.push("open markers: divergence".to_owned());
    }
    // Up to 100, so that the text fits above its region.
    xy.show_x = vec![1.0, 100.0];
    xy.show_y = vec![1.0];
    if !factors.estimates.points.is_empty() {
        xy.curves.insert(0, estimates(&factors.estimates));
    }
    xy.curves.insert(0, identity(&xy));
    xy.draw()
}

/// Grey strokes below the markers, which stay in view.
fn estimates(series: &Series) -> Curve {
    let line = Curve::line(ESTIMATES, series);
    Curve {
        look: Look {
            colour: style::MUTED,
            ..line.look
        },
        width: 0.0,
        marks: Marks::Open,
        ..line
    }
}

/// The look whose marker is a plus.
const ESTIMATES: usize = 6;

/// Whether a series has points below 1, and points from 1 on.
fn has_both_sides(series: &Series) -> bool {
    let above = series.points.iter().filter(|point| point.0 >= 1.0).count();
    0 < above && above < series.points.len()
}

/// A series on both sides of 1, under one legend entry, whose marker is open if all points are.
fn sides((k, series): (usize, &Series)) -> Vec<Curve> {
    let (below, above): (Vec<_>, Vec<_>) = series.points.iter().partition(|point| point.0 < 1.0);
    let mut sides = vec![];
    for (points, marks) in [(below, Marks::Filled), (above, Marks::Open)] {
        if !points.is_empty() {
            sides.push(Curve {
                points,
                marks,
                width: 0.0,
                ..Curve::line(k, series)
            });
        }
    }
    sides
}

/// The line on which prediction and measurement agree.
fn identity(xy: &Xy) -> Curve {
    let ruler = xy.x_ruler();
    let points = [ruler.lo, ruler.hi].map(|v| (10f64.powf(v), 10f64.powf(v)));
    let line = Curve::line(0, &Series::new("measured = predicted", points));
    let look = Look {
        colour: style::MUTED,
        dash: style::LONG,
        ..line.look
    };
    Curve {
        look,
        width: 1.6,
        is_data: false,
        ..line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_experiment_looks_the_same_in_any_order_and_no_two_scenes_are_alike() {
        let [forwards, backwards] = [looks(PAPER), looks(PAPER.into_iter().rev())];
        assert!(forwards.iter().eq(backwards.iter().rev()));
        assert_eq!(looks(["impact", "paper-1-beta-0", "another"]), [7, 1, 9]);
    }
}
