//! One experiment, run until it is steady, and what is read off on the way.

use crate::run::patience::StepPatience;
use thermobeam::mesh::Mesh;
use thermobeam::simulation::Simulation;
use thermobeam::solve::Level;

use super::Until;
use super::motion::Shapes;
use crate::kinds::steady::{code_of, exact_states, nearest, start};
use crate::kinds::untyped::Measured;
use crate::scene::Scene;
use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use convergence_study::text::number::max_or_nan;

/// Points of a curve in a figure, about: more than a figure has columns.
const POINTS: usize = 4000;

/// Runs a scene until its energy stands still.
///
/// # Errors
/// A step that cannot be done, steady states that cannot be told, or a beam that still moves at `t_max`.
pub(super) fn run(scene: &Scene, until: &Until) -> Result<Measured, CaseFailure> {
    let mut simulation = start(scene)?;
    let (mut old, mut log) = (simulation.level(), Log::new(scene));
    log.add_point(&simulation, &old);
    log.shapes.add(0, 0.0, &old);
    let mut new = old.clone();
    let window = (until.window / scene.dt).round().max(1.0) as usize;
    let mut fall = 0.0;
    let mut patience = Patience::of(&simulation);
    while simulation.t() < until.t_max {
        patience.before_step_of(&simulation)?;
        simulation.advance()?;
        simulation.observe(&mut new);
        // Summed up from differences: the total's round-off would hide a slow fall.
        let change = simulation.energy_change(&old, &new);
        log.add(&simulation, change, [&old, &new]);
        fall -= change;
        if simulation.step() % window == 0 {
            if fall <= until.rate * until.window {
                return finish(scene, &simulation, &new, log);
            }
            fall = 0.0;
        }
        std::mem::swap(&mut old, &mut new);
    }
    Err(CaseFailure { reason: format!("not steady by t = {}", until.t_max) })
}

fn finish(scene: &Scene, simulation: &Simulation, end: &Level, log: Log<'_>) -> Result<Measured, CaseFailure> {
    let mut measured = log.measured();
    let energy = simulation.energy(end);
    let largest = |values: &[f64]| values.iter().fold(0.0, |most, value: &f64| max_or_nan(most, value.abs()));
    let tip = end.u.len() - 1;
    measured.push("t_steady", simulation.t());
    measured.push("energy", energy.total());
    measured.push("u_tip", end.u[tip]);
    measured.push("phi_tip", end.phi[tip]);
    measured.push("contact_force", end.contact_force);
    let fields = [&end.u, &end.phi, &end.theta].map(|values| largest(values));
    measured.push("largest_field", fields.into_iter().fold(0.0, max_or_nan));
    add_nearest(scene, &scene.mesh, end, &mut measured)?;
    Ok(measured)
}

/// The exact steady state next to the end.
fn add_nearest(scene: &Scene, mesh: &Mesh, end: &Level, measured: &mut Measured) -> Result<(), CaseFailure> {
    let states = exact_states(scene)?;
    measured.push("states", states.len() as f64);
    if let Some((state, (in_u, in_phi))) = nearest(mesh, end, &states) {
        measured.push("exact_u_tip", state.u_tip);
        measured.push("exact_contact", code_of(state.contact));
        measured.push("exact_stable", f64::from(u8::from(state.stable)));
        measured.push("distance", max_or_nan(in_u, in_phi));
    }
    Ok(())
}

/// What a run has shown so far.
struct Log<'a> {
    scene: &'a Scene,
    /// Range of φ(1) in the figures' span.
    phi: [f64; 2],
    first_upper: f64,
    first_lower: f64,
    /// First and last upward crossing of zero by u(1), and their number.
    crossings: (f64, f64, usize),
    largest_increase: f64,
    /// Steps between two points of a curve.
    stride: usize,
    energy: Vec<(f64, f64)>,
    u_tip: Vec<(f64, f64)>,
    phi_tip: Vec<(f64, f64)>,
    shapes: Shapes,
}

impl<'a> Log<'a> {
    fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            phi: [f64::INFINITY, f64::NEG_INFINITY],
            first_upper: f64::NAN,
            first_lower: f64::NAN,
            crossings: (f64::NAN, f64::NAN, 0),
            largest_increase: f64::NEG_INFINITY,
            stride: ((scene.t_end / scene.dt).round() as usize / POINTS).max(1),
            energy: vec![],
            u_tip: vec![],
            phi_tip: vec![],
            shapes: Shapes::new(scene.mesh.nodes().len(), scene.dt),
        }
    }

    fn add(&mut self, simulation: &Simulation, change: f64, [old, new]: [&Level; 2]) {
        self.largest_increase = max_or_nan(self.largest_increase, change);
        let (t, step) = (simulation.t(), simulation.step());
        // Half a step of slack: n dt is not t_end to the last bit.
        if t <= self.scene.t_end + 0.5 * self.scene.dt {
            self.add_motion(t, [old, new]);
        }
        self.shapes.add(step, t, new);
        // Beyond the figures' span only slow, smooth motion is left.
        let thinning = if t <= self.scene.t_end { 1 } else { 10 };
        if step.is_multiple_of(thinning * self.stride) {
            self.add_point(simulation, new);
        }
    }

    /// Contacts, crossings and extremes of the free end.
    fn add_motion(&mut self, t: f64, [old, new]: [&Level; 2]) {
        let tip = new.u.len() - 1;
        let [before, now] = [old.u[tip], new.u[tip]];
        let passes = |at: f64| t - self.scene.dt * (now - at) / (now - before);
        if let Some(obstacles) = self.scene.obstacles {
            if self.first_upper.is_nan() && before <= obstacles.g2 && now > obstacles.g2 {
                self.first_upper = passes(obstacles.g2);
            }
            if self.first_lower.is_nan() && before >= obstacles.g1 && now < obstacles.g1 {
                self.first_lower = passes(obstacles.g1);
            }
        }
        if before < 0.0 && now >= 0.0 {
            let (first, _, count) = self.crossings;
            self.crossings = (if count == 0 { passes(0.0) } else { first }, passes(0.0), count + 1);
        }
        let phi = new.phi[tip];
        self.phi = [-max_or_nan(-self.phi[0], -phi), max_or_nan(self.phi[1], phi)];
    }

    fn add_point(&mut self, simulation: &Simulation, level: &Level) {
        let (t, tip) = (simulation.t(), level.u.len() - 1);
        self.u_tip.push((t, level.u[tip]));
        self.phi_tip.push((t, level.phi[tip]));
        self.energy.push((t, simulation.energy(level).total()));
    }

    fn measured(self) -> Measured {
        let (first, last, count) = self.crossings;
        let mut measured = Measured::default();
        for (name, when) in [("first_upper", self.first_upper), ("first_lower", self.first_lower)] {
            if !when.is_nan() {
                measured.push(name, when);
            }
        }
        measured.push("crossings", count as f64);
        if count >= 2 {
            measured.push("frequency", (count as f64 - 1.0) / (last - first));
        }
        measured.push("phi_amplitude", self.phi[1] - self.phi[0]);
        measured.push("largest_increase", self.largest_increase);
        for (name, points) in [("energy", self.energy), ("u_tip", self.u_tip), ("phi_tip", self.phi_tip)] {
            measured.series.push((name.to_owned(), points));
        }
        self.shapes.hand_over(&mut measured);
        measured
    }
}

/// β²/(4ρ), the energy of the straight beam at rest; NaN for the linear beam, whose energy has another constant.
pub(super) fn straight_energy(scene: &Scene) -> f64 {
    let beam = &scene.beam;
    if beam.rho > 0.0 { beam.beta * beam.beta / (4.0 * beam.rho) } else { f64::NAN }
}
