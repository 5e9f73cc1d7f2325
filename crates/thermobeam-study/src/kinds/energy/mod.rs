//! Proposition 3.1 and a sharper form of it: the energy never rises, and its balance closes in every step.
//!
//! An exactly solved step without loads satisfies, with the energy E of (3.9),
//!
//! ```text
//! E^n - E^{n-1} + dt ζ (‖v_x - w‖² + ‖w_x‖²) + dt ‖θ_x‖² (at n-½) + ½ (‖v - v0‖² + ‖w - w0‖²) + gap = 0,
//! ```
//!
//! where gap >= 0 comes from the contact term. Only the first difference can be negative, so E cannot rise. An energy may
//! decrease by chance, whereas a missing or wrong term opens the balance in the first step in which it acts.
//!
//! A study file selects its scenes by one of three tables:
//!
//! | table | scenes |
//! | --- | --- |
//! | `[energy]` | scene files and smooth random beams, by every scheme listed: a fixed bound on rise and residual |
//! | `[[case]]` | single scenes at the limits of the allowed range, each with its own claim and the way its run must end |
//! | `[random]` | batches of random scenes, in lanes |
//!
//! Rise and residual of `[[case]]` and `[random]` are bounded by 1e-12 of the energy or, if that is larger, by a bound on
//! the rounding errors of the step.

mod beams;
pub mod random;
pub mod runs;

use convergence_study::study::Study;

use super::prelude::*;
pub use super::watch::Worst;

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

/// Reads a study of scenes, of cases or of random scenes, depending on the table in the file.
fn read(header: Header, root: &Section<'_>, folder: &Path) -> Result<Box<dyn Study>, InputError> {
    let tables = ["energy", "case", "random"];
    root.allow(&[&["study"], &tables[..]].concat())?;
    let allowed = "one of the tables [energy], [[case]] and [random]";
    let mut present = tables.into_iter().filter(|table| root.get(table).is_some());
    match (present.next(), present.next()) {
        (None, _) => Err(root.missing("energy", allowed)),
        (Some(_), Some(second)) => Err(root.refuse(second, "a second table of scenes", allowed)),
        (Some("random"), None) => reader::<random::RandomScenes>(header, root, folder),
        (Some(_), None) => reader::<runs::EnergyRuns>(header, root, folder),
    }
}

/// The tables `[[case]]`, each with a unique name.
pub(in crate::kinds) fn named_cases<C>(
    root: &Section<'_>,
    read: impl Fn(&Section<'_>, String) -> Result<C, InputError>,
) -> Result<Vec<C>, InputError> {
    let mut names = std::collections::BTreeSet::new();
    root.tables("case", "", |section| {
        let name = section.require("name", "a text")?.text()?.to_owned();
        let case = read(section, name.clone())?;
        if names.insert(name.clone()) {
            return Ok(case);
        }
        Err(section.refuse("name", format!("a second \"{name}\""), "a name that no other case has"))
    })
}

/// How a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum End {
    /// After its last step.
    #[default]
    Answer,
    /// At a step whose operator is not definite.
    Indefinite,
    /// At a step whose iteration diverges or needs too many iterations.
    IterationLimit,
    /// At a step with numbers that are not finite.
    NotFinite,
}

impl End {
    /// All ends, with their names in study files and reports.
    pub const ALL: [(&str, End); 4] = [
        ("answer", End::Answer),
        ("indefinite", End::Indefinite),
        ("iteration-limit", End::IterationLimit),
        ("not-finite", End::NotFinite),
    ];

    /// The end of a run.
    ///
    /// # Errors
    /// The failure, if it is not a failed step of a one-step scheme.
    pub(crate) fn of(failure: Option<&RunError>) -> Result<Self, RunError> {
        let Some(run) = failure else { return Ok(End::Answer) };
        let RunError::Step(StepError { failure, .. }) = run else { return Err(run.clone()) };
        match failure {
            StepFailure::Indefinite { .. } => Ok(End::Indefinite),
            StepFailure::Diverged { .. } | StepFailure::IterationLimit { .. } => Ok(End::IterationLimit),
            StepFailure::NonFinite { .. } => Ok(End::NotFinite),
            _ => Err(run.clone()),
        }
    }

    /// Its name in study files and reports.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }
}
