//! Many scenes from one: a grid or a Latin hypercube over the numbers of a base scene, for one-step
//! schemes and any order.
//!
//! ```toml
//! [sweep]
//! scene = "scenes/paper-1-beta-0.toml"      # a file beside this one
//!
//! [set]                                     # optional: what every case has in common
//! time.t_end = 1.0
//! initial.theta = "{beam.theta_a}*(1-x)"    # {key}: the case's value of a key that varies
//!
//! [grid]                                    # every combination, the last key running fastest
//! beam.beta = [-0.5, 0.0, 5.0]
//! beam.theta_a = { from = 0.0, to = 20.0, count = 5 }
//! obstacles.epsilon = { from = 1e-4, to = 1e-2, count = 3, scale = "log" }
//! ```
//!
//! or, instead of `[grid]`,
//!
//! ```toml
//! [latin]                                   # as many cases as samples, each key stratified into as many slices
//! samples = 1000
//! seed = 1
//! beam.beta = { from = -0.5, to = 5.0 }
//! mesh.elements = { from = 20, to = 200, scale = "log" }
//! ```
//!
//! Cases are numbered from 0. A case's results depend on the files alone: any number of threads,
//! shares and interruptions gives the same bytes. Computed numbers are rounded to 9 digits, so that
//! a different mathematical library cannot move a case to another share.

mod case;
mod design;
mod journal;
mod lines;
mod reader;
mod run;

use std::path::Path;

use crate::scene::{Scene, limits};
use convergence_study::{InputError, internal::input};

pub use case::{SceneKey, SweepCase, SweepShare};
pub use journal::{Journal, Manifest, Merged, RESULTS, merge};
pub use lines::SweepError;
pub use run::{CaseLine, InOrder, run};

use design::Design;

/// Largest number of cases of a sweep.
pub const MOST_CASES: usize = limits::SWEEP_CASES;

/// A sweep file, read and validated.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The file's name without folder and extension.
    pub name: String,
    base: Base,
    keys: Vec<SceneKey>,
    design: Design,
    fingerprint: u64,
}

/// The base scene, as text: every case reads it with its own values instead of the scene's.
#[derive(Debug, Clone)]
struct Base {
    file: String,
    text: String,
    /// The part common to all cases: TOML in which `{key}` stands for the case's value.
    set: String,
}

impl Base {
    /// The scene with these values.
    fn scene(&self, values: impl Iterator<Item = (SceneKey, f64)>) -> Result<Scene, InputError> {
        let mut overlay = self.set.clone();
        for (key, value) in values {
            let (path, written) = (key.path(), key.written(value));
            // In brackets, so that a negative number keeps its sign under a power.
            overlay = overlay.replace(&format!("{{{path}}}"), &format!("({written})"));
            overlay.push_str(&format!("{path} = {written}\n"));
        }
        Scene::parse_overlaid(&self.text, &overlay, &self.file)
    }
}

impl Sweep {
    /// Reads a sweep file and the scene that it names.
    ///
    /// # Errors
    /// [`InputError`] with file, line and field. A number that no scene can have is refused here;
    /// the compatibility of a case's numbers with each other is checked when it is run.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        let text = input::read_text(path)?;
        input::parse_beside(&text, path, |root, folder| {
            reader::read(root, &text, path, folder)
        })
    }

    /// Number of cases.
    pub fn cases(&self) -> usize {
        self.design.cases()
    }

    /// The varied keys, in the order of a case's values.
    pub fn keys(&self) -> &[SceneKey] {
        &self.keys
    }

    /// Case number `index`, from 0.
    pub fn case(&self, index: usize) -> SweepCase<'_> {
        SweepCase::new(index, &self.keys, self.design.values(index, &self.keys))
    }

    /// The scene of a case.
    ///
    /// # Errors
    /// [`InputError`] if the case's numbers are incompatible, such as a dt that does not divide
    /// t_end.
    pub fn scene(&self, case: &SweepCase<'_>) -> Result<Scene, InputError> {
        self.base.scene(case.parameters())
    }

    /// A hash of the sweep file and the base scene.
    pub fn fingerprint(&self) -> u64 {
        self.fingerprint
    }
}
