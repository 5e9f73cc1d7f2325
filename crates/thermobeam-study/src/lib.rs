//! Convergence studies for the `thermobeam` solver.
