//! The values that structs of files have: numbers of a range, names of a choice, lists of levels. A
//! value that was read is in its range; what the range is, a message takes from its schema.

use std::borrow::Cow;
use std::fmt::{self, Display};
use std::marker::PhantomData;
use std::ops::Deref;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, DeserializeSeed, Deserializer, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use serde_json::json;

/// What a value says that is out of its range: the message has the range from the schema.
pub(super) const NOT_ALLOWED: &str = "invalid value";

fn not_allowed<E: de::Error>() -> E {
    E::custom(NOT_ALLOWED)
}

/// Which numbers are allowed.
pub trait Range {
    /// The ends of the range, each by its name in a JSON schema: `exclusiveMinimum`, `minimum`,
    /// `exclusiveMaximum` or `maximum`.
    const ENDS: &'static [(&'static str, f64)];
}

/// A finite number of a range; never NaN.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Number<R>(f64, PhantomData<R>);

/// A finite number.
pub type Finite = Number<AnyNumber>;

/// A finite number > 0.
pub type Positive = Number<AboveZero>;

/// The range of all numbers.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub enum AnyNumber {}

impl Range for AnyNumber {
    const ENDS: &'static [(&'static str, f64)] = &[];
}

/// The range of the numbers > 0.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub enum AboveZero {}

impl Range for AboveZero {
    const ENDS: &'static [(&'static str, f64)] = &[("exclusiveMinimum", 0.0)];
}

impl<R: Range> Number<R> {
    /// A number, if it is of the range.
    pub fn new(value: f64) -> Option<Self> {
        let keeps = |(name, end): &(&str, f64)| match *name {
            "exclusiveMinimum" => value > *end,
            "minimum" => value >= *end,
            "exclusiveMaximum" => value < *end,
            _ => value <= *end,
        };
        (value.is_finite() && R::ENDS.iter().all(keeps)).then_some(Self(value, PhantomData))
    }

    /// The number.
    pub fn get(self) -> f64 {
        self.0
    }
}

impl<'de, R: Range> Deserialize<'de> for Number<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::new(f64::deserialize(deserializer)?).ok_or_else(not_allowed)
    }
}

impl<R> Serialize for Number<R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.0)
    }
}

impl<R: Range> JsonSchema for Number<R> {
    fn schema_name() -> Cow<'static, str> {
        std::any::type_name::<Self>().into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({ "type": "number" });
        for (name, end) in R::ENDS {
            schema.insert((*name).to_owned(), json!(end));
        }
        schema
    }
}

/// A whole number from `LEAST` to `MOST`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Count<const LEAST: usize, const MOST: usize = { usize::MAX }>(usize);

impl<const LEAST: usize, const MOST: usize> Count<LEAST, MOST> {
    /// The number.
    pub fn get(self) -> usize {
        self.0
    }
}

impl<const LEAST: usize, const MOST: usize> From<Count<LEAST, MOST>> for usize {
    fn from(count: Count<LEAST, MOST>) -> Self {
        count.0
    }
}

impl<const LEAST: usize, const MOST: usize> Display for Count<LEAST, MOST> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<'de, const LEAST: usize, const MOST: usize> Deserialize<'de> for Count<LEAST, MOST> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let count = usize::deserialize(deserializer)?;
        let is_allowed = (LEAST..=MOST).contains(&count);
        is_allowed.then_some(Self(count)).ok_or_else(not_allowed)
    }
}

impl<const LEAST: usize, const MOST: usize> JsonSchema for Count<LEAST, MOST> {
    fn schema_name() -> Cow<'static, str> {
        std::any::type_name::<Self>().into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({ "type": "integer", "minimum": LEAST });
        if MOST < usize::MAX {
            schema.insert("maximum".to_owned(), json!(MOST));
        }
        schema
    }
}

/// Which texts are allowed.
pub(crate) trait Texts {
    /// What is allowed, in words.
    const ALLOWED: &'static str;

    /// Whether a text is.
    fn has(text: &str) -> bool;
}

/// A text that is allowed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AllowedText<T>(String, PhantomData<T>);

impl<T> AllowedText<T> {
    /// The text.
    pub(crate) fn get(self) -> String {
        self.0
    }
}

impl<'de, T: Texts> Deserialize<'de> for AllowedText<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        if T::has(&text) {
            Ok(Self(text, PhantomData))
        } else {
            Err(not_allowed())
        }
    }
}

impl<T: Texts> JsonSchema for AllowedText<T> {
    fn schema_name() -> Cow<'static, str> {
        std::any::type_name::<Self>().into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "title": T::ALLOWED })
    }
}

/// The values of a choice, by name.
pub trait Choices {
    /// A value.
    type Value: Copy;

    /// All of them.
    fn all() -> Vec<(&'static str, Self::Value)>;
}

/// One of several values, which a file gives by its name.
#[derive(Debug)]
pub struct OneOf<C: Choices> {
    /// The name.
    pub name: &'static str,
    /// The value.
    pub value: C::Value,
}

impl<C: Choices> Clone for OneOf<C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C: Choices> Copy for OneOf<C> {}

impl<'de, C: Choices> Deserialize<'de> for OneOf<C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let found = C::all().into_iter().find(|(name, _)| *name == text);
        let choice = found.map(|(name, value)| Self { name, value });
        choice.ok_or_else(not_allowed)
    }
}

impl<C: Choices> JsonSchema for OneOf<C> {
    fn schema_name() -> Cow<'static, str> {
        std::any::type_name::<C>().into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let names: Vec<&str> = C::all().into_iter().map(|(name, _)| name).collect();
        json_schema!({ "enum": names })
    }
}

/// One number, a list of levels, or `"auto"`, which leaves the levels to the study.
#[derive(Debug, Clone, PartialEq)]
pub enum Counts<T> {
    /// One number.
    One(T),
    /// Levels, each greater than the one before, at least one.
    List(Vec<T>),
    /// `"auto"`.
    Auto,
}

/// A level after another.
struct After<T>(Option<T>);

impl<'de, T: Deserialize<'de> + PartialOrd + Display> DeserializeSeed<'de> for After<T> {
    type Value = T;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<T, D::Error> {
        let level = T::deserialize(deserializer)?;
        match self.0 {
            Some(before) if !(level > before) => Err(de::Error::custom(format_args!(
                "found {level}; expected a number > {before}, the level before"
            ))),
            _ => Ok(level),
        }
    }
}

impl<'de, T> Deserialize<'de> for Counts<T>
where
    T: Deserialize<'de> + PartialOrd + Display + Copy,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reads<T>(PhantomData<T>);
        impl<'de, T> Visitor<'de> for Reads<T>
        where
            T: Deserialize<'de> + PartialOrd + Display + Copy,
        {
            type Value = Counts<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(NOT_ALLOWED)
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Counts<T>, E> {
                T::deserialize(value.into_deserializer()).map(Counts::One)
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Counts<T>, E> {
                let is_auto = text == "auto";
                is_auto.then_some(Counts::Auto).ok_or_else(not_allowed)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Counts<T>, A::Error> {
                let mut levels: Vec<T> = vec![];
                while let Some(level) = list.next_element_seed(After(levels.last().copied()))? {
                    levels.push(level);
                }
                let is_list = !levels.is_empty();
                is_list
                    .then_some(Counts::List(levels))
                    .ok_or_else(not_allowed)
            }
        }
        deserializer.deserialize_any(Reads(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for Counts<T> {
    fn schema_name() -> Cow<'static, str> {
        std::any::type_name::<Self>().into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (one, levels) = (
            T::json_schema(generator),
            Ascending::<T>::json_schema(generator),
        );
        json_schema!({ "anyOf": [one, levels, { "enum": ["auto"] }] })
    }
}

/// At least `LEAST` levels, each greater than the one before.
#[derive(Debug, Clone, PartialEq)]
pub struct Ascending<T, const LEAST: usize = 1>(Vec<T>);

impl<T, const LEAST: usize> Deref for Ascending<T, LEAST> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<'de, T, const LEAST: usize> Deserialize<'de> for Ascending<T, LEAST>
where
    T: Deserialize<'de> + PartialOrd + Display + Copy,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Counts::deserialize(deserializer)? {
            Counts::List(levels) if levels.len() >= LEAST => Ok(Self(levels)),
            _ => Err(not_allowed()),
        }
    }
}

impl<T: JsonSchema, const LEAST: usize> JsonSchema for Ascending<T, LEAST> {
    fn schema_name() -> Cow<'static, str> {
        std::any::type_name::<Self>().into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let items = T::json_schema(generator);
        json_schema!({
            "title": format!("a list of at least {LEAST} increasing numbers"),
            "type": "array",
            "items": items,
            "minItems": LEAST,
        })
    }
}
