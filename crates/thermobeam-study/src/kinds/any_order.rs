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

use convergence_study::judge::fit::FLOOR_MARGIN;
use thermobeam::dg::Stepping;

use super::prelude::*;
use super::settings;
use super::tables::{Layout, control, manufactured};
use crate::exact::any_order::ErrorMeter;
use crate::exact::defect::Defect;
use crate::run::dg::DgMotion;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "orders/any-order",
    read: reader::<AnyOrder>,
    why: "On a mesh of width h elements of degree p approximate a smooth solution to h^(p+1), its slopes to h^p; for fixed h the \
          error falls exponentially in p. dG(q) is of order 2q + 1 at the ends of steps, and inside them of the order of \
          polynomials of its degree: q + 2, but at most 2q + 1, for displacements, q + 1 for velocities (THEORY.md).",
    judged: "For each degree the rate over h or dt by the rule of every rate, other errors being at round-off; over p the error \
             must fall by the factor claimed for each degree until it reaches round-off.",
    failure: "Integrals in space or time are not exact enough, a term of the step is wrong, or the iteration for the axial force \
              is stopped too early: look at the highest degree that still passes.",
    settings: settings::of_any_order,
};

/// Steps of a run: at high degree a few hundred reach round-off.
const MOST_STEPS: usize = 100_000;

/// Points inside a step at which errors are measured: not the Gauss or Radau points, where errors
/// are smaller.
const INSIDE: [f64; 2] = [0.13, 0.61];

/// Below this error a higher degree gains nothing: round-off of the loads and the initial data.
const ROUND_OFF: f64 = 2e-12;

/// Below this error no rate is read: a thousand times about a hundred rounding errors of quantities
/// of order 1.
const FLOOR: f64 = FLOOR_MARGIN * 1e-13;

/// What is refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Over {
    /// The mesh, for each degree p.
    Space,
    /// The steps, for each degree q.
    Time,
    /// The degree p itself.
    Degree,
}

/// One run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    /// Degree p of the elements.
    pub degree: usize,
    /// Elements n.
    pub elements: usize,
    /// Degree q in time.
    pub time_degree: usize,
    /// Number of steps, all of the same length.
    pub steps: usize,
}

/// Allowed moments of the initial errors' slopes, which are zero but for rounding errors of the
/// initial data divided by h: 4e-13 for 256 elements. A quadrature that is too coarse for the
/// projection leaves 3e-7 and more.
const PROJECTED: f64 = 1e-11;

/// The judged errors of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Errors {
    /// Each with its name; errors in the fields at the end come first.
    pub named: Vec<(&'static str, f64)>,
    /// The largest moment of a slope's error at t = 0 ([`ErrorMeter::slope_moments`]): zero for the
    /// projection (3.6).
    pub start: f64,
}

/// Runs that are judged together.
#[derive(Debug, Clone, PartialEq)]
struct RunsOfDegree {
    /// The runs, coarse to fine.
    runs: Vec<Resolution>,
    /// Tolerance of a rate; for runs over p the factor by which the error falls for each degree.
    tolerance: f64,
}

/// A study of orders.
#[derive(Clone)]
pub struct AnyOrder {
    /// Coefficients from which the loads are derived.
    pub(super) theory: Coefficients,
    /// The solver's own coefficients; if they differ, the study must fail.
    pub(super) solver: Coefficients,
    /// A mistake in the loads; only a study of planted faults has one.
    pub(super) defect: Option<Defect>,
    exact: Manufactured,
    /// Whether loads keep the exact solution in place; a free vibration needs none.
    loaded: bool,
    layout: Layout,
    t_end: f64,
    over: Over,
    series: Vec<RunsOfDegree>,
}

impl FromFile for AnyOrder {
    fn from_document(_: &Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        let vibration = root.section("vibration")?;
        let problem: &[&str] = if vibration.is_some() {
            &["vibration"]
        } else {
            &["beam", "obstacles", "exact"]
        };
        root.allow(&[&["study", "run", "control", "series"], problem].concat())?;
        let run = root
            .require("run", "a table with over, t_end, degrees and steps")?
            .section()?;
        let overs = [
            ("space", Over::Space),
            ("time", Over::Time),
            ("degree", Over::Degree),
        ];
        let over = run
            .require("over", "\"space\", \"time\" or \"degree\"")?
            .choice(&overs)?;
        let (listed, own, _) = over.keys();
        let common = ["degree", "time_degree", "elements", "steps"];
        let common = common
            .into_iter()
            .filter(|key| !own.contains(key) && !listed.starts_with(key));
        run.allow(
            &["over", "t_end", "map"]
                .into_iter()
                .chain(common)
                .collect::<Vec<_>>(),
        )?;
        let t_end = run.positive("t_end")?;
        let (theory, exact) = match &vibration {
            Some(section) => free(section)?,
            None => {
                let theory = Coefficients::read(root)?;
                (theory, manufactured(root, &theory.beam, t_end)?)
            }
        };
        let series = root.tables("series", "", |section| series(&run, over, section))?;
        let elements: Vec<usize> = series
            .iter()
            .flat_map(|series| &series.runs)
            .map(|run| run.elements)
            .collect();
        let (solver, layout) = (control(root, theory)?, Layout::read(&run, &elements, None)?);
        let loaded = vibration.is_none();
        Ok(AnyOrder {
            theory,
            solver,
            defect: None,
            exact,
            loaded,
            layout,
            t_end,
            over,
            series,
        })
    }
}

/// Free vibrations: the beam with exact modes, and the modes, each released from a tip displacement
/// of 0.1.
fn free(section: &Section<'_>) -> Result<(Coefficients, Manufactured), InputError> {
    const AMPLITUDE: f64 = 0.1;
    section.allow(&["zeta", "modes"])?;
    let zeta = section.positive("zeta")?;
    let allowed = format!("a list of at least one mode, from 1 to {}", limits::MODES);
    let mode = |item: &Field<'_>| Ok((item.count(1..=limits::MODES)? - 1, AMPLITUDE));
    let modes = section.list("modes", &allowed, mode, |modes| !modes.is_empty())?;
    let refused = |_| section.refuse("modes", "modes without a motion", allowed);
    let theory = Coefficients {
        beam: free_vibration::beam(zeta),
        obstacles: None,
    };
    Ok((
        theory,
        free_vibration::vibration(&modes, zeta).map_err(refused)?,
    ))
}

impl Over {
    /// The keys of a table `[[series]]`: the refined parameter, the fixed one, and the criterion.
    /// The rest is in `[run]`.
    fn keys(self) -> (&'static str, &'static [&'static str], &'static str) {
        match self {
            Over::Space => ("elements", &["degree"], "tolerance"),
            Over::Time => ("steps", &["time_degree"], "tolerance"),
            Over::Degree => ("degrees", &[], "factor"),
        }
    }
}

/// A table `[[series]]`, and the settings that all series share.
fn series(
    run: &Section<'_>,
    over: Over,
    section: &Section<'_>,
) -> Result<RunsOfDegree, InputError> {
    let (listed, own, key) = over.keys();
    section.allow(&[&[listed, key], own].concat())?;
    let count = |key: &str, field: &Field<'_>| match key {
        "elements" => tables::elements(field),
        "steps" => field.count(1..=MOST_STEPS),
        "time_degree" => field.count(0..=MAX_TIME_DEGREE),
        _ => field.count(1..=MAX_DEGREE),
    };
    let allowed = "a list of at least three increasing whole numbers";
    let increasing = (
        "a whole number >",
        (|before, level| level > before) as fn(usize, usize) -> bool,
    );
    let list = section.sequence((listed, allowed, 3), |item| count(listed, item), increasing)?;
    let resolution = |level: usize| -> Result<Resolution, InputError> {
        let of = |key: &str| match if own.contains(&key) { section } else { run } {
            _ if listed.starts_with(key) => Ok(level),
            table => count(key, &table.require(key, "a whole number")?),
        };
        let (degree, time_degree) = (of("degree")?, of("time_degree")?);
        Ok(Resolution {
            degree,
            elements: of("elements")?,
            time_degree,
            steps: of("steps")?,
        })
    };
    let runs = list.into_iter().map(resolution).collect::<Result<_, _>>()?;
    let least = if over == Over::Degree { 1.0 } else { 0.0 };
    let allowed = format!("a finite number > {least}");
    let tolerance = section
        .require(key, &allowed)?
        .number_where(&allowed, |value| value > least)?;
    Ok(RunsOfDegree { runs, tolerance })
}

impl Kind for AnyOrder {
    type Data = Resolution;
    type Found = Errors;

    fn cases(&self) -> Vec<Case<Resolution>> {
        let case = |&data: &Resolution| {
            let Resolution {
                degree,
                elements,
                time_degree,
                steps,
            } = data;
            let label = match self.over {
                Over::Space => format!("p = {degree}, n = {elements}"),
                Over::Time => format!("q = {time_degree}, {steps} steps"),
                Over::Degree => format!("p = {degree}"),
            };
            let cost = (elements * degree * (time_degree + 1) * (steps + 10)) as f64 * 10.0;
            Case::new(label, cost, data)
        };
        self.series
            .iter()
            .flat_map(|series| &series.runs)
            .map(case)
            .collect()
    }

    /// Roots of the sums of squares of the L2 errors of u, φ, u_t, φ_t, θ at the end, and of their
    /// slopes. A study over time has the largest L2 errors of u and u_t inside steps instead of the
    /// slopes.
    fn run(&self, resolution: &Resolution) -> Result<Errors, CaseFailure> {
        let mut motion = self.motion(*resolution)?;
        // The solver's temperature: its unknown is lifted by the solver's own θ_A.
        let theta_a = self.solver.beam.theta_a;
        let mut level = motion.simulation().level().clone();
        let (mut inside_u, mut inside_u_t) = (0.0, 0.0);
        let mut meter = ErrorMeter::new(&self.exact, theta_a, motion.simulation().space());
        // The initial data have the θ_A of the loads, whatever the solver's is.
        let start = meter.slope_moments(motion.simulation().level(), self.theory.beam.theta_a);
        run_to(&mut motion, self.t_end, |motion, _| {
            // Only a study over time judges these.
            if self.over == Over::Time {
                let simulation = motion.simulation();
                let (from, to) = (simulation.old_level().t, simulation.t());
                for s in INSIDE {
                    if simulation.level_into(from + s * (to - from), &mut level) {
                        let [[u, _, u_t, ..], _] = meter.errors(&level);
                        inside_u = max_or_nan(inside_u, u);
                        inside_u_t = max_or_nan(inside_u_t, u_t);
                    }
                }
            }
        })?;
        let [values, slopes] = meter.errors(motion.simulation().level());
        let together =
            |errors: [f64; 5]| errors.iter().map(|error| error * error).sum::<f64>().sqrt();
        let named = match self.over {
            Over::Time => vec![
                ("ends", together(values)),
                ("u inside", inside_u),
                ("u_t inside", inside_u_t),
            ],
            _ => vec![("fields", together(values)), ("slopes", together(slopes))],
        };
        Ok(Errors { named, start })
    }

    fn judge(&self, ran: &[Ran<Resolution, Errors>]) -> Outcome {
        let completion = completion(ran, |errors| not_finite(errors.named.iter().copied()));
        let checks = vec![completion, projected(ran)];
        let (mut rest, mut runs) = (ran, vec![]);
        for series in &self.series {
            // Fewer if some are missing.
            let (mine, others) = rest.split_at(series.runs.len().min(rest.len()));
            rest = others;
            runs.push((series, mine));
        }
        match self.over {
            Over::Degree => self.over_degrees(&runs, checks),
            Over::Space | Over::Time => self.over_steps(&runs, checks),
        }
    }
}

impl AnyOrder {
    fn motion(&self, resolution: Resolution) -> Result<DgMotion, CaseFailure> {
        let Resolution {
            degree,
            elements,
            time_degree,
            steps,
        } = resolution;
        let dt = self.t_end / steps as f64;
        let stepping = Stepping {
            degree: time_degree,
            dt,
            restart_dt: dt,
            growth: 1.0,
            ..Stepping::default()
        };
        let (loads, mesh) = (
            self.loaded.then_some(&self.theory),
            self.layout.mesh(elements)?,
        );
        Ok(DgMotion::manufactured(
            &self.exact,
            loads,
            self.defect,
            self.solver,
            mesh,
            degree,
            stepping,
        )?)
    }

    /// Rates over h or dt; one figure shows each degree's errors together.
    fn over_steps(
        &self,
        runs: &[(&RunsOfDegree, &[Ran<Resolution, Errors>])],
        checks: Vec<Check>,
    ) -> Outcome {
        let mut all = Outcome::new("", vec![], checks);
        for (series, runs) in runs {
            let Resolution {
                degree,
                time_degree,
                ..
            } = series.runs[0];
            let (letter, degree) = if self.over == Over::Time {
                ("q", time_degree)
            } else {
                ("p", degree)
            };
            let subject = format!("{letter} = {degree}");
            let caption = format!("Errors for {subject}, with the orders of theory (triangles).");
            let what = format!("{letter}{degree}");
            all.extend(
                self.levels(series, runs)
                    .outcome(&what, Some(&subject), &caption, vec![]),
            );
        }
        Outcome {
            summary: summary(&all.rates),
            ..all.summed_up_by_rates("")
        }
    }

    fn levels(&self, series: &RunsOfDegree, ran: &[Ran<Resolution, Errors>]) -> Levels {
        let (name, orders) = match (self.over, &series.runs[0]) {
            (Over::Time, Resolution { time_degree: q, .. }) => {
                let orders = vec![
                    ("ends", 2 * q + 1),
                    ("u inside", (q + 2).min(2 * q + 1)),
                    ("u_t inside", q + 1),
                ];
                (format!("q = {q}"), orders)
            }
            (_, Resolution { degree: p, .. }) => {
                (format!("p = {p}"), vec![("fields", p + 1), ("slopes", *p)])
            }
        };
        let claim = |(name, order): (&'static str, usize)| {
            (name, Claim::new(order as f64, series.tolerance))
        };
        let claims: Vec<(&str, Claim)> = orders.into_iter().map(claim).collect();
        let errors: Vec<_> = ran
            .iter()
            .map(|ran| ran.ok().map(|errors| errors.named.as_slice()))
            .collect();
        let mut columns = ErrorColumn::of(&claims, &errors);
        let mut subjects = vec![];
        for column in &mut columns {
            let subject = Subject::of(&column.name).in_case(&name);
            // The degree is in the title.
            column.symbol = Some(column.name.replace("u_t", "uₜ"));
            column.name = format!("{name}, {}", column.name);
            subjects.push((column.name.clone(), subject));
        }
        let refinement = |ran: &Ran<Resolution, Errors>| {
            let Resolution {
                degree,
                elements,
                time_degree,
                steps,
            } = ran.case.data;
            let numbers = [
                ("degree", degree),
                ("elements", elements),
                ("time degree", time_degree),
                ("steps", steps),
            ];
            let step = match self.over {
                Over::Time => self.t_end / steps as f64,
                _ => self
                    .layout
                    .mesh(elements)
                    .map_or(f64::NAN, |mesh| mesh.size()),
            };
            Refinement::new(ran.case.label.clone(), &numbers, step)
        };
        let axis = if self.over == Over::Time {
            Axis::Time
        } else {
            Axis::Space
        };
        Levels::new(axis, ran.iter().map(refinement), columns)
            .with_floor(FLOOR)
            .with_subjects(subjects)
    }

    /// The error must fall by the factor claimed, as a geometric mean, from the first degree to the
    /// one that reaches round-off.
    fn over_degrees(
        &self,
        runs: &[(&RunsOfDegree, &[Ran<Resolution, Errors>])],
        mut checks: Vec<Check>,
    ) -> Outcome {
        let common = checks.len();
        let (mut curves, mut quantities, mut rows) = (vec![], vec![], vec![]);
        for (series, runs) in runs {
            let error = |run: &Ran<Resolution, Errors>| {
                run.ok().map_or(f64::NAN, |errors| errors.named[0].1)
            };
            let points: Vec<(f64, f64)> = runs
                .iter()
                .map(|run| (run.case.data.degree as f64, error(run)))
                .collect();
            checks.extend(exponential(&points, series.tolerance));
            let measurable = points.iter().filter(|(_, error)| !(*error <= ROUND_OFF));
            let guarded = |(p, error): &(f64, f64)| {
                Quantity::new(format!("error fields, p = {p}"), *error, 1e-4)
                    .about(Subject::of("fields").at(format!("p = {p}")))
                    .of_sort(Sort::Error)
            };
            quantities.extend(measurable.map(guarded));
            let name = counted(series.runs[0].elements, "element");
            rows.extend(
                points
                    .iter()
                    .map(|(p, error)| vec![name.clone(), format!("{p}"), format!("{error:.2e}")]),
            );
            curves.push(plots::Series::new(name, points));
        }
        let history = plots::history(
            plots::Axis::log("L2 error of all fields (dimensionless)"),
            &curves,
        )
        .marked();
        let drawing = Xy {
            x: plots::Axis::linear("degree p"),
            ..history
        };
        let svg = drawing
            .titled("The error falls exponentially with the degree, to round-off")
            .draw();
        let caption = "Error over the degree p on a fixed mesh: exponential, down to round-off.";
        let summary = checks
            .iter()
            .skip(common)
            .map(|check| check.evidence.clone())
            .collect::<Vec<_>>()
            .join("; ");
        let (title, head) = (
            "Error of all fields at the end over the degree",
            ["mesh", "degree p", "error"],
        );
        Outcome {
            headline: summary.clone(),
            tables: vec![Table::new(title, head, rows)],
            figures: vec![Figure::new("degrees", caption, svg)],
            quantities,
            ..Outcome::new(summary, vec![], checks)
        }
    }
}

/// Whether every run starts from the projection (3.6) of its initial data; with none, completion
/// fails.
fn projected(ran: &[Ran<Resolution, Errors>]) -> Check {
    let largest = ran
        .iter()
        .filter_map(Ran::ok)
        .map(|errors| errors.start)
        .fold(0.0, max_or_nan);
    let claim = "at t = 0 the errors of all slopes are orthogonal to the slopes of the space: the initial fields are projections";
    let evidence = format!("largest moment on an element {largest:.1e}, allowed {PROJECTED:e}");
    Check::that(largest <= PROJECTED, claim, evidence).about(Subject::of("initial projection"))
}

fn exponential(points: &[(f64, f64)], factor: f64) -> [Check; 2] {
    let reached = points.iter().position(|(_, error)| *error <= ROUND_OFF);
    let last = reached.unwrap_or(points.len().saturating_sub(1));
    let fall = match (points.first(), points.get(last)) {
        (Some((p0, e0)), Some((p1, e1))) if last > 0 => (e0 / e1).powf(1.0 / (p1 - p0)),
        _ => f64::NAN,
    };
    let monotone = points
        .iter()
        .zip(points.iter().skip(1))
        .take(last)
        .all(|(one, next)| next.1 < one.1);
    let rest = points
        .iter()
        .skip(last)
        .all(|(_, error)| *error <= ROUND_OFF);
    let end = points.get(last).map_or(f64::NAN, |(p, _)| *p);
    [
        Check::that(
            fall >= factor && monotone,
            format!("the error falls with every degree, {factor} times on average"),
            format!("{fall:.1} times a degree, up to p = {end}"),
        )
        .about(Subject::of("error over the degree")),
        Check::that(
            reached.is_some() && rest,
            format!("it reaches round-off, {ROUND_OFF:e}, and stays there"),
            format!("error at most {ROUND_OFF:e} from p = {end} on"),
        )
        .about(Subject::of("round-off")),
    ]
}
