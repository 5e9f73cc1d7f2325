//! Names that a file cannot have in a language: its keywords, and what its modules hide.

use super::Language;
use super::functions::EmittedFunction;
use crate::model::Model;
use crate::problem::InputError;

/// Refuses the name of a file that a language cannot use for a module.
pub(super) fn refuse(
    model: &Model,
    language: Language,
    functions: &[EmittedFunction],
) -> Result<(), InputError> {
    let problem = &model.problem;
    let name = &problem.name;
    let names = &language.texts().names;
    let is_same = |word: &str| language.is_same(word, name);
    let mut groups = names.taken.iter();
    let group = groups.find(|group| group.names.split_whitespace().any(is_same));
    let is_function = names.has_one_space && functions.iter().any(|f| is_same(&f.name));
    let by = match group {
        Some(group) => group.by,
        None if is_function => "a function of the emitted module",
        None => return Ok(()),
    };
    let words = format!(
        "found the name `{name}`, which {} cannot have: it is {by}; expected another name",
        language.name()
    );
    Err(problem.name_place.error(words))
}
