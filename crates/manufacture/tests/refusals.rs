//! Input that is refused: the place, what was found, what is expected, the nearest name.

use crate::prelude::*;

/// Names and keys are checked before what follows from them; shapes and the grammar are refused in
/// words, with remedies. A sixth derivative of a law for large strains has more nodes than are
/// evaluated in good time.
#[test]
fn input_is_refused_with_what_is_found_and_what_is_expected() {
    each_is_refused(include_str!("refused.txt"), |case| match case.kind {
        "the heat file" => {
            assert!(HEAT.contains(&case.old), "{case:?}");
            refusal(&HEAT.replace(&case.old, &case.new))
        }
        "a whole file" => refusal(&case.new),
        _ => term(&case.new),
    });
}

/// The refusal of an equation of a scalar and a vector.
fn term(text: &str) -> String {
    let fields = "T = \"x*y\"\nv = [\"x\", \"y^2\"]";
    refusal(&plane(fields, "", &format!("a = \"{text}\"")))
}

#[test]
fn what_is_nested_too_deeply_or_too_long_is_refused() {
    let deep = format!("{}T{}", "(".repeat(300), ")".repeat(300));
    let long = format!("x{}", " + x".repeat(2000));
    for (text, most) in [
        (deep, "at most 96 nested operations"),
        (long, "expected at most 1024 operations without brackets"),
    ] {
        let message = term(&text);
        assert!(message.contains(most), "{message}");
    }
}

/// Definitions that double at each step, or that are nested deeply, take no time that grows with
/// the number of paths.
#[test]
fn long_chains_of_definitions_are_read_or_refused() {
    // The first in the alphabet is the last of the chain.
    let file = |count: usize, rule: &str| {
        let step = |i: usize| {
            format!(
                "f{i:03} = \"{}\"\n",
                rule.replace('F', &format!("f{:03}", i + 1))
            )
        };
        let define: String = (0..count).map(step).collect();
        plane(
            "u = \"f000\"",
            &format!("{define}f{count:03} = \"x\""),
            "a = \"div(f000*grad(u))\"",
        )
    };
    check(&file(40, "F*F/2"));
    let message = refusal(&file(400, "F + 1"));
    assert!(
        message.contains("at most 96 definitions one inside the other"),
        "{message}"
    );
}

/// A sum without brackets is as long as it needs to be, and is emitted.
#[test]
fn a_flat_sum_of_three_hundred_terms_is_read_and_emitted() {
    let terms: Vec<String> = (1..=300).map(|k| format!("{k}*x^2/{}", k + 1)).collect();
    let sum = terms.join(" + ");
    let text = plane(
        "u = \"exp(x)\"",
        "",
        &format!("a = \"u*({sum})\"\nb = \"{sum}\""),
    );
    let values = at(&text, "x,y\n0.5,0.4\n");
    let expected: f64 = (1..=300)
        .map(|k| 0.25 * f64::from(k) / f64::from(k + 1))
        .sum();
    close(&values["sources"]["b"][0], expected, 1.0);
    for (_, language) in Language::ALL {
        assert!(!read(&text).emit(language).is_empty());
    }
}

/// A name that is a keyword of a requested language, or that hides what its module needs.
#[test]
fn names_that_a_language_cannot_have_are_refused_in_it_only() {
    let hidden = "a module that the emitted one would hide";
    for (name, language, words) in [
        ("class", Language::Python, "a keyword of Python"),
        ("numpy", Language::Python, hidden),
        ("random", Language::Python, hidden),
        ("math", Language::C, "a header of the standard library"),
        ("DP", Language::Fortran, "the emitted module itself"),
        (
            "source_a",
            Language::Fortran,
            "a function of the emitted module",
        ),
        ("iso_c_binding", Language::Fortran, "an intrinsic module"),
        ("endfunction", Language::Octave, "a keyword of Octave"),
        ("sin", Language::Octave, "a function of Octave"),
        ("fn", Language::Rust, "a keyword of Rust"),
        ("std", Language::Rust, "a crate that every program has"),
    ] {
        let text = plane("u = \"x\"", "", "a = \"u\"").replace("\"test\"", &format!("\"{name}\""));
        let manufacture = read(&text);
        let message = manufacture.accept(language).unwrap_err().to_string();
        let start = format!("test.toml:2: manufacture.name: found the name `{name}`, which ");
        assert!(
            message.starts_with(&start) && message.contains(words),
            "{message}"
        );
        assert_eq!(manufacture.accept(Language::Ufl), Ok(()));
    }
    let heat = read(HEAT);
    for (_, language) in Language::ALL {
        assert_eq!(heat.accept(language), Ok(()));
    }
}

#[test]
fn a_level_without_an_inside_is_named() {
    let file = |level: &str| {
        format!(
            "{}[boundary.rim]\nlevel = \"{level}\"\nu = \"u\"\n",
            plane("u = \"x\"", "", "a = \"u\"")
        )
    };
    let message = |level: &str| {
        let checked = read(&file(level)).check(&points(5));
        checked.unwrap_err().to_string()
    };
    let outside = message("x^2 + y^2");
    assert!(
        outside.starts_with("test.toml:13: boundary.rim: no point of the box is inside")
            && outside.contains("the level of rim to be negative inside the domain"),
        "{outside}"
    );
    let nowhere = message("x^2 + y^2 - 100");
    assert!(
        nowhere.contains("boundary.rim: the level is zero nowhere"),
        "{nowhere}"
    );
}

#[test]
fn a_table_of_points_is_refused_with_two_columns_of_a_name_and_with_points_off_their_face() {
    let text = plane("u = \"sin(x)*exp(y)\"", "", "a = \"laplacian(u) + u\"");
    let text = text
        + "[boundary.x_max]\nu = \"u\"\n[boundary.rim]\nlevel = \"x^2 + y^2 - 1\"\nflux = \"dot(grad(u), n)\"\n";
    for (table, message) in [
        (
            "x,x,y\n0.3,0.9,0.4\n",
            "points.csv:1: expected each column once, found `x` twice",
        ),
        (
            "x,y,face\n1.1,0.4,x_max\n0.3,0.4,x_max\n",
            "points.csv:3: expected a point of the face `x_max`, where x is 1.1; found 0.3",
        ),
        (
            "x,y,face\n0.6,0.8,rim\n0.6,0.81,rim\n",
            "points.csv:3: expected a point of the face `rim`, where `x^2 + y^2 - 1` is 0; found 0.016",
        ),
    ] {
        let refused = read(&text).at(table, "points.csv").unwrap_err().to_string();
        assert!(refused.starts_with(message), "{refused}");
    }
}
