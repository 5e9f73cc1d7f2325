//! Random scenes with contact: their estimated errors, and the runs chosen for an accuracy, against runs that share neither mesh
//! nor steps with the search.
//!
//! Such runs would not reveal a mistake that all dG runs share. So for some scenes linear elements and steps of `midpoint` are refined
//! in addition: they must converge to the chosen run.
//!
//! ```toml
//! [random-errors]
//! scenes = 12            # by the paper's scheme, midpoint and dG in turn
//! refined = 4            # every fourth scene is also run on finer and finer linear elements
//! targets = [1e-4, 1e-6]
//! seed = 1
//! ```

use thermobeam::dg::Stepping;
use thermobeam::simulation::Stepping as OneStep;

use super::prelude::*;
use crate::predict::choice::{self, choose};
use crate::predict::estimate::{differences, estimate};
use crate::predict::{MOST_WORK, Unreachable, Work};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "random-errors",
    read: reader::<RandomErrors>,
    why: "Users rely on an error that the program prints. Here it is measured against runs on seven elements of degree 16, which no \
          search tries; for some scenes linear elements and small steps must tend to the same motion.",
    judged: "No error of any number exceeds twice its estimate, no run the error asked for, no search is refused, and the error of \
             linear elements falls at least fourfold with four times the elements and steps.",
    failure: "The comparisons of a search are too coarse, or look where the error is not; a run that no finer one confirms may be wrong.",
};

/// An error may be this many times its estimate.
const EXCEEDED: f64 = 2.0;

/// Required ratio of linear elements' errors for four times the elements and steps: contact costs first order.
const FALL: f64 = 4.0;

/// Elements of the coarsest linear mesh, and its steps per unit of time.
const COARSEST: [usize; 2] = [80, 2500];

/// Which of the numbers is the curve of u(1, t).
const TIP: usize = 3;

/// Tolerance of the baseline on the work: one round more or less of a search.
const WORK_TOLERANCE: f64 = 0.2;

/// Final time of all scenes.
const T_END: f64 = 0.4;

/// A study of errors of random scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomErrors {
    scenes: usize,
    refined: usize,
    targets: Vec<f64>,
    seed: u64,
}

/// The results of a scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// The largest error of a number, in units of its estimate.
    pub over_estimate: f64,
    /// The largest error of a chosen run, in units of its target.
    pub over_target: f64,
    /// Why a search was abandoned.
    pub refused: Option<String>,
    /// Errors of linear elements, and of four times as many with four times the steps.
    pub linear: Option<[f64; 2]>,
    /// Work of the searches.
    pub work: f64,
}

impl FromFile for RandomErrors {
    fn from_document(_: &Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", ROW.name])?;
        let section = root.table(ROW.name, &["scenes", "refined", "targets", "seed"])?;
        let positive = |list: &[f64]| !list.is_empty() && list.iter().all(|target| *target > 0.0);
        Ok(Self {
            scenes: section.count("scenes", 1..=10_000)?,
            refined: section.count("refined", 1..=10_000)?,
            targets: section.list("targets", "a list of numbers > 0", Field::number, positive)?,
            seed: section.count("seed", 0..=u32::MAX as usize)? as u64,
        })
    }
}

impl RandomErrors {
    /// A scene: moderate coefficients, obstacles that the beam hits, smooth initial data.
    fn scene(&self, number: usize) -> Result<Scene, InputError> {
        // Far from the seeds of other studies, which are small.
        let mut random = SplitMix::new((self.seed << 32) + number as u64);
        let mut between = |low: f64, high: f64| random.within([low, high]);
        let time = ["dt = 0.002", "dt = 0.004\nscheme = \"midpoint\"", "scheme = \"dg\"\ndegree = 1"][number % 3];
        let mesh = if number % 3 == 2 { "elements = 2\ndegree = 8" } else { "elements = 32" };
        let theta_a = between(-5.0, 5.0);
        let text = format!(
            "[beam]\nzeta = {:?}\na = {:?}\nrho = {:?}\nbeta = {:?}\ntheta_a = {theta_a:?}\n\
             [obstacles]\nepsilon = {:?}\ng1 = {:?}\ng2 = {:?}\n\
             [initial]\nu = \"{:?}*x*(x-2)\"\nu_t = \"{:?}*x + {:?}*x*(x-1)^2\"\ntheta = \"{theta_a:?}*(1-x) + {:?}*sin(pi*x)\"\n\
             [mesh]\n{mesh}\n[time]\nt_end = {T_END}\n{time}\n",
            10f64.powf(between(-2.0, 0.0)),
            between(0.0, 1.0),
            10f64.powf(between(-0.5, 0.7)),
            between(-2.0, 5.0),
            10f64.powf(between(-3.5, -2.0)),
            -between(0.005, 0.1),
            between(0.01, 0.1),
            between(-0.01, 0.01),
            between(-3.0, 3.0),
            between(5.0, 20.0),
            between(-2.0, 2.0),
        );
        Scene::parse(&text, "random.toml")
    }

    /// One element of degree 16 in each of seven layers towards x = 1, and short steps.
    fn independent(scene: &Scene) -> Result<Scene, CaseFailure> {
        let mesh = Mesh::from_nodes(vec![0.0, 0.5, 0.8, 0.93, 0.98, 0.995, 0.999, 1.0])?;
        let impact = scene.obstacles.map_or(T_END, |obstacles| obstacles.impact_time(scene.beam.zeta));
        let dt = impact.min(0.004);
        let stepping = Stepping { degree: 4, dt, restart_dt: 1e-3 * impact, growth: 1.2, ..Stepping::default() };
        Ok(Scene { mesh, degree: 16, method: Method::Dg(stepping), ..scene.clone() })
    }

    /// Errors on linear elements and on finer ones.
    fn linear(
        scene: &Scene,
        errors: &mut impl FnMut(&Scene) -> Result<[f64; 8], CaseFailure>,
    ) -> Result<[f64; 2], CaseFailure> {
        let [elements, steps] = COARSEST;
        let mut of_tip = [f64::NAN; 2];
        for (error, times) in of_tip.iter_mut().zip([1, 4]) {
            let dt = 1.0 / (steps * times) as f64;
            let stepping = OneStep { scheme: MIDPOINT, settings: Settings::default(), dt, loaded: false };
            let mesh = Mesh::uniform(elements * times)?;
            *error = errors(&Scene { mesh, degree: 1, method: Method::OneStep(stepping), ..scene.clone() })?[TIP];
        }
        Ok(of_tip)
    }

    /// The estimates of the scene's numbers, and the run chosen for each target.
    fn searches(&self, scene: &Scene, work: &mut Work<'_>) -> Result<(Vec<f64>, Vec<Scene>), Unreachable> {
        let totals = estimate(scene, work)?.quantities.iter().map(|of| of.total).collect();
        let choose = |&target: &f64| Ok(choose(scene, choice::Quantity::Tip, target, work)?.scene);
        Ok((totals, self.targets.iter().map(choose).collect::<Result<_, Unreachable>>()?))
    }

    fn figure(&self, found: &[(&Ran<usize, Found>, &Found)]) -> Figure {
        let mut points: Vec<(f64, f64)> = found.iter().map(|(_, found)| (found.work, found.over_target)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let work = "work of a scene's searches (unknowns times solves)";
        let series = [plots::Series::new("random scenes", points)];
        let drawn = plots::work_precision(work, "largest error of u(1, t) / target error", &series);
        let caption =
            "Largest errors of the runs chosen for random scenes, in units of their target errors: all below 1.";
        Figure::new("errors", caption, drawn.titled("Errors of the runs chosen").draw())
    }
}

impl Kind for RandomErrors {
    /// Number of the scene.
    type Data = usize;
    type Found = Found;

    fn cases(&self) -> Vec<Case<usize>> {
        (0..self.scenes).map(|data| Case::new(format!("scene {data}"), 3e7, data)).collect()
    }

    fn run(&self, &number: &usize) -> Result<Found, CaseFailure> {
        let scene = self.scene(number)?;
        let exact = Self::independent(&scene)?;
        let mut ignored = |_: f64| ();
        let work = &mut Work::new(MOST_WORK, &mut ignored);
        let (estimates, chosen) = match self.searches(&scene, work) {
            Ok(found) => found,
            Err(refused) => {
                return Ok(Found { refused: Some(refused.to_string()), work: work.spent().work, ..Found::default() });
            }
        };
        let mut errors = |run: &Scene| Ok(differences(run, &exact, work)?);
        let over = estimates.iter().zip(errors(&scene)?).map(|(estimate, error)| error / estimate);
        let over_estimate = over.fold(0.0, max_or_nan);
        let mut over_target = 0.0;
        for (target, chosen) in self.targets.iter().zip(chosen) {
            over_target = max_or_nan(over_target, errors(&chosen)?[TIP] / target);
        }
        let is_refined = number.is_multiple_of(self.refined);
        let linear = if is_refined { Some(Self::linear(&scene, &mut errors)?) } else { None };
        Ok(Found { over_estimate, over_target, refused: None, linear, work: work.spent().work })
    }

    fn judge(&self, ran: &[Ran<usize, Found>]) -> Outcome {
        let found: Vec<(&Ran<usize, Found>, &Found)> = ran.iter().filter_map(|ran| Some((ran, ran.ok()?))).collect();
        let worst = |of: fn(&Found) -> f64| found.iter().map(|(_, found)| of(found)).fold(0.0, max_or_nan);
        let (over_estimate, over_target) = (worst(|found| found.over_estimate), worst(|found| found.over_target));
        let falls: Vec<f64> =
            found.iter().filter_map(|(_, of)| of.linear.map(|[coarse, fine]| coarse / fine)).collect();
        let least = falls.iter().copied().fold(f64::INFINITY, min_or_nan);
        let fall = format!("their error falls {FALL} times or more");
        let refused: Vec<&str> = found.iter().filter_map(|(_, found)| found.refused.as_deref()).collect();
        let checks = vec![
            completion(ran, |found| readings::not_finite(&found.readings())),
            Check::that(
                over_estimate <= EXCEEDED && !found.is_empty(),
                format!("no error of a number exceeds {EXCEEDED} times its estimate"),
                format!("the largest is {over_estimate:.2} of its estimate, of {} numbers", 8 * found.len()),
            ),
            Check::that(
                over_target <= 1.0 && !found.is_empty(),
                "no chosen run misses its target error",
                format!("the largest is {over_target:.2} of it, of {} runs", self.targets.len() * found.len()),
            ),
            Check::that(refused.is_empty(), "every search ends with a run", refused.join("; ")),
            Check::that(
                least >= FALL && !falls.is_empty(),
                format!("linear elements and steps of midpoint tend to the same motion: {fall}"),
                format!("with four times of both it falls at least {least:.1} times, of {} scenes", falls.len()),
            ),
        ];
        let rows: Vec<_> = found.iter().map(|(ran, found)| (vec![ran.case.label.clone()], found.readings())).collect();
        let work: f64 = found.iter().map(|(_, found)| found.work).sum();
        let errors = format!("{over_estimate:.2} of their estimates and {over_target:.2} of the target error");
        let headline = format!("{} scenes: errors at most {errors}", found.len());
        Outcome {
            tables: vec![readings::table("Errors relative to the estimates and targets", &["scene"], &rows)],
            figures: vec![self.figure(&found)],
            quantities: vec![Quantity::new("work of all searches", work, WORK_TOLERANCE)],
            headline: headline.clone(),
            ..Outcome::new(headline, vec![], checks)
        }
    }
}

impl Found {
    fn readings(&self) -> Vec<Reading> {
        vec![
            Reading::new("error over estimate", self.over_estimate).fixed(2),
            Reading::new("error over target", self.over_target).fixed(2),
            Reading::new("linear elements", self.linear.map(|of| of[0])).scientific(1),
            Reading::new("four times as many", self.linear.map(|of| of[1])).scientific(1),
            Reading::new("work", self.work).scientific(1),
        ]
    }
}
