//! Reading a sweep file; every error names file, line and field.

use std::path::Path;

use super::case::{KEYS, TABLES};
use super::design::{self, Design, VariedKey};
use super::{Base, MOST_CASES, SceneKey, Sweep};
use crate::scene::{Scene, limits, stem};
use convergence_study::{
    Complaint, Field, InputError, Section,
    internal::{input, store::content_hash},
};

/// Interdependent keys: dt must divide t_end.
const STEPS: [&str; 2] = ["dt", "t_end"];

/// Functions of a scene that may depend on the case.
const TEXTS: [(&str, &str); 6] = [
    ("initial", "u"),
    ("initial", "u_t"),
    ("initial", "phi"),
    ("initial", "phi_t"),
    ("initial", "theta"),
    ("mesh", "map"),
];

/// A value from `[set]`, the same in all cases.
struct CommonValue<'a> {
    /// The dotted path of its key.
    path: String,
    /// The value as TOML.
    text: String,
    field: Field<'a>,
}

/// A latin hypercube.
#[derive(Clone, Copy)]
struct Latin {
    samples: usize,
    seed: u64,
}

pub(super) fn read(
    root: &Section<'_>,
    text: &str,
    path: &Path,
    folder: &Path,
) -> Result<Sweep, InputError> {
    root.allow(&["sweep", "set", "grid", "latin"])?;
    let section = root
        .require("sweep", "a table that names the scene")?
        .section()?;
    section.allow(&["scene"])?;
    let scene = section
        .require("scene", "a scene file beside this one")?
        .file(folder)?;
    let mut base = Base {
        file: scene.display().to_string(),
        text: input::read_text(&scene)?,
        set: String::new(),
    };
    Scene::parse(&base.text, &base.file)?;
    let fingerprint = content_hash(format!("{text}\0{}", base.text).as_bytes());
    let common = common_values(root)?;
    let (varied, latin) = varied_keys(root)?;
    check_placeholders(&common, &varied)?;
    base.set = common
        .iter()
        .map(|value| format!("{} = {}\n", value.path, value.text))
        .collect();
    let first = probe(&base, &common, &varied, latin.is_some())?;
    let keys: Vec<SceneKey> = varied.iter().map(|varied| varied.key).collect();
    let values = varied.iter().map(|varied| varied.values.clone()).collect();
    let design = match latin {
        Some(latin) => {
            let steps = first
                .one_step()
                .ok()
                .map(|stepping| (stepping.dt, first.t_end));
            Design::Latin {
                samples: latin.samples,
                values,
                steps,
            }
        }
        None => Design::Grid(values),
    };
    if design.cases() > MOST_CASES {
        let (found, allowed) = limits::sweep_refusal(
            varied
                .iter()
                .map(|varied| varied.values.len() as f64)
                .product(),
        );
        return Err(root.refuse("grid", found, allowed));
    }
    Ok(Sweep {
        name: stem(&path.display().to_string()),
        base,
        keys,
        design,
        fingerprint,
    })
}

/// The table `[set]`.
fn common_values<'a>(root: &Section<'a>) -> Result<Vec<CommonValue<'a>>, InputError> {
    let Some(section) = root.section("set")? else {
        return Ok(vec![]);
    };
    section.allow(&[&TABLES[..], &["initial"]].concat())?;
    let mut values = vec![];
    for table in TABLES.into_iter().chain(["initial"]) {
        let Some(inner) = section.section(table)? else {
            continue;
        };
        let numbers = KEYS
            .iter()
            .filter(|key| key.table == table)
            .map(|key| (key.name, true));
        let texts = TEXTS
            .iter()
            .filter(|(known, _)| *known == table)
            .map(|(_, name)| (*name, false));
        let known: Vec<(&str, bool)> = numbers.chain(texts).collect();
        inner.allow(&known.iter().map(|(name, _)| *name).collect::<Vec<_>>())?;
        for (name, is_number) in known {
            let Some(field) = inner.get(name) else {
                continue;
            };
            let text = if is_number {
                written_number(&field)?
            } else {
                quoted(&field)?
            };
            values.push(CommonValue {
                path: format!("{table}.{name}"),
                text,
                field,
            });
        }
    }
    Ok(values)
}

/// A number as TOML; an integer stays an integer.
fn written_number(field: &Field<'_>) -> Result<String, InputError> {
    let value = field.number()?;
    Ok(field
        .count(0..=1 << 53)
        .map_or_else(|_| format!("{value:?}"), |count| count.to_string()))
}

fn quoted(field: &Field<'_>) -> Result<String, InputError> {
    let text = field.text()?;
    if text.contains(['"', '\\']) || text.contains(char::is_control) {
        return Err(field.refuse_as_written("a function in one line"));
    }
    Ok(format!("\"{text}\""))
}

/// The varied keys of `[grid]` or `[latin]`, and the hypercube of the latter.
fn varied_keys<'a>(root: &Section<'a>) -> Result<(Vec<VariedKey<'a>>, Option<Latin>), InputError> {
    let either = "either [grid] or [latin]";
    let (name, section, others) = match (root.section("grid")?, root.section("latin")?) {
        (Some(grid), None) => ("grid", grid, &[][..]),
        (None, Some(latin)) => ("latin", latin, &["samples", "seed"][..]),
        (None, None) => return Err(root.missing("grid", either)),
        (Some(_), Some(_)) => {
            return Err(root.refuse("latin", "a second design beside [grid]", either));
        }
    };
    section.allow(&[&TABLES[..], others].concat())?;
    let mut latin = None;
    if name == "latin" {
        let samples = section
            .require("samples", "a number of cases")?
            .count(1..=limits::SWEEP_SAMPLES)?;
        let seed = section
            .require("seed", "a whole number >= 0")?
            .count(0..=usize::MAX)?;
        latin = Some(Latin {
            samples,
            seed: seed as u64,
        });
    }
    let mut varied = vec![];
    for table in TABLES {
        let Some(inner) = section.section(table)? else {
            continue;
        };
        let keys: Vec<SceneKey> = KEYS.into_iter().filter(|key| key.table == table).collect();
        inner.allow(&keys.iter().map(|key| key.name).collect::<Vec<_>>())?;
        for key in keys {
            let Some(field) = inner.get(key.name) else {
                continue;
            };
            varied.push(match latin {
                None => design::grid(field, key)?,
                Some(Latin { samples, seed }) => design::latin(field, key, samples, seed)?,
            });
        }
    }
    if varied.is_empty() {
        let names: Vec<String> = KEYS.iter().map(|key| key.path()).collect();
        return Err(root.refuse(
            name,
            "no key that varies",
            format!("at least one of {}", names.join(", ")),
        ));
    }
    Ok((varied, latin))
}

/// Refuses `{key}` for a key that does not vary.
fn check_placeholders(
    common: &[CommonValue<'_>],
    varied: &[VariedKey<'_>],
) -> Result<(), InputError> {
    let names: Vec<String> = varied
        .iter()
        .map(|varied| format!("{{{}}}", varied.key.path()))
        .collect();
    for value in common {
        let rest = names
            .iter()
            .fold(value.text.clone(), |text, name| text.replace(name, ""));
        if rest.contains(['{', '}']) {
            return Err(value.field.refuse_as_written(format!(
                "a function in which only {} are filled in",
                names.join(", ")
            )));
        }
    }
    Ok(())
}

/// Builds a scene for every number in the file, with the other keys at their first value; returns
/// the scene with only first values.
///
/// If dt and t_end both vary, each case checks that dt divides t_end; drawn values are rounded so
/// that it does.
fn probe(
    base: &Base,
    common: &[CommonValue<'_>],
    varied: &[VariedKey<'_>],
    is_latin: bool,
) -> Result<Scene, InputError> {
    let count = varied.iter().filter(|varied| is_step(varied)).count();
    let together = is_latin || count == STEPS.len();
    let (steps, others): (Vec<_>, Vec<_>) = varied
        .iter()
        .partition(|varied| together && is_step(varied));
    for (value, field) in steps.iter().flat_map(|key| &key.probes) {
        if *value <= 0.0 {
            return Err(field.refuse_as_written("numbers > 0"));
        }
    }
    let mut values: Vec<(SceneKey, f64)> = others
        .iter()
        .map(|varied| (varied.key, varied.probes[0].0))
        .collect();
    let first = base
        .scene(values.iter().copied())
        .map_err(|error| traced(&error, common, &others))?;
    for (index, key) in others.iter().enumerate() {
        for (value, field) in &key.probes {
            values[index].1 = *value;
            base.scene(values.iter().copied())
                .map_err(|error| at_field(&error, field))?;
        }
        values[index].1 = key.probes[0].0;
    }
    Ok(first)
}

/// Whether a varied key is dt or t_end.
fn is_step(varied: &VariedKey<'_>) -> bool {
    STEPS.iter().any(|name| varied.key.is("time", name))
}

/// Converts an error of a scene into an error of the sweep file's field that caused it.
fn traced(error: &InputError, common: &[CommonValue<'_>], varied: &[&VariedKey<'_>]) -> InputError {
    if let Some(path) = &error.field {
        if let Some(value) = common.iter().find(|value| value.path == *path) {
            return at_field(error, &value.field);
        }
        if let Some(varied) = varied.iter().find(|varied| varied.key.path() == *path) {
            return at_field(error, &varied.probes[0].1);
        }
    }
    match varied.first() {
        Some(varied) => at_field(error, &varied.probes[0].1),
        None => error.clone(),
    }
}

fn at_field(error: &InputError, field: &Field<'_>) -> InputError {
    let name = error.field.as_deref().unwrap_or("the scene");
    match &*error.complaint {
        Complaint::NotAllowed { found, allowed } => {
            field.refuse(format!("{name} = {found}"), allowed.clone())
        }
        other => field.refuse(
            format!("{}, which makes {name} invalid", field.as_written()),
            other.to_string(),
        ),
    }
}
