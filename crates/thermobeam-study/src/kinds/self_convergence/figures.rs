//! The tip's displacement over time.

use convergence_study::plots::{self, Axis as PlotAxis, Guide, History, Series};
use convergence_study::study::{Axis, Figure, Ran};

use super::SelfConvergence;
use super::judge::Found;

/// On the coarsest and the finest level and in the reference run, with the obstacles.
pub(super) fn tip(study: &SelfConvergence, ran: &[Found]) -> Figure {
    let (reference, finest) = (study.levels.len(), study.levels.len() - 1);
    let name = |k: usize| match study.axis {
        Axis::Time => format!("{} steps", study.levels[k].steps),
        Axis::Space | Axis::Both => format!("n = {}", study.levels[k].elements),
    };
    let curve = |(k, label): (usize, String)| Series {
        label,
        points: ran.get(k).and_then(Ran::ok).map_or(vec![], |found| found.tip.clone()),
    };
    let shown =
        [(reference, format!("reference, {}", study.references[0].label())), (0, name(0)), (finest, name(finest))];
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
