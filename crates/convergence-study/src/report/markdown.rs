//! Text set in Markdown without changing its meaning.

use crate::text::columns::Columns;

/// Text that reads the same: no character of it is taken for markup, except for code in backticks.
pub(super) fn text(raw: &str) -> String {
    escape(raw, false)
}

/// Text for a cell of a table.
pub(super) fn cell(raw: &str) -> String {
    escape(raw, true)
}

fn escape(raw: &str, in_table: bool) -> String {
    // Unpaired backticks are not code.
    let has_code = raw.matches('`').count().is_multiple_of(2);
    let mut in_code = false;
    let mut escaped = String::with_capacity(raw.len());
    let mut rest = raw.chars().peekable();
    let mut before = ' ';
    while let Some(c) = rest.next() {
        let c = if c.is_control() { ' ' } else { c };
        // Within a word it is not markup.
        let is_within =
            before.is_alphanumeric() && rest.peek().is_some_and(|next| next.is_alphanumeric());
        let is_markup = matches!(c, '\\' | '*' | '`' | '[' | ']') || (c == '_' && !is_within);
        before = c;
        let opens_a_tag = c == '<'
            && rest
                .peek()
                .is_some_and(|next| next.is_alphabetic() || "/!?".contains(*next));
        if c == '`' && has_code {
            in_code = !in_code;
        } else if (c == '|' && in_table) || (!in_code && (opens_a_tag || is_markup)) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

/// The anchor of a heading: small letters, digits, `-` and `_`; a space becomes a `-`.
pub(super) fn anchor(heading: &str) -> String {
    let kept = heading
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_' | ' '));
    kept.flat_map(char::to_lowercase)
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// A table whose columns line up in the source too. The cells are already escaped.
pub(super) fn table<H: AsRef<str>>(head: &[H], rows: Vec<Vec<String>>) -> String {
    let head: Vec<String> = head.iter().map(|title| title.as_ref().to_owned()).collect();
    let columns = Columns::of(&head, &rows);
    let mut lines = line(columns.pad(&head));
    lines += &line((0..columns.count()).map(|i| rule(columns.width(i), columns.is_numeric(i))));
    for row in &rows {
        lines += &line(columns.pad(row));
    }
    lines
}

fn line(cells: impl Iterator<Item = String>) -> String {
    cells.fold(String::from("|"), |line, cell| line + " " + &cell + " |") + "\n"
}

fn rule(width: usize, numeric: bool) -> String {
    if numeric {
        format!("{:->1$}", ":", width.max(2))
    } else {
        "-".repeat(width.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_a_text_is_escaped() {
        for (raw, written) in [
            ("a | b", "a \\| b"),
            ("`a|b` < c", "`a\\|b` < c"),
            ("1<2, a<b, </i>", "1<2, a\\<b, \\</i>"),
            ("3*t and 2*t", "3\\*t and 2\\*t"),
            ("`3*t`", "`3*t`"),
            ("one ` only *", "one \\` only \\*"),
            ("back\\slash|", "back\\\\slash\\|"),
            ("two\nlines", "two lines"),
            ("[a](b) ![c]", "\\[a\\](b) !\\[c\\]"),
            ("u_t, _x_ and __y", "u_t, \\_x\\_ and \\_\\_y"),
            ("`a[0]_`", "`a[0]_`"),
        ] {
            assert_eq!(cell(raw), written, "{raw}");
        }
        assert_eq!(text("|x|"), "|x|");
    }

    #[test]
    fn anchors_are_those_of_the_web_page() {
        assert_eq!(anchor("heat-2.1-space"), "heat-21-space");
        assert_eq!(anchor("Moved from the baseline"), "moved-from-the-baseline");
    }

    #[test]
    fn columns_line_up_and_numbers_stand_to_the_right() {
        let rows = [["8", "θ"], ["128", "long"]]
            .map(|row| row.map(str::to_owned).to_vec())
            .to_vec();
        let expected = "|   n | norm |\n| --: | ---- |\n|   8 | θ    |\n| 128 | long |\n";
        assert_eq!(table(&["n", "norm"], rows), expected);
    }

    #[test]
    fn a_row_of_another_length_leaves_the_table_well_formed() {
        let text = table(
            &["a", "b"],
            vec![
                vec!["1".into()],
                vec!["1".into(), "2".into(), "3".into()],
                vec![],
            ],
        );
        assert!(
            text.lines().all(|line| line.matches('|').count() == 3),
            "{text}"
        );
    }
}
