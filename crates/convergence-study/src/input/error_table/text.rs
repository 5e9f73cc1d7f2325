//! From any text to names above columns of cells.

use super::names::Word;
use super::number::{is_dash, number};
use super::pairs;
use crate::input::{Place, Source};

/// A table as it is written. Names and cells are pieces of its text, which tell their places.
#[derive(Debug, Default)]
pub(super) struct RawTable<'t> {
    pub(super) text: &'t str,
    /// A name for each column, empty for none.
    pub(super) names: Vec<&'t str>,
    pub(super) rows: Vec<Vec<&'t str>>,
    /// Whether a comma in a cell is that of a number.
    pub(super) decimal_comma: bool,
    /// What is no column of the table, with the reason.
    pub(super) left_out: Vec<(String, String)>,
    /// How many words stand above the rows, where they are not one for each column.
    pub(super) misfit: Option<usize>,
}

/// Marks that begin a comment.
const COMMENTS: [char; 3] = ['#', '%', '!'];
/// Stands before a number that was written in parentheses.
const BEHIND: char = '\u{1f}';

/// A text without colours and timestamps, `0.1 (2.0)` as two cells, and a line for each of nested lists.
pub(super) fn plain(text: &str) -> String {
    // Spreadsheets put a byte order mark in front; the first Macintosh ended lines by \r.
    let marks = [("\u{feff}", ""), ("\r\n", "\n"), ("\r", "\n"), ("│", "|"), ("┃", "|"), ("┆", "|"), ("║", "|")];
    let wrappers = [("np.float64(", "("), ("np.int64(", "("), ("array(", "(")];
    let text = marks.iter().chain(&wrappers).fold(text.to_owned(), |text, (from, to)| text.replace(from, to));
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
fn split(line: &str, separator: Option<char>) -> Vec<&str> {
    let separates =
        |c: char| c == BEHIND || separator.map_or(c.is_whitespace() || c == '|', |separator| c == separator);
    // A row of LaTeX without the rules before it and what ends it.
    let is_latex = separator == Some('&');
    let line = if is_latex { line.find("\\\\").map_or(line, |end| &line[..end]) } else { line };
    let rules = ["\\hline", "\\toprule", "\\midrule", "\\addlinespace"];
    let rule = rules.iter().filter_map(|rule| line.find(rule).map(|at| at + rule.len())).filter(|_| is_latex).max();
    let (mut cells, mut start, first) = (vec![], rule.unwrap_or(0), rule.unwrap_or(0));
    let (mut quoted, mut escaped) = (false, false);
    for (at, c) in line.char_indices().skip_while(|(at, _)| *at < first).chain([(line.len(), BEHIND)]) {
        if separates(c) && (at == line.len() || !(quoted || escaped)) {
            cells.push(cell(&line[start..at]));
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
    cells.retain(|cell| separator.is_some() || !cell.is_empty());
    cells
}

/// A cell without blanks and quotes around it; of blanks alone their end.
fn cell(text: &str) -> &str {
    let text = text.trim_start().trim_end();
    text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text).trim()
}

/// The separator of a table: the first that leaves no two numbers in a cell of its first row.
fn separator<'t>(mut lines: impl DoubleEndedIterator<Item = &'t str> + Clone) -> Option<char> {
    let is_number = |text: &str| number(text, true).is_some();
    let leads = |line: &&str| {
        let line = line.trim_start_matches(|c: char| c.is_whitespace() || "|\"$".contains(c));
        is_number(line.split(|c: char| c.is_whitespace() || ";,&|\"$".contains(c)).next().unwrap_or_default())
    };
    let line = lines.clone().find(leads).or_else(|| lines.next_back())?;
    let holds_two = |cell: &&str| {
        let numbers: Vec<bool> = cell.split_whitespace().map(is_number).collect();
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
fn is_type(cell: &&str) -> bool {
    let text = cell.to_lowercase();
    let known = ["f", "i", "u", "int", "float", "double", "bigint", "str"];
    known.contains(&text.trim_end_matches(|c: char| c.is_ascii_digit()))
        || (text.starts_with(['[', '<']) && text.ends_with([']', '>']))
        || is_dash(&text)
}

/// A line above the rows, without the marks of a comment.
struct Head<'t> {
    text: &'t str,
    is_comment: bool,
}

impl<'t> RawTable<'t> {
    /// Finds the table in a text that has been made [`plain`].
    pub(super) fn read(text: &'t str) -> Self {
        if let Some(grid) = pairs::read(text, true) {
            return grid;
        }
        let mut grid = Self { text, ..Self::default() };
        let is_comment = |line: &str| line.trim_start().starts_with(COMMENTS);
        let lines = || text.lines().filter(|line| !line.trim().is_empty() && (is_comment(line) || !is_rule(line)));
        let separator = separator(lines().filter(|line| !is_comment(line)));
        grid.decimal_comma = separator != Some(',');
        let mut heads: Vec<Head<'t>> = vec![];
        for line in lines() {
            if is_comment(line) && grid.rows.is_empty() {
                heads.push(Head { text: line.trim_start().trim_start_matches(COMMENTS), is_comment: true });
            } else if !is_comment(line) && (separator != Some('&') || line.contains('&')) && !grid.add(line, separator)
            {
                heads.push(Head { text: line, is_comment: false });
            }
        }
        if grid.rows.is_empty() {
            return pairs::read(text, false).unwrap_or(grid);
        }
        let spans = grid.fill_gaps(separator);
        if let Some(names) = numbered(&heads, spans.len()).or_else(|| grid.fit(&heads, separator, &spans)) {
            grid.names = names;
        } else if !grid.turn() {
            let mut words = heads.iter().filter(|head| !head.is_comment).map(|head| split(head.text, separator).len());
            grid.misfit = words.rfind(|words| *words > 1);
        }
        grid
    }

    /// The byte of the text where a piece of it begins.
    fn offset(&self, piece: &str) -> usize {
        (piece.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    /// Where a piece of the text begins.
    pub(super) fn place(&self, piece: &str) -> Place {
        Source { file: "", text: self.text }.place(self.offset(piece))
    }

    /// The byte at which the line of a piece begins.
    fn line_start(&self, piece: &str) -> usize {
        self.text[..self.offset(piece)].rfind('\n').map_or(0, |end| end + 1)
    }

    /// Adds a line to the rows, if it is one; whether it is, or comes behind rows.
    fn add(&mut self, line: &'t str, separator: Option<char>) -> bool {
        let is_number = |cell: &&str| number(cell, separator != Some(',')).is_some();
        // A row without the comment behind it.
        let cells = split(&line[..line.find(" #").unwrap_or(line.len())], separator);
        let numbers = cells.iter().filter(|cell| is_number(cell)).count();
        let begins = cells.iter().filter(|cell| cell.starts_with(|c: char| c.is_ascii_digit())).count();
        let is_row = cells.first().is_some_and(is_number)
            || if separator.is_none() {
                numbers > 1 && numbers + 1 >= cells.len()
            } else {
                numbers > 0 && cells.len() > 1
            };
        if is_row || (!self.rows.is_empty() && 2 * begins >= cells.len()) {
            self.rows.push(cells);
        }
        !self.rows.is_empty()
    }

    /// Makes columns of rows: a word before each and none above, or two rows of numbers.
    fn turn(&mut self) -> bool {
        let width = self.rows[0].len();
        let named = usize::from(self.rows.iter().all(|row| number(row[0], true).is_none()));
        // Numbers with one ratio are those of a step.
        let is_even = |cells: Vec<&str>| {
            let numbers: Vec<f64> = cells.iter().filter_map(|cell| Some(number(cell, true)?.value)).collect();
            numbers.len() > 2
                && numbers.windows(3).all(|three| (three[0] * three[2] / three[1].powi(2) - 1.0).abs() < 1e-3)
        };
        let column = |k: usize| self.rows.iter().map(|row| row[k]).collect::<Vec<_>>();
        let is_turned = named == 1 || self.rows.len() == 2 || (is_even(self.rows[0].clone()) && !is_even(column(0)));
        if self.rows.len() < 2 || width < 3 || !is_turned || self.rows.iter().any(|row| row.len() != width) {
            return false;
        }
        let names = if named == 1 { column(0) } else { vec![] };
        (self.rows, self.names) = ((named..width).map(column).collect(), names);
        true
    }

    /// Puts the cells of shorter rows into the columns below which they stand, and empty ones between them; the bytes of a
    /// line that each column takes.
    fn fill_gaps(&mut self, separator: Option<char>) -> Vec<[usize; 2]> {
        // Where the rate of the coarsest level is left blank its row is shorter than the others.
        let width = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let mut spans = vec![[usize::MAX, 0]; width];
        for row in self.rows.iter().filter(|row| row.len() == width) {
            let start = self.line_start(row[0]);
            for (span, cell) in spans.iter_mut().zip(row) {
                let at = self.offset(cell) - start;
                *span = [span[0].min(at), span[1].max(at + cell.len().max(1))];
            }
        }
        let filled = |row: &Vec<&'t str>| {
            let start = self.line_start(row.first()?);
            let line = self.text[start..].lines().next()?;
            let is_below = |cell: &&str, span: &[usize; 2]| {
                let at = self.offset(cell) - start;
                at < span[1] && span[0] < at + cell.len().max(1)
            };
            let below = |span: &[usize; 2]| row.iter().copied().filter(|cell| is_below(cell, span)).collect::<Vec<_>>();
            let found: Vec<Vec<&'t str>> = spans.iter().map(below).collect();
            let is_clear = found.iter().all(|cells| cells.len() < 2) && found.iter().flatten().count() == row.len();
            let blank = |span: &[usize; 2]| line.get(span[0]..span[0]).unwrap_or(&line[line.len()..]);
            let cell = |(span, cells): (_, &Vec<&'t str>)| cells.first().copied().unwrap_or_else(|| blank(span));
            is_clear.then(|| spans.iter().zip(&found).map(cell).collect())
        };
        let is_short = |row: &Vec<&str>| separator.is_none() && row.len() < width;
        let fill = |row: &Vec<&'t str>| if is_short(row) { filled(row) } else { None };
        self.rows = self.rows.iter().map(|row| fill(row).unwrap_or_else(|| row.clone())).collect();
        spans
    }

    /// The nearest line above the rows that has a name for each column; a comment where no other has.
    fn fit(&self, heads: &[Head<'t>], separator: Option<char>, spans: &[[usize; 2]]) -> Option<Vec<&'t str>> {
        let width = spans.len();
        let dashed: Vec<bool> = (0..width).map(|column| self.holds_rates(column)).collect();
        let first = usize::from(self.counts_rows(0));
        let masks = [(0, false), (0, true), (first, false), (first, true)]
            .map(|(first, rates)| -> Vec<bool> { (0..width).map(|k| k >= first && !(rates && dashed[k])).collect() });
        let mut below: Option<&'t str> = None;
        let (comments, others): (Vec<_>, Vec<_>) = heads.iter().rev().partition(|head| head.is_comment);
        for head in others.into_iter().chain(comments) {
            // A comment may be separated in another way than the rows: `# h, L2` above columns of blanks.
            let others = [Some(','), Some(';'), Some('\t')];
            for other in others.iter().filter(|_| head.is_comment).chain([&separator]) {
                let mut cells = split(head.text, *other);
                let is_finite = |cell: &&str| number(cell, false).is_some_and(|number| number.value.is_finite());
                let is_of_types = !head.is_comment && split(head.text, None).iter().all(is_type);
                if is_of_types || cells.iter().any(is_finite) {
                    continue;
                }
                if let ([only], true, false) = (&cells[..], width > 1, head.is_comment) {
                    below = Some(only);
                } else if let Some(index) = below.filter(|_| cells.len() + 1 == width && !head.is_comment) {
                    cells.insert(0, index);
                }
                let is_fit = |mask: &&Vec<bool>| {
                    // Above blanks words may be parts of names: then none stands above rates but theirs.
                    let is_rate = || cells.iter().zip(&dashed).all(|(cell, dash)| !dash || Word::of(cell).is_rate());
                    mask.iter().filter(|named| **named).count() == cells.len()
                        && (mask.contains(&false) || other.is_some() || is_rate())
                };
                let fitted = masks.iter().find(is_fit).map(|mask| {
                    let mut cells = cells.iter().copied();
                    let mut name = |named: &bool| if *named { cells.next() } else { None };
                    mask.iter().map(|named| name(named).unwrap_or(&head.text[..0])).collect()
                });
                let above = || if other.is_none() { self.above(&cells, spans, &dashed) } else { None };
                let all = || Some(cells.clone()).filter(|cells| cells.len() == width);
                if let Some(names) = fitted.or_else(above).or_else(all) {
                    return Some(names);
                }
            }
        }
        None
    }

    /// Names of several words above columns, some of which hold rates: each word belongs to the nearest column with a name.
    fn above(&self, words: &[&'t str], spans: &[[usize; 2]], dashed: &[bool]) -> Option<Vec<&'t str>> {
        let start = self.line_start(words.first()?);
        let has_rate = words.iter().any(|word| Word::of(word).is_rate());
        let named: Vec<usize> = (0..spans.len()).filter(|k| has_rate || !dashed[*k]).collect();
        let mut names = vec![&self.text[start..start]; spans.len()];
        for word in words {
            let at = self.offset(word);
            // A name stands above the rates behind its column, too.
            let distance = |k: &usize| {
                let last = (*k + 1..spans.len()).take_while(|k| dashed[*k] && !has_rate).last().unwrap_or(*k);
                spans[*k][0].saturating_sub(at + word.len() - start).max((at - start).saturating_sub(spans[last][1]))
            };
            let name = &mut names[*named.iter().min_by_key(|k| distance(k))?];
            let from = if name.is_empty() { at } else { self.offset(name) };
            *name = cell(&self.text[from..at + word.len()]);
        }
        named.iter().skip(1).all(|k| !names[*k].is_empty()).then_some(names)
    }

    /// Whether a column is 0, 1, 2, ... or 1, 2, 3, ..., from above or from below.
    pub(super) fn counts_rows(&self, column: usize) -> bool {
        let value = |row: &Vec<&str>| row.get(column).and_then(|cell| cell.parse::<i64>().ok());
        let Some(values) = self.rows.iter().map(value).collect::<Option<Vec<i64>>>() else { return false };
        let (first, last) = (values[0], values[values.len() - 1]);
        matches!(first.min(last), 0 | 1) && values.windows(2).all(|two| two[1] - two[0] == (last - first).signum())
    }

    /// Whether a column may hold rates without a name: a dash in the first row or the last, and few decimals in all
    /// others.
    fn holds_rates(&self, column: usize) -> bool {
        let cells: Vec<&str> = self.rows.iter().map(|row| row.get(column).copied().unwrap_or_default()).collect();
        let is_rate = |text: &&str| {
            text.split_once('.').is_some_and(|(_, decimals)| decimals.len() < 5 && !text.contains(['e', 'E']))
        };
        let ends = [cells[0], cells[cells.len() - 1]].iter().any(|text| is_dash(text) && !text.is_empty());
        ends && cells.iter().filter(|text| is_rate(text)).count() + 1 == cells.len()
    }
}

/// The names of `# 1: cells`, `# 2: dofs`, ...; `None` where they are not as many as columns.
fn numbered<'t>(heads: &[Head<'t>], width: usize) -> Option<Vec<&'t str>> {
    let comments = heads.iter().filter(|head| head.is_comment);
    let numbered = comments.filter_map(|head| {
        let (number, name) = head.text.split_once(':')?;
        Some((number.trim().parse::<usize>().ok()?, cell(name)))
    });
    let (numbers, names): (Vec<usize>, Vec<&str>) = numbered.unzip();
    (names.len() == width && numbers.into_iter().eq(1..=width)).then_some(names)
}
