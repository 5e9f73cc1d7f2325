//! A check for each case, and the table of what was seen.

use super::{End, Extreme, Extremes};
use crate::kinds::Study;
use crate::kinds::complete::{all_ran, or_nothing};
use crate::kinds::untyped::Measured;
use crate::kinds::watch::of_allowed;
use convergence_study::judge::verdict::Verdict;
use convergence_study::plots::{self, Axis, Series};
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Figure, Outcome, Quantity, Table};
use convergence_study::text::number::max_or_nan;

pub(super) fn outcome(study: &Extremes, results: &[Result<Measured, CaseFailure>]) -> Outcome {
    let cases = study.cases();
    let measured = or_nothing(cases.len(), results);
    let mut checks = vec![all_ran(&cases, results)];
    checks.extend(study.extremes.iter().zip(&measured).map(|(extreme, m)| judge(extreme, m)));
    let worst = measured.iter().map(|m| m.value("open")).filter(|open| !open.is_nan()).fold(0.0, max_or_nan);
    let steps: f64 = measured.iter().map(|m| m.value("steps")).sum();
    let summary = format!(
        "{} scenes at the edge, {steps} steps: each ends as claimed, and no balance is open by more than {}",
        cases.len(),
        of_allowed(worst),
    );
    let ended = checks.iter().skip(1).filter(|check| check.verdict == Verdict::Pass).count();
    let headline = format!("{ended} of {} end as claimed; largest residual {}", cases.len(), of_allowed(worst));
    let mut outcome = Outcome { headline, ..Outcome::new(summary, vec![], checks) };
    let head = [
        "case",
        "elements",
        "dt",
        "steps",
        "in contact",
        "ends",
        "most iterations",
        "rise",
        "residual",
        "sum of residuals",
    ];
    outcome.tables = vec![Table {
        title: "What was seen; rise and residual in units of the energy".to_owned(),
        head: head.map(str::to_owned).to_vec(),
        rows: study.extremes.iter().zip(&measured).map(|(extreme, m)| row(extreme, m)).collect(),
    }];
    outcome.figures = vec![figure(study, &measured)];
    outcome.quantities = vec![Quantity { name: "steps".to_owned(), value: steps, tolerance: 1e-9 }];
    outcome
}

/// The end that is claimed, and the laws of the energy on the way; where not one step is done, there is no way.
fn judge(extreme: &Extreme, m: &Measured) -> Check {
    let (end, steps) = (m.value("end"), m.value("steps"));
    let (risen, open, drift) = (m.value("risen"), m.value("open"), m.value("drift"));
    let ended = end == extreme.end.code() && (end != End::Answer.code() || steps == extreme.scene.steps as f64);
    let lawful = steps == 0.0 || (risen <= 1.0 && open <= 1.0);
    let drifted = extreme.drift.is_none_or(|bound| drift <= bound);
    let way = format!(
        "; rise {:.1e}, residual {:.1e} of the energy ({}); sum of all residuals {drift:.1e}",
        m.value("rise"),
        m.value("residual"),
        of_allowed(open),
    );
    let way = if steps == 0.0 { "" } else { &way };
    let evidence = format!("{} after {steps} steps{way}", End::name_of(end));
    Check::that(ended && lawful && drifted, format!("{}: {}", extreme.scene.name, extreme.claim), evidence)
}

fn row(extreme: &Extreme, m: &Measured) -> Vec<String> {
    let scene = &extreme.scene;
    vec![
        scene.name.clone(),
        scene.mesh.elements().to_string(),
        format!("{:e}", scene.dt),
        m.value("steps").to_string(),
        m.value("contact").to_string(),
        End::name_of(m.value("end")).to_owned(),
        m.value("most iterations").to_string(),
        number(m.value("rise")),
        number(m.value("residual")),
        number(m.value("drift")),
    ]
}

/// A run without a step has none.
fn number(value: f64) -> String {
    if value.is_nan() { "-".to_owned() } else { format!("{value:.1e}") }
}

/// The sums of residuals over the steps, of the cases that claim a bound; of all where none does.
fn figure(study: &Extremes, measured: &[Measured]) -> Figure {
    let bounded = study.extremes.iter().any(|extreme| extreme.drift.is_some());
    let shown = study.extremes.iter().zip(measured).filter(|(extreme, _)| extreme.drift.is_some() || !bounded);
    let series = shown.map(|(extreme, m)| Series {
        label: extreme.scene.name.clone(),
        points: m.curve("drift").iter().copied().filter(|(_, drift)| *drift > 0.0).collect(),
    });
    let history = plots::History {
        x_label: "steps".to_owned(),
        y: Axis::log("|sum of residuals| / energy"),
        series: series.collect(),
        ..plots::History::default()
    };
    Figure {
        file: format!("{}-drift.svg", study.header.id),
        caption: "Sum of all residuals of the energy balance up to a step, with their signs.".to_owned(),
        svg: plots::history(&history),
    }
}
