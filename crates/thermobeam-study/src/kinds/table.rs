//! The kinds of study of the beam: reader and words of each.

use convergence_study::study::KindRow;

use super::untyped::reader;
use super::{
    any_order, bifurcation, calibration, controls, convergence, energy, equilibrium, exact_experiments, experiment,
    extremes, fixed_point, frequencies, random_scenes, rigid, self_convergence, sensitivity, stability, vibration,
    work_precision,
};

/// One row for each kind.
pub const KINDS: [KindRow; 17] = [
    convergence::ROW,
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
    calibration::ROW,
    KindRow {
        name: fixed_point::FIXED_POINT,
        read: reader::<fixed_point::FixedPoint>,
        why: "In contact, the paper's fixed point (4.1)-(4.5) shrinks its error by a factor per iteration that is known beforehand \
              from dt, epsilon, zeta and the mesh; past 1 it diverges. Newton's method solves the same step.",
        judged: "The factor measured against the factor foretold, for all combinations; the results of both solvers against each \
                 other; the error of the fixed point against its tolerance.",
        failure: "The iteration is not the paper's, or the steps that it delivers are not solved to the tolerance that was asked for.",
    },
    KindRow {
        name: sensitivity::SENSITIVITY,
        read: reader::<sensitivity::Sensitivity>,
        why: "A study that guards a coefficient sees an error in it from some size on. Bisection finds that size.",
        judged: "For every coefficient some study must see a relative error as small as the file says.",
        failure: "The guard has become blunter: a study has lost levels, or its tolerance has grown.",
    },
    vibration::ROW,
    frequencies::ROW,
    self_convergence::ROW,
    KindRow {
        name: "experiment",
        read: reader::<experiment::Experiments>,
        why: "Section 5 of the paper says what its seven experiments show. Each statement is a condition on a run of ours.",
        judged: "One check a statement, with the numbers. Where a statement does not hold as printed, the check says what holds.",
        failure: "Our beam does not do what the paper's does, or the resolution is too coarse to tell.",
    },
    equilibrium::ROW,
    KindRow {
        name: "bifurcation",
        read: reader::<bifurcation::BifurcationStudy>,
        why: "Below the buckling force -(pi^2/4)/(1 + pi^2/4) the straight beam is unstable and bent states appear; the branches are \
              followed over beta, and stability is an exact count.",
        judged: "The buckling point, found by counting states and by elements alone; and that moving beams end on stable branches.",
        failure: "Steady states are missed or invented, or the dynamics end where no stable state is.",
    },
    KindRow {
        name: "rigid",
        read: reader::<rigid::RigidStudy>,
        why: "As epsilon falls the obstacles become rigid: penetration falls like epsilon at rest and on a fixed grid, like \
              epsilon^(2/3) in an impact that the grid resolves.",
        judged: "The observed orders in epsilon, Newton's iterations, and where the fixed point ceases to converge.",
        failure: "The contact law, or its solution in closed form, loses digits or stability for stiff obstacles.",
    },
    KindRow {
        name: work_precision::WORK_PRECISION,
        read: reader::<work_precision::WorkPrecision>,
        why: "Every method pays for a smaller error with more node-steps. The law e = C_h h^p + C_t dt^q of each gives its cheapest \
              path, and its cost for any error.",
        judged: "Costs are counted, not timed. The laws must fit what was measured, and the advantage claimed must be there.",
        failure: "A method has become dearer for the same error, or its order is not what the law says.",
    },
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
    KindRow {
        name: "stability",
        read: reader::<stability::Stability>,
        why: "Over two parameters at a time: where the fixed point converges, alpha = 1 being the boundary foretold, and that Newton's \
              method and the fall of the energy hold everywhere.",
        judged: "The measured boundary against the one foretold; the energy and its balance at every point.",
        failure: "The scheme or a solver is not as stable as theory says.",
    },
    any_order::ROW,
    exact_experiments::ROW,
];
