//! Milliseconds and error of runs of any order, over degrees and steps: for benchmarks, since times vary.

use std::time::Duration;

use convergence_study::study::{CaseFailure, Table};
use thermobeam::dg::Stepping;
use thermobeam::mesh::Mesh;

use super::any_order::{AnyOrderRun, run_at};
use crate::error::curve::distance;
use crate::scene::{Method, Scene};

/// Runs of which the fastest counts: other load on the machine only makes a run slower.
const REPEATS: usize = 5;

/// Times at which u(1, t) is compared, inside steps as well as at their ends.
const TIMES: usize = 2000;

/// Elements that grow towards x = 0: the last one holds the layer of an impact.
const GRADED: [f64; 3] = [0.0, 0.9, 1.0];

/// Degrees p and q and the largest step; the others follow from it.
const WAYS: [(usize, usize, f64); 9] = [
    (8, 1, 0.02),
    (10, 1, 0.02),
    (12, 2, 0.02),
    (12, 2, 0.01),
    (14, 3, 0.02),
    (14, 3, 0.01),
    (16, 4, 0.008),
    (18, 5, 0.006),
    (20, 5, 0.004),
];

/// Degrees and largest step of the run that the others are compared with.
pub(crate) const REFERENCE: (usize, usize, f64) = (26, 5, 0.0021);

/// The first step over the largest, and the growth for a largest step of 0.02; finer steps grow more slowly.
const RESTART: f64 = 0.05;
const GROWTH: f64 = 0.5;
const COARSE: f64 = 0.02;

/// Error and time of a scene over [0, `t_end`], for several degrees and steps.
///
/// # Errors
/// [`CaseFailure`] of a run that does not come to its end.
pub fn times(scene: &Scene, t_end: f64) -> Result<Table, CaseFailure> {
    let exact = finished(&by(scene, REFERENCE, t_end)?, TIMES)?;
    let exact_tip = exact.tip();
    let mut rows = vec![];
    for way in WAYS {
        let scene = by(scene, way, t_end)?;
        let found = finished(&scene, TIMES)?;
        let over_time = distance(&found.tip(), &exact_tip);
        let at_end = (found.ends[1].u_tip - exact.ends[1].u_tip).abs();
        let mut best = Duration::MAX;
        for _ in 0..REPEATS {
            best = best.min(finished(&scene, 0)?.wall);
        }
        let (p, q, dt) = way;
        rows.push(vec![
            p.to_string(),
            q.to_string(),
            format!("{dt}"),
            found.steps.to_string(),
            found.work.solves.to_string(),
            found.work.factorizations.to_string(),
            format!("{at_end:.1e}"),
            format!("{over_time:.1e}"),
            format!("{:.2}", 1e3 * best.as_secs_f64()),
        ]);
    }
    let head = [
        "p",
        "q",
        "largest step",
        "steps",
        "solves",
        "factorizations",
        "error of u(1) at the end",
        "error of u(1, t)",
        "ms",
    ];
    let title = format!(
        "dG(q) on two elements of degree p, to t = {t_end}: error against a finer run, inside steps included, and time"
    );
    Ok(Table { title, head: head.map(str::to_owned).to_vec(), rows })
}

pub(crate) fn by(scene: &Scene, (degree, q, dt): (usize, usize, f64), t_end: f64) -> Result<Scene, CaseFailure> {
    let growth = 1.0 + GROWTH * dt / COARSE;
    let stepping = Stepping { degree: q, dt, restart_dt: RESTART * dt, growth, ..Stepping::default() };
    let mesh = Mesh::from_nodes(GRADED.to_vec())?;
    Ok(Scene { mesh, degree, method: Method::Dg(stepping), t_end, ..scene.clone() })
}

pub(crate) fn finished(scene: &Scene, times: usize) -> Result<AnyOrderRun, CaseFailure> {
    let run = run_at(scene, &[], &mut |_, _| (), times, &mut |_| ())?;
    match run.failure {
        Some(failure) => Err(failure.into()),
        None => Ok(run),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use convergence_study::input::read_text;

    #[test]
    fn errors_fall_to_ten_digits_down_the_table() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../studies/scenes/paper-1-beta-0.toml");
        let text = read_text(path.as_ref()).expect("the scene");
        let scene = Scene::parse(&text, path).expect("a scene");
        let table = times(&scene, 0.5).expect("a table");
        assert_eq!(table.rows.len(), WAYS.len());
        assert!(table.rows.iter().all(|row| row.len() == table.head.len()));
        let errors: Vec<f64> = table.rows.iter().map(|row| row[7].parse().expect("a number")).collect();
        assert!(errors[0] < 1e-3 && errors[0] > 1e-7 && errors[WAYS.len() - 1] < 1e-9, "{errors:?}");
        assert!(table.rows.iter().all(|row| row[8].parse::<f64>().is_ok_and(|ms| ms > 0.0)));
    }
}
