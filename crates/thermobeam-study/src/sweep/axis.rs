//! The numbers of a scene that a sweep may vary, and the values of one of them.

use convergence_study::{Field, InputError};
use serde_json::{Value, json};

use crate::scene::limits::SWEEP_VALUES;

/// The tables that have numeric keys.
pub(super) const TABLES: [&str; 4] = ["beam", "obstacles", "mesh", "time"];

/// The keys whose values are whole numbers.
const WHOLE: [&str; 4] = [
    "mesh.elements",
    "mesh.degree",
    "time.degree",
    "time.max_iterations",
];

/// The other numeric keys.
const REAL: [&str; 13] = [
    "beam.zeta",
    "beam.a",
    "beam.rho",
    "beam.beta",
    "beam.theta_a",
    "obstacles.epsilon",
    "obstacles.g1",
    "obstacles.g2",
    "time.dt",
    "time.t_end",
    "time.tolerance",
    "time.restart_dt",
    "time.growth",
];

/// All keys that may vary, by their dotted names.
pub(super) fn all_paths() -> impl Iterator<Item = &'static str> {
    REAL.into_iter().chain(WHOLE)
}

/// A key that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Its dotted name, such as `beam.beta`.
    pub path: &'static str,
    /// Its values.
    pub values: Vec<f64>,
    /// The number of successive cases with the same value.
    pub(super) stride: usize,
}

impl Axis {
    /// The place of a case's value among the values.
    pub(super) fn place(&self, case: usize) -> usize {
        case / self.stride % self.values.len()
    }

    /// A case's value.
    pub fn value(&self, case: usize) -> f64 {
        self.values[self.place(case)]
    }

    /// A case's value as JSON.
    pub(super) fn json(&self, case: usize) -> Value {
        let value = self.value(case);
        if WHOLE.contains(&self.path) {
            // Read as a whole number, below 2^53.
            json!(value as u64)
        } else {
            json!(value)
        }
    }

    /// A case's value as TOML and expressions write it; reading it back gives the same bits.
    pub(super) fn written(&self, case: usize) -> String {
        self.json(case).to_string()
    }
}

/// A key that varies, with the fields to name when a scene cannot have one of its values.
pub(super) struct SweptKey<'a> {
    pub(super) axis: Axis,
    /// One for each value of a list; a range is named as a whole.
    fields: Vec<Field<'a>>,
}

impl<'a> SweptKey<'a> {
    /// A list, or `{ from, to, count, scale }`.
    pub(super) fn read(path: &'static str, field: Field<'a>) -> Result<Self, InputError> {
        let of = |values, fields| Self {
            axis: Axis {
                path,
                values,
                stride: 1,
            },
            fields,
        };
        if field.is_table() {
            return Ok(of(range(&field, path)?, vec![field]));
        }
        let allowed = "a list of at least one number, or { from, to, count }";
        let items = field.items(allowed)?;
        if items.is_empty() {
            return Err(field.refuse_as_written(allowed));
        }
        let values: Result<_, _> = items.iter().map(|item| number(item, path)).collect();
        Ok(of(values?, items))
    }

    /// The cases, of a grid in which all other keys have their first values, whose numbers a scene
    /// must accept: the ends of a range, every number of a list.
    pub(super) fn probed(&self) -> impl Iterator<Item = usize> {
        let (last, stride) = (self.axis.values.len() - 1, self.axis.stride);
        let step = if self.fields.len() > 1 {
            1
        } else {
            last.max(1)
        };
        (0..=last).step_by(step).map(move |place| place * stride)
    }

    /// The field of a value.
    pub(super) fn field(&self, place: usize) -> &Field<'a> {
        &self.fields[place.min(self.fields.len() - 1)]
    }
}

fn number(field: &Field<'_>, path: &str) -> Result<f64, InputError> {
    if WHOLE.contains(&path) {
        // The scene refuses larger numbers; these are exact as f64.
        return Ok(field.count(0..=1 << 53)? as f64);
    }
    // -0 and 0 are the same value; adding 0 gives 0 for both.
    field.number().map(|value| value + 0.0)
}

/// The values of `{ from, to, count, scale }`: evenly spaced, both ends included.
fn range(field: &Field<'_>, path: &str) -> Result<Vec<f64>, InputError> {
    let section = field.section()?;
    section.allow(&["from", "to", "count", "scale"])?;
    let is_log = section.get("scale").map_or(Ok(false), |field| {
        field.choice(&[("linear", false), ("log", true)])
    })?;
    let from = number(&section.require("from", "a number")?, path)?;
    let to = number(&section.require("to", "a number")?, path)?;
    if is_log && from <= 0.0 {
        return Err(section.refuse("from", format!("{from:?}"), "a number > 0, for a logarithm"));
    }
    if to <= from {
        let allowed = format!("a number > {from:?}, which is from");
        return Err(section.refuse("to", format!("{to:?}"), allowed));
    }
    let count = section.count("count", 2..=SWEEP_VALUES)?;
    let mut values = vec![];
    for place in 0..count {
        let share = place as f64 / (count - 1) as f64;
        let value = if is_log {
            from * (to / from).powf(share)
        } else {
            from + (to - from) * share
        };
        values.push(if WHOLE.contains(&path) {
            value.round()
        } else {
            nine_digits(value)
        });
    }
    Ok(values)
}

/// A number rounded to nine digits, on which the mathematical libraries of all machines agree.
fn nine_digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{KEYS, tables};
    use convergence_study::Form;

    #[test]
    fn every_coefficient_can_be_varied() {
        let names = |table: &str| -> Vec<&str> {
            let paths = all_paths().filter_map(|path| path.split_once('.'));
            paths
                .filter(|path| path.0 == table)
                .map(|path| path.1)
                .collect()
        };
        assert_eq!(
            names("beam"),
            convergence_keys::names(&[&tables::BEAM_KEYS])
        );
        assert_eq!(
            names("obstacles"),
            convergence_keys::names(&[&tables::OBSTACLE_KEYS])
        );
    }

    #[test]
    fn whole_numbers_are_those_of_the_scene() {
        let mut found = 0;
        for table in KEYS {
            let Form::Table(sets) = table.form else {
                panic!("{}", table.name)
            };
            for key in sets.iter().copied().flatten().copied().flatten() {
                let path = format!("{}.{}", table.name, key.name);
                if all_paths().any(|known| known == path) {
                    let is_whole = matches!(key.form, Form::Count(_));
                    assert_eq!(WHOLE.contains(&&*path), is_whole, "{path}");
                    found += 1;
                }
            }
        }
        assert!(found >= 17, "{found}");
    }
}
