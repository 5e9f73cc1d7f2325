//! Errors of random and of given scenes with contact: their estimates, and the runs chosen for an
//! accuracy, against runs that share neither mesh nor steps with the search, at times and in a norm
//! that are not those of the search.
//!
//! Such runs would not reveal a mistake that all dG runs share. So for some scenes linear elements
//! and steps of `midpoint` are refined in addition: they must converge to the chosen run.
//!
//! ```toml
//! [random-errors]
//! scenes = 12            # smooth data, by the paper's scheme, midpoint and dG in turn
//! rough = 3              # a narrow feature, a kink or a jump in one of the fields; a search may refuse to resolve it
//! refined = 4            # every fourth scene of smooth data is also run on finer and finer linear elements; 0: none is
//! targets = [1e-4, 1e-6] # of u(1, t)
//! norm_targets = [1e-2]  # of the norm of Theorem 3.4
//! seed = 1
//!
//! [[case]]               # given scenes, if any: a name and the tables of a scene
//! name = "..."
//! ```

mod truth;

use thermobeam::dg::Stepping;
use thermobeam::simulation::Stepping as OneStep;

use self::truth::{Trace, Truth, points};
use super::prelude::*;
use super::runs::cases::named_cases;
use crate::predict::choice::{self, choose};
use crate::predict::estimate::estimate;
use crate::predict::{MOST_WORK, Unreachable, Work};
use crate::scene;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "random-errors",
    read: reader::<RandomErrors>,
    why: "Users rely on an error that the program prints. Here it is measured against runs on twelve elements of degree 11 or 14, which no \
          search tries, at other times and by other quadrature; for some scenes linear elements and small steps must tend to the same \
          motion.",
    judged: "No error of any number exceeds 1.3 times its estimate, no run the error asked for, no search is refused unless its data \
             are rough, and the error of linear elements falls at least fourfold with four times the elements and steps.",
    failure: "The comparisons of a search are too coarse, or look where the error is not; a run that no finer one confirms may be wrong.",
    settings: |header, item| {
        Topic::new("experiments with contact", ItemMethod::OneStep).settings(header, item)
    },
};

/// An error may be this many times its estimate.
const EXCEEDED: f64 = 1.3;

/// Required ratio of linear elements' errors for four times the elements and steps: contact costs
/// first order.
const FALL: f64 = 4.0;

/// Elements of the coarsest linear mesh, and its steps per unit of time.
const COARSEST: [usize; 2] = [80, 2500];

/// Tolerance of the baseline on the work: one round more or less of a search.
const WORK_TOLERANCE: f64 = 0.2;

/// Final time of all scenes.
const T_END: f64 = 0.4;

/// A study of errors of random scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomErrors {
    scenes: usize,
    rough: usize,
    refined: usize,
    targets: Vec<f64>,
    norm_targets: Vec<f64>,
    seed: u64,
    given: Vec<Scene>,
}

/// The scene of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drawn {
    /// Random and smooth, with its number.
    Smooth(usize),
    /// Random, with a narrow feature, a kink or a jump.
    Rough(usize),
    /// Given in the file.
    Given(usize),
}

/// A feature of the initial data that is not smooth, or narrow.
#[derive(Debug, Clone, PartialEq)]
struct Feature {
    field: &'static str,
    /// The function that is added to the field.
    text: String,
    x: f64,
    /// Size of the elements that resolve it at x.
    width: f64,
}

/// Why a search was abandoned.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    /// The search and the reason, in words.
    pub words: String,
    /// Whether data with features may be refused so: no mesh resolves them, or a finer run
    /// contradicts the search.
    pub is_of_features: bool,
}

impl Refusal {
    fn new(search: &str, why: &Unreachable) -> Self {
        let is_of_features = matches!(
            why,
            Unreachable::Unresolved { .. } | Unreachable::Contradicted { .. }
        );
        Self {
            words: format!("{search}: {why}"),
            is_of_features,
        }
    }
}

/// The results of a scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// The largest error of a number, in units of its estimate.
    pub over_estimate: f64,
    /// The largest error of u(1, t) of a chosen run, in units of its target.
    pub over_target: f64,
    /// The same in the norm.
    pub over_norm_target: f64,
    /// Why searches were abandoned.
    pub refused: Vec<Refusal>,
    /// Whether a search may be refused, because the data have features that no mesh resolves.
    pub may_be_refused: bool,
    /// Errors of linear elements, and of four times as many with four times the steps.
    pub linear: Option<[f64; 2]>,
    /// Work of the searches.
    pub work: f64,
}

impl FromFile for RandomErrors {
    fn from_document(_: &Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", ROW.name, "case"])?;
        let section = root.table(
            ROW.name,
            &[
                "scenes",
                "rough",
                "refined",
                "targets",
                "norm_targets",
                "seed",
            ],
        )?;
        let positive = |list: &[f64]| !list.is_empty() && list.iter().all(|target| *target > 0.0);
        let targets = |key| section.list(key, "a list of numbers > 0", Field::number, positive);
        let given = if root.get("case").is_some() {
            named_cases(root, given)?
        } else {
            vec![]
        };
        Ok(Self {
            scenes: section.count("scenes", usize::from(given.is_empty())..=10_000)?,
            rough: section.count("rough", 0..=10_000)?,
            refined: section.count("refined", 0..=10_000)?,
            targets: targets("targets")?,
            norm_targets: targets("norm_targets")?,
            seed: section.count("seed", 0..=u32::MAX as usize)? as u64,
            given,
        })
    }
}

fn given(section: &Section<'_>, name: String) -> Result<Scene, InputError> {
    section.allow(&[&["name"], &scene::TABLES[..]].concat())?;
    Scene::from_tables(section, name)
}

impl RandomErrors {
    /// The scene of a case, and its feature if it has one.
    fn scene(&self, drawn: Drawn) -> Result<(Scene, Option<Feature>), InputError> {
        // Far from the seeds of other studies, which are small.
        let seed = |first: u64, number: usize| (self.seed << 32) + first + number as u64;
        Ok(match drawn {
            Drawn::Given(number) => (self.given[number].clone(), None),
            Drawn::Smooth(number) => (
                random_scene(&mut SplitMix::new(seed(0, number)), number, None)?,
                None,
            ),
            Drawn::Rough(number) => {
                let mut random = SplitMix::new(seed(1 << 24, number));
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
    fn independent(&self, scene: &Scene, feature: Option<&Feature>) -> Result<Scene, CaseFailure> {
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
                || std::iter::successors(Some(width), |d| Some(3.0 * d)).take_while(|d| *d < 0.1);
            // A function may have no value at its jump; a kink is between the innermost nodes, 1e-5
            // apart.
            let around = distances().flat_map(|d| [x - d, x + d]);
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
        let stepping = Stepping {
            degree: time_degree,
            dt,
            restart_dt,
            growth: 1.25,
            ..Stepping::default()
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
    fn linear(scene: &Scene, times: usize) -> Result<Scene, CaseFailure> {
        let [elements, steps] = COARSEST;
        let dt = 1.0 / (steps * times) as f64;
        let stepping = OneStep {
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

    /// The run chosen for each target; a refusal is noted.
    fn chosen(
        &self,
        scene: &Scene,
        quantity: choice::Quantity,
        refused: &mut Vec<Refusal>,
        work: &mut Work<'_>,
    ) -> Vec<(f64, Scene)> {
        let targets = if quantity == choice::Quantity::Tip {
            &self.targets
        } else {
            &self.norm_targets
        };
        let mut chosen = vec![];
        for &target in targets {
            match choose(scene, quantity, target, work) {
                Ok(choice) => chosen.push((target, choice.scene)),
                Err(why) => {
                    let search = format!("{} {target:e}", quantity.name());
                    refused.push(Refusal::new(&search, &why));
                }
            }
        }
        chosen
    }

    fn measure(&self, drawn: Drawn) -> Result<Found, CaseFailure> {
        let (scene, feature) = self.scene(drawn)?;
        let exact = self.independent(&scene, feature.as_ref())?;
        let mut ignored = |_: f64| ();
        let work = &mut Work::new(MOST_WORK, &mut ignored);
        let mut refused = vec![];
        let estimates = estimate(&scene, work).map_or_else(
            |why: Unreachable| {
                refused.push(Refusal::new("estimate", &why));
                vec![]
            },
            |budget| budget.quantities,
        );
        let chosen = self.chosen(&scene, choice::Quantity::Tip, &mut refused, work);
        let in_norm = self.chosen(&scene, choice::Quantity::Norm, &mut refused, work);
        let points = points(
            in_norm
                .iter()
                .map(|(_, chosen)| &chosen.mesh)
                .chain([&exact.mesh]),
        );
        let is_refined = matches!(drawn, Drawn::Smooth(number) if self.refined > 0 && number.is_multiple_of(self.refined));
        let times: &[usize] = if is_refined { &[1, 4] } else { &[] };
        let linear = times
            .iter()
            .map(|times| Self::linear(&scene, *times))
            .collect::<Result<Vec<Scene>, _>>()?;
        let mut traces = vec![];
        for run in [&scene]
            .into_iter()
            .chain(chosen.iter().map(|(_, run)| run))
            .chain(&linear)
        {
            traces.push(Trace::of(run, &[])?);
        }
        for (_, run) in &in_norm {
            traces.push(Trace::of(run, &points)?);
        }
        let truth = Truth::of(&exact, &traces.iter().collect::<Vec<_>>(), &points)?;
        let mut found = Found {
            refused,
            may_be_refused: feature.is_some(),
            work: work.spent().work,
            ..Found::default()
        };
        for of in &estimates {
            found.over_estimate = max_or_nan(
                found.over_estimate,
                truth.of_estimate(0, &traces[0], of) / of.total,
            );
        }
        let first_linear = 1 + chosen.len();
        for (k, (target, _)) in (1..).zip(&chosen) {
            found.over_target =
                max_or_nan(found.over_target, truth.of_curve(k, &traces[k], 0) / target);
        }
        for (k, (target, _)) in (first_linear + linear.len()..).zip(&in_norm) {
            found.over_norm_target = max_or_nan(
                found.over_norm_target,
                truth.of_norm(k, &traces[k], &points) / target,
            );
        }
        found.linear = is_refined
            .then(|| [first_linear, first_linear + 1].map(|k| truth.of_curve(k, &traces[k], 0)));
        Ok(found)
    }

    fn checks(
        &self,
        ran: &[Ran<Drawn, Found>],
        found: &[(&Ran<Drawn, Found>, &Found)],
    ) -> Vec<Check> {
        let [over_estimate, over_target, over_norm_target] = worst(found).unwrap_or([f64::NAN; 3]);
        let falls: Vec<f64> = found
            .iter()
            .filter_map(|(_, of)| of.linear.map(|[coarse, fine]| coarse / fine))
            .collect();
        let least = falls.iter().copied().fold(f64::INFINITY, min_or_nan);
        let fall = format!("their error falls {FALL} times or more");
        let [refused, rough] = [false, true].map(|is_rough| refusals(found, is_rough));
        let [refused_words, rough_words] = [&refused, &rough].map(|refusals| in_words(refusals));
        let mut checks = vec![
            completion(ran, |found| readings::not_finite(&found.readings())),
            Check::that(
                over_estimate <= EXCEEDED && !found.is_empty(),
                format!("no error of a number exceeds {EXCEEDED} times its estimate"),
                format!(
                    "the largest is {over_estimate:.2} of its estimate, of {} numbers",
                    8 * found.len()
                ),
            )
            .about(Subject::of("estimates")),
            Check::that(
                over_target <= 1.0 && !found.is_empty(),
                "no chosen run misses its target error",
                format!(
                    "the largest is {over_target:.2} of it, of {} runs",
                    self.targets.len() * found.len()
                ),
            )
            .about(Subject::of("target errors")),
            Check::that(
                over_norm_target <= 1.0 && !found.is_empty(),
                "no chosen run misses its target error in the norm of Theorem 3.4",
                format!("the largest is {over_norm_target:.2} of it"),
            )
            .about(Subject::of("target errors in the norm")),
            Check::that(
                refused.is_empty(),
                "every search of smooth data ends with a run",
                refused_words,
            )
            .about(Subject::of("refused searches")),
            Check::that(
                rough.iter().all(|(_, refusal)| refusal.is_of_features),
                "a search of rough data is refused only where no mesh resolves them, or because a finer run contradicts it",
                format!("{} searches refused: {rough_words}", rough.len()),
            )
            .about(Subject::of("refused searches of rough data")),
        ];
        if self.refined > 0 {
            checks.push(
                Check::that(
                    least >= FALL && !falls.is_empty(),
                    format!(
                        "linear elements and steps of midpoint tend to the same motion: {fall}"
                    ),
                    format!(
                        "with four times of both it falls at least {least:.1} times, of {} scenes",
                        falls.len()
                    ),
                )
                .about(Subject::of("linear elements")),
            );
        }
        checks
    }

    fn figure(&self, found: &[(&Ran<Drawn, Found>, &Found)]) -> Figure {
        let mut points: Vec<(f64, f64)> = found
            .iter()
            .map(|(_, found)| (found.work, found.over_target))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let work = "work of a scene's searches (unknowns times solves)";
        let series = [plots::Series::new("random scenes", points)];
        let drawn = Xy {
            guides: vec![plots::Guide {
                label: "target".to_owned(),
                value: 1.0,
            }],
            ..plots::work_precision(work, "largest error of u(1, t) / target error", &series)
        };
        let caption = "Largest errors of the runs chosen for random scenes, in units of their target errors: all below 1.";
        Figure::new(
            "errors",
            caption,
            drawn
                .scattered()
                .titled("Every error stays below its target")
                .draw(),
        )
    }
}

impl Kind for RandomErrors {
    type Data = Drawn;
    type Found = Found;

    fn cases(&self) -> Vec<Case<Drawn>> {
        let smooth =
            (0..self.scenes).map(|number| (format!("scene {number}"), Drawn::Smooth(number)));
        let rough =
            (0..self.rough).map(|number| (format!("rough scene {number}"), Drawn::Rough(number)));
        let given = self
            .given
            .iter()
            .enumerate()
            .map(|(number, scene)| (scene.name.clone(), Drawn::Given(number)));
        smooth
            .chain(rough)
            .chain(given)
            .map(|(label, data)| Case::new(label, 3e7, data))
            .collect()
    }

    fn run(&self, &drawn: &Drawn) -> Result<Found, CaseFailure> {
        self.measure(drawn)
    }

    fn judge(&self, ran: &[Ran<Drawn, Found>]) -> Outcome {
        let found: Vec<(&Ran<Drawn, Found>, &Found)> = ran
            .iter()
            .filter_map(|ran| Some((ran, ran.ok()?)))
            .collect();
        let rows: Vec<_> = found
            .iter()
            .map(|(ran, found)| (vec![ran.case.label.clone()], found.readings()))
            .collect();
        let work: f64 = found.iter().map(|(_, found)| found.work).sum();
        let errors = worst(&found).map_or("no error is known".to_owned(), |worst| {
            let [over_estimate, over_target, over_norm_target] = worst;
            let most = max_or_nan(over_target, over_norm_target);
            format!(
                "errors at most {over_estimate:.2} of their estimates and {most:.2} of the target error"
            )
        });
        let headline = format!("{} scenes: {errors}", found.len());
        Outcome {
            tables: vec![readings::table(
                "Errors relative to the estimates and targets",
                &["scene"],
                &rows,
            )],
            figures: vec![self.figure(&found)],
            quantities: vec![Quantity::new("work of all searches", work, WORK_TOLERANCE)],
            headline: headline.clone(),
            coverage: vec![self.searches(ran)],
            ..Outcome::new(headline, vec![], self.checks(ran, &found))
        }
    }
}

impl RandomErrors {
    /// Each scene has an estimate and a search for each target; some are refused.
    fn searches(&self, ran: &[Ran<Drawn, Found>]) -> Coverage {
        let each = 1 + self.targets.len() + self.norm_targets.len();
        let of_scene = |ran: &Ran<Drawn, Found>| {
            let (reason, count) = match ran.ok() {
                Some(found) => ("refused with a reason", found.refused.len()),
                None => (NO_RESULT, each),
            };
            (0..each).map(move |k| (k < count).then_some(reason))
        };
        Coverage::of("searches", ran.iter().flat_map(of_scene))
    }
}

impl Found {
    fn readings(&self) -> Vec<Reading> {
        vec![
            Reading::new("error over estimate", self.over_estimate).fixed(2),
            Reading::new("error over target", self.over_target).fixed(2),
            Reading::new("the same in the norm", self.over_norm_target).fixed(2),
            Reading::new("linear elements", self.linear.map(|of| of[0])).scientific(1),
            Reading::new("four times as many", self.linear.map(|of| of[1])).scientific(1),
            Reading::new("work", self.work).scientific(1),
        ]
    }
}

/// The largest errors in units of their estimates, of the targets, and of those in the norm; `None`
/// without a scene.
fn worst(found: &[(&Ran<Drawn, Found>, &Found)]) -> Option<[f64; 3]> {
    let of: [fn(&Found) -> f64; 3] = [
        |found| found.over_estimate,
        |found| found.over_target,
        |found| found.over_norm_target,
    ];
    let largest = of.map(|of| {
        found
            .iter()
            .map(|(_, found)| of(found))
            .fold(0.0, max_or_nan)
    });
    (!found.is_empty()).then_some(largest)
}

/// Why searches of smooth, or of rough, data were refused.
fn refusals<'r>(
    found: &[(&'r Ran<Drawn, Found>, &'r Found)],
    is_rough: bool,
) -> Vec<(&'r str, &'r Refusal)> {
    let of = found
        .iter()
        .filter(|(_, found)| found.may_be_refused == is_rough);
    of.flat_map(|(ran, found)| {
        let refused = found.refused.iter();
        refused.map(|refusal| (ran.case.label.as_str(), refusal))
    })
    .collect()
}

fn in_words(refusals: &[(&str, &Refusal)]) -> String {
    let one = |(scene, refusal): &(&str, &Refusal)| format!("{scene}, {}", refusal.words);
    refusals.iter().map(one).collect::<Vec<_>>().join("; ")
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
