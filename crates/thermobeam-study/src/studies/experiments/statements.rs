//! The sentences of Section 5, each a table of the numbers that show it: the paper's as printed,
//! what holds in place of one that does not, and ours.

use super::figures;
use super::plotted::{Plotted, U_TIP, largest_difference};
use super::{OfExperiment, PaperRun, SectionFive, SteadyRun, Trace, rests};
use crate::studies::paper::{Experiment, FIRST, SECOND, T_END};
use crate::studies::prelude::*;
use crate::studies::steady::{AtRest, name_of};
use convergence_study::Figure;
use thermobeam::kirchhoff::BUCKLING;
use thermobeam_exact::equilibrium::Phase;

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

/// Where the heated beams come to rest, β ascending.
const RESTS_ON: [Phase; SECOND.len()] = [Phase::Upper, Phase::Upper, Phase::Free];

/// Numbers of the first three experiments, which the paper shows in figures without printing them:
/// first contacts above and below, frequency, range of φ(1). dG gave them; the paper's own
/// algorithm at h = 1e-2, dt = 1e-4 is within 5e-4 of each.
const MOTIONS: [[f64; 4]; FIRST.len()] = [
    [0.217_341, 0.911_357, 0.341_148, 0.336_345],
    [0.203_413, 0.858_234, 0.413_616, 0.237_139],
    [0.144_932, 0.498_252, 0.821_006, 0.091_158],
];

/// Distance to these numbers within which both discretisations lie. They differ by up to 3.4e-5, in
/// the frequency for β = 5.
const AGREED: f64 = 1e-4;

/// Tolerance of a number that depends smoothly on the data: far above round-off, below any change
/// of method.
const SMOOTH: f64 = 1e-6;

/// The same if many bounces lie between the data and the number: each amplifies a perturbation.
const AFTER_BOUNCES: f64 = 1e-4;

/// The same for numbers that depend on when an iteration stops: rounding decides where an increment
/// is close to the tolerance.
const OF_ITERATIONS: f64 = 1e-2;

pub(super) fn judge(
    study: &SectionFive,
    runs: &[OfExperiment<'_>],
    rests: &[(f64, &AtRest)],
) -> Outcome {
    let (first, others) = runs.split_at(FIRST.len());
    let (second, third) = others.split_at(SECOND.len());
    let plotted = figures::plotted([first, second, third]);
    let mut printed = vec![
        never_rises(runs),
        energy_at_rest(first, study.rate),
        becomes_straight(first),
        touches_both(first),
        frequency_grows(first),
        amplitude_is_largest(first),
    ];
    let at_rest = second.iter().zip(RESTS_ON);
    printed.extend(at_rest.map(|(runs, contact)| comes_to_rest(runs, contact)));
    printed.extend(third.iter().map(ends_bent));
    printed.push(rests::unique(rests));
    let corrected = rests::unique_below(rests);
    let mut own = vec![
        rests::several(rests),
        motion_is_known(first),
        lines_are_thick(&plotted),
    ];
    own.extend(study.fixed_point.map(|by| solved(runs, by.tolerance)));
    let headline = headline(&printed, &corrected, &own);
    let numbers = runs.iter().flat_map(OfExperiment::numbers);
    let mut sheets = vec![Sheet::new("The seven experiments", "experiment", numbers)];
    sheets.extend(printed.into_iter().chain([corrected]).chain(own));
    let drawn = plotted.iter().map(|plot| {
        let title = &plot.chart.title;
        let caption = format!("{}: {title}. {}.", plot.name, plot.accuracy().join(". "));
        Figure::new(plot.what, caption, plot.draw())
    });
    Outcome {
        figures: drawn.collect(),
        ..Outcome::of_sheets(sheets, "").headed(headline)
    }
}

/// How many statements hold: the paper's as printed, what holds in place of one that does not, and
/// ours.
fn headline(printed: &[Sheet], corrected: &Sheet, own: &[Sheet]) -> String {
    let holds = |sheet: &&Sheet| {
        let mut claimed = sheet.measured.iter().filter_map(Measured::holds).peekable();
        claimed.peek().is_some() && claimed.all(|holds| holds)
    };
    let holding = |sheets: &[Sheet]| sheets.iter().filter(holds).count();
    let of_the_last = if holds(&corrected) {
        format!(
            "1 has a threshold that is not sharp: several steady states for β < -1/2, where it is -B = -π²/4 / (1 + π²/4) = {:.4} for θ_A = 0",
            -BUCKLING
        )
    } else {
        "the last is not decided".to_owned()
    };
    format!(
        "the paper's {} statements: {} hold as printed, {of_the_last}; {} of {} of ours hold",
        printed.len() + 1,
        holding(printed),
        holding(own),
        own.len()
    )
}

impl OfExperiment<'_> {
    fn one(&self, name: &str, value: impl Into<Option<f64>>) -> Measured {
        measured(self.experiment.name, name, value)
    }

    /// Whether something happened that must not.
    fn none(&self, name: &str, happened: bool) -> Measured {
        none_of(self.experiment.name, name, usize::from(happened))
    }

    /// The numbers of an experiment. The digits of an end at zero are those of the remaining
    /// motion, and not recorded.
    fn numbers(&self) -> Vec<Measured> {
        let trace = self.trace();
        let SteadyRun { end, energy, .. } = self.first;
        let is_bent = !FIRST.contains(&self.experiment);
        let recorded = |one: Measured, name: &str| match is_bent {
            true => one.recorded(name, SMOOTH),
            false => one,
        };
        let exact = end.nearest.map(|nearest| nearest.state.u_tip);
        vec![
            self.one("first contact above", trace.first_upper)
                .fixed(4)
                .recorded("first_upper", SMOOTH),
            self.one("below", trace.first_lower)
                .fixed(4)
                .recorded("first_lower", AFTER_BOUNCES),
            self.one("frequency of u(1)", trace.frequency)
                .fixed(4)
                .recorded("frequency", AFTER_BOUNCES),
            self.one("range of φ(1)", trace.phi_amplitude)
                .fixed(4)
                .recorded("phi_amplitude", AFTER_BOUNCES),
            self.one("steady by t", end.t).fixed(0),
            recorded(self.one("E at the end", *energy).fixed(8), "energy"),
            self.one("u(1)", end.tip[0]).scientific(3),
            self.one("φ(1)", end.tip[1]).scientific(3),
            recorded(
                self.one("u(1) of the exact state", exact).fixed(9),
                "exact_u_tip",
            ),
        ]
    }

    /// Whether the end is an exact, stable steady state.
    fn arrived(&self) -> [Measured; 2] {
        let end = &self.first.end;
        [
            self.one("distance to a steady state", end.distance())
                .must_be(Must::AtMost(ARRIVED)),
            self.none("unstable", !end.is_stable()),
        ]
    }
}

/// A sentence, and the numbers that show it.
fn sentence(words: impl Into<String>, numbers: impl IntoIterator<Item = Measured>) -> Sheet {
    Sheet::new(words, "experiment", numbers)
}

fn never_rises(runs: &[OfExperiment<'_>]) -> Sheet {
    let numbers = runs.iter().flat_map(|runs| {
        let trace = runs.trace();
        [
            runs.one(
                "largest change of the energy in a step",
                trace.largest_increase,
            )
            .scientific(1)
            .must_be(Must::AtMost(ROUND_OFF)),
            runs.one("largest residual of its balance", trace.largest_residual)
                .scientific(1),
        ]
    });
    sentence("The energy rises in none of the experiments", numbers)
}

fn energy_at_rest(first: &[OfExperiment<'_>], rate: f64) -> Sheet {
    let numbers = first.iter().map(|runs| {
        let remains = (runs.first.energy - runs.experiment.straight_energy()).abs();
        runs.one("distance of the energy to β²/(4ρ)", remains)
            .must_be(Must::AtMost(REMAINS * rate))
    });
    sentence("Without heating the energy falls to β²/(4ρ)", numbers)
}

fn becomes_straight(first: &[OfExperiment<'_>]) -> Sheet {
    let numbers = first.iter().map(|runs| {
        runs.one("largest of the three fields", runs.first.largest_field)
            .must_be(Must::AtMost(ARRIVED))
    });
    let words = "Without heating the evolution is towards u = φ = θ = 0";
    sentence(words, numbers)
}

fn touches_both(first: &[OfExperiment<'_>]) -> Sheet {
    let numbers = first.iter().map(|runs| {
        let Trace {
            first_upper,
            first_lower,
            ..
        } = runs.trace();
        let both = first_upper.zip(*first_lower);
        runs.one(
            "both obstacles touched by t",
            both.map(|(a, b)| max_or_nan(a, b)),
        )
        .fixed(4)
        .must_be(Must::AtMost(BEGINNING * T_END))
    });
    let words = "At the beginning the beam touches both obstacles";
    sentence(words, numbers)
}

/// A ratio of numbers of two experiments that must exceed 1.
fn over(
    [runs, other]: [&OfExperiment<'_>; 2],
    name: String,
    numbers: [Option<f64>; 2],
) -> Measured {
    let ratio = numbers[0].zip(numbers[1]);
    let ratio = ratio.map(|(number, other)| number / other);
    runs.one(&name, ratio)
        .against(other.experiment.name)
        .fixed(4)
        .must_be(Must::Above(1.0))
}

fn frequency_grows(first: &[OfExperiment<'_>]) -> Sheet {
    let numbers = first.windows(2).map(|pair| {
        let [less, more] = [0, 1].map(|k| pair[k].trace().frequency);
        let name = "frequency of u(1) over that of the β before".to_owned();
        over([&pair[1], &pair[0]], name, [more, less])
    });
    let words = "The frequency of oscillation grows with β: in the order of β, not of |β|";
    sentence(words, numbers)
}

fn amplitude_is_largest(first: &[OfExperiment<'_>]) -> Sheet {
    let range = |runs: &OfExperiment<'_>| Some(runs.trace().phi_amplitude);
    let [least, others @ ..] = first else {
        return Sheet::default();
    };
    let beta = least.experiment.beta;
    let numbers = others.iter().map(|other| {
        let name = format!("range of φ(1) for β = {beta} over its own");
        over([other, least], name, [range(least), range(other)])
    });
    let words = format!("The oscillations of φ(1) are largest for β = {beta}");
    sentence(words, numbers)
}

fn comes_to_rest(runs: &OfExperiment<'_>, contact: Phase) -> Sheet {
    let SteadyRun {
        end, contact_force, ..
    } = runs.first;
    let presses = match contact {
        Phase::Upper => Must::Above(0.0),
        Phase::Lower => Must::AtMost(0.0_f64.next_down()),
        Phase::Free => Must::Count(0),
    };
    let force = runs
        .one("contact force", *contact_force)
        .fixed(6)
        .must_be(presses);
    let elsewhere = runs.none("at rest in another contact", end.contact() != Some(contact));
    let Experiment { theta_a, beta, .. } = runs.experiment;
    let place = match contact {
        Phase::Free => "free of both obstacles",
        _ => name_of(contact),
    };
    let words = format!("At the steady state for θ_A = {theta_a}, β = {beta} the beam is {place}");
    sentence(words, [force, elsewhere].into_iter().chain(runs.arrived()))
}

fn ends_bent(runs: &OfExperiment<'_>) -> Sheet {
    let end = &runs.first.end;
    let states = runs.one("steady states", end.states as f64);
    let tip = runs
        .one("|u(1)| at the end", end.tip[0].abs())
        .fixed(9)
        .must_be(Must::Above(ARRIVED));
    let beta = runs.experiment.beta;
    let words = format!("For β = {beta} the stationary solution is not zero");
    let numbers = [states.words(end.count()), tip];
    sentence(words, numbers.into_iter().chain(runs.arrived()))
}

/// The largest distance of first contacts, frequency and range of φ(1) to numbers known.
fn distance(trace: &Trace, known: &[f64; 4]) -> Option<f64> {
    let found = [trace.first_upper, trace.first_lower, trace.frequency];
    let found = found.into_iter().chain([Some(trace.phi_amplitude)]);
    let distances = found
        .zip(known)
        .map(|(found, known)| Some((found? - known).abs()));
    distances.collect::<Option<Vec<f64>>>().and_then(largest_of)
}

/// First contacts, frequency and amplitude of the first experiments are the numbers known, by both
/// discretisations.
fn motion_is_known(first: &[OfExperiment<'_>]) -> Sheet {
    let numbers = first.iter().zip(&MOTIONS).flat_map(|(runs, known)| {
        let near = |name: &str, run: &SteadyRun| {
            runs.one(name, distance(&run.trace, known))
                .scientific(1)
                .must_be(Must::AtMost(AGREED))
        };
        [
            near("distance to the numbers known, by the first", runs.first),
            near("distance to the numbers known, by the second", runs.second),
        ]
    });
    let words =
        "First contacts, frequency and range of φ(1) are those known, by both discretisations";
    sentence(words, numbers)
}

/// The figures are drawn from curves whose error cannot be seen.
fn lines_are_thick(plotted: &[Plotted]) -> Sheet {
    let numbers = plotted.iter().map(|plot| {
        measured(plot.what, "error over the width of the line", plot.error())
            .scientific(0)
            .must_be(Must::AtMost(1.0))
    });
    let words = "The error of each curve in the figures is below the width of its line";
    Sheet::new(words, "figure", numbers)
}

/// The tolerance η* of the paper's algorithm leaves an error that does not matter.
///
/// With ‖φ‖ <= (2/π) ‖φ_x‖, the norm d of (3.14) bounds |u(1)| <= ‖u_x‖ <= ‖u_x - φ‖ + ‖φ‖ <= (1 +
/// 4/π²)^½ d.
fn solved(all: &[OfExperiment<'_>], tolerance: f64) -> Sheet {
    let numbers = all.iter().filter_map(|runs| {
        let PaperRun { trace, solvers } = runs.paper?;
        let [exact, tip] =
            [&runs.first.trace, trace].map(|trace| U_TIP.points(runs.experiment, trace));
        let bound = solvers.distance / BUCKLING.sqrt();
        let error = largest_difference(false, &exact, &tip);
        Some([
            runs.one("iterations per step", solvers.mean_iterations)
                .fixed(4)
                .recorded("iterations_per_step", OF_ITERATIONS),
            runs.one("most", solvers.most_iterations as f64).fixed(0),
            runs.one("distance to Newton's solution", solvers.distance)
                .recorded("distance_to_newton", OF_ITERATIONS),
            runs.one("error of u(1, t)", error).scientific(1),
            runs.one("share that η* causes, at most", bound / error)
                .scientific(1)
                .must_be(Must::AtMost(NEGLIGIBLE)),
        ])
    });
    let words = format!(
        "η* = {tolerance:e} in the norm of (3.14) causes a small share of the error of u(1, t) by the paper's algorithm (4.1)-(4.5)"
    );
    sentence(words, numbers.flatten())
}
