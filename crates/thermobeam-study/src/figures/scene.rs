//! The pictures of a run of a scene, whatever the scheme.

use convergence_study::plots::{self, Axis, Guide, History, Phases, Series, SpaceTime};
use thermobeam::parameters::{Beam, Obstacles};

use super::{Animation, animation, obstacle_lines};

/// What a run of a scene shows.
pub struct SceneMotion<'r> {
    /// The scene's name.
    pub name: &'r str,
    /// Its coefficients.
    pub beam: &'r Beam,
    /// Its obstacles, if any.
    pub obstacles: Option<Obstacles>,
    /// `(t, u(1, t))`.
    pub u_tip: Vec<(f64, f64)>,
    /// `(t, φ(1, t))`.
    pub phi_tip: Vec<(f64, f64)>,
    /// `(t, E)`.
    pub energy: Vec<(f64, f64)>,
    /// Intervals of time in contact.
    pub contact: Vec<(f64, f64)>,
    /// Times of the frames.
    pub times: &'r [f64],
    /// Points x of the frames.
    pub points: &'r [f64],
    /// `u[k][i]` at `times[k]` and `points[i]`.
    pub frames: &'r [Vec<f64>],
}

impl SceneMotion<'_> {
    /// Names of files and their SVG documents: tip displacement with the obstacles, tip rotation, energy with its limit
    /// β²/(4ρ), u over space and time, the beam in motion.
    pub fn pictures(self) -> Vec<(&'static str, String)> {
        vec![
            ("space-time.svg", self.space_time()),
            ("motion.svg", self.motion()),
            ("tip-displacement.svg", self.tip_displacement()),
            ("tip-rotation.svg", self.tip_rotation()),
            ("energy.svg", self.energy()),
        ]
    }

    fn tip_displacement(&self) -> String {
        let guides = obstacle_lines(self.obstacles);
        let y = Axis::linear("displacement u(1, t) (dimensionless)");
        let figure = self.over_time("displacement of the free end", y, "u(1, t)", &self.u_tip);
        let phases = Phases { label: "in contact".into(), intervals: self.contact.clone() };
        plots::history(&History { guides, phases, ..figure })
    }

    fn tip_rotation(&self) -> String {
        let y = Axis::linear("rotation φ(1, t) (dimensionless)");
        plots::history(&self.over_time("rotation of the free end", y, "φ(1, t)", &self.phi_tip))
    }

    fn energy(&self) -> String {
        let figure = self.over_time("energy", Axis::linear("energy E (dimensionless)"), "E", &self.energy);
        let guide = |value| Guide { label: "β²/(4ρ)".into(), value };
        plots::history(&History { guides: energy_at_rest(self.beam).map(guide).into_iter().collect(), ..figure })
    }

    fn over_time(&self, what: &str, y: Axis, label: &str, points: &[(f64, f64)]) -> History {
        let title = Some(format!("{}: {what}", self.name));
        History {
            title,
            y,
            series: vec![Series { label: label.into(), points: points.to_vec() }],
            ..History::default()
        }
    }

    fn space_time(&self) -> String {
        plots::space_time(&SpaceTime {
            title: Some(format!("{}: displacement over space and time", self.name)),
            label: "displacement u (dimensionless)".into(),
            times: self.times.to_vec(),
            nodes: self.points.to_vec(),
            frames: self.frames.to_vec(),
        })
    }

    fn motion(&self) -> String {
        animation(&Animation {
            title: Some(format!("{}: the beam between its obstacles", self.name)),
            times: self.times.to_vec(),
            nodes: self.points.to_vec(),
            frames: self.frames.to_vec(),
            obstacles: self.obstacles.map(|obstacles| (obstacles.g1, obstacles.g2)),
            seconds: 20.0,
        })
    }
}

/// β²/(4ρ), the energy of the straight beam at rest; `None` without a Kirchhoff term.
pub fn energy_at_rest(beam: &Beam) -> Option<f64> {
    (beam.rho > 0.0).then(|| beam.beta * beam.beta / (4.0 * beam.rho))
}
