//! The languages: a row for each.

mod operators;
mod taken;

use std::path::Path;

use crate::language::names::name_in;
use operators::Operators;
pub(super) use taken::Taken;

/// A language that functions are emitted in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// C99, which C++ reads, too.
    C,
    /// Fortran 2008.
    Fortran,
    /// Python with NumPy.
    Python,
    /// The form language of FEniCSx and Firedrake.
    Ufl,
    /// Octave and MATLAB.
    Octave,
    /// Rust.
    Rust,
}

/// What the code knows of a language; all else is in its templates.
pub(crate) struct Row {
    pub(super) operators: Operators,
    /// The library first.
    pub(super) templates: &'static [Template],
    /// Whether names of functions and parameters begin with that of the module.
    pub(super) has_prefix: bool,
    pub(super) ignores_case: bool,
    /// Whether the module's name must differ from those of its functions.
    pub(super) has_one_space: bool,
    /// Whether both branches of a choice are evaluated at all points of an array.
    pub(super) has_arrays: bool,
    pub(super) taken: &'static [Taken],
    /// What builds and runs its files here; none where values are not compared.
    pub(crate) tools: Option<Tools>,
}

/// A file of a module.
pub(super) struct Template {
    /// Behind the module's name.
    pub(super) ending: &'static str,
    pub(super) text: &'static str,
}

/// Programs that build and run the emitted files: words with blanks between them, where `IN/` is
/// the folder and `NAME` the module's name.
pub(crate) struct Tools {
    /// It succeeds if they are there.
    pub(crate) probe: &'static str,
    pub(crate) missing: &'static str,
    pub(crate) build: Option<&'static str>,
    pub(crate) answering: Answering,
}

/// What runs the answering program here.
#[derive(Clone, Copy)]
pub(crate) enum Answering {
    /// A command that is started for each question.
    OneByOne(&'static str),
    /// Where starting costs more than answering: an interpreter with a text, which answers all
    /// questions by the answering program.
    Together {
        interpreter: &'static str,
        text: &'static str,
    },
}

impl Language {
    /// The languages by name.
    pub const ALL: [(&'static str, Language); 6] = [
        ("c", Language::C),
        ("fortran", Language::Fortran),
        ("python", Language::Python),
        ("ufl", Language::Ufl),
        ("octave", Language::Octave),
        ("rust", Language::Rust),
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        name_in(&Self::ALL, &self)
    }

    pub(crate) fn row(self) -> &'static Row {
        match self {
            Language::C => &C,
            Language::Fortran => &FORTRAN,
            Language::Python => &PYTHON,
            Language::Ufl => &UFL,
            Language::Octave => &OCTAVE,
            Language::Rust => &RUST,
        }
    }

    /// A name with `_` behind it where the language cannot tell it from one of the others: Fortran
    /// does not tell capitals from small letters.
    pub(super) fn distinct<'n>(
        self,
        mut name: String,
        others: impl Iterator<Item = &'n String> + Clone,
    ) -> String {
        while others.clone().any(|other| self.is_same(other, &name)) {
            name.push('_');
        }
        name
    }

    /// Whether the language takes two names for one.
    pub(super) fn is_same(self, one: &str, other: &str) -> bool {
        one == other || (self.row().ignores_case && one.eq_ignore_ascii_case(other))
    }

    /// A number with the digits that read back exactly.
    pub(super) fn number(self, value: f64) -> String {
        // NaN and infinity are findings of the check; here they are divisions.
        if value.is_nan() {
            return "(0.0/0.0)".to_owned();
        }
        if value.is_infinite() {
            return "(1.0/0.0)".to_owned();
        }
        let digits = if value == 0.0 || (1e-5..1e16).contains(&value.abs()) {
            format!("{value:?}")
        } else {
            format!("{value:e}")
        };
        digits + self.row().operators.suffix
    }

    /// The words of a command of its tools, for a module in a folder.
    pub(crate) fn command(self, words: &str, name: &str, folder: &Path) -> Vec<String> {
        let folder = folder.join("").display().to_string();
        let words = words.split(' ');
        words
            .map(|word| word.replace("NAME", name).replace("IN/", &folder))
            .collect()
    }
}

macro_rules! templates {
    ($($ending:literal: $file:literal),*) => {
        &[$(Template { ending: $ending, text: include_str!(concat!("../templates/", $file)) }),*]
    };
}

const C: Row = Row {
    operators: operators::C,
    templates: templates!(".c": "c.j2", ".h": "header.j2", "_answer.c": "c_answer.j2"),
    has_prefix: true,
    ignores_case: false,
    has_one_space: false,
    has_arrays: false,
    taken: &taken::C,
    tools: Some(Tools {
        probe: "cc --version",
        missing: "C compiler",
        build: Some("cc -std=c99 -O2 -o IN/NAME_answer_c IN/NAME.c IN/NAME_answer.c -lm"),
        answering: Answering::OneByOne("IN/NAME_answer_c"),
    }),
};

const FORTRAN: Row = Row {
    operators: operators::FORTRAN,
    templates: templates!(".f90": "fortran.j2", "_answer.f90": "fortran_answer.j2"),
    has_prefix: false,
    ignores_case: true,
    has_one_space: true,
    taken: &taken::FORTRAN,
    tools: Some(Tools {
        probe: "gfortran --version",
        missing: "gfortran",
        build: Some(
            "gfortran -std=f2008 -O2 -J IN/ -o IN/NAME_answer_fortran IN/NAME.f90 IN/NAME_answer.f90",
        ),
        answering: Answering::OneByOne("IN/NAME_answer_fortran"),
    }),
    ..C
};

const PYTHON: Row = Row {
    operators: operators::PYTHON,
    templates: templates!(".py": "python.j2", "_answer.py": "python_answer.j2"),
    has_prefix: false,
    has_arrays: true,
    taken: &taken::PYTHON,
    tools: Some(Tools {
        probe: "python3 -c __import__('numpy')",
        missing: "Python with NumPy",
        build: None,
        answering: Answering::Together {
            interpreter: "python3 -B -c",
            text: include_str!("../templates/together.py"),
        },
    }),
    ..C
};

const UFL: Row = Row {
    operators: operators::UFL,
    templates: templates!("_ufl.py": "ufl.j2"),
    has_prefix: false,
    // Its module is NAME_ufl.
    taken: &[],
    tools: None,
    ..C
};

const OCTAVE: Row = Row {
    operators: operators::OCTAVE,
    templates: templates!(".m": "octave.j2", "_answer.m": "octave_answer.j2"),
    has_prefix: false,
    taken: &taken::OCTAVE,
    tools: Some(Tools {
        probe: "octave --version",
        missing: "Octave",
        build: None,
        answering: Answering::OneByOne("octave --quiet --no-history --path IN/ IN/NAME_answer.m"),
    }),
    ..C
};

const RUST: Row = Row {
    operators: operators::RUST,
    templates: templates!(".rs": "rust.j2", "_answer.rs": "rust_answer.j2"),
    has_prefix: false,
    taken: &taken::RUST,
    tools: Some(Tools {
        probe: "rustc --version",
        missing: "rustc",
        build: Some("rustc --edition 2021 -O -o IN/NAME_answer_rust IN/NAME_answer.rs"),
        answering: Answering::OneByOne("IN/NAME_answer_rust"),
    }),
    ..C
};
