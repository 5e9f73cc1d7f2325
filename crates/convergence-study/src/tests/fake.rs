//! Small studies with a prescribed behaviour.

use std::fmt::Display;
use std::num::NonZeroUsize;
use std::path::Path;

use crate::{
    Case, CaseFailure, Check, Described, Figure, Finished, Header, Kind, LevelErrors, Must,
    NamedNumber, NamedRate, Outcome, Project, Ran, Study, Table, Tier, Verdict, VerifyRequest, run,
    study::Quantity, verify::Scope,
};
use convergence_judge::{time_limit::Patience, verdict};

/// The project of these studies; none of them is read from a file.
pub(crate) const PROJECT: Project = Project::new("fakes", "cargo xtask");

/// What the cases of a study do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Does {
    /// Errors of first order.
    Converge,
    /// Errors that do not change.
    Stay,
    /// First order, but the second case returns NaN.
    NotANumber,
    /// First order, but the second case returns an error.
    Fail,
    /// First order, but the second case panics.
    Panic,
    /// First order, but the second case runs until its time limit stops it, and then returns its
    /// error regardless.
    Dawdle,
    /// Judging the results panics.
    PanicAtTheEnd,
    /// First order on too few levels.
    TooShort,
    /// Nothing is judged, but a pass is claimed.
    Nothing,
    /// First order, with two figures of one name: no report can be made of it.
    DrawTwice,
}

pub(crate) struct Fake {
    pub(crate) header: Header,
    pub(crate) does: Does,
    pub(crate) scale: f64,
    pub(crate) tolerance: f64,
    pub(crate) claim: Option<Must>,
    pub(crate) quantity: &'static str,
}

pub(crate) fn fake(id: &str, does: Does) -> Fake {
    let header = Header {
        kind: "fake".to_owned(),
        ..Header::new(id, "errors | fall < with *h*")
    };
    Fake {
        header,
        does,
        scale: 1.0,
        tolerance: 1e-3,
        claim: None,
        quantity: "finest error",
    }
}

/// Errors of first order.
pub(crate) fn converging(id: &str) -> Fake {
    fake(id, Does::Converge)
}

/// The same, ready to run.
pub(crate) fn passing(id: &str) -> Box<dyn Study> {
    converging(id).erased()
}

pub(crate) fn study(id: &str, does: Does) -> Box<dyn Study> {
    fake(id, does).erased()
}

impl Fake {
    /// With errors that are so many times as large.
    pub(crate) fn scaled(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// With this claim of its number.
    pub(crate) fn claiming(self, claim: Option<Must>) -> Self {
        Self { claim, ..self }
    }

    pub(crate) fn erased(self) -> Box<dyn Study> {
        Described::boxed(self.header.clone(), self)
    }
}

impl Kind for Fake {
    /// The level.
    type Data = usize;
    /// The error.
    type Found = f64;

    fn cases(&self) -> Vec<Case<usize>> {
        let levels = if self.does == Does::TooShort { 2 } else { 5 };
        (0..levels)
            .map(|i| Case::new(format!("n = {}", 8 << i), f64::from(8 << i), i))
            .collect()
    }

    fn run(&self, &level: &usize) -> Result<f64, CaseFailure> {
        let error = self.scale * 0.3 / f64::from(8 << level);
        match (self.does, level) {
            (Does::Stay, _) => Ok(self.scale),
            (Does::NotANumber, 1) => Ok(f64::NAN),
            (Does::Fail, 1) => Err(CaseFailure::new("step 3 | t = 0.1: diverged")),
            (Does::Panic, 1) => panic!("a pivot of {error} was lost"),
            (Does::Dawdle, 1) => {
                step_until_stopped();
                Ok(error)
            }
            _ => Ok(error),
        }
    }

    fn judge(&self, ran: &[Ran<usize, f64>]) -> Outcome {
        if self.does == Does::PanicAtTheEnd {
            panic!("no conclusion");
        }
        if self.does == Does::Nothing {
            return Outcome {
                verdict: Verdict::Pass,
                ..Outcome::new("all well", vec![], vec![])
            };
        }
        let errors: Vec<f64> = ran
            .iter()
            .map(|ran| ran.ok().copied().unwrap_or(f64::NAN))
            .collect();
        let pairs = errors
            .iter()
            .enumerate()
            .map(|(i, error)| (1.0 / f64::from(8 << i), *error));
        let rate = verdict::judge_pairs(pairs, 1.0, 0.1);
        let level = |(i, error): (usize, &f64)| LevelErrors {
            parameters: vec![
                NamedNumber::new("elements", f64::from(8 << i)),
                NamedNumber::new("steps", 20.0),
            ],
            step: Some(1.0 / f64::from(8 << i)),
            work: None,
            errors: vec![NamedNumber::new("velocity", *error)],
            without: vec![],
        };
        let finest = *errors.last().unwrap();
        let quantity = Quantity::new(self.quantity, finest, self.tolerance).claimed(self.claim);
        let table = Table {
            title: "Two | three".into(),
            head: vec!["a|b".into()],
            rows: vec![vec!["c|d".into()]],
        };
        let svg = if self.scale == 1.0 {
            "<svg/>".to_owned()
        } else {
            format!("<svg>{}</svg>", self.scale)
        };
        let figure = Figure::new("errors", "errors | h", svg);
        let figures = match self.does {
            Does::DrawTwice => vec![figure.clone(), figure],
            _ => vec![figure],
        };
        Outcome {
            levels: errors.iter().enumerate().map(level).collect(),
            quantities: vec![quantity],
            tables: vec![table],
            figures,
            ..Outcome::new(
                rate.reason.clone(),
                vec![NamedRate::new("velocity", rate)],
                vec![Check::that(
                    finest < 10.0,
                    "|error| < 10",
                    format!("{finest:.1e}"),
                )],
            )
        }
    }
}

/// A computation of hours in short steps; returns when the time limit is reached.
fn step_until_stopped() {
    let mut patience = Patience::new(100);
    for step in 0.. {
        if patience.check(step, || 1e-8 * step as f64).is_err() {
            return;
        }
    }
}

pub(crate) fn jobs(count: usize) -> NonZeroUsize {
    NonZeroUsize::new(count).unwrap()
}

/// Runs on two threads.
pub(crate) fn finished(studies: Vec<Box<dyn Study>>) -> Vec<Finished> {
    run::run(&studies, jobs(2), &|_| {}).unwrap()
}

/// Headers of studies with these ids, with their cases.
pub(crate) fn ids(ids: &[&str]) -> Vec<Header> {
    ids.iter()
        .map(|id| run::listed(study(id, Does::Converge).as_ref()))
        .collect()
}

/// A verification of the quick tier with these known studies.
pub(crate) fn request(root: &Path, known: &[&str]) -> VerifyRequest {
    let scope = Scope::Tier(Tier::Quick, ids(known));
    VerifyRequest {
        scope,
        effort: jobs(2).into(),
        bless: false,
        loosened: false,
        root: root.to_owned(),
        reports: root.join("reports"),
    }
}

/// Whether a text has these words.
#[track_caller]
pub(crate) fn says(text: impl Display, words: &str) {
    let text = text.to_string();
    assert!(text.contains(words), "{words}: {text}");
}
