//! Proposition 3.1, and sharper: the energy never rises, and its balance closes in every step.
//!
//! An exactly solved step without loads satisfies, with the energy E of (3.9),
//!
//! ```text
//! E^n - E^{n-1} + dt ζ (‖v_x - w‖² + ‖w_x‖²) + dt ‖θ_x‖² (at n-½) + ½ (‖v - v0‖² + ‖w - w0‖²) + gap = 0,
//! ```
//!
//! gap >= 0 being the contact term's. No term but the first difference is negative, so E cannot rise. An energy can fall by
//! luck, while a missing or wrong term opens the balance in the first step in which it acts.
//!
//! A study file says by one of three tables which scenes are run:
//!
//! | table | scenes |
//! | --- | --- |
//! | `[energy]` | scene files and smooth random beams, by every scheme listed: a fixed bound on rise and residual |
//! | `[[case]]` | single scenes at the limits of what is allowed, each with its own claim and the end that it must come to |
//! | `[random]` | batches of random scenes, in lanes |
//!
//! Rise and residual of `[[case]]` and `[random]` are bounded by 1e-12 of the energy or, where that is larger, by a bound on
//! the rounding errors of the step.

mod beams;
mod end;
mod file;
pub mod random;
pub mod runs;

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{Header, KindRow, Study, reader};

pub use super::watch::Worst;
pub use end::End;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "energy",
    read,
    why: "An exactly solved step obeys a balance: the change of the energy, the viscous and the thermal dissipation, that of the \
          Euler scheme and the gap of the contact energy add up to zero. All but the first are not negative, so the energy \
          cannot rise (Proposition 3.1). Scenes at the limits of every range, and random ones, test it where nobody would look.",
    judged: "Every step of every run: the energy must not rise and the balance must close, up to rounding errors. A run must end \
             with its answer or, where the scene asks for it, with the failure that it names.",
    failure: "A term of the step or of the energy is wrong, or a step has not been solved. The balance shows the defect in the \
              very step in which it happens. Run the scene named alone.",
};

/// The tables of which a study file has one.
const TABLES: [&str; 3] = ["energy", "case", "random"];

/// Reads a study of scenes, of cases or of random scenes, whichever table the file has.
fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    root.allow(&[&["study"], &TABLES[..]].concat())?;
    let allowed = "one of the tables [energy], [[case]] and [random]";
    let mut present = TABLES.into_iter().filter(|table| root.get(table).is_some());
    match (present.next(), present.next()) {
        (None, _) => Err(root.missing("energy", allowed)),
        (Some(_), Some(second)) => Err(root.refuse(second, "a second table of scenes", allowed)),
        (Some("random"), None) => reader::<random::RandomScenes>(header, root, folder),
        (Some(_), None) => reader::<runs::Runs>(header, root, folder),
    }
}
