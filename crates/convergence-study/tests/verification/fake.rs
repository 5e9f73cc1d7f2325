//! Studies that do as they are told.

use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::path::Path;

use convergence_study::judge::verdict;
use convergence_study::run::{self, Finished};
use convergence_study::study::case::{Case, CaseFailure, Measured};
use convergence_study::study::outcome::{Check, Figure, LevelErrors, Outcome, Quantity, Table};
use convergence_study::verify::{Request, Scope};
use thermobeam_study::scene::Scene;
use thermobeam_study::simulate::{Recording, Simulator};
use thermobeam_study::study::Study;
use thermobeam_study::study_file::{StudyHeader, Tier};

/// What the cases of a study do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Does {
    /// Errors of first order.
    Converge,
    /// Errors that stay where they are.
    Stay,
    /// First order, but the second case returns NaN.
    NotANumber,
    /// First order, but the second case returns an error.
    Fail,
    /// First order, but the second case panics.
    Panic,
    /// First order, but the second case would take hours, and does not mind being stopped.
    Dawdle,
    /// The conclusion panics.
    PanicAtTheEnd,
    /// First order on too few levels.
    TooShort,
    /// Nothing is judged, and a pass is claimed.
    Nothing,
}

pub(crate) struct Fake {
    pub(crate) header: StudyHeader,
    pub(crate) does: Does,
    pub(crate) scale: f64,
    pub(crate) tolerance: f64,
    pub(crate) quantity: &'static str,
}

pub(crate) fn fake(id: &str, does: Does) -> Fake {
    let (claim, kind) = ("errors | fall < with *h*".to_owned(), "fake".to_owned());
    let header = StudyHeader { id: id.to_owned(), claim, tier: Tier::Quick, kind };
    Fake { header, does, scale: 1.0, tolerance: 1e-3, quantity: "finest error" }
}

pub(crate) fn study(id: &str, does: Does) -> Box<dyn Study> {
    Box::new(fake(id, does))
}

impl Study for Fake {
    fn header(&self) -> &StudyHeader {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let levels = if self.does == Does::TooShort { 2 } else { 5 };
        (0..levels).map(|i| Case { label: format!("n = {}", 8 << i), cost: f64::from(8 << i) }).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let mut error = self.scale * 0.3 / f64::from(8 << index);
        match (self.does, index) {
            (Does::Stay, _) => error = self.scale,
            (Does::NotANumber, 1) => error = f64::NAN,
            (Does::Fail, 1) => return Err(CaseFailure { reason: "step 3 | t = 0.1: diverged".to_owned() }),
            (Does::Dawdle, 1) => drop(endless().run(Recording::Summary, &mut |_| ())),
            (Does::Panic, 1) => panic!("a pivot of {error} was lost"),
            _ => {}
        }
        let mut measured = Measured::default();
        measured.push("velocity", error);
        Ok(measured)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        if self.does == Does::PanicAtTheEnd {
            panic!("no conclusion");
        }
        if self.does == Does::Nothing {
            return Outcome { verdict: verdict::Verdict::Pass, ..Outcome::new("all well", vec![], vec![]) };
        }
        let errors: Vec<f64> = results
            .iter()
            .map(|result| result.as_ref().map_or(f64::NAN, |measured| measured.value("velocity")))
            .collect();
        let pairs = errors.iter().enumerate().map(|(i, error)| (1.0 / f64::from(8 << i), *error));
        let rate = verdict::judge_pairs(pairs, 1.0, 0.1);
        let level = |(i, error): (usize, &f64)| LevelErrors {
            elements: 8 << i,
            steps: 20,
            errors: vec![("velocity".to_owned(), *error)],
        };
        let finest = *errors.last().unwrap();
        let quantity = Quantity { name: self.quantity.to_owned(), value: finest, tolerance: self.tolerance };
        let table = Table { title: "Two | three".into(), head: vec!["a|b".into()], rows: vec![vec!["c|d".into()]] };
        let figure = Figure {
            file: format!("{}-errors.svg", self.header.id),
            caption: "errors | h".into(),
            svg: "<svg/>".into(),
        };
        Outcome {
            levels: errors.iter().enumerate().map(level).collect(),
            quantities: vec![quantity],
            tables: vec![table],
            figures: vec![figure],
            ..Outcome::new(
                rate.reason.clone(),
                vec![("velocity".to_owned(), rate)],
                vec![Check::that(finest < 10.0, "|error| < 10", format!("{finest:.1e}"))],
            )
        }
    }
}

/// A beam in small steps.
fn endless() -> Simulator {
    let scene = Scene::parse("[time]\ndt = 1e-8\nt_end = 10.0\n", "endless.toml").unwrap();
    Simulator::new(&scene).unwrap()
}

pub(crate) fn jobs(count: usize) -> NonZeroUsize {
    NonZeroUsize::new(count).unwrap()
}

/// Runs on two threads.
pub(crate) fn finished(studies: Vec<Box<dyn Study>>) -> Vec<Finished> {
    runner::run(&studies, jobs(2), &|_| {}).unwrap()
}

pub(crate) fn ids(ids: &[&str]) -> BTreeSet<String> {
    ids.iter().map(|id| (*id).to_owned()).collect()
}

/// A verification of the quick tier in which there are these studies.
pub(crate) fn request(root: &Path, known: &[&str]) -> Request {
    Request { scope: Scope::Tier(Tier::Quick, ids(known)), effort: jobs(2).into(), bless: false, root: root.to_owned() }
}
