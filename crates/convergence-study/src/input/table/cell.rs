//! A cell of a table: its text without markup, and the number that it holds.

/// A number as printed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Number {
    pub(super) value: f64,
    pub(super) is_whole: bool,
    /// Digits behind the point; `None` of a number without rounding.
    pub(super) decimals: Option<i32>,
    /// The power of ten behind the digits, if one is printed.
    pub(super) exponent: Option<i32>,
    /// The counts along all edges, where the cell is `16x32`: the value is the first.
    pub(super) edges: Vec<f64>,
}

impl Number {
    /// A number without rounding.
    fn exact(value: f64) -> Self {
        Self {
            value,
            is_whole: value.fract() == 0.0,
            decimals: None,
            exponent: None,
            edges: vec![],
        }
    }

    /// Half a unit of the last printed place.
    pub(super) fn half(&self) -> f64 {
        let power = self.exponent.unwrap_or(0);
        self.decimals
            .map_or(0.0, |decimals| 0.5 * 10f64.powi(power - decimals))
    }
}

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    pub(super) text: String,
    pub(super) number: Option<Number>,
    /// Its line in the text, from 1; 0 without one.
    pub(super) line: usize,
}

/// How the numbers of a table are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Style {
    /// `0.1`.
    Plain,
    /// `0,1`.
    DecimalCommas,
    /// `1,024`.
    Thousands,
}

/// LaTeX commands around a number or a name.
const COMMANDS: &str = r"\num{ \text{ \textrm{ \textbf{ \mathrm{ \mathbf{ \operatorname{";
/// Markup that stands for nothing.
const MARKS: &str = r"\hline \toprule \midrule \bottomrule \\ ** ` \, \; \! $";
/// What stands in a cell where a number failed or is absent, in small letters.
const FAILURES: &str = "- -- --- – — / ? n/a none null fail failed diverged divergent blow-up blowup overflow inf +inf -inf infinity -infinity";
/// Beginnings of words of a failure.
const FAILING: &str =
    "nan -nan +nan 1.# -1.# ** ## -- diverge fail abort blew crash kill timeout unstable ∞ -∞";

/// A text without markup and with single blanks.
pub(super) fn plain(text: &str) -> String {
    let mut text = without_spans(&text.replace('\u{2212}', "-"));
    let has_markup = text.contains(['\\', '*', '`', '$']);
    for command in COMMANDS.split(' ').filter(|_| has_markup) {
        while let Some(start) = text.find(command) {
            text.replace_range(start..start + command.len(), "");
            if let Some(end) = text[start..].find('}') {
                text.remove(start + end);
            }
        }
    }
    for mark in MARKS.split(' ').filter(|_| has_markup) {
        text = text.replace(mark, " ");
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A text without `\multicolumn{3}{|c|}{` and its closing brace: what stands below a name without
/// one of its own must be rates.
fn without_spans(text: &str) -> String {
    let mut parts = text.split(r"\multicolumn{");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let content = part.splitn(3, "}{").nth(2).unwrap_or_default();
        let (before, behind) = content.rsplit_once('}').unwrap_or((content, ""));
        text + before + behind
    })
}

/// The unit that all numbers of a column end in: `%`, or a short word.
pub(super) fn unit<'c>(mut cells: impl Iterator<Item = &'c str>) -> &'c str {
    /// Most letters of a unit.
    const LONGEST: usize = 4;
    let unit = cells.next().map_or("", behind_digits);
    let is_word =
        |word: &str| word.chars().all(char::is_alphabetic) && word.chars().count() <= LONGEST;
    let word = unit.trim_start();
    let is_share = ["%", r"\%"].contains(&word);
    let is_unit = is_share || unit.starts_with(' ') && is_word(word) && !is_failure(word);
    if is_unit && cells.all(|cell| behind_digits(cell) == unit) {
        unit
    } else {
        ""
    }
}

fn behind_digits(cell: &str) -> &str {
    let last = cell.rfind(|c: char| c.is_ascii_digit());
    &cell[last.map_or(0, |last| last + 1)..]
}

impl Style {
    /// The style that the cells of a table share.
    pub(super) fn of<'c>(cells: impl Iterator<Item = &'c str> + Clone) -> Self {
        let has_comma = |cell: &&str| {
            let behind = cell.split_once(',').map_or("", |(_, behind)| behind);
            behind.starts_with(|c: char| c.is_ascii_digit())
        };
        let numbers: Vec<String> = cells.clone().filter(has_comma).map(plain).collect();
        let has_point = || cells.clone().any(|cell| cell.contains('.'));
        let is_decimal = |cell: &String| cell.matches(',').count() == 1;
        let may_be_decimal = numbers.iter().all(is_decimal) && !has_point();
        let begins_with_zero = numbers.iter().any(|cell| cell.starts_with("0,"));
        if numbers.is_empty() {
            Self::Plain
        } else if numbers.iter().all(|cell| are_thousands(cell))
            && !(may_be_decimal && begins_with_zero)
        {
            Self::Thousands
        } else if may_be_decimal {
            Self::DecimalCommas
        } else {
            Self::Plain
        }
    }
}

fn are_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit())
}

fn are_thousands(cell: &str) -> bool {
    let mut groups = cell.split(',');
    let first = groups.next().unwrap_or_default();
    first.len() < 4 && are_digits(first) && groups.all(|one| one.len() == 3 && are_digits(one))
}

impl Cell {
    pub(super) fn new(raw: &str, style: Style) -> Self {
        let text = plain(raw);
        let number = real(&text, style).or_else(|| edges(&text));
        Self {
            text,
            number,
            line: 0,
        }
    }

    /// A number without rounding.
    pub(super) fn exact(value: f64) -> Self {
        Self {
            line: 0,
            text: value.to_string(),
            number: value.is_finite().then(|| Number::exact(value)),
        }
    }

    pub(super) fn value(&self) -> Option<f64> {
        self.number.as_ref().map(|number| number.value)
    }

    pub(super) fn is_whole(&self) -> bool {
        let number = self.number.as_ref();
        number.is_some_and(|number| number.is_whole)
    }

    /// Whether the cell is a grid such as `16x32`.
    pub(super) fn is_grid(&self) -> bool {
        let number = self.number.as_ref();
        number.is_some_and(|number| !number.edges.is_empty())
    }

    /// Whether the cell is empty or a dash, as where there is no rate.
    pub(super) fn is_blank(&self) -> bool {
        self.text.chars().all(|c| "-–—".contains(c))
    }

    /// Whether the cell is no number, and has one in front of a sign or a blank, behind a sign or
    /// between marks: `0.1*`, `<0.1`, `[0.1]`, `(0.1+0j)`.
    pub(super) fn is_broken(&self) -> bool {
        /// Most marks up to the end of a number: `.5e-3` has two. It bounds the time that a cell of
        /// nothing but marks takes.
        const MARKS: usize = 64;
        let text = &self.text;
        let start = text.trim_start_matches(['<', '>', '~', '≈', '±', '+', '-', ' ']);
        let ends = start
            .match_indices(|c: char| !c.is_alphanumeric())
            .map(|(end, _)| end)
            .take(MARKS);
        self.number.is_none()
            && !is_failure(text)
            && (ends
                .chain([start.len()])
                .any(|end| is_number(&start[..end]))
                || has_marks_of_numbers_alone(text))
    }
}

/// Whether a text begins like a number, has a point or a sign, and nothing but what numbers have:
/// `(2,1)` and `3D` may be labels.
fn has_marks_of_numbers_alone(text: &str) -> bool {
    const BEGINNINGS: &str = "0123456789.([{'\"";
    const OTHERS: &str = "+-–eEdDfFjJ)]}";
    text.starts_with(|c| BEGINNINGS.contains(c))
        && text.contains(|c: char| c.is_ascii_digit())
        && text.contains(['.', '+', '-', '–'])
        && text
            .chars()
            .all(|c| BEGINNINGS.contains(c) || OTHERS.contains(c))
}

/// Whether a text says that there is no number.
pub(super) fn is_failure(text: &str) -> bool {
    let text = text.to_lowercase();
    let is_word = FAILURES.split(' ').any(|word| word == text);
    let begins = FAILING.split(' ').any(|start| text.starts_with(start));
    text.is_empty() || is_word || begins || text.chars().all(|c| c == '*' || c == '#')
}

/// Whether a text is a number.
pub(super) fn is_number(text: &str) -> bool {
    Cell::new(text, Style::Plain).number.is_some()
}

/// Whether the first word of a text is a number.
pub(super) fn first_is_number(text: &str) -> bool {
    let first = text.split_whitespace().next();
    first.is_some_and(|word| is_number(word.trim_end_matches([',', ';'])))
}

/// Whether a text is a number with a point or with a decimal comma.
pub(super) fn is_number_of_any_style(text: &str) -> bool {
    is_number(text) || text.contains(',') && real(&plain(text), Style::DecimalCommas).is_some()
}

/// Digits, a fraction of whole numbers, or digits with a power of ten behind `e`, `d` or `× 10`.
fn real(text: &str, style: Style) -> Option<Number> {
    if let Some((above, below)) = text.split_once('/')
        && are_digits(above)
        && are_digits(below)
    {
        return Some(Number::exact(
            above.parse::<f64>().ok()? / below.parse::<f64>().ok()?,
        ));
    }
    let (mantissa, exponent) = match (power_of_ten(text), text.split_once(['e', 'E', 'd', 'D'])) {
        (Some((mantissa, exponent)), _) => (mantissa, Some(exponent)),
        (None, Some((mantissa, exponent))) => (mantissa, Some(exponent.parse().ok()?)),
        (None, None) => (text, None),
    };
    let mantissa = match style {
        Style::DecimalCommas => mantissa.replace(',', "."),
        Style::Thousands if are_thousands(mantissa) => mantissa.replace(',', ""),
        _ => mantissa.to_owned(),
    };
    let digits = mantissa.strip_prefix(['+', '-']).unwrap_or(&mantissa);
    let (whole, places) = digits.split_once('.').unwrap_or((digits, ""));
    if !are_digits(&format!("{whole}{places}")) {
        return None;
    }
    let value = format!("{mantissa}e{}", exponent.unwrap_or(0))
        .parse()
        .ok()?;
    let is_whole = exponent.is_none() && !digits.contains('.');
    Some(Number {
        is_whole,
        decimals: (!is_whole).then_some(places.len() as i32),
        exponent,
        ..Number::exact(value)
    })
}

/// The digits and the power of `2.09 × 10⁻⁵`, `2.09 \cdot 10^{-5}`.
fn power_of_ten(text: &str) -> Option<(&str, i32)> {
    const ABOVE: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺";
    let mut marks = ["×", "·", "\\cdot", "\\times", "x"].into_iter();
    let (mantissa, power) = marks.find_map(|mark| text.split_once(mark))?;
    let power = power.trim_start().strip_prefix("10")?.trim_start();
    let digit = |c| ABOVE.chars().position(|above| above == c);
    let exponent = match power.strip_prefix('^') {
        Some(power) => power.trim_matches(['{', '}', '(', ')', ' ']).to_owned(),
        None => power
            .chars()
            .map(|c| Some(char::from(b"0123456789-+"[digit(c)?])))
            .collect::<Option<_>>()?,
    };
    Some((mantissa.trim(), exponent.parse().ok()?))
}

/// `16x32`, `16 × 16 × 16 (fine)`, `16²`.
fn edges(text: &str) -> Option<Number> {
    let base = ["²", "³", "^2", "^3"]
        .iter()
        .find_map(|end| text.strip_suffix(end));
    let mut counts: Vec<f64> = vec![];
    for part in base.unwrap_or(text).split(['x', '×']) {
        let part = part.trim();
        let end = part
            .find(|c: char| !c.is_ascii_digit())
            .unwrap_or(part.len());
        let (count, rest) = part.split_at(end);
        let goes_on = rest.starts_with(|c: char| c.is_alphanumeric() || "._^".contains(c));
        // `4×10-2` has lost its raised digits.
        let power = rest.trim_start().strip_prefix(['+', '-']).unwrap_or("");
        let has_power = power.starts_with(|c: char| c.is_ascii_digit());
        if goes_on || has_power || base.is_some() && !rest.is_empty() {
            return None;
        }
        counts.push(count.parse().ok()?);
    }
    (counts.len() > 1 || base.is_some()).then(|| Number {
        edges: counts.clone(),
        ..Number::exact(counts[0])
    })
}
