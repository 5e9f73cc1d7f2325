//! The maps: claims, the table of boundaries, and guarded numbers.

use super::with_all;
use super::{
    FixedPointStep, SolverResult, SolverTask,
    map::{Boundary, Map, MapPoint, MapRow, NewtonSteps},
    results,
};
use crate::kinds::prelude::*;
use crate::kinds::runs::{checks::energy_and_balance, watch::Worst};
use convergence_judge::text::number::{min_or_nan, plain_text};
use convergence_study::left_out;
use thermobeam::{kirchhoff::BUCKLING, parameters::Beam};

/// A factor for which the map's iterations suffice, with a margin for the mean force, which is not
/// known in advance.
const SLOW: f64 = 0.8;
/// γ up to which α alone decides.
const ALONE: f64 = 0.01;
/// Maximum number of Newton iterations in a step.
const MOST: f64 = 30.0;

/// A map with the results of its cases.
pub(super) struct MapResults<'r> {
    pub(super) map: &'r Map,
    pub(super) rows: Vec<&'r MapRow>,
    pub(super) lines: Vec<&'r Boundary>,
}

impl Map {
    pub(super) fn judge(&self, ran: &[Ran<SolverTask, SolverResult>]) -> Outcome {
        let results = MapResults {
            map: self,
            rows: results(ran, |found| match found {
                SolverResult::Row(row) => Some(row),
                _ => None,
            }),
            lines: results(ran, |found| match found {
                SolverResult::Boundary(line) => Some(line),
                _ => None,
            }),
        };
        results.outcome()
    }
}

impl MapResults<'_> {
    fn outcome(&self) -> Outcome {
        let converged = self.points().filter(|point| point.step.converged).count();
        let completes = self.points().filter(|point| point.newton_completes).count();
        let worst = largest_of(self.lines.iter().filter_map(|line| line.distance_alone()));
        let boundary = worst.map_or("no boundary".to_owned(), |worst| {
            format!("boundary within {:.2} % of alpha = 1", 100.0 * worst)
        });
        let residual = largest_of(self.newton().map(|steps| steps.worst.residual));
        let residual = residual.map_or("no residual".to_owned(), |residual| {
            format!("residual at most {residual:.1e} of the energy")
        });
        let summary = format!(
            "{} points: the fixed point converges at {converged}, Newton's method at {completes}; \
             {boundary} where gamma <= {ALONE}; {residual}",
            self.count()
        );
        let title = "Boundary of the fixed point's convergence, by bisection in dt";
        let agreement = self.map.agreement.get();
        let numbers = self.lines.iter().flat_map(|line| {
            let claims = line.claims(agreement);
            line.numbers().into_iter().chain(claims)
        });
        let lines = Sheet::new(title, "boundary", numbers);
        Outcome {
            headline: format!("{boundary}, {residual}").into(),
            left_out: self.left_out(),
            figures: self.figures(),
            ..Outcome::new(summary, vec![], vec![])
                .with_sheets([lines, Sheet::untabled(self.claims(converged))])
        }
    }

    /// Numbers of the whole map.
    ///
    /// * `converged`: the points with a fixed point.
    fn claims(&self, converged: usize) -> Vec<Measured> {
        let judged = self.points().count();
        let name = "points with a fixed point";
        let mut claims = vec![
            measured("", "points at which both solvers were run", judged as f64)
                .fixed(0)
                .must_be(Must::Count(self.count())),
            self.in_contact(),
            // A point next to the boundary may fall on either side.
            measured("", name, converged as f64).recorded(name, 1e-2),
        ];
        claims.extend(self.as_predicted());
        claims.extend(self.newton_completes());
        claims.push(self.newton_is_quick());
        claims.extend(energy_and_balance(
            &self.worst(),
            self.every_row_has_a_step(),
        ));
        claims
    }

    /// The number of points of the map.
    fn count(&self) -> usize {
        self.map.points.get().pow(2)
    }

    pub(super) fn points(&self) -> impl Iterator<Item = &MapPoint> {
        self.rows.iter().flat_map(|row| &row.points)
    }

    fn newton(&self) -> impl Iterator<Item = &NewtonSteps> {
        self.points().filter_map(|point| point.newton.as_ref())
    }

    /// The points and boundaries that each statement judges.
    fn left_out(&self) -> Vec<String> {
        let count = self.count();
        let convergence = self.points().map(|point| {
            let between = prediction(&point.step).is_none();
            between.then_some("factors near 1, which predict nothing")
        });
        let balance = self.points().map(|point| {
            let failed = point.newton.is_none();
            failed.then_some("no step by Newton's method")
        });
        let boundaries = self.lines.iter().map(|line| line.not_alone());
        let lines = self.map.lines.len();
        let all = [
            left_out("points for convergence", with_all(count, convergence)),
            left_out("points for the balance", with_all(count, balance)),
            left_out(
                "boundaries for alpha = 1 alone",
                with_all(lines, boundaries),
            ),
        ];
        all.into_iter().flatten().collect()
    }

    /// The first step ends in contact.
    fn in_contact(&self) -> Measured {
        let forces = self.newton().map(|steps| steps.contact_force);
        let name = "contact force after the first step, least";
        measured("", name, forces.reduce(min_or_nan)).must_be(Must::Above(0.0))
    }

    /// The map against α and γ: convergence where both are well below 1, no convergence where α
    /// exceeds 1 by more than γ.
    fn as_predicted(&self) -> [Measured; 3] {
        let mut fast = 0;
        let mut beyond = 0;
        let mut wrong = 0;
        for point in self.points() {
            match prediction(&point.step) {
                Some(true) => fast += 1,
                Some(false) => beyond += 1,
                None => continue,
            }
            wrong += usize::from(prediction(&point.step) != Some(point.step.converged));
        }
        let far = 2.0 - SLOW;
        [
            some_of(
                "",
                &format!("points with alpha and gamma below {SLOW}"),
                fast,
            ),
            some_of("", &format!("points with alpha > {far} + gamma"), beyond),
            none_of(
                "",
                "of them, points where the fixed point does not as predicted",
                wrong,
            ),
        ]
    }

    /// Newton's method must converge wherever its operator is known to be definite.
    fn newton_completes(&self) -> [Measured; 2] {
        let mut known = 0;
        let mut wrong = 0;
        for row in &self.rows {
            let Beam { zeta, beta, .. } = self.map.beam(row.value);
            for point in &row.points {
                let half = 0.5 * point.step.dt;
                if BUCKLING * (zeta + half) + beta * half > 0.0 {
                    known += 1;
                    wrong += usize::from(!point.newton_completes);
                }
            }
        }
        [
            some_of("", "points with B (zeta + dt/2) + beta dt/2 > 0", known),
            none_of("", "of them, points where Newton's method fails", wrong),
        ]
    }

    fn newton_is_quick(&self) -> Measured {
        let most = self.newton().map(|steps| steps.iterations).max();
        let name = "iterations of Newton's method in a step, most";
        measured("", name, most.map(|most| most as f64))
            .fixed(0)
            .must_be(Must::AtMost(MOST))
    }

    /// Over all steps of Newton's method.
    fn worst(&self) -> Worst {
        self.newton()
            .map(|steps| steps.worst)
            .fold(Worst::default(), Worst::max)
    }

    /// A row without a single step of Newton's method shows nothing.
    fn every_row_has_a_step(&self) -> bool {
        self.rows
            .iter()
            .all(|row| row.points.iter().any(|point| point.newton.is_some()))
    }
}

/// Whether α and γ predict convergence or failure; `None` where they are near 1 and predict
/// nothing.
fn prediction(&FixedPointStep { alpha, gamma, .. }: &FixedPointStep) -> Option<bool> {
    if alpha < SLOW && gamma < SLOW {
        return Some(true);
    }
    // An infinite α means that the operator A_u of the step is not definite.
    (alpha == f64::INFINITY || alpha > 1.0 + gamma + (1.0 - SLOW)).then_some(false)
}

impl Boundary {
    /// Why α alone does not decide where the boundary is; `None` if it does.
    fn not_alone(&self) -> Option<&'static str> {
        match self.found {
            None => Some("no boundary on the map"),
            Some(crossing) => (!(crossing.gamma <= ALONE)).then_some("gamma takes part"),
        }
    }

    /// Relative difference of the boundary to α = 1; `None` if there is none.
    fn difference(&self) -> Option<f64> {
        Some(self.found?.dt / self.predicted? - 1.0)
    }

    /// Relative distance of the boundary to α = 1, where α alone decides.
    fn distance_alone(&self) -> Option<f64> {
        let is_alone = self.not_alone().is_none();
        is_alone.then(|| self.difference().map_or(f64::NAN, f64::abs))
    }

    pub(super) fn numbers(&self) -> Vec<Measured> {
        let one = |name: &str, value: Option<f64>| measured(self.place(), name, value);
        let name = format!("boundary at {} = {:e}", self.over, self.value);
        let dt = one("dt found", self.found.map(|step| step.dt)).scientific(4);
        let percent = self.difference().map(|difference| 100.0 * difference);
        let in_words = percent.map_or("-".to_owned(), |percent| format!("{percent:+.3} %"));
        vec![
            one("dt where alpha = 1", self.predicted).scientific(4),
            match self.found {
                Some(_) => dt.recorded_as(name, 1e-2),
                None => dt,
            },
            one("difference", percent).words(in_words),
            one("alpha there", self.found.map(|step| step.alpha)).fixed(4),
            one("gamma there", self.found.map(|step| step.gamma)).scientific(1),
        ]
    }

    fn place(&self) -> String {
        format!("{} = {}", self.over, plain_text(self.value))
    }

    /// The fixed point fails from α = 1 on, up to a share of γ: a boundary is found where one is
    /// predicted, and nowhere else.
    ///
    /// * `agreement`: how far from 1 α may be at the boundary, beyond γ.
    fn claims(&self, agreement: f64) -> Vec<Measured> {
        let alone = usize::from(self.found.is_some() != self.predicted.is_some());
        let name = "boundaries that are found or predicted alone";
        let mut claims = vec![none_of(self.place(), name, alone).hidden()];
        if let Some(FixedPointStep { alpha, gamma, .. }) = self.found {
            let beyond = (alpha - 1.0).abs() - gamma;
            let name = "distance of alpha there from 1, beyond gamma";
            let beyond = measured(self.place(), name, beyond).hidden();
            claims.push(beyond.must_be(Must::AtMost(agreement)));
        }
        claims
    }
}
