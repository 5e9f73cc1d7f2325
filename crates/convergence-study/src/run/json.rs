//! A finished study as JSON: its fields, and the list of what did not pass, which is written only,
//! because it follows from them.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::failures::items_not_passed;
use super::{Finished, Item};

#[derive(Serialize)]
struct Written<'f> {
    #[serde(flatten, serialize_with = "Finished::serialize")]
    finished: &'f Finished,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    not_passed: Vec<Item>,
}

impl Serialize for Finished {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let written = Written {
            finished: self,
            not_passed: items_not_passed(self),
        };
        written.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Finished {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::deserialize(deserializer)
    }
}
