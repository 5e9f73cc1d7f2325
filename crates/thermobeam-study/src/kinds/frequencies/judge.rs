//! The verdict: the order for each frequency, all errors positive, the exact frequencies roots of their equation.

use convergence_study::judge::verdict::RateVerdict;
use convergence_study::study::levels::{self, Claim, ErrorColumn, Levels, Refinement};
use convergence_study::study::{Axis, Check, Outcome, Ran, Table};
use convergence_study::text::number::max_or_nan;
use thermobeam::vibration::frequencies;

use super::Frequencies;

/// Bound on the frequency equation at the exact frequencies, in rounding errors of its terms.
///
/// Between neighbours the determinant is of order 1, near a frequency its slope is of order 1 too: 16 of them mean 14 digits.
const ROUNDING_ERRORS: f64 = 16.0;

/// Relative error of frequencies that are not judged by their rates.
const MET: f64 = 1e-8;

pub(super) fn judge(study: &Frequencies, ran: &[Ran<usize, Vec<f64>>]) -> Outcome {
    let levels = errors(study, ran);
    let rates = levels.judge();
    let not_finite = |found: &Vec<f64>| {
        let complete = found.len() == study.count && found.iter().all(|omega| omega.is_finite());
        if complete { vec![] } else { vec!["a frequency".to_owned()] }
    };
    let mut checks =
        vec![levels::completion(ran, not_finite), check_equation(study.count), check_above(study, &levels)];
    if study.first > 1 {
        checks.push(check_below_first(study, ran));
    }
    let figure = levels.figure(
        format!("{}-errors.svg", study.header.id),
        Some("Discrete frequencies, ω_h - ω".to_owned()),
        format!(
            "Errors of frequencies {} to {} over the mesh width, on elements of degree {}.",
            study.first, study.count, study.degree
        ),
        &rates,
    );
    Outcome {
        tables: vec![table(study, &levels, &rates)],
        figures: vec![figure],
        quantities: levels.quantities(&rates),
        levels: levels.errors(),
        ..Outcome::new(levels::summary(&rates), rates, checks)
    }
}

fn errors(study: &Frequencies, ran: &[Ran<usize, Vec<f64>>]) -> Levels {
    let exact = frequencies(study.count);
    let found = |level: &Ran<usize, Vec<f64>>, mode: usize| level.ok().and_then(|found| found.get(mode)).copied();
    let refinement = |level: &Ran<usize, Vec<f64>>| Refinement {
        label: level.case.label.clone(),
        parameters: vec![("elements".to_owned(), level.case.data as f64)],
        step: study.mesh(level.case.data).map_or(f64::NAN, |mesh| mesh.size()),
    };
    let column = |mode: usize| ErrorColumn {
        name: format!("omega-{}", mode + 1),
        errors: ran.iter().map(|level| Some(found(level, mode)? - exact[mode])).collect(),
        claim: Some(Claim { order: study.order, tolerance: study.tolerance }),
        look: mode,
    };
    Levels {
        axis: Axis::Space,
        refinements: ran.iter().map(refinement).collect(),
        columns: (study.first - 1..study.count).map(column).collect(),
    }
}

fn table(study: &Frequencies, levels: &Levels, rates: &[(String, RateVerdict)]) -> Table {
    let finest = levels.refinements.last();
    let h = finest.map_or(f64::NAN, |level| level.step);
    let row = |(mode, omega): (usize, f64)| {
        let (column, rate) = (&levels.columns[mode], &rates[mode].1);
        let error = column.errors.last().copied().flatten().unwrap_or(f64::NAN);
        let interval = rate.interval.map_or_else(|| "-".into(), |[low, high]| format!("{low:.4} to {high:.4}"));
        // Known for linear elements only.
        let leading = (study.degree == 1).then(|| format!("{:.3}", error / (omega.powi(3) * h * h / 24.0)));
        vec![
            (mode + study.first).to_string(),
            format!("{omega:.11}"),
            format!("{:.11}", omega + error),
            format!("{error:.3e}"),
            leading.unwrap_or_else(|| "-".into()),
            rate.fitted.map_or_else(|| "-".into(), |rate| format!("{rate:.4}")),
            interval,
            rate.verdict.to_string(),
        ]
    };
    let head = ["mode", "ω exact", "ω_h", "ω_h - ω", "over ω³h²/24", "rate", "95 % interval", "verdict"];
    let mesh = finest.map_or("-", |level| level.label.as_str());
    Table {
        title: format!("Frequencies {} to {}, exact and discrete ({mesh})", study.first, study.count),
        head: head.map(str::to_owned).into(),
        rows: frequencies(study.count).into_iter().skip(study.first - 1).enumerate().map(row).collect(),
    }
}

/// `1 + C+ C- - ω² S+ S-` at x = 1 for ω > 1, half the determinant of the boundary conditions, by plain sines.
fn determinant(omega: f64) -> f64 {
    let [plus, minus] = [omega * omega - omega, omega * omega + omega].map(f64::sqrt);
    1.0 + plus.cos() * minus.cos() - omega * omega * (plus.sin() / plus) * (minus.sin() / minus)
}

fn check_equation(count: usize) -> Check {
    let rounding = |omega: f64| determinant(omega).abs() / (f64::EPSILON * (1.0 + omega));
    let worst = frequencies(count).into_iter().map(rounding).fold(0.0, max_or_nan);
    Check::that(
        worst <= ROUNDING_ERRORS,
        "the exact frequencies solve the frequency equation 1 + C+ C- - ω² S+ S- = 0",
        format!("largest residual {worst:.1} rounding errors, allowed {ROUNDING_ERRORS}"),
    )
}

/// Frequencies that are too near to round-off for a rate: they must be met on the finest mesh.
fn check_below_first(study: &Frequencies, ran: &[Ran<usize, Vec<f64>>]) -> Check {
    let exact = frequencies(study.first - 1);
    let found = ran.last().and_then(|level| level.ok());
    let error = |(mode, omega): (usize, &f64)| {
        let found = found.and_then(|found| found.get(mode)).copied().unwrap_or(f64::NAN);
        (found - omega).abs() / omega
    };
    let worst = exact.iter().enumerate().map(error).fold(0.0, max_or_nan);
    Check::that(
        worst <= MET,
        format!("the frequencies below number {} are met to {MET:e} of their value on the finest mesh", study.first),
        format!("largest relative error {worst:.1e}"),
    )
}

fn check_above(study: &Frequencies, levels: &Levels) -> Check {
    let least = levels.columns.iter().flat_map(|column| &column.errors).fold(f64::INFINITY, |least, &error| {
        // A NaN must stay, and so must a mode that was not found.
        let error = error.unwrap_or(f64::NAN);
        if least.is_nan() || least <= error { least } else { error }
    });
    Check::that(
        least > 0.0,
        format!("discrete frequencies {} to {} lie above the exact ones", study.first, study.count),
        format!("the smallest ω_h - ω of all levels and modes is {least:.3e}"),
    )
}
