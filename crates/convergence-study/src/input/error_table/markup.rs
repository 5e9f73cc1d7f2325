//! Tables in HTML, lists as tables, columns of LaTeX that span others, and quoted mail, as plain
//! rows of cells.

/// A text without the marks of quoted mail; a line of its own for each row of HTML and of a list.
pub(super) fn plain(text: &str) -> String {
    let text: String = text.split_inclusive('\n').map(unquoted).collect();
    let text = with_spans(&list_tables(&text));
    let lower = text.to_ascii_lowercase();
    if lower.contains("<tr") && (lower.contains("<td") || lower.contains("<th")) {
        html(&text)
    } else {
        text
    }
}

/// A line without `> ` in front.
fn unquoted(line: &str) -> &str {
    let mut rest = line;
    while let Some(inner) = rest
        .strip_prefix('>')
        .filter(|inner| inner.starts_with([' ', '>', '\n']))
    {
        rest = inner.strip_prefix(' ').unwrap_or(inner);
    }
    rest
}

/// The list tables of reStructuredText as rows between bars, each in its first line: a row begins
/// with `* -`, its other cells with `-`.
fn list_tables(text: &str) -> String {
    if !text.contains(".. list-table::") {
        return text.to_owned();
    }
    let mut plain = String::new();
    let mut row: Vec<&str> = vec![];
    for line in text.lines().chain([""]) {
        let words = line.trim();
        let first = words.strip_prefix("* -");
        let next = words.strip_prefix('-').filter(|_| !row.is_empty());
        if next.is_none() && !row.is_empty() {
            plain += &format!("| {} |{}", row.join(" | "), "\n".repeat(row.len()));
            row.clear();
        }
        match first.or(next) {
            Some(cell) => row.push(cell.trim()),
            // `:widths: 20,40`.
            None if words.starts_with(':') => plain.push('\n'),
            None => plain = plain + line + "\n",
        }
    }
    plain
}

/// `\multicolumn{3}{|c|}{name}` as a cell with this name, and two without; `\multirow{2}{*}{name}`
/// as one with it.
fn with_spans(text: &str) -> String {
    let text = with_span(text, "\\multirow", 1);
    with_span(&text, "\\multicolumn", WIDEST)
}

/// No table has so many columns.
const WIDEST: usize = 100;

/// * `widest`: the most columns of such a cell.
fn with_span(text: &str, command: &str, widest: usize) -> String {
    let mut parts = text.split(command);
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let groups = Group::first(part).and_then(|columns| {
            let format = Group::first(columns.behind)?;
            Some((columns.inside, Group::first(format.behind)?))
        });
        match groups {
            Some((columns, name)) => {
                let columns: usize = columns.trim().parse().unwrap_or(1);
                plain += name.inside;
                plain += &" & ".repeat(columns.clamp(1, widest) - 1);
                plain += name.behind;
            }
            None => plain = plain + command + part,
        }
    }
    plain
}

/// What stands in braces, and what behind them.
struct Group<'t> {
    inside: &'t str,
    behind: &'t str,
}

impl<'t> Group<'t> {
    /// The group that a text begins with; braces in it are matched.
    fn first(text: &'t str) -> Option<Self> {
        let inner = text.strip_prefix('{')?;
        let mut depth = 1;
        for (k, c) in inner.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                return Some(Self {
                    inside: &inner[..k],
                    behind: &inner[k + 1..],
                });
            }
        }
        None
    }
}

/// The rows of HTML with bars between their cells, each in the line in which it begins.
fn html(text: &str) -> String {
    let mut plain = String::new();
    let mut row: Option<Vec<String>> = None;
    // Lines within a row, which follow it.
    let mut lines = 0;
    let mut parts = text.split('<');
    plain += parts.next().unwrap_or_default();
    for part in parts {
        let (tag, words) = part.split_once('>').unwrap_or((part, ""));
        let name: String = tag
            .chars()
            .take_while(|c| c.is_alphanumeric() || *c == '/')
            .collect();
        match name.to_ascii_lowercase().as_str() {
            "tr" => row = Some(vec![]),
            "td" | "th" => {
                let span = attribute(tag, "colspan").unwrap_or(1);
                let cells = row.get_or_insert_default();
                cells.push(String::new());
                cells.extend((1..span).map(|_| String::new()));
                add(cells, span, words);
            }
            "/tr" => {
                if let Some(cells) = row.take().filter(|cells| !cells.is_empty()) {
                    plain += &format!("| {} |", cells.join(" | "));
                }
                plain += &"\n".repeat(std::mem::take(&mut lines));
                plain += words;
                continue;
            }
            "/td" | "/th" => {}
            _ => match &mut row {
                Some(cells) => add(cells, 1, words),
                None => plain += words,
            },
        }
        if row.is_some() {
            lines += part.matches('\n').count();
        }
    }
    plain
}

/// Adds words to a cell of a row.
///
/// * `span`: how many columns the last cell has.
fn add(cells: &mut [String], span: usize, words: &str) {
    let Some(cell) = cells.len().checked_sub(span).and_then(|k| cells.get_mut(k)) else {
        return;
    };
    let words = entities(words);
    let words: Vec<&str> = words.split_whitespace().collect();
    if !cell.is_empty() && !words.is_empty() {
        cell.push(' ');
    }
    *cell += &words.join(" ").replace("\\|", "|").replace('|', "\\|");
}

/// A text with the characters that HTML names.
fn entities(text: &str) -> String {
    const ENTITIES: [(&str, &str); 9] = [
        ("&nbsp;", " "),
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&minus;", "-"),
        ("&ndash;", "-"),
        ("&mdash;", "-"),
        ("&times;", "×"),
        ("&amp;", "&"),
    ];
    let mut text = text.to_owned();
    for (name, character) in ENTITIES {
        text = text.replace(name, character);
    }
    text
}

/// The number of an attribute of a tag, at most 100.
fn attribute(tag: &str, name: &str) -> Option<usize> {
    const MOST: usize = 100;
    let (_, value) = tag.split_once(name)?;
    let value = value.trim_start().strip_prefix('=')?;
    let value = value.trim_start_matches([' ', '"', '\'']);
    let digits = value
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(value.len());
    Some(value[..digits].parse::<usize>().ok()?.clamp(1, MOST))
}
