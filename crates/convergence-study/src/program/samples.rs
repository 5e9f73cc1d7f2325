//! From runs with several seeds to one answer for each level.

use super::answer::Answer;
use super::judge::names;
use super::{CaseRun, Program};
use crate::study::sampled::{Sampled, SampledLevel};
use crate::study::{Case, CaseFailure, Ran};
use crate::text::number::counted;
use convergence_judge::verdict::Of;

/// One answer for each level, whose errors are made of its samples; and these samples. A level of
/// which a sample has failed has none.
///
/// * `count`: how many samples a level has, which follow each other.
pub(super) fn levels(study: &Program, ran: &[CaseRun], count: usize) -> (Vec<CaseRun>, Sampled) {
    let answers: Vec<Result<Vec<&Answer>, CaseFailure>> = ran.chunks(count).map(whole).collect();
    let resolutions = study.refine.resolutions();
    let levels = resolutions.iter().zip(&answers);
    let levels = levels.map(|(data, answers)| SampledLevel {
        label: data.label.clone(),
        samples: match answers {
            Ok(answers) => Ok(answers.iter().map(|one| one.errors.clone()).collect()),
            Err(failure) => Err(failure.clone()),
        },
    });
    let sampled = Sampled(levels.collect());
    let made = sampled.errors(&|name| study.of(name));
    let levels = resolutions.into_iter().zip(answers).zip(made);
    let levels = levels.map(|((data, answers), errors)| Ran {
        found: answers.and_then(|answers| {
            Ok(Answer {
                errors: errors?,
                ..of_all(&answers)
            })
        }),
        case: Case::new(data.label.clone(), data.cost(), data),
    });
    (levels.collect(), sampled)
}

/// The answers of a level, which have the same step.
fn whole(samples: &[CaseRun]) -> Result<Vec<&Answer>, CaseFailure> {
    let failed = samples.iter().filter_map(|ran| match &ran.found {
        Err(failure) => Some((ran, failure)),
        Ok(answer) => Some((ran, answer.failure.as_ref()?)),
    });
    let failed: Vec<_> = failed.collect();
    if let Some((ran, failure)) = failed.first() {
        let all = counted(samples.len(), "sample");
        let count = failed.len();
        let reason = format!(
            "{count} of {all} failed: {}: {}",
            ran.case.label, failure.reason
        );
        return Err(CaseFailure {
            reason,
            ..(*failure).clone()
        });
    }
    let answers: Vec<&Answer> = samples.iter().filter_map(CaseRun::ok).collect();
    if answers
        .windows(2)
        .any(|pair| (pair[0].h, pair[0].dt) != (pair[1].h, pair[1].dt))
    {
        let reason = "its samples answer different steps; expected one step of a level";
        return Err(CaseFailure::new(reason));
    }
    let mut pairs = answers.windows(2);
    if let Some(pair) = pairs.find(|pair| names(pair[0]).ne(names(pair[1]))) {
        let [one, other] = [pair[0], pair[1]].map(|answer| {
            let names: Vec<&str> = names(answer).collect();
            names.join(", ")
        });
        let reason = format!("its samples answer different errors: {one} and {other}");
        return Err(CaseFailure::new(reason));
    }
    Ok(answers)
}

/// Step, time and work of a level; the errors are those of its first sample.
fn of_all(answers: &[&Answer]) -> Answer {
    let work: Option<f64> = answers.iter().map(|answer| answer.work).sum();
    let first = answers.first().map(|answer| (*answer).clone());
    Answer {
        values: vec![],
        work,
        seconds: answers.iter().map(|answer| answer.seconds).sum(),
        ..first.unwrap_or_default()
    }
}

impl Program {
    /// How samples make the error of a name of which an order is claimed.
    pub(super) fn of(&self, name: &str) -> Option<Of> {
        let mut expected = self.expect.iter();
        expected.find(|one| one.name == name).map(|one| one.of)
    }
}
