//! The text between two numbers: a name, and words that stand for a number.

use std::collections::HashSet;

use super::{LEVELS, LONGEST_LABEL, is_mark};
use crate::input::error_table::names::{self, Word};
use crate::input::error_table::number::{is_dash, number};

/// A number, or what stands for one.
pub(super) struct Value<'t> {
    /// The text between it and the number before.
    pub(super) before: &'t str,
    pub(super) word: &'t str,
}

/// The text between two numbers, with a word that may be the second.
pub(super) struct Gap<'t> {
    /// It ends with the word.
    pub(super) text: &'t str,
    pub(super) behind: &'t str,
    /// Whether the number before stands in a list that has not ended.
    pub(super) is_in_list: bool,
}

impl<'t> Gap<'t> {
    /// The value at the end of the gap, if it is one: a number, or the words of a level without a
    /// result, in a list or behind a name.
    ///
    /// * `start`: of the last word.
    pub(super) fn value(&self, start: usize, known: &HashSet<&str>) -> Option<Value<'t>> {
        let (before, word) = self.text.split_at(start);
        let behind = self.behind.trim_start_matches("(ind)");
        let behind = behind.trim_start_matches([' ', '\t', '"', '\'']);
        let is_last = behind.is_empty() || behind.starts_with(['\n', ',', ';', '}', ')', ']']);
        let begins = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        if (begins || is_last) && number(word, false).is_some() {
            return Some(Value { before, word });
        }
        if !is_last {
            return None;
        }
        // `did not converge` stands for a number, as `diverged` does.
        let words = phrase(self.text);
        let start = self.text.len() - words.len();
        if words.contains(' ') && names::is_failure(words) && start > 0 {
            let (before, word) = self.text.split_at(start);
            return Some(Value { before, word });
        }
        let is_in_list = self.is_in_list && !before.contains(']');
        let is_element = before.contains(',')
            && before
                .chars()
                .all(|c| c.is_whitespace() || ",\"'".contains(c));
        let is_state = names::state(word).is_some();
        let stands_for_number = is_dash(word) || names::is_failure(word);
        // After a name that has a number elsewhere, any word means that the number is missing.
        let is_missing = is_in_list && (is_element || stands_for_number || is_state)
            || ends_with_mark(before)
                && (stands_for_number || may_be_missing(before, is_state, known));
        is_missing.then_some(Value { before, word })
    }

    /// The name of a list that begins with a word: `"T": ["lost", "lost"]`.
    pub(super) fn name_of_list(&self, start: usize) -> Option<&'t str> {
        let before = &self.text[..start];
        let marks = &before[before.trim_end_matches(is_mark).len()..];
        let name = (marks.contains('[') && ends_with_mark(before)).then(|| name_before(before))?;
        name.contains(char::is_alphabetic).then_some(name)
    }

    /// The name before the only word behind it: `T = lost`.
    pub(super) fn name_of_word(&self, start: usize) -> Option<&'t str> {
        let (before, word) = self.text.split_at(start);
        let behind = self.behind.trim_start_matches([' ', '"', '\'']);
        let is_last = behind.is_empty() || behind.starts_with(['\n', ',', ';', '}']);
        let is_word = is_last && ends_with_mark(before) && names::state(word) != Some(true);
        let name = is_word.then(|| name_before(before))?;
        name.contains(char::is_alphabetic).then_some(name)
    }
}

/// Whether a text ends with `=` or `:`, perhaps before brackets and quotes.
pub(super) fn ends_with_mark(text: &str) -> bool {
    text.trim_end_matches(|c| is_mark(c) && !":=".contains(c))
        .ends_with([':', '='])
}

/// Whether a word stands behind a name that has a number elsewhere, or says that a level was solved,
/// or was not, behind a name that promises this.
fn may_be_missing(before: &str, is_state: bool, known: &HashSet<&str>) -> bool {
    let name = name_before(before);
    known.contains(name) || is_state && Word::of(name) == Word::State
}

/// The last words of a text behind a mark of a value: `did not converge`. The search is bounded, as
/// that for a name is.
fn phrase(text: &str) -> &str {
    let tail = end(text);
    let mark = tail.rfind([':', '=', ',', '[', '{', ';']);
    tail[mark.map_or(0, |mark| mark + 1)..].trim_start_matches(is_mark)
}

/// The last bytes of a text in which a name is looked for: a text may have a hundred thousand words
/// before its next number.
fn end(text: &str) -> &str {
    let mut start = text.len().saturating_sub(LONGEST_LABEL);
    while !text.is_char_boundary(start) {
        start += 1;
    }
    &text[start..]
}

/// The name that a text ends with, before marks.
pub(super) fn name_before(text: &str) -> &str {
    let words = end(text.trim_end_matches(is_mark));
    let words = words.rsplit('\n').next().unwrap_or_default();
    // `Level(h=0.1, error=2e-3)`, but not `error (L2) = 2e-3`.
    let separators: &[char] = if words.contains(')') {
        &[',', ';', '{', '\t']
    } else {
        &[',', ';', '{', '\t', '(']
    };
    let name = words.rsplit(separators).next().unwrap_or_default();
    let name = name
        .trim_matches(is_mark)
        .trim_start_matches(['-', '>', ' ']);
    let name = name
        .rsplit([':', ']'])
        .next()
        .unwrap_or_default()
        .trim_matches(is_mark);
    LEVELS
        .iter()
        .find_map(|level| name.strip_prefix(level))
        .unwrap_or(name)
        .trim_start()
}
