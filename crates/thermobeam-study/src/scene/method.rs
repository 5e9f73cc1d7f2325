//! How a scene is stepped: the table `[time]`, and the degree of the elements for its method.

use convergence_study::{Form, InputError, Key, Section, internal::input::POSITIVE};
use thermobeam::dg::{DgStepping, MAX_DEGREE, MAX_TIME_DEGREE};
use thermobeam::mesh::Mesh;
use thermobeam::one_step::Stepping;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::SCHEMES;
use thermobeam::solve::{Solver, Stopping};

use super::{limits, tables};

/// The value of `time.scheme` for elements of any degree and dG(q).
pub const DG: &str = "dg";

/// Default degree p: 1e-8 for the paper's first experiment on one element.
const DEGREE: usize = 13;

/// Default for the largest step.
const DT: f64 = 0.02;

/// Default growth of the steps.
const GROWTH: f64 = 1.5;

/// Default first step, in units of the time scale of an impact's peak.
const RESTART: f64 = 0.2;

const T_END: Key = Key::new("t_end", Form::Positive, "final time");

/// The keys of `[time]` for a one-step scheme, beside [`tables::STEPPING_KEYS`].
pub(super) const ONE_STEP_KEYS: [Key; 2] = [
    Key::new("dt", Form::Positive, "time step; it divides t_end"),
    T_END,
];

/// The keys of `[time]` for dG.
pub(super) const DG_KEYS: [Key; 8] = [
    Key::new(
        "scheme",
        Form::Choice(|| vec![DG]),
        "elements of any degree, dG(q) in time",
    ),
    Key::new("degree", Form::Count(0), "degree q in time").or("2"),
    Key::new("dt", Form::Positive, "the largest step").or("0.02, at most t_end"),
    Key::new(
        "restart_dt",
        Form::Positive,
        "the first step, at the start and after each contact event",
    )
    .or("a fifth of the time scale of an impact"),
    Key::new(
        "growth",
        Form::Number,
        "factor of the steps in between, at least 1",
    )
    .or("1.5"),
    T_END,
    Key::new(
        "tolerance",
        Form::Positive,
        "the increment at which an iteration ends",
    )
    .or("1e-14"),
    Key::new(
        "max_iterations",
        Form::Count(1),
        "iterations after which a step fails",
    )
    .or("100"),
];

/// How a scene is stepped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// By a one-step scheme on linear elements.
    OneStep(Stepping),
    /// By dG(q) on elements of degree p.
    Dg(DgStepping),
}

impl Method {
    /// The value of `time.scheme`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::OneStep(stepping) => stepping.scheme.name,
            Self::Dg(_) => DG,
        }
    }

    /// The value of `time.solver`; dG has a single one.
    pub fn solver(&self) -> &'static str {
        match self {
            Self::OneStep(stepping) => stepping.settings.solver.name(),
            Self::Dg(_) => Solver::Newton.name(),
        }
    }

    /// The steps of dG; `None` for a one-step scheme.
    pub fn dg(&self) -> Option<DgStepping> {
        match self {
            Self::OneStep(_) => None,
            Self::Dg(stepping) => Some(*stepping),
        }
    }

    /// When the iteration of a step ends.
    pub fn stopping(&self) -> Stopping {
        match self {
            Self::OneStep(stepping) => stepping.settings.stopping,
            Self::Dg(DgStepping {
                tolerance,
                max_iterations,
                ..
            }) => Stopping::Converged {
                tolerance: *tolerance,
                max_iterations: *max_iterations,
            },
        }
    }

    /// The time step; for dG the largest.
    pub fn dt(&self) -> f64 {
        match self {
            Self::OneStep(stepping) => stepping.dt,
            Self::Dg(stepping) => stepping.dt,
        }
    }

    /// The same with another step.
    pub(crate) fn with_dt(self, dt: f64) -> Self {
        match self {
            Self::OneStep(stepping) => Self::OneStep(Stepping { dt, ..stepping }),
            Self::Dg(stepping) => Self::Dg(DgStepping {
                dt,
                restart_dt: stepping.restart_dt.min(dt),
                ..stepping
            }),
        }
    }

    /// Default number of elements: the paper's number, or one.
    pub(super) fn default_elements(&self) -> usize {
        match self {
            Self::OneStep(_) => 100,
            Self::Dg(_) => 1,
        }
    }

    /// `mesh.degree`. One-step schemes use linear elements; higher degrees must fit into memory.
    pub(super) fn degree(&self, root: &Section<'_>, mesh: &Mesh) -> Result<usize, InputError> {
        let section = root.section("mesh")?;
        let get = |key: &str| section.as_ref().and_then(|section| section.get(key));
        let Some(stepping) = self.dg() else {
            let refused = get("degree").filter(|field| field.count(1..=1).is_err());
            let allowed = "1, or time.scheme = \"dg\" for elements of higher degree";
            return refused.map_or(
                Ok(1),
                |field| Err(field.refuse(field.as_written(), allowed)),
            );
        };
        let degree = get("degree").map_or(Ok(DEGREE), |field| field.count(1..=MAX_DEGREE))?;
        if let Some(field) = get("nodes").or_else(|| get("elements")) {
            let shortest = mesh
                .nodes()
                .windows(2)
                .map(|x| x[1] - x[0])
                .fold(f64::INFINITY, f64::min);
            let lengths = if mesh.size() <= (1.0 + 1e-6) * shortest {
                1
            } else {
                mesh.elements()
            };
            limits::any_order_memory(&field, mesh.elements(), lengths, degree, stepping.degree)?;
        }
        Ok(degree)
    }
}

/// The table `[time]`: the method, and t_end.
///
/// # Errors
/// An unknown scheme is reported first, since the keys depend on it.
pub(super) fn read(
    root: &Section<'_>,
    beam: &Beam,
    obstacles: Option<&Obstacles>,
) -> Result<(Method, f64), InputError> {
    let names: Vec<_> = SCHEMES
        .iter()
        .map(|scheme| (scheme.name, false))
        .chain([(DG, true)])
        .collect();
    let scheme = root.section("time")?.and_then(|time| time.get("scheme"));
    let is_dg = scheme.map_or(Ok(false), |field| field.choice(&names))?;
    let expected = if is_dg {
        "a table with scheme and t_end"
    } else {
        "a table with dt and t_end"
    };
    let time = root.require("time", expected)?.section()?;
    if is_dg {
        dg(&time, beam, obstacles)
    } else {
        one_step(&time)
    }
}

/// A one-step scheme, and t_end.
fn one_step(time: &Section<'_>) -> Result<(Method, f64), InputError> {
    time.allow(&convergence_keys::names(&[
        &ONE_STEP_KEYS,
        &tables::STEPPING_KEYS,
    ]))?;
    let (dt, t_end) = time_steps(time)?;
    let (scheme, settings) = (tables::scheme(time)?, tables::settings(time)?);
    Ok((
        Method::OneStep(Stepping {
            scheme,
            settings,
            dt,
            loaded: false,
        }),
        t_end,
    ))
}

/// dt and t_end; dt must divide t_end.
fn time_steps(time: &Section<'_>) -> Result<(f64, f64), InputError> {
    // Each of dt, t_end and their quotient is rounded once.
    const SLACK: f64 = 4.0 * f64::EPSILON;
    let t_end = time.positive("t_end")?;
    let field = time.require("dt", POSITIVE)?;
    let dt = field.positive()?;
    let quotient = t_end / dt;
    if quotient > limits::STEPS as f64 {
        let found = format!("{dt:?}, which is {quotient:.3e} steps for t_end = {t_end:?}");
        return Err(field.refuse(found, format!("at most {:e} steps", limits::STEPS as f64)));
    }
    let steps = quotient.round();
    if steps >= 1.0 && (steps * dt - t_end).abs() <= SLACK * t_end {
        return Ok((dt, t_end));
    }
    let candidates =
        [quotient.floor().max(1.0), quotient.ceil()].map(|steps| (steps, t_end / steps));
    let [low, high] = candidates;
    let (steps, nearest) = if (low.1 - dt).abs() <= (high.1 - dt).abs() {
        low
    } else {
        high
    };
    let found = format!("{dt:?}, which is {quotient} steps for t_end = {t_end:?}");
    Err(field.refuse(
        found,
        format!("a dt that divides t_end, the nearest being {nearest:?} ({steps} steps)"),
    ))
}

/// dG(q), and t_end.
fn dg(
    time: &Section<'_>,
    beam: &Beam,
    obstacles: Option<&Obstacles>,
) -> Result<(Method, f64), InputError> {
    time.allow(&convergence_keys::names(&[&DG_KEYS]))?;
    let t_end = time.positive("t_end")?;
    let defaults = default_stepping(beam, obstacles, t_end);
    let or = |key: &str, default: f64| time.get(key).map_or(Ok(default), |field| field.positive());
    let count = |key: &str, default: usize, allowed| {
        time.get(key)
            .map_or(Ok(default), |field| field.count(allowed))
    };
    let dt = or("dt", defaults.dt)?;
    if let Some(field) = time.get("dt") {
        limits::steps_until(&field, t_end, dt, limits::STEPS)?;
    }
    let restart_dt = match time.get("restart_dt") {
        Some(field) => field
            .number_where(&format!("a number > 0 and at most dt = {dt:?}"), |h| {
                h > 0.0 && h <= dt
            })?,
        None => first_step(beam, obstacles, dt),
    };
    let growth = match time.get("growth") {
        Some(field) => field.number_where("a finite number >= 1", |growth| growth >= 1.0)?,
        None => GROWTH,
    };
    let stepping = DgStepping {
        degree: count("degree", defaults.degree, 0..=MAX_TIME_DEGREE)?,
        dt,
        restart_dt,
        growth,
        tolerance: or("tolerance", defaults.tolerance)?,
        max_iterations: count("max_iterations", defaults.max_iterations, 1..=usize::MAX)?,
    };
    Ok((Method::Dg(stepping), t_end))
}

/// The steps of a scene that specifies none.
pub(super) fn default_stepping(
    beam: &Beam,
    obstacles: Option<&Obstacles>,
    t_end: f64,
) -> DgStepping {
    let dt = DT.min(t_end);
    DgStepping {
        dt,
        restart_dt: first_step(beam, obstacles, dt),
        growth: GROWTH,
        ..DgStepping::default()
    }
}

/// A fifth of the time scale of an impact's peak, and at most dt.
fn first_step(beam: &Beam, obstacles: Option<&Obstacles>, dt: f64) -> f64 {
    let impact = obstacles.map_or(dt, |obstacles| obstacles.impact_time(beam.zeta));
    (RESTART * impact).min(dt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn read(text: &str) -> Result<(Scene, DgStepping), String> {
        let scene = Scene::parse(text, "s.toml").map_err(|error| error.to_string())?;
        let stepping = scene
            .method
            .dg()
            .ok_or_else(|| format!("a scene by {}", scene.method.name()))?;
        Ok((scene, stepping))
    }

    #[test]
    fn keys_are_read_and_defaults_follow_the_scene() {
        let text = "[obstacles]\n[mesh]\ndegree = 4\n[time]\nscheme = \"dg\"\ndegree = 3\ndt = 0.3\nt_end = 1.0\n";
        let (scene, stepping) = read(text).unwrap();
        assert_eq!(
            (scene.degree, scene.mesh.elements(), stepping.degree),
            (4, 1, 3)
        );
        assert_eq!((stepping.dt, scene.t_end, stepping.growth), (0.3, 1.0, 1.5));
        // (1e-3 √0.1)^(2/3) / 5.
        assert!(
            (stepping.restart_dt - 9.283e-4).abs() < 1e-7,
            "{}",
            stepping.restart_dt
        );
        assert_eq!(
            read("[time]\nscheme = \"midpoint\"\ndt = 0.5\nt_end = 1.0").unwrap_err(),
            "a scene by midpoint"
        );
    }

    #[test]
    fn values_out_of_range_are_refused_with_their_field() {
        let with = |mesh: &str, time: &str| {
            read(&format!(
                "[mesh]\n{mesh}\n[time]\nscheme = \"dg\"\nt_end = 1.0\n{time}\n"
            ))
            .unwrap_err()
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
            (
                "",
                "dt = 1e-20",
                "time.dt: found 1e-20, which is 1.000e20 steps",
            ),
            (
                "elements = 100000\ndegree = 40",
                "degree = 5",
                "mesh.elements: found 100000, which would take about 7.",
            ),
        ] {
            let message = with(mesh, time);
            assert!(message.contains(words), "{message}");
        }
    }

    #[test]
    fn a_beam_without_viscosity_has_an_impact_time_too() {
        let text =
            "[beam]\nzeta = 0.0\n[obstacles]\nepsilon = 1e-3\n[time]\nscheme = \"dg\"\nt_end = 1.0";
        assert_eq!(read(text).unwrap().1.restart_dt, 0.2 * 1e-3);
    }

    #[test]
    fn a_one_step_scheme_refuses_a_degree_and_counts_its_steps() {
        let degree = read("[mesh]\ndegree = 2\n[time]\ndt = 0.5\nt_end = 1.0\n").unwrap_err();
        assert!(degree.contains("mesh.degree: found 2"), "{degree}");
        let steps = |text: &str| Scene::parse(text, "s.toml").unwrap().steps();
        assert_eq!(steps("[time]\ndt = 0.1\nt_end = 0.3\n"), 3);
        assert_eq!(steps("[time]\nscheme = \"dg\"\ndt = 0.2\nt_end = 0.3\n"), 2);
    }

    #[test]
    fn dg_steps_of_a_one_step_scene_are_the_defaults() {
        let [one_step, dg] = ["dt = 0.1", "scheme = \"dg\""].map(|time| {
            let text = format!("[obstacles]\nepsilon = 1e-4\n[time]\n{time}\nt_end = 1.0\n");
            Scene::parse(&text, "s.toml").unwrap()
        });
        assert_eq!(one_step.dg_stepping(), dg.dg_stepping());
        assert!(
            one_step.one_step().is_ok()
                && dg.one_step().unwrap_err().to_string().contains("found dg")
        );
    }
}
