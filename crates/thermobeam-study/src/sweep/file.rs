//! A sweep file as it is written; every error names file, line and field.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use convergence_study::{
    Document, InputError,
    file::{Refusal, named_file},
};
use schemars::JsonSchema;
use serde::{Deserialize, de::IgnoredAny};

use super::axis::{self, SweptKey, Varied};
use super::{Base, MOST_CASES};
use crate::scene::limits;

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

/// How the numbers of the keys are combined into cases.
#[derive(Clone, Copy, PartialEq)]
enum Design {
    /// Every combination; the last key varies fastest.
    Grid,
    /// Case i has number i of each key.
    List,
}

/// The sweep that a file describes.
pub(super) struct Described {
    /// The scene from which all are made.
    pub(super) scene: PathBuf,
    design: Design,
    pub(super) keys: Vec<SweptKey>,
    pub(super) cases: usize,
    /// The values of `[set]`, each with its dotted name.
    common: Vec<(String, String)>,
}

impl Described {
    pub(super) fn read(root: &Document<'_>, folder: &Path) -> Result<Self, InputError> {
        let file: SweepFile = root.read()?;
        let common = root.settings().into_iter().filter_map(|(path, value)| {
            let name = path.strip_prefix("set.")?.to_owned();
            Some((name, value))
        });
        let common = common.collect();
        let described = Self::new(file, common, folder, |path| root.start_of(path));
        described.map_err(|refusal| root.locate(refusal))
    }

    /// * `start`: where a field stands in the file.
    fn new(
        file: SweepFile,
        common: Vec<(String, String)>,
        folder: &Path,
        start: impl Fn(&str) -> usize,
    ) -> Result<Self, Refusal> {
        let either = "either [grid] or [list]";
        let (design, tables) = match (file.grid, file.list) {
            (Some(grid), None) => (Design::Grid, grid),
            (None, Some(list)) => (Design::List, list),
            (None, None) => return Err(Refusal::missing("grid", either)),
            (Some(_), Some(_)) => return Err(Refusal::new("list", "[grid], too", either)),
        };
        let name = match design {
            Design::Grid => "grid",
            Design::List => "list",
        };
        let mut keys = keys(name, &tables, &common)?;
        keys.sort_by_cached_key(|key| start(&key.field(0)));
        let mut described = Self {
            scene: named_file("sweep.scene", &file.sweep.scene, folder)?,
            design,
            keys,
            cases: 1,
            common,
        };
        match design {
            Design::Grid => described.combine()?,
            Design::List => described.align()?,
        }
        Ok(described)
    }

    /// Counts the cases of a grid, and refuses a number that stands twice.
    fn combine(&mut self) -> Result<(), Refusal> {
        for key in self.keys.iter_mut().rev() {
            key.axis.stride = self.cases;
            self.cases = self.cases.saturating_mul(key.axis.values.len());
            let mut seen = HashSet::new();
            let mut values = key.axis.values.iter();
            if let Some(place) = values.position(|value| !seen.insert(value.to_bits())) {
                let found = format!("{:?} a second time", key.axis.values[place]);
                return Err(Refusal::new(key.field(place), found, "each number once"));
            }
        }
        if self.cases <= MOST_CASES {
            return Ok(());
        }
        let numbers = self.keys.iter().map(|key| key.axis.values.len() as f64);
        let (found, allowed) = limits::sweep_refusal(numbers.product());
        Err(Refusal::new("grid", found, allowed))
    }

    /// Counts the cases of a list, which has as many numbers of each key.
    fn align(&mut self) -> Result<(), Refusal> {
        let first = &self.keys[0].axis;
        self.cases = first.values.len();
        let other = self
            .keys
            .iter()
            .find(|key| key.axis.values.len() != self.cases);
        let Some(other) = other else { return Ok(()) };
        let allowed = format!("{}, as many as of {}", self.cases, first.path);
        let found = format!("{} numbers of {}", other.axis.values.len(), other.axis.path);
        Err(Refusal::new(other.field(0), found, allowed))
    }

    /// The table `[set]` as TOML.
    pub(super) fn common_values(&self) -> String {
        let lines = self.common.iter();
        lines
            .map(|(path, text)| format!("{path} = {text}\n"))
            .collect()
    }

    /// Builds the scene of every case of a list. Of a grid, a scene for every number in the file,
    /// with the other keys at their first values: whether numbers go together is a matter of each
    /// case. Where dt and t_end both vary, they must be positive, and are left out otherwise.
    pub(super) fn check_scenes(&self, base: &Base) -> Result<(), Refusal> {
        let is_step = |key: &&SweptKey| ["time.dt", "time.t_end"].contains(&key.axis.path);
        let are_paired =
            self.design == Design::Grid && self.keys.iter().filter(is_step).count() == 2;
        let (steps, keys): (Vec<_>, Vec<_>) =
            self.keys.iter().partition(|key| are_paired && is_step(key));
        for key in steps {
            let bad = key.probed().find(|&case| key.axis.value(case) <= 0.0);
            if let Some(case) = bad {
                let field = key.field(key.axis.place(case));
                return Err(Refusal::written(field, "numbers > 0"));
            }
        }
        let check = |case, probed| match base.scene(case, keys.iter().map(|key| &key.axis)) {
            Ok(_) => Ok(()),
            Err(error) => Err(self.blame(&error, probed, case)),
        };
        if self.design == Design::List {
            return (0..self.cases).try_for_each(|case| check(case, None));
        }
        check(0, None)?;
        for key in &keys {
            key.probed().try_for_each(|case| check(case, Some(*key)))?;
        }
        Ok(())
    }

    /// The error of a scene as one of the field of this file that caused it.
    ///
    /// * `probed`: the key of which another number made no error.
    fn blame(&self, error: &InputError, probed: Option<&SweptKey>, case: usize) -> Refusal {
        let name = error.field.as_deref().unwrap_or("the scene");
        let swept = self.keys.iter().find(|key| key.axis.path == name);
        let key = probed.or(swept).unwrap_or(&self.keys[0]);
        let field = if probed.is_none() && self.common.iter().any(|(path, _)| path == name) {
            format!("set.{name}")
        } else {
            key.field(key.axis.place(case))
        };
        Refusal::invalid(field, format!("{name}: {}", error.complaint))
    }
}

/// The keys that vary.
///
/// * `design`: the name of their table; `common`: the keys of `[set]`.
fn keys(
    design: &str,
    tables: &Tables,
    common: &[(String, String)],
) -> Result<Vec<SweptKey>, Refusal> {
    let known: Vec<(&str, &str)> = axis::all_paths()
        .filter_map(|path| path.split_once('.'))
        .collect();
    let mut keys = vec![];
    for (table, names) in tables {
        let field = format!("{design}.{table}");
        let mut own = known.iter().filter(|(of, _)| of == table).peekable();
        if own.peek().is_none() {
            let mut tables: Vec<&str> = known.iter().map(|(table, _)| *table).collect();
            tables.sort_unstable();
            tables.dedup();
            return Err(Refusal::unknown(&field, &tables));
        }
        let own: Vec<&str> = own.map(|(_, name)| *name).collect();
        for (name, varied) in names {
            let (path, field) = (format!("{table}.{name}"), format!("{field}.{name}"));
            let Some(path) = axis::all_paths().find(|known| *known == path) else {
                return Err(Refusal::unknown(&field, &own));
            };
            if common.iter().any(|(common, _)| common == path) {
                let found = format!("{path} in [set], too");
                return Err(Refusal::new(field, found, "a key that varies"));
            }
            keys.push(SweptKey::new(path, varied, field)?);
        }
    }
    if keys.is_empty() {
        let names: Vec<&str> = axis::all_paths().collect();
        let allowed = format!("at least one of {}", names.join(", "));
        return Err(Refusal::new(design, "no key that varies", allowed));
    }
    Ok(keys)
}
