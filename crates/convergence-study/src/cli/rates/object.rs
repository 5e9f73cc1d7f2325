//! The result for programs: one JSON object.

use serde::Serialize;

use super::{Findings, Judged};
use crate::judge::fit::Level;

/// What `rates --format json` prints, beside the verdict.
#[derive(Debug, Serialize)]
pub(super) struct Object<'a> {
    step: &'a str,
    floor: f64,
    rates: Vec<Rate<'a>>,
    not_errors: Vec<NotErrors<'a>>,
    /// How the table was read, where the names did not decide.
    notes: &'a [String],
}

/// As in `study --format json`, the column's name for the norm's; a number that is none is `null`.
#[derive(Debug, Serialize)]
struct Rate<'a> {
    norm: &'a str,
    order: f64,
    tolerance: f64,
    pairwise: &'a [f64],
    fitted: Option<f64>,
    /// Of error = constant step^rate.
    constant: Option<f64>,
    interval: Option<[f64; 2]>,
    extrapolated: Option<f64>,
    verdict: &'static str,
    reason: &'a str,
    /// Whether the overall verdict depends on it.
    decides: bool,
    /// Coarsest first.
    levels: Vec<LevelObject>,
    set_aside: Vec<SetAside>,
}

#[derive(Debug, Serialize)]
struct LevelObject {
    step: f64,
    error: f64,
}

/// A level without a say, 0 the coarsest.
#[derive(Debug, Serialize)]
struct SetAside {
    level: usize,
    because: &'static str,
}

/// A column that was not judged.
#[derive(Debug, Serialize)]
struct NotErrors<'a> {
    column: &'a str,
    because: &'static str,
}

impl<'a> Object<'a> {
    pub(super) fn new(findings: &'a Findings<'a>) -> Self {
        let rates = findings.columns.iter().zip(&findings.table.columns);
        let not_errors = findings.table.not_errors.iter().map(|(column, because)| NotErrors { column, because });
        Self {
            step: &findings.table.step,
            floor: findings.floor,
            rates: rates.map(|(judged, (_, levels))| Rate::new(judged, levels)).collect(),
            not_errors: not_errors.collect(),
            notes: &findings.table.notes,
        }
    }
}

impl<'a> Rate<'a> {
    fn new(judged: &'a Judged<'a>, levels: &[Level]) -> Self {
        let rate = judged.rate;
        let aside = rate.set_aside.iter();
        Self {
            norm: judged.name,
            order: rate.order,
            tolerance: rate.tolerance,
            pairwise: &rate.pairwise,
            fitted: rate.fitted,
            constant: rate.constant,
            interval: rate.interval,
            extrapolated: rate.extrapolated,
            verdict: rate.verdict.name(),
            reason: if judged.is_claimed() { &rate.reason } else { judged.reason() },
            decides: judged.decides,
            levels: levels.iter().map(|level| LevelObject { step: level.step, error: level.error }).collect(),
            set_aside: aside.map(|aside| SetAside { level: aside.level, because: aside.because.text() }).collect(),
        }
    }
}
