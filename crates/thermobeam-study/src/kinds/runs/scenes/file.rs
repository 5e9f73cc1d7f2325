//! A case as its file has it.

use convergence_study::NamedNumber;
use convergence_study::file::{Finite, Number, OneOf, Positive, Range, Refusal};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    CHOSEN, IndependentAnswer, Most, Whole,
    shown::{NUMBERS, PAIRS, listed},
};
use crate::kinds::runs::cases::End;
use crate::scene::{
    Scene, SceneFile,
    file::{BeamTable, InitialTable, MeshTable, ObstacleTable, TimeTable},
};

/// A study of whole scenes.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScenesFile {
    /// scenes, and what their runs must answer
    pub(super) case: Vec<CaseTable>,
}

/// A table `[[case]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CaseTable {
    /// a name that no other case has
    name: String,
    /// the claim in words
    claim: String,
    /// how its run must end
    ends: OneOf<End>,
    /// numbers of the answer, where a run ends with one
    answer: Option<AnswerTable>,
    /// upper bounds on what a run takes, where it ends with an answer
    most: Option<MostTable>,
    /// as in a scene
    #[serde(default)]
    beam: BeamTable,
    /// as in a scene
    obstacles: Option<ObstacleTable>,
    /// as in a scene
    #[serde(default)]
    initial: InitialTable,
    /// as in a scene
    #[serde(default)]
    mesh: MeshTable,
    /// as in a scene
    time: TimeTable,
}

/// The table `[case.most]`: at least one bound.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct MostTable {
    /// on the mean number of iterations
    iterations_per_step: Option<Number<UpToThousand>>,
    /// on the distance of a step to the same step solved to round-off, in units of the tolerance
    unsolved: Option<Number<UpToThousand>>,
}

/// Bounds that some run misses.
#[derive(Debug, Clone, Copy)]
enum UpToThousand {}

impl Range for UpToThousand {
    const ENDS: &'static [(&'static str, f64)] = &[("exclusiveMinimum", 0.0), ("maximum", 1000.0)];
}

/// The table `[case.answer]`: at least one number or list.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct AnswerTable {
    /// distance allowed to each number, below each that is not 0
    within: Positive,
    /// what the run must give for it
    u_tip: Option<Finite>,
    /// what the run must give for it
    phi_tip: Option<Finite>,
    /// what the run must give for it
    u_t_tip: Option<Finite>,
    /// what the run must give for it
    phi_t_tip: Option<Finite>,
    /// what the run must give for it
    theta_mid: Option<Finite>,
    /// what the run must give for it
    energy: Option<Finite>,
    /// what the run must give for it
    u_tip_min: Option<Finite>,
    /// what the run must give for it
    u_tip_max: Option<Finite>,
    /// what the run must give for it
    largest_increase: Option<Finite>,
    /// u(1) at the end of the run for an error of `within`
    chosen_u_tip: Option<Finite>,
    /// pairs that the run must give
    history: Option<Vec<[Finite; 2]>>,
    /// pairs that the run must give
    contact: Option<Vec<[Finite; 2]>>,
    /// pairs that the run must give
    steady: Option<Vec<[Finite; 2]>>,
}

impl CaseTable {
    pub(super) fn whole(self) -> Result<Whole, Refusal> {
        let scene = SceneFile {
            beam: self.beam,
            obstacles: self.obstacles,
            initial: self.initial,
            mesh: self.mesh,
            time: self.time,
        };
        let scene = Scene::new(scene, self.name)?;
        let end = self.ends.value;
        let answers = end == End::Answer;
        let none = "none, where a case ends with an error";
        if end == End::Unbalanced {
            let names = End::FAILURES.map(|end| format!("\"{}\"", end.name()));
            let allowed = format!("\"answer\", {}", names.join(", "));
            return Err(Refusal::written("ends", allowed));
        }
        if self.answer.is_some() && !answers {
            return Err(Refusal::new("answer", "an answer", none));
        }
        if self.most.is_some() && !answers {
            return Err(Refusal::new("most", "bounds", none));
        }
        if answers && self.answer.is_none() && self.most.is_none() {
            let allowed = "a table with numbers, where a case ends with its answer";
            return Err(Refusal::missing("answer", allowed));
        }
        let answer = self.answer.map(|answer| answer.numbers());
        let answer = answer.transpose().map_err(Refusal::within("answer"))?;
        let most = self.most.map(|most| most.bounds(&scene));
        let most = most.transpose().map_err(Refusal::within("most"))?;
        Ok(Whole {
            scene,
            claim: self.claim,
            end,
            answer,
            most: most.unwrap_or_default(),
        })
    }
}

impl MostTable {
    fn bounds(&self, scene: &Scene) -> Result<Most, Refusal> {
        let most = Most {
            iterations: self.iterations_per_step.map(Number::get),
            unsolved: self.unsolved.map(Number::get),
        };
        if most == Most::default() {
            return Err(Refusal::missing(
                "iterations_per_step",
                "at least one bound",
            ));
        }
        if most.unsolved.is_some() {
            scene
                .one_step()
                .map_err(|error| Refusal::new("unsolved", "a bound for dg", error.to_string()))?;
        }
        Ok(most)
    }
}

impl AnswerTable {
    fn numbers(&self) -> Result<IndependentAnswer, Refusal> {
        let named = [
            self.u_tip,
            self.phi_tip,
            self.u_t_tip,
            self.phi_t_tip,
            self.theta_mid,
            self.energy,
            self.u_tip_min,
            self.u_tip_max,
            self.largest_increase,
        ];
        let named = NUMBERS.into_iter().zip(named);
        let mut numbers = vec![];
        for (name, value) in named.chain([(CHOSEN, self.chosen_u_tip)]) {
            numbers.extend(value.map(|value| NamedNumber::new(name, value.get())));
        }
        let lists = [&self.history, &self.contact, &self.steady];
        for (key, pairs) in PAIRS.into_iter().zip(lists) {
            if let Some(pairs) = pairs {
                numbers.extend(listed(key, pairs.iter().map(|pair| pair.map(Finite::get))));
            }
        }
        if numbers.is_empty() {
            let allowed = "at least one number of the answer";
            return Err(Refusal::missing(NUMBERS[0], allowed));
        }
        // A distance says something of 0 beside a number that it resolves: the size of the motion.
        let within = self.within;
        let sizes = numbers.iter().map(|number| number.value.abs());
        let smallest = sizes.filter(|size| *size > 0.0).reduce(f64::min);
        let Some(smallest) = smallest else {
            let allowed = "at least one number that is not 0";
            return Err(Refusal::new(NUMBERS[0], "zeros alone", allowed));
        };
        if within.get() >= smallest {
            let allowed = format!("a distance below {smallest}, the smallest of the numbers");
            return Err(Refusal::written("within", allowed));
        }
        Ok(IndependentAnswer { numbers, within })
    }
}
