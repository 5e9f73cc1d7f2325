//! Modules with variants: what each language computes with each of them, and how it refuses one
//! that it does not have.

use crate::emitted::compiles_without_a_warning;
use crate::functions;
use crate::prelude::*;

/// Time, two fields, a tensor, an integral, parameters of which one is set to zero and another
/// depends on it, a normal.
const RICH: &str = r#"
[manufacture]
name = "rich"
coordinates = ["x", "y"]
time = "t"
[domain]
x = [0, 1]
y = [0.5, 2]
t = [0.25, 1]
[parameters]
b = 0.4
k = "1 + b/2"
a = 1.5
[exact]
u = "2 + sin(x + 0.3*y)*exp(-t)"
v = ["x*y + t", "cos(y)*t"]
[define]
q = "-k*grad(u)"
[equations.u]
storage = "dt(u)"
conduction = "div(q)"
advection = "b*d(u, x) + a*dot(v, grad(u))"
memory = "integral(u*x, x)/3"
[equations.v]
storage = "dt(v)"
pull = "grad(u)"
[boundary.x_max]
flux = "dot(q, n)"
[boundary.y_min]
u = "u"
[initial]
u = "u"
[variants]
parameters = ["b"]
[norms]
u = ["L1", "L2", "Linf", "H1"]
"#;

/// Stationary, without parameters.
const STILL: &str = r#"
[manufacture]
name = "still"
coordinates = ["x"]
[domain]
x = [0, 1]
[exact]
u = "exp(x)*sin(2*x)"
[equations.u]
diffusion = "-d(u, x, x)"
[boundary.x_min]
u = "u"
[boundary.x_max]
u = "u"
"#;

/// The module of a file with its variants, and their names.
fn module(text: &str, language: Language) -> (Module, Vec<String>) {
    let manufacture = read(text).with_variants(&points(30)).unwrap();
    let usable = manufacture.variants().unwrap().usable.iter();
    let names = usable.map(|variant| variant.name.clone());
    let module = Module::new(manufacture.name(), manufacture.emit(language));
    (module, names.collect())
}

/// Sources, data, exact values, gradients, definitions, terms and joint sources of each variant, as
/// the library evaluates them, with the parameters of the file and with others.
#[test]
fn each_language_has_the_values_of_each_variant() {
    // Octave is started for each question, and takes a second.
    let rich = languages().filter(|language| *language != Language::Octave);
    let pairs = rich.map(|language| (RICH, language));
    for (text, language) in pairs.chain(languages().map(|language| (STILL, language))) {
        let manufacture = read(text).with_variants(&points(30)).unwrap();
        let variants = manufacture.variants().unwrap();
        assert!(variants.usable.len() >= 4, "{:?}", variants.left_out);
        let folder = TempDir::new().unwrap();
        let findings = manufacture
            .check_emitted(language, folder.path(), &points(30))
            .unwrap();
        none_fails(&findings);
    }
}

/// What is found in a module after a text in one branch of a field has been replaced.
fn found_after(language: Language, file: &str, places: [&str; 3], text: &str) -> Vec<String> {
    let manufacture = read(STILL).with_variants(&points(30)).unwrap();
    let (module, _) = module(STILL, language);
    let path = module.folder.path().join(file);
    let source = fs::read_to_string(&path).unwrap();
    let find = |from: usize, place: &str| from + source[from..].find(place).unwrap();
    let start = places.iter().fold(0, |from, place| find(from, place));
    let end = start + places[2].len();
    fs::write(&path, [&source[..start], text, &source[end..]].concat()).unwrap();
    let findings = manufacture.check_built(language, module.folder.path(), &points(30));
    let findings = findings.unwrap().into_iter();
    findings.map(|finding| finding.text).collect()
}

/// A slip in one branch of a field is found, and named with its variant: `flat_x_max`, the
/// third.
#[test]
fn a_slip_in_a_variant_is_found() {
    foreign_tools::needs!(C, NUMPY);
    let c = [
        "double still_field_u(const double x[])\n{",
        "case 3: {",
        "return ",
    ];
    let python = ["def field_u(", "_NUMBER in [3]:", "out[0] = "];
    for texts in [
        found_after(Language::C, "still.c", c, "return 1.001*"),
        found_after(Language::Python, "still.py", python, "out[0] = 1.001*"),
    ] {
        let mut of_variant = texts
            .iter()
            .filter_map(|text| text.strip_prefix("flat_x_max: "));
        assert_eq!(of_variant.clone().count(), texts.len(), "{texts:?}");
        assert!(
            of_variant.any(|text| text.starts_with("exact_u differs by")),
            "{texts:?}"
        );
    }
}

/// A module that fails with one variant is compared with all others.
#[test]
fn a_module_that_fails_with_a_variant_fails_with_no_other() {
    foreign_tools::needs!(NUMPY);
    let places = ["def field_u(", "_NUMBER in [3]:", "out[0] = "];
    let texts = found_after(Language::Python, "still.py", places, "out[0] = missing*");
    let expected = "flat_x_max: python3: ended without an answer";
    assert!(
        !texts.is_empty() && texts.iter().all(|text| text == expected),
        "{texts:?}"
    );
}

const NAMES: &str = "constant_x flat_x_min flat_x_max flat_x";

/// A program that prints a value at a point.
fn still_program(language: Language) -> &'static str {
    match language {
        Language::C => {
            "#include <stdio.h>\n#include \"still.h\"\n\
             int main(void) { const double x[] = {0.3}; printf(\"%.17g\\n\", still_source_u(x)); return 0; }\n"
        }
        Language::Fortran => {
            "program driver\nuse still\nimplicit none\ncall choose_variant()\n\
             print '(es25.16)', source_u([0.3d0])\nend program driver\n"
        }
        Language::Rust => {
            "#[path = \"still.rs\"]\nmod still;\nfn main() { println!(\"{:?}\", still::source_u(&[0.3])); }\n"
        }
        Language::Python => "import still\nprint(repr(float(still.source_u([0.3]))))\n",
        Language::Ufl => UFL,
        Language::Octave => "p = still();\nprintf('%.17g\\n', p.source_u(0.3));\n",
    }
}

/// UFL is not here: numbers take the place of its forms.
const UFL: &str = r#"
import math, sys, types
ufl = types.ModuleType("ufl")
for name in ["sin", "cos", "exp"]:
    setattr(ufl, name, getattr(math, name))
ufl.as_ufl = float
sys.modules["ufl"] = ufl
import still_ufl
print(repr(still_ufl.source_u([0.3])))
"#;

/// Without the variable the source is that of the file, with it that of the variant: the same in
/// all languages. Another name is refused, with those that there are.
#[test]
fn the_environment_chooses_a_variant_and_an_unknown_one_is_refused() {
    // u'' of exp(x) sin(2x), and of its value at 0.4 for all x.
    let x: f64 = 0.3;
    let file = -x.exp() * (4.0 * (2.0 * x).cos() - 3.0 * (2.0 * x).sin());
    let mut of_first: Option<Vec<f64>> = None;
    for language in languages() {
        let (module, names) = module(STILL, language);
        assert_eq!(names.join(" "), NAMES);
        let command = module.built(language, still_program(language));
        let values: Vec<f64> = std::iter::once("")
            .chain(NAMES.split(' '))
            .map(|variant| module.numbers(command, variant)[0])
            .collect();
        assert!((values[0] - file).abs() < 1e-13, "{language:?}: {values:?}");
        assert_eq!(values[1], 0.0, "{language:?}");
        let first = of_first.get_or_insert_with(|| values.clone());
        for (place, (value, first)) in values.iter().zip(first).enumerate() {
            assert!((value - *first).abs() < 1e-11, "{language:?}: {values:?}");
            let is_that_of_another = values[..place]
                .iter()
                .any(|other| (other - value).abs() < 1e-6);
            assert!(!is_that_of_another, "{language:?}: {values:?}");
        }
        let output = run(command, module.folder.path(), "flat_y_max");
        assert!(!output.status.success(), "{language:?}: {output:?}");
        let expected =
            format!("MANUFACTURE_VARIANT: unknown variant `flat_y_max`; expected one of {NAMES}");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains(&expected), "{language:?}: {message}");
        assert_eq!(String::from_utf8_lossy(&output.stdout), "", "{language:?}");
    }
}

/// Fortran's functions are pure, and cannot read the environment: without the call nothing is
/// computed, with the variable or without it.
#[test]
fn a_fortran_program_that_does_not_choose_ends_and_says_what_it_has_to_call() {
    foreign_tools::needs!(FORTRAN);
    let (module, _) = module(RICH, Language::Fortran);
    for (call, status) in [
        ("print '(es25.16)', source_u([0.3d0, 1.0d0], 0.5d0)", None),
        (
            "print '(es25.16)', normal_x_max([0.3d0, 1.0d0], 0.5d0)",
            None,
        ),
        (
            "print '(es25.16)', average_u([0.0d0, 0.5d0], [1.0d0, 1.0d0], 0.5d0)",
            None,
        ),
        ("call set_parameter('a', 1.0d0)", None),
        ("call choose_variant()", Some(0)),
    ] {
        let program =
            format!("program driver\nuse rich\nimplicit none\n{call}\nend program driver\n");
        let command = module.built(Language::Fortran, &program);
        for variant in ["", "zero_b"] {
            let output = run(command, module.folder.path(), variant);
            let message = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(
                output.status.code() == Some(0),
                status == Some(0),
                "{call}: {message}"
            );
            let is_named = message.contains("call_choose_variant_first");
            assert_eq!(is_named, status.is_none(), "{call}: {message}");
            assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "", "{call}");
        }
    }
}

/// A program that prints b, k, and both where b is set to 2.
fn parameters_program(language: Language) -> &'static str {
    match language {
        Language::C => {
            "#include <stdio.h>\n#include \"rich.h\"\nint main(void)\n{\n\
             printf(\"%.17g %.17g \", rich_get_parameter(\"b\"), rich_get_parameter(\"k\"));\n\
             rich_set_parameter(\"b\", 2.0);\n\
             printf(\"%.17g %.17g\\n\", rich_get_parameter(\"b\"), rich_get_parameter(\"k\"));\nreturn 0;\n}\n"
        }
        Language::Fortran => {
            "program driver\nuse rich\nimplicit none\ncall choose_variant()\n\
             print '(2es25.16)', parameter_b, parameter_k\ncall set_parameter('b', 2.0d0)\n\
             print '(2es25.16)', parameter_b, parameter_k\nend program driver\n"
        }
        Language::Rust => {
            "#[path = \"rich.rs\"]\nmod rich;\nfn main() {\n\
             let print = || println!(\"{:?} {:?}\", rich::get_parameter(\"b\").unwrap(), rich::get_parameter(\"k\").unwrap());\n\
             print();\nrich::set_parameter(\"b\", 2.0).unwrap();\nprint();\n}\n"
        }
        Language::Octave => {
            "p = rich();\nprintf('%.17g ', p.get_parameter('b'), p.get_parameter('k'));\n\
             p.set_parameter('b', 2);\nprintf('%.17g ', p.get_parameter('b'), p.get_parameter('k'));\n"
        }
        Language::Python => {
            "import rich\nprint(rich.parameter_b, rich.parameter_k)\nrich.set_parameter('b', 2.0)\n\
             print(rich.parameter_b, rich.parameter_k)\n"
        }
        Language::Ufl => {
            "import sys, types\nsys.modules['ufl'] = types.ModuleType('ufl')\nimport rich_ufl as rich\n\
             print(rich.parameter_b, rich.parameter_k)\nrich.set_parameter('b', 2.0)\n\
             print(rich.parameter_b, rich.parameter_k)\n"
        }
    }
}

/// A program that takes its parameters from the module has those of the variant; one that it sets
/// replaces that of the variant, and those that depend on it follow.
#[test]
fn a_program_reads_the_parameters_of_the_variant() {
    foreign_tools::needs!(C);
    for language in languages() {
        let (module, _) = module(RICH, language);
        let command = module.built(language, parameters_program(language));
        for (variant, expected) in [
            ("", [0.4, 1.2, 2.0, 2.0]),
            ("constant_x", [0.4, 1.2, 2.0, 2.0]),
            ("zero_b", [0.0, 1.0, 2.0, 2.0]),
        ] {
            let values = module.numbers(command, variant);
            assert_eq!(values, expected, "{language:?}: {variant}");
        }
    }
}

/// Initial data, normals, averages and errors follow the variant as well.
#[test]
fn functions_that_no_answering_program_calls_follow_the_variant() {
    foreign_tools::needs!(C);
    // No field is a polynomial, which would be zero where it is flat.
    let text = functions::FILE.replace("y + t\"", "y + exp(x*t)\"");
    let text = text.replace("y^2 + t\"", "y^2 + exp(x*t)\"");
    let mut of_first: Option<Vec<Vec<f64>>> = None;
    for language in languages().filter(|language| *language != Language::Ufl) {
        let mut program = functions::program(language).to_owned();
        if language == Language::Fortran {
            program = program.replace("    lo = 0\n", "    lo = 0\n    call choose_variant()\n");
        }
        let (module, names) = module(&text, language);
        let command = module.built(language, &program);
        let variants = ["", "constant_x", "flat_initial", "flat_x_max"];
        for variant in &variants[1..] {
            assert!(names.iter().any(|name| name == variant), "{names:?}");
        }
        let all = variants.map(|variant| module.numbers(command, variant));
        // The average of T; errors are of differences from the exact values, whatever these are.
        assert!((all[1][12] - all[0][12]).abs() > 0.05, "{language:?}");
        assert!(all[2][9].abs() < 1e-12 && all[0][9] > 1.0, "{language:?}");
        let first = of_first.get_or_insert_with(|| all.to_vec());
        for (values, first) in all.iter().zip(first.iter()) {
            assert_eq!([values.len(), first.len()], [functions::EXPECTED.len(); 2]);
            for (place, (value, first)) in values.iter().zip(first).enumerate() {
                let is_same = (value - first).abs() <= 1e-12 || (value.is_nan() && first.is_nan());
                let expected = functions::EXPECTED[place];
                let is_met = (value - expected).abs() <= 1e-12 || value.is_nan() || place < 15;
                assert!(is_same && is_met, "{language:?}: {values:?}");
            }
        }
    }
}

/// A project that builds with warnings as errors can take modules with variants as they are.
#[test]
fn modules_with_variants_compile_without_a_warning() {
    for text in [RICH, STILL, SOLID] {
        let manufacture = read(text).with_variants(&points(30)).unwrap();
        for (_, language) in Language::ALL {
            compiles_without_a_warning(language, manufacture.name(), manufacture.emit(language));
        }
    }
}
