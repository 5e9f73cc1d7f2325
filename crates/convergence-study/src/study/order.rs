//! Claims of files about an error: `order = 2` or `order = ">= 2"`, optionally with
//! `constant = [0.9, 1.1]`.

use std::borrow::Cow;
use std::fmt::{self, Formatter};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{self, Deserializer, IntoDeserializer, Unexpected, Visitor};

use crate::input::{Positive, Refusal};
use crate::interval::Interval;
use convergence_judge::claims::{Bound, Claim, order_from_text};

/// The order that a study claims of an error, or a number written in the same way: a number, or a
/// text such as `">= 2"`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// The order.
    pub order: f64,
    /// Whether it is the least one.
    pub bound: Bound,
}

/// How many times as large as the lower end of a constant the upper one may be.
const MOST_APART: f64 = 100.0;

/// The two ends of a constant, the smaller first.
pub(crate) type Constant = [Positive; 2];

impl Order {
    /// The claim.
    ///
    /// * `constant`: the ends of the C of error = C h^order.
    /// * `tolerance`: how far the rate may be from the order; without it as usual.
    ///
    /// # Errors
    /// The ends are not ascending, or so far apart that any constant is between.
    pub fn claim(
        self,
        constant: Option<Constant>,
        tolerance: Option<Positive>,
    ) -> Result<Claim, Refusal> {
        let ends = constant.map(|ends| ends.map(Positive::get));
        if ends.is_some_and(|[low, high]| low >= high || high > MOST_APART * low) {
            let allowed = "two numbers > 0 beside order, the smaller first, the other at most 100 times as large";
            return Err(Refusal::written("constant", allowed));
        }
        let usual = Claim::usual(self.order, self.bound);
        Ok(Claim {
            constant: ends.map(|[low, high]| Interval { low, high }),
            tolerance: tolerance.map_or(usual.tolerance, Positive::get),
            ..usual
        })
    }
}

/// What an order may be, in words.
pub(crate) const ORDER: &str =
    "a number > 0, or a text such as \">= 2\", or \">= 2..\" for any higher rate";

impl<'de> Deserialize<'de> for Order {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reads;
        impl Visitor<'_> for Reads {
            type Value = Order;

            fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
                f.write_str(ORDER)
            }

            fn visit_f64<E: de::Error>(self, order: f64) -> Result<Order, E> {
                let order = Positive::deserialize(order.into_deserializer())?.get();
                let bound = Bound::Both;
                Ok(Order { order, bound })
            }

            fn visit_i64<E: de::Error>(self, order: i64) -> Result<Order, E> {
                self.visit_f64(order as f64)
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Order, E> {
                let least = order_from_text(text).filter(|(_, bound)| bound.is_least());
                let (order, bound) =
                    least.ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))?;
                Ok(Order { order, bound })
            }
        }
        deserializer.deserialize_any(Reads)
    }
}

impl JsonSchema for Order {
    fn schema_name() -> Cow<'static, str> {
        "order".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = Positive::json_schema(generator);
        let text = json_schema!({ "type": "string", "examples": [">= 2", ">= 2.."] });
        json_schema!({ "title": ORDER, "anyOf": [number, text] })
    }
}
