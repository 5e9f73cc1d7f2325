//! The scenes: random ones, those that are rough, and the discretisations to which the runs of a
//! search are compared.

use thermobeam::{
    dg::DgStepping, mesh::Mesh, one_step::Stepping, scheme::MIDPOINT, solve::Settings,
};

use super::{Drawn, RandomErrors};
use crate::kinds::prelude::*;
use crate::scene::{Method, Scene};
use convergence_judge::judge::random::SplitMix;

/// Elements of the coarsest linear mesh, and its steps per unit of time.
const COARSEST: [usize; 2] = [80, 2500];

/// Final time of all scenes.
const T_END: f64 = 0.4;

/// A feature of the initial data that is not smooth, or narrow.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Feature {
    field: &'static str,
    /// The function that is added to the field.
    text: String,
    x: f64,
    /// Size of the elements that resolve it at x.
    width: f64,
}

impl RandomErrors {
    /// The scene of a case, and its feature if it has one.
    pub(super) fn scene(&self, drawn: Drawn) -> Result<(Scene, Option<Feature>), InputError> {
        // Far from the seeds of other studies, which are small.
        let first_seed = self.seed << 32;
        Ok(match drawn {
            Drawn::Given(number) => (self.given[number].clone(), None),
            Drawn::Smooth(number) => (
                random_scene(&mut SplitMix::new(first_seed + number as u64), number, None)?,
                None,
            ),
            Drawn::Rough(number) => {
                let mut random = SplitMix::new(first_seed + (1 << 24) + number as u64);
                let feature = Feature::random(&mut random, number);
                (
                    random_scene(&mut random, number, Some(&feature))?,
                    Some(feature),
                )
            }
        })
    }

    /// Twelve elements of degree 14 or 11, shorter towards x = 1 and towards a feature, and short
    /// steps.
    pub(super) fn independent(
        &self,
        scene: &Scene,
        feature: Option<&Feature>,
    ) -> Result<Scene, CaseFailure> {
        let mut nodes = vec![
            0.0, 0.125, 0.25, 0.375, 0.5, 0.65, 0.8, 0.9, 0.96, 0.985, 0.995, 0.999, 1.0,
        ];
        let impact = scene
            .obstacles
            .map_or(T_END, |obstacles| obstacles.impact_time(scene.beam.zeta));
        let mut restart_dt = 1e-3 * impact;
        if let Some(&Feature { x, width, .. }) = feature {
            restart_dt *= 1e-3;
            let distances =
                std::iter::successors(Some(width), |d| Some(3.0 * d)).take_while(|d| *d < 0.1);
            // A function may have no value at its jump; a kink is between the innermost nodes, 1e-5
            // apart.
            let around = distances.flat_map(|d| [x - d, x + d]);
            nodes.retain(|node| *node == 0.0 || *node == 1.0 || (node - x).abs() > 0.03);
            nodes.extend(around.filter(|node| 0.0 < *node && *node < 1.0));
            nodes.sort_by(f64::total_cmp);
            nodes.dedup();
        }
        let dt = impact.clamp(0.002, 0.004);
        // Three digits more than the targets.
        let [degree, time_degree] = if self.targets.iter().all(|target| *target >= 1e-4) {
            [11, 3]
        } else {
            [14, 4]
        };
        let stepping = DgStepping {
            degree: time_degree,
            dt,
            restart_dt,
            growth: 1.25,
            ..DgStepping::default()
        };
        let mesh = Mesh::from_nodes(nodes)?;
        Ok(Scene {
            mesh,
            degree,
            method: Method::Dg(stepping),
            ..scene.clone()
        })
    }

    /// The scene on linear elements, with steps of `midpoint`; both `times` as fine.
    pub(super) fn linear(scene: &Scene, times: usize) -> Result<Scene, CaseFailure> {
        let [elements, steps] = COARSEST;
        let dt = 1.0 / (steps * times) as f64;
        let stepping = Stepping {
            scheme: MIDPOINT,
            settings: Settings::default(),
            dt,
            loaded: false,
        };
        let mesh = Mesh::uniform(elements * times)?;
        Ok(Scene {
            mesh,
            degree: 1,
            method: Method::OneStep(stepping),
            ..scene.clone()
        })
    }
}

/// A scene with moderate coefficients, obstacles that the beam hits, and smooth initial data, to
/// one of which a feature is added.
fn random_scene(
    random: &mut SplitMix,
    number: usize,
    feature: Option<&Feature>,
) -> Result<Scene, InputError> {
    let mut between = |low: f64, high: f64| random.within([low, high]);
    let time = [
        "dt = 0.002",
        "dt = 0.004\nscheme = \"midpoint\"",
        "scheme = \"dg\"\ndegree = 1",
    ][number % 3];
    let mesh = if number % 3 == 2 {
        "elements = 2\ndegree = 8"
    } else {
        "elements = 32"
    };
    let theta_a = between(-5.0, 5.0);
    let coefficients = format!(
        "[beam]\nzeta = {:?}\na = {:?}\nrho = {:?}\nbeta = {:?}\ntheta_a = {theta_a:?}\n\
         [obstacles]\nepsilon = {:?}\ng1 = {:?}\ng2 = {:?}\n",
        10f64.powf(between(-2.0, 0.0)),
        between(0.0, 1.0),
        10f64.powf(between(-0.5, 0.7)),
        between(-2.0, 5.0),
        10f64.powf(between(-3.5, -2.0)),
        -between(0.005, 0.1),
        between(0.01, 0.1),
    );
    let fields = [
        ("u", format!("{:?}*x*(x-2)", between(-0.01, 0.01))),
        (
            "u_t",
            format!(
                "{:?}*x + {:?}*x*(x-1)^2",
                between(-3.0, 3.0),
                between(5.0, 20.0)
            ),
        ),
        (
            "theta",
            format!("{theta_a:?}*(1-x) + {:?}*sin(pi*x)", between(-2.0, 2.0)),
        ),
        ("phi", "0*x".to_owned()),
        ("phi_t", "0*x".to_owned()),
    ];
    let mut initial = String::from("[initial]\n");
    for (field, function) in fields {
        match feature.filter(|feature| feature.field == field) {
            Some(feature) => initial += &format!("{field} = \"{function} + {}\"\n", feature.text),
            None if function == "0*x" => (),
            None => initial += &format!("{field} = \"{function}\"\n"),
        }
    }
    let text = format!("{coefficients}{initial}[mesh]\n{mesh}\n[time]\nt_end = {T_END}\n{time}\n");
    Scene::parse(&text, "random.toml")
}

impl Feature {
    /// A narrow feature, a kink or a jump; u and φ do not jump.
    fn random(random: &mut SplitMix, number: usize) -> Self {
        // The scheme of the scene has the period three.
        let kind = number / 3 % 3;
        let sizes = [
            ("u_t", 30.0),
            ("phi_t", 10.0),
            ("theta", 5.0),
            ("u", 0.02),
            ("phi", 0.2),
        ];
        let (field, size) = sizes[random.below(if kind == 2 { 3 } else { 5 })];
        let x = random.within([0.1, 0.9]);
        let height = size * random.within([0.2, 1.0]);
        let (width, shape) = match kind {
            0 => {
                let width = 10f64.powf(random.within([-4.0, -2.3]));
                (0.5 * width, format!("exp(-((x-{x:?})/{width:?})^2)"))
            }
            1 => {
                let kinks = [
                    format!("max(0,x-{x:?})"),
                    format!("min(x,{x:?})"),
                    format!("abs(x-{x:?})"),
                ];
                (1e-5, kinks[random.below(3)].clone())
            }
            _ => {
                let steps = [
                    format!("(x-{x:?})/abs(x-{x:?})"),
                    format!("tanh((x-{x:?})*1e9)"),
                    format!("min(1,max(0,(x-{x:?})*1e8))"),
                ];
                (1e-7, steps[random.below(3)].clone())
            }
        };
        Self {
            field,
            text: format!("{height:?}*4*x*(1-x)*{shape}"),
            x,
            width,
        }
    }
}
