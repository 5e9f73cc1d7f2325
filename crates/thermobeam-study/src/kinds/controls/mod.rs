//! Planted faults: solver or sources are wrong on purpose, and a convergence study must fail.
//!
//! A check that cannot fail proves nothing. The study file says by one of three tables what is asked:
//!
//! | table | question |
//! | --- | --- |
//! | `[controls]` | does some study fail for each coefficient off by a given relative amount, and for each defect of the sources? |
//! | `[any-order]` | the same for studies of kind any-order: does each fail for every coefficient named? |
//! | `[sensitivity]` | from which relative error of each coefficient on does a study fail? |

pub mod any_order;
mod fault;
pub mod matrix;
pub mod sensitivity;
mod untested;

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{Check, Header, KindRow, Study, reader};

pub use fault::Fault;
pub(in crate::kinds) use untested::untested;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "controls",
    read,
    why: "A check that cannot fail proves nothing. Each coefficient of the solver in turn is put off a little from that of the \
          sources, and each defect in turn is planted in the sources. A study that guards a coefficient detects an error in it \
          from some size on; bisection finds that size.",
    judged: "Every fault must make at least one of the studies fail; without a fault, all of them must pass. Of every \
             coefficient some study must detect a relative error as small as the file says.",
    failure: "A fault that no study detects: errors of this size in this place would go unnoticed, because a study has lost \
              levels or its tolerance has grown.",
};

/// What is found of studies without a fault: how many pass, and which do not.
fn without_a_fault<'s>(studies: impl Iterator<Item = (&'s str, bool)>) -> Check {
    let (passing, others): (Vec<_>, Vec<_>) = studies.partition(|(_, passes)| *passes);
    let others: Vec<&str> = others.into_iter().map(|(id, _)| id).collect();
    let mut evidence = format!("{} of {} pass", passing.len(), passing.len() + others.len());
    if !others.is_empty() {
        evidence += &format!("; not {}", others.join(", "));
    }
    Check::that(others.is_empty(), "without a fault every study passes", evidence)
}

/// The tables of which a study file has one.
const TABLES: [&str; 3] = ["controls", "any-order", "sensitivity"];

/// Reads a study of planted faults, or of the smallest that are detected, whichever table the file has.
fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    root.allow(&[&["study"], &TABLES[..]].concat())?;
    let allowed = "one of the tables [controls], [any-order] and [sensitivity]";
    let found: Vec<&str> = TABLES.into_iter().filter(|table| root.get(table).is_some()).collect();
    match found[..] {
        [] => Err(root.missing("controls", allowed)),
        ["controls"] => reader::<matrix::Controls>(header, root, folder),
        ["any-order"] => reader::<any_order::AnyOrderControls>(header, root, folder),
        ["sensitivity"] => reader::<sensitivity::Sensitivity>(header, root, folder),
        [_, second, ..] => Err(root.refuse(second, "a second table", allowed)),
        [other] => Err(root.missing(other, allowed)),
    }
}
