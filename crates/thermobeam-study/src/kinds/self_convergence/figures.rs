//! The tip's displacement over time.

use convergence_study::plots::{self, Axis as PlotAxis, Guide, History, Series};
use convergence_study::study::{Axis, Figure, Ran};

use super::SelfConvergence;
use super::judge::Run;

/// On the coarsest and the finest level and in the reference run, with the obstacles.
pub(super) fn tip(study: &SelfConvergence, ran: &[Run]) -> Figure {
    let reference = study.runs.len() - 1;
    let name = |k: usize| match study.axis {
        Axis::Space => format!("n = {}", study.runs[k].elements),
        Axis::Time | Axis::Both => format!("{} steps", study.runs[k].steps),
    };
    let curve = |(k, label): (usize, String)| Series {
        label,
        points: ran.get(k).and_then(Ran::ok).map_or(vec![], |found| found.tip.clone()),
    };
    let shown =
        [(reference, format!("reference, {}", name(reference))), (0, name(0)), (reference - 1, name(reference - 1))];
    let guides = study
        .scene
        .obstacles
        .map_or(vec![], |o| vec![Guide { label: "g₁".into(), value: o.g1 }, Guide { label: "g₂".into(), value: o.g2 }]);
    let figure = History {
        title: Some(format!("Tip of {}", study.scene.name)),
        y: PlotAxis::linear("tip displacement u(1, t) (dimensionless)"),
        series: shown.into_iter().map(curve).collect(),
        guides,
        ..History::default()
    };
    Figure {
        file: format!("{}-tip.svg", study.header.id),
        caption: "Tip displacement on the coarsest and the finest level and in the reference run, with the obstacles."
            .into(),
        svg: plots::history(&figure),
    }
}
