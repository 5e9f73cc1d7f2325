//! The numbers of a scene that a sweep may vary, and the values of one of them.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::{self, Formatter};

use convergence_judge::text::number::significant;
use convergence_study::file::{Count, Finite, Refusal, schema};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Value, json};

use crate::scene::{SceneFile, limits::SWEEP_VALUES};

/// The numbers of a scene, which a sweep may vary: their dotted names, and whether they are whole.
pub(super) fn numbers_of_a_scene() -> BTreeMap<String, bool> {
    let schema = schema::<SceneFile>();
    let mut numbers = BTreeMap::new();
    for (table, of_table) in schema["properties"].as_object().into_iter().flatten() {
        for (name, key) in of_table["properties"].as_object().into_iter().flatten() {
            let is_whole = key["type"] == "integer";
            if is_whole || key["type"] == "number" {
                numbers.insert(format!("{table}.{name}"), is_whole);
            }
        }
    }
    numbers
}

/// A key that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepAxis {
    /// Its dotted name, such as `beam.beta`.
    pub path: String,
    /// Its values.
    pub values: Vec<f64>,
    /// Whether they are whole numbers.
    is_whole: bool,
    /// The number of successive cases with the same value.
    pub(super) stride: usize,
    /// The field of the key in the file.
    field: String,
    /// Whether the values are listed, each with a field of its own.
    is_listed: bool,
}

impl SweepAxis {
    /// Listed numbers that are not whole.
    pub(super) fn listed(path: &str, values: Vec<f64>) -> Self {
        Self {
            path: path.to_owned(),
            values,
            is_whole: false,
            stride: 1,
            field: path.to_owned(),
            is_listed: true,
        }
    }

    /// The numbers of a key in a file.
    ///
    /// * `field`: the dotted name of the key in the file.
    pub(super) fn read(
        path: String,
        is_whole: bool,
        varied: &Varied,
        field: String,
    ) -> Result<Self, Refusal> {
        let mut axis = Self {
            is_whole,
            field,
            ..Self::listed(&path, vec![])
        };
        match varied {
            Varied::List(values) if values.is_empty() => {
                return Err(Refusal::written(axis.field, LIST));
            }
            Varied::List(values) => {
                for (place, value) in values.iter().enumerate() {
                    let value = number(*value, is_whole, &axis.field(place))?;
                    axis.values.push(value);
                }
            }
            Varied::Range(range) => {
                axis.values = range
                    .values(is_whole)
                    .map_err(Refusal::within(&axis.field))?;
                axis.is_listed = false;
            }
        }
        Ok(axis)
    }

    /// The place of a case's value among the values.
    pub(super) fn place(&self, case: usize) -> usize {
        case / self.stride % self.values.len()
    }

    /// A case's value.
    pub fn value(&self, case: usize) -> f64 {
        self.values[self.place(case)]
    }

    /// A case's value as JSON, which TOML and expressions write in the same way; reading it back
    /// gives the same bits.
    pub(super) fn json(&self, case: usize) -> Value {
        let value = self.value(case);
        if self.is_whole {
            // Read as a whole number, below 2^53.
            json!(value as u64)
        } else {
            json!(value)
        }
    }

    /// The cases, of a grid in which all other keys have their first values, whose numbers a scene
    /// must accept: the ends of a range, every number of a list.
    pub(super) fn probed(&self) -> impl Iterator<Item = usize> {
        let (last, stride) = (self.values.len() - 1, self.stride);
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

/// What a file has under a key that varies.
#[derive(Debug, Clone)]
pub(super) enum Varied {
    /// A list of numbers.
    List(Vec<Finite>),
    /// Evenly spaced numbers, both ends included.
    Range(RangeTable),
}

/// `{ from, to, count, scale }`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RangeTable {
    from: Finite,
    to: Finite,
    count: Count<2, SWEEP_VALUES>,
    #[serde(default)]
    scale: Scale,
}

/// How the numbers of a range are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize, JsonSchema)]
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
    fn schema_name() -> Cow<'static, str> {
        "numbers".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let list = Vec::<Finite>::json_schema(generator);
        let range = RangeTable::json_schema(generator);
        json_schema!({ "title": LIST, "anyOf": [list, range] })
    }
}

const LIST: &str = "a list of at least one number, or { from, to, count }";

/// A value of a key: some are whole numbers.
fn number(value: Finite, is_whole: bool, field: &str) -> Result<f64, Refusal> {
    // The scene refuses larger numbers; these are exact as f64.
    const MOST: f64 = (1u64 << 53) as f64;
    let value = value.get();
    if is_whole && !(value.fract() == 0.0 && (0.0..=MOST).contains(&value)) {
        return Err(Refusal::written(field, "a whole number >= 0"));
    }
    // -0 and 0 are the same value; adding 0 gives 0 for both.
    Ok(value + 0.0)
}

impl RangeTable {
    /// The values.
    fn values(&self, is_whole: bool) -> Result<Vec<f64>, Refusal> {
        let from = number(self.from, is_whole, "from")?;
        let to = number(self.to, is_whole, "to")?;
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
            values.push(if is_whole {
                value.round()
            } else {
                // The mathematical libraries of all machines agree on nine digits.
                significant(value, 9)
            });
        }
        Ok(values)
    }
}
