//! What other programs need to know of the variants of a file: a form for JSON.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Switch, Variants};

/// The variants of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Description {
    /// The size of the solution of the file.
    pub size: f64,
    /// Those that can be used.
    pub usable: Vec<DescribedVariant>,
    /// The others.
    pub left_out: Vec<DescribedVariant>,
    /// The names of the data at each side.
    pub data: BTreeMap<String, Vec<String>>,
}

/// A variant.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DescribedVariant {
    /// Its name, the value of `MANUFACTURE_VARIANT`.
    pub name: String,
    /// What it switches off.
    pub switches_off: Switch,
    /// The size of its solution; absent if it cannot be used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<f64>,
    /// Why it cannot be used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl Description {
    /// The literal `VARIANTS` of a module in Python, which JSON without null and booleans is.
    pub(super) fn literal(&self) -> String {
        let literal = serde_json::to_string_pretty(self).unwrap_or_default();
        format!(
            "\n# For `study(..., variants=module)` of the package convergence_study.\nVARIANTS = {literal}\n"
        )
    }
}

impl DescribedVariant {
    fn new(switch: &Switch, size: Option<f64>, why: Option<String>) -> Self {
        Self {
            name: switch.variant(),
            switches_off: switch.clone(),
            size,
            why,
        }
    }
}

impl Variants<'_> {
    /// The variants in a form that JSON and literals of Python have.
    pub fn description(&self) -> Description {
        let usable = self.usable.iter();
        let left_out = self.left_out.iter();
        let faces = self.switches().filter_map(|switch| match switch {
            Switch::Face(name) => Some(name),
            _ => None,
        });
        let data = faces.map(|face| {
            let names = self.data_at(face).into_iter().map(str::to_owned);
            (face.clone(), names.collect())
        });
        Description {
            size: self.size,
            usable: usable
                .map(|one| DescribedVariant::new(&one.switch, Some(one.size), None))
                .collect(),
            left_out: left_out
                .map(|one| DescribedVariant::new(&one.switch, None, Some(one.why.clone())))
                .collect(),
            data: data.collect(),
        }
    }
}
