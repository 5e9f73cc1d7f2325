//! The files that `new program` writes: a study, and a program in a language; or a study of a
//! command of the user.

use super::command::filled;
use super::launch::CaseParameter;
use crate::project::Template;

/// A language of `new program`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Language {
    /// As on the command line.
    pub name: &'static str,
    /// What follows the user's name in the name of the program's file.
    ending: &'static str,
    program: &'static str,
    /// The command that runs it, as the study file lists it.
    command: &'static str,
}

/// All languages, that of [`super::TEMPLATE`] first.
pub(crate) const LANGUAGES: [Language; 8] = [
    Language {
        name: "python",
        ending: ".py",
        program: include_str!("begin/program.py"),
        command: PYTHON,
    },
    Language {
        name: "octave",
        ending: ".m",
        program: include_str!("begin/program.m"),
        command: r#"["octave-cli", "--no-history", "BELOWNAME.m", "{n}"]"#,
    },
    Language {
        name: "fortran",
        ending: ".f90",
        program: include_str!("begin/program.f90"),
        command: r#"["sh", "-c", 'd=$(mktemp -d) || exit; gfortran -O2 -o "$d/solver" "$0" && "$d/solver" "$1"; s=$?; rm -r "$d"; exit $s', "BELOWNAME.f90", "{n}"]"#,
    },
    Language {
        name: "c++",
        ending: ".cpp",
        program: include_str!("begin/program.cpp"),
        command: r#"["sh", "-c", 'd=$(mktemp -d) || exit; c++ -O2 -o "$d/solver" "$0" && "$d/solver" "$1"; s=$?; rm -r "$d"; exit $s', "BELOWNAME.cpp", "{n}"]"#,
    },
    Language {
        name: "freefem",
        ending: ".edp",
        program: include_str!("begin/program.edp"),
        command: r#"["FreeFem++", "-nw", "-v", "0", "BELOWNAME.edp", "{n}"]"#,
    },
    Language {
        name: "openfoam",
        ending: ".py",
        program: include_str!("begin/openfoam.py"),
        command: PYTHON,
    },
    Language {
        name: "julia",
        ending: ".jl",
        program: include_str!("begin/program.jl"),
        command: r#"["julia", "BELOWNAME.jl", "{n}"]"#,
    },
    Language {
        name: "shell",
        ending: ".sh",
        program: include_str!("begin/program.sh"),
        command: r#"["sh", "BELOWNAME.sh", "{n}"]"#,
    },
];

/// The command of the study in `begin/study.toml`.
const PYTHON: &str = r#"["python3", "BELOWNAME.py", "{n}"]"#;

const STUDY: &str = include_str!("begin/study.toml");

/// A file to write: what follows the user's name in its name, and its text, in which the words of
/// [`Template::files`](crate::project::Template::files) stand for others.
#[derive(Debug, Clone)]
pub(crate) struct Begun {
    /// Such as `.toml`.
    pub ending: &'static str,
    /// The text.
    pub text: String,
}

/// The files of a template.
pub(crate) fn of_template(template: &Template) -> Vec<Begun> {
    let files = template.files.iter();
    files
        .map(|(ending, text)| Begun {
            ending,
            text: (*text).to_owned(),
        })
        .collect()
}

/// The study of a program in this language, and the program.
pub(crate) fn in_language(language: &Language) -> Vec<Begun> {
    let study = STUDY
        .replace(PYTHON, language.command)
        .replace("NAME.py", &format!("NAME{}", language.ending));
    vec![
        Begun {
            ending: ".toml",
            text: study,
        },
        Begun {
            ending: language.ending,
            text: language.program.to_owned(),
        },
    ]
}

/// The study of a command, such as `FreeFem++ -nw poisson.edp {n}`, in its words.
///
/// # Errors
/// A placeholder that the study gives no value, in words.
pub(crate) fn of_command(words: Vec<String>) -> Result<Vec<Begun>, String> {
    const VALUES: [CaseParameter; 3] = [("n", 8.0), ("h", 0.125), ("level", 0.0)];
    for word in &words {
        filled(word, &VALUES).map_err(|unfilled| unfilled.reason)?;
    }
    // A list of texts has the same form in JSON and in TOML.
    let list = serde_json::Value::from(words).to_string();
    Ok(vec![Begun {
        ending: ".toml",
        text: include_str!("begin/command.toml").replace("COMMAND", &list),
    }])
}
