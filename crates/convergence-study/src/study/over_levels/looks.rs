//! What a study that adds levels asks of the levels so far.

use super::{ErrorColumn, Levels};
use convergence_judge::verdict::Samples;

impl Levels {
    /// The names of the errors that would be below the floor at the next level, if they fall on as
    /// between the last two.
    pub(in crate::study) fn below_floor_next(&self) -> Vec<String> {
        let floor = self.floor.value();
        let is_below = |column: &&ErrorColumn| {
            let points = self.points(column);
            let [.., before, last] = &points[..] else {
                return false;
            };
            floor > 0.0 && last.error * (last.error / before.error).min(1.0) <= floor
        };
        let below = self.columns.iter().filter(is_below);
        below.map(|column| column.name.clone()).collect()
    }

    /// The same with only the coarsest levels.
    pub fn coarsest(&self, levels: usize) -> Self {
        let refinements = self.refinements.iter().take(levels).cloned();
        let columns = self.columns.iter().map(|column| ErrorColumn {
            errors: column.errors.iter().copied().take(levels).collect(),
            samples: column.samples.clone().map(|samples| Samples {
                numbers: samples.numbers.into_iter().take(levels).collect(),
                ..samples
            }),
            ..column.clone()
        });
        Self {
            refinements: refinements.collect(),
            columns: columns.collect(),
            ..self.clone()
        }
    }
}
