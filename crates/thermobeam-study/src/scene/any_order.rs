//! Scenes with `scheme = "dg"`: elements of degree p in space, dG(q) in time, steps cut where contact begins or ends.
//!
//! ```toml
//! [mesh]
//! elements = 1
//! degree = 12           # p
//!
//! [time]
//! scheme = "dg"
//! degree = 2            # q
//! dt = 0.02             # the largest step; it need not divide t_end
//! restart_dt = 1e-3     # the first step, at the start and after each contact event
//! growth = 1.5          # of the steps in between
//! t_end = 10.0
//! ```

use convergence_study::input::{self, InputError, Section};
use std::path::Path;
use thermobeam::dg::{self, MAX_DEGREE, MAX_TIME_DEGREE};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::SCHEMES;

use super::{Initial, Scene, limits, stem, tables};
use crate::expression::Expression;

/// The value of `time.scheme` for these scenes.
pub const SCHEME: &str = "dg";

/// Degree p of a scene that does not say: 1e-8 for the paper's first experiment on one element.
const DEGREE: usize = 13;

/// Elements of a scene that does not say.
const ELEMENTS: usize = 1;

/// Largest step of a scene that does not say.
const DT: f64 = 0.02;

/// Growth of the steps of a scene that does not say.
const GROWTH: f64 = 1.5;

/// First step of a scene that does not say, in units of the duration of an impact.
const RESTART: f64 = 0.2;

const TIME_KEYS: [&str; 8] = ["scheme", "degree", "dt", "restart_dt", "growth", "t_end", "tolerance", "max_iterations"];

/// Everything that a simulation of any order needs, validated.
#[derive(Debug, Clone, PartialEq)]
pub struct AnyOrderScene {
    /// The file's name without folder and extension.
    pub name: String,
    /// Coefficients of the equations.
    pub beam: Beam,
    /// The obstacles, if any.
    pub obstacles: Option<Obstacles>,
    /// Initial data; they meet the boundary conditions up to round-off.
    pub initial: Initial,
    /// The mesh.
    pub mesh: Mesh,
    /// Degree p of the elements.
    pub degree: usize,
    /// Degree q in time, and the lengths of steps.
    pub stepping: dg::Stepping,
    /// Final time.
    pub t_end: f64,
}

/// A scene file, by its scheme.
#[derive(Debug, Clone, PartialEq)]
pub enum SceneFile {
    /// A one-step scheme on linear elements.
    OneStep(Scene),
    /// dG(q) on elements of degree p.
    AnyOrder(AnyOrderScene),
}

impl SceneFile {
    /// Reads a scene file of any scheme.
    ///
    /// # Errors
    /// [`InputError`] with file, line, field, the value found and the values allowed.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        Self::parse(&input::read_text(path)?, &path.display().to_string())
    }

    /// Reads a scene of any scheme from `text`; messages and the scene's name refer to `file_name`.
    ///
    /// # Errors
    /// As [`SceneFile::read`].
    pub fn parse(text: &str, file_name: &str) -> Result<Self, InputError> {
        input::parse(text, file_name, |root| Self::from_document(root, stem(file_name)))
    }

    /// Reads a scene from `text` with the values of `overlay` in place of its own: TOML as well.
    pub(crate) fn parse_overlaid(text: &str, overlay: &str, file_name: &str) -> Result<Self, InputError> {
        input::parse_overlaid(text, overlay, file_name, |root| Self::from_document(root, stem(file_name)))
    }

    fn from_document(root: &Section<'_>, name: String) -> Result<Self, InputError> {
        root.allow(&super::TABLES)?;
        Self::from_tables(root, name)
    }

    /// The scene of the tables in a section, which may hold other keys besides.
    pub(crate) fn from_tables(root: &Section<'_>, name: String) -> Result<Self, InputError> {
        Ok(if is_any_order(root)? {
            Self::AnyOrder(from_document(root, name)?)
        } else {
            Self::OneStep(Scene::from_tables(root, name)?)
        })
    }
}

/// Whether `time.scheme` is `dg`.
///
/// # Errors
///
/// No scheme has that name: said first, since the keys of `[time]` depend on it.
pub(super) fn is_any_order(root: &Section<'_>) -> Result<bool, InputError> {
    let Some(time) = root.section("time")? else { return Ok(false) };
    let names: Vec<_> = SCHEMES.iter().map(|scheme| (scheme.name, false)).chain([(SCHEME, true)]).collect();
    time.get("scheme").map_or(Ok(false), |field| field.choice(&names))
}

fn from_document(root: &Section<'_>, name: String) -> Result<AnyOrderScene, InputError> {
    let beam = tables::beam(root)?;
    let obstacles = tables::obstacles(root)?;
    let time = root.require("time", "a table with scheme and t_end")?.section()?;
    time.allow(&TIME_KEYS)?;
    let mesh = super::mesh(root, ELEMENTS)?;
    let degree = match root.section("mesh")?.and_then(|section| section.get("degree")) {
        Some(field) => field.count(1..=MAX_DEGREE)?,
        None => DEGREE,
    };
    let t_end = time.positive("t_end")?;
    let stepping = stepping(&time, &beam, obstacles.as_ref(), t_end)?;
    let blamed = root.section("mesh")?.and_then(|mesh| ["nodes", "elements"].into_iter().find_map(|key| mesh.get(key)));
    if let Some(field) = blamed {
        let shortest = mesh.nodes().windows(2).map(|x| x[1] - x[0]).fold(f64::INFINITY, f64::min);
        let lengths = if mesh.size() <= (1.0 + 1e-6) * shortest { 1 } else { mesh.elements() };
        limits::any_order_memory(&field, mesh.elements(), lengths, degree, stepping.degree)?;
    }
    let initial = super::initial(root, &beam, &mesh)?;
    Ok(AnyOrderScene { name, beam, obstacles, initial, mesh, degree, stepping, t_end })
}

fn stepping(
    time: &Section<'_>,
    beam: &Beam,
    obstacles: Option<&Obstacles>,
    t_end: f64,
) -> Result<dg::Stepping, InputError> {
    let defaults = dg::Stepping::default();
    let or = |key: &str, default: f64| time.get(key).map_or(Ok(default), |field| field.positive());
    let dt = or("dt", DT.min(t_end))?;
    if let Some(field) = time.get("dt") {
        limits::steps_until(&field, t_end, dt, limits::STEPS)?;
    }
    let impact = obstacles.map_or(dt, |obstacles| obstacles.impact_time(beam.zeta));
    let restart_dt = match time.get("restart_dt") {
        Some(field) => field.number_where(&format!("a number > 0 and at most dt = {dt:?}"), |h| h > 0.0 && h <= dt)?,
        None => (RESTART * impact).min(dt),
    };
    let growth = match time.get("growth") {
        Some(field) => field.number_where("a finite number >= 1", |growth| growth >= 1.0)?,
        None => GROWTH,
    };
    Ok(dg::Stepping {
        degree: time.get("degree").map_or(Ok(defaults.degree), |field| field.count(0..=MAX_TIME_DEGREE))?,
        dt,
        restart_dt,
        growth,
        tolerance: or("tolerance", defaults.tolerance)?,
        max_iterations: time
            .get("max_iterations")
            .map_or(Ok(defaults.max_iterations), |field| field.count(1..=usize::MAX))?,
    })
}

impl AnyOrderScene {
    /// The solver's view of the scene.
    pub fn problem(&self) -> dg::Problem {
        let function = |function: &Option<Expression>| -> dg::Function {
            match function.clone() {
                Some(function) => Box::new(move |x| function.eval(x)),
                None => Box::new(|_| 0.0),
            }
        };
        let Initial { u, u_t, phi, phi_t, theta } = &self.initial;
        dg::Problem {
            beam: self.beam,
            obstacles: self.obstacles,
            mesh: self.mesh.clone(),
            degree: self.degree,
            initial: dg::Initial {
                u: function(u),
                u_t: function(u_t),
                phi: function(phi),
                phi_t: function(phi_t),
                theta: function(theta),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<AnyOrderScene, String> {
        match SceneFile::parse(text, "s.toml") {
            Ok(SceneFile::AnyOrder(scene)) => Ok(scene),
            Ok(SceneFile::OneStep(scene)) => Err(format!("a scene by {}", scene.scheme.name)),
            Err(error) => Err(error.to_string()),
        }
    }

    #[test]
    fn keys_are_read_and_defaults_follow_the_scene() {
        let text = "[obstacles]\n[mesh]\ndegree = 4\n[time]\nscheme = \"dg\"\ndegree = 3\ndt = 0.3\nt_end = 1.0\n";
        let scene = read(text).unwrap();
        assert_eq!((scene.degree, scene.mesh.elements(), scene.stepping.degree), (4, 1, 3));
        assert_eq!((scene.stepping.dt, scene.t_end, scene.stepping.growth), (0.3, 1.0, 1.5));
        // (1e-3 √0.1)^(2/3) / 5.
        assert!((scene.stepping.restart_dt - 9.283e-4).abs() < 1e-7, "{}", scene.stepping.restart_dt);
        assert_eq!(read("[time]\nscheme = \"midpoint\"\ndt = 0.5\nt_end = 1.0").unwrap_err(), "a scene by midpoint");
    }

    #[test]
    fn values_out_of_range_are_refused_with_their_field() {
        let with = |mesh: &str, time: &str| {
            read(&format!("[mesh]\n{mesh}\n[time]\nscheme = \"dg\"\nt_end = 1.0\n{time}\n")).unwrap_err()
        };
        for (mesh, time, words) in [
            ("degree = 0", "", "mesh.degree"),
            ("degree = 100", "", "mesh.degree"),
            ("", "degree = 6", "time.degree"),
            (
                "",
                "dt = 0.1\nrestart_dt = 0.2",
                "time.restart_dt: found 0.2; expected a number > 0 and at most dt = 0.1",
            ),
            ("", "growth = 0.5", "time.growth"),
            ("", "solver = \"newton\"", "unknown key `solver`"),
            ("", "dt = -1", "time.dt"),
            ("", "dt = 1e-20", "time.dt: found 1e-20, which is 1.000e20 steps"),
            ("elements = 100000\ndegree = 40", "degree = 5", "mesh.elements: found 100000, which would take about 7."),
        ] {
            let message = with(mesh, time);
            assert!(message.contains(words), "{message}");
        }
    }

    #[test]
    fn a_beam_without_viscosity_has_an_impact_time_too() {
        let scene =
            read("[beam]\nzeta = 0.0\n[obstacles]\nepsilon = 1e-3\n[time]\nscheme = \"dg\"\nt_end = 1.0").unwrap();
        assert_eq!(scene.stepping.restart_dt, 0.2 * 1e-3);
    }

    #[test]
    fn a_one_step_reader_refuses_the_scheme_and_a_degree() {
        let scene = |text: &str| Scene::parse(text, "s.toml").unwrap_err().to_string();
        let dg = scene("[time]\nscheme = \"dg\"\ndt = 0.5\nt_end = 1.0\n");
        assert!(dg.contains("time.scheme") && dg.contains("euler-crank-nicolson"), "{dg}");
        let degree = scene("[mesh]\ndegree = 2\n[time]\ndt = 0.5\nt_end = 1.0\n");
        assert!(degree.contains("mesh.degree: found 2"), "{degree}");
    }
}
