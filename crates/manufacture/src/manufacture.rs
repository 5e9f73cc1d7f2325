//! What the other crates and programs see of a file.

use std::path::Path;

use crate::against::Question;
use crate::check::{self, Check, Finding};
use crate::emit::{self, Alternative, EmittedFile, Language};
use crate::problem::{InputError, Problem};
use crate::variants::{self, Variants};
use crate::{at, model};

/// A file, read and derived.
#[derive(Debug)]
pub struct Manufacture {
    model: model::Model,
    variants: Option<Variants>,
}

/// How the points of a check are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    /// The same seed draws the same points.
    pub seed: u64,
    /// Points of each part of the domain.
    pub points: usize,
    /// Notes fail, too.
    pub is_strict: bool,
}

impl Default for Sampling {
    fn default() -> Self {
        Self {
            seed: 1,
            points: 1000,
            is_strict: false,
        }
    }
}

impl Manufacture {
    /// Reads a text; `file` is its name in messages.
    ///
    /// # Errors
    /// [`InputError`] with the place, what was found and what is expected.
    pub fn parse(text: &str, file: &str) -> Result<Self, InputError> {
        let problem = Problem::parse(text, file)?;
        Ok(Self {
            model: model::Model::new(problem)?,
            variants: None,
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let file = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|error| InputError::whole(&file, error.to_string()))?;
        Self::parse(&text, &file)
    }

    /// The name that everything emitted begins with.
    pub fn name(&self) -> &str {
        &self.model.problem.name
    }

    /// Checks everything at random points.
    ///
    /// # Errors
    /// A domain or a face without points.
    pub fn check(&self, sampling: &Sampling) -> Result<Check, InputError> {
        check::check(&self.model, sampling)
    }

    /// Whether a language can have a module of this name.
    ///
    /// # Errors
    /// A name that is a keyword, or that hides a module which the emitted one needs.
    pub fn accept(&self, language: Language) -> Result<(), InputError> {
        emit::accept(&self.model, language)
    }

    /// The file with other solutions, each of which switches off what a part of a program can get
    /// wrong, checked as the solution of the file is.
    ///
    /// # Errors
    /// A domain or a face without points.
    pub fn with_variants(self, sampling: &Sampling) -> Result<Self, InputError> {
        let variants = Some(variants::variants(&self.model, sampling)?);
        Ok(Self { variants, ..self })
    }

    /// The other solutions, of a file with them.
    pub fn variants(&self) -> Option<&Variants> {
        self.variants.as_ref()
    }

    fn alternatives(&self) -> Vec<Alternative<'_>> {
        let variants = self.variants.as_ref();
        variants.map(Variants::alternatives).unwrap_or_default()
    }

    /// The files of a language: the library, and the program that answers questions about points.
    ///
    /// The library has the solution and its gradients, definitions, terms, sources one by one and
    /// all together, data, averages, norms, and `set_parameter`, by which another value replaces
    /// that of the file. The domain, and the points of an integral, are those of the file.
    ///
    /// With variants the functions are those of the variant that the environment variable
    /// `MANUFACTURE_VARIANT` names; it is read once, and without it they are those of the file. In
    /// Fortran a program calls `choose_variant` first. In Python the module says what each variant
    /// switches off, too.
    pub fn emit(&self, language: Language) -> Vec<EmittedFile> {
        let mut files = emit::emit(&self.model, &self.alternatives(), language);
        if let (Language::Python, Some(variants)) = (language, &self.variants) {
            files[0].text += &variants.literal();
        }
        files
    }

    /// The study file, if the file has `[study]`.
    pub fn study(&self) -> Option<EmittedFile> {
        emit::study(&self.model)
    }

    /// Builds and runs the files of a language in a folder, which is for temporary files, and
    /// compares their values, and those of each variant.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn check_emitted(
        &self,
        language: Language,
        folder: &Path,
        sampling: &Sampling,
    ) -> Result<Vec<Finding>, InputError> {
        check::emitted::emitted(
            &self.model,
            &self.alternatives(),
            language,
            folder,
            sampling,
        )
    }

    /// Builds and runs the files of a language that are in a folder already, and compares their
    /// values.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn check_built(
        &self,
        language: Language,
        folder: &Path,
        sampling: &Sampling,
    ) -> Result<Vec<Finding>, InputError> {
        check::emitted::run(
            &self.model,
            &self.alternatives(),
            language,
            folder,
            sampling,
        )
    }

    /// Values at the points of a table with a header: coordinates, time, and optionally `face`.
    ///
    /// # Errors
    /// A table that cannot be used, with the line.
    pub fn at(&self, table: &str, file: &str) -> Result<serde_json::Value, InputError> {
        at::values(&self.model, table, file)
    }

    /// The points at which another program is to compute the sources, or the data of a face: the
    /// caller runs it on their text, and has its answer compared.
    ///
    /// # Errors
    /// An unknown face.
    pub fn question(
        &self,
        face: Option<&str>,
        sampling: &Sampling,
    ) -> Result<Question<'_>, InputError> {
        Question::new(&self.model, face, sampling)
    }
}
