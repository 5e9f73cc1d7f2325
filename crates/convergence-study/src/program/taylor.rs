//! The kind `taylor`: a program answers J(m + εd) and, at ε = 0, its derivatives along d. The rule
//! is that of [`TaylorTest`](crate::TaylorTest).

mod file;
mod outcome;

use std::path::Path;

use super::answer::Answer;
use super::expectation::Expectation;
use super::launch::{CaseParameter, Launch};
use crate::input::{Refusal, schema};
use crate::study::{Case, CaseFailure, FromFile, Header, Kind, KindRow, Outcome, Ran};
use crate::taylor::{MOST_DRAWN_ANEW, steps_from};
use convergence_judge::taylor::{Along, Finding, Judged, Second};
use convergence_judge::verdict::FEWEST_LEVELS;
use file::TaylorFile;

/// The row of the table of kinds.
pub(super) const ROW: KindRow = KindRow {
    name: "taylor",
    schema: schema::of::<TaylorFile>,
    read: Taylor::read_study,
    why: "By Taylor's theorem J(m + εd) differs from J(m) + ε dJ·d by a remainder of second order in ε, if dJ·d is the derivative of J.",
    judged: "The program is run at steps from `eps` down to the noise of J, in several directions. The differences of J, extrapolated to ε = 0, \
             give dJ·d with an error bar: the answered dJ·d must agree with it to `to`, and the remainder must fall with order 2 (3 with d2J). \
             A J that is too noisy for that, or a line along d, is inconclusive.",
    failure: "The derivative is not that of J: a term is missing, or it belongs to another m, or to another J.",
};

/// What a program answers: J, and its derivatives along d.
const NAMES: [&str; 3] = ["J", "dJ", "d2J"];

/// A test of derivatives that a program computes.
#[derive(Debug, Clone)]
pub(super) struct Taylor {
    launch: Launch,
    /// The coarsest step.
    coarsest: f64,
    /// How many directions are tested.
    directions: usize,
    /// Whether the program chooses the direction by `{seed}`.
    has_seed: bool,
    /// Whether the second derivative is tested, too.
    second: bool,
    /// The part of a derivative by which it may be off.
    to: f64,
}

/// A step in a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StepCase {
    /// By which the program draws the direction, from 1.
    seed: usize,
    /// ε, negative for the other side.
    eps: f64,
    /// Whether it is run once more, which shows the noise of J.
    is_again: bool,
}

/// The numbers of an answer; NaN if that was the answer, or where none is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Values {
    value: f64,
    slope: f64,
    curvature: f64,
}

/// The derivatives along one direction, judged.
struct Direction {
    seed: usize,
    value: f64,
    derivatives: Vec<Judged>,
    /// How many coarse steps were left out, at which J is not finite.
    left_out: usize,
}

impl FromFile for Taylor {
    type File = TaylorFile;

    fn from_file(file: TaylorFile, _: &Header, folder: &Path) -> Result<Self, Refusal> {
        file.taylor(folder)
    }
}

impl StepCase {
    fn parameters(&self) -> Vec<CaseParameter> {
        vec![("eps", self.eps), ("seed", self.seed as f64)]
    }
}

impl Taylor {
    /// The cases of a direction: at ε = 0 twice, then from the coarsest step on.
    fn cases_of(&self, seed: usize) -> Vec<StepCase> {
        let here = [false, true].map(|is_again| StepCase {
            seed,
            eps: 0.0,
            is_again,
        });
        let sides: &[f64] = if self.second { &[1.0, -1.0] } else { &[1.0] };
        let steps = steps_from(self.coarsest);
        let along = sides.iter().flat_map(|side| {
            steps.iter().map(move |step| StepCase {
                seed,
                eps: side * step,
                is_again: false,
            })
        });
        here.into_iter().chain(along).collect()
    }

    fn case(&self, data: StepCase) -> Case<StepCase> {
        let seed = if self.has_seed {
            format!("seed = {}, ", data.seed)
        } else {
            String::new()
        };
        let again = if data.is_again { ", again" } else { "" };
        Case::new(format!("{seed}eps = {:e}{again}", data.eps), 1.0, data)
    }

    /// What the program must answer at a step.
    fn expected(&self, case: &StepCase) -> Vec<Expectation> {
        let count = match (case.eps == 0.0, self.second) {
            (false, _) => 1,
            (true, false) => 2,
            (true, true) => 3,
        };
        let names = NAMES.iter().take(count);
        names.map(|name| Expectation::of_value(name)).collect()
    }

    /// The judged directions; `None` where a case has no result.
    fn directions(&self, ran: &[Ran<StepCase, Values>]) -> Vec<Direction> {
        let last = ran.iter().map(|ran| ran.case.data.seed).max().unwrap_or(0);
        let judged = (1..=last).map(|seed| self.direction(seed, ran));
        judged.flatten().collect()
    }

    fn direction(&self, seed: usize, ran: &[Ran<StepCase, Values>]) -> Option<Direction> {
        let cases = self.cases_of(seed);
        let found = cases
            .iter()
            .map(|case| ran.iter().find(|ran| ran.case.data == *case)?.ok().copied());
        let found: Vec<Values> = found.collect::<Option<_>>()?;
        let (here, along) = found.split_at(2);
        let mut steps = steps_from(self.coarsest);
        let (ahead, behind) = along.split_at(steps.len());
        let [mut forward, mut backward] = [ahead, behind].map(|side| {
            let values = side.iter().map(|one| one.value);
            values.collect::<Vec<f64>>()
        });
        // The coarsest steps may leave the domain of J.
        let is_finite = |k: &usize| {
            let sides = [forward.get(*k), backward.get(*k)];
            sides.into_iter().flatten().all(|value| value.is_finite())
        };
        let most = steps.len() - FEWEST_LEVELS;
        let left_out = (0..steps.len()).find(is_finite).unwrap_or(0).min(most);
        steps.drain(..left_out);
        forward.drain(..left_out);
        backward.drain(..left_out.min(backward.len()));
        let second = self.second.then_some(Second {
            backward,
            curvature: here[0].curvature,
        });
        let along = Along {
            steps,
            forward,
            here: [here[0].value, here[1].value],
            slope: here[0].slope,
            second,
        };
        Some(Direction {
            seed,
            value: here[0].value,
            derivatives: along.judge(self.to),
            left_out,
        })
    }
}

impl Direction {
    /// Whether a derivative is zero along it, which has no relative error.
    fn vanishes(&self) -> bool {
        let mut derivatives = self.derivatives.iter();
        derivatives.any(|judged| judged.finding == Finding::Vanishes)
    }
}

impl Kind for Taylor {
    type Data = StepCase;
    type Found = Values;

    fn cases(&self) -> Vec<Case<StepCase>> {
        let seeds = 1..=self.directions;
        let cases = seeds.flat_map(|seed| self.cases_of(seed));
        cases.map(|data| self.case(data)).collect()
    }

    /// Another direction for one in which a derivative is zero.
    fn more(&self, ran: &[Ran<StepCase, Values>]) -> Option<Case<StepCase>> {
        if !self.has_seed || ran.iter().any(|ran| ran.found.is_err()) {
            return None;
        }
        let last = ran.iter().map(|ran| ran.case.data.seed).max()?;
        let is_new = |case: &StepCase| ran.iter().all(|ran| ran.case.data != *case);
        if let Some(next) = self.cases_of(last).into_iter().find(is_new) {
            return Some(self.case(next));
        }
        let tell = self.directions(ran);
        let tell = tell.iter().filter(|one| !one.vanishes()).count();
        let is_next = tell < self.directions && last < self.directions + MOST_DRAWN_ANEW;
        is_next.then(|| self.case(self.cases_of(last + 1)[0]))
    }

    fn run(&self, case: &StepCase) -> Result<Values, CaseFailure> {
        let invocation = self.launch.invocation(&case.parameters());
        let expected = self.expected(case);
        let answer: Answer = invocation.run(&expected)?;
        let [value, slope, curvature] = NAMES.map(|name| {
            let value = answer.number(&Expectation::of_value(name));
            value.unwrap_or(f64::NAN)
        });
        // A J that is not a number may be one outside of its domain, far from m.
        let is_outside = case.eps != 0.0 && answer.number(&expected[0]).is_some_and(f64::is_nan);
        match answer.failure {
            Some(failure) if !is_outside => Err(failure),
            _ => Ok(Values {
                value,
                slope,
                curvature,
            }),
        }
    }

    fn judge(&self, ran: &[Ran<StepCase, Values>]) -> Outcome {
        outcome::judge(self, ran)
    }
}
