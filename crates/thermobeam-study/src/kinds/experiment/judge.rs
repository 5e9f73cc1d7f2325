//! The sentences of Section 5, each a check with its numbers.

use super::plotted::{Plotted, U_TIP, largest_difference};
use super::runs::{OfGroup, Runs};
use super::{
    AtRest, Experiments, Found, Measured, PaperRun, SectionGroup, Task, Trace, straight_energy,
};
use crate::kinds::prelude::*;
use crate::kinds::runs::steady::name_of;

/// A first contact within this share of the figures' span counts as "at the beginning".
const BEGINNING: f64 = 0.1;

/// Distance from the exact steady state within which an experiment has arrived: the error of a
/// hundred elements and the remaining motion, a hundredth of the distance between the obstacles.
const ARRIVED: f64 = 1e-3;

/// The energy that remains, in units of its last fall per unit of time: no mode of these beams,
/// including heat conduction, decays more slowly than exp(-t/50).
const REMAINS: f64 = 50.0;

/// Largest change of the energy in a step: the round-off of an energy of order 1 to 10.
const ROUND_OFF: f64 = 1e-14;

/// Share of an error that can be neglected.
const NEGLIGIBLE: f64 = 0.02;

/// The β below which the paper's text claims several steady states.
const AS_PRINTED: f64 = -0.5;

/// A beam with a tip closer to zero than this is straight: bent tips start at some 0.01, the lower
/// obstacle.
const STRAIGHT: f64 = 1e-6;

/// Tolerance of a number that depends smoothly on the data: far above round-off, below any change
/// of method.
const SMOOTH: f64 = 1e-6;

/// The same if many bounces lie between the data and the number: each amplifies a perturbation.
const AFTER_BOUNCES: f64 = 1e-4;

/// The same for numbers that depend on when an iteration stops: rounding decides where an increment
/// is close to the tolerance.
const OF_ITERATIONS: f64 = 1e-2;

impl Runs<'_> {
    /// The largest error of u(1, t) by the paper's algorithm; `None` if the study does not run
    /// that.
    fn error_of_paper(&self) -> Option<f64> {
        let tip = |trace: &Trace| U_TIP.points(self.experiment, trace);
        let paper = tip(&self.paper?.trace);
        let exact = tip(&self.first.trace);
        Some(largest_difference(plots::Scale::Linear, &exact, &paper))
    }

    /// The numbers of the experiment.
    pub(super) fn readings(&self) -> Vec<Reading> {
        let name = &self.experiment.scene.name;
        let bent = self.experiment.group != SectionGroup::First;
        let mut readings = self.trace().readings(name);
        readings.extend(self.first.readings(name, bent));
        readings
    }
}

impl Trace {
    /// * `name`: the experiment's.
    pub(super) fn readings(&self, name: &str) -> Vec<Reading> {
        let of = |reading: Reading, guard: &str, tolerance: f64| {
            reading
                .fixed(4)
                .guarded(format!("{name}: {guard}"), tolerance)
        };
        vec![
            of(
                Reading::new("first contact above", self.first_upper),
                "first_upper",
                SMOOTH,
            ),
            of(
                Reading::new("below", self.first_lower),
                "first_lower",
                AFTER_BOUNCES,
            ),
            of(
                Reading::new("frequency of u(1)", self.frequency),
                "frequency",
                AFTER_BOUNCES,
            ),
            of(
                Reading::new("range of φ(1)", self.phi_amplitude),
                "phi_amplitude",
                AFTER_BOUNCES,
            ),
            Reading::new("largest change of the energy", self.largest_increase),
            Reading::new("largest residual of the balance", self.largest_residual),
        ]
    }
}

impl PaperRun {
    /// * `name`: the experiment's.
    pub(super) fn readings(&self, name: &str) -> Vec<Reading> {
        let of = |reading: Reading, guard: &str| reading.guarded_in(name, guard, OF_ITERATIONS);
        let solvers = &self.solvers;
        let per_step = Reading::new("iterations per step", solvers.mean_iterations).fixed(4);
        let distance = Reading::new("distance to Newton's solution", solvers.distance);
        vec![
            of(per_step, "iterations_per_step"),
            Reading::text("most", solvers.most_iterations.to_string()),
            of(distance.scientific(2), "distance_to_newton"),
            Reading::new("largest change of the energy", self.trace.largest_increase).scientific(1),
            Reading::new(
                "largest residual of its balance",
                self.trace.largest_residual,
            )
            .scientific(1),
        ]
    }
}

impl Measured {
    /// * `name`: the experiment's; `bent`: whether the end is nonzero; the digits of zero are those
    ///   of the remaining motion.
    pub(super) fn readings(&self, name: &str, bent: bool) -> Vec<Reading> {
        let ends = |reading: Reading, guard: &str| {
            if bent {
                reading.guarded_in(name, guard, SMOOTH)
            } else {
                reading
            }
        };
        let exact = self.end.nearest.map(|nearest| nearest.state.u_tip);
        vec![
            Reading::new("steady by t", self.end.t).fixed(0),
            ends(Reading::new("E at the end", self.energy).fixed(8), "energy"),
            Reading::new("u(1)", self.end.tip[0]).scientific(3),
            Reading::new("φ(1)", self.end.tip[1]).scientific(3),
            ends(
                Reading::new("u(1) of the exact state", exact),
                "exact_u_tip",
            )
            .about(
                Subject::of("exact_u_tip")
                    .in_case(name)
                    .by(ItemMethod::Exact),
            ),
            Reading::new("contact force", self.contact_force),
            Reading::new("largest field", self.largest_field),
            Reading::new("distance to a steady state", self.end.distance()),
        ]
    }
}

impl AtRest {
    pub(super) fn readings(&self) -> Vec<Reading> {
        let distance = Reading::new("distance to the nearest", self.distance());
        vec![
            Reading::text("steady states", self.count()),
            Reading::text("stable", self.stable.to_string()),
            Reading::new("u(1) at rest", self.tip[0]).scientific(6),
            distance.shown(|distance| {
                if self.nearest.is_some() {
                    format!("{distance:.1e}")
                } else {
                    "-".to_owned()
                }
            }),
            Reading::new("at rest by t", self.t).fixed(0),
        ]
    }
}

/// The runs to rest that completed, each with its β.
pub(super) fn rests<'r>(
    study: &Experiments,
    ran: &'r [Ran<Task, Found>],
) -> Vec<(f64, &'r AtRest)> {
    let rest = |(k, &beta): (usize, &f64)| match found(ran, &Task::Rest(k)) {
        Some(Found::Rest(rest)) => Some((beta, rest)),
        _ => None,
    };
    study
        .rest
        .betas
        .iter()
        .enumerate()
        .filter_map(rest)
        .collect()
}

/// * `plotted`: the figures.
pub(super) fn checks(
    study: &Experiments,
    ran: &[Ran<Task, Found>],
    rests: &[(f64, &AtRest)],
    plotted: &[Plotted],
) -> Vec<Check> {
    let mut checks = vec![completion(ran, |found| {
        readings::not_finite(&match found {
            Found::Run(run) => [run.trace.readings(""), run.readings("", true)].concat(),
            Found::FixedPoint(run) => [run.trace.readings(""), run.readings("")].concat(),
            Found::Rest(rest) => rest.readings(),
        })
    })];
    checks.extend(
        claims(study, ran)
            .into_iter()
            .map(|check| check.stated_by(Origin::Source)),
    );
    checks.extend(counts(rests, rests.len() == study.rest.betas.len()));
    checks.push(thin_lines(plotted));
    if study.fixed_point.is_some() {
        checks.push(solved(&OfGroup::of(study, ran, |_| true)));
    }
    checks
}

/// The tolerance η* of the paper's algorithm leaves an error that does not matter.
///
/// With ‖φ‖ <= (2/π) ‖φ_x‖, the norm d of (3.14) bounds |u(1)| <= ‖u_x‖ <= ‖u_x - φ‖ + ‖φ‖ <= (1 +
/// 4/π²)^½ d.
fn solved(all: &OfGroup<'_>) -> Check {
    let of_tip = |runs: &Runs<'_>| {
        let distance = runs.paper.map_or(f64::NAN, |paper| paper.solvers.distance);
        distance / BUCKLING.sqrt()
    };
    let error = |runs: &Runs<'_>| runs.error_of_paper().unwrap_or(f64::NAN);
    let evidence = |runs: &Runs<'_>| {
        let name = &runs.experiment.scene.name;
        format!("{name} {:.1e} of {:.1e}", of_tip(runs), error(runs))
    };
    Check::that(
        all.all(|runs| of_tip(runs) <= NEGLIGIBLE * error(runs)),
        format!("η* causes at most {NEGLIGIBLE} of the error of u(1, t)"),
        all.runs.iter().map(evidence).collect::<Vec<_>>().join(", "),
    )
    .about(Subject::of("distance to Newton's solution").by(ItemMethod::FixedPoint))
}

/// The figures are drawn from curves whose error cannot be seen.
fn thin_lines(plotted: &[Plotted]) -> Check {
    let of_figure = |plot: &Plotted| format!("{} {:.0e}", plot.what, plot.error());
    Check::that(
        !plotted.is_empty() && plotted.iter().all(|plot| plot.error() < 1.0),
        "the error of each curve in the figures is below the width of its line",
        format!(
            "largest error over the width: {}",
            plotted.iter().map(of_figure).collect::<Vec<_>>().join(", ")
        ),
    )
    .about(Subject::of("curves of the figures").by(ItemMethod::AnyOrder))
}

/// A time that may be missing.
fn time(t: Option<f64>) -> String {
    t.map_or_else(|| "never".to_owned(), |t| format!("t = {t:.4}"))
}

/// All checks of the text except the number of steady states.
fn claims(study: &Experiments, ran: &[Ran<Task, Found>]) -> Vec<Check> {
    let all = OfGroup::of(study, ran, |_| true);
    let first = OfGroup::of(study, ran, |group| group == SectionGroup::First);
    let increases = all.runs.iter().map(|runs| {
        let increase = runs.trace().largest_increase;
        format!("{} {increase:.1e}", runs.experiment.scene.name)
    });
    let mut checks = vec![
        Check::that(
            all.all(|runs| runs.trace().largest_increase <= ROUND_OFF),
            "the energy rises in none of the experiments",
            format!(
                "largest change in a step: {}",
                increases.collect::<Vec<_>>().join(", ")
            ),
        )
        .about(Subject::of("energy")),
    ];
    checks.extend(ends_straight(&first, REMAINS * study.rate));
    checks.extend(moves(&first));
    // If a run is missing, the check of completion has failed.
    checks.extend(
        all.runs
            .iter()
            .filter_map(|runs| match runs.experiment.group {
                SectionGroup::First => None,
                SectionGroup::Second(contact) => Some(comes_to_rest(runs, contact)),
                SectionGroup::Third => Some(ends_bent(runs)),
            }),
    );
    checks
}

/// * `allowed`: upper bound on the remaining energy.
fn ends_straight(group: &OfGroup<'_>, allowed: f64) -> [Check; 2] {
    let energies = group.list(|runs| {
        format!(
            "{:.9} for {:.9} at t = {:.0}",
            runs.first.energy,
            straight_energy(&runs.experiment.scene),
            runs.first.end.t
        )
    });
    let remains =
        |runs: &Runs<'_>| (runs.first.energy - straight_energy(&runs.experiment.scene)).abs();
    [
        Check::that(
            group.all(|runs| remains(runs) <= allowed),
            format!("the energy falls to β²/(4ρ), to {allowed:.1e}"),
            energies,
        )
        .about(Subject::of("energy at rest").in_case("θ_A = 0")),
        Check::that(
            group.all(|runs| runs.first.largest_field <= ARRIVED),
            "the evolution is towards u = φ = θ = 0",
            format!(
                "largest of the three fields: {}",
                group.list(|runs| format!("{:.1e}", runs.first.largest_field))
            ),
        )
        .about(Subject::of("fields at rest").in_case("θ_A = 0")),
    ]
}

/// First contacts, frequency and amplitude; the experiments are in ascending order of β.
fn moves(group: &OfGroup<'_>) -> [Check; 3] {
    let is_early = |runs: &Runs<'_>, contact: Option<f64>| {
        contact.is_some_and(|t| t > 0.0 && t <= BEGINNING * runs.experiment.scene.t_end)
    };
    let touches_both = |runs: &Runs<'_>| {
        is_early(runs, runs.trace().first_upper) && is_early(runs, runs.trace().first_lower)
    };
    let contacts = group.list(|runs| {
        let Trace {
            first_upper,
            first_lower,
            ..
        } = runs.trace();
        format!("upper {}, lower {}", time(*first_upper), time(*first_lower))
    });
    let frequency = |runs: &Runs<'_>| runs.trace().frequency.unwrap_or(f64::NAN);
    let several = group.complete && group.runs.len() >= 2;
    let grows = group
        .runs
        .windows(2)
        .all(|pair| frequency(&pair[0]) < frequency(&pair[1]));
    let frequencies = group.list(|runs| {
        let crossings = runs.trace().crossings;
        format!("{:.4} from {crossings} upward crossings", frequency(runs))
    });
    let amplitude = |runs: &Runs<'_>| runs.trace().phi_amplitude;
    let (beta, largest) = group.runs.first().map_or((f64::NAN, f64::NAN), |runs| {
        (runs.experiment.scene.beam.beta, amplitude(runs))
    });
    let is_largest = group
        .runs
        .iter()
        .skip(1)
        .all(|runs| largest > amplitude(runs));
    let amplitudes = group.list(|runs| format!("{:.4}", amplitude(runs)));
    [
        Check::that(
            group.all(touches_both),
            "at the beginning the beam touches both obstacles",
            format!("first contacts: {contacts}"),
        )
        .about(Subject::of("first contact")),
        Check::that(
            several && grows,
            "the frequency of oscillation grows with β",
            format!("frequency of u(1), in the order of β, not of |β|: {frequencies}"),
        )
        .about(Subject::of("frequency")),
        Check::that(
            several && is_largest,
            format!("the oscillations of φ(1) are largest for β = {beta}"),
            format!("largest minus smallest φ(1): {amplitudes}"),
        )
        .about(Subject::of("phi_amplitude")),
    ]
}

fn comes_to_rest(runs: &Runs<'_>, contact: Phase) -> Check {
    let run = runs.first;
    let presses = match contact {
        Phase::Upper => run.contact_force > 0.0,
        Phase::Lower => run.contact_force < 0.0,
        Phase::Free => run.contact_force == 0.0,
    };
    let Scene { beam, .. } = &runs.experiment.scene;
    let place = if contact == Phase::Free {
        "free of both obstacles"
    } else {
        name_of(contact)
    };
    let is_there = run.end.contact() == Some(contact);
    Check::that(
        presses && is_there && has_arrived(run),
        format!("at the steady state the beam is {place}"),
        at_rest(run),
    )
    .about(
        Subject::of("contact at rest")
            .in_case(format!("θ_A = {}, β = {}", beam.theta_a, beam.beta)),
    )
}

fn ends_bent(runs: &Runs<'_>) -> Check {
    let run = runs.first;
    Check::that(
        run.end.tip[0].abs() > ARRIVED && has_arrived(run),
        "the stationary solution is not zero",
        format!("{}, one of {} steady states", at_rest(run), run.end.count()),
    )
    .about(Subject::of("end").in_case(format!("β = {}", runs.experiment.scene.beam.beta)))
}

/// Whether the end is an exact, stable steady state.
fn has_arrived(run: &Measured) -> bool {
    run.end.is_stable() && run.end.distance() <= ARRIVED
}

fn at_rest(run: &Measured) -> String {
    let ([u, _], [exact, _]) = (run.end.tip, run.end.exact_tip());
    let force = format!(
        "contact force {:.6}, at t = {:.0}",
        run.contact_force, run.end.t
    );
    format!("u(1) = {u:.9}, {force}; the exact state has u(1) = {exact:.9}")
}

/// The paper's last sentence: how many steady states there are below β = -1/2, and in which a
/// moving beam comes to rest.
///
/// * `complete`: whether every β has a result; otherwise no claim holds.
fn counts(rests: &[(f64, &AtRest)], complete: bool) -> [Check; 3] {
    let alone_and_straight = |rest: &AtRest| rest.states == 1 && rest.tip[0].abs() <= STRAIGHT;
    let claim = |range: AxialForce, holds: fn(&AtRest) -> bool, text: &str, more: &str| {
        let within: Vec<_> = rests
            .iter()
            .filter(|(beta, _)| AxialForce::of(*beta) == Some(range))
            .collect();
        let holds = complete && !within.is_empty() && within.iter().all(|(_, rest)| holds(rest));
        let evidence = |(beta, rest): &&(f64, &AtRest)| {
            format!(
                "β = {beta}: {} of them, at rest u(1) = {:.2e}",
                rest.count(),
                rest.tip[0]
            )
        };
        let each: Vec<String> = within.iter().map(evidence).collect();
        let evidence = if each.is_empty() {
            "no β in this range".to_owned()
        } else {
            each.join("; ")
        };
        Check::that(holds, text, evidence + more).about(Subject::of(range.quantity()))
    };
    let bent = |rest: &AtRest| {
        rest.states >= 3 && rest.stable >= 2 && rest.tip[0].abs() > STRAIGHT && rest.is_stable()
    };
    let unique = "uniqueness for β > -1/2: the straight beam is the only steady state, and moving beams come to rest in it";
    let one = "not as printed (\"for β < -1/2 there are multiple steady-state solutions\"): for -0.7116 ≤ β ≤ -1/2 \
               there is only one, the straight beam";
    let convex = format!(
        "; the potential energy is strictly convex for β ≥ -(π²/4)/(1 + π²/4) = {:.6}",
        -BUCKLING
    );
    let several = "for β < -0.7116 there are several steady states, two of them stable, and moving beams come to rest bent";
    [
        claim(AxialForce::AsPrinted, alone_and_straight, unique, "").stated_by(Origin::Source),
        claim(AxialForce::Refuted, alone_and_straight, one, &convex).stated_by(Origin::Correction),
        claim(AxialForce::BeyondBuckling, bent, several, ""),
    ]
}

/// Where an axial force at rest lies, which decides what is claimed of it.
///
/// At β = -1/2 the paper claims nothing, and the straight beam is the only steady state, as above.
/// The same holds at β = -B: the quadratic part of the potential energy is not negative there, and
/// vanishes only along the buckling mode, along which ρ/4 ‖u_x‖⁴ is strictly convex. So both ends
/// belong to the range between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum AxialForce {
    /// β > -1/2: one steady state, as the paper says.
    AsPrinted,
    /// -B <= β <= -1/2: one steady state, against the paper.
    Refuted,
    /// β < -B: several steady states.
    BeyondBuckling,
}

impl AxialForce {
    /// What is claimed of it, as a quantity.
    fn quantity(self) -> &'static str {
        match self {
            Self::AsPrinted => "steady states as printed",
            Self::Refuted => "steady states against the paper",
            Self::BeyondBuckling => "steady states beyond buckling",
        }
    }

    /// `None` for NaN alone.
    fn of(beta: f64) -> Option<Self> {
        if beta > AS_PRINTED {
            Some(Self::AsPrinted)
        } else if beta >= -BUCKLING {
            Some(Self::Refuted)
        } else if beta < -BUCKLING {
            Some(Self::BeyondBuckling)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermobeam_exact::equilibrium::equilibria;

    /// The number of steady states is that of the claim, at both ends of each range and next to
    /// them.
    #[test]
    fn each_axial_force_falls_under_the_claim_that_is_true_of_it() {
        let rows = [
            (-0.4999, AxialForce::AsPrinted),
            (-0.5, AxialForce::Refuted),
            (-0.6, AxialForce::Refuted),
            (-BUCKLING, AxialForce::Refuted),
            (-BUCKLING - 1e-6, AxialForce::BeyondBuckling),
            (-0.8, AxialForce::BeyondBuckling),
        ];
        for (beta, expected) in rows {
            assert_eq!(AxialForce::of(beta), Some(expected), "{beta}");
            let beam = Beam {
                beta,
                ..Beam::default()
            };
            let states = equilibria(&beam, Some(&Obstacles::default()))
                .unwrap()
                .len();
            let is_several = expected == AxialForce::BeyondBuckling;
            assert_eq!(states > 1, is_several, "β = {beta}: {states} states");
        }
        assert_eq!(AxialForce::of(f64::NAN), None);
    }
}
