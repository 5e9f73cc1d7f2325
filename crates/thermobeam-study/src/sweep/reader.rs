//! Reading a sweep file; every error names file, line and field.

use std::path::Path;

use super::design::Design;
use super::key::{KEYS, TABLES};
use super::values::{self, VariedKey};
use super::{Base, Key, MOST_CASES, Sweep, SweepCase};
use crate::scene::{Scene, limits, stem};
use convergence_study::input::{self, Complaint, Field, InputError, Section};
use convergence_study::store::content_hash;

/// What every case has in common: TOML in which `{key}` stands for the case's value.
#[derive(Debug, Clone, Default)]
pub(super) struct Overlay(String);

impl Overlay {
    /// The values that replace those of the base scene.
    pub(super) fn overlay(&self, case: &SweepCase<'_>) -> String {
        let mut text = self.0.clone();
        for (key, value) in case.parameters() {
            let (path, written) = (key.path(), key.written(value));
            // In brackets, so that a negative number keeps its sign under a power.
            text = text.replace(&format!("{{{path}}}"), &format!("({written})"));
            text.push_str(&format!("{path} = {written}\n"));
        }
        text
    }
}

/// Keys that depend on each other: dt must divide t_end.
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

pub(super) fn read(root: &Section<'_>, text: &str, path: &Path, folder: &Path) -> Result<Sweep, InputError> {
    root.allow(&["sweep", "set", "grid", "latin"])?;
    let section = root.require("sweep", "a table that names the scene")?.section()?;
    section.allow(&["scene"])?;
    let scene = section.require("scene", "a scene file beside this one")?.file(folder)?;
    let base = Base { file: scene.display().to_string(), text: input::read_text(&scene)? };
    let plain = Scene::parse(&base.text, &base.file)?;
    let set = set(root)?;
    let varied = varied(root)?;
    check_placeholders(&set, &varied)?;
    let template = Overlay(set.iter().map(|(name, text, _)| format!("{name} = {text}\n")).collect());
    let samples = samples(root)?;
    probe(&base, &template, &set, &varied, samples.is_some())?;
    let keys: Vec<Key> = varied.iter().map(|varied| varied.key).collect();
    let values = varied.iter().map(|varied| varied.values.clone()).collect();
    let design = match samples {
        Some((samples, _)) => {
            let steps = steps(&plain).map(|plain| common_steps(&base, &template, &varied).unwrap_or(plain));
            Design::Latin { samples, values, steps }
        }
        None => Design::Grid(values),
    };
    if design.cases() > MOST_CASES {
        let (found, allowed) = limits::sweep_refusal(varied.iter().map(|varied| varied.values.len() as f64).product());
        return Err(root.refuse("grid", found, allowed));
    }
    let fingerprint = content_hash(format!("{text}\0{}", base.text).as_bytes());
    Ok(Sweep { name: stem(&path.display().to_string()), base, template, keys, design, fingerprint })
}

/// The table `[set]`: dotted name, value as TOML, place.
fn set<'a>(root: &Section<'a>) -> Result<Vec<(String, String, Field<'a>)>, InputError> {
    let Some(section) = root.section("set")? else { return Ok(vec![]) };
    section.allow(&[&TABLES[..], &["initial"]].concat())?;
    let mut set = vec![];
    for table in TABLES.into_iter().chain(["initial"]) {
        let Some(inner) = section.section(table)? else { continue };
        let numbers = KEYS.iter().filter(|key| key.table == table).map(|key| (key.name, true));
        let texts = TEXTS.iter().filter(|(of, _)| *of == table).map(|(_, name)| (*name, false));
        let known: Vec<(&str, bool)> = numbers.chain(texts).collect();
        inner.allow(&known.iter().map(|(name, _)| *name).collect::<Vec<_>>())?;
        for (name, is_number) in known {
            let Some(field) = inner.get(name) else { continue };
            let value = if is_number { written_number(&field)? } else { quoted(&field)? };
            set.push((format!("{table}.{name}"), value, field));
        }
    }
    Ok(set)
}

/// A number as TOML; a whole one stays whole.
fn written_number(field: &Field<'_>) -> Result<String, InputError> {
    let value = field.number()?;
    Ok(field.count(0..=1 << 53).map_or_else(|_| format!("{value:?}"), |count| count.to_string()))
}

fn quoted(field: &Field<'_>) -> Result<String, InputError> {
    let text = field.text()?;
    if text.contains(['"', '\\']) || text.contains(char::is_control) {
        return Err(field.refuse_as_written("a function in one line"));
    }
    Ok(format!("\"{text}\""))
}

/// Samples and seed of a Latin hypercube; `None` for a grid.
fn samples(root: &Section<'_>) -> Result<Option<(usize, u64)>, InputError> {
    let Some(section) = root.section("latin")? else { return Ok(None) };
    let samples = section.require("samples", "a number of cases")?.count(1..=limits::SWEEP_SAMPLES)?;
    let seed = section.require("seed", "a whole number >= 0")?.count(0..=usize::MAX)?;
    Ok(Some((samples, seed as u64)))
}

/// The keys that vary: `[grid]` or `[latin]`.
fn varied<'a>(root: &Section<'a>) -> Result<Vec<VariedKey<'a>>, InputError> {
    let either = "either [grid] or [latin]";
    let (section, others) = match (root.section("grid")?, root.section("latin")?) {
        (Some(grid), None) => (grid, &[][..]),
        (None, Some(latin)) => (latin, &["samples", "seed"][..]),
        (None, None) => return Err(root.missing("grid", either)),
        (Some(_), Some(_)) => return Err(root.refuse("latin", "a second design beside [grid]", either)),
    };
    section.allow(&[&TABLES[..], others].concat())?;
    let samples = samples(root)?;
    let mut varied = vec![];
    for table in TABLES {
        let Some(inner) = section.section(table)? else { continue };
        let keys: Vec<Key> = KEYS.into_iter().filter(|key| key.table == table).collect();
        inner.allow(&keys.iter().map(|key| key.name).collect::<Vec<_>>())?;
        for key in keys {
            let Some(field) = inner.get(key.name) else { continue };
            varied.push(match samples {
                None => values::grid(field, key)?,
                Some((samples, seed)) => values::latin(field, key, samples, seed)?,
            });
        }
    }
    if varied.is_empty() {
        let names: Vec<String> = KEYS.iter().map(|key| key.path()).collect();
        let allowed = format!("at least one of {}", names.join(", "));
        return Err(root.refuse(if samples.is_some() { "latin" } else { "grid" }, "no key that varies", allowed));
    }
    Ok(varied)
}

/// Refuses `{key}` for a key that does not vary.
fn check_placeholders(set: &[(String, String, Field<'_>)], varied: &[VariedKey<'_>]) -> Result<(), InputError> {
    for (_, text, field) in set {
        let known =
            varied.iter().fold(text.clone(), |text, varied| text.replace(&format!("{{{}}}", varied.key.path()), ""));
        if known.contains(['{', '}']) {
            let names: Vec<String> = varied.iter().map(|varied| format!("{{{}}}", varied.key.path())).collect();
            return Err(field.refuse_as_written(format!("a function in which only {} are filled in", names.join(", "))));
        }
    }
    Ok(())
}

/// The dt and t_end of all cases, where one of them varies alone.
fn common_steps(base: &Base, template: &Overlay, varied: &[VariedKey<'_>]) -> Option<(f64, f64)> {
    let fixed: Vec<&VariedKey<'_>> = varied.iter().filter(|varied| !is_step(varied.key)).collect();
    steps(&attempt(base, template, &fixed, None).ok()?)
}

/// dt and t_end where the one must divide the other.
fn steps(scene: &Scene) -> Option<(f64, f64)> {
    scene.one_step().ok().map(|stepping| (stepping.dt, scene.t_end))
}

fn is_step(key: Key) -> bool {
    STEPS.iter().any(|name| key.is("time", name))
}

/// The scene with the first values of all keys but one.
fn attempt(
    base: &Base,
    template: &Overlay,
    varied: &[&VariedKey<'_>],
    probed: Option<(usize, f64)>,
) -> Result<Scene, InputError> {
    let keys: Vec<Key> = varied.iter().map(|varied| varied.key).collect();
    let mut values: Vec<f64> = varied.iter().map(|varied| varied.probes[0].0).collect();
    if let Some((index, value)) = probed {
        values[index] = value;
    }
    Scene::parse_overlaid(&base.text, &template.overlay(&SweepCase::new(0, &keys, values)), &base.file)
}

/// Builds a scene with every number that the file lists, the other keys at their first value.
///
/// Where dt and t_end both vary, each case checks whether dt divides t_end; drawn ones are rounded so that it does.
fn probe(
    base: &Base,
    template: &Overlay,
    set: &[(String, String, Field<'_>)],
    varied: &[VariedKey<'_>],
    is_drawn: bool,
) -> Result<(), InputError> {
    let together = is_drawn || varied.iter().filter(|varied| is_step(varied.key)).count() == STEPS.len();
    let (steps, others): (Vec<_>, Vec<_>) = varied.iter().partition(|varied| together && is_step(varied.key));
    for (value, field) in steps.iter().flat_map(|key| &key.probes) {
        if *value <= 0.0 {
            return Err(field.refuse_as_written("numbers > 0"));
        }
    }
    attempt(base, template, &others, None).map_err(|error| traced(&error, set, &others))?;
    for (index, key) in others.iter().enumerate() {
        for (value, field) in &key.probes {
            attempt(base, template, &others, Some((index, *value))).map_err(|error| at_field(&error, field))?;
        }
    }
    Ok(())
}

/// The error of a scene as an error of the field of the sweep file that it comes from.
fn traced(error: &InputError, set: &[(String, String, Field<'_>)], varied: &[&VariedKey<'_>]) -> InputError {
    let named = |name: &str| error.field.as_deref() == Some(name);
    let of_set = set.iter().find(|(name, ..)| named(name)).map(|(.., field)| field);
    let of_key = varied.iter().find(|varied| named(&varied.key.path())).map(|varied| &varied.probes[0].1);
    match of_set.or(of_key).or(varied.first().map(|varied| &varied.probes[0].1)) {
        Some(field) => at_field(error, field),
        None => error.clone(),
    }
}

fn at_field(error: &InputError, field: &Field<'_>) -> InputError {
    let name = error.field.as_deref().unwrap_or("the scene");
    match &*error.complaint {
        Complaint::NotAllowed { found, allowed } => field.refuse(format!("{name} = {found}"), allowed.clone()),
        other => field.refuse(format!("{}, which makes {name} invalid", field.as_written()), other.to_string()),
    }
}
