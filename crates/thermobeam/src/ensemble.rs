//! Several simulations side by side, in lanes: for sweeps, maps and random scenes.
//!
//! The stepping code is that of [`Simulation`](crate::simulation::Simulation), with four numbers in place of one. A
//! case in a lane gets the same bits as alone; a case that fails keeps its last level and does not touch the others.

use crate::energy::{self, Balance, Energy, Rounding};
use crate::error::{SetupError, StepError, StepFailure};
use crate::lanes::Lanes;
use crate::scheme::Scheme;
use crate::simulation::{Problem, Stepping, is_heated, prepare};
use crate::solve::newton::{Case, Newton};
use crate::solve::{Level, Settings, StepReport, Work};

/// Cases in a group of lanes. Eight were slower for each case: their sums do not fit the registers of AVX2.
const WIDTH: usize = 4;

/// Simulations by Newton's method, with as many elements each, the same scheme and the same settings; coefficients,
/// obstacles, meshes, data and time steps may differ.
///
/// Any number of cases; they are stepped in groups of four, and a group that is not full costs as much as a full one.
pub struct Ensemble {
    problems: Vec<Problem>,
    lengths: Vec<Vec<f64>>,
    dt: Vec<f64>,
    groups: Vec<Group>,
    step: usize,
    /// The step in which a case failed.
    failed: Vec<Option<usize>>,
    heated: Vec<bool>,
}

/// Up to [`WIDTH`] cases in lanes.
struct Group {
    stepper: Stepper,
    /// One for each lane, filled or not.
    outcomes: Vec<Result<StepReport, StepFailure>>,
}

/// Chosen once for a group: with or without temperature.
enum Stepper {
    Cold(Box<Newton<Lanes<WIDTH>, 2>>),
    Heated(Box<Newton<Lanes<WIDTH>, 3>>),
}

/// The same for both kinds of stepper.
macro_rules! with {
    ($stepper:expr, $newton:ident => $result:expr) => {
        match $stepper {
            Stepper::Cold($newton) => $result,
            Stepper::Heated($newton) => $result,
        }
    };
}

impl Ensemble {
    /// Checks every case and stands at t = 0.
    ///
    /// * `problems`: one or more, with as many elements each.
    /// * `dt`: the time step of each.
    ///
    /// # Errors
    /// [`SetupError`] as for a single simulation, of the first case that has one; [`SetupError::Length`] where the
    /// numbers of elements differ, where there is no problem, and where there are not as many time steps.
    pub fn new(mut problems: Vec<Problem>, dt: &[f64], scheme: Scheme, settings: Settings) -> Result<Self, SetupError> {
        if dt.len() != problems.len() {
            return Err(SetupError::Length { field: "dt", found: dt.len(), expected: problems.len() });
        }
        let Some(first) = problems.first() else {
            return Err(SetupError::Length { field: "problems", found: 0, expected: 1 });
        };
        let nodes = first.mesh.nodes().len();
        let mut starts = vec![];
        for (problem, &dt) in problems.iter_mut().zip(dt) {
            let level = prepare(problem, &Stepping { scheme, settings, dt, loaded: false })?;
            if level.u.len() != nodes {
                return Err(SetupError::Length { field: "nodes", found: level.u.len(), expected: nodes });
            }
            let lengths = problem.mesh.lengths().collect();
            starts.push((Case { beam: problem.beam, obstacles: problem.obstacles, dt, lengths }, level));
        }
        let lengths = starts.iter().map(|(case, _)| case.lengths.clone()).collect();
        let heated: Vec<bool> = starts.iter().map(|(case, level)| is_heated(&case.beam, level)).collect();
        let group = |(starts, heated): (&[_], &[bool])| Group::new(starts, heated.contains(&true), scheme, settings);
        let groups = starts.chunks(WIDTH).zip(heated.chunks(WIDTH)).map(group).collect();
        let failed = vec![None; problems.len()];
        Ok(Self { problems, lengths, dt: dt.to_vec(), groups, step: 0, failed, heated })
    }

    /// Number of cases.
    pub fn cases(&self) -> usize {
        self.problems.len()
    }

    /// Number of steps done.
    pub fn step(&self) -> usize {
        self.step
    }

    /// Does one step of every case that has not failed; allocates nothing as long as none does.
    pub fn advance(&mut self) {
        self.step += 1;
        for (group, failed) in self.groups.iter_mut().zip(self.failed.chunks_mut(WIDTH)) {
            group.advance();
            for (failed, outcome) in failed.iter_mut().zip(&group.outcomes) {
                if outcome.is_err() && failed.is_none() {
                    *failed = Some(self.step);
                }
            }
        }
    }

    /// What the last step of case k took, or why and when the case failed.
    ///
    /// # Errors
    /// [`StepError`] of the step in which the case failed.
    pub fn report(&self, k: usize) -> Result<StepReport, StepError> {
        self.groups[k / WIDTH].outcomes[k % WIDTH].clone().map_err(|failure| {
            let step = self.failed[k].unwrap_or(self.step);
            StepError { step, t: step as f64 * self.dt[k], failure }
        })
    }

    /// Copies the present level of case k into `level`; its last good one if the case has failed.
    pub fn observe(&self, k: usize, level: &mut Level) {
        self.groups[k / WIDTH].read(k % WIDTH, level);
    }

    /// Energy of a level of case k.
    pub fn energy(&self, k: usize, level: &Level) -> Energy {
        let problem = &self.problems[k];
        Energy::of(&problem.beam, problem.obstacles.as_ref(), &self.lengths[k], level)
    }

    /// The [`Balance`] of the last step of every case, NaN for those that have failed and before the first step.
    ///
    /// No level is copied for it, and the sums run over all lanes of a group at once; the bits are the same.
    ///
    /// * `balances`: overwritten; it need not be of the right length.
    pub fn balances(&self, balances: &mut Vec<Balance>) {
        balances.clear();
        balances.resize(self.cases(), Balance::NAN);
        let groups = self.groups.iter().zip(balances.chunks_mut(WIDTH));
        groups.for_each(|(group, balances)| group.balances(balances));
    }

    /// u(1) of the present level of case k; of its last good one if the case has failed.
    pub fn tip(&self, k: usize) -> f64 {
        self.groups[k / WIDTH].tip(k % WIDTH)
    }

    /// The contact force of the step that led to the present level of case k.
    pub fn contact_force(&self, k: usize) -> f64 {
        self.groups[k / WIDTH].contact_force(k % WIDTH)
    }

    /// The size of the energy of a level of case k, without signs.
    pub fn energy_scale(&self, k: usize, level: &Level) -> f64 {
        let problem = &self.problems[k];
        energy::scale(&problem.beam, problem.obstacles.as_ref(), &self.lengths[k], level)
    }

    /// What rounding errors explain in the balance of a step of case k.
    pub fn rounding(&self, k: usize, old: &Level, new: &Level) -> Rounding {
        let problem = &self.problems[k];
        Rounding::of(&problem.beam, problem.obstacles.as_ref(), self.dt[k], &self.lengths[k], old, new)
    }

    /// Counts of the work done so far, all cases together: a pass of the lanes of a group is one.
    pub fn work(&self) -> Work {
        self.groups.iter().map(Group::work).fold(Work::default(), Work::plus)
    }

    /// Counts of the work that case k has needed so far, as many as it would have taken alone.
    pub fn work_of(&self, k: usize) -> Work {
        self.groups[k / WIDTH].work_of(k % WIDTH)
    }

    /// Whether the temperature of case k would be computed if it were alone: something heats the beam.
    pub fn is_heated(&self, k: usize) -> bool {
        self.heated[k]
    }
}

impl Group {
    /// Lanes for these cases; the last one again where a lane is left over.
    fn new(starts: &[(Case, Level)], heated: bool, scheme: Scheme, settings: Settings) -> Self {
        let lanes = || (0..WIDTH).map(|k| &starts[k.min(starts.len() - 1)]);
        let cases: Vec<Case> = lanes().map(|(case, _)| case.clone()).collect();
        let fields = |level: &Level| (0..level.u.len()).map(|i| [level.u[i], level.phi[i], level.theta[i]]).collect();
        let velocities = |level: &Level| (0..level.v.len()).map(|i| [level.v[i], level.w[i]]).collect();
        let initial: Vec<Vec<[f64; 3]>> = lanes().map(|(_, level)| fields(level)).collect();
        let velocity: Vec<Vec<[f64; 2]>> = lanes().map(|(_, level)| velocities(level)).collect();
        let stepper = if heated {
            Stepper::Heated(Box::new(Newton::new(cases, scheme, settings, &initial, &velocity)))
        } else {
            Stepper::Cold(Box::new(Newton::new(cases, scheme, settings, &initial, &velocity)))
        };
        let outcomes = vec![Err(StepFailure::NonFinite { iterations: 0, increment: f64::NAN }); WIDTH];
        Self { stepper, outcomes }
    }

    fn advance(&mut self) {
        with!(&mut self.stepper, newton => newton.advance(&mut self.outcomes));
    }

    fn read(&self, lane: usize, level: &mut Level) {
        with!(&self.stepper, newton => newton.read(lane, level));
    }

    fn balances(&self, balances: &mut [Balance]) {
        with!(&self.stepper, newton => newton.balances(balances));
    }

    fn tip(&self, lane: usize) -> f64 {
        with!(&self.stepper, newton => newton.tip(lane))
    }

    fn contact_force(&self, lane: usize) -> f64 {
        with!(&self.stepper, newton => newton.contact_force(lane))
    }

    fn work(&self) -> Work {
        with!(&self.stepper, newton => newton.work())
    }

    fn work_of(&self, lane: usize) -> Work {
        with!(&self.stepper, newton => newton.work_of(lane))
    }
}
