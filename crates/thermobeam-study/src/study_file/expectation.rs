//! The tables `[[expect]]`: in which norm which order.

use crate::document::{InputError, Section};

/// A norm of the error, each the maximum over the time levels n = 1..N.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Norm {
    /// ‖û - u_t‖.
    Velocity,
    /// ‖u_hx - φ_h - (u_x - φ)‖.
    Shear,
    /// ‖φ̂ - φ_t‖.
    RotationRate,
    /// ‖φ_hx - φ_x‖.
    Curvature,
    /// ‖θ_h - θ‖.
    Temperature,
    /// Root of the sum of the squares of the five before, at the same n: the left-hand side of Theorem 3.4.
    Theorem34,
    /// ‖u_h - u‖.
    Displacement,
    /// As [`Norm::Theorem34`], of the distance to the nodal interpolants of the exact solution: Z_n^½ of (3.16).
    Superclose,
}

impl Norm {
    /// All norms.
    pub const ALL: [Norm; 8] = [
        Norm::Velocity,
        Norm::Shear,
        Norm::RotationRate,
        Norm::Curvature,
        Norm::Temperature,
        Norm::Theorem34,
        Norm::Displacement,
        Norm::Superclose,
    ];

    /// The name in study files and records.
    pub fn name(self) -> &'static str {
        match self {
            Norm::Velocity => "velocity",
            Norm::Shear => "shear",
            Norm::RotationRate => "rotation-rate",
            Norm::Curvature => "curvature",
            Norm::Temperature => "temperature",
            Norm::Theorem34 => "theorem-3.4",
            Norm::Displacement => "displacement",
            Norm::Superclose => "superclose",
        }
    }
}

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
    let positive = |key: &str| {
        let allowed = "a finite number > 0";
        section.require(key, allowed)?.number_where(allowed, |value| value > 0.0)
    };
    Ok(Expectation {
        norm: section.require("norm", &names)?.choice(&norms)?,
        order: positive("order")?,
        tolerance: positive("tolerance")?,
    })
}
