//! The functions of emitted files that no answering program calls: exact values, gradients,
//! normals, initial data, averages and errors, by a program in each language.

use crate::prelude::*;

pub(crate) const FILE: &str = r#"
[manufacture]
name = "every"
coordinates = ["x", "y"]
time = "t"
[domain]
x = [0, 1]
y = [0, 2]
t = [0.5, 1]
[exact]
T = "x^2*y + t"
v = ["x*y", "y^2 + t"]
[equations]
T = "dt(T)"
[boundary.x_max]
T = "T"
[initial]
T = "2*T"
[norms]
T = ["L1", "L2", "Linf", "H1"]
v = ["L2"]
"#;

/// At (0.5, 0.25) and t = 0.75; averages over [0, 1] x [0, 2]; errors at that point and at (1, 2),
/// with the weights 0.25 and 0.5 and the differences 1 and -2 of T, 1 in each component of its
/// gradient, and 1 in the first component of v.
pub(crate) const EXPECTED: [f64; 22] = [
    0.8125, // T
    0.25,
    0.25, // its gradient
    0.125,
    0.8125, // v
    0.25,
    0.5,
    0.0,
    0.5,   // its gradient, row by row
    1.125, // 2 T at t = 0.5
    1.0,
    0.0,                // the normal
    1.0833333333333333, // the average of T
    0.5,
    2.0833333333333335, // that of v
    1.25,
    1.5,
    2.0,
    1.224744871391589,  // errors of T: L1, L2, Linf, H1
    0.8660254037844386, // of v: L2
    0.0,                // of v without a difference
    f64::NAN,           // Linf of T where the first value is NaN
];

const C: &str = r#"
#include <math.h>
#include <stdio.h>
#include "every.h"
static void print(int count, const double values[]) { for (int i = 0; i < count; ++i) printf("%.17g\n", values[i]); }
int main(void)
{
    const double x[] = {0.5, 0.25, 1, 2}, w[] = {0.25, 0.5}, t = 0.75, lo[] = {0, 0}, hi[] = {1, 2};
    double a[4], b[4], c[4];
    a[0] = every_exact_T(x, t); print(1, a);
    every_gradient_T(x, t, a); print(2, a);
    every_exact_v(x, t, a); print(2, a);
    every_gradient_v(x, t, a); print(4, a);
    a[0] = every_initial_T(x); print(1, a);
    every_normal_x_max(x, t, a); print(2, a);
    a[0] = every_average_T(lo, hi, t); print(1, a);
    every_average_v(lo, hi, t, a); print(2, a);
    a[0] = every_exact_T(x, t) + 1; a[1] = every_exact_T(x + 2, t) - 2;
    every_gradient_T(x, t, b); every_gradient_T(x + 2, t, b + 2);
    for (int i = 0; i < 4; ++i) b[i] += 1;
    c[0] = every_error_T_L1(2, x, w, t, a); c[1] = every_error_T_L2(2, x, w, t, a);
    c[2] = every_error_T_Linf(2, x, w, t, a); c[3] = every_error_T_H1(2, x, w, t, b); print(4, c);
    every_exact_v(x, t, b); every_exact_v(x + 2, t, b + 2);
    c[1] = every_error_v_L2(2, x, w, t, b);
    b[0] += 1; b[2] += 1;
    c[0] = every_error_v_L2(2, x, w, t, b);
    a[0] = NAN; c[2] = every_error_T_Linf(2, x, w, t, a); print(3, c);
    return 0;
}
"#;

const RUST: &str = r#"
#[path = "every.rs"]
mod every;
use every::*;
fn main() {
    let (x, w, t) = ([[0.5, 0.25], [1.0, 2.0]], [0.25, 0.5], 0.75);
    let mut all = vec![exact_T(&x[0], t)];
    all.extend(gradient_T(&x[0], t));
    all.extend(exact_v(&x[0], t));
    all.extend(gradient_v(&x[0], t));
    all.push(initial_T(&x[0]));
    all.extend(normal_x_max(&x[0], t));
    all.push(average_T(&[0.0, 0.0], &[1.0, 2.0], t));
    all.extend(average_v(&[0.0, 0.0], &[1.0, 2.0], t));
    let a = [exact_T(&x[0], t) + 1.0, exact_T(&x[1], t) - 2.0];
    let b: Vec<f64> = x.iter().flat_map(|x| gradient_T(x, t)).map(|g| g + 1.0).collect();
    all.extend([error_T_L1(&x, &w, t, &a), error_T_L2(&x, &w, t, &a)]);
    all.extend([error_T_Linf(&x, &w, t, &a), error_T_H1(&x, &w, t, &b)]);
    let c: Vec<f64> = x.iter().flat_map(|x| exact_v(x, t)).collect();
    let d: Vec<f64> = x.iter().flat_map(|x| { let v = exact_v(x, t); [v[0] + 1.0, v[1]] }).collect();
    all.extend([error_v_L2(&x, &w, t, &d), error_v_L2(&x, &w, t, &c)]);
    all.push(error_T_Linf(&x, &w, t, &[f64::NAN, a[1]]));
    for value in all {
        println!("{value:?}");
    }
}
"#;

const FORTRAN: &str = r#"
program driver
    use every
    implicit none
    integer, parameter :: double = kind(1.0d0)
    real(double) :: x(2, 2), w(2), t, lo(2), hi(2), a(2), b(2, 2), d, zero
    x = reshape([0.5d0, 0.25d0, 1.0d0, 2.0d0], [2, 2])
    w = [0.25d0, 0.5d0]
    t = 0.75d0
    lo = 0
    hi = [1.0d0, 2.0d0]
    print '(es25.16)', exact_T(x(:, 1), t), gradient_T(x(:, 1), t), exact_v(x(:, 1), t), transpose(gradient_v(x(:, 1), t))
    print '(es25.16)', initial_T(x(:, 1)), normal_x_max(x(:, 1), t), average_T(lo, hi, t), average_v(lo, hi, t)
    a = [exact_T(x(:, 1), t) + 1, exact_T(x(:, 2), t) - 2]
    b(:, 1) = gradient_T(x(:, 1), t) + 1
    b(:, 2) = gradient_T(x(:, 2), t) + 1
    print '(es25.16)', error_T_L1(x, w, t, a), error_T_L2(x, w, t, a), error_T_Linf(x, w, t, a), error_T_H1(x, w, t, b)
    zero = 0
    a(1) = zero/zero
    d = error_T_Linf(x, w, t, a)
    b(:, 1) = exact_v(x(:, 1), t)
    b(:, 2) = exact_v(x(:, 2), t)
    a(1) = error_v_L2(x, w, t, b)
    b(1, :) = b(1, :) + 1
    print '(es25.16)', error_v_L2(x, w, t, b), a(1), d
end program driver
"#;

const PYTHON: &str = r#"
import numpy as np
from every import *
x, w, t = np.array([[0.5, 1.0], [0.25, 2.0]]), np.array([0.25, 0.5]), 0.75
p, lo, hi = x[:, 0], [0.0, 0.0], [1.0, 2.0]
b = exact_v(x, t)
parts = [exact_T(p, t), gradient_T(p, t), exact_v(p, t), gradient_v(p, t), initial_T(p), normal_x_max(p, t),
    average_T(lo, hi, t), average_v(lo, hi, t)]
a = exact_T(x, t) + np.array([1, -2])
parts += [error_T_L1(x, w, t, a), error_T_L2(x, w, t, a), error_T_Linf(x, w, t, a), error_T_H1(x, w, t, gradient_T(x, t) + 1)]
parts += [error_v_L2(x, w, t, b + np.array([[1], [0]])), error_v_L2(x, w, t, b)]
parts += [error_T_Linf(x, w, t, np.array([np.nan, a[1]]))]
for part in parts:
    for value in np.ravel(part):
        print(repr(float(value)))
"#;

const OCTAVE: &str = r#"
1;
p = every();
x = [0.5 1; 0.25 2]; w = [0.25 0.5]; t = 0.75; y = x(:, 1); lo = [0 0]; hi = [1 2];
b = p.exact_v(x, t);
a = p.exact_T(x, t) + [1 -2];
all = [p.exact_T(y, t); p.gradient_T(y, t); p.exact_v(y, t); p.gradient_v(y, t); p.initial_T(y); p.normal_x_max(y, t)];
all = [all; p.average_T(lo, hi, t); p.average_v(lo, hi, t)];
all = [all; p.error_T_L1(x, w, t, a); p.error_T_L2(x, w, t, a); p.error_T_Linf(x, w, t, a)];
all = [all; p.error_T_H1(x, w, t, p.gradient_T(x, t) + 1); p.error_v_L2(x, w, t, b + [1; 0]); p.error_v_L2(x, w, t, b)];
all = [all; p.error_T_Linf(x, w, t, [NaN a(2)])];
printf('%.17g\n', all);
"#;

/// The program of a language; Fortran's also in place of that of UFL, which has none.
pub(crate) fn program(language: Language) -> &'static str {
    match language {
        Language::C => C,
        Language::Rust => RUST,
        Language::Fortran | Language::Ufl => FORTRAN,
        Language::Python => PYTHON,
        Language::Octave => OCTAVE,
    }
}

/// Builds and runs a program beside the emitted files, and compares what it prints.
#[test]
fn functions_have_their_values_in_each_language_that_is_here() {
    for language in languages().filter(|language| *language != Language::Ufl) {
        let module = Module::new("every", read(FILE).emit(language));
        let values = module.numbers(module.built(language, program(language)), "");
        assert_eq!(values.len(), EXPECTED.len(), "{values:?}");
        for (place, (value, expected)) in values.iter().zip(EXPECTED).enumerate() {
            let is_met = (value - expected).abs() <= 1e-14 || (value.is_nan() && expected.is_nan());
            assert!(
                is_met,
                "{language:?}, value {place}: {value}, not {expected}"
            );
        }
    }
}

/// In polar coordinates; its parameters follow each other, and share parts of their expressions.
const RING: &str = "[manufacture]\nname = \"ring\"\nsystem = \"polar\"\ncoordinates = [\"r\", \"theta\"]\n\
    [domain]\nr = [1, 2]\ntheta = [0, 1]\n\
    [parameters]\nnu = 0.3\nlam = \"nu/((1 + nu)*(1 - 2*nu)) + (1 + nu)*(1 - 2*nu)\"\nmu = 1\n\
    [exact]\nu = \"r^2*exp(theta)\"\n[equations]\na = \"lam*u - mu*laplacian(u)\"\n";

/// The mean of `r^2 exp(theta)` over [1, 2] x [0, 1] is (15/4)/(3/2) (e - 1).
#[test]
fn a_mean_over_a_cell_of_a_ring_has_the_radius_as_its_weight() {
    let expected = 2.5 * (std::f64::consts::E - 1.0);
    for language in languages().filter(|language| *language != Language::Ufl) {
        let module = Module::new("ring", read(RING).emit(language));
        let program = match language {
            Language::C => {
                "#include <stdio.h>\n#include \"ring.h\"\nint main(void)\n{\n\
                 const double lo[] = {1, 0}, hi[] = {2, 1};\n\
                 printf(\"%.17g\\n\", ring_average_u(lo, hi));\nreturn 0;\n}\n"
            }
            Language::Rust => {
                "#[path = \"ring.rs\"]\nmod ring;\n\
                 fn main() { println!(\"{:?}\", ring::average_u(&[1.0, 0.0], &[2.0, 1.0])); }\n"
            }
            Language::Fortran | Language::Ufl => {
                "program driver\nuse ring\nimplicit none\n\
                 print '(es25.16)', average_u([1.0d0, 0.0d0], [2.0d0, 1.0d0])\nend program driver\n"
            }
            Language::Python => {
                "import ring\nprint(repr(float(ring.average_u([1.0, 0.0], [2.0, 1.0]))))\n"
            }
            Language::Octave => "p = ring();\nprintf('%.17g\\n', p.average_u([1 0], [2 1]));\n",
        };
        let values = module.numbers(module.built(language, program), "");
        assert!(
            (values[0] - expected).abs() < 1e-13,
            "{language:?}: {values:?}"
        );
    }
}
