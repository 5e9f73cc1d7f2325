//! A sweep file as it is written; every error names file, line and field.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use convergence_study::{
    Document, HashedFile, InputError,
    file::{Refusal, named_file},
};
use schemars::JsonSchema;
use serde::{Deserialize, de::IgnoredAny};

use super::axis::{SweepAxis, Varied, numbers_of_a_scene};
use super::{Base, MOST_CASES, Sweep};
use crate::scene::{Scene, limits, stem};

/// The key that must divide the final time.
const DT: &str = "time.dt";

/// A sweep.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SweepFile {
    /// what is varied
    sweep: SweepTable,
    /// what every case has in common, as in a scene
    #[serde(rename = "set")]
    #[schemars(with = "Option<BTreeMap<String, BTreeMap<String, f64>>>")]
    _set: Option<IgnoredAny>,
    /// keys that vary: every combination, the last key running fastest
    grid: Option<Tables>,
    /// keys that vary: case i has number i of each key
    list: Option<Tables>,
}

/// Keys that vary, by the table of a scene and the key in it.
type Tables = BTreeMap<String, BTreeMap<String, Varied>>;

/// The table `[sweep]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SweepTable {
    /// a scene file beside this one
    scene: String,
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
            let file: SweepFile = root.read()?;
            let sweep = file.sweep(root, path, &text);
            sweep.map_err(|refusal| root.locate(refusal))
        })
    }
}

impl SweepFile {
    /// The sweep of the file at `path` with this text.
    fn sweep(self, root: &Document<'_>, path: &Path, text: &str) -> Result<Sweep, Refusal> {
        let folder = path.parent().unwrap_or(Path::new("."));
        let scene = named_file("sweep.scene", &self.sweep.scene, folder)?;
        let settings = root.settings().into_iter();
        let common: Vec<(String, String)> = settings
            .filter_map(|(path, value)| Some((path.strip_prefix("set.")?.to_owned(), value)))
            .collect();
        let lines = common.iter();
        let base = Base {
            file: scene.display().to_string(),
            text: Document::text_of_file(&scene)?,
            set: lines
                .map(|(path, text)| format!("{path} = {text}\n"))
                .collect(),
        };
        Scene::parse(&base.text, &base.file)?;
        let either = "either [grid] or [list]";
        let (design, tables) = match (&self.grid, &self.list) {
            (Some(grid), None) => ("grid", grid),
            (None, Some(list)) => ("list", list),
            (None, None) => return Err(Refusal::missing("grid", either)),
            (Some(_), Some(_)) => return Err(Refusal::new("list", "[grid], too", either)),
        };
        let mut axes = axes(design, tables, &common)?;
        axes.sort_by_cached_key(|axis| root.start_of(&axis.field(0)));
        let cases = match self.grid {
            Some(_) => combined(&mut axes)?,
            None => aligned(&axes)?,
        };
        let version = env!("CARGO_PKG_VERSION");
        let sweep = Sweep {
            name: stem(&path.display().to_string()),
            cases,
            hash: HashedFile::new("", format!("{version}\0{text}\0{}", base.text).as_bytes()).hash,
            axes,
            base,
        };
        sweep.check_scenes(self.grid.is_some(), &common)?;
        Ok(sweep)
    }
}

impl Sweep {
    /// Builds the scene of every case of a list. Of a grid, a scene for every number in the file,
    /// with the other keys at their first values: whether numbers go together is a matter of each
    /// case, and so is dt where t_end varies, too.
    fn check_scenes(&self, is_grid: bool, common: &[(String, String)]) -> Result<(), Refusal> {
        let steps = self.axes.iter().map(|axis| &axis.path[..]);
        let steps = steps.filter(|path| [DT, "time.t_end"].contains(path));
        let is_left_to_cases = is_grid && steps.count() == 2;
        let check = |case, probed| match self.scene(case) {
            Err(error) if !(is_left_to_cases && error.field.as_deref() == Some(DT)) => {
                Err(self.blame(&error, common, probed, case))
            }
            _ => Ok(()),
        };
        if !is_grid {
            return (0..self.cases).try_for_each(|case| check(case, None));
        }
        check(0, None)?;
        for axis in &self.axes {
            axis.probed().try_for_each(|case| check(case, Some(axis)))?;
        }
        Ok(())
    }

    /// The error of a scene as one of the field of this file that caused it.
    ///
    /// * `common`: the keys of `[set]`.
    /// * `probed`: the key of which another number made no error.
    fn blame(
        &self,
        error: &InputError,
        common: &[(String, String)],
        probed: Option<&SweepAxis>,
        case: usize,
    ) -> Refusal {
        let name = error.field.as_deref().unwrap_or("the scene");
        let swept = self.axes.iter().find(|axis| axis.path == name);
        let axis = probed.or(swept).unwrap_or(&self.axes[0]);
        let field = if probed.is_none() && common.iter().any(|(path, _)| path == name) {
            format!("set.{name}")
        } else {
            axis.field(axis.place(case))
        };
        Refusal::invalid(field, format!("{name}: {}", error.complaint()))
    }
}

/// Combines the numbers of a grid, the last key running fastest; returns the number of cases.
///
/// # Errors
/// A number that stands twice, or too many cases.
fn combined(axes: &mut [SweepAxis]) -> Result<usize, Refusal> {
    let mut cases: usize = 1;
    for axis in axes.iter_mut().rev() {
        axis.stride = cases;
        cases = cases.saturating_mul(axis.values.len());
        let mut seen = HashSet::new();
        let mut values = axis.values.iter();
        if let Some(place) = values.position(|value| !seen.insert(value.to_bits())) {
            let found = format!("{:?} a second time", axis.values[place]);
            return Err(Refusal::new(axis.field(place), found, "each number once"));
        }
    }
    if cases <= MOST_CASES {
        return Ok(cases);
    }
    let numbers = axes.iter().map(|axis| axis.values.len() as f64);
    Err(limits::too_many_cases("grid", numbers.product()))
}

/// The number of cases of a list, which has as many numbers of each key.
fn aligned(axes: &[SweepAxis]) -> Result<usize, Refusal> {
    let first = &axes[0];
    let cases = first.values.len();
    let Some(other) = axes.iter().find(|axis| axis.values.len() != cases) else {
        return Ok(cases);
    };
    let allowed = format!("{cases}, as many as of {}", first.path);
    let found = format!("{} numbers of {}", other.values.len(), other.path);
    Err(Refusal::new(other.field(0), found, allowed))
}

/// The keys that vary.
///
/// * `design`: the name of their table; `common`: the keys of `[set]`.
fn axes(
    design: &str,
    tables: &Tables,
    common: &[(String, String)],
) -> Result<Vec<SweepAxis>, Refusal> {
    let known = numbers_of_a_scene();
    let mut axes = vec![];
    for (table, names) in tables {
        let field = format!("{design}.{table}");
        let split = known.keys().filter_map(|path| path.split_once('.'));
        let own = split.clone().filter(|(of, _)| of == table);
        let own: Vec<&str> = own.map(|(_, name)| name).collect();
        if own.is_empty() {
            let mut tables: Vec<&str> = split.map(|(table, _)| table).collect();
            tables.dedup();
            return Err(Refusal::unknown(&field, &tables));
        }
        for (name, varied) in names {
            let (path, field) = (format!("{table}.{name}"), format!("{field}.{name}"));
            let Some(is_whole) = known.get(&path) else {
                return Err(Refusal::unknown(&field, &own));
            };
            if common.iter().any(|(common, _)| *common == path) {
                let found = format!("{path} in [set], too");
                return Err(Refusal::new(field, found, "a key that varies"));
            }
            axes.push(SweepAxis::read(path, *is_whole, varied, field)?);
        }
    }
    if axes.is_empty() {
        let names: Vec<&str> = known.keys().map(String::as_str).collect();
        let allowed = format!("at least one of {}", names.join(", "));
        return Err(Refusal::new(design, "no key that varies", allowed));
    }
    Ok(axes)
}
