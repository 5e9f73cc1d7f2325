//! The report of the benchmark, from its record.

use convergence_study::{Table, internal::report};
use thermobeam_study::error::ErrorMeasure;
use thermobeam_study::kinds::work_precision::compared::{self, Costed, cheapest};
use thermobeam_study::kinds::work_precision::method::METHODS;

use super::record::{Cost, Record};

/// The problems: the study that has it, and its name in words.
pub(super) const PROBLEMS: [(&str, &str); 2] = [
    (
        "work-precision-paper",
        "the paper's first experiment over [0, 1]",
    ),
    ("work-precision-manufactured", "the manufactured solution"),
];

/// The method of high order.
const DG: &str = "dg";

/// Costs differ clearly if their ratio is larger: times of the same run differ by some per cent.
const CLEARLY: f64 = 1.1;

/// The library, whose runs are made by hand.
pub(super) const LIBRARY: &str = "CVODE";

/// Errors in the norm of Theorem 3.4: half decades.
const NORM_TARGETS: [f64; 9] = [1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5];
/// Errors of u(1, t): decades.
const TIP_TARGETS: [f64; 8] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// A reference is so many times better than the targets.
const BETTER: f64 = 10.0;

/// Rows and columns of the short table, on the first problem.
const SHORT: [(ErrorMeasure, f64); 7] = [
    (ErrorMeasure::Tip, 1e-3),
    (ErrorMeasure::Tip, 1e-5),
    (ErrorMeasure::Tip, 1e-7),
    (ErrorMeasure::Tip, 1e-9),
    (ErrorMeasure::Theorem34, 1e-2),
    (ErrorMeasure::Theorem34, 1e-3),
    (ErrorMeasure::Theorem34, 1e-4),
];
const SHORT_METHODS: [&str; 5] = [
    "fixed-point",
    "euler-crank-nicolson",
    "midpoint",
    "dg",
    LIBRARY,
];

/// A figure: file name, caption, picture.
pub(super) struct Drawing {
    /// Name of the file.
    pub(super) file: String,
    /// What it shows.
    pub(super) caption: String,
    /// The picture.
    pub(super) svg: String,
}

fn targets(measure: ErrorMeasure) -> &'static [f64] {
    match measure {
        ErrorMeasure::Theorem34 => &NORM_TARGETS,
        ErrorMeasure::Tip => &TIP_TARGETS,
    }
}

fn names() -> Vec<&'static str> {
    let own = METHODS.iter().map(|method| method.name);
    own.chain([LIBRARY]).collect()
}

/// The name of a method in tables and figures.
fn in_words(name: &str) -> &str {
    let own = METHODS.iter().find(|method| method.name == name);
    own.map_or(name, |method| method.in_words)
}

/// Two significant digits, without an exponent where that is readable.
fn seconds_text(seconds: f64) -> String {
    let digits = (1.0 - seconds.log10().floor()).max(0.0) as usize;
    if seconds < 9.5e-4 {
        format!("{seconds:.1e}")
    } else {
        format!("{seconds:.digits$}")
    }
}

fn is_known(record: &Record, problem: &str, measure: ErrorMeasure, target: f64) -> bool {
    let apart = record.references.get(problem);
    apart.is_some_and(|apart| BETTER * apart[measure as usize] <= target)
}

/// The short table, in seconds.
pub(super) fn short(record: &Record) -> Table {
    let (problem, in_problem) = PROBLEMS[0];
    let mut rows = vec![];
    for (measure, target) in SHORT {
        let runs = record.costed(problem, measure, Cost::Seconds);
        let mut row = vec![format!("{}, {target:e}", measure.in_words())];
        for name in SHORT_METHODS {
            row.push(match cheapest(&runs, name, target) {
                Some(run) => seconds_text(run.cost),
                None => "-".to_owned(),
            });
        }
        rows.push(row);
    }
    let title = format!("In short: CPU seconds for an error, {in_problem}");
    let head = ["error in"]
        .into_iter()
        .chain(SHORT_METHODS.iter().map(|name| in_words(name)));
    Table::new(title, head, rows)
}

/// The fastest discretisation for each error that the reference can judge.
fn fastest(record: &Record, problem: (&str, &str), measure: ErrorMeasure) -> Table {
    let runs = record.costed(problem.0, measure, Cost::Seconds);
    let present: Vec<&str> = names()
        .into_iter()
        .filter(|name| runs.iter().any(|run| run.method == *name))
        .collect();
    let mut rows = vec![];
    for &target in targets(measure) {
        if !is_known(record, problem.0, measure, target) {
            continue;
        }
        let mut row = vec![format!("{target:e}")];
        for name in &present {
            row.push(match cheapest(&runs, name, target) {
                Some(run) => format!("{} ({})", seconds_text(run.cost), run.resolution),
                None => "-".to_owned(),
            });
        }
        rows.push(row);
    }
    let title = format!(
        "Error in {}, {}: CPU seconds of the fastest run (elements x steps, or degrees and step)",
        measure.in_words(),
        problem.1
    );
    let head = ["error"]
        .into_iter()
        .chain(present.iter().map(|name| in_words(name)));
    Table::new(title, head, rows)
}

/// The smallest error of each method within the limit.
fn smallest(record: &Record, problem: (&str, &str)) -> Table {
    let mut rows = vec![];
    for name in names() {
        let mut runs = record.runs.iter();
        if runs.any(|run| run.problem == problem.0 && run.method == name) {
            let mut row = vec![in_words(name).to_owned()];
            row.extend(ErrorMeasure::ALL.map(|measure| best(record, problem.0, name, measure)));
            rows.push(row);
        }
    }
    let title = format!("The smallest error of each method, {}", problem.1);
    let head = ["method"]
        .into_iter()
        .chain(ErrorMeasure::ALL.map(ErrorMeasure::in_words));
    Table::new(title, head, rows)
}

/// The run of a method with the smallest error, in words.
fn best(record: &Record, problem: &str, method: &str, measure: ErrorMeasure) -> String {
    let runs = record.costed(problem, measure, Cost::Seconds);
    let own = runs.into_iter().filter(|run| run.method == method);
    let best: Option<Costed> = own.min_by(|a, b| a.error.total_cmp(&b.error));
    match best {
        Some(run) => format!(
            "{:.1e} ({} s, {})",
            run.error,
            seconds_text(run.cost),
            run.resolution
        ),
        None => "-".to_owned(),
    }
}

/// The largest of the `targets`, which decrease, such that for it and each smaller one that any
/// method reaches `method` is clearly the cheapest; `None` if there is none.
fn cheapest_from(runs: &[Costed], method: &str, targets: &[f64]) -> Option<f64> {
    let mut from = None;
    for &target in targets.iter().rev() {
        let cost = |name: &str| cheapest(runs, name, target).map(|run| run.cost);
        let others = names().into_iter().filter(|name| *name != method);
        let least = others.filter_map(cost).reduce(f64::min);
        match (cost(method), least) {
            (None, None) => {}
            (Some(own), least) if least.is_none_or(|least| CLEARLY * own < least) => {
                from = Some(target);
            }
            _ => return from,
        }
    }
    from
}

fn drawing(record: &Record, problem: (&str, &str), measure: ErrorMeasure, cost: Cost) -> Drawing {
    let (what, axis, seen) = match cost {
        Cost::Seconds => ("seconds", "run time (CPU seconds)", "dG is the fastest"),
        Cost::Work => (
            "work",
            "counted work (elements × linear solves)",
            "dG needs the least work",
        ),
    };
    let runs = record.costed(problem.0, measure, cost);
    let title = match cheapest_from(&runs, DG, targets(measure)) {
        Some(error) => format!("Error in {}: {seen} up to {error:e}", measure.in_words()),
        None => format!("Error in {}", measure.in_words()),
    };
    let error = "largest error (dimensionless)";
    let svg = compared::figure(&title, axis, error, &runs, &names());
    let file = format!("{}-{}-{what}.svg", problem.0, measure.name());
    let caption = format!(
        "{}: error in {} over {axis}; for each method the runs that no other run of it beats",
        problem.1,
        measure.in_words()
    );
    Drawing { file, caption, svg }
}

/// The part of the report on run time against error, with its figures.
pub(super) fn accuracy(record: &Record) -> (String, Vec<Drawing>) {
    let mut drawings = vec![];
    let short = short(record);
    let mut text = format!("## {}\n\n{}\n", short.title, report::markdown(&short));
    for problem in PROBLEMS {
        for measure in ErrorMeasure::ALL {
            let table = fastest(record, problem, measure);
            text += &format!("## {}\n\n{}\n", table.title, report::markdown(&table));
            for cost in [Cost::Seconds, Cost::Work] {
                let drawing = drawing(record, problem, measure, cost);
                text += &format!("![{}](bench/{})\n\n", drawing.caption, drawing.file);
                drawings.push(drawing);
            }
        }
        let table = smallest(record, problem);
        text += &format!("## {}\n\n{}\n", table.title, report::markdown(&table));
        if let Some([norm, tip]) = record
            .references
            .get(problem.0)
            .filter(|apart| apart[0] > 0.0)
        {
            text += &format!(
                "The reference is a run of any order. Another one, of different elements, degrees and steps, is {norm:.1e} away in the \
                 norm of Theorem 3.4 and {tip:.1e} in u(1, t); only errors ten times larger are shown.\n\n"
            );
        }
    }
    (text, drawings)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(method: &str, error: f64, cost: f64) -> Costed {
        Costed {
            method: method.to_owned(),
            resolution: String::new(),
            error,
            cost,
        }
    }

    /// At 1e-1 midpoint is cheaper, at 1e-2 the costs are alike, and 1e-5 nothing reaches.
    #[test]
    fn the_error_from_which_on_a_method_is_cheapest_is_found_from_below() {
        let mut runs = vec![
            run(DG, 1e-2, 2.0),
            run(DG, 1e-4, 3.0),
            run("midpoint", 1e-1, 1.0),
            run("midpoint", 1e-2, 2.1),
            run("midpoint", 1e-3, 9.0),
        ];
        let targets = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];
        assert_eq!(cheapest_from(&runs, DG, &targets), Some(1e-3));
        assert_eq!(cheapest_from(&runs, "midpoint", &targets), None);
        runs.push(run("midpoint", 1e-4, 2.0));
        assert_eq!(cheapest_from(&runs, DG, &targets), None);
    }
}
