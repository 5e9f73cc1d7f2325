//! Text of unknown origin made safe to show: terminals obey control characters, and CI systems obey
//! lines.

use std::path::Path;

/// Whether a character controls a terminal, or shows nothing and may turn the text behind it round:
/// the marks of the direction of writing, and blanks without width.
pub fn is_hidden(c: char) -> bool {
    let is_mark = matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}');
    c.is_control() || is_mark
}

/// Text on one line: every [hidden](is_hidden) character, line ends included, is replaced by
/// U+FFFD.
pub fn visible(text: &str) -> String {
    text.chars()
        .map(|c| {
            if is_hidden(c) {
                char::REPLACEMENT_CHARACTER
            } else {
                c
            }
        })
        .collect()
}

/// A path for messages, [`visible`].
pub fn path(path: &Path) -> String {
    visible(&path.display().to_string())
}

/// Text of several lines without [hidden](is_hidden) characters other than line ends and tabs.
pub fn lines(text: &str) -> String {
    text.chars()
        .map(|c| {
            if is_hidden(c) && c != '\n' && c != '\t' {
                char::REPLACEMENT_CHARACTER
            } else {
                c
            }
        })
        .collect()
}

/// Text without lines that are commands to GitHub Actions, which obeys lines of a log that begin
/// with `::`.
pub fn without_commands(text: &str) -> String {
    if !text.contains("::") || !text.split(['\n', '\r']).any(is_command) {
        return text.to_owned();
    }
    let mut safe = String::with_capacity(text.len());
    for line in text.split_inclusive(['\n', '\r']) {
        if is_command(line) {
            safe += &line.replacen("::", ": :", 1);
        } else {
            safe += line;
        }
    }
    safe
}

/// Whether GitHub Actions takes a line for a command.
fn is_command(line: &str) -> bool {
    line.trim_start().starts_with("::")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_replaced() {
        assert_eq!(
            visible("a\x1b[31m\nb\u{9b}é"),
            "a\u{fffd}[31m\u{fffd}b\u{fffd}é"
        );
        assert_eq!(path(Path::new("a\r/b\x07")), "a\u{fffd}/b\u{fffd}");
        assert_eq!(lines("a\n\tb\x1bc\r"), "a\n\tb\u{fffd}c\u{fffd}");
    }

    #[test]
    fn no_line_is_a_command() {
        assert_eq!(
            without_commands("a::b\n::error::c\n  ::d::\r::e"),
            "a::b\n: :error::c\n  : :d::\r: :e"
        );
        assert_eq!(without_commands("plain\ntext\n"), "plain\ntext\n");
    }
}
