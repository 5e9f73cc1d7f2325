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

use std::path::Path;

use crate::scene::{Scene, limits, stem};
use convergence_study::{Document, HashedFile, InputError};

pub use axis::Axis;
pub use lines::{CaseLine, Header, InOrder, ShareFile, SweepError};
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
    pub axes: Vec<Axis>,
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

impl Base {
    /// The scene of a case with the numbers of these keys.
    fn scene<'a>(
        &self,
        case: usize,
        axes: impl Iterator<Item = &'a Axis>,
    ) -> Result<Scene, InputError> {
        let mut overlay = self.set.clone();
        for axis in axes {
            let (path, written) = (axis.path, axis.written(case));
            // In brackets, so that a negative number keeps its sign under a power.
            overlay = overlay.replace(&format!("{{{path}}}"), &format!("({written})"));
            overlay.push_str(&format!("{path} = {written}\n"));
        }
        Scene::parse_overlaid(&self.text, &overlay, &self.file)
    }
}

/// The same on every machine.
fn hash_of(text: &str) -> String {
    HashedFile::new("", text.as_bytes()).hash
}

impl Sweep {
    /// Reads a sweep file and the scene that it names.
    ///
    /// # Errors
    /// [`InputError`] with file, line and field. A number that no scene can have is refused here,
    /// and so is any case of a list; whether the numbers of a grid go together is checked when a
    /// case is run.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        let text = Document::text_of_file(path)?;
        Document::parse(&text, &path.display().to_string(), |root| {
            let folder = path.parent().unwrap_or(Path::new("."));
            let file = file::Described::read(root, folder)?;
            let base = Base {
                file: file.scene.display().to_string(),
                text: Document::text_of_file(&file.scene)?,
                set: file.common_values(),
            };
            Scene::parse(&base.text, &base.file)?;
            let version = env!("CARGO_PKG_VERSION");
            let hashed = format!("{version}\0{text}\0{}", base.text);
            file.check_scenes(&base)
                .map_err(|refusal| root.locate(refusal))?;
            Ok(Self {
                name: stem(&path.display().to_string()),
                cases: file.cases,
                hash: hash_of(&hashed),
                axes: file.keys.into_iter().map(|key| key.axis).collect(),
                base,
            })
        })
    }

    /// A list in code: case i has number i of each key.
    ///
    /// * `scene`: the base scene, as text.
    /// * `keys`: dotted names with as many numbers each.
    pub(crate) fn of_list(name: &str, scene: &str, keys: Vec<(&'static str, Vec<f64>)>) -> Self {
        let axis = |(path, values)| Axis {
            path,
            values,
            stride: 1,
        };
        let axes: Vec<Axis> = keys.into_iter().map(axis).collect();
        Self {
            name: name.to_owned(),
            cases: axes.iter().map(|axis| axis.values.len()).min().unwrap_or(0),
            hash: hash_of(scene),
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
        self.base.scene(case, self.axes.iter())
    }
}
