//! Planted faults: solver or sources are wrong on purpose, and a convergence study must fail.
//!
//! A check that cannot fail proves nothing. The study file says by one of two tables what is asked:
//!
//! | table | question |
//! | --- | --- |
//! | `[controls]` | does some study fail for each coefficient off by a given relative amount, and for each defect of the sources? |
//! | `[sensitivity]` | from which relative error of each coefficient on does a study fail? |

mod fault;
pub mod matrix;
pub mod sensitivity;

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{Header, KindRow, Study, reader};

pub use fault::Fault;

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

/// The tables of which a study file has one.
const TABLES: [&str; 2] = ["controls", "sensitivity"];

/// Reads a study of planted faults, or of the smallest that are detected, whichever table the file has.
fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    root.allow(&[&["study"], &TABLES[..]].concat())?;
    let allowed = "one of the tables [controls] and [sensitivity]";
    match TABLES.map(|table| root.get(table).is_some()) {
        [false, false] => Err(root.missing("controls", allowed)),
        [true, true] => Err(root.refuse("sensitivity", "a second table", allowed)),
        [true, false] => reader::<matrix::Controls>(header, root, folder),
        [false, true] => reader::<sensitivity::Sensitivity>(header, root, folder),
    }
}
