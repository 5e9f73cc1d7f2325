//! The beam of the paper's Section 5: (5.1), its initial data (5.3) to (5.5), its mesh and steps
//! (5.2).

use convergence_study::InputError;
use thermobeam::parameters::{Beam, Obstacles};

use crate::scene::{Scene, parts::Parts};

/// The obstacles of (5.1).
pub(crate) const OBSTACLES: Obstacles = Obstacles {
    epsilon: 1e-3,
    g1: -0.01,
    g2: 0.1,
};

/// The paper's mesh and steps, (5.2).
pub(crate) const RESOLUTION: &str = "mesh = { elements = 100 }
time = { dt = 1e-4, t_end = 10.0, tolerance = 1e-10 }";
pub(crate) const ELEMENTS: usize = 100;
pub(crate) const STEPS: usize = 100_000;
/// The end of the figures.
pub(crate) const T_END: f64 = 10.0;

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
    /// The energy of the straight beam at rest, β²/(4ρ).
    pub(crate) fn straight_energy(self) -> f64 {
        self.beta * self.beta / 4.0
    }

    /// What its runs are made of, but for mesh and method.
    pub(crate) fn parts(self) -> Parts {
        let Self { theta_a, beta, .. } = self;
        let beam = Beam {
            theta_a,
            beta,
            ..Beam::default()
        };
        Parts::new(&beam, Some(&OBSTACLES))
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::{f64::consts::PI, path::Path};
    use thermobeam::parameters::Beam;
    use thermobeam::solve::Settings;

    /// What the paper prints, (5.1) and (5.3) to (5.5), as functions, and the files in `studies/`.
    #[test]
    fn the_experiments_have_the_data_that_the_paper_prints() {
        let names: Vec<&str> = experiments().map(|one| one.name).collect();
        assert_eq!(names.len(), 7);
        let expected = [-0.5, 0.0, 5.0].map(|beta| [(0.0, beta), (20.0, beta)]);
        for (k, experiment) in experiments().enumerate() {
            let Experiment {
                name,
                theta_a,
                beta,
            } = experiment;
            let printed = if k < 6 {
                expected[k % 3][k / 3]
            } else {
                (0.0, -0.8)
            };
            assert_eq!((theta_a, beta), printed, "{name}");
            let scene = experiment.scene().expect("a scene");
            let file = format!("../../studies/scenes/{name}.toml");
            let file = Scene::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(file));
            let file = file.unwrap_or_else(|error| panic!("{error}"));
            for scene in [&scene, &file] {
                let beam = Beam {
                    zeta: 0.1,
                    a: 0.017,
                    rho: 1.0,
                    beta,
                    theta_a,
                };
                assert_eq!((scene.beam, scene.obstacles), (beam, Some(OBSTACLES)));
                // They are the defaults, too.
                let of_default = Beam {
                    beta,
                    theta_a,
                    ..Beam::default()
                };
                assert_eq!((of_default, Obstacles::default()), (beam, OBSTACLES));
                assert_eq!(scene.name, name);
                let stepping = scene.one_step().expect("a one-step scheme");
                assert_eq!(stepping.settings, Settings::default(), "{name}");
                assert_eq!((scene.t_end, scene.steps()), (T_END, STEPS));
                assert_eq!(scene.mesh.elements(), ELEMENTS);
                let initial = &scene.initial;
                assert!(initial.phi.is_none() && initial.phi_t.is_none());
                let heat = |x: f64| match theta_a {
                    0.0 => (PI * x).sin(),
                    _ => 20.0 * (2.5 * PI * x).cos(),
                };
                for x in (0..=64).map(|k| f64::from(k) / 64.0) {
                    for (found, printed) in [
                        (&initial.u, 0.01 * x * (x - 2.0)),
                        (&initial.u_t, 20.0 * x * (x - 1.0).powi(2)),
                        (&initial.theta, heat(x)),
                    ] {
                        let found = found.as_ref().expect("a function").eval(x);
                        assert!((found - printed).abs() <= 1e-13, "{name}: {found}");
                    }
                }
            }
        }
    }
}
