//! A check for each run: its end, rise and residual of every step, and the sum of the residuals.

use convergence_study::judge::verdict::Verdict;
use convergence_study::plots::{self, Axis, Guide, Series};
use convergence_study::study::levels::completion;
use convergence_study::study::{Check, Figure, Outcome, Quantity, Ran, Table};
use convergence_study::text::number::{max_or_nan, plain_text};

use super::{Bound, End, Figures, Found, Run, Runs, Sample, Worst};
use crate::kinds::watch::of_allowed;

pub(super) fn judge(study: &Runs, ran: &[Ran<usize, Found>]) -> Outcome {
    let found: Vec<(&Run, &Found)> =
        ran.iter().filter_map(|ran| Some((&study.runs[ran.case.data], ran.ok()?))).collect();
    let mut checks = vec![completion(ran, not_finite)];
    checks.extend(found.iter().map(|(run, found)| check(run, found)));
    let holding = checks.iter().skip(1).filter(|check| check.verdict == Verdict::Pass).count();
    let steps: usize = found.iter().map(|(_, found)| found.steps).sum();
    let Worst { residual, rise, .. } = found.iter().fold(Worst::NONE, |worst, (_, found)| worst.max(found.worst));
    let share = found.iter().map(|(run, found)| share(run, found)).fold(0.0, max_or_nan);
    let headline = format!("largest residual {residual:.1e} of the energy, largest change in a step {rise:.1e}");
    let summary = format!(
        "{holding} of {} runs hold, {steps} steps: {headline}; at most {}",
        study.runs.len(),
        of_allowed(share)
    );
    Outcome {
        headline,
        tables: vec![table(&found)],
        figures: figures(study, &found),
        quantities: vec![Quantity { name: "steps".to_owned(), value: steps as f64, tolerance: 1e-9 }],
        ..Outcome::new(summary, vec![], checks)
    }
}

/// Names of the numbers that are not finite; a run without a step has no rise.
fn not_finite(found: &Found) -> Vec<String> {
    let Found { initial_energy, worst, drift, steps, .. } = found;
    let numbers = [
        ("initial energy", *initial_energy),
        ("residual", worst.residual),
        ("rise", if *steps == 0 { 0.0 } else { worst.rise }),
        ("residual over its bound", worst.open),
        ("rise over its bound", worst.risen),
        ("sum of residuals", *drift),
    ];
    numbers.iter().filter(|(_, value)| !value.is_finite()).map(|(name, _)| (*name).to_owned()).collect()
}

/// Largest rise or residual of a run in units of its bound.
fn share(run: &Run, found: &Found) -> f64 {
    let worst = &found.worst;
    match run.bound {
        Bound::Share(tolerance) => max_or_nan(worst.residual, worst.rise) / tolerance,
        Bound::Rounding => max_or_nan(worst.open, worst.risen),
    }
}

/// The end that is claimed, and the bounds of every step before; a run without a step has nothing to bound.
fn check(run: &Run, found: &Found) -> Check {
    let Found { end, steps, worst, drift, .. } = found;
    let ended = *end == run.end && (*end != End::Answer || *steps == run.steps);
    let share = share(run, found);
    let bounded = *steps == 0 || share <= 1.0;
    let drifted = run.drift.is_none_or(|bound| drift.abs() <= bound);
    let balance = format!(
        "; rise {:.1e}, residual {:.1e} of the energy ({}); sum of all residuals {:.1e}",
        worst.rise,
        worst.residual,
        of_allowed(share),
        drift.abs(),
    );
    let balance = if *steps == 0 { "" } else { &balance };
    let evidence = format!("{} after {steps} steps{balance}", end.name());
    Check::that(ended && bounded && drifted, format!("{}: {}", run.name, run.claim), evidence)
}

fn table(found: &[(&Run, &Found)]) -> Table {
    let head = [
        "run",
        "elements",
        "dt",
        "steps",
        "in contact",
        "end",
        "most iterations",
        "initial energy",
        "rise",
        "residual",
        "sum of residuals",
    ];
    let row = |(run, found): &(&Run, &Found)| {
        let number = |value: f64| if found.steps == 0 { "-".to_owned() } else { format!("{value:.1e}") };
        vec![
            run.name.clone(),
            run.elements().to_string(),
            plain_text(run.stepping.dt),
            found.steps.to_string(),
            found.contact_steps.to_string(),
            found.end.name().to_owned(),
            found.most_iterations.to_string(),
            format!("{:.4e}", found.initial_energy),
            number(found.worst.rise),
            number(found.worst.residual),
            number(found.drift.abs()),
        ]
    };
    Table {
        title: "Largest rise and residual of a step, and the sum of all residuals, in units of the energy".to_owned(),
        head: head.map(str::to_owned).into(),
        rows: found.iter().map(row).collect(),
    }
}

fn figures(study: &Runs, found: &[(&Run, &Found)]) -> Vec<Figure> {
    let series = |point: &dyn Fn(&Found, &Sample) -> (f64, f64)| {
        let drawn = found.iter().filter(|(run, _)| run.is_drawn);
        let curve = |(run, found): &(&Run, &Found)| Series {
            label: scene(run).to_owned(),
            points: found.samples.iter().map(|sample| point(found, sample)).collect(),
        };
        drawn.map(curve).collect::<Vec<_>>()
    };
    let figure = |what: &str, caption: &str, history: plots::History| Figure {
        file: format!("{}-{what}.svg", study.header.id),
        caption: caption.to_owned(),
        svg: plots::history(&history),
    };
    if study.figures == Figures::Drift {
        let series = not_zero(series(&|_, sample| (sample.step as f64, sample.drift.abs())));
        let y = Axis::log("|sum of residuals| / energy");
        let guides = allowed(found, |run| run.drift);
        let history = plots::History { x_label: "steps".to_owned(), y, series, guides, ..plots::History::default() };
        return vec![figure("drift", "Sum of the signed residuals of the energy balance up to each step.", history)];
    }
    let looks = crate::figures::looks(found.iter().filter(|(run, _)| run.is_drawn).map(|(run, _)| scene(run)));
    let energy = plots::History {
        y: Axis::linear("energy E / initial energy"),
        series: series(&|found, sample| (sample.t, sample.energy / found.initial_energy)),
        looks: looks.clone(),
        ..plots::History::default()
    };
    let balance = plots::History {
        y: Axis::log("residual / initial energy"),
        series: not_zero(series(&|_, sample| (sample.t, sample.residual))),
        looks,
        guides: allowed(found, |run| match run.bound {
            Bound::Share(tolerance) => Some(tolerance),
            Bound::Rounding => None,
        }),
        ..plots::History::default()
    };
    vec![
        figure("energy", "The energy, in units of its initial size: it never rises.", energy),
        figure(
            "balance",
            "Residual of the energy balance, the largest of each group of steps, in units of the initial energy.",
            balance,
        ),
    ]
}

/// The name of a run without that of its scheme.
fn scene(run: &Run) -> &str {
    run.name.split(',').next().unwrap_or_default()
}

/// Without values of exactly zero, such as that of the start: they have no place on a logarithmic axis.
fn not_zero(mut series: Vec<Series>) -> Vec<Series> {
    series.iter_mut().for_each(|series| series.points.retain(|(_, value)| *value != 0.0));
    series
}

/// A line for each bound that the runs drawn must keep.
fn allowed(found: &[(&Run, &Found)], bound: impl Fn(&Run) -> Option<f64>) -> Vec<Guide> {
    let mut bounds: Vec<f64> = found.iter().filter(|(run, _)| run.is_drawn).filter_map(|(run, _)| bound(run)).collect();
    bounds.sort_by(f64::total_cmp);
    bounds.dedup();
    bounds.into_iter().map(|value| Guide { label: "allowed".to_owned(), value }).collect()
}
