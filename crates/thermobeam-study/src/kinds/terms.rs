//! The norms in words, for `explain`.

use convergence_study::project::Term;

use crate::exact::norm::Norm;

/// A row for each norm, in the order of [`Norm::ALL`].
pub const TERMS: [Term; Norm::ALL.len()] = [
    term(Norm::Velocity, "the L2 norm of the error of the velocity u_t"),
    term(Norm::Shear, "the L2 norm of the error of the shear u_x - phi: a derivative, so first order in h at best"),
    term(Norm::RotationRate, "the L2 norm of the error of the rate of rotation phi_t"),
    term(Norm::Curvature, "the L2 norm of the error of phi_x: a derivative, so first order in h at best"),
    term(Norm::Temperature, "the L2 norm of the error of the temperature"),
    term(
        Norm::Theorem34,
        "the root of the sum of the squares of velocity, shear, rotation-rate, curvature and temperature at the same time: \
         the left-hand side of Theorem 3.4, bounded there by c (h + dt)",
    ),
    term(Norm::Displacement, "the L2 norm of the error of the displacement u"),
    term(
        Norm::Superclose,
        "as theorem-3.4, but of the distance to the interpolant of the exact solution: Z_n^1/2 of (3.16). The first order of \
         Theorem 3.4 is that of interpolation alone; to the interpolant the scheme is of order h^2 + dt. The sharpest guard: \
         it sees defects which the interpolation error hides",
    ),
];

const fn term(norm: Norm, text: &'static str) -> Term {
    Term { name: norm.name(), what: "a norm; its maximum over all time levels counts", text }
}
