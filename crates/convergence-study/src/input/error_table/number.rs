//! Numbers as tables have them: `1/8`, `1.0D-01`, `2^-3`, `$1.2 \times 10^{-3}$`, `0,1`.

/// Commands of LaTeX that dress a number and do not change it.
const DRESS: [&str; 8] = ["\\num", "\\textbf", "\\mathbf", "\\bf", "\\bfseries", "\\displaystyle", "\\left", "\\right"];

/// What stands where there is no number: the rate of the coarsest level.
const DASHES: [&str; 10] = ["", "-", "--", "---", "–", "—", "n/a", "N/A", "NA", "None"];

/// Whether a cell says that it has no number.
pub(super) fn is_dash(cell: &str) -> bool {
    !cell.starts_with(|c: char| c.is_ascii_digit()) && DASHES.contains(&cell.trim_matches('$'))
}

/// The value of a cell; `None` where it is no number.
///
/// * `decimal_comma`: whether `0,1` may be a number, for the comma does not separate cells. `1,024` is none: it may be 1024.
pub(super) fn number(cell: &str, decimal_comma: bool) -> Option<f64> {
    if let Ok(value) = cell.parse() {
        return Some(value);
    }
    // Most cells that are no numbers are words, of which there may be a hundred thousand.
    if cell.starts_with(char::is_alphabetic) {
        return None;
    }
    // Two numbers with a blank between them are not one.
    if cell.split_whitespace().filter(|word| word.parse::<f64>().is_ok()).count() > 1 {
        return None;
    }
    let plain = undressed(cell);
    if decimal_comma && plain.matches(',').count() == 1 && !looks_like_thousands(&plain) {
        return ratio(&plain.replace(',', "."));
    }
    ratio(&plain)
}

/// Whether a comma in a cell may separate thousands as well as decimals: three digits behind it, and no zero before it.
fn looks_like_thousands(cell: &str) -> bool {
    let (whole, rest) = cell.trim_start_matches(['+', '-']).split_once(',').unwrap_or((cell, ""));
    let digits = rest.chars().take_while(char::is_ascii_digit).count();
    digits == 3 && digits == rest.len() && !whole.trim_start_matches('0').is_empty()
}

/// The cell without markup of LaTeX and Markdown, with `*` for times, `^` for powers and `/` for fractions.
fn undressed(cell: &str) -> String {
    let emphasis = |text: &str| ["**", "__", "`", "*", "_"].into_iter().find(|mark| text.starts_with(mark));
    let mut text = cell.trim();
    while let Some(inner) =
        emphasis(text).and_then(|mark| text.strip_prefix(mark)?.strip_suffix(mark)).filter(|inner| !inner.is_empty())
    {
        text = inner;
    }
    let mut text = text.replace("**", "^").replace('\u{2212}', "-");
    for (from, to) in [("\\times", "*"), ("\\cdot", "*"), ("×", "*"), ("·", "*"), ("\\,", ""), ("\\tfrac", "\\frac")]
    {
        text = text.replace(from, to);
    }
    text = text.replace("\\dfrac", "\\frac");
    if let Some((before, fraction)) = text.split_once("\\frac") {
        text = before.to_owned() + &fraction.replacen("}{", "/", 1);
    }
    for command in DRESS {
        text = text.replace(command, "");
    }
    text.retain(|c| !c.is_whitespace() && !matches!(c, '$' | '{' | '}'));
    text
}

/// `a`, or `a/b`.
fn ratio(text: &str) -> Option<f64> {
    match text.split_once('/') {
        Some((above, below)) => Some(scaled(above)? / scaled(below)?),
        None => scaled(text),
    }
}

/// `a`, or `a*10^n`. Any other product is none: Fortran writes `2*0.1` for the number 0.1 twice.
fn scaled(text: &str) -> Option<f64> {
    match text.split_once('*') {
        // Read as one number, for a product is rounded once more.
        Some((factor, ten)) => format!("{factor}e{}", integer(ten.strip_prefix("10^")?)?).parse().ok(),
        None => power(text),
    }
}

/// `a`, or `a^n` with a whole number n.
fn power(text: &str) -> Option<f64> {
    match text.split_once('^') {
        Some(("10", exponent)) => format!("1e{}", integer(exponent)?).parse().ok(),
        Some((base, exponent)) => Some(real(base)?.powi(integer(exponent)?)),
        None => real(text),
    }
}

fn integer(text: &str) -> Option<i32> {
    text.trim_start_matches('(').trim_end_matches(')').parse().ok()
}

/// A number of C or of Fortran, whose exponents begin with D or, where they have three digits, with their sign.
fn real(text: &str) -> Option<f64> {
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    let is_mantissa =
        |text: &str| text.parse::<f64>().is_ok() && text.ends_with(|c: char| c.is_ascii_digit() || c == '.');
    if let Some((mantissa, exponent)) = text.split_once(['D', 'd', 'Q', 'q']) {
        let exponent: i32 = exponent.parse().ok()?;
        return is_mantissa(mantissa).then(|| format!("{mantissa}e{exponent}").parse().ok()).flatten();
    }
    let (mantissa, exponent) =
        text.is_char_boundary(text.len().checked_sub(4)?).then(|| text.split_at(text.len() - 4))?;
    let is_exponent = exponent.starts_with(['+', '-']) && exponent[1..].chars().all(|c| c.is_ascii_digit());
    (is_exponent && is_mantissa(mantissa)).then(|| format!("{mantissa}e{exponent}").parse().ok()).flatten()
}
