//! What two discretisations of one scene agree on: checks, and rows of numbers.

use super::{ExactExperiments, SceneRun, ShownStates};
use crate::kinds::prelude::*;
use crate::{
    kinds::runs::{
        Results, Row,
        checks::{Condition, agree, all, at_most, largest_difference},
    },
    run::{Sample, object::phase_name},
    scene::Scene,
};

/// Residual of the balance that is round-off, over the initial energy.
const CLOSED: f64 = 1e-12;

/// Relative change of a published number that the baseline tolerates.
const TOLERANCE: f64 = 1e-8;

/// The numbers of a state, in the order of [`Sample::numbers`].
pub(super) const NAMES: [&str; 6] = ["u(1)", "φ(1)", "u_t(1)", "φ_t(1)", "θ(1/2)", "E"];

/// The runs of one scene.
pub(super) struct OfScene<'r> {
    pub(super) scene: &'r Scene,
    pub(super) any_order: [&'r ShownStates; 2],
    /// By the scene's own scheme, where that is compared.
    own: Option<&'r ShownStates>,
}

impl<'r> OfScene<'r> {
    pub(super) fn of(
        study: &'r ExactExperiments,
        results: &Results<'r, ExactExperiments>,
        scene: usize,
    ) -> Self {
        Self {
            scene: &study.scenes[scene],
            any_order: [Some(0), Some(1)].map(|by| results.of(&SceneRun { scene, by })),
            own: results.optional(&SceneRun { scene, by: None }),
        }
    }

    /// θ_A.
    pub(super) fn heating(&self) -> f64 {
        self.scene.beam.theta_a
    }

    /// `(t, u(1, t))` by the first discretisation.
    pub(super) fn tip(&self) -> Vec<(f64, f64)> {
        self.any_order[0].tip.clone()
    }

    /// The states of the first discretisation.
    fn states(&self) -> &'r [Sample] {
        &self.any_order[0].states
    }

    /// A number of each run by any order: the larger.
    fn larger(&self, number: fn(&ShownStates) -> f64) -> f64 {
        let [one, other] = self.any_order.map(number);
        max_or_nan(one, other)
    }

    /// The largest difference of any number at any time.
    pub(super) fn difference(&self) -> f64 {
        let [one, other] = self.any_order.map(|run| {
            let numbers = run.states.iter().flat_map(Sample::numbers);
            numbers.collect::<Vec<_>>()
        });
        largest_difference(&one, &other)
    }

    pub(super) fn checks(&self, agreement: f64) -> [Check; 3] {
        let runs = "two discretisations";
        let subject = self.subject("agreement");
        [
            agree(runs, subject, self.difference(), agreement),
            self.events_agree(agreement),
            self.balance(),
        ]
    }

    fn subject(&self, quantity: &str) -> Subject {
        Subject::of(quantity).in_case(&self.scene.name)
    }

    fn events_agree(&self, agreement: f64) -> Check {
        let claim = "they agree on every contact event";
        let subject = self.subject("contact events");
        let [one, other] = self.any_order;
        let mut pairs = one.events.iter().zip(&other.events);
        let distances = pairs.clone().map(|(a, b)| (a.t - b.t).abs());
        let alike = pairs.all(|(a, b)| (a.from, a.to) == (b.from, b.to));
        let [count, other_count] = [one, other].map(|run| run.events.len());
        let mut evidence = format!("{count} and {other_count} events");
        let mut close = true;
        if let Some(apart) = largest_of(distances) {
            evidence += &format!(", times at most {apart:.1e} apart");
            // Times are of order 10, the other numbers of order 1.
            close = apart <= 10.0 * agreement;
        }
        let holds = count == other_count && alike && close;
        all(claim, subject, [Condition::that(holds, evidence)])
    }

    fn balance(&self) -> Check {
        let [residual, increase] = [
            self.larger(|shown| shown.balance[0]),
            self.larger(|shown| shown.balance[1]),
        ];
        let evidence =
            format!("largest residual {residual:.1e} of E0, largest change {increase:.1e}");
        all(
            format!(
                "the energy falls in every step and its balance closes within {CLOSED:e} of E0"
            ),
            self.subject("energy and balance"),
            [
                at_most(residual, CLOSED, evidence),
                at_most(increase, 0.0, ""),
            ],
        )
    }

    /// The numbers, to the digits that both discretisations agree on and one more.
    pub(super) fn values(&self) -> Vec<Row> {
        let apart = self.difference();
        let decimals = if apart > 0.0 {
            (-apart.log10()).floor().clamp(0.0, 14.0) as usize
        } else {
            14
        };
        let mut rows = vec![];
        for state in self.states() {
            let mut row = vec![];
            for (name, number) in NAMES.into_iter().zip(state.numbers()) {
                let guarded = name.replace('φ', "phi").replace('θ', "theta");
                let quantity = format!("{guarded} at t = {}", state.t);
                let reading = Reading::new(name, number).fixed(decimals);
                row.push(reading.guarded_in(&self.scene.name, quantity, TOLERANCE));
            }
            row.push(Reading::text("largest difference", format!("{apart:.0e}")));
            rows.push((self.at(state), row));
        }
        rows
    }

    /// The first cells of a row: scene and time.
    fn at(&self, state: &Sample) -> Vec<String> {
        vec![self.scene.name.clone(), state.t.to_string()]
    }

    /// Errors of the scene's own scheme.
    pub(super) fn errors(&self) -> Vec<Row> {
        let own = self.own.map_or(&[][..], |own| &own.states);
        let largest = Reading::new("largest |error| of u(1, t)", self.own_error()).scientific(2);
        let mut rows = vec![];
        for (own, exact) in own.iter().zip(self.states()) {
            let pairs = own.numbers().into_iter().zip(exact.numbers());
            let errors = NAMES
                .into_iter()
                .zip(pairs)
                .map(|(name, (own, exact))| Reading::new(name, own - exact).scientific(2));
            rows.push((self.at(exact), errors.chain([largest.clone()]).collect()));
        }
        rows
    }

    /// `(t, error)` of u(1, t) by the scene's own scheme.
    pub(super) fn error_over_time(&self) -> Vec<(f64, f64)> {
        let own = self.own.map_or(&[][..], |own| &own.tip);
        // The history of the exact run begins at t = 0. The reader has made sure that both have the
        // same times.
        own.iter()
            .zip(self.tip())
            .skip(1)
            .map(|((t, u), (_, exact))| (*t, (u - exact).abs()))
            .collect()
    }

    /// The largest of these; NaN where there is none.
    pub(super) fn own_error(&self) -> f64 {
        let errors = self.error_over_time().into_iter();
        largest_of(errors.map(|(_, error)| error)).unwrap_or(f64::NAN)
    }
}

pub(super) fn events(scenes: &[OfScene<'_>]) -> Table {
    let mut rows = vec![];
    for of in scenes {
        for event in &of.any_order[0].events {
            let [from, to] = [event.from, event.to].map(phase_name);
            rows.push(vec![
                of.scene.name.clone(),
                format!("{:.10}", event.t),
                format!("{from} to {to}"),
            ]);
        }
    }
    Table::new("Contact events", ["scene", "t", "free end"], rows)
}
