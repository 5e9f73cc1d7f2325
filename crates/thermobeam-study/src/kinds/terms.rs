//! The norms in words, for `explain`.

use convergence_study::project::Term;

use crate::exact::norm::Norm;

/// A row for each norm.
pub const TERMS: [Term; Norm::ALL.len()] = {
    let mut terms = [Term { name: "", what: "a norm", text: "" }; Norm::ALL.len()];
    let mut i = 0;
    while i < terms.len() {
        terms[i] = Term {
            name: Norm::ALL[i].name(),
            what: "a norm, of which the maximum over all time levels counts",
            text: text(Norm::ALL[i]),
        };
        i += 1;
    }
    terms
};

/// What a norm measures.
pub(crate) const fn text(norm: Norm) -> &'static str {
    match norm {
        Norm::Velocity => "the L2 norm of the error of the velocity u_t",
        Norm::Shear => "the L2 norm of the error of the shear u_x - phi: a derivative, so first order in h at best",
        Norm::RotationRate => "the L2 norm of the error of the rate of rotation phi_t",
        Norm::Curvature => "the L2 norm of the error of phi_x: a derivative, so first order in h at best",
        Norm::Temperature => "the L2 norm of the error of the temperature",
        Norm::Theorem34 => {
            "the root of the sum of the squares of velocity, shear, rotation-rate, curvature and temperature at the same time: \
             the left-hand side of Theorem 3.4, bounded there by c (h + dt)"
        }
        Norm::Displacement => "the L2 norm of the error of the displacement u",
        Norm::Superclose => {
            "as theorem-3.4, but of the distance to the interpolant of the exact solution: Z_n^1/2 of (3.16). The first order of \
             Theorem 3.4 is that of interpolation alone; to the interpolant the scheme is of order h^2 + dt. The sharpest guard: \
             it sees defects which the interpolation error hides"
        }
    }
}
