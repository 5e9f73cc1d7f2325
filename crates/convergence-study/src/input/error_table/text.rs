//! From any text to names above columns of cells.

use super::names::Word;
use super::number::{is_dash, number};
use super::pairs;
use crate::input::Place;

/// What stands between two separators, without blanks and quotes around it, and the byte of its line where it begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell<'t> {
    pub(super) start: usize,
    pub(super) text: &'t str,
}

/// Nothing where a name or a number could be.
const NONE: Cell<'_> = Cell { start: 0, text: "" };

/// A row and its line, from 1.
#[derive(Debug, Clone)]
pub(super) struct Row<'t> {
    pub(super) line: usize,
    pub(super) cells: Vec<Cell<'t>>,
}

/// A table as it is written.
#[derive(Debug, Default)]
pub(super) struct Grid<'t> {
    pub(super) text: &'t str,
    /// Line of the names, from 1, and a name for each column, empty for none.
    pub(super) line: usize,
    pub(super) names: Vec<Cell<'t>>,
    pub(super) rows: Vec<Row<'t>>,
    /// Whether a comma in a cell is that of a number.
    pub(super) decimal_comma: bool,
    /// What is no column of the table, with the reason.
    pub(super) left_out: Vec<(String, String)>,
    /// How many words stand above the rows, where they are not one for each column.
    pub(super) misfit: Option<usize>,
}

/// A line that may have names: its number, and where the text behind a comment mark begins.
struct Head<'t> {
    line: usize,
    text: &'t str,
    before: usize,
}

/// Marks that begin a comment.
const COMMENTS: [char; 3] = ['#', '%', '!'];
/// Stands before a number that was written in parentheses.
const BEHIND: char = '\u{1f}';

/// A text without colours and timestamps, `0.1 (2.0)` as two cells, and a line for each of nested lists.
pub(super) fn plain(text: &str) -> String {
    // Spreadsheets put a byte order mark in front; the first Macintosh ended lines by \r.
    let text = text
        .trim_start_matches('\u{feff}')
        .replace("\r\n", "\n")
        .replace('\r', "\n")
        .replace(['│', '┃', '┆', '║'], "|");
    let text = ["np.float64(", "np.int64(", "array("].iter().fold(text, |text, wrapper| text.replace(wrapper, "("));
    let uncoloured = |(k, part): (usize, &str)| {
        let end = part.find(|c: char| !c.is_ascii_digit() && c != ';').map_or(part.len(), |end| end + 1);
        part.get(if k == 0 { 0 } else { end }..).unwrap_or_default().to_owned()
    };
    let text: String = text.split("\x1b[").enumerate().map(uncoloured).collect();
    // Jira writes `||h||L2||` above `|0.1|1.6e-3|`.
    let single = |line: &str| if line.ends_with("||") { line.replace("||", "|") } else { line.to_owned() };
    let mut text: String = text.lines().map(|line| single(without_stamp(line)) + "\n").collect();
    let mut from = 0;
    while let Some((open, close)) =
        text[from..].find('(').and_then(|at| Some((from + at, from + at + text[from + at..].find(')')?)))
    {
        let inner = &text[open + 1..close];
        let before = text[..open].trim_end_matches(' ').chars().last();
        if before.is_none_or(|c| c.is_ascii_digit() || "([,=$}\n".contains(c))
            && (number(inner, false).is_some() || (is_dash(inner) && before.is_some_and(|c| c.is_ascii_digit())))
        {
            text.replace_range(close..=close, " ");
            text.replace_range(open..=open, &BEHIND.to_string());
        }
        from = open + 1;
    }
    let begins = |marks: &[char]| text.trim_start().starts_with(marks) && !text.contains(['"', '\'', '=']);
    match () {
        // `{0.1: 1.6e-3, 0.05: 4e-4}`.
        () if begins(&['{']) && !text.contains(['&', '\\']) => text.replace([',', '{', '}'], "\n").replace(':', " "),
        () if begins(&['[', '(']) && !text.contains('{') => unnested(&text),
        () => text,
    }
}

/// Nested lists without names: a line for each innermost one.
fn unnested(text: &str) -> String {
    let mut depth = 0_usize;
    let mut kept = |c: char| match c {
        '[' | '(' => {
            depth += 1;
            ' '
        }
        ']' | ')' => {
            depth = depth.saturating_sub(1);
            '\n'
        }
        ',' | BEHIND => ' ',
        '\n' if depth > 0 => ' ',
        other => other,
    };
    text.chars().map(&mut kept).collect()
}

/// A line of a log without date, time, level and the marks behind them.
fn without_stamp(line: &str) -> &str {
    const LEVELS: [&str; 5] = ["INFO", "DEBUG", "WARNING", "WARN", "ERROR"];
    if LEVELS.iter().any(|level| line.starts_with(level) && line[level.len()..].starts_with(':')) {
        // `INFO:root:h=0.1`.
        return line.splitn(3, ':').nth(2).unwrap_or(line);
    }
    let is_stamp = |word: &str| {
        let word = word.trim_matches(|c| "[](),|".contains(c));
        let is_date = word.len() > 7 && word.matches(['-', '/']).count() == 2 && !word.contains('.');
        word.chars().all(|c| c.is_ascii_digit() || "-:.,T+Z/".contains(c)) && (word.matches(':').count() > 1 || is_date)
    };
    let is_level = |word: &str| {
        let word = word.trim_matches(|c: char| !c.is_alphabetic());
        word.is_empty() || LEVELS.iter().any(|level| word.eq_ignore_ascii_case(level))
    };
    let (mut rest, mut stamped) = (line, false);
    while let Some(word) = rest.split_whitespace().next() {
        let has_digit = word.contains(|c: char| c.is_ascii_digit());
        if !(is_stamp(word) && has_digit || stamped && !has_digit && is_level(word)) {
            break;
        }
        (rest, stamped) = (&rest[rest.find(word).unwrap_or(0) + word.len()..], true);
    }
    rest
}

/// The cells of a line: between separators, outside of quotes and not behind a backslash; between blanks without one.
fn split(line: &str, separator: Option<char>) -> Vec<Cell<'_>> {
    let separates =
        |c: char| c == BEHIND || separator.map_or(c.is_whitespace() || c == '|', |separator| c == separator);
    // A row of LaTeX without the rules before it and what ends it.
    let is_latex = separator == Some('&');
    let line = if is_latex { line.find("\\\\").map_or(line, |end| &line[..end]) } else { line };
    let rules = ["\\hline", "\\toprule", "\\midrule", "\\addlinespace"];
    let rule = rules.iter().filter_map(|rule| line.find(rule).map(|at| at + rule.len())).filter(|_| is_latex).max();
    let first = rule.unwrap_or(0);
    let (mut cells, mut start) = (vec![], first);
    let (mut quoted, mut escaped) = (false, false);
    for (at, c) in line.char_indices().skip_while(|(at, _)| *at < first).chain([(line.len(), BEHIND)]) {
        if separates(c) && (at == line.len() || !(quoted || escaped)) {
            cells.push(cell(line, start, at));
            start = (at + c.len_utf8()).min(line.len());
        } else if c == '"' && (quoted || line[start..at].trim().is_empty()) {
            quoted = !quoted;
        }
        escaped = c == '\\' && !escaped;
    }
    if separator == Some('|') {
        let line = line.trim();
        cells.truncate(cells.len() - usize::from(line.ends_with('|') && cells.len() > 1));
        cells.drain(..usize::from(line.starts_with('|') && cells.len() > 1));
    }
    cells.retain(|cell| separator.is_some() || !cell.text.is_empty());
    cells
}

fn cell(line: &str, start: usize, end: usize) -> Cell<'_> {
    let text = line[start..end].trim();
    let start = end - line[start..end].trim_start().len();
    Cell { start, text: text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text).trim() }
}

/// The separator of a table: the first that leaves no two numbers in a cell of its first row.
fn separator<'t>(mut lines: impl DoubleEndedIterator<Item = &'t str> + Clone) -> Option<char> {
    let is_number = |text: &str| number(text, true).is_some();
    let leads = |line: &&str| {
        let line = line.trim_start_matches(|c: char| c.is_whitespace() || "|\"$".contains(c));
        is_number(line.split(|c: char| c.is_whitespace() || ";,&|\"$".contains(c)).next().unwrap_or_default())
    };
    let line = lines.clone().find(leads).or_else(|| lines.next_back())?;
    let holds_two = |cell: &Cell<'_>| {
        let numbers: Vec<bool> = cell.text.split_whitespace().map(is_number).collect();
        numbers.windows(2).any(|two| two[0] && two[1])
    };
    let cells = |separator: char| split(line, Some(separator));
    ['&', '|', ';', '\t', ','].into_iter().find(|c| line.contains(*c) && !cells(*c).iter().any(holds_two))
}

/// A line of dashes or of a box.
fn is_rule(line: &str) -> bool {
    let strokes = |c: char| "-=_~─═━".contains(c);
    let drawn =
        |c: char| strokes(c) || c.is_whitespace() || "+|:".contains(c) || ('\u{2500}'..='\u{257f}').contains(&c);
    line.chars().all(drawn) && line.chars().filter(|c| strokes(*c)).count() > 2
}

/// The types of columns as data frames write them below the names, or units.
fn is_type(cell: &Cell<'_>) -> bool {
    let text = cell.text.to_lowercase();
    let known = ["f", "i", "u", "int", "float", "double", "bigint", "str"];
    known.contains(&text.trim_end_matches(|c: char| c.is_ascii_digit()))
        || (text.starts_with(['[', '<']) && text.ends_with([']', '>']))
        || is_dash(&text)
}

impl<'t> Grid<'t> {
    /// Finds the table in a text that has been made [`plain`].
    pub(super) fn read(text: &'t str) -> Self {
        if let Some(grid) = pairs::read(text, true) {
            return grid;
        }
        let mut grid = Self { text, ..Self::default() };
        let is_comment = |line: &str| line.trim_start().starts_with(COMMENTS);
        let content = text.lines().filter(|line| !line.trim().is_empty() && !is_rule(line) && !is_comment(line));
        let separator = separator(content);
        grid.decimal_comma = separator != Some(',');
        let mut heads: Vec<Head<'t>> = vec![];
        for (k, text) in text.lines().enumerate() {
            let before = text.len() - text.trim_start().trim_start_matches(COMMENTS).len();
            let head = Head { line: k + 1, text, before: if is_comment(text) { before } else { 0 } };
            let is_cut = separator == Some('&') && !text.contains('&');
            if head.before > 0 && grid.rows.is_empty() {
                heads.push(head);
            } else if !(head.before > 0 || text.trim().is_empty() || is_rule(text) || is_cut) {
                grid.add(head, separator, &mut heads);
            }
        }
        if grid.rows.is_empty() {
            return pairs::read(text, false).unwrap_or(grid);
        }
        let spans = grid.fill_gaps(separator);
        if let Some((line, names)) = numbered(&heads, spans.len()).or_else(|| grid.fit(&heads, separator, &spans)) {
            (grid.line, grid.names) = (line, names);
        } else if !grid.turn() {
            let mut words = heads.iter().filter(|head| head.before == 0).map(|head| split(head.text, separator).len());
            grid.misfit = words.rfind(|words| *words > 1);
        }
        grid
    }

    /// Where a byte of a line is.
    pub(super) fn place(&self, line: usize, byte: usize) -> Place {
        let text = self.text.lines().nth(line.saturating_sub(1)).unwrap_or_default();
        Place { line, column: text.get(..byte).map_or(byte, |before| before.chars().count()) + 1 }
    }

    /// Adds a line to the rows, if it is one, or to the lines above them that may have names.
    fn add(&mut self, head: Head<'t>, separator: Option<char>, heads: &mut Vec<Head<'t>>) {
        let is_number = |cell: &Cell<'_>| number(cell.text, separator != Some(',')).is_some();
        // A row without the comment behind it.
        let end = head.text.find(" #").unwrap_or(head.text.len());
        let cells = split(&head.text[..end], separator);
        let numbers = cells.iter().filter(|cell| is_number(cell)).count();
        let begins = cells.iter().filter(|cell| cell.text.starts_with(|c: char| c.is_ascii_digit())).count();
        let is_row = cells.first().is_some_and(is_number)
            || if separator.is_none() {
                numbers > 1 && numbers + 1 >= cells.len()
            } else {
                numbers > 0 && cells.len() > 1
            };
        if is_row || (!self.rows.is_empty() && 2 * begins >= cells.len()) {
            self.rows.push(Row { line: head.line, cells });
        } else if self.rows.is_empty() {
            heads.push(head);
        }
    }

    /// Makes columns of rows: a word before each and none above, or two rows of numbers.
    fn turn(&mut self) -> bool {
        let width = self.rows[0].cells.len();
        let named = usize::from(self.rows.iter().all(|row| number(row.cells[0].text, true).is_none()));
        // Numbers with one ratio are those of a step.
        let is_even = |cells: Vec<Cell<'_>>| {
            let numbers: Vec<f64> = cells.iter().filter_map(|cell| Some(number(cell.text, true)?.value)).collect();
            numbers.len() > 2
                && numbers.windows(3).all(|three| (three[0] * three[2] / three[1].powi(2) - 1.0).abs() < 1e-3)
        };
        let first = || self.rows.iter().filter_map(|row| row.cells.first().copied()).collect();
        let is_turned =
            named == 1 || self.rows.len() == 2 || (is_even(self.rows[0].cells.clone()) && !is_even(first()));
        if self.rows.len() < 2 || width < 3 || !is_turned || self.rows.iter().any(|row| row.cells.len() != width) {
            return false;
        }
        let rows = std::mem::take(&mut self.rows);
        self.line = rows[0].line;
        self.names = rows.iter().take(named * rows.len()).map(|row| row.cells[0]).collect();
        let row = |k: usize| Row { line: self.line, cells: rows.iter().map(|row| row.cells[k]).collect() };
        self.rows = (named..width).map(row).collect();
        true
    }

    /// Puts the cells of shorter rows into the columns below which they stand, and empty ones between them; the bytes
    /// that each column takes.
    fn fill_gaps(&mut self, separator: Option<char>) -> Vec<[usize; 2]> {
        // Where the rate of the coarsest level is left blank its row is shorter than the others.
        let width = self.rows.iter().map(|row| row.cells.len()).max().unwrap_or(0);
        let end = |cell: &Cell<'_>| cell.start + cell.text.len().max(1);
        let mut spans = vec![[usize::MAX, 0]; width];
        for row in self.rows.iter().filter(|row| row.cells.len() == width) {
            for (span, cell) in spans.iter_mut().zip(&row.cells) {
                *span = [span[0].min(cell.start), span[1].max(end(cell))];
            }
        }
        for row in self.rows.iter_mut().filter(|row| separator.is_none() && row.cells.len() < width) {
            let below = |span: &[usize; 2]| {
                row.cells.iter().copied().filter(|cell| cell.start < span[1] && span[0] < end(cell)).collect::<Vec<_>>()
            };
            let found: Vec<Vec<Cell<'t>>> = spans.iter().map(below).collect();
            if found.iter().all(|cells| cells.len() < 2) && found.iter().map(Vec::len).sum::<usize>() == row.cells.len()
            {
                row.cells = spans
                    .iter()
                    .zip(found)
                    .map(|(span, cells)| cells.first().copied().unwrap_or(Cell { start: span[0], text: "" }))
                    .collect();
            }
        }
        spans
    }

    /// The nearest line above the rows that has a name for each column; a comment where no other has.
    fn fit(&self, heads: &[Head<'t>], separator: Option<char>, spans: &[[usize; 2]]) -> Option<(usize, Vec<Cell<'t>>)> {
        let width = spans.len();
        let dashed: Vec<bool> = (0..width).map(|column| self.holds_rates(column)).collect();
        let first = usize::from(self.counts_rows(0));
        let masks = [(0, false), (0, true), (first, false), (first, true)]
            .map(|(first, rates)| -> Vec<bool> { (0..width).map(|k| k >= first && !(rates && dashed[k])).collect() });
        let mut below: Option<Cell<'t>> = None;
        let rows = heads.iter().rev().filter(|head| head.before == 0);
        for head in rows.chain(heads.iter().rev().filter(|head| head.before > 0)) {
            // A comment may be separated in another way than the rows: `# h, L2` above columns of blanks.
            let others = [Some(','), Some(';'), Some('\t')];
            for other in others.iter().filter(|_| head.before > 0).chain([&separator]) {
                let mut cells = split(&head.text[head.before..], *other);
                cells.iter_mut().for_each(|cell| cell.start += head.before);
                let is_finite =
                    |cell: &Cell<'_>| number(cell.text, false).is_some_and(|number| number.value.is_finite());
                if split(head.text, None).iter().all(is_type) || cells.iter().any(is_finite) {
                    continue;
                }
                if let ([only], true, 0) = (&cells[..], width > 1, head.before) {
                    below = Some(*only);
                } else if let Some(index) = below.filter(|_| cells.len() + 1 == width && head.before == 0) {
                    cells.insert(0, index);
                }
                let is_fit = |mask: &&Vec<bool>| {
                    // Above blanks words may be parts of names: then none stands above rates but theirs.
                    let is_rate =
                        || cells.iter().zip(&dashed).all(|(cell, dash)| !dash || Word::of(cell.text).is_rate());
                    mask.iter().filter(|named| **named).count() == cells.len()
                        && (mask.contains(&false) || other.is_some() || is_rate())
                };
                let fitted = masks.iter().find(is_fit).map(|mask| {
                    let mut cells = cells.iter().copied();
                    mask.iter().map(|named| if *named { cells.next().unwrap_or(NONE) } else { NONE }).collect()
                });
                let all = || Some(cells.clone()).filter(|cells| cells.len() == width);
                let above = || if other.is_none() { above(head.text, &cells, spans, &dashed) } else { None };
                if let Some(names) = fitted.or_else(above).or_else(all) {
                    return Some((head.line, names));
                }
            }
        }
        None
    }

    /// Whether a column is 0, 1, 2, ... or 1, 2, 3, ..., from above or from below.
    pub(super) fn counts_rows(&self, column: usize) -> bool {
        let value = |row: &Row<'_>| row.cells.get(column).and_then(|cell| cell.text.parse::<i64>().ok());
        let Some(values) = self.rows.iter().map(value).collect::<Option<Vec<i64>>>() else { return false };
        let (first, last) = (values[0], values[values.len() - 1]);
        matches!(first.min(last), 0 | 1) && values.windows(2).all(|two| two[1] - two[0] == (last - first).signum())
    }

    /// Whether a column may hold rates without a name: a dash in the first row or the last, and few decimals in all
    /// others.
    fn holds_rates(&self, column: usize) -> bool {
        let cells: Vec<&str> = self.rows.iter().map(|row| row.cells.get(column).map_or("", |cell| cell.text)).collect();
        let is_rate = |text: &&str| {
            text.split_once('.').is_some_and(|(_, decimals)| decimals.len() < 5 && !text.contains(['e', 'E']))
        };
        let ends = [cells[0], cells[cells.len() - 1]].iter().any(|text| is_dash(text) && !text.is_empty());
        ends && cells.iter().filter(|text| is_rate(text)).count() + 1 == cells.len()
    }
}

/// Names of several words above columns, some of which hold rates: each word belongs to the nearest column with a name.
fn above<'t>(line: &'t str, words: &[Cell<'t>], spans: &[[usize; 2]], dashed: &[bool]) -> Option<Vec<Cell<'t>>> {
    let has_rate = words.iter().any(|word| Word::of(word.text).is_rate());
    let named: Vec<usize> = (0..spans.len()).filter(|k| has_rate || !dashed[*k]).collect();
    let mut names = vec![NONE; spans.len()];
    for word in words {
        let end = word.start + word.text.len();
        // A name stands above the rates behind its column, too.
        let distance = |k: &usize| {
            let last = (*k + 1..spans.len()).take_while(|k| dashed[*k] && !has_rate).last().unwrap_or(*k);
            spans[*k][0].saturating_sub(end).max(word.start.saturating_sub(spans[last][1]))
        };
        let name = &mut names[*named.iter().min_by_key(|k| distance(k))?];
        *name = if name.text.is_empty() { *word } else { cell(line, name.start, end) };
    }
    named.iter().skip(1).all(|k| !names[*k].text.is_empty()).then_some(names)
}

/// The names of `# 1: cells`, `# 2: dofs`, ..., and the line of the first; `None` where they are not as many as
/// columns.
fn numbered<'t>(heads: &[Head<'t>], width: usize) -> Option<(usize, Vec<Cell<'t>>)> {
    let name = |head: &Head<'t>| {
        let (number, name) = head.text[head.before..].split_once(':')?;
        Some((
            number.trim().parse::<usize>().ok()?,
            cell(head.text, head.text.len() - name.len(), head.text.len()),
            head.line,
        ))
    };
    let named: Vec<_> = heads.iter().filter(|head| head.before > 0).filter_map(name).collect();
    let in_order = named.len() == width && named.iter().enumerate().all(|(k, (number, ..))| *number == k + 1);
    in_order.then(|| (named[0].2, named.iter().map(|(_, name, _)| *name).collect()))
}
