//! How records stand in JSON where their fields do not say it by themselves.

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::{Errors, Parameters};

pub(in crate::store) use crate::study::outcome::null_is_nan;

/// The same of each number of a list.
pub(in crate::store) fn null_is_nan_in<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let numbers: Vec<Option<f64>> = Vec::deserialize(deserializer)?;
    Ok(numbers.into_iter().map(|number| number.unwrap_or(f64::NAN)).collect())
}

/// The same of both ends of an interval.
pub(in crate::store) fn null_is_nan_of_pair<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<[f64; 2]>, D::Error> {
    let ends: Option<[Option<f64>; 2]> = Option::deserialize(deserializer)?;
    Ok(ends.map(|ends| ends.map(|end| end.unwrap_or(f64::NAN))))
}

impl Serialize for Errors {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (norm, error) in &self.0 {
            map.serialize_entry(norm, error)?;
        }
        map.end()
    }
}

impl Serialize for Parameters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            let whole = *value as i64;
            if whole as f64 == *value { map.serialize_entry(name, &whole)? } else { map.serialize_entry(name, value)? }
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Errors {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Numbers).map(Self)
    }
}

impl<'de> Deserialize<'de> for Parameters {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Numbers).map(Self)
    }
}

/// Names and numbers in their order.
struct Numbers;

impl<'de> Visitor<'de> for Numbers {
    type Value = Vec<(String, f64)>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of numbers")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Self::Value, M::Error> {
        let mut numbers = vec![];
        while let Some((name, value)) = map.next_entry::<String, Option<f64>>()? {
            numbers.push((name, value.unwrap_or(f64::NAN)));
        }
        Ok(numbers)
    }
}
