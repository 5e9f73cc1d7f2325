//! Numbers behind names in the lines that a program prints: `max error = 1.5e-3`.

use crate::input::table::failed_run::says_failure;

/// What the last line with a name has behind it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NamedText {
    pub(super) name: String,
    /// The number; `None` if it is none.
    pub(super) number: Option<f64>,
    /// As it was printed.
    pub(super) text: String,
}

/// Between a name and its number.
pub(super) const MARKS: [char; 2] = ['=', ':'];

/// Levels of a log before a name.
const LEVELS: [&str; 4] = ["INFO", "DEBUG", "WARNING", "ERROR"];

/// Notes what a line has behind each of some names, as the last of what is found, and says of how
/// many; the last line with a name counts.
pub(super) fn note(line: &str, names: &[String], found: &mut Vec<NamedText>) -> usize {
    if !has_mark(line) {
        return 0;
    }
    let mut noted = 0;
    for name in names {
        if let Some([before, behind]) = around(line, name) {
            let has_failed = says_failure(before);
            found.retain(|known| known.name != *name);
            found.push(NamedText {
                name: name.clone(),
                number: leading_number(behind).filter(|_| !has_failed),
                text: if has_failed { line } else { behind }.to_owned(),
            });
            noted += 1;
        }
    }
    noted
}

/// Whether a line has one of the [`MARKS`]. Logs are long, and two searches for a byte are faster
/// than one for either.
pub(super) fn has_mark(line: &str) -> bool {
    MARKS.into_iter().any(|mark| line.contains(mark))
}

/// The text before the last place of a name in a line, and the text behind its `=` or `:`.
fn around<'l>(line: &'l str, name: &str) -> Option<[&'l str; 2]> {
    let places = line.match_indices(name);
    let texts = places.filter_map(|(start, _)| {
        let before = &line[..start];
        let rest = line[start + name.len()..].trim_start_matches(['"', '\'']);
        let marked = rest.trim_start().strip_prefix(MARKS)?;
        let behind = marked.trim_start_matches(MARKS).trim();
        begins_name(before).then_some([before, behind])
    });
    texts.last()
}

/// Whether a name may begin behind this text: `max error` is another name than `error`.
fn begins_name(before: &str) -> bool {
    const OPENINGS: &str = ",;|:=([{\"'";
    const BULLETS: &str = ">]}*#-•";
    let Some(last) = before.chars().next_back() else {
        return true;
    };
    if !last.is_whitespace() {
        return OPENINGS.contains(last);
    }
    let text = before.trim_end();
    let word = text.rsplit(char::is_whitespace).next().unwrap_or_default();
    let is_gap = before.len() > text.len() + 1 || last == '\t';
    let is_end = text.ends_with(|c| OPENINGS.contains(c) || BULLETS.contains(c));
    text.is_empty() || is_gap || is_end || LEVELS.contains(&word) || number(word).is_some()
}

/// The number that a text begins with, if what is behind it does not change it.
fn leading_number(text: &str) -> Option<f64> {
    let is_end = |(k, c): &(usize, char)| {
        let is_digit = |rest: &str| rest.starts_with(|c: char| c.is_ascii_digit());
        c.is_whitespace() || ";|}".contains(*c) || *c == ',' && !is_digit(&text[k + 1..])
    };
    let end = text.char_indices().find(is_end);
    let (token, rest) = text.split_at(end.map_or(text.len(), |(end, _)| end));
    let rest = rest.trim_start();
    let pairs = [('[', ']'), ('(', ')'), ('"', '"'), ('\'', '\'')];
    let mut inner = pairs
        .iter()
        .filter_map(|(open, close)| token.strip_prefix(*open)?.strip_suffix(*close));
    // Brackets around a name and its number end behind the number, as does a sentence.
    let plain = token.trim_end_matches([')', ']', '.']);
    let has_more = makes_another(rest) || has_thousands(token, rest);
    number(inner.next().unwrap_or(plain)).filter(|_| !has_more && !is_denial(rest))
}

/// Whether a text goes on with thousands of the number before it: `1 234,5`.
fn has_thousands(token: &str, rest: &str) -> bool {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let begins = token.trim_start_matches(['+', '-']);
    (1..=3).contains(&begins.len()) && digits(begins) == begins.len() && digits(rest) == 3 && {
        let behind = rest[3..].chars().next();
        !behind.is_some_and(char::is_whitespace) || digits(rest[3..].trim_start()) > 0
    }
}

/// Whether what is behind a number makes another one of it: a factor, an exponent, a term, an
/// imaginary part.
fn makes_another(rest: &str) -> bool {
    const FACTORS: [char; 6] = ['×', '*', '·', '^', '\\', '±'];
    let is_number = |word: Option<&str>| word.is_some_and(|word| number(word).is_some());
    let mut words = rest.split_whitespace();
    let first = words.next().unwrap_or_default();
    let second = words.next().map(|word| word.trim_end_matches(['i', 'j']));
    let has_operand = ["+", "-", "/"].contains(&first) && is_number(second);
    let is_imaginary = is_number(first.strip_suffix(['i', 'j']));
    // `d2 = 4` is another name.
    let is_name = rest[first.len()..].trim_start().starts_with(MARKS);
    let exponent = first
        .strip_prefix(['e', 'E', 'd', 'D'])
        .filter(|_| !is_name);
    let exponent = match exponent {
        Some("") => second,
        other => other,
    };
    rest.starts_with(FACTORS)
        || ["x 10", "10^", "10**", "+/-"]
            .iter()
            .any(|start| rest.starts_with(start))
        || exponent.is_some_and(|exponent| exponent.parse::<i32>().is_ok())
        || has_operand
        || is_imaginary
}

/// Whether the words behind a number say that it is of no use: `(not converged)`, `FAILED`.
fn is_denial(words: &str) -> bool {
    const DENIALS: [&str; 4] = ["diverged", "failed", "not converged", "unconverged"];
    let words = words.trim_matches(|c: char| c.is_whitespace() || ",;()[]<->".contains(c));
    if says_failure(words) {
        return true;
    }
    let words = words.to_lowercase();
    let mut denials = DENIALS.iter();
    // `failed steps = 0` is another name.
    denials.any(|denial| words.starts_with(denial)) && !words.contains(MARKS)
}

/// A finite number of C or Fortran.
fn number(token: &str) -> Option<f64> {
    let digits = token.replace(['d', 'D'], "e");
    let number = digits.parse().ok().or_else(|| {
        // Three digits of an exponent leave Fortran no room for its letter: `1.5-101`.
        let (mantissa, exponent) = digits.split_at_checked(digits.len().checked_sub(4)?)?;
        let is_exponent = exponent.starts_with(['+', '-']) && mantissa.contains('.');
        let number = is_exponent.then(|| format!("{mantissa}e{exponent}"));
        number?.parse().ok()
    });
    number.filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a line has behind `L2`: a number, no number, or no such name.
    fn read(line: &str) -> Option<Option<f64>> {
        let mut found = vec![];
        note(line, &["L2".to_owned()], &mut found);
        found.pop().map(|one| one.number)
    }

    #[test]
    fn a_number_stands_behind_its_name() {
        for line in include_str!("lines/numbers.txt").lines() {
            assert_eq!(read(line), Some(Some(1.5e-3)), "{line}");
        }
        assert_eq!(read("L2 = 1.5-101"), Some(Some(1.5e-101)));
        assert_eq!(read("L2 = -2"), Some(Some(-2.0)));
    }

    #[test]
    fn another_name_is_another_number() {
        for line in include_str!("lines/other_names.txt").lines() {
            assert_eq!(read(line), None, "{line}");
        }
    }

    #[test]
    fn what_is_no_number_is_not_the_number_of_an_earlier_line() {
        for text in include_str!("lines/no_numbers.txt").lines() {
            let mut found = vec![];
            for line in ["L2 = 1.5e-3", &format!("L2 = {text}")] {
                note(line, &["L2".to_owned()], &mut found);
            }
            assert_eq!(found.len(), 1, "{text}");
            assert_eq!(found[0].number, None, "{text}");
        }
        for before in [
            "not converged: ",
            "no convergence after 9 iterations, ",
            "diverged, ",
        ] {
            let line = format!("{before}L2 = 1.5e-3");
            assert_eq!(read(&line), Some(None), "{line}");
        }
    }
}
