//! The kinds of study of the beam: reader and words of each.

use convergence_study::study::KindRow;

use super::untyped::reader;
use super::{
    bifurcation, calibration, controls, convergence, energy, equilibrium, experiment, extremes, frequencies,
    random_scenes, rigid, self_convergence, sensitivity, solvers, vibration, work_precision,
};
use crate::kinds::convergence::file::CONVERGENCE;

/// One row for each kind.
pub const KINDS: [KindRow; 16] = [
    KindRow {
        name: CONVERGENCE,
        read: reader::<convergence::Convergence>,
        why: "An exact solution is chosen, and the loads are derived from it by putting it into the equations in their strong form; \
              the solver works with the weak form and knows nothing of it. So the error is known at every step. Theorem 3.4 bounds \
              it by c (h + dt).",
        judged: "At each level of refinement the error is measured in each norm, as the maximum over all time levels. The rate at \
                 which it falls is estimated with an interval (95 %), and the interval is held against the order: it must lie \
                 within the tolerance, whole. Above is as wrong as below. What cannot be told is inconclusive, which is not a pass.",
        failure: "The scheme, as it is programmed, does not have the order: a term is missing, belongs to another time level, has a \
                  wrong coefficient, or the quadrature is too coarse. Look which norm fails, and from which level on.",
    },
    KindRow {
        name: energy::ENERGY,
        read: reader::<energy::EnergyDecay>,
        why: "An exactly solved step obeys a balance: the change of the energy, the viscous and the thermal dissipation, that of the \
              Euler scheme and the gap of the contact energy add up to zero. All but the first are not negative, so the energy \
              cannot rise (Proposition 3.1).",
        judged: "Every step of every run: the energy must not rise, and the balance must close to round-off, both in units of \
                 the initial energy. Falling can be luck; closing cannot.",
        failure: "A term of the step or of the energy is wrong, or a step has not been solved. The balance shows the defect in the \
                  very step in which it happens.",
    },
    KindRow {
        name: controls::CONTROLS,
        read: reader::<controls::Controls>,
        why: "A check that cannot fail proves nothing. Each coefficient of the solver in turn is put off a little from that of the \
              sources, and each mistake in turn is planted in the sources.",
        judged: "Every fault must turn at least one of the studies to fail; without a fault, all of them must pass.",
        failure: "A fault that no study sees: mistakes of this size in this place would go unnoticed, so that the passing \
                  studies say less than they seem to.",
    },
    KindRow {
        name: calibration::CALIBRATION,
        read: reader::<calibration::RuleCalibration>,
        why: "The rule that turns errors into verdicts is applied to thousands of made-up sequences of errors whose order is known: \
              pure powers, polluted by higher powers, scattered, ending in a round-off floor.",
        judged: "Counted: how often a wrong claim passes, how often a right one fails, how often the interval holds the true order. \
                 Each share has its limit.",
        failure: "The rule errs more often than is admitted: no verdict of any other study can be trusted as far as was said.",
    },
    solvers::ROW,
    KindRow {
        name: sensitivity::SENSITIVITY,
        read: reader::<sensitivity::Sensitivity>,
        why: "A study that guards a coefficient sees an error in it from some size on. Bisection finds that size.",
        judged: "For every coefficient some study must see a relative error as small as the file says.",
        failure: "The guard has become blunter: a study has lost levels, or its tolerance has grown.",
    },
    KindRow {
        name: vibration::KIND,
        read: reader::<vibration::Vibration>,
        why: "Without coupling, nonlinearity and obstacles the damped modes of the beam are exact solutions that no source term keeps \
              in place. Moved by the scheme's own recursion they leave the space error alone; the mesh's own modes, moved exactly, \
              leave the time error alone.",
        judged: "Errors in each norm over the levels, by the rule of every rate; and the solver against the closed form, to round-off.",
        failure: "The beam that is simulated is not the beam of the equations, or a step of the scheme is wrong. No manufactured load \
                  can be to blame.",
    },
    frequencies::ROW,
    KindRow {
        name: self_convergence::KIND,
        read: reader::<self_convergence::SelfConvergence>,
        why: "For the paper's own data there is no exact solution: rates come from the differences of three levels (Richardson) and \
              from the distance to a much finer run, contact included.",
        judged: "Each quantity's rate by the rule of every rate. A wrong coefficient cannot be seen in this way; a lost order can.",
        failure: "With contact and rough data the order is lost, or the levels are too coarse for it.",
    },
    KindRow {
        name: "experiment",
        read: reader::<experiment::Experiments>,
        why: "Section 5 of the paper says what its seven experiments show. Each statement is a condition on a run of ours.",
        judged: "One check a statement, with the numbers. Where a statement does not hold as printed, the check says what holds.",
        failure: "Our beam does not do what the paper's does, or the resolution is too coarse to tell.",
    },
    KindRow {
        name: "equilibrium",
        read: reader::<equilibrium::EndStates>,
        why: "All steady states are roots of a function of one variable, known to round-off. A damped beam must come to rest at one.",
        judged: "Beams are run to rest on several meshes; their end states converge at second order to an exact state.",
        failure: "The steady part of the equations is discretised wrongly, or the beam has not come to rest.",
    },
    KindRow {
        name: "bifurcation",
        read: reader::<bifurcation::BifurcationStudy>,
        why: "Below the buckling force -(pi^2/4)/(1 + pi^2/4) the straight beam is unstable and bent states appear; the branches are \
              followed over beta, and stability is an exact count.",
        judged: "The buckling point, found by counting states and by elements alone; and that moving beams end on stable branches.",
        failure: "Steady states are missed or invented, or the dynamics end where no stable state is.",
    },
    rigid::ROW,
    work_precision::ROW,
    KindRow {
        name: "extremes",
        read: reader::<extremes::Extremes>,
        why: "At the edge of each range - huge steps, stiff obstacles, no viscosity, loads past buckling, a million elements, ten million \
              steps - the laws of the scheme still hold, or a typed error says that they cannot.",
        judged: "Each case has its claim: the energy, the balance within its derived bound, or the error that must come.",
        failure: "The case named has left the range in which the solver can be trusted.",
    },
    KindRow {
        name: "random-scenes",
        read: reader::<random_scenes::RandomScenes>,
        why: "Coefficients, meshes and data at random reach corners that nobody thought of.",
        judged: "Each scene ends with an answer or a typed error; the energy never rises and its balance closes within the bound stated.",
        failure: "The scene named, with its seed, breaks a law of the scheme: run it alone.",
    },
];
