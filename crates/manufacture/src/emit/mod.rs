//! Functions in the user's language: a module as plain data, printed by the templates of the
//! language.

mod functions;
mod languages;
mod lower;
mod module;
mod parameters;
mod study;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior, Value};

use crate::model::Model;
use crate::problem::InputError;

pub(crate) use functions::{answered_together, functions};
pub(crate) use languages::Answering;
pub use languages::Language;
use module::Module;
pub(crate) use study::study;

/// A file to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EmittedFile {
    /// Its name, without a folder.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// What stands between the name and the version in the first comment of a module.
const MADE_BY: &str = ", by manufacture ";

impl EmittedFile {
    /// How a module begins, whatever its input and the version that has written it.
    pub fn beginning(&self) -> String {
        let own = self.text.split(MADE_BY).next().unwrap_or_default();
        own.split_inclusive('\n').take(5).collect()
    }
}

/// A model whose functions take the place of those of another where its name is chosen.
#[derive(Debug, Clone)]
pub(crate) struct Alternative<'m> {
    pub(crate) name: String,
    pub(crate) model: &'m Model,
}

/// Templates that others include.
const SHARED: [(&str, &str); 2] = [
    ("python_setter", include_str!("templates/python_setter.j2")),
    (
        "python_variants",
        include_str!("templates/python_variants.j2"),
    ),
];

/// Columns of a line of the first comment.
const WIDTH: usize = 100;

/// The files of a model in a language, whose functions are those of the alternative that the
/// environment variable `MANUFACTURE_VARIANT` names.
pub(crate) fn emit(
    model: &Model,
    alternatives: &[Alternative<'_>],
    language: Language,
) -> Vec<EmittedFile> {
    if alternatives.is_empty() {
        return printed(&Module::new(model, &[], language), language);
    }
    // Expressions in the fields are those of all models.
    let kept: Result<Vec<Model>, InputError> = std::iter::once(model)
        .chain(alternatives.iter().map(|alternative| alternative.model))
        .map(Model::keeping_fields)
        .collect();
    let Ok(kept) = kept else {
        return printed(&Module::new(model, alternatives, language), language);
    };
    let names = alternatives.iter().map(|alternative| &alternative.name);
    let models = names.zip(&kept[1..]).map(|(name, model)| Alternative {
        name: name.clone(),
        model,
    });
    let models: Vec<Alternative<'_>> = models.collect();
    printed(&Module::new(&kept[0], &models, language), language)
}

fn printed(module: &Module<'_>, language: Language) -> Vec<EmittedFile> {
    let environment = environment();
    let values = Value::from(Serde(module));
    let templates = language.row().templates.iter();
    templates
        .map(|template| EmittedFile {
            name: format!("{}{}", module.name, template.ending),
            // The templates are part of the program.
            text: environment
                .render_str(template.text, values.clone())
                .unwrap_or_else(|error| panic!("{}: {error:#}", template.ending)),
        })
        .collect()
}

/// Lines of tags alone leave no trace.
fn environment() -> Environment<'static> {
    let mut environment = Environment::new();
    let syntax = SyntaxConfig::builder()
        .trim_blocks(true)
        .lstrip_blocks(true)
        .keep_trailing_newline(true)
        .build();
    environment.set_syntax(syntax.unwrap_or_default());
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_filter("comment", comment);
    for (name, text) in SHARED {
        environment
            .add_template(name, text)
            .unwrap_or_else(|error| panic!("{name}: {error:#}"));
    }
    environment
}

/// Lines as a comment, cut at blanks.
fn comment(lines: Vec<String>, sign: &str) -> String {
    let parts = lines.iter().flat_map(|line| {
        let cut = cut(line, WIDTH - 8).into_iter().enumerate();
        cut.map(move |(number, part)| match number {
            0 => format!("{sign} {part}"),
            _ => format!("{sign}     {part}"),
        })
    });
    parts.collect::<Vec<_>>().join("\n")
}

/// A text as lines that are cut at blanks, of so many characters at most if the words allow it.
fn cut(text: &str, longest: usize) -> Vec<String> {
    let mut lines: Vec<String> = vec![];
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= longest => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Refuses the name of a model that a language cannot use for a module.
pub(crate) fn accept(model: &Model, language: Language) -> Result<(), InputError> {
    let name = &model.problem.name;
    let row = language.row();
    let is_same = |word: &str| language.is_same(word, name);
    let mut groups = row.taken.iter();
    let group = groups.find(|group| group.names.split_whitespace().any(is_same));
    let mut functions = functions(model, language).into_iter();
    let is_function = row.has_one_space && functions.any(|function| is_same(&function.name));
    let by = match group {
        Some(group) => group.by,
        None if is_function => "a function of the emitted module",
        None => return Ok(()),
    };
    let words = format!(
        "found the name `{name}`, which {} cannot have: it is {by}; expected another name",
        language.name()
    );
    Err(model.problem.name_place.error(words))
}
