//! Sources in closed form: what the two ways of the check share is held to something else here.

use crate::prelude::*;

/// A point away from all symmetries.
const X: f64 = 0.7;
const Y: f64 = 0.4;
const POINT: &str = "x,y\n0.7,0.4\n";

/// The sources of equations at the point.
#[track_caller]
fn in_plane(exact: &str, define: &str, equations: &str, expected: &[(&str, f64)]) {
    sources(&plane(exact, define, equations), POINT, 1.0, expected);
}

#[test]
fn the_gradient_of_a_vector_has_the_component_first_and_the_derivative_second() {
    // v = (x²y, x + y³).
    let v = "v = [\"x^2*y\", \"x + y^3\"]";
    let gradient = [[2.0 * X * Y, X * X], [1.0, 3.0 * Y * Y]];
    in_plane(
        v,
        "g = \"grad(v)\"",
        "a = \"[g[x, x], g[x, y]]\"\nb = \"[g[y, x], g[2, 2]]\"",
        &[
            ("a_x", gradient[0][0]),
            ("a_y", gradient[0][1]),
            ("b_x", gradient[1][0]),
            ("b_y", gradient[1][1]),
        ],
    );
    // (v·∇)v_i = Σ_j v_j ∂_j v_i.
    let v_value = [X * X * Y, X + Y * Y * Y];
    let along = |row: [f64; 2]| row[0] * v_value[0] + row[1] * v_value[1];
    in_plane(
        v,
        "",
        "a = \"dot(grad(v), v)\"\nb = \"curl(v)\"\nc = \"div(v)\"",
        &[
            ("a_x", along(gradient[0])),
            ("a_y", along(gradient[1])),
            ("b", 1.0 - X * X),
            ("c", 2.0 * X * Y + 3.0 * Y * Y),
        ],
    );
}

#[test]
fn the_divergence_of_a_tensor_contracts_its_last_index() {
    let tensor = "A = [[\"x*y\", \"y^2\"], [\"x^3\", \"x*y^2\"]]";
    in_plane(
        tensor,
        "",
        "a = \"div(A)\"\nb = \"div(transpose(A))\"\nc = \"inner(A, A)\"",
        &[
            ("a_x", Y + 2.0 * Y),
            ("a_y", 3.0 * X * X + 2.0 * X * Y),
            ("b_x", Y),
            ("b_y", 2.0 * X * Y),
            (
                "c",
                (X * Y).powi(2) + Y.powi(4) + X.powi(6) + (X * Y * Y).powi(2),
            ),
        ],
    );
    let determinant = X * Y * X * Y * Y - Y * Y * X.powi(3);
    in_plane(
        tensor,
        "",
        "a = \"det(A)\"\nb = \"dot(inv(A), [1, 2])\"\nc = \"trace(A)\"\nd1 = \"skew(A)[x, y]\"",
        &[
            ("a", determinant),
            ("b_x", (X * Y * Y - 2.0 * Y * Y) / determinant),
            ("b_y", (2.0 * X * Y - X.powi(3)) / determinant),
            ("c", X * Y + X * Y * Y),
            ("d1", 0.5 * (Y * Y - X.powi(3))),
        ],
    );
}

#[test]
fn functions_have_their_derivatives_and_both_ways_agree_on_third_ones() {
    let s = "s = \"0.3*x + 0.2*y\"";
    let value = 0.3 * X + 0.2 * Y;
    for (function, slope) in [
        ("sin", value.cos()),
        ("cos", -value.sin()),
        ("tan", 1.0 + value.tan().powi(2)),
        ("asin", 1.0 / (1.0 - value * value).sqrt()),
        ("acos", -1.0 / (1.0 - value * value).sqrt()),
        ("atan", 1.0 / (1.0 + value * value)),
        ("sinh", value.cosh()),
        ("cosh", value.sinh()),
        ("tanh", 1.0 - value.tanh().powi(2)),
        ("exp", value.exp()),
        ("ln", 1.0 / value),
        ("log10", 1.0 / (value * std::f64::consts::LN_10)),
        ("sqrt", 0.5 / value.sqrt()),
        ("abs", 1.0),
    ] {
        in_plane(
            s,
            "",
            &format!("a = \"d({function}(s), x)\""),
            &[("a", 0.3 * slope)],
        );
        // Third derivatives by the rules of the graph and by the recurrences of the jets.
        let third = format!("a = \"d({function}(s), x, x, y) + s^2.5 + x^s\"");
        let check = check(&plane("s = \"0.3*x + 0.2*x*y\"", "", &third));
        for code in ["second-way", "singular"] {
            assert!(found(&check, code).is_empty(), "{function}: {check:#?}");
        }
    }
    in_plane(
        s,
        "",
        "a = \"d(s^x, x)\"\nb = \"d(max(x, y) - min(x, y), y)\"\nc = \"where(x < y, x, y^2) + heaviside(x - y)\"",
        &[
            ("a", value.powf(X) * (value.ln() + X * 0.3 / value)),
            ("b", -1.0),
            ("c", Y * Y + 1.0),
        ],
    );
}

#[test]
fn integrals_run_over_the_whole_interval() {
    // ∫ x² y over [0.2, 1.1], and its derivative by y.
    let cubes = (1.1_f64.powi(3) - 0.2_f64.powi(3)) / 3.0;
    in_plane(
        "u = \"x*sin(y)\"",
        "",
        "a = \"integral(x*u, x)\"\nb = \"d(integral(x*u, x), y)\"\nc = \"integral(integral(x*y, x), y)\"",
        &[
            ("a", cubes * Y.sin()),
            ("b", cubes * Y.cos()),
            ("c", 0.5 * (1.21 - 0.04) * 0.5 * (1.96 - 0.09)),
        ],
    );
}

/// Burgers' equation with u = x/(1 + t): the source is zero but for what is added.
#[test]
fn burgers_by_hand() {
    let text = "[manufacture]\nname = \"burgers\"\ncoordinates = [\"x\"]\ntime = \"t\"\n[domain]\nx = [1, 2]\nt = [0, 1]\n\
                [parameters]\nnu = 0.1\n[exact]\nu = \"x/(1 + t) + x^3\"\n[equations]\nu = \"dt(u) + u*d(u, x) - nu*d(u, x, x)\"\n\
                [initial]\nu = \"u\"\n";
    let [x, t] = [1.3_f64, 0.6];
    let u = x / (1.0 + t) + x.powi(3);
    let slope = 1.0 / (1.0 + t) + 3.0 * x * x;
    let expected = -x / (1.0 + t).powi(2) + u * slope - 0.1 * 6.0 * x;
    let values = sources(text, "x,t\n1.3,0.6\n", 1.0, &[("u", expected)]);
    let term = &values["terms"]["u"]["-nu*d(u, x, x)"][0];
    close(term, -0.1 * 6.0 * x, 1.0);
    close(&values["initial"]["u"][0], x + x.powi(3), 1.0);
}

/// The same Navier-Stokes problem in cylindrical and in Cartesian coordinates.
#[test]
fn cylindrical_coordinates_agree_with_cartesian_ones() {
    let head = |system: &str, coordinates: &str, domain: &str| {
        format!(
            "[manufacture]\nname = \"flow\"\ncoordinates = {coordinates}\nsystem = \"{system}\"\n[domain]\n{domain}\n\
             [parameters]\nnu = 0.3\n[define]\nsigma = \"-p*identity + 2*nu*sym(grad(v))\"\n"
        )
    };
    let equations = "[equations]\nmomentum = \"dot(grad(v), v) - div(sigma) + laplacian(v)\"\nmass = \"div(v)\"\nspin = \"curl(v)\"\nheat = \"laplacian(p)\"\n";
    // v = (x y, z - x², x + y z), p = x² y + z, in both bases.
    let cartesian = head(
        "cartesian",
        "[\"x\", \"y\", \"z\"]",
        "x = [0, 1]\ny = [0, 1]\nz = [0, 1]",
    ) + "[exact]\nv = [\"x*y\", \"z - x^2\", \"x + y*z\"]\np = \"x^2*y + z\"\n"
        + equations;
    let [x, y] = ["(r*cos(phi))", "(r*sin(phi))"];
    let [a, b, c, p] =
        ["x*y", "z - x^2", "x + y*z", "x^2*y + z"].map(|text| text.replace('x', x).replace('y', y));
    let cylindrical = head(
        "cylindrical",
        "[\"r\", \"phi\", \"z\"]",
        "r = [0.5, 1]\nphi = [0, 1]\nz = [0, 1]",
    ) + &format!(
        "[exact]\nv = [\"({a})*cos(phi) + ({b})*sin(phi)\", \"({b})*cos(phi) - ({a})*sin(phi)\", \"{c}\"]\np = \"{p}\"\n{equations}"
    );
    let [r, phi, z] = [0.8_f64, 0.6, 0.35];
    let point = format!("x,y,z\n{},{},{z}\n", r * phi.cos(), r * phi.sin());
    let first = at(&cartesian, &point);
    let number = |component: &str| first["sources"][component][0].as_f64().unwrap();
    let mut expected = vec![("mass", number("mass")), ("heat", number("heat"))];
    for name in ["momentum", "spin"] {
        let [a, b, c] = ["x", "y", "z"].map(|axis| number(&format!("{name}_{axis}")));
        let components = match name {
            "spin" => ["spin_r", "spin_phi", "spin_z"],
            _ => ["momentum_r", "momentum_phi", "momentum_z"],
        };
        let along = [
            a * phi.cos() + b * phi.sin(),
            b * phi.cos() - a * phi.sin(),
            c,
        ];
        expected.extend(components.into_iter().zip(along));
    }
    sources(
        &cylindrical,
        &format!("r,phi,z\n{r},{phi},{z}\n"),
        10.0,
        &expected,
    );
}

/// Swirl in axisymmetric coordinates: (v·∇)v has the centrifugal term -v_θ²/r.
#[test]
fn axisymmetric_vectors_have_three_components() {
    let text = "[manufacture]\nname = \"swirl\"\ncoordinates = [\"r\", \"z\"]\nsystem = \"axisymmetric\"\n[domain]\nr = [0, 1]\nz = [0, 1]\n\
                [exact]\nv = [\"r*z\", \"r^2\", \"-z^2\"]\n[equations]\na = \"dot(grad(v), v)\"\nb = \"div(v)\"\nc = \"laplacian(v)\"\n";
    let [r, z] = [0.6_f64, 0.3];
    let expected = [
        ("a_r", r * z * z - z * z * r - r.powi(4) / r),
        ("a_theta", r * z * 2.0 * r + r * r * r * z / r),
        ("a_z", 2.0 * z.powi(3)),
        ("b", 2.0 * z - 2.0 * z),
        // ∇²(r z) - z/r = 0, ∇²(r²) - 1 = 3, -2.
        ("c_r", 0.0),
        ("c_theta", 3.0),
        ("c_z", -2.0),
    ];
    sources(text, "r,z\n0.6,0.3\n", 1.0, &expected);
}

/// A neo-Hookean bar stretched along x only: P = μ (F - 1/F) + λ ln(F)/F with F = 1 + u'.
#[test]
fn a_stretched_bar_has_the_force_and_the_traction_of_its_law() {
    let text = "[manufacture]\nname = \"bar\"\ncoordinates = [\"x\", \"y\", \"z\"]\n[domain]\nx = [0, 1]\ny = [0, 1]\nz = [0, 1]\n\
                [parameters]\nmu = 1.5\nlambda = 2.5\n[exact]\nu = [\"x^2/2 + x\", \"0\", \"0\"]\n[define]\nF = \"identity + grad(u)\"\n\
                P = \"mu*(F - transpose(inv(F))) + lambda*ln(det(F))*transpose(inv(F))\"\n[equations]\nu = \"-div(P)\"\n\
                [boundary.x_min]\ntraction = \"dot(P, n)\"\n";
    let f = 2.4_f64;
    let expected = -(1.5 * (1.0 + 1.0 / (f * f)) + 2.5 * (1.0 - f.ln()) / (f * f));
    let table = "x,y,z,face\n0.4,0.2,0.3,\n0,0.2,0.3,x_min\n";
    let values = sources(text, table, 1.0, &[("u_x", expected)]);
    let traction = -(1.5 * (2.0 - 0.5) + 2.5 * std::f64::consts::LN_2 / 2.0);
    close(&values["boundary"]["x_min"]["traction_x"][1], traction, 1.0);
}
