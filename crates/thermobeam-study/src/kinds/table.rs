//! The kinds of study of the beam: reader and words of each.

use convergence_study::study::KindRow;

use super::untyped::reader;
use super::{
    bifurcation, calibration, controls, convergence, energy, equilibrium, experiment, fixed_point, frequencies, rigid,
    self_convergence, stability, vibration, work_precision,
};
use crate::kinds::convergence::file::CONVERGENCE;

/// One row for each kind.
pub const KINDS: [KindRow; 14] = [
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
    energy::ROW,
    controls::ROW,
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
    experiment::ROW,
    KindRow {
        name: "equilibrium",
        read: reader::<equilibrium::EndStates>,
        why: "All steady states are roots of a function of one variable, known to round-off. A damped beam must come to rest at one.",
        judged: "Beams are run to rest on several meshes; their end states converge at second order to an exact state.",
        failure: "The steady part of the equations is discretised wrongly, or the beam has not come to rest.",
    },
    bifurcation::ROW,
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
        name: "stability",
        read: reader::<stability::Stability>,
        why: "Over two parameters at a time: where the fixed point converges, alpha = 1 being the boundary foretold, and that Newton's \
              method and the fall of the energy hold everywhere.",
        judged: "The measured boundary against the one foretold; the energy and its balance at every point.",
        failure: "The scheme or a solver is not as stable as theory says.",
    },
];
