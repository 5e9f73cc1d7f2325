//! Differences of runs, and what is checked and shown beside their rates.

use super::{
    Runs, SelfConvergence,
    observable::{Observable, TIP, last},
};
use crate::kinds::prelude::*;
use crate::{
    exact::norm::Norm,
    kinds::tables::{Refine, mean_width},
};
use convergence_judge::richardson;
use convergence_study::{
    ErrorColumn, Levels,
    chart::{self, Chart},
};

/// Half-width of the band about the order for quantities that are shown but not claimed.
const SHOWN_TOLERANCE: f64 = 0.1;

/// Relative change that the baseline tolerates in a value of the solution itself.
const VALUE_TOLERANCE: f64 = 1e-8;

/// The part of the finest level's error that the two references may differ by.
const KNOWN: f64 = 1e-2;

/// What each level is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ComparisonWith {
    /// The next finer one.
    Successive,
    /// The reference.
    Reference,
}

/// Both readings, in the order in which they are judged.
pub(super) const READINGS: [ComparisonWith; 2] =
    [ComparisonWith::Successive, ComparisonWith::Reference];

impl ComparisonWith {
    fn name(self) -> &'static str {
        match self {
            ComparisonWith::Successive => "successive",
            ComparisonWith::Reference => "reference",
        }
    }
}

impl SelfConvergence {
    /// Differences of each level to what it is compared with, of the observables whose claim is
    /// `wanted`.
    pub(super) fn differences(
        &self,
        runs: &Runs<Self>,
        reading: ComparisonWith,
        wanted: impl Fn(Option<Claim>) -> bool,
    ) -> Levels {
        let reference = self.levels.len();
        let count = match reading {
            ComparisonWith::Successive => reference - 1,
            ComparisonWith::Reference => reference,
        };
        let mut columns = vec![];
        for (place, observable) in self.observables().enumerate() {
            let claim = self.claim(observable);
            if !wanted(claim) {
                continue;
            }
            let mut errors = vec![];
            for k in 0..count {
                let other = match reading {
                    ComparisonWith::Successive => k + 1,
                    ComparisonWith::Reference => reference,
                };
                let pair = found(runs, &k).zip(found(runs, &other));
                errors.push(pair.map(|(level, other)| observable.difference(level, other)));
            }
            let smooth = Claim::new(self.smooth_order(observable), SHOWN_TOLERANCE);
            // A norm that is also one of errors has its style wherever it is drawn.
            let mut norms = Norm::ALL.iter();
            let norm = norms.position(|norm| norm.name() == observable.name);
            let name = format!("{}, {}", observable.name, reading.name());
            let subject = Subject::of(&name);
            columns.push(ErrorColumn {
                subject: match reading {
                    ComparisonWith::Successive => subject,
                    ComparisonWith::Reference => subject.against("reference"),
                },
                symbol: Some(observable.symbol.to_owned()),
                style: norm.unwrap_or(Norm::ALL.len() + place),
                ..ErrorColumn::new(name, claim.unwrap_or(smooth), errors)
            });
        }
        let mut refinements = vec![];
        for (k, &(elements, steps)) in self.levels.iter().enumerate().take(count) {
            refinements.push(Refine::level(elements, steps, self.step_size(k)));
        }
        Levels::new(self.axis, refinements, columns).of_differences()
    }

    fn observables(&self) -> impl Iterator<Item = &'static Observable> {
        Observable::all(self.axis, self.scene.method.stopping())
    }

    fn claim(&self, observable: &Observable) -> Option<Claim> {
        let mut claims = self.claims.iter();
        let own = claims.find(|(claimed, _)| claimed.name == observable.name);
        own.map(|(_, claim)| *claim)
    }

    fn smooth_order(&self, observable: &Observable) -> f64 {
        observable.order(self.axis, self.order_in_time)
    }

    /// 1/n of a level, or dt where time alone is refined.
    fn step_size(&self, level: usize) -> f64 {
        let (elements, steps) = self.levels[level];
        match self.axis {
            RefinedIn::Space | RefinedIn::Both => mean_width(elements),
            RefinedIn::Time => self.t_end / steps as f64,
        }
    }

    /// The time of sample `k` from 1.
    fn time(&self, k: usize) -> f64 {
        self.t_end * k as f64 / self.samples as f64
    }

    /// All differences to the reference; the legend marks those without a claim.
    pub(super) fn to_reference(&self, runs: &Runs<Self>) -> Figure {
        let mut differences = self.differences(runs, ComparisonWith::Reference, |_| true);
        for (column, observable) in differences.columns.iter_mut().zip(self.observables()) {
            column.is_only_drawn = self.claim(observable).is_none();
        }
        let rates = differences.judge();
        let subject = self.scene.name.clone();
        let caption = "Differences to a run of any order, with the orders of a smooth solution.";
        differences.figure("errors", Some(subject), caption.to_owned(), &rates)
    }

    /// How far u(1) of each level is from the reference over time.
    pub(super) fn tip(&self, runs: &Runs<Self>) -> Figure {
        let reference = self.levels.len();
        let y = chart::Axis::log("|u(1, t) − reference| (dimensionless)");
        let time = chart::Axis::linear("time t");
        let mut chart = Chart::empty(time, y);
        for (level, (elements, steps)) in self.levels.iter().enumerate() {
            let name = match self.axis {
                RefinedIn::Time => format!("{steps} steps"),
                RefinedIn::Space | RefinedIn::Both => format!("n = {elements}"),
            };
            let points = (1..=self.samples).map(|k| {
                let distance =
                    (self.tip_at(runs, level, k) - self.tip_at(runs, reference, k)).abs();
                (self.time(k), distance)
            });
            let curve = chart.curve(name, points);
            *curve = curve.clone().marked();
        }
        let chart = chart.titled("How near each refinement brings the tip to the reference");
        Figure::of(
            "tip",
            "Distance of u(1, t) to the reference on each level.",
            chart,
        )
    }

    /// Tip displacements of the finest level, what Richardson adds to them, and those of the
    /// reference.
    pub(super) fn values(&self, runs: &Runs<Self>) -> Table {
        let reference = self.levels.len();
        let [before, finest] = [reference - 2, reference - 1];
        let ratio = self.step_size(before) / self.step_size(finest);
        let order = self.smooth_order(&TIP);
        let head = [
            "t",
            "u(1), finest",
            "extrapolated",
            "reference",
            "error estimated",
            "against reference",
        ];
        let mut rows = vec![];
        for k in 1..=self.samples {
            let tip = self.tip_at(runs, finest, k);
            let exact = self.tip_at(runs, reference, k);
            let coarser = self.tip_at(runs, before, k);
            let correction = richardson::correction(coarser, tip, ratio, order);
            rows.push(vec![
                format!("{:.4}", self.time(k)),
                format!("{tip:.10}"),
                format!("{:.10}", tip + correction),
                format!("{exact:.10}"),
                format!("{:.1e}", correction.abs()),
                format!("{:.1e}", (tip - exact).abs()),
            ]);
        }
        let title = "Tip displacement: finest level, extrapolated, reference";
        Table::new(title, head, rows)
    }

    /// Where contact is claimed: how far the tip is beyond an obstacle.
    pub(super) fn meets_obstacle(&self, runs: &Runs<Self>) -> Option<Measured> {
        let obstacles = self.scene.obstacles.filter(|_| self.contact)?;
        let range = found(runs, &self.levels.len()).map(|found| found.tip_range);
        let depth =
            range.map(|range| max_or_nan(obstacles.g1 - range.low, range.high - obstacles.g2));
        let depth = measured("", "depth of the tip beyond an obstacle, largest", depth);
        Some(depth.must_be(Must::Above(0.0)))
    }

    /// The difference of the reference to that of another discretisation, over the smallest error
    /// that is measured with it.
    pub(super) fn references(&self, runs: &Runs<Self>) -> Vec<Measured> {
        let claims = self.claims.iter();
        let parts = claims.map(|(observable, _)| {
            let part = self.unknown_part(observable, runs);
            let name = format!(
                "difference of the references over the finest error, {}",
                observable.name
            );
            let part = measured("", name, part).scientific(0);
            part.must_be(Must::AtMost(KNOWN))
        });
        parts.collect()
    }

    /// The difference of the references as a part of the finest level's error.
    fn unknown_part(&self, observable: &Observable, runs: &Runs<Self>) -> Option<f64> {
        let first = self.levels.len();
        let reference = found(runs, &first)?;
        let error = observable.difference(found(runs, &(first - 1))?, reference);
        Some(observable.difference(reference, found(runs, &(first + 1))?) / error)
    }

    /// Values of the finest level.
    pub(super) fn values_guarded(&self, runs: &Runs<Self>) -> Vec<Measured> {
        let (finest, samples) = (self.levels.len() - 1, self.samples);
        let traced = found(runs, &finest);
        let energy = traced.and_then(|traced| traced.energies.last().copied());
        let values = [
            (format!("tip {samples}"), self.tip_at(runs, finest, samples)),
            (format!("energy {samples}"), energy.unwrap_or(f64::NAN)),
            (
                "tip max".to_owned(),
                traced.map_or(f64::NAN, |traced| traced.tip_range.high),
            ),
        ];
        let label = self
            .levels
            .last()
            .map_or(String::new(), |&(elements, steps)| {
                Refine::label(elements, steps)
            });
        let guarded = values.map(|(name, value)| {
            let guarded = format!("{name}, finest level");
            measured(&label, name, value).recorded_as(guarded, VALUE_TOLERANCE)
        });
        guarded.into()
    }

    /// u(1) of a run at sample `k` from 1; NaN where there is none.
    fn tip_at(&self, runs: &Runs<Self>, run: usize, k: usize) -> f64 {
        let level = found(runs, &run).and_then(|traced| {
            let levels = &traced.levels;
            levels.get((k * levels.len() / self.samples).checked_sub(1)?)
        });
        level.map_or(f64::NAN, |level| last(&level.u))
    }
}
