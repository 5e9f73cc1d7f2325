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
//! [case.answer]                # with `ends = "answer"` only: numbers as `run --format json` calls them
//! within = 1e-9                # bound on the distance to each
//! u_tip = -0.0408657198986
//! history = [[0.5, 0.012]]     # t and u(1, t), at times k t_end/200
//! contact = [[0.0, 0.2]]       # beginning and end of each contact
//! steady = [[-0.01, 0]]        # u(1) and the number of unstable directions of each steady state, in the order of u(1)
//! estimated_error = 1e-3       # what `--estimate-error` says of u(1) at the end
//! chosen_u_tip = -0.040865     # u(1) at the end of the run that `--target-error` chooses for an error of `within`
//! [case.most]                  # with `ends = "answer"`, beside an answer or in place of it: bounds
//! iterations_per_step = 5.0    # mean number of iterations
//! unsolved = 1.0               # distance of a step to the same step solved to round-off, over the tolerance; one-step schemes
//! # and the tables of a scene, by any scheme
//! [case.time]
//! dt = 0.005
//! t_end = 1.0
//! ```

use std::ops::ControlFlow;

use super::energy::{End, named_cases};
use super::prelude::*;
use super::runs::steady::exact_states;
use super::runs::watch::SOLVED;
use super::tables::cost_of_run;
use crate::error::reference::distance;
use crate::predict::Work;
use crate::predict::choice::{Quantity as Accuracy, choose};
use crate::predict::estimate::estimate;
use crate::run::tally::Extremes;
use crate::run::together::run_together;
use crate::scene;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/scenes",
    read: reader::<Scenes>,
    why: "Two programs that were written independently of each other seldom make the same mistake. A run of a scene must give \
          the numbers of the other program: of the same scheme on the same mesh to round-off and tolerance, of the scheme of any \
          order those of a converged solution.",
    judged: "Each number of an answer must be met within the bound of its case, and each run must end as the case says. Where a \
             case bounds iterations or the distance to solved steps, they must stay below. The baseline guards all numbers of a \
             run and its counts: steps, iterations, factorisations.",
    failure: "A value of the scene is not used, or used for something else: look which keys the case sets and its neighbours do \
              not. Counts alone that move mean another stopping criterion or another rule for factorising anew.",
    settings: |header, item| {
        Topic::new("whole scenes", ItemMethod::OneStep)
            .of_file()
            .settings(header, item)
    },
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
    name: String,
    claim: String,
    scene: Scene,
    end: End,
    answer: Expected,
    /// Bound on the distance to each number of the answer.
    within: f64,
    most: Most,
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

/// Numbers by their names: some of [`NUMBERS`] and of [`PREDICTED`], and those of lists of pairs.
type Expected = Vec<(String, f64)>;

/// Keys of an answer whose values are lists of pairs.
const PAIRS: [&str; 3] = ["history", "contact", "steady"];
const STEADY: &str = "steady states";

/// The numbers that a list of pairs stands for.
fn listed(key: &str, pairs: &[[f64; 2]]) -> Expected {
    let (what, names) = match key {
        "contact" => ("contacts", ["begin of contact", "end of contact"]),
        "steady" => (
            STEADY,
            [
                "u(1) of steady state",
                "unstable directions of steady state",
            ],
        ),
        _ => {
            return pairs
                .iter()
                .map(|[t, u]| (format!("u(1, {t})"), *u))
                .collect();
        }
    };
    let named = |(k, pair): (usize, &[f64; 2])| {
        [0, 1].map(|i| (format!("{} {}", names[i], k + 1), pair[i]))
    };
    [(what.to_owned(), pairs.len() as f64)]
        .into_iter()
        .chain(pairs.iter().enumerate().flat_map(named))
        .collect()
}

/// Keys of what predictions say: the error of a scene, and the run for an accuracy.
const PREDICTED: [&str; 2] = ["estimated_error", "chosen_u_tip"];

/// Work that a prediction may do.
const MOST_WORK: f64 = 2e8;

/// What a run shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// How it ended.
    pub end: End,
    /// The last level, the free end's range and the energy's largest change, in the order of
    /// [`NUMBERS`].
    pub numbers: [f64; NUMBERS.len()],
    /// Counts, in the order of [`COUNTS`].
    pub counts: [usize; COUNTS.len()],
    /// Whether the scene has the same bits in a lane of a group that is not full; `None` where it
    /// can only run alone.
    pub alike_in_lanes: Option<bool>,
    /// `(t, u(1, t))`.
    pub tip: Vec<(f64, f64)>,
    /// Beginning and end of each contact.
    pub contact: Vec<(f64, f64)>,
    /// Predictions and steady states, where the answer has them.
    others: Expected,
    /// Distance of the least solved step to its solution over the tolerance, where the case bounds
    /// it.
    pub unsolved: Option<f64>,
}

/// Names of numbers, as in the object of `run --format json`.
pub const NUMBERS: [&str; 9] = [
    "u_tip",
    "phi_tip",
    "u_t_tip",
    "phi_t_tip",
    "theta_mid",
    "energy",
    "u_tip_min",
    "u_tip_max",
    "largest_increase",
];

/// Names of counts; `contact` counts steps in contact, or the contact events of the scheme of any
/// order.
pub const COUNTS: [&str; 6] = [
    "steps",
    "iterations",
    "most iterations",
    "passes",
    "factorizations",
    "contact",
];

impl FromFile for Scenes {
    fn from_document(_: &Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "case"])?;
        Ok(Self {
            scenes: named_cases(root, case)?,
        })
    }
}

fn case(section: &Section<'_>, name: String) -> Result<Whole, InputError> {
    section.allow(
        &[
            &["name", "claim", "ends", "answer", "most"],
            &scene::TABLES[..],
        ]
        .concat(),
    )?;
    let end = section
        .require("ends", "\"answer\" or an error")?
        .choice(&End::ALL)?;
    let most = section.section("most")?;
    let (answer, within) = match (section.section("answer")?, end) {
        (Some(answer), End::Answer) => numbers_of(&answer)?,
        (None, End::Answer) if most.is_none() => {
            return Err(section.missing(
                "answer",
                "a table with numbers, where a case ends with its answer",
            ));
        }
        (Some(_), _) => {
            return Err(section.refuse(
                "answer",
                "an answer",
                "none, where a case ends with an error",
            ));
        }
        (None, _) => (vec![], 0.0),
    };
    if most.is_some() && end != End::Answer {
        return Err(section.refuse("most", "bounds", "none, where a case ends with an error"));
    }
    let scene = Scene::from_tables(section, name.clone())?;
    Ok(Whole {
        claim: section.require("claim", "a text")?.text()?.to_owned(),
        most: most.map_or(Ok(Most::default()), |section| Most::read(&section, &scene))?,
        scene,
        name,
        end,
        answer,
        within,
    })
}

impl Most {
    fn read(section: &Section<'_>, scene: &Scene) -> Result<Self, InputError> {
        let [iterations, unsolved] = ["iterations_per_step", "unsolved"];
        section.allow(&[iterations, unsolved])?;
        let bound = |key: &str| section.get(key).map(|field| field.positive()).transpose();
        let most = Self {
            iterations: bound(iterations)?,
            unsolved: bound(unsolved)?,
        };
        if most == Self::default() {
            return Err(section.missing(iterations, "at least one bound"));
        }
        if most.unsolved.is_some() {
            scene
                .one_step()
                .map_err(|error| section.refuse(unsolved, "a bound for dg", error.to_string()))?;
        }
        Ok(most)
    }

    /// The claims of a case, each as a check.
    fn checks(self, name: &str, shown: &Shown) -> Vec<Check> {
        let [steps, iterations, ..] = shown.counts;
        let mean = iterations as f64 / steps as f64;
        let of_iterations = self.iterations.map(|most| {
            let claim = format!("a step takes at most {most} iterations on average");
            Check::that(mean <= most, claim, format!("{mean:.2} in {steps} steps"))
                .about(Subject::of("iterations").in_case(name))
        });
        let of_solution = self.unsolved.map(|most| {
            let share = shown.unsolved.unwrap_or(f64::NAN);
            let claim = format!(
                "each step is at most {most} times the tolerance from the same step solved to round-off"
            );
            Check::that(share <= most, claim, format!("{} times", short_text(share)))
                .about(Subject::of("solved steps").in_case(name))
        });
        of_iterations.into_iter().chain(of_solution).collect()
    }
}

/// The numbers of an answer, and the bound.
fn numbers_of(section: &Section<'_>) -> Result<(Expected, f64), InputError> {
    section.allow(&[&["within"], &NUMBERS[..], &PREDICTED, &PAIRS].concat())?;
    let within = section.positive("within")?;
    let number = |name: &str| {
        section
            .get(name)
            .map(|field| Ok((name.to_owned(), field.number()?)))
    };
    let numbers = NUMBERS.into_iter().chain(PREDICTED).filter_map(number);
    let mut answer = numbers.collect::<Result<Expected, InputError>>()?;
    for key in PAIRS {
        if let Some(field) = section.get(key) {
            answer.extend(listed(key, &pairs(&field)?));
        }
    }
    if answer.is_empty() {
        return Err(section.missing(NUMBERS[0], "at least one number of the answer"));
    }
    Ok((answer, within))
}

fn pairs(field: &Field<'_>) -> Result<Vec<[f64; 2]>, InputError> {
    let allowed = "a list of pairs of numbers";
    let pair = |item: &Field<'_>| match item.items(allowed)?.as_slice() {
        [one, other] => Ok([one.number()?, other.number()?]),
        _ => Err(item.refuse_as_written("two numbers")),
    };
    field.items(allowed)?.iter().map(pair).collect()
}

impl Kind for Scenes {
    /// Number of the scene.
    type Data = usize;
    type Found = Shown;

    fn cases(&self) -> Vec<Case<usize>> {
        // Each step is observed, which costs three times its solution.
        let cost = |scene: &Scene| match scene.method {
            Method::OneStep(_) => 4.0 * cost_of_run(scene),
            Method::Dg(_) => cost_of_run(scene),
        };
        let case = |(data, whole): (usize, &Whole)| {
            Case::new(whole.name.clone(), cost(&whole.scene), data)
        };
        self.scenes.iter().enumerate().map(case).collect()
    }

    fn run(&self, index: &usize) -> Result<Shown, CaseFailure> {
        let whole = &self.scenes[*index];
        let scene = &whole.scene;
        let shown =
            Shown::of(&Simulator::new(scene)?.run(Recording::Curve(TIMES), &mut |_, _| ()))?;
        let lane = run_together(std::slice::from_ref(scene))?
            .first()
            .map(Shown::of)
            .transpose()?;
        let alike_in_lanes = lane.map(|lane| lane.has_the_bits_of(&shown));
        let unsolved = whole.most.unsolved.map(|_| unsolved(scene)).transpose()?;
        Ok(Shown {
            alike_in_lanes,
            others: whole.others()?,
            unsolved,
            ..shown
        })
    }

    fn judge(&self, ran: &[Ran<usize, Shown>]) -> Outcome {
        let found: Vec<(&Whole, &Shown)> = ran
            .iter()
            .filter_map(|ran| Some((&self.scenes[ran.case.data], ran.ok()?)))
            .collect();
        let mut checks = vec![completion(ran, |shown| {
            // A run without a step has no change of the energy.
            let count = if shown.counts[0] == 0 {
                NUMBERS.len() - 1
            } else {
                NUMBERS.len()
            };
            not_finite(NUMBERS.into_iter().zip(shown.numbers).take(count))
        })];
        checks.extend(found.iter().map(|(whole, shown)| whole.check(shown)));
        checks.extend(
            found
                .iter()
                .flat_map(|(whole, shown)| whole.most.checks(&whole.name, shown)),
        );
        checks.push(alike_in_lanes(&found));
        let answered = found.iter().filter(|(whole, _)| !whole.answer.is_empty());
        let strain =
            largest_of(answered.map(|(whole, shown)| whole.farthest(shown).1 / whole.within));
        let distance = strain.map_or(String::new(), |strain| {
            format!(", at most {strain:.2} of the distance allowed to an independent answer")
        });
        let headline = format!("{} scenes{distance}", found.len());
        let head = [
            "scene",
            "scheme",
            "solver",
            "end",
            "farthest from its answer",
            "by",
        ];
        let rows: Vec<_> = found
            .iter()
            .map(|(whole, shown)| (whole.cells(shown), whole.readings(shown)))
            .collect();
        Outcome {
            tables: vec![readings::table(
                "Scenes against an independent implementation",
                &head,
                &rows,
            )],
            quantities: readings::guarded(rows.iter().flat_map(|(_, readings)| readings)),
            coverage: self.coverage(ran),
            headline: headline.clone(),
            ..Outcome::new(headline, vec![], checks)
        }
    }
}

impl Scenes {
    /// The scenes that are compared with an answer, and with themselves in lanes.
    fn coverage(&self, ran: &[Ran<usize, Shown>]) -> Vec<Coverage> {
        let count = |items: &str, reason: fn(&Whole, &Shown) -> Option<&'static str>| {
            let of_scene = |ran: &Ran<usize, Shown>| match ran.ok() {
                Some(shown) => reason(&self.scenes[ran.case.data], shown),
                None => Some(NO_RESULT),
            };
            Coverage::of(items, ran.iter().map(of_scene))
        };
        vec![
            count("scenes against an answer", |whole, _| {
                let unknown = whole.answer.is_empty();
                unknown.then_some("with bounds or an end only")
            }),
            count("scenes in lanes", |_, shown| {
                let alone = shown.alike_in_lanes.is_none();
                alone.then_some("without a scheme that runs in lanes")
            }),
        ]
    }
}

impl Whole {
    /// Predictions and steady states, where the answer has them.
    fn others(&self) -> Result<Expected, CaseFailure> {
        let (mut others, mut ignored, [error, chosen]) = (vec![], |_: f64| (), PREDICTED);
        let is_known = |name: &str| self.answer.iter().any(|(of, _)| of == name);
        if is_known(error) {
            let budget = estimate(&self.scene, &mut Work::new(MOST_WORK, &mut ignored))?;
            let of_tip = budget
                .quantities
                .iter()
                .find(|estimate| estimate.name == "u(1) at the end");
            others.push((
                error.to_owned(),
                of_tip.map_or(f64::NAN, |estimate| estimate.total),
            ));
        }
        if is_known(chosen) {
            let work = &mut Work::new(MOST_WORK, &mut ignored);
            let choice = choose(&self.scene, Accuracy::Tip, self.within, work)?;
            let run = Simulator::new(&choice.scene)?.run(Recording::Summary, &mut |_, _| ());
            others.push((chosen.to_owned(), run.last.u_tip));
        }
        if is_known(STEADY) {
            // Infinitely many unstable directions are no number of an answer.
            let unstable = |state: &Equilibrium| {
                state
                    .unstable_directions
                    .map_or(f64::INFINITY, |count| count as f64)
            };
            let states = exact_states(&self.scene)?.into_iter();
            others.extend(listed(
                "steady",
                &states
                    .map(|state| [state.u_tip, unstable(&state)])
                    .collect::<Vec<_>>(),
            ));
        }
        Ok(others)
    }

    /// The number that is farthest from its answer, and how far; NaN is farthest.
    fn farthest(&self, shown: &Shown) -> (&str, f64) {
        let (mut farthest, named) = (("none", 0.0), shown.named());
        for (name, expected) in &self.answer {
            let found = named
                .iter()
                .find(|(number, _)| number == name)
                .map_or(f64::NAN, |(_, value)| *value);
            let distance = (found - expected).abs();
            if !(distance <= farthest.1) {
                farthest = (name, distance);
            }
        }
        farthest
    }

    fn check(&self, shown: &Shown) -> Check {
        let (name, distance) = self.farthest(shown);
        let holds = shown.end == self.end && (self.end != End::Answer || distance <= self.within);
        let evidence = if shown.end == End::Answer && !self.answer.is_empty() {
            format!(
                "{name} is {} from its answer, {:e} allowed",
                short_text(distance),
                self.within
            )
        } else {
            format!("{} after {} steps", shown.end.name(), shown.counts[0])
        };
        Check::that(holds, self.claim.clone(), evidence)
            .about(Subject::of("answer").in_case(&self.name))
    }

    /// All numbers and counts of a run, unless a run without a step has no change of the energy.
    fn readings(&self, shown: &Shown) -> Vec<Reading> {
        let numbers = NUMBERS
            .into_iter()
            .zip(shown.numbers)
            .filter(|(_, value)| value.is_finite());
        let numbers = numbers
            .map(|(of, value)| Reading::new(of, value).guarded_in(&self.name, of, TOLERANCE));
        let counts = COUNTS
            .into_iter()
            .zip(shown.counts)
            .map(|(of, count)| (of, count as f64));
        let counts = counts.map(|(of, count)| {
            Reading::new(of, count)
                .fixed(0)
                .guarded_in(&self.name, of, COUNT_TOLERANCE)
        });
        numbers.chain(counts).collect()
    }

    fn cells(&self, shown: &Shown) -> Vec<String> {
        let solver = self
            .scene
            .one_step()
            .map_or("newton", |stepping| stepping.settings.solver.name());
        let (name, distance) = self.farthest(shown);
        let by = if self.answer.is_empty() {
            "-".to_owned()
        } else {
            format!("{distance:.1e}")
        };
        [
            &self.name,
            self.scene.method.name(),
            solver,
            shown.end.name(),
            name,
            &by,
        ]
        .map(str::to_owned)
        .to_vec()
    }
}

/// The largest distance of a step to the same step solved to round-off from the same level, in the
/// norm of (3.14), over the tolerance of the scene.
fn unsolved(scene: &Scene) -> Result<f64, CaseFailure> {
    let stepping = scene.one_step()?;
    let tolerance = stepping.settings.stopping.tolerance();
    let tolerance = tolerance
        .ok_or_else(|| CaseFailure::new("a fixed number of iterations has no tolerance"))?;
    let solved = Settings {
        stopping: Stopping::below(SOLVED),
        ..stepping.settings
    };
    let solved = Stepping {
        settings: solved,
        ..stepping
    };
    let mut problem = simulate::problem(scene);
    let lifting: Vec<f64> = scene
        .mesh
        .nodes()
        .iter()
        .map(|x| scene.beam.theta_a * (1.0 - x))
        .collect();
    let lengths: Vec<f64> = scene.mesh.lengths().collect();
    let mut driver = Driver::new(problem.clone(), stepping)?;
    let mut farthest = 0.0;
    let mut solve_again = |driver: &mut Driver<'_>, _: &Report| {
        let old = driver.old_level();
        let theta = old
            .theta
            .iter()
            .zip(&lifting)
            .map(|(theta, lifting)| theta + lifting)
            .collect();
        let [u, u_t, phi, phi_t] = [&old.u, &old.v, &old.phi, &old.w].map(Clone::clone);
        problem.initial = Initial {
            u,
            u_t,
            phi,
            phi_t,
            theta,
        };
        let mut same = Driver::new(problem.clone(), solved)?;
        run_to(&mut same, solved.dt, |_, _| ())?;
        farthest = max_or_nan(farthest, distance(&lengths, driver.level(), same.level()));
        Ok(ControlFlow::Continue(()))
    };
    run(&mut driver, scene.t_end, &[], &mut [&mut solve_again])?;
    Ok(farthest / tolerance)
}

fn alike_in_lanes(found: &[(&Whole, &Shown)]) -> Check {
    let compared = found
        .iter()
        .filter(|(_, shown)| shown.alike_in_lanes.is_some())
        .count();
    let apart = found
        .iter()
        .filter(|(_, shown)| shown.alike_in_lanes == Some(false));
    let apart: Vec<&str> = apart.map(|(whole, _)| whole.name.as_str()).collect();
    Check::that(
        compared > 0 && apart.is_empty(),
        "in lanes, in a group that is not full, each scene that can run so has the same bits",
        format!(
            "{compared} compared, {} with other bits: {}",
            apart.len(),
            apart.join(", ")
        ),
    )
    .about(Subject::of("lanes"))
}

impl Shown {
    /// All numbers by their names.
    fn named(&self) -> Expected {
        let numbers = NUMBERS.into_iter().map(str::to_owned).zip(self.numbers);
        let lists = [&self.tip, &self.contact]
            .map(|list| list.iter().map(|&(a, b)| [a, b]).collect::<Vec<_>>());
        let pairs = PAIRS
            .iter()
            .zip(&lists)
            .flat_map(|(key, list)| listed(key, list));
        numbers.chain(pairs).chain(self.others.clone()).collect()
    }

    /// Whether end, numbers and counts are the same, to the bit.
    fn has_the_bits_of(&self, other: &Self) -> bool {
        let bits = |shown: &Self| shown.numbers.map(f64::to_bits);
        (self.end, bits(self), self.counts) == (other.end, bits(other), other.counts)
    }

    fn of(run: &Run) -> Result<Self, RunError> {
        let Run {
            last,
            iterations,
            work,
            ..
        } = run;
        let Sample {
            u_tip,
            phi_tip,
            u_t_tip,
            phi_t_tip,
            theta_mid,
            energy,
            ..
        } = *last;
        let Extremes {
            u_tip_min,
            u_tip_max,
        } = run.extremes;
        let rise = run.energy.largest_increase;
        let contact = run
            .contact
            .as_ref()
            .map_or(run.contact_steps, |contact| contact.events.len());
        Ok(Self {
            end: End::of(run.failure.as_ref())?,
            numbers: [
                u_tip, phi_tip, u_t_tip, phi_t_tip, theta_mid, energy, u_tip_min, u_tip_max, rise,
            ],
            counts: [
                run.steps,
                iterations.total,
                iterations.max,
                work.passes,
                work.factorizations,
                contact,
            ],
            alike_in_lanes: None,
            tip: run.tip(),
            contact: run.contact_phases(),
            others: vec![],
            unsolved: None,
        })
    }
}
