//! Paragraphs under a title, for a terminal.

use std::fmt::Write;

/// A title, and a paragraph with lines of at most 100 characters.
pub fn section(text: &mut String, title: &str, paragraph: &str) {
    const WIDTH: usize = 100;
    let _ = write!(text, "\n{title}\n ");
    let mut column = 1;
    for word in paragraph.split_whitespace() {
        if column + 1 + word.chars().count() > WIDTH {
            text.push_str("\n ");
            column = 1;
        }
        let _ = write!(text, " {word}");
        column += 1 + word.chars().count();
    }
    text.push('\n');
}
