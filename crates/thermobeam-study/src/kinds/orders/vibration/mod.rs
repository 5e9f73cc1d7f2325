//! Damped vibrations without any source term: the only motion of this beam known in closed form.
//!
//! For a = β = ρ = 0 and without obstacles the modes of [`thermobeam_exact::vibration`] are
//! decoupled. No load keeps the solution in place, so equal errors in the scheme and in the sources
//! cannot cancel. `modes` isolates the error of space or time.

mod modes;

use super::{
    ErrorSource, Orders, Runs, Series, SourceResult,
    one_step::{self, formulas_of, largest_errors, levels},
};
use crate::kinds::prelude::*;
use crate::{
    exact::{
        errors::ErrorMeter,
        norm::{Norm, Norms},
        solution::Factors,
        sources::Nodal,
    },
    kinds::tables::{ControlTable, ExpectNorm, Refine, RefineTable, controlled, expected_norms},
    run::{ObservableMotion, driver::Driver},
    scene::{Coefficients, file::BeamTable, limits},
};
use convergence_study::{
    chart::{self, Chart},
    file::Finite,
};
use modes::Modes;
use thermobeam::{one_step::Problem, solve::TimeLevel};
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

/// A study of damped vibrations.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VibrationFile {
    /// the coefficients of a linear beam, whose damped modes are exact: a = rho = 0, written out
    #[serde(default)]
    beam: BeamTable,
    /// the modes of the beam that move
    mode: Vec<ModeTable>,
    /// the modes of the temperature
    #[serde(default)]
    heat: Vec<HeatTable>,
    /// the meshes and steps of the runs
    refine: RefineTable,
    /// coefficients in which the solver differs from the sources: the study must fail
    control: Option<ControlTable>,
    /// the orders claimed, each norm once
    expect: Vec<ExpectNorm>,
}

/// A table `[[mode]]`: an amplitude, a velocity, or both.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ModeTable {
    /// number of the mode, from 1
    index: Count<1, { limits::MODES }>,
    /// displacement of the tip at t = 0
    amplitude: Option<Finite>,
    /// velocity of the tip at t = 0
    velocity: Option<Finite>,
}

/// A table `[[heat]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct HeatTable {
    /// number of the mode, from 1
    index: Count<1, { limits::MODES }>,
    /// of the temperature at t = 0, not 0
    amplitude: Finite,
}

impl ErrorSource for Vibration {
    const ROW: KindRow = KindRow {
        name: "orders/vibration",
        schema: schema::<VibrationFile>,
        read: <Orders<Self>>::read_study,
        why: "Without coupling, nonlinearity and obstacles the damped modes of the beam are exact solutions that no source term keeps \
              in place. Moved by the scheme's own recursion they leave the space error alone; the mesh's own modes, moved exactly, \
              leave the time error alone.",
        judged: "Errors in each norm over the levels, by the rule of every rate; and the solver against the closed form, to round-off.",
        failure: "The beam that is simulated is not the beam of the equations, or a step of the scheme is wrong. No manufactured load \
                  can be to blame.",
    };

    type File = VibrationFile;
    /// Elements and steps.
    type Data = (usize, usize);
    type Found = Vibrated;

    fn from_file(file: VibrationFile, _: &Path) -> Result<Self, Refusal> {
        let theory = linear_beam(&file.beam)?;
        let refine = file.refine.refine().map_err(Refusal::within("refine"))?;
        bounded(&refine).map_err(Refusal::within("refine"))?;
        Ok(Self {
            theory,
            solver: controlled(file.control.as_ref(), theory)?,
            modes: modes(&file.mode, &refine)?,
            heat: heat(&file.heat, &refine)?,
            refine,
            expect: expected_norms(&file.expect)?,
        })
    }

    fn coefficients(&self) -> Option<[Coefficients; 2]> {
        Some([self.theory, self.solver])
    }

    fn cases(&self) -> Vec<Case<(usize, usize)>> {
        let parts = one_step::parts(&self.solver, &self.refine, Known::Vibration);
        let mut cases = vec![];
        for (elements, steps) in self.refine.cases() {
            let cost = elements as f64 * steps as f64;
            let label = Refine::label(elements, steps);
            cases.push(Case::new(label, cost, (elements, steps)).described(&parts));
        }
        cases
    }

    /// Compares the solver with the exact motion.
    fn run(&self, &(elements, steps): &(usize, usize)) -> Result<Vibrated, CaseFailure> {
        let mesh = self.refine.layout.mesh(elements)?;
        let dt = self.refine.dt(steps);
        let formulas = formulas_of(self.refine.scheme)?;
        let is_of_mesh = self.refine.isolates(RefinedIn::Time);
        let modes = if is_of_mesh {
            Modes::of_mesh(self, &mesh)?
        } else {
            Modes::of_beam(self)?
        };
        let scheme = self.refine.isolates(RefinedIn::Space).then_some(formulas);
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
        let zero = TimeLevel::new(elements + 1);
        let mut deviation = 0.0;
        let mut size = 0.0;
        let mut tip = vec![(0.0, driver.level().u[elements])];
        let errors = largest_errors(&mut driver, steps as f64 * dt, |driver| {
            let level = driver.level();
            let n = driver.motion().steps();
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

    fn measured(&self, runs: &Runs<Self>) -> SourceResult {
        let errors = runs
            .iter()
            .map(|run| (run.case.data, run.ok().map(|found| &found.errors)));
        let levels = levels(&self.refine, &self.expect, errors);
        let caption = "Errors against exact damped modes, with the orders that theory gives.";
        let mut measured = SourceResult {
            series: vec![Series::new(levels).drawn("errors", Some("Damped vibration"), caption)],
            tables: vec![self.modes_table()],
            ..SourceResult::default()
        };
        if self.refine.isolates(RefinedIn::Time) {
            measured.sheets.push(Sheet::untabled([closed_form(runs)]));
        }
        if self.refine.axis == RefinedIn::Both {
            measured.figures.extend(self.tip_figure(runs));
        }
        measured
    }
}

/// If time is isolated, the exact result of the solver is known.
fn closed_form(runs: &Runs<Vibration>) -> Measured {
    let deviations = runs.iter().map(|run| run.ok()?.closed_form);
    let worst = largest_of(deviations.map(|deviation| deviation.unwrap_or(f64::NAN)));
    let name =
        "largest distance to the scheme's own steps of the modes of the mesh, over the motion";
    measured("", name, worst)
        .scientific(1)
        .must_be(Must::AtMost(CLOSED_FORM))
}

/// The beam, which must have exact modes.
fn linear_beam(table: &BeamTable) -> Result<Coefficients, Refusal> {
    let theory = Coefficients::new(table, None)?;
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
            return Err(Refusal::new(
                format!("beam.{key}"),
                format!("{value:?}"),
                allowed,
            ));
        }
    }
    Ok(theory)
}

/// Limits the steps, since the tip is kept at each, and the elements, since a dense method finds
/// the modes of a mesh.
fn bounded(refine: &Refine) -> Result<(), Refusal> {
    if refine.budget.is_some() {
        let auto = if refine.axis == RefinedIn::Time {
            "steps"
        } else {
            "elements"
        };
        let allowed = "a list: a study of vibrations adds no levels";
        return Err(Refusal::written(auto, allowed));
    }
    for &level in &refine.steps {
        let dt = refine.dt(level);
        limits::steps_to("steps", refine.t_end, dt, limits::RECORDED_STEPS)?;
    }
    if refine.isolates(RefinedIn::Time) {
        limits::dense("elements", refine.elements[0])
    } else {
        Ok(())
    }
}

/// Refuses a mode that the mesh does not have, if a study starts from the modes of its mesh.
fn is_of_mesh(index: usize, refine: &Refine, of_mesh: usize) -> Result<(), Refusal> {
    if !refine.isolates(RefinedIn::Time) || index <= of_mesh {
        return Ok(());
    }
    let allowed = format!("a whole number >= 1 and <= {of_mesh}");
    Err(Refusal::written("index", allowed))
}

fn modes(tables: &[ModeTable], refine: &Refine) -> Result<Vec<(usize, [f64; 2])>, Refusal> {
    let modes = Refusal::of_each("mode", tables, |table| {
        let index = table.index.get();
        is_of_mesh(index, refine, 2 * refine.elements[0])?;
        let number = |number: Option<Finite>| number.map_or(0.0, Finite::get);
        let start = [table.amplitude, table.velocity].map(number);
        if start == [0.0, 0.0] {
            let allowed = "an amplitude or a velocity other than 0";
            let found = "a mode that does not move";
            return Err(Refusal::new("amplitude", found, allowed));
        }
        Ok((index - 1, start))
    })?;
    if modes.is_empty() {
        let allowed = "at least one table [[mode]] with index and amplitude or velocity";
        return Err(Refusal::written("mode", allowed));
    }
    Ok(modes)
}

fn heat(tables: &[HeatTable], refine: &Refine) -> Result<Vec<(usize, f64)>, Refusal> {
    let of_mesh = refine.elements[0].saturating_sub(1).max(1);
    Refusal::of_each("heat", tables, |table| {
        is_of_mesh(table.index.get(), refine, of_mesh)?;
        if table.amplitude.get() == 0.0 {
            let allowed = "a finite number other than 0";
            return Err(Refusal::written("amplitude", allowed));
        }
        Ok((table.index.get(), table.amplitude.get()))
    })
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
        Some(Figure::of("tip", caption, chart))
    }
}
