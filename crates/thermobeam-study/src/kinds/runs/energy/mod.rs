//! Proposition 3.1 and a sharper form of it: the energy never rises, and its balance closes in
//! every step.
//!
//! An exactly solved step without loads satisfies, with the energy E of (3.9),
//!
//! ```text
//! E^n - E^{n-1} + dt ζ (‖v_x - w‖² + ‖w_x‖²) + dt ‖θ_x‖² (at n-½)
//!     + ½ (‖v - v0‖² + ‖w - w0‖²) + gap = 0,
//! ```
//!
//! where gap >= 0 comes from the contact term. Only the first difference can be negative, so E
//! cannot rise. An energy may decrease by chance, whereas a missing or wrong term opens the balance
//! in the first step in which it acts.
//!
//! A study file selects its scenes by one of three tables:
//!
//! * `[energy]`: scene files and smooth random beams, by every scheme listed: a fixed bound on rise
//!   and residual
//! * `[[case]]`: single scenes at the limits of the allowed range, each with its own claim and the
//!   way its run must end
//! * `[random]`: batches of random scenes, in lanes
//!
//! Rise and residual of `[[case]]` and `[random]` are bounded by 1e-12 of the energy or, if that is
//! larger, by a bound on the rounding errors of the step.

mod beams;
mod bound;
pub mod one_by_one;
pub mod random;

use crate::kinds::prelude::*;
use convergence_study::{Document, Study};
use one_by_one::{EnergyRuns, listed};
use random::RandomScenes;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/energy",
    schema: schema::<EnergyFile>,
    read,
    why: "An exactly solved step obeys a balance: the change of the energy, the viscous and the thermal dissipation, that of the \
          Euler scheme and the gap of the contact energy add up to zero. All but the first are not negative, so the energy \
          cannot rise (Proposition 3.1). Scenes at the limits of every range, and random ones, test it where nobody would look.",
    judged: "Every step of every run: the energy must not rise and the balance must close, up to rounding errors. A run must end \
             with its answer or, where the scene asks for it, with the failure that it names.",
    failure: "A term of the step or of the energy is wrong, or a step has not been solved. The balance shows the defect in the \
              very step in which it happens. Run the scene named alone.",
};

/// A study of the energy, by one of three tables.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EnergyFile {
    /// beams, and how they are run
    energy: Option<listed::EnergyTable>,
    /// scenes, and what is claimed of their runs
    case: Option<Vec<listed::CaseTable>>,
    /// random scenes, in lanes
    random: Option<random::RandomTable>,
}

impl EnergyFile {
    /// Its table, as a file may have only one of them.
    fn only_table(&self) -> Result<&'static str, Refusal> {
        let allowed = "one of the tables [energy], [[case]] and [random]";
        let tables = [
            ("energy", self.energy.is_some()),
            ("case", self.case.is_some()),
            ("random", self.random.is_some()),
        ];
        let given = tables.iter().filter(|(_, is_given)| *is_given);
        match given.map(|(table, _)| *table).collect::<Vec<_>>()[..] {
            [] => Err(Refusal::missing("energy", allowed)),
            [only] => Ok(only),
            [_, second, ..] => Err(Refusal::new(second, "a second table", allowed)),
        }
    }
}

/// Reads a study of scenes, of cases or of random scenes, depending on the table in the file.
fn read(header: Header, root: &Document<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    match root.described(|file: EnergyFile| file.only_table())? {
        "random" => RandomScenes::read_study(header, root, folder),
        _ => EnergyRuns::read_study(header, root, folder),
    }
}
