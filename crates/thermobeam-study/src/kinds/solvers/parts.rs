//! Two parts of a study: the contraction factor in contact, measured against α; and the difference
//! between the fixed point and Newton's method on a scene, against the fixed point's tolerance.

use super::spectrum::spectral_radius;
use super::{SolverTask, factors, positive_numbers};
use crate::kinds::prelude::*;
use crate::kinds::runs::side_by_side::{SideBySide, SolverComparison, StepOfBoth};

/// Smallest and largest number of iterations between the start and the last increment but one of a
/// measurement.
const FEWEST: usize = 3;
const ITERATIONS: usize = 60;
/// The increments of a measurement shrink or grow by about this factor: so much that the largest
/// eigenvalue dominates, and so little that rounding errors do not show.
const SPAN: f64 = 1e8;
/// Largest displacement of the free end by the disturbance, in all iterates: small against the
/// depth of the contact, 0.02.
const DISTURBANCE: f64 = 1e-5;
/// Largest relative difference between the measured factor and the spectral radius.
const AGREEMENT: f64 = 0.01;
/// Iterations from which the ratio of two increments shows the largest eigenvalue. The first
/// increment is not one of the linearised iteration, by (4.1), and with fewer ratios the other
/// eigenvalues still take part.
const SETTLED: usize = 5;
/// Largest distance of an increment to that of the linearised iteration.
const LINEAR: f64 = 1e-3;
/// Slope of the beam pressed into the upper obstacle by a fifth of the gap.
const PRESSED: f64 = 0.12;

/// The table `[contraction]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    elements: usize,
    dt: Vec<f64>,
    epsilon: Vec<f64>,
    zeta: Vec<f64>,
}

impl Grid {
    pub(super) fn read(section: &Section<'_>) -> Result<Self, InputError> {
        section.allow(&["elements", "dt", "epsilon", "zeta"])?;
        let [dt, epsilon, zeta] =
            ["dt", "epsilon", "zeta"].map(|key| positive_numbers(section, key));
        let (dt, epsilon, zeta) = (dt?, epsilon?, zeta?);
        limits::cases(
            &section.require("dt", "a list")?,
            &[dt.len(), epsilon.len(), zeta.len()],
        )?;
        let elements = tables::elements(&section.require("elements", "a number of elements")?)?;
        Ok(Self {
            elements,
            dt,
            epsilon,
            zeta,
        })
    }

    pub(super) fn cases(&self) -> Vec<Case<SolverTask>> {
        let cost = self.elements as f64 * ITERATIONS as f64;
        let case = |at: [f64; 3]| Case::new(name(at), cost, SolverTask::Contraction(at));
        let of = |zeta: f64, epsilon: f64| self.dt.iter().map(move |&dt| case([dt, epsilon, zeta]));
        let of_zeta = |&zeta: &f64| {
            self.epsilon
                .iter()
                .flat_map(move |&epsilon| of(zeta, epsilon))
        };
        self.zeta.iter().flat_map(of_zeta).collect()
    }

    /// The first step next to a state of rest in contact, after a disturbance of u_t.
    ///
    /// Loads hold the beam at u = p x, φ = 0, θ = 0, at a fifth of the gap behind the upper
    /// obstacle. On a uniform mesh they are, by (3.7) at rest, `(1 + N) p + g(p)` at the free end
    /// in the first equation, and `-p (1, χ_i)` in the second.
    pub(super) fn measure(
        &self,
        [dt, epsilon, zeta]: [f64; 3],
    ) -> Result<Contraction, CaseFailure> {
        let mesh = Mesh::uniform(self.elements)?;
        let beam = Beam {
            zeta,
            ..Beam::default()
        };
        let obstacles = Obstacles {
            epsilon,
            ..Obstacles::default()
        };
        let mut initial = Initial::at_rest(&mesh, 0.0);
        initial.u = mesh.nodes().iter().map(|x| PRESSED * x).collect();
        let state = Problem {
            beam,
            obstacles: Some(obstacles),
            mesh,
            initial,
        };
        let n_value = beam.axial_force(PRESSED * PRESSED);
        let [alpha, gamma] = factors(&state, dt, n_value);
        let case = state.case(EULER_CRANK_NICOLSON, dt);
        let map = case.linearized_iteration(&state.initial.u);
        let mut map =
            map.ok_or_else(|| CaseFailure::new("a matrix of (4.2) is not positive definite"))?;
        let radius = spectral_radius(&mut map);
        let iterations =
            ((SPAN.ln() / radius.ln().abs()).ceil() as usize).clamp(FEWEST, ITERATIONS);
        let growth = radius.max(1.0).powi(iterations as i32 + 1);
        let speed = DISTURBANCE / (dt * growth);
        let mut disturbed = state.clone();
        disturbed.initial.u_t = state.mesh.nodes().iter().map(|x| speed * x).collect();
        let held = Held {
            problem: disturbed,
            dt,
            tip_load: (1.0 + n_value) * PRESSED + obstacles.force(PRESSED),
        };
        let [before, one, two] =
            [iterations - 1, iterations, iterations + 1].map(|count| held.iterate(count));
        let (before, one, two) = (before?, one?, two?);
        let mut expected = one.minus(&before);
        map.apply(&mut expected.v, &mut expected.w);
        let increment = two.minus(&one);
        let deviation = increment.minus(&expected).size() / increment.size();
        Ok(Contraction {
            alpha,
            gamma,
            radius,
            iterations: iterations + 1,
            measured: two.contraction,
            deviation,
        })
    }
}

/// The factor of an iteration in contact: predictions and measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contraction {
    /// Predicted factor of the contact alone; infinite if its operator is not definite.
    pub alpha: f64,
    /// Predicted factor of the coupling between rotation and displacement alone; infinite if its
    /// operator is not definite.
    pub gamma: f64,
    /// Spectral radius of the whole iteration, linearised at the state.
    pub radius: f64,
    /// Iterations done.
    pub iterations: usize,
    /// Ratio of the last two increments in the norm of (3.14).
    pub measured: f64,
    /// Distance of the last increment of (û, φ̂) to the image of the one before under the
    /// linearised iteration, relative.
    pub deviation: f64,
}

/// A step from a disturbed state of rest that loads hold.
struct Held {
    problem: Problem,
    dt: f64,
    /// Load of the first equation at the free end.
    tip_load: f64,
}

/// û and φ̂ of an iterate, or of a difference of two.
struct Velocities {
    v: Vec<f64>,
    w: Vec<f64>,
    /// Ratio of the last two increments.
    contraction: f64,
}

impl Held {
    /// The iterate after this number of iterations.
    fn iterate(&self, iterations: usize) -> Result<Velocities, CaseFailure> {
        let stopping = Stopping::Iterations(iterations);
        let settings = Settings {
            solver: Solver::FixedPoint,
            stopping,
            ..Settings::default()
        };
        let stepping = Stepping {
            scheme: EULER_CRANK_NICOLSON,
            settings,
            dt: self.dt,
            loaded: true,
        };
        let hold = |_, load: &mut [[f64; 3]]| {
            let n = load.len() - 1;
            let moment = -PRESSED / n as f64;
            load.iter_mut().for_each(|load| load[1] = moment);
            load[n] = [self.tip_load, 0.5 * moment, 0.0];
        };
        let mut driver = Driver::new(self.problem.clone(), stepping)?.loaded(hold);
        let mut contraction = None;
        run_to(&mut driver, self.dt, |_, report| {
            contraction = report.contraction;
        })?;
        let Level { v, w, .. } = driver.level().clone();
        Ok(Velocities {
            v,
            w,
            contraction: contraction.unwrap_or(f64::NAN),
        })
    }
}

impl Velocities {
    fn minus(&self, other: &Self) -> Self {
        let difference = |one: &[f64], other: &[f64]| {
            one.iter()
                .zip(other)
                .map(|(one, other)| one - other)
                .collect()
        };
        Self {
            v: difference(&self.v, &other.v),
            w: difference(&self.w, &other.w),
            contraction: self.contraction,
        }
    }

    /// Euclidean length.
    fn size(&self) -> f64 {
        self.v
            .iter()
            .chain(&self.w)
            .map(|value| value * value)
            .sum::<f64>()
            .sqrt()
    }
}

fn name([dt, epsilon, zeta]: [f64; 3]) -> String {
    format!("dt = {dt:e}, epsilon = {epsilon:e}, zeta = {zeta}")
}

/// * `found`: the results, each with its (dt, ε, ζ); `all`: the number of points of the grid.
pub(super) fn judge_contraction(found: &[([f64; 3], &Contraction)], all: usize) -> Outcome {
    let settled: Vec<&Contraction> = found
        .iter()
        .map(|(_, point)| *point)
        .filter(|point| point.is_settled())
        .collect();
    let worst = largest_of(settled.iter().map(|point| point.error()));
    let deviation = largest_of(found.iter().map(|(_, point)| point.deviation));
    let linear = found
        .iter()
        .filter(|(_, point)| point.deviation <= LINEAR)
        .count();
    let increments = deviation.map_or("no point has a result".to_owned(), |deviation| {
        format!(
            "increments are those of the linearised iteration to {deviation:.0e} at {linear} of {all} points"
        )
    });
    let factors = worst.map_or("no factor is known".to_owned(), |worst| {
        format!(
            "the factor is its spectral radius to {:.1} % at {}",
            100.0 * worst,
            settled.len()
        )
    });
    let summary = format!("{increments}; {factors}");
    Outcome {
        headline: summary.clone(),
        coverage: vec![factors_judged(found, all)],
        tables: vec![contraction_table(found)],
        figures: vec![contraction_figure(found)],
        quantities: found
            .iter()
            .map(|(at, point)| contraction_quantity(*at, point))
            .collect(),
        ..Outcome::new(
            summary,
            vec![],
            found
                .iter()
                .flat_map(|(at, point)| contraction_checks(*at, point))
                .collect(),
        )
    }
}

/// The points whose factor is compared with the spectral radius.
fn factors_judged(found: &[([f64; 3], &Contraction)], all: usize) -> Coverage {
    let unsettled = format!("fewer than {SETTLED} iterations");
    let reason = |point: &Contraction| (!point.is_settled()).then(|| unsettled.clone());
    let missing = std::iter::repeat_n(Some(NO_RESULT.to_owned()), all - found.len());
    let reasons = found.iter().map(|(_, point)| reason(point));
    Coverage::of("factors", reasons.chain(missing))
}

impl Contraction {
    /// Relative difference of the measured factor to the spectral radius.
    fn error(&self) -> f64 {
        (self.measured / self.radius - 1.0).abs()
    }

    fn is_settled(&self) -> bool {
        self.iterations >= SETTLED
    }
}

fn contraction_checks(at: [f64; 3], point: &Contraction) -> Vec<Check> {
    let name = name(at);
    let Contraction {
        radius,
        measured,
        deviation,
        ..
    } = *point;
    let subject = |quantity: &str| {
        Subject::of(quantity)
            .in_case(&name)
            .by(ItemMethod::FixedPoint)
    };
    let linear = Check::that(
        deviation <= LINEAR,
        "the last increment is that of the linearised iteration",
        format!("apart by {deviation:.1e} of it"),
    );
    let mut checks = vec![linear.about(subject("increment"))];
    if point.is_settled() {
        let factor = Check::that(
            point.error() <= AGREEMENT,
            "the contraction factor is the spectral radius",
            format!("spectral radius {radius:.5}, measured {measured:.5}"),
        );
        checks.push(factor.about(subject("contraction")));
    }
    checks
}

fn contraction_quantity(at: [f64; 3], point: &Contraction) -> Quantity {
    let subject = Subject::of("contraction")
        .by(ItemMethod::FixedPoint)
        .at(name(at));
    Quantity::new(format!("contraction, {}", name(at)), point.measured, 1e-2).about(subject)
}

fn contraction_table(found: &[([f64; 3], &Contraction)]) -> Table {
    let head = [
        "dt",
        "epsilon",
        "zeta",
        "alpha",
        "spectral radius",
        "measured",
        "iterations",
    ];
    Table::new(
        "Contraction factor in contact",
        head,
        found.iter().map(|(at, point)| contraction_row(*at, point)),
    )
}

fn contraction_row([dt, epsilon, zeta]: [f64; 3], point: &Contraction) -> Vec<String> {
    let factors = [point.alpha, point.radius, point.measured].map(|factor| format!("{factor:.5}"));
    let at = [format!("{dt:e}"), format!("{epsilon:e}"), zeta.to_string()];
    at.into_iter()
        .chain(factors)
        .chain([point.iterations.to_string()])
        .collect()
}

fn contraction_figure(found: &[([f64; 3], &Contraction)]) -> Figure {
    let mut zetas: Vec<f64> = found.iter().map(|([_, _, zeta], _)| *zeta).collect();
    zetas.dedup();
    let measured = |zeta: &f64| {
        let of_zeta = found.iter().filter(|([_, _, z], _)| z == zeta);
        plots::Series::new(
            format!("ζ = {zeta}"),
            of_zeta.map(|(_, point)| (point.radius, point.measured)),
        )
    };
    // Elsewhere α lies under the marker of the measured factor.
    let is_off = |point: &&Contraction| (point.alpha / point.measured - 1.0).abs() > 0.1;
    let off = found
        .iter()
        .map(|(_, point)| *point)
        .filter(is_off)
        .map(|point| (point.radius, point.alpha));
    let svg = figures::contraction(&figures::ContractionFactors {
        title: "The fixed point contracts as its linearisation does".to_owned(),
        measured: zetas.iter().map(measured).collect(),
        predicted: "spectral radius of the linearised iteration".to_owned(),
        estimates: plots::Series::new("α, where over 10 % off", off.collect::<Vec<_>>()),
    });
    let caption = "Contraction factor of the fixed point in contact: measured over the spectral radius of the linearised \
                   iteration, and the estimate α. From 1 on the iteration diverges.";
    Figure::new("contraction", caption, svg)
}

/// The table `[comparison]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Comparison {
    scene: Scene,
    elements: usize,
    steps: usize,
    tolerances: Vec<f64>,
}

/// The results of running both solvers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Agreement {
    /// Distance and iterations over all steps.
    pub solvers: SolverComparison,
    /// Its iterations in each step, as (t, iterations).
    pub iterations: Vec<(f64, f64)>,
    /// Newton iterations in each step, likewise.
    pub newton: Vec<(f64, f64)>,
    /// Time intervals of the steps that end in contact.
    pub contact: Vec<(f64, f64)>,
}

impl Comparison {
    pub(super) fn read(section: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        section.allow(&["scene", "elements", "steps", "tolerances"])?;
        Ok(Self {
            scene: Scene::read_one_step(
                &section.require("scene", "a scene file beside this one")?,
                folder,
            )?,
            elements: tables::elements(&section.require("elements", "a number of elements")?)?,
            // Each step is a point of a figure.
            steps: section.count("steps", 1..=limits::RECORDED_STEPS)?,
            tolerances: positive_numbers(section, "tolerances")?,
        })
    }

    pub(super) fn cases(&self) -> Vec<Case<SolverTask>> {
        // Some four iterations of 60 ns per step and element; the unit of the runner is 25 ns.
        let cost = (self.elements * self.steps) as f64 * 10.0;
        let case = |&eta: &f64| {
            Case::new(
                format!("tolerance {eta:e}"),
                cost,
                SolverTask::Comparison(eta),
            )
        };
        self.tolerances.iter().map(case).collect()
    }

    /// Steps the scene by both solvers side by side.
    pub(super) fn run(&self, tolerance: f64) -> Result<Agreement, CaseFailure> {
        let scene = Scene {
            mesh: Mesh::uniform(self.elements)?,
            ..self.scene.clone()
        };
        let mut both = SideBySide::new(&scene, tolerance)?;
        let mut agreement = Agreement::default();
        for _ in 0..self.steps {
            let StepOfBoth {
                fixed_point,
                newton,
            } = both.step()?;
            let t = both.fixed_point.work().t;
            agreement
                .iterations
                .push((t, fixed_point.iterations as f64));
            agreement.newton.push((t, newton.iterations as f64));
            if fixed_point.in_contact {
                agreement.contact.push((t - scene.dt(), t));
            }
        }
        let solvers = both.comparison;
        Ok(Agreement {
            solvers,
            ..agreement
        })
    }
}

/// * `found`: the results, each with its tolerance η*.
pub(super) fn judge_comparison(found: &[(f64, &Agreement)]) -> Outcome {
    let check = |(eta, found): &(f64, &Agreement)| {
        // A step leaves at most α/(1 - α) η* unsolved; here α is far below 1/2, and the beam damps
        // the rest.
        let evidence = format!(
            "{:.2e}, {:.3} of the tolerance",
            found.solvers.distance,
            found.solvers.distance / eta
        );
        Check::that(
            found.solvers.distance <= *eta,
            "the error is below eta*",
            evidence,
        )
        .about(
            Subject::of("distance to Newton's method")
                .in_case(format!("eta* = {eta:e}"))
                .by(ItemMethod::FixedPoint),
        )
    };
    let row = |(
        eta,
        Agreement {
            solvers:
                SolverComparison {
                    distance,
                    mean_iterations,
                    most_iterations,
                },
            ..
        },
    ): &(f64, &Agreement)| {
        [
            format!("{eta:e}"),
            format!("{distance:.3e}"),
            format!("{mean_iterations:.3}"),
            most_iterations.to_string(),
        ]
        .into()
    };
    let head = [
        "tolerance",
        "distance to Newton",
        "mean iterations",
        "most iterations",
    ];
    let last = found.last().map(|(_, found)| *found);
    let distance = last.map_or(f64::NAN, |found| found.solvers.distance);
    let summary = format!("distance to Newton's method {distance:.1e} at the smallest tolerance");
    let title = "Fixed point against Newton's method on the scene";
    Outcome {
        headline: summary.clone(),
        tables: vec![Table::new(title, head, found.iter().map(row))],
        figures: vec![iterations_figure(last)],
        ..Outcome::new(summary, vec![], found.iter().map(check).collect())
    }
}

fn iterations_figure(found: Option<&Agreement>) -> Figure {
    let curve =
        |of: fn(&Agreement) -> &Vec<(f64, f64)>| found.map_or(vec![], |found| of(found).clone());
    let fixed_point = plots::Series::new("fixed point", curve(|found| &found.iterations));
    let series = [
        fixed_point,
        plots::Series::new("Newton's method", curve(|found| &found.newton)),
    ];
    let phases = plots::Phases {
        label: "in contact".to_owned(),
        intervals: curve(|found| &found.contact),
    };
    let (title, shaded) = if phases.intervals.is_empty() {
        ("Newton's method takes fewer iterations", "")
    } else {
        (
            "The fixed point takes more iterations in contact",
            "; shaded where the tip is in contact",
        )
    };
    let caption = format!(
        "Iterations per step of the fixed point at the smallest tolerance, and of Newton's method{shaded}."
    );
    Figure::new(
        "iterations",
        caption,
        Xy {
            phases,
            ..plots::iterations(&series)
        }
        .titled(title)
        .draw(),
    )
}
