//! Of every coefficient some study must detect an error as small as the file says.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::levels::completion;
use convergence_study::study::{Check, Outcome, Quantity, Ran, Table};

use super::{Coefficient, Sensitivity, coefficients};

/// The outcome of one case.
enum Cell {
    /// The study does not have the coefficient, or has it zero.
    Absent,
    Failed,
    OutOfRange,
    Smallest(f64),
}

impl Cell {
    fn of(study: usize, key: &str, ran: &[Ran<Coefficient, Option<f64>>]) -> Self {
        let case = ran.iter().find(|ran| ran.case.data.study == study && ran.case.data.key == key);
        match case.map(|case| &case.found) {
            None => Cell::Absent,
            Some(Err(_)) => Cell::Failed,
            Some(Ok(None)) => Cell::OutOfRange,
            Some(Ok(Some(smallest))) => Cell::Smallest(*smallest),
        }
    }

    fn text(&self) -> String {
        match self {
            Cell::Absent => "n/a".to_owned(),
            Cell::Failed => "failed".to_owned(),
            Cell::OutOfRange => "not in the range".to_owned(),
            Cell::Smallest(smallest) => format!("{smallest:.1e}"),
        }
    }
}

pub(super) fn judge(study: &Sensitivity, ran: &[Ran<Coefficient, Option<f64>>]) -> Outcome {
    let mut checks = vec![completion(ran, not_finite)];
    let (mut rows, mut quantities) = (vec![], vec![]);
    for key in coefficients() {
        let cells: Vec<Cell> = (0..study.studies.len()).map(|k| Cell::of(k, key, ran)).collect();
        let best = best(&cells);
        let claim = format!("{key} off by {:e} is detected", study.at_most);
        checks.push(Check::that(best <= study.at_most, claim, format!("detected from {best:.1e} on")));
        quantities.push(Quantity { name: format!("smallest {key} seen"), value: best, tolerance: 0.2 });
        rows.push([vec![key.to_owned()], cells.iter().map(Cell::text).collect()].concat());
    }
    let holds = checks.iter().all(|check| check.verdict == Verdict::Pass);
    let summary = if holds {
        format!("every coefficient off by {:e} is detected, most from far less", study.at_most)
    } else {
        format!("some coefficient off by {:e} is not detected", study.at_most)
    };
    let head = ["coefficient"].into_iter().chain(study.studies.iter().map(|spec| spec.header.id.as_str()));
    let table = Table {
        title: "Smallest relative error that makes the study fail; n/a: coefficient absent or zero".to_owned(),
        head: head.map(str::to_owned).collect(),
        rows,
    };
    Outcome { headline: summary.clone(), tables: vec![table], quantities, ..Outcome::new(summary, vec![], checks) }
}

fn not_finite(smallest: &Option<f64>) -> Vec<String> {
    let finite = smallest.is_none_or(f64::is_finite);
    if finite { vec![] } else { vec!["the smallest error".to_owned()] }
}

/// The smallest error that some study detects; NaN where a case failed or no study has the coefficient, infinite where
/// none detects it within the range.
fn best(cells: &[Cell]) -> f64 {
    let number = |cell: &Cell| match cell {
        Cell::Absent => None,
        Cell::Failed => Some(f64::NAN),
        Cell::OutOfRange => Some(f64::INFINITY),
        Cell::Smallest(smallest) => Some(*smallest),
    };
    let smaller = |a: f64, b: f64| if a.is_nan() || a < b { a } else { b };
    cells.iter().filter_map(number).reduce(smaller).unwrap_or(f64::NAN)
}
