//! Damped vibrations without any source term: the only motion of this beam known in closed form.
//!
//! For a = β = ρ = 0 and without obstacles the modes of [`thermobeam_exact::vibration`] are
//! decoupled. No load keeps the solution in place, so equal errors in the scheme and in the sources
//! cannot cancel. `modes` isolates the error of space or time.

mod modes;

use super::{
    ErrorSource, Orders, Runs, Series, SourceResult,
    one_step::{formulas_of, largest_errors, levels, not_finite_norms},
};
use crate::kinds::prelude::*;
use crate::{
    exact::{
        errors::ErrorMeter,
        norm::{Norm, Norms},
        solution::Factors,
        sources::Nodal,
    },
    kinds::{
        settings::{ActiveTerms, Exercise, FREE_VIBRATIONS},
        tables::{CONTROL, EXPECT, REFINE, Refine, control, expectations, mean_width, refine},
    },
    run::{ObservableMotion, driver::Driver},
    scene::{Coefficients, limits, tables},
};
use convergence_study::internal::chart::{self, Chart};
use modes::Modes;
use thermobeam::{one_step::Problem, solve::Level};
use thermobeam_exact::vibration::Mode;

/// Allowed distance of the solver from the closed form of its own steps, relative to the size of
/// the motion in the norm of Theorem 3.4. Measured values are 3e-14; a relative error of 1e-10 in a
/// coefficient would show.
const CLOSED_FORM: f64 = 1e-12;

/// A study of exact vibrations.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    /// The beam with exact modes; it has no obstacles.
    theory: Coefficients,
    /// The solver's coefficients: another beam in a negative control.
    solver: Coefficients,
    /// Index of each vibration, from 0, the lowest frequency; tip displacement and velocity of the
    /// mode at t = 0.
    modes: Vec<(usize, [f64; 2])>,
    /// k of each temperature sin kπx, and its amplitude at t = 0.
    heat: Vec<(usize, f64)>,
    refine: Refine,
    expect: Vec<(Norm, Claim)>,
}

/// The results of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibrated {
    /// The largest error over the time levels in each norm.
    pub errors: Norms,
    /// If time is isolated: the largest distance from the scheme's own steps of the mesh's modes,
    /// relative to the size of the motion, both in the norm of Theorem 3.4.
    pub closed_form: Option<f64>,
    /// (t, u(1, t)) of the solver at each time level.
    pub tip: Vec<(f64, f64)>,
}

const KEYS: [Key; 6] = [
    Key::new(
        "beam",
        Form::Table(&[&[&LINEAR]]),
        "the coefficients of a linear beam, whose damped modes are exact",
    ),
    Key::new(
        "mode",
        Form::List(&Form::Table(MODE)),
        "the modes of the beam that move",
    ),
    Key::new(
        "heat",
        Form::List(&Form::Table(&[&[&HEAT]])),
        "the modes of the temperature",
    )
    .or("none"),
    REFINE,
    CONTROL,
    EXPECT,
];
const INDEX: Key = Key::new("index", Form::Count(1), "number of the mode, from 1");
const LINEAR: [Key; 5] = [
    tables::BEAM_KEYS[0],
    Key::new("a", Form::Number, "0, written out"),
    Key::new("rho", Form::Number, "0, written out"),
    tables::BEAM_KEYS[3],
    tables::BEAM_KEYS[4],
];
const MODE: &[Keys] = &[
    &[&[INDEX, AMPLITUDE, VELOCITY.or("0")]],
    &[&[INDEX, VELOCITY]],
];
const AMPLITUDE: Key = Key::new(
    "amplitude",
    Form::Number,
    "displacement of the tip at t = 0",
);
const VELOCITY: Key = Key::new("velocity", Form::Number, "velocity of the tip at t = 0");
const HEAT: [Key; 2] = [
    INDEX,
    Key::new(
        "amplitude",
        Form::Number,
        "of the temperature at t = 0, not 0",
    ),
];

impl ErrorSource for Vibration {
    const ROW: KindRow = KindRow {
        name: "orders/vibration",
        keys: &[&[&KEYS]],
        schema: None,
        read: read_study::<Orders<Self>>,
        why: "Without coupling, nonlinearity and obstacles the damped modes of the beam are exact solutions that no source term keeps \
              in place. Moved by the scheme's own recursion they leave the space error alone; the mesh's own modes, moved exactly, \
              leave the time error alone.",
        judged: "Errors in each norm over the levels, by the rule of every rate; and the solver against the closed form, to round-off.",
        failure: "The beam that is simulated is not the beam of the equations, or a step of the scheme is wrong. No manufactured load \
                  can be to blame.",
    };

    /// Elements and steps.
    type Data = (usize, usize);
    type Found = Vibrated;

    fn read(root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        let theory = linear_beam(root)?;
        let refine = refine(root)?;
        bounded(root, &refine)?;
        let modes = modes(root, &refine)?;
        let heat = heat(root, &refine)?;
        let solver = control(root, theory)?;
        Ok(Self {
            theory,
            solver,
            modes,
            heat,
            refine,
            expect: expectations(root)?,
        })
    }

    fn exercise(&self) -> Exercise {
        let theory = &self.theory;
        let terms = ActiveTerms::of(&theory.beam, theory.obstacles.as_ref());
        self.refine.exercise(FREE_VIBRATIONS, terms)
    }

    fn cases(&self) -> Vec<Case<(usize, usize)>> {
        let mut cases = vec![];
        for (elements, steps) in self.refine.cases() {
            let cost = elements as f64 * steps as f64;
            let label = Refine::label(elements, steps);
            cases.push(Case::new(label, cost, (elements, steps)));
        }
        cases
    }

    /// Compares the solver with the exact motion.
    fn run(&self, &(elements, steps): &(usize, usize)) -> Result<Vibrated, CaseFailure> {
        let mesh = self.refine.layout.mesh(elements)?;
        let dt = self.refine.dt(steps);
        let formulas = formulas_of(self.refine.scheme)?;
        let is_of_mesh = self.refine.isolates(Axis::Time);
        let modes = if is_of_mesh {
            Modes::of_mesh(self, &mesh)?
        } else {
            Modes::of_beam(self)?
        };
        let scheme = self.refine.isolates(Axis::Space).then_some(formulas);
        let mut reference = modes.moved(scheme, dt);
        let mut closed = is_of_mesh.then(|| modes.moved(Some(formulas), dt));
        let mut factors = Factors::default();
        reference(0, &mut factors);
        let Coefficients { beam, obstacles } = self.solver;
        let nodal = Nodal::of(&modes.exact, &mesh);
        let initial = nodal.initial(&mesh, &factors, self.theory.beam.theta_a, beam.theta_a);
        let mut meter = ErrorMeter::new(&modes.exact, &mesh, is_of_mesh);
        meter.lift(&mesh, beam.theta_a);
        let problem = Problem {
            beam,
            obstacles,
            mesh,
            initial,
        };
        let mut driver = Driver::new(problem, self.refine.stepping(steps, false))?;
        let zero = Level::new(elements + 1);
        let mut deviation = 0.0;
        let mut size = 0.0;
        let mut tip = vec![(0.0, driver.level().u[elements])];
        let errors = largest_errors(&mut driver, steps as f64 * dt, |driver| {
            let level = driver.level();
            let n = driver.work().steps;
            if let Some(closed) = &mut closed {
                closed(n, &mut factors);
                let distance = meter.measure(level, &factors)[Norm::Theorem34];
                deviation = max_or_nan(deviation, distance);
                size = max_or_nan(size, meter.measure(&zero, &factors)[Norm::Theorem34]);
            }
            reference(n, &mut factors);
            tip.push((n as f64 * dt, level.u[elements]));
            meter.measure(level, &factors)
        })?;
        Ok(Vibrated {
            errors,
            closed_form: is_of_mesh.then_some(deviation / size),
            tip,
        })
    }

    fn not_finite(&self, found: &Vibrated) -> Vec<String> {
        let mut broken = not_finite_norms(&found.errors);
        broken.extend(not_finite([("closed form", found.closed_form)]));
        broken
    }

    fn measured(&self, runs: &Runs<Self>) -> SourceResult {
        let errors = runs
            .iter()
            .map(|run| (run.case.data, run.ok().map(|found| &found.errors)));
        let levels = levels(
            &self.refine,
            &self.expect,
            |elements, steps| match self.refine.axis {
                Axis::Time => self.refine.dt(steps),
                Axis::Space | Axis::Both => mean_width(elements),
            },
            errors,
        );
        let caption = "Errors against exact damped modes, with the orders that theory gives.";
        let mut measured = SourceResult {
            series: vec![Series::new(levels).drawn("errors", Some("Damped vibration"), caption)],
            tables: vec![self.modes_table()],
            ..SourceResult::default()
        };
        if self.refine.isolates(Axis::Time) {
            measured.checks.push(closed_form(runs));
        }
        if self.refine.axis == Axis::Both {
            measured.figures.extend(self.tip_figure(runs));
        }
        measured
    }
}

/// If time is isolated, the exact result of the solver is known.
fn closed_form(runs: &Runs<Vibration>) -> Check {
    let deviations = runs.iter().map(|run| run.ok()?.closed_form);
    let worst = largest_of(deviations.map(|deviation| deviation.unwrap_or(f64::NAN)));
    let worst = worst.unwrap_or(f64::NAN);
    Check::that(
        worst <= CLOSED_FORM,
        "each step is the scheme's own step of each mode of the mesh, to round-off",
        format!("largest deviation {worst:.1e} of the motion, allowed {CLOSED_FORM:.0e}"),
    )
    .about(Subject::of("closed form"))
}

/// The beam, which must have exact modes.
fn linear_beam(root: &Section<'_>) -> Result<Coefficients, InputError> {
    let theory = Coefficients::read(root)?;
    let beam = theory.beam;
    for (key, value) in [
        ("a", beam.a),
        ("rho", beam.rho),
        ("beta", beam.beta),
        ("theta_a", beam.theta_a),
    ] {
        if value != 0.0 {
            let allowed =
                "0, written out: damped modes are exact for a = rho = beta = theta_a = 0 only";
            let section = root
                .require("beam", "a table with zeta, a = 0 and rho = 0")?
                .section()?;
            return Err(section.refuse(key, format!("{value:?}"), allowed));
        }
    }
    Ok(theory)
}

/// Limits the steps, since the tip is kept at each, and the elements, since a dense method finds
/// the modes of a mesh.
fn bounded(root: &Section<'_>, refine: &Refine) -> Result<(), InputError> {
    let section = root.require("refine", "a table")?.section()?;
    let steps = section.require("steps", "a number")?;
    let elements = section.require("elements", "a number")?;
    if refine.budget.is_some() {
        let auto = if refine.axis == Axis::Time {
            &steps
        } else {
            &elements
        };
        return Err(auto.refuse_as_written("a list: a study of vibrations adds no levels"));
    }
    for &level in &refine.steps {
        limits::steps_until(
            &steps,
            refine.t_end,
            refine.dt(level),
            limits::RECORDED_STEPS,
        )?;
    }
    if refine.isolates(Axis::Time) {
        limits::dense(&elements, refine.elements[0])
    } else {
        Ok(())
    }
}

/// The indices of modes: a study that starts from the modes of its mesh has only `of_mesh` of them.
fn indices(refine: &Refine, of_mesh: usize) -> std::ops::RangeInclusive<usize> {
    1..=if refine.isolates(Axis::Time) {
        of_mesh.min(limits::MODES)
    } else {
        limits::MODES
    }
}

fn modes(root: &Section<'_>, refine: &Refine) -> Result<Vec<(usize, [f64; 2])>, InputError> {
    root.tables("mode", " with index and amplitude or velocity", |section| {
        let index = section.count("index", indices(refine, 2 * refine.elements[0]))? - 1;
        let number = |key: &str| section.get(key).map_or(Ok(0.0), |field| field.number());
        let start = [number("amplitude")?, number("velocity")?];
        if start == [0.0, 0.0] {
            let allowed = "an amplitude or a velocity other than 0";
            return Err(section.refuse("amplitude", "a mode that does not move", allowed));
        }
        Ok((index, start))
    })
}

fn heat(root: &Section<'_>, refine: &Refine) -> Result<Vec<(usize, f64)>, InputError> {
    let read = |item: &Field<'_>| {
        let section = item.section()?;
        let allowed = "a finite number other than 0";
        let k = section.count(
            "index",
            indices(refine, refine.elements[0].saturating_sub(1).max(1)),
        )?;
        Ok((
            k,
            section
                .require("amplitude", allowed)?
                .number_where(allowed, |value| value != 0.0)?,
        ))
    };
    let allowed = "tables [[heat]] with index and amplitude";
    root.get("heat")
        .map_or(Ok(vec![]), |_| root.list("heat", allowed, read, |_| true))
}

impl Vibration {
    fn modes_table(&self) -> Table {
        let head = [
            "mode",
            "ω",
            "ζω/2",
            "motion",
            "u(1) at t = 0",
            "u_t(1) at t = 0",
        ];
        let mut rows = vec![];
        for &(index, [amplitude, velocity]) in &self.modes {
            let omega = Mode::new(index).omega();
            let damping = 0.5 * self.theory.beam.zeta * omega;
            let motion = if damping < 1.0 {
                "underdamped"
            } else {
                "overdamped"
            };
            rows.push(vec![
                (index + 1).to_string(),
                format!("{omega:.11}"),
                format!("{damping:.4}"),
                motion.to_owned(),
                amplitude.to_string(),
                velocity.to_string(),
            ]);
        }
        Table::new("Modes superposed", head, rows)
    }

    /// The tip's displacement on the coarsest and the finest level, and the exact one.
    fn tip_figure(&self, runs: &Runs<Self>) -> Option<Figure> {
        let modes = Modes::of_beam(self).ok()?;
        let y = chart::Axis::linear("tip displacement u(1, t) (dimensionless)");
        let mut chart = Chart::empty(chart::Axis::linear("time t"), y);
        let times = runs.last()?.ok()?.tip.iter().map(|(t, _)| *t);
        chart.curve("exact", times.map(|t| (t, modes.exact.tip(t))));
        for run in [runs.first()?, runs.last()?] {
            chart.curve(&run.case.label, run.ok()?.tip.iter().copied());
        }
        let caption =
            "Tip displacement over time: exact, and on the coarsest and the finest level.";
        let chart = chart.titled("The tip of the beam, and as it moves exactly");
        Some(Figure::new("tip", caption, chart.svg()))
    }
}
