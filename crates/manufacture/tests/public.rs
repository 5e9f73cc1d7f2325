//! Problems of other projects: sources against their own formulas, and the mistakes of public
//! threads named.

use std::f64::consts::{LN_2, PI, SQRT_2};

use manufacture::{Comparison, Sampling};

use crate::files::{at, check, close, found, read};

/// A file with these intervals, a variable a line, and the rest as it is written.
fn file(coordinates: &str, head: &str, domain: &str, rest: &str) -> String {
    format!(
        "[manufacture]\nname = \"public\"\ncoordinates = {coordinates}\n{head}\n[domain]\n{domain}\n{rest}\n"
    )
}

/// What is said of a program in Python that prints this expression of the point `x`, `y`, `t`.
fn against(text: &str, names: &str, expression: &str) -> Comparison {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.py");
    let program = format!(
        "import sys\nfrom math import *\nsys.stdin.readline()\nfor line in sys.stdin:\n    \
         {names} = [float(word) for word in line.split()]\n    print(repr(float({expression})))\n"
    );
    std::fs::write(&path, program).unwrap();
    let sampling = Sampling {
        points: 100,
        ..Sampling::default()
    };
    let command = format!("python3 '{}'", path.display());
    read(text)
        .against(&command, None, &sampling)
        .unwrap()
        .remove(0)
}

/// PFHub, benchmark 7: Allen-Cahn's equation.
const PHASE_FIELD: &str = "[parameters]\nkappa = 0.0004\nA1 = 0.0075\nB1 = \"8*pi\"\nA2 = 0.03\nB2 = \"22*pi\"\nC2 = \"0.0625*pi\"\n\
[define]\nalpha = \"1/4 + A1*t*sin(B1*x) + A2*sin(B2*x + C2*t)\"\n[exact]\neta = \"(1 - tanh((y - alpha)/sqrt(2*kappa)))/2\"\n\
[equations.eta]\nrate = \"dt(eta)\"\nreaction = \"4*eta*(eta - 1)*(eta - 1/2)\"\ndiffusion = \"-kappa*laplacian(eta)\"\n";

fn phase_field() -> String {
    file(
        "[\"x\", \"y\"]",
        "time = \"t\"",
        "x = [0, 1]\ny = [0.2, 0.3]\nt = [0, 8]",
        PHASE_FIELD,
    )
}

/// Its equation (4): sech²(z)/(4 √κ) (-2 √κ tanh(z) α_x² + √2 (α_t - κ α_xx)) with z = (y -
/// α)/√(2κ).
#[test]
fn the_phase_field_has_the_source_of_its_page() {
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
        let values = at(&phase_field(), &format!("x,y,t\n{x},{y},{t}\n"));
        let size = values["size"]["sources"]["eta"][0].as_f64().unwrap();
        close(&values["sources"]["eta"][0], expected, size);
    }
}

/// github.com/usnistgov/pfhub/issues/756: generated C with the wrong sign of both spatial terms.
#[test]
fn the_signs_of_the_generated_source_of_the_phase_field_are_named() {
    // κ η_xx and the rest, from the derivatives of η = (1 - tanh z)/2.
    let foreign = "(lambda a, ax, axx, at, k: (lambda z, s: (lambda d: \
        -d*(-at)/s - 4*((1-tanh(z))/2)*((1-tanh(z))/2-1)*((1-tanh(z))/2-0.5) \
        + k*(-d*(-axx)/s + 2*d*tanh(z)*(ax*ax + 1)/(s*s)))(0.5/cosh(z)**2))((y-a)/sqrt(2*k), sqrt(2*k)))(\
        0.25 + 0.0075*t*sin(8*pi*x) + 0.03*sin(22*pi*x + 0.0625*pi*t), \
        0.0075*t*8*pi*cos(8*pi*x) + 0.03*22*pi*cos(22*pi*x + 0.0625*pi*t), \
        -0.0075*t*(8*pi)**2*sin(8*pi*x) - 0.03*(22*pi)**2*sin(22*pi*x + 0.0625*pi*t), \
        0.0075*sin(8*pi*x) + 0.03*0.0625*pi*cos(22*pi*x + 0.0625*pi*t), 0.0004)";
    let comparison = against(&phase_field(), "x, y, t", foreign);
    assert_eq!(comparison.cause, "sign-of-term", "{comparison:?}");
    assert_eq!(comparison.terms, ["reaction", "diffusion"]);
    assert_eq!(
        comparison.sentence,
        "eta: your source has the opposite sign in `reaction` and `diffusion`; the other term is right"
    );
}

/// github.com/Mantevo/miniFE/issues/16: the analytic solution is harmonic, the code's source is 1.
#[test]
fn the_constant_source_of_minife_is_named() {
    let text = file(
        "[\"x\", \"y\", \"z\"]",
        "",
        "x = [0, 1]\ny = [0, 1]\nz = [0, 1]",
        "[exact]\nT = \"sin(pi*y)*sin(pi*z)*sinh(sqrt(2)*pi*x)/sinh(sqrt(2)*pi)\"\n[equations]\nT = \"-laplacian(T)\"\n",
    );
    assert_eq!(found(&check(&text), "source-zero").len(), 1);
    let comparison = against(&text, "x, y, z", "1");
    assert_eq!(
        (comparison.cause, comparison.factors.as_slice()),
        ("constant", [1.0].as_slice())
    );
}

/// github.com/ufz/ogs/pull/2241: the equation of the analytical solution was written on the other
/// side.
#[test]
fn the_sign_of_a_source_of_opengeosys_is_named() {
    let text = file(
        "[\"x\", \"y\"]",
        "",
        "x = [0, 1]\ny = [0, 1]",
        "[exact]\np = \"sin(x)*sin(y)\"\n[equations]\np = \"-laplacian(p)\"\n",
    );
    assert_eq!(against(&text, "x, y", "2*sin(x)*sin(y)").cause, "equal");
    assert_eq!(
        against(&text, "x, y", "-2*sin(x)*sin(y)").cause,
        "sign-of-source"
    );
}

/// github.com/Argonne-National-Laboratory/deer/pull/75: a minus forgotten on the body force, and a
/// solution whose error is round-off.
#[test]
fn the_body_force_of_deer_is_named_and_its_polynomial_noted() {
    let text = file(
        "[\"x\", \"y\"]",
        "",
        "x = [0, 1]\ny = [0, 1]",
        "[exact]\nu = \"x^2*y\"\n[equations]\nu = \"-laplacian(u)\"\n",
    );
    assert_eq!(found(&check(&text), "polynomial")[0].value, Some(3.0));
    assert_eq!(against(&text, "x, y", "2*y").cause, "sign-of-source");
}

/// github.com/pmgbergen/porepy/issues/146: with tractions that vanish the order is seen, with
/// others it is lost.
#[test]
fn tractions_that_vanish_are_noted() {
    let text = |u: &str| {
        file(
            "[\"x\", \"y\"]",
            "",
            "x = [0, 1]\ny = [0, 1]",
            &format!(
                "[exact]\nu = {u}\n[define]\nsigma = \"2*sym(grad(u)) + div(u)*identity\"\n[equations]\nbalance = \"-div(sigma)\"\n\
                      [boundary.x_max]\ntraction = \"dot(sigma, n)\"\n"
            ),
        )
    };
    let vanishing = check(&text("[\"(1 - x)^2*sin(y)\", \"(1 - x)^2*cos(2*y)\"]"));
    assert_eq!(
        found(&vanishing, "data-zero")[0].key,
        "boundary.x_max.traction"
    );
    let other = check(&text("[\"sin(x)*sin(y)\", \"x*cos(2*y)\"]"));
    assert!(found(&other, "data-zero").is_empty());
}

/// MASA, `euler_2d`: compressible flow. Its formulas are products of the same waves; here by hand,
/// with density 1.02 refused as MASA's was.
#[test]
fn compressible_flow_has_the_sources_of_masa() {
    let text = |density: &str| {
        file(
            "[\"x\", \"y\"]",
            "",
            "x = [0, 1]\ny = [0, 1]",
            &format!(
                "[parameters]\nGamma = 1.4\nr0 = {density}\n[exact]\nrho = \"r0 + 2.2*sin(1.1*pi*x) + 3.1*cos(0.7*pi*y)\"\n\
                      v = [\"0.5 + 0.2*sin(1.2*pi*x) + 0.4*cos(0.8*pi*y)\", \"0.7 + 0.3*cos(0.9*pi*x) + 0.6*sin(1.3*pi*y)\"]\n\
                      p = \"50 + 4*cos(1.4*pi*x) + 3*sin(pi*y)\"\n[define]\nE = \"p/(Gamma - 1) + rho*dot(v, v)/2\"\n\
                      [equations]\nmass = \"div(rho*v)\"\nmomentum = \"div(rho*outer(v, v)) + grad(p)\"\nenergy = \"div((E + p)*v)\"\n\
                      [require]\npositive = [\"rho\"]\n"
            ),
        )
    };
    assert_eq!(found(&check(&text("1.02")), "not-positive").len(), 1);
    assert!(found(&check(&text("100.02")), "not-positive").is_empty());
    let [x, y] = [0.37_f64, 0.81];
    let wave = |a: f64, s: f64| [(a * PI * s).sin(), (a * PI * s).cos()];
    let rho = 100.02 + 2.2 * wave(1.1, x)[0] + 3.1 * wave(0.7, y)[1];
    let rho_x = 2.2 * 1.1 * PI * wave(1.1, x)[1];
    let rho_y = -3.1 * 0.7 * PI * wave(0.7, y)[0];
    let u = 0.5 + 0.2 * wave(1.2, x)[0] + 0.4 * wave(0.8, y)[1];
    let u_x = 0.2 * 1.2 * PI * wave(1.2, x)[1];
    let u_y = -0.4 * 0.8 * PI * wave(0.8, y)[0];
    let v = 0.7 + 0.3 * wave(0.9, x)[1] + 0.6 * wave(1.3, y)[0];
    let v_x = -0.3 * 0.9 * PI * wave(0.9, x)[0];
    let v_y = 0.6 * 1.3 * PI * wave(1.3, y)[1];
    let p = 50.0 + 4.0 * wave(1.4, x)[1] + 3.0 * wave(1.0, y)[0];
    let p_x = -4.0 * 1.4 * PI * wave(1.4, x)[0];
    let p_y = 3.0 * PI * wave(1.0, y)[1];
    let mass = rho_x * u + rho * u_x + rho_y * v + rho * v_y;
    let values = at(&text("100.02"), &format!("x,y\n{x},{y}\n"));
    close(&values["sources"]["mass"][0], mass, 100.0);
    let momentum = mass * u + rho * (u * u_x + v * u_y) + p_x;
    close(&values["sources"]["momentum_x"][0], momentum, 100.0);
    let momentum = mass * v + rho * (u * v_x + v * v_y) + p_y;
    close(&values["sources"]["momentum_y"][0], momentum, 100.0);
    let kinetic = 0.5 * (u * u + v * v);
    let growth = u * (u * u_x + v * v_x) + v * (u * u_y + v * v_y);
    let pressure = 1.4 / 0.4 * (u * p_x + v * p_y + p * (u_x + v_y));
    close(
        &values["sources"]["energy"][0],
        mass * kinetic + rho * growth + pressure,
        1000.0,
    );
}

/// Ethier and Steinman's flow solves Navier-Stokes' equations in three dimensions without a source,
/// and does not notice a transposed gradient.
#[test]
fn the_flow_of_ethier_and_steinman_needs_no_source() {
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

/// MFEM, example 3: curl curl E + E = f with E = (sin κy, sin κz, sin κx) has f = (1 + κ²) E.
#[test]
fn maxwell_has_the_source_of_mfem() {
    let text = file(
        "[\"x\", \"y\", \"z\"]",
        "",
        "x = [0, 1]\ny = [0, 1]\nz = [0, 1]",
        "[parameters]\nkappa = \"pi\"\n[exact]\nE = [\"sin(kappa*y)\", \"sin(kappa*z)\", \"sin(kappa*x)\"]\n\
         [equations]\nE = \"curl(curl(E)) + E\"\n",
    );
    let values = at(&text, "x,y,z\n0.3,0.41,0.77\n");
    for (component, s) in [("E_x", 0.41), ("E_y", 0.77), ("E_z", 0.3)] {
        close(
            &values["sources"][component][0],
            (1.0 + PI * PI) * (PI * s).sin(),
            10.0,
        );
    }
}

/// Cahn and Hilliard's equation is of fourth order; by hand for c = cos(x) e^t: ∇⁴c = c, ∇²c³ = 3 c
/// (2 c_x² - c²).
#[test]
fn a_phase_field_of_fourth_order_by_hand() {
    let text = file(
        "[\"x\"]",
        "time = \"t\"",
        "x = [0, 2]\nt = [0, 1]",
        "[parameters]\ngamma = 0.02\n[exact]\nc = \"cos(x)*exp(t)\"\n[define]\nmu = \"c^3 - c - gamma*laplacian(c)\"\n\
         [equations]\nc = \"dt(c) - laplacian(mu)\"\n",
    );
    let [x, t] = [0.7_f64, 0.2];
    let [c, slope] = [x.cos() * t.exp(), -x.sin() * t.exp()];
    let expected = c - (3.0 * c * (2.0 * slope * slope - c * c) + c - 0.02 * c);
    close(
        &at(&text, "x,t\n0.7,0.2\n")["sources"]["c"][0],
        expected,
        1.0,
    );
}

/// A neo-Hookean bar stretched along x only: P = μ (F - 1/F) + λ ln(F)/F with F = 1 + u'.
#[test]
fn a_solid_with_large_strains_by_hand() {
    let text = file(
        "[\"x\", \"y\", \"z\"]",
        "",
        "x = [0, 1]\ny = [0, 1]\nz = [0, 1]",
        "[parameters]\nmu = 1.5\nlambda = 2.5\n[exact]\nu = [\"x^2/2 + x\", \"0\", \"0\"]\n[define]\nF = \"identity + grad(u)\"\n\
         P = \"mu*(F - transpose(inv(F))) + lambda*ln(det(F))*transpose(inv(F))\"\n[equations]\nu = \"-div(P)\"\n\
         [boundary.x_min]\ntraction = \"dot(P, n)\"\n",
    );
    let values = at(&text, "x,y,z,face\n0.4,0.2,0.3,\n0,0.2,0.3,x_min\n");
    let f = 2.4_f64;
    let expected = -(1.5 * (1.0 + 1.0 / (f * f)) + 2.5 * (1.0 - f.ln()) / (f * f));
    close(&values["sources"]["u_x"][0], expected, 1.0);
    let traction = -(1.5 * (2.0 - 0.5) + 2.5 * LN_2 / 2.0);
    close(&values["boundary"]["x_min"]["traction_x"][1], traction, 1.0);
}

/// Stokes' equations for a flow in a pipe: v = (0, 0, 1 - r²), p = -4 z; and with a swirl r³ the
/// source -8 r.
#[test]
fn axisymmetric_stokes_by_hand() {
    let text = file(
        "[\"r\", \"z\"]",
        "system = \"axisymmetric\"",
        "r = [0, 1]\nz = [0, 1]",
        "[exact]\nv = [\"0\", \"r^3\", \"1 - r^2\"]\np = \"-4*z\"\n[equations]\nmomentum = \"-laplacian(v) + grad(p)\"\nmass = \"div(v)\"\n",
    );
    let values = at(&text, "r,z\n0.6,0.3\n");
    for (component, expected) in [
        ("momentum_r", 0.0),
        ("momentum_theta", -4.8),
        ("momentum_z", 0.0),
        ("mass", 0.0),
    ] {
        close(&values["sources"][component][0], expected, 1.0);
    }
}

/// The shallow water equations of Trixi's convergence test, one-dimensional: H = 7 + cos(ω x)
/// cos(2π t), v = 1/2, b = 2 + sin(ω x)/2.
#[test]
fn shallow_water_by_hand() {
    let text = file(
        "[\"x\"]",
        "time = \"t\"",
        "x = [0, \"sqrt(2)\"]\nt = [0, 1]",
        "[parameters]\ng = 9.81\nw = \"sqrt(2)*pi\"\n[exact]\nH = \"7 + cos(w*x)*cos(2*pi*t)\"\nv = \"1/2\"\n\
         [define]\nb = \"2 + sin(w*x)/2\"\nh = \"H - b\"\n[equations]\nmass = \"dt(h) + d(h*v, x)\"\n\
         momentum = \"dt(h*v) + d(h*v^2 + g*h^2/2, x) + g*h*d(b, x)\"\n",
    );
    let [x, t, w] = [0.9_f64, 0.3, SQRT_2 * PI];
    let level_x = -w * (w * x).sin() * (2.0 * PI * t).cos();
    let level_t = -2.0 * PI * (w * x).cos() * (2.0 * PI * t).sin();
    let bottom_x = 0.5 * w * (w * x).cos();
    let h = 7.0 + (w * x).cos() * (2.0 * PI * t).cos() - 2.0 - 0.5 * (w * x).sin();
    let mass = level_t + 0.5 * (level_x - bottom_x);
    let values = at(&text, "x,t\n0.9,0.3\n");
    close(&values["sources"]["mass"][0], mass, 10.0);
    close(
        &values["sources"]["momentum"][0],
        0.5 * mass + 9.81 * h * level_x,
        100.0,
    );
}
