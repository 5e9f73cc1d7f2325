//! Files of refusals: what is given, and the words of the message.
//!
//! A paragraph is a case. Its lines with `+` are what is given, those with `-` what that replaces;
//! the line with `>` is the message, with ` … ` between its pieces. A line with `#` names the kind
//! of the cases below it. Programs of tests that may not depend on this crate include this file.

/// A case of a file.
#[derive(Debug)]
pub struct Refusal<'t> {
    /// The kind of the case.
    pub kind: &'t str,
    /// What is replaced.
    pub old: String,
    /// What is given.
    pub new: String,
    /// The pieces of the message.
    pub words: &'t str,
}

/// The cases of a file.
///
/// # Panics
/// A case has no message, or several.
pub fn refusals(text: &str) -> Vec<Refusal<'_>> {
    let (mut kind, mut cases) = ("", vec![]);
    for paragraph in text.split("\n\n") {
        if let Some(name) = marked(paragraph, '#').first() {
            kind = name;
        }
        let [words] = marked(paragraph, '>')[..] else {
            panic!("expected one message, found\n{paragraph}");
        };
        let [old, new] = ['-', '+'].map(|mark| marked(paragraph, mark).join("\n"));
        cases.push(Refusal {
            kind,
            old,
            new,
            words,
        });
    }
    cases
}

/// The lines that begin with a mark, without it.
fn marked(paragraph: &str, mark: char) -> Vec<&str> {
    let lines = paragraph.lines().filter_map(|line| line.strip_prefix(mark));
    lines
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
        .collect()
}

/// Each case of a file is refused with its words.
///
/// * `refusal`: the message for a case.
#[track_caller]
pub fn each_is_refused(text: &str, refusal: impl Fn(&Refusal<'_>) -> String) {
    for case in refusals(text) {
        let message = refusal(&case);
        assert!(says(&message, case.words), "{case:?}:\n{message}");
    }
}

/// Whether a text has these pieces in this order; ` … ` separates them.
pub fn says<'a>(text: &'a str, pieces: &str) -> bool {
    let after = |rest: &'a str, piece| rest.split_once(piece).map(|(_, rest)| rest);
    pieces.split(" … ").try_fold(text, after).is_some()
}
