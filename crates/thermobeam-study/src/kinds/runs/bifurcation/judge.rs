//! The claims: where the beam buckles and lifts off, and that moving beams come to rest on stable
//! branches; tables, figures and guarded numbers.

use std::cmp::Ordering;

use super::{
    AtRest, BRACKET, BifurcationStudy, BranchKey, CLOSE, Diagram, DiagramTask, Found, SteadyBranch,
};
use crate::kinds::prelude::*;

/// A beam with a tip closer to zero than this is straight.
const STRAIGHT: f64 = 1e-6;

/// Allowed error of the extrapolated buckling force of P1 elements.
const LIMIT: f64 = 1e-8;

/// The results of one scene; `None` if a case failed.
struct DiagramOf<'r> {
    scene: &'r Scene,
    diagram: Option<&'r Diagram>,
    /// Each β with its run to rest.
    rests: Vec<(f64, Option<&'r AtRest>)>,
}

impl<'r> DiagramOf<'r> {
    fn of(study: &'r BifurcationStudy, ran: &'r [Ran<DiagramTask, Found>], k: usize) -> Self {
        let diagram = match found(ran, &DiagramTask::Diagram(k)) {
            Some(Found::Diagram(diagram)) => Some(diagram),
            _ => None,
        };
        let rest = |(place, &beta): (usize, &f64)| match found(ran, &DiagramTask::Rest(k, place)) {
            Some(Found::Rest(rest)) => (beta, Some(rest)),
            _ => (beta, None),
        };
        Self {
            scene: &study.scenes[k],
            diagram,
            rests: study.rest.betas.iter().enumerate().map(rest).collect(),
        }
    }

    fn theta_a(&self) -> f64 {
        self.scene.beam.theta_a
    }

    /// The lower end of the bracket of buckling or lift-off; NaN if the case failed.
    fn event(&self) -> f64 {
        self.diagram.map_or(f64::NAN, |diagram| diagram.event[0])
    }

    fn guarded_event(&self) -> Quantity {
        let theta_a = format!("θ_A = {}", self.theta_a());
        let name = format!("event at {theta_a}");
        Quantity::new(name, self.event(), 1e-8).about(Subject::of("event").in_case(theta_a))
    }

    /// β and u(1) at rest; NaN if the case failed.
    fn tips(&self) -> impl Iterator<Item = (f64, f64)> {
        self.rests
            .iter()
            .map(|(beta, rest)| (*beta, rest.map_or(f64::NAN, |rest| rest.tip[0])))
    }

    fn checks(&self, study: &BifurcationStudy) -> Vec<Check> {
        let mut checks = vec![self.ends_are_stable(study.distance)];
        // Without a diagram, the check of completion has failed already.
        if let Some(diagram) = self.diagram {
            checks.push(self.unambiguous(diagram));
            checks.extend(match super::buckles(self.scene) {
                true => [buckles(diagram), self.bent_below()],
                false => [lifts_off(diagram), self.one_state(diagram)],
            });
        }
        checks
    }

    fn ends_are_stable(&self, allowed: f64) -> Check {
        let is_stable = |rest: &AtRest| rest.is_stable() && rest.distance() <= allowed;
        let distances = self
            .rests
            .iter()
            .map(|(_, rest)| rest.map_or(f64::NAN, AtRest::distance));
        let farthest = distances.fold(0.0, max_or_nan);
        let elsewhere = self
            .rests
            .iter()
            .filter(|(_, rest)| !rest.is_some_and(is_stable));
        let elsewhere: Vec<f64> = elsewhere.map(|(beta, _)| *beta).collect();
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

    fn subject(&self, quantity: &str) -> Subject {
        Subject::of(quantity).in_case(format!("θ_A = {}", self.theta_a()))
    }

    fn bent_below(&self) -> Check {
        let is_bent = |u_tip: f64| u_tip.abs() > STRAIGHT;
        let as_expected = |(beta, tip): (f64, f64)| {
            if beta < -BUCKLING {
                is_bent(tip)
            } else {
                tip.abs() <= STRAIGHT
            }
        };
        let bent = self
            .tips()
            .filter(|(_, tip)| is_bent(*tip))
            .map(|(beta, _)| beta)
            .fold(f64::NEG_INFINITY, f64::max);
        let straight = self
            .tips()
            .filter(|(_, tip)| tip.abs() <= STRAIGHT)
            .map(|(beta, _)| beta);
        let straight = straight.fold(f64::INFINITY, f64::min);
        Check::that(
            bent < straight && self.tips().all(as_expected),
            "moving beams come to rest bent below β = -0.7116 and straight above",
            format!("bent up to β = {bent}, straight from β = {straight}"),
        )
        .about(self.subject("bent ends of runs").by(ItemMethod::OneStep))
    }

    fn unambiguous(
        &self,
        Diagram {
            ambiguous,
            branches,
            ..
        }: &Diagram,
    ) -> Check {
        let claim = "contact, side and number of unstable directions tell all branches apart";
        Check::that(
            *ambiguous == 0 && !branches.is_empty(),
            claim,
            format!("{ambiguous} states could belong to two branches"),
        )
        .about(self.subject("branches"))
    }

    fn one_state(&self, Diagram { counts, .. }: &Diagram) -> Check {
        let several = counts.iter().filter(|(_, n)| *n != 1);
        let several: Vec<f64> = several.map(|(beta, _)| *beta).collect();
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
        let Some(diagram) = self.diagram else {
            return vec![];
        };
        let theta_a = self.theta_a();
        let markers =
            "solid where stable, dashed where not; open markers: where moving beams come to rest";
        let caption = format!("Steady states over β for θ_A = {theta_a}: {markers}.");
        let fork = diagram.event[0];
        let is_fork = super::buckles(self.scene);
        // A minus sign, not a hyphen.
        let event = format!("{fork:.4}").replace('-', "−");
        let (title, end) = if is_fork {
            // Above the fork there is the straight beam alone.
            (
                format!("Several steady states below β = {event}, one above"),
                fork + 2.0 * CLOSE,
            )
        } else {
            (
                format!("One steady state for every β; it lifts off at β = {event}"),
                f64::INFINITY,
            )
        };
        let whole = self.drawing(diagram, title, [f64::NEG_INFINITY, end]);
        let mut figures = vec![Figure::new(&format!("theta-a-{theta_a}"), caption, whole)];
        if is_fork {
            let title = "The beam bends until its free end meets an obstacle".to_owned();
            let caption = "The same near the buckling point: the fork opens until the free end meets an obstacle.";
            let close = self.drawing(diagram, title, [fork - CLOSE, fork + CLOSE]);
            figures.push(Figure::new(
                &format!("theta-a-{theta_a}-fork"),
                caption,
                close,
            ));
        }
        figures
    }

    fn drawing(&self, diagram: &Diagram, title: String, range: [f64; 2]) -> String {
        let shown = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
            points
                .iter()
                .copied()
                .filter(|(beta, _)| (range[0]..=range[1]).contains(beta))
                .collect()
        };
        let curve = |branch: &SteadyBranch| figures::Branch {
            label: branch_name(&branch.key).to_owned(),
            points: shown(&branch.points),
            stable: branch.key.stable,
        };
        let mut branches: Vec<figures::Branch> = vec![];
        for next in diagram.branches.iter().map(curve) {
            // The straight beam is one branch, whatever the number of its unstable directions.
            let known = branches.iter_mut().find(|known| {
                next.label == NAMES[0] && (&known.label, known.stable) == (&next.label, next.stable)
            });
            match known {
                Some(known) => known.points.extend(next.points),
                None => branches.push(next),
            }
        }
        // A branch found at a single β is a corner of the diagram, not a line.
        branches.retain(|branch| branch.points.len() > 1);
        let place = |branch: &figures::Branch| {
            (
                NAMES.iter().position(|name| *name == branch.label),
                !branch.stable,
            )
        };
        branches.sort_by_key(place);
        let ends = plots::Series::new("end of a run", shown(&self.tips().collect::<Vec<_>>()));
        figures::bifurcation(&figures::Bifurcation {
            title,
            branches,
            obstacles: figures::obstacle_lines(self.scene.obstacles),
            ends,
        })
    }
}

/// Names of branches, in the order of the legend.
const NAMES: [&str; 4] = [
    "straight",
    "bent, free",
    "on the upper obstacle",
    "on the lower obstacle",
];

fn branch_name(key: &BranchKey) -> &'static str {
    let place = match (key.contact, key.side) {
        (Phase::Free, Some(Ordering::Equal)) => 0,
        (Phase::Free, _) => 1,
        (Phase::Upper, _) => 2,
        (Phase::Lower, _) => 3,
    };
    NAMES[place]
}

pub(super) fn judge(study: &BifurcationStudy, ran: &[Ran<DiagramTask, Found>]) -> Outcome {
    let scenes: Vec<DiagramOf<'_>> = (0..study.scenes.len())
        .map(|k| DiagramOf::of(study, ran, k))
        .collect();
    let force = |&n: &usize| match found(ran, &DiagramTask::Buckling(n)) {
        Some(Found::Force(force)) => (n, *force),
        _ => (n, f64::NAN),
    };
    let forces: Vec<(usize, f64)> = study.meshes.iter().map(force).collect();
    let mut checks = vec![completion(ran, numbers_not_finite), discrete_limit(&forces)];
    checks.extend(scenes.iter().flat_map(|of| of.checks(study)));
    let refinement =
        |&n: &usize| Refinement::new(format!("n = {n}"), &[("elements", n)], 1.0 / n as f64);
    let errors = forces
        .iter()
        .map(|(_, force)| Some((force - BUCKLING).abs()))
        .collect();
    let (name, claim) = (
        "buckling force of P1 elements".to_owned(),
        Some(Claim::new(2.0, study.tolerance)),
    );
    let column = ErrorColumn {
        name,
        symbol: None,
        errors,
        claim,
        look: 0,
    };
    let levels = Levels::new(Axis::Space, study.meshes.iter().map(refinement), [column]);
    let rates = levels.judge();
    let events = scenes.iter().map(DiagramOf::guarded_event);
    let guarded = forces.iter().map(guarded_force);
    let at: Vec<String> = scenes
        .iter()
        .map(|of| format!("{:.6}", of.event()))
        .collect();
    let headline = format!("buckling and lift-off at β = {}", at.join(", "));
    let (diagrams, runs) = (
        study.scenes.len(),
        study.scenes.len() * study.rest.betas.len(),
    );
    let ends = scenes.iter().flat_map(|of| &of.rests);
    let left_out = ends.map(|(_, rest)| rest.is_none().then_some(NO_RESULT));
    Outcome {
        coverage: vec![Coverage::of("runs to rest", left_out)],
        tables: vec![force_table(&forces), rest_table(study, &scenes)],
        figures: scenes.iter().flat_map(|of| of.figures()).collect(),
        quantities: events
            .chain(guarded)
            .chain(levels.quantities(&rates))
            .collect(),
        levels: levels.errors(),
        headline: headline.clone(),
        ..Outcome::new(
            format!("{diagrams} diagrams, {runs} runs to rest; {headline}"),
            rates,
            checks,
        )
    }
}

fn guarded_force((n, force): &(usize, f64)) -> Quantity {
    let subject = Subject::of("buckling force").at(format!("n = {n}"));
    Quantity::new(format!("buckling force, n = {n}"), *force, 1e-11).about(subject)
}

fn numbers_not_finite(found: &Found) -> Vec<String> {
    not_finite(match found {
        Found::Diagram(Diagram {
            event: [low, high], ..
        }) => vec![("event, below", *low), ("event, above", *high)],
        Found::Force(force) => vec![("force", *force)],
        Found::Rest(rest) => vec![("u(1)", rest.tip[0]), ("distance", rest.distance())],
    })
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

/// The discrete buckling force for vanishing mesh width, from the last two meshes.
fn extrapolated(forces: &[(usize, f64)]) -> f64 {
    let &[.., (coarse, before), (fine, last)] = forces else {
        return f64::NAN;
    };
    last + richardson::correction(before, last, fine as f64 / coarse as f64, 2.0)
}

fn discrete_limit(forces: &[(usize, f64)]) -> Check {
    let limit = extrapolated(forces);
    Check::that(
        (limit - BUCKLING).abs() <= LIMIT,
        "P1 elements buckle at -(π²/4)/(1 + π²/4) as the mesh is refined, to 1e-8",
        format!("extrapolated -{limit:.10} for -{BUCKLING:.10}"),
    )
    .about(Subject::of("buckling force"))
}

fn buckles(diagram: &Diagram) -> Check {
    let [low, high] = diagram.event;
    // Counting gives the ends of the bracket, analysis gives the number.
    let holds = low <= -BUCKLING + BRACKET && -BUCKLING <= high + BRACKET && high - low <= BRACKET;
    Check::that(
        holds,
        "the straight beam is the only steady state down to β = -(π²/4)/(1 + π²/4), and not below",
        format!(
            "several states up to {low:.10}, one from {high:.10}, for {:.10}",
            -BUCKLING
        ),
    )
    .about(Subject::of("event").in_case("θ_A = 0"))
}

fn lifts_off(diagram: &Diagram) -> Check {
    let [low, high] = diagram.event;
    let claim = "the heated beam leaves the upper obstacle at one β, and is free above";
    Check::that(
        high - low <= BRACKET,
        claim,
        format!("between {low:.9} and {high:.9}"),
    )
    .about(Subject::of("lift-off"))
}

fn force_table(forces: &[(usize, f64)]) -> Table {
    let row = |name: String, force: f64| {
        vec![
            name,
            format!("-{force:.10}"),
            format!("{:.3e}", force - BUCKLING),
        ]
    };
    let rows = forces.iter().map(|(n, force)| row(n.to_string(), *force));
    let last = row("extrapolated".to_owned(), extrapolated(forces));
    let head = ["elements", "β", "above -(π²/4)/(1 + π²/4)"];
    Table::new("Buckling point of P1 elements", head, rows.chain([last]))
}

fn rest_table(study: &BifurcationStudy, scenes: &[DiagramOf<'_>]) -> Table {
    let readings = |k: usize, of: &DiagramOf<'_>| {
        let rest = of.rests[k].1;
        let exact = rest.map_or(f64::NAN, |rest| rest.exact_tip()[0]);
        [
            decimals(rest.map_or(f64::NAN, |rest| rest.tip[0]), 8),
            decimals(exact, 8),
        ]
    };
    let row = |(k, beta): (usize, &f64)| {
        std::iter::once(beta.to_string())
            .chain(scenes.iter().flat_map(|of| readings(k, of)))
            .collect()
    };
    let of_scene = |of: &DiagramOf<'_>| {
        [
            format!("u(1) at rest, θ_A = {}", of.theta_a()),
            "exact".to_owned(),
        ]
    };
    let head = std::iter::once("β".to_owned()).chain(scenes.iter().flat_map(of_scene));
    Table::new(
        "Where moving beams come to rest",
        head,
        study.rest.betas.iter().enumerate().map(row),
    )
}
