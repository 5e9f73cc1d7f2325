//! What an error of u(1, t) costs by the scheme of any order and by `midpoint`: error over counted work.
//!
//! The unit is the node-solve of `midpoint`: two 3 x 3 blocks a row. A solve of dG(q) on so many blocks has 3 (q + 1) unknowns a
//! block and costs (q + 1)² as much for each; a factorisation counts as 3 (q + 1) solves. `midpoint` does not reach the error of
//! interest in reasonable time: its cost there is that of its cheapest run along error x cost = constant, the best that a
//! scheme of second order in h and dt can do, and the study says so.
//!
//! ```toml
//! [any-order-cost]
//! scene = "scenes/paper-1-beta-0.toml"
//! t_end = 1.0
//! error = 1e-8                       # largest error of u(1, t) over the times observed
//! times = 1000                       # dG(q) must be so many times cheaper
//! any-order = [[14, 3, 0.01]]        # degree p, degree q, largest step
//! midpoint = [[500, 8000]]           # elements, steps: multiples of 250; each twice the one before
//! ```

use std::path::Path;
use std::sync::OnceLock;

use convergence_study::input::{Field, InputError, Section};
use convergence_study::plots;
use convergence_study::study::levels::completion;
use convergence_study::study::{
    Case, CaseFailure, Check, Figure, FromFile, Header, Kind, KindRow, Outcome, Quantity, Ran, Table, reader,
};
use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE};
use thermobeam::scheme::MIDPOINT;
use thermobeam::solve::Settings;

use super::work_precision::law::front;
use crate::error::curve::distance;
use crate::run::any_order_time::{REFERENCE, by, finished};
use crate::run::family::Family;
use crate::scene::{Scene, limits};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "any-order-cost",
    read: reader::<AnyOrderCost>,
    why: "A scheme of second order in h and dt pays 1/error for an error; high orders pay little more for ten digits than for five.",
    judged: "Work is counted, not timed. midpoint's error must fall fourfold from run to run, so that its cost at the error asked \
             for can be extrapolated; dG(q) must reach that error and be cheaper by the factor claimed.",
    failure: "dG(q) needs more steps, solves or factorisations than before, or no longer reaches the error.",
};

/// Times of observation, most of them inside steps of dG(q).
const OBSERVED: usize = 250;

/// Tolerance of midpoint's iteration.
const TOLERANCE: f64 = 1e-11;

/// How far the fall of midpoint's error from run to run may be from fourfold.
const FALL: [f64; 2] = [3.5, 4.5];

/// A study of cost.
pub struct AnyOrderCost {
    header: Header,
    scene: Scene,
    error: f64,
    times: f64,
    runs: Vec<Way>,
    /// u(1, t) of the run that the others are compared with.
    exact: OnceLock<Result<Vec<f64>, CaseFailure>>,
}

/// A run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Way {
    /// Degree p, degree q, largest step.
    AnyOrder(usize, usize, f64),
    /// Elements and steps of midpoint.
    Midpoint(usize, usize),
}

/// What it found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Largest error of u(1, t) over the times of observation.
    pub error: f64,
    /// Node-solves.
    pub work: f64,
}

impl FromFile for AnyOrderCost {
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", ROW.name])?;
        let section = root.require(ROW.name, "a table with scene, error and runs")?.section()?;
        section.allow(&["scene", "t_end", "error", "times", "any-order", "midpoint"])?;
        let mut scene = Scene::read(section.require("scene", "a scene file")?.file(folder)?)?;
        scene.t_end = section.positive("t_end")?;
        let allowed = "a list of [degree p, degree q, largest step]";
        let any_order = rows::<3>(&section, "any-order", allowed)?.into_iter().map(|[p, q, dt]| {
            let dt = dt.positive()?;
            Ok(Way::AnyOrder(p.count(1..=MAX_DEGREE)?, q.count(0..=MAX_TIME_DEGREE)?, dt))
        });
        let mut runs = any_order.collect::<Result<Vec<_>, InputError>>()?;
        let allowed = "a list of at least two [elements, steps], each twice the one before, steps a multiple of 250";
        let mut midpoint: Vec<(usize, usize)> = vec![];
        for [elements, steps] in rows::<2>(&section, "midpoint", allowed)? {
            midpoint.push((elements.count(1..=1 << 20)?, steps.count(1..=limits::STEPS)?));
        }
        let doubled = midpoint.windows(2).all(|two| two[1] == (2 * two[0].0, 2 * two[0].1));
        if midpoint.len() < 2 || !doubled || midpoint.iter().any(|(_, steps)| !steps.is_multiple_of(OBSERVED)) {
            return Err(section.require("midpoint", allowed)?.refuse_as_written(allowed));
        }
        runs.extend(midpoint.into_iter().map(|(elements, steps)| Way::Midpoint(elements, steps)));
        Ok(Self {
            header,
            scene,
            error: section.positive("error")?,
            times: section.positive("times")?,
            runs,
            exact: OnceLock::new(),
        })
    }
}

fn rows<'d, const N: usize>(
    section: &Section<'d>,
    key: &str,
    allowed: &str,
) -> Result<Vec<[Field<'d>; N]>, InputError> {
    let field = section.require(key, allowed)?;
    let items = field.items(allowed)?;
    let row = |item: &Field<'d>| item.items(allowed)?.try_into().map_err(|_| field.refuse_as_written(allowed));
    items.iter().map(row).collect()
}

impl AnyOrderCost {
    fn tip(&self, way: (usize, usize, f64)) -> Result<(Vec<f64>, f64), CaseFailure> {
        let scene = by(&self.scene, way, self.scene.t_end)?;
        let run = finished(&scene, OBSERVED)?;
        let stages = (scene.dg_stepping().degree + 1) as f64;
        let blocks = (scene.mesh.elements() * (1 + 2 * (scene.degree / 2)) + 1) as f64;
        let solves = run.work.solves as f64 + 3.0 * stages * run.work.factorizations as f64;
        Ok((run.tip(), blocks * stages * stages * solves))
    }
}

impl Kind for AnyOrderCost {
    type Data = Way;
    type Found = Point;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<Way>> {
        let case = |&data: &Way| match data {
            Way::AnyOrder(p, q, dt) => Case { label: format!("p = {p}, q = {q}, dt = {dt}"), cost: 1e6, data },
            Way::Midpoint(n, steps) => {
                Case { label: format!("midpoint, {n} x {steps}"), cost: (n * steps) as f64, data }
            }
        };
        self.runs.iter().map(case).collect()
    }

    fn run(&self, way: &Way) -> Result<Point, CaseFailure> {
        let exact =
            self.exact.get_or_init(|| self.tip(REFERENCE).map(|(tip, _)| tip)).as_ref().map_err(Clone::clone)?;
        match *way {
            Way::AnyOrder(p, q, dt) => {
                let (tip, work) = self.tip((p, q, dt))?;
                Ok(Point { error: distance(&tip, exact), work })
            }
            Way::Midpoint(elements, steps) => {
                let family = Family::of_scene(&self.scene);
                let on = family.on(elements)?;
                let mut run = on.start(MIDPOINT, Settings { tolerance: TOLERANCE, ..Settings::default() }, steps)?;
                let mut tip = vec![exact[0]];
                for _ in 0..OBSERVED {
                    run.advance(steps / OBSERVED)?;
                    tip.push(run.level().u[elements]);
                }
                Ok(Point { error: distance(&tip, exact), work: run.spent().node_solves })
            }
        }
    }

    fn judge(&self, ran: &[Ran<Way, Point>]) -> Outcome {
        let mut checks = vec![completion(ran, |point| {
            if point.error.is_finite() && point.work.is_finite() { vec![] } else { vec!["error or work".to_owned()] }
        })];
        let of = |midpoint: bool| -> Vec<Point> {
            let mine = ran.iter().filter(|ran| matches!(ran.case.data, Way::Midpoint(..)) == midpoint);
            mine.map(|ran| ran.ok().copied().unwrap_or(Point { error: f64::NAN, work: f64::NAN })).collect()
        };
        let [any_order, midpoint] = [of(false), of(true)];
        let falls: Vec<f64> = midpoint.windows(2).map(|two| two[0].error / two[1].error).collect();
        checks.push(Check::that(
            !falls.is_empty() && falls.iter().all(|fall| (FALL[0]..=FALL[1]).contains(fall)),
            "midpoint's error falls fourfold with twice the elements and steps",
            falls.iter().map(|fall| format!("{fall:.2}")).collect::<Vec<_>>().join(", "),
        ));
        let good = any_order.iter().filter(|point| point.error <= self.error).map(|point| point.work);
        let cheap = good.fold(f64::INFINITY, f64::min);
        let dear = midpoint.iter().map(|point| point.work * point.error / self.error).fold(f64::INFINITY, f64::min);
        let ratio = if cheap.is_finite() && midpoint.iter().all(|p| p.error > 0.0) { dear / cheap } else { f64::NAN };
        let evidence = format!(
            "{ratio:.0} times cheaper: {cheap:.2e} node-solves against {dear:.2e} of midpoint (extrapolated along error x cost = constant)"
        );
        let claim =
            format!("u(1, t) to {:e}: dG(q) is at least {} times cheaper than midpoint", self.error, self.times);
        checks.push(Check::that(ratio >= self.times && ratio.is_finite(), claim.clone(), evidence.clone()));
        let row = |ran: &Ran<Way, Point>| {
            let cell = |of: fn(&Point) -> f64| ran.ok().map_or("-".to_owned(), |point| format!("{:.2e}", of(point)));
            vec![ran.case.label.clone(), cell(|point| point.error), cell(|point| point.work)]
        };
        let table = Table {
            title: "Error of u(1, t) and counted work".to_owned(),
            head: ["run", "error", "node-solves"].map(str::to_owned).to_vec(),
            rows: ran.iter().map(row).collect(),
        };
        let series = [("dG(q)", any_order), ("midpoint", midpoint)].map(|(label, runs)| plots::Series {
            label: label.to_owned(),
            points: front(runs.iter().map(|run| (run.work, run.error))),
        });
        let svg = plots::work_precision(&plots::WorkPrecision {
            title: Some("What an error of u(1, t) costs".to_owned()),
            x_label: Some("counted work (node-solves)".to_owned()),
            y_label: "largest error of u(1, t) (dimensionless)".to_owned(),
            series: series.to_vec(),
        });
        let file = format!("{}-work.svg", self.header.id);
        let caption = "Error of u(1, t) over counted work, by dG(q) and by midpoint, without runs that another one beats in both.".to_owned();
        let quantities = if ratio.is_finite() {
            vec![Quantity { name: "times cheaper".to_owned(), value: ratio, tolerance: 0.05 }]
        } else {
            vec![]
        };
        let figures = vec![Figure { file, caption, svg }];
        let summary = format!("{claim}: {evidence}");
        Outcome {
            headline: evidence,
            tables: vec![table],
            figures,
            quantities,
            ..Outcome::new(summary, vec![], checks)
        }
    }
}
