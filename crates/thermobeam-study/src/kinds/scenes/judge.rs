//! A check for each scene: its end, and the distance to its answer.

use convergence_study::plots::{self, Axis, History, Series};
use convergence_study::study::levels::completion;
use convergence_study::study::{Check, Figure, Outcome, Quantity, Ran, Table};
use convergence_study::text::number::{max_or_nan, short_text};

use super::{COUNTS, NUMBERS, Scenes, Shown, Whole};
use crate::kinds::energy::End;

/// Relative change of a number that the baseline tolerates. Iterations stop at a tolerance of 1e-10 or more, and may stop one
/// earlier where rounding differs.
const TOLERANCE: f64 = 1e-7;

/// The same of a count: below 50 it must be equal.
const COUNT_TOLERANCE: f64 = 0.02;

pub(super) fn judge(study: &Scenes, ran: &[Ran<usize, Shown>]) -> Outcome {
    let found: Vec<(&Whole, &Shown)> =
        ran.iter().filter_map(|ran| Some((&study.scenes[ran.case.data], ran.ok()?))).collect();
    let mut checks = vec![completion(ran, not_finite)];
    checks.extend(found.iter().map(|(whole, shown)| check(whole, shown)));
    let compared = found.iter().filter(|(_, shown)| shown.alike_in_lanes.is_some()).count();
    let apart =
        found.iter().filter(|(_, shown)| shown.alike_in_lanes == Some(false)).map(|(whole, _)| whole.name.as_str());
    let apart: Vec<&str> = apart.collect();
    let evidence = format!("{compared} compared, {} with other bits: {}", apart.len(), apart.join(", "));
    checks.push(Check::that(
        compared > 0 && apart.is_empty(),
        "in lanes, in a group that is not full, each scene that can run so has the same bits",
        evidence,
    ));
    let answered = found.iter().filter(|(whole, _)| !whole.answer.is_empty());
    let strain = answered.map(|(whole, shown)| farthest(whole, shown).1 / whole.within).fold(0.0, max_or_nan);
    let headline =
        format!("{} scenes, at most {strain:.2} of the distance allowed to an independent answer", found.len());
    Outcome {
        tables: vec![table(&found)],
        figures: vec![figure(study, &found)],
        quantities: found.iter().flat_map(|(whole, shown)| quantities(whole, shown)).collect(),
        headline: headline.clone(),
        ..Outcome::new(headline, vec![], checks)
    }
}

/// Names of the numbers that are not finite; a run without a step has no change of the energy.
fn not_finite(shown: &Shown) -> Vec<String> {
    let numbers =
        NUMBERS.iter().zip(shown.numbers).take(if shown.counts[0] == 0 { NUMBERS.len() - 1 } else { NUMBERS.len() });
    numbers.filter(|(_, value)| !value.is_finite()).map(|(name, _)| (*name).to_owned()).collect()
}

/// The number that is farthest from its answer, and how far; NaN is farthest.
fn farthest(whole: &Whole, shown: &Shown) -> (&'static str, f64) {
    let mut farthest = ("none", 0.0);
    for &(name, expected) in &whole.answer {
        let found = NUMBERS.iter().position(|number| *number == name).map_or(f64::NAN, |place| shown.numbers[place]);
        let distance = (found - expected).abs();
        if !(distance <= farthest.1) {
            farthest = (name, distance);
        }
    }
    farthest
}

fn check(whole: &Whole, shown: &Shown) -> Check {
    let (name, distance) = farthest(whole, shown);
    let holds = shown.end == whole.end && (whole.end != End::Answer || distance <= whole.within);
    let evidence = if shown.end == End::Answer {
        format!("{name} is {} from its answer, {:e} allowed", short_text(distance), whole.within)
    } else {
        format!("{} after {} steps", shown.end.name(), shown.counts[0])
    };
    Check::that(holds, format!("{}: {}", whole.name, whole.claim), evidence)
}

/// All numbers and counts of a run, but for a change of the energy that is none.
fn quantities(whole: &Whole, shown: &Shown) -> Vec<Quantity> {
    let quantity =
        |name: &str, value: f64, tolerance: f64| Quantity { name: format!("{}: {name}", whole.name), value, tolerance };
    let numbers = NUMBERS.iter().zip(shown.numbers).filter(|(_, value)| value.is_finite());
    let numbers = numbers.map(|(name, value)| quantity(name, value, TOLERANCE));
    let counts = COUNTS.iter().zip(shown.counts).map(|(name, count)| quantity(name, count as f64, COUNT_TOLERANCE));
    numbers.chain(counts).collect()
}

fn table(found: &[(&Whole, &Shown)]) -> Table {
    let head = ["scene", "scheme", "solver", "end", "farthest from its answer", "by"].into_iter().chain(COUNTS);
    let row = |(whole, shown): &(&Whole, &Shown)| {
        let (scheme, solver) = (whole.scene.method.name(), whole.scene.method.solver());
        let (name, distance) = farthest(whole, shown);
        let by = if whole.answer.is_empty() { "-".to_owned() } else { format!("{distance:.1e}") };
        let cells = [whole.name.as_str(), scheme, solver, shown.end.name(), name, &by].map(str::to_owned);
        cells.into_iter().chain(shown.counts.map(|count| count.to_string())).collect()
    };
    Table {
        title: "Scenes against an independent implementation".to_owned(),
        head: head.map(str::to_owned).collect(),
        rows: found.iter().map(row).collect(),
    }
}

fn figure(study: &Scenes, found: &[(&Whole, &Shown)]) -> Figure {
    let drawn = found.iter().filter(|(whole, _)| whole.end == End::Answer);
    let series = drawn.map(|(whole, shown)| Series { label: whole.name.clone(), points: shown.tip.clone() });
    Figure {
        file: format!("{}-tip.svg", study.header.id),
        caption: "Displacement of the free end in the scenes that end with an answer.".to_owned(),
        svg: plots::history(&History {
            y: Axis::linear("displacement u(1, t) (dimensionless)"),
            series: series.collect(),
            ..History::default()
        }),
    }
}
