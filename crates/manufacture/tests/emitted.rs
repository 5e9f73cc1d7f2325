//! Emitted files: built, run and compared; and what a person reads in them.

use crate::prelude::*;

const PLANE: &str = include_str!("files/plane.toml");

/// The findings about the files of a language, which is not found missing silently.
fn findings(text: &str, language: Language) -> Vec<Finding> {
    let folder = tempfile::tempdir().unwrap();
    read(text)
        .check_emitted(language, folder.path(), &points(60))
        .unwrap()
}

#[test]
fn emitted_files_agree_in_each_language_that_is_here() {
    // UFL has no values here.
    for language in languages().filter(|language| *language != Language::Ufl) {
        for text in [HEAT, BEAM, SOLID, PIECES] {
            assert_eq!(findings(text, language), [], "{language:?}");
        }
    }
}

#[track_caller]
fn is_narrow(EmittedFile { name, text }: &EmittedFile) {
    for line in text.lines() {
        assert!(line.len() <= 100, "{name}: {line}");
    }
}

#[test]
fn lines_have_at_most_100_columns_and_no_file_has_a_date() {
    for text in [HEAT, BEAM, SOLID, PIECES] {
        for (_, language) in Language::ALL {
            for file in read(text).emit(language) {
                is_narrow(&file);
                let has_none = !file.text.contains('@') || language == Language::Octave;
                assert!(has_none, "{}", file.name);
            }
            assert_eq!(read(text).emit(language), read(text).emit(language));
        }
    }
}

/// The check answers all questions in one process; a user starts the program for each.
#[test]
fn the_answering_program_in_python_is_a_command() {
    foreign_tools::needs!(NUMPY);
    let manufacture = read(HEAT);
    let module = Module::new("heat", manufacture.emit(Language::Python));
    let program = module.folder.path().join("heat_answer.py");
    let mut command = Command::new("python3");
    command.arg("-B").arg(program);
    let comparisons = answered(&manufacture, &mut command, None, &points(60));
    for comparison in comparisons.unwrap() {
        assert_eq!(comparison.cause, "equal", "{comparison:?}");
    }
}

/// Fortran does not tell capitals from small letters: names get a trailing `_`, and the first
/// comment lists them.
#[test]
fn names_that_fortran_cannot_tell_apart_are_listed() {
    let text = plane(
        "u = \"a*sin(x)\"\nU = \"A*cos(y)\"",
        "",
        "u = \"u + d(U, y)\"\nU = \"U\"",
    );
    let text = text.replace("[exact]", "[parameters]\na = 2\nA = 3\n[exact]");
    let fortran = library(&text, Language::Fortran);
    let comment: String = fortran
        .lines()
        .take_while(|line| line.starts_with('!'))
        .map(|line| line.trim_start_matches("! "))
        .collect::<Vec<_>>()
        .join(" ");
    for name in ["exact_u_", "gradient_u_", "source_u_", "parameter_a_"] {
        assert!(comment.contains(name), "{name}: {comment}");
    }
    none_fails(&findings(&text, Language::Fortran));
    let python = library(&text, Language::Python);
    assert!(!python.contains("Written with _ behind"));
}

/// Each definition, each term and all sources together are functions of their own, which add up.
#[test]
fn definitions_terms_and_joint_sources_are_emitted() {
    foreign_tools::needs!(C);
    let text = plane(
        "u = \"sin(x)*exp(y)\"",
        "k = \"1 + u^2\"\nq = \"-k*grad(u)\"",
        "heat = \"div(q) + 3*u\"\n[equations.other]\nloss = \"k*u\"\ngain = \"-x*y\"",
    );
    let python = library(&text, Language::Python);
    for name in [
        "define_k",
        "define_q",
        "term_heat_1",
        "term_heat_2",
        "term_other_loss",
        "term_other_gain",
        "sources",
    ] {
        assert!(
            python.contains(&format!("def {name}(x):")),
            "{name}: {python}"
        );
    }
    let fortran = library(&text, Language::Fortran);
    assert!(fortran.contains("pure function sources(x) result(out)"));
    // One equation needs no joint function.
    assert!(!library(HEAT, Language::C).contains("heat_sources"));
    assert!(findings(&text, Language::C).is_empty());
}

/// The check compares each function that an answering program has: a slip in one is found in it.
#[test]
fn a_slip_in_each_emitted_function_is_found() {
    foreign_tools::needs!(C);
    let text = plane(
        "u = \"sin(x)*exp(y)\"",
        "k = \"1 + u^2\"",
        "heat = \"-div(k*grad(u))\"\n[equations.other]\nloss = \"k*u\"\ngain = \"-x*y\"",
    );
    let text = text + "[boundary.x_max]\nflux = \"dot(grad(u), n)\"\n";
    let manufacture = read(&text);
    let files = manufacture.emit(Language::C);
    for (function, component) in [
        ("exact_u", "exact_u"),
        ("gradient_u", "gradient_u_x"),
        ("define_k", "define_k"),
        ("term_other_loss", "term_other_loss"),
        ("source_heat", "heat"),
        ("sources", "sources_x"),
        ("boundary_x_max_flux", "flux"),
    ] {
        let mut files = files.clone();
        for EmittedFile { text, .. } in &mut files {
            *text = slipped(text, &format!("test_{function}("));
        }
        let findings = built(&manufacture, files);
        let first = findings.first().map(|finding| finding.text.as_str());
        let start = format!("{component} differs by ");
        assert!(
            first.is_some_and(|text| text.starts_with(&start)),
            "{function}: {findings:#?}"
        );
    }
}

/// The findings about these files in C.
fn built(manufacture: &Manufacture, files: Vec<EmittedFile>) -> Vec<Finding> {
    let folder = Module::new("test", files).folder;
    let findings = manufacture.check_built(Language::C, folder.path(), &points(60));
    findings.unwrap()
}

/// The first value of a function a thousandth larger.
fn slipped(text: &str, function: &str) -> String {
    let Some(start) = text.find(function) else {
        return text.to_owned();
    };
    let (before, body) = text.split_at(start);
    let mut body = body.to_owned();
    let of_function = body.find("\n}\n").unwrap_or(0);
    let mut values = ["return ", "out[0] = "].into_iter();
    let found = values.find_map(|value| Some(body[..of_function].find(value)? + value.len()));
    if let Some(from) = found {
        let to = from + body[from..].find(';').unwrap();
        body.insert(to, ')');
        body.insert_str(from, "1.001*(");
    }
    format!("{before}{body}")
}

/// A command that compiles the files of a language in a folder at its strictest.
fn strict(language: Language) -> &'static str {
    match language {
        Language::C => "cc -std=c99 -pedantic -Wall -Wextra -Werror -c NAME.c NAME_answer.c",
        Language::Fortran => {
            "gfortran -std=f2008 -Wall -Wextra -Werror -c NAME.f90 NAME_answer.f90"
        }
        Language::Python => "python3 -B -W error NAME.py",
        Language::Rust => "rustc --edition 2021 -D warnings --emit metadata NAME_answer.rs",
        Language::Octave => "octave --quiet --no-history --eval NAME();",
        // FEniCS is not here: the file is compiled alone.
        Language::Ufl => "python3 -B -W error -m py_compile NAME_ufl.py",
    }
}

/// Each emitted file compiles without a warning where its compiler is: a project that builds with
/// warnings as errors can take the files as they are.
#[test]
fn emitted_files_compile_without_a_warning() {
    let files = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/files")).unwrap();
    let mut texts = vec![BEAM.to_owned()];
    for file in files {
        texts.push(std::fs::read_to_string(file.unwrap().path()).unwrap());
    }
    assert!(texts.len() > 10, "{}", texts.len());
    for text in &texts {
        let manufacture = read(text);
        for (_, language) in Language::ALL {
            compiles_without_a_warning(language, manufacture.name(), manufacture.emit(language));
        }
    }
}

/// * `name`: of the module.
#[track_caller]
pub(crate) fn compiles_without_a_warning(language: Language, name: &str, files: Vec<EmittedFile>) {
    if foreign_tools::are_here(tools(language)) {
        Module::new(name, files).prints(strict(language));
    }
}

/// A parameter is set at run time, and those that depend on it follow: the check runs each program
/// once more, with other parameters. One that does not follow is found.
#[test]
fn a_parameter_that_does_not_follow_is_found() {
    foreign_tools::needs!(C, LINKER);
    let text = plane("u = \"sin(k*x)*exp(y)\"", "", "a = \"laplacian(u) + L*u\"");
    let text = text.replace(
        "[exact]",
        "[parameters]\nL = 1.5\nk = \"pi/L + m\"\nm = \"2*L\"\n[exact]",
    );
    for language in [Language::C, Language::Rust] {
        assert_eq!(findings(&text, language), [], "{language:?}");
    }
    let mut files = read(&text).emit(Language::C);
    // In the branch of L the last statement, by which k follows, is lost.
    let library = &mut files[0].text;
    let branch = library.find("strcmp(name, \"L\")").unwrap();
    let start = branch + library[branch..].find("test_parameter_k = ").unwrap();
    let end = start + library[start..].find('\n').unwrap();
    library.replace_range(start..end, "(void)0;");
    let findings = built(&read(&text), files);
    let words = "a differs with other parameters by";
    assert!(
        findings
            .iter()
            .any(|finding| finding.text.starts_with(words)),
        "{findings:#?}"
    );
}

/// An integrand that is a sum, or that begins with a sign, is weighted as a whole.
#[test]
fn an_integrand_is_weighted_as_a_whole() {
    foreign_tools::needs!(C, LINKER);
    let text = plane(
        "u = \"exp(x)*y\"",
        "",
        "a = \"u + integral(x + y, x)\"\nb = \"u*integral(-x/3, x)\"",
    );
    for language in [
        Language::C,
        Language::Fortran,
        Language::Python,
        Language::Rust,
    ] {
        none_fails(&findings(&text, language));
    }
}

/// Over arrays each branch of a choice is evaluated only where it is taken: elsewhere it may have
/// no value, about which NumPy warns.
#[test]
fn python_evaluates_each_branch_where_it_is_taken() {
    foreign_tools::needs!(NUMPY);
    let text = plane(
        "u = \"where(abs(x - 0.5) > 0.05, sin(x - 0.5)/(x - 0.5), 1) + where(y < 0.6, sqrt(0.7 - y), y)\"",
        "",
        "a = \"u + d(u, x) + integral(where(y > 0.5, ln(x), x), x)\"",
    );
    let module = Module::new("test", read(&text).emit(Language::Python));
    let program = "import numpy, test\n\
        x = numpy.array([[0.5, 0.5, 0.2, 0.9, 0.0], [0.9, 0.1, 0.5, 0.31, 0.2]])\n\
        for points in x, x.reshape(2, 5, 1), x[:, 0]:\n    \
        values = test.source_a(points)\n    \
        assert values.shape == points.shape[1:] and numpy.all(numpy.isfinite(values))\n";
    module.built(Language::Python, program);
    module.prints("python3 -B -W error driver.py");
    // A branch that has a value everywhere stays in its line.
    let chooses = |text| library(text, Language::Python).contains("choose(");
    assert!(chooses(&text) && !chooses(HEAT));
    assert!(findings(&text, Language::Python).is_empty());
}

/// What variants have in common is there once: their number changes the fields alone.
#[test]
fn a_module_with_variants_has_each_source_once() {
    let manufacture = read(HEAT).with_variants(&points(60)).unwrap();
    assert!(manufacture.variants().unwrap().usable.len() > 6);
    for (language, function) in [
        (
            Language::C,
            "double heat_source_heat(const double x[], double t)\n{",
        ),
        (Language::Python, "def source_heat(x, t):"),
        (
            Language::Fortran,
            "pure function source_heat(x, t) result(out)",
        ),
    ] {
        let library = &manufacture.emit(language)[0].text;
        let (_, source) = library.split_once(function).unwrap();
        let end = source
            .find("source_heat")
            .or(source.find("\n\n\n"))
            .or(source.find("\n}\n"));
        let source = &source[..end.unwrap()];
        for choice in ["switch", "_NUMBER", "select case"] {
            assert!(!source.contains(choice), "{language:?}: {source}");
        }
        assert!(source.contains("field_T_x_x("), "{source}");
    }
}

/// What a variant has in common with the solution of the file stands once in each function.
#[test]
fn a_module_with_sixteen_variants_is_small() {
    let manufacture = read(PLANE).with_variants(&points(60)).unwrap();
    assert_eq!(manufacture.variants().unwrap().usable.len(), 16);
    let files = |language: Language| manufacture.emit(language);
    let lines = files(Language::C)
        .iter()
        .map(|file| file.text.lines().count())
        .sum::<usize>();
    let bytes = files(Language::Python)
        .iter()
        .map(|file| file.text.len())
        .sum::<usize>();
    assert!(
        lines <= 1500 && bytes <= 60_000,
        "{lines} lines of C, {bytes} bytes of Python"
    );
    for (_, language) in Language::ALL {
        files(language).iter().for_each(is_narrow);
    }
}
