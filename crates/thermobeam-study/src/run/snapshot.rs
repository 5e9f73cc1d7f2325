//! The state of a motion in full, for pictures, histories and comparisons on a mesh.

use thermobeam::dg::{self, ContactEvent, Dg, DgLevel, Field, Phase};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::one_step::OneStep;
use thermobeam::solve::Level;

/// Maximum number of rows of a history: every step up to this number, then every second, third, ...
/// step.
pub(crate) const MOST_ROWS: usize = 200_000;

/// Maximum number of nodes of a frame: twice the rows of a picture over space and time.
const MOST_POINTS: usize = 281;

/// Maximum number of times of a history by dG: more than a figure has columns.
const DG_ROWS: usize = 4000;

/// Points of a frame by dG.
const DG_POINTS: usize = 141;

/// What may explain an error of the energy at one level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergySize {
    /// Sum of the absolute values of the energy's terms, without the constant β²/(4ρ).
    pub terms: f64,
    /// Bound on the rounding errors of a balance at this level.
    pub rounding: f64,
}

/// The last step of a motion, as its method has it.
#[derive(Clone, Copy)]
pub enum Snapshot<'m> {
    /// By a one-step scheme.
    OneStep {
        /// The simulation, standing at the end of the step.
        simulation: &'m OneStep,
        /// The level at its start.
        old: &'m Level,
        /// The level at its end.
        level: &'m Level,
        /// Whether steps are solved to a tolerance: only then the energy obeys its balance.
        is_solved: bool,
    },
    /// By dG.
    Dg(&'m Dg),
}

impl Snapshot<'_> {
    /// Those ends of `count` equal parts of the time to `t_end` that lie in the step; the first is
    /// `t_end / count`. A one-step scheme shows levels at equal numbers of steps, at most `count`
    /// of them.
    pub(crate) fn parts(&self, t_end: f64, count: usize) -> Vec<f64> {
        match self {
            Self::OneStep { simulation, .. } => {
                let steps = (t_end / simulation.dt()).round() as usize;
                let stride = steps.div_ceil(count).max(1);
                if simulation.steps().is_multiple_of(stride) {
                    vec![simulation.t()]
                } else {
                    vec![]
                }
            }
            Self::Dg(simulation) => {
                let (from, to) = (simulation.old_level().t, simulation.t());
                let first = (from / t_end * count as f64).floor() as usize;
                (first.max(1)..=count)
                    .map(|k| equidistant_time(t_end, k, count))
                    .skip_while(|&t| t <= from)
                    .take_while(|&t| t <= to)
                    .collect()
            }
        }
    }

    /// Times of a history.
    pub(crate) fn rows(&self) -> usize {
        match self {
            Self::OneStep { .. } => MOST_ROWS,
            Self::Dg(_) => DG_ROWS,
        }
    }

    /// Points x of a picture.
    pub(crate) fn points(&self) -> Vec<f64> {
        match self {
            Self::OneStep { simulation, .. } => {
                let nodes = simulation.problem().mesh.nodes();
                let shown = thinned(nodes.len(), MOST_POINTS);
                shown.into_iter().map(|i| nodes[i]).collect()
            }
            Self::Dg(_) => (0..DG_POINTS)
                .map(|i| i as f64 / (DG_POINTS - 1) as f64)
                .collect(),
        }
    }

    /// Displacement at those points, at a time in the step; for a one-step scheme at its end.
    pub(crate) fn shape(&self, t: f64) -> Vec<f64> {
        match self {
            Self::OneStep { level, .. } => {
                let indices = thinned(level.u.len(), MOST_POINTS);
                indices.into_iter().map(|i| level.u[i]).collect()
            }
            Self::Dg(simulation) => self
                .points()
                .into_iter()
                .map(|x| simulation.value(Field::U, x, t).unwrap_or(f64::NAN))
                .collect(),
        }
    }

    /// The values of the current level at the nodes of a mesh, without the contact force.
    pub fn on(&self, mesh: &Mesh) -> Level {
        match self {
            Self::OneStep {
                simulation, level, ..
            } => Level {
                contact_force: 0.0,
                ..on_mesh(level, &simulation.problem().mesh, mesh)
            },
            Self::Dg(simulation) => nodal(simulation.space(), simulation.level(), mesh.nodes()),
        }
    }

    /// The size of the current level's energy, with which errors of the balance are compared.
    pub(crate) fn energy_size(&self) -> EnergySize {
        match *self {
            Self::OneStep {
                simulation,
                old,
                level,
                is_solved,
            } => {
                let rounding = if is_solved {
                    simulation.rounding(old, level).total()
                } else {
                    // A fixed number of iterations leaves a defect that nothing bounds.
                    f64::INFINITY
                };
                EnergySize {
                    terms: simulation.energy_scale(level),
                    rounding,
                }
            }
            Self::Dg(simulation) => EnergySize {
                terms: simulation.energy_scale(),
                rounding: simulation.rounding(),
            },
        }
    }

    /// What the free end touches, and where contact began and ended; `None` if the method does not
    /// locate events.
    pub(crate) fn contact(&self) -> Option<(Phase, &[ContactEvent])> {
        match self {
            Self::OneStep { .. } => None,
            Self::Dg(simulation) => Some((simulation.phase(), simulation.events())),
        }
    }
}

/// At most `most` of `0..len`, evenly spaced, including both ends.
pub(crate) fn thinned(len: usize, most: usize) -> Vec<usize> {
    if len <= most {
        return (0..len).collect();
    }
    (0..most).map(|k| k * (len - 1) / (most - 1)).collect()
}

/// A level with each field replaced.
pub(crate) fn map_fields(level: &Level, map: impl Fn(&[f64]) -> Vec<f64>) -> Level {
    let Level {
        u,
        v,
        phi,
        w,
        theta,
        contact_force,
    } = level;
    Level {
        u: map(u),
        v: map(v),
        phi: map(phi),
        w: map(w),
        theta: map(theta),
        contact_force: *contact_force,
    }
}

/// The end of the part with number `k` from 1, if the time to `t_end` has `count` equal parts; the
/// last one is `t_end` to the last bit.
pub(crate) fn equidistant_time(t_end: f64, k: usize, count: usize) -> f64 {
    if k == count {
        t_end
    } else {
        t_end * k as f64 / count as f64
    }
}

/// The P1 functions of a level at the nodes of another mesh.
pub(crate) fn on_mesh(level: &Level, mesh: &Mesh, other: &Mesh) -> Level {
    let nodes = mesh.nodes();
    let mut elements = vec![];
    let mut left = 0;
    for &x in other.nodes() {
        while left + 2 < nodes.len() && nodes[left + 1] <= x {
            left += 1;
        }
        elements.push((left, (x - nodes[left]) / (nodes[left + 1] - nodes[left])));
    }
    map_fields(level, |y| {
        elements
            .iter()
            .map(|&(i, s)| (1.0 - s) * y[i] + s * y[i + 1])
            .collect()
    })
}

/// A level of any order by its values at the nodes, without the contact force.
pub(crate) fn nodal(space: &dg::Space, level: &DgLevel, nodes: &[f64]) -> Level {
    let mut nodal = Level {
        u: Vec::with_capacity(nodes.len()),
        v: Vec::with_capacity(nodes.len()),
        phi: Vec::with_capacity(nodes.len()),
        w: Vec::with_capacity(nodes.len()),
        theta: Vec::with_capacity(nodes.len()),
        contact_force: 0.0,
    };
    for &x in nodes {
        let [u, phi, v, w, theta] = level.values_and_slopes(space, x).map(|(value, _)| value);
        nodal.u.push(u);
        nodal.phi.push(phi);
        nodal.v.push(v);
        nodal.w.push(w);
        nodal.theta.push(theta);
    }
    nodal
}
