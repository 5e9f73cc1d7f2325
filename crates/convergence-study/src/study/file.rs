//! Studies described by files: the kinds that a project knows, what a kind reads, and the table
//! `[study]` of every file.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::erased::{Described, Study};
use super::header::{DEFAULT_KIND, Header, KIND, NAME, Tier, is_kind, is_name};
use super::kind::Kind;
use crate::input::{
    self, AllowedText, Choices, Document, InputError, Number, OneOf, Range, Refusal, Texts, schema,
};
use crate::text::names::nearest;
use crate::text::visible;

/// Reads a study of one kind from the document of its file.
pub(crate) type Reader = fn(Header, &Document<'_>, &Path) -> Result<Box<dyn Study>, InputError>;

impl Document<'_> {
    /// What a study file describes: its tables beside `[study]` as a struct, and what is made of
    /// it.
    pub fn described<F: DeserializeOwned + JsonSchema, T>(
        &self,
        build: impl FnOnce(F) -> Result<T, Refusal>,
    ) -> Result<T, InputError> {
        let file = self.read_keys(|key| key != STUDY)?;
        build(file).map_err(|refusal| self.locate(refusal))
    }
}

/// A kind of study: its name, its reader, and what it means in words.
#[derive(Debug, Clone, Copy)]
pub struct KindRow {
    /// The value of `[study] kind`. Kinds that differ in the source of their numbers alone have the
    /// same word before a `/`: `orders/vibration`.
    pub name: &'static str,
    /// The JSON schema of its files beside `[study]`: that of [`FromFile::File`].
    pub schema: fn() -> Value,
    /// Its reader.
    pub read: Reader,
    /// Why the claim should hold.
    pub why: &'static str,
    /// How it is judged.
    pub judged: &'static str,
    /// What a failure would mean.
    pub failure: &'static str,
}

impl KindRow {
    /// Reads a study file of any of these kinds.
    ///
    /// # Errors
    /// [`InputError`] with file, line, field, the value found and the values allowed.
    pub fn read_any(kinds: &[Self], path: &Path) -> Result<Box<dyn Study>, InputError> {
        Self::parse_any(kinds, &Document::text_of_file(path)?, path)
    }

    /// The same of a text; messages name `path`, and other files are searched for next to it.
    ///
    /// # Errors
    /// As [`KindRow::read_any`].
    pub fn parse_any(
        kinds: &[Self],
        text: &str,
        path: &Path,
    ) -> Result<Box<dyn Study>, InputError> {
        Ok(StudyFile::parse_after(&[], kinds, text, path)?.study)
    }

    /// The first kind whose numbers come from this source, which is named without the kind:
    /// `vibration` for `orders/vibration`.
    pub fn with_source<'k>(kinds: &'k [Self], source: &str) -> Option<&'k Self> {
        kinds.iter().find(|row| {
            let parts = row.name.split_once('/');
            parts.is_some_and(|(_, own)| own == source)
        })
    }
}

/// A study file, read once.
pub(crate) struct StudyFile {
    /// The file.
    pub path: PathBuf,
    /// The study.
    pub study: Box<dyn Study>,
}

impl StudyFile {
    /// Reads study files; ids must be unique.
    ///
    /// # Errors
    /// As [`KindRow::read_any`], and if two studies have the same id.
    pub(crate) fn read_all(kinds: &[KindRow], paths: &[PathBuf]) -> Result<Vec<Self>, InputError> {
        let mut files: Vec<Self> = Vec::with_capacity(paths.len());
        for path in paths {
            let text = Document::text_of_file(path)?;
            files.push(Self::parse_after(&files, kinds, &text, path)?);
        }
        Ok(files)
    }

    /// Reads a study file whose id none of the `earlier` ones has.
    fn parse_after(
        earlier: &[Self],
        kinds: &[KindRow],
        text: &str,
        path: &Path,
    ) -> Result<Self, InputError> {
        let study = input::parse_beside(text, path, |root, folder| {
            let header = Header::from_document(root)?;
            let mut earlier = earlier.iter();
            if let Some(earlier) = earlier.find(|earlier| earlier.study.header().id == header.id) {
                let found = format!(
                    "\"{}\", which {} has too",
                    header.id,
                    visible::path(&earlier.path)
                );
                let allowed = "an id that no other study has";
                return Err(root.locate(Refusal::new("study.id", found, allowed)));
            }
            let row = row(kinds, root, &header)?;
            (row.read)(header, root, folder)
        })?;
        Ok(Self {
            path: path.to_owned(),
            study,
        })
    }
}

fn row<'k>(
    kinds: &'k [KindRow],
    root: &Document<'_>,
    header: &Header,
) -> Result<&'k KindRow, InputError> {
    if let Some(row) = kinds.iter().find(|row| row.name == header.kind) {
        return Ok(row);
    }
    let names: Vec<String> = kinds
        .iter()
        .map(|row| format!("\"{}\"", row.name))
        .collect();
    const KIND: &str = "study.kind";
    // A file without kind has the default kind, which not every project knows.
    if !header.settings.iter().any(|(path, _)| path == KIND) {
        return Err(root.locate(Refusal::missing(KIND, &names.join(", "))));
    }
    let source = KindRow::with_source(kinds, &header.kind);
    let expected = source.map_or_else(|| names.join(", "), |row| format!("\"{}\"", row.name));
    let similar = nearest(&header.kind, kinds.iter().map(|row| row.name));
    let hint = similar.filter(|_| source.is_none());
    let hint = hint.map(|name| format!(" (did you mean \"{name}\"?)"));
    let found = format!("\"{}\"{}", header.kind, hint.unwrap_or_default());
    Err(root.locate(Refusal::new(KIND, found, expected)))
}

/// A kind of study that a file describes.
///
/// ```
/// use std::path::Path;
///
/// use convergence_study::file::{Count, Refusal, schema};
/// use convergence_study::{Case, CaseFailure, Claim, FromFile, Header, InputError, Kind, Order};
/// use convergence_study::{Check, KindRow, Outcome, Ran};
/// use schemars::JsonSchema;
/// use serde::Deserialize;
///
/// /// Sums of `terms` terms.
/// #[derive(Debug)]
/// struct Sums {
///     terms: usize,
///     claim: Claim,
/// }
///
/// /// The file, beside its table `[study]`.
/// #[derive(Deserialize, JsonSchema)]
/// #[serde(deny_unknown_fields)]
/// struct SumsFile {
///     /// the sum
///     sum: SumTable,
/// }
///
/// #[derive(Deserialize, JsonSchema)]
/// #[serde(deny_unknown_fields)]
/// struct SumTable {
///     /// how many terms
///     terms: Count<1, 100>,
///     /// the expected order
///     order: Order,
/// }
///
/// impl FromFile for Sums {
///     type File = SumsFile;
///
///     fn from_file(SumsFile { sum }: SumsFile, _: &Header, _: &Path) -> Result<Self, Refusal> {
///         let claim = sum.order.claim(None, None).map_err(Refusal::within("sum"))?;
///         Ok(Self { terms: sum.terms.get(), claim })
///     }
/// }
///
/// // How a project lists the kind, for its files and their reference page.
/// const ROW: KindRow = KindRow {
///     name: "sums",
///     schema: schema::<SumsFile>,
///     read: Sums::read_study,
///     why: "The series converges.",
///     judged: "Every sum must be finite.",
///     failure: "The sum is wrong.",
/// };
///
/// let text = r#"
/// study = { id = "s", claim = "c", tier = "quick", kind = "sums" }
/// sum = { terms = 8, order = 2 }
/// "#;
/// let sums = Sums::parse(text, Path::new("s.toml"))?;
/// assert_eq!((sums.terms, sums.claim.order), (8, 2.0));
///
/// let error = Sums::parse(&text.replace('8', "0"), Path::new("s.toml")).unwrap_err();
/// assert!(error.to_string().starts_with("s.toml:3:"), "{error}");
///
/// impl Kind for Sums {
///     type Data = usize;
///     type Found = f64;
///
///     fn cases(&self) -> Vec<Case<usize>> {
///         vec![Case::new("sum", 1.0, self.terms)]
///     }
///
///     fn run(&self, terms: &usize) -> Result<f64, CaseFailure> {
///         Ok((0..*terms).map(|k| 0.5_f64.powi(k as i32)).sum())
///     }
///
///     fn judge(&self, ran: &[Ran<usize, f64>]) -> Outcome {
///         Outcome::new("", vec![], vec![Check::completion(ran, |_| vec![])])
///     }
/// }
/// # let _ = ROW;
/// # Ok::<(), InputError>(())
/// ```
pub trait FromFile: Kind + Sized {
    /// The tables of its files beside `[study]`.
    type File: DeserializeOwned + JsonSchema;

    /// The study that a file describes.
    ///
    /// * `header`: the table `[study]`.
    /// * `folder`: the folder of the file; names of other files are relative to it.
    ///
    /// # Errors
    /// Values that do not go together.
    fn from_file(file: Self::File, header: &Header, folder: &Path) -> Result<Self, Refusal>;

    /// The TOML files that a file names and that say what is computed, relative to its folder:
    /// their values are settings of the study as its own are.
    fn named_files(_file: &Self::File) -> Vec<&str> {
        vec![]
    }

    /// The reader of a kind, for its [`KindRow`].
    ///
    /// # Errors
    /// As [`FromFile::parse`].
    fn read_study(
        header: Header,
        root: &Document<'_>,
        folder: &Path,
    ) -> Result<Box<dyn Study>, InputError>
    where
        Self: 'static,
    {
        let Described { header, kind } = Described::<Self>::of(header, root, folder)?;
        Ok(Described::boxed(header, kind))
    }

    /// Reads a study from `text`; messages name `file`, and other files are searched for next to
    /// it.
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        Ok(Described::parse(text, file)?.kind)
    }

    /// Reads a study file.
    ///
    /// # Errors
    /// As [`FromFile::parse`], and if the file cannot be read.
    fn read(file: impl AsRef<Path>) -> Result<Self, InputError> {
        Ok(Described::read(file)?.kind)
    }
}

impl<K: FromFile> Described<K> {
    /// As [`FromFile::parse`], with the header.
    pub fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, |root, folder| {
            Self::of(Header::from_document(root)?, root, folder)
        })
    }

    /// What a document describes beside its table `[study]`.
    fn of(mut header: Header, root: &Document<'_>, folder: &Path) -> Result<Self, InputError> {
        let mut named = vec![];
        let kind = root.described(|file| {
            named.extend(K::named_files(&file).into_iter().map(str::to_owned));
            K::from_file(file, &header, folder)
        })?;
        for name in named {
            let path = folder.join(&name);
            let text = Document::text_of_file(&path)?;
            let settings = input::parse_beside(&text, &path, |root, _| Ok(root.settings()))?;
            let settings = settings.into_iter();
            let settings = settings.map(|(path, value)| (format!("{name}: {path}"), value));
            header.settings.extend(settings);
        }
        Ok(Self { header, kind })
    }

    /// As [`FromFile::read`], with the header.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, InputError> {
        let file = file.as_ref();
        Self::parse(&Document::text_of_file(file)?, file)
    }
}

/// The table that every study file has.
pub(crate) const STUDY: &str = "study";

/// What every study file has.
#[derive(Debug, Deserialize, JsonSchema)]
struct StudyOfFile {
    study: StudyTable,
}

/// The table `[study]`: what a study is about.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StudyTable {
    /// its name, which no other study has
    id: AllowedText<Names>,
    /// the claim
    claim: AllowedText<Lines>,
    /// "full": only when everything is verified
    tier: OneOf<Tiers>,
    /// which kind of study it is, on which the other tables depend; without it
    /// "orders/manufactured", if the project has that kind
    kind: Option<AllowedText<Kinds>>,
    /// under which reports list it; without it the kind
    group: Option<AllowedText<Lines>>,
    /// the relative change that the baseline tolerates of its numbers, if their own tolerance is
    /// less: for programs that scatter; without it 1e-6 for errors, 1e-4 for rates
    guard: Option<Number<Guard>>,
}

/// The schema of the table `[study]`.
pub(crate) fn study_schema() -> Value {
    schema::of::<StudyTable>()
}

#[derive(Debug, Clone)]
enum Names {}

impl Texts for Names {
    const ALLOWED: &'static str = NAME;

    fn has(text: &str) -> bool {
        is_name(text)
    }
}

#[derive(Debug, Clone)]
enum Kinds {}

impl Texts for Kinds {
    const ALLOWED: &'static str = KIND;

    fn has(text: &str) -> bool {
        is_kind(text)
    }
}

/// One line of text: it is printed to terminals and logs.
#[derive(Debug, Clone)]
pub(crate) enum Lines {}

impl Texts for Lines {
    const ALLOWED: &'static str = "one line of text without control characters";

    fn has(text: &str) -> bool {
        !text.trim().is_empty() && !text.contains(char::is_control)
    }
}

#[derive(Debug)]
enum Tiers {}

impl Choices for Tiers {
    type Value = Tier;

    fn all() -> Vec<(&'static str, Tier)> {
        Tier::ALL.map(|tier| (tier.name(), tier)).to_vec()
    }
}

/// A looser guard hides what it should show; a tighter one than that of errors changes nothing.
#[derive(Debug, Clone, Copy)]
enum Guard {}

impl Range for Guard {
    const ENDS: &'static [(&'static str, f64)] = &[("minimum", 1e-6), ("maximum", 0.1)];
}

impl Header {
    /// Reads `[study]` of a document, and records every value of the document.
    pub fn from_document(root: &Document<'_>) -> Result<Self, InputError> {
        if !root.has(STUDY) {
            let refusal = match root.key_like(STUDY) {
                Some(misspelt) => Refusal::unknown(misspelt, &[STUDY]),
                None => Refusal::missing(STUDY, "a table with id, claim and tier"),
            };
            return Err(root.locate(refusal));
        }
        let StudyOfFile { study: table } = root.read_keys(|key| key == STUDY)?;
        let kind = table.kind.map_or(DEFAULT_KIND.to_owned(), AllowedText::get);
        Ok(Self {
            id: table.id.get(),
            claim: table.claim.get(),
            tier: table.tier.value,
            group: table.group.map_or(kind.clone(), AllowedText::get),
            kind,
            guard: table.guard.map(Number::get),
            settings: root.settings(),
            home: None,
            cases: vec![],
        })
    }
}
