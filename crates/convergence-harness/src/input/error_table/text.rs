//! Any text as rows of cells below names.

use super::forms::joined;
use super::names::Word;
use super::number::{is_dash, number};
use super::pairs::{self, RawTable};

/// Characters with simpler equivalents. Spreadsheets write a byte order mark; the first Macintosh
/// ended lines with \r.
const MARKS: [(&str, &str); 9] = [
    ("\u{feff}", ""),
    ("\r\n", "\n"),
    ("\r", "\n"),
    ("│", "|"),
    ("┃", "|"),
    ("┆", "|"),
    ("║", "|"),
    ("array(", "("),
    ("\\hline", "      "),
];
/// Types of columns and units, as data frames write them below the names.
const TYPES: [&str; 8] = [
    "double", "f64", "i64", "float64", "int64", "float", "int", "str",
];

/// A row that is filled has at least one cell in this many columns.
const FULL: usize = 4;

/// A text without colours, and a line for each of nested lists without names.
pub(super) fn plain(text: &str) -> String {
    let marked = MARKS
        .iter()
        .fold(text.to_owned(), |text, (from, to)| text.replace(from, to));
    let marked = joined(&marked);
    let mut parts = marked.split("\x1b[");
    let first = parts.next().unwrap_or_default().to_owned();
    // A colour ends after its first letter, a number of NumPy with its parenthesis.
    let text = parts.fold(first, |text, part| {
        text + part
            .split_once(char::is_alphabetic)
            .map_or("", |(_, rest)| rest)
    });
    let mut parts = text.split("np.float64(");
    let first = parts.next().unwrap_or_default().to_owned();
    let text = parts.fold(first, |text, part| text + &part.replacen(')', "", 1));
    let line = |line: &str| match line.find("\\\\").filter(|_| line.contains('&')) {
        // A row of LaTeX has an end; Jira writes `||h||L2||` above `|0.1|1.6e-3|`.
        Some(end) => line[..end].to_owned() + "\n",
        None if line.ends_with("||") => line.replace("||", "|") + "\n",
        None => line.to_owned() + "\n",
    };
    let text: String = text.lines().map(line).collect();
    let is_list = |marks: &[char]| {
        text.trim_start().starts_with(marks) && !text.contains(['"', '\'', '=', '\\'])
    };
    if is_list(&['{']) {
        // `{0.1: 1.6e-3, 0.05: 4e-4}`.
        text.replace([',', '{', '}'], "\n").replace(':', " ")
    } else if is_list(&['[', '(']) && !text.contains('{') {
        text.replace(['[', '(', ',', '\n'], " ")
            .replace([']', ')'], "\n")
    } else {
        text
    }
}

/// Finds the table in a text that has been made [`plain`]: names with numbers after them, or rows
/// below names.
pub(super) fn read(text: &str) -> RawTable<'_> {
    if let Some(table) = pairs::read(text, true) {
        return table;
    }
    let Lines {
        mut heads,
        mut rows,
        quoted_names,
        separator,
    } = sorted(text);
    // A comment has the names only if no other line does.
    heads.sort_by_key(|line| !is_comment(line));
    heads
        .iter_mut()
        .for_each(|line| *line = line.trim_start_matches(['#', '%', '!']));
    if rows.is_empty() {
        return pairs::read(text, false).unwrap_or_default();
    }
    if separator.is_none() {
        fill(&mut rows);
    }
    let rows: Vec<Vec<&str>> = rows.into_iter().map(|(_, cells)| cells).collect();
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    let table = RawTable {
        decimal_comma: separator != Some(','),
        ..RawTable::default()
    };
    let quoted_names = quoted_names.and_then(|names| match width.checked_sub(names.len())? {
        0 => Some(names),
        // R writes no name above the names of rows.
        1 => Some([&[&text[..0]], names.as_slice()].concat()),
        _ => None,
    });
    match quoted_names
        .or_else(|| numbered(&heads, width))
        .or_else(|| names(&heads, &rows, separator, width))
    {
        None if is_turned(&rows) => turned(&rows, width, table),
        names => {
            // If the number of words is not that of the columns, it says how many columns there
            // should be.
            let words = heads
                .iter()
                .map(|head| split(head, separator).len())
                .rfind(|words| *words > 1);
            let names = names.unwrap_or_else(|| vec![&text[..0]; words.unwrap_or(width)]);
            RawTable {
                names,
                rows,
                ..table
            }
        }
    }
}

/// A table whose rows are the columns of `rows`, each with its name in front, if it has one.
fn turned<'t>(rows: &[Vec<&'t str>], width: usize, table: RawTable<'t>) -> RawTable<'t> {
    let named = usize::from(number(rows[0][0], true).is_none());
    let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<_>>();
    let names = if named == 1 {
        column(0)
    } else {
        vec![&rows[0][0][..0]; rows.len()]
    };
    RawTable {
        names,
        rows: (named..width).map(column).collect(),
        ..table
    }
}

/// The lines of a text by what they hold.
struct Lines<'t> {
    /// Possibly names.
    heads: Vec<&'t str>,
    /// Rows of numbers, each with its cells.
    rows: Vec<(&'t str, Vec<&'t str>)>,
    /// Names that are numbers in quotes.
    quoted_names: Option<Vec<&'t str>>,
    /// Of cells; `None` for blanks.
    separator: Option<char>,
}

fn is_comment(line: &&str) -> bool {
    line.trim_start().starts_with(['#', '%', '!'])
}

/// Tells rows of numbers from lines above them.
fn sorted(text: &str) -> Lines<'_> {
    let lines = || {
        text.lines()
            .filter(|line| !line.trim().is_empty() && !is_rule(line))
    };
    let separator = separator(lines().filter(|line| !is_comment(line)));
    let is_number = |cell: &&str| number(cell, separator != Some(',')).is_some();
    let mut heads = vec![];
    let mut rows = vec![];
    let mut quoted_names = None;
    let mut all = lines().peekable();
    while let Some(line) = all.next() {
        if rows.is_empty()
            && let Some(below) = all.peek()
            && let Some(names) = names_in_quotes(line, below, separator)
        {
            quoted_names = Some(names);
            continue;
        }
        // A row without the comment after it.
        let cells = split(&line[..line.find(" #").unwrap_or(line.len())], separator);
        let numbers = cells.iter().filter(|cell| is_number(cell)).count();
        let is_row = match separator {
            _ if cells.first().is_some_and(is_number) => true,
            None => numbers > 1 && numbers + 1 >= cells.len(),
            Some(_) => numbers > 0 && cells.len() > 1,
        };
        let begins = cells
            .iter()
            .filter(|cell| cell.starts_with(|c: char| c.is_ascii_digit()))
            .count();
        match rows.is_empty() {
            _ if is_row && !is_comment(&line) => rows.push((line, cells)),
            // A row with a word in place of a number is one, so that the word is refused.
            false if begins > 0 && 2 * begins >= cells.len() && !is_comment(&line) => {
                rows.push((line, cells));
            }
            true => heads.push(line),
            false => {}
        }
    }
    Lines {
        heads,
        rows,
        quoted_names,
        separator,
    }
}

/// The cells of a line: between separators outside quotes, or between blanks. `0.1 (2.0)` are two
/// cells.
fn split(line: &str, separator: Option<char>) -> Vec<&str> {
    // A frame has an edge on either side; without one, the last cell may be blank.
    let framed = line
        .trim()
        .strip_prefix('|')
        .filter(|_| separator == Some('|'));
    let line = framed.map_or(line, |line| line.strip_suffix('|').unwrap_or(line));
    let mut quoted = false;
    let mut is_start = true;
    let separates = |c: char| {
        quoted ^= c == '"' && (quoted || is_start);
        let is_end =
            !quoted && separator.map_or(c.is_whitespace() || c == '|', |separator| c == separator);
        is_start = is_end || (is_start && c.is_whitespace());
        is_end
    };
    let two = |cell| match str::split_once(cell, " (") {
        Some((one, two)) if number(one, false).is_some() => vec![one, two.trim_end_matches(')')],
        _ => vec![cell],
    };
    let cells = line
        .split(separates)
        .map(cell)
        .filter(|cell| separator.is_some() || !cell.is_empty());
    cells.flat_map(two).collect()
}

/// A cell without surrounding blanks and quotes; the end of a text of blanks alone.
fn cell(text: &str) -> &str {
    let text = text.trim_start().trim_end();
    text.strip_prefix('"')
        .and_then(|text| text.strip_suffix('"'))
        .unwrap_or(text)
        .trim()
}

/// The cells of a line in which each number is in quotes, if some stand above a number without:
/// they are names.
fn names_in_quotes<'t>(
    line: &'t str,
    below: &str,
    separator: Option<char>,
) -> Option<Vec<&'t str>> {
    if !line.contains('"') {
        return None;
    }
    let is_number = |cell: &&str| number(cell, separator != Some(',')).is_some();
    let is_quoted = |line: &str, cell: &str| {
        line[..cell.as_ptr() as usize - line.as_ptr() as usize].ends_with('"')
    };
    let names = split(line, separator);
    let cells = split(below, separator);
    let is_above = |(name, cell): (&&str, &&str)| {
        is_number(name) && is_number(cell) && !is_quoted(below, cell)
    };
    let is_head = names
        .iter()
        .filter(|name| is_number(name))
        .all(|name| is_quoted(line, name));
    (is_head && names.iter().rev().zip(cells.iter().rev()).any(is_above)).then_some(names)
}

/// The separator of a table: the first that leaves no two numbers in one cell of its first row;
/// `None` for blanks.
fn separator<'t>(mut lines: impl DoubleEndedIterator<Item = &'t str> + Clone) -> Option<char> {
    let is_number = |text: &str| number(text, true).is_some();
    let leads = |line: &&str| {
        let line = line.trim_start_matches(|c: char| c.is_whitespace() || "|\"$".contains(c));
        is_number(
            line.split(|c: char| c.is_whitespace() || ";,&|\"$".contains(c))
                .next()
                .unwrap_or_default(),
        )
    };
    let line = lines.clone().find(leads).or_else(|| lines.next_back())?;
    let holds_two = |cell: &&str| {
        let words: Vec<&str> = cell.split_whitespace().collect();
        words
            .windows(2)
            .any(|two| is_number(two[0]) && is_number(two[1]))
    };
    let separates = |c: &char| line.contains(*c) && !split(line, Some(*c)).iter().any(holds_two);
    ['&', '|', ';', '\t', ','].into_iter().find(separates)
}

/// A line of dashes, or the border of a box.
fn is_rule(line: &str) -> bool {
    let drawn = |c: char| {
        c.is_whitespace() || "-=_~+|:".contains(c) || ('\u{2500}'..='\u{257f}').contains(&c)
    };
    line.chars().all(drawn)
        && line
            .chars()
            .filter(|c| !c.is_whitespace() && *c != '|')
            .count()
            > 2
}

/// Cells of a row that is shorter than others, for a blank in place of a rate, go into the columns
/// below which they stand.
///
/// A row with less than a [`FULL`]-th of the cells stays short: filled, such rows could be many
/// times as long as the text.
fn fill<'t>(rows: &mut [(&'t str, Vec<&'t str>)]) {
    let span = |line: &str, cell: &str| {
        [0, cell.len()].map(|end| cell.as_ptr() as usize - line.as_ptr() as usize + end)
    };
    let width = rows.iter().map(|(_, cells)| cells.len()).max().unwrap_or(0);
    let mut spans = vec![[usize::MAX, 0]; width];
    for (line, cells) in rows.iter().filter(|(_, cells)| cells.len() == width) {
        for (all, [start, end]) in spans
            .iter_mut()
            .zip(cells.iter().map(|cell| span(line, cell)))
        {
            *all = [all[0].min(start), all[1].max(end)];
        }
    }
    for (line, cells) in rows
        .iter_mut()
        .filter(|(_, cells)| (width..FULL * width).contains(&(FULL * cells.len())))
    {
        // Starts and ends grow from column to column.
        let below = |cell: &&str| {
            let [start, end] = span(line, cell);
            let column = spans.partition_point(|column| column[1] <= start);
            spans
                .get(column)
                .is_some_and(|column| column[0] < end)
                .then_some(column)
        };
        let places: Vec<usize> = cells.iter().filter_map(below).collect();
        if places.len() == cells.len() && places.is_sorted_by(|a, b| a < b) {
            let mut filled = vec![&line[line.len()..]; width];
            places
                .iter()
                .zip(cells.iter())
                .for_each(|(place, cell)| filled[*place] = cell);
            *cells = filled;
        }
    }
}

/// Names in numbered lines, `# 1: cells`, `# 2: dofs`, ...
fn numbered<'t>(heads: &[&'t str], width: usize) -> Option<Vec<&'t str>> {
    let pairs = heads.iter().filter_map(|line| line.split_once(':'));
    let numbered =
        pairs.filter_map(|(k, name)| Some((k.trim().parse::<usize>().ok()?, cell(name))));
    let (numbers, names): (Vec<usize>, Vec<&str>) = numbered.unzip();
    numbers.into_iter().eq(1..=width).then_some(names)
}

/// Whether a cell holds the type of a column, as data frames write it below the name, or a unit.
fn is_type(cell: &&str) -> bool {
    TYPES.contains(&&*cell.to_lowercase()) || is_dash(cell) || cell.starts_with(['[', '<'])
}

/// Whether a cell cannot be a name.
fn is_no_name(cell: &&str) -> bool {
    let is_finite = number(cell, false).is_some_and(|number| number.value.is_finite());
    is_finite
        || cell.ends_with(',')
        || !(matches!(*cell, "" | "#")
            || cell.contains(|c: char| c.is_alphabetic() || c.is_control()))
}

/// A line cut at its separator, at commas, at semicolons, and where there are several blanks.
fn splits(line: &str, separator: Option<char>) -> [Vec<&str>; 4] {
    let wide = line
        .split("  ")
        .map(|cell| cell.trim_matches([' ', '|', '\t']))
        .filter(|cell| !cell.is_empty());
    [
        split(line, separator),
        split(line, Some(',')),
        split(line, Some(';')),
        wide.collect(),
    ]
}

/// The nearest line above the rows with a name for each column. Columns of rates, which begin or
/// end with a dash, and the first column may have none.
fn names<'t>(
    heads: &[&'t str],
    rows: &[Vec<&str>],
    separator: Option<char>,
    width: usize,
) -> Option<Vec<&'t str>> {
    let firsts: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    let is_even = rows.iter().all(|row| row.len() == width);
    let is_index = counts_rows(&firsts);
    let ends = [&rows[0], &rows[rows.len() - 1]];
    let is_rate = |k: &usize| {
        ends.iter().any(|row| {
            row.get(*k)
                .is_some_and(|cell| !cell.is_empty() && is_dash(cell))
        })
    };
    let masks = [(0, false), (0, true), (1, false), (1, true)].map(|(first, without)| {
        (first..width)
            .filter(|k| !(without && is_rate(k)))
            .collect::<Vec<usize>>()
    });
    let mut first = "";
    for line in heads.iter().rev() {
        let splits = splits(line, separator);
        // Between words of several names there are single blanks: no word is the name of a rate
        // then.
        let is_worded = separator.is_none() && (2..splits[0].len()).contains(&splits[3].len());
        let fits = |mask: &[usize], cells: &&Vec<&str>| {
            let is_sure = !is_worded
                || mask
                    .iter()
                    .zip(*cells)
                    .all(|(k, cell)| !is_rate(k) || Word::of(cell) == Word::Rate);
            cells.len() == mask.len()
                && is_sure
                && !cells.iter().all(is_type)
                && !cells.iter().any(is_no_name)
        };
        // A data frame writes the name of its index below the others.
        let may_lack = is_even && (is_index || line.starts_with(' '));
        for mask in masks
            .iter()
            .filter(|mask| mask.len() == width || is_even && mask.first() == Some(&0) || may_lack)
        {
            if let Some(cells) = splits.iter().find(|cells| fits(mask, cells)) {
                let mut names = vec![&line[..0]; width];
                names[0] = first;
                mask.iter()
                    .zip(cells)
                    .for_each(|(k, cell)| names[*k] = cell);
                return Some(names);
            }
        }
        first = if splits[0].len() == 1 {
            splits[0][0]
        } else {
            ""
        };
    }
    None
}

/// Whether columns stand as rows: words before them and none above, two rows of numbers, or the
/// steps in the first one.
fn is_turned(rows: &[Vec<&str>]) -> bool {
    // Numbers with a constant ratio are those of a step.
    let is_even = |cells: &[&str]| {
        let numbers: Vec<f64> = cells
            .iter()
            .filter_map(|cell| Some(number(cell, true)?.value))
            .collect();
        numbers.len() > 2
            && numbers
                .windows(3)
                .all(|three| (three[0] * three[2] / three[1].powi(2) - 1.0).abs() < 1e-3)
    };
    let firsts: Vec<&str> = rows.iter().filter_map(|row| row.first().copied()).collect();
    let is_even_across = || rows.len() == 2 || is_even(&rows[0]) && !is_even(&firsts);
    rows.iter()
        .all(|row| row.len() == rows[0].len() && row.len() > 2)
        && rows.len() > 1
        && (firsts.iter().all(|cell| number(cell, true).is_none()) || is_even_across())
}

/// Whether a column is 0, 1, 2, ... or 1, 2, 3, ..., from above or from below.
pub(super) fn counts_rows(cells: &[&str]) -> bool {
    let Ok(values) = cells
        .iter()
        .map(|cell| cell.parse::<i64>())
        .collect::<Result<Vec<i64>, _>>()
    else {
        return false;
    };
    let [first, .., last] = values[..] else {
        return matches!(values[..], [0 | 1]);
    };
    matches!(first.min(last), 0 | 1)
        && values
            .windows(2)
            .all(|two| two[1] - two[0] == (last - first).signum())
}
