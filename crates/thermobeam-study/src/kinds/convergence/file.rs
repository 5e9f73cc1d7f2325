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

use convergence_study::input::{InputError, Section};
use convergence_study::study::{FromFile, Header};

use super::{Convergence, ROW};
use crate::kinds::tables::{control, expectations, manufactured, refine};
use crate::scene::tables;

impl FromFile for Convergence {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        // Studies of other kinds name files of this kind.
        if header.kind != ROW.name {
            let study = root.require("study", "a table")?.section()?;
            return Err(study.refuse(
                "kind",
                format!("\"{}\"", header.kind),
                format!("\"{}\" for this reader", ROW.name),
            ));
        }
        root.allow(&["study", "beam", "obstacles", "exact", "refine", "control", "expect"])?;
        let beam = tables::beam(root)?;
        let obstacles = tables::obstacles(root)?;
        let refine = refine(root)?;
        let exact = manufactured(root, &beam, refine.t_end)?;
        let control = control(root, beam, obstacles)?;
        let expect = expectations(root)?;
        Ok(Self { header, beam, obstacles, exact, refine, control, expect })
    }
}
