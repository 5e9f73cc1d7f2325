//! Input that is refused: the place, what was found, what is expected, the nearest name.

use crate::files::{HEAT, plane, refusal};

/// The heat file with one text replaced must be refused with these words.
#[track_caller]
fn refused(old: &str, new: &str, words: &[&str]) {
    assert!(HEAT.contains(old), "{old}");
    let message = refusal(&HEAT.replace(old, new));
    for word in words {
        assert!(message.contains(word), "`{word}` in {message}");
    }
}

#[test]
fn a_message_has_file_line_key_the_nearest_name_and_a_caret() {
    let text = plane(
        "T = \"x*y\"",
        "kappa = \"2\"",
        "heat = \"div(kapa*grad(T))\"",
    );
    let message = refusal(&text);
    assert_eq!(
        message,
        "test.toml:12:13: equations.heat: unknown name `kapa`, did you mean `kappa`?; expected one of x y T kappa\n    \
         div(kapa*grad(T))\n        ^"
    );
}

#[test]
fn a_missing_table_and_a_norm_in_place_of_a_field_are_explained() {
    let file = |rest: &str| {
        format!(
            "[manufacture]\nname = \"test\"\ncoordinates = [\"x\"]\n{rest}[exact]\np = \"sin(x)\"\n\
             [equations]\na = \"d(p, x)\"\n"
        )
    };
    let message = refusal(&file(""));
    let expected =
        "expected the key `domain` (the interval of each coordinate and of time, as two numbers";
    assert!(message.contains(expected), "{message}");
    let message = refusal(&(file("[domain]\nx = [0, 1]\n") + "[norms]\nL2 = [\"p\"]\n"));
    assert_eq!(
        message,
        "test.toml:11: norms.L2: expected a field and its norms, `p = [\"L2\"]`; found a norm as a key"
    );
}

#[test]
fn names_and_keys_are_checked_before_what_follows_from_them() {
    refused(
        "[equations.heat]",
        "[equation.heat]",
        &["unknown key `equation`", "`equations`?"],
    );
    refused(
        "[exact]",
        "[exakt]",
        &["unknown key `exakt`, did you mean `exact`?"],
    );
    refused(
        "[boundary.x_max]",
        "[boundary.x_max]\nface = \"x_max\"\nlevel = \"x - 1\"",
        &["boundary.x_max.face: found `face` and `level`; expected one of them"],
    );
    refused(
        "n = [",
        "n = [0, ",
        &["study.n: expected a whole number >= 1, found 0"],
    );
    for (number, words) in [
        (
            "nan",
            "test.toml:10: parameters.h: expected a finite number, found NaN",
        ),
        (
            "1e999",
            "parameters.h: expected a finite number, found 1e999",
        ),
        (
            "true",
            "parameters.h: expected an expression as a text, or a number, found true",
        ),
        (
            "[1]",
            "parameters.h: expected an expression as a text, or a number, found [1]",
        ),
    ] {
        refused("h = 2.5", &format!("h = {number}"), &[words]);
    }
    refused(
        "\"T L2\" = 2",
        "\"T L2\" = nan",
        &["study.order.T L2: expected a finite number"],
    );
    refused(
        "time = \"t\"",
        "time = \"t\"\nsystem = 3",
        &["manufacture.system: expected a text, found 3"],
    );
    refused(
        "time = \"t\"",
        "time = \"t\"\nsystem = \"polr\"",
        &["found `polr`, did you mean `polar`?"],
    );
    refused("h = 2.5", "e = 2.5", &["`e` is a constant"]);
    refused("h = 2.5", "n = 2.5", &["`n` is the unit normal"]);
    refused("h = 2.5", "sin = 2.5", &["`sin` is a function"]);
    refused("h = 2.5", "x = 2.5", &["found `x` twice"]);
    refused("h = 2.5", "k = 2.5", &["found `k` twice"]);
    refused(
        "name = \"heat\"",
        "name = \"my heat\"",
        &["a letter, then letters, digits"],
    );
    refused(
        "x = [0, 1]",
        "x = [1, 0]",
        &["the first is the smaller; found [1, 0]", "domain.x"],
    );
    refused(
        "x = [0, 1]",
        "x = [0, 1, 2]",
        &["expected two numbers, found 3"],
    );
    refused(
        "[boundary.x_max]",
        "[boundary.x_mx]",
        &["`x_mx` is no face", "`x_max`?", "y_min"],
    );
    refused(
        "time = \"t\"",
        "time = \"t\"\nsystem = \"spherical\"",
        &["manufacture.system", "spherical coordinates are left out"],
    );
    refused("[\"L2\", \"H1\"]", "[\"L3\"]", &["found `L3`", "Linf"]);
}

#[test]
fn circles_are_printed() {
    let message = refusal(&plane(
        "T = \"x\"",
        "k = \"q\"\nq = \"k + 1\"",
        "a = \"k*T\"",
    ));
    assert!(message.contains("a circle: k -> q -> k"), "{message}");
}

#[test]
fn shapes_are_refused_in_words() {
    for (equation, words) in [
        ("T - 2*grad(T)", "a scalar minus a vector of 2"),
        (
            "T - grad(T)",
            "a scalar minus a vector of 2; expected equal shapes",
        ),
        (
            "v*v",
            "a vector of 2 times a vector of 2; expected a scalar on one side, or dot",
        ),
        ("div(T)", "`div` of a scalar"),
        (
            "v[z]",
            "expected a number from 1 to 2, or one of x y, found z",
        ),
        ("v[3]", "expected a number from 1 to 2"),
        ("dot(T, v)", "`dot` of a scalar and a vector of 2"),
        (
            "trace(v)",
            "`trace` of a vector of 2; expected a square tensor",
        ),
        ("cross(v, [1, 2, 3])", "expected two vectors of 3, or of 2"),
        ("sin(v)", "expected a scalar, found a vector of 2"),
        ("2^v", "a scalar to the power of a vector of 2"),
        ("dt(T)", "expected `time` in [manufacture]"),
        ("d(T, z)", "expected one of x y, found z"),
        (
            "T*n[x]",
            "`n` is the unit normal; expected it in [boundary] only",
        ),
        (
            "grad(v)",
            "expected a scalar or a vector, found a tensor of 2 x 2",
        ),
        ("[1, [2, 3]]", "a scalar beside a vector of 2"),
    ] {
        let text = plane(
            "T = \"x*y\"\nv = [\"x\", \"y^2\"]",
            "",
            &format!("a = \"{equation}\""),
        );
        let message = refusal(&text);
        assert!(message.contains(words), "{equation}: {message}");
    }
}

#[test]
fn the_grammar_is_refused_with_remedies() {
    for (equation, words) in [
        (
            "jump(T)",
            "`jump`: no jumps or means: write a field for each side",
        ),
        ("erf(T)", "`erf`: special functions are left out"),
        ("conj(T)", "`conj`: complex fields are left out"),
        ("T**2", "a power is written ^"),
        ("2T", "a product needs its *"),
        ("2 T", "found `T`; a product needs its *"),
        ("(T", "for the bracket at byte 0, found the end"),
        ("T)", "no bracket is open"),
        (
            "T < 1",
            "a comparison only as the first argument of `where`",
        ),
        ("where(T, 1, 2)", "one of < <= > >= in the condition"),
        ("sin", "`(` after the function `sin`"),
        ("sine(T)", "unknown name `sine`, did you mean `sin`?"),
        (
            "dx(T)",
            "unknown name `dx`; a derivative is written `d(..., x)`; expected one of sin cos",
        ),
        ("dett(T)", "unknown name `dett`, did you mean `det`?"),
        (
            "bessel(T)",
            "a product needs its *, and no function has the name `bessel`",
        ),
        (
            "T(2)",
            "a product needs its *, and no function has the name `T`",
        ),
        ("min(T)", "`min`: expected 2 argument(s), found 1"),
        ("π*T", "write pi"),
        ("", "an empty text"),
        ("1e999", "expected a number of at most"),
    ] {
        let message = refusal(&plane("T = \"x*y\"", "", &format!("a = \"{equation}\"")));
        assert!(message.contains(words), "{equation}: {message}");
    }
    let deep = format!("{}T{}", "(".repeat(300), ")".repeat(300));
    let message = refusal(&plane("T = \"x*y\"", "", &format!("a = \"{deep}\"")));
    assert!(
        message.contains("at most 96 nested operations"),
        "{message}"
    );
}

#[test]
fn an_integral_that_does_not_converge_is_refused() {
    let message = refusal(&plane(
        "T = \"x*y\"",
        "",
        "a = \"integral(abs(x - 0.7), x)*T\"",
    ));
    assert!(
        message.contains("expected a function that is smooth"),
        "{message}"
    );
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
    crate::files::check(&file(40, "F*F/2"));
    let message = refusal(&file(400, "F + 1"));
    assert!(
        message.contains("at most 96 definitions one inside the other"),
        "{message}"
    );
}

/// A sixth derivative of a law for large strains has more nodes than are evaluated in good time.
#[test]
fn a_graph_that_grows_too_large_is_refused_with_its_term() {
    let file = "[manufacture]\nname = \"large\"\ncoordinates = [\"x\", \"y\", \"z\"]\n[domain]\nx = [1, 2]\ny = [1, 2]\nz = [1, 2]\n\
                [exact]\nu = [\"sin(x*y*z + x)*exp(y*z)\", \"x*sqrt(1 + y*z)*cos(x*y)\", \"x^y*atan(z*x)/(1 + exp(x*y))\"]\n\
                [define]\nF = \"identity + grad(u)\"\nP = \"dot(F, inv(dot(transpose(F), F)))*exp(inner(F, F))*tanh(det(F))\"\n\
                [equations]\na = \"laplacian(laplacian(div(div(P))))\"\n";
    let message = refusal(file);
    assert!(
        message.contains("expected at most 200000 nodes of the graph"),
        "{message}"
    );
}

#[test]
fn the_logarithm_of_other_languages_is_named() {
    let message = refusal(&plane("u = \"log(x)\"", "", "a = \"u\""));
    assert!(
        message.contains("`log`: an unknown function") && message.contains("`ln`"),
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
    let values = crate::files::at(&text, "x,y\n0.5,0.4\n");
    let expected: f64 = (1..=300)
        .map(|k| 0.25 * f64::from(k) / f64::from(k + 1))
        .sum();
    crate::files::close(&values["sources"]["b"][0], expected, 1.0);
    for (_, language) in manufacture::Language::ALL {
        assert!(!crate::files::read(&text).emit(language).is_empty());
    }
    let message = refusal(&plane(
        "u = \"x\"",
        "",
        &format!("a = \"x{}\"", " + x".repeat(2000)),
    ));
    assert!(
        message.contains("expected at most 1024 operations without brackets"),
        "{message}"
    );
}

/// A name that is a keyword of a requested language, or that hides what its module needs.
#[test]
fn names_that_a_language_cannot_have_are_refused_in_it_only() {
    use manufacture::Language;
    for (name, language, words) in [
        ("class", Language::Python, "a keyword of Python"),
        (
            "numpy",
            Language::Python,
            "a module that the emitted one would hide",
        ),
        (
            "random",
            Language::Python,
            "a module that the emitted one would hide",
        ),
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
        let manufacture = crate::files::read(&text);
        let message = manufacture.accept(language).unwrap_err().to_string();
        let start = format!("test.toml:2: manufacture.name: found the name `{name}`, which ");
        assert!(
            message.starts_with(&start) && message.contains(words),
            "{message}"
        );
        assert_eq!(manufacture.accept(Language::Ufl), Ok(()));
    }
    let heat = crate::files::read(HEAT);
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
        let sampling = manufacture::Sampling {
            points: 5,
            ..Default::default()
        };
        crate::files::read(&file(level))
            .check(&sampling)
            .unwrap_err()
            .to_string()
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
