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

#[cfg(test)]
mod tests {
    use super::section;

    #[test]
    fn a_paragraph_is_broken_before_its_lines_have_more_than_100_characters() {
        let mut text = "above".to_owned();
        section(&mut text, "Title", &"word\n".repeat(40));
        let [full, rest] = [19, 2].map(|count| " word".repeat(count));
        let expected = format!("above\nTitle\n {full}\n {full}\n {rest}\n");
        assert_eq!(text, expected);
    }
}
