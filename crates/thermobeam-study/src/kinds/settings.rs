//! The settings that an item of a study exercises; by these a diagnosis separates failing from
//! passing items.
//!
//! Each kind of study says what its items exercise, as an [`Exercise`], from what it has read of
//! its file. What an item is about is data of its [`Subject`].

mod places;

use convergence_study::{
    Axis, Header, Subject,
    internal::study::header::{SettingWords, study},
};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{MIDPOINT, Scheme};
use thermobeam::solve::Solver;

use crate::exact::norm::Norm;
use crate::run::family::is_uniform;
use crate::scene::{Method, Scene};

pub use places::PLACES;

/// A viscosity below this is small.
const SMALL_ZETA: f64 = 0.02;

/// The topic of studies of experiments.
pub(crate) const CONTACT: &str = "experiments with contact";

/// The topic of studies of the energy.
pub(crate) const ENERGY: &str = "the energy's laws";

/// The topic of studies of initial data.
pub(crate) const INITIAL_DATA: &str = "initial data";

/// The topic of studies of manufactured solutions.
pub(crate) const MANUFACTURED: &str = "manufactured solutions";

/// The topic of studies of vibrations.
pub(crate) const FREE_VIBRATIONS: &str = "free vibrations";

/// How an item is computed, where that is not the method of its study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ItemMethod {
    /// By a one-step scheme: the study's, or the paper's.
    OneStep,
    /// By the midpoint rule.
    Midpoint,
    /// By the paper's iteration.
    FixedPoint,
    /// By elements of any degree and dG(q).
    AnyOrder,
    /// By a formula, without time steps.
    Exact,
}

impl ItemMethod {
    const ALL: [(&str, ItemMethod); 5] = [
        ("one-step", ItemMethod::OneStep),
        ("midpoint", ItemMethod::Midpoint),
        ("fixed-point", ItemMethod::FixedPoint),
        ("dg", ItemMethod::AnyOrder),
        ("exact", ItemMethod::Exact),
    ];

    /// That of a scheme.
    pub(crate) fn of_scheme(scheme: &Scheme) -> Self {
        if *scheme == MIDPOINT {
            ItemMethod::Midpoint
        } else {
            ItemMethod::OneStep
        }
    }

    fn named(name: &str) -> Option<Self> {
        let row = Self::ALL.iter().find(|(known, _)| *known == name);
        row.map(|(_, method)| *method)
    }
}

impl From<ItemMethod> for String {
    /// Its word in a [`Subject`].
    fn from(method: ItemMethod) -> Self {
        let row = ItemMethod::ALL.iter().find(|(_, known)| *known == method);
        row.map_or("", |(name, _)| name).to_owned()
    }
}

/// How the runs of a study advance in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Integration {
    /// By a one-step scheme: the midpoint rule or the paper's, the fixed point or Newton's method.
    OneStep {
        is_midpoint: bool,
        is_fixed_point: bool,
    },
    /// By dG(q).
    AnyOrder,
    /// Not at all.
    Exact,
}

impl Integration {
    /// By the paper's scheme and Newton's method.
    pub(crate) const PAPER: Self = Self::OneStep {
        is_midpoint: false,
        is_fixed_point: false,
    };

    pub(crate) fn of(scheme: &Scheme, solver: Solver) -> Self {
        Self::OneStep {
            is_midpoint: *scheme == MIDPOINT,
            is_fixed_point: solver == Solver::FixedPoint,
        }
    }

    pub(crate) fn of_scene(scene: &Scene) -> Self {
        match &scene.method {
            Method::OneStep(stepping) => Self::of(&stepping.scheme, stepping.settings.solver),
            Method::Dg(_) => Self::AnyOrder,
        }
    }

    /// That of an item which has a method of its own.
    fn by(self, method: ItemMethod) -> Self {
        let (is_midpoint, is_fixed_point) = match self {
            Self::OneStep {
                is_midpoint,
                is_fixed_point,
            } => (is_midpoint, is_fixed_point),
            Self::AnyOrder | Self::Exact => (false, false),
        };
        match method {
            ItemMethod::Exact => Self::Exact,
            ItemMethod::AnyOrder => Self::AnyOrder,
            _ => Self::OneStep {
                is_midpoint: is_midpoint || method == ItemMethod::Midpoint,
                is_fixed_point: is_fixed_point || method == ItemMethod::FixedPoint,
            },
        }
    }

    /// Method, scheme and solver; a method without a choice of these is named instead.
    fn settings(self) -> [SettingWords; 3] {
        let keys = ["method", "scheme", "solver"];
        match self {
            Self::Exact => keys.map(|key| setting(key, "no time steps")),
            Self::AnyOrder => keys.map(|key| setting(key, "any order")),
            Self::OneStep {
                is_midpoint,
                is_fixed_point,
            } => {
                let [method, scheme, solver] = keys;
                [
                    setting(method, "one-step schemes"),
                    either(
                        scheme,
                        is_midpoint,
                        "the midpoint rule",
                        "the paper's scheme",
                    ),
                    either(solver, is_fixed_point, "the fixed point", "Newton's method"),
                ]
            }
        }
    }
}

/// The terms of the equations that are active.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct ActiveTerms {
    is_coupled: bool,
    is_nonlinear: bool,
    is_hot: bool,
    has_small_zeta: bool,
    has_obstacles: bool,
}

impl ActiveTerms {
    /// All but a small ζ, as in random scenes with moderate coefficients.
    pub(crate) const MODERATE: Self = Self {
        is_coupled: true,
        is_nonlinear: true,
        is_hot: true,
        has_small_zeta: false,
        has_obstacles: true,
    };

    /// All, as in random scenes.
    pub(crate) const ALL: Self = Self {
        has_small_zeta: true,
        ..Self::MODERATE
    };

    pub(crate) fn of(beam: &Beam, obstacles: Option<&Obstacles>) -> Self {
        Self {
            is_coupled: beam.a != 0.0,
            is_nonlinear: beam.rho != 0.0,
            is_hot: beam.theta_a != 0.0,
            has_small_zeta: beam.zeta < SMALL_ZETA,
            has_obstacles: obstacles.is_some(),
        }
    }

    /// Those of one or the other.
    #[must_use]
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            is_coupled: self.is_coupled || other.is_coupled,
            is_nonlinear: self.is_nonlinear || other.is_nonlinear,
            is_hot: self.is_hot || other.is_hot,
            has_small_zeta: self.has_small_zeta || other.has_small_zeta,
            has_obstacles: self.has_obstacles || other.has_obstacles,
        }
    }

    fn settings(self) -> [SettingWords; 5] {
        [
            either("coupling", self.is_coupled, "coupling a > 0", "no coupling"),
            either(
                "rho",
                self.is_nonlinear,
                "Kirchhoff's term, rho > 0",
                "a linear beam",
            ),
            either(
                "theta_a",
                self.is_hot,
                "a hot end, theta_A > 0",
                "a cold end",
            ),
            either(
                "zeta",
                self.has_small_zeta,
                "small zeta",
                "zeta of order 0.1",
            ),
            either("obstacles", self.has_obstacles, "obstacles", "a free end"),
        ]
    }
}

/// Where the nodes of the meshes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Nodes {
    Uniform,
    Graded,
    Listed,
    Perturbed,
}

impl Nodes {
    pub(crate) fn of_mesh(mesh: &Mesh) -> Self {
        if is_uniform(mesh) {
            Self::Uniform
        } else {
            Self::Graded
        }
    }

    pub(crate) fn of_scene(scene: &Scene) -> Self {
        if scene.listed.is_empty() {
            Self::of_mesh(&scene.mesh)
        } else {
            Self::Listed
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Uniform => "a uniform mesh",
            Self::Graded => "a graded mesh",
            Self::Listed => "listed nodes",
            Self::Perturbed => "a perturbed mesh",
        }
    }
}

/// What an item of a study exercises.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exercise {
    /// What is put to the test, in words that can stand alone.
    topic: &'static str,
    /// What is refined, in words.
    axis: Option<&'static str>,
    integration: Integration,
    terms: ActiveTerms,
    nodes: Nodes,
}

impl Exercise {
    /// On uniform meshes, without refinement.
    ///
    /// * `topic`: what is put to the test, in words that can stand alone.
    pub(crate) fn new(topic: &'static str, integration: Integration, terms: ActiveTerms) -> Self {
        Self {
            topic,
            axis: None,
            integration,
            terms,
            nodes: Nodes::Uniform,
        }
    }

    /// Beam and mesh of a scene.
    pub(crate) fn of_scene(topic: &'static str, integration: Integration, scene: &Scene) -> Self {
        let terms = ActiveTerms::of(&scene.beam, scene.obstacles.as_ref());
        Self::new(topic, integration, terms).on(Nodes::of_scene(scene))
    }

    /// Beams and meshes of the scene that a case is named after; of all scenes, if none is.
    pub(crate) fn of_scenes<'s>(
        topic: &'static str,
        integration: Integration,
        scenes: impl IntoIterator<Item = &'s Scene>,
        case: Option<&str>,
    ) -> Self {
        let mut all = Self::new(topic, integration, ActiveTerms::default());
        for (place, scene) in scenes.into_iter().enumerate() {
            let one = Self::of_scene(topic, integration, scene);
            if Some(&*scene.name) == case {
                return one;
            }
            all = if place == 0 { one } else { all.and(one) };
        }
        all
    }

    /// This and another one together: the terms of both, and special nodes only if both have them.
    #[must_use]
    pub(crate) fn and(self, other: Self) -> Self {
        let is_same = self.nodes == other.nodes;
        Self {
            terms: self.terms.or(other.terms),
            nodes: if is_same { self.nodes } else { Nodes::Uniform },
            ..self
        }
    }

    /// The same on other meshes.
    #[must_use]
    pub(crate) fn on(self, nodes: Nodes) -> Self {
        Self { nodes, ..self }
    }

    /// The same with refinement.
    #[must_use]
    pub(crate) fn refined_in(self, axis: &'static str) -> Self {
        Self {
            axis: Some(axis),
            ..self
        }
    }

    /// The settings of an item, which may have a method of its own.
    pub(crate) fn settings(self, header: &Header, subject: &Subject) -> Vec<SettingWords> {
        let mut settings = vec![study(header), setting("kind", self.topic)];
        let quantity = subject.quantity.as_str();
        if Norm::ALL.iter().any(|norm| norm.name() == quantity) {
            settings.push(setting("field", quantity));
        }
        if let Some(axis) = self.axis {
            settings.push(setting("axis", &format!("refined in {axis}")));
        }
        let own = subject.method.as_deref().and_then(ItemMethod::named);
        let integration = own.map_or(self.integration, |own| self.integration.by(own));
        settings.extend(integration.settings());
        settings.extend(self.terms.settings());
        settings.push(setting("mesh", self.nodes.name()));
        settings
    }
}

/// What is refined, in words.
pub(crate) fn axis_in_words(axis: Axis) -> &'static str {
    match axis {
        Axis::Space => "space",
        Axis::Time => "time",
        Axis::Both => "space and time",
    }
}

fn setting(key: &str, value: &str) -> SettingWords {
    (key.to_owned(), value.to_owned())
}

fn either(key: &str, holds: bool, value: &str, otherwise: &str) -> SettingWords {
    setting(key, if holds { value } else { otherwise })
}

#[cfg(test)]
mod tests {
    use super::{ActiveTerms, Exercise, Integration, ItemMethod, Nodes, SettingWords};
    use crate::kinds::KINDS;
    use crate::scene::Scene;
    use convergence_study::internal::study::StudyFile;
    use convergence_study::{Header, Subject};
    use std::path::Path;

    fn values(settings: Vec<SettingWords>) -> Vec<String> {
        settings.into_iter().map(|(_, value)| value).collect()
    }

    /// The settings of an item of a study of this repository.
    fn of_study(file: &str, subject: &Subject) -> Vec<String> {
        let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
        let read = StudyFile::read(&KINDS, &studies.join(file)).unwrap();
        values(read.study.settings(subject))
    }

    #[track_caller]
    fn has(settings: &[String], expected: &[&str]) {
        for value in expected {
            assert!(
                settings.iter().any(|own| own == value),
                "{value}: {settings:?}"
            );
        }
    }

    #[test]
    fn the_method_of_an_item_replaces_that_of_its_study() {
        let exercise = Exercise::new("steady states", Integration::Exact, ActiveTerms::default());
        let of = |subject: Subject| values(exercise.settings(&Header::new("a", "b"), &subject));
        let state = Subject::of("steady state");
        has(&of(state.clone()), &["no time steps"]);
        has(&of(state.by(ItemMethod::OneStep)), &["one-step schemes"]);
        for (_, method) in ItemMethod::ALL {
            assert_eq!(ItemMethod::named(&String::from(method)), Some(method));
        }
    }

    #[test]
    fn a_scene_gives_its_terms_its_nodes_and_its_scheme() {
        let text = "[beam]\nzeta = 0.01\na = 0\n[mesh]\nelements = 8\nmap = \"s^2/2 + s/2\"\n\
                    [time]\nscheme = \"midpoint\"\nsolver = \"fixed-point\"\ndt = 0.1\nt_end = 1\n";
        let scene = Scene::parse(text, "a.toml").unwrap();
        let integration = Integration::of_scene(&scene);
        let exercise = Exercise::of_scene("whole scenes", integration, &scene);
        let settings = values(exercise.settings(&Header::new("a", "b"), &Subject::of("u")));
        has(
            &settings,
            &[
                "the midpoint rule",
                "the fixed point",
                "no coupling",
                "Kirchhoff's term, rho > 0",
                "small zeta",
                "a cold end",
                "a free end",
                "a graded mesh",
            ],
        );
        assert_eq!(Nodes::of_mesh(&scene.mesh), Nodes::Graded);
    }

    /// Of the study's own values, of those of the case, and of scenes in other files.
    #[test]
    fn a_study_gives_what_it_has_read() {
        let space = of_study("theorem-3.4-space.toml", &Subject::of("temperature"));
        has(
            &space,
            &[
                "temperature",
                "refined in space",
                "manufactured solutions",
                "Newton's method",
                "a uniform mesh",
                "obstacles",
            ],
        );
        let graded = of_study("graded-mesh.toml", &Subject::of("temperature"));
        has(&graded, &["a graded mesh"]);
        let midpoint = of_study("vibration-midpoint.toml", &Subject::of("velocity"));
        has(
            &midpoint,
            &[
                "free vibrations",
                "the midpoint rule",
                "no coupling",
                "a linear beam",
            ],
        );
    }
}
