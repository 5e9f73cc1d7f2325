//! Figures of beams, each a chart of the harness: plain data in, a self-contained SVG document out.

mod pictures;
mod space_time;

use convergence_judge::text::lists::distinct;
use convergence_study::chart::{Axis, Cells, Chart, Columns, Guide, Mark, Series, Shade};
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

/// Cells of two parameters: their centres and values.
///
/// * `axes`: of both parameters, and of the colours.
/// * `missing`: what a cell without a value is.
pub(crate) fn cells(cells: &[[f64; 3]], axes: [Axis; 3], missing: &str) -> Chart {
    let values = [0, 1, 2].map(|k| cells.iter().map(|cell| cell[k]).collect());
    let names = axes.each_ref().map(|axis| axis.label.clone());
    let [x, y, value] = names.clone();
    let columns: Vec<(String, Vec<f64>)> = names.into_iter().zip(values).collect();
    let [across, up, colours] = axes;
    Chart {
        cells: Some(Cells {
            x,
            y,
            value,
            colours,
            missing: missing.to_owned(),
        }),
        ..Chart::new(Columns::new(columns), across, up)
    }
}

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

/// The [`style`](convergence_study::chart::Series::style) of each scene of a figure: an
/// experiment of the paper has its own; any other scene gets, by its place in the figure, one that
/// no experiment has.
pub(crate) fn styles<'n>(scenes: impl IntoIterator<Item = &'n str>) -> Vec<usize> {
    let mut styles = vec![];
    for (place, name) in scenes.into_iter().enumerate() {
        let paper = PAPER.iter().position(|known| *known == name);
        styles.push(paper.unwrap_or(PAPER.len() + place));
    }
    styles
}

/// The values of β in the paper's experiments.
const BETAS: [f64; 4] = [-0.5, 0.0, 5.0, -0.8];

/// The [`style`](convergence_study::chart::Series::style) of a value of β, the same in all
/// figures whose curves are its values; of other values the next one.
pub(crate) fn style_of_beta(beta: f64) -> usize {
    BETAS
        .iter()
        .position(|known| *known == beta)
        .unwrap_or(BETAS.len())
}

/// The name of a beam by its axial force at rest.
pub(crate) fn beta_label(beta: f64) -> String {
    // A minus sign, not a hyphen.
    format!("β = {beta}").replace('-', "−")
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
    /// `(parameter, tip displacement)` of those in which simulations ended.
    pub ends: Vec<(f64, f64)>,
}

/// The k-th style of discs in ink: the first 60 are those of curves.
const ENDS: usize = 61;

/// Draws families of equilibria; open markers show those in which simulations ended.
pub fn bifurcation(figure: &Bifurcation) -> String {
    let branches = &figure.branches;
    let labels = distinct(branches.iter().map(|branch| branch.label.as_str()));
    let points = branches.iter().flat_map(|branch| &branch.points);
    let parameters = points.chain(&figure.ends).map(|point| point.0);
    let parameters = parameters.filter(|x| x.is_finite());
    let low = parameters.clone().fold(f64::INFINITY, f64::min);
    let high = parameters.fold(f64::NEG_INFINITY, f64::max);
    // Branches end at the limits of the parameter, so these must not coincide with the frame.
    let room = 0.03 * (high - low);
    let x = Axis::linear("axial force at rest β").showing([low - room, high + room]);
    let y = Axis::linear("tip displacement u(1) (dimensionless)");
    let mut chart = Chart {
        guides: figure.obstacles.clone(),
        ..Chart::empty(x, y).titled(&figure.title)
    };
    for branch in branches {
        let family = labels.iter().position(|label| *label == branch.label);
        // The colour shows the contact state, dashes show instability.
        let (dashes, stability) = if branch.stable {
            (Series::SOLID, "stable")
        } else {
            (Series::SHORT, "unstable")
        };
        let label = format!("{}, {stability}", branch.label);
        let curve = chart.curve(label, branch.points.iter().copied());
        curve.style = family;
        curve.dashes = Some(dashes);
        curve.width = 2.6;
    }
    let ends = chart.curve("end of a run", figure.ends.iter().copied());
    *ends = ends.clone().scattered().styled(ENDS);
    ends.mark = Mark::Open;
    chart.svg()
}

/// Points with a name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedPoints {
    /// In the legend.
    pub label: String,
    /// `(predicted, measured)`.
    pub points: Vec<(f64, f64)>,
}

/// Contraction factors over the predicted one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContractionFactors {
    /// What the reader should see.
    pub title: String,
    /// What predicts them: the horizontal axis.
    pub predicted: String,
    /// Those of one kind of case together.
    pub measured: Vec<NamedPoints>,
    /// Estimates of them; not drawn if there are no points.
    pub estimates: NamedPoints,
}

/// The range of numbers that a logarithmic axis shows, 1 included.
fn extent(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let shown = numbers.filter(|number| *number > 0.0 && number.is_finite());
    shown.fold([1.0, 1.0], |[least, most], number| {
        [least.min(number), most.max(number)]
    })
}

/// The style of estimates: a plus, below the markers, which stay in view.
const ESTIMATES: usize = 45;
/// The style of the line of agreement.
const IDENTITY: usize = 5;

/// Draws measured over predicted contraction, log-log, with the identity and the region where the
/// iteration diverges. Markers there are open.
pub fn contraction(factors: &ContractionFactors) -> String {
    let measured = &factors.measured;
    let x = Axis::log(&factors.predicted).showing([1.0]);
    let y = Axis::log("measured factor per iteration").showing([1.0]);
    let mut chart = Chart::empty(x, y).titled(&factors.title);
    chart.bands.push(Shade {
        label: "divergence".to_owned(),
        intervals: vec![(1.0, f64::INFINITY)],
    });
    let all = measured.iter().flat_map(|series| &series.points);
    let [across, up] = [
        extent(all.clone().map(|point| point.0)),
        extent(all.map(|point| point.1)),
    ];
    // Beyond what was measured, or predicted, the line would stretch an axis.
    let identity = [across[0].max(up[0]), across[1].min(up[1])].map(|end| (end, end));
    let agreement = chart.curve("measured = predicted", identity);
    *agreement = agreement.clone().styled(IDENTITY);
    agreement.width = 1.6;
    if !factors.estimates.points.is_empty() {
        let NamedPoints { label, points } = &factors.estimates;
        let estimates = chart.curve(label, points.iter().copied());
        *estimates = estimates.clone().scattered().styled(ESTIMATES);
    }
    for (k, NamedPoints { label, points }) in measured.iter().enumerate() {
        let (below, above): (Vec<_>, Vec<_>) = points.iter().partition(|point| point.0 < 1.0);
        if !below.is_empty() && !above.is_empty() {
            chart.notes = vec!["open markers: divergence".to_owned()];
        }
        let converging = 0..below.len();
        let series = chart.curve(label, [below, above].concat());
        *series = series.clone().scattered().styled(k);
        series.used = Some(converging);
    }
    chart.svg()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_experiment_looks_the_same_in_any_order_and_no_two_scenes_are_alike() {
        let [forwards, backwards] = [styles(PAPER), styles(PAPER.into_iter().rev())];
        assert!(forwards.iter().eq(backwards.iter().rev()));
        assert_eq!(styles(["impact", "paper-1-beta-0", "another"]), [7, 1, 9]);
    }
}
