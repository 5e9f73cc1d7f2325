//! The kinds of study of the beam, and that of any program.

use convergence_study::program;
use convergence_study::study::KindRow;

use super::{
    any_order, bifurcation, calibration, controls, convergence, energy, equilibrium, exact_experiments, experiment,
    frequencies, random_errors, rigid, scenes, self_convergence, solvers, vibration, work_precision,
};

/// One row for each kind; the first is that of a file without `kind`.
pub const KINDS: [KindRow; 18] = [
    convergence::ROW,
    any_order::ROW,
    controls::ROW,
    energy::ROW,
    scenes::ROW,
    solvers::ROW,
    vibration::ROW,
    frequencies::ROW,
    self_convergence::ROW,
    experiment::ROW,
    exact_experiments::ROW,
    equilibrium::ROW,
    bifurcation::ROW,
    random_errors::ROW,
    rigid::ROW,
    work_precision::ROW,
    calibration::ROW,
    program::ROW,
];
