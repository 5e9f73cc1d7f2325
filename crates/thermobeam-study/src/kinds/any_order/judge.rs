//! The verdict: a rate for each degree and each error, or the fall of the error with the degree.

use convergence_study::plots::look::look;
use convergence_study::plots::marker::Marks;
use convergence_study::plots::xy::{Curve, Xy};
use convergence_study::plots::{self, Axis as PlotAxis};
use convergence_study::study::levels::{self, Claim, ErrorColumn, Levels, Refinement};
use convergence_study::study::{Axis, Check, Figure, Outcome, Quantity, Ran, Table};
use convergence_study::text::number::counted;

use super::{AnyOrder, Errors, Over, Resolution, Series};

/// Error below which a further degree gains nothing: round-off of the loads and the initial data.
const ROUND_OFF: f64 = 2e-12;

pub(super) fn judge(study: &AnyOrder, ran: &[Ran<Resolution, Errors>]) -> Outcome {
    let completion = levels::completion(ran, |found| {
        let Errors { fields, slopes, inside_u, inside_u_t } = *found;
        let named = [("fields", fields), ("slopes", slopes), ("u inside", inside_u), ("u_t inside", inside_u_t)];
        named.iter().filter(|(_, error)| !error.is_finite()).map(|(name, _)| (*name).to_owned()).collect()
    });
    match study.over {
        Over::Degree => over_degrees(study, ran, completion),
        Over::Space | Over::Time => over_steps(study, ran, completion),
    }
}

/// Rates over h or dt, a figure for each degree's errors together.
fn over_steps(study: &AnyOrder, ran: &[Ran<Resolution, Errors>], completion: Check) -> Outcome {
    let mut outcome = Outcome::new("", vec![], vec![]);
    let mut rates = vec![];
    let mut begin = 0;
    for series in &study.series {
        let mine = runs_of(ran, &mut begin, series);
        let levels = levels_of(study, series, mine);
        let judged = levels.judge();
        outcome.quantities.extend(levels.quantities(&judged));
        outcome.levels.extend(levels.errors());
        let (letter, degree) = match study.over {
            Over::Time => ("q", series.runs[0].time_degree),
            _ => ("p", series.runs[0].degree),
        };
        outcome.figures.push(levels.figure(
            format!("{}-{letter}{degree}.svg", study.header.id),
            Some(format!("{letter} = {degree}")),
            format!("Errors for {letter} = {degree}, with the orders of theory (triangles)."),
            &judged,
        ));
        rates.extend(judged);
    }
    let Outcome { figures, quantities, levels, .. } = outcome;
    Outcome { figures, quantities, levels, ..Outcome::new(levels::summary(&rates), rates, vec![completion]) }
}

/// The next runs, those of one series: fewer where some are missing.
fn runs_of<'r>(
    ran: &'r [Ran<Resolution, Errors>],
    begin: &mut usize,
    series: &Series,
) -> &'r [Ran<Resolution, Errors>] {
    let end = *begin + series.runs.len();
    let mine = &ran[(*begin).min(ran.len())..end.min(ran.len())];
    *begin = end;
    mine
}

/// Name and order of an error, and the error itself.
type ClaimOf = (String, f64, fn(&Errors) -> f64);

fn levels_of(study: &AnyOrder, series: &Series, ran: &[Ran<Resolution, Errors>]) -> Levels {
    let Resolution { degree: p, time_degree: q, .. } = series.runs[0];
    let claims: Vec<ClaimOf> = match study.over {
        Over::Time => vec![
            (format!("q = {q}, ends"), (2 * q + 1) as f64, |errors| errors.fields),
            (format!("q = {q}, u inside"), (q + 2).min(2 * q + 1) as f64, |errors| errors.inside_u),
            (format!("q = {q}, u_t inside"), (q + 1) as f64, |errors| errors.inside_u_t),
        ],
        _ => vec![
            (format!("p = {p}, fields"), (p + 1) as f64, |errors| errors.fields),
            (format!("p = {p}, slopes"), p as f64, |errors| errors.slopes),
        ],
    };
    let column = |(look, (name, order, of)): (usize, &ClaimOf)| ErrorColumn {
        name: name.clone(),
        errors: ran.iter().map(|ran| ran.ok().map(of)).collect(),
        claim: Some(Claim { order: *order, tolerance: series.tolerance }),
        look,
    };
    let refinement = |ran: &Ran<Resolution, Errors>| {
        let Resolution { degree, elements, time_degree, steps } = ran.case.data;
        let numbers = [("degree", degree), ("elements", elements), ("time degree", time_degree), ("steps", steps)];
        Refinement {
            label: ran.case.label.clone(),
            parameters: numbers.iter().map(|(name, value)| ((*name).to_owned(), *value as f64)).collect(),
            step: match study.over {
                Over::Time => study.t_end / steps as f64,
                _ => study.mesh(elements).map_or(f64::NAN, |mesh| mesh.size()),
            },
        }
    };
    Levels {
        axis: if study.over == Over::Time { Axis::Time } else { Axis::Space },
        refinements: ran.iter().map(refinement).collect(),
        columns: claims.iter().enumerate().map(column).collect(),
    }
}

/// The error must fall by the factor claimed, as a geometric mean, from the first degree to the one that reaches round-off.
fn over_degrees(study: &AnyOrder, ran: &[Ran<Resolution, Errors>], completion: Check) -> Outcome {
    let mut checks = vec![completion];
    let mut curves = vec![];
    let (mut quantities, mut rows) = (vec![], vec![]);
    let mut begin = 0;
    for (k, series) in study.series.iter().enumerate() {
        let mine = runs_of(ran, &mut begin, series);
        let points: Vec<(f64, f64)> = mine
            .iter()
            .map(|ran| (ran.case.data.degree as f64, ran.ok().map_or(f64::NAN, |errors| errors.fields)))
            .collect();
        checks.extend(exponential(&points, series.tolerance));
        quantities.extend(points.iter().filter(|(_, error)| !(*error <= ROUND_OFF)).map(|(p, error)| Quantity {
            name: format!("error fields, p = {p}"),
            value: *error,
            tolerance: 1e-4,
        }));
        let n = series.runs[0].elements;
        let name = counted(n, "element");
        rows.extend(points.iter().map(|(p, error)| vec![name.clone(), format!("{p}"), format!("{error:.2e}")]));
        let listed = plots::Series { label: name, points };
        curves.push(Curve { look: look(k), marks: Marks::Filled, ..Curve::line(k, &listed) });
    }
    let svg = Xy {
        title: Some("Error over the degree of the elements".into()),
        x: PlotAxis::linear("degree p"),
        y: PlotAxis::log("L2 error of all fields (dimensionless)"),
        curves,
        ..Xy::default()
    }
    .draw();
    let figure = Figure {
        file: format!("{}-degrees.svg", study.header.id),
        caption: "Error over the degree p on a fixed mesh: exponential, down to round-off.".into(),
        svg,
    };
    let summary = checks.iter().skip(1).map(|check| check.evidence.clone()).collect::<Vec<_>>().join("; ");
    let table = Table {
        title: "Error of all fields at the end over the degree".to_owned(),
        head: ["mesh", "degree p", "error"].map(str::to_owned).to_vec(),
        rows,
    };
    Outcome {
        headline: summary.clone(),
        tables: vec![table],
        figures: vec![figure],
        quantities,
        ..Outcome::new(summary, vec![], checks)
    }
}

fn exponential(points: &[(f64, f64)], factor: f64) -> [Check; 2] {
    let reached = points.iter().position(|(_, error)| *error <= ROUND_OFF);
    let last = reached.unwrap_or(points.len().saturating_sub(1));
    let fall = match (points.first(), points.get(last)) {
        (Some((p0, e0)), Some((p1, e1))) if last > 0 => (e0 / e1).powf(1.0 / (p1 - p0)),
        _ => f64::NAN,
    };
    let monotone = points.iter().zip(points.iter().skip(1)).take(last).all(|(one, next)| next.1 < one.1);
    let rest = points.iter().skip(last).all(|(_, error)| *error <= ROUND_OFF);
    let end = points.get(last).map_or(f64::NAN, |(p, _)| *p);
    [
        Check::that(
            fall >= factor && monotone,
            format!("the error falls with every degree, {factor} times on average"),
            format!("{fall:.1} times a degree, up to p = {end}"),
        ),
        Check::that(
            reached.is_some() && rest,
            format!("it reaches round-off, {ROUND_OFF:e}, and stays there"),
            format!("error at most {ROUND_OFF:e} from p = {end} on"),
        ),
    ]
}
