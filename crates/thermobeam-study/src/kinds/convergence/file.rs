//! Convergence-study files: an exact solution, what is refined, and the orders expected.
//!
//! ```toml
//! [study]
//! id = "theorem-3.4-space"
//! claim = "Theorem 3.4: first order in h"
//! tier = "quick"
//!
//! [exact]                     # sums of products, functions of x and of t; `[beam]`, `[obstacles]` as in a scene
//! u     = [{ x = "0.3*sin(1.3*pi*x)", t = "cos(3*t) + 0.2*t" }]
//! theta = [{ x = "(1+x)*sin(pi*x)", t = "exp(-t)" }]
//!
//! [refine]
//! axis = "space"
//! isolate = true
//! elements = [8, 16, 32, 64]
//! steps = 20
//! t_end = 1.0
//!
//! [control]                   # optional: coefficients in which the solver differs from the sources
//! zeta = 0.101
//!
//! [[expect]]
//! norm = "theorem-3.4"
//! order = 1.0
//! tolerance = 0.05
//! ```

use std::path::Path;

use thermobeam::parameters::{Beam, Obstacles};

use crate::scene::tables;
use convergence_study::input::{self, InputError, Section};

use crate::kinds::tables::{Control, Expectation, Manufactured, Refine, control, expectations, manufactured, refine};
use convergence_study::study::{Header, Tier};

/// The kind of a convergence study.
pub const CONVERGENCE: &str = "convergence";

/// A convergence study, validated.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvergenceSpec {
    /// The study's name, which says its claim in short.
    pub id: String,
    /// What is claimed, in words.
    pub claim: String,
    /// When it is run.
    pub tier: Tier,
    /// What sort of thing is claimed.
    pub group: String,
    /// Coefficients from which the sources are derived.
    pub beam: Beam,
    /// Obstacles from which the boundary load is derived.
    pub obstacles: Option<Obstacles>,
    /// The exact solution; it meets the essential boundary conditions.
    pub exact: Manufactured,
    /// What is refined and how.
    pub refine: Refine,
    /// The solver's own coefficients, where they differ: then the study must fail.
    pub control: Option<Control>,
    /// The orders expected; at least one, each norm once.
    pub expect: Vec<Expectation>,
}

impl ConvergenceSpec {
    /// Reads a study file.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        Self::parse(&input::read_text(path)?, &path.display().to_string())
    }

    /// Reads a study from `text`; complaints refer to `file_name`.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, InputError> {
        input::parse(text, file_name, Self::from_document)
    }

    /// The coefficients that the solver works with: those of the control, or else those of the sources.
    pub fn solver_coefficients(&self) -> (Beam, Option<Obstacles>) {
        self.control.as_ref().map_or((self.beam, self.obstacles), |control| (control.beam, control.obstacles))
    }

    fn from_document(root: &Section<'_>) -> Result<Self, InputError> {
        let Header { id, claim, tier, kind, group } = Header::from_document(root)?;
        if kind != CONVERGENCE {
            let study = root.require("study", "a table")?.section()?;
            return Err(study.refuse("kind", format!("\"{kind}\""), format!("\"{CONVERGENCE}\" for this reader")));
        }
        root.allow(&["study", "beam", "obstacles", "exact", "refine", "control", "expect"])?;
        let beam = tables::beam(root)?;
        let obstacles = tables::obstacles(root)?;
        let refine = refine(root)?;
        let exact = manufactured(root, &beam, refine.t_end)?;
        let control = control(root, beam, obstacles)?;
        let expect = expectations(root)?;
        Ok(Self { id, claim, tier, group, beam, obstacles, exact, refine, control, expect })
    }
}
