//! Problems of other projects, each in at most twenty lines: sources against the projects' own
//! formulas and numbers.
//!
//! Formulas are written anew from the place that is named. Numbers were computed there.

use std::f64::consts::{PI, SQRT_2};

use crate::prelude::*;

/// PFHub, benchmark 7, equation (4): Allen-Cahn's equation. With z = (y - α)/√(2κ) the source is
/// sech²(z)/(4 √κ) (-2 √κ tanh(z) α_x² + √2 (α_t - κ α_xx)).
#[test]
fn allen_cahn_has_the_source_of_pfhub() {
    let [kappa, a1, b1, a2, b2, c2] = [0.0004_f64, 0.0075, 8.0 * PI, 0.03, 22.0 * PI, 0.0625 * PI];
    for [x, y, t] in [[0.13_f64, 0.24, 1.5], [0.71, 0.27, 6.0]] {
        let wave = b2 * x + c2 * t;
        let alpha = 0.25 + a1 * t * (b1 * x).sin() + a2 * wave.sin();
        let by_x = a1 * t * b1 * (b1 * x).cos() + a2 * b2 * wave.cos();
        let by_xx = -a1 * t * b1 * b1 * (b1 * x).sin() - a2 * b2 * b2 * wave.sin();
        let by_t = a1 * (b1 * x).sin() + a2 * c2 * wave.cos();
        let z = (y - alpha) / (2.0 * kappa).sqrt();
        let slopes = -2.0 * kappa.sqrt() * z.tanh() * by_x * by_x + SQRT_2 * (by_t - kappa * by_xx);
        let expected = z.cosh().powi(-2) / (4.0 * kappa.sqrt()) * slopes;
        let values = at(PFHUB, &format!("x,y,t\n{x},{y},{t}\n"));
        let size = values["size"]["sources"]["eta"][0].as_f64().unwrap();
        close(&values["sources"]["eta"][0], expected, size);
    }
}

const MASA: &str = r#"
[manufacture]
name = "euler"
coordinates = ["x", "y"]
[domain]
x = [0, 3.02]
y = [0, 3.02]
[parameters]
w = "pi/3.02"
Gamma = 1.01
rho_0 = 1.02
[exact]
rho = "rho_0 + 7.2*sin(0.627*w*x) + 9.8*cos(0.828*w*y)"
v = ["1.23 + 1.1*sin(0.1987*w*x) + 0.08*cos(1.189*w*y)", "12 + 1.6*cos(1.91*w*x) + 0.67*sin(2.901*w*y)"]
p = "1.2 + 0.91*cos(0.165*w*x) + 0.623*sin(0.612*w*y)"
[define]
E = "p/(Gamma - 1) + rho*dot(v, v)/2"
[equations]
mass = "div(rho*v)"
momentum = "div(rho*outer(v, v)) + grad(p)"
energy = "div((E + p)*v)"
[require]
positive = ["rho"]
"#;

/// MASA, `euler_2d` in `src/euler.cpp` (commit 093e659) with the parameters of `init_var`: values
/// of `eval_q_rho`, `eval_q_u`, `eval_q_v`, `eval_q_e`.
///
/// Its density is negative in a part of the square of its length; MASA has rho_0 = 100.02 today.
#[test]
fn compressible_flow_has_the_sources_of_masa() {
    for (point, [mass, u, v, energy]) in [
        (
            "0.37,0.81",
            [
                -81.22134395084473,
                -118.7212466950613,
                -1351.678480030328,
                -10816.32320554328,
            ],
        ),
        (
            "1.9,2.6",
            [
                -72.5783663209099,
                -113.360653406494,
                -820.516692822627,
                -4711.203498344161,
            ],
        ),
    ] {
        let table = format!("x,y\n{point}\n");
        let expected = [
            ("mass", mass),
            ("momentum_x", u),
            ("momentum_y", v),
            ("energy", energy),
        ];
        sources(MASA, &table, 100.0, &expected);
    }
    assert_eq!(found(&check(MASA), "not-positive").len(), 1);
    let mended = MASA.replace("rho_0 = 1.02", "rho_0 = 100.02");
    assert!(found(&check(&mended), "not-positive").is_empty());
}

const TRIXI_SHALLOW: &str = r#"
[manufacture]
name = "shallow"
coordinates = ["x"]
time = "t"
[domain]
x = [0, "sqrt(2)"]
t = [0, 1]
[parameters]
g = 9.81
w = "2*sqrt(2)*pi"
[exact]
H = "7 + cos(w*x)*cos(2*pi*t)"
v = "0.5"
[define]
b = "2 + 0.5*sin(sqrt(2)*pi*x)"
h = "H - b"
[equations]
mass = "dt(h) + d(h*v, x)"
momentum = "dt(h*v) + d(h*v^2 + g*h^2/2, x) + g*h*d(b, x)"
"#;

/// Trixi.jl, `source_terms_convergence_test` of `src/equations/shallow_water_1d.jl`: H_t + v (H_x -
/// b_x) = s and v s + g (H - b) H_x.
#[test]
fn shallow_water_has_the_sources_of_trixi() {
    let [x, t, g] = [0.9_f64, 0.3, 9.81];
    let [w, w_b] = [2.0 * PI * SQRT_2, PI * SQRT_2];
    let [wave, beat] = [(w * x).sin_cos(), (2.0 * PI * t).sin_cos()];
    let level = 7.0 + wave.1 * beat.1;
    let level_x = -w * wave.0 * beat.1;
    let level_t = -2.0 * PI * wave.1 * beat.0;
    let bottom = 2.0 + 0.5 * (w_b * x).sin();
    let mass = level_t + 0.5 * (level_x - 0.5 * w_b * (w_b * x).cos());
    let momentum = 0.5 * mass + g * (level - bottom) * level_x;
    let table = format!("x,t\n{x},{t}\n");
    let expected = [("mass", mass), ("momentum", momentum)];
    sources(TRIXI_SHALLOW, &table, 100.0, &expected);
}

/// NekRS, `examples/ethier`: the flow of Ethier and Steinman (1994) solves Navier-Stokes' equations
/// in three dimensions without a source, and does not notice a transposed gradient.
#[test]
fn navier_stokes_in_three_dimensions_needs_no_source() {
    let check = check(include_str!("files/ethier-steinman.toml"));
    assert_eq!(check.verdict, "pass", "{check:#?}");
    assert_eq!(found(&check, "source-zero").len(), 2);
    let slips = found(&check, "slip-invisible");
    assert!(
        slips
            .iter()
            .any(|slip| slip.text.starts_with("transposed-gradient")),
        "{slips:?}"
    );
}

const MFEM: &str = r#"
[manufacture]
name = "maxwell"
coordinates = ["x", "y", "z"]
[domain]
x = [0, 1]
y = [0, 1]
z = [0, 1]
[parameters]
kappa = "pi"
[exact]
E = ["sin(kappa*y)", "sin(kappa*z)", "sin(kappa*x)"]
[equations]
E = "curl(curl(E)) + E"
"#;

/// MFEM, `examples/ex3.cpp`: Maxwell's equations, whose `f_exact` is (1 + κ²) E.
#[test]
fn maxwell_has_the_source_of_mfem() {
    let expected = [("E_x", 0.41), ("E_y", 0.77), ("E_z", 0.3)]
        .map(|(component, s)| (component, (1.0 + PI * PI) * (PI * s).sin()));
    sources(MFEM, "x,y,z\n0.3,0.41,0.77\n", 10.0, &expected);
}

const SLOTH: &str = r#"
[manufacture]
name = "cahn_hilliard"
coordinates = ["x"]
time = "t"
[domain]
x = [0, 1]
t = [0, 1]
[exact]
c = "(t + 1)*sin(pi*x)"
[define]
mu = "c^3 - c - laplacian(c)"
[equations]
c = "dt(c) - laplacian(mu)"
"#;

/// SLOTH, convergence test after Zhang et al., J. Comput. Phys. 236 (2013), 74-80: Cahn-Hilliard's
/// equation with the source c_t - Δμ, Δμ = Δc (3 c² - 1) + 6 c c_x² - π⁴ c.
#[test]
fn cahn_hilliard_has_the_source_of_sloth() {
    let [x, t] = [0.23_f64, 0.4];
    let (sine, cosine) = (PI * x).sin_cos();
    let [c, slope] = [(t + 1.0) * sine, (t + 1.0) * PI * cosine];
    let laplacian = -PI * PI * c * (3.0 * c * c - 1.0) + 6.0 * c * slope * slope - PI.powi(4) * c;
    let table = format!("x,t\n{x},{t}\n");
    sources(SLOTH, &table, 100.0, &[("c", sine - laplacian)]);
}

const FEENOX: &str = r#"
[manufacture]
name = "solid"
coordinates = ["x", "y", "z"]
[domain]
x = [0, 1]
y = [0, 1]
z = [0, 1]
[parameters]
mu = 1.5
lambda = 2.5
[exact]
u = ["sin(pi*x)/10", "y^2*z/2", "x*ln(1 + y)/5"]
[define]
F = "identity + grad(u)"
E = "(dot(transpose(F), F) - identity)/2"
S = "lambda*trace(E)*identity + 2*mu*E"
[equations]
b = "-div(dot(F, S))"
"#;

/// FeenoX, `tests/mms/mechanical/ldef/mechanical-ldefcube-b.fee` (commit 42e631f): values of its
/// `bx`, `by`, `bz`, which Maxima derived for a Saint-Venant-Kirchhoff solid with large strains.
#[test]
fn a_solid_with_large_strains_has_the_force_of_feenox() {
    for (point, force) in [
        (
            "0.3,0.41,0.77",
            [7.772988852429286, -9.880001612414748, -2.0225826615960667],
        ),
        (
            "0.83,0.62,0.19",
            [0.9937770045235036, -3.00296155074555, -2.7030540087323804],
        ),
    ] {
        let [x, y, z] = force;
        let table = format!("x,y,z\n{point}\n");
        sources(FEENOX, &table, 10.0, &[("b_x", x), ("b_y", y), ("b_z", z)]);
    }
}

const MOOSE: &str = r#"
[manufacture]
name = "pipe"
coordinates = ["r", "z"]
system = "axisymmetric"
[domain]
r = [0, 1]
z = [0, 1]
[parameters]
mu = 1.1
rho = 1.1
[exact]
v = ["sin(pi*r)^2*sin(pi*z/2)", "0", "cos(pi*r)*cos(pi*z)"]
p = "cos(pi*r)*cos(pi*z/2)"
[equations.radial]
convection = "rho*div(outer(v, v))[r]"
diffusion = "-mu*laplacian(v[r])"
hoop = "mu*v[r]/r^2"
pressure = "d(p, r)"
[equations]
axial = "(rho*div(outer(v, v)) - mu*laplacian(v) + grad(p))[z]"
mass = "rho*div(v)"
whole = "rho*div(outer(v, v)) - mu*laplacian(v) + grad(p)"
"#;

/// MOOSE, `modules/navier_stokes/test/tests/finite_volume/ins/mms/channel-flow/cylindrical/
/// 2d-average.i` (commit fc9298f): Navier-Stokes' and, for ρ = 0, Stokes' equations in axisymmetric
/// coordinates. Its `forcing_u` lacks the term μ u_r/r², as issue 31934 of the project says.
#[test]
fn axisymmetric_flow_has_the_sources_of_moose_but_for_its_lost_term() {
    foreign_tools::needs!(PYTHON);
    let head = "s, c, h, g = sin(pi*r), cos(pi*r), sin(pi*z/2), cos(pi*z/2); mu = rho = 1.1; u, w = s*s*h, c*cos(pi*z);";
    let radial = "f = mu*pi**2/4*u - pi*s*g + rho*(4*pi*s**3*c*h*h + s**4*h*h/r) \
        + rho*pi*s*s*c*(g*cos(pi*z)/2 - h*sin(pi*z)) - 2*pi*mu*h*(pi*c*c - pi*s*s + s*c/r)";
    let axial = "f = mu*pi**2*w - 2*pi*rho*sin(pi*z)*c*c*cos(pi*z) - pi/2*h*c + mu*pi*cos(pi*z)*(pi*c + s/r) \
        + rho*s*h*cos(pi*z)*(2*pi*c*c - pi*s*s + s*c/r)";
    let mass = "f = -pi*rho*sin(pi*z)*c + rho*(2*pi*s*c*h + s*s*h/r)";
    let mut found = vec![];
    for (name, source) in [("radial", radial), ("axial", axial), ("mass", mass)] {
        let program = format!("{head} {source}");
        found.push(against(MOOSE, None, "r, z", name, &program));
    }
    assert_eq!(
        found[0].sentence,
        "radial: your source lacks `hoop`; the other terms are right (test.toml:18:9)"
    );
    assert_eq!([found[1].cause, found[2].cause], ["equal"; 2], "{found:?}");
    // The terms are those of the operators on vectors.
    let values = at(MOOSE, "r,z\n0.6,0.3\n");
    let whole = values["sources"]["whole_r"][0].as_f64().unwrap();
    close(&values["sources"]["radial"][0], whole, 10.0);
}
