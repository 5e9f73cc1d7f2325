//! The tables `[[expect]]`: in which norm which order.

use crate::exact::norm::Norm;
use convergence_study::input::{InputError, Section};

/// The order that theory gives for a norm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expectation {
    /// The norm.
    pub norm: Norm,
    /// The order, > 0.
    pub order: f64,
    /// How far the observed rate may be from it, above or below, > 0.
    pub tolerance: f64,
}

/// All tables `[[expect]]`.
pub(crate) fn expectations(root: &Section<'_>) -> Result<Vec<Expectation>, InputError> {
    let allowed = "at least one table [[expect]] with norm, order and tolerance";
    let field = root.require("expect", allowed)?;
    let mut expectations: Vec<Expectation> = Vec::new();
    for item in field.items(allowed)? {
        let section = item.section()?;
        let expectation = expectation(&section)?;
        if expectations.iter().any(|earlier| earlier.norm == expectation.norm) {
            let found = format!("\"{}\" a second time", expectation.norm.name());
            return Err(section.refuse("norm", found, "each norm once"));
        }
        expectations.push(expectation);
    }
    if expectations.is_empty() { Err(field.refuse_as_written(allowed)) } else { Ok(expectations) }
}

fn expectation(section: &Section<'_>) -> Result<Expectation, InputError> {
    section.allow(&["norm", "order", "tolerance"])?;
    let norms = Norm::ALL.map(|norm| (norm.name(), norm));
    let names = norms.map(|(name, _)| format!("\"{name}\"")).join(", ");
    Ok(Expectation {
        norm: section.require("norm", &names)?.choice(&norms)?,
        order: section.positive("order")?,
        tolerance: section.positive("tolerance")?,
    })
}
