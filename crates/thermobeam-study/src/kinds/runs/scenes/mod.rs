//! Whole scenes, read and run as `run` does it, against the answers of an independent
//! implementation.
//!
//! Studies of orders take loads and initial data from an exact solution; everything else that a
//! scene says, from its initial rotation to its stopping criterion, is tested here. The work of a
//! run is guarded as well.
//!
//! ```toml
//! [[case]]
//! name = "listed-nodes"
//! claim = "..."                # in words
//! ends = "answer"              # or "indefinite", "iteration-limit", "not-finite": the failure
//! # with `ends = "answer"` only: numbers as `run --format json` calls them
//! [case.answer]
//! within = 1e-9                # bound on the distance to each
//! u_tip = -0.0408657198986
//! history = [[0.5, 0.012]]     # t and u(1, t), at times k t_end/200
//! contact = [[0.0, 0.2]]       # beginning and end of each contact
//! # u(1) and the number of unstable directions of each steady state, in the order of u(1)
//! steady = [[-0.01, 0]]
//! # u(1) at the end of the run that `--target-error` chooses for an error of `within`
//! chosen_u_tip = -0.040865
//! # with `ends = "answer"`, in addition to an answer or in place of it: bounds
//! [case.most]
//! iterations_per_step = 5.0    # mean number of iterations
//! # distance of a step to the same step solved to round-off, over the tolerance; one-step schemes
//! unsolved = 1.0
//! # and the tables of a scene, by any scheme
//! [case.time]
//! dt = 0.005
//! t_end = 1.0
//! ```

mod contact;
mod file;
mod norm;
mod shown;

use super::{
    Shown as ShownRun,
    cases::{End, named_cases},
    checks::{Condition, all, at_most, ended},
    in_words, with_table_of_runs,
};
use crate::kinds::prelude::*;
use crate::{
    accuracy::reach,
    kinds::tables::cost_of_run,
    run::{
        simulate::{Recording, Simulator},
        together::{Together, run_together},
    },
    scene::{Method, Scene},
};
use contact::ContactCount;
use convergence_judge::text::number::short_text;
use convergence_study::{NamedNumber, left_out};
use file::{CaseTable, ScenesFile};
use shown::{STEADY, listed, unsolved};
use thermobeam_exact::equilibrium::equilibria;

pub use shown::{COUNTS, NUMBERS, Shown};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/scenes",
    schema: schema::<ScenesFile>,
    read: Scenes::read_study,
    why: "Two programs that were written independently of each other seldom make the same mistake. A run of a scene must give \
          the numbers of the other program: of the same scheme on the same mesh to round-off and tolerance, of the scheme of any \
          order those of a converged solution.",
    judged: "Each number of an answer must be met within the bound of its case, and each run must end as the case says. Where a \
             case bounds iterations or the distance to solved steps, they must stay below. The baseline guards all numbers of a \
             run and its counts: steps, iterations, factorisations.",
    failure: "A value of the scene is not used, or used for something else: look which keys the case sets and its neighbours do \
              not. Counts alone that move mean another stopping criterion or another rule for factorising anew.",
};

/// Times of a history.
const TIMES: usize = 200;

/// Relative change of a number that the baseline tolerates. Iterations stop at a tolerance of 1e-10
/// or more, and may stop one earlier where rounding differs.
const TOLERANCE: f64 = 1e-7;

/// The same of a count: below 50 it must be equal.
const COUNT_TOLERANCE: f64 = 0.02;

/// A study of whole scenes.
#[derive(Debug, Clone)]
pub struct Scenes {
    scenes: Vec<Whole>,
}

/// A scene and what is known of it.
#[derive(Debug, Clone)]
struct Whole {
    scene: Scene,
    /// In words.
    claim: String,
    /// How its run must end.
    end: End,
    answer: Option<IndependentAnswer>,
    most: Most,
}

/// What an independent implementation answers.
#[derive(Debug, Clone)]
struct IndependentAnswer {
    numbers: Vec<NamedNumber>,
    /// Bound on the distance to each.
    within: Positive,
}

impl IndependentAnswer {
    /// Whether a number is asked for.
    fn has(&self, name: &str) -> bool {
        self.numbers.iter().any(|known| known.name == name)
    }
}

/// Upper bounds on the cost of steps and on what their iterations leave unsolved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Most {
    /// On the mean number of iterations of a step.
    iterations: Option<f64>,
    /// On the distance of a step to the same step solved to round-off, in the norm of (3.14) and in
    /// units of the tolerance.
    unsolved: Option<f64>,
}

/// The key of the run for an accuracy.
const CHOSEN: &str = "chosen_u_tip";

impl FromFile for Scenes {
    type File = ScenesFile;

    fn from_file(file: ScenesFile, _: &Header, _: &Path) -> Result<Self, Refusal> {
        let scenes = named_cases(file.case, CaseTable::whole, |whole| &whole.scene.name)?;
        Ok(Self { scenes })
    }
}

impl Kind for Scenes {
    /// Number of the scene.
    type Data = usize;
    type Found = Shown;

    fn cases(&self) -> Vec<Case<usize>> {
        let mut runs = vec![];
        for (place, whole) in self.scenes.iter().enumerate() {
            let scene = &whole.scene;
            // Each step is observed, which costs three times its solution.
            let observed = match scene.method {
                Method::OneStep(_) => 4.0,
                Method::Dg(_) => 1.0,
            };
            let cost = observed * cost_of_run(scene);
            runs.push(Case::new(scene.name.clone(), cost, place).described(&whole.parts()));
        }
        runs
    }

    fn run(&self, place: &usize) -> Result<Shown, CaseFailure> {
        let whole = &self.scenes[*place];
        let scene = &whole.scene;
        let mut count = ContactCount::new(scene);
        let run = Simulator::new(scene)?.watched(Recording::Curve(TIMES), &[], &mut count);
        let shown = Shown::of(&run)?;
        let unsolved = whole.most.unsolved.map(|_| unsolved(scene)).transpose()?;
        Ok(Shown {
            alike_in_lanes: self.alike_in_lanes(*place, &shown)?,
            miscounted: count.miscounted(),
            others: whole.others()?,
            unsolved,
            ..shown
        })
    }

    fn judge(&self, ran: &[Ran<usize, Shown>]) -> Outcome {
        let outcome = Outcome::of_complete(self, ran, |shown| self.judge_complete(shown));
        let table = ["Scenes against an independent implementation", "scene"];
        with_table_of_runs(outcome, ran, table, |place, shown| {
            self.scenes[*place].numbers(shown)
        })
    }
}

impl Whole {
    /// All numbers and counts of a run; a run without a step has no change of the energy.
    fn numbers(&self, shown: &Shown) -> Vec<Measured> {
        let scene = &self.scene;
        let name = &scene.name;
        let solver = scene
            .one_step()
            .map_or("newton", |stepping| stepping.settings.solver.name());
        let (farthest, by) = match &self.answer {
            Some(answer) => {
                let Farthest { name, distance } = answer.farthest(shown);
                (name, format!("{distance:.1e}"))
            }
            None => ("none", "-".to_owned()),
        };
        let mut numbers = vec![
            in_words("scheme", scene.method.name()),
            in_words("solver", solver),
            in_words("end", shown.end.name()),
            in_words("farthest from its answer", farthest),
            in_words("by", by),
        ];
        let without_a_step = usize::from(shown.counts[0] == 0);
        let of_levels = NUMBERS.len() - without_a_step;
        for (of, value) in NUMBERS.into_iter().zip(shown.numbers).take(of_levels) {
            let number = measured("", of, value).hidden();
            numbers.push(number.recorded_as(format!("{name}: {of}"), TOLERANCE));
        }
        for (of, count) in COUNTS.into_iter().zip(shown.counts) {
            let count = measured("", of, count as f64).fixed(0);
            numbers.push(count.recorded_as(format!("{name}: {of}"), COUNT_TOLERANCE));
        }
        numbers
    }
}

impl Scenes {
    fn judge_complete(&self, runs: &[ShownRun<'_, Self>]) -> Outcome {
        let shown: Vec<(&Whole, &Shown)> = runs
            .iter()
            .map(|&(place, shown)| (&self.scenes[*place], shown))
            .collect();
        let mut numbers = vec![];
        for (whole, shown) in &shown {
            numbers.push(whole.claim(shown));
            numbers.extend(whole.most.claims(&whole.scene.name, shown));
        }
        let can_share = |whole: &Whole| Together::of(&whole.scene).is_some();
        if self.scenes.iter().any(can_share) {
            numbers.extend(alike_in_lanes(&shown));
        }
        numbers.push(contacts_counted(&shown));
        let mut headline = format!("{} scenes", shown.len());
        let strains = shown
            .iter()
            .filter_map(|(whole, shown)| Some(whole.answer.as_ref()?.strain(shown)));
        if let Some(strain) = largest_of(strains) {
            headline +=
                &format!(", at most {strain:.2} of the distance allowed to an independent answer");
        }
        let unknown = shown.iter().map(|(whole, _)| {
            let is_unknown = whole.answer.is_none();
            is_unknown.then_some("with bounds or an end only")
        });
        let alone = shown.iter().map(|(_, shown)| {
            let is_alone = shown.alike_in_lanes.is_none();
            is_alone.then_some("without a scheme that runs in lanes")
        });
        let not_judged = [
            left_out("scenes against an answer", unknown),
            left_out("scenes in lanes", alone),
        ];
        Outcome {
            headline: headline.as_str().into(),
            left_out: not_judged.into_iter().flatten().collect(),
            ..Outcome::new(headline, vec![], vec![]).with_sheets([Sheet::untabled(numbers)])
        }
    }
}

/// The number that is farthest from its answer.
struct Farthest<'a> {
    name: &'a str,
    distance: f64,
}

impl IndependentAnswer {
    /// NaN is farthest.
    fn farthest(&self, shown: &Shown) -> Farthest<'_> {
        let named = shown.named();
        let mut farthest = Farthest {
            name: "none",
            distance: 0.0,
        };
        for NamedNumber { name, value } in &self.numbers {
            let number = NamedNumber::find(&named, name).unwrap_or(f64::NAN);
            let distance = (number - value).abs();
            if !(distance <= farthest.distance) {
                farthest = Farthest { name, distance };
            }
        }
        farthest
    }

    /// The largest distance in units of the bound.
    fn strain(&self, shown: &Shown) -> f64 {
        self.farthest(shown).distance / self.within.get()
    }

    /// Each number is met.
    fn is_met(&self, shown: &Shown) -> Condition {
        let Farthest { name, distance } = self.farthest(shown);
        let far = short_text(distance);
        let within = self.within.get();
        let evidence = format!("{name} is {far} from its answer, {within:e} allowed");
        at_most(distance, within, evidence)
    }
}

impl Most {
    /// What is claimed of the iterations of a case.
    fn claims(self, name: &str, shown: &Shown) -> Vec<Measured> {
        let [steps, iterations, ..] = shown.counts;
        let mut claims = vec![];
        if let Some(most) = self.iterations {
            let mean = iterations as f64 / steps as f64;
            let words = format!("{mean:.2} in {steps} steps");
            let mean = measured(name, "iterations of a step, mean", mean).words(words);
            claims.push(mean.must_be(Must::AtMost(most)));
        }
        if let Some(most) = self.unsolved {
            let name_of =
                "distance to the same step solved to round-off over the tolerance, largest";
            let share = measured(name, name_of, shown.unsolved);
            claims.push(share.must_be(Must::AtMost(most)));
        }
        claims
    }
}

impl Scenes {
    /// Whether a scene has the bits of `shown` in lanes: by itself, and in groups of all scenes of
    /// the study that can share a group, each of which is once the first; `None` where it can only
    /// run alone.
    fn alike_in_lanes(&self, place: usize, shown: &Shown) -> Result<Option<bool>, CaseFailure> {
        let scene = |place: usize| &self.scenes[place].scene;
        let Some(common) = Together::of(scene(place)) else {
            return Ok(None);
        };
        let mut sharing: Vec<usize> = (0..self.scenes.len())
            .filter(|&other| Together::of(scene(other)) == Some(common))
            .collect();
        let mut is_alike = is_alike_in(&[scene(place)], 0, shown)?;
        let orders = match sharing.len() {
            1 => 0,
            count => count,
        };
        for _ in 0..orders {
            sharing.rotate_left(1);
            let scenes: Vec<&Scene> = sharing.iter().map(|&other| scene(other)).collect();
            let lane = sharing.iter().position(|&other| other == place);
            is_alike &= is_alike_in(&scenes, lane.unwrap_or(0), shown)?;
        }
        Ok(Some(is_alike))
    }
}

/// Whether the scene of this lane has the bits of `shown`.
fn is_alike_in(scenes: &[&Scene], lane: usize, shown: &Shown) -> Result<bool, CaseFailure> {
    let runs = run_together(scenes)?;
    let found = runs.get(lane).map(Shown::of).transpose()?;
    Ok(found.is_some_and(|found| found.has_the_bits_of(shown)))
}

impl Whole {
    fn claim(&self, shown: &Shown) -> Measured {
        let met = match &self.answer {
            Some(answer) => answer.is_met(shown),
            None => Condition::that(true, ""),
        };
        // Steady states are compared without a motion.
        let is_asked = self.answer.as_ref().is_some_and(|own| !own.has(STEADY));
        let moves = Condition::or(shown.moves() || !is_asked, "nothing moves");
        all(
            &self.scene.name,
            "the answer",
            &self.claim,
            [ended(shown.end, self.end, shown.counts[0]), met, moves],
        )
    }

    fn parts(&self) -> Parts {
        let parts = Parts::of(&self.scene);
        let answer = self.answer.as_ref();
        if answer.is_some_and(|answer| answer.has(STEADY)) {
            parts.against(Known::SteadyStates)
        } else {
            parts
        }
    }

    /// The run for an accuracy and steady states, where the answer has them.
    fn others(&self) -> Result<Vec<NamedNumber>, CaseFailure> {
        let Whole { scene, answer, .. } = self;
        let mut others = vec![];
        let Some(answer) = answer else {
            return Ok(others);
        };
        if answer.has(CHOSEN) {
            let reached = reach(scene, answer.within, Recording::Summary, &mut |_| ())?;
            others.push(NamedNumber::new(CHOSEN, reached.run.last.u_tip));
        }
        if answer.has(STEADY) {
            let mut pairs = vec![];
            for state in equilibria(&scene.beam, scene.obstacles.as_ref())? {
                // Infinitely many unstable directions are no number of an answer.
                let unstable = state
                    .unstable_directions
                    .map_or(f64::INFINITY, |count| count as f64);
                pairs.push([state.u_tip, unstable]);
            }
            others.extend(listed("steady", pairs));
        }
        Ok(others)
    }
}

/// In lanes, by itself and in each group that it can share, each scene has the same bits.
fn alike_in_lanes(shown: &[(&Whole, &Shown)]) -> [Measured; 2] {
    let compared = shown.iter();
    let compared = compared.filter(|(_, shown)| shown.alike_in_lanes.is_some());
    let apart = names_of(shown, |shown| shown.alike_in_lanes == Some(false));
    [
        some_of("", "scenes compared in lanes", compared.count()),
        none_listed("scenes with other bits in lanes", &apart),
    ]
}

/// A step of a one-step scheme counts as one in contact where the free end has passed an obstacle.
fn contacts_counted(shown: &[(&Whole, &Shown)]) -> Measured {
    let wrong = names_of(shown, |shown| {
        shown.miscounted.is_some_and(|steps| steps > 0)
    });
    none_listed("scenes that count other steps in contact", &wrong)
}

/// The names of the scenes for which this holds.
fn names_of<'s>(shown: &[(&'s Whole, &Shown)], holds: impl Fn(&Shown) -> bool) -> Vec<&'s str> {
    let chosen = shown.iter().filter(|(_, shown)| holds(shown));
    chosen.map(|(whole, _)| whole.scene.name.as_str()).collect()
}
