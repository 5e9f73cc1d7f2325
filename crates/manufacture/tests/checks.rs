//! The check: each code has a file that brings it forth, and a sound file that does not.

use manufacture::Sampling;

use crate::files::{HEAT, check, found, plane, read};

/// The file has a finding with this code at this key.
#[track_caller]
fn finds(text: &str, code: &str, key: &str, fails: bool) {
    let check = check(text);
    let findings = found(&check, code);
    assert!(
        findings.iter().any(|finding| finding.key == key),
        "{code} {key}: {check:#?}"
    );
    assert!(findings.iter().all(|finding| finding.fails == fails));
    assert_eq!(
        check.verdict == "fail",
        check.findings.iter().any(|finding| finding.fails)
    );
}

#[track_caller]
fn does_not_find(text: &str, code: &str) {
    let check = check(text);
    assert!(found(&check, code).is_empty(), "{code}: {check:#?}");
}

#[test]
fn a_sound_file_passes_and_the_shares_of_its_terms_are_known() {
    let check = check(HEAT);
    assert_eq!(check.verdict, "pass", "{check:#?}");
    let shares: Vec<&str> = check
        .shares
        .iter()
        .map(|share| share.term.as_str())
        .collect();
    assert_eq!(shares, ["storage", "conduction"]);
    assert_eq!(check.shares[1].share, 1.0);
    assert!(check.shares[0].share > 0.02 && check.shares[0].share < 0.2);
}

#[test]
fn strict_checks_fail_by_notes() {
    let sampling = Sampling {
        points: 50,
        is_strict: true,
        ..Sampling::default()
    };
    let check = read(HEAT).check(&sampling).unwrap();
    assert_eq!(check.verdict, "fail");
    assert!(check.findings.iter().all(|finding| !finding.fails));
}

#[test]
fn conditions_are_held() {
    let file = |is: &str| {
        format!(
            "{}[boundary.x_min]\nu = {{ of = \"u\", is = \"{is}\" }}\n",
            plane("u = \"(x - 0.2)*sin(y)\"", "", "a = \"laplacian(u)\"")
        )
    };
    does_not_find(&file("0"), "condition-violated");
    finds(&file("1"), "condition-violated", "boundary.x_min.u", true);
    finds(
        &file("1e-9"),
        "condition-violated",
        "boundary.x_min.u",
        true,
    );
}

#[test]
fn requirements_are_held() {
    let file = |requirement: &str| {
        format!(
            "{}[require]\n{requirement}\n",
            plane(
                "u = \"x - 0.19 + sin(y)\"\nv = [\"y\", \"x\"]",
                "",
                "a = \"laplacian(u)\""
            )
        )
    };
    does_not_find(&file("positive = [\"u\"]"), "not-positive");
    // The lowest sample is positive, the corner is not.
    finds(
        &file("positive = [\"u - 0.306\"]"),
        "not-positive",
        "require.positive",
        true,
    );
    does_not_find(&file("zero = [\"div(v)\"]"), "not-zero");
    finds(
        &file("zero = [\"grad(v)\"]"),
        "not-zero",
        "require.zero",
        true,
    );
}

/// An overflow is no pole, but no value, either.
#[test]
fn values_that_are_not_finite_are_singular() {
    finds(
        &plane("u = \"exp(1000*x)\"", "", "a = \"u\""),
        "singular",
        "exact.u",
        true,
    );
}

#[test]
fn terms_that_cannot_be_missed_are_noted() {
    let file = |equation| {
        plane(
            "u = \"sin(x + 0.3)*exp(y)\"",
            "",
            &format!("a = \"{equation}\""),
        )
    };
    for (equation, code) in [
        ("d(u, x, x) + d(u, y, y)", "source-zero"),
        ("u + d(x, y)", "term-absent"),
        ("u + 0.001*d(u, x)", "term-small"),
        ("u + d(u, y) + x", "terms-proportional"),
        ("u*x + u*y + u*(x - 2*y)", "terms-proportional"),
    ] {
        finds(&file(equation), code, "equations.a", false);
    }
    does_not_find(&file("u + x*d(u, x)"), "terms-proportional");
}

#[test]
fn slips_that_cannot_be_seen_are_noted() {
    for (fields, define, equation, is_noted) in [
        // The velocity of a rigid rotation: its gradient is skew, so v·∇v with the transpose has
        // the opposite sign.
        ("v = [\"-y\", \"x\"]", "", "dot(grad(v), v)", false),
        // A gradient field has a symmetric gradient.
        (
            "v = [\"y*cos(x*y)\", \"x*cos(x*y)\"]",
            "",
            "dot(grad(v), v)",
            true,
        ),
        // A constant coefficient has no derivative, so there is no slip.
        ("u = \"sin(x)*y^3\"", "k = \"2\"", "div(k*grad(u))", false),
        (
            "u = \"sin(x)*y^3\"",
            "k = \"2 + x\"",
            "div(k*grad(u))",
            false,
        ),
        // The coefficient varies across the gradient only.
        ("u = \"sin(x)\"", "k = \"2 + y\"", "div(k*grad(u))", true),
    ] {
        let text = plane(fields, define, &format!("a = \"{equation}\""));
        if is_noted {
            finds(&text, "slip-invisible", "equations.a", false);
        } else {
            does_not_find(&text, "slip-invisible");
        }
    }
}

/// A gradient transposed inside a symmetric form changes nothing for any solution, nor does the
/// missing transpose where viscosity is constant and the velocity has no divergence.
#[test]
fn elasticity_and_stokes_flow_pass_strictly() {
    let strict = |fields: &str, define: &str, equations: &str| {
        let sampling = Sampling {
            points: 100,
            is_strict: true,
            ..Sampling::default()
        };
        let check = read(&plane(fields, define, equations))
            .check(&sampling)
            .unwrap();
        assert_eq!(check.findings, [], "{equations}");
        assert_eq!(check.verdict, "pass");
    };
    strict(
        "u = [\"sin(x + 2*y)\", \"exp(x)*cos(y)\"]",
        "sigma = \"2*sym(grad(u)) + 3*div(u)*identity\"",
        "balance = \"-div(sigma)\"",
    );
    strict(
        "v = [\"sin(x)*exp(2*y)*2\", \"-cos(x)*exp(2*y)\"]\np = \"sin(x)*exp(y)\"",
        "tau = \"2*1.3*sym(grad(v)) - p*identity\"",
        "momentum = \"-div(tau)\"",
    );
    // With a viscosity that varies the missing transpose can be seen, but not by a gradient field.
    finds(
        &plane(
            "v = [\"y*cos(x*y)\", \"x*cos(x*y)\"]",
            "",
            "momentum = \"-div((1 + x)*sym(grad(v)))\"",
        ),
        "slip-invisible",
        "equations.momentum",
        false,
    );
}

#[test]
fn data_that_are_zero_are_noted() {
    let file = |datum: &str| {
        format!(
            "{}[boundary.x_max]\nflux = \"{datum}\"\n",
            plane("u = \"sin(y)*(x - 1.1)^2\"", "", "a = \"laplacian(u)\"")
        )
    };
    finds(
        &file("dot(grad(u), n)"),
        "data-zero",
        "boundary.x_max.flux",
        false,
    );
    does_not_find(&file("dot(grad(u), n) + y"), "data-zero");
}

#[test]
fn polynomials_and_symmetries_are_noted() {
    let file = |exact| plane(&format!("u = \"{exact}\""), "", "a = \"u\"");
    for (exact, code) in [
        ("x^2*y", "polynomial"),
        ("cos(x - 0.65)*exp(y)", "symmetric"),
        ("cos(2*pi*x/0.9)*exp(y)*sin(2*pi*x/0.9)", "symmetric"),
    ] {
        finds(&file(exact), code, "exact.u", false);
    }
    does_not_find(&file("x^2*sin(y)"), "polynomial");
    does_not_find(&file("cos(x)*exp(y)"), "symmetric");
}

#[test]
fn initial_data_agree_with_conditions() {
    let file = |condition: &str| {
        format!("{HEAT}\n[boundary.y_max]\nT = {{ of = \"T\", is = \"{condition}\" }}\n")
    };
    let sound = file("1 + 0.3*sin(pi*x)*cos(2)*exp(-t)");
    does_not_find(&sound, "initial-mismatch");
    does_not_find(&sound, "condition-violated");
    finds(&file("1"), "initial-mismatch", "boundary.y_max.T", false);
}

#[test]
fn faces_of_level_sets_have_points_and_normals() {
    let file = "[manufacture]\nname = \"disc\"\ncoordinates = [\"x\", \"y\"]\n[domain]\nx = [-2, 2]\ny = [-1, 1]\n[exact]\nu = \"x^3 + y\"\n\
                [equations]\na = \"laplacian(u)\"\n[boundary.rim]\nlevel = \"x^2/4 + y^2 - 1\"\nflux = \"dot(grad(u), n)\"\n\
                [require]\npositive = [\"1.0001 - x^2/4 - y^2\"]\n";
    assert_eq!(check(file).verdict, "pass");
    // At (2 cos, sin) the normal is (cos/2, sin)/length.
    let [c, s] = [0.6_f64, 0.8];
    let values = crate::files::at(file, "x,y,face\n1.2,0.8,rim\n0.1,0.1,\n");
    let length = (c * c / 4.0 + s * s).sqrt();
    let expected = (3.0 * 1.44 * c / 2.0 + s) / length;
    crate::files::close(&values["boundary"]["rim"]["flux"][0], expected, 1.0);
    assert!(values["boundary"]["rim"]["flux"][1].is_null());
}

#[test]
fn a_check_is_the_same_for_any_order_of_keys() {
    let swap = |text: &str, [first, second]: [&str; 2]| {
        let both = format!("{first}\n{second}\n");
        assert!(text.contains(&both), "{both}");
        text.replace(&both, &format!("{second}\n{first}\n"))
    };
    let terms = swap(HEAT, ["storage = \"dt(T)\"", "conduction = \"div(q)\""]);
    let reordered = swap(&terms, ["x = [0, 1]", "y = [0, 2]"]);
    let mut other = check(&reordered);
    // The table is in the order of the file.
    other.shares.reverse();
    assert_eq!((other.shares.len(), other), (2, check(HEAT)));
}

#[test]
fn renaming_a_coordinate_changes_no_value() {
    let file = |x: &str| {
        plane(
            "u = \"sin(2*X)*exp(y)\"",
            "k = \"1 + X^2\"",
            "a = \"-div(k*grad(u)) + d(u, X)\"",
        )
        .replace('X', x)
        .replace("\"x\", \"y\"", &format!("\"{x}\", \"y\""))
        .replace("x = [", &format!("{x} = ["))
    };
    assert_eq!(check(&file("x")).shares.len(), 2);
    let values =
        |x: &str| crate::files::at(&file(x), &format!("{x},y\n0.7,0.4\n"))["sources"].clone();
    assert_eq!(values("x"), values("xi"));
}

/// The page's file: two fields on both sides of a circle, and the jumps as data of it.
#[test]
fn an_interface_by_two_fields_has_its_jumps_as_data() {
    const FILE: &str = include_str!("files/interface.toml");
    const PAGE: &str = include_str!("../../convergence-study/book/src/interfaces.md");
    assert!(PAGE.contains(&format!("```toml\n{FILE}```")));
    assert_eq!(check(FILE).verdict, "pass");
    let reversed = FILE.replace("R^2 - x^2 - y^2", "x^2 + y^2 - R^2");
    let inner = reversed.split("[boundary.x_max]").next().unwrap();
    assert_eq!(check(inner).verdict, "pass");
    let [x, y] = [0.36_f64, 0.48];
    let values = crate::files::at(FILE, "x,y,face\n0.36,0.48,circle\n");
    let data = &values["boundary"]["circle"];
    let inside = x.cos() * (0.5 * y).exp();
    crate::files::close(&data["jump"][0], inside - 1.0 - (x + 2.0 * y).sin(), 1.0);
    // The normal at (0.36, 0.48) is (-0.6, -0.8).
    let slope = (x + 2.0 * y).cos();
    let along_x = -10.0 * x.sin() * (0.5 * y).exp() - slope;
    let along_y = 5.0 * inside - 2.0 * slope;
    let flux = -0.6 * along_x - 0.8 * along_y;
    crate::files::close(&data["flux_jump"][0], flux, 10.0);
    let is = "jump = { of = \"u_in - u_out\", is = \"0\" }";
    let required = FILE.replace("jump = \"u_in - u_out\"", is);
    finds(
        &required,
        "condition-violated",
        "boundary.circle.jump",
        true,
    );
}
