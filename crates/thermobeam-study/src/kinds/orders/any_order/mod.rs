//! Orders of the scheme of any order: elements of degree p in space, dG(q) in time.
//!
//! Against a manufactured solution, contact included, or a free vibration without any load.
//!
//! ```toml
//! [run]
//! over = "space"        # "space", "time" or "degree"
//! t_end = 0.3
//! time_degree = 4       # but for "time"
//! steps = 15            # but for "time"
//! degree = 14           # for "time"
//! elements = 1          # for "time" and "degree"
//! map = "0.8*s + 0.2*s^2"
//!
//! [vibration]           # instead of [beam], [obstacles] and [exact]: modes that no load keeps in place
//! zeta = 0.1
//! modes = [1, 3]        # from 1, the lowest
//!
//! [control]             # optional: coefficients in which the solver differs from the loads; then the study must fail
//! zeta = 0.101
//!
//! [[series]]
//! degree = 2            # "space"; or time_degree = 1 for "time"
//! elements = [4, 8, 16] # "space"; or steps = [...] for "time"; or degrees = [...] for "degree"
//! tolerance = 0.1       # of the rate; or factor = 4.0 for "degree"
//! ```

mod degrees;
mod runs;

use convergence_judge::fit::FLOOR_MARGIN;
use thermobeam::{dg::DgStepping, motion::Motion};

use super::{ErrorSource, Orders, Runs, Series, SourceResult};
use crate::kinds::prelude::*;
use crate::{
    error::free_vibration,
    exact::{any_order::ErrorMeter, defect::Defect, solution::Manufactured},
    kinds::tables::{ControlTable, ExactTable, Layout, controlled, mean_width},
    run::{dg::DgMotion, run_to},
    scene::{
        Coefficients,
        file::{BeamTable, ObstacleTable, first_where},
        limits,
    },
};
use convergence_study::{ErrorColumn, Floor, Levels, Refinement};
pub use runs::AnyOrderRun;
use runs::{Over, RunTable, RunsOfDegree, SeriesTable};

/// Points inside a step at which errors are measured: not the Gauss or Radau points, where errors
/// are smaller.
const INSIDE: [f64; 2] = [0.13, 0.61];

/// Below this error no rate is read: a thousand times about a hundred rounding errors of quantities
/// of order 1.
const FLOOR: Floor = match Floor::new(FLOOR_MARGIN * 1e-13) {
    Ok(floor) => floor,
    Err(_) => Floor::NONE,
};

/// Allowed moments of the initial errors' slopes, which are zero but for rounding errors of the
/// initial data divided by h: 4e-13 for 256 elements. A quadrature that is too coarse for the
/// projection leaves 3e-7 and more.
const PROJECTED: f64 = 1e-11;

/// The judged errors of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedErrors {
    /// Each with its name; errors in the fields at the end come first.
    pub named: Vec<(&'static str, f64)>,
    /// The largest moment of a slope's error at t = 0 ([`ErrorMeter::slope_moments`]): zero for the
    /// projection (3.6).
    pub start: f64,
}

/// A study of orders.
#[derive(Clone)]
pub struct AnyOrder {
    /// Coefficients from which the loads are derived.
    pub(crate) theory: Coefficients,
    /// The solver's own coefficients; if they differ, the study must fail.
    pub(crate) solver: Coefficients,
    /// A mistake in the loads; only a study of planted faults has one.
    pub(crate) defect: Option<Defect>,
    exact: Manufactured,
    /// Whether loads keep the exact solution in place; a free vibration needs none.
    loaded: bool,
    layout: Layout,
    t_end: f64,
    over: Over,
    series: Vec<RunsOfDegree>,
}

/// A study of orders as it is written: an exact solution with loads, or a free vibration.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnyOrderFile {
    /// the coefficients of the equations (1.1), beside exact
    beam: Option<BeamTable>,
    /// the obstacles at the free end, (1.3), beside exact; without the table there are none
    obstacles: Option<ObstacleTable>,
    /// the exact solution: of each field a sum of products
    exact: Option<ExactTable>,
    /// a free vibration in place of an exact solution with loads
    vibration: Option<VibrationTable>,
    /// what is refined, and what all series share
    run: RunTable,
    /// runs that are judged together
    series: Vec<SeriesTable>,
    /// coefficients in which the solver differs from the sources: the study must fail
    control: Option<ControlTable>,
}

/// The table `[vibration]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct VibrationTable {
    /// the viscosity ζ
    zeta: Positive,
    /// the modes from 1, each released from a tip displacement of 0.1
    modes: Vec<Count<1, { limits::MODES }>>,
}

impl AnyOrderFile {
    /// The beam and its motion.
    fn problem(&self, t_end: f64) -> Result<(Coefficients, Manufactured), Refusal> {
        let Some(vibration) = &self.vibration else {
            let beam = self.beam.clone().unwrap_or_default();
            let theory = Coefficients::new(&beam, self.obstacles.as_ref())?;
            let allowed = "a table with at least one of u, phi, theta, or [vibration] in its place";
            let exact = self.exact.as_ref();
            let exact = exact.ok_or_else(|| Refusal::missing("exact", allowed))?;
            let exact = exact.manufactured(&theory.beam, t_end);
            return Ok((theory, exact.map_err(Refusal::within("exact"))?));
        };
        let other = first_where([
            ("beam", self.beam.is_some()),
            ("obstacles", self.obstacles.is_some()),
            ("exact", self.exact.is_some()),
        ]);
        if let Some(table) = other {
            let found = format!("[{table}] beside [vibration]");
            return Err(Refusal::new(table, found, "one of the two"));
        }
        vibration.free().map_err(Refusal::within("vibration"))
    }

    /// The study.
    fn study(&self) -> Result<AnyOrder, Refusal> {
        let run = &self.run;
        run.check().map_err(Refusal::within("run"))?;
        let t_end = run.t_end.get();
        let (theory, exact) = self.problem(t_end)?;
        let series = Refusal::of_each("series", &self.series, |table| table.runs(run))?;
        if series.is_empty() {
            return Err(Refusal::written("series", "at least one table [[series]]"));
        }
        let runs = series.iter().flat_map(|series| &series.runs);
        let elements: Vec<usize> = runs.map(|run| run.elements).collect();
        Ok(AnyOrder {
            theory,
            solver: controlled(self.control.as_ref(), theory)?,
            defect: None,
            exact,
            loaded: self.vibration.is_none(),
            layout: Layout::new(run.map.as_ref(), &elements, None)
                .map_err(Refusal::within("run"))?,
            t_end,
            over: run.over.value,
            series,
        })
    }
}

impl ErrorSource for AnyOrder {
    const ROW: KindRow = KindRow {
        name: "orders/any-order",
        schema: schema::<AnyOrderFile>,
        read: <Orders<Self>>::read_study,
        why: "On a mesh of width h elements of degree p approximate a smooth solution to h^(p+1), its slopes to h^p; for fixed h the \
              error falls exponentially in p. dG(q) is of order 2q + 1 at the ends of steps, and inside them of the order of \
              polynomials of its degree: q + 2, but at most 2q + 1, for displacements, q + 1 for velocities (THEORY.md).",
        judged: "For each degree the rate over h or dt by the rule of every rate, other errors being at round-off; over p the error \
                 must fall by the factor claimed for each degree until it reaches round-off.",
        failure: "Integrals in space or time are not exact enough, a term of the step is wrong, or the iteration for the axial force \
                  is stopped too early: look at the highest degree that still passes.",
    };

    type File = AnyOrderFile;
    type Data = AnyOrderRun;
    type Found = JudgedErrors;

    fn from_file(file: AnyOrderFile, _: &Path) -> Result<Self, Refusal> {
        file.study()
    }

    fn coefficients(&self) -> Option<[Coefficients; 2]> {
        Some([self.theory, self.solver])
    }

    fn cases(&self) -> Vec<Case<AnyOrderRun>> {
        let solver = &self.solver;
        let parts = Parts::new(&solver.beam, solver.obstacles.as_ref())
            .on(self.layout == Layout::default())
            .by_dg()
            .against(Known::with_loads(self.loaded));
        let mut cases = vec![];
        for &resolution in self.series.iter().flat_map(|series| &series.runs) {
            let AnyOrderRun {
                degree,
                elements,
                time_degree,
                steps,
            } = resolution;
            let label = match self.over {
                Over::Space => format!("p = {degree}, n = {elements}"),
                Over::Time => format!("q = {time_degree}, {steps} steps"),
                Over::Degree => format!("p = {degree}"),
            };
            let cost = (elements * degree * (time_degree + 1) * (steps + 10)) as f64 * 10.0;
            cases.push(Case::new(label, cost, resolution).described(&parts));
        }
        cases
    }

    /// Roots of the sums of squares of the L2 errors of u, φ, u_t, φ_t, θ at the end, and of their
    /// slopes. A study over time has the largest L2 errors of u and u_t inside steps instead of the
    /// slopes.
    fn run(&self, resolution: &AnyOrderRun) -> Result<JudgedErrors, CaseFailure> {
        let mut motion = self.motion(*resolution)?;
        // The solver's temperature: its unknown is lifted by the solver's own θ_A.
        let theta_a = self.solver.beam.theta_a;
        let mut level = motion.simulation().level().clone();
        let mut inside_u = 0.0;
        let mut inside_u_t = 0.0;
        let mut meter = ErrorMeter::new(&self.exact, theta_a, motion.simulation().space());
        // The initial data have the θ_A of the loads, whatever the solver's is.
        let start = meter.slope_moments(motion.simulation().level(), self.theory.beam.theta_a);
        run_to(&mut motion, self.t_end, |motion, _| {
            // Only a study over time judges these.
            if self.over != Over::Time {
                return;
            }
            let simulation = motion.simulation();
            let (from, to) = (simulation.old_level().t, simulation.t());
            for s in INSIDE {
                if simulation.level_into(from + s * (to - from), &mut level) {
                    let [[u, _, u_t, ..], _] = meter.errors(&level);
                    inside_u = max_or_nan(inside_u, u);
                    inside_u_t = max_or_nan(inside_u_t, u_t);
                }
            }
        })?;
        let [values, slopes] = meter
            .errors(motion.simulation().level())
            .map(root_of_squares);
        let named = match self.over {
            Over::Time => vec![
                ("ends", values),
                ("u inside", inside_u),
                ("u_t inside", inside_u_t),
            ],
            Over::Space => vec![("fields", values), ("slopes", slopes)],
            Over::Degree => vec![("fields", values)],
        };
        Ok(JudgedErrors { named, start })
    }

    fn measured(&self, runs: &Runs<Self>) -> SourceResult {
        let mut measured = match self.over {
            Over::Degree => self.over_degrees(runs),
            Over::Space | Over::Time => self.over_steps(runs),
        };
        measured.sheets.push(Sheet::untabled([projected(runs)]));
        measured
    }
}

impl VibrationTable {
    /// Free vibrations: the beam with exact modes, and the modes.
    fn free(&self) -> Result<(Coefficients, Manufactured), Refusal> {
        const AMPLITUDE: f64 = 0.1;
        let allowed = format!(
            "a list of at least one mode, each once, from 1 to {}",
            limits::MODES
        );
        let modes = self.modes.iter().map(|mode| (mode.get() - 1, AMPLITUDE));
        let modes: Vec<_> = modes.collect();
        if modes.is_empty() || (1..modes.len()).any(|k| modes[..k].contains(&modes[k])) {
            return Err(Refusal::written("modes", allowed));
        }
        let zeta = self.zeta.get();
        let theory = Coefficients {
            beam: free_vibration::beam(zeta),
            obstacles: None,
        };
        let exact = free_vibration::vibration(&modes, zeta);
        let exact = exact.map_err(|_| Refusal::new("modes", "modes without a motion", allowed))?;
        Ok((theory, exact))
    }
}

fn root_of_squares(errors: [f64; 5]) -> f64 {
    errors.iter().map(|error| error * error).sum::<f64>().sqrt()
}

impl AnyOrder {
    fn motion(&self, resolution: AnyOrderRun) -> Result<DgMotion, CaseFailure> {
        let dt = self.t_end / resolution.steps as f64;
        let stepping = DgStepping {
            degree: resolution.time_degree,
            dt,
            restart_dt: dt,
            growth: 1.0,
            ..DgStepping::default()
        };
        Ok(DgMotion::manufactured(
            &self.exact,
            self.loaded.then_some(&self.theory),
            self.defect,
            self.solver,
            self.layout.mesh(resolution.elements)?,
            resolution.degree,
            stepping,
        )?)
    }

    /// The results of each series; fewer if some are missing.
    fn by_degree<'r>(&self, runs: &'r Runs<Self>) -> Vec<(&RunsOfDegree, &'r Runs<Self>)> {
        let mut rest = runs;
        let mut by_degree = vec![];
        for series in &self.series {
            let (own, others) = rest.split_at(series.runs.len().min(rest.len()));
            rest = others;
            by_degree.push((series, own));
        }
        by_degree
    }

    /// The errors of a series and the orders that theory gives them.
    fn orders(&self, resolution: AnyOrderRun) -> Vec<(&'static str, usize)> {
        let (p, q) = (resolution.degree, resolution.time_degree);
        match self.over {
            Over::Time => vec![
                ("ends", 2 * q + 1),
                ("u inside", (q + 2).min(2 * q + 1)),
                ("u_t inside", q + 1),
            ],
            Over::Space | Over::Degree => vec![("fields", p + 1), ("slopes", p)],
        }
    }

    /// Rates over h or dt; one figure shows each degree's errors together.
    fn over_steps(&self, runs: &Runs<Self>) -> SourceResult {
        let mut series = vec![];
        for (of_degree, runs) in self.by_degree(runs) {
            let AnyOrderRun {
                degree: p,
                time_degree: q,
                ..
            } = of_degree.runs[0];
            let (letter, degree) = match self.over {
                Over::Time => ("q", q),
                Over::Space | Over::Degree => ("p", p),
            };
            let subject = format!("{letter} = {degree}");
            let caption = format!("Errors for {subject}, with the orders of theory (triangles).");
            let levels = self.levels(&subject, of_degree, runs);
            let file = format!("{letter}{degree}");
            series.push(Series::new(levels).drawn(&file, Some(&subject), &caption));
        }
        SourceResult {
            series,
            ..SourceResult::default()
        }
    }

    /// * `degree`: in words, such as `p = 2`.
    fn levels(&self, degree: &str, series: &RunsOfDegree, runs: &Runs<Self>) -> Levels {
        let mut columns = vec![];
        for (style, (error, order)) in self.orders(series.runs[0]).into_iter().enumerate() {
            let claim = Claim::new(order as f64, series.tolerance);
            let errors = runs.iter().map(|run| run.ok()?.of(error));
            columns.push(ErrorColumn {
                subject: Subject::of(error).in_case(degree),
                // The degree is in the title.
                symbol: Some(error.replace("u_t", "uₜ")),
                style,
                ..ErrorColumn::new(format!("{degree}, {error}"), claim, errors)
            });
        }
        let axis = match self.over {
            Over::Time => RefinedIn::Time,
            Over::Space | Over::Degree => RefinedIn::Space,
        };
        let refinements = runs.iter().map(|run| self.refinement(run));
        Levels::new(axis, refinements, columns).with_floor(FLOOR)
    }

    fn refinement(&self, run: &Ran<AnyOrderRun, JudgedErrors>) -> Refinement {
        let AnyOrderRun {
            degree,
            elements,
            time_degree,
            steps,
        } = run.case.data;
        let numbers = [
            ("degree", degree),
            ("elements", elements),
            ("time degree", time_degree),
            ("steps", steps),
        ];
        let step = match self.over {
            Over::Time => self.t_end / steps as f64,
            Over::Space | Over::Degree => mean_width(elements),
        };
        Refinement::new(run.case.label.clone(), &numbers, step)
    }
}

impl JudgedErrors {
    fn of(&self, name: &str) -> Option<f64> {
        let error = self.named.iter().find(|(known, _)| *known == name);
        error.map(|(_, error)| *error)
    }
}

/// Whether every run starts from the projection (3.6) of its initial data: the errors of all slopes
/// are then orthogonal to the slopes of the space.
fn projected(runs: &[Ran<AnyOrderRun, JudgedErrors>]) -> Measured {
    let moments = runs.iter().filter_map(Ran::ok).map(|errors| errors.start);
    let name = "moment of the errors of all slopes against those of the space at t = 0, largest";
    measured("", name, largest_of(moments))
        .scientific(1)
        .must_be(Must::AtMost(PROJECTED))
}
