//! Foreign sources with one mistake each: the cause that is named.

use manufacture::InputError;

use crate::prelude::*;

/// Reaction and diffusion with a coefficient that varies.
const FILE: &str = "[manufacture]\nname = \"rd\"\ncoordinates = [\"x\", \"y\"]\ntime = \"t\"\n[domain]\nx = [0, 1]\ny = [0, 1]\nt = [0, 1]\n\
[parameters]\na = 1.7\n[exact]\nu = \"1 + sin(a*x)*exp(-t)*(1 + y^2)\"\nv = [\"sin(x + 2*y)\", \"x*cos(y)\"]\n[define]\nk = \"1 + 0.5*x\"\n\
[equations.u]\nstorage = \"dt(u)\"\ndiffusion = \"-div(k*grad(u))\"\nreaction = \"u^2\"\n[equations]\nv = \"dot(grad(v), v) - div(sym(grad(v)))\"\n\
[boundary.x_max]\nflux = \"-k*dot(grad(u), n)\"\nrobin = \"-k*dot(grad(u), n) - 3*u\"\n";

/// What is said of a program that computes `u` in Python from the terms S (storage), D (diffusion),
/// R (reaction).
fn of(expression: &str, on: Option<&str>, columns: &str) -> Vec<Comparison> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.py");
    let program = format!(
        "import sys\nfrom math import *\nsys.stdin.readline()\nprint('{columns}')\n\
         def u(x, y, t, a=1.7):\n    return 1 + sin(a*x)*exp(-t)*(1 + y*y)\n\
         def S(x, y, t, a=1.7):\n    return -sin(a*x)*exp(-t)*(1 + y*y)\n\
         def L(x, y, t, a=1.7):\n    return exp(-t)*(-a*a*sin(a*x)*(1 + y*y) + 2*sin(a*x))\n\
         def G(x, y, t, a=1.7):\n    return a*cos(a*x)*exp(-t)*(1 + y*y)\n\
         def D(x, y, t, a=1.7):\n    return -(1 + 0.5*x)*L(x, y, t, a) - 0.5*G(x, y, t, a)\n\
         def R(x, y, t, a=1.7):\n    return u(x, y, t, a)**2\n\
         def V(x, y):\n    s, c = sin(x + 2*y), cos(x + 2*y)\n    v = [s, x*cos(y)]\n    g = [[c, 2*c], [cos(y), -x*sin(y)]]\n    \
         return v, g, [0.5*(-2*s - 4*s - sin(y)), 0.5*(-2*s - 2*x*cos(y))]\n\
         for line in sys.stdin:\n    p = [float(word) for word in line.split()]\n    x, y, t = p[:3]\n    {expression}\n"
    );
    fs::write(&path, program).unwrap();
    let sampling = points(100);
    let mut command = Command::new("python3");
    answered(&read(FILE), command.arg(path), on, &sampling).unwrap()
}

fn causes(comparisons: &[Comparison]) -> Vec<&'static str> {
    let comparisons = comparisons.iter();
    comparisons.map(|comparison| comparison.cause).collect()
}

/// The cause that is named, its terms and its factors.
fn in_words(expression: &str) -> String {
    let comparison = of(&format!("print(repr({expression}))"), None, "u").remove(0);
    let factors = comparison.factors.iter();
    let rounded = factors.map(|factor| ((factor * 1e7).round() / 1e7).to_string());
    let words = comparison.terms.iter().cloned().chain(rounded);
    let all = std::iter::once(comparison.cause.to_owned()).chain(words);
    all.collect::<Vec<_>>().join(" ") + "."
}

/// Of a whole source, of its terms, inside a term, and in its arguments; the source itself is
/// equal.
#[test]
fn the_cause_of_each_mistake_is_named() {
    foreign_tools::needs!(PYTHON, SHELL);
    for case in refusals(include_str!("against.txt")) {
        assert_eq!(in_words(&case.new), case.words, "{case:?}");
    }
    let changed = "print(repr(S(x,y,t,2) + D(x,y,t,2) + R(x,y,t,2)))";
    assert_eq!(
        of(changed, None, "u")[0].sentence,
        "u: test.toml:10:5: in parameters.a: your source has `2` where the file has `1.7`"
    );
}

#[test]
fn vectors_are_explained_by_component() {
    foreign_tools::needs!(PYTHON, SHELL);
    let causes = |expression: &str| {
        let text = format!("v, g, s = V(x, y); {expression}");
        causes(&of(&text, None, "v_y v_x"))
    };
    let right =
        "f = [g[i][0]*v[0] + g[i][1]*v[1] - s[i] for i in (0, 1)]; print(repr(f[1]), repr(f[0]))";
    assert_eq!(causes(right), ["equal", "equal"]);
    let transposed =
        "f = [g[0][i]*v[0] + g[1][i]*v[1] - s[i] for i in (0, 1)]; print(repr(f[1]), repr(f[0]))";
    assert_eq!(
        causes(transposed),
        ["transposed-gradient", "transposed-gradient"]
    );
    assert_eq!(
        causes(&right.replace("repr(f[1]), repr(f[0])", "repr(f[0]), repr(f[1])")),
        ["components", "components"]
    );
    let plain = "w = [-sin(x + 2*y)*5, -x*cos(y)]; f = [g[i][0]*v[0] + g[i][1]*v[1] - w[i] for i in (0, 1)]; print(repr(f[1]), repr(f[0]))";
    assert_eq!(causes(plain), ["missing-transpose", "missing-transpose"]);
}

#[test]
fn data_of_a_face_have_their_normal() {
    foreign_tools::needs!(PYTHON, SHELL);
    let flux = |sign: &str| {
        let program = format!(
            "q = {sign}(1 + 0.5*x)*G(x, y, t)*p[3]; print(repr(q), repr(q - 3*u(x, y, t)))"
        );
        causes(&of(&program, Some("x_max"), "flux robin"))
    };
    assert_eq!(flux("-"), ["equal", "equal"]);
    assert_eq!(flux(""), ["normal", "normal"]);
}

#[test]
fn values_with_few_digits_are_right_within_them() {
    foreign_tools::needs!(PYTHON, SHELL);
    let cause = |printed: &str| of(&format!("print({printed})"), None, "u").remove(0).cause;
    for format in ["%.17g", "%.6g", "%.3f", "%.5e"] {
        let printed = format!("'{format}' % (S(x,y,t) + D(x,y,t) + R(x,y,t))");
        assert_eq!(cause(&printed), "equal", "{format}");
    }
    // Five digits do not hide a mistake in the third.
    let printed = "'%.5g' % (S(x,y,t) + 1.01*D(x,y,t) + R(x,y,t))";
    assert_ne!(cause(printed), "equal");
}

/// An energy equation whose terms are some 1e8: a difference of 0.2 is 1e-9 of their sum.
const ENERGY: &str = "[manufacture]\nname = \"energy\"\ncoordinates = [\"x\"]\n[domain]\nx = [0, 1]\n[exact]\nu = \"sin(x)\"\n\
[equations.e]\nflow = \"2e8*u\"\nwork = \"0.2*u^2\"\n";

#[test]
fn a_difference_that_is_small_against_the_terms_is_no_rounding() {
    foreign_tools::needs!(PYTHON, SHELL);
    let said = |statement: &str| against(ENERGY, None, "x,", "e", statement);
    let right = said("f = 2e8*sin(x) + 0.2*sin(x)**2");
    assert_eq!(right.cause, "equal");
    assert!(right.sentence.contains("right"), "{}", right.sentence);
    let lacking = said("f = 2e8*sin(x)");
    assert_eq!(lacking.cause, "missing-term", "{}", lacking.sentence);
    assert_eq!(lacking.terms, ["work"]);
    // Within the rounding of another order of operations, which is said.
    let rounded = said("f = (2e8*sin(x) + 0.2*sin(x)**2)*(1 + 1e-14)");
    assert_eq!(rounded.cause, "equal", "{}", rounded.sentence);
    assert!(
        rounded.sentence.contains("the largest difference, ") && rounded.difference > 0.0,
        "{}",
        rounded.sentence
    );
}

/// What is said of a program that prints these names, and a line for each point of one coordinate.
fn compared(
    file: &str,
    names: &str,
    line: impl Fn(f64) -> String,
) -> Result<Vec<Comparison>, InputError> {
    let (manufacture, sampling) = (read(file), points(40));
    let question = manufacture.question(None, &sampling).unwrap();
    let points = question.text().lines().skip(1).map(str::trim);
    let lines: String = points.map(|x| line(x.parse().unwrap()) + "\n").collect();
    question.compare(&(names.to_owned() + &lines), "other")
}

#[test]
fn the_line_of_a_term_is_that_of_its_own_equation() {
    let file = "[manufacture]\nname = \"two\"\ncoordinates = [\"x\"]\n[domain]\nx = [0, 1]\n\
                [exact]\nu = \"sin(x)\"\nv = \"cos(x)\"\n[equations.first]\ninertia = \"u\"\nload = \"u^2\"\n\
                [equations.second]\ninertia = \"v\"\nload = \"v^3\"\n";
    let found = compared(file, "first second\n", |x| {
        let (u, v) = (x.sin(), x.cos());
        format!("{:?} {:?}", u + u * u, 2.0 * v + 3.0 * v * v * v)
    });
    let found = found.unwrap();
    assert_eq!(found[0].cause, "equal", "{}", found[0].sentence);
    assert_eq!(found[1].terms, ["inertia", "load"], "{}", found[1].sentence);
    let line = "test.toml:13:";
    assert!(found[1].sentence.contains(line), "{}", found[1].sentence);
}

#[test]
fn a_wrong_source_of_two_digits_is_not_taken_for_a_rounded_one() {
    let file = "[manufacture]\nname = \"one\"\ncoordinates = [\"x\"]\n[domain]\nx = [0, 1]\n\
                [exact]\nu = \"1 + x^2\"\n[equations]\nfirst = \"u\"\n";
    let said = |digits: usize| {
        let wrong = |x: f64| 1.05 * (1.0 + x.powi(2));
        compared(file, "", |x| format!("{:.*e}", digits - 1, wrong(x)))
    };
    let refused = said(2).unwrap_err();
    let words = "other:1: `first`: expected numbers of at least three digits";
    assert!(refused.to_string().contains(words), "{refused}");
    let found = said(3).unwrap();
    assert_ne!(found[0].cause, "equal", "{}", found[0].sentence);
}

#[test]
fn answers_that_cannot_be_used_are_refused_with_the_line() {
    let sampling = points(5);
    let manufacture = read(FILE);
    let question = manufacture.question(None, &sampling).unwrap();
    for (answer, words) in [
        ("u\n1\n", ":3: expected 5 lines of numbers, found 1"),
        ("w\n1\n", ":1: unknown name `w`; expected some of u v_x v_y"),
        ("u u\n1 1\n", ":1: expected each name once, found `u` twice"),
        ("u\n1\nnan\n", ":3: expected a finite number, found `nan`"),
        ("1 2\n", ":1: expected a first line of names"),
    ] {
        let message = question.compare(answer, "other").unwrap_err().to_string();
        assert!(message.contains(words), "{answer:?}: {message}");
    }
}

#[test]
fn terms_that_cancel_leave_too_few_digits_to_call_a_source_right() {
    let file = "[manufacture]\nname = \"one\"\ncoordinates = [\"x\"]\n[domain]\nx = [0, 1]\n\
                [exact]\nu = \"exp(x)\"\n[equations]\na = \"u + 1e12*u^2 - 1e12*exp(2*x)\"\n";
    let refused = compared(file, "", |x| format!("{:?}", 1.02 * x.exp()));
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("too few digits to tell"), "{refused}");
}
