//! The beam of the paper's Section 5: (5.1), its initial data (5.3) to (5.5), its mesh and steps
//! (5.2).

use convergence_study::InputError;
use thermobeam::parameters::Obstacles;

use crate::scene::Scene;

/// The obstacles of (5.1).
pub(crate) const OBSTACLES: Obstacles = Obstacles {
    epsilon: 1e-3,
    g1: -0.01,
    g2: 0.1,
};

/// The paper's mesh and steps, (5.2).
const RESOLUTION: &str = "mesh = { elements = 100 }
time = { dt = 1e-4, t_end = 10.0, tolerance = 1e-10 }";

/// One of the experiments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Experiment {
    pub(crate) name: &'static str,
    /// The temperature of the clamped end: 0 or 20.
    pub(crate) theta_a: f64,
    /// The axial force at rest.
    pub(crate) beta: f64,
}

const fn experiment(name: &'static str, theta_a: f64, beta: f64) -> Experiment {
    Experiment {
        name,
        theta_a,
        beta,
    }
}

/// Without heating, (5.4); β ascending.
pub(crate) const FIRST: [Experiment; 3] = [
    experiment("paper-1-beta-minus-0.5", 0.0, -0.5),
    experiment("paper-1-beta-0", 0.0, 0.0),
    experiment("paper-1-beta-5", 0.0, 5.0),
];

/// Heated, (5.5); β ascending.
pub(crate) const SECOND: [Experiment; 3] = [
    experiment("paper-2-beta-minus-0.5", 20.0, -0.5),
    experiment("paper-2-beta-0", 20.0, 0.0),
    experiment("paper-2-beta-5", 20.0, 5.0),
];

/// Beyond buckling.
pub(crate) const THIRD: Experiment = experiment("paper-3-beta-minus-0.8", 0.0, -0.8);

/// All seven.
pub(crate) fn experiments() -> impl Iterator<Item = Experiment> {
    FIRST.into_iter().chain(SECOND).chain([THIRD])
}

impl Experiment {
    /// Its scene, at the paper's resolution.
    pub(crate) fn scene(self) -> Result<Scene, InputError> {
        self.by(RESOLUTION)
    }

    /// Its scene on another mesh, with other steps.
    ///
    /// * `method`: the tables `mesh` and `time` of a scene.
    pub(crate) fn by(self, method: &str) -> Result<Scene, InputError> {
        let Self {
            name,
            theta_a,
            beta,
        } = self;
        let Obstacles { epsilon, g1, g2 } = OBSTACLES;
        // 20 at x = 0: the clamped end is hot, and stays so.
        let theta = match theta_a {
            0.0 => "sin(pi*x)",
            _ => "20*cos(5*pi*x/2)",
        };
        let text = format!(
            "beam = {{ zeta = 0.1, a = 0.017, rho = 1.0, beta = {beta:?}, theta_a = {theta_a:?} }}
obstacles = {{ epsilon = {epsilon:?}, g1 = {g1:?}, g2 = {g2:?} }}
initial = {{ u = \"0.01*x*(x-2)\", u_t = \"20*x*(x-1)^2\", theta = \"{theta}\" }}
{method}
"
        );
        Scene::parse(&text, &format!("{name}.toml"))
    }
}
