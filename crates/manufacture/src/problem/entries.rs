//! The values of a file that have more than one form: a text or a number, a list, a table.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::ops::Range;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{self, MapAccess, SeqAccess, Unexpected, Visitor};
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

/// A finite number: never NaN.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(try_from = "f64")]
pub(super) struct Finite(f64);

impl Finite {
    pub(super) fn get(self) -> f64 {
        self.0
    }
}

impl TryFrom<f64> for Finite {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        let is_finite = value.is_finite().then_some(Self(value));
        is_finite.ok_or_else(|| format!("expected a finite number, found {value}"))
    }
}

/// An expression as a text, or a number: its text is what the file has there.
#[derive(Debug)]
pub(super) enum Scalar {
    Text(String),
    Number,
}

impl JsonSchema for Scalar {
    fn schema_name() -> Cow<'static, str> {
        "Scalar".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, { "type": "number" }] })
    }
}

/// A scalar, a vector, or the rows of a tensor.
#[derive(Debug)]
pub(super) enum TensorEntry {
    One(Scalar),
    List(Vec<Located<TensorEntry>>),
}

impl JsonSchema for TensorEntry {
    fn schema_name() -> Cow<'static, str> {
        "TensorEntry".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let scalar = Scalar::json_schema(generator);
        let vector = json_schema!({ "type": "array", "items": scalar });
        let tensor = json_schema!({ "type": "array", "items": vector });
        json_schema!({ "anyOf": [scalar, vector, tensor] })
    }
}

/// A value of `[boundary]` or `[initial]`: one that is given, or one that must hold.
#[derive(Debug, JsonSchema)]
#[schemars(untagged)]
pub(super) enum DatumEntry {
    Given(TensorEntry),
    Held(HeldTable),
}

/// A value that must hold.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub(super) struct HeldTable {
    /// what has the value
    pub(super) of: Located<TensorEntry>,
    /// the value that it must have
    pub(super) is: Located<TensorEntry>,
}

/// An equation: a text that is cut into terms, or terms by name.
#[derive(Debug, JsonSchema)]
#[schemars(untagged)]
pub(super) enum EquationEntry {
    Sum(Scalar),
    Terms(Named<Scalar>),
}

/// `[boundary.NAME]`: its data, and where they are.
#[derive(Debug, Default, JsonSchema)]
pub(super) struct FaceEntry {
    /// the side that the data are on, such as `x_max`; without it the name of the table
    pub(super) face: Option<Located<String>>,
    /// in place of `face`: a function that is negative inside and zero on the face
    pub(super) level: Option<Located<Scalar>>,
    #[schemars(flatten)]
    pub(super) data: Named<DatumEntry>,
}

/// A value that an expression may stand for.
trait Entry: Sized {
    const EXPECTED: &'static str = "an expression as a text, or a number";

    fn scalar(scalar: Scalar) -> Self;

    fn list<'de, A: SeqAccess<'de>>(_: A) -> Result<Self, A::Error> {
        Err(de::Error::invalid_type(Unexpected::Seq, &Self::EXPECTED))
    }

    fn table<'de, A: MapAccess<'de>>(_: A) -> Result<Self, A::Error> {
        Err(de::Error::invalid_type(Unexpected::Map, &Self::EXPECTED))
    }
}

impl Entry for Scalar {
    fn scalar(scalar: Scalar) -> Self {
        scalar
    }
}

impl Entry for TensorEntry {
    fn scalar(scalar: Scalar) -> Self {
        Self::One(scalar)
    }

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let parts: Vec<Located<TensorEntry>> =
            Deserialize::deserialize(SeqAccessDeserializer::new(list))?;
        if parts.is_empty() {
            return Err(de::Error::invalid_length(0, &"at least one component"));
        }
        Ok(Self::List(parts))
    }
}

impl Entry for DatumEntry {
    fn scalar(scalar: Scalar) -> Self {
        Self::Given(TensorEntry::One(scalar))
    }

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        TensorEntry::list(list).map(Self::Given)
    }

    fn table<'de, A: MapAccess<'de>>(table: A) -> Result<Self, A::Error> {
        Deserialize::deserialize(MapAccessDeserializer::new(table)).map(Self::Held)
    }
}

impl Entry for EquationEntry {
    fn scalar(scalar: Scalar) -> Self {
        Self::Sum(scalar)
    }

    fn table<'de, A: MapAccess<'de>>(table: A) -> Result<Self, A::Error> {
        let terms: Named<Scalar> = Deserialize::deserialize(MapAccessDeserializer::new(table))?;
        if terms.is_empty() {
            return Err(de::Error::invalid_length(0, &"at least one term"));
        }
        Ok(Self::Terms(terms))
    }
}

struct ReadsEntry<T>(PhantomData<T>);

impl<'de, T: Entry> Visitor<'de> for ReadsEntry<T> {
    type Value = T;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(T::EXPECTED)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<T, E> {
        Ok(T::scalar(Scalar::Text(text.to_owned())))
    }

    fn visit_i64<E: de::Error>(self, _: i64) -> Result<T, E> {
        Ok(T::scalar(Scalar::Number))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<T, E> {
        Finite::try_from(value).map_err(E::custom)?;
        Ok(T::scalar(Scalar::Number))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<T, A::Error> {
        T::list(list)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<T, A::Error> {
        T::table(table)
    }
}

macro_rules! read_entries {
    ($($entry:ty)*) => {$(
        impl<'de> Deserialize<'de> for $entry {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(ReadsEntry(PhantomData))
            }
        }
    )*};
}

read_entries!(Scalar TensorEntry DatumEntry EquationEntry);

impl<'de> Deserialize<'de> for FaceEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ReadsFace;
        impl<'de> Visitor<'de> for ReadsFace {
            type Value = FaceEntry;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a table")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut table: A) -> Result<FaceEntry, A::Error> {
                let mut entry = FaceEntry::default();
                while let Some(key) = table.next_key::<String>()? {
                    match key.as_str() {
                        "face" => entry.face = Some(table.next_value()?),
                        "level" => entry.level = Some(table.next_value()?),
                        _ => drop(entry.data.insert(key, table.next_value()?)),
                    }
                }
                Ok(entry)
            }
        }
        deserializer.deserialize_map(ReadsFace)
    }
}
