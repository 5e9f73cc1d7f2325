//! Runs chosen by accuracy: the cheapest run with at most the wanted error, or such a run by the
//! scene's own scheme.
//!
//! The cheapest is dG with the degrees, elements and steps of [`super::reference`]: the error of
//! any other run could only be found by comparison with such a run. The scene's own scheme starts
//! coarse; two more runs, one with twice the elements and one with half of dt, show the parts of
//! space and time in its error, and the larger part is halved until the target is met.
//!
//! ```
//! use thermobeam_study::predict::choice::{ErrorQuantity, choose};
//! use thermobeam_study::predict::{MOST_WORK, Work};
//! use thermobeam_study::scene::Scene;
//!
//! let scene = Scene::parse("[initial]\nu_t = \"x\"\n[time]\ndt = 0.01\nt_end = 1.0", "swing.toml")?;
//! let choice = choose(&scene, ErrorQuantity::Tip, 1e-7, &mut Work::new(MOST_WORK, &mut |_| ()))?;
//! assert!(choice.error <= 1e-7 && choice.scene.method.name() == "dg");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use convergence_judge::SpaceTime;
use thermobeam::solve::Stopping;

use super::curves::{Apart, CurveRows, Curves, Wanted, curves};
use super::first::impact;
use super::policy::Policy;
use super::reference::{Reference, reference};
use super::{Cost, StopReason, Unreachable, Work};
use crate::scene::{Method, Scene, resampled};

/// Elements of the coarsest run by the scene's own scheme.
const ELEMENTS: f64 = 16.0;

/// Allowed error of the reference of a one-step scheme, as part of the target.
const TENTH: f64 = 0.1;

/// Rounds of refinement.
const ROUNDS: usize = 40;

/// Allowed number of failed runs.
const FAILURES: usize = 4;

/// The quantity whose error is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorQuantity {
    /// Maximum over [0, T] of the error of u(1, t).
    Tip,
    /// Maximum over [0, T] of the norm of Theorem 3.4.
    Norm,
}

impl ErrorQuantity {
    /// The name in JSON and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tip => "tip",
            Self::Norm => "theorem-3.4",
        }
    }

    /// Its meaning, in words.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Tip => "maximum over [0, T] of the error of u(1, t), inside steps included",
            Self::Norm => "maximum over [0, T] of the error in the norm of Theorem 3.4",
        }
    }

    /// * `nodes`: for the norm, which is exact for linear functions between them.
    fn rows(self, nodes: &[f64]) -> CurveRows {
        match self {
            Self::Tip => CurveRows::Tip,
            Self::Norm => CurveRows::of_norm(nodes, 2),
        }
    }

    /// The comparison of dG runs, for the norm at points of their own meshes.
    fn wanted(self, target: f64) -> Wanted {
        Wanted {
            rows: self.rows(&[]),
            tolerance: [target; 3],
        }
    }
}

/// The chosen run.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The scene with the chosen mesh, method and steps.
    pub scene: Scene,
    /// The parts of space and time in the error.
    pub parts: SpaceTime<f64>,
    /// The origin of these parts, in words.
    pub parts_by: String,
    /// The cost of the run itself.
    pub run: Cost,
    /// The error of the run.
    pub error: f64,
    /// Whether the scheme is the scene's own, as in [`keep_scheme`].
    pub is_kept: bool,
}

/// The cheapest run with an error no larger than `target`.
///
/// * `scene`: its own mesh, steps and method have no influence.
///
/// # Errors
/// [`Unreachable`]: why there is no such run, and the error reached.
pub fn choose(
    scene: &Scene,
    quantity: ErrorQuantity,
    target: f64,
    work: &mut Work<'_>,
) -> Result<Choice, Unreachable> {
    let Reference {
        scene: chosen,
        space,
        time,
        run,
        finer_space,
        ..
    } = reference(
        scene,
        None,
        &quantity.wanted(target),
        &Policy::default(),
        work,
    )?;
    Ok(Choice {
        scene: chosen,
        parts: SpaceTime {
            space: space[0],
            time: time[0],
        },
        parts_by: format!("differences to {finer_space}, and to half the steps"),
        error: space[0] + time[0],
        is_kept: false,
        run,
    })
}

/// The scene's own scheme with the required elements and steps; its error is the difference to a
/// run of any order.
///
/// # Errors
/// As [`choose`].
pub fn keep_scheme(
    scene: &Scene,
    quantity: ErrorQuantity,
    target: f64,
    work: &mut Work<'_>,
) -> Result<Choice, Unreachable> {
    let Some(mut scene) = coarsest(scene, target) else {
        return choose(scene, quantity, target, work);
    };
    let reference = reference(
        &scene,
        None,
        &quantity.wanted(TENTH * target),
        &Policy::default(),
        work,
    )?;
    let mut search = OneStepSearch {
        quantity,
        target,
        reference,
        parts: None,
        best: Best {
            error: f64::INFINITY,
            parts: SpaceTime {
                space: f64::NAN,
                time: f64::NAN,
            },
        },
        failures: 0,
    };
    for _ in 0..ROUNDS {
        match search.round(&scene, work) {
            Next::Reached(choice) => return Ok(*choice),
            Next::Refine(factors) => {
                let finer = Size::of(&scene).times(factors);
                scene =
                    resized(&scene, finer).ok_or_else(|| search.not_reached(StopReason::Finest))?;
            }
            Next::GiveUp(reason) => return Err(search.not_reached(reason)),
        }
    }
    Err(search.not_reached(StopReason::Rounds))
}

/// A search for the elements and steps of the scene's own scheme.
struct OneStepSearch {
    quantity: ErrorQuantity,
    target: f64,
    reference: Reference,
    /// The parts of space and time, once they are known.
    parts: Option<Parts>,
    /// The smallest error so far.
    best: Best,
    /// The number of failed runs.
    failures: usize,
}

/// An error and its parts of space and time.
struct Best {
    error: f64,
    parts: SpaceTime<f64>,
}

/// What a search does after a round.
enum Next {
    /// The error is small enough.
    Reached(Box<Choice>),
    /// By these factors of elements and of steps.
    Refine(Size),
    /// The target cannot be reached.
    GiveUp(StopReason),
}

impl OneStepSearch {
    /// Runs a scene, and decides what is next.
    fn round(&mut self, scene: &Scene, work: &mut Work<'_>) -> Next {
        match self.measure(scene, work) {
            Ok((own, error)) => self.after(scene, &own, error, work),
            // Coarse steps may fail although finer ones succeed.
            Err(StopReason::Run(_)) if self.failures < FAILURES => {
                self.failures += 1;
                Next::Refine(Size {
                    elements: 2.0,
                    steps: 2.0,
                })
            }
            Err(reason) => Next::GiveUp(reason),
        }
    }

    /// A run and its error; the parts of the error too, if they are needed.
    fn measure(&mut self, scene: &Scene, work: &mut Work<'_>) -> Result<(Own, f64), StopReason> {
        work.leaves(Size::of(scene).product())?;
        let nodes = self.reference.scene.mesh.nodes();
        let own = Own::run(scene, self.quantity, nodes, work)?;
        let error = own.error(&self.reference, work)?;
        if self.parts.is_none() || error > self.target {
            self.parts = Some(Parts::of(scene, &own, work)?);
        }
        Ok((own, error))
    }

    /// What follows from a run with this error.
    fn after(&mut self, scene: &Scene, own: &Own, error: f64, work: &Work<'_>) -> Next {
        let Some(parts) = &mut self.parts else {
            return Next::GiveUp(StopReason::NotFinite);
        };
        if error <= self.target {
            return Next::Reached(Box::new(Choice {
                scene: scene.clone(),
                parts: parts.errors,
                parts_by: "by runs with twice the elements and with half of dt".to_owned(),
                error,
                is_kept: true,
                run: own.curves.cost,
            }));
        }
        if error < self.best.error {
            self.best = Best {
                error,
                parts: parts.errors,
            };
        }
        // A run that is clearly too expensive is not started.
        let least = Size::of(scene).product();
        if let Err(reason) = work.leaves(0.5 * least * parts.growth(0.5 * self.target)) {
            return Next::GiveUp(reason);
        }
        Next::Refine(parts.halve_larger())
    }

    fn not_reached(&self, reason: StopReason) -> Unreachable {
        let SpaceTime { space, time } = self.best.parts;
        Unreachable::NotReached {
            target: self.target,
            reached: self.best.error,
            space,
            time,
            reason,
        }
    }
}

/// The scene with its own one-step scheme on the coarsest level; `None` for a scene by dG.
fn coarsest(scene: &Scene, target: f64) -> Option<Scene> {
    let Method::OneStep(mut stepping) = scene.method else {
        return None;
    };
    if let Stopping::Converged { tolerance, .. } = &mut stepping.settings.stopping {
        *tolerance = tolerance.min((1e-4 * target).clamp(1e-13, 1e-9));
    }
    let steps = (2.0 * scene.t_end / impact(scene)).max(8.0);
    resized(
        &Scene {
            method: Method::OneStep(stepping),
            ..scene.clone()
        },
        Size {
            elements: ELEMENTS,
            steps,
        },
    )
}

/// Numbers of elements and of steps, or factors of these.
#[derive(Debug, Clone, Copy)]
struct Size {
    elements: f64,
    steps: f64,
}

impl Size {
    fn of(scene: &Scene) -> Self {
        Self {
            elements: scene.mesh.elements() as f64,
            steps: scene.steps() as f64,
        }
    }

    fn times(self, factors: Self) -> Self {
        Self {
            elements: factors.elements * self.elements,
            steps: factors.steps * self.steps,
        }
    }

    fn product(self) -> f64 {
        self.elements * self.steps
    }
}

/// The scene with at least these numbers of elements and steps; `None` if there is no such mesh.
fn resized(scene: &Scene, Size { elements, steps }: Size) -> Option<Scene> {
    // A multiple of the listed elements keeps their nodes.
    let listed = scene.listed.len().saturating_sub(1).max(1);
    let mesh = resampled(
        &scene.mesh,
        (elements.ceil() as usize).next_multiple_of(listed),
    )
    .ok()?;
    Some(scene.with_steps(mesh, steps.ceil() as usize, scene.t_end))
}

/// A run by the scene's own scheme.
struct Own {
    rows: CurveRows,
    curves: Curves,
}

impl Own {
    /// * `nodes`: of the reference, whose polynomials may be steep where the scene's mesh is
    ///   coarse.
    fn run(
        scene: &Scene,
        quantity: ErrorQuantity,
        nodes: &[f64],
        work: &mut Work<'_>,
    ) -> Result<Self, StopReason> {
        let finer =
            resampled(&scene.mesh, 2 * scene.mesh.elements()).map_err(StopReason::of_run)?;
        let mut nodes = [finer.nodes(), nodes].concat();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        let rows = quantity.rows(&nodes);
        let curves = curves(scene, &rows, None, work)?;
        Ok(Self { rows, curves })
    }

    /// Its error, including that of the reference.
    fn error(&self, reference: &Reference, work: &mut Work<'_>) -> Result<f64, StopReason> {
        Ok(self.apart(&self.other(&reference.scene, work)?) + reference.error(0))
    }

    /// Another run, read at the same times.
    fn other(&self, scene: &Scene, work: &mut Work<'_>) -> Result<Curves, StopReason> {
        curves(scene, &self.rows, Some(&self.curves.own_times()), work)
    }

    fn apart(&self, other: &Curves) -> f64 {
        Apart::of(&self.rows, &self.curves, other, &[1.0; 3]).most()
    }
}

/// The parts of space and time in the error of a one-step scheme.
#[derive(Debug, Clone, Copy)]
struct Parts {
    errors: SpaceTime<f64>,
    /// The orders in h and in dt at which they fall.
    orders: SpaceTime<f64>,
}

impl Parts {
    /// From two runs: one with twice the elements, one with dt/2.
    fn of(scene: &Scene, own: &Own, work: &mut Work<'_>) -> Result<Self, StopReason> {
        let [space, time] = Policy::default()
            .finer(scene)
            .map(|finer| own.other(&finer?, work));
        let (space, time) = (own.apart(&space?), own.apart(&time?));
        let order = scene.one_step().map_err(StopReason::of_run)?.scheme.order;
        // In the norm, the error of the mesh is orthogonal to that of a finer one, so squares add.
        let (p, left) = match own.rows {
            CurveRows::Norm(_) => (1.0, 0.75_f64.sqrt()),
            _ => (2.0, 0.75),
        };
        Ok(Self {
            errors: SpaceTime {
                space: space / left,
                time: time / (1.0 - 0.5_f64.powf(order)),
            },
            orders: SpaceTime {
                space: p,
                time: order,
            },
        })
    }

    /// Halves h or dt, whichever has the larger part: the factors of elements and steps. The part
    /// that remains follows from its order until it is measured again.
    fn halve_larger(&mut self) -> Size {
        let Self { errors, orders } = self;
        if errors.time > errors.space {
            errors.time *= 0.5_f64.powf(orders.time);
            Size {
                elements: 1.0,
                steps: 2.0,
            }
        } else {
            errors.space *= 0.5_f64.powf(orders.space);
            Size {
                elements: 2.0,
                steps: 1.0,
            }
        }
    }

    /// By how much the product of elements and steps must grow until each part is at most `target`.
    fn growth(&self, target: f64) -> f64 {
        let mut growth = 1.0;
        for (error, order) in self.errors.both().into_iter().zip(self.orders.both()) {
            growth *= (error / target).max(1.0).powf(order.recip());
        }
        growth
    }
}
