//! The values of a file that have more than one form, and their schemas.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::num::NonZeroU64;
use std::ops::Range;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{self, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::file::Named;

/// A value, and the bytes of the file that hold it.
#[derive(Debug)]
pub(super) struct Located<T> {
    pub(super) span: Range<usize>,
    pub(super) value: T,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Located<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let spanned = toml::Spanned::deserialize(deserializer)?;
        Ok(Self {
            span: spanned.span(),
            value: spanned.into_inner(),
        })
    }
}

impl<T: JsonSchema> JsonSchema for Located<T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// An order: a finite number > 0.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(try_from = "f64")]
pub(crate) struct Order(f64);

impl Order {
    pub(crate) fn get(self) -> f64 {
        self.0
    }
}

impl TryFrom<f64> for Order {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        let is_order = value > 0.0 && value.is_finite();
        let order = is_order.then_some(Self(value));
        order.ok_or_else(|| format!("expected a finite number > 0, found {value}"))
    }
}

/// Resolutions, coarse to fine.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(try_from = "Vec<NonZeroU64>")]
pub(crate) struct Resolutions(Vec<NonZeroU64>);

impl Resolutions {
    pub(crate) fn counts(&self) -> &[NonZeroU64] {
        &self.0
    }
}

impl TryFrom<Vec<NonZeroU64>> for Resolutions {
    type Error = String;

    fn try_from(counts: Vec<NonZeroU64>) -> Result<Self, String> {
        let rises = !counts.is_empty() && counts.windows(2).all(|pair| pair[0] < pair[1]);
        let found = format!("{counts:?}");
        let counts = rises.then_some(Self(counts));
        counts.ok_or_else(|| format!("expected increasing whole numbers, found {found}"))
    }
}

/// A value: an expression, or a list or a table of values.
#[derive(Debug)]
pub(super) enum Entry {
    Text(String),
    /// Its text is what the file has there.
    Number,
    List(Vec<Located<Entry>>),
    Table(Named<Entry>),
}

/// What a value is without a list or a table.
pub(super) const EXPRESSION: &str = "an expression as a text, or a number";

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ReadsEntry;
        impl<'de> Visitor<'de> for ReadsEntry {
            type Value = Entry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPRESSION)
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Entry, E> {
                Ok(Entry::Text(text.to_owned()))
            }

            fn visit_i64<E: de::Error>(self, _: i64) -> Result<Entry, E> {
                Ok(Entry::Number)
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Entry, E> {
                let number = value.is_finite().then_some(Entry::Number);
                let found = || E::custom(format!("expected a finite number, found {value}"));
                number.ok_or_else(found)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Entry, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(Entry::List)
            }

            fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<Entry, A::Error> {
                Deserialize::deserialize(MapAccessDeserializer::new(table)).map(Entry::Table)
            }
        }
        deserializer.deserialize_any(ReadsEntry)
    }
}

/// What a schema says of [`Entry`].
impl JsonSchema for Entry {
    fn schema_name() -> Cow<'static, str> {
        Scalar::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Scalar::json_schema(generator)
    }
}

/// An expression, or a number.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "the schema of an entry")]
pub(super) enum Scalar {
    Text(String),
    Number(f64),
}

/// A scalar, a vector, or the rows of a tensor.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "the schema of an entry")]
pub(super) enum Components {
    One(Scalar),
    Vector(Vec<Scalar>),
    Rows(Vec<Vec<Scalar>>),
}

/// A value that must hold.
#[derive(JsonSchema)]
#[serde(deny_unknown_fields)]
#[expect(dead_code, reason = "the schema of an entry")]
pub(super) struct HeldDatum {
    /// what has the value
    of: Components,
    /// the value that it must have
    is: Components,
}

/// A value that is given, or one that must hold.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "the schema of an entry")]
pub(super) enum DatumForm {
    Given(Components),
    Held(HeldDatum),
}

/// A text that is cut into terms, or terms by name.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "the schema of an entry")]
pub(super) enum LeftSide {
    Sum(Scalar),
    Terms(BTreeMap<String, Scalar>),
}

/// Data, and where they are.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "the schema of an entry")]
pub(super) struct FaceTable {
    /// the side that the data are on, such as `x_max`; without it the name of the table
    face: Option<String>,
    /// in place of `face`: a function that is negative inside and zero on the face
    level: Option<Scalar>,
    #[serde(flatten)]
    data: BTreeMap<String, DatumForm>,
}
