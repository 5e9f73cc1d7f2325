//! One batch: its scenes in lanes, each to its end.

use convergence_study::run::time_limit::Patience;
use convergence_study::study::CaseFailure;
use thermobeam::ensemble::Ensemble;
use thermobeam::kirchhoff::BUCKLING;
use thermobeam::parameters::Beam;
use thermobeam::simulation::Problem;
use thermobeam::solve::{Level, Settings};

use super::{BATCH, Batch, End, Ends, Exception, GROUPS, LANES, RandomScenes, Scene, Worst};
use crate::kinds::watch::{CLOSED, SOLVED, Watch};

/// Exceptions of a batch that are kept.
const KEPT: usize = 4;

pub(super) fn run(study: &RandomScenes, number: usize) -> Result<Batch, CaseFailure> {
    let mut batch = Batch {
        ends: Ends::default(),
        refused: 0,
        steps: 0,
        not_finite_levels: 0,
        worst: Worst::NONE,
        exceptions: 0,
        largest: vec![],
        scenes: vec![],
    };
    for group in 0..GROUPS {
        run_group(study, number, group, &mut batch)?;
    }
    batch.exceptions = batch.largest.len();
    batch.largest.sort_by(|a, b| b.residual.total_cmp(&a.residual));
    batch.largest.truncate(KEPT);
    Ok(batch)
}

/// Scenes with `group + 1` elements each, to their ends.
fn run_group(study: &RandomScenes, number: usize, group: usize, batch: &mut Batch) -> Result<(), CaseFailure> {
    let first = number * BATCH + group * LANES;
    let scenes: Vec<(Problem, f64)> =
        (first..first + LANES).map(|scene| study.problem(scene)).collect::<Result<_, _>>()?;
    let dt: [f64; LANES] = std::array::from_fn(|k| scenes[k].1);
    let settings = Settings { tolerance: SOLVED, ..Settings::default() };
    let problems = scenes.iter().map(|(problem, _)| problem.clone()).collect();
    let mut ensemble = Ensemble::new(problems, &dt, study.scheme(number), settings)?;
    let mut old: Vec<Level> = vec![Level::new(group + 2); LANES];
    (0..LANES).for_each(|k| ensemble.observe(k, &mut old[k]));
    let mut watches: Vec<Watch> = (0..LANES).map(|k| Watch::new(ensemble.energy_scale(k, &old[k]))).collect();
    let mut ends = [End::Answer; LANES];
    let (mut new, mut balances) = (Level::new(group + 2), vec![]);
    let mut patience = Patience::new(LANES * (group + 1));
    for step in 0..study.steps {
        patience.check(step, || step as f64 * dt[0])?;
        ensemble.advance();
        ensemble.balances(&mut balances);
        for k in 0..LANES {
            if ends[k] != End::Answer {
                continue;
            }
            if let Err(error) = ensemble.report(k) {
                ends[k] = End::of(&error.failure);
                batch.refused += usize::from(is_definite(&scenes[k].0.beam, dt[k]));
                continue;
            }
            ensemble.observe(k, &mut new);
            let scale = ensemble.energy_scale(k, &new);
            watches[k].step(&balances[k], scale, || ensemble.rounding(k, &old[k], &new));
            batch.steps += 1;
            batch.not_finite_levels += usize::from(!is_finite(&new));
            std::mem::swap(&mut old[k], &mut new);
        }
    }
    for k in 0..LANES {
        batch.ends.count(ends[k]);
        batch.add(first + k, &scenes[k], &watches[k]);
    }
    Ok(())
}

impl Batch {
    fn add(&mut self, scene: usize, (problem, dt): &(Problem, f64), watch: &Watch) {
        let residual = watch.residual;
        self.worst = self.worst.max(watch.worst());
        if !(residual <= CLOSED) {
            self.largest.push(Exception { scene, residual });
        }
        let shortest = problem.mesh.lengths().fold(f64::INFINITY, f64::min);
        self.scenes.push(Scene { dt: *dt, shortest, residual });
    }
}

/// Whether the operator of every step is definite, whatever the axial force turns out to be.
fn is_definite(beam: &Beam, dt: f64) -> bool {
    beam.beta > -BUCKLING * (1.0 + 2.0 * beam.zeta / dt)
}

fn is_finite(level: &Level) -> bool {
    let fields = [&level.u, &level.v, &level.phi, &level.w, &level.theta];
    level.contact_force.is_finite() && fields.iter().all(|field| field.iter().all(|value| value.is_finite()))
}
