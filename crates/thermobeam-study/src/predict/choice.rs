//! Runs chosen by accuracy: the cheapest run with at most the wanted error, or such a run by the scene's own scheme.
//!
//! The cheapest is dG with the degrees, elements and steps of [`super::reference`]: the error of any other run could only be found by
//! comparison with such a run. The needs of the scene's own scheme follow from two constants: with n elements and s steps its error
//! is about `S (n0/n)^p + T (s0/s)^q`. S and T are the reductions of a coarse run's error when only h or only dt is halved, divided
//! by `1 - 2^-p` and `1 - 2^-q`.
//!
//! ```
//! use thermobeam_study::predict::choice::{Quantity, choose};
//! use thermobeam_study::predict::{MOST_WORK, Work};
//! use thermobeam_study::scene::Scene;
//!
//! let scene = Scene::parse("[initial]\nu_t = \"x\"\n[time]\ndt = 0.01\nt_end = 1.0", "swing.toml")?;
//! let choice = choose(&scene, Quantity::Tip, 1e-7, &mut Work::new(MOST_WORK, &mut |_| ()))?;
//! assert!(choice.error <= 1e-7 && choice.scene.method.name() == "dg");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use thermobeam::solve::Stopping;

use super::curves::{Apart, Curves, Rows, Wanted, curves};
use super::reference::{Reference, finer, impact, reference};
use super::{Cost, Reason, Unreachable, Work};
use crate::scene::{Method, Scene, resampled};

/// Elements of the coarsest run by the scene's own scheme.
const ELEMENTS: f64 = 16.0;

/// Maximum number of steps in runs that predict the needs of the scene's own scheme: some milliseconds.
const MOST_STEPS: f64 = 4000.0;

/// Part of the target that a one-step scheme aims at; the rest allows for constants that change from level to level.
const AIM: f64 = 0.75;

/// Allowed error of the reference of a one-step scheme, as part of the target.
const TENTH: f64 = 0.1;

/// Maximum growth of elements and steps in one round: constants of coarse runs reach no further.
const MOST_GROWTH: f64 = 8.0;

/// Rounds of refinement.
const ROUNDS: usize = 16;

/// Allowed number of failed runs.
const FAILURES: usize = 4;

/// The quantity whose error is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Maximum over [0, T] of the error of u(1, t).
    Tip,
    /// Maximum over [0, T] of the norm of Theorem 3.4.
    Norm,
}

impl Quantity {
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
    fn rows(self, nodes: &[f64]) -> Rows {
        match self {
            Self::Tip => Rows::Tip,
            Self::Norm => Rows::of_norm(nodes, 2),
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

/// Predicted discretisation and cost of the scene's own scheme for the wanted error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Needed {
    /// Elements and steps.
    pub at: [f64; 2],
    /// Seconds, at the speed of the coarse runs.
    pub seconds: f64,
}

impl Needed {
    /// Elements times steps.
    pub fn node_steps(&self) -> f64 {
        self.at[0] * self.at[1]
    }
}

/// The chosen run.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The scene with the chosen mesh, method and steps.
    pub scene: Scene,
    /// The parts of space and time in the error.
    pub parts: [f64; 2],
    /// The origin of these parts, in words.
    pub parts_by: String,
    /// The cost of the run itself.
    pub run: Cost,
    /// The needs of the scene's own scheme; `None` if it is the chosen one, or if its coarse runs fail.
    pub needed: Option<Needed>,
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
    quantity: Quantity,
    target: f64,
    work: &mut Work<'_>,
) -> Result<Choice, Unreachable> {
    let Reference {
        scene: chosen,
        space,
        time,
        run,
        finer_space,
        is_narrow,
        ..
    } = reference(scene, None, &quantity.wanted(target), work)?;
    // Coarse levels that miss a narrow feature say nothing about finer ones.
    let own_scheme = if is_narrow {
        None
    } else {
        own_scheme(scene, target, MOST_STEPS)
    };
    let law = own_scheme.and_then(|coarse| {
        let own = Own::run(&coarse, quantity, chosen.mesh.nodes(), work).ok()?;
        Law::of(&coarse, &own, work).ok()
    });
    Ok(Choice {
        scene: chosen,
        parts: [space[0], time[0]],
        parts_by: format!("differences to {finer_space}, and to half the steps"),
        error: space[0] + time[0],
        is_kept: false,
        run,
        needed: law.map(|law| law.needed(target)),
    })
}

/// The scene's own scheme with the required elements and steps; its error is the difference to a run of any order.
///
/// # Errors
/// As [`choose`].
pub fn keep_scheme(
    scene: &Scene,
    quantity: Quantity,
    target: f64,
    work: &mut Work<'_>,
) -> Result<Choice, Unreachable> {
    let Some(mut scene) = own_scheme(scene, target, f64::INFINITY) else {
        return choose(scene, quantity, target, work);
    };
    let reference = reference(&scene, None, &quantity.wanted(TENTH * target), work)?;
    let mut best = (f64::INFINITY, [f64::NAN; 2]);
    let (mut law, mut failures) = (None, 0);
    let not_reached = |(reached, [space, time]): (f64, [f64; 2]), reason| Unreachable::NotReached {
        target,
        reached,
        space,
        time,
        reason,
    };
    for _ in 0..ROUNDS {
        let outcome = work
            .leaves(size(&scene).iter().product())
            .and_then(|()| Own::run(&scene, quantity, reference.scene.mesh.nodes(), work))
            .and_then(|own| {
                let error = own.error(&reference, work)?;
                // A law for the first run, and after each run that misses the target.
                if law.is_none() || error > target {
                    law = Some(Law::of(&scene, &own, work)?);
                }
                Ok((own, error))
            });
        let finer = match (outcome, &law) {
            (Ok((own, error)), Some(law)) if error <= target => {
                let parts = law.parts(size(&scene));
                let parts_by = "by runs with twice the elements and with half of dt".to_owned();
                return Ok(Choice {
                    scene,
                    parts,
                    parts_by,
                    error,
                    is_kept: true,
                    run: own.curves.cost,
                    needed: None,
                });
            }
            (Ok((_, error)), Some(law)) => {
                if error < best.0 {
                    best = (error, law.parts(size(&scene)));
                }
                // A run that is clearly too expensive is not started.
                let [elements, steps] = law.cheapest(AIM * target);
                work.leaves(0.25 * elements * steps)
                    .map_err(|reason| not_reached(best, reason))?;
                law.next(size(&scene), target)
            }
            // Coarse steps may fail although finer ones succeed.
            (Err(Reason::Run(_)), _) if failures < FAILURES => {
                failures += 1;
                size(&scene).map(|count| 2.0 * count)
            }
            (Err(reason), _) => return Err(not_reached(best, reason)),
            (Ok(_), None) => return Err(not_reached(best, Reason::NotFinite)),
        };
        scene = resized(&scene, finer).ok_or_else(|| not_reached(best, Reason::Finest))?;
    }
    Err(not_reached(best, Reason::Rounds))
}

/// The scene with its own one-step scheme on coarse levels; `None` for a scene by dG.
fn own_scheme(scene: &Scene, target: f64, most_steps: f64) -> Option<Scene> {
    let Method::OneStep(mut stepping) = scene.method else {
        return None;
    };
    if let Stopping::Converged { tolerance, .. } = &mut stepping.settings.stopping {
        *tolerance = tolerance.min((1e-4 * target).clamp(1e-13, 1e-9));
    }
    let steps = (2.0 * scene.t_end / impact(scene)).clamp(8.0, most_steps);
    resized(
        &Scene {
            method: Method::OneStep(stepping),
            ..scene.clone()
        },
        [ELEMENTS, steps],
    )
}

fn size(scene: &Scene) -> [f64; 2] {
    [scene.mesh.elements() as f64, scene.steps() as f64]
}

/// The scene with at least these numbers of elements and steps; `None` if there is no such mesh.
fn resized(scene: &Scene, [elements, steps]: [f64; 2]) -> Option<Scene> {
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
    rows: Rows,
    curves: Curves,
}

impl Own {
    /// * `nodes`: of the reference, whose polynomials may be steep where the scene's mesh is coarse.
    fn run(
        scene: &Scene,
        quantity: Quantity,
        nodes: &[f64],
        work: &mut Work<'_>,
    ) -> Result<Self, Reason> {
        let finer = resampled(&scene.mesh, 2 * scene.mesh.elements()).map_err(Reason::of_run)?;
        let mut nodes = [finer.nodes(), nodes].concat();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        let rows = quantity.rows(&nodes);
        let curves = curves(scene, &rows, None, work)?;
        Ok(Self { rows, curves })
    }

    /// Its error, including that of the reference.
    fn error(&self, reference: &Reference, work: &mut Work<'_>) -> Result<f64, Reason> {
        Ok(self.apart(&self.other(&reference.scene, work)?) + reference.error(0))
    }

    /// Another run, read at the same times.
    fn other(&self, scene: &Scene, work: &mut Work<'_>) -> Result<Curves, Reason> {
        curves(scene, &self.rows, Some(&self.curves.own_times()), work)
    }

    fn apart(&self, other: &Curves) -> f64 {
        Apart::of(&self.rows, &self.curves, other, &[1.0; 3]).most()
    }
}

/// How the error of a one-step scheme falls with elements and steps.
#[derive(Debug, Clone, Copy)]
struct Law {
    at: [f64; 2],
    /// Errors of space and time on that level.
    parts: [f64; 2],
    orders: [f64; 2],
    seconds_per_node_step: f64,
}

impl Law {
    /// From two runs: one with twice the elements, one with dt/2.
    fn of(scene: &Scene, own: &Own, work: &mut Work<'_>) -> Result<Self, Reason> {
        let [space, time] = finer(scene).map(|finer| own.other(&finer?, work));
        let (space, time) = (own.apart(&space?), own.apart(&time?));
        let order = scene.one_step().map_err(Reason::of_run)?.scheme.order;
        // In the norm, the error of the mesh is orthogonal to that of a finer one, so squares add.
        let (p, left) = match own.rows {
            Rows::Norm(_) => (1.0, 0.75_f64.sqrt()),
            _ => (2.0, 0.75),
        };
        let cost = own.curves.cost;
        Ok(Self {
            at: size(scene),
            parts: [space / left, time / (1.0 - 0.5_f64.powf(order))],
            orders: [p, order],
            seconds_per_node_step: cost.seconds / cost.work,
        })
    }

    fn parts(&self, [elements, steps]: [f64; 2]) -> [f64; 2] {
        let ([n, s], [p, q]) = (self.at, self.orders);
        [
            self.parts[0] * (n / elements).powf(p),
            self.parts[1] * (s / steps).powf(q),
        ]
    }

    /// The fewest node-steps with a given error: there the errors of space and time are in the ratio q to p.
    fn cheapest(&self, error: f64) -> [f64; 2] {
        let ([n, s], [p, q]) = (self.at, self.orders);
        let wanted = [error * q / (p + q), error * p / (p + q)];
        [
            n * (self.parts[0] / wanted[0]).powf(1.0 / p),
            s * (self.parts[1] / wanted[1]).powf(1.0 / q),
        ]
    }

    /// The size after a run that misses the target: larger, but within the range of the law.
    fn next(&self, now: [f64; 2], target: f64) -> [f64; 2] {
        let best = self.cheapest(AIM * target);
        let next: [f64; 2] = std::array::from_fn(|k| best[k].clamp(now[k], MOST_GROWTH * now[k]));
        if next[0] * next[1] >= 1.5 * now[0] * now[1] {
            next
        } else {
            now.map(|count| 1.3 * count)
        }
    }

    fn needed(&self, target: f64) -> Needed {
        let at = self.cheapest(target).map(|count| count.max(1.0).ceil());
        Needed {
            at,
            seconds: self.seconds_per_node_step * at[0] * at[1],
        }
    }
}
