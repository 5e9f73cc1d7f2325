//! Many scenes from one: a grid or a list of the numbers of a base scene, for one-step schemes and
//! any order.
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
//! [list]                                    # case i has number i of each key; as many of each
//! beam.beta = [-0.5, 0.1, 4.2]
//! mesh.elements = [20, 50, 200]
//! ```
//!
//! Cases are numbered from 0. A case's results depend on the files alone: any number of threads,
//! shares and interruptions gives the same bytes.

mod axis;
mod file;
mod lines;
mod run;
mod share;

use crate::scene::{Scene, limits};
use convergence_study::{HashedFile, InputError};

pub use axis::SweepAxis;
pub use lines::{Header, ShareFile, SweepError};
pub use run::run;
pub use share::{Finished, RESULTS, SweepShare, merge};

/// Largest number of cases of a sweep.
pub const MOST_CASES: usize = limits::SWEEP_CASES;

/// A sweep file, read and validated.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The file's name without folder and extension.
    pub name: String,
    /// Number of cases.
    pub cases: usize,
    /// The keys that vary, in the order of the file.
    pub axes: Vec<SweepAxis>,
    /// A hash of the sweep file, the base scene and the version of the program: another version may
    /// compute other bits.
    pub hash: String,
    base: Base,
}

/// The base scene, as text: every case reads it with its own values instead of the scene's.
#[derive(Debug, Clone)]
struct Base {
    file: String,
    text: String,
    /// The part common to all cases: TOML in which `{key}` stands for the case's value.
    set: String,
}

impl Sweep {
    /// A list in code: case i has number i of each key.
    ///
    /// * `scene`: the base scene, as text.
    /// * `keys`: dotted names of numbers that are not whole, with as many values each.
    pub(crate) fn of_list(name: &str, scene: &str, keys: Vec<(&str, Vec<f64>)>) -> Self {
        let keys = keys.into_iter();
        let axes: Vec<SweepAxis> = keys
            .map(|(path, values)| SweepAxis::listed(path, values))
            .collect();
        Self {
            name: name.to_owned(),
            cases: axes.iter().map(|axis| axis.values.len()).min().unwrap_or(0),
            hash: HashedFile::new("", scene.as_bytes()).hash,
            axes,
            base: Base {
                file: name.to_owned(),
                text: scene.to_owned(),
                set: String::new(),
            },
        }
    }

    /// The scene of a case.
    ///
    /// # Errors
    /// [`InputError`] if the case's numbers are incompatible, such as a dt that does not divide
    /// t_end.
    pub fn scene(&self, case: usize) -> Result<Scene, InputError> {
        let Base { file, text, set } = &self.base;
        let mut overlay = set.clone();
        for axis in &self.axes {
            let (path, written) = (&axis.path, axis.json(case));
            // In brackets, so that a negative number keeps its sign under a power.
            overlay = overlay.replace(&format!("{{{path}}}"), &format!("({written})"));
            overlay.push_str(&format!("{path} = {written}\n"));
        }
        Scene::parse_overlaid(text, &overlay, file)
    }
}
