//! Numbers for reports: a maximum that keeps NaN, and formats whose bytes must stay the same.

use crate::interval::Interval;

/// Significant digits of a number in a committed file: more than anyone compares, fewer than two
/// machines agree on.
const DIGITS: usize = 6;

/// Decimal place beyond which the digits of quantities of order 1 are their rounding errors.
const NOISE_PLACE: i32 = 15;

/// Decimal places of a rate in a committed file: a relative change of an error by 1e-5 does not
/// show.
pub const RATE_PLACES: usize = 4;

/// Width of an interval above which its middle is not shown as a rate: it would look known.
pub const WIDEST_INTERVAL: f64 = 0.5;

/// The larger of two numbers; NaN if one of them is, unlike `f64::max`.
pub fn max_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// The smaller of two numbers; NaN if one of them is.
pub fn min_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || a <= b { a } else { b }
}

/// The number that a committed file holds for `value`: six significant digits, none of them beyond
/// 1e-15 except the first.
///
/// A difference of quantities of order 1 carries rounding errors of that size, and two mathematical
/// libraries need not make the same ones: 4.4541e-8 is kept, 4.4413e-15 becomes 4e-15. Numbers that
/// are not finite stay as they are.
pub fn committed(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let place = value.abs().log10().floor() as i32;
    let digits = (place + NOISE_PLACE + 1).clamp(1, DIGITS as i32) as usize;
    significant(value, digits)
}

/// A number rounded to so many significant digits, at least one.
pub fn significant(value: f64, digits: usize) -> f64 {
    reread(format!("{value:.*e}", digits - 1), value)
}

/// The number that a committed file holds for a rate: four decimals.
pub fn committed_rate(rate: f64) -> f64 {
    rounded(rate, RATE_PLACES)
}

/// An interval whose ends have at most this many decimals. What is shown is rounded from it: a
/// report that is made from a record then shows what was shown before.
fn rounded_interval(interval: Interval, places: usize) -> Interval {
    Interval {
        low: rounded(interval.low, places),
        high: rounded(interval.high, places),
    }
}

/// A number of so many decimals.
fn rounded(value: f64, places: usize) -> f64 {
    // Without the sum, a number that is rounded to zero would show its sign.
    reread(format!("{value:.places$}"), value) + 0.0
}

fn reread(text: String, value: f64) -> f64 {
    text.parse().unwrap_or(value)
}

/// An error as reports show it: four significant digits, `4.454e-8`.
pub fn error_text(value: f64) -> String {
    let value = committed(value);
    if value == 0.0 || !value.is_finite() {
        value.to_string()
    } else {
        format!("{value:.3e}")
    }
}

/// A rate as reports show it: three decimals; a dash if there is none.
pub fn rate_text(rate: Option<f64>) -> String {
    rate.map_or_else(|| "-".to_owned(), |rate| decimals(committed_rate(rate), 3))
}

/// Decimals that an interval of rates needs: two digits of its width, at least 2 and at most
/// `most`.
pub fn interval_places(interval: Interval, most: usize) -> usize {
    let width = rounded_interval(interval, most).width();
    if width.is_nan() || width.is_infinite() {
        return most.min(3);
    }
    let needed = if width > 0.0 {
        (1.0 - width.log10().floor()) as usize
    } else {
        most
    };
    needed.clamp(most.min(2), most)
}

/// An interval of rates with as many decimals as it needs, and at most `most`: `1.9581 to 1.9613`.
/// If it is narrower than the last decimal, a number and the rounding: `2.0000 ± 0.00005`.
pub fn interval_text(interval: Interval, most: usize) -> String {
    let places = interval_places(interval, most);
    let ends = <[f64; 2]>::from(rounded_interval(interval, most));
    let [low, high] = ends.map(|end| decimals(end, places));
    if low == high {
        format!("{low} ± 0.{}5", "0".repeat(places))
    } else {
        format!("{low} to {high}")
    }
}

/// A count with its noun: `1 element`, `2 elements`.
pub fn counted(count: usize, noun: &str) -> String {
    counted_as(count, noun, &format!("{noun}s"))
}

/// A count with a noun whose plural has no plain `s`: `1 study`, `2 studies`.
pub fn counted_as(count: usize, one: &str, several: &str) -> String {
    if count == 1 {
        format!("1 {one}")
    } else {
        format!("{count} {several}")
    }
}

/// A number with `places` decimals; without a sign if it is rounded to zero.
pub fn decimals(value: f64, places: usize) -> String {
    let text = format!("{value:.places$}");
    if text.parse() == Ok(0.0) {
        text.replace('-', "")
    } else {
        text
    }
}

/// Any other number as reports show it: like an error if it is very small or large, plainly
/// otherwise.
pub fn plain_text(value: f64) -> String {
    written(committed(value))
}

fn written(value: f64) -> String {
    let size = value.abs();
    if value.is_finite() && size != 0.0 && !(1e-3..1e6).contains(&size) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// An order as claimed: four decimals without trailing zeros: `2`, `0.6667`.
pub fn order_text(order: f64) -> String {
    let rounded = committed_rate(order);
    if rounded == 0.0 {
        plain_text(order)
    } else {
        rounded.to_string()
    }
}

/// A number whose size alone matters, with two digits: `0.52`, `2.3e11`.
pub fn short_text(value: f64) -> String {
    written(reread(format!("{value:.1e}"), value))
}

/// Two numbers as [`plain_text`] writes them; if they would look alike or almost alike, with enough
/// digits to differ, and one more.
pub fn pair_text(pair: [f64; 2]) -> [String; 2] {
    let rounded =
        |digits: usize| pair.map(|value| reread(format!("{value:.*e}", digits - 1), value));
    let differs = |digits: &usize| rounded(*digits)[0] != rounded(*digits)[1];
    // Seventeen digits distinguish any two numbers.
    let needed = (1..=17).find(differs).unwrap_or(1);
    let plain = pair.map(plain_text);
    if needed < DIGITS && plain[0] != plain[1] {
        plain
    } else {
        rounded(needed + 1).map(written)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_maximum_keeps_nan() {
        assert_eq!([0.0, 2.0, 1.0].into_iter().fold(0.0, max_or_nan), 2.0);
        for values in [
            [f64::NAN, 1.0, 2.0],
            [1.0, f64::NAN, 2.0],
            [1.0, 2.0, f64::NAN],
        ] {
            assert!(values.into_iter().fold(0.0, max_or_nan).is_nan());
        }
    }

    #[test]
    fn a_number_rounded_to_zero_has_no_sign() {
        assert_eq!(decimals(-4e-10, 8), "0.00000000");
        assert_eq!(decimals(-4e-8, 8), "-0.00000004");
        assert_eq!(decimals(f64::NAN, 2), "NaN");
    }

    #[test]
    fn one_of_a_kind_has_no_s() {
        assert_eq!(
            [0, 1, 2].map(|n| counted(n, "element")),
            ["0 elements", "1 element", "2 elements"]
        );
    }

    fn in_words([low, high]: [f64; 2], most: usize) -> String {
        interval_text(Interval { low, high }, most)
    }

    #[test]
    fn an_interval_has_two_digits_of_its_width_and_never_two_equal_ends() {
        for (interval, text) in [
            ([1.5, 2.5], "1.50 to 2.50"),
            ([1.9581, 1.9613], "1.9581 to 1.9613"),
            ([1.958, 1.991], "1.958 to 1.991"),
            ([0.99999, 1.00001], "1.0000 ± 0.00005"),
            ([1.0, 1.0], "1.0000 ± 0.00005"),
            ([-0.2, 30.0], "-0.20 to 30.00"),
        ] {
            assert_eq!(in_words(interval, 4), text);
        }
        assert_eq!(in_words([0.999_99, 1.000_01], 6), "0.999990 to 1.000010");
        assert_eq!(in_words([f64::NAN, 1.0], 4), "NaN to 1.000");
        // The record has 1.9915, and a report 1.992.
        assert_eq!(in_words([1.991_49, 2.01], 4), "1.992 to 2.010");
    }

    #[test]
    fn committed_numbers_keep_the_digits_that_machines_agree_on() {
        for (value, kept) in [
            (1.0 / 3.0, 0.333333),
            (-4.454123456e-8, -4.45412e-8),
            (4.4413e-15, 4e-15),
            (4.4413e-14, 4.4e-14),
            (3.7e-19, 4e-19),
            (123_456_789.0, 123_457_000.0),
            (0.0, 0.0),
            (f64::INFINITY, f64::INFINITY),
        ] {
            assert_eq!(committed(value), kept, "{value}");
        }
        assert!(committed(f64::NAN).is_nan());
    }

    #[test]
    fn rounding_a_committed_number_again_changes_nothing() {
        for exponent in -20..20 {
            let value = 1.234567891234 * 10f64.powi(exponent);
            assert_eq!(committed(committed(value)), committed(value));
        }
    }

    #[test]
    fn two_numbers_that_differ_look_different() {
        for (pair, texts) in [
            ([1.0, 1.01], ["1", "1.01"]),
            (
                [0.008_482_598_7, 0.008_482_598_4],
                ["0.0084825987", "0.0084825984"],
            ),
            ([1.994_05, 1.994_06], ["1.99405", "1.99406"]),
            ([1.994_051, 1.994_059], ["1.994051", "1.994059"]),
            ([1e-9, 1.000_000_2e-9], ["1e-9", "1.0000002e-9"]),
            ([4.1e-15, 4.3e-15], ["4.1e-15", "4.3e-15"]),
            ([3.0, 3.0], ["3", "3"]),
        ] {
            assert_eq!(pair_text(pair), texts);
        }
        assert_eq!(pair_text([f64::NAN, 1.0]), ["NaN", "1"]);
    }

    #[test]
    fn an_order_has_four_decimals_at_most() {
        assert_eq!(
            [2.0, 2.0 / 3.0, 1.5, 1e-6, f64::NAN].map(order_text),
            ["2", "0.6667", "1.5", "1e-6", "NaN"]
        );
    }

    #[test]
    fn texts_of_numbers_are_short_and_name_nan() {
        assert_eq!(error_text(4.454_12e-8), "4.454e-8");
        assert_eq!(error_text(f64::NAN), "NaN");
        assert_eq!(error_text(0.0), "0");
        assert_eq!(rate_text(Some(1.99996)), "2.000");
        assert_eq!(rate_text(Some(-1e-9)), "0.000");
        assert_eq!(rate_text(None), "-");
        assert_eq!(
            [0.5249, 226_297_294_514.99, 2.2e-16, 0.0].map(short_text),
            ["0.52", "2.3e11", "2.2e-16", "0"]
        );
        assert_eq!(plain_text(1e-3), "0.001");
        assert_eq!(plain_text(2.5e-7), "2.5e-7");
        assert_eq!(plain_text(-0.0), "-0");
    }
}
