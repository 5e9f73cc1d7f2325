//! What a colleague would say.

use super::causes::{Cause, SPREADS};
use super::right::Right;
use crate::check::place;

fn quoted(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// What is said of the terms that are right.
fn others(labels: &[&str], terms: &[String]) -> &'static str {
    match labels.len().saturating_sub(terms.len()) {
        0 => "",
        1 => "; the other term is right",
        _ => "; the other terms are right",
    }
}

pub(super) fn sentence(
    right: &Right<'_>,
    quantity: &str,
    labels: &[&str],
    cause: &Cause,
    differences: &[f64],
) -> String {
    let Cause {
        name,
        terms,
        factors,
        alternatives,
    } = cause;
    let factor = factors.first().copied().unwrap_or(f64::NAN);
    let others = others(labels, terms);
    let quoted = quoted(terms);
    let what = match *name {
        "equal" => right_values(differences),
        "sign-of-source" => {
            "your source has the opposite sign: the equation was written on the other side"
                .to_owned()
        }
        "normal" => "your values have the opposite sign: the normal points inwards".to_owned(),
        "constant" => format!("your values differ from the right ones by the constant {factor}"),
        "factor-of-source" => format!("your values are the right ones times {factor}"),
        "sign-of-term" => format!("your source has the opposite sign in {quoted}{others}"),
        "missing-term" => format!("your source lacks {quoted}{others}"),
        "factor-of-term" => {
            let parts: Vec<String> = terms
                .iter()
                .zip(factors)
                .map(|(term, factor)| format!("`{term}` times {factor}"))
                .collect();
            format!("your source has {}{others}", parts.join(" and "))
        }
        "product-rule" | "transposed-gradient" | "missing-transpose" => {
            format!("your source is the one {}", terms.join(""))
        }
        "time" => format!("your values are those of the time {factor} at all times"),
        "components" => format!("your values are those of {quoted}"),
        "coordinates" => format!("your values fit with {quoted} exchanged"),
        "parameter" => format!("your values fit with {quoted} = {factor}"),
        _ => nothing(right, differences),
    };
    let also = if alternatives.is_empty() {
        String::new()
    } else {
        format!(" (this fits as well: {})", alternatives.join(", "))
    };
    format!("{quantity}: {what}{also}")
}

/// Equal values, and the largest difference that was taken for rounding.
fn right_values(differences: &[f64]) -> String {
    let largest = differences.iter().copied().fold(0.0, f64::max);
    if largest == 0.0 {
        return "your values are right, to the last digit".to_owned();
    }
    format!(
        "your values are right: the largest difference, {largest:.1e}, is within {SPREADS} times the spread \
         of the two evaluations of the file, or within the digits printed"
    )
}

/// No explanation: where the difference is largest and where it is smallest.
fn nothing(right: &Right<'_>, differences: &[f64]) -> String {
    let differences = || differences.iter().zip(&right.points);
    let largest = differences().max_by(|a, b| a.0.total_cmp(b.0));
    let smallest = differences().min_by(|a, b| a.0.total_cmp(b.0));
    let [largest, smallest] = [largest, smallest].map(|entry| {
        entry.map_or(String::new(), |(difference, point)| {
            format!("{difference:.3e} at {}", place(right.model, point))
        })
    });
    format!("no explanation found; your values differ by {largest} and by {smallest}")
}
