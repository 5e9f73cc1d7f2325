//! Numbers in JSON: a number that is not finite is `null`, and `null` is read as NaN; named numbers
//! are an object in their own order.

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{SerializeMap, Serializer};

use super::named::NamedNumber;

/// A number; `null` is NaN.
pub fn nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Option::deserialize(deserializer).map(|number| number.unwrap_or(f64::NAN))
}

/// The same for each number of a list.
pub fn nans<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let numbers: Vec<Option<f64>> = Vec::deserialize(deserializer)?;
    Ok(numbers
        .into_iter()
        .map(|number| number.unwrap_or(f64::NAN))
        .collect())
}

/// Names and numbers as an object.
pub mod named {
    use super::{Deserializer, Named, NamedNumber, SerializeMap, Serializer};

    /// As serde asks for it.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(
        numbers: &[NamedNumber],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(numbers.len()))?;
        numbers
            .iter()
            .try_for_each(|NamedNumber { name, value }| map.serialize_entry(name, value))?;
        map.end()
    }

    /// As serde asks for it.
    ///
    /// # Errors
    /// Those of the deserializer.
    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<NamedNumber>, D::Error> {
        deserializer.deserialize_map(Named)
    }
}

/// The same, with whole numbers written without a decimal point.
pub mod counted {
    use super::{NamedNumber, SerializeMap, Serializer};

    pub use super::named::deserialize;

    /// As serde asks for it.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(
        numbers: &[NamedNumber],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(numbers.len()))?;
        for NamedNumber { name, value } in numbers {
            let whole = *value as i64;
            if whole as f64 == *value {
                map.serialize_entry(name, &whole)?;
            } else {
                map.serialize_entry(name, value)?;
            }
        }
        map.end()
    }
}

/// Reads an object of numbers.
struct Named;

impl<'de> Visitor<'de> for Named {
    type Value = Vec<NamedNumber>;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("an object of numbers")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Self::Value, M::Error> {
        let mut numbers = vec![];
        while let Some((name, value)) = map.next_entry::<String, Option<f64>>()? {
            numbers.push(NamedNumber::new(name, value.unwrap_or(f64::NAN)));
        }
        Ok(numbers)
    }
}
