//! The row of each language.

mod c;
mod fortran;
mod octave;
mod python;
mod rust;
mod ufl;

use super::Language;
use super::texts::Texts;

impl Language {
    pub(crate) fn texts(self) -> &'static Texts {
        match self {
            Language::C => &c::C,
            Language::Fortran => &fortran::FORTRAN,
            Language::Python => &python::PYTHON,
            Language::Ufl => &ufl::UFL,
            Language::Octave => &octave::OCTAVE,
            Language::Rust => &rust::RUST,
        }
    }
}
