//! The boundary: the largest error of all points beside that of the points inside.

use super::Levels;
use crate::column::{BoundaryLoss, INSIDE, MAX};
use crate::study::grid::{Grid, GridColumn};
use crate::study::{Check, NamedRate, Subject};
use convergence_judge::verdict::RateVerdict;

impl Levels {
    /// [`loses_order`] over these levels.
    ///
    /// * `rates`: of these levels.
    pub(crate) fn boundary(&self, rates: &[NamedRate]) -> Option<Check> {
        let observed = [self.observed(MAX)?, self.observed(INSIDE)?];
        loses_order([MAX, INSIDE], observed.each_ref(), rates)
    }

    /// Whether the boundary loses the order in h or that in dt, over a grid of both.
    ///
    /// * `rates`: of the grid.
    pub(crate) fn boundary_of_grid(&self, grid: &Grid, rates: &[NamedRate]) -> Vec<Check> {
        let columns = [MAX, INSIDE].map(|name| {
            let errors = self.column(name)?.errors.iter();
            // What is claimed does not matter to the rates.
            Some(GridColumn {
                name: name.to_owned(),
                errors: errors.map(|error| error.unwrap_or(f64::NAN)).collect(),
                ..grid.columns.first()?.clone()
            })
        });
        let both = Grid {
            columns: columns.into_iter().flatten().collect(),
            ..grid.clone()
        };
        // The rates in h and dt of each.
        let observed: Vec<NamedRate> = both.judge().rates;
        let [max_h, max_dt, inside_h, inside_dt] = &observed[..] else {
            return vec![];
        };
        let checks = [[max_h, inside_h], [max_dt, inside_dt]].map(|pair| {
            let names = pair.map(|of| of.name.as_str());
            loses_order(names, pair.map(|of| &of.rate), rates)
        });
        checks.into_iter().flatten().collect()
    }

    /// The rate of an error, whatever is claimed of it.
    fn observed(&self, name: &str) -> Option<RateVerdict> {
        Some(self.as_column(self.column(name)?).observe(self.floor))
    }
}

impl From<BoundaryLoss> for Check {
    fn from(loss: BoundaryLoss) -> Self {
        Self::new(loss.verdict, loss.claim, loss.evidence)
    }
}

/// A check that says so where the boundary has another rate than the points inside.
///
/// * `names`, `observed`: of the largest error of all points, and of that of the points inside.
/// * `rates`: with those of the two that are claimed, by their names.
fn loses_order(
    names: [&str; 2],
    observed: [&RateVerdict; 2],
    rates: &[NamedRate],
) -> Option<Check> {
    let passes = |name: &str| {
        let rate = rates.iter().find(|rate| rate.name == name);
        rate.is_some_and(|rate| rate.rate.verdict.is_pass())
    };
    let loss = BoundaryLoss::of(names, observed, passes)?;
    Some(Check::from(loss).about(Subject::of(names[0])))
}

#[cfg(test)]
mod tests {
    use crate::study::{ErrorsOverLevels, Outcome, levels, norms::norms};
    use convergence_judge::verdict::Verdict;

    /// Errors of second order inside, and of this order at the ends.
    fn ends(order: f64) -> ErrorsOverLevels<impl Fn(usize, usize) -> [(&'static str, f64); 4]> {
        levels([16, 32, 64, 128, 256], move |n| {
            let h = 1.0 / n as f64;
            let at_end = |i: usize| i == 0 || i == n;
            let error = |i: usize| match at_end(i) {
                true => h.powf(order),
                false => h * h * (i as f64 * h).exp(),
            };
            let errors: Vec<f64> = (0..=n).map(error).collect();
            let boundary: Vec<bool> = (0..=n).map(at_end).collect();
            norms(&errors, &vec![h; n + 1], &boundary)
        })
    }

    fn said(outcome: &Outcome) -> bool {
        let mut checks = outcome.checks.iter();
        checks.any(|check| {
            check
                .evidence
                .to_string()
                .contains("the boundary loses the order")
        })
    }

    #[test]
    fn a_boundary_that_loses_the_order_is_said_unless_both_are_claimed() {
        let alone = ends(1.0).claim("max inside", 2.0).run().outcome;
        assert!(alone.verdict == Verdict::Inconclusive && said(&alone));
        let both = ends(1.0).claim("max inside", 2.0).claim("max", 1.0);
        let both = both.claim("L2", 1.5).claim("L1", 2.0).run().outcome;
        assert!(both.verdict.is_pass() && said(&both), "{}", both.summary);
        let wrong = ends(1.0).claim("max inside", 2.0).claim("max", 2.0);
        let wrong = wrong.run().outcome;
        assert!(wrong.verdict == Verdict::Fail && said(&wrong));
    }

    #[test]
    fn a_boundary_that_keeps_it_is_not_said_and_equal_maxima_are_no_doubt() {
        for order in [2.0, 3.0] {
            let study = ends(order).claim("max inside", 2.0).claim("max", 2.0);
            let found = study.claim("L1", 2.0).run();
            assert!(found.outcome.verdict.is_pass(), "{}", found.explained());
            assert!(!said(&found.outcome));
        }
    }
}
