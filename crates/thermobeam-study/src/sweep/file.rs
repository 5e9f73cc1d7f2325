//! A sweep file as it is written, with one reader; every error names file, line and field.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::axis::{self, SweptKey, TABLES};
use super::{Base, MOST_CASES};
use crate::scene::limits;
use convergence_study::{Field, InputError, Section};

/// How the numbers of the keys are combined into cases.
#[derive(Clone, Copy, PartialEq)]
enum Design {
    /// Every combination; the last key varies fastest.
    Grid,
    /// Case i has number i of each key.
    List,
}

/// The file.
pub(super) struct SweepFile<'a> {
    root: Section<'a>,
    /// The scene from which all are made.
    pub(super) scene: PathBuf,
    design: Design,
    pub(super) keys: Vec<SweptKey<'a>>,
    pub(super) cases: usize,
}

impl<'a> SweepFile<'a> {
    pub(super) fn read(root: &Section<'a>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["sweep", "set", "grid", "list"])?;
        let sweep = root
            .require("sweep", "a table that names the scene")?
            .section()?;
        sweep.allow(&["scene"])?;
        let scene = sweep.require("scene", "a scene file beside this one")?;
        let either = "either [grid] or [list]";
        let (name, design) = match (root.get("grid"), root.get("list")) {
            (Some(_), None) => ("grid", Design::Grid),
            (None, Some(_)) => ("list", Design::List),
            (None, None) => return Err(root.missing("grid", either)),
            (Some(_), Some(_)) => return Err(root.refuse("list", "[grid], too", either)),
        };
        let mut file = Self {
            root: root.clone(),
            scene: scene.file(folder)?,
            design,
            keys: keys(root, name)?,
            cases: 1,
        };
        match design {
            Design::Grid => file.combine()?,
            Design::List => file.align()?,
        }
        Ok(file)
    }

    /// Counts the cases of a grid, and refuses a number that stands twice.
    fn combine(&mut self) -> Result<(), InputError> {
        for key in self.keys.iter_mut().rev() {
            key.axis.stride = self.cases;
            self.cases = self.cases.saturating_mul(key.axis.values.len());
            let mut seen = HashSet::new();
            let mut values = key.axis.values.iter();
            if let Some(place) = values.position(|value| !seen.insert(value.to_bits())) {
                let found = format!("{:?} a second time", key.axis.values[place]);
                let field = key.field(place);
                return Err(field.refuse(found, "each number once"));
            }
        }
        if self.cases <= MOST_CASES {
            return Ok(());
        }
        let numbers = self.keys.iter().map(|key| key.axis.values.len() as f64);
        let (found, allowed) = limits::sweep_refusal(numbers.product());
        Err(self.root.refuse("grid", found, allowed))
    }

    /// Counts the cases of a list, which has as many numbers of each key.
    fn align(&mut self) -> Result<(), InputError> {
        let first = &self.keys[0].axis;
        self.cases = first.values.len();
        let other = self
            .keys
            .iter()
            .find(|key| key.axis.values.len() != self.cases);
        let Some(other) = other else { return Ok(()) };
        let allowed = format!("{}, as many as of {}", self.cases, first.path);
        let found = format!("{} numbers of {}", other.axis.values.len(), other.axis.path);
        Err(other.field(0).refuse(found, allowed))
    }

    /// The table `[set]` as TOML.
    pub(super) fn common_values(&self) -> Result<String, InputError> {
        let Some(set) = self.root.section("set")? else {
            return Ok(String::new());
        };
        let values = set.settings();
        let lines = values
            .iter()
            .map(|(path, text)| format!("{path} = {text}\n"));
        Ok(lines.collect())
    }

    /// Builds the scene of every case of a list. Of a grid, a scene for every number in the file,
    /// with the other keys at their first values: whether numbers go together is a matter of each
    /// case. Where dt and t_end both vary, they must be positive, and are left out otherwise.
    pub(super) fn check_scenes(&self, base: &Base) -> Result<(), InputError> {
        let is_step = |key: &&SweptKey<'_>| ["time.dt", "time.t_end"].contains(&key.axis.path);
        let are_paired =
            self.design == Design::Grid && self.keys.iter().filter(is_step).count() == 2;
        let (steps, keys): (Vec<_>, Vec<_>) =
            self.keys.iter().partition(|key| are_paired && is_step(key));
        for key in steps {
            let bad = key.probed().find(|&case| key.axis.value(case) <= 0.0);
            if let Some(case) = bad {
                let field = key.field(key.axis.place(case));
                return Err(field.refuse_as_written("numbers > 0"));
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
    fn blame(&self, error: &InputError, probed: Option<&SweptKey<'_>>, case: usize) -> InputError {
        let name = error.field.as_deref().unwrap_or("the scene");
        let swept = self.keys.iter().find(|key| key.axis.path == name);
        let common = common_value(&self.root, name).filter(|_| probed.is_none());
        let key = probed.or(swept).unwrap_or(&self.keys[0]);
        let field = common.unwrap_or_else(|| key.field(key.axis.place(case)).clone());
        field.invalid(format!("{name}: {}", error.complaint))
    }
}

/// The value of a dotted name in `[set]`.
fn common_value<'a>(root: &Section<'a>, path: &str) -> Option<Field<'a>> {
    let (table, name) = path.split_once('.')?;
    let set = root.section("set").ok()??;
    set.section(table).ok()??.get(name)
}

/// The keys that vary, in the order of the file.
fn keys<'a>(root: &Section<'a>, design: &str) -> Result<Vec<SweptKey<'a>>, InputError> {
    let section = root.require(design, "a table of keys")?.section()?;
    section.allow(&TABLES)?;
    let mut keys = vec![];
    for table in TABLES {
        let Some(inner) = section.section(table)? else {
            continue;
        };
        let mut known = vec![];
        for path in axis::all_paths() {
            let Some((_, name)) = path.split_once('.').filter(|split| split.0 == table) else {
                continue;
            };
            known.push(name);
            let Some(field) = inner.get(name) else {
                continue;
            };
            if common_value(root, path).is_some() {
                return Err(field.refuse(format!("{path} in [set], too"), "a key that varies"));
            }
            keys.push((field.start(), SweptKey::read(path, field)?));
        }
        inner.allow(&known)?;
    }
    if keys.is_empty() {
        let names: Vec<&str> = axis::all_paths().collect();
        let allowed = format!("at least one of {}", names.join(", "));
        return Err(root.refuse(design, "no key that varies", allowed));
    }
    keys.sort_by_key(|key| key.0);
    Ok(keys.into_iter().map(|key| key.1).collect())
}
