//! Rows of cells below names.

use super::names::Word;
use super::number::{is_dash, number};
use super::pairs;
use super::text::{BEHIND, RawTable};

/// Marks that begin a comment.
const COMMENTS: [char; 3] = ['#', '%', '!'];

/// Rows and the lines above them.
#[derive(Default)]
struct Lines<'t> {
    heads: Vec<&'t str>,
    /// Without comment marks.
    comments: Vec<&'t str>,
    /// Lines and their cells.
    rows: Vec<(&'t str, Vec<&'t str>)>,
    /// `None` for blanks.
    separator: Option<char>,
}

/// Finds the table in a text that has been made [`plain`](super::text::plain).
pub(super) fn read(text: &str) -> RawTable<'_> {
    if let Some(grid) = pairs::read(text, true) {
        return grid;
    }
    let is_comment = |line: &str| line.trim_start().starts_with(COMMENTS);
    let kept = || text.lines().filter(|line| !line.trim().is_empty() && (is_comment(line) || !is_rule(line)));
    let mut lines = Lines { separator: separator(kept().filter(|line| !is_comment(line))), ..Lines::default() };
    for line in kept() {
        match is_comment(line) {
            true if lines.rows.is_empty() => lines.comments.push(line.trim_start().trim_start_matches(COMMENTS)),
            false if lines.separator != Some('&') || line.contains('&') => lines.add(line),
            _ => {}
        }
    }
    if lines.rows.is_empty() {
        return pairs::read(text, false).filter(|_| lines.separator != Some('&')).unwrap_or_default();
    }
    let spans = lines.fill();
    let names = numbered(&lines.comments, spans.len()).or_else(|| lines.names(&spans));
    let rows: Vec<Vec<&str>> = lines.rows.into_iter().map(|(_, cells)| cells).collect();
    let grid = RawTable { decimal_comma: lines.separator != Some(','), ..RawTable::default() };
    if names.is_none() && is_turned(&rows) {
        let named = usize::from(number(rows[0][0], true).is_none());
        let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<_>>();
        let names = if named == 1 { column(0) } else { vec![&text[..0]; rows.len()] };
        return RawTable { names, rows: (named..rows[0].len()).map(column).collect(), ..grid };
    }
    // If the number of words is not that of the columns, it says how many columns there should be.
    let words = lines.heads.iter().map(|head| split(head, lines.separator).len()).rfind(|words| *words > 1);
    let names = names.unwrap_or_else(|| vec![&text[..0]; words.unwrap_or(spans.len())]);
    RawTable { names, rows, ..grid }
}

/// The cells of a line: between separators, outside quotes and not after a backslash; between blanks without one.
fn split(line: &str, separator: Option<char>) -> Vec<&str> {
    let mut line = line;
    if separator == Some('|') {
        line = line.trim();
        line = line.strip_prefix('|').unwrap_or(line);
        line = line.strip_suffix('|').unwrap_or(line);
    }
    let (mut quoted, mut escaped, mut is_start) = (false, false, true);
    let separates = |c: char| {
        quoted ^= c == '"' && (quoted || is_start);
        let is_separator = c == BEHIND || separator.map_or(c.is_whitespace() || c == '|', |separator| c == separator);
        let is_end = is_separator && !quoted && !escaped;
        (is_start, escaped) = (is_end || (is_start && c.is_whitespace()), c == '\\' && !escaped);
        is_end
    };
    line.split(separates).map(cell).filter(|cell| separator.is_some() || !cell.is_empty()).collect()
}

/// A cell without surrounding blanks and quotes; the end of a text of blanks alone.
fn cell(text: &str) -> &str {
    let text = text.trim_start().trim_end();
    text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text).trim()
}

/// The separator of a table: the first that leaves no two numbers in one cell of its first row.
fn separator<'t>(mut lines: impl DoubleEndedIterator<Item = &'t str> + Clone) -> Option<char> {
    let is_number = |text: &str| number(text, true).is_some();
    let leads = |line: &&str| {
        let line = line.trim_start_matches(|c: char| c.is_whitespace() || "|\"$".contains(c));
        is_number(line.split(|c: char| c.is_whitespace() || ";,&|\"$".contains(c)).next().unwrap_or_default())
    };
    let line = lines.clone().find(leads).or_else(|| lines.next_back())?;
    let holds_two = |cell: &&str| {
        let words: Vec<&str> = cell.split_whitespace().collect();
        words.windows(2).any(|two| is_number(two[0]) && is_number(two[1]))
    };
    let separates = |c: &char| line.contains(*c) && !split(line, Some(*c)).iter().any(holds_two);
    ['&', '|', ';', '\t', ','].into_iter().find(separates)
}

/// A line of dashes, or the border of a box.
fn is_rule(line: &str) -> bool {
    let strokes = |c: char| "-=_~─═━".contains(c);
    let drawn =
        |c: char| strokes(c) || c.is_whitespace() || "+|:".contains(c) || ('\u{2500}'..='\u{257f}').contains(&c);
    line.chars().all(drawn) && line.chars().filter(|c| strokes(*c)).count() > 2
}

/// The types of columns, as data frames write them below the names, or units.
fn is_type(cell: &&str) -> bool {
    let text = cell.to_lowercase();
    let known = ["f", "i", "u", "int", "float", "double", "bigint", "str"];
    known.contains(&text.trim_end_matches(|c: char| c.is_ascii_digit()))
        || (text.starts_with(['[', '<']) && text.ends_with([']', '>']))
        || is_dash(&text)
}

/// The byte range of a piece within its line.
fn span(line: &str, piece: &str) -> [usize; 2] {
    let start = (piece.as_ptr() as usize).saturating_sub(line.as_ptr() as usize);
    [start, start + piece.len().max(1)]
}

impl<'t> Lines<'t> {
    /// Adds a line to the rows, if it is one, or to the lines above them.
    fn add(&mut self, line: &'t str) {
        let is_number = |cell: &&str| number(cell, self.separator != Some(',')).is_some();
        // A row without the comment after it.
        let cells = split(&line[..line.find(" #").unwrap_or(line.len())], self.separator);
        let numbers = cells.iter().filter(|cell| is_number(cell)).count();
        let begins = cells.iter().filter(|cell| cell.starts_with(|c: char| c.is_ascii_digit())).count();
        let is_row = match self.separator {
            _ if cells.first().is_some_and(is_number) => true,
            None => numbers > 1 && numbers + 1 >= cells.len(),
            Some(_) => numbers > 0 && cells.len() > 1,
        };
        if is_row || (!self.rows.is_empty() && 2 * begins >= cells.len()) {
            self.rows.push((line, cells));
        } else if self.rows.is_empty() {
            self.heads.push(line);
        }
    }

    /// The byte range of each column. Cells of shorter rows go into the columns below which they stand.
    fn fill(&mut self) -> Vec<[usize; 2]> {
        // If the rate of the coarsest level is left blank, its row is shorter than the others.
        let width = self.rows.iter().map(|(_, cells)| cells.len()).max().unwrap_or(0);
        let mut spans = vec![[usize::MAX, 0]; width];
        for (line, cells) in self.rows.iter().filter(|(_, cells)| cells.len() == width) {
            for (found, cell) in spans.iter_mut().zip(cells) {
                let [start, end] = span(line, cell);
                *found = [found[0].min(start), found[1].max(end)];
            }
        }
        for (line, cells) in self.rows.iter_mut().filter(|(_, cells)| self.separator.is_none() && cells.len() < width) {
            *cells = below(line, cells, &spans).unwrap_or_else(|| cells.clone());
        }
        spans
    }

    /// The cells of a column.
    fn column(&self, k: usize) -> Vec<&'t str> {
        self.rows.iter().map(|(_, cells)| cells.get(k).copied().unwrap_or_default()).collect()
    }

    /// The nearest line above the rows that has a name for each column; a comment only if no other line has.
    fn names(&self, spans: &[[usize; 2]]) -> Option<Vec<&'t str>> {
        let rates: Vec<bool> = (0..spans.len()).map(|k| are_rates(&self.column(k))).collect();
        let index = usize::from(counts_rows(&self.column(0)));
        // Rates and an index may have no names.
        let masks = [(0, false), (0, true), (index, false), (index, true)]
            .map(|(first, without)| (first..spans.len()).filter(|k| !(without && rates[*k])).collect::<Vec<usize>>());
        let mut below: Option<&str> = None;
        let heads = self.heads.iter().rev().map(|line| (line, false));
        for (line, is_comment) in heads.chain(self.comments.iter().rev().map(|line| (line, true))) {
            // A comment may use another separator than the rows: `# h, L2` above columns of blanks.
            let others = [Some(','), Some(';'), Some('\t')];
            for separator in others.iter().filter(|_| is_comment).chain([&self.separator]) {
                let mut cells = split(line, *separator);
                let is_finite = |cell: &&str| number(cell, false).is_some_and(|number| number.value.is_finite());
                let is_of_types = !is_comment && split(line, None).iter().all(is_type);
                if is_of_types || cells.iter().any(is_finite) {
                    continue;
                }
                if let ([only], true, false) = (&cells[..], spans.len() > 1, is_comment) {
                    below = Some(only);
                } else if let Some(index) = below.filter(|_| cells.len() + 1 == spans.len() && !is_comment) {
                    cells.insert(0, index);
                }
                // If blanks separate, words may be parts of names: then only names of rates may stand above rates.
                let is_rate = |(cell, is_rate): (&&str, &bool)| !is_rate || Word::of(cell) == Word::Rate;
                let is_sure = || separator.is_some() || cells.iter().zip(&rates).all(is_rate);
                let fits = |mask: &&Vec<usize>| cells.len() == mask.len() && (mask.len() < rates.len() || is_sure());
                let above = |mask: &Vec<usize>| above(line, &cells, spans, mask);
                let mut names = vec![&line[..0]; spans.len()];
                if let Some(mask) = masks.iter().find(fits) {
                    mask.iter().zip(cells).for_each(|(k, cell)| names[*k] = cell);
                } else if let Some(above) =
                    masks.iter().filter(|_| separator.is_none() && cells.len() > 1).find_map(above)
                {
                    names = above;
                } else if cells.len() == spans.len() {
                    names = cells;
                } else {
                    continue;
                }
                return Some(names);
            }
        }
        None
    }
}

/// Each cell in the only column that it overlaps, and empty ones between; `None` if a cell stands elsewhere.
fn below<'t>(line: &'t str, cells: &[&'t str], spans: &[[usize; 2]]) -> Option<Vec<&'t str>> {
    let empty = |span: &[usize; 2]| line.get(span[0]..span[0]).unwrap_or(&line[line.len()..]);
    let mut filled: Vec<&str> = spans.iter().map(empty).collect();
    for cell in cells {
        let [start, end] = span(line, cell);
        let mut below = (0..spans.len()).filter(|k| start < spans[*k][1] && spans[*k][0] < end);
        let only = below.next().filter(|k| below.next().is_none() && filled[*k].is_empty())?;
        filled[only] = cell;
    }
    Some(filled)
}

/// Names of several words: each word belongs to the nearest column of `named`; all of these except the first need one.
fn above<'t>(line: &'t str, words: &[&'t str], spans: &[[usize; 2]], named: &[usize]) -> Option<Vec<&'t str>> {
    let mut names = vec![&line[..0]; spans.len()];
    for word in words {
        let [start, end] = span(line, word);
        let distance = |k: &&usize| spans[**k][0].saturating_sub(end).max(start.saturating_sub(spans[**k][1]));
        let name = &mut names[*named.iter().min_by_key(distance)?];
        let from = if name.is_empty() { start } else { span(line, name)[0] };
        *name = cell(line.get(from..end)?);
    }
    named.iter().all(|k| *k == 0 || !names[*k].is_empty()).then_some(names)
}

/// Whether columns stand as rows: words before them and none above, two rows of numbers, or the steps in the first one.
fn is_turned(rows: &[Vec<&str>]) -> bool {
    // Numbers with a constant ratio are those of a step.
    let is_even = |cells: &[&str]| {
        let numbers: Vec<f64> = cells.iter().filter_map(|cell| Some(number(cell, true)?.value)).collect();
        numbers.len() > 2 && numbers.windows(3).all(|three| (three[0] * three[2] / three[1].powi(2) - 1.0).abs() < 1e-3)
    };
    let firsts: Vec<&str> = rows.iter().filter_map(|row| row.first().copied()).collect();
    rows.len() > 1
        && rows[0].len() > 2
        && rows.iter().all(|row| row.len() == rows[0].len())
        && (rows.len() == 2
            || firsts.iter().all(|cell| number(cell, true).is_none())
            || (is_even(&rows[0]) && !is_even(&firsts)))
}

/// Whether a column is 0, 1, 2, ... or 1, 2, 3, ..., from above or from below.
pub(super) fn counts_rows(cells: &[&str]) -> bool {
    let Ok(values) = cells.iter().map(|cell| cell.parse::<i64>()).collect::<Result<Vec<i64>, _>>() else {
        return false;
    };
    let [first, .., last] = values[..] else { return matches!(values[..], [0 | 1]) };
    matches!(first.min(last), 0 | 1) && values.windows(2).all(|two| two[1] - two[0] == (last - first).signum())
}

/// Whether a nameless column may hold rates: a dash in the first or last row, and few decimals in all others.
fn are_rates(cells: &[&str]) -> bool {
    let is_rate = |text: &&&str| {
        text.split_once('.').is_some_and(|(_, decimals)| decimals.len() < 5 && !text.contains(['e', 'E']))
    };
    let ends = [cells[0], cells[cells.len() - 1]].iter().any(|text| is_dash(text) && !text.is_empty());
    ends && cells.iter().filter(is_rate).count() + 1 == cells.len()
}

/// The names of `# 1: cells`, `# 2: dofs`, ...; `None` if their number is not that of the columns.
fn numbered<'t>(comments: &[&'t str], width: usize) -> Option<Vec<&'t str>> {
    let pairs = comments.iter().filter_map(|line| line.split_once(':'));
    let numbered = pairs.filter_map(|(number, name)| Some((number.trim().parse::<usize>().ok()?, cell(name))));
    let (numbers, names): (Vec<usize>, Vec<&str>) = numbered.unzip();
    numbers.into_iter().eq(1..=width).then_some(names)
}
