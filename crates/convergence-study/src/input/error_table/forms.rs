//! Numbers that several words or lines write: `8.23 × 10⁻³`, `1.6 %`, MATLAB's `1.0e-03 *`.

/// Digits and signs above the line, and those that they are, in the same order.
const RAISED: [&str; 2] = ["⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+"];

/// The digit or sign that one above the line is.
fn lowered(raised: char) -> Option<char> {
    let place = RAISED[0].chars().position(|known| known == raised)?;
    RAISED[1].chars().nth(place)
}

/// A text in which each of these numbers is one word.
pub(super) fn joined(text: &str) -> String {
    let text = with_exponents(text);
    with_factors(&text)
        .split_inclusive('\n')
        .map(with_percent)
        .collect()
}

/// `× 10⁻³` as an exponent.
fn with_exponents(text: &str) -> String {
    let mut parts = text.split("10");
    let mut joined = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c| lowered(c).is_none());
        let (power, rest) = part.split_at(end.unwrap_or(part.len()));
        let before = joined.trim_end().strip_suffix(['×', '·', '⋅']);
        let factor = before
            .map(str::trim_end)
            .filter(|before| !power.is_empty() && before.ends_with(|c: char| c.is_ascii_digit()));
        match factor.map(str::len) {
            Some(length) => {
                joined.truncate(length);
                joined.push('e');
                joined.extend(power.chars().filter_map(lowered));
                joined += rest;
            }
            None => joined = joined + "10" + part,
        }
    }
    joined
}

/// The numbers of a matrix with the factor that MATLAB writes on a line above it.
fn with_factors(text: &str) -> String {
    let mut exponent = None;
    let mut scaled = String::new();
    for line in text.split_inclusive('\n') {
        let factor = line.trim().strip_suffix('*').map(str::trim_end);
        let power = factor.and_then(|factor| factor.strip_prefix("1.0e"));
        if let Some(power) = power.filter(|power| power.parse::<i32>().is_ok()) {
            exponent = Some(power);
            scaled.push('\n');
            continue;
        }
        let is_number = |word: &str| word.parse::<f64>().is_ok() && !word.contains(['e', 'E']);
        let is_row = line.split_whitespace().all(is_number);
        match exponent {
            Some(power) if is_row => {
                let words = line.split_whitespace();
                let words: Vec<String> = words.map(|word| format!("{word}e{power}")).collect();
                scaled += &(words.join(" ") + "\n");
            }
            _ => {
                exponent = exponent.filter(|_| line.trim().is_empty());
                scaled += line;
            }
        }
    }
    scaled
}

/// A line in which the sign of per cent stands at its number: before the end, a separator or another
/// number. Elsewhere it begins a comment.
fn with_percent(line: &str) -> String {
    let mut parts = line.split(" %");
    let mut joined = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let behind = part.trim_start();
        let ends = behind.is_empty() || behind.starts_with(['|', ',', ';', '&', '\\']);
        let goes_on =
            behind.starts_with(|c: char| c.is_ascii_digit()) && line.trim_end().ends_with('%');
        let is_unit = joined.ends_with(|c: char| c.is_ascii_digit()) && (ends || goes_on);
        joined += if is_unit { "%" } else { " %" };
        joined += part;
    }
    joined
}
