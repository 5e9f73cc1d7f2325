//! The numbers of a scene that a sweep may vary, and the values of one of them.

use std::borrow::Cow;
use std::fmt::{self, Formatter};

use convergence_study::file::{Count, Finite, Refusal, within};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Value, json};

use crate::scene::limits::SWEEP_VALUES;

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

/// What a file has under a key that varies.
#[derive(Debug, Clone)]
pub(super) enum Varied {
    /// A list of numbers.
    List(Vec<Finite>),
    /// Evenly spaced numbers, both ends included.
    Range(RangeTable),
}

/// `{ from, to, count, scale }`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RangeTable {
    from: Finite,
    to: Finite,
    count: Count<2, SWEEP_VALUES>,
    #[serde(default)]
    scale: Scale,
}

/// How the numbers of a range are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Scale {
    #[default]
    Linear,
    Log,
}

impl<'de> Deserialize<'de> for Varied {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reads;
        impl<'de> Visitor<'de> for Reads {
            type Value = Varied;

            fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
                f.write_str(LIST)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Varied, A::Error> {
                let mut values = vec![];
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok(Varied::List(values))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Varied, A::Error> {
                RangeTable::deserialize(MapAccessDeserializer::new(map)).map(Varied::Range)
            }
        }
        deserializer.deserialize_any(Reads)
    }
}

impl JsonSchema for Varied {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "numbers".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "title": LIST, "anyOf": [{ "type": "array" }, { "type": "object" }] })
    }
}

const LIST: &str = "a list of at least one number, or { from, to, count }";

/// A key that varies, with the field to name when a scene cannot have one of its values.
#[derive(Debug)]
pub(super) struct SweptKey {
    pub(super) axis: Axis,
    /// The field of the key in the file.
    field: String,
    /// Whether the values are listed, each with a field of its own.
    is_listed: bool,
}

impl SweptKey {
    /// * `field`: the dotted name of the key in the file.
    pub(super) fn new(path: &'static str, varied: &Varied, field: String) -> Result<Self, Refusal> {
        let (values, is_listed) = match varied {
            Varied::List(values) if values.is_empty() => {
                return Err(Refusal::written(field, LIST));
            }
            Varied::List(values) => {
                let value = |(place, value): (usize, &Finite)| {
                    number(value.get(), path, &format!("{field}[{place}]"))
                };
                (
                    values
                        .iter()
                        .enumerate()
                        .map(value)
                        .collect::<Result<_, _>>()?,
                    true,
                )
            }
            Varied::Range(range) => (range.values(path).map_err(within(&field))?, false),
        };
        Ok(Self {
            axis: Axis {
                path,
                values,
                stride: 1,
            },
            field,
            is_listed,
        })
    }

    /// The cases, of a grid in which all other keys have their first values, whose numbers a scene
    /// must accept: the ends of a range, every number of a list.
    pub(super) fn probed(&self) -> impl Iterator<Item = usize> {
        let (last, stride) = (self.axis.values.len() - 1, self.axis.stride);
        let step = if self.is_listed { 1 } else { last.max(1) };
        (0..=last).step_by(step).map(move |place| place * stride)
    }

    /// The field of a value; a range is named as a whole.
    pub(super) fn field(&self, place: usize) -> String {
        if self.is_listed {
            format!("{}[{place}]", self.field)
        } else {
            self.field.clone()
        }
    }
}

/// A value of a key: some are whole numbers.
fn number(value: f64, path: &str, field: &str) -> Result<f64, Refusal> {
    // The scene refuses larger numbers; these are exact as f64.
    const MOST: f64 = (1u64 << 53) as f64;
    if WHOLE.contains(&path) && !(value.fract() == 0.0 && (0.0..=MOST).contains(&value)) {
        return Err(Refusal::written(field, "a whole number >= 0"));
    }
    // -0 and 0 are the same value; adding 0 gives 0 for both.
    Ok(value + 0.0)
}

impl RangeTable {
    /// The values.
    fn values(&self, path: &str) -> Result<Vec<f64>, Refusal> {
        let from = number(self.from.get(), path, "from")?;
        let to = number(self.to.get(), path, "to")?;
        let is_log = self.scale == Scale::Log;
        if is_log && from <= 0.0 {
            return Err(Refusal::written("from", "a number > 0, for a logarithm"));
        }
        if to <= from {
            let allowed = format!("a number > {from:?}, which is from");
            return Err(Refusal::written("to", allowed));
        }
        let count = self.count.get();
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
}

/// A number rounded to nine digits, on which the mathematical libraries of all machines agree.
fn nine_digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneFile;
    use convergence_study::file::schema;

    /// A number that a scene can have and a sweep cannot vary would be missed; so would a whole
    /// number that the sweep gives a point.
    #[test]
    fn every_number_of_a_scene_can_be_varied_and_whole_ones_stay_whole() {
        let schema = schema::<SceneFile>();
        let mut numbers = vec![];
        for (table, keys) in schema["properties"].as_object().unwrap() {
            for (name, key) in keys["properties"].as_object().unwrap() {
                let is_whole = key["type"] == "integer";
                if is_whole || key["type"] == "number" {
                    numbers.push((format!("{table}.{name}"), is_whole));
                }
            }
        }
        // Only the fixed point has it, and the sweep's method is that of its scene.
        numbers.retain(|(path, _)| path != "time.iterations");
        let mut known: Vec<(String, bool)> = all_paths()
            .map(|path| (path.to_owned(), WHOLE.contains(&path)))
            .collect();
        known.sort();
        numbers.sort();
        assert_eq!(known, numbers);
    }
}
