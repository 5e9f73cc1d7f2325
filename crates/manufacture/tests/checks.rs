//! The check: each code has a file that brings it forth, and a sound file that does not.

use crate::prelude::*;

/// The head of a stationary file in the plane.
const PLANE: &str = "[manufacture]\nname = \"test\"\ncoordinates = [\"x\", \"y\"]\n\
    [domain]\nx = [0.2, 1.1]\ny = [0.3, 1.4]\n";

/// The findings of a file with that code: where each is, and whether it fails.
fn in_words(text: &str, code: &str) -> String {
    let check = check(text);
    let fails = check.findings.iter().any(|finding| finding.fails);
    assert_eq!(check.verdict == "fail", fails, "{check:#?}");
    let found = found(&check, code);
    let words = found.iter().map(|finding| {
        let verb = if finding.fails { "fails" } else { "is noted" };
        format!("{code} at {} {verb}", finding.key)
    });
    let words: Vec<String> = words.collect();
    let is_one = |verb: &str| words.iter().all(|word| word.ends_with(verb));
    assert!(is_one("fails") || is_one("is noted"), "{words:?}");
    match words.len() {
        0 => format!("no {code}"),
        _ => words.join("; "),
    }
}

/// A case says the finding that its file has, or the code of which it has none: a value that is a
/// little off, an overflow, and a lowest sample that is positive although the corner is not, too.
#[test]
fn each_code_has_files_that_bring_it_forth_and_files_that_do_not() {
    each_is_refused(include_str!("checks.txt"), |case| {
        let head = if case.kind.starts_with("in the plane") {
            PLANE
        } else {
            HEAT
        };
        let code = case.words.trim_start_matches("no ").split(' ').next();
        in_words(&format!("{head}\n{}\n", case.new), code.unwrap_or_default())
    });
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
}

#[test]
fn faces_of_level_sets_have_points_and_normals() {
    let file = "[manufacture]\nname = \"disc\"\ncoordinates = [\"x\", \"y\"]\n[domain]\nx = [-2, 2]\ny = [-1, 1]\n[exact]\nu = \"x^3 + y\"\n\
                [equations]\na = \"laplacian(u)\"\n[boundary.rim]\nlevel = \"x^2/4 + y^2 - 1\"\nflux = \"dot(grad(u), n)\"\n\
                [require]\npositive = [\"1.0001 - x^2/4 - y^2\"]\n";
    assert_eq!(check(file).verdict, "pass");
    // At (2 cos, sin) the normal is (cos/2, sin)/length.
    let [c, s] = [0.6_f64, 0.8];
    let values = at(file, "x,y,face\n1.2,0.8,rim\n0.1,0.1,\n");
    let length = (c * c / 4.0 + s * s).sqrt();
    let expected = (3.0 * 1.44 * c / 2.0 + s) / length;
    close(&values["boundary"]["rim"]["flux"][0], expected, 1.0);
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
    let values = at(FILE, "x,y,face\n0.36,0.48,circle\n");
    let data = &values["boundary"]["circle"];
    let inside = x.cos() * (0.5 * y).exp();
    close(&data["jump"][0], inside - 1.0 - (x + 2.0 * y).sin(), 1.0);
    // The normal at (0.36, 0.48) is (-0.6, -0.8).
    let slope = (x + 2.0 * y).cos();
    let along_x = -10.0 * x.sin() * (0.5 * y).exp() - slope;
    let along_y = 5.0 * inside - 2.0 * slope;
    let flux = -0.6 * along_x - 0.8 * along_y;
    close(&data["flux_jump"][0], flux, 10.0);
    let is = "jump = { of = \"u_in - u_out\", is = \"0\" }";
    let required = FILE.replace("jump = \"u_in - u_out\"", is);
    let violated = "condition-violated at boundary.circle.jump fails";
    assert_eq!(in_words(&required, "condition-violated"), violated);
}

/// A file of one coordinate and time.
fn in_time(exact: &str) -> String {
    let head = "[manufacture]\nname = \"test\"\ncoordinates = [\"x\"]\ntime = \"t\"\n\
                [domain]\nx = [0, 1]\nt = [0, 1]\n";
    format!(
        "{head}[exact]\nu = \"{exact}\"\n[equations]\na = \"dt(u) - laplacian(u)\"\n[initial]\nu = \"u\"\n"
    )
}

#[test]
fn a_solution_without_time_and_initial_values_of_zero_are_noted() {
    for (exact, note) in [
        ("exp(x)*sin(3*x)", "coordinate-unseen at exact.u is noted"),
        ("exp(x)*sin(3*x + t)", "no coordinate-unseen"),
        ("exp(x)*sin(3*x)*sin(t)", "data-zero at initial.u is noted"),
        ("exp(x)*sin(3*x)*cos(t)", "no data-zero"),
    ] {
        let code = note.trim_start_matches("no ").split(' ').next().unwrap();
        assert_eq!(in_words(&in_time(exact), code), note, "{exact}");
    }
}

#[test]
fn a_polynomial_in_time_is_noted() {
    let linear = check(&in_time("exp(x)*(1 + t)"));
    let notes = found(&linear, "polynomial");
    assert_eq!(notes.len(), 1, "{linear:#?}");
    assert!(
        notes[0]
            .text
            .starts_with("a polynomial of degree 1 in time"),
        "{linear:#?}"
    );
    for exact in ["exp(x)*exp(-t)", "exp(x)*(1 + x)", "sin(x + t)"] {
        assert!(
            found(&check(&in_time(exact)), "polynomial").is_empty(),
            "{exact}"
        );
    }
}
