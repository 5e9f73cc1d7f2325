//! Damped vibrations without any source term: the only motion of this beam known in closed form.
//!
//! For a = β = ρ = 0 and without obstacles the modes of [`thermobeam_exact::vibration`] are
//! decoupled. No load keeps the solution in place, so equal errors in the scheme and in the sources
//! cannot cancel. `modes` isolates the error of space or time.

mod modes;

use super::convergence::design::formulas_of;
use super::prelude::*;
use super::tables::{Refine, control, expectations, norm_levels, refine};
use crate::exact::sources::Nodal;
use crate::kinds::settings;
use modes::Modes;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "orders/vibration",
    read: reader::<Vibration>,
    why: "Without coupling, nonlinearity and obstacles the damped modes of the beam are exact solutions that no source term keeps \
          in place. Moved by the scheme's own recursion they leave the space error alone; the mesh's own modes, moved exactly, \
          leave the time error alone.",
    judged: "Errors in each norm over the levels, by the rule of every rate; and the solver against the closed form, to round-off.",
    failure: "The beam that is simulated is not the beam of the equations, or a step of the scheme is wrong. No manufactured load \
              can be to blame.",
    settings: settings::of_vibrations,
};

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

impl FromFile for Vibration {
    fn from_document(_: &Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&[
            "study", "beam", "mode", "heat", "refine", "control", "expect",
        ])?;
        let theory = linear_beam(root)?;
        let refine = refine(root)?;
        bounded(root, &refine)?;
        let (modes, heat) = (modes(root, &refine)?, heat(root, &refine)?);
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
    let (steps, elements) = (
        section.require("steps", "a number")?,
        section.require("elements", "a number")?,
    );
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
        section.allow(&["index", "amplitude", "velocity"])?;
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
        section.allow(&["index", "amplitude"])?;
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

impl Kind for Vibration {
    /// Elements and steps.
    type Data = (usize, usize);
    type Found = Vibrated;

    fn cases(&self) -> Vec<Case<(usize, usize)>> {
        let case =
            |(n, steps)| Case::new(Refine::label(n, steps), n as f64 * steps as f64, (n, steps));
        self.refine.cases().into_iter().map(case).collect()
    }

    /// Compares the solver with the exact motion.
    fn run(&self, &(elements, steps): &(usize, usize)) -> Result<Vibrated, CaseFailure> {
        let Refine {
            scheme, settings, ..
        } = self.refine;
        let (dt, mesh) = (self.refine.dt(steps), self.refine.layout.mesh(elements)?);
        let of_mesh = self.refine.isolates(Axis::Time);
        let modes = if of_mesh {
            Modes::of_mesh(self, &mesh)?
        } else {
            Modes::of_beam(self)?
        };
        let formulas = formulas_of(scheme)?;
        let by = self.refine.isolates(Axis::Space).then_some(formulas);
        let (mut reference, mut closed) = (
            modes.moved(by, dt),
            of_mesh.then(|| modes.moved(Some(formulas), dt)),
        );
        let mut factors = Factors::default();
        reference(0, &mut factors);
        let Coefficients { beam, obstacles } = self.solver;
        let nodal = Nodal::of(&modes.exact, &mesh);
        let initial = nodal.initial(&mesh, &factors, self.theory.beam.theta_a, beam.theta_a);
        let mut meter = ErrorMeter::new(&modes.exact, &mesh, of_mesh);
        meter.lift(&mesh, beam.theta_a);
        let problem = Problem {
            beam,
            obstacles,
            mesh: Mesh::clone(&mesh),
            initial,
        };
        let mut driver = Driver::new(
            problem,
            Stepping {
                scheme,
                settings,
                dt,
                loaded: false,
            },
        )?;
        let zero = Level::new(elements + 1);
        let (mut errors, mut deviation, mut size) = (Norms::ZERO, 0.0, 0.0);
        let mut tip = vec![(0.0, driver.level().u[elements])];
        run_to(&mut driver, steps as f64 * dt, |driver, _| {
            let (n, new) = (driver.work().steps, driver.level());
            if let Some(closed) = &mut closed {
                closed(n, &mut factors);
                let mut distance = |level: &Level| meter.measure(level, &factors)[Norm::Theorem34];
                deviation = max_or_nan(deviation, distance(new));
                size = max_or_nan(size, distance(&zero));
            }
            reference(n, &mut factors);
            errors = errors.max(&meter.measure(new, &factors));
            tip.push((n as f64 * dt, new.u[elements]));
        })?;
        Ok(Vibrated {
            errors,
            closed_form: closed.map(|_| deviation / size),
            tip,
        })
    }

    fn judge(&self, ran: &[Ran<(usize, usize), Vibrated>]) -> Outcome {
        let mut checks = vec![completion(
            ran,
            |Vibrated {
                 errors,
                 closed_form,
                 ..
             }| {
                let norms = errors
                    .iter()
                    .map(|(norm, error)| (norm.name(), Some(error)));
                not_finite(norms.chain([("closed form", *closed_form)]))
            },
        )];
        if self.refine.isolates(Axis::Time) {
            checks.push(closed_form(ran));
        }
        // Over dt if only time is refined, otherwise over h.
        let step = |elements: usize, steps: usize| match self.refine.axis {
            Axis::Time => self.refine.dt(steps),
            Axis::Space | Axis::Both => self
                .refine
                .layout
                .mesh(elements)
                .map_or(f64::NAN, |mesh| mesh.size()),
        };
        let errors = ran
            .iter()
            .map(|ran| (ran.case.data, ran.ok().map(|found| &found.errors)));
        let levels = norm_levels(&self.refine, &self.expect, step, errors);
        let caption = "Errors against exact damped modes, with the orders that theory gives.";
        let subject = Some("Damped vibration");
        let mut outcome = levels.outcome("errors", subject, caption, checks);
        if self.refine.axis == Axis::Both {
            outcome.figures.extend(self.tip_figure(ran));
        }
        Outcome {
            tables: vec![self.modes_table()],
            ..outcome
        }
    }
}

/// If time is isolated, the exact result of the solver is known.
fn closed_form(ran: &[Ran<(usize, usize), Vibrated>]) -> Check {
    let deviation = |ran: &Ran<_, Vibrated>| {
        ran.ok()
            .and_then(|found| found.closed_form)
            .unwrap_or(f64::NAN)
    };
    let worst = ran.iter().map(deviation).fold(0.0, max_or_nan);
    Check::that(
        worst <= CLOSED_FORM && !ran.is_empty(),
        "each step is the scheme's own step of each mode of the mesh, to round-off",
        format!("largest deviation {worst:.1e} of the motion, allowed {CLOSED_FORM:.0e}"),
    )
    .about(Subject::of("closed form"))
}

impl Vibration {
    fn modes_table(&self) -> Table {
        let row = |&(index, start): &(usize, [f64; 2])| {
            let omega = Mode::new(index).omega();
            let damping = 0.5 * self.theory.beam.zeta * omega;
            let motion = if damping < 1.0 {
                "underdamped"
            } else {
                "overdamped"
            };
            let mode = [
                (index + 1).to_string(),
                format!("{omega:.11}"),
                format!("{damping:.4}"),
                motion.to_owned(),
            ];
            mode.into_iter()
                .chain(start.map(|value| value.to_string()))
                .collect()
        };
        let head = [
            "mode",
            "ω",
            "ζω/2",
            "motion",
            "u(1) at t = 0",
            "u_t(1) at t = 0",
        ];
        Table::new("Modes superposed", head, self.modes.iter().map(row))
    }

    /// The tip's displacement on the coarsest and the finest level, and the exact one.
    fn tip_figure(&self, ran: &[Ran<(usize, usize), Vibrated>]) -> Option<Figure> {
        let (first, last) = (ran.first()?, ran.last()?);
        let (coarsest, finest, modes) = (first.ok()?, last.ok()?, Modes::of_beam(self).ok()?);
        let exact = plots::Series::new(
            "exact",
            finest.tip.iter().map(|(t, _)| (*t, modes.exact.tip(*t))),
        );
        let of_level = |level: &Ran<_, _>, found: &Vibrated| {
            plots::Series::new(&level.case.label, found.tip.clone())
        };
        let [coarsest, finest] = [of_level(first, coarsest), of_level(last, finest)];
        let y = plots::Axis::linear("tip displacement u(1, t) (dimensionless)");
        let caption =
            "Tip displacement over time: exact, and on the coarsest and the finest level.";
        let figure = plots::history(y, &[exact, coarsest, finest])
            .titled("The tip of the fine beam moves as the exact one does");
        Some(Figure::new("tip", caption, figure.draw()))
    }
}
