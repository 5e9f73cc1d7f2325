//! Whole scenes, read and run as `run` does it, against the answers of an independent implementation.
//!
//! Studies of orders take loads and initial data from an exact solution; what a scene says beside them, from its initial rotation
//! to its stopping criterion, is tested here. The work of a run is guarded too: a factorisation in every step changes no result.

mod file;
mod judge;

use convergence_study::study::{Case, CaseFailure, Header, Kind, KindRow, Outcome, Ran, reader};

use super::energy::End;
use super::tables::Discretisation;
use crate::run::simulate::{Recording, Run, Simulator};
use crate::run::tally::{EnergySummary, Extremes, Sample};
use crate::run::together::run_together;
use crate::scene::{Method, Scene};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "scenes",
    read: reader::<Scenes>,
    why: "Two programs that were written independently of each other seldom make the same mistake. A run of a scene must give \
          the numbers of the other program: of the same scheme on the same mesh to round-off and tolerance, of the scheme of any \
          order those of a converged solution.",
    judged: "Each number of an answer must be met within the bound of its case, and each run must end as the case says. The \
             baseline guards all numbers of a run and its counts: steps, iterations, factorisations.",
    failure: "A value of the scene is not used, or used for something else: look which keys the case sets and its neighbours do \
              not. Counts alone that move mean another stopping criterion or another rule for factorising anew.",
};

/// Times of a curve in the figure.
const TIMES: usize = 200;

/// A study of whole scenes.
#[derive(Debug, Clone)]
pub struct Scenes {
    header: Header,
    scenes: Vec<Whole>,
}

/// Numbers by their names, some of [`NUMBERS`].
type Answer = Vec<(&'static str, f64)>;

/// A scene and what is known of it.
#[derive(Debug, Clone)]
pub(super) struct Whole {
    name: String,
    claim: String,
    scene: Scene,
    end: End,
    answer: Answer,
    /// Bound on the distance to each number of the answer.
    within: f64,
}

/// What a run shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// How it ended.
    pub end: End,
    /// The last level, the free end's range and the energy's largest change, in the order of [`NUMBERS`].
    pub numbers: [f64; NUMBERS.len()],
    /// Counts, in the order of [`COUNTS`].
    pub counts: [usize; COUNTS.len()],
    /// Whether the scene has the same bits in a lane of a group that is not full; `None` where it can only run alone.
    pub alike_in_lanes: Option<bool>,
    /// `(t, u(1, t))`, for the figure.
    pub tip: Vec<(f64, f64)>,
}

/// Names of numbers, as in the object of `run --format json`.
pub const NUMBERS: [&str; 9] =
    ["u_tip", "phi_tip", "u_t_tip", "phi_t_tip", "theta_mid", "energy", "u_tip_min", "u_tip_max", "largest_increase"];

/// Names of counts; `contact` counts steps in contact, or the contact events of the scheme of any order.
pub const COUNTS: [&str; 6] = ["steps", "iterations", "most iterations", "passes", "factorizations", "contact"];

impl Shown {
    /// Whether end, numbers and counts are the same, to the bit.
    fn has_the_bits_of(&self, other: &Self) -> bool {
        let bits = |shown: &Self| shown.numbers.map(f64::to_bits);
        (self.end, bits(self), self.counts) == (other.end, bits(other), other.counts)
    }

    fn of(run: &Run) -> Result<Self, CaseFailure> {
        let end = match &run.failure {
            None => End::Answer,
            Some(failure) => End::of_run(failure).ok_or_else(|| failure.clone())?,
        };
        let Run { last, extremes, energy, iterations, work, .. } = run;
        let contact = run.contact.as_ref().map_or(run.contact_steps, |contact| contact.events.len());
        Ok(Self {
            end,
            numbers: numbers(last, extremes, energy),
            counts: [run.steps, iterations.total, iterations.max, work.passes, work.factorizations, contact],
            alike_in_lanes: None,
            tip: run.tip(),
        })
    }
}

/// What a run of any scheme shows, in the order of [`NUMBERS`].
fn numbers(last: &Sample, extremes: &Extremes, energy: &EnergySummary) -> [f64; NUMBERS.len()] {
    let Sample { u_tip, phi_tip, u_t_tip, phi_t_tip, theta_mid, energy: end, .. } = *last;
    [
        u_tip,
        phi_tip,
        u_t_tip,
        phi_t_tip,
        theta_mid,
        end,
        extremes.u_tip_min,
        extremes.u_tip_max,
        energy.largest_increase,
    ]
}

impl Kind for Scenes {
    /// Number of the scene.
    type Data = usize;
    type Found = Shown;

    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case<usize>> {
        let cost = |scene: &Scene| match scene.method {
            Method::OneStep(_) => scene.steps() as f64 * (4.0 * scene.mesh.elements() as f64 + 4.0),
            Method::Dg(stepping) => {
                let Scene { degree, t_end, .. } = *scene;
                Discretisation { elements: scene.mesh.elements(), degree, stepping }.cost(t_end)
            }
        };
        let case = |(data, whole): (usize, &Whole)| Case { label: whole.name.clone(), cost: cost(&whole.scene), data };
        self.scenes.iter().enumerate().map(case).collect()
    }

    fn run(&self, index: &usize) -> Result<Shown, CaseFailure> {
        let scene = &self.scenes[*index].scene;
        let shown = Shown::of(&Simulator::new(scene)?.run(Recording::Curve(TIMES), &mut |_, _| ()))?;
        let lane = run_together(std::slice::from_ref(scene))?.first().map(Shown::of).transpose()?;
        Ok(Shown { alike_in_lanes: lane.map(|lane| lane.has_the_bits_of(&shown)), ..shown })
    }

    fn judge(&self, ran: &[Ran<usize, Shown>]) -> Outcome {
        judge::judge(self, ran)
    }
}
