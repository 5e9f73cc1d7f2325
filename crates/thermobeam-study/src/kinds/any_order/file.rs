//! The study file.
//!
//! ```toml
//! [run]
//! over = "space"        # "space", "time" or "degree"
//! t_end = 0.3
//! time_degree = 4       # but for "time"
//! steps = 15            # but for "time"
//! degree = 14           # for "time"
//! elements = 1          # for "time" and "degree"
//! map = "0.8*s + 0.2*s^2"
//!
//! [vibration]           # instead of [beam], [obstacles] and [exact]: modes that no load keeps in place
//! zeta = 0.1
//! modes = [1, 3]        # from 1, the lowest
//!
//! [control]             # optional: coefficients in which the solver differs from the loads; then the study must fail
//! zeta = 0.101
//!
//! [[series]]
//! degree = 2            # "space"; or time_degree = 1 for "time"
//! elements = [4, 8, 16] # "space"; or steps = [...] for "time"; or degrees = [...] for "degree"
//! tolerance = 0.1       # of the rate; or factor = 4.0 for "degree"
//! ```

use std::path::Path;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::study::{FromFile, Header};
use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};

use super::{AnyOrder, Over, Resolution, Series};
use crate::error::free_vibration;
use crate::expression::Variable;
use crate::kinds::tables::{Manufactured, control, manufactured};
use crate::scene::functions::FunctionField;
use crate::scene::{limits, tables};

/// Steps of a run: at high degree a few hundred reach round-off.
const MOST_STEPS: usize = 100_000;

impl FromFile for AnyOrder {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        let vibration = root.section("vibration")?;
        let problem: &[&str] = if vibration.is_some() { &["vibration"] } else { &["beam", "obstacles", "exact"] };
        root.allow(&[&["study", "run", "control", "series"], problem].concat())?;
        let run = root.require("run", "a table with over, t_end, degrees and steps")?.section()?;
        let over = run.require("over", "\"space\", \"time\" or \"degree\"")?.choice(&[
            ("space", Over::Space),
            ("time", Over::Time),
            ("degree", Over::Degree),
        ])?;
        let keys: &[&str] = match over {
            Over::Space => &["over", "t_end", "time_degree", "steps", "map"],
            Over::Time => &["over", "t_end", "degree", "elements", "map"],
            Over::Degree => &["over", "t_end", "time_degree", "steps", "elements", "map"],
        };
        run.allow(keys)?;
        let t_end = run.positive("t_end")?;
        let (beam, obstacles, exact) = match &vibration {
            Some(section) => free(section)?,
            None => {
                let beam = tables::beam(root)?;
                (beam, tables::obstacles(root)?, manufactured(root, &beam, t_end)?)
            }
        };
        let loaded = vibration.is_none();
        let map = run.get("map").map(|field| field.expression(Variable::S)).transpose()?;
        let allowed = "at least one table [[series]]";
        let series = root.require("series", allowed)?;
        let items = series.items(allowed)?;
        if items.is_empty() {
            return Err(series.refuse_as_written(allowed));
        }
        let series = items.iter().map(|item| one(&run, over, &item.section()?)).collect::<Result<Vec<_>, _>>()?;
        let control = control(root, beam, obstacles)?;
        let study = AnyOrder { header, beam, obstacles, exact, loaded, control, map, t_end, over, series };
        for resolution in study.resolutions() {
            if let (Err(error), Some(field)) = (study.mesh(resolution.elements), run.get("map")) {
                return Err(field.refuse(error.to_string(), "a map that increases from 0 to 1"));
            }
        }
        Ok(study)
    }
}

/// Free vibrations: the beam whose modes are exact, and the modes, each released from a tip displacement of 0.1.
fn free(section: &Section<'_>) -> Result<(Beam, Option<Obstacles>, Manufactured), InputError> {
    const AMPLITUDE: f64 = 0.1;
    section.allow(&["zeta", "modes"])?;
    let zeta = section.positive("zeta")?;
    let allowed = format!("a list of at least one mode, from 1 to {}", limits::MODES);
    let field = section.require("modes", &allowed)?;
    let items = field.items(&allowed)?;
    let mode = |item: &Field<'_>| Ok((item.count(1..=limits::MODES)? - 1, AMPLITUDE));
    let modes = items.iter().map(mode).collect::<Result<Vec<_>, InputError>>()?;
    match free_vibration::vibration(&modes, zeta) {
        Ok(exact) if !modes.is_empty() => Ok((free_vibration::beam(zeta), None, exact)),
        _ => Err(field.refuse_as_written(allowed)),
    }
}

fn one(run: &Section<'_>, over: Over, section: &Section<'_>) -> Result<Series, InputError> {
    let count = |of: &Section<'_>, key: &str, most: usize| {
        of.require(key, &format!("a whole number from 1 to {most}"))?.count(1..=most)
    };
    let time_degree = |of: &Section<'_>| {
        of.require("time_degree", &format!("a whole number from 0 to {MAX_TIME_DEGREE}"))?.count(0..=MAX_TIME_DEGREE)
    };
    let steps = |of: &Section<'_>| count(of, "steps", MOST_STEPS);
    let (runs, tolerance) = match over {
        Over::Space => {
            section.allow(&["degree", "elements", "tolerance"])?;
            let (q, steps, p) = (time_degree(run)?, steps(run)?, count(section, "degree", MAX_DEGREE)?);
            let list = increasing(section, "elements", tables::elements)?;
            let run = |elements| Resolution { degree: p, elements, time_degree: q, steps };
            (list.into_iter().map(run).collect(), "tolerance")
        }
        Over::Time => {
            section.allow(&["time_degree", "steps", "tolerance"])?;
            let (p, q) = (count(run, "degree", MAX_DEGREE)?, time_degree(section)?);
            let elements = tables::elements(&run.require("elements", "a whole number >= 1")?)?;
            let list = increasing(section, "steps", |field| field.count(1..=MOST_STEPS))?;
            let run = |steps| Resolution { degree: p, elements, time_degree: q, steps };
            (list.into_iter().map(run).collect(), "tolerance")
        }
        Over::Degree => {
            section.allow(&["degrees", "factor"])?;
            let (q, steps) = (time_degree(run)?, steps(run)?);
            let elements = tables::elements(&run.require("elements", "a whole number >= 1")?)?;
            let list = increasing(section, "degrees", |field| field.count(1..=MAX_DEGREE))?;
            let run = |degree| Resolution { degree, elements, time_degree: q, steps };
            (list.into_iter().map(run).collect(), "factor")
        }
    };
    let least = if over == Over::Degree { 1.0 } else { 0.0 };
    let allowed = format!("a finite number > {least}");
    let tolerance = section.require(tolerance, &allowed)?.number_where(&allowed, |value| value > least)?;
    Ok(Series { runs, tolerance })
}

fn increasing(
    section: &Section<'_>,
    key: &str,
    read: impl Fn(&Field<'_>) -> Result<usize, InputError>,
) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of at least three increasing whole numbers";
    let field = section.require(key, allowed)?;
    let list = field.items(allowed)?.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let is_increasing = list.len() >= 3 && list.windows(2).all(|pair| pair[0] < pair[1]);
    if is_increasing { Ok(list) } else { Err(field.refuse_as_written(allowed)) }
}

impl AnyOrder {
    /// All runs, series by series.
    pub(super) fn resolutions(&self) -> impl Iterator<Item = Resolution> {
        self.series.iter().flat_map(|series| series.runs.iter().copied())
    }

    pub(super) fn mesh(&self, elements: usize) -> Result<Mesh, thermobeam::mesh::MeshError> {
        Mesh::mapped(elements, |s| self.map.as_ref().map_or(s, |map| map.eval(s)))
    }
}
