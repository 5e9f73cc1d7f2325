//! What study files claim of an error: `order = 2` or `order = ">= 2"`, and `constant = [0.9, 1.1]` beside it.

use super::levels::Claim;
use crate::input::{Field, InputError, Section};
use crate::judge::claims::order_from_text;
use crate::judge::verdict::DEFAULT_TOLERANCE;

impl Claim {
    /// The claim of a table, with the default tolerance: which a study may be given is its kind's affair.
    ///
    /// * `key`: where the order is, or a number that is written in the same way.
    pub fn read(section: &Section<'_>, key: &str) -> Result<Self, InputError> {
        let allowed = "a number > 0, or a text such as \">= 2\"";
        let field = section.require(key, allowed)?;
        let (order, at_least) = match field.text() {
            Ok(text) => {
                order_from_text(text).filter(|(_, least)| *least).ok_or_else(|| field.refuse_as_written(allowed))?
            }
            Err(_) => (field.positive()?, false),
        };
        Ok(Self { at_least, constant: constant(section)?, ..Self::new(order, DEFAULT_TOLERANCE) })
    }
}

fn constant(section: &Section<'_>) -> Result<Option<[f64; 2]>, InputError> {
    let Some(field) = section.get("constant") else { return Ok(None) };
    let allowed = "two numbers > 0, the smaller first, beside order";
    let ends: Vec<f64> = field.items(allowed)?.iter().map(Field::positive).collect::<Result<_, _>>()?;
    match ends[..] {
        [least, most] if least < most && section.get("order").is_some() => Ok(Some([least, most])),
        _ => Err(field.refuse_as_written(allowed)),
    }
}
