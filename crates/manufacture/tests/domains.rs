//! Domains: poles and ends of the domain with their places; what stays bounded; what is not found.

use proptest::prelude::*;

use crate::prelude::*;

/// A stationary file on a box with sides `[0, 1]` under these names.
fn unit_box(coordinates: &[&str], exact: &str, equation: &str) -> String {
    let sides = coordinates.join(" = [0, 1]\n");
    format!(
        "[manufacture]\nname = \"test\"\ncoordinates = {coordinates:?}\n[domain]\n{sides} = [0, 1]\n\
         [exact]\nu = \"{exact}\"\n[equations]\na = \"{equation}\"\n"
    )
}

const FEW: Sampling = Sampling {
    seed: 1,
    points: 20,
    is_strict: false,
};

fn with_parameters(text: &str) -> String {
    text.replace("[exact]", "[parameters]\np = 2\nq = 0.25\n[exact]")
}

/// The error of a check that must refuse its file.
#[track_caller]
fn refused(text: &str) -> String {
    match Manufacture::parse(text, "test.toml").unwrap().check(&FEW) {
        Ok(check) => panic!("accepted: {text}\n{check:#?}"),
        Err(error) => error.to_string(),
    }
}

#[track_caller]
fn is_refused(text: &str, words: &[&str]) {
    let message = refused(text);
    for word in words {
        assert!(message.contains(word), "`{word}` in {message}");
    }
}

/// What is said of the domain.
///
/// * `is_taken`: whether a pole of the exact solution where a branch is not taken may be noted.
fn in_words(check: &Check, is_taken: bool) -> String {
    let is_meant = |finding: &&Finding| match finding.code {
        "pole" => !(is_taken && finding.key == "exact.u"),
        "removable" | "singular" => true,
        "surface-source" => finding.text.contains("the value jumps"),
        code => code == "second-way" && !is_taken,
    };
    let notes = check.findings.iter().filter(is_meant);
    let notes: Vec<String> = notes
        .map(|note| format!("{} at {}: {}", note.code, note.key, note.text))
        .collect();
    let points = format!("nothing at {} points", check.domain_points);
    let notes = if notes.is_empty() {
        points
    } else {
        format!("{} noted: {}", notes.len(), notes.join("; "))
    };
    format!("{}: {notes}", check.verdict)
}

/// A case says the exact solution and the equation. What is not found is not said to be absent: the
/// number of points is reported.
#[test]
fn what_has_its_values_or_stays_bounded_passes_and_a_branch_counts_only_where_it_is_taken() {
    for case in refusals(include_str!("domains.txt")) {
        let (exact, equation) = case.new.split_once('\n').unwrap();
        let files = if let Ok(dimension) = case.kind[..1].parse() {
            vec![unit_box(&["x", "y"][..dimension], exact, equation)]
        } else if case.kind.starts_with("in a plane") {
            let exact = format!("u = \"{exact}\"");
            vec![plane(&exact, "", &format!("a = \"{equation}\""))]
        } else {
            squares(exact, equation).to_vec()
        };
        for file in files {
            let check = check(&with_parameters(&file));
            let words = in_words(&check, case.kind.contains("a branch"));
            assert!(says(&words, case.words), "{case:?}: {words}");
        }
    }
}

/// No finding about the domain.
#[track_caller]
fn is_silent(check: &Check, exact: &str) {
    for code in ["removable", "pole", "singular", "second-way"] {
        assert!(found(check, code).is_empty(), "{exact}: {check:#?}");
    }
}

/// Poles inside, at an edge, in a needle, of even order; logarithms, roots, `asin`, `acos`, `tan`,
/// negative powers, `inv`, parameters, in one to three dimensions, each coordinate in [0, 1]. A
/// guard that lets the wrong points pass, or a use without a guard, is no guard; nor is one up to
/// which the value grows.
#[test]
fn poles_and_ends_of_domains_are_refused_with_their_places() {
    each_is_refused(include_str!("poles.txt"), |case| {
        let (exact, equation) = case.new.split_once('\n').unwrap_or((&case.new, "u"));
        let text = match case.kind.parse() {
            Ok(dimension) => unit_box(&["x", "y", "z"][..dimension], exact, equation),
            Err(_) => squares(exact, equation)[0].clone(),
        };
        refused(&with_parameters(&text))
    });
}

/// With data on the face, all of whose points lie on the switch, and without.
#[test]
fn a_switch_on_a_face_is_a_note() {
    let text = unit_box(&["x"], "where(x > 0, sin(x)/x, 1)", "u + d(u, x)");
    let data = format!("{text}[boundary.x_min]\nu = \"u\"\n");
    for text in [text, data] {
        let check = check(&text);
        let notes = found(&check, "switch-on-face");
        assert_eq!((notes.len(), check.verdict), (1, "pass"), "{check:#?}");
        assert!(notes[0].text.contains("the face x = 0:"), "{check:#?}");
        is_silent(&check, "sin(x)/x");
    }
    for exact in ["where(x > 0.5, x, 0.5)", "abs(x - 0.2)*y"] {
        let inside = unit_box(&["x", "y"], exact, "u");
        let micrometres = inside.replace("0.5", "5e-7").replace("0.2", "2e-7");
        for text in [inside, micrometres.replace("[0, 1]", "[0, 1e-6]")] {
            let check = check(&text);
            assert!(found(&check, "switch-on-face").is_empty(), "{check:#?}");
        }
    }
    let disc = "u = \"max(1 - x^2 - y^2, 0) + exp(x)\"";
    let disc =
        plane(disc, "", "a = \"u\"") + "[boundary.rim]\nlevel = \"x^2 + y^2 - 1\"\nu = \"u\"\n";
    let check = check(&disc);
    let notes = found(&check, "switch-on-face");
    assert_eq!(notes.len(), 1, "{check:#?}");
    assert!(notes[0].text.contains("the face rim:"), "{check:#?}");
}

/// Cones, roots and turning vectors have no derivative on the axis, where no point lies; smooth
/// fields have one, though each derivative along theta divides by r.
#[test]
fn what_grows_towards_the_axis_is_found_and_smooth_fields_are_not_noted() {
    let text = |system: &str, second: &str, exact: &str| {
        format!(
            "[manufacture]\nname = \"test\"\nsystem = \"{system}\"\ncoordinates = [\"r\", \"{second}\"]\n\
             [domain]\nr = [0, 1]\n{second} = [0.2, 1]\n[exact]\nu = {exact}\n[equations]\na = \"u - laplacian(u)\"\n"
        )
    };
    let disc = |exact: &str| text("polar", "theta", &format!("\"{exact}\""));
    let tube = |exact: &str| text("axisymmetric", "z", &format!("\"{exact}\""));
    let smooth = [
        disc("r*cos(theta)*exp(r^2)"),
        disc("r^2*exp(-r^2)*sin(2*theta)"),
        disc("exp(r*cos(theta))*r*sin(theta)"),
        tube("cos(3*r^2)*exp(z)"),
        text(
            "axisymmetric",
            "z",
            "[\"r*exp(z)\", \"0\", \"cos(r^2 + z)\"]",
        ),
    ];
    for text in smooth {
        let check = check(&text);
        assert!(found(&check, "pole").is_empty(), "{text}\n{check:#?}");
    }
    let rough = [
        disc("cos(theta) + exp(r)"),
        tube("r*exp(z)"),
        tube("sqrt(r) + z^3"),
        text("axisymmetric", "z", "[\"exp(z)\", \"0\", \"cos(r^2 + z)\"]"),
    ];
    for text in rough {
        let check = check(&text);
        let notes = found(&check, "pole");
        let words = "on the boundary of the domain: `r` is zero at about r = 0.000000";
        assert!(
            notes.iter().any(|note| note.text.contains(words)),
            "{text}\n{check:#?}"
        );
    }
    is_refused(
        &tube("1/r + z"),
        &["exact.u", "`r` is zero at about r = 0.000000"],
    );
    is_refused(&disc("ln(r)*exp(r)"), &["exact.u", "`r` is not positive"]);
}

#[test]
fn a_face_outside_the_levels_is_named_not_the_level() {
    let text = plane("u = \"exp(x + y)\"", "", "a = \"u\"")
        + "[boundary.x_max]\nu = \"u\"\n[boundary.rim]\nlevel = \"x - 0.5\"\n";
    is_refused(
        &text,
        &[
            "boundary.x_max",
            "no point of the face is inside the domain",
        ],
    );
}

#[test]
fn a_pole_only_in_time_is_found() {
    let text = "[manufacture]\nname = \"test\"\ncoordinates = [\"x\"]\ntime = \"t\"\n[domain]\nx = [0, 1]\nt = [0, 2]\n\
                [exact]\nu = \"sin(x)/(t - 0.7)\"\n[equations]\na = \"dt(u)\"\n";
    is_refused(
        text,
        &["exact.u", "`t - 0.7` is zero at about t = 0.700000;"],
    );
}

#[test]
fn a_variant_with_a_pole_is_left_out_and_the_others_remain() {
    let head = "[parameters]\nb = 2\n[variants]\nparameters = [\"b\"]\n[exact]";
    let text = unit_box(&["x"], "exp(x)", "u/b + d(u, x)").replace("[exact]", head);
    let manufacture = read(&text).with_variants(&points(20)).unwrap();
    let variants = manufacture.variants().unwrap();
    let why = "a pole inside the domain: `b` is zero";
    let of_pole = variants
        .left_out
        .iter()
        .filter(|entry| entry.why.contains(why));
    assert_eq!(of_pole.count(), 1);
    assert!(!variants.usable.is_empty());
}

/// On a square with zero in its middle, and on its boundary.
fn squares(exact: &str, equation: &str) -> [String; 2] {
    let text = unit_box(&["x", "y"], exact, equation);
    [text.replace("[0, 1]", "[-1, 1]"), text]
}

/// A hole that a level cuts out takes the pole away; a smaller one does not.
#[test]
fn a_level_that_cuts_out_the_pole_makes_the_domain_free() {
    let file = |radius: &str| {
        let text = unit_box(
            &["x", "y"],
            "ln((x - 0.3)^2 + (y - 0.6)^2)",
            "laplacian(u) + x*y",
        );
        format!(
            "{text}[boundary.hole]\nlevel = \"{radius}^2 - (x - 0.3)^2 - (y - 0.6)^2\"\nu = \"u\"\n"
        )
    };
    let sound = check(&file("0.1"));
    assert!(found(&sound, "removable").is_empty(), "{sound:#?}");
    let other = file("0.1").replace("0.1^2 - (x - 0.3)", "0.1^2 - (x - 0.5)");
    is_refused(&other, &["exact.u", "x = 0.300000, y = 0.600000"]);
}

type Argument = fn(f64, f64, [f64; 3]) -> f64;

type IsMissing = fn(f64, f64) -> bool;

/// An argument with two factors and a shift: on the square its least and largest values are known
/// from samples.
const ARGUMENTS: [(&str, Argument); 4] = [
    ("A*x + B*y - C", |x, y, [a, b, c]| a * x + b * y - c),
    ("A*x^2 + B*y^2 - C", |x, y, [a, b, c]| {
        a * x * x + b * y * y - c
    }),
    ("sin(3*A*x)*cos(B*y) - C", |x, y, [a, b, c]| {
        (3.0 * a * x).sin() * (b * y).cos() - c
    }),
    ("exp(A*x)*B - y*x - C", |x, y, [a, b, c]| {
        (a * x).exp() * b - y * x - c
    }),
];

/// The argument in a function, and whether it has no value for an argument from `lo` to `hi`.
const FUNCTIONS: [(&str, IsMissing); 5] = [
    ("1/(ARG)", |lo, hi| lo <= 0.0 && 0.0 <= hi),
    ("ln(ARG)", |lo, _| lo <= 0.0),
    ("sqrt(ARG)", |lo, _| lo < 0.0),
    ("(ARG)^-3", |lo, hi| lo <= 0.0 && 0.0 <= hi),
    ("asin(ARG)", |lo, hi| lo < -1.0 || hi > 1.0),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// What dense samples find is found, and nothing where they keep their distance.
    #[test]
    fn the_search_agrees_with_dense_samples(
        argument in 0..4usize, function in 0..5usize,
        a in -200..200i32, b in -200..200i32, c in -300..300i32,
    ) {
        const CELLS: usize = 200;
        let numbers = [a, b, c].map(|number| f64::from(number) / 100.0);
        let (text, value) = ARGUMENTS[argument];
        let (call, is_missing) = FUNCTIONS[function];
        let [mut lo, mut hi] = [f64::INFINITY, f64::NEG_INFINITY];
        for i in 0..=CELLS {
            for j in 0..=CELLS {
                let [x, y] = [i, j].map(|k| k as f64 / CELLS as f64);
                let sample = value(x, y, numbers);
                lo = lo.min(sample);
                hi = hi.max(sample);
            }
        }
        let mut text = call.replace("ARG", text);
        for (name, number) in ["A", "B", "C"].iter().zip(numbers) {
            text = text.replace(name, &format!("({number})"));
        }
        let file = unit_box(&["x", "y"], &text, "u + x");
        let check = Manufacture::parse(&file, "test.toml").unwrap().check(&FEW);
        // Slopes are at most 60: a sample lies within 0.21 of any value.
        const DISTANCE: f64 = 60.0 * 0.5 / CELLS as f64 * 1.42;
        let is_free = check.is_ok_and(|check| {
            found(&check, "pole").is_empty() && found(&check, "removable").is_empty() && found(&check, "singular").is_empty()
        });
        if is_missing(lo, hi) {
            prop_assert!(!is_free, "{text} from {lo} to {hi}");
        }
        if !is_missing(lo - DISTANCE, hi + DISTANCE) {
            prop_assert!(is_free, "{text} from {lo} to {hi}");
        }
    }
}
