//! A run of any order whose own error is known: degrees, elements and steps are refined until it is
//! small enough.
//!
//! Two comparisons judge a discretisation by its curves, at several times inside each of its steps:
//! with a finer space (p + 4, or the longest elements halved) and with finer steps. Finer steps
//! have half the length *everywhere*: dt, `restart_dt` and `growth - 1` are halved, since at a
//! distance s from a contact event a step is about `(growth - 1) s` long; `restart_dt` is halved
//! twice. The difference estimates the error of the coarser run: p + 4 leaves up to a third of the
//! error where elements do not resolve a layer, halved steps leave less. If a difference exceeds
//! half of the target, space or time is refined according to their ratio, and both runs are
//! compared again. Before that, the first two steps are refined on their own.
//!
//! * The start: initial data that violate the condition at x = 1 make u(1, t) behave like t^(3/2).
//!   The error peaks inside the first steps, which only `restart_dt` makes shorter, and in the
//!   element at x = 1, which is split.
//! * Steps: at the peak of an impact, on the time scale (ε √ζ)^(2/3), u_tt behaves like t^(1/2);
//!   there the error peaks inside steps, and is not visible at their ends. The degree q helps
//!   between impacts, short steps during them.
//! * Elements: the last one, at x = 1, covers the layer that an impact sends into the beam; after
//!   time t its width is √(ζ t).
//! * Initial data: nodes at narrow features and at kinks, see `data`. From a kink a layer of width
//!   √(ζ t) begins at the start: the elements on both sides of it are split like the last one,
//!   until there is a contact event.
//! * Short waves: u ~ e^(λt) sin(kx) has λ² + ζk²λ + (1 + N)k² = 0. While N < -1 every wave grows,
//!   shorter waves faster, up to the rate s/ζ, s = -(1 + N), which waves with k > √s/ζ come close
//!   to. Unresolved waves grow most, and p and p + 4 agree on waves that both lack: errors of 300
//!   times the difference were observed. N ≥ β, so this requires β < -1. Then the first mesh
//!   resolves k = √s/ζ, in elements no longer than 2p/k, and the first steps are at most 2ζ/s long,
//!   with s at N = β.

use thermobeam::dg::DgStepping;

use super::curves::{Apart, CurveRows, Curves, Wanted, curves};
use super::data::Data;
use super::first::first;
use super::policy::Policy;
use super::refine::elements_and_degree;
use super::{Cost, StopReason, Unreachable, Work};
use crate::error::reference::distance_of_curves;
use crate::scene::{Method, Scene};

/// A run whose own error is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The scene with the chosen mesh, degrees and steps.
    pub scene: Scene,
    /// Largest difference to a finer space: of u(1, t), φ(1, t) and the energy, or once in the
    /// norm.
    pub space: [f64; 3],
    /// The same to finer steps.
    pub time: [f64; 3],
    /// Both together at the end, in units of the largest value of the curve; the largest of all
    /// curves.
    pub(super) end: f64,
    /// The cost of the run.
    pub run: Cost,
    /// The finer space of the last comparison, in words.
    pub finer_space: String,
}

impl Reference {
    /// The error of curve k.
    pub(super) fn error(&self, k: usize) -> f64 {
        self.space[k] + self.time[k]
    }
}

/// Refines until both differences are at most half of the tolerance.
///
/// * `scene`: its own mesh, degrees and steps have no influence.
/// * `start`: the first discretisation; without it, a guess.
/// * `policy`: how to refine.
///
/// # Errors
/// [`Unreachable`]: why there is no such run, and the error reached.
pub(super) fn reference(
    scene: &Scene,
    start: Option<&Scene>,
    wanted: &Wanted,
    policy: &Policy,
    work: &mut Work<'_>,
) -> Result<Reference, Unreachable> {
    let target = wanted.tolerance[0];
    if !(target > 0.0 && target.is_finite()) {
        return Err(Unreachable::Target { target });
    }
    let data = Data::of(scene);
    let first = start
        .cloned()
        .unwrap_or_else(|| first(scene, wanted, &data.kept));
    let (first, _) = data.resolve(first, wanted)?;
    let mut search = ReferenceSearch {
        wanted,
        policy,
        data,
        work,
        last: 0.0,
        best: [f64::INFINITY; 2],
    };
    // A search that finds no start for the first two steps begins with the guess.
    let beginning = match start {
        Some(_) => first,
        None => search.begin(&first).unwrap_or(first),
    };
    search.last = 0.0;
    search.refine(beginning).map_err(|reason| {
        let [space, time] = search.best.map(|part| part * target);
        Unreachable::NotReached {
            target,
            reached: space.max(time) / policy.share,
            space,
            time,
            reason,
        }
    })
}

/// Two finer runs and their distances from a run.
struct Compared {
    finer: Curves,
    shorter: Curves,
    space: Apart,
    time: Apart,
}

/// The state of a search for a discretisation.
struct ReferenceSearch<'s, 'w> {
    wanted: &'s Wanted,
    policy: &'s Policy,
    data: Data,
    work: &'s mut Work<'w>,
    /// Work of the last run.
    last: f64,
    /// The differences of the round whose sum was smallest.
    best: [f64; 2],
}

impl ReferenceSearch<'_, '_> {
    /// Refines for the first two steps only, which cost little: the start often needs the shortest
    /// steps of all.
    ///
    /// # Errors
    /// [`StopReason`]: a run fails, or refinement ends before the differences are small enough.
    fn begin(&mut self, first: &Scene) -> Result<Scene, StopReason> {
        let mut scene = first.clone();
        for _ in 0..self.policy.rounds {
            let DgStepping { dt, restart_dt, .. } = scene.dg_stepping();
            let t_end = 2.0 * restart_dt;
            // Only shorter steps: each step length needs memory, and only these lengths occur.
            let method = Method::Dg(DgStepping {
                dt: t_end.min(dt),
                ..scene.dg_stepping()
            });
            let short = Scene {
                t_end: t_end.min(scene.t_end),
                method,
                ..scene.clone()
            };
            let rows = self.wanted.rows.on(&short);
            let base = self.run(&short, &rows, None)?;
            let Compared { space, time, .. } = self.compare(&short, &rows, &base)?;
            if self.are_small(&space, &time) {
                return Ok(scene);
            }
            scene = self.refined(&scene, &space, &time)?;
        }
        Err(StopReason::Rounds)
    }

    /// Refines a discretisation until both differences are small enough.
    fn refine(&mut self, mut scene: Scene) -> Result<Reference, StopReason> {
        for _ in 0..self.policy.rounds {
            let rows = self.wanted.rows.on(&scene);
            let base = self.run(&scene, &rows, None)?;
            let compared = self.compare(&scene, &rows, &base)?;
            let (space, time) = (&compared.space, &compared.time);
            if self.are_small(space, time) {
                return Ok(self.reference(scene, &base, &compared));
            }
            self.judge(space.most(), time.most())?;
            scene = self.refined(&scene, space, time)?;
        }
        Err(StopReason::Rounds)
    }

    /// Whether both differences have at most their share of the target.
    fn are_small(&self, space: &Apart, time: &Apart) -> bool {
        space.most() <= self.policy.share && time.most() <= self.policy.share
    }

    /// The next discretisation.
    fn refined(&self, scene: &Scene, space: &Apart, time: &Apart) -> Result<Scene, StopReason> {
        self.policy
            .refined(scene, space, time, &self.data.kinks)
            .ok_or(StopReason::Finest)
    }

    /// The result of a search that ends with this scene.
    fn reference(&self, scene: Scene, base: &Curves, compared: &Compared) -> Reference {
        let mut reference = Reference {
            finer_space: self.policy.finer(&scene)[0]
                .as_ref()
                .map_or_else(|_| String::new(), elements_and_degree),
            scene,
            space: [compared.space.most() * self.wanted.tolerance[0]; 3],
            time: [compared.time.most() * self.wanted.tolerance[0]; 3],
            end: 0.0,
            run: base.cost,
        };
        if !matches!(self.wanted.rows, CurveRows::Norm(_)) {
            for k in 0..base.width {
                let [own, finer, shorter] =
                    [base, &compared.finer, &compared.shorter].map(|run| run.column(k));
                reference.space[k] = distance_of_curves(&own, &finer);
                reference.time[k] = distance_of_curves(&own, &shorter);
                let last = own.len() - 1;
                let end = (own[last] - finer[last]).abs() + (own[last] - shorter[last]).abs();
                let largest = distance_of_curves(&own, &vec![0.0; own.len()]);
                reference.end = reference.end.max(end / largest);
            }
        }
        reference
    }

    /// The two comparisons of a scene; `base` is its run.
    fn compare(
        &mut self,
        scene: &Scene,
        rows: &CurveRows,
        base: &Curves,
    ) -> Result<Compared, StopReason> {
        let times = base.own_times();
        let [finer, shorter] = self.policy.finer(scene);
        let finer = self.run(&finer?, rows, Some(&times))?;
        let shorter = self.run(&shorter?, rows, Some(&times))?;
        let tolerance = &self.wanted.tolerance;
        let [space, time] = [&finer, &shorter].map(|finer| Apart::of(rows, base, finer, tolerance));
        Ok(Compared {
            finer,
            shorter,
            space,
            time,
        })
    }

    /// Runs a scene; `times` are those of the run that it is compared with.
    fn run(
        &mut self,
        scene: &Scene,
        rows: &CurveRows,
        times: Option<&[f64]>,
    ) -> Result<Curves, StopReason> {
        // A run has at most four times the steps of its predecessor; higher degrees cost more on
        // top.
        self.work.leaves(2.0 * self.last)?;
        let run = curves(scene, rows, times, self.work)?;
        self.last = run.cost.work;
        Ok(run)
    }

    /// Records the result of a round; stops if refinement has reached round-off.
    fn judge(&mut self, space: f64, time: f64) -> Result<(), StopReason> {
        let [best_space, best_time] = self.best;
        let sum = space + time;
        let stalled = !(sum <= self.policy.stalled * (best_space + best_time));
        if sum < best_space + best_time {
            self.best = [space, time];
        }
        if !sum.is_finite() {
            return Err(StopReason::NotFinite);
        }
        if stalled && sum * self.wanted.tolerance[0] <= self.policy.round_off {
            Err(StopReason::RoundOff)
        } else {
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predict::MOST_WORK;

    fn search(policy: &Policy) -> Reference {
        let text = "[initial]\nu_t = \"x\"\n[time]\nscheme = \"dg\"\nt_end = 0.2";
        let scene = Scene::parse(text, "swing.toml").expect("a scene");
        let wanted = Wanted {
            rows: CurveRows::Tip,
            tolerance: [1e-5; 3],
        };
        let mut no_progress = |_: f64| ();
        let work = &mut Work::new(MOST_WORK, &mut no_progress);
        reference(&scene, None, &wanted, policy, work).expect("a reference")
    }

    #[test]
    fn a_smaller_share_of_the_target_leaves_a_smaller_error_at_a_higher_cost() {
        let usual = search(&Policy::default());
        let strict = Policy {
            share: 1e-3 * Policy::default().share,
            ..Policy::default()
        };
        let smaller = search(&strict);
        assert!(usual.space[0].max(usual.time[0]) <= 0.5e-5, "{usual:?}");
        assert!(usual.error(0) > 0.5e-8, "{usual:?}");
        assert!(
            smaller.space[0].max(smaller.time[0]) <= 0.5e-8,
            "{smaller:?}"
        );
        assert!(smaller.run.work > usual.run.work, "{smaller:?}");
    }
}
