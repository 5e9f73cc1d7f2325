//! Damped vibrations without any source term: the one motion of this beam that is known in closed form.
//!
//! For a = β = ρ = 0 and without obstacles each mode of [`thermobeam::vibration`] rings by itself, and a beam started
//! from a sum of modes stays that sum for ever. Nothing is manufactured: no load keeps the solution in place, so an
//! error in the scheme and the same error in the sources cannot cancel. The module `clock` tells how space and time errors are
//! had one without the other.

mod clock;
mod file;
mod modes;
mod motion;

use super::Study;
use super::ladder::{self, Family, Ladder};
use crate::kinds::tables::{Expectation, Norm, Refine};
use crate::kinds::untyped::{Case, Measured};
use crate::run::patience::StepPatience;
use clock::{Clock, Levels};
use convergence_study::plots::{self, Axis as PlotAxis, History, Series};
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Figure, LevelErrors, Outcome, Table};
use convergence_study::study::{Axis, Header};
use convergence_study::text::number::max_or_nan;
use file::{Cooling, Vibrating};
use motion::{Motion, Shape};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::Beam;
use thermobeam::simulation::{Problem, Simulation, Stepping};
use thermobeam::vibration::Mode;

/// The name in study files.
pub const KIND: &str = "vibration";

/// How far the solver may be from the closed form of its own steps, relative to the motion's size in the norm of
/// Theorem 3.4. Measured are 3e-14; a coefficient that is off by 1e-10 would show.
const CLOSED_FORM: f64 = 1e-12;

/// A study of exact vibrations.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    header: Header,
    /// The beam whose modes are exact.
    beam: Beam,
    /// The beam that the solver is given: another one in a negative control.
    solver: Beam,
    modes: Vec<Vibrating>,
    heat: Vec<Cooling>,
    refine: Refine,
    expect: Vec<Expectation>,
}

/// A mesh that has no modes: its mass matrix is not positive definite.
#[derive(Debug, thiserror::Error)]
#[error("the mesh has no modes")]
struct NoModes;

impl Vibration {
    fn isolates(&self, axis: Axis) -> bool {
        self.refine.isolate && self.refine.axis == axis
    }

    /// The motion that the solver is held against.
    fn reference(&self, mesh: &Mesh, levels: Levels) -> Result<Motion, CaseFailure> {
        if self.isolates(Axis::Time) {
            self.of_mesh(mesh, levels, Clock::Exact)
        } else {
            let by_scheme = self.isolates(Axis::Space);
            self.exact(mesh, levels, if by_scheme { Clock::Scheme(self.refine.scheme) } else { Clock::Exact })
        }
    }

    /// The exact modes.
    fn exact(&self, mesh: &Mesh, levels: Levels, clock: Clock) -> Result<Motion, CaseFailure> {
        let mut parts = vec![];
        for &Vibrating { index, start } in &self.modes {
            let mode = Mode::new(index);
            let path = clock.vibration(levels, mode.omega().powi(2), self.beam.zeta, start)?;
            parts.push((Shape::vibration(mesh, &mode), path));
        }
        for &Cooling { k, amplitude } in &self.heat {
            let kappa = k as f64 * std::f64::consts::PI;
            parts.push((Shape::temperature(mesh, k), clock.temperature(levels, kappa * kappa, amplitude)));
        }
        Ok(Motion { parts })
    }

    /// The modes of the mesh itself.
    fn of_mesh(&self, mesh: &Mesh, levels: Levels, clock: Clock) -> Result<Motion, CaseFailure> {
        let mut parts = vec![];
        let vibrations = modes::vibrations(mesh).ok_or(NoModes)?;
        for &Vibrating { index, start } in &self.modes {
            let mode = vibrations.get(index).ok_or(NoModes)?;
            let path = clock.vibration(levels, mode.eigenvalue, self.beam.zeta, start)?;
            let theta = vec![0.0; mode.first.len()];
            parts.push((Shape { nodal: [mode.first.clone(), mode.second.clone(), theta], between: None }, path));
        }
        let temperatures = if self.heat.is_empty() { vec![] } else { modes::temperatures(mesh).ok_or(NoModes)? };
        for &Cooling { k, amplitude } in &self.heat {
            let mode = temperatures.get(k - 1).ok_or(NoModes)?;
            let path = clock.temperature(levels, mode.eigenvalue, amplitude);
            let zeros = || vec![0.0; mode.first.len()];
            parts.push((Shape { nodal: [zeros(), zeros(), mode.first.clone()], between: None }, path));
        }
        Ok(Motion { parts })
    }

    /// Errors in each norm, judged where the file expects an order.
    fn ladder(&self, results: &[Result<Measured, CaseFailure>]) -> Ladder {
        let cases = self.refine.cases();
        let errors = |norm: Norm| (0..cases.len()).map(|i| ladder::value(results, i, norm.name())).collect();
        Ladder {
            axis: self.refine.axis,
            steps: cases.iter().map(|&(elements, steps)| self.step(elements, steps)).collect(),
            families: self
                .expect
                .iter()
                .map(|&Expectation { norm, order, tolerance }| Family {
                    name: norm.name().to_owned(),
                    errors: errors(norm),
                    order,
                    tolerance,
                })
                .collect(),
        }
    }

    /// dt where only time is refined, else h.
    fn step(&self, elements: usize, steps: usize) -> f64 {
        match self.refine.axis {
            Axis::Time => self.refine.dt(steps),
            _ => self.refine.mesh(elements).map_or(f64::NAN, |mesh| mesh.size()),
        }
    }

    fn levels(&self, results: &[Result<Measured, CaseFailure>]) -> Vec<LevelErrors> {
        let level = |(i, (elements, steps)): (usize, (usize, usize))| {
            let errors = Norm::ALL.map(|norm| (norm.name().to_owned(), ladder::value(results, i, norm.name())));
            let parameters = [("elements", elements), ("steps", steps)];
            let parameters = parameters.map(|(name, count)| (name.to_owned(), count as f64)).into();
            LevelErrors { parameters, errors: errors.into() }
        };
        self.refine.cases().into_iter().enumerate().map(level).collect()
    }

    /// In the design that isolates time the solver's result is known to the last digit.
    fn closed_form(&self, results: &[Result<Measured, CaseFailure>]) -> Option<Check> {
        if !self.isolates(Axis::Time) {
            return None;
        }
        let deviations = (0..self.refine.cases().len()).map(|i| ladder::value(results, i, "closed form"));
        let worst = deviations.fold(0.0, max_or_nan);
        Some(Check::that(
            worst <= CLOSED_FORM,
            "each step is the scheme's own step of each mode of the mesh, to round-off",
            format!("largest deviation {worst:.1e} of the motion, allowed {CLOSED_FORM:.0e}"),
        ))
    }

    fn modes_table(&self) -> Table {
        let row = |&Vibrating { index, start }: &Vibrating| {
            let omega = Mode::new(index).omega();
            let damping = 0.5 * self.beam.zeta * omega;
            let motion = if damping < 1.0 { "rings" } else { "creeps" };
            let number = |value: f64| format!("{value:.11}");
            vec![
                (index + 1).to_string(),
                number(omega),
                format!("{damping:.4}"),
                motion.into(),
                start[0].to_string(),
                start[1].to_string(),
            ]
        };
        Table {
            title: "Modes superposed".into(),
            head: ["mode", "ω", "ζω/2", "motion", "u(1) at t = 0", "u_t(1) at t = 0"].map(str::to_owned).into(),
            rows: self.modes.iter().map(row).collect(),
        }
    }

    /// The tip's way on the coarsest and the finest level beside the exact one.
    fn tip_figure(&self, results: &[Result<Measured, CaseFailure>]) -> Option<Figure> {
        let cases = self.refine.cases();
        let (first, last) = (results.first()?.as_ref().ok()?, results.last()?.as_ref().ok()?);
        let name = |index: usize| format!("n = {}, {} steps", cases[index].0, cases[index].1);
        let series = [
            ("exact".to_owned(), last.curve("exact tip")),
            (name(0), first.curve("tip")),
            (name(cases.len() - 1), last.curve("tip")),
        ];
        let figure = History {
            title: Some("Tip of the vibrating beam".into()),
            y: PlotAxis::linear("tip displacement u(1, t) (dimensionless)"),
            series: series.map(|(label, points)| Series { label, points: points.to_vec() }).into(),
            ..History::default()
        };
        Some(Figure {
            file: format!("{}-tip.svg", self.header.id),
            caption: "Tip displacement over time: exact, and on the coarsest and the finest level.".into(),
            svg: plots::history(&figure),
        })
    }
}

impl Study for Vibration {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let case = |(elements, steps): (usize, usize)| Case {
            label: format!("n = {elements}, {steps} steps"),
            cost: elements as f64 * steps as f64,
        };
        self.refine.cases().into_iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let (elements, steps) = self.refine.cases()[index];
        let levels = Levels { dt: self.refine.dt(steps), steps };
        let mesh = self.refine.mesh(elements)?;
        let reference = self.reference(&mesh, levels)?;
        let closed = match self.isolates(Axis::Time) {
            true => Some(self.of_mesh(&mesh, levels, Clock::Scheme(self.refine.scheme))?),
            false => None,
        };
        let problem = Problem { beam: self.solver, obstacles: None, mesh, initial: reference.initial() };
        let Refine { scheme, settings, .. } = self.refine;
        let simulation = Simulation::new(problem, Stepping { scheme, settings, dt: levels.dt, loaded: false })?;
        follow(simulation, levels, &reference, closed.as_ref())
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let ladder = self.ladder(results);
        let rates = ladder.judge();
        let mut checks = vec![ladder::completion(&self.cases(), results)];
        checks.extend(self.closed_form(results));
        let caption = "Errors against exact damped modes, with the orders that theory gives.";
        let file = format!("{}-errors.svg", self.header.id);
        let mut figures = vec![ladder.figure(file, "Damped vibration, no source term", caption.into(), &rates)];
        if self.refine.axis == Axis::Both {
            figures.extend(self.tip_figure(results));
        }
        Outcome {
            levels: self.levels(results),
            tables: vec![self.modes_table()],
            figures,
            quantities: ladder.quantities(&rates),
            ..Outcome::new(ladder::summary(&rates), rates, checks)
        }
    }
}

/// Runs the solver and keeps the largest error in each norm.
fn follow(
    mut simulation: Simulation,
    levels: Levels,
    reference: &Motion,
    closed: Option<&Motion>,
) -> Result<Measured, CaseFailure> {
    let lengths = simulation.lengths().to_vec();
    let mut level = simulation.level();
    let tip = level.u.len() - 1;
    let (mut largest, mut deviation, mut size) = ([0.0; 8], 0.0, 0.0);
    let mut curves = [vec![(0.0, reference.tip(0))], vec![(0.0, level.u[tip])]];
    let theorem = Norm::ALL.iter().position(|&norm| norm == Norm::Theorem34).unwrap_or(0);
    let mut patience = Patience::of(&simulation);
    for n in 1..=levels.steps {
        patience.before_step_of(&simulation)?;
        simulation.advance()?;
        simulation.observe(&mut level);
        for (largest, error) in largest.iter_mut().zip(reference.errors(&lengths, n, &level)) {
            *largest = max_or_nan(*largest, error);
        }
        if let Some(closed) = closed {
            let zero = thermobeam::solve::Level::new(tip + 1);
            deviation = max_or_nan(deviation, closed.errors(&lengths, n, &level)[theorem]);
            size = max_or_nan(size, closed.errors(&lengths, n, &zero)[theorem]);
        }
        let t = n as f64 * levels.dt;
        curves[0].push((t, reference.tip(n)));
        curves[1].push((t, level.u[tip]));
    }
    let mut measured = Measured::default();
    Norm::ALL.iter().zip(largest).for_each(|(norm, error)| measured.push(norm.name(), error));
    if closed.is_some() {
        measured.push("closed form", deviation / size);
    }
    let [exact, found] = curves;
    measured.series = vec![("exact tip".into(), exact), ("tip".into(), found)];
    Ok(measured)
}
