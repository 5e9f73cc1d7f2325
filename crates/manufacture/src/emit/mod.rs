//! Functions in the user's language.

mod answer;
mod choice;
mod dialect;
mod functions;
mod languages;
mod lower;
mod parameters;
mod reserved;
mod runtime;
mod study;
mod texts;
mod write;
mod writer;

use std::path::Path;

use crate::language::names::name_in;
use crate::model::Model;
use crate::problem::InputError;

pub(crate) use answer::OTHERS;
pub(crate) use functions::{EmittedFunction, functions, others};
pub(crate) use texts::Answering;
pub(crate) use writer::Alternative;

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

    /// The words of a command of its tools, for a file in a folder.
    pub(crate) fn command(self, words: &str, name: &str, folder: &Path) -> Vec<String> {
        let folder = folder.join("").display().to_string();
        let values = [("IN", folder.as_str()), ("NAME", name)];
        words.split(' ').map(|word| fill(word, &values)).collect()
    }
}

/// A file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EmittedFile {
    /// Its name, without a folder.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// The files of a model in a language, whose functions are those of the alternative that the
/// environment variable `MANUFACTURE_VARIANT` names.
pub(crate) fn emit(
    model: &Model,
    alternatives: &[Alternative<'_>],
    language: Language,
) -> Vec<EmittedFile> {
    let functions = functions(model, language);
    let mut files = write::library(model, alternatives, language, &functions);
    let has_alternatives = !alternatives.is_empty();
    files.extend(answer::program(
        model,
        has_alternatives,
        language,
        &functions,
    ));
    files
}

/// Refuses a model whose name a language cannot have.
pub(crate) fn accept(model: &Model, language: Language) -> Result<(), InputError> {
    reserved::refuse(model, language, &functions(model, language))
}

/// The study file, if the file has `[study]`.
pub(crate) fn study(model: &Model) -> Option<EmittedFile> {
    study::study(model)
}

/// A text with `@KEY@` replaced.
fn fill(template: &str, values: &[(&str, &str)]) -> String {
    let replace =
        |text: String, (key, value): &(&str, &str)| text.replace(&format!("@{key}@"), value);
    values.iter().fold(template.to_owned(), replace)
}
