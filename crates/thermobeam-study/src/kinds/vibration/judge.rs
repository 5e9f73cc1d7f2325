//! The verdict: the order in each norm, and in the design that isolates time the closed form of every step.

use convergence_study::plots::{self, Axis as PlotAxis, History, Series};
use convergence_study::study::levels::{self, Levels};
use convergence_study::study::{Axis, Check, Figure, Outcome, Ran, Table};
use convergence_study::text::number::max_or_nan;
use thermobeam::vibration::Mode;

use super::{Vibrated, Vibrating, Vibration};
use crate::kinds::tables::{norm_levels, not_finite};

/// How far the solver may be from the closed form of its own steps, relative to the motion's size in the norm of
/// Theorem 3.4. Measured are 3e-14; a coefficient that is off by 1e-10 would show.
const CLOSED_FORM: f64 = 1e-12;

type Run = Ran<(usize, usize), Vibrated>;

pub(super) fn judge(study: &Vibration, ran: &[Run]) -> Outcome {
    let levels = errors(study, ran);
    let rates = levels.judge();
    let mut checks = vec![levels::completion(ran, |found| {
        let closed_form = found.closed_form.filter(|deviation| !deviation.is_finite());
        not_finite(&found.errors).into_iter().chain(closed_form.map(|_| "closed form".to_owned())).collect()
    })];
    checks.extend(closed_form(study, ran));
    let mut figures = vec![levels.figure(
        format!("{}-errors.svg", study.header.id),
        Some("Damped vibration, no source term".to_owned()),
        "Errors against exact damped modes, with the orders that theory gives.".to_owned(),
        &rates,
    )];
    if study.refine.axis == Axis::Both {
        figures.extend(tip_figure(study, ran));
    }
    Outcome {
        levels: levels.errors(),
        tables: vec![modes_table(study)],
        figures,
        quantities: levels.quantities(&rates),
        ..Outcome::new(levels::summary(&rates), rates, checks)
    }
}

/// Errors in each norm, judged where the file expects an order: over dt where only time is refined, else over h.
fn errors(study: &Vibration, ran: &[Run]) -> Levels {
    let step = |elements: usize, steps: usize| match study.refine.axis {
        Axis::Time => study.refine.dt(steps),
        Axis::Space | Axis::Both => study.refine.mesh(elements).map_or(f64::NAN, |mesh| mesh.size()),
    };
    let errors = ran.iter().map(|ran| (ran.case.data, ran.ok().map(|found| &found.errors)));
    norm_levels(&study.refine, &study.expect, step, errors)
}

/// In the design that isolates time the solver's result is known to the last digit.
fn closed_form(study: &Vibration, ran: &[Run]) -> Option<Check> {
    if !study.isolates(Axis::Time) {
        return None;
    }
    let deviation = |ran: &Run| ran.ok().and_then(|found| found.closed_form).unwrap_or(f64::NAN);
    let worst = ran.iter().map(deviation).fold(0.0, max_or_nan);
    Some(Check::that(
        worst <= CLOSED_FORM && !ran.is_empty(),
        "each step is the scheme's own step of each mode of the mesh, to round-off",
        format!("largest deviation {worst:.1e} of the motion, allowed {CLOSED_FORM:.0e}"),
    ))
}

fn modes_table(study: &Vibration) -> Table {
    let row = |&Vibrating { index, start }: &Vibrating| {
        let omega = Mode::new(index).omega();
        let damping = 0.5 * study.beam.zeta * omega;
        vec![
            (index + 1).to_string(),
            format!("{omega:.11}"),
            format!("{damping:.4}"),
            if damping < 1.0 { "underdamped" } else { "overdamped" }.into(),
            start[0].to_string(),
            start[1].to_string(),
        ]
    };
    Table {
        title: "Modes superposed".into(),
        head: ["mode", "ω", "ζω/2", "motion", "u(1) at t = 0", "u_t(1) at t = 0"].map(str::to_owned).into(),
        rows: study.modes.iter().map(row).collect(),
    }
}

/// The tip's displacement on the coarsest and the finest level beside the exact one.
fn tip_figure(study: &Vibration, ran: &[Run]) -> Option<Figure> {
    let (first, last) = (ran.first()?, ran.last()?);
    let (coarsest, finest) = (first.ok()?, last.ok()?);
    let series = [
        ("exact".to_owned(), &finest.exact_tip),
        (first.case.label.clone(), &coarsest.tip),
        (last.case.label.clone(), &finest.tip),
    ];
    let figure = History {
        title: Some("Tip of the vibrating beam".into()),
        y: PlotAxis::linear("tip displacement u(1, t) (dimensionless)"),
        series: series.map(|(label, points)| Series { label, points: points.clone() }).into(),
        ..History::default()
    };
    Some(Figure {
        file: format!("{}-tip.svg", study.header.id),
        caption: "Tip displacement over time: exact, and on the coarsest and the finest level.".into(),
        svg: plots::history(&figure),
    })
}
