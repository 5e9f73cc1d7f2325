//! Errors of random and of given scenes with contact: their estimates, and the runs chosen for an
//! accuracy, against runs that share neither mesh nor steps with the search, at times and in a norm
//! that are not those of the search.
//!
//! Such runs would not reveal a mistake that all dG runs share. So for some scenes linear elements
//! and steps of `midpoint` are refined in addition: they must converge to the chosen run.
//!
//! ```toml
//! [random-errors]
//! scenes = 12            # smooth data, by the paper's scheme, midpoint and dG in turn
//! rough = 3              # a narrow feature, a kink or a jump in one of the fields; a search may refuse to resolve it
//! refined = 4            # every fourth scene of smooth data is also run on finer and finer linear elements; 0: none is
//! targets = [1e-4, 1e-6] # of u(1, t)
//! norm_targets = [1e-2]  # of the norm of Theorem 3.4
//! seed = 1
//!
//! [[case]]               # given scenes, if any: a name and the tables of a scene
//! name = "..."
//! ```

mod draw;
mod judge;
mod measure;
mod truth;

pub use self::measure::{AbandonedSearch, PredictedErrors};

use self::judge::worst;
use super::prelude::*;
use super::runs::cases::named_cases;
use crate::{
    kinds::settings::{ActiveTerms, CONTACT, Exercise, Integration},
    scene::{self, Scene},
};
use convergence_study::{
    Coverage,
    internal::study::{coverage::NO_RESULT, header::SettingWords, readings},
};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "random-errors",
    keys: RandomErrors::KEYS,
    read: read_study::<RandomErrors>,
    why: "Users rely on an error that the program prints. Here it is measured against runs on twelve elements of degree 11 or 14, which no \
          search tries, at other times and by other quadrature; for some scenes linear elements and small steps must tend to the same \
          motion.",
    judged: "No error of any number exceeds 1.3 times its estimate, no run the error asked for, no search is refused unless its data \
             are rough, and the error of linear elements falls at least fourfold with four times the elements and steps.",
    failure: "The comparisons of a search are too coarse, or look where the error is not; a run that no finer one confirms may be wrong.",
};

/// Tolerance of the baseline on the work: one round more or less of a search.
const WORK_TOLERANCE: f64 = 0.2;

/// A study of errors of random scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomErrors {
    scenes: usize,
    rough: usize,
    refined: usize,
    targets: Vec<f64>,
    norm_targets: Vec<f64>,
    seed: u64,
    given: Vec<Scene>,
}

/// The scene of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drawn {
    /// Random and smooth, with its number.
    Smooth(usize),
    /// Random, with a narrow feature, a kink or a jump.
    Rough(usize),
    /// Given in the file.
    Given(usize),
}

const KEYS: [Key; 2] = [
    Key::new(
        "random-errors",
        Form::Table(&[&[&DRAWN]]),
        "random scenes, and the errors predicted and requested",
    ),
    Key::new(
        "case",
        Form::List(&Form::Table(&[&[
            &[Key::new(
                "name",
                Form::Text,
                "a name that no other case has",
            )],
            &scene::KEYS,
        ]])),
        "scenes in addition",
    )
    .or("none"),
];
const DRAWN: [Key; 6] = [
    Key::new("scenes", Form::Count(0), "random smooth scenes"),
    Key::new(
        "rough",
        Form::Count(0),
        "random scenes with a narrow feature, a kink or a jump",
    ),
    Key::new(
        "refined",
        Form::Count(0),
        "of the first scenes, those whose reference is compared with a finer one",
    ),
    Key::new(
        "targets",
        Form::List(&Form::Positive),
        "errors of the tip that a search must reach",
    ),
    Key::new(
        "norm_targets",
        Form::List(&Form::Positive),
        "errors in the norm of Theorem 3.4, likewise",
    ),
    Key::new("seed", Form::Count(0), "of the random scenes"),
];

impl FromFile for RandomErrors {
    const KEYS: &'static [Keys] = &[&[&KEYS]];

    fn from_document(_: &Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        let section = root.table(ROW.name, &[&DRAWN])?;
        let positive = |list: &[f64]| !list.is_empty() && list.iter().all(|target| *target > 0.0);
        let targets = |key| section.list(key, "a list of numbers > 0", Field::number, positive);
        let given = if root.get("case").is_some() {
            named_cases(root, given)?
        } else {
            vec![]
        };
        Ok(Self {
            scenes: section.count("scenes", usize::from(given.is_empty())..=10_000)?,
            rough: section.count("rough", 0..=10_000)?,
            refined: section.count("refined", 0..=10_000)?,
            targets: targets("targets")?,
            norm_targets: targets("norm_targets")?,
            seed: section.count("seed", 0..=u32::MAX as usize)? as u64,
            given,
        })
    }
}

fn given(section: &Section<'_>, name: String) -> Result<Scene, InputError> {
    Scene::from_tables(section, name)
}

impl Kind for RandomErrors {
    type Data = Drawn;
    type Found = PredictedErrors;

    fn settings(&self, header: &Header, subject: &Subject) -> Vec<SettingWords> {
        let case = subject.case.as_deref();
        let given = self.given.iter().find(|scene| Some(&*scene.name) == case);
        let exercise = match given {
            Some(scene) => Exercise::of_scene(CONTACT, Integration::PAPER, scene),
            None => Exercise::new(CONTACT, Integration::PAPER, ActiveTerms::MODERATE),
        };
        exercise.settings(header, subject)
    }

    fn cases(&self) -> Vec<Case<Drawn>> {
        let smooth =
            (0..self.scenes).map(|number| (format!("scene {number}"), Drawn::Smooth(number)));
        let rough =
            (0..self.rough).map(|number| (format!("rough scene {number}"), Drawn::Rough(number)));
        let given = self
            .given
            .iter()
            .enumerate()
            .map(|(number, scene)| (scene.name.clone(), Drawn::Given(number)));
        smooth
            .chain(rough)
            .chain(given)
            .map(|(label, data)| Case::new(label, 3e7, data))
            .collect()
    }

    fn run(&self, &drawn: &Drawn) -> Result<PredictedErrors, CaseFailure> {
        self.measure(drawn)
    }

    fn judge(&self, ran: &[Ran<Drawn, PredictedErrors>]) -> Outcome {
        let found: Vec<(&Ran<Drawn, PredictedErrors>, &PredictedErrors)> = ran
            .iter()
            .filter_map(|ran| Some((ran, ran.ok()?)))
            .collect();
        let rows: Vec<_> = found
            .iter()
            .map(|(ran, found)| (vec![ran.case.label.clone()], found.readings()))
            .collect();
        let work: f64 = found.iter().map(|(_, found)| found.work).sum();
        let errors = worst(&found).map_or("no error is known".to_owned(), |worst| {
            let [over_estimate, over_target, over_norm_target] = worst;
            let most = max_or_nan(over_target, over_norm_target);
            format!(
                "errors at most {over_estimate:.2} of their estimates and {most:.2} of the target error"
            )
        });
        let headline = format!("{} scenes: {errors}", found.len());
        Outcome {
            tables: vec![readings::table(
                "Errors relative to the estimates and targets",
                &["scene"],
                &rows,
            )],
            figures: vec![self.figure(&found)],
            quantities: vec![Quantity::new("work of all searches", work, WORK_TOLERANCE)],
            headline: headline.clone().into(),
            coverage: vec![self.searches(ran)],
            ..Outcome::new(headline, vec![], self.checks(ran, &found))
        }
    }
}

impl RandomErrors {
    /// Each scene has an estimate and a search for each target; some are refused.
    fn searches(&self, ran: &[Ran<Drawn, PredictedErrors>]) -> Coverage {
        let each = 1 + self.targets.len() + self.norm_targets.len();
        let mut left_out = vec![];
        for ran in ran {
            let (reason, count) = match ran.ok() {
                Some(found) => ("refused with a reason", found.refused.len()),
                None => (NO_RESULT, each),
            };
            left_out.extend((0..each).map(|k| (k < count).then_some(reason)));
        }
        Coverage::of("searches", left_out)
    }
}
