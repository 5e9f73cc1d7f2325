//! Several simulations in parallel lanes: for sweeps, maps and random scenes.
//!
//! The code of a step is that of [`OneStep`](crate::one_step::OneStep), with four numbers
//! instead of one. The results of a case are bitwise those of a single run. A case that fails keeps
//! its last level and does not affect the others.

use crate::energy::Balance;
use crate::error::{SetupError, StepError, StepFailure};
use crate::lanes::Lanes;
use crate::motion::{StepReport, Work};
use crate::one_step::{Problem, Stepping, is_heated, prepare};
use crate::scheme::{Scheme, SteppedBeam};
use crate::solve::newton::newton;
use crate::solve::stepper::Batch;
use crate::solve::{Settings, TimeLevel};

/// Cases in a group of lanes. Groups of eight were slower per case: their sums do not fit the
/// registers of AVX2.
const WIDTH: usize = 4;

/// Simulations by Newton's method with the same number of elements, the same scheme and the same
/// settings. Coefficients, obstacles, meshes, initial data and time steps may differ.
///
/// The number of cases is arbitrary. They are stepped in groups of four; a partly filled group
/// costs as much as a full one.
pub struct Ensemble {
    cases: Vec<SteppedBeam>,
    /// Up to [`WIDTH`] cases each; unused lanes repeat the last case.
    groups: Vec<Box<dyn Batch<Lanes<WIDTH>>>>,
    /// One for each lane, used or not.
    outcomes: Vec<Result<StepReport, StepFailure>>,
    steps: usize,
    /// The step in which a case failed, if any.
    failed: Vec<Option<usize>>,
    heated: Vec<bool>,
}

impl Ensemble {
    /// Checks every case and starts at t = 0.
    ///
    /// * `problems`: at least one, all with the same number of elements.
    /// * `dt`: the time step of each problem.
    ///
    /// # Errors
    /// [`SetupError`] as for a single simulation, for the first invalid case;
    /// [`SetupError::Length`] if the numbers of elements differ, if there is no problem, or if the
    /// number of time steps differs from that of the problems.
    pub fn new(
        mut problems: Vec<Problem>,
        dt: &[f64],
        scheme: Scheme,
        settings: Settings,
    ) -> Result<Self, SetupError> {
        let starts = starts(&mut problems, dt, scheme, settings)?;
        let heated: Vec<bool> = starts
            .iter()
            .map(|(case, level)| is_heated(&case.beam, level))
            .collect();
        let groups: Vec<_> = starts
            .chunks(WIDTH)
            .zip(heated.chunks(WIDTH))
            .map(|(starts, heated)| group(starts, heated.contains(&true), settings))
            .collect();
        let outcomes = vec![
            Err(StepFailure::NonFinite {
                iterations: 0,
                increment: f64::NAN
            });
            WIDTH * groups.len()
        ];
        let failed = vec![None; starts.len()];
        let cases = starts.into_iter().map(|(case, _)| case).collect();
        Ok(Self {
            cases,
            groups,
            outcomes,
            steps: 0,
            failed,
            heated,
        })
    }

    /// The cases, which compute energies, and scales for them.
    pub fn cases(&self) -> &[SteppedBeam] {
        &self.cases
    }

    /// Number of steps done.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Does one step of every case that has not failed. It allocates memory only when a case fails.
    pub fn step_once(&mut self) {
        self.steps += 1;
        for (group, outcomes) in self.groups.iter_mut().zip(self.outcomes.chunks_mut(WIDTH)) {
            group.advance(outcomes);
        }
        for (failed, outcome) in self.failed.iter_mut().zip(&self.outcomes) {
            if outcome.is_err() && failed.is_none() {
                *failed = Some(self.steps);
            }
        }
    }

    /// Iterations of the last step of case k.
    ///
    /// # Errors
    /// [`StepError`] of the step in which the case failed.
    pub fn report(&self, k: usize) -> Result<StepReport, StepError> {
        self.outcomes[k].clone().map_err(|failure| {
            let step = self.failed[k].unwrap_or(self.steps);
            let dt = self.cases[k].dt;
            StepError {
                step,
                t: (step - 1) as f64 * dt,
                dt,
                failure,
            }
        })
    }

    /// Copies the current level of case k into `level`; if the case has failed, the last level
    /// before the failure.
    pub fn observe(&self, k: usize, level: &mut TimeLevel) {
        self.groups[k / WIDTH].read(k % WIDTH, level);
    }

    /// The energy [`Balance`] of the last step of every case; NaN for failed cases and before the
    /// first step.
    ///
    /// Bitwise that of a single run; no level is copied, and the sums run over all lanes of a group
    /// at once.
    ///
    /// * `balances`: overwritten and resized.
    pub fn balances(&self, balances: &mut Vec<Balance>) {
        balances.clear();
        balances.resize(self.cases.len(), Balance::NAN);
        let groups = self.groups.iter().zip(balances.chunks_mut(WIDTH));
        groups.for_each(|(group, balances)| group.balances(balances));
    }

    /// u(1) at the current level of case k; if the case has failed, at the last level before the
    /// failure.
    pub fn tip(&self, k: usize) -> f64 {
        self.groups[k / WIDTH].tip(k % WIDTH)
    }

    /// The contact force of the step that led to the current level of case k.
    pub fn contact_force(&self, k: usize) -> f64 {
        self.groups[k / WIDTH].contact_force(k % WIDTH)
    }

    /// Counts of the work done so far for all cases; a pass of a group counts once.
    pub fn work(&self) -> Work {
        let mut sum = Work::default();
        for group in &self.groups {
            let work = group.work();
            sum.passes += work.passes;
            sum.factorizations += work.factorizations;
        }
        sum
    }

    /// Counts of the work for case k so far, the same as in a single run.
    pub fn work_of(&self, k: usize) -> Work {
        self.groups[k / WIDTH].work_of(k % WIDTH)
    }

    /// Whether anything heats case k: in a single run, its temperature would then be computed.
    pub fn is_heated(&self, k: usize) -> bool {
        self.heated[k]
    }
}

/// Each case with its first level; all have the same number of nodes.
fn starts(
    problems: &mut [Problem],
    dt: &[f64],
    scheme: Scheme,
    settings: Settings,
) -> Result<Vec<(SteppedBeam, TimeLevel)>, SetupError> {
    check_length("dt", dt.len(), problems.len())?;
    let Some(first) = problems.first() else {
        return Err(SetupError::Length {
            field: "problems",
            found: 0,
            expected: 1,
        });
    };
    let nodes = first.mesh.nodes().len();
    let mut starts = vec![];
    for (problem, &dt) in problems.iter_mut().zip(dt) {
        let stepping = Stepping {
            scheme,
            settings,
            dt,
            loaded: false,
        };
        let level = prepare(problem, &stepping)?;
        check_length("nodes", level.u.len(), nodes)?;
        starts.push((problem.case(scheme, dt), level));
    }
    Ok(starts)
}

fn check_length(field: &'static str, found: usize, expected: usize) -> Result<(), SetupError> {
    if found == expected {
        Ok(())
    } else {
        Err(SetupError::Length {
            field,
            found,
            expected,
        })
    }
}

/// The solver of up to [`WIDTH`] cases; unused lanes repeat the last one.
fn group(
    starts: &[(SteppedBeam, TimeLevel)],
    is_heated: bool,
    settings: Settings,
) -> Box<dyn Batch<Lanes<WIDTH>>> {
    let mut cases = vec![];
    let mut levels = vec![];
    for k in 0..WIDTH {
        let (case, level) = &starts[k.min(starts.len() - 1)];
        cases.push(case.clone());
        levels.push(level);
    }
    newton(cases, settings, &levels, is_heated)
}
