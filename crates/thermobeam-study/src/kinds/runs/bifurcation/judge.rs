//! The claims: where the beam buckles and lifts off, and that moving beams come to rest on stable
//! branches; tables, figures and guarded numbers.

use std::ops::RangeInclusive;

use convergence_judge::{interval::Interval, judge::richardson, text::number::decimals};

use super::{
    AtRest, Bifurcation, DiagramTask,
    branches::{BRACKET, CLOSE, Diagram, buckles},
};
use crate::kinds::prelude::*;
use crate::{
    figures,
    kinds::{
        runs::{
            Findings, Listing, Results, Row,
            checks::{all, at_most, within},
        },
        settings::ItemMethod,
        tables::level_of_mesh,
    },
    scene::Scene,
};
use convergence_study::internal::study::over_levels::{ErrorColumn, Levels};
use thermobeam::kirchhoff::BUCKLING;

/// A beam with a tip closer to zero than this is straight.
const STRAIGHT: f64 = 1e-6;

/// Allowed error of the extrapolated buckling force of P1 elements.
const LIMIT: f64 = 1e-8;

/// Width to which an event is enclosed by proofs.
const PROVED: f64 = 1e-12;

/// The order of the discrete buckling force.
const ORDER: f64 = 2.0;

/// The results of one scene.
struct OfScene<'r> {
    scene: &'r Scene,
    diagram: &'r Diagram,
    /// Each β with its run to rest.
    rests: Vec<(f64, &'r AtRest)>,
}

impl<'r> OfScene<'r> {
    fn new(study: &'r Bifurcation, results: &Results<'r, Bifurcation>, k: usize) -> Self {
        let mut rests = vec![];
        for (place, &beta) in study.rest.betas.iter().enumerate() {
            rests.push((beta, results.of(&DiagramTask::Rest(k, place)).rest()));
        }
        Self {
            scene: &study.scenes[k],
            diagram: results.of(&DiagramTask::Diagram(k)).diagram(),
            rests,
        }
    }

    fn name(&self) -> String {
        format!("θ_A = {}", self.scene.beam.theta_a)
    }

    fn subject(&self, quantity: &str) -> Subject {
        Subject::of(quantity).in_case(self.name())
    }

    /// The lower end of the bracket of buckling or lift-off.
    fn event(&self) -> f64 {
        self.diagram.event.low
    }

    fn guarded_event(&self) -> Quantity {
        let name = format!("event at {}", self.name());
        Quantity::new(name, self.event(), 1e-8).about(self.subject("event"))
    }

    /// β and u(1) at rest.
    fn tips(&self) -> impl Iterator<Item = (f64, f64)> {
        self.rests.iter().map(|(beta, rest)| (*beta, rest.tip[0]))
    }

    fn checks(&self, study: &Bifurcation) -> Vec<Check> {
        let [first, second] = if buckles(self.scene) {
            [self.buckles(), self.bent_below()]
        } else {
            [lifts_off(self.diagram), self.one_state()]
        };
        vec![
            self.ends_are_stable(study.distance),
            self.unambiguous(),
            first,
            second,
            self.is_proved(),
        ]
    }

    fn ends_are_stable(&self, allowed: f64) -> Check {
        let mut elsewhere = vec![];
        let mut farthest = 0.0;
        for (beta, rest) in &self.rests {
            let distance = rest.distance();
            farthest = max_or_nan(farthest, distance);
            if !(rest.is_stable() && distance <= allowed) {
                elsewhere.push(*beta);
            }
        }
        let count = self.rests.len();
        Check::that(
            count > 0 && elsewhere.is_empty(),
            "every moving beam comes to rest on a stable branch",
            format!(
                "{count} runs, at most {farthest:.1e} from an exact state; not on a stable branch: {}",
                list(&elsewhere)
            ),
        )
        .about(self.subject("ends of runs").by(ItemMethod::OneStep))
    }

    fn bent_below(&self) -> Check {
        let mut bent = f64::NEG_INFINITY;
        let mut straight = f64::INFINITY;
        let mut as_expected = true;
        for (beta, tip) in self.tips() {
            if tip.abs() > STRAIGHT {
                bent = bent.max(beta);
                as_expected &= beta < -BUCKLING;
            } else if tip.abs() <= STRAIGHT {
                straight = straight.min(beta);
                as_expected &= beta >= -BUCKLING;
            } else {
                as_expected = false;
            }
        }
        Check::that(
            bent < straight && as_expected,
            "moving beams come to rest bent below β = -0.7116 and straight above",
            format!("bent up to β = {bent}, straight from β = {straight}"),
        )
        .about(self.subject("bent ends of runs").by(ItemMethod::OneStep))
    }

    fn unambiguous(&self) -> Check {
        let ambiguous = self.diagram.ambiguous;
        Check::that(
            ambiguous == 0 && !self.diagram.branches.is_empty(),
            "contact, side and number of unstable directions tell all branches apart",
            format!("{ambiguous} states could belong to two branches"),
        )
        .about(self.subject("branches"))
    }

    /// Counting gives the ends of the bracket, analysis gives the number.
    fn buckles(&self) -> Check {
        let Interval { low, high } = self.diagram.event;
        let holds =
            low <= -BUCKLING + BRACKET && -BUCKLING <= high + BRACKET && high - low <= BRACKET;
        Check::that(
            holds,
            "the straight beam is the only steady state down to β = -(π²/4)/(1 + π²/4), and not below",
            format!(
                "several states up to {low:.10}, one from {high:.10}, for {:.10}",
                -BUCKLING
            ),
        )
        .about(self.subject("event"))
    }

    /// Proofs on both sides enclose the event that counting brackets.
    fn is_proved(&self) -> Check {
        let Interval { low, high } = self.diagram.proved;
        let event = self.diagram.event;
        let holds = high - low <= PROVED && low <= event.high && event.low <= high;
        Check::that(
            holds,
            "the β at which the steady states change is enclosed, by proofs on both sides",
            format!("between {low:?} and {high:?}"),
        )
        .about(self.subject("event, proved"))
    }

    fn one_state(&self) -> Check {
        let counts = &self.diagram.counts;
        let several: Vec<f64> = counts
            .iter()
            .filter(|(_, states)| *states != 1)
            .map(|(beta, _)| *beta)
            .collect();
        Check::that(
            !counts.is_empty() && several.is_empty(),
            "one steady state for every β of the diagram, even beyond buckling",
            format!(
                "{} values of β, with another number of states: {}",
                counts.len(),
                list(&several)
            ),
        )
        .about(self.subject("number of steady states"))
    }

    /// The whole diagram, and a close-up of the fork if there is one.
    fn figures(&self) -> Vec<Figure> {
        let theta_a = self.scene.beam.theta_a;
        let file = format!("theta-a-{theta_a}");
        let caption = format!(
            "Steady states over β for θ_A = {theta_a}: solid where stable, dashed where not; \
             open markers: where moving beams come to rest."
        );
        let fork = self.event();
        // A minus sign, not a hyphen.
        let event = format!("{fork:.4}").replace('-', "−");
        if !buckles(self.scene) {
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
            obstacles: figures::obstacle_lines(self.scene.obstacles),
            ends: tips.collect(),
        })
    }
}

pub(super) fn judge(study: &Bifurcation, results: &Results<'_, Bifurcation>) -> Findings {
    let scenes: Vec<OfScene<'_>> = (0..study.scenes.len())
        .map(|k| OfScene::new(study, results, k))
        .collect();
    let meshes = study.meshes.iter();
    let forces: Vec<f64> = meshes
        .map(|&n| results.of(&DiagramTask::Buckling(n)).force())
        .collect();
    let limit = extrapolated(&study.meshes, &forces);
    let mut checks = vec![discrete_limit(limit)];
    checks.extend(scenes.iter().flat_map(|scene| scene.checks(study)));
    let errors = forces.iter().map(|force| Some((force - BUCKLING).abs()));
    let column = ErrorColumn::new(
        "buckling force of P1 elements",
        Claim::new(ORDER, study.tolerance),
        errors,
    );
    let refinements = study
        .meshes
        .iter()
        .map(|&n| level_of_mesh(format!("n = {n}"), n));
    let levels = Levels::new(Axis::Space, refinements, [column]);
    let rates = levels.judge();
    let events: Vec<String> = scenes
        .iter()
        .map(|scene| format!("{:.6}", scene.event()))
        .collect();
    let headline = format!("buckling and lift-off at β = {}", events.join(", "));
    let ends: usize = scenes.iter().map(|scene| scene.rests.len()).sum();
    Findings {
        summary: format!(
            "{} diagrams, {} runs to rest; {headline}",
            scenes.len(),
            ends
        ),
        headline,
        checks,
        listings: vec![
            forces_over_meshes(&study.meshes, &forces, limit),
            rests(study, &scenes),
        ],
        figures: scenes.iter().flat_map(|scene| scene.figures()).collect(),
        quantities: scenes.iter().map(OfScene::guarded_event).collect(),
        ..Findings::default()
    }
    .with_orders(&levels, rates)
}

/// Numbers in words.
fn list(betas: &[f64]) -> String {
    let betas: Vec<String> = betas.iter().map(f64::to_string).collect();
    if betas.is_empty() {
        "none".to_owned()
    } else {
        betas.join(", ")
    }
}

/// The discrete buckling force for vanishing mesh width, from the last two meshes; NaN for fewer.
fn extrapolated(meshes: &[usize], forces: &[f64]) -> f64 {
    let (&[.., coarse, fine], &[.., before, last]) = (meshes, forces) else {
        return f64::NAN;
    };
    last + richardson::correction(before, last, fine as f64 / coarse as f64, ORDER)
}

fn discrete_limit(limit: f64) -> Check {
    let evidence = format!("extrapolated -{limit:.10} for -{BUCKLING:.10}");
    all(
        "P1 elements buckle at -(π²/4)/(1 + π²/4) as the mesh is refined, to 1e-8",
        Subject::of("buckling force"),
        [within(limit, BUCKLING, LIMIT, evidence)],
    )
}

fn lifts_off(diagram: &Diagram) -> Check {
    let Interval { low, high } = diagram.event;
    let evidence = format!("between {low:.9} and {high:.9}");
    all(
        "the heated beam leaves the upper obstacle at one β, and is free above",
        Subject::of("lift-off"),
        [at_most(high - low, BRACKET, evidence)],
    )
}

/// The row of a buckling force: with its sign, and its distance to the exact one.
fn force_row(label: String, force: Reading) -> Row {
    let above = force.value.map(|force| force - BUCKLING);
    let above = Reading::new("above -(π²/4)/(1 + π²/4)", above).scientific(3);
    let force = force.shown(|force| format!("-{force:.10}"));
    (vec![label], vec![force, above])
}

fn forces_over_meshes(meshes: &[usize], forces: &[f64], limit: f64) -> Listing {
    let mut rows = vec![];
    for (n, force) in meshes.iter().zip(forces) {
        let subject = Subject::of("buckling force").at(format!("n = {n}"));
        let force = Reading::new("β", *force)
            .guarded(format!("buckling force, n = {n}"), 1e-11)
            .about(subject);
        rows.push(force_row(n.to_string(), force));
    }
    rows.push(force_row(
        "extrapolated".to_owned(),
        Reading::new("β", limit),
    ));
    Listing::of("Buckling point of P1 elements", &["elements"], rows)
}

fn rests(study: &Bifurcation, scenes: &[OfScene<'_>]) -> Listing {
    let mut head = vec!["β".to_owned()];
    for scene in scenes {
        head.extend([
            format!("u(1) at rest, {}", scene.name()),
            "exact".to_owned(),
        ]);
    }
    let mut rows = vec![];
    for (place, beta) in study.rest.betas.iter().enumerate() {
        let mut row = vec![beta.to_string()];
        for scene in scenes {
            let (_, rest) = scene.rests[place];
            let tips = [rest.tip[0], rest.exact_tip()[0]];
            row.extend(tips.map(|tip| decimals(tip, 8)));
        }
        rows.push(row);
    }
    Table::new("Where moving beams come to rest", head, rows).into()
}
