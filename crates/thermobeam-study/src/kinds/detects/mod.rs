//! Planted faults: solver or sources are wrong on purpose, and a convergence study must fail.
//!
//! A check that cannot fail proves nothing. The study file asks its question by one of two
//! tables:
//!
//! | table | question |
//! | --- | --- |
//! | `[controls]` | does some study fail for each coefficient with a given relative error, and for each defect of the sources? |
//! | `[any-order]` | the same for studies of kind orders/any-order: does each fail for every coefficient and defect named? |
//!
//! And of any study that passes `untested` says which coefficients it does not test, by the same
//! means.
//!
//! For `[controls]` each coefficient of the solver in turn is perturbed by a relative amount, while
//! the sources keep the exact one; each [`Defect`](crate::exact::defect::Defect) in turn is planted
//! in the sources. Sources and solver share no function, so it stands for the same mistake in the
//! solver. Without a fault every study must pass, since otherwise its failures would prove nothing.
//!
//! ```toml
//! [controls]
//! relative = 1e-4
//! studies = ["theorem-3.4-space.toml"]    # files beside this one
//! elements = [64, 128, 256]               # optional: levels in place of the studies' own
//! ```

mod any_order;
mod manufactured;
mod matrix;

pub use super::orders::planted::fault::{Fault, Planted};
pub use super::orders::planted::plantable::Plantable;
pub use matrix::{Detects, RunOf, UnderFaults};

use super::orders::{ErrorSource, Orders, any_order::AnyOrder, manufactured::Convergence};
use super::prelude::*;
use crate::kinds::settings::{ActiveTerms, Exercise, Integration, MANUFACTURED};
use convergence_study::{Study, internal::study::Described};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "detects",
    keys: &[
        Detects::<Convergence>::KEYS[0],
        Detects::<AnyOrder>::KEYS[0],
    ],
    schema: None,
    read,
    why: "A check that cannot fail proves nothing. Each coefficient of the solver in turn is put off a little from that of the \
          sources, and each defect in turn is planted in the sources.",
    judged: "Every fault must make at least one of the studies fail; without a fault, all of them must pass.",
    failure: "A fault that no study detects: errors of this size in this place would go unnoticed, because a study has lost \
              levels or its tolerance has grown.",
};

const RELATIVE_KEY: Key = Key::new(
    "relative",
    Form::Positive,
    "relative size of a planted error, below 1",
);
const STUDIES: Key = Key::new(
    "studies",
    Form::List(&Form::Text),
    "study files, relative to this file",
);
const ELEMENTS: Key = Key::new(
    "elements",
    Form::List(&Form::Count(1)),
    "numbers of elements in place of those of the studies",
)
.or("those of the studies");

/// What an item exercises: what the study does that it is about, or all of them.
fn exercise<S: ErrorSource>(studies: &[Described<Orders<S>>], subject: &Subject) -> Exercise {
    let case = subject.case.as_deref();
    let named = studies.iter().find(|study| Some(&*study.header.id) == case);
    let all = match named {
        Some(study) => std::slice::from_ref(study),
        None => studies,
    };
    let all = all.iter().map(|study| study.kind.exercise());
    all.reduce(Exercise::and)
        .unwrap_or_else(|| Exercise::new(MANUFACTURED, Integration::PAPER, ActiveTerms::default()))
}

/// Reads a study of planted faults in studies of one kind, depending on the table in the file.
fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    let allowed = "one of the tables [controls] and [any-order]";
    match only_table(root, ["controls", "any-order"], allowed)? {
        "controls" => read_study::<Detects<Convergence>>(header, root, folder),
        _ => read_study::<Detects<AnyOrder>>(header, root, folder),
    }
}
