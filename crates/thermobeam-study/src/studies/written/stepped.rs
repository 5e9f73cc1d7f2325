//! The numbers of a run, from levels that the library steps.

use thermobeam::dg::{Dg, DgStepping};
use thermobeam::energy::Balance;
use thermobeam::motion::Motion;
use thermobeam::one_step::{OneStep, Stepping};
use thermobeam::parameters::Obstacles;

use super::{COLUMNS, DG_ROWS, ROWS, Row, RunNumbers};
use crate::exact::formulas::SchemeFormulas;
use crate::run::simulate::problem;
use crate::scene::{Method, Scene};
use crate::studies::prelude::*;

/// The numbers of a scene.
pub(super) fn stepped(scene: &Scene) -> Result<RunNumbers, CaseFailure> {
    match scene.method {
        Method::OneStep(stepping) => by_levels(scene, stepping),
        Method::Dg(stepping) => by_dg(scene, stepping),
    }
}

/// The columns of the balance.
fn terms(sum: &Balance) -> [f64; 6] {
    [
        sum.change,
        sum.viscous,
        sum.thermal,
        sum.inertial,
        sum.contact,
        sum.residual,
    ]
}

impl RunNumbers {
    /// Adds a step.
    fn count(&mut self, in_contact: bool, iterations: usize, [low, high]: [f64; 2]) {
        let [steps, contact, total, most] = &mut self.counts;
        *steps += 1.0;
        *contact += f64::from(u8::from(in_contact));
        *total += iterations as f64;
        *most = most.max(iterations as f64);
        self.range = [self.range[0].min(low), self.range[1].max(high)];
    }

    /// The phases of contact, by whether each row is in contact.
    fn set_phases(&mut self, in_contact: impl Fn(&Row) -> bool) {
        let mut was_in_contact = false;
        for row in &self.rows {
            let is_in_contact = in_contact(row);
            match self.phases.last_mut() {
                Some(phase) if is_in_contact && was_in_contact => phase[1] = row[0],
                _ if is_in_contact => self.phases.push([row[0]; 2]),
                _ => {}
            }
            was_in_contact = is_in_contact;
        }
    }
}

/// A scene by a one-step scheme, level by level.
#[expect(
    clippy::disallowed_methods,
    reason = "the loop is what is held against it"
)]
fn by_levels(scene: &Scene, stepping: Stepping) -> Result<RunNumbers, CaseFailure> {
    let unknown = || CaseFailure::new("expected a scheme of this project and obstacles");
    let formulas = SchemeFormulas::of(stepping.scheme.name).ok_or_else(unknown)?;
    let obstacles = scene.obstacles.ok_or_else(unknown)?;
    let mut motion = OneStep::new(problem(scene), stepping)?;
    let mut old = motion.level();
    let tip = old.u.len() - 1;
    let middle = scene.mesh.elements() as f64 / 2.0;
    let state = |motion: &OneStep, level: &thermobeam::solve::TimeLevel, force: f64| {
        let ends = [middle.floor(), middle.ceil()].map(|node| level.theta[node as usize]);
        let theta = 0.5 * (ends[0] + ends[1]) + 0.5 * scene.beam.theta_a;
        let [u, phi, v, w] = [&level.u, &level.phi, &level.v, &level.w].map(|field| field[tip]);
        let energy = motion.energy(level).total();
        [motion.t(), u, phi, v, w, theta, force, energy]
    };
    let mut numbers = RunNumbers {
        range: [old.u[tip]; 2],
        ..RunNumbers::default()
    };
    let start = state(
        &motion,
        &old,
        formulas.contact_force(&obstacles, old.u[tip], old.u[tip]),
    );
    numbers.rows.push(row(start, &Balance::default()));
    let steps = (scene.t_end / stepping.dt).round() as usize;
    let stride = steps.div_ceil(ROWS);
    let mut sum = Balance::default();
    for step in 1..=steps {
        let report = motion.step_once()?;
        let new = motion.level();
        let [u0, u] = [old.u[tip], new.u[tip]];
        let force = formulas.contact_force(&obstacles, u, u0);
        sum += motion.balance(&old, &new);
        numbers.across += usize::from(is_across(&obstacles, u0, u));
        numbers.count(force != 0.0, report.iterations, [u; 2]);
        if step % stride == 0 || step == steps {
            numbers
                .rows
                .push(row(state(&motion, &new, force), &std::mem::take(&mut sum)));
        }
        old = new;
    }
    numbers.set_phases(|row| row[6] != 0.0);
    Ok(numbers)
}

fn row(state: [f64; 8], sum: &Balance) -> Row {
    let mut row = [0.0; COLUMNS.len()];
    row[..8].copy_from_slice(&state);
    row[8..].copy_from_slice(&terms(sum));
    row
}

fn is_beyond(obstacles: &Obstacles, u: f64) -> bool {
    u > obstacles.g2 || u < obstacles.g1
}

/// Whether a step begins beyond one obstacle and ends beyond the other.
fn is_across(Obstacles { g1, g2, .. }: &Obstacles, u0: f64, u: f64) -> bool {
    u0 < *g1 && u > *g2 || u0 > *g2 && u < *g1
}

/// A scene by dG: the state at equal parts of the time, also within a step.
#[expect(
    clippy::disallowed_methods,
    reason = "the loop is what is held against it"
)]
fn by_dg(scene: &Scene, stepping: DgStepping) -> Result<RunNumbers, CaseFailure> {
    let obstacles = scene.obstacles;
    let obstacles = obstacles.ok_or_else(|| CaseFailure::new("expected obstacles"))?;
    let mut motion = Dg::new(scene.dg_problem(), stepping)?;
    let mut level = motion.level().clone();
    let mut state = |motion: &Dg, t: f64| {
        motion.level_into(t, &mut level);
        let at = |x: f64| {
            level
                .values_and_slopes(motion.space(), x)
                .map(|(value, _)| value)
        };
        let [u, phi, v, w, _] = at(1.0);
        let theta = at(0.5)[4] + 0.5 * scene.beam.theta_a;
        let force = SchemeFormulas::EulerCrankNicolson.contact_force(&obstacles, u, u);
        [t, u, phi, v, w, theta, force, motion.energy(&level).total()]
    };
    let start = state(&motion, 0.0);
    let mut numbers = RunNumbers {
        rows: vec![row(start, &Balance::default())],
        range: [start[1]; 2],
        ..RunNumbers::default()
    };
    let mut part = 1;
    let mut sum = Balance::default();
    while let Some(report) = motion.step(scene.t_end)? {
        sum += motion.balance();
        let range = motion.tip_range();
        numbers.count(
            report.in_contact,
            report.iterations,
            [range.low, range.high],
        );
        let time = |part: usize| match part {
            DG_ROWS => scene.t_end,
            _ => scene.t_end * part as f64 / DG_ROWS as f64,
        };
        while part <= DG_ROWS && time(part) <= motion.t() {
            let state = state(&motion, time(part));
            numbers.rows.push(row(state, &std::mem::take(&mut sum)));
            part += 1;
        }
    }
    numbers.set_phases(|row| is_beyond(&obstacles, row[1]));
    Ok(numbers)
}
