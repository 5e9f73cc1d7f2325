//! From answers to an outcome: a check for each derivative and direction, their numbers, and the
//! remainders as a figure.

use std::collections::HashSet;

use super::{Direction, StepCase, Taylor, Values};
use crate::chart::{self, Chart, Series};
use crate::study::over_levels::ERROR_TOLERANCE;
use crate::study::{Check, Figure, Measured, Must, Outcome, Ran, Sheet, Subject, measured};
use crate::text::number::{counted, decimals};
use convergence_judge::taylor::Judged;
use convergence_judge::verdict::Verdict;

pub(super) fn judge(study: &Taylor, ran: &[Ran<StepCase, Values>]) -> Outcome {
    let completion = Check::completion(ran, |_| vec![]);
    let all = study.directions(ran);
    if all.is_empty() {
        let words = "no direction has a J at every step, so nothing is judged";
        return Outcome::new(words, vec![], vec![completion]);
    }
    // Those in which a derivative is zero tell nothing, if there are enough others.
    let (zero, tell): (Vec<_>, Vec<_>) = all.into_iter().partition(Direction::vanishes);
    let drawn_anew = if tell.len() >= study.directions {
        zero.len()
    } else {
        0
    };
    let judged: Vec<Direction> = if drawn_anew > 0 {
        tell
    } else {
        let mut both: Vec<Direction> = tell.into_iter().chain(zero).collect();
        both.sort_by_key(|direction| direction.seed);
        both
    };
    let mut checks = vec![completion];
    checks.extend(judged.iter().flat_map(|one| study.checks(one)));
    let different = different(&judged);
    if study.has_seed && different < judged.len() {
        let evidence = format!(
            "the derivatives have the same size in some of them, {different} of {} differ: expected a program \
             that draws d by `{{seed}}`, or `directions = {different}`",
            judged.len()
        );
        let claim = "the directions differ";
        checks.push(Check::new(Verdict::Inconclusive, claim, evidence).about(Subject::of("seed")));
    }
    let numbers = judged.iter().flat_map(|one| study.measured(one));
    let sheet = Sheet::new("Derivatives", study.first(), numbers);
    let mut outcome =
        Outcome::of_judged_sheet(summary(&judged, drawn_anew, different), checks, sheet);
    // The report that is committed has no digits of round-off.
    if outcome.verdict.is_pass() {
        let directions = counted(judged.len(), "direction");
        let names = if study.second {
            "dJ·d and d'Hd are"
        } else {
            "dJ·d is"
        };
        outcome.headline = format!("{names} right to {:e} in {directions}", study.to).into();
    }
    outcome.figures.push(figure(study, &judged));
    outcome
}

/// The number of directions that differ: along d and -d the derivatives have the same size, and so
/// they have in all of them where a program does not use its seed.
fn different(judged: &[Direction]) -> usize {
    let sizes = judged.iter().map(|direction| {
        let derivatives = direction.derivatives.iter();
        let sizes = derivatives.map(|one| one.size.claimed.abs().to_bits());
        sizes.collect::<Vec<_>>()
    });
    sizes.collect::<HashSet<_>>().len()
}

impl Taylor {
    /// What a row of the table is.
    fn first(&self) -> &'static str {
        if self.has_seed { "direction" } else { "" }
    }

    fn name_of(&self, direction: &Direction) -> String {
        if self.has_seed {
            format!("seed = {}", direction.seed)
        } else {
            String::new()
        }
    }

    /// A check for each derivative along a direction.
    fn checks<'a>(&'a self, direction: &'a Direction) -> impl Iterator<Item = Check> + 'a {
        let case = Some(self.name_of(direction)).filter(|name| !name.is_empty());
        let left_out = match direction.left_out {
            0 => String::new(),
            count => format!("; J is not finite at {}", counted(count, "coarse step")),
        };
        direction.derivatives.iter().map(move |judged| {
            let claim = format!("{} is the derivative of J", judged.name());
            let subject = Subject {
                case: case.clone(),
                ..Subject::of(judged.name())
            };
            let evidence = format!("{judged}{left_out}");
            Check::new(judged.verdict(), claim, evidence).about(subject)
        })
    }

    /// The numbers of a direction. The answered ones are guarded: the others are of the size of
    /// round-off.
    fn measured(&self, direction: &Direction) -> Vec<Measured> {
        let case = self.name_of(direction);
        let value = measured(&case, "J", direction.value).scientific(6);
        let mut numbers = vec![value.recorded("J", ERROR_TOLERANCE)];
        for judged in &direction.derivatives {
            let name = judged.name();
            let size = &judged.size;
            let rate = judged.rate.as_ref().and_then(|rate| rate.fitted);
            let rate = rate.map_or("-".to_owned(), |rate| decimals(rate, 3));
            numbers.extend([
                measured(&case, name, size.claimed)
                    .scientific(6)
                    .recorded(name, ERROR_TOLERANCE),
                measured(&case, format!("{name} of J"), size.found).scientific(6),
                measured(&case, format!("{name} right to"), size.right_to())
                    .scientific(1)
                    .must_be(Must::AtMost(self.to)),
                measured(&case, format!("R{} rate", judged.derivative), None).words(rate),
            ]);
        }
        numbers
    }
}

/// What is known of the directions, in a sentence.
///
/// * `drawn_anew`: how many were replaced, because a derivative is zero in them.
/// * `different`: how many of them differ.
fn summary(judged: &[Direction], drawn_anew: usize, different: usize) -> String {
    let mut derivatives = judged.iter().flat_map(|one| &one.derivatives);
    let not_passed = derivatives.find(|judged| !judged.verdict().is_pass());
    let mut words = match not_passed {
        Some(judged) => judged.to_string(),
        None => {
            let parts = [1, 2].map(|derivative| worst(judged, derivative));
            let parts: Vec<String> = parts.into_iter().flatten().collect();
            format!(
                "{} in {}",
                parts.join(", "),
                counted(different, "direction")
            )
        }
    };
    if drawn_anew > 0 {
        let directions = counted(drawn_anew, "direction");
        words += &format!("; {directions} drawn anew, in which a derivative is zero");
    }
    words
}

/// What a derivative is right to in all directions, if one has it.
fn worst(judged: &[Direction], derivative: u8) -> Option<String> {
    let derivatives = judged.iter().flat_map(|one| &one.derivatives);
    let own = derivatives.filter(|one| one.derivative == derivative);
    let right_to = own.clone().map(|one| one.size.right_to());
    let name = own.clone().next().map(Judged::name)?;
    Some(format!(
        "{name} is right to {:.1e}",
        right_to.fold(0.0, f64::max)
    ))
}

/// The remainders over the steps.
fn figure(study: &Taylor, judged: &[Direction]) -> Figure {
    let mut table = chart::Columns::default();
    let mut series = vec![];
    for direction in judged {
        for one in &direction.derivatives {
            let case = study.name_of(direction);
            let separator = if case.is_empty() { "" } else { ", " };
            let name = format!("R{}{separator}{case}", one.derivative);
            let [over, of] = ["eps", "remainder"].map(|column| format!("{column}, {name}"));
            table.push(&over, one.levels.iter().map(|level| level.step));
            table.push(&of, one.levels.iter().map(|level| level.error));
            let order = f64::from(one.derivative) + 1.0;
            let errors = Series::errors(name, over, of).claiming(order);
            series.push(match &one.rate {
                Some(rate) => errors.judged(rate),
                None => errors,
            });
        }
    }
    let x = chart::Axis::log("step ε");
    let chart = Chart {
        series,
        ..Chart::new(table, x, chart::Axis::log("remainder"))
    };
    let caption =
        "Remainders of Taylor's theorem over steps, as far as they are above the noise of J.";
    Figure::of("remainders", caption, chart)
}
