//! The errors of one norm over the steps of a record.

use crate::judge::fit::Level;
use crate::store::record::LevelRecord;

/// Steps that differ by less, as a share, are one step: records may be rounded to six digits.
const SAME_STEP: f64 = 1e-5;

/// One level.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    /// What identifies the level.
    pub(super) parameters: Vec<(String, f64)>,
    pub(super) level: Level,
    pub(super) work: Option<f64>,
}

/// The levels that have the norm: over decreasing steps, or over a grid of parameters, which has no one step.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    pub(super) points: Vec<Point>,
    /// Whether the steps decrease from level to level.
    pub(super) is_sequence: bool,
}

/// A value interpolated at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Between {
    /// Its logarithm.
    pub(super) log: f64,
    /// How far off that may be.
    pub(super) doubt: f64,
}

impl Series {
    /// * `recorded`: whether steps are those of the records; else they are taken from the parameter that is refined.
    pub(super) fn new(levels: &[LevelRecord], norm: &str, recorded: bool) -> Self {
        let having: Vec<(&LevelRecord, f64)> =
            levels.iter().filter_map(|level| Some((level, error(level, norm)?))).collect();
        let steps = steps(having.iter().map(|(level, _)| *level), recorded);
        let is_sequence = steps.len() == having.len() && steps.windows(2).all(|pair| pair[1] < pair[0]);
        let point = |(k, (level, error)): (usize, &(&LevelRecord, f64))| Point {
            parameters: level.parameters.0.clone(),
            level: Level { step: steps.get(k).copied().unwrap_or(f64::NAN), error: *error },
            work: level.work.filter(|work| *work > 0.0),
        };
        Self { points: having.iter().enumerate().map(point).collect(), is_sequence }
    }

    /// The point of this series at the step of a point of another: the same parameters, or where both have steps the same step.
    pub(super) fn same_level(&self, point: &Point, other: &Self) -> Option<&Point> {
        let both_have_steps = self.is_sequence && other.is_sequence;
        let is_same = |known: &&Point| {
            if both_have_steps {
                (known.level.step / point.level.step).ln().abs() <= SAME_STEP
            } else {
                known.parameters == point.parameters
            }
        };
        self.points.iter().find(is_same).filter(|known| known.level.error >= 0.0)
    }

    pub(super) fn levels(&self) -> Vec<Level> {
        self.points.iter().map(|point| point.level).collect()
    }

    /// log e at a step within the range of `points`, linear in log h.
    pub(super) fn at_step(points: &[Point], step: f64) -> Option<Between> {
        let axes: Vec<(f64, f64)> =
            points.iter().map(|point| (point.level.step.ln(), point.level.error.ln())).collect();
        between(&axes, step.ln())
    }

    /// log work at an error within the range of `points`, linear in log e.
    pub(super) fn work_at(points: &[Point], error: f64) -> Option<Between> {
        let pair = |point: &Point| Some((point.level.error.ln(), point.work?.ln()));
        between(&points.iter().map(pair).collect::<Option<Vec<_>>>()?, error.ln())
    }
}

/// The error of a norm; `None` where the level does not have it.
pub(super) fn error(level: &LevelRecord, norm: &str) -> Option<f64> {
    level.errors.0.iter().find(|(name, _)| name == norm).map(|(_, error)| *error)
}

/// Whether all levels of a study have the step that their errors are judged over.
pub(super) fn has_steps(levels: &[LevelRecord]) -> bool {
    levels.iter().all(|level| level.step.is_some())
}

/// One step for each level: the recorded one, or the first parameter that falls from level to level, or one over that which grows. Empty where there is none.
fn steps<'l>(levels: impl Iterator<Item = &'l LevelRecord> + Clone, recorded: bool) -> Vec<f64> {
    if recorded {
        return levels.map(|level| level.step.unwrap_or(f64::NAN)).collect();
    }
    let Some(first) = levels.clone().next() else { return vec![] };
    let column =
        |k: usize| levels.clone().map(move |level| level.parameters.0.get(k).map_or(f64::NAN, |(_, value)| *value));
    (0..first.parameters.0.len())
        .map(|k| column(k).collect::<Vec<f64>>())
        .find_map(|values| {
            let falls = values.windows(2).all(|pair| pair[1] < pair[0]);
            let grows = values.windows(2).all(|pair| pair[1] > pair[0]);
            let positive = values.iter().all(|value| *value > 0.0);
            match (positive, falls, grows) {
                (true, true, false) => Some(values),
                (true, false, true) => Some(values.iter().map(|value| 1.0 / value).collect()),
                _ => None,
            }
        })
        .unwrap_or_default()
}

/// Linear interpolation between neighbours; x falls from point to point.
fn between(points: &[(f64, f64)], x: f64) -> Option<Between> {
    if let Some((_, y)) = points.iter().find(|(known, _)| (known - x).abs() <= SAME_STEP) {
        return Some(Between { log: *y, doubt: 0.0 });
    }
    let k = points.windows(2).position(|pair| pair[0].0 > x && x > pair[1].0)?;
    let slope = |k: usize| points.get(k + 1).map(|next| (next.1 - points[k].1) / (next.0 - points[k].0));
    let here = slope(k)?;
    let neighbours = [k.checked_sub(1).and_then(slope), slope(k + 1)];
    let change = neighbours.into_iter().flatten().map(|slope| (slope - here).abs()).fold(0.0, f64::max);
    let width = points[k].0 - points[k + 1].0;
    Some(Between { log: points[k].1 + here * (x - points[k].0), doubt: 0.25 * change * width })
}
