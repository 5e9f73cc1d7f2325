//! Numbers as tables write them: `1/8`, `1.0D-01`, `2^-3`, `$1.2 \times 10^{-3}$`, `1.2 × 10⁻³`,
//! `0,1`, `32x32`.

/// What tables write if there is no number: the rate of the coarsest level.
const DASHES: [&str; 14] = [
    "", "-", "--", "---", "–", "—", "n/a", "n.a.", "na", "none", "null", "nil", "missing", "(-)",
];

/// Markup around a number that does not change it, and what it stands for.
const DRESS: &str =
    "**=^ \u{2212}=- \\times=* \\cdot=* ×=* ·=* \\,= \\num= \\textbf= \\mathbf= \\bf= {}=";

/// A number, and the digits it is printed with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Number {
    pub(super) value: f64,
    /// `None` for fractions and powers, which are exact.
    place: Option<Place>,
}

impl Number {
    /// A number without rounding.
    pub(super) fn exact(value: f64) -> Self {
        Self { value, place: None }
    }
}

/// The last printed place of a number.
#[derive(Debug, Clone, Copy)]
struct Place {
    decimals: i32,
    /// The power of ten after the decimals, if there is one.
    exponent: Option<i32>,
}

/// Half a unit of the last printed place of each number of a column; 0 for whole and for exact
/// numbers.
///
/// The row with the most decimals shows the place to which all are printed: a program that prints
/// 0.25 and 0.0625 omits zeros.
pub(super) fn halves(column: &[Option<Number>]) -> Vec<f64> {
    let mut plain_decimals = 0;
    let mut scaled_decimals = 0;
    for place in column.iter().flatten().filter_map(|number| number.place) {
        let decimals = match place.exponent {
            None => &mut plain_decimals,
            Some(_) => &mut scaled_decimals,
        };
        *decimals = place.decimals.max(*decimals);
    }
    let mut halves = vec![0.0; column.len()];
    for (half, number) in halves.iter_mut().zip(column) {
        let Some(Number {
            value,
            place: Some(place),
        }) = number
        else {
            continue;
        };
        match place.exponent {
            None if plain_decimals > 0 => *half = 0.5 * 10f64.powi(-plain_decimals),
            Some(exponent) if *value != 0.0 => {
                *half = 0.5 * 10f64.powi(exponent - scaled_decimals);
            }
            _ => {}
        }
    }
    halves
}

/// The unit that stands behind each number of a column, as in `0.5 µm` and `16%`.
pub(super) fn common_unit<'t>(cells: &[&'t str]) -> Option<&'t str> {
    let numbers = cells
        .iter()
        .filter(|cell| cell.contains(|c: char| c.is_ascii_digit()));
    let mut units = numbers.map(|cell| unit(cell));
    let first = units.next()??;
    units.all(|unit| unit == Some(first)).then_some(first)
}

/// The unit behind the number of a cell.
fn unit(cell: &str) -> Option<&str> {
    let end = cell.rfind(|c: char| c.is_ascii_digit())? + 1;
    let (number, unit) = cell.split_at(end);
    let unit = unit.trim_start();
    let is_unit = unit
        .trim_start_matches('\\')
        .starts_with(|c: char| c.is_alphabetic() || c == '%')
        && !unit.contains(char::is_whitespace);
    (is_unit && real(number.trim_start_matches('$')).is_some()).then_some(unit)
}

/// Whether a cell says that it has no number.
pub(super) fn is_dash(cell: &str) -> bool {
    let plain = cell.trim_matches(['$', '{', '}']).to_lowercase();
    DASHES.contains(&plain.as_str())
}

/// The value of a cell; `None` if it is not a number.
///
/// * `decimal_comma`: whether `0,1` may be a number, because commas do not separate cells. `1,024`
///   is refused: it may be 1024.
pub(super) fn number(cell: &str, decimal_comma: bool) -> Option<Number> {
    if let Some(number) = real(cell).or_else(|| {
        cell.strip_prefix('(')
            .and_then(|cell| real(cell.strip_suffix(')')?))
    }) {
        return Some(number);
    }
    if is_no_number(cell) {
        return None;
    }
    let edges = cell.trim_matches('$').replace("\\times", "×");
    let mut edges = edges.split(['x', '×']).map(str::trim);
    let edge = edges.next().unwrap_or_default();
    if edge.bytes().all(|c| c.is_ascii_digit()) && edges.all(|other| other == edge) {
        return real(edge);
    }
    let mut text = without_superscripts(cell.trim_matches(|c| "`_".contains(c)));
    if let Some(bold) = text
        .strip_prefix("**")
        .and_then(|text| text.strip_suffix("**"))
    {
        text = bold.to_owned();
    }
    let marks = DRESS
        .split_whitespace()
        .filter_map(|mark| mark.split_once('='));
    text = marks.fold(
        text.replace("\\frac{", "").replace("}{", "/"),
        |text, (from, to)| text.replace(from, to),
    );
    text.retain(|c| !c.is_whitespace() && !matches!(c, '$' | '{' | '}' | '\\'));
    match text.split_once(',') {
        // Three digits after a comma, and no zero before it, may be thousands.
        Some((whole, rest)) if rest.len() == 3 && !matches!(whole, "0" | "-0") => None,
        Some((whole, rest)) if decimal_comma => value(&format!("{whole}.{rest}")),
        Some(_) => None,
        None => value(&text),
    }
}

/// `10⁻³` as `10^-3`.
fn without_superscripts(cell: &str) -> String {
    const SUPERSCRIPTS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻";
    let mut plain = String::new();
    let mut is_above = false;
    for c in cell.chars() {
        let place = SUPERSCRIPTS.chars().position(|above| above == c);
        if place.is_some() && !is_above {
            plain.push('^');
        }
        is_above = place.is_some();
        plain.push(place.map_or(c, |place| char::from(b"0123456789-"[place])));
    }
    plain
}

/// `1,000,000` without the commas of its thousands.
pub(super) fn without_thousands(cell: &str) -> Option<String> {
    let (whole, decimals) = cell.split_once('.').unwrap_or((cell, "0"));
    let mut groups = whole.trim_start_matches(['+', '-']).split(',');
    let first = groups.next()?;
    let are_digits = |text: &str| text.bytes().all(|c| c.is_ascii_digit());
    let are_thousands = (1..=3).contains(&first.len())
        && are_digits(first)
        && are_digits(decimals)
        && whole.contains(',')
        && groups.all(|group| group.len() == 3 && are_digits(group));
    are_thousands.then(|| cell.replace(',', ""))
}

/// Whether a cell, which is not a number as it stands, is a word or several numbers. A text may have
/// a hundred thousand words: they are recognised without more work.
fn is_no_number(cell: &str) -> bool {
    let words = cell.split_whitespace();
    cell.is_empty()
        || cell.starts_with(char::is_alphabetic)
        || words.filter(|word| word.parse::<f64>().is_ok()).count() > 1
}

/// A whole number, perhaps in parentheses.
fn integer(text: &str) -> Option<i32> {
    text.trim_matches(['(', ')']).parse().ok()
}

/// `a/b`, `a*10^n`, `a^n` or `a`. Other products are refused: Fortran writes `2*0.1` for the number
/// 0.1 twice.
fn value(text: &str) -> Option<Number> {
    if let Some((above, below)) = text
        .split_once('/')
        .filter(|(_, below)| !below.contains('/'))
    {
        return Some(Number::exact(value(above)?.value / value(below)?.value));
    }
    if let Some((factor, power)) = text.split_once('*') {
        // Read as one number, because a product is rounded once more.
        return real(&format!(
            "{factor}e{}",
            integer(power.strip_prefix("10^")?)?
        ));
    }
    match text.split_once('^') {
        Some(("10", exponent)) => {
            let number = real(&format!("1e{}", integer(exponent)?))?;
            Some(Number::exact(number.value))
        }
        Some((base, exponent)) => Some(Number::exact(real(base)?.value.powi(integer(exponent)?))),
        None => real(text),
    }
}

/// A number of C or Fortran; Fortran's exponents begin with D or, with three digits, with their
/// sign.
fn real(text: &str) -> Option<Number> {
    if let Some(Scaled { mantissa, exponent }) = split_exponent(text) {
        let exponent: i32 = exponent.parse().ok()?;
        return Some(Number {
            value: format!("{mantissa}e{exponent}").parse().ok()?,
            place: Some(Place {
                decimals: decimals(mantissa),
                exponent: Some(exponent),
            }),
        });
    }
    let value: f64 = text.parse().ok()?;
    Some(Number {
        value,
        place: value.is_finite().then_some(Place {
            decimals: decimals(text),
            exponent: None,
        }),
    })
}

/// A number as printed, before and after the mark of its exponent.
struct Scaled<'t> {
    mantissa: &'t str,
    exponent: &'t str,
}

/// The parts of a number with an exponent; `None` without one.
fn split_exponent(text: &str) -> Option<Scaled<'_>> {
    let (mantissa, exponent) = match text.split_once(['e', 'E', 'D', 'd', 'Q', 'q']) {
        Some(parts) => parts,
        // Three digits after a sign: Fortran has no room for the letter.
        None => {
            let (mantissa, exponent) = text.split_at_checked(text.len().checked_sub(4)?)?;
            let digits = exponent.strip_prefix(['+', '-'])?;
            if !digits.bytes().all(|c| c.is_ascii_digit()) {
                return None;
            }
            (mantissa, exponent)
        }
    };
    mantissa
        .ends_with(|c: char| c.is_ascii_digit() || c == '.')
        .then_some(Scaled { mantissa, exponent })
}

/// The number of digits after the decimal point.
fn decimals(text: &str) -> i32 {
    text.split_once('.')
        .map_or(0, |(_, decimals)| decimals.len() as i32)
}

/// Whether a column is 0, 1, 2, ... or 1, 2, 3, ..., from above or from below; levels may begin with
/// any number.
pub(super) fn counts_rows(cells: &[&str], are_levels: bool) -> bool {
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
    first != last
        && (are_levels || matches!(first.min(last), 0 | 1))
        && values
            .windows(2)
            .all(|two| two[1] - two[0] == (last - first).signum())
}
