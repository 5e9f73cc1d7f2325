//! The claims: where the beam buckles and lifts off, and that moving beams come to rest on stable
//! branches; tables, figures and guarded numbers.

use std::ops::RangeInclusive;

use convergence_judge::{interval::Interval, richardson};

use super::branches::{BRACKET, CLOSE, Diagram};
use super::{AtRest, BifurcationResult, DiagramTask, MESHES, RESTS, SCENES};
use crate::figures;
use crate::kinds::tables::level_of_mesh;
use crate::studies::paper::{Experiment, OBSTACLES};
use crate::studies::prelude::*;
use convergence_study::{Claim, ErrorColumn, Figure, Levels, RefinedIn};
use thermobeam::kirchhoff::BUCKLING;

/// A beam with a tip closer to zero than this is straight.
const STRAIGHT: f64 = 1e-6;

/// Allowed error of the extrapolated buckling force of P1 elements.
const LIMIT: f64 = 1e-8;

/// Width to which an event is enclosed by proofs.
const PROVED: f64 = 1e-12;

/// The order of the discrete buckling force, and the tolerance of its rate.
const ORDER: f64 = 2.0;
const TOLERANCE: f64 = 0.02;

/// Allowed distance of a beam at rest from an exact state: what 32 elements leave just beyond
/// buckling, where the beam is soft.
const DISTANCE: f64 = 1e-3;

/// The results of one scene.
struct OfScene<'r> {
    experiment: Experiment,
    diagram: &'r Diagram,
    /// Whether the straight beam buckles; a heated beam lifts off the upper obstacle.
    buckles: bool,
    /// Each β with its run to rest.
    rests: Vec<(f64, &'r AtRest)>,
}

impl<'r> OfScene<'r> {
    fn new(shown: &[(&DiagramTask, &'r BifurcationResult)], k: usize) -> Self {
        let mut rests = vec![];
        for (place, beta) in RESTS.into_iter().enumerate() {
            rests.push((beta, of(shown, &DiagramTask::Rest(k, place)).rest()));
        }
        Self {
            experiment: SCENES[k],
            diagram: of(shown, &DiagramTask::Diagram(k)).diagram(),
            buckles: SCENES[k].theta_a == 0.0,
            rests,
        }
    }

    fn name(&self) -> String {
        format!("θ_A = {}", self.experiment.theta_a)
    }

    /// The lower end of the bracket of buckling or lift-off.
    fn event(&self) -> f64 {
        self.diagram.event.low
    }

    /// β and u(1) at rest.
    fn tips(&self) -> impl Iterator<Item = (f64, f64)> {
        self.rests.iter().map(|(beta, rest)| (*beta, rest.tip[0]))
    }

    /// What is claimed of the diagram and of the runs.
    fn claims(&self) -> Vec<Measured> {
        let name = self.name();
        let distances = self.rests.iter().map(|(_, rest)| rest.distance());
        let unstable = self.rests.iter().filter(|(_, rest)| !rest.is_stable());
        let mut claims = self.of_event();
        claims.extend([
            some_of(&name, "runs to rest", self.rests.len()),
            none_of(&name, "ends on no stable branch", unstable.count()),
            measured(&name, "farthest end from its state", largest_of(distances))
                .scientific(1)
                .must_be(Must::AtMost(DISTANCE)),
            some_of(&name, "branches", self.diagram.branches.len()),
            none_of(&name, "states of two branches", self.diagram.ambiguous),
        ]);
        if self.buckles {
            claims.push(none_of(
                &name,
                "ends bent above -0.7116, or straight below",
                self.wrongly_bent(),
            ));
        } else {
            // One steady state for every β, even beyond buckling.
            let counts = &self.diagram.counts;
            let others = counts.iter().filter(|(_, states)| *states != 1);
            claims.push(some_of(&name, "β in the diagram", counts.len()));
            claims.push(none_of(
                &name,
                "β with several states, or none",
                others.count(),
            ));
        }
        claims
    }

    /// Counting brackets the event, and proofs on both sides enclose it; for buckling analysis
    /// gives the number.
    fn of_event(&self) -> Vec<Measured> {
        let name = self.name();
        let Diagram { event, proved, .. } = self.diagram;
        let Interval { low, high } = *event;
        let known = |claim: Must| self.buckles.then_some(claim);
        let apart = largest_of([proved.low - high, low - proved.high]);
        vec![
            measured(&name, "event, below", low)
                .fixed(10)
                .recorded_as(format!("event at {name}"), 1e-8)
                .must_be(known(Must::AtMost(-BUCKLING + BRACKET))),
            measured(&name, "event, above", high)
                .fixed(10)
                .must_be(known(Must::AtLeast(-BUCKLING - BRACKET))),
            measured(&name, "width of the event", high - low).must_be(Must::AtMost(BRACKET)),
            measured(
                &name,
                "width of the event, proved",
                proved.high - proved.low,
            )
            .must_be(Must::AtMost(PROVED)),
            measured(&name, "event, proved, beyond that counted", apart).must_be(Must::AtMost(0.0)),
        ]
    }

    /// Runs that end bent although the straight beam is stable, or straight although it is not.
    fn wrongly_bent(&self) -> usize {
        let is_right = |(beta, tip): &(f64, f64)| {
            let is_bent = tip.abs() > STRAIGHT && *beta < -BUCKLING;
            is_bent || tip.abs() <= STRAIGHT && *beta >= -BUCKLING
        };
        self.tips().filter(|end| !is_right(end)).count()
    }

    /// The whole diagram, and a close-up of the fork if there is one.
    fn figures(&self) -> Vec<Figure> {
        let theta_a = self.experiment.theta_a;
        let file = format!("theta-a-{theta_a}");
        let caption = format!(
            "Steady states over β for θ_A = {theta_a}: solid where stable, dashed where not; \
             open markers: where moving beams come to rest."
        );
        let fork = self.event();
        // A minus sign, not a hyphen.
        let event = format!("{fork:.4}").replace('-', "−");
        if !self.buckles {
            let title = format!("One steady state for every β; it lifts off at β = {event}");
            let svg = self.drawing(title, f64::NEG_INFINITY..=f64::INFINITY);
            return vec![Figure::new(&file, caption, svg)];
        }
        let title = format!("Several steady states below β = {event}, one above");
        // Above the fork there is the straight beam alone.
        let whole = self.drawing(title, f64::NEG_INFINITY..=fork + 2.0 * CLOSE);
        let title = "The beam bends until its free end meets an obstacle".to_owned();
        let close = self.drawing(title, fork - CLOSE..=fork + CLOSE);
        let caption_of_close = "The same near the buckling point: the fork opens until the free end meets an obstacle.";
        vec![
            Figure::new(&file, caption, whole),
            Figure::new(&format!("{file}-fork"), caption_of_close, close),
        ]
    }

    fn drawing(&self, title: String, range: RangeInclusive<f64>) -> String {
        let mut sorted: Vec<_> = self.diagram.branches.iter().collect();
        sorted.sort_by_key(|branch| (branch.key.place(), !branch.key.stable));
        let mut branches: Vec<figures::EquilibriumBranch> = vec![];
        for branch in sorted {
            let label = branch.key.name();
            let stable = branch.key.stable;
            let points = branch.points.iter().copied();
            let points = points.filter(|(beta, _)| range.contains(beta));
            match branches.last_mut() {
                Some(last)
                    if branch.key.is_straight()
                        && (&last.label[..], last.stable) == (label, stable) =>
                {
                    last.points.extend(points);
                }
                _ => branches.push(figures::EquilibriumBranch {
                    label: label.to_owned(),
                    points: points.collect(),
                    stable,
                }),
            }
        }
        // A branch found at a single β is a corner of the diagram, not a line.
        branches.retain(|branch| branch.points.len() > 1);
        let tips = self.tips().filter(|(beta, _)| range.contains(beta));
        figures::bifurcation(&figures::Bifurcation {
            title,
            branches,
            obstacles: figures::obstacle_lines(Some(OBSTACLES)),
            ends: tips.collect(),
        })
    }
}

pub(super) fn judge(shown: &[(&DiagramTask, &BifurcationResult)]) -> Outcome {
    let scenes = [0, 1].map(|k| OfScene::new(shown, k));
    let forces = MESHES.map(|n| of(shown, &DiagramTask::Buckling(n)).force());
    let errors = forces.iter().map(|force| Some((force - BUCKLING).abs()));
    let column = ErrorColumn::new(
        "buckling force of P1 elements",
        Claim::new(ORDER, TOLERANCE),
        errors,
    );
    let refinements = MESHES.map(|n| level_of_mesh(format!("n = {n}"), n));
    let levels = Levels::new(RefinedIn::Space, refinements, [column]);
    let rates = levels.judge();
    let events: Vec<String> = scenes
        .iter()
        .map(|scene| format!("{:.6}", scene.event()))
        .collect();
    let claims = scenes.iter().flat_map(OfScene::claims);
    let events = events.join(", ");
    let buckling = "Buckling point of P1 elements";
    let sheets = [
        Sheet::new("Where the steady states change", "scene", claims),
        Sheet::new(buckling, "elements", of_meshes(&forces)),
        Sheet::new("Where moving beams come to rest", "β", rests(&scenes)),
    ];
    Outcome {
        figures: scenes.iter().flat_map(|scene| scene.figures()).collect(),
        ..Outcome::of_sheets(sheets, "")
    }
    .headed(format!("buckling and lift-off at β = {events}"))
    .with_orders(&levels, rates)
}

/// The discrete buckling force for vanishing mesh width, from the last two meshes; NaN for fewer.
fn extrapolated(meshes: &[usize], forces: &[f64]) -> f64 {
    let (&[.., coarse, fine], &[.., before, last]) = (meshes, forces) else {
        return f64::NAN;
    };
    last + richardson::correction(before, last, fine as f64 / coarse as f64, ORDER)
}

/// The buckling force of each mesh, and of vanishing mesh width; in the table with its sign.
fn of_meshes(forces: &[f64]) -> Vec<Measured> {
    let force = |case: &str, force: f64| measured(case, "β", force).words(format!("-{force:.10}"));
    let above = |case: &str, force: f64| {
        measured(case, "above -(π²/4)/(1 + π²/4)", force - BUCKLING).scientific(3)
    };
    let mut found = vec![];
    for (n, &of_mesh) in MESHES.iter().zip(forces) {
        let case = n.to_string();
        let known = format!("buckling force, n = {n}");
        found.extend([
            force(&case, of_mesh).recorded_as(known, 1e-11),
            above(&case, of_mesh),
        ]);
    }
    let limit = extrapolated(&MESHES, forces);
    let near = Must::Near {
        answer: BUCKLING,
        within: LIMIT,
    };
    let case = "extrapolated";
    found.extend([force(case, limit).must_be(near), above(case, limit)]);
    found
}

fn rests(scenes: &[OfScene<'_>]) -> Vec<Measured> {
    let mut found = vec![];
    for (place, beta) in RESTS.iter().enumerate() {
        for scene in scenes {
            let (_, rest) = scene.rests[place];
            let [at_rest, exact] = [rest.tip[0], rest.exact_tip()[0]];
            let [name, beta] = [scene.name(), beta.to_string()];
            found.extend([
                measured(&beta, format!("u(1) at rest, {name}"), at_rest).fixed(8),
                measured(&beta, format!("exact, {name}"), exact).fixed(8),
            ]);
        }
    }
    found
}
