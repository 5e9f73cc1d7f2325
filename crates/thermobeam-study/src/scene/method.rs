//! How a scene is stepped: the table `[time]`, and the degree of the elements for its method.

use convergence_study::file::{Count, Number, Refusal};
use thermobeam::dg::DgStepping;
use thermobeam::mesh::Mesh;
use thermobeam::one_step::Stepping;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::solve::{Settings, Solver, Stopping};

use super::file::{MeshTable, SolverKeys, TimeTable, first_where};
use super::limits;
use super::parts::is_uniform;

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

    /// The degree of the elements. One-step schemes use linear elements; higher degrees must fit
    /// into memory.
    pub(super) fn degree(&self, table: &MeshTable, mesh: &Mesh) -> Result<usize, Refusal> {
        let degree = table.degree.map(Count::get);
        let Some(stepping) = self.dg() else {
            let allowed = "1, or time.scheme = \"dg\" for elements of higher degree";
            return match degree {
                None | Some(1) => Ok(1),
                Some(_) => Err(Refusal::written("degree", allowed)),
            };
        };
        let degree = degree.unwrap_or(DEGREE);
        let lengths = if is_uniform(mesh.nodes()) {
            1
        } else {
            mesh.elements()
        };
        let path = if table.nodes.is_some() {
            "nodes"
        } else {
            "elements"
        };
        limits::memory_of_dg(path, mesh.elements(), lengths, degree, stepping.degree)?;
        Ok(degree)
    }
}

impl TimeTable {
    /// The method, and t_end.
    pub(super) fn method(
        &self,
        beam: &Beam,
        obstacles: Option<&Obstacles>,
    ) -> Result<(Method, f64), Refusal> {
        let scheme = match self.scheme.map(|scheme| scheme.value) {
            None => Some(EULER_CRANK_NICOLSON),
            Some(scheme) => scheme,
        };
        let keys = SolverKeys {
            solver: self.solver,
            tolerance: self.tolerance,
            max_iterations: self.max_iterations,
            iterations: self.iterations,
        };
        let foreign = match scheme {
            Some(_) => first_where([
                ("degree", self.degree.is_some()),
                ("restart_dt", self.restart_dt.is_some()),
                ("growth", self.growth.is_some()),
            ]),
            None => first_where([
                ("solver", self.solver.is_some()),
                ("iterations", self.iterations.is_some()),
            ]),
        };
        if let Some(key) = foreign {
            let (found, allowed) = match scheme {
                Some(scheme) => (scheme.name, format!("{key} with scheme = \"{DG}\" alone")),
                None => (DG, format!("{key} with a one-step scheme alone")),
            };
            return Err(Refusal::new(key, format!("scheme = \"{found}\""), allowed));
        }
        let t_end = self.t_end.get();
        let method = match scheme {
            Some(scheme) => Method::OneStep(Stepping {
                scheme,
                settings: keys.over(Settings::default())?,
                dt: self.dividing_dt()?,
                loaded: false,
            }),
            None => Method::Dg(self.dg(beam, obstacles)?),
        };
        Ok((method, t_end))
    }

    /// The step of a one-step scheme; it must divide t_end.
    fn dividing_dt(&self) -> Result<f64, Refusal> {
        // Each of dt, t_end and their quotient is rounded once.
        const SLACK: f64 = 4.0 * f64::EPSILON;
        let t_end = self.t_end.get();
        let dt = self
            .dt
            .ok_or_else(|| Refusal::missing("dt", "a finite number > 0"))?
            .get();
        let quotient = t_end / dt;
        if quotient > limits::STEPS as f64 {
            let found = format!("{dt:?}, which is {quotient:.3e} steps for t_end = {t_end:?}");
            let allowed = format!("at most {:e} steps", limits::STEPS as f64);
            return Err(Refusal::new("dt", found, allowed));
        }
        let steps = quotient.round();
        if steps >= 1.0 && (steps * dt - t_end).abs() <= SLACK * t_end {
            return Ok(dt);
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
        let allowed =
            format!("a dt that divides t_end, the nearest being {nearest:?} ({steps} steps)");
        Err(Refusal::new("dt", found, allowed))
    }

    /// The steps of dG(q).
    fn dg(&self, beam: &Beam, obstacles: Option<&Obstacles>) -> Result<DgStepping, Refusal> {
        let t_end = self.t_end.get();
        let defaults = default_stepping(beam, obstacles, t_end);
        let dt = self.dt.map_or(defaults.dt, Number::get);
        if self.dt.is_some() {
            limits::steps_to("dt", t_end, dt, limits::STEPS)?;
        }
        let restart_dt = match self.restart_dt.map(Number::get) {
            Some(restart) if restart > dt => {
                let allowed = format!("a number > 0 and at most dt = {dt:?}");
                return Err(Refusal::written("restart_dt", allowed));
            }
            Some(restart) => restart,
            None => first_step(beam, obstacles, dt),
        };
        Ok(DgStepping {
            degree: self.degree.map_or(defaults.degree, Count::get),
            dt,
            restart_dt,
            growth: self.growth.map_or(GROWTH, Number::get),
            tolerance: self.tolerance.map_or(defaults.tolerance, Number::get),
            max_iterations: self
                .max_iterations
                .map_or(defaults.max_iterations, Count::get),
        })
    }
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
    fn a_last_step_that_is_shorter_counts_by_dg_alone() {
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
