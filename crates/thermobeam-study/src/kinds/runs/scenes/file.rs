//! A case as its file has it.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::{self, Formatter};

use convergence_study::NamedNumber;
use convergence_study::file::{Choice, Finite, Positive, Refusal, within};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{self, Deserializer, IntoDeserializer, SeqAccess, Visitor};
use serde_json::{Map, Value};

use super::{
    CHOSEN, IndependentAnswer, Most, Whole,
    shown::{NUMBERS, PAIRS, listed},
};
use crate::kinds::runs::cases::{ClaimedScene, End, Ends};
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
    ends: Choice<Ends>,
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
    iterations_per_step: Option<Positive>,
    /// on the distance of a step to the same step solved to round-off, in units of the tolerance
    unsolved: Option<Positive>,
}

/// The table `[case.answer]`: numbers and lists of pairs by their names.
#[derive(Debug, Deserialize)]
#[serde(transparent)]
struct AnswerTable(BTreeMap<String, Answered>);

/// What an answer has under a name.
#[derive(Debug)]
enum Answered {
    Number(Finite),
    Pairs(Vec<[Finite; 2]>),
}

/// The name of the bound on the distances.
const WITHIN: &str = "within";

impl<'de> Deserialize<'de> for Answered {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reads;
        impl<'de> Visitor<'de> for Reads {
            type Value = Answered;

            fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
                f.write_str("a number or pairs of numbers")
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Answered, E> {
                Finite::deserialize(value.into_deserializer()).map(Answered::Number)
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Answered, E> {
                self.visit_f64(value as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Answered, A::Error> {
                let mut pairs = vec![];
                while let Some(pair) = list.next_element()? {
                    pairs.push(pair);
                }
                Ok(Answered::Pairs(pairs))
            }
        }
        deserializer.deserialize_any(Reads)
    }
}

impl JsonSchema for AnswerTable {
    fn schema_name() -> Cow<'static, str> {
        "answer".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let described = |mut schema: Schema, meaning: &str| {
            schema.insert("description".to_owned(), meaning.into());
            Value::from(schema)
        };
        let number = Finite::json_schema(generator);
        let pairs = Vec::<[Finite; 2]>::json_schema(generator);
        let bound = Positive::json_schema(generator);
        let mut keys = Map::new();
        for name in NUMBERS {
            let meaning = "what the run must give for it";
            keys.insert(name.to_owned(), described(number.clone(), meaning));
        }
        for name in PAIRS {
            let meaning = "pairs that the run must give";
            keys.insert(name.to_owned(), described(pairs.clone(), meaning));
        }
        let meaning = "u(1) at the end of the run for an error of `within`";
        keys.insert(CHOSEN.to_owned(), described(number, meaning));
        let meaning = "distance allowed to each number";
        keys.insert(WITHIN.to_owned(), described(bound, meaning));
        json_schema!({
            "type": "object",
            "properties": keys,
            "required": [WITHIN],
            "additionalProperties": false,
        })
    }
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
        let case = ClaimedScene::new((self.name, self.claim), self.ends, scene)?;
        let answers = case.end == End::Answer;
        let none = "none, where a case ends with an error";
        if case.end == End::Unbalanced {
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
        let most = self.most.map(|most| most.bounds(&case.scene));
        Ok(Whole {
            answer: answer
                .transpose()
                .map_err(within("answer"))?
                .unwrap_or_default(),
            most: most
                .transpose()
                .map_err(within("most"))?
                .unwrap_or_default(),
            case,
        })
    }
}

impl MostTable {
    fn bounds(&self, scene: &Scene) -> Result<Most, Refusal> {
        let most = Most {
            iterations: self.iterations_per_step.map(Positive::get),
            unsolved: self.unsolved.map(Positive::get),
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
        let mut numbers = vec![];
        let singles = NUMBERS.into_iter().chain([CHOSEN]);
        let known: Vec<&str> = [WITHIN]
            .into_iter()
            .chain(singles.clone())
            .chain(PAIRS)
            .collect();
        if let Some(name) = self.0.keys().find(|name| !known.contains(&name.as_str())) {
            return Err(Refusal::unknown(name, &known));
        }
        let number = |name: &str| match self.0.get(name) {
            None => Ok(None),
            Some(Answered::Number(number)) => Ok(Some(number.get())),
            Some(Answered::Pairs(_)) => Err(Refusal::written(name, "a finite number")),
        };
        for name in singles {
            numbers.extend(number(name)?.map(|value| NamedNumber::new(name, value)));
        }
        for key in PAIRS {
            match self.0.get(key) {
                None => {}
                Some(Answered::Pairs(pairs)) => {
                    let pairs = pairs.iter().map(|pair| pair.map(Finite::get));
                    numbers.extend(listed(key, pairs.collect::<Vec<_>>()));
                }
                Some(Answered::Number(_)) => {
                    return Err(Refusal::written(key, "a list of pairs of numbers"));
                }
            }
        }
        if numbers.is_empty() {
            return Err(Refusal::missing(
                NUMBERS[0],
                "at least one number of the answer",
            ));
        }
        match number(WITHIN)? {
            Some(within) if within > 0.0 => Ok(IndependentAnswer { numbers, within }),
            Some(_) => Err(Refusal::written(WITHIN, "a finite number > 0")),
            None => Err(Refusal::missing(WITHIN, "a finite number > 0")),
        }
    }
}
