//! The values of a key, as the sweep file writes them.

use super::Key;
use super::design::stratified;
use crate::scene::limits::SWEEP_VALUES;
use convergence_study::input::{Field, InputError};

/// How values are spread between two ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Spread {
    Linear,
    Log,
}

/// `{ from, to, scale }`.
struct Range {
    from: f64,
    to: f64,
    scale: Spread,
}

impl Range {
    fn read(field: &Field<'_>, key: Key, others: &[&str]) -> Result<Self, InputError> {
        let section = field.section()?;
        section.allow(&[&["from", "to", "scale"], others].concat())?;
        let scales = [("linear", Spread::Linear), ("log", Spread::Log)];
        let scale = section.get("scale").map_or(Ok(Spread::Linear), |field| field.choice(&scales))?;
        let end = |name: &str| {
            let field = section.require(name, "a number")?;
            let value = number(&field, key)?;
            if scale == Spread::Log && value <= 0.0 {
                return Err(field.refuse_as_written("a number > 0 on a logarithmic scale"));
            }
            Ok((field, value))
        };
        let (_, from) = end("from")?;
        let (to_field, to) = end("to")?;
        if to <= from {
            return Err(to_field.refuse_as_written(format!("a number > {from:?}, which is from")));
        }
        Ok(Self { from, to, scale })
    }

    /// The value at `share` of the way, 0 to 1.
    fn at(&self, share: f64, key: Key) -> f64 {
        let value = match self.scale {
            Spread::Linear => self.from + (self.to - self.from) * share,
            Spread::Log => self.from * (self.to / self.from).powf(share),
        };
        if key.is_whole { value.round() } else { rounded(value) }
    }
}

/// To 9 digits, on which the mathematical libraries of all machines agree.
fn rounded(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

fn number(field: &Field<'_>, key: Key) -> Result<f64, InputError> {
    if key.is_whole {
        // Larger ones are refused by the scene; these are exact as f64.
        return Ok(field.count(1..=1 << 53)? as f64);
    }
    // -0 and 0 are one value; the sum is 0 for both.
    field.number().map(|value| value + 0.0)
}

/// A key that varies, its values, and where they are written.
pub(super) struct VariedKey<'a> {
    pub(super) key: Key,
    pub(super) values: Vec<f64>,
    /// Values that a scene must accept, and the fields to name if it does not.
    pub(super) probes: Vec<(f64, Field<'a>)>,
}

/// A list, or `{ from, to, count, scale }`.
pub(super) fn grid<'a>(field: Field<'a>, key: Key) -> Result<VariedKey<'a>, InputError> {
    let allowed = "a list of at least one number, or { from, to, count }";
    if field.is_list() {
        let items = field.items(allowed)?;
        let values = items.iter().map(|item| number(item, key)).collect::<Result<Vec<_>, _>>()?;
        if values.is_empty() {
            return Err(field.refuse_as_written(allowed));
        }
        let mut seen = std::collections::HashSet::new();
        if let Some(twice) = values.iter().position(|value| !seen.insert(value.to_bits())) {
            return Err(items[twice].refuse(format!("{} a second time", items[twice].as_written()), "each number once"));
        }
        return Ok(VariedKey { key, probes: values.iter().copied().zip(items).collect(), values });
    }
    if !field.is_table() {
        return Err(field.refuse_as_written(allowed));
    }
    let range = Range::read(&field, key, &["count"])?;
    let count = field.section()?.require("count", "a whole number >= 2")?;
    let number = count.count(2..=SWEEP_VALUES)?;
    let mut values: Vec<f64> = (0..number).map(|i| range.at(i as f64 / (number - 1) as f64, key)).collect();
    values.dedup();
    if values.len() < number {
        return Err(count.refuse(format!("{number}, which repeats numbers"), format!("at most {}", values.len())));
    }
    Ok(VariedKey { key, probes: vec![(values[0], field.clone()), (values[number - 1], field)], values })
}

/// `{ from, to, scale }`, a Latin hypercube's share of it.
pub(super) fn latin<'a>(field: Field<'a>, key: Key, samples: usize, seed: u64) -> Result<VariedKey<'a>, InputError> {
    if !field.is_table() {
        return Err(field.refuse_as_written("a range { from, to }"));
    }
    let range = Range::read(&field, key, &[])?;
    let values = stratified(samples, seed, key).into_iter().map(|share| range.at(share, key)).collect();
    Ok(VariedKey { key, values, probes: vec![(range.from, field.clone()), (range.to, field)] })
}
